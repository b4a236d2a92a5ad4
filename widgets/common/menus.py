"""Menus built from the table of actions."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.session import Session
from widgets.common.actions import actions
from widgets.common.controls import named


def passing_menu(parent: QWidget, name: str = "") -> QMenu:
    """Return a menu that is deleted when it closes."""
    menu = named(QMenu(parent), name)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return menu


def add_actions(menu: QMenu, session: Session, ids: Iterable[str]) -> None:
    """Add actions by id that exist; an empty id is a separator."""
    table = actions(session)
    for id in ids:
        if id in table:
            menu.addAction(table[id])
        elif not id:
            menu.addSeparator()


def offer_actions(session: Session, ids: Iterable[str], parent: QWidget, name: str, at: QPoint) -> None:
    """Open a menu of actions at a point of the screen if there are any; see `add_actions`."""
    if actions(session):
        menu = passing_menu(parent, name)
        add_actions(menu, session, ids)
        menu.popup(at)
