"""Dynamics from note velocities: the ladders of notation programs, and the piece's own distribution.

A notation program writes every dynamic mark as one velocity, and each program has its own: *forte* is 96 in MuseScore,
88 in Finale, 95 in LilyPond and 66 in LilyPond's flutes. Which ladder a piece was written with is recognised by all its
velocities together (`read_velocities`). What was played has no ladder: its levels are those of the piece's own
distribution.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.music.velocity_ladders import (
    DYNAMICS,
    LADDERS,
    LILYPOND,
    LILYPOND_RANGES,
    SHARES,
    UNMARKED_STEP,
    articulated,
    ladder_of,
)

MEZZOFORTE: Final = 0.63
"""Loudness 0..1 of mezzoforte: MIDI velocity 80 of 127."""
LEVELS: Final[FloatArray] = np.array([MEZZOFORTE if mark == "mf" else at / 127.0 for mark, at in DYNAMICS])
"""(8,): loudness of each mark, the softest first."""
_BETWEEN: Final[FloatArray] = (LEVELS[1:] + LEVELS[:-1]) / 2.0
_LOUDEST_FROM: Final = 123.5 / 127.0
"""Loudness from which on a velocity without a ladder is *fff*: hardly any music for winds asks for it."""
_MARKS: Final = {mark: index for index, (mark, _) in enumerate(DYNAMICS)}
_MF: Final = _MARKS["mf"]

STROKES: Final = 5
"""In a line of more than four times as many notes, one that differs from so many around it is no dynamic."""
UNMEANT_SPREAD: Final = 16.0
"""Velocities between the 10th and 90th percentile of notes played equally loud (a standard deviation of 6)."""
MEANT_SPREAD: Final = 32.0
"""From here on the velocities are dynamics: two marks apart."""

DEFAULTS: Final = frozenset({64, 80, 90, 96, 100, 127})
"""Velocities that programs write where the music has no dynamics."""
UNMARKED: Final = 0.95
"""This share of a part without dynamic marks has the default, or what articulations make of it."""
MOST_OFTEN: Final = 0.3
"""A default that so many of the notes have is the level without dynamics."""
RUN, SHARED, APART = 3, 0.3, 4
"""Levels are written, not played, where this share of the notes stands in runs of so many alike, or where they are so
many velocities apart."""
MOST_SHIFT: Final = 7.0
"""So many velocities the middle of what is played goes towards mezzoforte: not half a mark."""
USUAL_RANGE: Final = (49.0, 96.0)
"""*Piano* to *forte*: the middle of a piece lies there, however hard its keys were struck."""


_OWN_RANGE: Final = 6.0
"""By so much (a logarithm of likelihood) another instrument's range must explain a part better than its own; that of no
instrument a whole piece."""
_PASSED: Final = 0.1
"""Share of the notes that stand at the end of a hairpin which leads to no mark."""


class VelocityReading(msgspec.Struct, frozen=True):
    """A reading of the velocities of a piece.

    Attributes
    ----------
    ladder : str
        Name of the program whose ladder they are; empty: none.
    marked : bool
        Whether the ladder's levels are marks: a piece that is all at the default level has none.
    usual : float
        Median velocity of what has no ladder.
    meant : float
        How far, 0..1, its levels are dynamics.
    shift : float
        Velocities to add before its levels are compared with `DYNAMICS`.
    whole_range : bool
        LilyPond wrote all parts in the range of no instrument: their programs were given to them afterwards.
    """

    ladder: str = ""
    marked: bool = True
    usual: float = 80.0
    meant: float = 0.0
    shift: float = 0.0
    whole_range: bool = False


def read_velocities(parts: Iterable[tuple[Sequence[int] | IntArray, int | None]]) -> VelocityReading:
    """Return the reading of the velocities of all parts of a piece together.

    Parameters
    ----------
    parts : iterable of (velocities (N,), General MIDI program from 0 or None)
        Notes in order.
    """
    given = [(np.asarray(velocities, np.int64), program) for velocities, program in parts if len(velocities)]
    if not given:
        return VelocityReading()
    written = [(velocities, program) for velocities, program in given if _engraved(velocities)]
    levels = [(_levels(velocities), program) for velocities, program in written]
    alone = {int(velocity) for values, _ in given for velocity in np.unique(values)}
    if len(alone) == 1 and alone <= DEFAULTS:
        return VelocityReading("", marked=False)
    ladder, whole_range = _recognised(levels)
    if ladder and len(written) == len(given) and _unmarked(ladder, written, whole_range):
        return VelocityReading(ladder, marked=False)
    unread = given if not ladder else [one for one in given if not any(one[0] is other for other, _ in written)]
    usual, meant, shift = _distribution([velocities for velocities, _ in unread], constant=len(alone) == 1)
    return VelocityReading(ladder, True, usual, meant, shift, whole_range)


def _engraved(velocity: IntArray) -> bool:
    """Decide whether a part's velocities are levels that notes share, not strokes of a hand."""
    edges = np.flatnonzero(np.append(True, velocity[1:] != velocity[:-1]))
    lengths = np.diff(np.append(edges, len(velocity)))
    if lengths[lengths >= RUN].sum() >= SHARED * len(velocity):
        return True
    values, counts = np.unique(velocity, return_counts=True)
    common = values[counts > len(velocity) * 0.02]
    return len(velocity) < 2 * STROKES or (len(common) * 4 <= len(velocity) and bool((np.diff(common) >= APART).all()))


def _levels(velocity: IntArray) -> dict[int, int]:
    """Velocities at which the music stays, with the number of their notes; hairpins pass through all others."""
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


def _recognised(levels: Sequence[tuple[dict[int, int], int | None]]) -> tuple[str, bool]:
    """Name of the ladder that explains the levels best, and whether it does so in the whole range; empty where any
    velocity would do as well."""
    best, name, whole = 0.0, "", False
    for one in LADDERS:
        total = ladder_of(one, None).usual
        for found, program in levels:
            wrote = _written_as(one, found, program)
            total += _gain(one, wrote, found) - (_OWN_RANGE if wrote != program else 0.0)
        if total > best:
            best, name, whole = total, one, False
    if any(program in LILYPOND_RANGES for _, program in levels):
        total = sum(_gain(LILYPOND, None, found) for found, _ in levels) - _OWN_RANGE
        if total > best:
            return LILYPOND, True
    return name, whole


def _gain(name: str, program: int | None, levels: dict[int, int]) -> float:
    """Return how much likelier the levels of a part are on a ladder than anywhere, as a logarithm."""
    gains = _gains(name, program)
    return sum(gains[value] * math.log1p(count) for value, count in levels.items())


def _written_as(name: str, levels: dict[int, int], program: int | None, whole_range: bool = False) -> int | None:
    """The program in whose range LilyPond wrote a part: its own, or that of an instrument it was written for before."""
    if name != LILYPOND:
        return program
    if whole_range:
        return None
    own = _gain(name, program, levels) + _OWN_RANGE
    other = max((None, *LILYPOND_RANGES), key=lambda one: _gain(name, one, levels))
    return other if _gain(name, other, levels) > own else program


@lru_cache(maxsize=128)
def _gains(name: str, program: int | None) -> tuple[float, ...]:
    """(128,): logarithm of how much likelier each velocity is on a ladder than anywhere."""
    ladder = ladder_of(name, program)
    likely = np.full(128, 0.05 / 60.0)
    for mark, velocity in ladder.steps:
        for more, share in articulated(ladder, velocity):
            for off, near in ((0, 0.9), (-1, 0.05), (1, 0.05)):
                place = min(max(velocity + more + off, 0), 127)
                likely[place] += SHARES[mark] * share * near
    likely[list(ladder.passed)] += _PASSED / max(len(ladder.passed), 1)
    if ladder.default is not None:
        likely[ladder.default] += 0.1
    return tuple(np.log(likely * 60.0).tolist())


def _unmarked(name: str, written: Sequence[tuple[IntArray, int | None]], whole_range: bool) -> bool:
    """Decide whether all parts stay at what a program writes without dynamic marks, but for articulations and slips."""
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


def _distribution(unread: Sequence[IntArray], constant: bool) -> tuple[float, float, float]:
    """Usual level, how far levels are meant, and their shift, of what no ladder explains."""
    if not unread:
        return 80.0, 0.0, 0.0
    several = np.concatenate([_smoothed(velocities) for velocities in unread])
    usual = float(np.median(several))
    low, high = np.percentile(several, [10, 90])
    meant = float(np.clip((high - low - UNMEANT_SPREAD) / (MEANT_SPREAD - UNMEANT_SPREAD), 0.0, 1.0))
    if constant:
        # One velocity that no program writes by itself was set by a person.
        return usual, 1.0, 0.0
    if len(several) < 4 * STROKES:
        return usual, meant, 0.0
    inside = float(np.clip(usual, *USUAL_RANGE))
    shift = inside - usual + float(np.clip((80.0 - inside) / 2.0, -MOST_SHIFT, MOST_SHIFT))
    values, counts = np.unique(np.concatenate(list(unread)), return_counts=True)
    most = int(values[counts.argmax()])
    if most in DEFAULTS and counts.max() >= MOST_OFTEN * counts.sum():
        shift = 80.0 - most
    return usual, meant, shift


def is_level(velocity: FloatArray) -> bool:
    """Return whether notes (N,), enough to judge by, spread no more than the strokes of a hand that plays one level."""
    if len(velocity) < 4 * STROKES:
        return False
    low, high = np.percentile(_smoothed(velocity), [10, 90])
    return bool(high - low < UNMEANT_SPREAD)


def _smoothed(velocity: IntArray | FloatArray) -> FloatArray:
    """(M,): medians of several notes, or the velocities of a short line."""
    if len(velocity) < 4 * STROKES:
        return velocity.astype(np.float64)
    return np.median(np.lib.stride_tricks.sliding_window_view(velocity, STROKES), axis=1)


def velocity_loudness(
    velocity: IntArray, program: int | None = None, reading: VelocityReading | None = None
) -> FloatArray:
    """Loudness 0..1 by velocities (N,) alone.

    On a ladder each note has the loudness of its mark, a little more with an accent, and what lies between in a
    hairpin. Otherwise the differences between the strokes of one hand say nothing about dynamics: the level, and how
    much louder or softer than usual a note is, count as far as the velocities of several notes together spread beyond
    them.

    Parameters
    ----------
    reading : VelocityReading, optional
        Of the whole piece; by default that of these velocities alone.
    """
    return _read(velocity, program, reading)[0]


def velocity_marks(
    velocity: IntArray, program: int | None = None, reading: VelocityReading | None = None
) -> tuple[str, ...]:
    """The dynamic mark in force at each note, by velocities (N,); an accent is none."""
    return tuple(DYNAMICS[mark][0] for mark in _read(velocity, program, reading)[1].tolist())


def _read(velocity: IntArray, program: int | None, reading: VelocityReading | None) -> tuple[FloatArray, IntArray]:
    if not len(velocity):
        return np.zeros(0), np.zeros(0, np.int64)
    found = _known(np.clip(velocity, 0, 127).astype(np.uint8).tobytes(), program, reading)
    return found[0].copy(), found[1].copy()


@lru_cache(maxsize=128)
def _known(velocities: bytes, program: int | None, reading: VelocityReading | None) -> tuple[FloatArray, IntArray]:
    """Kept, since most edits change no velocity."""
    velocity = np.frombuffer(velocities, np.uint8).astype(np.int64)
    reading = read_velocities([(velocity, program)]) if reading is None else reading
    plain = not reading.ladder and int(velocity[0]) in DEFAULTS and bool((velocity == velocity[0]).all())
    if plain or not reading.marked:
        accents = velocity - float(np.median(velocity))
        if reading.ladder:
            accents[np.abs(accents) < _STRESS] = 0.0
        return np.clip(MEZZOFORTE + accents / 127.0, 0.0, 1.0), np.full(len(velocity), _MF)
    if reading.ladder and _engraved(velocity):
        written = _written_as(reading.ladder, _levels(velocity), program, reading.whole_range)
        return _on_ladder(velocity, reading.ladder, written)
    return _by_distribution(velocity, reading)


def _by_distribution(velocity: IntArray, reading: VelocityReading) -> tuple[FloatArray, IntArray]:
    """Loudness and marks of what was played, or written with unknown levels."""
    unmeant = (1.0 - reading.meant) * UNMEANT_SPREAD / 2.0
    level = MEZZOFORTE + reading.meant * ((reading.usual + reading.shift) / 127.0 - MEZZOFORTE)
    stroke = velocity - reading.usual
    accent: FloatArray = np.sign(stroke) * np.maximum(np.abs(stroke) - unmeant, 0.0)
    loudness: FloatArray = np.clip(level + accent / 127.0, 0.0, 1.0)
    return loudness, nearest_marks(phrase_levels(loudness))


def phrase_levels(loudness: FloatArray) -> FloatArray:
    """(N,): the loudness of several notes around each: an accent is no dynamic."""
    if len(loudness) < 4 * STROKES:
        return loudness
    padded = np.pad(loudness, STROKES // 2, mode="edge")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, STROKES), axis=1))


def nearest_marks(loudness: FloatArray) -> IntArray:
    """(N,): the rows in `DYNAMICS` of the marks nearest to each loudness 0..1."""
    between = np.append(_BETWEEN[:-1], _LOUDEST_FROM)
    return np.asarray(np.searchsorted(between, loudness), np.int64)


_STRESS: Final = 12
"""An articulation that adds so much is an accent; less is staccato's."""
_ACCENT: Final = 0.16
"""Loudness that an accent adds, 0..1: about a mark."""
_CHANGE_COST, _FURTHER_COST = 0.8, 0.15
"""Cost of a change of level, and of each mark more that it goes."""
_NEAR_COST, _OFF_COST, _STEP_COST, _MOST_COST = 0.6, 1.2, 0.6, 3.0
"""Cost of a note whose velocity is beside the step, or off it (more for every mark away, at most so much)."""
_ARTICULATION_COST, _ADDED_COST = 0.25, 0.03
"""What a note costs that an articulation makes louder, and each velocity that this adds."""
_MARK_COST = _CHANGE_COST
"""Cost of a note with the velocity of a mark that is read as an articulation of one without a mark, at least."""


@lru_cache(maxsize=64)
def _costs(name: str, program: int | None) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(128, S) each: cost and accent of every velocity on every step of a ladder; (S, S): cost of a change."""
    ladder = ladder_of(name, program)
    values = np.array([velocity for _, velocity in ladder.steps])
    loud = np.array([LEVELS[_MARKS.get("fff" if mark == "sf" else mark, _MF)] for mark, _ in ladder.steps])
    has = np.array([mark != UNMARKED_STEP for mark, _ in ladder.steps])
    between = np.interp(np.arange(128), values[has], loud[has])
    cost = np.minimum(_OFF_COST + _STEP_COST * np.abs(between[:, None] - loud) / 0.126, _MOST_COST)
    accent = np.clip(between[:, None] - np.where(has, loud, between[values]), -_ACCENT, _ACCENT)
    for step, (mark, velocity) in enumerate(ladder.steps):
        more = [added for added, _ in articulated(ladder, velocity)]
        rows = [(added, _ARTICULATION_COST + _ADDED_COST * abs(added)) for added in more[1:]]
        # A hairpin passes by the level without a mark.
        if mark == UNMARKED_STEP:
            # What a mark has exactly is rather that mark than an articulation of what has none.
            rows = [(added, max(paid, _MARK_COST) if velocity + added in values[has] else paid) for added, paid in rows]
        near = () if mark == UNMARKED_STEP else ((-1, _NEAR_COST), (1, _NEAR_COST))
        for added, paid in (*near, *rows, (0, 0.0)):
            place = min(max(velocity + added, 0), 127)
            if paid <= cost[place, step]:
                cost[place, step] = paid
                # What a program writes without a mark is as loud as the mark in force, whatever its number is near.
                plain = added < -1 or (added == 0 and mark == UNMARKED_STEP)
                accent[place, step] = _ACCENT if added >= _STRESS else 0.0 if plain else accent[place, step]
    if ladder.default is not None and ladder.default not in values:
        cost[ladder.default, _MF], accent[ladder.default, _MF] = 0.0, 0.0
    marks = np.array([_MARKS.get(mark, _MF) for mark, _ in ladder.steps])
    further = np.maximum(np.abs(marks[:, None] - marks) - 1, 0)
    change = np.where(np.eye(len(marks), dtype=bool), 0.0, _CHANGE_COST + _FURTHER_COST * further)
    return cost, accent, change


def _on_ladder(velocity: IntArray, name: str, program: int | None) -> tuple[FloatArray, IntArray]:
    """Loudness and marks on a ladder: the cheapest way along its steps, where each change of level costs."""
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
    more = accent[velocity, along]
    marks = np.array([_MARKS.get(mark, -1) for mark, _ in ladder_of(name, program).steps], np.int64)[along]
    stressed = np.array([mark == "sf" for mark, _ in ladder_of(name, program).steps])[along]
    if (marks < 0).any():
        marks, more = _carried(marks, stressed, more)
    return np.clip(LEVELS[marks] + more, 0.0, 1.0), marks


def _carried(marks: IntArray, stressed: BoolArray, more: FloatArray) -> tuple[IntArray, FloatArray]:
    """Give notes without a mark of their own (-1) the mark before them, and the first of some stressed ones an accent:
    LilyPond stays at a *sf* until the next mark, players do not; and it plays a voice without marks at its default."""
    unmarked = marks < 0
    first = stressed & ~np.insert(stressed[:-1], 0, False)
    known = np.maximum.accumulate(np.where(unmarked, -1, np.arange(len(marks))))
    level = np.where(known < 0, _MF, marks[np.maximum(known, 0)])
    return level, np.where(stressed, np.where(first, _ACCENT, 0.0), more)
