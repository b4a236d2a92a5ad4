"""Keyframe reduction with linear keys: the frames with keys, their choice, and the values between them.

All programs interpolate linear keys alike: numbers (positions, weights, Euler angles) linearly, quaternions at constant
angular speed. Keys are frames of a clip with their own values, so the values shown at other frames can be computed
here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, SingleArray

KeyChoice = Literal["every", "reduced", "linear"]
"""Frames that get keys: every frame, or as few as keep all errors within a bound, joined by cubics ("reduced") or
straight lines ("linear").
"""
KEY_CHOICES: Final[tuple[KeyChoice, ...]] = ("every", "reduced", "linear")

_LEAST_CHUNK, _MOST_CHUNK, _AT_ONCE = 64, 512, 8192
"""Least and greatest number of consecutive frames in a chunk, and number of values processed at a time over all chunks
and curves.
"""


@dataclass(frozen=True, eq=False)
class Keys:
    """The frames of a clip that have keys, each list ascending from frame 0; a constant curve has one key.

    Attributes
    ----------
    bones : tuple of ndarray of int
        Keys of each bone. Rotation and translation and all axes share them, since Blender merges them and three.js
        pairs them by number.
    morphs : mapping of str to ndarray of int
        Keys of each morph's weight.
    face : ndarray of int
        Keys of all morphs together, for formats that require this.
    pose : ndarray of int or None
        Keys of all bones together, for formats that require this; None for every frame.
    curved : bool
        Whether the keys of `bones` are joined by cubics (`app.formats.cubics`). All other keys are linear.
    """

    bones: tuple[AnyIntArray, ...]
    morphs: Mapping[str, AnyIntArray] = field(default_factory=dict)
    face: AnyIntArray = field(default_factory=lambda: np.zeros(1, np.intp))
    pose: AnyIntArray | None = None
    curved: bool = False

    def beside(self, other: Keys) -> Keys:
        """Return the keys of a skeleton followed by the bones of another one, such as an attached instrument's, which
        has no morphs.
        """
        pose = None if self.pose is None or other.pose is None else np.union1d(self.pose, other.pose)
        return replace(self, bones=self.bones + other.bones, pose=pose)

    def check(self, bones: int, frames: int, morphs: Mapping[str, object]) -> None:
        """Raise ValueError unless the keys fit a clip with these numbers of bones and frames and these morphs: all
        lists ascend from frame 0.
        """
        if len(self.bones) != bones or self.morphs.keys() != morphs.keys():
            raise ValueError("keys of other bones or morphs than the clip's")
        lists = [*self.bones, *self.morphs.values(), self.face, *([] if self.pose is None else [self.pose])]
        for keys in lists:
            if not len(keys) or keys[0] != 0 or keys[-1] >= frames or (np.diff(keys) <= 0).any():
                raise ValueError("keys must be frames of the clip in their order, the first among them")


@dataclass(frozen=True, eq=False)
class KeySpans:
    """Position of frames relative to the keys around them.

    Attributes
    ----------
    before, after : ndarray of int, shape (L, F)
        Key frames before and after each frame: both are the frame itself if it has a key, and the last key after it.
    share : ndarray, shape (L, F)
        Position of a frame between the two, 0..1.
    """

    before: AnyIntArray
    after: AnyIntArray
    share: SingleArray

    @classmethod
    def of(cls, kept: BoolArray) -> KeySpans:
        """Return the spans between the keys of L curves, given as a mask (L, F) of F frames; the first frame must have
        a key."""
        frames = np.arange(kept.shape[1], dtype=np.int32)
        before = np.maximum.accumulate(np.where(kept, frames, 0), axis=1)
        last = before[:, -1:]
        after = np.minimum.accumulate(np.where(kept, frames, last)[:, ::-1], axis=1)[:, ::-1]
        after = np.maximum(after, before)
        share = (frames - before) / np.maximum(after - before, 1).astype(np.float32)
        return cls(before, after, np.where(after > before, share, np.float32(0.0)))

    def at(self, frames: AnyIntArray) -> KeySpans:
        """Return the position of only the given frames (K,) relative to their keys."""
        return KeySpans(self.before[:, frames], self.after[:, frames], self.share[:, frames])

    def row(self, row: int) -> KeySpans:
        """Return the spans of the curve with the index ``row`` alone, as arrays with one row."""
        return KeySpans(self.before[row, None], self.after[row, None], self.share[row, None])

    def straight(self, values: AnyFloatArray) -> FloatArray:
        """Return the values (L, F, D) of L curves with D components, linearly interpolated between the keys."""
        rows = np.arange(len(values))[:, None]
        first, last = values[rows, self.before], values[rows, self.after]
        return np.asarray(first + (last - first) * self.share[..., None], np.float64)

    def turned(self, rotations: AnyFloatArray) -> FloatArray:
        """Return the unit quaternions (L, F, 4) of L curves, interpolated between the keys by the shorter way."""
        rows = np.arange(len(rotations))[:, None]
        return slerp(rotations[rows, self.before], rotations[rows, self.after], self.share[..., None])


def slerp(a: AnyFloatArray, b: AnyFloatArray, share: AnyFloatArray) -> FloatArray:
    """Interpolate between unit quaternions (..., 4) by the shorter way; ``share`` (..., 1) is 0 at ``a``."""
    cosine = np.einsum("...i,...i->...", a, b)[..., None]
    b = np.where(cosine < 0.0, -b, b)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    near = sine < 1e-6
    safe = np.where(near, 1.0, sine)
    of_a = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / safe)
    of_b = np.where(near, share, np.sin(share * angle) / safe)
    return np.asarray(of_a * a + of_b * b)


def straight_keys(values: AnyFloatArray) -> BoolArray:
    """Choose few keys such that straight lines through them deviate by at most 1 in any number.

    Parameters
    ----------
    values : ndarray, shape (L, F, D)
        Curves of D numbers each, divided by the tolerance.

    Returns
    -------
    ndarray of bool, shape (L, F)
        Mask of keys; includes the first frame, and the last unless the curve stays near its first value.

    Notes
    -----
    Lines from a key that are within the tolerance of all frames so far have slopes in an interval; the next key is the
    last frame before the interval becomes empty (the "swing door" of P. A. Bristol, US patent 4669097, 1987, with keys
    on the curve). All curves are processed at once in chunks of frames, whose borders are keys that are removed
    afterwards if not needed.
    """
    lanes, frames, width = values.shape
    kept = np.zeros((lanes, frames), bool)
    kept[:, 0] = True
    moves = np.flatnonzero((np.abs(values - values[:, :1]) > 1.0).any(axis=(1, 2)))
    if not len(moves):
        return kept
    chunk = max(_LEAST_CHUNK, min(_MOST_CHUNK, len(moves) * frames * width // _AT_ONCE))
    borders = np.unique([*range(0, frames - 1, chunk), frames - 1])
    # One row for each component, containing all curves in succession.
    rows = np.ascontiguousarray(values[moves].transpose(2, 0, 1).reshape(width, -1))
    found = _walked(rows, len(moves), borders)
    kept[moves] = _without_needless(rows, found, borders[1:-1])
    return kept


def _walked(rows: AnyFloatArray, lanes: int, borders: AnyIntArray) -> BoolArray:
    """Return a mask (L, F) of the keys of L curves, found as described in `straight_keys`; every frame in ``borders``
    is a key. ``rows`` (D, L * F) are the values.
    """
    frames = rows.shape[1] // lanes
    kept = np.zeros(lanes * frames, bool)
    starts = (np.arange(lanes)[:, None] * frames + borders[:-1]).ravel()
    end = (np.arange(lanes)[:, None] * frames + borders[1:]).ravel()
    kept[starts] = kept[end] = True
    key, here, reached = starts.copy(), starts.copy(), starts.copy()
    base = rows[:, key]
    low, high = np.full_like(base, -np.inf), np.full_like(base, np.inf)
    while len(key):
        here += 1
        over = (1.0 / (here - key)).astype(rows.dtype)
        slope = (np.take(rows, here, axis=1) - base) * over
        passes = ((slope >= low) & (slope <= high)).all(axis=0)
        reached = np.where(passes, here, reached)
        np.maximum(low, slope - over, out=low)
        np.minimum(high, slope + over, out=high)
        stopped = np.flatnonzero((low > high).any(axis=0) | (here >= end))
        if not len(stopped):
            continue
        new = reached[stopped]
        kept[new] = True
        key[stopped] = here[stopped] = new
        base[:, stopped], low[:, stopped], high[:, stopped] = rows[:, new], -np.inf, np.inf
        walking = key < end
        if not walking.all():
            key, end, here, reached = key[walking], end[walking], here[walking], reached[walking]
            base, low, high = base[:, walking], low[:, walking], high[:, walking]
    return kept.reshape(lanes, frames)


def _without_needless(rows: AnyFloatArray, kept: BoolArray, borders: AnyIntArray) -> BoolArray:
    """Return ``kept`` (curves, frames) without those keys at ``borders`` frames that a straight line through the
    neighbouring keys makes unnecessary.

    Of the remaining ones, every second is tried at a time, so that the keys on both sides stay.
    """
    at_borders = np.zeros(kept.shape, bool)
    at_borders[:, borders] = True
    doubtful = (at_borders & kept).ravel()
    places = np.flatnonzero(kept.ravel())
    removed = True
    while removed:
        removed = False
        for first in (0, 1):
            tried = np.flatnonzero(doubtful[places])[first::2]
            needless = tried[_joined(rows, places[tried - 1], places[tried + 1])]
            removed |= bool(len(needless))
            stay = np.ones(len(places), bool)
            stay[needless] = False
            places = places[stay]
    result = np.zeros(kept.shape, bool)
    result.reshape(-1)[places] = True
    return result


def _joined(rows: AnyFloatArray, first: AnyIntArray, last: AnyIntArray) -> BoolArray:
    """Return a mask (N,) of the straight lines from column ``first`` to column ``last`` of ``rows`` that deviate from
    the columns between by at most 1 (the tolerance).
    """
    lengths = last - first
    line = np.repeat(np.arange(len(first)), lengths)
    on = np.arange(len(line)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    share = (on / lengths[line]).astype(rows.dtype)
    place = rows[:, first[line]] * (1 - share) + rows[:, last[line]] * share
    off = (np.abs(place - rows[:, first[line] + on]) > 1.0).any(axis=0)
    return np.asarray(np.bincount(line[off], minlength=len(first)) == 0)


def runs(flags: BoolArray) -> Iterator[slice]:
    """Yield the runs of consecutive flagged frames (F,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    for first, last in edges.reshape(-1, 2).tolist():
        yield slice(first, last)
