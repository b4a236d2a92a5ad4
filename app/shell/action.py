"""A row of the table of actions: id, text, shortcut, menu and function."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message

Subject = TypeVar("Subject")


@dataclass(frozen=True)
class ActionRow(Generic[Subject]):
    """A user action, from whose row menus, palette, tool tips and shortcuts are made.

    The functions of a row take the session (`Action`) or the whole editor (`app.shell.editor.EditorAction`).

    Attributes
    ----------
    id : str
        Id such as ``"notes.split"``, under which settings store the action's shortcuts. Its text has the id
        ``"action.notes.split"`` in `app.shell.commands.texts`; the text ends with ``...`` if a dialog opens.
    run : callable
        Performs the action. Takes the session or editor, and also the new checked state if ``checked`` is given.
    menu : str
        Path of the menu, such as ``"edit/notes"``, whose parts have text ids such as ``"menu.notes"``; empty if the
        action is only in the command palette.
    shortcut : str
        Default shortcut as portable text of `QKeySequence`, several separated by ``;``; empty for none.
    context : str
        Where the shortcut works: ``"window"`` or the object name of a panel (``"timeline"``, ``"viewport"``).
    enabled : callable, optional
        Returns whether the action is available; called when the session changes.
    checked : callable, optional
        Returns whether the action is checked; makes it an action with a check mark.
    icon : str
        Name of an icon in ``resources/icons``; empty for none.
    hides : bool
        Whether menus leave the action out while it is unavailable.
    step : callable, optional
        Returns the edit that undo or redo would concern, which the action's text then names.
    """

    about_editor: ClassVar[bool] = False

    id: str
    run: Callable[..., None]
    menu: str = ""
    shortcut: str = ""
    context: str = "window"
    enabled: Callable[[Subject], bool] | None = None
    checked: Callable[[Subject], bool] | None = None
    icon: str = ""
    step: Callable[[Subject], Message | None] | None = None
    hides: bool = False

    @property
    def text(self) -> str:
        """Return the action's text in the editor's language."""
        return tr(f"action.{self.id}")

    @property
    def place(self) -> str:
        """Return the path of the action's menu in the editor's language; empty if it is in no menu."""
        return " › ".join(without_key(tr(f"menu.{part}")) for part in self.menu.split("/") if part)


class Action(ActionRow[Session]):
    """An action on the project and its display, whose functions take the session."""


def without_dots(text: str) -> str:
    """Return an action's text without its final dots and its mnemonic mark (``&``)."""
    return text.replace("&", "").removesuffix("...").removesuffix("…")


def without_key(text: str) -> str:
    """Return a menu's name without its mnemonic mark, as in ``&File`` or ``ファイル(&F)``."""
    if text.endswith(")") and "(&" in text:
        text = text[: text.rindex("(&")]
    return text.replace("&", "")
