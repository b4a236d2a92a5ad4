"""Finds the directions in force at each measure, and restores them where repeats and jumps go back in the score.

After a repeat, a D.C. or a D.S., directions that are printed later in the score (a change to the piccolo, a mute, a
dynamic, a solo) are no longer in force.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from app.score.doublings import requested_instrument
from app.score.musicxml.loudness import USUAL_DYNAMIC, held_dynamic
from app.score.musicxml.written import Direction, Measure, Time
from app.score.mutes import said_of_mute
from app.score.solos import words_of_players

_UNSAID: Final = {
    "dynamic": Direction(0, "dynamic", USUAL_DYNAMIC),
    "instrument": Direction(0, "own_instrument"),
    "mute": Direction(0, "mute", "open"),
    "players": Direction(0, "words", "tutti"),
}
"""Directions that apply before the first written one, by subject."""

_State = dict[str, Direction]


def restored(measures: Sequence[Measure], order: Sequence[tuple[Time, int]]) -> list[tuple[int, Direction]]:
    """Directions to repeat where playing jumps to another measure: those in force there in print that differ from those
    in force before the jump, each with its tick.

    Parameters
    ----------
    order : sequence of (start, measure)
        Start tick and index of every measure in the order they are played.
    """
    jumps = [
        (start, before + 1, place)
        for (_, before), (start, place) in zip([(0, -1), *order], order, strict=False)
        if place != before + 1 and place < len(measures)
    ]
    if not jumps:
        return []
    page: list[_State] = [dict(_UNSAID)]
    for measure in measures:
        page.append(_after(page[-1], measure))
    found: list[tuple[int, Direction]] = []
    for start, left, place in jumps:
        running, there = page[min(left, len(measures))], page[place]
        own = {_subject(one) for one in measures[place].directions if one.start <= 0}
        found += (
            (round(start), one) for subject, one in there.items() if subject not in own and running[subject] != one
        )
    return found


def _after(state: _State, measure: Measure) -> _State:
    """Return the directions in force after a measure, by subject; those set in the measure come last."""
    changed = {}
    for one in sorted(measure.directions, key=lambda one: one.start):
        subject = _subject(one)
        if subject:
            changed[subject] = replace(one, start=0, text=held_dynamic(one.text) if subject == "dynamic" else one.text)
    if not changed:
        return state
    return {**{subject: one for subject, one in state.items() if subject not in changed}, **changed}


def _subject(one: Direction) -> str:
    """Subject of a direction that stays in force until another one replaces it: ``"instrument"``, ``"mute"``,
    ``"dynamic"`` or ``"players"``; empty if it has no lasting effect.
    """
    if one.kind in ("instrument", "mute"):
        return one.kind
    if one.kind == "dynamic":
        return "dynamic" if held_dynamic(one.text) else ""
    if one.kind != "words":
        return ""
    if requested_instrument(one.text) is not None:
        return "instrument"
    if said_of_mute(one.text) is not None:
        return "mute"
    return "players" if words_of_players([(0, one.text)]) else ""
