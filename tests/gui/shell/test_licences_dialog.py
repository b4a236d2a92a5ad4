"""The list of licences."""

from __future__ import annotations

from PySide6.QtWidgets import QTreeWidget
from pytestqt.qtbot import QtBot

from app.shell.licences import installed
from app.shell.licences_dialog import LicencesDialog
from tests.support.windows import child


def test_it_lists_packages_with_their_parts_and_the_data(qtbot: QtBot) -> None:
    dialog = LicencesDialog()
    qtbot.addWidget(dialog)
    dialog.show()
    rows = child(dialog, QTreeWidget, "licences_list")
    packages = [rows.topLevelItem(index) for index in range(rows.topLevelItemCount())]
    assert [row.text(0) for row in packages[:-1]] == [package.name for package in installed()]
    films = next(row for row in packages if row.text(0) == "imageio-ffmpeg")
    assert films.isExpanded()
    assert (films.child(0).text(0), films.child(0).text(2)) == ("FFmpeg", "GPL-3.0-or-later")
    assert packages[-1].childCount() > 3
    assert all(row.text(2) and row.text(3) for row in packages[:-1])
