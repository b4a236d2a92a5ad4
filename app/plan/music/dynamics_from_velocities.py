"""Dynamics from note velocities, by the velocity tables of notation programs or the piece's own distribution.

A notation program writes every dynamic as one velocity, and each program differs: *forte* is 96 in MuseScore, 88 in
Finale, 95 in LilyPond and 66 in LilyPond's flutes. The table (here: ladder) is recognised from all velocities of the
piece (`read_velocities`). Played music has no ladder: its levels come from its own distribution.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray, running_medians
from app.plan.music.ladder_marks import STRESS, STROKES, has_no_marks, is_written, ladder_marks, recognised
from app.plan.music.staff_levels import StaffLevels, staff_levels
from app.plan.music.velocity_ladders import DEFAULTS, LEVELS, MEZZOFORTE, MF

_BETWEEN: Final[FloatArray] = (LEVELS[1:] + LEVELS[:-1]) / 2.0
_LOUDEST_FROM: Final = 123.5 / 127.0
"""Loudness above which a velocity of an unrecognised program is *fff*, which hardly any wind music contains."""
UNMEANT_SPREAD: Final = 16.0
"""Difference of velocity between the 10th and 90th percentile of notes played equally loud (a standard
deviation of 6).
"""
MEANT_SPREAD: Final = 32.0
"""Difference of velocity from which velocities are dynamics: two marks apart."""

MOST_OFTEN: Final = 0.3
"""Share of the notes from which a program's default velocity is the level without dynamics."""
MOST_SHIFT: Final = 7.0
"""Greatest shift of velocities towards mezzoforte: less than half a mark."""
USUAL_RANGE: Final = (49.0, 96.0)
"""Velocities of *piano* and *forte*, between which the middle of a piece is assumed."""


class Velocities(NamedTuple):
    """Velocities of a part.

    Attributes
    ----------
    velocities : (N,) int
        Velocities of the notes in order, 0..127.
    program : int or None
        General MIDI program, from 0.
    onsets : (N,) int
        Ticks of the notes; empty: unknown.
    staff : int
        Number of the staff, equal for parts of one staff.
    """

    velocities: Sequence[int] | IntArray
    program: int | None = None
    onsets: Sequence[int] | IntArray = ()
    staff: int = 0


class VelocityReading(msgspec.Struct, frozen=True):
    """Interpretation of the velocities of a piece.

    Attributes
    ----------
    ladder : str
        Name of the notation program whose table of velocities (ladder) fits the piece; empty: none.
    marked : bool
        Whether the ladder's levels are dynamics; False if everything is at the default level.
    usual : float
        Median velocity of the parts without a ladder.
    meant : float
        Degree, 0..1, to which the levels without a ladder are intended dynamics.
    shift : float
        Velocities to add before levels are compared with `DYNAMICS`.
    whole_range : bool
        Whether LilyPond wrote all parts in its range without instrument, because programs were assigned later.
    levels : StaffLevels or None
        Dynamics in force on every staff, for notes written without one.
    """

    ladder: str = ""
    marked: bool = True
    usual: float = 80.0
    meant: float = 0.0
    shift: float = 0.0
    whole_range: bool = False
    levels: StaffLevels | None = None


def read_velocities(parts: Iterable[Velocities]) -> VelocityReading:
    """Interpret the velocities of all parts of a piece together: as written by a notation program, or as played."""
    given = [part for part in parts if len(part.velocities)]
    reading = _reading(tuple((_array(part.velocities).astype(np.uint8).tobytes(), part.program) for part in given))
    if not reading.ladder or not reading.marked:
        return reading
    on_ladder = [
        (part.staff, _array(part.onsets), ladder_marks(velocity, reading.ladder, part.program, reading.whole_range))
        for part in given
        if len(part.onsets) and is_written(velocity := _array(part.velocities))
    ]
    levels = staff_levels([(staff, onsets, found.marks) for staff, onsets, found in on_ladder])
    return msgspec.structs.replace(reading, levels=levels)


@lru_cache(maxsize=8)
def _reading(parts: tuple[tuple[bytes, int | None], ...]) -> VelocityReading:
    """Interpret the velocities of a piece, without the dynamics of its staves; cached, since most edits change no
    velocity.
    """
    given = [(np.frombuffer(velocities, np.uint8).astype(np.int64), program) for velocities, program in parts]
    alone = {int(velocity) for velocities, _ in given for velocity in np.unique(velocities)}
    if not given or (len(alone) == 1 and alone <= DEFAULTS):
        return VelocityReading(marked=not given)
    written = [part for part in given if is_written(part[0])]
    ladder, whole_range = recognised(written)
    if ladder and len(written) == len(given) and has_no_marks(ladder, written, whole_range):
        return VelocityReading(ladder, marked=False)
    unread = [velocities for velocities, _ in given if not ladder or not is_written(velocities)]
    usual, meant, shift = _distribution(unread, constant=len(alone) == 1)
    return VelocityReading(ladder, True, usual, meant, shift, whole_range)


def _array(values: Sequence[int] | IntArray) -> IntArray:
    return np.asarray(values, np.int64)


def _distribution(unread: Sequence[IntArray], constant: bool) -> tuple[float, float, float]:
    """Interpret velocities that fit no notation program: their usual level, the degree 0..1 to which they are intended
    dynamics, and the shift to add before comparing them with `DYNAMICS`.
    """
    if not unread:
        return 80.0, 0.0, 0.0
    several = np.concatenate([_smoothed(velocities) for velocities in unread])
    usual = float(np.median(several))
    low, high = np.percentile(several, [10, 90])
    meant = float(np.clip((high - low - UNMEANT_SPREAD) / (MEANT_SPREAD - UNMEANT_SPREAD), 0.0, 1.0))
    if constant:
        # A single velocity that no program writes by default was chosen deliberately.
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
    """Return whether velocities (N,) vary no more than the strokes of a player who keeps one dynamic, with enough notes
    to tell.
    """
    if len(velocity) < 4 * STROKES:
        return False
    low, high = np.percentile(_smoothed(velocity), [10, 90])
    return bool(high - low < UNMEANT_SPREAD)


def _smoothed(velocity: IntArray | FloatArray) -> FloatArray:
    """Running medians (M,) of the velocities; a short part is returned unchanged."""
    if len(velocity) < 4 * STROKES:
        return velocity.astype(np.float64)
    return running_medians(velocity, STROKES)


def read_dynamics(part: Velocities, reading: VelocityReading | None = None) -> tuple[FloatArray, IntArray]:
    """Derive the dynamics of a part from its velocities alone: the loudness (N,) 0..1 of every note, and the row (N,)
    in `DYNAMICS` of the dynamic in force.

    If a notation program wrote the velocities, each note has the loudness of its dynamic, slightly more with an accent,
    or a value between two in a hairpin. Otherwise small differences between strokes are ignored: level and deviation
    count as far as the velocities of several notes spread beyond them. Accents are no dynamics.

    Parameters
    ----------
    reading : VelocityReading, optional
        Interpretation of the whole piece; by default of these velocities alone.
    """
    velocity = np.clip(_array(part.velocities), 0, 127)
    if not len(velocity):
        return np.zeros(0), velocity
    reading = read_velocities([part]) if reading is None else reading
    plain = not reading.ladder and int(velocity[0]) in DEFAULTS and bool((velocity == velocity[0]).all())
    if plain or not reading.marked:
        accents = velocity - float(np.median(velocity))
        if reading.ladder:
            accents[np.abs(accents) < STRESS] = 0.0
        return np.clip(MEZZOFORTE + accents / 127.0, 0.0, 1.0), np.full(len(velocity), MF)
    if not reading.ladder or not is_written(velocity):
        return _by_distribution(velocity, reading)
    marks = ladder_marks(velocity, reading.ladder, part.program, reading.whole_range)
    in_force = reading.levels if len(part.onsets) else None
    return marks.read(None if in_force is None else in_force.at(part.staff, _array(part.onsets)))


def levels_in_force(part: Velocities, reading: VelocityReading | None = None) -> FloatArray:
    """Return the loudness 0..1 of the dynamic in force at every note, if a notation program wrote the velocities;
    otherwise empty.

    Parameters
    ----------
    reading : VelocityReading, optional
        As of `read_dynamics`.
    """
    reading = read_velocities([part]) if reading is None else reading
    if not reading.ladder or not is_written(np.clip(_array(part.velocities), 0, 127)):
        return np.zeros(0)
    return np.asarray(LEVELS[read_dynamics(part, reading)[1]])


def _by_distribution(velocity: IntArray, reading: VelocityReading) -> tuple[FloatArray, IntArray]:
    """Return loudness (N,) 0..1 and dynamic level (N,) of notes from their velocities, for played music, or music
    written with unknown levels."""
    unmeant = (1.0 - reading.meant) * UNMEANT_SPREAD / 2.0
    level = MEZZOFORTE + reading.meant * ((reading.usual + reading.shift) / 127.0 - MEZZOFORTE)
    stroke = velocity - reading.usual
    accent: FloatArray = np.sign(stroke) * np.maximum(np.abs(stroke) - unmeant, 0.0)
    loudness: FloatArray = np.clip(level + accent / 127.0, 0.0, 1.0)
    return loudness, nearest_marks(phrase_levels(loudness))


def phrase_levels(loudness: FloatArray) -> FloatArray:
    """Smooth the loudness of notes by a running median (N,), so that single accents do not count as dynamics."""
    if len(loudness) < 4 * STROKES:
        return loudness
    padded = np.pad(loudness, STROKES // 2, mode="edge")
    return running_medians(padded, STROKES)


def nearest_marks(loudness: FloatArray) -> IntArray:
    """Return for each loudness 0..1 the row (N,) in `DYNAMICS` of the nearest dynamic mark."""
    between = np.append(_BETWEEN[:-1], _LOUDEST_FROM)
    return np.asarray(np.searchsorted(between, loudness), np.int64)
