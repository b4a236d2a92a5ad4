"""Doublings: one person who plays several instruments in turn, as flutists change to the piccolo.

A `Player` is what someone plays on one instrument. Who doubles another shares that one's body: the first instrument's
player is the person, and has what belongs to a person.

Messages
--------
doubling.posture(player, other): no posture fits both instruments.
doubling.together(player, other, seconds): both sound at once for so long.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Final

import msgspec

from app.score.model import MOST_VOICES, Note, Part
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap, Posture

if TYPE_CHECKING:
    from app.project.model import Player

TOGETHER_S: Final = 1.0
"""As long as this two instruments of one person may sound at once, all in all: a held last note, a pickup written
early. More is another player's."""


def embodied(players: tuple[Player, ...]) -> tuple[Player, ...]:
    """The players, those who double with what belongs to the person; the same tuple where nothing is other."""
    if not any(player.doubles for player in players):
        return players
    persons = {player.id: player for player in players if not player.doubles}
    result = tuple(_of_person(player, persons.get(player.doubles)) for player in players)
    return players if all(one is other for one, other in zip(result, players, strict=True)) else result


def _of_person(player: Player, person: Player | None) -> Player:
    if person is None:
        return player
    same = (player.character_id, player.parameters, player.stage) == (
        person.character_id,
        person.parameters,
        person.stage,
    )
    if same:
        return player
    return msgspec.structs.replace(
        player, character_id=person.character_id, parameters=person.parameters, stage=person.stage
    )


def without_persons(players: Iterable[Player]) -> tuple[Player, ...]:
    """Players some of whose persons have gone: the first instrument that is left is the person's then."""
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
    """Which parts are played by the player of another one, by part id: what a track's player has on a second
    instrument, unless no posture fits both or they sound at once."""
    groups: dict[tuple[int, int, int], list[Part]] = {}
    for part in sorted(parts, key=lambda part: part.voice):
        groups.setdefault((part.track, part.channel, part.voice % MOST_VOICES), []).append(part)
    found: dict[str, str] = {}
    for first, *others in groups.values():
        mine = [first]
        for part in others:
            postures = common_postures([maps[one.map_id] for one in (*mine, part)])
            played = [one.notes for one in mine]
            if part.place != first.place and postures and together_s(played, part.notes, clock) <= TOGETHER_S:
                found[part.id] = first.id
                mine.append(part)
    return found


def common_postures(instruments: Sequence[InstrumentMap]) -> tuple[Posture, ...]:
    """In what all of some instruments are played."""
    postures: tuple[Posture, ...] = ("standing", "seated")
    return tuple(one for one in postures if all(one in instrument.hold.postures for instrument in instruments))


def together_s(played: Sequence[Sequence[Note]], notes: Sequence[Note], clock: TempoMap) -> float:
    """How long notes sound while others do, in seconds."""
    others = _spans(chain.from_iterable(played))
    total_s, place = 0.0, 0
    for start, end in _spans(notes):
        while place < len(others) and others[place][1] <= start:
            place += 1
        for other_start, other_end in others[place:]:
            if other_start >= end:
                break
            first, last = max(start, other_start), min(end, other_end)
            total_s += clock.seconds(float(last)) - clock.seconds(float(first))
    return total_s


def _spans(notes: Iterable[Note]) -> list[tuple[int, int]]:
    """Where notes sound, apart and in order."""
    spans: list[tuple[int, int]] = []
    for start, end in sorted((note.onset_tick, note.end_tick) for note in notes):
        if spans and start <= spans[-1][1]:
            spans[-1] = (spans[-1][0], max(end, spans[-1][1]))
        else:
            spans.append((start, end))
    return spans
