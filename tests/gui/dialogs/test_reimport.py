"""What a re-import would do is read before it is done: changes by hand that stay, and those the file overrules."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QListWidget, QTableWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.tokens import LIGHT
from app.project.reimport import reimport
from app.shell.language import Language
from instrument_maps.load import bundled_maps
from tests.gui.conftest import quartet_project
from tests.unit.project.test_reimport import by_hand, file_with
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
        rows = dialog.findChild(QListWidget, "reimport_conflicts")
        assert rows is not None
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
        table = dialog.findChild(QTableWidget, "reimport_parts")
        assert table is not None
        assert [table.item(row, 4).text() for row in range(table.rowCount())] == ["1", "0", "0", "0"]
        assert table.horizontalHeaderItem(0).textAlignment() & Qt.AlignmentFlag.AlignLeft.value
        ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
        with qtbot.waitSignal(dialog.accepted):
            qtbot.mouseClick(ok, Qt.MouseButton.LeftButton)
    finally:
        spoken.set("en")
