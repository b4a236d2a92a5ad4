"""The notes of a take without unintended ones.

A wind controller sends a note for whatever the fingers and the breath do: for a finger that is late a note between two
others, for a key that springs back the same note twice, for a fading breath an inaudible note. Legato
notes overlap. Excluded notes are reported, so that they can be shown.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from app.score.take import Cleaning, Controlled, Played, Take

Fault: TypeAlias = Literal["", "ghost", "silent", "slip", "double"]
"""Why a note is excluded: short and soft; no audible breath; a finger that was late; struck twice. Empty: it is
kept."""

SILENT_SHARE: Final = 0.4
"""Hysteresis: a note whose breath stays below this share of `Cleaning.ghost_loudness` is inaudible, however long it
is; above the whole of it it is audible, however short."""
_TOUCHING_S: Final = 0.012
"""Notes this near to one another are legato."""


@dataclass(frozen=True, eq=False)
class Cleaned:
    """The notes of a take, cleaned; all arrays as long as the take's notes.

    Attributes
    ----------
    onsets_s, ends_s : float64
        Of a note that is kept; of an excluded one, as it was played.
    pitches, velocities : int64
    """

    onsets_s: npt.NDArray[np.float64]
    ends_s: npt.NDArray[np.float64]
    pitches: npt.NDArray[np.int64]
    velocities: npt.NDArray[np.int64]
    faults: tuple[Fault, ...]

    @property
    def kept(self) -> list[int]:
        """The notes that stay."""
        return [index for index, fault in enumerate(self.faults) if not fault]


def cleaned(take: Take) -> Cleaned:
    """The notes of a take, cleaned by its settings; kept for the takes that are looked at."""
    return _cleaned(take.played, take.cleaning)


@lru_cache(maxsize=64)
def _cleaned(notes: Played, cleaning: Cleaning) -> Cleaned:
    count = len(notes)
    onsets, ends = notes.onsets_s.copy(), notes.ends_s.copy()
    loudness = loudest(notes)
    breathes = "breath" in notes.curves
    faults: list[Fault] = [""] * count
    held = -1
    for index in range(count):
        length_s = ends[index] - onsets[index]
        short = length_s < cleaning.ghost_s
        soft = loudness[index] < cleaning.ghost_loudness
        if held >= 0 and _is_double(held, index, onsets, ends, notes, cleaning):
            faults[index] = "double"
            ends[held] = max(ends[held], ends[index])
        elif cleaning.ghost_s and breathes and loudness[index] < SILENT_SHARE * cleaning.ghost_loudness:
            faults[index] = "silent"
        elif short and soft:
            faults[index] = "ghost"
        elif short and held >= 0 and _is_between(index, held, onsets, ends, notes):
            # The note before goes on until the one that was meant.
            faults[index] = "slip"
            ends[held] = max(ends[held], onsets[index + 1])
        else:
            held = index
    kept = [index for index, fault in enumerate(faults) if not fault]
    for index, following in pairwise(kept):
        ends[index] = min(ends[index], onsets[following] + cleaning.overlap_s)
    out = np.array([bool(fault) for fault in faults], bool)
    onsets[out], ends[out] = notes.onsets_s[out], notes.ends_s[out]
    return Cleaned(onsets, ends, notes.pitches, notes.velocities, tuple(faults))


def loudest(notes: Played) -> npt.NDArray[np.float64]:
    """How loud each note gets, 0..1: its highest breath; without breath its velocity."""
    breath = notes.curves.get("breath")
    if breath is None:
        return notes.velocities / 127.0
    return highest(breath, notes.onsets_s, notes.ends_s)


def highest(
    curve: Controlled, starts_s: npt.NDArray[np.float64], ends_s: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    """The highest value of a curve in each of some spans, closed at both ends."""
    values = np.concatenate(([0.0], curve.values, [0.0]))
    first = np.searchsorted(curve.times_s, starts_s, side="right")
    last = np.maximum(np.searchsorted(curve.times_s, ends_s, side="right"), first) + 1
    # Pairs of bounds: what lies between a pair's end and the next one's beginning is passed over.
    bounds = np.stack([first, last], axis=1).ravel()
    peaks: npt.NDArray[np.float64] = np.maximum.reduceat(values, bounds)[::2] if len(bounds) else np.empty(0)
    return peaks


def _is_double(
    held: int,
    index: int,
    onsets: npt.NDArray[np.float64],
    ends: npt.NDArray[np.float64],
    notes: Played,
    cleaning: Cleaning,
) -> bool:
    if notes.pitches[held] != notes.pitches[index]:
        return False
    again_s = min(onsets[index] - onsets[held], max(onsets[index] - ends[held], 0.0))
    # Two strokes of the tongue leave longer notes than a key that springs back.
    bounced = (
        ends[index] - onsets[index] < 2 * cleaning.double_s or onsets[index] - onsets[held] < 2 * cleaning.double_s
    )
    return bool(again_s < cleaning.double_s and bounced)


def _is_between(
    index: int, held: int, onsets: npt.NDArray[np.float64], ends: npt.NDArray[np.float64], notes: Played
) -> bool:
    """Whether a note only leads from one note of a legato to the next."""
    if index + 1 >= len(notes):
        return False
    before_s, after_s = onsets[index] - ends[held], onsets[index + 1] - ends[index]
    return bool(before_s <= _TOUCHING_S and after_s <= _TOUCHING_S and ends[index + 1] - onsets[index + 1] > 0.0)
