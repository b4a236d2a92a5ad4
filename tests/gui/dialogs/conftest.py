"""The export dialog on screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QSpinBox
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from tests.support.windows import child
from widgets.dialogs.export_files import ExportDialog

ShowExport = Callable[..., ExportDialog]


@pytest.fixture
def show_export(qtbot: QtBot, tmp_path: Path) -> ShowExport:
    """Function that shows the dialog for a session with given options."""

    def show(session: Session, **options: object) -> ExportDialog:
        dialog = ExportDialog(session, tmp_path / "out", "quartet.mid", "Suisou test", **options)
        dialog.show()
        return dialog

    return show


@pytest.fixture
def dialog(session: Session, show_export: ShowExport) -> ExportDialog:
    """Export dialog for the bundled quartet."""
    return show_export(session)


def one_player_of_bars(dialog: ExportDialog, last_bar: int) -> None:
    """Choose the first player, bars up to a number and 24 frames a second by mouse and keys."""
    for row in range(1, dialog._players.count()):
        dialog._players.item(row).setCheckState(Qt.CheckState.Unchecked)
    QTest.keyClick(child(dialog, QComboBox, "export_range"), Qt.Key.Key_Down)
    last = child(dialog, QSpinBox, "export_last_bar")
    last.setFocus()
    last.selectAll()
    QTest.keyClicks(last, str(last_bar))
    QTest.keyClick(last, Qt.Key.Key_Tab)
    rate = child(dialog, QComboBox, "export_rate")
    QTest.keyClick(rate, Qt.Key.Key_Home)
    QTest.keyClick(rate, Qt.Key.Key_Down)
    assert rate.currentData() == "24"
