"""Keyframe reduction with cubic curves: the curve between two keys is the cubic that best fits the motion's frames
there.

Each span starts and ends at the values of its keys, with slopes fitted by least squares to the frames in between. Keys
are frames of a clip (`app.formats.keys`), and slopes follow from the clip. The basis is Hermite's; source: Khronos,
"glTF 2.0 Specification", appendix C.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, IntArray

_FIRST = 64
"""Length in frames of the spans tried first."""
_LONGEST = 192
"""Greatest length of a span in frames: a motionless hand still has a key every few seconds."""
_LENGTHS = np.unique([*range(1, 24), *range(24, 48, 2), *range(48, 96, 4), *range(96, _LONGEST + 1, 8)])
"""Lengths in frames that are tried when a span is extended as far as possible."""
_AT_ONCE = 2**20
"""Number of values processed at a time."""
_PASSES = 8
_BLOCK = 48
"""Number of consecutive spans that are redivided together, each as long as possible."""
_BLOCK_PASSES = 2
"""Number of such passes; blocks are shifted by half their length in between."""


@cache
def _basis(length: int) -> tuple[FloatArray, FloatArray]:
    """Return two matrices for spans of ``length`` frames, by which slopes are fitted.

    The first (length + 1, 2) converts the slopes at both ends to deviations from a straight line, the second (2, length
    + 1) is its least-squares inverse. Slopes are changes over the whole span.
    """
    share = np.arange(length + 1) / length
    effects = np.stack([share**3 - 2.0 * share**2 + share, share**3 - share**2], axis=1)
    if length == 1:
        return effects, np.zeros((2, 2))
    return effects, np.asarray(np.linalg.pinv(effects), np.float64)


def span_slopes(values: AnyFloatArray, keys: AnyIntArray) -> FloatArray:
    """Return the slopes (K - 1, 2, D) per frame at the start and end of each span between the K keys (K,) of a curve
    (F, D) of D components."""
    lanes = np.zeros(len(keys) - 1, np.intp)
    result = np.empty((len(keys) - 1, 2, values.shape[1]))
    curve = np.asarray(values)[None]
    for length, some in _by_length(np.diff(keys)):
        result[some] = _fitted(curve, lanes[some], keys[:-1][some], length)[1]
    return result


def curved_values(values: AnyFloatArray, kept: BoolArray) -> FloatArray:
    """Return the values (L, F, D) of L curves with D components in F frames if only the frames in the mask ``kept`` (L,
    F) are keys: cubics between them, constant after the last one.
    """
    frames = np.arange(values.shape[1])
    last = np.where(kept, frames, 0).max(axis=1)
    rows = np.arange(len(values))[:, None]
    result: FloatArray = np.asarray(values, np.float64)[rows, np.minimum(frames, last[:, None])]
    lanes, starts, lengths = _spans(kept)
    for length, some in _by_length(lengths):
        shown, _ = _fitted(values, lanes[some], starts[some], length)
        result[lanes[some, None], starts[some, None] + np.arange(length + 1)] = shown
    return result


def cubic_values(values: FloatArray, slopes: FloatArray, keys: AnyIntArray, frames: int) -> FloatArray:
    """Return the values (F,) at all frames of cubics through values (K,) with slopes (K - 1, 2) per frame at keys (K,);
    constant before the first and after the last key.
    """
    at = np.arange(frames)
    before = np.clip(np.searchsorted(keys, at, side="right") - 1, 0, len(keys) - 2)
    lengths = (keys[before + 1] - keys[before]).astype(np.float64)
    share = np.clip((at - keys[before]) / lengths, 0.0, 1.0)
    first, last = values[before], values[before + 1]
    begin, end = (slopes[before] * lengths[:, None]).T
    bend = share * (share - 1.0) * ((share - 1.0) * (begin - (last - first)) + share * (end - (last - first)))
    found: FloatArray = first + (last - first) * share + bend
    return found


def cubic_keys(values: AnyFloatArray) -> BoolArray:
    """Choose few keys such that the cubics through them deviate by at most 1 in any number.

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
    Spans are halved until each is accurate enough; those of equal length are processed together. Then keys are removed
    while the result stays accurate enough: single keys, or two keys replaced by one in the middle. Finally the keys of
    short stretches are chosen again, each span as long as possible.
    """
    lanes, frames, _ = values.shape
    kept = np.zeros((lanes, frames), bool)
    kept[:, 0] = True
    moves = np.flatnonzero((np.abs(values - values[:, :1]) > 1.0).any(axis=(1, 2)))
    if not len(moves):
        return kept
    found = _halved(values[moves])
    for _ in range(_PASSES):
        taken = sum(_without_every_second(values[moves], found, first) for first in (0, 1))
        taken += sum(_with_one_of_two(values[moves], found, first) for first in range(3))
        if not taken:
            break
    for number in range(_BLOCK_PASSES):
        if not _with_longest_spans(values[moves], found, number % 2 * (_BLOCK // 2)):
            break
    kept[moves] = found
    return kept


def _halved(values: AnyFloatArray) -> BoolArray:
    """Return a mask (L, F) of keys of L curves, found by halving, between which all spans are accurate enough."""
    lanes, frames, _ = values.shape
    borders = np.unique([*range(0, frames, _FIRST), frames - 1])
    kept = np.zeros((lanes, frames), bool)
    kept[:, borders] = True
    row, start = (one.ravel() for one in np.meshgrid(np.arange(lanes), borders[:-1], indexing="ij"))
    end = np.tile(borders[1:], lanes)
    while len(row):
        divided = (end - start > 1) & _far(values, row, start, end - start)
        row, start, end = row[divided], start[divided], end[divided]
        middle = (start + end) // 2
        kept[row, middle] = True
        row, start, end = np.tile(row, 2), np.concatenate([start, middle]), np.concatenate([middle, end])
    return kept


def _without_every_second(values: AnyFloatArray, kept: BoolArray, first: int) -> int:
    """Remove those keys that are not needed among every second one, counted from ``first``, in place; return their
    number.
    """
    lanes, frames = np.nonzero(kept)
    rank = np.arange(len(lanes)) - np.searchsorted(lanes, np.arange(len(kept)))[lanes]
    inner = np.zeros(len(lanes), bool)
    inner[1:-1] = (lanes[1:-1] == lanes[:-2]) & (lanes[1:-1] == lanes[2:]) & (rank[1:-1] % 2 == first)
    tried = np.flatnonzero(inner)
    tried = tried[frames[tried + 1] - frames[tried - 1] <= _LONGEST]
    start = frames[tried - 1]
    needless = tried[~_far(values, lanes[tried], start, frames[tried + 1] - start)]
    kept[lanes[needless], frames[needless]] = False
    return len(needless)


def _with_one_of_two(values: AnyFloatArray, kept: BoolArray, first: int) -> int:
    """Replace two of every three keys, counted from ``first``, by one in the middle if the result is accurate enough,
    in place; return the number of keys saved.
    """
    lanes, frames = np.nonzero(kept)
    rank = np.arange(len(lanes)) - np.searchsorted(lanes, np.arange(len(kept)))[lanes]
    inner = np.zeros(len(lanes), bool)
    inner[1:-2] = (lanes[1:-2] == lanes[:-3]) & (lanes[1:-2] == lanes[3:]) & (rank[1:-2] % 3 == first)
    tried = np.flatnonzero(inner)
    start, middle, end = frames[tried - 1], (frames[tried] + frames[tried + 1]) // 2, frames[tried + 2]
    near = (middle - start <= _LONGEST) & (end - middle <= _LONGEST)
    tried, start, middle, end = tried[near], start[near], middle[near], end[near]
    near = ~_far(values, lanes[tried], start, middle - start)
    tried, middle, end = tried[near], middle[near], end[near]
    near = ~_far(values, lanes[tried], middle, end - middle)
    tried, middle = tried[near], middle[near]
    kept[lanes[tried], frames[tried]] = kept[lanes[tried], frames[tried + 1]] = False
    kept[lanes[tried], middle] = True
    return len(tried)


def _with_longest_spans(values: AnyFloatArray, kept: BoolArray, first: int) -> int:
    """Choose the keys of each `_BLOCK` successive spans again, each span as long as possible, where that saves keys.

    ``kept`` is changed in place. Borders between the blocks keep their keys; they are counted from the curve's key
    number ``first``. Return the number of keys saved.
    """
    lanes, frames = np.nonzero(kept)
    counts = np.bincount(lanes, minlength=len(kept))
    rank = np.arange(len(lanes)) - np.repeat(np.cumsum(counts) - counts, counts)
    borders = np.flatnonzero((rank == 0) | (rank == counts[lanes] - 1) | ((rank - first) % _BLOCK == 0))
    begins = borders[:-1][lanes[borders[1:]] == lanes[borders[:-1]]]
    ends = borders[1:][lanes[borders[1:]] == lanes[borders[:-1]]]
    lane, end, spans = lanes[begins], frames[ends], ends - begins
    longest = np.minimum(2 * np.maximum.reduceat(np.diff(frames, append=0), begins), _LONGEST)
    here, chosen = frames[begins], np.zeros((len(begins), _BLOCK), np.intp)
    for number in range(_BLOCK):
        going = np.flatnonzero((here < end) & (number < spans))
        if not len(going):
            break
        here[going] += _longest(values, lane[going], here[going], np.minimum(end[going] - here[going], longest[going]))
        chosen[:, number] = here
    used = np.argmax(chosen == end[:, None], axis=1) + 1
    shorter = np.flatnonzero((here == end) & (used < spans))
    for block in shorter.tolist():
        kept[lane[block], frames[begins[block]] + 1 : end[block]] = False
        kept[lane[block], chosen[block, : used[block]]] = True
    return int((spans - used)[shorter].sum())


def stretches_again(
    values: AnyFloatArray, limits: AnyFloatArray, lanes: AnyIntArray, begins: AnyIntArray, ends: AnyIntArray
) -> list[AnyIntArray]:
    """Choose the keys of some stretches of curves again, each span as long as possible.

    Parameters
    ----------
    values : ndarray, shape (L, F, D)
        Curves of D numbers each, divided by the tolerance.
    limits : ndarray, shape (L, F)
        Greatest deviation in any number at each frame, 1 for the tolerance.
    lanes, begins, ends : (S,) int
        Curve, first frame and last frame of each stretch; both frames keep their keys.

    Returns
    -------
    list of ndarray of int
        Frames of the keys inside each stretch, without its first and last frame.
    """
    here, found = np.array(begins, np.int64), [list[int]() for _ in range(len(begins))]
    while len(going := np.flatnonzero(here < ends)):
        most = np.minimum(ends[going] - here[going], _LONGEST)
        here[going] += _longest(values, lanes[going], here[going], most, limits)
        for stretch in going.tolist():
            found[stretch].append(int(here[stretch]))
    return [np.array(frames[:-1], np.intp) for frames in found]


def _longest(
    values: AnyFloatArray,
    lanes: AnyIntArray,
    starts: AnyIntArray,
    most: AnyIntArray,
    limits: AnyFloatArray | None = None,
) -> IntArray:
    """Return for each of S spans from ``starts`` the greatest length that is accurate enough: ``most``, or the one of
    `_LENGTHS` that bisection finds.
    """
    near = ~_far(values, lanes, starts, most, limits)
    result: IntArray = np.array(most, np.int64)
    rest = np.flatnonzero(~near)
    low, high = np.zeros(len(rest), np.intp), np.searchsorted(_LENGTHS, most[rest]) - 1
    while (low < high).any():
        tried = (low + high + 1) // 2
        near = ~_far(values, lanes[rest], starts[rest], _LENGTHS[tried], limits)
        low, high = np.where(near, tried, low), np.where(near, high, np.maximum(tried - 1, low))
    result[rest] = _LENGTHS[low]
    return result


def _far(
    values: AnyFloatArray,
    lanes: AnyIntArray,
    starts: AnyIntArray,
    lengths: AnyIntArray,
    limits: AnyFloatArray | None = None,
) -> BoolArray:
    """Return a mask (S,) of the spans whose cubic deviates from ``values`` by more than ``limits`` (L, F), or by more
    than 1 (the tolerance).

    S spans are given by curve, first frame and length.
    """
    result = np.zeros(len(lanes), bool)
    for length, some in _by_length(lengths):
        step = max(1, _AT_ONCE // ((length + 1) * values.shape[2]))
        for part in (some[first : first + step] for first in range(0, len(some), step)):
            frames = starts[part, None] + np.arange(length + 1)
            shown, _ = _fitted(values, lanes[part], starts[part], length)
            most = 1.0 if limits is None else limits[lanes[part, None], frames][..., None]
            result[part] = (np.abs(shown - values[lanes[part, None], frames]) > most).any(axis=(1, 2))
    return result


def _fitted(
    values: AnyFloatArray, lanes: AnyIntArray, starts: AnyIntArray, length: int
) -> tuple[FloatArray, FloatArray]:
    """Fit cubics to S spans of ``length`` frames, given by curve and first frame.

    Return the cubics' values (S, length + 1, D) with D components, and their slopes (S, 2, D) at both ends, per frame.
    """
    effects, squares = _basis(length)
    own = values[lanes[:, None], starts[:, None] + np.arange(length + 1)]
    change = own[:, -1:] - own[:, :1]
    straight = own[:, :1] + change * (np.arange(length + 1) / length).astype(own.dtype)[:, None]
    bent = squares.astype(own.dtype) @ (own - straight)
    return np.asarray(straight + effects.astype(own.dtype) @ bent), np.asarray((change + bent) / length, np.float64)


def _spans(kept: BoolArray) -> tuple[IntArray, IntArray, IntArray]:
    """Return the curve index, first frame and length (S,) of all S spans between two keys of a curve.

    ``kept`` (L, F) marks the keys of L curves.
    """
    lanes, frames = np.nonzero(kept)
    same = np.flatnonzero(lanes[1:] == lanes[:-1])
    return lanes[same], frames[same], frames[same + 1] - frames[same]


def _by_length(lengths: AnyIntArray) -> Iterator[tuple[int, IntArray]]:
    """Yield each length in ``lengths`` once, with the indices (K,) of the spans that have it."""
    order = np.argsort(lengths, kind="stable")
    found, starts = np.unique(lengths[order], return_index=True)
    yield from zip(found.tolist(), np.split(order, starts[1:]), strict=False)
