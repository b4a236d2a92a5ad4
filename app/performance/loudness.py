"""How loud a part plays each note and how it was blown, where a controller says so."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from app.plan.heard import STOPS_AT, step_means
from app.plan.line import Heard, Steps, velocity_loudness
from app.score.model import ControllerCurve, Part

Floats: TypeAlias = npt.NDArray[np.float64]

_SPEAKING = ("breath", "expression", "aftertouch", "volume")
"""Controllers that may carry the dynamics, the most telling first: wind controllers send one of the first three, and
sequencers draw the second or the last."""


def note_loudness(part: Part) -> tuple[float, ...]:
    """Mean loudness 0..1 of every note, by the first controller that moves while notes sound; by its velocity where it
    was not blown at all (drawn beside the recorded bars).

    A controller that is set once is a mixer's level and says nothing about playing; empty if no controller speaks.
    """
    curve = speaking_curve(part)
    if curve is None:
        return ()
    onsets, ends = _spans(part)
    means = np.clip(_means(curve, onsets, ends), 0.0, 1.0)
    silent = means <= STOPS_AT
    if silent.any():
        means[silent] = velocity_loudness(np.array([note.velocity for note in part.notes]))[silent]
    return tuple(means.tolist())


def heard(part: Part) -> Heard | None:
    """The curves that tell how a part was blown and what the lips did; None if none of them moves."""
    breath = speaking_curve(part)
    lips = {curve.kind: curve for curve in part.curves if curve.kind in ("bite", "pitch_bend")}
    onsets, ends = _spans(part)
    moving = {
        kind: _steps(curve) for kind, curve in lips.items() if len(onsets) and _moves(curve, onsets[0], ends.max())
    }
    if breath is None and not moving:
        return None
    return Heard(
        breath=None if breath is None else _steps(breath), bite=moving.get("bite"), bend=moving.get("pitch_bend")
    )


def _steps(curve: ControllerCurve) -> Steps:
    return Steps(np.asarray(curve.ticks, np.float64), np.asarray(curve.values, np.float64))


def speaking_curve(part: Part) -> ControllerCurve | None:
    """The controller that carries a part's dynamics; None if none does."""
    onsets, ends = _spans(part)
    for kind in _SPEAKING:
        for curve in part.curves:
            if (
                curve.kind == kind
                and len(onsets)
                and _moves(curve, onsets[0], ends[-1])
                and _means(curve, onsets, ends).max() > 0.0
            ):
                return curve
    return None


def _spans(part: Part) -> tuple[Floats, Floats]:
    """Onsets and ends of the notes, ticks."""
    onsets = np.array([note.onset_tick for note in part.notes], np.float64)
    return onsets, np.array([note.end_tick for note in part.notes], np.float64)


def _moves(curve: ControllerCurve, first: float, last: float) -> bool:
    """Whether it takes more than one value between two ticks."""
    ticks = np.asarray(curve.ticks)
    start = max(int(np.searchsorted(ticks, first, side="right")) - 1, 0)
    return len(set(curve.values[start : int(np.searchsorted(ticks, last))])) > 1


def _means(curve: ControllerCurve, starts: Floats, ends: Floats) -> Floats:
    """Mean of a step function over spans; before its first tick it has its first value."""
    return step_means(np.asarray(curve.ticks, np.float64), np.asarray(curve.values, np.float64), starts, ends)
