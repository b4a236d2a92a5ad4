"""Times of a piece at which a dance may place accents."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.rhythm import Rhythm

SAME_S: Final = 0.05
"""Greatest time in seconds between a hit and a place of the grid that is meant."""
WEAK: Final = 0.0
"""Strength of an additional beat between the beats of the piece."""


@dataclass(frozen=True, eq=False)
class AccentGrid:
    """Grid of G times in a piece at which a dance may place accents: beats, and divisions between them.

    Attributes
    ----------
    times_s : (G,) float64
        Ascending times in seconds.
    on_beat : (G,) bool
        Whether each is on a beat that dancers feel.
    written : (G,) bool, optional
        Whether each is a beat of the piece itself, not one that dancers feel in addition; by default all beats are.
    """

    times_s: FloatArray
    on_beat: BoolArray
    written: BoolArray | None = None

    @cached_property
    def strengths(self) -> FloatArray:
        """Strength (G,) of each grid time for accents: 1 on a beat of the piece, `WEAK` on a beat that dancers feel in
        addition, 0 between beats.
        """
        written = self.on_beat if self.written is None else self.written
        return np.where(written, 1.0, np.where(self.on_beat, WEAK, 0.0))

    @cached_property
    def beats(self) -> FloatArray:
        """Position (G,) of each grid time in beats, counted from the first grid time."""
        on_beat = np.flatnonzero(self.on_beat)
        return np.asarray(np.interp(np.arange(len(self.times_s)), on_beat, np.arange(len(on_beat))))

    def until(self, time_s: float) -> AccentGrid:
        """Return the grid up to its first place at a time or later."""
        count = int(np.searchsorted(self.times_s, time_s - SAME_S)) + 1
        written = None if self.written is None else self.written[:count]
        return AccentGrid(self.times_s[:count], self.on_beat[:count], written)


def grid_of(rhythm: Rhythm) -> AccentGrid:
    """Return the grid of a rhythm: its beats, and the times that divide them as the metre does."""
    beats = rhythm.beats_s
    if len(beats) < 2:
        return AccentGrid(beats, np.ones(len(beats), bool))
    divisions = np.full(len(beats), 2) if rhythm.divisions is None else rhythm.divisions
    places = np.concatenate([at + np.arange(parts) / parts for at, parts in enumerate(divisions[:-1].tolist())])
    places = np.append(places, len(beats) - 1.0)
    on_beat = places % 1.0 == 0.0
    written = None
    if rhythm.written is not None:
        written = on_beat.copy()
        written[on_beat] = rhythm.written
    return AccentGrid(np.interp(places, np.arange(len(beats)), beats), on_beat, written)
