"""Widgets that word themselves: what is said once, where they are made, follows the language."""

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
"""Id of a text, or what makes the text in the language of the editor."""
Wordings = Wording | Sequence[Wording] | Mapping[str, Wording]


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
"""Setter of a widget's text or texts, by its keyword in `Retranslated.texted`."""


def _header(view: QTreeWidget | QTableWidget) -> Callable[[Sequence[str]], None]:
    return view.setHeaderLabels if isinstance(view, QTreeWidget) else view.setHorizontalHeaderLabels


def _explain(widget: QWidget, text: str) -> None:
    widget.setToolTip(text)
    widget.setAccessibleName(text)


def _item_setter(box: ComboBox | QListWidget) -> Callable[[int, str], object]:
    return box.setItemText if isinstance(box, ComboBox) else lambda index, text: box.item(index).setText(text)


def _set_options(box: ComboBox, /, **options: str) -> None:
    """Set the options of a Combo, or the texts of a plain box, which holds their names as data."""
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
    """Stands before Qt's class among the bases of a widget: its texts follow the language.

    Texts are bound to their widgets by `texted`; `retranslate` shows again what else has texts in it.
    """

    _bound: tuple[tuple[QObject | None, str, Wordings], ...] = ()
    """Widgets, what is set, and wordings; None for this widget, which would keep itself alive."""

    def texted(self, widget: AnyTexted, **wordings: Wordings) -> AnyTexted:
        """The widget, with these texts, also after a change of the language.

        Parameters
        ----------
        widget : QObject
            What has the texts: this widget, or a part of it that lives as long.
        **wordings : str, callable, sequence or mapping of them
            Ids, or functions that make a text and do not hold this widget (`said`), by what they are: ``text``,
            ``short`` (of an action on a button), ``tip``, ``name`` (the accessible name), ``explained`` (both),
            ``placeholder``, ``title`` (of a window), ``heading`` (of a group), ``suffix``, ``words`` (label, unit and
            tip of a number, or the title of a section); lists: ``columns`` (headings of a table or tree), ``items``
            (of a box or list), ``tabs``; by id: ``options`` of a box. What is no id, as ``"%"``, stands for itself.
        """
        for what, wording in wordings.items():
            self._bound += ((None if widget is self else widget, what, wording),)
            _set(widget, what, wording)
        return widget

    def retranslate(self) -> None:
        """Show again what else depends on the language of the editor."""

    def word(self) -> None:
        """Set all texts."""
        for widget, what, wording in self._bound:
            _set(self if widget is None else widget, what, wording)
        self.retranslate()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.word()
            if isinstance(self, QDialog) and self.isVisible():
                # Its parts get the event after it.
                QTimer.singleShot(0, self, partial(_fit, self))
        super().changeEvent(event)


def _fit(dialog: QDialog) -> None:
    """Make a dialog as high and as wide as its texts need by now; it does not shrink."""
    layout = dialog.layout()
    if layout is not None:
        layout.activate()
        least = layout.totalMinimumSize().expandedTo(dialog.size())
        dialog.resize(least.width(), max(least.height(), layout.totalHeightForWidth(least.width())))


def said(text_id: str, **arguments: object) -> Callable[[], str]:
    """Return a function that words a text id with arguments, for `Retranslated.texted`."""
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

    def show_picture(self, picture: str) -> None:
        """Show another picture."""
        self._picture = picture
        self._draw()

    def _draw(self) -> None:
        tokens = self._session.tokens
        self.setIcon(icon(self._picture, tokens, tokens.text_dim if self._dim else None))


class OkCancel(Retranslated, QDialogButtonBox):
    """The buttons that accept and cancel a dialog, with the texts of two ids.

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

    def showEvent(self, event: QShowEvent) -> None:
        """Measure the rows again: those that came before the style sheet are as low as their text."""
        super().showEvent(event)
        self.doItemsLayout()
