"""One row of the table of actions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.editor.session import Session


@dataclass(frozen=True)
class Action:
    """Something the user can do; menus, palette, tool tips and shortcuts all read this row.

    Attributes
    ----------
    id : str
        ``"notes.split"``; settings keep shortcuts by it. Its text is ``"action.notes.split"`` of `app.shell.texts`,
        with a trailing ``...`` where a dialog follows.
    run : callable
        Takes the session (and the checked state, where ``checked`` is given).
    menu : str
        Path of the menu, ``"Edit/Notes"``; empty: only in the palette.
    shortcut : str
        Portable text as of `QKeySequence`; several are separated by ``;``; empty: none by default.
    context : str
        Where the shortcut holds: ``"window"`` or the object name of a panel (``"timeline"``, ``"viewport"``).
    enabled : callable, optional
        Whether it makes sense now; asked when the session changes.
    checked : callable, optional
        Makes it a toggle: whether it is on.
    icon : str
        Name of an icon in ``resources/icons``; empty: none.
    """

    id: str
    run: Callable[..., None]
    menu: str = ""
    shortcut: str = ""
    context: str = "window"
    enabled: Callable[[Session], bool] | None = None
    checked: Callable[[Session], bool] | None = None
    icon: str = ""
