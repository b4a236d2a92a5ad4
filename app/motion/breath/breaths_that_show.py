"""Makes every breath visible: if a nod or lean moves the trunk forward during a breath, the breath's backward lean is
increased.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, Envelopes
from app.plan.model import BreathEvent

SHOWN: Final = 0.8
"""Least backward lean of the trunk in a breath, as a share of the breath's own lean."""
LOOKED_AT: Final = (0.5, 0.625, 0.75, 0.875, 0.97)
"""Examined times of the farthest backward lean, as shares of a breath: in its second half, when the lungs fill."""
LEAST_RAD: Final = 1e-4
"""Leans smaller than this angle in radians are zero."""
BACK_S: Final = 0.6
"""Seconds after the breath within which the trunk returns to its path; see `LEAST_BACK_S`."""
LEAST_BACK_S: Final = 0.15
"""Least time in seconds of that return if the next breath comes earlier than `BACK_S`."""


def leaning_further(
    breaths: Sequence[BreathEvent], full: Curve, torso_rad: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
) -> Envelopes:
    """Return the additional fullness that makes each breath visible, in units of ``full``.

    Parameters
    ----------
    breaths : sequence of BreathEvent
        Breaths of the player.
    full : Curve
        Fullness of the lungs without the addition.
    torso_rad : callable
        Forward lean of the torso (F,) in radians at ascending times (F,): without and with breathing.
    """
    drawn = sorted(
        (event for event in breaths if event.draws_air and event.end_s > event.start_s),
        key=lambda event: event.start_s,
    )
    if not drawn:
        return Envelopes.of(())
    start_s, end_s = (np.array(column) for column in zip(*((one.start_s, one.end_s) for one in drawn), strict=True))
    moments_s = start_s[:, None] + (end_s - start_s)[:, None] * np.array((0.0, *LOOKED_AT))
    ascending_s, places = np.unique(moments_s, return_inverse=True)
    places = places.reshape(moments_s.shape)
    without, with_breath = torso_rad(ascending_s)
    own = _rise((without - with_breath)[places])
    back = _rise(-with_breath[places])
    farthest = back.argmax(axis=1)
    missing = SHOWN * own.max(axis=1) - back.max(axis=1)
    level = _rise(full.sample(ascending_s)[places]).max(axis=1)
    rows = []
    for index in np.flatnonzero((missing > 0.0) & (own.max(axis=1) > LEAST_RAD)).tolist():
        next_s = start_s[index + 1] if index + 1 < len(drawn) else np.inf
        until_s = max(end_s[index] + LEAST_BACK_S, min(end_s[index] + BACK_S, next_s))
        height = missing[index] * level[index] / own[index].max()
        top_s = moments_s[index, 1 + farthest[index]]
        rows.append((start_s[index], top_s, end_s[index], until_s, height))
    return Envelopes.of(rows)


def _rise(values: FloatArray) -> FloatArray:
    """Return the change (N, M) of M values relative to the first value of each row of ``values`` (N, 1 + M)."""
    change: FloatArray = values[:, 1:] - values[:, :1]
    return change
