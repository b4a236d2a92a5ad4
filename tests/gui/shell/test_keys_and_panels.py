"""Keys go to the open menu or the focused panel, which is visibly marked."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.editor.selection import Selection
from app.shell.app import Program
from tests.support.windows import child, pause, wait_until
from widgets.common.actions import actions
from widgets.common.combo import Combo
from widgets.timeline.panel import TimelinePanel

KEYS = (Qt.Key.Key_M, Qt.Key.Key_S, Qt.Key.Key_B, Qt.Key.Key_1, Qt.Key.Key_P, Qt.Key.Key_F8, Qt.Key.Key_Delete)


@pytest.fixture
def fired(program: Program) -> list[str]:
    """Ids of the triggered actions."""
    result: list[str] = []
    for id, action in actions(program.session).items():
        action.triggered.connect(lambda *_, id=id: result.append(id))
    return result


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    while (popup := QApplication.activePopupWidget()) is not None:
        popup.close()


def press(program: Program, key: Qt.Key) -> None:
    """Send a key to the window like the display does; the window finds the receiver."""
    pause(1)
    QTest.keyClick(program.window.windowHandle(), key)
    pause(1)


def select_note(program: Program) -> str:
    note = program.session.project.part(program.session.project.players[0]).notes[3]
    program.session.select(Selection(frozenset({note.id})))
    return note.id


@pytest.mark.parametrize("panel", ["timeline", "players"])
def test_no_shortcut_works_behind_an_open_menu(program: Program, fired: list[str], panel: str) -> None:
    select_note(program)
    program.window.panels[panel].setFocus()
    timeline = child(program.window, TimelinePanel)
    before = program.session.project
    for opened in ("menu bar", "lane"):
        if opened == "lane":
            lane = timeline.lanes["fingering"]
            lane.plot.setFocus()
            QTest.mouseClick(lane.plot, Qt.MouseButton.RightButton, pos=lane.plot.rect().center())
        else:
            menu = program.window.menus.menu("edit")
            menu.popup(program.window.mapToGlobal(program.window.rect().center()))
        assert wait_until(lambda: QApplication.activePopupWidget() is not None)
        select_note(program)
        for key in KEYS:
            press(program, key)
            if QApplication.activePopupWidget() is None:
                break
        assert fired == []
        assert program.session.project is before
        while (popup := QApplication.activePopupWidget()) is not None:
            popup.close()


def test_keys_in_an_open_list_choose_in_it(program: Program, fired: list[str]) -> None:
    box = child(program.window, Combo, "player_instrument")
    box.setFocus()
    box.showPopup()
    assert wait_until(box.view().isVisible)
    names = [box.itemText(row) for row in range(box.count())]
    letter = next(name[0] for name in names if name[0] != box.currentText()[0] and name[0] in "MSBPLF")
    press(program, Qt.Key(ord(letter)))
    assert box.view().currentIndex().data()[0] == letter
    for key in KEYS:
        press(program, key)
    assert fired == []


def test_digits_and_p_go_to_the_panel_with_the_mark(program: Program, fired: list[str]) -> None:
    window, session = program.window, program.session
    mark = window.focus_mark
    timeline = child(window, TimelinePanel)
    for panel, done in (("timeline", "fingering.type_1"), ("players", ""), ("timeline", "fingering.type_1")):
        select_note(program)
        target: QWidget = timeline.roll.plot if panel == "timeline" else child(window, Combo, "player_instrument")
        target.setFocus()
        assert QApplication.focusWidget() is target
        assert mark.isVisible()
        assert mark.parentWidget() is window.docks[panel]
        assert mark.width() == window.docks[panel].width()
        fired.clear()
        press(program, Qt.Key.Key_1)
        assert fired == ([done] if done else [])
        posing = session.viewport.posing
        press(program, Qt.Key.Key_P)
        assert session.viewport.posing is not posing
    target.clearFocus()
    assert not mark.isVisible()


def test_digits_in_the_viewport_choose_views(program: Program, fired: list[str]) -> None:
    window = program.window
    button = child(window.viewport, QWidget, "viewport_frame")
    button.setFocus(Qt.FocusReason.TabFocusReason)
    assert window.focus_mark.parentWidget() is window.viewport
    press(program, Qt.Key.Key_5)
    press(program, Qt.Key.Key_P)
    assert fired == ["viewport.hands", "viewport.pose"]
