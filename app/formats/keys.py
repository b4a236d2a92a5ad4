"""Keys that are not on every frame: where they are, how linear ones are chosen, and what is between these.

Every program interpolates linear keys alike: numbers (places, weights, Euler angles) along a straight line, quaternions
at constant angular speed. So keys are frames of a clip at which its own values are written, and what a program shows at
any other frame can be worked out here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, SingleArray

KeyChoice = Literal["every", "reduced", "linear"]
"""A key on every frame, or as few as keep everything within a bound: joined by cubics, or by straight lines."""
KEY_CHOICES: Final[tuple[KeyChoice, ...]] = ("every", "reduced", "linear")

_LEAST_CHUNK, _MOST_CHUNK, _AT_ONCE = 64, 512, 8192
"""Frames that are walked through one after another, and how many numbers at once: all chunks of all curves."""


@dataclass(frozen=True, eq=False)
class Keys:
    """The frames of a clip that have keys, each list ascending from frame 0; a curve that never changes has one key.

    Attributes
    ----------
    bones : tuple of ndarray of int
        Of each bone's rotation and place. Both have theirs at the same frames, and so have all axes: Blender merges
        them, and three.js pairs them by their number.
    morphs : mapping of str to ndarray of int
        Of each morph's weight.
    face : ndarray of int
        Of all morphs together, for formats in which the morphs of a mesh share their keys.
    pose : ndarray of int or None
        Of all bones together, for formats in which they share their keys; None: on every frame there.
    curved : bool
        Whether cubics (`app.formats.cubics`) join the keys of `bones`. All other keys are linear.
    """

    bones: tuple[AnyIntArray, ...]
    morphs: Mapping[str, AnyIntArray] = field(default_factory=dict)
    face: AnyIntArray = field(default_factory=lambda: np.zeros(1, np.intp))
    pose: AnyIntArray | None = None
    curved: bool = False

    def beside(self, other: Keys) -> Keys:
        """Return these keys followed by the keys of further bones, which move no morphs."""
        pose = None if self.pose is None or other.pose is None else np.union1d(self.pose, other.pose)
        return replace(self, bones=self.bones + other.bones, pose=pose)

    def check(self, bones: int, frames: int, morphs: Mapping[str, object]) -> None:
        """Raise ValueError where these are no keys of a clip."""
        if len(self.bones) != bones or self.morphs.keys() != morphs.keys():
            raise ValueError("keys of other bones or morphs than the clip's")
        lists = [*self.bones, *self.morphs.values(), self.face, *([] if self.pose is None else [self.pose])]
        for keys in lists:
            if not len(keys) or keys[0] != 0 or keys[-1] >= frames or (np.diff(keys) <= 0).any():
                raise ValueError("keys must be frames of the clip in their order, the first among them")


@dataclass(frozen=True, eq=False)
class KeySpans:
    """Position of frames between keys.

    Attributes
    ----------
    before, after : ndarray of int, shape (L, F)
        The keys of each curve around each frame: the frame itself where it has one, the last key twice after it.
    share : ndarray, shape (L, F)
        How far a frame is from the one to the other, 0..1.
    """

    before: AnyIntArray
    after: AnyIntArray
    share: SingleArray

    @classmethod
    def of(cls, kept: BoolArray) -> KeySpans:
        """Spans between the frames (L, F) that have keys, the first among them."""
        frames = np.arange(kept.shape[1], dtype=np.int32)
        before = np.maximum.accumulate(np.where(kept, frames, 0), axis=1)
        last = before[:, -1:]
        after = np.minimum.accumulate(np.where(kept, frames, last)[:, ::-1], axis=1)[:, ::-1]
        after = np.maximum(after, before)
        share = (frames - before) / np.maximum(after - before, 1).astype(np.float32)
        return cls(before, after, np.where(after > before, share, np.float32(0.0)))

    def at(self, frames: AnyIntArray) -> KeySpans:
        """Spans of some of the frames."""
        return KeySpans(self.before[:, frames], self.after[:, frames], self.share[:, frames])

    def row(self, row: int) -> KeySpans:
        """Spans of one of the curves."""
        return KeySpans(self.before[row, None], self.after[row, None], self.share[row, None])

    def straight(self, values: AnyFloatArray) -> FloatArray:
        """Numbers (L, F, D) at these frames, interpolated from the keys."""
        rows = np.arange(len(values))[:, None]
        first, last = values[rows, self.before], values[rows, self.after]
        return np.asarray(first + (last - first) * self.share[..., None], np.float64)

    def turned(self, rotations: AnyFloatArray) -> FloatArray:
        """Unit quaternions (L, F, 4) at these frames, interpolated from the keys."""
        rows = np.arange(len(rotations))[:, None]
        return slerp(rotations[rows, self.before], rotations[rows, self.after], self.share[..., None])


def slerp(a: AnyFloatArray, b: AnyFloatArray, share: AnyFloatArray) -> FloatArray:
    """Interpolate between unit quaternions (..., 4) by the shorter way; ``share`` (..., 1) is 0 at a."""
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
    """Few frames whose values, joined by straight lines, are nowhere more than 1 off in any number.

    Parameters
    ----------
    values : ndarray, shape (L, F, D)
        Curves of D numbers each, divided by what they may be off.

    Returns
    -------
    ndarray of bool, shape (L, F)
        The first frame is among them, and the last unless the curve stays near its first value.

    Notes
    -----
    From a key on, the straight lines that meet the tolerance of all frames so far have slopes in an interval; the next
    key is the last frame that such a line reaches before the interval is empty (the "swing door" of P. A. Bristol, US
    patent 4669097, 1987, with keys on the curve itself). All curves are walked at once, and in chunks of frames, whose
    borders are keys at first and are then taken away where they are not needed.
    """
    lanes, frames, width = values.shape
    kept = np.zeros((lanes, frames), bool)
    kept[:, 0] = True
    moves = np.flatnonzero((np.abs(values - values[:, :1]) > 1.0).any(axis=(1, 2)))
    if not len(moves):
        return kept
    chunk = max(_LEAST_CHUNK, min(_MOST_CHUNK, len(moves) * frames * width // _AT_ONCE))
    borders = np.unique([*range(0, frames - 1, chunk), frames - 1])
    # Row by row of numbers, each of all curves one after the other.
    rows = np.ascontiguousarray(values[moves].transpose(2, 0, 1).reshape(width, -1))
    found = _walked(rows, len(moves), borders)
    kept[moves] = _without_needless(rows, found, borders[1:-1])
    return kept


def _walked(rows: AnyFloatArray, lanes: int, borders: AnyIntArray) -> BoolArray:
    """Frames (L, F) of `straight_keys`, with every border among them; ``rows`` is (D, L * F)."""
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
    """The keys without those at some frames that straight lines do not need.

    Of those that are left every second one is tried at a time, so that each stands between two keys that stay.
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
    """Return which straight lines (N,) between two columns of ``rows`` are nowhere more than 1 off."""
    lengths = last - first
    line = np.repeat(np.arange(len(first)), lengths)
    on = np.arange(len(line)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    share = (on / lengths[line]).astype(rows.dtype)
    place = rows[:, first[line]] * (1 - share) + rows[:, last[line]] * share
    off = (np.abs(place - rows[:, first[line] + on]) > 1.0).any(axis=0)
    return np.asarray(np.bincount(line[off], minlength=len(first)) == 0)


def runs(flags: BoolArray) -> Iterator[slice]:
    """The unbroken runs of frames (F,) that are flagged."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    for first, last in edges.reshape(-1, 2).tolist():
        yield slice(first, last)
