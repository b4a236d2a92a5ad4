"""Widgets whose texts follow the language: a text is set once by id."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeVar

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QIcon, QShowEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QListWidget,
    QPushButton,
    QTableWidget,
    QToolButton,
    QTreeWidget,
    QWidget,
)

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.editor.translated import tr
from widgets.common.clicks import on_click
from widgets.common.combo import Combo, Option
from widgets.common.icons import icon
from widgets.common.plain import ComboBox, Label

if TYPE_CHECKING:
    _Mixin = QWidget
else:
    _Mixin = object

AnyWidget = TypeVar("AnyWidget", bound=QWidget)
AnyLabel = TypeVar("AnyLabel", bound=Label)
AnyTexted = TypeVar("AnyTexted", bound=QObject)
Wording = str | Callable[[], str]
"""Text id, or a function that returns a text in the editor's language."""
Wordings = Wording | Sequence[Wording] | Mapping[str, Wording]


def named(widget: AnyWidget, name: str) -> AnyWidget:
    """Return the widget after setting its object name."""
    widget.setObjectName(name)
    return widget


def wrapped(label: AnyLabel) -> AnyLabel:
    """Return the label after enabling word wrap."""
    label.setWordWrap(True)
    return label


def selectable(label: AnyLabel) -> AnyLabel:
    """Return the label after making its text selectable, as for paths and names."""
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def sized(label: AnyLabel, size_pt: float) -> AnyLabel:
    """Return the label after setting its font size in points."""
    font = label.font()
    font.setPointSizeF(size_pt)
    label.setFont(font)
    return label


def small(button: AnyWidget) -> AnyWidget:
    """Return a button after setting it to the least size that is easy to click."""
    button.setFixedSize(LEAST_TARGET_PX, LEAST_TARGET_PX)
    return button


_SETTERS: Final[dict[str, Callable[[Any], Callable[..., object]]]] = {
    "text": lambda widget: widget.setText,
    "short": lambda action: action.setIconText,
    "tip": lambda widget: widget.setToolTip,
    "name": lambda widget: widget.setAccessibleName,
    "placeholder": lambda widget: widget.setPlaceholderText,
    "title": lambda window: window.setWindowTitle,
    "heading": lambda group: group.setTitle,
    "suffix": lambda number: number.setSuffix,
    "words": lambda number: lambda *words: number.set_texts(*words),
    "columns": lambda view: lambda *titles: _header(view)(titles),
    "explained": lambda widget: partial(_explain, widget),
    "items": lambda box: partial(_set_each, _item_setter(box)),
    "options": lambda box: partial(_set_options, box),
    "tabs": lambda tabs: partial(_set_each, tabs.setTabText),
}
"""Functions that return the setter of a widget's text, by keyword of `Retranslated.texted`."""


def _header(view: QTreeWidget | QTableWidget) -> Callable[[Sequence[str]], None]:
    return view.setHeaderLabels if isinstance(view, QTreeWidget) else view.setHorizontalHeaderLabels


def _explain(widget: QWidget, text: str) -> None:
    widget.setToolTip(text)
    widget.setAccessibleName(text)


def _item_setter(box: ComboBox | QListWidget) -> Callable[[int, str], object]:
    return box.setItemText if isinstance(box, ComboBox) else lambda index, text: box.item(index).setText(text)


def _set_options(box: ComboBox, /, **options: str) -> None:
    """Set the option texts of a Combo, or the item texts of a plain box whose data are the option names."""
    if isinstance(box, Combo):
        box.set_options([Option(id, text) for id, text in options.items()])
    elif box.count():
        _set_each(box.setItemText, *options.values())
    else:
        for id, text in options.items():
            box.addItem(text, id)


def _set_each(set_text: Callable[[int, str], object], *texts: str) -> None:
    for index, text in enumerate(texts):
        set_text(index, text)


class Retranslated(_Mixin):
    """Mixin that precedes the Qt class among a widget's bases, so that its texts follow the language.

    Texts are bound to widgets by `texted`; `retranslate` updates all other texts.
    """

    _bound: tuple[tuple[QObject | None, str, Wordings], ...] = ()
    """Widgets with their kinds of text and wordings; None stands for this widget, to avoid a reference cycle."""

    def texted(self, widget: AnyTexted, **wordings: Wordings) -> AnyTexted:
        """Return a widget after setting texts that follow the language.

        Parameters
        ----------
        widget : QObject
            This widget, or a part of it with the same lifetime.
        **wordings : str, callable, sequence or mapping of them
            Text ids, or functions that return a text without a reference to this widget (`said`), by kind: ``text``,
            ``short`` (a short text for a button), ``tip``, ``name`` (the accessible name), ``explained`` (tip and
            name), ``placeholder``, ``title`` (of a window), ``heading`` (of a group), ``suffix``, ``words`` (label,
            unit and tip of a number, or the title of a section); lists: ``columns`` (headings of a table or tree),
            ``items`` (of a box or list), ``tabs``; by id: ``options`` of a box. Texts that are no ids, such as ``"%"``,
            are used unchanged.
        """
        for what, wording in wordings.items():
            self._bound += ((None if widget is self else widget, what, wording),)
            _set(widget, what, wording)
        return widget

    def retranslate(self) -> None:
        """Update all texts that are not bound by `texted`; widgets with such texts override this."""

    def word(self) -> None:
        """Set all texts of the widget again after a change of language."""
        for widget, what, wording in self._bound:
            _set(self if widget is None else widget, what, wording)
        self.retranslate()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.word()
            if isinstance(self, QDialog) and self.isVisible():
                # The child widgets receive the event after this one.
                QTimer.singleShot(0, self, partial(_fit, self))
        super().changeEvent(event)


def _fit(dialog: QDialog) -> None:
    """Enlarge a dialog to fit its texts; it does not shrink."""
    layout = dialog.layout()
    if layout is not None:
        layout.activate()
        least = layout.totalMinimumSize().expandedTo(dialog.size())
        dialog.resize(least.width(), max(least.height(), layout.totalHeightForWidth(least.width())))


def said(text_id: str, **arguments: object) -> Callable[[], str]:
    """Return a function that returns a text with arguments, for `Retranslated.texted`."""
    return lambda: tr(text_id).format(**arguments)


def _set(widget: QObject, what: str, wordings: Wordings) -> None:
    set_texts = _SETTERS[what](widget)
    if isinstance(wordings, Mapping):
        set_texts(**{key: _text(wording) for key, wording in wordings.items()})
    else:
        each = (wordings,) if isinstance(wordings, str) or callable(wordings) else wordings
        set_texts(*map(_text, each))


def _text(wording: Wording) -> str:
    return (tr(wording) if wording else "") if isinstance(wording, str) else wording()


class Caption(Retranslated, Label):
    """A label with a text by id, optionally the caption of a field."""

    def __init__(self, text_id: str, field: QWidget | None = None) -> None:
        super().__init__()
        self.texted(self, text=text_id)
        if field is not None:
            self.setBuddy(field)
            self.texted(field, name=text_id)


class Button(Retranslated, QPushButton):
    """A button with a text by id, which Return in a dialog's field does not press.

    Parameters
    ----------
    run : callable
        Function without arguments, called on a click.
    name : str
        Object name.
    tip_id : str
        Id of the tool tip; empty for none.
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
        See `Button`.
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
    """A small button with a picture and a tool tip.

    Parameters
    ----------
    picture : str
        See `icon`.
    tip_id : str
        Id of the tool tip.
    run : callable
        Function without arguments, called on a click.
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

    def show_picture(self, picture: str) -> None:
        """Replace the icon of the button by the one with the name ``picture``."""
        self._picture = picture
        self._draw()

    def _draw(self) -> None:
        tokens = self._session.tokens
        self.setIcon(icon(self._picture, tokens, tokens.text_dim if self._dim else None))


class OkCancel(Retranslated, QDialogButtonBox):
    """The buttons that accept and cancel a dialog, with texts by two ids.

    Attributes
    ----------
    ok : QPushButton
        The accepting button.
    """

    def __init__(self, ok_id: str, cancel_id: str) -> None:
        super().__init__(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        self.ok = self.texted(self.button(QDialogButtonBox.StandardButton.Ok), text=ok_id)
        self.texted(self.button(QDialogButtonBox.StandardButton.Cancel), text=cancel_id)
        for button in self.buttons():
            button.setIcon(QIcon())


class Check(Retranslated, QCheckBox):
    """A check box with a text by id."""

    def __init__(self, text_id: str) -> None:
        super().__init__()
        self.texted(self, text=text_id)


class ColumnList(Retranslated, QTreeWidget):
    """A list with columns and rows of equal height.

    Parameters
    ----------
    name : str
        Object name.
    *text_ids : str
        Ids of the columns' headings.
    stretches : tuple of int
        Columns that share the remaining width.
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

    def showEvent(self, event: QShowEvent) -> None:
        """Update the row heights, since rows made before the style sheet are too low."""
        super().showEvent(event)
        self.doItemsLayout()
