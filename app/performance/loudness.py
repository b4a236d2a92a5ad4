"""How loud a part plays each note, where a controller says so."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from app.score.model import ControllerCurve, Part

Floats: TypeAlias = npt.NDArray[np.float64]

_SPEAKING = ("breath", "expression", "aftertouch", "volume")
"""Controllers that may carry the dynamics, the most telling first: wind controllers send one of the first three, and
sequencers draw the second or the last."""


def note_loudness(part: Part) -> tuple[float, ...]:
    """Mean loudness 0..1 of every note, by the first controller that moves while notes sound.

    A controller that is set once is a mixer's level and says nothing about playing; empty if no controller speaks.
    """
    curve = speaking_curve(part)
    if curve is None:
        return ()
    onsets, ends = _spans(part)
    return tuple(np.clip(_means(curve, onsets, ends), 0.0, 1.0).tolist())


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
    ticks = np.asarray(curve.ticks, np.float64)
    values = np.asarray(curve.values, np.float64)
    area = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(ticks))])

    def integral(at: Floats) -> Floats:
        step = np.clip(np.searchsorted(ticks, at, side="right") - 1, 0, None)
        result: Floats = area[step] + values[step] * (at - ticks[step])
        return result

    means: Floats = (integral(ends) - integral(starts)) / (ends - starts)
    return means
