"""The user's own instruments in the running editor are updated immediately after edits."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton
from pytestqt.qtbot import QtBot

import instrument_maps.library as module
from app.errors import Message
from instrument_maps.library import FOLDER_VARIABLE
from instrument_maps.load import bundled_maps
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start
from widgets.dialogs.instrument_map import InstrumentsDialog

# The first choice of written D 5 is another one here.
OWN = """extends = "trumpet_Bb"
id = "trumpet_Bb"
fingerings = [
  { written_pitch = 74, rank = 1, label = "13" },
]
"""


def write(path: Path, text: str, second: int) -> None:
    path.write_text(text, "utf-8")
    os.utime(path, (second, second))


def test_a_map_that_is_edited_is_played_at_once_and_a_wrong_one_is_reported(
    start: Start, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "mine" / "instruments"
    monkeypatch.setenv(FOLDER_VARIABLE, str(folder))
    monkeypatch.setattr(module.LIBRARY, "last", None)
    program = start()
    session = program.session
    reported: list[tuple[str, dict[str, object]]] = []
    session.noticed.connect(lambda message, severity: reported.append((message.id, dict(message.arguments))))
    program.editor.files.open(QUARTET)
    trumpet = next(player for player in session.project.players if player.instrument_id == "trumpet_Bb")
    trombone = next(player for player in session.project.players if player.instrument_id.startswith("trombone"))

    def labels() -> set[str]:
        notes = {note.id for note in session.project.part(trumpet).notes if note.pitch == 72}
        plan = session.performance.plans[trumpet.id]
        return {event.label for event in plan.fingerings if event.note_id in notes}

    qtbot.waitUntil(lambda: session.performance.project is session.project and session.performance.planned)
    assert labels() <= {"1", "13"}
    before = session.performance
    # The folder is made while the editor runs.
    folder.mkdir(parents=True)
    qtbot.wait(400)
    write(folder / "trumpet_Bb.toml", OWN, 1)
    qtbot.waitUntil(lambda: session.performance is not before and session.performance.planned)
    assert labels() == {"13"}
    assert session.performance.plans[trombone.id] is before.plans[trombone.id]
    assert program.generator.up_to_date
    assert reported[-1] == ("instruments.read_again", {"maps": "trumpet_Bb"})
    # An invalid file is reported with the place of the error; the last valid version stays in use.
    good = session.performance
    write(folder / "trumpet_Bb.toml", OWN.replace('label = "13"', 'label = "19"'), 2)
    qtbot.waitUntil(lambda: reported[-1][0] == "table.invalid")
    assert reported[-1][1]["file"] == str(folder / "trumpet_Bb.toml")
    assert str(reported[-1][1]["place"]).startswith("fingerings[")
    assert labels() == {"13"}
    assert session.performance.instrument(trumpet) is good.instrument(trumpet)
    # The problem stays visible until it is fixed, whatever else is reported.
    session.notice(Message("problems.none"))
    lasting = program.window.status.findChild(QPushButton, "instrument_problems")
    assert lasting.isVisible()
    assert "'19'" in lasting.toolTip()
    QTest.mouseClick(lasting, Qt.MouseButton.LeftButton)
    dialog = program.window.findChild(InstrumentsDialog)
    wrong = dialog.findChild(QLabel, "instruments_wrong")
    assert wrong.isVisible()
    assert str(folder / "trumpet_Bb.toml") in wrong.text()
    assert "'19'" in wrong.text()
    # Saved as editors do, by renaming a new file over the old one: the watch goes on.
    write(folder / "new", OWN.replace('label = "13"', 'label = "1"'), 3)
    (folder / "new").replace(folder / "trumpet_Bb.toml")
    qtbot.waitUntil(lambda: labels() == {"1"})
    assert not lasting.isVisible()
    assert not wrong.isVisible()
    dialog.close()
    # Gone: the bundled one again.
    (folder / "trumpet_Bb.toml").unlink()
    qtbot.waitUntil(lambda: session.performance.instrument(trumpet) is bundled_maps()["trumpet_Bb"])
    monkeypatch.setattr(module.LIBRARY, "last", None)
