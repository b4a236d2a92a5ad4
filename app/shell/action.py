"""One row of the table of actions."""

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
    """An action of the user; menus, palette, tool tips and shortcuts are all made from this row.

    Its functions are given what it is about: `Action` the session, `app.shell.editor.EditorAction` the whole editor.

    Attributes
    ----------
    id : str
        ``"notes.split"``; settings keep shortcuts by it. Its text is ``"action.notes.split"`` of
        `app.shell.commands.texts`, with a trailing ``...`` where a dialog follows.
    run : callable
        Takes the session or editor (and the checked state, where ``checked`` is given).
    menu : str
        Path of the menu, ``"edit/notes"``, whose parts have their texts as ``"menu.notes"``; empty: only in the
        palette.
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
    hides : bool
        It is in no menu while it makes no sense.
    step : callable, optional
        What it would do now, which its text names; None: nothing.
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
        """Its text in the language of the editor."""
        return tr(f"action.{self.id}")

    @property
    def place(self) -> str:
        """Return where it stands in the menus, in the language of the editor; empty: nowhere."""
        return " › ".join(without_key(tr(f"menu.{part}")) for part in self.menu.split("/") if part)


class Action(ActionRow[Session]):
    """A row about the project and what of it is shown: its functions take the session."""


def without_dots(text: str) -> str:
    """An action's text without dots and marks."""
    return text.replace("&", "").removesuffix("...").removesuffix("…")


def without_key(text: str) -> str:
    """A menu's name without the mark of its key: ``&File``, ``ファイル(&F)``."""
    if text.endswith(")") and "(&" in text:
        text = text[: text.rindex("(&")]
    return text.replace("&", "")
