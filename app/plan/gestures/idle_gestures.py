"""Gestures of players while they do not play: in long rests, and after the last note.

If the instrument is lowered long enough in a rest, the hands settle on it, the player looks around and counts the last
bars. After the end of the piece all players look up to the audience and bow together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from app.errors import Message
from app.plan.event_id import EventId
from app.plan.gestures.lowered_instrument import LOWER_S, RAISE_S
from app.plan.kinds import GestureKind
from app.plan.model import GestureEvent, TimeFrame
from app.plan.music.piece import NoteTimes, Piece, Seeds
from app.score.model import Note

LONG_REST_S: Final = 8.0
"""Length in seconds of rests from which players move at rest; a shorter one suffices only for lowering the
instrument.
"""
SETTLE_S: Final = 1.3
SETTLE_CHANCE: Final = 0.8
AGAIN_CHANCE: Final = 0.3
"""Probability that the hands settle again instead of a further look."""
LOOK_S: Final = (2.2, 3.6)
LOOK_EVERY_S: Final = 3.5
"""Mean seconds between two looks around in a rest."""
MOST_LOOKS: Final = 8
"""Greatest number of looks around in a rest."""
COUNT_BARS: Final = 2
COUNT_LEAST_BEATS: Final = 3
COUNT_CHANCE: Final = 0.65

HELD_BEFORE_S: Final = 0.2
"""Seconds before the end of the last note at which the body comes to rest."""
STILL_LOWERING_S: Final = 0.5
"""Seconds after the instrument begins to be lowered at which the body moves again."""
LOOK_UP_S: Final = 1.7
"""Seconds after the last note at which the eyes look up to the audience."""
BOW_S: Final = 3.1
"""Seconds after the last note at which the bow begins."""
BOW_LASTS_S: Final = 2.5
APART_S: Final = 0.25
"""Greatest random delay in seconds of a bow, so that players do not bow simultaneously."""
AFTER_S: Final = 0.2
"""Least seconds for which the performance continues after the bow."""


def in_long_rests(
    notes: tuple[Note, ...],
    times: NoteTimes,
    lowered: Sequence[GestureEvent],
    piece: Piece,
    frame: TimeFrame,
    seeds: Seeds,
) -> list[GestureEvent]:
    """Plan the gestures of a player who rests for at least `LONG_REST_S`, while the instrument is lowered
    (``lowered``).
    """
    events: list[GestureEvent] = []
    index_of = {note.id: index for index, note in enumerate(notes)} if lowered else {}
    for low in lowered:
        note_id = EventId.parse(low.id).of
        index = index_of.get(note_id)
        if index is None:
            continue
        silent_s = float(times.played_end_s[index - 1]) if index else frame.first_frame_s
        rest_s = float(times.onset_s[index]) - silent_s
        if rest_s < LONG_REST_S:
            continue
        first_s = max(low.start_s, frame.first_frame_s - LOWER_S) + LOWER_S
        events += _rest(note_id, notes[index].onset_tick, (first_s, low.end_s - RAISE_S), rest_s, piece, seeds)
    return events


def _rest(
    note_id: str, place: int, down_s: tuple[float, float], rest_s: float, piece: Piece, seeds: Seeds
) -> list[GestureEvent]:
    """Plan the gestures in the rest before a note at the tick ``place``; the instrument is down during the span
    ``down_s``.
    """
    first_s, last_s = down_s
    said = {"rest_s": round(rest_s, 2)}
    events: list[GestureEvent] = []
    free_s = first_s
    if seeds.chance_at("settle", place) < SETTLE_CHANCE and first_s + SETTLE_S <= last_s:
        start_s = first_s + 0.15 + 0.5 * seeds.chance_at("settle at", place)
        if start_s + SETTLE_S <= last_s:
            free_s = start_s + SETTLE_S
            events.append(_event("settle_grip", note_id, start_s, free_s, 1.0, piece, said))
    if seeds.chance_at("count", place) < COUNT_CHANCE:
        counted = _counted(free_s, last_s, piece, seeds.chance_at("count from", place))
        if counted is not None:
            start_s, end_s, beats = counted
            amount = round(0.5 + 0.5 * seeds.chance_at("count size", place), 4)
            events.append(_event("count", note_id, start_s, end_s, amount, piece, said | {"beats": beats}))
    return events + _looks(place, (free_s, last_s), piece, seeds, said)


def _counted(first_s: float, last_s: float, piece: Piece, later: float) -> tuple[float, float, int] | None:
    """First and last beat, in seconds, of the bars that the player counts, and the number of beats; None if there is no
    time.

    ``later`` (0..1) delays the player's start, by half the time at most.
    """
    clock = piece.clock
    last = int(clock.ticks(last_s))
    bar = piece.metre_map.bar_ticks_at(last)
    beats = piece.metre_map.felt_between(last - COUNT_BARS * bar, last + 1)
    beats = beats[(beats > last - COUNT_BARS * bar) & (beats <= last)]
    beats_s = clock.seconds(beats.astype(np.float64))
    inside = beats_s[beats_s >= first_s]
    inside = inside[int(later * 0.5 * len(inside)) :]
    if len(inside) <= COUNT_LEAST_BEATS:
        return None
    return float(inside[0]), float(inside[-1]), len(inside) - 1


def _looks(
    place: int, free: tuple[float, float], piece: Piece, seeds: Seeds, said: Mapping[str, float]
) -> list[GestureEvent]:
    """Plan looks around and renewed grips during a rest, at times that differ between players; ``free`` is the usable
    part of the rest (start and end in seconds), ``said`` the arguments of the reason.
    """
    events: list[GestureEvent] = []
    free_s, last_s = free
    for number in range(MOST_LOOKS):
        shortest_s, longest_s = LOOK_S
        lasts_s = shortest_s + (longest_s - shortest_s) * seeds.chance_at(f"look {number}", place)
        start_s = free_s + 0.3 + 1.2 * seeds.chance_at(f"look at {number}", place)
        if start_s + lasts_s > last_s:
            break
        amount = round(0.6 + 0.4 * seeds.chance_at(f"look to {number}", place), 4)
        name = f"@{round(piece.clock.ticks(start_s))}"
        if number and seeds.chance_at(f"settle again {number}", place) < AGAIN_CHANCE:
            lasts_s = SETTLE_S
            events.append(_event("settle_grip", name, start_s, start_s + lasts_s, amount, piece, said))
        else:
            events.append(_event("look_about", name, start_s, start_s + lasts_s, amount, piece, said))
        free_s = start_s + lasts_s + LOOK_EVERY_S * (0.4 + seeds.chance_at(f"look again {number}", place))
    return events


def holding_at_end(
    times: NoteTimes, lowered: Sequence[GestureEvent], piece: Piece, frame: TimeFrame
) -> list[GestureEvent]:
    """Plan the gesture of keeping still from the end of the last note until the instrument is lowered."""
    lows = [event for event in lowered if event.id == "lower_instrument:end"]
    if not lows:
        return []
    start_s, end_s = float(times.played_end_s.max()) - HELD_BEFORE_S, lows[0].start_s + STILL_LOWERING_S
    return [_event("hold_still", "end", start_s, min(end_s, frame.end_s), 1.0, piece, {})]


def after_the_end(last_s: float, piece: Piece, frame: TimeFrame, seeds: Seeds) -> list[GestureEvent]:
    """Plan the look up to the audience and the bow after the last note of all players, which ends at ``last_s``; empty
    if the performance ends too soon.
    """
    if last_s + BOW_S + BOW_LASTS_S + AFTER_S > frame.end_s:
        return []
    look_s = last_s + LOOK_UP_S + 0.3 * seeds.chance("look up")
    bow_s = last_s + BOW_S + APART_S * (seeds.chance("bow") - 0.5)
    size = round(0.85 + 0.15 * seeds.chance("bow size"), 4)
    lasts_s = BOW_LASTS_S * (0.92 + 0.16 * (seeds.chance("bow lasts") - 0.5))
    return [
        _event("look_up", "end", look_s, frame.end_s, 1.0, piece, {"after_s": round(look_s - last_s, 2)}),
        _event("bow", "end", bow_s, bow_s + lasts_s, size, piece, {"after_s": round(bow_s - last_s, 2)}),
    ]


def _event(
    kind: GestureKind,
    name: str,
    start_s: float,
    end_s: float,
    amount: float,
    piece: Piece,
    said: Mapping[str, float],
) -> GestureEvent:
    return GestureEvent(
        id=f"{kind}:{name}",
        kind=kind,
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=round(piece.clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        amount=amount,
        reason=Message(f"gesture.{kind}", dict(said)),
    )
