"""A player's marks as arrays, assigned to their notes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import repeat
from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.project.edit.marks import Origin
from app.score.marks import MARK_KINDS, Mark
from widgets.timeline.model.geometry import TimeSpans
from widgets.timeline.model.marks.mark_looks import LOOKS
from widgets.timeline.model.roll.note_table import NoteTable

GAP_UNITS = 0.55
"""Gap between a mark and the note or mark below it."""


class MarkList:
    """The marks of one player, independent of its notes.

    Parameters
    ----------
    origins : mapping of Mark to str
        Marks with their origins, as in `app.project.edit.marks.player_marks`.

    Attributes
    ----------
    marks : list of Mark
        The marks.
    by_hand : array (N,)
        Whether the user wrote each mark.
    by_id : dict of str to int
        Index of each mark by its id.
    over_notes, at_notes, at_ticks : array
        Indices of the marks over several notes, at one note, and at ticks.
    order, height, line : array
        For marks at one note: order from the note outwards, heights in units and in lines of text.
    is_stacked, is_outer : array
        For marks at one note: whether stacked above its start, and whether above slurs.
    """

    def __init__(self, origins: Mapping[Mark, Origin]) -> None:
        self.marks = list(origins)
        self.by_hand: BoolArray = np.fromiter((origin == "hand" for origin in origins.values()), np.bool_, len(origins))
        self.by_id = {mark.id: number for number, mark in enumerate(self.marks)}
        numbered = list(enumerate(self.marks))
        self.over_notes = _numbers(number for number, mark in numbered if MARK_KINDS[mark.kind].anchor == "notes")
        self.at_notes = _numbers(number for number, mark in numbered if mark.kind in LOOKS)
        self.at_ticks = _numbers(number for number, mark in numbered if not mark.note_id)
        looks = [LOOKS[self.marks[number].kind] for number in self.at_notes.tolist()]
        self.order = np.array([look.order for look in looks], np.int64)
        self.is_stacked = np.array([look.place == "stack" for look in looks], np.bool_)
        self.is_outer = np.array([not look.under_slur for look in looks], np.bool_)
        self.line = np.array([float(look.is_text and look.place == "stack") for look in looks])
        heights = np.array([look.height + GAP_UNITS for look in looks])
        self.height: FloatArray = np.where(self.is_stacked & (self.line == 0.0), heights, 0.0)


def _numbers(found: object) -> IntArray:
    numbers: IntArray = np.fromiter(found, np.int64)  # type: ignore[call-overload]
    return numbers


class NoteSpans(NamedTuple):
    """Marks over several notes, ascending by the first note.

    Attributes
    ----------
    mark, first, last : array (N,)
        Index of the mark, indices of its first and last note.
    inner : array (N,)
        Number of levels of marks nested within the span, above which it is drawn.
    chained_first, chained_last : array (N,)
        Whether another such mark ends at the first note, and whether one begins at the last note.
    """

    mark: IntArray
    first: IntArray
    last: IntArray
    inner: IntArray
    chained_first: BoolArray
    chained_last: BoolArray


class MarksAtNotes(NamedTuple):
    """Marks at single notes, ascending by the note.

    Attributes
    ----------
    mark, note, last : array (N,)
        Index of the mark, indices of its note and of the last note of its written-out form.
    units, lines : array (N,)
        Height of the marks between it and the note or slur below, in units and in lines of text.
    is_stacked, is_outer : array (N,)
        See `MarkList`.
    """

    mark: IntArray
    note: IntArray
    last: IntArray
    units: FloatArray
    lines: FloatArray
    is_stacked: BoolArray
    is_outer: BoolArray


class MarkTable:
    """The marks of one player, assigned to its notes; marks without notes are omitted.

    Attributes
    ----------
    slurs : NoteSpans
        Marks over several notes.
    spans : TimeSpans
        Time spans of ``slurs``.
    at_notes : MarksAtNotes
        Marks at single notes.
    under_slurs : array (N,)
        Height of the marks on each note below a slur, in units.
    """

    def __init__(self, notes: NoteTable, of_player: MarkList) -> None:
        self.notes, self.of_player = notes, of_player
        self.slurs = self._spanning()
        self.spans = TimeSpans(notes.onset_s[self.slurs.first], notes.end_s[self.slurs.last])
        self.at_notes = self._standing()
        at = self.at_notes
        heights = of_player.height[np.searchsorted(of_player.at_notes, at.mark)]
        inner = ~at.is_outer
        self.under_slurs: FloatArray = np.zeros(len(notes))
        np.add.at(self.under_slurs, at.note[inner], heights[inner])

    def _places(self, numbers: IntArray) -> tuple[IntArray, IntArray]:
        """Return the indices (N,) of the first and of the last note of each mark in ``numbers``, -1 if a note does not
        exist.
        """
        marks, index, count = self.of_player.marks, self.notes.index, len(numbers)
        chosen = [marks[number] for number in numbers.tolist()]
        first = np.fromiter(map(index.get, (mark.note_id for mark in chosen), repeat(-1)), np.int64, count)
        last = np.fromiter(map(index.get, (mark.last_note_id for mark in chosen), repeat(-1)), np.int64, count)
        return first, last

    def _spanning(self) -> NoteSpans:
        mark = self.of_player.over_notes
        first, last = self._places(mark)
        known = np.flatnonzero((first >= 0) & (last > first))
        known = known[np.lexsort((-last[known], first[known]))]
        mark, first, last = mark[known], first[known], last[known]
        return NoteSpans(mark, first, last, _nested(first, last), np.isin(first, last), np.isin(last, first))

    def _standing(self) -> MarksAtNotes:
        its = self.of_player
        first, last = self._places(its.at_notes)
        known = np.flatnonzero(first >= 0)
        # Marks below a slur and marks above it are stacked separately.
        known = known[np.lexsort((its.order[known], its.is_outer[known], first[known]))]
        note, outer = first[known], its.is_outer[known]
        begins = np.append(True, (np.diff(note) != 0) | (np.diff(outer.astype(np.int8)) != 0))[: len(known)]
        stack = np.cumsum(begins) - 1
        units, lines = (_within(column[known], np.flatnonzero(begins), stack) for column in (its.height, its.line))
        latest = np.maximum(last[known], note)
        return MarksAtNotes(its.at_notes[known], note, latest, units, lines, its.is_stacked[known], outer)


def _within(heights: FloatArray, starts: IntArray, stack: IntArray) -> FloatArray:
    """Return for each mark (N,) the total height of the marks below it in the same stack.

    ``stack`` is the index of each mark's stack, ``starts`` the index of the first mark of each stack.
    """
    before = np.cumsum(heights) - heights
    result: FloatArray = before - before[starts][stack]
    return result


def _nested(first: IntArray, last: IntArray) -> IntArray:
    """Return for each span (N,) the number of levels of other spans nested in it; spans ascend by the first note,
    longer ones first."""
    levels = [0] * len(first)
    opened: list[tuple[int, int]] = []
    ends = last.tolist()
    for place in range(len(ends) - 1, -1, -1):
        # Marks behind it in this order begin later or are shorter, so inner marks are on top.
        while opened and opened[-1][0] <= ends[place]:
            levels[place] = max(levels[place], levels[opened.pop()[1]] + 1)
        opened.append((ends[place], place))
    return np.array(levels, np.int64)
