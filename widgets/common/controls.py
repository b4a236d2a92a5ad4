"""Widgets that word themselves: what is said once, where they are made, follows the language."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeVar

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QCheckBox,
    QDialogButtonBox,
    QHeaderView,
    QPushButton,
    QTableWidget,
    QToolButton,
    QTreeWidget,
    QWidget,
)

from app.editor.session import Session
from app.editor.tokens import LEAST_TARGET_PX
from app.editor.translated import tr
from widgets.common.clicks import on_click
from widgets.common.icons import icon
from widgets.common.plain import Label

if TYPE_CHECKING:
    _Mixin = QWidget
else:
    _Mixin = object

AnyWidget = TypeVar("AnyWidget", bound=QWidget)
AnyLabel = TypeVar("AnyLabel", bound=Label)
AnyTexted = TypeVar("AnyTexted", bound=QObject)


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


_SETTERS: Final[dict[str, Callable[[Any], Callable[..., object]]]] = {
    "text": lambda widget: widget.setText,
    "tip": lambda widget: widget.setToolTip,
    "name": lambda widget: widget.setAccessibleName,
    "placeholder": lambda widget: widget.setPlaceholderText,
    "title": lambda window: window.setWindowTitle,
    "heading": lambda group: group.setTitle,
    "suffix": lambda number: number.setSuffix,
    "words": lambda number: lambda *words: number.set_texts(*words),
    "columns": lambda view: lambda *titles: _header(view)(titles),
    "items": lambda box: partial(_set_each, box.setItemText),
    "tabs": lambda tabs: partial(_set_each, tabs.setTabText),
}
"""What takes the text or texts of a widget, by the word for them in `Retranslated.texted`."""


def _header(view: QTreeWidget | QTableWidget) -> Callable[[Sequence[str]], None]:
    return view.setHeaderLabels if isinstance(view, QTreeWidget) else view.setHorizontalHeaderLabels


def _set_each(set_text: Callable[[int, str], object], *texts: str) -> None:
    for index, text in enumerate(texts):
        set_text(index, text)


class Retranslated(_Mixin):
    """Stands before Qt's class among the bases of a widget: its texts follow the language.

    Texts of fixed ids are bound to their widgets by `texted`; `retranslate` sets those that are formatted or chosen.
    """

    _bound: tuple[tuple[QObject | None, str, tuple[str, ...]], ...] = ()
    """Widgets, what is set, and ids; None for this widget, which would keep itself alive."""

    def texted(self, widget: AnyTexted, **text_ids: str | Sequence[str]) -> AnyTexted:
        """The widget, with the texts of these ids, also after a change of the language.

        Parameters
        ----------
        widget : QObject
            What has the texts: this widget, or a part of it that lives as long.
        **text_ids : str or sequence of str
            By what they are: ``text``, ``tip``, ``name`` (the accessible name), ``placeholder``, ``title`` (of a
            window), ``heading`` (of a group), ``suffix``, ``words`` (label, unit and tip of a number, or the title
            of a section); lists: ``columns`` (headings of a table or tree), ``items`` (of a box), ``tabs``. What is
            no id, as ``"%"``, stands for itself.
        """
        for what, ids in text_ids.items():
            bound = (ids,) if isinstance(ids, str) else tuple(ids)
            self._bound += ((None if widget is self else widget, what, bound),)
            _set(widget, what, bound)
        return widget

    def retranslate(self) -> None:
        """Set what else depends on the language of the editor."""

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            for widget, what, ids in self._bound:
                _set(self if widget is None else widget, what, ids)
            self.retranslate()
        super().changeEvent(event)


def _set(widget: QObject, what: str, ids: tuple[str, ...]) -> None:
    _SETTERS[what](widget)(*(tr(text_id) if text_id else "" for text_id in ids))


class Caption(Retranslated, Label):
    """A label with the text of an id, perhaps of a field, which is named by it too."""

    def __init__(self, text_id: str, field: QWidget | None = None) -> None:
        super().__init__()
        self.texted(self, text=text_id)
        if field is not None:
            self.setBuddy(field)
            self.texted(field, name=text_id)


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
        self.setObjectName(name)
        self.setAutoDefault(False)
        on_click(self, run)
        self.texted(self, text=text_id, tip=tip_id)


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
        self._session, self._picture, self._dim = session, picture, dim
        self.setObjectName(name)
        on_click(self, run)
        session.theme_changed.connect(self._draw)
        self._draw()
        self.texted(self, tip=tip_id, name=tip_id)

    def _draw(self) -> None:
        tokens = self._session.tokens
        self.setIcon(icon(self._picture, tokens, tokens.text_dim if self._dim else None))


class OkCancel(Retranslated, QDialogButtonBox):
    """What agrees to a dialog and what leaves it, with the texts of two ids.

    Attributes
    ----------
    ok : QPushButton
    """

    def __init__(self, ok_id: str, cancel_id: str) -> None:
        super().__init__(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        self.ok = self.texted(self.button(QDialogButtonBox.StandardButton.Ok), text=ok_id)
        self.texted(self.button(QDialogButtonBox.StandardButton.Cancel), text=cancel_id)
        for button in self.buttons():
            button.setIcon(QIcon())


class Check(Retranslated, QCheckBox):
    """A box to tick with the text of an id."""

    def __init__(self, text_id: str) -> None:
        super().__init__()
        self.texted(self, text=text_id)


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
        self.setObjectName(name)
        self.setColumnCount(len(text_ids))
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        for column in stretches:
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Stretch)
        self.texted(self, columns=text_ids)
