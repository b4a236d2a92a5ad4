"""Passages of a score in the order in which a recording plays them: it may begin anywhere, and repeat or omit bars.

Dynamic programming over the frames of the recording: from each to the next, the score advances by a frame, stays, skips
one, or jumps to any other position at the cost of half a second of similarity. So jumps are found without notated
repeats. After C. Fremerey, M. Mueller, M. Clausen, "Handling repeats and jumps in score-performance synchronization"
(ISMIR 2010).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.audio.score_sound import CHROMA_S

_JUMP: Final = 6.0
"""Cost of a jump as a number of perfectly similar frames."""
_UNEVEN: Final = 0.25
"""Cost of staying and of skipping a frame, in the same unit."""
_LEAST_S: Final = 3.0
"""Passages shorter than this number of seconds are ignored as chance."""
_LEAST_ALIKE: Final = 0.6
"""Passages less similar than this share of the most similar one are ignored as chance."""
_PLAYED: Final = (1, 0, 2)
"""Advances in frames of the score per frame of the recording, in order of preference."""
_JUMPED: Final = 3
"""Index of a jump, after those of `_PLAYED`."""


@dataclass(frozen=True)
class Passage:
    """A passage that a recording plays: start and end in seconds of the score, and the corresponding seconds of the
    recording.
    """

    start_s: float
    end_s: float
    recording_start_s: float
    recording_end_s: float


def passages(score: FloatArray, recording: FloatArray, frame_s: float = CHROMA_S) -> tuple[Passage, ...]:
    """Find the passages of a score that a recording plays, in order; of a repeated passage only the first time.

    Parameters
    ----------
    score, recording : (n, 12) float64
        Chroma of both, normalised by `app.audio.score_sound.shape`.
    frame_s : float
        Length of a frame in seconds.

    Returns
    -------
    tuple of Passage
        Passages that ascend in score and recording.
    """
    if not len(score) or not len(recording):
        return ()
    path = _path(score, recording)
    alike = (score[path] * recording).sum(axis=1)
    steps = np.diff(path)
    starts = np.concatenate(([0], np.flatnonzero((steps < 0) | (steps > 2)) + 1))
    runs = list(zip(starts.tolist(), [*starts[1:].tolist(), len(path)], strict=True))
    likeness = [float(alike[first:last].mean()) for first, last in runs]
    long = [
        (run, mean)
        for run, mean in zip(runs, likeness, strict=True)
        if (run[1] - run[0]) * frame_s >= _LEAST_S and mean >= _LEAST_ALIKE * max(likeness)
    ]
    chain = _rising([run for run, _ in long], path)
    return tuple(
        Passage(int(path[first]) * frame_s, (int(path[last - 1]) + 1) * frame_s, first * frame_s, last * frame_s)
        for first, last in chain
    )


def _path(score: FloatArray, recording: FloatArray) -> IntArray:
    """Find the best path: for every frame of the recording the corresponding frame of the score."""
    count = len(score)
    places = np.arange(count)
    how = np.empty((len(recording), count), np.int8)
    jumped_from = np.empty(len(recording), np.int64)
    total = -(score @ recording[0])
    best = np.full((3, count), np.inf)
    for frame in range(1, len(recording)):
        best[0, 1:] = total[:-1]
        best[1] = total + _UNEVEN
        best[2, 2:] = total[:-2] + _UNEVEN
        chosen = best.argmin(axis=0)
        least = best[chosen, places]
        lowest = jumped_from[frame] = int(total.argmin())
        jumps = total[lowest] + _JUMP < least
        how[frame] = np.where(jumps, _JUMPED, chosen)
        total = np.where(jumps, total[lowest] + _JUMP, least) - score @ recording[frame]
    path = np.empty(len(recording), np.int64)
    path[-1] = int(total.argmin())
    for frame in range(len(recording) - 1, 0, -1):
        came = int(how[frame, path[frame]])
        path[frame - 1] = jumped_from[frame] if came == _JUMPED else path[frame] - _PLAYED[came]
    return path


def _rising(runs: list[tuple[int, int]], path: IntArray) -> list[tuple[int, int]]:
    """Select the runs of the recording that ascend in the score with the greatest total length, without beginnings that
    repeat what was played already.
    """
    # Best chain that ends with each run: its length and the runs after trimming.
    found: list[tuple[int, list[tuple[int, int]]]] = []
    for first, last in runs:
        best: tuple[int, list[tuple[int, int]]] = (last - first, [(first, last)])
        for length, chain in found:
            reached = int(path[chain[-1][1] - 1])
            begin = first + int(np.searchsorted(path[first:last], reached, side="right"))
            if begin < last and length + last - begin > best[0]:
                best = (length + last - begin, [*chain, (begin, last)])
        found.append(best)
    return max(found, key=lambda one: one[0])[1] if found else []
