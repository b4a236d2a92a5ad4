"""Chooses the fingering of a note as it begins in live playing, by the costs of the search, given the notes before
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.plan.fingering.costs import FingeringProblem
from app.plan.fingering.fingering_table import FULLY_AUDIBLE_S, pitch_controls, table_of
from app.plan.fingering.search import best_path, never_worse
from app.plan.fingering.trills_and_runs import TRILL_NOTES
from app.plan.music.piece import LineTimes
from instrument_maps.model import Fingering, InstrumentMap

REMEMBERED = TRILL_NOTES
"""Number of previous notes that are considered, which is enough to detect a trill."""


@dataclass(frozen=True)
class Fingered:
    """A note played live, from ``onset_s`` to ``end_s``; ``column`` is the rank of its fingering."""

    pitch: int
    onset_s: float
    end_s: float
    loudness: float
    column: int


class NextFingering:
    """Chooses fingerings note by note, without knowledge of later notes."""

    def __init__(self, instrument: InstrumentMap) -> None:
        self._low = instrument.range.low
        self._table = table_of(tuple(range(instrument.range.low, instrument.range.high + 1)), instrument)
        self._controls = pitch_controls(instrument)

    def fingering(self, pitch: int, column: int) -> Fingering:
        """Return the fingering with the rank ``column`` of a concert pitch, which must be within the instrument's
        range.
        """
        return self._table.choices[pitch - self._low][column]

    def column(self, before: Sequence[Fingered], pitch: int, onset_s: float, loudness: float) -> int:
        """Choose a fingering for the note that begins now: its rank (0: first choice) among the fingerings of its
        pitch, which must be within the instrument's range.

        Parameters
        ----------
        before : sequence of Fingered
            The notes before, in order; only the last `REMEMBERED` matter.
        """
        if len(self._table.choices[pitch - self._low]) == 1:
            return 0
        notes = [*before[-REMEMBERED:], Fingered(pitch, onset_s, onset_s + FULLY_AUDIBLE_S, loudness, 0)]
        rows = np.array([note.pitch - self._low for note in notes], dtype=np.int64)
        allowed = self._table.valid[rows]
        for index, note in enumerate(notes[:-1]):
            allowed[index] = False
            allowed[index, note.column] = True
        problem = FingeringProblem(_times(notes), self._table, rows, self._controls, allowed)
        return int(never_worse(problem, best_path(problem))[-1])


def _times(notes: Sequence[Fingered]) -> LineTimes:
    onsets_s = np.array([note.onset_s for note in notes])
    ends_s = np.maximum(np.minimum([note.end_s for note in notes], np.append(onsets_s[1:], np.inf)), onsets_s)
    nowhere = np.zeros(len(notes), dtype=np.int64)
    return LineTimes(
        onset_tick=nowhere,
        played_end_tick=nowhere,
        slurs_next=np.zeros(len(notes), dtype=bool),
        silence_tick=nowhere,
        onset_s=onsets_s,
        played_end_s=ends_s,
        pitch=np.array([note.pitch for note in notes], dtype=np.int64),
        loudness=np.array([note.loudness for note in notes]),
        level=np.full(len(notes), -np.inf),
    )
