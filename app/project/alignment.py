"""Matching of the notes of two versions of a part by pitch and time.

Between the versions notes may be added, removed, moved or changed, bars inserted or cut, or everything transposed. Most
notes recur exactly at one of a few time shifts. Dynamic programming (Viterbi) finds the shift that is valid at each
note; the notes in between are matched by dynamic programming over both versions (Needleman and Wunsch, 1970).
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.arrays import FloatArray, IntArray
from app.score.model import Note

SAME_QUARTERS = 1 / 16
"""Difference of onsets in quarters that counts as equal, since files have different resolutions and notes are
nudged.
"""
SWITCH_COST = 3.0
"""Cost of a change of the time offset between two versions, in notes without a partner."""
SKIP_COST, MOST_SKIP_COST = 0.05, 6.0
"""Cost of every note that such a change skips, and greatest cost, since many bars may be inserted together."""
AGAIN_COST, MOST_AGAIN_COST = 0.5, 12.0
"""Cost of every note that is matched twice although nothing was cut before, and greatest cost."""
GAP_COST = 0.7
"""Cost of a note without a partner; two cost a little more than a changed pitch or a moved onset, but less
than both.
"""
PITCH_COST = 1.0
TIME_COST = 0.8
FAR_QUARTERS = 0.5
"""Difference of onsets in quarters above which the cost does not increase."""
LENGTH_COST = 0.05

_BINS_PER_QUARTER = 12
_MOST_DISTANCES = 24
_SAMPLED_PAIRS = 200_000
_LEAST_ROWS = 150
_MOST_CELLS = 5_000_000


@dataclass(frozen=True, eq=False)
class AlignmentPart:
    """Notes of a part as arrays of equal length, ordered by onset and pitch; times in quarters."""

    onsets: FloatArray
    lengths: FloatArray
    pitches: IntArray

    @classmethod
    def of(cls, notes: Sequence[Note], ticks_per_quarter: int) -> AlignmentPart:
        """Return onsets, durations (quarter notes) and pitches of notes as arrays (N,) for alignment."""
        return cls(
            np.array([note.onset_tick for note in notes], np.float64) / ticks_per_quarter,
            np.array([note.duration_tick for note in notes], np.float64) / ticks_per_quarter,
            np.array([note.pitch for note in notes], np.int64),
        )

    def __len__(self) -> int:
        return len(self.onsets)

    def part(self, first: int, end: int) -> AlignmentPart:
        """Return the notes from ``first`` to before ``end``."""
        return AlignmentPart(self.onsets[first:end], self.lengths[first:end], self.pitches[first:end])


def align(old: AlignmentPart, new: AlignmentPart) -> IntArray:
    """Match the notes of two versions of a part.

    Returns
    -------
    int64, shape (pairs, 2)
        Index of the old and index of the new note of each pair; both columns ascend strictly.
    """
    if not len(old) or not len(new):
        return np.empty((0, 2), np.int64)
    distances, transposition = _distances(old, new)
    anchors = _anchors(old, new, distances, transposition)
    pairs = [*anchors]
    for (first, new_first), (end, new_end) in _gaps(anchors, len(old), len(new)):
        # Distances of the neighbouring notes; the first and last note have one neighbour.
        around = [(first - 1, new_first - 1)] * (first > 0) + [(end, new_end)] * (end < len(old))
        shifts = [float(new.onsets[after] - old.onsets[before]) for before, after in around]
        shifts = shifts or distances.tolist()
        inner = _gap_pairs(old.part(first, end), new.part(new_first, new_end), shifts, transposition)
        pairs += [(first + one, new_first + other) for one, other in inner]
    return np.array(sorted(pairs), np.int64).reshape(-1, 2)


def pair_costs(old: AlignmentPart, new: AlignmentPart, shifts: Sequence[float], transposition: int) -> FloatArray:
    """Return the costs (old, new) of matching each old note with each new one.

    Parameters
    ----------
    shifts : sequence of float
        Allowed time shifts from old to new notes in quarters; the cheapest one is used.
    transposition : int
        Semitones by which the new notes are higher.
    """
    moved = new.onsets[None, :] - old.onsets[:, None]
    away = np.min([np.abs(moved - shift) for shift in shifts], axis=0)
    costs = TIME_COST * np.minimum(away / FAR_QUARTERS, 1.0)
    costs += PITCH_COST * (new.pitches[None, :] - old.pitches[:, None] != transposition)
    costs += LENGTH_COST * (np.abs(new.lengths[None, :] - old.lengths[:, None]) > SAME_QUARTERS)
    return np.asarray(costs, np.float64)


def cheapest(costs: FloatArray) -> list[tuple[int, int]]:
    """Return the cheapest ordered pairing (row, column) of a cost matrix's rows with its columns; an unpaired one costs
    `GAP_COST`."""
    rows, columns = costs.shape
    steps = GAP_COST * np.arange(columns + 1)
    totals = np.empty((rows + 1, columns + 1))
    totals[0] = steps
    for row in range(rows):
        before, here = totals[row], totals[row + 1]
        here[0] = before[0] + GAP_COST
        np.minimum(before[:-1] + costs[row], before[1:] + GAP_COST, out=here[1:])
        # Skipping columns: the minimum over all starting columns, plus the cost of the columns skipped.
        here -= steps
        np.minimum.accumulate(here, out=here)
        here += steps
    pairs = []
    row, column = rows, columns
    while row and column:
        total = totals[row, column]
        if np.isclose(total, totals[row - 1, column - 1] + costs[row - 1, column - 1], rtol=0.0, atol=1e-9):
            row, column = row - 1, column - 1
            pairs.append((row, column))
        elif np.isclose(total, totals[row - 1, column] + GAP_COST, rtol=0.0, atol=1e-9):
            row -= 1
        else:
            column -= 1
    return pairs[::-1]


def _distances(old: AlignmentPart, new: AlignmentPart) -> tuple[FloatArray, int]:
    """Return the time shifts (N,) from old to new notes, in quarters, at which many notes recur, and the transposition
    in semitones.
    """
    found, _ = _partners(old, new, 0.0, 0)
    if np.count_nonzero(found >= 0) >= 0.98 * max(len(old), len(new)):
        return np.zeros(1), 0
    rows = min(len(old), max(_SAMPLED_PAIRS // len(new), _LEAST_ROWS))
    chosen = np.unique(np.linspace(0, len(old) - 1, rows).astype(np.int64))
    moved = np.subtract.outer(new.onsets, old.onsets[chosen]).T
    higher = np.subtract.outer(new.pitches, old.pitches[chosen]).T
    bins = np.rint(moved * _BINS_PER_QUARTER).astype(np.int64)
    keys, votes = np.unique(higher + 128 + 256 * (bins - bins.min()), return_counts=True)
    # Among equally frequent distances the nearest one: notes count as unmoved unless the evidence is stronger.
    places = keys // 256 + bins.min()
    pitches = keys % 256 - 128
    order = np.lexsort((np.abs(places), np.abs(pitches), -votes))
    transposition = int(pitches[order[0]])
    best = [index for index in order[: 40 * _MOST_DISTANCES] if pitches[index] == transposition][:_MOST_DISTANCES]
    least = max(2, votes[order[0]] // 100) if votes[order[0]] > 1 else 1
    distances = [0.0]
    same = higher == transposition
    for index in best:
        if votes[index] >= least:
            near = moved[same & (bins == places[index])]
            distances.append(float(np.median(near)))
    return np.unique(distances), transposition


def _partners(
    old: AlignmentPart, new: AlignmentPart, distance: float, transposition: int
) -> tuple[IntArray, FloatArray]:
    """Return for each old note (N,) the index of the new note of equal pitch nearest to its shifted time (-1 for none),
    and its distance in quarter notes.

    Pitches are compared after the transposition, times after a shift by ``distance``.
    """
    width = float(max(old.onsets[-1] + abs(distance), new.onsets[-1]) + 2.0)
    order = np.lexsort((new.onsets, new.pitches))
    keys = new.pitches[order] * 4.0 * width + new.onsets[order]
    requested = (old.pitches + transposition) * 4.0 * width + old.onsets + distance
    after = np.searchsorted(keys, requested)
    above, below = np.minimum(after, len(keys) - 1), np.maximum(after - 1, 0)
    nearer = np.where(np.abs(keys[above] - requested) <= np.abs(keys[below] - requested), above, below)
    away = np.abs(keys[nearer] - requested)
    return np.where(away <= SAME_QUARTERS, order[nearer], -1), away


def _anchors(
    old: AlignmentPart, new: AlignmentPart, distances: FloatArray, transposition: int
) -> list[tuple[int, int]]:
    """Return the pairs of notes (old index, new index), ascending, that match at a time shift which is valid for a
    longer stretch of notes.
    """
    partners, away = zip(*(_partners(old, new, distance, transposition) for distance in distances), strict=True)
    found = np.array(partners)
    costs = np.where(found >= 0, 0.2 * np.array(away) / SAME_QUARTERS, 1.0)
    # Between readings that are equal otherwise, the one with less movement.
    costs += 1e-4 * np.minimum(np.abs(distances), 100.0)[:, None]
    density = len(old) / max(float(old.onsets[-1] - old.onsets[0]), 1.0)
    skipped = (distances[None, :] - distances[:, None]) * density
    changes = SWITCH_COST + np.where(
        skipped > 0.0,
        np.minimum(SKIP_COST * skipped, MOST_SKIP_COST),
        np.minimum(-AGAIN_COST * skipped, MOST_AGAIN_COST),
    )
    np.fill_diagonal(changes, 0.0)
    chosen = _held(costs, changes)
    pairs = [(index, int(found[state, index])) for index, state in enumerate(chosen) if found[state, index] >= 0]
    return _ascending(pairs)


def _held(costs: FloatArray, changes: FloatArray) -> IntArray:
    """Return for every column the row of the cheapest path through a cost matrix; going from row a to row b costs
    ``changes[a, b]``.
    """
    states, count = costs.shape
    if states == 1:
        return np.zeros(count, np.int64)
    total = costs[:, 0].copy()
    came = np.empty((count, states), np.int64)
    own = np.arange(states)
    for index in range(1, count):
        ways = total[:, None] + changes
        best = ways.argmin(axis=0)
        came[index] = best
        total = ways[best, own] + costs[:, index]
    path = np.empty(count, np.int64)
    path[-1] = np.argmin(total)
    for index in range(count - 1, 0, -1):
        path[index - 1] = came[index, path[index]]
    return path


def _ascending(pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the longest subset of pairs, ordered by the first index, whose second index also ascends (patience
    sorting).
    """
    tops: list[int] = []
    last: list[int] = []
    before: list[int] = []
    for index, (_, value) in enumerate(pairs):
        pile = bisect_left(tops, value)
        before.append(last[pile - 1] if pile else -1)
        if pile == len(tops):
            tops.append(value)
            last.append(index)
        else:
            tops[pile], last[pile] = value, index
    kept = []
    index = last[-1] if last else -1
    while index >= 0:
        kept.append(pairs[index])
        index = before[index]
    return kept[::-1]


def _gaps(
    anchors: list[tuple[int, int]], old_count: int, new_count: int
) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield the gaps between matched pairs in which both versions have notes, as (start, end) indices in the old and in
    the new version.
    """
    ends = [*anchors, (old_count, new_count)]
    first, new_first = 0, 0
    for end, new_end in ends:
        if end > first and new_end > new_first:
            yield (first, new_first), (end, new_end)
        first, new_first = end + 1, new_end + 1


def _gap_pairs(
    old: AlignmentPart, new: AlignmentPart, shifts: Sequence[float], transposition: int
) -> Iterator[tuple[int, int]]:
    # Long stretches without common notes are divided evenly, since nothing relates their notes.
    blocks = -(-len(old) * len(new) // _MOST_CELLS)
    cuts = [(len(old) * block // blocks, len(new) * block // blocks) for block in range(blocks + 1)]
    for (first, new_first), (end, new_end) in pairwise(cuts):
        if end > first and new_end > new_first:
            costs = pair_costs(old.part(first, end), new.part(new_first, new_end), shifts, transposition)
            yield from ((first + one, new_first + other) for one, other in cheapest(costs))
