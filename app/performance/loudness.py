"""Loudness of each note of a part, and its breath where a controller recorded it."""

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
"""Controllers that may carry the dynamics, the most telling first: wind controllers send one of the first three, and
sequencers draw the second or the last."""
_SCALING: Final = ("expression", "volume")
"""Controllers that make what the velocities say louder or softer, as in synthesisers; the others take its place."""


_STEPS: Final[IdentityCache[ControllerSteps]] = IdentityCache(64)
"""A minute of a wind controller has ten thousand steps, and an edit of a note changes none of them."""


def velocities_of(part: Part) -> Velocities:
    """The velocities of a part; equal after every edit that changes neither them nor an onset."""
    onsets = tuple(note.onset_tick for note in part.notes)
    return Velocities(tuple(note.velocity for note in part.notes), part.program, onsets, part.track)


def unaccented(part: Part) -> Velocities:
    """The velocities without what accents of the score add to them: an accent is no dynamic."""
    found = velocities_of(part)
    stressed = {mark.note_id: share for mark in part.marks if (share := ACCENT_SHARES.get(mark.kind)) is not None}
    if part.source != "score" or not stressed:
        return found
    plain = (round(note.velocity / stressed.get(note.id, 1.0)) for note in part.notes)
    return found._replace(velocities=tuple(plain))


def note_loudness(part: Part, reading: VelocityReading | None = None) -> tuple[float, ...]:
    """Mean loudness 0..1 of every note, by the first controller that moves while notes sound, expression and volume
    relative to its velocity; by the velocity alone where there is none, or where it was not blown at all (drawn beside
    the recorded bars).

    A controller that is set once is a mixer's level and says nothing about playing.

    Parameters
    ----------
    reading : VelocityReading, optional
        Of the whole piece (`read_velocities`); by default that of the part alone.
    """
    curve = speaking_curve(part)
    found = _by_velocity(part, reading) if curve is None else _loudness(part, curve, reading)
    return tuple(found.tolist())


def note_levels(part: Part, reading: VelocityReading | None = None) -> tuple[float, ...]:
    """Loudness of the dynamic mark in force at every note, where a notation program wrote it as velocities; empty where
    it is unknown."""
    return () if speaking_curve(part) is not None else tuple(levels_in_force(unaccented(part), reading).tolist())


def note_marks(
    part: Part, reading: VelocityReading | None = None, written: WrittenDynamics = NONE_WRITTEN
) -> tuple[str, ...]:
    """The dynamic mark in force at every note: an accent is none.

    Parameters
    ----------
    written : WrittenDynamics, optional
        Dynamics in the score, which win.
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
    """The recorded curves of breath and lips of a part; None if none of them moves."""
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
    """The controller that carries a part's dynamics; None if none does."""
    span = _span(part)
    if span is None:
        return None
    for kind in _SPEAKING:
        for curve in part.curves:
            if curve.kind == kind and _moves(_steps(curve), *span) and _means(part, _steps(curve)).max() > 0.0:
                return curve
    return None


def sounding_curve(part: Part) -> ControllerCurve | None:
    """The loudness curve as it sounds: a note that was not blown at all has the loudness of its velocity."""
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
        # Who draws the dynamics as a curve leaves the velocity as it is.
        by_velocity = np.full(len(part.notes), MEZZOFORTE)
    blown = np.minimum(means * by_velocity / MEZZOFORTE, 1.0) if curve.kind in _SCALING else means
    played = means > STOPS_AT
    if played.any() and is_level(127.0 * means[played]):
        # It shapes the notes and has no dynamics: how loud they are the velocities say.
        blown = np.clip(by_velocity + means - float(np.median(means[played])), 0.0, 1.0)
    return np.where(played, blown, by_velocity)


def _by_velocity(part: Part, reading: VelocityReading | None) -> FloatArray:
    return read_dynamics(velocities_of(part), reading)[0]


def _steps(curve: ControllerCurve) -> ControllerSteps:
    return _STEPS.step(_arrays, curve)


def _arrays(curve: ControllerCurve) -> ControllerSteps:
    return ControllerSteps(np.asarray(curve.ticks, np.float64), np.asarray(curve.values, np.float64))


def _span(part: Part) -> tuple[float, float] | None:
    """Span from the first onset to the last note's end, ticks; None without notes."""
    return (float(part.notes[0].onset_tick), float(part.notes[-1].end_tick)) if part.notes else None


def _spans(part: Part) -> tuple[FloatArray, FloatArray]:
    """Onsets and ends of the notes, ticks."""
    onsets = np.array([note.onset_tick for note in part.notes], np.float64)
    return onsets, np.array([note.end_tick for note in part.notes], np.float64)


def _moves(steps: ControllerSteps, first: float, last: float) -> bool:
    """Return whether a controller has more than one value between two ticks."""
    start = max(int(np.searchsorted(steps.ticks, first, side="right")) - 1, 0)
    values = steps.values[start : int(np.searchsorted(steps.ticks, last))]
    return len(values) > 0 and bool(np.ptp(values) > 0.0)


def _means(part: Part, steps: ControllerSteps) -> FloatArray:
    """Mean over each note."""
    return step_means(steps.ticks, steps.values, *_spans(part))
