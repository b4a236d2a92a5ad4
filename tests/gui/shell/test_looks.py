"""The whole editor at 100 and 125 % in both languages: nothing is cut, and nothing is too small to click."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QCheckBox, QHBoxLayout, QLabel, QPushButton, QTabBar, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.shell.app import Program
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start
from tests.support.looks import faults
from tests.support.windows import show
from widgets.common.actions import actions

ROOT = Path(__file__).parents[3]
SCREENS = ("1:dark:1093:614", "1.25:light:1280:800:live")
"""Scale, theme and available size of common screens in device-independent pixels: the smallest (1366 x 768 at 125 %) at
the scale with the widest letters, and one at a scale with fractional lengths. Larger scales leave more space. On the
last screen the language is switched in every state.
"""


@pytest.mark.usefixtures("qapp")
def test_everything_fits() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tests.support.looks", *SCREENS],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=1800,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [f"scale {screen.partition(':')[0]}" for screen in SCREENS]


def test_the_judge_sees_what_does_not_fit(qt_app: QApplication, qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    line = QHBoxLayout(window)
    cut = QLabel("much more than there is room for")
    cut.setFixedWidth(40)
    squeezed = QPushButton("just as much")
    squeezed.setFixedWidth(30)
    small, mute, box = QToolButton(), QToolButton(), QCheckBox("fits")
    small.setToolTip("small")
    small.setFixedSize(16, 16)
    tabs = QTabBar()
    tabs.addTab("a tab with a long name")
    tabs.setFixedWidth(50)
    tabs.setUsesScrollButtons(False)
    for widget in (cut, squeezed, small, mute, box, tabs):
        line.addWidget(widget)
    show(window)
    found = "\n".join(fault for fault in faults(qt_app))
    for expected in ("'much more", "'just as much'", "16 x 16", "its function is not stated", "the tab"):
        assert expected in found, found
    assert "fits" not in found


@pytest.mark.parametrize(("height", "beside"), [(700, "inspector"), (1000, "players")])
def test_in_a_low_window_the_inspector_has_the_whole_height_and_in_a_high_one_the_players(
    start: Start, qtbot: QtBot, height: int, beside: str
) -> None:
    program: Program = start()
    window = program.window
    window.resize(1280, height)
    program.editor.files.open(QUARTET, ask=False)
    timeline = window.docks["timeline"]
    qtbot.waitUntil(lambda: timeline.isVisible() and timeline.height() > 100)
    QApplication.processEvents()
    foot = timeline.geometry().bottom()
    sides = [window.docks[name] for name in ("players", "inspector")]
    assert [dock.objectName() for dock in sides if dock.geometry().bottom() >= foot] == [f"dock_{beside}"]
    (whole,) = [dock for dock in sides if dock.objectName() == f"dock_{beside}"]
    assert timeline.width() == window.width() - whole.width() - 8


def test_the_keys_belong_to_the_notes_from_the_start(program: Program) -> None:
    assert QApplication.focusWidget() is program.window.timeline.roll.plot
    program.window.reset_workspace()
    assert QApplication.focusWidget() is program.window.timeline.roll.plot


def test_a_banner_pushes_no_panel_aside(program: Program, qtbot: QtBot) -> None:
    window = program.window
    window.resize(1093, 614)
    window.reset_workspace()
    QApplication.processEvents()
    before = window.docks["players"].width(), window.docks["inspector"].width()
    window.file_questions.ask_to_save_over(
        Path("a_rather_long_name_of_a_project_that_nobody_would_shorten.suisou"), None
    )
    QApplication.processEvents()
    assert (window.docks["players"].width(), window.docks["inspector"].width()) == before
    buttons = window.banner.findChildren(QPushButton)
    assert all(window.banner.rect().contains(button.geometry()) for button in buttons)


def test_paths_can_be_copied_from_banners_and_dialogs(program: Program) -> None:
    program.window.file_questions.ask_to_save_over(Path("project.suisou"), None)
    for action in ("file.rules", "application.characters"):
        actions(program.session)[action].trigger()
    labels = {label.objectName(): label for top in QApplication.topLevelWidgets() for label in top.findChildren(QLabel)}
    for name in ("banner_text", "rules_folder", "rules_problem", "characters_wrong"):
        assert labels[name].textInteractionFlags() & Qt.TextInteractionFlag.TextSelectableByMouse, name
