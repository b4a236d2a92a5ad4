"""The dialog that chooses data from a recording."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot

from app.audio.followed_recording import FollowOptions
from app.editor.session import Session
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from tests.unit.audio.pieces import quartet
from widgets.common.controls import Check
from widgets.dialogs import follow_recording
from widgets.dialogs.follow_recording import FollowRecordingDialog


@pytest.fixture
def dialog(qtbot: QtBot) -> FollowRecordingDialog:
    result = FollowRecordingDialog(Session(quartet(), ImmediateTasks()))
    # Closing would delete the dialog, and qtbot would delete it again.
    result.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(result)
    result.open()
    return result


def press(dialog: FollowRecordingDialog, name: str) -> None:
    QTest.mouseClick(child(dialog, QPushButton, name), Qt.MouseButton.LeftButton)


def test_beats_alone_are_followed_at_first(dialog: FollowRecordingDialog, qtbot: QtBot) -> None:
    with qtbot.waitSignal(dialog.requested) as requested:
        dialog.accept()
    assert requested.args == [FollowOptions()]


def test_dynamics_with_a_recording_of_one_player(
    dialog: FollowRecordingDialog, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(follow_recording, "ask_for_file", lambda *_: Path("/music/second.wav"))
    second = quartet().players[1].id
    press(dialog, "stem_choose_1")
    assert dialog.options == FollowOptions(), "it is disabled without dynamics"
    dynamics = child(dialog, Check, "follow_dynamics")
    QTest.keyClick(dynamics, Qt.Key.Key_Space)
    press(dialog, "stem_choose_1")
    assert dialog.options == FollowOptions(dynamics=True, stems={second: "/music/second.wav"})
    press(dialog, "stem_clear_1")
    assert dialog.options == FollowOptions(dynamics=True)
