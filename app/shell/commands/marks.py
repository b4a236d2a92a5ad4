"""Commands that write marks over the selected notes, or remove them if all selected notes have them."""

from __future__ import annotations

from functools import partial
from typing import Final

from PySide6.QtGui import QCursor

from app.editor.additions import toggle_mark
from app.editor.session import Session
from app.score.marks import WRITABLE, WRITABLE_DYNAMICS
from app.shell.action import Action
from app.shell.commands.choice_menu import choice_menu
from app.shell.commands.command_targets import has_notes, notes_by_player
from widgets.common.actions import actions

KEYS: Final = {
    "slur": "Shift+L",
    "non_legato": "Shift+T",
    "staccato": "Shift+P",
    "tenuto": "Shift+N",
    "accent": "Shift+V",
    "marcato": "Shift+O",
    "breath": "Shift+R",
    "crescendo": "<",
    "diminuendo": ">",
}
"""Shortcuts of marks: those of MuseScore where they are free (not for slur and staccato, since S and Shift+S split
notes).
"""


def toggle(session: Session, kind: str, text: str = "") -> None:
    """Write a musical mark over the selected notes of each player, or remove it if all have it."""
    toggle_mark(session, {player.id: notes for player, notes in notes_by_player(session).items()}, kind, text)


def choose_dynamic(session: Session) -> None:
    """Open a menu of dynamics at the mouse pointer."""
    menu = choice_menu()
    for action in DYNAMICS:
        menu.addAction(actions(session)[action.id])
    menu.popup(QCursor.pos())


def _row(kind: str) -> Action:
    return Action(f"marks.{kind}", partial(toggle, kind=kind), "edit/marks", KEYS.get(kind, ""), "timeline", has_notes)


DYNAMICS: Final = tuple(
    Action(
        f"marks.dynamic_{text}",
        partial(toggle, kind="dynamic", text=text),
        "edit/marks/dynamics",
        context="timeline",
        enabled=has_notes,
    )
    for text in WRITABLE_DYNAMICS
)
"""Commands that write a dynamic."""
ACTIONS: tuple[Action, ...] = (
    *map(_row, WRITABLE),
    Action("marks.dynamic", choose_dynamic, "edit/marks", "Shift+D", "timeline", has_notes),
    *DYNAMICS,
)
