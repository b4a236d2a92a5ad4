"""Commands of the editor itself: command palette, panels, theme, language, and the notation of pitches and times."""

from __future__ import annotations

from collections.abc import Callable
from typing import get_args

from app.editor.design_tokens import THEMES
from app.editor.session import PitchDisplay
from app.messages.pitches import PitchNames
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction, is_open
from app.shell.workspaces import WORKSPACES


def preferences(editor: Editor, page: str = "general") -> None:
    """Open the preferences dialog on a page."""
    from app.shell.preferences import show_preferences

    show_preferences(editor, page)


def instruments(editor: Editor) -> None:
    """Open the dialog of instruments and their fingerings, or bring it to the front."""
    from widgets.dialogs.instrument_map import InstrumentsDialog

    editor.show_once(InstrumentsDialog, lambda: InstrumentsDialog(editor.session, editor.window))


def about(editor: Editor) -> None:
    """Open the dialog with the program's name and version."""
    from app.shell.about import AboutDialog

    AboutDialog(editor.settings.path, editor.window).open()


def _panel(name: str, key: str) -> EditorAction:
    return EditorAction(
        f"panel.{name}",
        lambda editor, shown: editor.window.show_panel(name, shown),
        "view/panels",
        key,
        enabled=is_open,
        checked=lambda editor: editor.window.is_panel_shown(name),
    )


def _workspace(id: str, key: str) -> EditorAction:
    return EditorAction(
        f"workspace.{id}",
        lambda editor, on: editor.window.choose_workspace(id),
        "view/workspace",
        key,
        enabled=is_open,
        checked=lambda editor: editor.window.workspaces.current == id,
    )


def _pitch(id: str, choose: Callable[[PitchDisplay], None], chosen: Callable[[PitchDisplay], bool]) -> Action:
    return Action(
        id,
        lambda session, on: choose(session.pitch_display),
        "view/pitch",
        checked=lambda session: chosen(session.pitch_display),
    )


def _pitch_names(names: PitchNames) -> Action:
    return _pitch(
        f"pitch_names.{names}", lambda display: display.set(names=names), lambda display: display.names == names
    )


def _theme(name: str) -> Action:
    return Action(
        f"theme.{name}",
        lambda session, on: session.set_tokens(THEMES[name]),
        "view/theme",
        checked=lambda session: session.tokens.name == name,
        icon=name,
    )


def _language(code: str) -> EditorAction:
    return EditorAction(
        f"language.{code}",
        lambda editor, on: editor.speak(code),
        "view/language",
        checked=lambda editor: editor.language.code == code,
    )


ACTIONS: tuple[Action | EditorAction, ...] = (
    EditorAction(
        "application.palette", lambda editor: editor.window.show_palette(), "help", "Ctrl+Shift+P", icon="search"
    ),
    EditorAction(
        "application.full_screen",
        lambda editor, on: editor.window.set_full_screen(on),
        "view",
        "F11",
        enabled=is_open,
        checked=lambda editor: editor.window.is_full_screen,
        icon="full_screen",
    ),
    _panel("players", "Ctrl+1"),
    _panel("inspector", "Ctrl+2"),
    _panel("timeline", "Ctrl+3"),
    _panel("recording", "Ctrl+4"),
    *(_workspace(workspace.id, f"Alt+{number}") for number, workspace in enumerate(WORKSPACES, 1)),
    EditorAction(
        "workspace.reset",
        lambda editor: editor.window.reset_workspace(),
        "view/workspace",
        enabled=is_open,
        icon="reset",
    ),
    _pitch("pitch.concert", lambda named: named.set(written=False), lambda named: not named.written),
    _pitch("pitch.written", lambda named: named.set(written=True), lambda named: named.written),
    _pitch("pitch_octave.c4", lambda named: named.set(middle_c_octave=4), lambda named: named.middle_c_octave == 4),
    _pitch("pitch_octave.c3", lambda named: named.set(middle_c_octave=3), lambda named: named.middle_c_octave == 3),
    *(_pitch_names(names) for names in get_args(PitchNames)),
    _theme("dark"),
    _theme("light"),
    _language("en"),
    _language("ja"),
    EditorAction("application.instruments", instruments, "edit", "Ctrl+Alt+I"),
    EditorAction("application.preferences", preferences, "edit", "Ctrl+,", icon="settings"),
    EditorAction("application.shortcuts", lambda editor: preferences(editor, "shortcuts"), "help", icon="keyboard"),
    EditorAction("application.about", about, "help", icon="information"),
)
