"""Detection of copies among motions: a take added twice, a trimmed or filtered one, or a loop.

Dancers do not repeat several consecutive motions that exactly: among 182 motions of salsa the two most similar are 6 cm
apart.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.cuts import Cut
from app.choreography.features import features
from app.choreography.model import ChoreographyModel

COPIES: Final = 0.01
"""Root mean square distance of two motions over poses and points of the body, relative to the body's height, up to
which they may be copies.
"""
ON_END: Final = 4
"""Number of consecutive similar motions that indicate copies."""
MOST_PAIRS: Final = 5_000_000
"""Number of similar pairs above which a model consists of one repeated motion."""
_DIRECTIONS: Final = 8
"""Number of directions in which distances are bounded before they are calculated."""


def groups_of_copies(model: ChoreographyModel) -> IntArray:
    """For each of S motions of a model the number (S,) of its group; copies of each other have the same number."""
    clips = np.array([one.clip for one in model.segments], np.int64)
    order = np.argsort(clips, kind="stable")
    groups = np.zeros(len(order), np.int64)
    found = np.concatenate([_features(model, clip) for clip in range(len(model.clips))])
    groups[order] = _groups(found, clips[order])
    return groups


def _groups(found: FloatArray, clips: IntArray) -> IntArray:
    """Group S motions by their features (S, D): the group (S,) of each, equal for copies of each other; ``clips`` are
    the clips of the motions.
    """
    count = len(found)
    # Points have three coordinates.
    most = COPIES * np.sqrt(found.shape[1] / 3.0)
    centred = found - found.mean(axis=0)
    directions = np.linalg.svd(centred[:: max(1, count // 200)], full_matrices=False)[2][:_DIRECTIONS]
    tree = cKDTree(centred @ directions.T)
    if tree.count_neighbors(tree, most) > 2 * MOST_PAIRS:
        return np.zeros(count, np.int64)
    pairs = tree.query_pairs(most, output_type="ndarray").astype(np.int64)
    pairs = pairs[np.linalg.norm(found[pairs[:, 0]] - found[pairs[:, 1]], axis=1) <= most]
    one, other = pairs[_on_end(pairs, clips)].T
    graph = coo_array((np.ones(len(one), bool), (one, other)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def _on_end(pairs: IntArray, clips: IntArray) -> BoolArray:
    """Mask (P,) of the pairs (P, 2) of similar segments that are part of at least `ON_END` consecutive pairs in both
    clips, so that one is a copy of the other.
    """
    order = np.lexsort((pairs[:, 0], pairs[:, 1] - pairs[:, 0]))
    one, other = pairs[order].T
    breaks = (
        (np.diff(other - one) != 0) | (np.diff(one) != 1) | (np.diff(clips[one]) != 0) | (np.diff(clips[other]) != 0)
    )
    starts = np.concatenate([[0], np.flatnonzero(breaks) + 1, [len(one)]])
    lengths = np.diff(starts)
    found = np.zeros(len(pairs), bool)
    found[order] = np.repeat(lengths >= ON_END, lengths)
    return found


def _features(model: ChoreographyModel, clip: int) -> FloatArray:
    cuts = [Cut(one.start, one.accent, one.end) for one in model.segments if one.clip == clip]
    return features(model.clips[clip], cuts)
