"""Commands of the help menu: the guides, and the section of a guide about a part of the window."""

from __future__ import annotations

from PySide6.QtGui import QCursor
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from app.shell.editor import Editor, EditorAction
from app.shell.first_steps.tour import FirstSteps
from app.shell.help.guides import names
from app.shell.help.places import part_under, place_in_menu, place_of
from app.shell.help.window import HelpWindow


def guides(editor: Editor) -> None:
    """Open the guides at the section read last, or at the guide about the window."""
    window = _help_window(editor)
    name, number = window.place or (names()[0], 0)
    window.read(name, number)


def help_here(editor: Editor) -> None:
    """Open the section of a guide about the widget under the mouse, or about the one with the keyboard focus."""
    help_about(editor, part_under(QCursor.pos(), editor.window))


def help_about(editor: Editor, part: QWidget) -> None:
    """Open the section of a guide about a widget, or about the command chosen in a menu."""
    place = place_in_menu(part) if isinstance(part, QMenu) else place_of(part)
    while (menu := QApplication.activePopupWidget()) is not None:
        menu.close()
    name, _, anchor = place.partition("#")
    _help_window(editor).read(name, anchor)


def _help_window(editor: Editor) -> HelpWindow:
    return editor.window.findChild(HelpWindow) or HelpWindow(editor.session, editor.language, editor.window)


def first_steps(editor: Editor) -> None:
    """Start the tour, or bring a running tour into view."""
    (editor.window.findChild(FirstSteps) or FirstSteps(editor)).begin()


ACTIONS: tuple[EditorAction, ...] = (
    EditorAction("help.first_steps", first_steps, "help"),
    EditorAction("help.guides", guides, "help", icon="help"),
    EditorAction("help.here", help_here, "help", "F1", icon="pointer"),
)
