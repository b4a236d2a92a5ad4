"""Sections of the guides about parts of the window and dialogs, by object name, for F1 and for help buttons."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QApplication, QMenu, QWidget

_TABLE: Final = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
PLACES: Final[Mapping[str, str]] = _TABLE["parts"]
"""Guide of each object name with the anchor of a heading after ``#``. Other widgets use the entry of the nearest
parent.
"""
ACTIONS: Final[Mapping[str, str]] = _TABLE["actions"]
"""Guide sections of commands by the beginning of their ids; other commands use the section of their menu."""


def place_of(widget: QWidget) -> str:
    """Return the guide section about a widget or the nearest parent that has one."""
    found: QWidget | None = widget
    while found is not None:
        if found.objectName() in PLACES:
            return PLACES[found.objectName()]
        found = found.parentWidget()
    return PLACES["window"]


def place_in_menu(menu: QMenu) -> str:
    """Return the guide section about the command under the mouse in an open menu, or about the menu."""
    chosen = menu.activeAction()
    if chosen is None:
        return place_of(menu)
    known = [start for start in ACTIONS if chosen.objectName().startswith(start)]
    submenu = chosen.menu()
    return ACTIONS[max(known, key=len)] if known else place_of(submenu if isinstance(submenu, QMenu) else menu)


def part_under(pointer: QPoint, window: QWidget) -> QWidget:
    """Return the widget under the pointer if it belongs to the window, else the one with the keyboard focus, else the
    window.
    """
    under = QApplication.widgetAt(pointer)
    part = under
    while part is not None and part is not window:
        part = part.parentWidget()
    if under is not None and part is window:
        return under
    return QApplication.focusWidget() or window
