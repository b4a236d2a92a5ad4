"""The table of actions: palette, shortcuts, menus, states."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QContextMenuEvent, QKeySequence
from PySide6.QtWidgets import QAbstractButton, QApplication, QMenu, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings
from app.errors import Message
from app.messages import LANGUAGES
from app.project.edit.piece import set_title
from app.shell.action import without_dots, without_key
from app.shell.action_rows import rows
from app.shell.actions import CONTEXTS, ActionTable, sequences
from app.shell.app import Program
from app.shell.language import TEXTS
from app.shell.menus import menu_with_keys
from app.shell.window import Window
from tests.gui.shell.conftest import trigger
from tests.support.windows import show_in_front
from widgets.common.actions import actions
from widgets.players.choreography.dancers import MENU, DancersSection


def test_the_table_is_sound() -> None:
    table = rows()
    ids = [row.id for row in table]
    assert len(set(ids)) == len(ids)
    assert {f"menu.{part}" for row in table for part in row.menu.split("/") if part} <= TEXTS.keys()
    assert {row.context for row in table} <= set(CONTEXTS)
    for row in table:
        assert TEXTS[f"action.{row.id}"][0]
        for sequence in sequences(row.shortcut):
            assert sequence.toString(), f"{row.id}: {row.shortcut!r} is no shortcut"


@pytest.mark.parametrize("language", [0, 1], ids=list(LANGUAGES))
def test_no_two_actions_have_the_same_name(language: int) -> None:
    """The palette and the list of shortcuts show the actions of all menus together."""
    ids: dict[str, list[str]] = {}
    for row in rows():
        ids.setdefault(without_dots(without_key(TEXTS[f"action.{row.id}"][language])).casefold(), []).append(row.id)
    assert {name: found for name, found in ids.items() if len(found) > 1} == {}


def test_no_two_actions_have_the_same_shortcut_in_one_place(program: Program) -> None:
    table = program.editor.table
    clashes = {row.id: found for row in table.rows.values() if (found := table.conflicts(row.id, row.shortcut))}
    assert clashes == {}


def test_a_command_has_one_shortcut(program: Program) -> None:
    """Several only if keyboards or systems differ: two Enter keys, plus without Shift, two common keys for redo."""
    several = {row.id for row in program.editor.table.rows.values() if ";" in row.shortcut}
    assert several == {"edit.redo", "notes.louder", "play.bar", "timeline.zoom_in", "viewport.dolly_in"}


def test_menus_show_a_command_with_one_shortcut(program: Program) -> None:
    """A command with the same name in menus of a panel and of the main window has the same shortcut in both."""
    program.editor.table.refresh()
    shown: dict[str, set[tuple[str, ...]]] = {}
    for menu in program.editor.window.findChildren(QMenu):
        for action in menu.actions():
            keys = tuple(sequence.toString() for sequence in action.shortcuts())
            if action.menu() is None and keys:
                shown.setdefault(action.text(), set()).add(keys)
    assert len(shown) > 50
    assert {text: keys for text, keys in shown.items() if len(keys) > 1} == {}


def test_tool_tips_name_the_shortcut(program: Program) -> None:
    assert actions(program.session)["file.save"].toolTip() == "Save (Ctrl+S)"


def test_undo_names_the_step_and_takes_it_back(program: Program, qtbot: QtBot) -> None:
    session = program.session
    undo, redo = actions(session)["edit.undo"], actions(session)["edit.redo"]
    qtbot.waitUntil(lambda: not undo.isEnabled())
    before = session.project
    session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, "Another"))
    qtbot.waitUntil(undo.isEnabled)
    assert undo.text() == "Undo: Set Tempo"
    qtbot.keyClick(program.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert session.project is before
    qtbot.waitUntil(redo.isEnabled)
    assert not undo.isEnabled()
    qtbot.keyClick(
        program.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    )
    assert session.project.score.title == "Another"


def test_the_palette_finds_and_runs(program: Program, qtbot: QtBot) -> None:
    palette = program.window.palette_popup
    qtbot.mouseClick(program.window.palette_field, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(palette.isVisible)
    qtbot.keyClicks(palette.field, "light th")
    assert palette.found()[0] == "theme.light"
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert program.session.tokens.name == "light"
    assert not palette.isVisible()
    # The most recent action is offered first.
    qtbot.keyClick(
        program.window, Qt.Key.Key_P, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    )
    qtbot.waitUntil(palette.isVisible)
    assert palette.found()[0] == "theme.light"
    palette.hide()


def test_the_palette_knows_both_languages(program: Program) -> None:
    program.editor.speak("ja")
    palette = program.window.palette_popup
    palette.field.setText("theme light")
    assert palette.found()[0] == "theme.light"
    palette.field.setText("ライト")
    assert palette.found()[0] == "theme.light"


def test_the_palette_does_not_run_what_makes_no_sense(program: Program, qtbot: QtBot) -> None:
    palette = program.window.palette_popup
    program.editor.table.refresh()
    palette.field.setText("redo")
    assert palette.found()[0] == "edit.redo"
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert program.session.document.undone == ()


def test_a_shortcut_of_ones_own_works_and_is_remembered(program: Program, settings: Settings, qtbot: QtBot) -> None:
    table = program.editor.table
    table.set_keys("theme.light", "Ctrl+Alt+J")
    qtbot.keyClick(program.window, Qt.Key.Key_J, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier)
    assert program.session.tokens.name == "light"
    assert "Ctrl+Alt+J" in actions(program.session)["theme.light"].toolTip()
    settings.sync()
    again = ActionTable(program.session, Settings(settings.path), rows())
    assert again.keys("theme.light") == "Ctrl+Alt+J"
    table.set_keys("theme.light", None)
    assert settings.shortcut("theme.light") is None


def test_a_taken_shortcut_is_reported(program: Program) -> None:
    table = program.editor.table
    assert table.conflicts("theme.light", "Ctrl+S") == ("file.save",)
    assert table.conflicts("file.save", "Ctrl+S") == ()


def test_the_preferences_move_a_shortcut(program: Program, qtbot: QtBot) -> None:
    from app.shell.preferences import show_preferences

    dialog = show_preferences(program.editor, "shortcuts")
    page = dialog.shortcuts
    page.choose("theme.light")
    qtbot.keyClick(page.edit, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert "Save" in page.reported.text()
    qtbot.mouseClick(page.give, Qt.MouseButton.LeftButton)
    assert program.editor.table.keys("theme.light") == "Ctrl+S"
    assert program.editor.table.keys("file.save") == ""
    qtbot.mouseClick(page.all_back, Qt.MouseButton.LeftButton)
    assert program.editor.table.keys("theme.light") == ""
    assert program.editor.table.keys("file.save") == "Ctrl+S"
    dialog.close()


@pytest.mark.parametrize(
    ("language", "reported"), [("en", "opens the menu File"), ("ja", "「ファイル」メニューを開く")]
)
def test_keys_that_open_a_menu_are_not_given(program: Program, qtbot: QtBot, language: str, reported: str) -> None:
    from app.shell.preferences import show_preferences

    program.editor.speak(language)
    dialog = show_preferences(program.editor, "shortcuts")
    page = dialog.shortcuts
    page.choose("theme.light")
    qtbot.keyClick(page.edit, Qt.Key.Key_F, Qt.KeyboardModifier.AltModifier)
    assert reported in page.reported.text()
    assert not page.give.isEnabled()
    qtbot.keyClick(page.edit, Qt.Key.Key_J, Qt.KeyboardModifier.AltModifier)
    assert page.reported.text() == ""
    assert page.give.isEnabled()
    dialog.close()
    program.editor.speak("en")


def test_no_action_comes_with_keys_that_open_a_menu(program: Program) -> None:
    """Checked in both languages."""
    for language in ("en", "ja"):
        program.editor.speak(language)
        found = {row.id: menu_with_keys(row.shortcut) for row in program.editor.table.rows.values()}
        assert {id: menu for id, menu in found.items() if menu} == {}
    program.editor.speak("en")


def test_the_preferences_hold_at_once(program: Program, settings: Settings, qtbot: QtBot) -> None:
    from app.shell.preferences import show_preferences

    dialog = show_preferences(program.editor, "general")
    for name in ("preferences_theme_light", "preferences_middle_c_octave_3", "preferences_time_display_frames"):
        dialog.findChild(QAbstractButton, name).click()
    assert program.session.tokens.name == "light"
    assert program.session.pitch_display.middle_c_octave == 3
    assert program.session.time_display == "frames"
    settings.sync()
    kept = Settings(settings.path)
    assert (kept.theme, kept.middle_c_octave, kept.time_display) == ("light", 3, "frames")
    dialog.close()


def test_a_panel_has_its_shortcut_before_the_window(program: Program, qtbot: QtBot) -> None:
    table = program.editor.table
    table.set_keys("theme.light", "Ctrl+Alt+K")
    table.set_keys("viewport.skeleton", "Ctrl+Alt+K")
    modifiers = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
    window = program.window
    focus(window, "viewport", qtbot)
    qtbot.keyClick(QApplication.focusWidget() or window, Qt.Key.Key_K, modifiers)
    assert program.session.viewport.shows("skeleton")
    assert program.session.tokens.name == "dark"
    window.palette_field.setFocus()
    qtbot.keyClick(window.palette_field, Qt.Key.Key_K, modifiers)
    assert program.session.tokens.name == "light"


def focus(window: Window, panel: str, qtbot: QtBot) -> None:
    """Move the keyboard focus to a panel."""
    show_in_front(window)
    widget = window.panels[panel]
    for candidate in (widget, *widget.findChildren(QPushButton), *widget.findChildren(QWidget)):
        if getattr(candidate, "focusPolicy", lambda: Qt.FocusPolicy.NoFocus)() != Qt.FocusPolicy.NoFocus:
            candidate.setFocus()
            if QApplication.focusWidget() is not None and widget.isAncestorOf(QApplication.focusWidget()):
                return
    pytest.fail(f"nothing in {panel} takes the keyboard")


@pytest.mark.parametrize("code", ["en", "ja"])
def test_no_shortcut_is_the_key_of_a_menu(program: Program, code: str) -> None:
    """Qt would perform neither."""
    program.editor.speak(code)
    menus = {
        QKeySequence.mnemonic(action.text()).toString()
        for action in program.window.menuBar().actions()
        if action.isVisible()
    }
    assert len(menus) == 8
    taken = {
        row.id: keys
        for row in program.editor.table.rows.values()
        if (keys := menus & {sequence.toString() for sequence in sequences(row.shortcut)})
    }
    assert taken == {}


def test_keys_in_the_dancers_are_for_dancers_and_beside_them_for_players(program: Program, qtbot: QtBot) -> None:
    session, window = program.session, program.window
    trigger(program, "dancers.add")
    trigger(program, "dancers.add")
    first, second = session.project.dancers
    players = session.project.players
    session.set_players((players[1].id,))
    show_in_front(window)

    def press(key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        QApplication.processEvents()
        focused = QApplication.focusWidget()
        assert focused is not None
        qtbot.keyClick(focused, key, modifier)

    window.players.findChild(DancersSection).list.setFocus()
    press(Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)
    assert len(session.project.dancers) == 3
    press(Qt.Key.Key_Delete)
    assert session.project.dancers == (first, second)
    assert session.project.players == players
    press(Qt.Key.Key_M)
    assert session.project.players[1].muted
    window.players.list.setFocus()
    press(Qt.Key.Key_Delete)
    assert len(session.project.players) == len(players) - 1
    assert session.project.dancers == (first, second)


def test_the_menu_of_a_dancer_is_that_of_the_table(program: Program, qtbot: QtBot) -> None:
    trigger(program, "dancers.add")
    QApplication.processEvents()
    dancers = program.window.players.findChild(DancersSection)
    at = dancers.list.visualRect(dancers.list.rows.index(0, 0)).center()
    event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, at, dancers.list.viewport().mapToGlobal(at))
    QApplication.sendEvent(dancers.list.viewport(), event)
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    assert [action.objectName() for action in menu.actions()] == list(MENU)
    menu.close()
