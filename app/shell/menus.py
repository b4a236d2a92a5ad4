"""The window's menus, made from the table of actions."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from app.editor.translated import tr
from app.shell.action import without_key
from app.shell.actions import ActionTable, written
from widgets.common.controls import Retranslated
from widgets.common.help import ask_for_help

BAR: Final = ("file", "edit", "view", "play", "record", "generate", "export", "help")
"""Menus in the order of the menu bar; their entries have the order of the table."""
BEFORE_LINE: Final = frozenset(
    (
        *("file.save", "file.import_midi", "file.piece_settings", "file.close", "file.quit"),
        *("marks.double_tongue", "marks.breath", "marks.crescendo", "marks.dynamic_sfz"),
        *("application.preferences", "application.about", "workspace.reset", "lanes.stacked", "lanes.unfold_all"),
        "cameras.keep",
    )
)
"""Ids of actions that a separator precedes, besides the separators between groups."""


def menu_with_keys(keys: str) -> str:
    """Return the name, in the editor's language, of the menu that one of these shortcuts opens; empty if none does."""
    requested = written(keys)
    titles = [tr(f"menu.{name}") for name in BAR]
    return next((without_key(title) for title in titles if QKeySequence.mnemonic(title).toString() in requested), "")


class Menu(Retranslated, QMenu):
    """A menu whose title is the last part of its path."""

    def __init__(self, path: str, parent: QWidget) -> None:
        super().__init__(parent)
        self._text_id = f"menu.{path.rpartition('/')[2]}"
        self.setObjectName(f"menu_{path.replace('/', '_')}")
        self.setToolTipsVisible(False)
        self.retranslate()

    def retranslate(self) -> None:
        """Set the menu's title in the language of the editor."""
        self.setTitle(tr(self._text_id))

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Show the guide section about the command under the mouse on F1."""
        if event.key() == Qt.Key.Key_F1:
            ask_for_help(self)
        else:
            super().keyPressEvent(event)


class Menus:
    """The menus of the menu bar, filled with the actions of the table."""

    def __init__(self, bar: QMenuBar, table: ActionTable) -> None:
        self._bar = bar
        self.menus: dict[str, Menu] = {}
        used = {row.menu.split("/")[0] for row in table.rows.values()}
        for name in BAR:
            if name in used:
                self.menu(name)
        last: dict[str, str] = {}
        for row in table.rows.values():
            if not row.menu:
                continue
            menu = self.menu(row.menu)
            subject = row.id.split(".")[0]
            if menu.actions() and (row.id in BEFORE_LINE or last.get(row.menu, subject) != subject):
                menu.addSeparator()
            last[row.menu] = subject
            menu.addAction(table.actions[row.id])
        for menu in self.menus.values():
            menu.aboutToShow.connect(table.refresh)

    def menu(self, path: str) -> Menu:
        """Return the menu at a path, creating it if necessary."""
        if path not in self.menus:
            above = path.rpartition("/")[0]
            parent = self.menu(above) if above else self._bar
            self.menus[path] = Menu(path, parent)
            parent.addMenu(self.menus[path])
        return self.menus[path]
