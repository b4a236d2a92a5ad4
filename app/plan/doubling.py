"""Doubling: changes of a musician between several instruments, and the events that remain for each.

A change is in the middle of the rest between the last note of one instrument and the first of the next: the first is
put aside, the hand moves, the second is picked up. About two seconds are assumed: three steps at an unhurried pace and
a small margin.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Final, Protocol, TypeVar

import msgspec

from app.errors import Message
from app.plan.model import GestureEvent, PlayerPlan, Problem

NEEDED_S: Final = 2.0
"""Length in seconds of a rest below which a change of instrument is reported as a problem (an assumption)."""
USUAL_S: Final = 3.4
"""Usual seconds of a change if there is time (an assumption)."""
LEAST_S: Final = 0.8
"""Shortest change in seconds; in a shorter rest it overlaps the notes before and after."""
AFTER_S, BEFORE_S = 0.12, 0.3
"""Seconds from the end of the last note to the change, and from the change to the next note, with the lips in place."""
BREATH_S: Final = 0.08
"""Seconds from the change to the breath."""
PUT, TAKEN = 0.42, 0.58
"""Shares of the change at which the first instrument is put aside, and at which the hand reaches the second one."""


class InstrumentChange(msgspec.Struct, frozen=True):
    """Change of a musician from one instrument to another.

    Attributes
    ----------
    before, after : str
        Ids of the players of the two.
    start_s, put_s, taken_s, end_s : float
        Times at which the first instrument leaves its place, it is put aside, the hand reaches the second, and the
        second is up.
    rest_s : float
        Seconds from the end of the last note to the start of the next; negative if they overlap.
    note_id : str
        Id of the next note.
    """

    before: str
    after: str
    start_s: float
    put_s: float
    taken_s: float
    end_s: float
    rest_s: float
    note_id: str


def changes(played: Mapping[str, PlayerPlan]) -> tuple[InstrumentChange, ...]:
    """Plan the instrument changes of a musician: each is between two notes, before the breath for the second one if
    there is time.

    Parameters
    ----------
    played : mapping of str to PlayerPlan
        Plans of all players that the musician plays, in order.
    """
    rows = [
        (event.start_s, event.end_s, place, player, event.note_id)
        for place, (player, plan) in enumerate(played.items())
        for event in plan.fingerings
    ]
    drawn = {player: [breath.start_s for breath in plan.breaths if breath.draws_air] for player, plan in played.items()}
    notes = sorted(rows, key=lambda row: row[:3])
    found: list[InstrumentChange] = []
    free_s = float("-inf")
    for (_, end_s, _, before, _), (next_s, _, _, after, note_id) in pairwise(notes):
        if before == after:
            continue
        rest_s = next_s - end_s
        from_s, to_s = end_s + AFTER_S, next_s - BEFORE_S
        breaths_s = drawn[after]
        first = bisect_left(breaths_s, end_s)
        if first < len(breaths_s) and from_s + NEEDED_S <= breaths_s[first] - BREATH_S < to_s:
            to_s = breaths_s[first] - BREATH_S
        length_s = min(max(to_s - from_s, LEAST_S), USUAL_S)
        middle_s = 0.5 * (from_s + to_s)
        begin_s = max(middle_s - 0.5 * length_s, free_s)
        done_s = max(middle_s + 0.5 * length_s, begin_s + 0.1 * LEAST_S)
        length_s = done_s - begin_s
        put_s, taken_s = begin_s + PUT * length_s, begin_s + TAKEN * length_s
        found.append(InstrumentChange(before, after, begin_s, put_s, taken_s, done_s, rest_s, note_id))
        free_s = done_s
    return tuple(found)


def in_hands(player_id: str, first: str, found: Sequence[InstrumentChange]) -> tuple[tuple[float, float], ...]:
    """Return the spans in which a player's instrument is in hand, for a musician who begins with that of ``first``."""
    spans, since_s = [], float("-inf") if player_id == first else None
    for change in found:
        if change.before == player_id and since_s is not None:
            spans.append((since_s, change.put_s))
            since_s = None
        elif change.after == player_id:
            since_s = change.taken_s
    if since_s is not None:
        spans.append((since_s, float("inf")))
    return tuple(spans)


def first_played(played: Mapping[str, PlayerPlan]) -> str:
    """The player whose instrument the musician holds at the start."""
    begun = [
        (plan.fingerings[0].start_s, place, player)
        for place, (player, plan) in enumerate(played.items())
        if plan.fingerings
    ]
    return min(begun)[2] if begun else next(iter(played))


class _Event(Protocol):
    @property
    def start_s(self) -> float: ...
    @property
    def end_s(self) -> float: ...
    @property
    def corrected(self) -> bool: ...


E = TypeVar("E", bound=_Event)


def held_plan(plan: PlayerPlan, first: str, found: Sequence[InstrumentChange], names: Mapping[str, str]) -> PlayerPlan:
    """Remove from a player's plan the events while the instrument is put aside; corrections by hand stay.

    Parameters
    ----------
    first : str
        See `first_played`.
    found : sequence of InstrumentChange
        The musician's, in order.
    names : mapping of str to str
        Names of players by id.
    """
    spans = in_hands(plan.player_id, first, found)
    ends_s = [end_s for _, end_s in spans]

    def meets(start_s: float, end_s: float) -> bool:
        """Return whether an event overlaps a span with the instrument in hand."""
        first = bisect_right(ends_s, start_s)
        return first < len(spans) and spans[first][0] < end_s

    lowered = [event for event in plan.gestures if event.part == "lowering"]
    others = _within([event for event in plan.gestures if event.part != "lowering"], meets)
    gestures: list[GestureEvent] = sorted((*lowered, *others), key=lambda event: event.start_s)
    reported = [
        _problem(change, names) for change in found if change.after == plan.player_id and change.rest_s < NEEDED_S
    ]
    return msgspec.structs.replace(
        plan,
        cues=_within(plan.cues, meets, at_end=True),
        gestures=tuple(gestures),
        expressions=_within(plan.expressions, meets),
        problems=tuple(sorted((*plan.problems, *reported), key=lambda problem: problem.start_s)),
        glances=tuple(glance for glance in plan.glances if meets(glance.start_s, glance.end_s)),
    )


def _within(events: Iterable[E], meets: Callable[[float, float], bool], at_end: bool = False) -> tuple[E, ...]:
    return tuple(
        event for event in events if event.corrected or meets(event.end_s if at_end else event.start_s, event.end_s)
    )


def _problem(change: InstrumentChange, names: Mapping[str, str]) -> Problem:
    before, after = names[change.before], names[change.after]
    if change.rest_s < 0.0:
        message = Message("doubling.overlap", {"before": before, "after": after, "seconds": round(-change.rest_s, 1)})
    else:
        message = Message(
            "doubling.rest_short",
            {"before": before, "after": after, "rest_s": round(change.rest_s, 1), "needed_s": NEEDED_S},
        )
    return Problem(message, change.note_id, change.start_s, change.end_s)
