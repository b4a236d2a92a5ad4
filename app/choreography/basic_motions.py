"""Basic motions: classes of motions with similar poses, found by k-means (H2)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from sklearn.cluster import KMeans

from app.arrays import FloatArray, IntArray

SPREAD: Final = 0.09
"""Spread for which the fewest basic motions are chosen, unless a number is given: root mean square distance of motions
from their mean over poses and points of the body, relative to the body's height (15 cm at 1.7 m). The silhouette is
unsuitable: dance is a continuum, and of the CMU clips it always prefers two classes.
"""
LEAST_MOTIONS: Final = 3
"""Least number of motions per basic motion, since fewer cannot be counted."""
STARTS: Final = 8
"""Runs of k-means; the best result counts."""


def classify(
    features: FloatArray, states: int | None, seed: int, proceed: Callable[[], None] = lambda: None
) -> IntArray:
    """Assign each motion to a basic motion.

    Parameters
    ----------
    features : (S, D) float64
        See `app.choreography.features`; in time order.
    states : int or None
        Number of basic motions; None to choose it by `SPREAD` and `LEAST_MOTIONS`.
    proceed : callable
        Called before each run of k-means; an exception raised by it stops the work.

    Returns
    -------
    (S,) int64
        Numbers in the order of first appearance, all used. Exactly equal for equal features and seed on any number of
        cores. Fewer than `states` if fewer motions differ.
    """
    differ = len(np.unique(features, axis=0))
    if states is not None:
        proceed()
        return _k_means(features, min(states, differ), seed)[0]
    fewest, most = 1, max(1, min(differ, len(features) // LEAST_MOTIONS))
    # The spread decreases as the number of classes increases, unless k-means finds a poor solution.
    while fewest < most:
        proceed()
        middle = (fewest + most) // 2
        if _k_means(features, middle, seed)[1] <= SPREAD:
            most = middle
        else:
            fewest = middle + 1
    proceed()
    return _k_means(features, most, seed)[0]


def _k_means(features: FloatArray, states: int, seed: int) -> tuple[IntArray, float]:
    """Divide motions with the given features (S, D) into ``states`` classes by k-means. Returns the class (S,) of each,
    numbered by first appearance, and the spread about the class means (see `SPREAD`).
    """
    if not len(features):
        return np.zeros(0, np.int64), 0.0
    # scikit-learn uses NumPy's legacy generator, which accepts seeds of 32 bits.
    found = KMeans(states, n_init=STARTS, random_state=seed % 2**32).fit(features)
    _, first, classes = np.unique(found.labels_, return_index=True, return_inverse=True)
    by_appearance = np.argsort(np.argsort(first))
    # Inertia sums over the three coordinates of each point.
    spread = np.sqrt(3.0 * found.inertia_ / features.size)
    return np.asarray(by_appearance[classes], np.int64), float(spread)
