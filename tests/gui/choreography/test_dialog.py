"""The view of a choreography by mouse and keys, compared with the model and with the generated dance."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.choreography.model import ChoreographyModel
from app.choreography.model_file import write_model
from app.choreography.performed.dancers import dancing_of
from app.editor.session import Session
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.edit.dancers import add_dancer, change_dancers, dancer_edit, remove_dancers, set_choreography
from app.project.model import Project
from app.score.model import PercussionHit, Score
from tests.support.dances import model
from tests.support.windows import child, show_in_front
from widgets.common.percussion_names import percussion_names
from widgets.dialogs.choreography.show import ChoreographyDialog

COWBELL, CLAVES = 56, 75


def learned(states: int, name: str) -> ChoreographyModel:
    """Model that was learned with the cowbell only."""
    made = model(states=states)
    emission = np.full((states, 47), 0.001)
    emission[:, COWBELL - 35] = 1.0 - 0.046
    sources = tuple(replace(source, credits=f"By {source.motion_name} <b>&") for source in made.sources)
    return replace(made, name=name, emission=emission, sources=sources)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("dances")
    for states, name in ((4, "four <b>"), (6, "six")):
        write_model(folder / f"{states}.choreography", learned(states, name))
    return folder / "4.choreography", folder / "6.choreography"


@pytest.fixture
def dialog(session: Session, qtbot: QtBot, files: tuple[Path, Path]) -> ChoreographyDialog:
    """The dialog for two dancers, the second one selected, in a piece with claves."""
    project = replace(session.project, score=with_claves(session.project.score))
    for path in files:
        project, _ = add_dancer(project, path, "Dancer")
    session.apply(Message("edit.add_dancer"), project)
    session.set_performance(Performance(session.project))
    made = ChoreographyDialog(session)
    # The dialog deletes itself when it is closed.
    qtbot.addWidget(made)
    show_in_front(made)
    return made


def with_claves(score: Score) -> Score:
    hits = tuple(PercussionHit(480 * beat, CLAVES, 90) for beat in range(64))
    return msgspec.structs.replace(score, percussion=hits)


def text(dialog: ChoreographyDialog, name: str) -> str:
    return child(dialog, QLabel, f"choreography_{name}").text()


def danced(session: Session) -> Counter[int]:
    assert session.dancer is not None
    return Counter(step.state for step in dancing_of(session.performance, session.dancer).steps())


def press(widget: QWidget, *keys: Qt.Key) -> None:
    widget.setFocus()
    for key in keys:
        QTest.keyClick(widget, key)


def test_the_gallery_counts_what_is_danced_and_goes_by_arrow_keys(session: Session, dialog: ChoreographyDialog) -> None:
    used = danced(session)
    rows = dialog.gallery.rows
    assert rows.rowCount() == 6
    assert used
    assert dict(rows.used) == used
    for state in range(6):
        expected = f"used {used[state]}×" if used[state] else "not used"
        assert rows.used_text(state) == expected
        assert expected in str(rows.index(state).data(Qt.ItemDataRole.AccessibleTextRole))
    assert f"uses {len(used)} of 6 " in text(dialog, "use")
    assert text(dialog, "heading").startswith("six · Basic motions: 6 · Segments: 44")
    assert text(dialog, "motions_details").startswith("Basic motion 1 · ")
    press(dialog.gallery, Qt.Key.Key_Right, Qt.Key.Key_Right)
    shown = text(dialog, "motions_details")
    assert shown.startswith("Basic motion 3 · ")
    own = Counter(one.clip for one in learned(6, "").segments if one.state == 2)
    assert all(f"{name} ({own[clip]})" in shown for clip, name in enumerate(("one", "other")) if own[clip])
    assert "Cowbell (95 %)" in shown


def test_cards_have_figures_in_the_dancers_colour(session: Session, dialog: ChoreographyDialog) -> None:
    assert session.dancer is not None
    colour = QColor(session.colour(session.dancer))
    view = dialog.gallery
    for state in range(3):
        card = view.viewport().grab(view.visualRect(view.rows.index(state))).toImage()
        pixels = [card.pixelColor(x, y) for x in range(card.width()) for y in range(card.height())]
        assert sum(pixel == colour for pixel in pixels) > 30


def test_transitions_are_the_models_percentages_and_the_cell_is_read_out(
    session: Session, dialog: ChoreographyDialog
) -> None:
    dialog.tabs.setCurrentIndex(1)
    table = dialog.transitions.table
    transition = learned(6, "").transition
    for row in range(6):
        for column in range(6):
            shown = table.index(row, column).data()
            assert float(str(shown).replace("·", "0")) == pytest.approx(100 * transition[row, column], abs=0.51)
    press(dialog.transitions, Qt.Key.Key_Down, Qt.Key.Key_Right, Qt.Key.Key_Right)
    assert text(dialog, "transitions_details") == (
        f"Basic motion 2 is followed by 3 with a probability of {100 * transition[1, 2]:.1f} %."
    )
    press(dialog.transitions, Qt.Key.Key_Left)
    assert text(dialog, "transitions_details").startswith("Basic motion 2 repeats with a probability of ")
    assert table.rows.marked == set(danced(session))
    assert not session.document.done[1:]


def test_the_graph_has_an_arrow_for_each_learned_transition(dialog: ChoreographyDialog) -> None:
    dialog.tabs.setCurrentIndex(2)
    graph, transition = dialog.graph, learned(6, "").transition
    seen = {
        (row, column) for row in range(6) for column in range(6) if transition[row][column] > 1.5 * min(transition[row])
    }
    assert set(graph.arrows()) == seen
    assert 0 < len(seen) < 36
    QTest.mouseMove(graph, graph.place(2).toPoint())
    assert graph.looked_at == 2
    assert text(dialog, "graph_details").startswith("Basic motion 3 · ")
    press(graph, Qt.Key.Key_Right)
    assert text(dialog, "graph_details").startswith("Basic motion 4 · ")
    places = [graph.place(state) for state in range(6)]
    assert all(graph.rect().contains(place.toPoint()) for place in places)
    picture = graph.grab().toImage()
    drawn = {
        picture.pixelColor(x, y).rgb() for x in range(0, picture.width(), 3) for y in range(0, picture.height(), 3)
    }
    assert len(drawn) > 10


def test_sounds_are_those_learned_and_those_of_the_piece_which_are_marked(dialog: ChoreographyDialog) -> None:
    dialog.tabs.setCurrentIndex(3)
    table = dialog.percussion.table
    assert table.rows.names == ("Cowbell", "Claves")
    assert table.rows.marked == {1}
    assert [table.index(0, column).data() for column in range(6)] == ["95"] * 6
    assert [table.index(1, column).data() for column in range(6)] == ["·"] * 6
    press(dialog.percussion, Qt.Key.Key_Right)
    assert text(dialog, "percussion_details") == "Cowbell: 95.4 % of the percussion hits during basic motion 2"


def test_credits_are_shown_as_they_are_written(dialog: ChoreographyDialog) -> None:
    assert dialog.credits.isReadOnly()
    assert "one.bvh with one.mid\n\nBy one.bvh <b>&" in dialog.credits.toPlainText()


def test_it_follows_the_selection_and_the_edits(
    session: Session, dialog: ChoreographyDialog, files: tuple[Path, Path], tmp_path: Path
) -> None:
    first, second = session.project.dancers

    def edit(project: Project) -> None:
        session.apply(dancer_edit("seed", ""), project)
        session.set_performance(Performance(session.project))

    session.set_dancer(first.id)
    assert dialog.windowTitle() == f"Choreography of {first.name}"
    assert text(dialog, "heading").startswith("four <b> · ")
    assert dict(dialog.gallery.rows.used) == danced(session)
    edit(change_dancers(session.project, (first.id,), seed=77))
    assert dict(dialog.gallery.rows.used) == danced(session)
    edit(set_choreography(session.project, (first.id,), tmp_path / "gone.choreography"))
    assert "gone.choreography" in text(dialog, "heading")
    assert not dialog.tabs.isVisible()
    session.set_dancer(second.id)
    assert dialog.tabs.isVisible()
    edit(remove_dancers(session.project, (first.id, second.id)))
    assert text(dialog, "heading") == "No dancer is selected."
    assert not dialog.tabs.isVisible()


def test_names_of_the_sounds_are_those_of_general_midi() -> None:
    names = percussion_names()
    assert len(set(names)) == 47
    # General MIDI System Level 1, table 3.
    said = {35: "Acoustic Bass Drum", 42: "Closed Hi-hat", 49: "Crash Cymbal 1", COWBELL: "Cowbell"}
    said |= {60: "High Bongo", 69: "Cabasa", CLAVES: "Claves", 81: "Open Triangle"}
    assert {note: names[note - 35] for note in said} == said


def test_the_button_closes_it(dialog: ChoreographyDialog) -> None:
    button = child(dialog, QPushButton, "choreography_close")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert not dialog.isVisible()
