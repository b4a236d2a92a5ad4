"""Similarity of melodies regardless of place and key, to recognise parts and tracks in another version of a file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray

ALIKE: Final = 0.25
"""Share of common groups of notes from which two melodies count as the same."""
SKETCH: Final = 32
"""Greatest number of groups of notes in the sketch of a melody."""
SKETCH_BITS: Final = 32
_GRAM: Final = 3
"""Number of consecutive notes in a group."""
_MIX: Final = np.uint64(0x9E3779B97F4A7C15)


def turns(onset_ticks: Sequence[int], pitches: Sequence[int], quarter: int) -> FloatArray:
    """Return hashes of melodic turns (two successive intervals with their durations), sorted; they do not depend on
    key, place and the file's resolution.

    Parameters
    ----------
    onset_ticks, pitches : sequence of int
        One entry per note, by onset, then pitch.
    quarter : int
        Ticks per quarter.
    """
    onsets = np.asarray(onset_ticks, np.float64) / quarter
    heights = np.asarray(pitches, np.float64)
    if len(heights) <= _GRAM:
        # Too short for sequences of intervals: the notes themselves are used, relative to the first.
        return np.sort(heights * 1e6 + np.minimum(np.rint((onsets - onsets[:1]) * 12.0), 999.0))
    steps = np.diff(heights) + 200.0
    times = np.minimum(np.rint(np.diff(onsets) * 12.0), 999.0)
    single = steps * 1000.0 + times
    count = len(single) - _GRAM + 2
    return np.sort(single[:count] * 1e6 + single[len(single) - count :])


def shares(old: Sequence[FloatArray], new: Sequence[FloatArray]) -> FloatArray:
    """Return the share 0..1 of common turns for each pair of an old and a new melody, shape (old, new).

    Computed turn by turn, since most pairs have none in common.
    """
    both: FloatArray = np.zeros((len(old), len(new)))
    here, there = _owners(old), _owners(new)
    for turn, (melodies, counts) in here.items():
        if turn in there:
            others, more = there[turn]
            both[np.ix_(melodies, others)] += np.minimum.outer(counts, more)
    lengths = np.add.outer([len(found) for found in old], [len(found) for found in new])
    return 2.0 * both / np.maximum(lengths, 1)


def _owners(melodies: Sequence[FloatArray]) -> dict[float, tuple[list[int], list[int]]]:
    """Return for each melodic turn the indices of the melodies that contain it, and how often each does."""
    owners: dict[float, tuple[list[int], list[int]]] = {}
    for index, found in enumerate(melodies):
        values, counts = np.unique(found, return_counts=True)
        for value, count in zip(values.tolist(), counts.tolist(), strict=True):
            those = owners.setdefault(value, ([], []))
            those[0].append(index)
            those[1].append(count)
    return owners


def sketch(found: FloatArray) -> tuple[int, ...]:
    """Return the turns with the smallest hashes, as a short sketch of a melody (bottom-k sketch; Cohen and Kaplan,
    2007). Two sketches allow an estimate of the similarity of their melodies.
    """
    mixed = (found.astype(np.int64).astype(np.uint64) * _MIX) >> np.uint64(64 - SKETCH_BITS)
    return tuple(np.unique(mixed)[:SKETCH].tolist())


def sketched_shares(old: Sequence[Sequence[int]], new: Sequence[Sequence[int]]) -> FloatArray:
    """Return the similarity by `sketched_share` of each old and each new melody, shape (old, new)."""
    result: FloatArray = np.zeros((len(old), len(new)))
    owners: dict[int, list[int]] = {}
    for index, melody in enumerate(new):
        for hash_ in melody:
            owners.setdefault(hash_, []).append(index)
    for index, melody in enumerate(old):
        # Most pairs have nothing in common.
        for other in {one for hash_ in melody for one in owners.get(hash_, ())}:
            result[index, other] = sketched_share(melody, new[other])
    return result


def sketched_share(one: Sequence[int], other: Sequence[int]) -> float:
    """Return the estimated share 0..1 of turns common to two melodies, from their sketches: among the smallest hashes
    of both together, the share of those that are in both.
    """
    mine, others = set(one), set(other)
    together = sorted(mine | others)[:SKETCH]
    if not together:
        return 0.0
    jaccard = sum(hash_ in mine and hash_ in others for hash_ in together) / len(together)
    return 2.0 * jaccard / (1.0 + jaccard)
