"""What a re-import would do is read before it is done: changes by hand that stay, and those the file overrules."""

from __future__ import annotations

from pathlib import Path

import mido
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QLabel, QListWidget, QTableWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.tokens import LIGHT
from app.project.model import Project
from app.project.reimport import reimport, reimported
from app.shell.language import Language
from instrument_maps.load import bundled_maps
from tests.gui.conftest import quartet_project
from tests.support.windows import child
from tests.unit.project.test_reimport import by_hand, file_with
from tests.unit.project.test_rereading import quintet, tracks, written
from widgets.common.text import note_text
from widgets.dialogs.reimport_midi import ReimportDialog


@pytest.mark.parametrize("language", ["en", "ja"])
def test_conflicts_are_rows_and_what_stays_is_counted(session: Session, qtbot: QtBot, language: str) -> None:
    project = quartet_project()
    first = project.score.parts[0].notes
    edited = by_hand(project, 0, {3: {"pitch": first[3].pitch + 1}, 7: None, 11: {"velocity": 9}})
    new = file_with(project, 0, {3: {"pitch": first[3].pitch - 2}, 7: {"velocity": 9}})
    session.document.open(edited)
    outcome = reimport(edited, new, bundled_maps())
    spoken = Language()
    spoken.set(language)
    try:
        dialog = ReimportDialog(
            edited,
            outcome,
            "quartet.mid",
            lambda correction: "",
            lambda part_id, note: note_text(session, note, session.project.players[0]),
            session.tokens if language == "en" else LIGHT,
        )
        qtbot.addWidget(dialog)
        dialog.show()
        rows = child(dialog, QListWidget, "reimport_conflicts")
        assert rows.isVisible()
        texts = [rows.item(row).text() for row in range(rows.count())]
        assert len(texts) == 2
        part = project.score.parts[0]
        here, there = (
            note_text(session, note, session.project.players[0])
            for note in (edited.score.parts[0].notes[3], outcome.project.score.parts[0].notes[3])
        )
        assert texts[0] == f"{part.name}: {here} → {there}"
        assert texts[1].startswith(f"{part.name}: {'deleted' if language == 'en' else '削除'}")
        table = child(dialog, QTableWidget, "reimport_parts")
        assert [table.item(row, 4).text() for row in range(table.rowCount())] == ["1", "0", "0", "0"]
        assert table.horizontalHeaderItem(0).textAlignment() & Qt.AlignmentFlag.AlignLeft.value
        ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
        with qtbot.waitSignal(dialog.accepted):
            qtbot.mouseClick(ok, Qt.MouseButton.LeftButton)
    finally:
        spoken.set("en")


def changed_quintet(tmp_path: Path) -> tuple[Project, Path, Path]:
    """A quintet, its file, and a newer one without the fourth part and with a flute."""
    path = written(tmp_path / "quintet.mid", tracks())
    flute = mido.MidiTrack([mido.MetaMessage("track_name", name="Flute")])
    for place in range(12):
        flute.append(mido.Message("note_on", note=72 + 5 * place % 12, velocity=80))
        flute.append(mido.Message("note_off", note=72 + 5 * place % 12, time=240))
    newer = written(tmp_path / "newer.mid", [*tracks()[:3], tracks()[4], flute])
    return quintet(path), path, newer


def dialog_of(qtbot: QtBot, before: Project, path: Path) -> ReimportDialog:
    outcome = reimported(before, path, bundled_maps())
    dialog = ReimportDialog(before, outcome, path.name, lambda correction: "", lambda part_id, note: "", LIGHT)
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


@pytest.mark.parametrize("by", ["mouse", "keys"])
def test_a_player_whose_part_is_gone_is_removed_only_if_checked(
    session: Session, qtbot: QtBot, tmp_path: Path, by: str
) -> None:
    project, _, newer = changed_quintet(tmp_path)
    dialog = dialog_of(qtbot, project, newer)
    gone = child(dialog, QListWidget, "reimport_gone")
    assert gone.isVisible()
    assert [gone.item(row).text() for row in range(gone.count())] == [project.players[3].name]
    assert dialog.removed == ()
    if by == "keys":
        gone.setFocus()
        gone.setCurrentRow(0)
        QTest.keyClick(gone, Qt.Key.Key_Space)
    else:
        box = gone.visualItemRect(gone.item(0))
        QTest.mouseClick(gone.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(box.left() + 10, box.center().y()))
    assert dialog.removed == (project.players[3].id,)


def test_a_file_that_says_nothing_new_cannot_be_taken_in(session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    project, path, _ = changed_quintet(tmp_path)
    dialog = dialog_of(qtbot, project, path)
    assert any(label.text() == "quintet.mid contains no changes." for label in dialog.findChildren(QLabel))
    assert not dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).isEnabled()
    assert not dialog.findChild(QListWidget, "reimport_gone").isVisible()


def test_the_same_notes_elsewhere_only_change_which_file_is_used(
    session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    project, path, _ = changed_quintet(tmp_path)
    other = tmp_path / "final.mid"
    other.write_bytes(path.read_bytes())
    dialog = dialog_of(qtbot, project, other)
    assert any("from now on" in label.text() for label in dialog.findChildren(QLabel))
    assert dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).isEnabled()
