"""A part's notes as arrays: what is visible, and what lies under the mouse, without a look at every note."""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property
from operator import attrgetter

import numpy as np
import numpy.typing as npt

from app.score.model import Part
from app.score.tempo import TempoMap

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


class NoteTable:
    """Arrays with an entry for every note of a part, ordered by onset.

    Parameters
    ----------
    part : Part
    tempo : TempoMap
    """

    def __init__(self, part: Part, tempo: TempoMap) -> None:
        self.part = part
        self.tempo = tempo
        notes = part.notes
        count = len(notes)
        # A loop of Python's would take three times as long, and the first picture needs every player's notes.
        self.onset_tick: Floats = np.fromiter(map(attrgetter("onset_tick"), notes), np.float64, count)
        duration = np.fromiter(map(attrgetter("duration_tick"), notes), np.float64, count)
        self.pitch: Floats = np.fromiter(map(attrgetter("pitch"), notes), np.float64, count)
        self.velocity: Floats = np.fromiter(map(attrgetter("velocity"), notes), np.float64, count)
        self.onset_s: Floats = tempo.seconds(self.onset_tick)
        self.end_s: Floats = tempo.seconds(self.onset_tick + duration)
        # The latest end so far never falls: the first note that reaches into a range is found by bisection.
        self._latest_end_s: Floats = np.maximum.accumulate(self.end_s) if count else self.end_s

    def __len__(self) -> int:
        return len(self.part.notes)

    def visible(self, start_s: float, end_s: float) -> slice:
        """The notes from the first to the last that sounds between two times (some between may not)."""
        first = int(np.searchsorted(self._latest_end_s, start_s, side="right"))
        last = int(np.searchsorted(self.onset_s, end_s, side="left"))
        return slice(first, max(first, last))

    @cached_property
    def index(self) -> dict[str, int]:
        """Place of every note by id."""
        return {note_id: place for place, note_id in enumerate(map(attrgetter("id"), self.part.notes))}

    def flags(self, note_ids: Collection[str]) -> Flags:
        """Which notes are among these."""
        result = np.zeros(len(self), np.bool_)
        if self.index.keys().isdisjoint(note_ids):
            # So it is for most players.
            return result
        if len(note_ids) < len(self) // 8:
            found = [self.index[id] for id in note_ids if id in self.index]
            result[found] = True
        else:
            result[:] = np.fromiter((note.id in note_ids for note in self.part.notes), np.bool_, len(self))
        return result

    def at(self, time_s: float, pitch: int, slack_s: float) -> int | None:
        """The note at a place, the last of several; a note is caught ``slack_s`` beside itself if none is nearer."""
        near = self.visible(time_s - slack_s, time_s + slack_s)
        rows = np.arange(near.start, near.stop)[self.pitch[near] == pitch]
        if not len(rows):
            return None
        distance = np.maximum(np.maximum(self.onset_s[rows] - time_s, time_s - self.end_s[rows]), 0.0)
        best = len(rows) - 1 - int(np.argmin(distance[::-1]))
        return int(rows[best]) if distance[best] <= slack_s else None

    def within(self, start_s: float, end_s: float, low_pitch: int, high_pitch: int) -> list[str]:
        """Ids of the notes that touch a rectangle of time and pitch (both pitches included)."""
        near = self.visible(start_s, end_s)
        hit = (self.end_s[near] > start_s) & (self.pitch[near] >= low_pitch) & (self.pitch[near] <= high_pitch)
        return [self.part.notes[place].id for place in (np.flatnonzero(hit) + near.start).tolist()]
