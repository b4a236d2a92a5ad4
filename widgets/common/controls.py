"""Widgets that word themselves: what is said once, where they are made, follows the language."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QCheckBox, QPushButton, QWidget

from widgets.common.plain import Label

if TYPE_CHECKING:
    _Mixin = QWidget
else:
    _Mixin = object

AnyWidget = TypeVar("AnyWidget", bound=QWidget)


def named(widget: AnyWidget, name: str) -> AnyWidget:
    """The widget, with this object name."""
    widget.setObjectName(name)
    return widget


class Retranslated(_Mixin):
    """Stands before Qt's class among the bases of a widget, and calls `retranslate` when the language changes."""

    def retranslate(self) -> None:
        """Set every text in the language of the editor."""
        raise NotImplementedError

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class Caption(Retranslated, Label):
    """A label with the text of an id."""

    def __init__(self, text_id: str) -> None:
        super().__init__()
        self._text_id = text_id
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))


class Button(Retranslated, QPushButton):
    """A button with the text of an id; Return in a dialog's field does not press it.

    Parameters
    ----------
    text_id : str
    run : callable
        Called without arguments when it is clicked.
    name : str
        Object name.
    tip_id : str
        Id of its tool tip; empty: none.
    """

    def __init__(self, text_id: str, run: Callable[[], object], name: str = "", tip_id: str = "") -> None:
        super().__init__()
        self._text_id, self._tip_id = text_id, tip_id
        self.setObjectName(name)
        self.setAutoDefault(False)
        self.clicked.connect(lambda _checked: run())
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))
        self.setToolTip(self._tip_id and self.tr(self._tip_id))


class Check(Retranslated, QCheckBox):
    """A box to tick with the text of an id."""

    def __init__(self, text_id: str) -> None:
        super().__init__()
        self._text_id = text_id
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))
