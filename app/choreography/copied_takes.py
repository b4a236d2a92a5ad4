"""Detection of takes that a model contains several times: a file added twice, trimmed, filtered, repaired or damaged.

Two clips are of the same take if they have equal poses at the same distance in time, over much of the shorter one. Cuts
play no part: damage moves them, so that copies need not consist of the same motions (`app.choreography.near_copies`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree
from scipy.spatial import cKDTree

from app.arrays import FloatArray, IntArray
from app.choreography.clip import MotionClip
from app.choreography.features import facing, joint_points_m, size_m
from app.choreography.near_copies import COPIES, MOST_PAIRS
from app.identity_cache import IdentityCache
from app.rig import quaternion

_EVERY_S: Final = 1.0 / 60.0
"""Time between compared poses in seconds."""
_ASKED: Final = 24
"""Number of compared poses between two whose copies are sought."""
_SHARE: Final = 0.25
"""Share of the sought poses of the shorter clip that must have copies at one distance in time."""
_LEAST: Final = 5
"""Least number of consecutive ones of these poses, which are 0.4 s apart. A dance that repeats a step has single poses
in common with another take.
"""
_BIN: Final = 3
"""Number of compared poses by which the distance in time may vary to either side."""
_DIRECTIONS: Final = 12
"""Number of principal components in which poses are compared."""


@dataclass(frozen=True, eq=False)
class Takes:
    """Takes of which the clips of a model are copies.

    Attributes
    ----------
    takes : (K,) int64
        Number of the take of each clip, from 0.
    shifts_s : (K,) float64
        Time of each clip's first frame in its take in seconds.
    """

    takes: IntArray
    shifts_s: FloatArray

    @property
    def copies(self) -> int:
        """Number of clips that are copies of another one."""
        return len(self.takes) - len(np.unique(self.takes))


def takes_of(clips: Sequence[MotionClip]) -> Takes:
    """Find the takes of which clips are copies."""
    return _FOUND.step(_takes_of, *clips)


_FOUND: Final[IdentityCache[Takes]] = IdentityCache(2)
"""Takes of the models asked about last: every report on a model needs them."""


def _takes_of(*clips: MotionClip) -> Takes:
    count = len(clips)
    takes, shifts_s = np.arange(count), np.zeros(count)
    if count < 2:
        return Takes(takes, shifts_s)
    found = _pairs(clips)
    if found is None:
        return Takes(np.zeros(count, np.int64), shifts_s)
    one, other, votes, lag_s = found
    # The surest pairs link all copies of a take.
    tree = minimum_spanning_tree(coo_array((1.0 / votes, (one, other)), shape=(count, count)).tocsr())
    lags = {(i, j): lag for i, j, lag in zip(one.tolist(), other.tolist(), lag_s.tolist(), strict=True)}
    for first in range(count):
        if takes[first] != first:
            continue
        order, before = breadth_first_order(tree, first, directed=False)
        for clip in order[1:].tolist():
            linked = int(before[clip])
            lag = lags[linked, clip] if (linked, clip) in lags else -lags[clip, linked]
            takes[clip], shifts_s[clip] = first, shifts_s[linked] - lag
    return Takes(np.asarray(np.unique(takes, return_inverse=True)[1], np.int64), shifts_s)


def _pairs(clips: Sequence[MotionClip]) -> tuple[IntArray, IntArray, FloatArray, FloatArray] | None:
    """Find pairs of clips of the same take: the first clip, the second one, the number of equal poses, and by how many
    seconds a pose is later in the second. None if all motion is one repeated pose.
    """
    poses, numbers, frames = _poses(clips)
    asked = np.concatenate([np.flatnonzero(numbers == clip)[_ASKED::_ASKED] for clip in range(len(clips))])
    # A body that stands has the same pose at any distance in time.
    later = np.minimum(asked + _ASKED // 2, len(poses) - 1)
    most = COPIES * np.sqrt(len(poses[0]) / 3.0)
    centred = poses - poses.mean(axis=0)
    directions = np.linalg.svd(centred[:: max(1, len(poses) // 500)], full_matrices=False)[2][:_DIRECTIONS]
    seen = centred @ directions.T
    asked = asked[np.linalg.norm(poses[later] - poses[asked], axis=1) > 2.0 * most]
    tree, sought = cKDTree(seen), cKDTree(seen[asked])
    if sought.count_neighbors(tree, most) > MOST_PAIRS:
        return None
    near = sought.query_ball_tree(tree, most)
    at = np.repeat(asked, [len(one) for one in near])
    to = np.concatenate([np.array(one, np.int64) for one in near]) if near else np.zeros(0, np.int64)
    apart = numbers[at] < numbers[to]
    at, to = at[apart], to[apart]
    lags = (frames[to] - frames[at]) // _BIN
    # One pose counts once at each distance; distances that lie between two bins count in both.
    rank = np.searchsorted(asked, at)
    rows = np.concatenate([np.column_stack([numbers[at], numbers[to], lags + way, rank]) for way in (0, 1)])
    rows = _on_end(np.unique(rows, axis=0))
    kept, votes = np.unique(rows[:, :3], axis=0, return_counts=True)
    of_clip = np.bincount(numbers[asked], minlength=len(clips))
    enough = votes >= _SHARE * np.minimum(of_clip[kept[:, 0]], of_clip[kept[:, 1]])
    kept, votes = kept[enough], votes[enough]
    order = np.lexsort((-votes, kept[:, 1], kept[:, 0]))
    best = order[np.unique(kept[order][:, :2], axis=0, return_index=True)[1]]
    return kept[best, 0], kept[best, 1], votes[best].astype(np.float64), kept[best, 2] * _BIN * _EVERY_S


def _on_end(rows: IntArray) -> IntArray:
    """Return the rows (N, 4) that are part of at least `_LEAST` consecutive poses (last column) with otherwise equal
    values; rows are sorted.
    """
    starts = np.flatnonzero(np.append(True, (np.diff(rows, axis=0) != (0, 0, 0, 1)).any(axis=1)))
    lengths = np.diff(np.append(starts, len(rows)))
    return rows[np.repeat(lengths >= _LEAST, lengths)] if len(rows) else rows


def _poses(clips: Sequence[MotionClip]) -> tuple[FloatArray, IntArray, IntArray]:
    """Compute the poses of clips as points of a body of height 1 that faces +Z (P, 63), with the clip (P,) of each and
    its number (P,) in it.
    """
    poses, numbers, frames = [], [], []
    for number, clip in enumerate(clips):
        every = max(1, round(float(clip.fps) * _EVERY_S))
        # About the hips: copies may have been put on another floor.
        points = (joint_points_m(clip) - clip.hips_m[:, None])[::every]
        seen = quaternion.rotate(quaternion.conjugate(facing(clip)[::every])[:, None], points) / size_m(clip)
        poses.append(seen.reshape(len(seen), -1))
        numbers.append(np.full(len(seen), number))
        frames.append(np.arange(len(seen)))
    return np.concatenate(poses), np.concatenate(numbers), np.concatenate(frames)
