"""Curves of lip tension and air within notes, sampled from a recording or following the score's dynamics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class SampledCurves:
    """Sampled curves of lips and air within notes, 0..1; the end values extend outwards.

    Fields as in `EmbouchureEvent`, which has the means over notes.

    Attributes
    ----------
    start_s, step_s : float
        Sample k is at ``start_s + k * step_s``; ``start_s`` is a multiple of the step.
    tension : (K,) float64
        Lip tension at each sample.
    air, effort : (K,) float64 or None
        Air and effort at each sample; None if no breath was recorded.
    recorded : bool
        Whether they were recorded by a player, including vibrato; otherwise they follow the dynamics of the score.
    """

    start_s: float
    step_s: float
    tension: FloatArray
    air: FloatArray | None = None
    effort: FloatArray | None = None
    recorded: bool = True

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing plans."""
        if not isinstance(other, SampledCurves):
            return NotImplemented
        return (
            (self.start_s, self.step_s, self.recorded) == (other.start_s, other.step_s, other.recorded)
            and np.array_equal(self.tension, other.tension)
            and _same(self.air, other.air)
            and _same(self.effort, other.effort)
        )

    __hash__ = None  # type: ignore[assignment]


def _same(one: FloatArray | None, other: FloatArray | None) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one, other))
