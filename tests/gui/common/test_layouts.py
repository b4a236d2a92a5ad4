"""Initial sizes of dialogs."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from tests.support.windows import show
from widgets.common.layouts import begin_with_size


def test_a_dialog_begins_with_its_size_though_it_is_most_of_the_screen(qtbot: QtBot) -> None:
    dialog = QDialog()
    qtbot.addWidget(dialog)
    screen = dialog.screen().availableSize()
    size = QSize(int(0.9 * screen.width()), int(0.8 * screen.height()))
    begin_with_size(dialog, size)
    show(dialog)
    assert dialog.size() == size


def test_a_dialog_with_its_frame_fits_the_screen(qtbot: QtBot) -> None:
    dialog = QDialog()
    qtbot.addWidget(dialog)
    screen = dialog.screen().availableSize()
    begin_with_size(dialog, screen * 2)
    assert dialog.width() < screen.width()
    assert dialog.height() < screen.height()
