"""A part's notes as arrays, for finding visible notes and the note under the mouse quickly."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cached_property
from operator import attrgetter, is_

import numpy as np
import numpy.typing as npt

from app.arrays import BoolArray, FloatArray
from app.score.model import Part
from app.score.tempo import TempoMap


class TimedNotes:
    """Notes ordered by onset, searchable by time.

    Parameters
    ----------
    onset_s, end_s, pitch : array (N,)
        Onset and end in seconds, and pitch, of each of N notes.
    """

    def __init__(self, onset_s: FloatArray, end_s: FloatArray, pitch: FloatArray) -> None:
        self.onset_s, self.end_s, self.pitch = onset_s, end_s, pitch
        # The running maximum of the ends never decreases: bisection finds the first note that reaches into a range.
        self._latest_end_s: FloatArray = np.maximum.accumulate(end_s) if len(end_s) else end_s

    def visible(self, start_s: float, end_s: float) -> slice:
        """Return the range of indices from the first to the last note that sounds between two times; some between may
        not sound then.
        """
        first = int(self._latest_end_s.searchsorted(start_s, side="right"))
        last = int(self.onset_s.searchsorted(end_s, side="left"))
        return slice(first, max(first, last))


class NoteTable(TimedNotes):
    """Arrays with an entry for every note of a part, ordered by onset."""

    def __init__(self, part: Part, tempo: TempoMap) -> None:
        self.part = part
        self.tempo = tempo
        notes = part.notes
        count = len(notes)
        # Three times as fast as a loop, which matters since the first picture needs the notes of all players.
        self.onset_tick: FloatArray = np.fromiter(map(attrgetter("onset_tick"), notes), np.float64, count)
        duration = np.fromiter(map(attrgetter("duration_tick"), notes), np.float64, count)
        pitch = np.fromiter(map(attrgetter("pitch"), notes), np.float64, count)
        self.velocity: FloatArray = np.fromiter(map(attrgetter("velocity"), notes), np.float64, count)
        super().__init__(tempo.seconds(self.onset_tick), tempo.seconds(self.onset_tick + duration), pitch)

    def __len__(self) -> int:
        return len(self.part.notes)

    @cached_property
    def index(self) -> dict[str, int]:
        """Return the index of every note by id."""
        return {note_id: place for place, note_id in enumerate(map(attrgetter("id"), self.part.notes))}

    def flags(self, note_ids: Collection[str]) -> BoolArray:
        """Return for each row of the table (N,) whether its note's id is among ``note_ids``."""
        result = np.zeros(len(self), np.bool_)
        if self.index.keys().isdisjoint(note_ids):
            # The usual case for most players.
            return result
        if len(note_ids) < len(self) // 8:
            found = [self.index[id] for id in note_ids if id in self.index]
            result[found] = True
        else:
            result[:] = np.fromiter((note.id in note_ids for note in self.part.notes), np.bool_, len(self))
        return result

    def at(self, time_s: float, pitch: int, slack_s: float) -> int | None:
        """Return the index of the note at a time and pitch, the last of several; within ``slack_s`` of a note, that
        note if none is nearer.
        """
        near = self.visible(time_s - slack_s, time_s + slack_s)
        rows = np.arange(near.start, near.stop)[self.pitch[near] == pitch]
        if not len(rows):
            return None
        distance = np.maximum(np.maximum(self.onset_s[rows] - time_s, time_s - self.end_s[rows]), 0.0)
        best = len(rows) - 1 - int(np.argmin(distance[::-1]))
        return int(rows[best]) if distance[best] <= slack_s else None

    def nearest(self, time_s: float) -> int | None:
        """Return the index of the note that sounds at a time, else of the nearest one."""
        if not len(self):
            return None
        near = int(self.onset_s.searchsorted(time_s, side="right"))
        rows = np.arange(max(near - 1, 0), min(near + 1, len(self)))
        distance = np.maximum(np.maximum(self.onset_s[rows] - time_s, time_s - self.end_s[rows]), 0.0)
        return int(rows[distance.argmin()])

    def within(self, start_s: float, end_s: float, low_pitch: int, high_pitch: int) -> list[str]:
        """Return the ids of the notes in a rectangle of time and pitch (both pitches included)."""
        near = self.visible(start_s, end_s)
        hit = (self.end_s[near] > start_s) & (self.pitch[near] >= low_pitch) & (self.pitch[near] <= high_pitch)
        return [self.part.notes[place].id for place in (np.flatnonzero(hit) + near.start).tolist()]


class Together(TimedNotes):
    """Notes of several tables merged into one, so that the visible notes of many players are found in one search.

    Attributes
    ----------
    owner : array (N,)
        Index of the table of each note.
    """

    def __init__(self, tables: Sequence[NoteTable]) -> None:
        onset_s, end_s, pitch = (
            np.concatenate([np.empty(0), *(getattr(table, name) for table in tables)])
            for name in ("onset_s", "end_s", "pitch")
        )
        owner = np.repeat(np.arange(len(tables), dtype=np.int16), [len(table) for table in tables])
        # A stable sort recognises runs that are in order already.
        order = np.argsort(onset_s, kind="stable")
        self.owner: npt.NDArray[np.int16] = owner[order]
        super().__init__(onset_s[order], end_s[order], pitch[order])


class Behind:
    """The notes of the inactive players.

    Parameters
    ----------
    colours : sequence of str
        Colour of each table's notes.
    before : Behind, optional
        Previous value, whose combined notes are reused if the tables are the same.
    """

    def __init__(self, tables: Sequence[NoteTable], colours: Sequence[str], before: Behind | None = None) -> None:
        self.tables, self.colours = tuple(tables), tuple(colours)
        same = before is not None and len(before.tables) == len(tables) and all(map(is_, before.tables, tables))
        self.notes: Together = before.notes if before is not None and same else Together(self.tables)

    def looks_like(self, other: Behind) -> bool:
        """Return whether another value has the same notes in the same colours."""
        return self.notes is other.notes and self.colours == other.colours
