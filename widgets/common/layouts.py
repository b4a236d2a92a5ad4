"""Functions that describe nested layouts: rows, columns and forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, TypeAlias, TypeVar

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtWidgets import (
    QBoxLayout,
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QLayout,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from widgets.common.controls import Caption

STRETCH: Final = None
"""Item that takes the remaining space."""
Part: TypeAlias = QWidget | QLayout
Item: TypeAlias = Part | int | tuple[Part, int] | tuple[QWidget, int, Qt.AlignmentFlag] | None
"""A widget or layout, optionally with a stretch factor and alignment; a gap in pixels; or `STRETCH`."""
Margins: TypeAlias = int | tuple[int, int, int, int]
_FRAME: Final = QSize(40, 80)
"""Space in pixels for a window's frame and the desktop's bars."""
_LEAST_SCROLLED_PX: Final = 200
"""Least height of a scrolled area."""


def in_row(
    *items: Item, of: QWidget | None = None, margins: Margins | None = None, spacing: int | None = None
) -> QHBoxLayout:
    """Return a layout with items from left to right.

    Parameters
    ----------
    *items : Item
    of : QWidget, optional
        Widget that gets the layout.
    margins : int or tuple of int, optional
        Margins in pixels: left, top, right and bottom, or a single value; None for the style's default.
    spacing : int, optional
        Spacing in pixels; None for the style's default.
    """
    return _filled(QHBoxLayout(), items, of, margins, spacing)


def in_column(
    *items: Item, of: QWidget | None = None, margins: Margins | None = None, spacing: int | None = None
) -> QVBoxLayout:
    """Return a layout with items from top to bottom; parameters as in `in_row`."""
    return _filled(QVBoxLayout(), items, of, margins, spacing)


def in_form(rows: Mapping[str, Part], of: QWidget | None = None) -> QFormLayout:
    """Return a form with captions (by text id) and fields; the caption of a nested layout belongs to its
    first field.
    """
    layout = QFormLayout()
    layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    for text_id, part in rows.items():
        layout.addRow(Caption(text_id, _field(part)), part)
    if of is not None:
        of.setLayout(layout)
    return layout


def begin_with_size(dialog: QDialog, size: QSize) -> None:
    """Set the initial size of a dialog, limited to the screen, since Qt's default is at most two thirds of it."""
    dialog.resize(size.boundedTo(room_for(dialog)))


def room_for(dialog: QDialog) -> QSize:
    """Return the size available to a dialog on its screen, without the window frame."""
    return dialog.screen().availableSize() - _FRAME


class _Shrinking(QWidget):
    """Widget whose height follows from its layout, so that wrapped texts are not cut off."""

    # Qt overrides

    def heightForWidth(self, width: int) -> int:
        layout = self.layout()
        return -1 if layout is None else layout.minimumSize().height()


class Scrolled(QScrollArea):
    """A vertically scrolling area that is as large as its contents need.

    Parameters
    ----------
    shrinks : bool
        Whether contents are shrunk to their minimum before they scroll, as for lists and pictures.
    """

    def __init__(self, layout: QLayout, shrinks: bool = False) -> None:
        super().__init__()
        layout.setContentsMargins(0, 0, 0, 0)
        self._contents = _Shrinking() if shrinks else QWidget()
        self._contents.setLayout(layout)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidgetResizable(True)
        self.setWidget(self._contents)

    def _with_bar(self, size: QSize) -> QSize:
        return size + QSize(self.verticalScrollBar().sizeHint().width(), 0)

    def sizeHint(self) -> QSize:
        return self._with_bar(self._contents.sizeHint())

    def minimumSizeHint(self) -> QSize:
        least = self._contents.minimumSizeHint()
        return self._with_bar(QSize(least.width(), min(least.height(), _LEAST_SCROLLED_PX)))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Update the size when the contents request more space."""
        if watched is self._contents and event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


def panel(layout: QLayout) -> QWidget:
    """Return a widget that contains a layout."""
    widget = QWidget()
    widget.setLayout(layout)
    return widget


def _field(part: Part) -> QWidget | None:
    if isinstance(part, QWidget):
        return part
    first = part.itemAt(0)
    return None if first is None else first.widget()


Box = TypeVar("Box", bound=QBoxLayout)


def _filled(
    layout: Box, items: tuple[Item, ...], of: QWidget | None, margins: Margins | None, spacing: int | None
) -> Box:
    if of is not None:
        of.setLayout(layout)
    if margins is not None:
        layout.setContentsMargins(*((margins,) * 4 if isinstance(margins, int) else margins))
    if spacing is not None:
        layout.setSpacing(spacing)
    for item in items:
        _add(layout, item)
    return layout


def _add(layout: QBoxLayout, item: Item) -> None:
    match item:
        case None:
            layout.addStretch(1)
        case int():
            layout.addSpacing(item)
        case QWidget():
            layout.addWidget(item)
        case QLayout():
            layout.addLayout(item)
        case (QWidget() as widget, share, alignment):
            layout.addWidget(widget, share, alignment)
        case (QWidget() as widget, share):
            layout.addWidget(widget, share)
        case (QLayout() as part, share):
            layout.addLayout(part, share)
