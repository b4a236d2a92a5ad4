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

    Its functions take the session (`Action`) or the whole editor (`app.shell.editor.EditorAction`).

    Attributes
    ----------
    id : str
        Id such as ``"notes.split"``, by which settings store shortcuts. Its text id is ``"action.notes.split"`` in
        `app.shell.commands.texts`; the text ends with ``...`` if a dialog follows.
    run : callable
        Takes the session or editor, and the checked state if ``checked`` is given.
    menu : str
        Path of the menu, ``"edit/notes"``, whose parts have text ids such as ``"menu.notes"``; empty: only in the
        palette.
    shortcut : str
        Portable text as in `QKeySequence`; several separated by ``;``; empty: none by default.
    context : str
        Scope of the shortcut: ``"window"`` or the object name of a panel (``"timeline"``, ``"viewport"``).
    enabled : callable, optional
        Returns whether it is available; called when the session changes.
    checked : callable, optional
        Makes it a toggle: returns whether it is on.
    icon : str
        Name of an icon in ``resources/icons``; empty: none.
    hides : bool
        Whether it is hidden in menus while unavailable.
    step : callable, optional
        Returns the step it would undo or redo, for its text; None: none.
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
        """Text in the editor's language."""
        return tr(f"action.{self.id}")

    @property
    def place(self) -> str:
        """Return the menu path in the editor's language; empty: none."""
        return " › ".join(without_key(tr(f"menu.{part}")) for part in self.menu.split("/") if part)


class Action(ActionRow[Session]):
    """An action on the project and its display, whose functions take the session."""


def without_dots(text: str) -> str:
    """Text of an action without dots and mnemonic marks."""
    return text.replace("&", "").removesuffix("...").removesuffix("…")


def without_key(text: str) -> str:
    """Name of a menu without its mnemonic mark: ``&File``, ``ファイル(&F)``."""
    if text.endswith(")") and "(&" in text:
        text = text[: text.rindex("(&")]
    return text.replace("&", "")
