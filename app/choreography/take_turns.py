"""Turns of the takes (captured dancers) of a choreography in a dance, so that each gets its share of the phrases."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.drums_of_dancers import TakeShares

LEFT_OVER: Final = 0.85
"""Share of a take's deficit that remains a phrase later."""
LEAST_SHARE: Final = 0.25
"""Share of the greatest take below which a take gets no turn."""
SAME_TAKE: Final = 80.0
"""Number of beats by which a take may exceed its share if music recurs to which it was danced."""


class TakeTurns:
    """Choice of the take (captured dancer) that is favoured in each phrase, so that takes alternate in proportion to
    their shares.

    Parameters
    ----------
    random : numpy.random.Generator
        Choice of what each take is owed at the beginning.
    phrase_beats : int
        Number of beats in a phrase.
    """

    def __init__(self, takes: TakeShares, random: np.random.Generator, phrase_beats: int) -> None:
        self._takes, self._phrase_beats = takes, phrase_beats
        self._owed = takes.shares[:1].sum(axis=0) * random.random(takes.shares.shape[1]) * self._phrase_beats
        self._counted = 0

    def favoured(
        self, grid: AccentGrid, chosen: Sequence[tuple[int, int]], first: int, again: FloatArray
    ) -> FloatArray:
        """Mark (S,) with 1 the segments of the take that is favoured in a phrase.

        Parameters
        ----------
        chosen : sequence of (place, segment)
            Accents before the phrase with their segments.
        first : int
            Accent at which the phrase begins.
        again : (P, S) float64
            How similar each of P places of the phrase is to places at which each of S segments was danced; the take
            that was danced to recurring music before is favoured.
        """
        beats, takes = grid.beats, self._takes.takes
        # The beats danced since the last phrase are subtracted from what each take is owed.
        for (place, segment), (following, _) in pairwise((*chosen[self._counted :], (first, -1))):
            self._owed[takes[segment]] -= max(0.0, beats[following] - beats[place])
        self._counted = len(chosen)
        share = self._takes.shares[first : first + len(again)].mean(axis=0)
        self._owed = LEFT_OVER * self._owed + share * self._phrase_beats
        turn = np.where(share > LEAST_SHARE * share.max(), self._owed, -np.inf)
        for take in np.unique(takes).tolist():
            own = again[:, takes == take]
            turn[take] += SAME_TAKE * float((own.max(axis=1) + own.min(axis=1)).mean())
        return np.asarray(takes == int(turn.argmax()), np.float64)
