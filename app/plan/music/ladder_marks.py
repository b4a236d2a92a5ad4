"""Recovers dynamics from the velocities of a notation program: which program wrote them, and the dynamic at each note.
A ladder is the table of velocities with which a program writes dynamics.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.music.velocity_ladders import (
    COMMON,
    DEFAULTS,
    LADDERS,
    LEVELS,
    LILYPOND,
    LILYPOND_RANGES,
    MARKS,
    MF,
    SET_RANGES,
    SHARES,
    UNMARKED_STEP,
    articulated,
    ladder_of,
)

STROKES: Final = 5
"""Number of equal notes around a single different one from which that one is no dynamic, in lines of more than four
times as many notes.
"""
UNMARKED: Final = 0.95
"""Share of a part's notes with the default velocity, or with its changes by articulations, from which the part has no
dynamic marks.
"""
RUN, HAIRPIN, SHARED, APART = 3, 6, 0.3, 4
"""Levels are written, not played, if the third share of the notes is in runs of at least the first number of equal
notes or in the second number of consecutive increases or decreases, or if they differ by the fourth value.
"""

_OWN_RANGE: Final = 6.0
"""Least advantage in log likelihood for reading a part with another instrument's range; that of no instrument must
explain a whole piece.
"""
_SET_RANGE, _SET_LEVELS, _SET_SHARE = 12.0, 3, 0.6
"""For a range set by the score: least advantage in log likelihood, least number of levels, and least share of their
notes that match its marks exactly.
"""
_PASSED: Final = 0.1
"""Greatest share of notes at the end of a hairpin that leads to no mark."""


def is_written(velocity: IntArray) -> bool:
    """Return whether velocities (N,) were written by a notation program (levels and hairpins) instead of played."""
    steps = np.sign(np.diff(velocity))
    edges = np.flatnonzero(np.append(True, steps[1:] != steps[:-1])) if len(steps) else steps
    lengths = np.diff(np.append(edges, len(steps))) + 1
    long = lengths >= np.where(steps[edges] == 0, RUN, HAIRPIN)
    if lengths[long].sum() >= SHARED * len(velocity):
        return True
    values, counts = np.unique(velocity, return_counts=True)
    common = values[counts > len(velocity) * 0.02]
    return len(velocity) < 2 * STROKES or (len(common) * 4 <= len(velocity) and bool((np.diff(common) >= APART).all()))


def _levels(velocity: IntArray) -> dict[int, int]:
    """Find the velocities at which the music stays for a while, and the number of notes at each; velocities within
    hairpins are excluded.
    """
    edges = np.flatnonzero(np.append(True, velocity[1:] != velocity[:-1]))
    lengths = np.diff(np.append(edges, len(velocity)))
    for least in (3, 1):
        stays: dict[int, int] = {}
        for value, length in zip(velocity[edges].tolist(), lengths.tolist(), strict=True):
            if length >= least:
                stays[value] = stays.get(value, 0) + length
        if stays:
            return stays
    return {}


def recognised(written: Sequence[tuple[IntArray, int | None]]) -> tuple[str, bool]:
    """Find the notation program whose velocity ladder best explains all parts: its name (empty if none is clearly
    better), and whether LilyPond wrote its whole range.
    """
    levels = [(_levels(velocities), program) for velocities, program in written]
    best, name, whole = 0.0, "", False
    for one in LADDERS:
        total = ladder_of(one, None).usual
        for found, program in levels:
            wrote = _written_as(one, found, program)
            total += _gain(one, wrote, found) - _range_cost(wrote, program)
        if total > best:
            best, name, whole = total, one, False
    if any(program in LILYPOND_RANGES for _, program in levels):
        total = sum(_gain(LILYPOND, None, found) for found, _ in levels) - _OWN_RANGE
        if total > best:
            return LILYPOND, True
    return name, whole


def _gain(name: str, program: int | None, levels: dict[int, int]) -> float:
    """Log likelihood ratio of a part's velocity levels being written by a program (its ladder ``name``), against random
    velocities.
    """
    gains = _gains(name, program)
    return sum(gains[value] * math.log1p(count) for value, count in levels.items())


def _written_as(name: str, levels: dict[int, int], program: int | None, whole_range: bool = False) -> int | None:
    """Return the program whose velocity range LilyPond most probably used for a part: that of the part's instrument, of
    an earlier instrument, or None for the whole range. For other notation programs the part's own ``program``.
    """
    if name != LILYPOND:
        return program
    if whole_range:
        return None
    ranges = (program, None, *LILYPOND_RANGES, *(one for one in SET_RANGES if _may_be_set(one, levels, program)))
    return max(ranges, key=lambda one: _gain(name, one, levels) - _range_cost(one, program))


def _may_be_set(one: int, levels: dict[int, int], program: int | None) -> bool:
    """Return whether the score probably sets the velocity range ``one`` itself: enough ``levels`` are exactly its
    dynamics, and more than twice as many as those of the usual ranges.
    """
    marked = [count for at, count in levels.items() if count >= RUN and at in _marks_of(one)]
    plain = max(sum(levels[at] for at in levels.keys() & _marks_of(own)) for own in (program, None))
    return len(marked) >= _SET_LEVELS and sum(marked) >= max(_SET_SHARE * sum(levels.values()), 2.0 * plain)


@lru_cache(maxsize=128)
def _marks_of(program: int | None) -> frozenset[int]:
    """Velocities of *pp* to *ff* in one of LilyPond's ranges."""
    return frozenset(at for mark, at in ladder_of(LILYPOND, program).steps if mark in COMMON)


def _range_cost(wrote: int | None, program: int | None) -> float:
    """Return the cost of assuming that LilyPond wrote a part in the range ``wrote`` instead of that of its
    ``program``.
    """
    if wrote == program:
        return 0.0
    return _SET_RANGE if wrote in SET_RANGES else _OWN_RANGE


@lru_cache(maxsize=256)
def _gains(name: str, program: int | None) -> tuple[float, ...]:
    """Log likelihood ratio (128,) of each velocity 0..127 having been written by the notation program ``name``, against
    random velocities.
    """
    ladder = ladder_of(name, program)
    likely = np.full(128, 0.2 / 60.0)
    for mark, velocity in ladder.steps:
        for more, share in articulated(ladder, velocity):
            for off, near in ((0, 0.9), (-1, 0.05), (1, 0.05)):
                place = min(max(velocity + more + off, 0), 127)
                likely[place] += SHARES[mark] * share * near
    likely[list(ladder.passed)] += _PASSED / max(len(ladder.passed), 1)
    if ladder.default is not None:
        likely[ladder.default] += 0.1
    return tuple(np.log(likely * 60.0).tolist())


def has_no_marks(name: str, written: Sequence[tuple[IntArray, int | None]], whole_range: bool) -> bool:
    """Return whether all parts stay at the velocity that a program writes without dynamics, except for articulations
    and single notes.
    """
    default: int | None = None
    for velocities, program in written:
        values, counts = np.unique(velocities, return_counts=True)
        usual = int(values[counts.argmax()])
        ladder = ladder_of(name, _written_as(name, _levels(velocities), program, whole_range))
        if usual != ladder.default and (ladder.default is not None or usual not in DEFAULTS):
            return False
        if ladder.default is None and default not in (None, usual):
            return False
        default = usual
        as_usual = {usual + more for more, _ in articulated(ladder, usual)}
        if counts[[int(value) in as_usual for value in values]].sum() < UNMARKED * len(velocities):
            return False
    return True


STRESS: Final = 12
"""Increase of velocity from which an articulation is an accent; a smaller one is a staccato's."""
_ACCENT: Final = 0.16
"""Loudness that an accent adds, 0..1: about a mark."""
_CHANGE_COST, _FURTHER_COST = 0.8, 0.15
"""Cost of a change of level, and of each further mark it skips."""
_NEAR_COST, _OFF_COST, _STEP_COST, _MOST_COST = 0.6, 1.2, 0.6, 3.0
"""Costs of a velocity one step from its dynamic, two steps from it, for each further step, and the greatest cost."""
_ARTICULATION_COST, _ADDED_COST = 0.25, 0.03
"""Cost of a note that an articulation makes louder, and per velocity step of the increase."""
_MARK_COST = _CHANGE_COST
"""Least cost of reading a mark's velocity as the articulation of an unmarked note."""


@lru_cache(maxsize=64)
def _costs(name: str, program: int | None) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Cost and accent (128, S) of reading each velocity as each of the S dynamics of a notation program's table
    (ladder), and cost (S, S) of a change from one to another.
    """
    ladder = ladder_of(name, program)
    values = np.array([velocity for _, velocity in ladder.steps])
    loud = np.array([LEVELS[MARKS.get("fff" if mark == "sf" else mark, MF)] for mark, _ in ladder.steps])
    has = np.array([mark != UNMARKED_STEP for mark, _ in ladder.steps])
    between = np.interp(np.arange(128), values[has], loud[has])
    cost = np.minimum(_OFF_COST + _STEP_COST * np.abs(between[:, None] - loud) / 0.126, _MOST_COST)
    accent = np.clip(between[:, None] - np.where(has, loud, between[values]), -_ACCENT, _ACCENT)
    for step, (mark, velocity) in enumerate(ladder.steps):
        more = [added for added, _ in articulated(ladder, velocity)]
        rows = [(added, _ARTICULATION_COST + _ADDED_COST * abs(added)) for added in more[1:]]
        # A hairpin passes through the unmarked level without a mark.
        if mark == UNMARKED_STEP:
            # A velocity equal to that of a mark is more likely the mark than an articulation without one.
            rows = [(added, max(paid, _MARK_COST) if velocity + added in values[has] else paid) for added, paid in rows]
        near = () if mark == UNMARKED_STEP else ((-1, _NEAR_COST), (1, _NEAR_COST))
        for added, paid in (*near, *rows, (0, 0.0)):
            place = min(max(velocity + added, 0), 127)
            if paid <= cost[place, step]:
                cost[place, step] = paid
                # The velocity that a program writes without marks has the loudness of the current mark, whichever mark
                # it is close to.
                plain = added < -1 or (added == 0 and mark == UNMARKED_STEP)
                accent[place, step] = _ACCENT if added >= STRESS else 0.0 if plain else accent[place, step]
    if ladder.default is not None and ladder.default not in values:
        cost[ladder.default, MF], accent[ladder.default, MF] = 0.0, 0.0
    marks = np.array([MARKS.get(mark, MF) for mark, _ in ladder.steps])
    further = np.maximum(np.abs(marks[:, None] - marks) - 1, 0)
    change = np.where(np.eye(len(marks), dtype=bool), 0.0, _CHANGE_COST + _FURTHER_COST * further)
    return cost, accent, change


class LadderMarks(NamedTuple):
    """Dynamics of a part, recovered from velocities that a notation program wrote.

    Attributes
    ----------
    marks : (N,) int
        Rows of `DYNAMICS`; -1: the note was written without a mark.
    stressed : (N,) bool
        Mask of notes at a step that does not last: LilyPond stays at *sf* until the next dynamic, players do not.
    accents : (N,) float64
        Loudness of each note above its dynamic.
    """

    marks: IntArray
    stressed: BoolArray
    accents: FloatArray

    def read(self, unmarked: IntArray | None = None) -> tuple[FloatArray, IntArray]:
        """Return the loudness (N,) 0..1 of every note, and the row (N,) in `DYNAMICS` of its dynamic.

        Parameters
        ----------
        unmarked : (N,) int, optional
            Dynamic of each note without one of its own; by default that of the previous note.
        """
        if unmarked is None:
            known = np.maximum.accumulate(np.where(self.marks < 0, -1, np.arange(len(self.marks))))
            unmarked = np.where(known < 0, MF, self.marks[np.maximum(known, 0)])
        marks = np.where(self.marks < 0, unmarked, self.marks)
        # The first of several stressed notes has an accent.
        first = self.stressed & ~np.concatenate(([False], self.stressed[:-1]))
        more = np.where(self.stressed, np.where(first, _ACCENT, 0.0), self.accents)
        return np.clip(LEVELS[marks] + more, 0.0, 1.0), marks


def ladder_marks(velocity: IntArray, name: str, program: int | None, whole_range: bool) -> LadderMarks:
    """Read the dynamics of a part from velocities (N,) that the notation program ``name`` wrote."""
    return _along(velocity.astype(np.uint8).tobytes(), name, program, whole_range)


@lru_cache(maxsize=128)
def _along(velocities: bytes, name: str, program: int | None, whole_range: bool) -> LadderMarks:
    """Read the dynamics of a part as the cheapest sequence of dynamics in the program's table of velocities, where each
    change has a cost; cached, since most edits change no velocity.
    """
    velocity = np.frombuffer(velocities, np.uint8).astype(np.int64)
    program = _written_as(name, _levels(velocity), program, whole_range)
    cost, accent, change = _costs(name, program)
    edges = np.flatnonzero(np.append(True, velocity[1:] != velocity[:-1]))
    lengths = np.diff(np.append(edges, len(velocity)))
    paid = cost[velocity[edges]] * lengths[:, None]
    total, back, each = paid[0], np.zeros(paid.shape, np.int64), np.arange(paid.shape[1])
    for run in range(1, len(paid)):
        ways = total[:, None] + change
        back[run] = ways.argmin(axis=0)
        total = ways[back[run], each] + paid[run]
    steps = np.zeros(len(paid), np.int64)
    steps[-1] = int(total.argmin())
    for run in range(len(paid) - 1, 0, -1):
        steps[run - 1] = back[run, steps[run]]
    along = np.repeat(steps, lengths)
    names = np.array([mark for mark, _ in ladder_of(name, program).steps])
    rows = np.array([MARKS.get(mark, -1) for mark in names.tolist()], np.int64)
    return LadderMarks(rows[along], (names == "sf")[along], accent[velocity, along])
