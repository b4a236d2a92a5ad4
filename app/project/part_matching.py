"""Matching of the parts of a score with those of a newer version."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.project.import_decisions import Place
from app.project.melody_likeness import ALIKE, shares, turns
from app.score.model import Part, Score

_NAMED = 0.4
"""Similarity of names from which a completely rewritten part is the same part."""


def matched_parts(old: Score, new: Score, hints: Sequence[Place | None]) -> list[tuple[int, int]]:
    """Return matching parts as pairs of indices, with the greatest total similarity.

    Parameters
    ----------
    hints : sequence of Place or None
        Present place of each old part's track; None if not known.
    """
    if not old.parts or not new.parts:
        return []
    content = shares(
        [turns_of(part, old.ticks_per_quarter) for part in old.parts],
        [turns_of(part, new.ticks_per_quarter) for part in new.parts],
    )
    named = np.array(
        [
            [_kinship(one, other) + _NAMED * (hint == other.place) for other in new.parts]
            for one, hint in zip(old.parts, hints, strict=True)
        ]
    )
    from scipy.optimize import linear_sum_assignment  # slow to import and rarely needed

    pairs = zip(*linear_sum_assignment(-(content + named)), strict=True)
    # A completely rewritten part still belongs to the same player if all other evidence agrees.
    return [
        (int(one), int(other)) for one, other in pairs if content[one, other] >= ALIKE or named[one, other] >= _NAMED
    ]


def turns_of(part: Part, quarter: int) -> FloatArray:
    """Return the hashes (N,) of a part's melodic turns, by which similar melodies are found (see
    `app.project.melody_likeness.turns`)."""
    return turns([note.onset_tick for note in part.notes], [note.pitch for note in part.notes], quarter)


def _kinship(one: Part, other: Part) -> float:
    """Return the similarity of two parts apart from their notes, which decides between parts with equal music."""
    return (
        0.25 * (one.name.casefold() == other.name.casefold())
        + 0.15 * (one.map_id == other.map_id and one.instrument == other.instrument)
        + 0.06 * (one.voice == other.voice)
        + 0.04 * (one.track == other.track)
        + 0.02 * (one.channel == other.channel)
    )
