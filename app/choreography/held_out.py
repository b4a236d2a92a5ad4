"""Division of a model's motions into those that a test learns from, and those that are held out for it.

Copies prove nothing: a copy of a learned motion is no test, and a motion counts once, however many copies of its take
the model contains. The first part of each take is learned from, so that consecutive motions are divided only once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.copied_takes import takes_of
from app.choreography.model import ChoreographyModel
from app.choreography.near_copies import groups_of_copies
from app.choreography.rhythm import SYMBOLS

_SAME: Final = 0.5
"""Share of a motion that copies cover, and of its sounds that one of them has, above which it is known already."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Motions of a model as evidence.

    Attributes
    ----------
    takes : (S,) int64
        Take of each motion; copies of a take are one.
    starts, ends : (S,) float64
        Place of each motion in its take, 0..1; equal in a take without copies.
    counted : (S,) bool
        False for motions that are known from another copy already.
    copies : int
        Number of clips that are copies of another one.
    """

    takes: IntArray
    starts: FloatArray
    ends: FloatArray
    counted: BoolArray
    copies: int

    def within(self, start: float, stop: float) -> IntArray:
        """Indices (N,) of the counted motions that lie in a part of their take, from ``start`` to before ``stop``
        (0..1). A motion of a copied take that goes beyond it is in neither part.
        """
        return np.flatnonzero(self.counted & (self.starts >= start) & (self.starts < stop) & (self.ends <= stop))


def sounds_of(model: ChoreographyModel) -> FloatArray:
    """Count the strokes of each sound during each of S motions (S, 47)."""
    sounds = np.zeros((len(model.segments), len(SYMBOLS)))
    for at, one in enumerate(model.segments):
        np.add.at(sounds[at], list(one.sounds), 1.0)
    return sounds


def evidence_of(model: ChoreographyModel) -> Evidence:
    """Find copies among the motions of a model, and the place of each motion in its take."""
    clips = np.array([one.clip for one in model.segments], np.int64)
    found = takes_of(model.clips)
    takes, sounds = found.takes[clips], sounds_of(model)
    starts, counted = np.zeros(len(clips)), np.ones(len(clips), bool)
    fps = [float(clip.fps) for clip in model.clips]
    spans_s = np.array([(one.start / fps[one.clip], one.end / fps[one.clip]) for one in model.segments])
    spans_s = spans_s.reshape(-1, 2) + found.shifts_s[clips][:, None]
    for clip in range(len(model.clips)):
        own = np.flatnonzero(clips == clip)
        starts[own] = np.arange(len(own)) / max(len(own), 1)
    ends = starts.copy()
    for take in range(found.takes.max(initial=-1) + 1):
        own = np.flatnonzero(takes == take)
        if len(own) and (found.takes == take).sum() > 1:
            first_s, last_s = spans_s[own, 0].min(), spans_s[own, 1].max()
            starts[own], ends[own] = ((spans_s[own] - first_s) / (last_s - first_s)).T
            counted[own] = _new(spans_s[own], clips[own], sounds[own])
    groups = groups_of_copies(model)
    # A motion copied together with its sounds counts once; other copies are all learned from, or all held out.
    known = np.flatnonzero(counted)
    once = np.unique(np.column_stack([groups, sounds])[known], axis=0, return_index=True)[1]
    counted = np.isin(np.arange(len(clips)), known[once])
    earliest = _earliest(groups, starts)
    return Evidence(takes, earliest, np.where(earliest < starts, earliest, ends), counted, found.copies)


def _new(spans_s: FloatArray, clips: IntArray, sounds: FloatArray) -> BoolArray:
    """Mask (N,) of the motions of a take that no earlier copy contains with the same sounds.

    Parameters
    ----------
    spans_s : (N, 2)
        Start and end of each motion in the take in seconds.
    """
    new = np.zeros(len(spans_s), bool)
    for at, (start_s, end_s) in enumerate(spans_s):
        before = np.flatnonzero(new & (clips != clips[at]))
        common_s = np.minimum(spans_s[before, 1], end_s) - np.maximum(spans_s[before, 0], start_s)
        covering = before[common_s > 0.0]
        both = np.minimum(sounds[covering], sounds[at]).sum(axis=1)
        either = np.maximum(sounds[covering], sounds[at]).sum(axis=1)
        known_s = common_s[common_s > 0.0].sum()
        new[at] = not (known_s > _SAME * (end_s - start_s) and (both >= _SAME * either).any())
    return new


def _earliest(groups: IntArray, places: FloatArray) -> FloatArray:
    """For each of S elements the least place among the elements of its group (S,)."""
    least = np.full(groups.max(initial=0) + 1, np.inf)
    np.minimum.at(least, groups, places)
    return np.asarray(least[groups])
