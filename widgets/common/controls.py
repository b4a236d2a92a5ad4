"""Widgets that word themselves: what is said once, where they are made, follows the language."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QCheckBox, QDialogButtonBox, QHeaderView, QPushButton, QToolButton, QTreeWidget, QWidget

from app.editor.session import Session
from app.editor.tokens import LEAST_TARGET_PX
from widgets.common.clicks import on_click
from widgets.common.icons import icon
from widgets.common.plain import Label

if TYPE_CHECKING:
    _Mixin = QWidget
else:
    _Mixin = object

AnyWidget = TypeVar("AnyWidget", bound=QWidget)
AnyLabel = TypeVar("AnyLabel", bound=Label)


def named(widget: AnyWidget, name: str) -> AnyWidget:
    """The widget, with this object name."""
    widget.setObjectName(name)
    return widget


def wrapped(label: AnyLabel) -> AnyLabel:
    """The label, of as many lines as its text needs."""
    label.setWordWrap(True)
    return label


def selectable(label: AnyLabel) -> AnyLabel:
    """The label, whose text can be selected and copied: it has paths or names."""
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def sized(label: AnyLabel, size_pt: float) -> AnyLabel:
    """The label, in letters of this size."""
    font = label.font()
    font.setPointSizeF(size_pt)
    label.setFont(font)
    return label


def small(button: AnyWidget) -> AnyWidget:
    """The button, just large enough to be hit."""
    button.setFixedSize(LEAST_TARGET_PX, LEAST_TARGET_PX)
    return button


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
    """A label with the text of an id, perhaps of a field, which is named by it too."""

    def __init__(self, text_id: str, field: QWidget | None = None) -> None:
        super().__init__()
        self._text_id = text_id
        if field is not None:
            self.setBuddy(field)
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))
        field = self.buddy()
        if field is not None:
            field.setAccessibleName(self.text())


class Button(Retranslated, QPushButton):
    """A button with the text of an id; Return in a dialog's field does not press it.

    Parameters
    ----------
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
        on_click(self, run)
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))
        if self._tip_id:
            self.setToolTip(self.tr(self._tip_id))


class PictureButton(Button):
    """A button with a text and a picture, which may be narrower than its text.

    Parameters
    ----------
    picture : str
        See `icon`.
    text_id, run, name, tip_id
        As of `Button`.
    """

    def __init__(
        self, session: Session, picture: str, text_id: str, run: Callable[[], object], name: str, tip_id: str
    ) -> None:
        super().__init__(text_id, run, name, tip_id)
        self._session, self._picture = session, picture
        self.setMinimumWidth(40)
        session.theme_changed.connect(self._draw)
        self._draw()

    def _draw(self) -> None:
        self.setIcon(icon(self._picture, self._session.tokens))


class IconButton(Retranslated, QToolButton):
    """A small button with a picture alone, which its tip explains.

    Parameters
    ----------
    picture : str
        See `icon`.
    tip_id : str
        Id of its tool tip.
    run : callable
        Called without arguments when it is clicked.
    name : str
        Object name.
    dim : bool
        Whether the picture has the colour of dim text.
    """

    def __init__(
        self, session: Session, picture: str, tip_id: str, run: Callable[[], object], name: str, dim: bool = False
    ) -> None:
        super().__init__()
        self._session, self._picture, self._tip_id, self._dim = session, picture, tip_id, dim
        self.setObjectName(name)
        on_click(self, run)
        session.theme_changed.connect(self._draw)
        self._draw()
        self.retranslate()

    def _draw(self) -> None:
        tokens = self._session.tokens
        self.setIcon(icon(self._picture, tokens, tokens.text_dim if self._dim else None))

    def retranslate(self) -> None:
        self.setToolTip(self.tr(self._tip_id))
        self.setAccessibleName(self.toolTip())


class OkCancel(Retranslated, QDialogButtonBox):
    """What agrees to a dialog and what leaves it, with the texts of two ids.

    Attributes
    ----------
    ok : QPushButton
    """

    def __init__(self, ok_id: str, cancel_id: str) -> None:
        super().__init__(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        self._ok_id, self._cancel_id = ok_id, cancel_id
        self.ok = self.button(QDialogButtonBox.StandardButton.Ok)
        for button in self.buttons():
            button.setIcon(QIcon())
        self.retranslate()

    def retranslate(self) -> None:
        self.ok.setText(self.tr(self._ok_id))
        self.button(QDialogButtonBox.StandardButton.Cancel).setText(self.tr(self._cancel_id))


class Check(Retranslated, QCheckBox):
    """A box to tick with the text of an id."""

    def __init__(self, text_id: str) -> None:
        super().__init__()
        self._text_id = text_id
        self.retranslate()

    def retranslate(self) -> None:
        self.setText(self.tr(self._text_id))


class ColumnList(Retranslated, QTreeWidget):
    """Rows of some columns, all of the same height, without the handles of a tree.

    Parameters
    ----------
    name : str
        Object name.
    *text_ids : str
        Ids of the columns' headings.
    stretches : tuple of int
        Columns that share the room that the others leave.
    """

    def __init__(self, name: str, *text_ids: str, stretches: tuple[int, ...] = (0,)) -> None:
        super().__init__()
        self._text_ids = text_ids
        self.setObjectName(name)
        self.setColumnCount(len(text_ids))
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        for column in stretches:
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Stretch)
        self.retranslate()

    def retranslate(self) -> None:
        self.setHeaderLabels([self.tr(text_id) for text_id in self._text_ids])
