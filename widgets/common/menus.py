"""Menus of the table of actions."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QMenu, QWidget

from widgets.common.controls import named
from widgets.common.session import Session


def passing_menu(parent: QWidget, name: str = "") -> QMenu:
    """A menu that is gone when it closes."""
    menu = named(QMenu(parent), name)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return menu


def offer_actions(session: Session, ids: Iterable[str], parent: QWidget, name: str, at: QPoint) -> None:
    """Open a menu of these actions at a place of the screen; an empty id is a line."""
    menu = passing_menu(parent, name)
    for id in ids:
        if id in session.actions:
            menu.addAction(session.actions[id])
        elif not id:
            menu.addSeparator()
    menu.popup(at)
