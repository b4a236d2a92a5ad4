"""Loudness of each note of a part, and its breath if a controller recorded it."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.identity_cache import IdentityCache
from app.plan.music.breath_controller import STOPS_AT, step_means
from app.plan.music.dynamics_from_velocities import (
    Velocities,
    VelocityReading,
    is_level,
    levels_in_force,
    nearest_marks,
    phrase_levels,
    read_dynamics,
)
from app.plan.music.piece import MEZZOFORTE, ControllerInput, ControllerSteps
from app.plan.music.velocity_ladders import DYNAMICS
from app.plan.music.written_dynamics import NONE_WRITTEN, WrittenDynamics
from app.score.marks import ACCENT_SHARES
from app.score.model import ControllerCurve, Part

_SPEAKING = ("breath", "expression", "aftertouch", "volume")
"""Controllers that may represent dynamics, most significant first: wind controllers send one of the first three,
sequencers usually draw the second or the last.
"""
_SCALING: Final = ("expression", "volume")
"""Controllers that scale velocities, as in synthesisers; the others replace them."""


_STEPS: Final[IdentityCache[ControllerSteps]] = IdentityCache(64)
"""Curves of loudness in steps: a minute of a wind controller has ten thousand, and editing a note changes
none of them.
"""


def velocities_of(part: Part) -> Velocities:
    """Velocities of a part; equal after edits that change neither velocities nor onsets."""
    onsets = tuple(note.onset_tick for note in part.notes)
    return Velocities(tuple(note.velocity for note in part.notes), part.program, onsets, part.track)


def unaccented(part: Part) -> Velocities:
    """Velocities of a part, reduced where the score has accents, since an accent is no change of dynamics."""
    found = velocities_of(part)
    stressed = {mark.note_id: share for mark in part.marks if (share := ACCENT_SHARES.get(mark.kind)) is not None}
    if part.source != "score" or not stressed:
        return found
    plain = (round(note.velocity / stressed.get(note.id, 1.0)) for note in part.notes)
    return found._replace(velocities=tuple(plain))


def note_loudness(part: Part, reading: VelocityReading | None = None) -> tuple[float, ...]:
    """Mean loudness 0..1 of every note, from the first controller that changes while notes sound; expression and volume
    scale the velocity. Without such a controller, and for notes that were not blown, the velocity alone counts.

    A controller that is set only once is a mixer level and is ignored.

    Parameters
    ----------
    reading : VelocityReading, optional
        Interpretation of the velocities of the whole piece (`read_velocities`); by default of the part alone.
    """
    curve = speaking_curve(part)
    found = _by_velocity(part, reading) if curve is None else _loudness(part, curve, reading)
    return tuple(found.tolist())


def note_levels(part: Part, reading: VelocityReading | None = None) -> tuple[float, ...]:
    """Loudness of the dynamic in force at every note, if a notation program wrote dynamics as velocities; otherwise
    empty.
    """
    return () if speaking_curve(part) is not None else tuple(levels_in_force(unaccented(part), reading).tolist())


def note_marks(
    part: Part, reading: VelocityReading | None = None, written: WrittenDynamics = NONE_WRITTEN
) -> tuple[str, ...]:
    """Return the dynamic in force at every note, such as ``"mf"``; accents are not dynamics.

    Parameters
    ----------
    written : WrittenDynamics, optional
        Dynamics in the score, which have priority.
    """
    found = _heard_marks(part, reading)
    rows = written.rows_at(np.array([note.onset_tick for note in part.notes], np.float64))
    for index in np.flatnonzero(~np.isnan(rows)).tolist():
        found[index] = DYNAMICS[int(rows[index] + 0.5)][0]
    return tuple(found)


def _heard_marks(part: Part, reading: VelocityReading | None) -> list[str]:
    curve = speaking_curve(part)
    if curve is None:
        marks = read_dynamics(unaccented(part), reading)[1]
    else:
        marks = nearest_marks(phrase_levels(_loudness(part, curve, reading)))
    return [DYNAMICS[mark][0] for mark in marks.tolist()]


def controller_input(part: Part) -> ControllerInput | None:
    """Return the recorded curves of breath, bite and pitch bend of a part; None if none of them changes."""
    breath = speaking_curve(part)
    span = _span(part)
    moving = {
        curve.kind: _steps(curve)
        for curve in part.curves
        if curve.kind in ("bite", "pitch_bend") and span is not None and _moves(_steps(curve), *span)
    }
    if breath is None and not moving:
        return None
    return ControllerInput(
        breath=None if breath is None else _steps(breath), bite=moving.get("bite"), bend=moving.get("pitch_bend")
    )


def speaking_curve(part: Part) -> ControllerCurve | None:
    """Return the controller curve that carries the dynamics of a part; None if there is none."""
    span = _span(part)
    if span is None:
        return None
    for kind in _SPEAKING:
        for curve in part.curves:
            if curve.kind == kind and _moves(_steps(curve), *span) and _means(part, _steps(curve)).max() > 0.0:
                return curve
    return None


def sounding_curve(part: Part) -> ControllerCurve | None:
    """Return the loudness curve of a part as it is heard; notes that were not blown have the loudness of their
    velocity. None if there is no curve.
    """
    curve = speaking_curve(part)
    if curve is None:
        return None
    steps = _steps(curve)
    means = _means(part, steps)
    silent = np.flatnonzero(means <= STOPS_AT).tolist()
    if not silent:
        return curve
    loudness = _loudness(part, curve, None)
    onsets, ends = (array.astype(np.int64) for array in _spans(part))
    levels = dict(zip(curve.ticks, curve.values, strict=True))
    for index in silent:
        place = int(np.searchsorted(steps.ticks, ends[index], side="right")) - 1
        levels[int(ends[index])] = curve.values[max(place, 0)]
    for index in silent:
        first, last = np.searchsorted(steps.ticks, (onsets[index], ends[index])).tolist()
        for tick in curve.ticks[first:last]:
            levels.pop(tick, None)
    for index in silent:
        levels[int(onsets[index])] = float(loudness[index])
    ticks = sorted(levels)
    return ControllerCurve(curve.kind, tuple(ticks), tuple(levels[tick] for tick in ticks))


def _loudness(part: Part, curve: ControllerCurve, reading: VelocityReading | None) -> FloatArray:
    means: FloatArray = np.clip(_means(part, _steps(curve)), 0.0, 1.0)
    by_velocity = _by_velocity(part, reading)
    if curve.kind in _SCALING and len({note.velocity for note in part.notes}) == 1:
        # If dynamics are given as a curve, velocities are ignored.
        by_velocity = np.full(len(part.notes), MEZZOFORTE)
    blown = np.minimum(means * by_velocity / MEZZOFORTE, 1.0) if curve.kind in _SCALING else means
    played = means > STOPS_AT
    if played.any() and is_level(127.0 * means[played]):
        # The breath curve shapes the notes but contains no dynamics, so velocities determine the level.
        blown = np.clip(by_velocity + means - float(np.median(means[played])), 0.0, 1.0)
    return np.where(played, blown, by_velocity)


def _by_velocity(part: Part, reading: VelocityReading | None) -> FloatArray:
    return read_dynamics(velocities_of(part), reading)[0]


def _steps(curve: ControllerCurve) -> ControllerSteps:
    return _STEPS.step(_arrays, curve)


def _arrays(curve: ControllerCurve) -> ControllerSteps:
    return ControllerSteps(np.asarray(curve.ticks, np.float64), np.asarray(curve.values, np.float64))


def _span(part: Part) -> tuple[float, float] | None:
    """Ticks from the first onset to the last note's end; None without notes."""
    return (float(part.notes[0].onset_tick), float(part.notes[-1].end_tick)) if part.notes else None


def _spans(part: Part) -> tuple[FloatArray, FloatArray]:
    """Return onset and end (N,) of a part's notes in ticks."""
    onsets = np.array([note.onset_tick for note in part.notes], np.float64)
    return onsets, np.array([note.end_tick for note in part.notes], np.float64)


def _moves(steps: ControllerSteps, first: float, last: float) -> bool:
    """Return whether a controller changes its value between the ticks ``first`` and ``last``."""
    start = max(int(np.searchsorted(steps.ticks, first, side="right")) - 1, 0)
    values = steps.values[start : int(np.searchsorted(steps.ticks, last))]
    return len(values) > 0 and bool(np.ptp(values) > 0.0)


def _means(part: Part, steps: ControllerSteps) -> FloatArray:
    """Return the mean value (N,) of a MIDI controller during each note of a part."""
    return step_means(steps.ticks, steps.values, *_spans(part))
