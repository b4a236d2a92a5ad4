"""The guides' places for parts of the window and dialogs, by object names: one table for F1 and the help buttons."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QApplication, QMenu, QWidget

_TABLE: Final = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
PLACES: Final[Mapping[str, str]] = _TABLE["parts"]
"""Guide, and after ``#`` the anchor of its heading. A widget without a place of its own has that of what it is in."""
ACTIONS: Final[Mapping[str, str]] = _TABLE["actions"]
"""Places of commands, by the beginning of their ids; others have that of their menu."""


def place_of(widget: QWidget) -> str:
    """Return the place for a widget: its own, or that of the nearest part it is in."""
    found: QWidget | None = widget
    while found is not None:
        if found.objectName() in PLACES:
            return PLACES[found.objectName()]
        found = found.parentWidget()
    return PLACES["window"]


def place_in_menu(menu: QMenu) -> str:
    """Return the place for the command under the mouse in an open menu, or for the menu where it has none."""
    chosen = menu.activeAction()
    if chosen is None:
        return place_of(menu)
    known = [start for start in ACTIONS if chosen.objectName().startswith(start)]
    submenu = chosen.menu()
    return ACTIONS[max(known, key=len)] if known else place_of(submenu if isinstance(submenu, QMenu) else menu)


def part_under(pointer: QPoint, window: QWidget) -> QWidget:
    """Return the widget under the pointer if it is a part of the window, else the one that has the keyboard, else the
    window."""
    under = QApplication.widgetAt(pointer)
    part = under
    while part is not None and part is not window:
        part = part.parentWidget()
    if under is not None and part is window:
        return under
    return QApplication.focusWidget() or window
