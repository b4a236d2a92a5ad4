"""Notes of many players searched and drawn together."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from app.editor.timeline_view import Ghosts
from app.score.model import Note, Part
from app.score.tempo import TempoMap
from tests.gui.timeline.conftest import TPQ, Stage
from widgets.timeline.model.roll.note_table import Behind, NoteTable, Together
from widgets.timeline.roll import drawn_notes
from widgets.timeline.roll.drawn_notes import picture_behind


def table(number: int, *notes: tuple[int, int, int]) -> NoteTable:
    """Table of notes (onset and length in quarters, pitch)."""
    made = tuple(
        Note(f"{number}:{place}", TPQ * onset, TPQ * length, pitch, 80)
        for place, (onset, length, pitch) in enumerate(notes)
    )
    return NoteTable(Part(f"{number}", "", number, 0, 0, None, None, "trumpet_Bb", made), TempoMap(TPQ))


def test_tables_together_are_in_time_and_know_whose_a_note_is() -> None:
    notes = Together([table(1, (0, 9, 60), (2, 1, 62)), table(2), table(3, (1, 1, 50), (4, 1, 52))])
    assert notes.pitch.tolist() == [60, 50, 62, 52]
    assert notes.owner.tolist() == [0, 2, 0, 2]
    assert (np.diff(notes.onset_s) >= 0).all()
    # A quarter is half a second: at 1.8 s only the long note from before sounds, and it is the first to look at.
    assert notes.visible(1.8, 1.9) == slice(0, 3)
    assert notes.visible(4.6, 5.0) == slice(4, 4)


def test_no_one_together_is_nothing() -> None:
    notes = Together([])
    assert notes.visible(0.0, 9.0) == slice(0, 0)


def test_players_behind_are_put_together_again_only_where_they_have_other_notes() -> None:
    one, two, other = table(1, (0, 1, 60)), table(2, (0, 1, 50)), table(2, (0, 1, 51))
    before = Behind([one, two], ["#111111", "#222222"])
    same = Behind([one, two], ["#111111", "#222222"], before)
    assert same.notes is before.notes
    assert same.looks_like(before)
    recoloured = Behind([one, two], ["#111111", "#333333"], before)
    assert recoloured.notes is before.notes
    assert not recoloured.looks_like(before)
    assert Behind([one, other], ["#111111", "#222222"], before).notes is not before.notes
    assert Behind([one], ["#111111"], before).notes is not before.notes


@pytest.mark.parametrize("most", [0, 6000])
def test_notes_behind_lie_where_they_belong_as_points_and_as_rectangles(
    stage: Stage, monkeypatch: pytest.MonkeyPatch, most: int
) -> None:
    monkeypatch.setattr(drawn_notes, "MOST_RECTANGLES", most)
    stage.panel.set_ghosts(Ghosts.ALL)
    stage.panel.axis.fit()
    QApplication.processEvents()
    roll, (colour,) = stage.roll, stage.roll.ghosts().colours
    image = picture_behind(roll, roll.ghosts(), None, 1.0)
    for note in roll.ghosts().tables[0].part.notes:
        left = roll.axis.x_px(stage.session.project.score.tempo_map.seconds(float(note.onset_tick)))
        y = round(roll.y_px(note.pitch + 0.5))
        assert image.pixelColor(int(left) + 1, y).name() == colour.lower()
        assert image.pixelColor(int(left) - 1, y).alpha() == 0
