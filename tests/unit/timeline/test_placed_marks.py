"""Positions of marks in the piano roll: slurs avoid their notes, glyphs are above their notes, and every kind has a
sign.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.project.edit.marks import Origin
from app.score.marks import MARKINGS, Mark
from app.score.model import Note, Part
from app.score.tempo import TempoMap
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.model.marks.mark_looks import LOOKS
from widgets.timeline.model.marks.mark_table import MarkList, MarkTable
from widgets.timeline.model.marks.placed_marks import MarkRoom, PlacedMarks, placed_marks
from widgets.timeline.model.roll.note_table import NoteTable
from widgets.timeline.model.roll.shown_notes import boxes
from widgets.timeline.model.visible_time import TimeView

TPQ = 480
ROW_PX, WIDTH_PX, HIGHEST = 8.0, 1200, 100.0


class Roll:
    """Eighths of these pitches with marks in a plot of 10 s."""

    def __init__(self, pitches: list[int], marks: list[Mark], origin: Origin = "score") -> None:
        notes = tuple(Note(f"1:{i}", i * TPQ // 2, TPQ // 2 - 20, pitch, 80) for i, pitch in enumerate(pitches))
        part = Part("1.1.1", "Part", 0, 0, 0, None, None, "trumpet_Bb", notes)
        self.notes = NoteTable(part, TempoMap(TPQ))
        self.axis = TimeView((0.0, 10.0), 0.0, 10.0, WIDTH_PX)
        self.table = MarkTable(self.notes, MarkList(dict.fromkeys(marks, origin)))
        room = MarkRoom(self.axis, WIDTH_PX, 800.0, ROW_PX, 14.0, HIGHEST, 0.0, 10.0)
        self.placed = placed_marks(self.table, room)

    @property
    def shown(self) -> PlacedMarks:
        assert self.placed is not None
        return self.placed

    @property
    def boxes(self) -> list[PixelRect]:
        """Boxes of the notes."""
        rows = np.arange(len(self.notes))
        left, top, width, height = boxes(self.notes, rows, self.axis, HIGHEST, ROW_PX)
        return [PixelRect(*map(float, box)) for box in zip(left, top, left + width, top + height, strict=True)]


@given(st.lists(st.integers(50, 85), min_size=3, max_size=12))
def test_a_slur_clears_every_note_between_its_ends(pitches: list[int]) -> None:
    roll = Roll(pitches, [Mark("slur", "1:0", f"1:{len(pitches) - 1}")])
    arcs, notes = roll.shown.arcs, roll.boxes
    assert len(arcs.mark) == 1
    assert notes[0].left <= arcs.x0[0] <= notes[0].right
    assert notes[-1].left <= arcs.x1[0] <= notes[-1].right
    is_above = arcs.lift[0] > 0
    for box in notes[1:-1]:
        x = np.linspace(box.left, box.right, 9)
        y = arcs.y_at(np.zeros(9, np.int64), x)
        assert (y <= box.top + 1.0).all() if is_above else (y >= box.bottom - 1.0).all()


@given(st.lists(st.sampled_from(sorted(LOOKS)), min_size=1, max_size=6, unique=True), st.booleans())
def test_what_stands_on_a_note_lies_over_neither_it_nor_another(kinds: list[str], slurred: bool) -> None:
    marks = [Mark(kind, "1:1", text="1" if LOOKS[kind].is_text else "") for kind in kinds]
    slur = [Mark("slur", "1:0", "1:2")] if slurred else []
    roll = Roll([60, 62, 60, 60], marks + slur)
    shown = roll.shown
    assert len(shown.glyphs.mark) == len(kinds)
    stacked = [place for place, number in enumerate(shown.glyphs.mark.tolist())
               if LOOKS[roll.table.of_player.marks[number].kind].place == "stack"]  # fmt: skip
    found = [shown.box_of_glyph(place) for place in stacked]
    for place, box in enumerate(found):
        assert not box.meets(roll.boxes[1])
        assert roll.boxes[1].left - 12 <= box.left < box.right <= roll.boxes[1].right + 12
        assert not any(box.meets(other) for other in found[place + 1 :])


def test_slurs_within_slurs_lie_below_them() -> None:
    inner, outer = Mark("slur", "1:0", "1:2"), Mark("slur", "1:0", "1:5")
    roll = Roll([64] * 6, [inner, outer])
    arcs = roll.shown.arcs
    by_kind = {roll.table.of_player.marks[number]: place for place, number in enumerate(arcs.mark.tolist())}
    middle = np.array([(arcs.x0[by_kind[inner]] + arcs.x1[by_kind[inner]]) / 2])
    heights = [float(arcs.y_at(np.array([by_kind[mark]]), middle)[0]) for mark in (inner, outer)]
    assert heights[1] < heights[0] - 2.0


def test_marks_of_notes_that_are_gone_are_left_out() -> None:
    roll = Roll([60, 62], [Mark("accent", "1:7"), Mark("slur", "1:0", "1:9"), Mark("tenuto", "1:1")])
    assert [roll.table.of_player.marks[number].kind for number in roll.shown.glyphs.mark] == ["tenuto"]
    assert not len(roll.shown.arcs.mark)


@pytest.mark.parametrize("mark", [Mark("accent", "1:2"), Mark("slur", "1:1", "1:4"), Mark("breath", "1:3")])
def test_a_mark_is_found_where_it_lies(mark: Mark) -> None:
    roll = Roll([60, 62, 64, 62, 60], [mark])
    place = roll.shown.place_of(0)
    assert place is not None
    assert (roll.shown.arc_at if mark.kind == "slur" else roll.shown.glyph_at)(*place) == 0
    assert roll.shown.glyph_at(place[0], place[1] + 60.0) is None
    assert roll.shown.arc_at(place[0], place[1] + 60.0) is None


def test_every_kind_of_a_note_has_a_look() -> None:
    assert set(LOOKS) == {kind.id for kind in MARKINGS if kind.anchor == "note"}
