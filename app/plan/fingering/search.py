"""Search for fingerings: the cheapest path through a part by the costs of fingerings and motions.

Viterbi over the ranked fingerings of every note, exact also for costs that involve three notes (reversing a slide).
Only spans where leaving the first choices can pay are searched, so slow music costs no time. Finger movements between
two pitches are counted in `app.plan.fingering.finger_travel`.
"""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.fingering.costs import TOLERANCE, FingeringProblem

PHRASE_SILENCE_S = 0.25
"""Silence in seconds that separates phrases when they are compared with the first choices."""


def best_path(problem: FingeringProblem) -> IntArray:
    """Return the cheapest path: the column of the fingering for every note; ties go to the lower rank.

    Only spans in which leaving the cheapest fingerings can pay are searched (see `_windows`).
    """
    local = problem.local_cost
    path: IntArray = np.argmin(local, axis=1).astype(np.int64)
    for first, last in _windows(problem, path):
        path[first : last + 1] = _search(problem, path, first, last)
    return path


def _windows(problem: FingeringProblem, path: IntArray) -> list[tuple[int, int]]:
    """Return the spans of notes in which a path cheaper than ``path`` may leave it; ``path`` has the fingerings that
    are cheapest by themselves.

    Each note that leaves ``path`` costs at least a known least amount more, and saves at most the excess cost of its
    steps over their minimum. Spans in which the savings cannot exceed the costs are excluded, by cumulative sums.
    """
    count = len(path)
    if count < 2:
        return []
    steps, cost, local = np.arange(count - 1), problem.motions.cost, problem.local_cost
    possible = np.where(problem.allowed[:-1, :, None] & problem.allowed[1:, None, :], cost, np.inf)
    saving = cost[steps, path[:-1], path[1:]] - possible.min(axis=(1, 2))
    if problem.reversal_cost is not None:
        turned = problem.reversal_cost[steps[:-1], path[:-2], path[1:-1], path[2:]]
        saving[1:] += turned
    if not (saving > TOLERANCE).any():
        return []
    others = local - local[np.arange(count), path][:, None]
    others[np.arange(count), path] = np.inf
    dearer = float(others.min())
    # A span of notes first..last includes the steps first-1..last, and one more step on each side if costs depend on
    # three notes.
    reach = 1 if problem.reversal_cost is None else 2
    if not np.isfinite(dearer):
        return []
    sums = np.concatenate(([0.0], np.cumsum(saving - dearer)))
    lowest = np.minimum.accumulate(sums)
    highest = np.maximum.accumulate(sums[::-1])[::-1]
    # For each step: the best span of steps that contains it.
    pays = highest[1:] - lowest[:-1] > -dearer * reach - TOLERANCE
    held = np.zeros(count, dtype=bool)
    held[:-1] |= pays
    held[1:] |= pays
    free = np.flatnonzero(held)
    runs = np.split(free, np.flatnonzero(np.diff(free) > 1) + 1)
    return [(max(int(run[0]) - reach, 0), min(int(run[-1]) + reach, count - 1)) for run in runs if len(run)]


def _search(problem: FingeringProblem, path: IntArray, first: int, last: int) -> IntArray:
    """Return the cheapest fingerings of notes ``first`` to ``last`` as columns (N,), by the Viterbi algorithm; the end
    notes keep their fingering in ``path`` unless they are the ends of the part."""
    local, cost = problem.local_cost[first : last + 1].copy(), problem.motions.cost[first:last]
    for end, is_lines in ((0, first == 0), (last - first, last == len(path) - 1)):
        if not is_lines:
            held = local[end, path[first + end]]
            local[end] = np.inf
            local[end, path[first + end]] = held
    reversal = problem.reversal_cost
    if reversal is None:
        return _chain(local, cost)
    return _chain_of_pairs(local, cost, reversal[first : max(last - 1, first)])


def _chain(local: FloatArray, cost: FloatArray) -> IntArray:
    """Return the cheapest path through a chain of choices; ties go to the lower ranks.

    Pairs of neighbouring steps are merged by the best choice of the note between them, all pairs at once, until one
    step is left: a number of rounds logarithmic in the number of notes.
    """
    steps = cost + local[1:, None, :]
    steps[0] += local[0][:, None]
    rounds: list[IntArray] = []
    while len(steps) > 1:
        joined = len(steps) // 2 * 2
        before, after = steps[0:joined:2], steps[1:joined:2]
        best = before[:, :, :1] + after[:, :1, :]
        middle = np.zeros(best.shape, dtype=np.int64)
        for choice in range(1, local.shape[1]):
            ways = before[:, :, choice : choice + 1] + after[:, choice : choice + 1, :]
            better = ways < best - TOLERANCE
            np.copyto(best, ways, where=better)
            middle[better] = choice
        rounds.append(middle)
        steps = np.concatenate((best, steps[joined:]))
    first, last = np.unravel_index(int(steps[0].argmin()), steps[0].shape)
    chosen = np.array([first, last], dtype=np.int64)
    for middle in reversed(rounds):
        # With an odd count the last step of a round has no partner.
        joined = len(middle)
        between = middle[np.arange(joined), chosen[:joined], chosen[1 : joined + 1]]
        chosen = np.concatenate((np.stack((chosen[:joined], between), axis=1).ravel(), chosen[joined:]))
    return chosen


def _chain_of_pairs(local: FloatArray, cost: FloatArray, reversal: FloatArray) -> IntArray:
    """Return the cheapest path, as columns (N,), with costs that involve three notes in a row, found as a chain of
    pairs of neighbouring choices."""
    total = local[0][:, None] + cost[0] + local[1][None, :]
    back: list[IntArray] = []
    for note in range(2, len(local)):
        ways = total[:, :, None] + reversal[note - 2]
        back.append(ways.argmin(axis=0))
        total = ways.min(axis=0) + cost[note - 1] + local[note][None, :]
    before, here = np.unravel_index(int(total.argmin()), total.shape)
    chosen = [int(here), int(before)]
    for origin in reversed(back):
        chosen.append(int(origin[chosen[-1], chosen[-2]]))
    return np.array(chosen[::-1], dtype=np.int64)


def even_trills(problem: FingeringProblem, path: IntArray) -> IntArray:
    """Return ``path`` (the fingering's column of each note) with the first and last two notes of every trill fingered
    as within it, since no player changes fingerings while trilling."""
    steps = np.concatenate(([False], problem.in_trill, [False]))
    if not steps.any():
        return path
    even = path.copy()
    edges = np.flatnonzero(steps[1:] != steps[:-1]).tolist()
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        for note, within in ((first, first + 2), (first + 1, first + 3), (last, last - 2), (last - 1, last - 3)):
            same = problem.pitch_index[note] == problem.pitch_index[within]
            # A correction of one of two notes applies to that note alone.
            if same and (problem.allowed[note] == problem.allowed[within]).all():
                even[note] = path[within]
    return even


def never_worse(problem: FingeringProblem, path: IntArray) -> IntArray:
    """Replace the fingerings of a run of alternates, or of a phrase, by the first choices where ``path`` travels
    further or faster than they do. Fingerings fixed by corrections stay.
    """
    first_path = np.argmin(problem.local_cost, axis=1)
    different = np.flatnonzero(path != first_path)
    if len(different) == 0:
        return path
    count = len(path)
    # Between two alternates a slide that stays near gains at the first note what it may lose at the second.
    breaks = np.flatnonzero(np.diff(different) > (2 if problem.has_slide else 1))
    starts, ends = different[np.append(0, breaks + 1)], different[np.append(breaks, len(different) - 1)]
    silence = problem.times.onset_s[1:] - problem.times.played_end_s[:-1] >= PHRASE_SILENCE_S
    # Includes the notes on both sides, which runs may share (no step belongs to two runs), but not across a rest, in
    # which there is time to change.
    before = starts - ~np.append(True, silence)[starts]
    after = ends + ~np.append(silence, True)[ends]
    worse = problem.goes_further(path, first_path, before, after)
    path = _with_first_choices(path, first_path, starts[worse], ends[worse])
    starts = np.append(0, np.flatnonzero(silence) + 1)
    ends = np.append(starts[1:], count) - 1
    worse = problem.goes_further(path, first_path, starts, ends)
    return _with_first_choices(path, first_path, starts[worse], ends[worse])


def _with_first_choices(path: IntArray, first_path: IntArray, starts: IntArray, ends: IntArray) -> IntArray:
    """Return ``path`` with the first choices (``first_path``) in the spans of notes ``starts[i]``..``ends[i]``."""
    edges = np.zeros(len(path) + 1, dtype=np.int64)
    edges[starts] += 1
    edges[ends + 1] -= 1
    return np.where(np.cumsum(edges[:-1]) > 0, first_path, path)
