"""Overview of a learned choreography: its basic motions."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.cuts import Cut
from app.choreography.features import POSES, features
from app.choreography.model import ChoreographyModel


@dataclass(frozen=True, eq=False)
class BasicMotion:
    """A state of a choreography.

    Attributes
    ----------
    segments : int
        Number of segments with this state.
    mean_s : float
        Mean length of these segments in seconds.
    sources : tuple of (int, int)
        Indices of sources with their numbers of segments, most segments first.
    poses : (3, 21, 2) float64
        The most typical segment at its start, accent and end, from the front as at the accent: X to the right and Y up
        from the floor below the hips, relative to the body's height.
    """

    segments: int
    mean_s: float
    sources: tuple[tuple[int, int], ...]
    poses: FloatArray


def basic_motions(model: ChoreographyModel) -> tuple[BasicMotion, ...]:
    """Summarise the basic motions of a model in the order of their states; each has at least one segment.

    The most typical segment is the one with `features` nearest to their mean.
    """
    clips = np.array([one.clip for one in model.segments])
    states = np.array([one.state for one in model.segments])
    lengths_s = np.array([(one.end - one.start) / float(model.clips[one.clip].fps) for one in model.segments])
    shapes = np.zeros((len(model.segments), POSES * (len(SEGMENTS) + len(ENDS)) * 3))
    for number, clip in enumerate(model.clips):
        own = np.flatnonzero(clips == number)
        cuts = [Cut(one.start, one.accent, one.end) for one in (model.segments[at] for at in own.tolist())]
        shapes[own] = features(clip, cuts)
    found = []
    for state in range(model.states):
        own = np.flatnonzero(states == state)
        typical = own[np.linalg.norm(shapes[own] - shapes[own].mean(axis=0), axis=1).argmin()]
        poses = shapes[typical].reshape(POSES, len(SEGMENTS) + len(ENDS), 3)[..., :2]
        count = Counter(clips[own].tolist())
        sources = tuple(sorted(count.items(), key=lambda item: (-item[1], item[0])))
        found.append(BasicMotion(len(own), float(lengths_s[own].mean()), sources, poses))
    return tuple(found)
