"""Excerpts of a piece for evaluation: requested bars, or passages with much playing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.project.model import Project

_STEP_S: Final = 0.25
"""Distance in seconds of the positions tried for an excerpt."""
_LEAD_IN_S: Final = 0.5
"""Seconds before the first note at which an excerpt begins, so that its preparation is visible."""


@dataclass(frozen=True)
class Excerpt:
    """A span of the performance in seconds."""

    from_s: float
    until_s: float

    @property
    def duration_s(self) -> float:
        """Duration of the excerpt in seconds."""
        return self.until_s - self.from_s


def choose_excerpts(
    project: Project, count: int, length_s: float, within_s: tuple[float, float] | None = None
) -> tuple[Excerpt, ...]:
    """Choose excerpts with much playing, in order: the piece is divided into ``count`` parts, and the span with most
    notes of each is chosen. Short pieces give fewer excerpts, or a single shorter one.

    Parameters
    ----------
    count : int
        Number of excerpts.
    length_s : float
        Length of each in seconds.
    within_s : (float, float), optional
        Span of seconds that is covered by a film.

    Returns
    -------
    tuple of Excerpt
        Empty if nothing is played.
    """
    starts_s, ends_s = _notes_s(project)
    if not len(starts_s):
        return ()
    first_s, last_s = float(starts_s.min()) - _LEAD_IN_S, float(ends_s.max())
    if within_s is not None:
        first_s, last_s = max(first_s, within_s[0]), min(last_s, within_s[1])
    if last_s <= first_s:
        return ()
    length_s = min(length_s, last_s - first_s)
    count = max(1, min(count, int((last_s - first_s) / length_s + 1e-9)))
    edges = np.linspace(first_s, last_s, count + 1)
    found = list[Excerpt]()
    for left_s, right_s in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        places = np.arange(left_s, right_s - length_s + 1e-6, _STEP_S)
        played = [_played_s(starts_s, ends_s, place, place + length_s) for place in places.tolist()]
        best = float(places[int(np.argmax(played))])
        if max(played) > 0.0:
            found.append(Excerpt(best, best + length_s))
    return tuple(found)


def _played_s(starts_s: FloatArray, ends_s: FloatArray, from_s: float, until_s: float) -> float:
    """Return the total duration in seconds of notes within a span."""
    return float(np.clip(np.minimum(ends_s, until_s) - np.maximum(starts_s, from_s), 0.0, None).sum())


def _notes_s(project: Project) -> tuple[FloatArray, FloatArray]:
    """Return start and end (N,) in seconds of the notes of all players."""
    notes = [note for player in project.players for note in project.part(player).notes]
    clock = project.score.tempo_map
    starts = np.array([note.onset_tick for note in notes], np.float64)
    ends = np.array([note.end_tick for note in notes], np.float64)
    return np.asarray(clock.seconds(starts), np.float64), np.asarray(clock.seconds(ends), np.float64)


def practice_of(excerpts: Sequence[Excerpt], longest_s: float = 4.0) -> Excerpt:
    """Return the excerpt for the practice clip: the beginning of the last excerpt, up to ``longest_s`` seconds."""
    last = excerpts[-1]
    return Excerpt(last.from_s, min(last.from_s + longest_s, last.until_s))
