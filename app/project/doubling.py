"""Doublings: one musician plays several instruments in turn, for example flute and piccolo.

A `Player` is one instrument part. A doubling player shares the body of another player: the player of the first
instrument represents the musician and holds character, parameters and place.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Final

import msgspec
import numpy as np

from app.project.performers import Player
from app.score.model import MOST_VOICES, Note, Part
from app.score.tempo import TempoMap
from instrument_maps.map_table import Posture
from instrument_maps.model import InstrumentMap

TOGETHER_S: Final = 1.0
"""Longest total seconds for which two instruments of one musician may sound simultaneously, as for a held last note or
an early pickup. More overlap requires two musicians.
"""


def embodied(players: tuple[Player, ...]) -> tuple[Player, ...]:
    """Return the players, with doubling ones given the character, parameters, place and outfit of their musician; the
    same tuple if nothing changes."""
    if not any(player.doubles for player in players):
        return players
    musicians = {player.id: player for player in players if not player.doubles}
    result = tuple(_of_musician(player, musicians.get(player.doubles)) for player in players)
    return players if all(one is other for one, other in zip(result, players, strict=True)) else result


def _of_musician(player: Player, musician: Player | None) -> Player:
    if musician is None:
        return player
    shared = {name: getattr(musician, name) for name in ("character_id", "parameters", "stage", "outfit")}
    if all(getattr(player, name) == value for name, value in shared.items()):
        return player
    return msgspec.structs.replace(player, **shared)


def promote_remaining(players: Iterable[Player]) -> tuple[Player, ...]:
    """Return the players left after a removal: if a musician's first player was removed, the next one takes its
    role."""
    left = tuple(players)
    there = {player.id for player in left if not player.doubles}
    heirs: dict[str, str] = {}
    result = []
    for player in left:
        if player.doubles and player.doubles not in there:
            heir = heirs.setdefault(player.doubles, player.id)
            player = msgspec.structs.replace(player, doubles="" if heir == player.id else heir)
        result.append(player)
    return tuple(result)


def doubled_parts(parts: Sequence[Part], maps: Mapping[str, InstrumentMap], clock: TempoMap) -> dict[str, str]:
    """Return parts played by the musician of another part, as part id to part id: a track's second instrument, unless
    no posture fits both or they sound together.
    """
    groups: dict[tuple[int, int, int], list[Part]] = {}
    for part in sorted(parts, key=lambda part: part.voice):
        groups.setdefault((part.track, part.channel, part.voice % MOST_VOICES), []).append(part)
    found: dict[str, str] = {}
    for first, *others in groups.values():
        mine, played = [first], _spans(first.notes)
        for part in others:
            postures = common_postures([maps[one.map_id] for one in (*mine, part)])
            sounding = _spans(part.notes)
            if part.place != first.place and postures and _overlap_s(played, sounding, clock) <= TOGETHER_S:
                found[part.id] = first.id
                mine.append(part)
                played = _joined([*played, *sounding])
    return found


def common_postures(instruments: Sequence[InstrumentMap]) -> tuple[Posture, ...]:
    """Return the postures in which all given instruments can be played."""
    postures: tuple[Posture, ...] = ("standing", "seated")
    return tuple(one for one in postures if all(one in instrument.hold.postures for instrument in instruments))


def together_s(played: Sequence[Sequence[Note]], notes: Sequence[Note], clock: TempoMap) -> float:
    """Return for how many seconds ``notes`` sound at the same time as notes of the parts ``played`` already."""
    return _overlap_s(_spans(chain.from_iterable(played)), _spans(notes), clock)


def _overlap_s(one: Sequence[tuple[int, int]], other: Sequence[tuple[int, int]], clock: TempoMap) -> float:
    """Return the overlap in seconds of two lists of (start, end) in ticks; the spans of a list are ordered and
    separate.
    """
    common: list[tuple[int, int]] = []
    mine = theirs = 0
    while mine < len(one) and theirs < len(other):
        (start, end), (other_start, other_end) = one[mine], other[theirs]
        first, last = max(start, other_start), min(end, other_end)
        if first < last:
            common.append((first, last))
        if end <= other_end:
            mine += 1
        else:
            theirs += 1
    if not common:
        return 0.0
    seconds = clock.seconds(np.array(common, np.float64))
    return float((seconds[:, 1] - seconds[:, 0]).sum())


def _spans(notes: Iterable[Note]) -> list[tuple[int, int]]:
    """Return the spans (start, end) of ticks in which notes sound, ascending; overlapping ones are merged."""
    return _joined((note.onset_tick, note.end_tick) for note in notes)


def _joined(spans: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the spans sorted and merged, so that they neither overlap nor touch."""
    joined: list[tuple[int, int]] = []
    for start, end in sorted(spans):
        if joined and start <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((start, end))
    return joined
