"""Header of a lane: title, fold button, and small controls."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPalette
from PySide6.QtWidgets import QSizePolicy, QToolButton, QWidget

from app.editor.design_tokens import Tokens
from app.editor.translated import tr
from widgets.common.controls import named
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.plain import Label

GUTTER_PX = 144
"""Width of the header of every lane."""


class LaneHeader(QWidget):
    """Header at the left of a lane.

    Signals
    -------
    double_clicked()
        The user double-clicked the title, or a place of the header without a control.
    """

    double_clicked = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setFixedWidth(GUTTER_PX)
        self.setAutoFillBackground(True)
        self.fold_button = named(QToolButton(self), "fold")
        self.fold_button.setAutoRaise(True)
        self.fold_button.setFixedSize(QSize(24, 24))
        self.fold_button.setArrowType(Qt.ArrowType.DownArrow)
        self.name_fold(False)
        self.title = named(Label(parent=self), "lane_title")
        self.title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.title_row = in_row(self.fold_button, (self.title, 1), margins=0, spacing=2)
        self.controls = in_column(margins=(4, 0, 4, 2), spacing=2)
        """Below the title: a lane's own small controls go here."""
        in_column(self.title_row, self.controls, STRETCH, of=self, margins=(2, 1, 4, 0), spacing=0)

    def name_fold(self, folded: bool) -> None:
        """Set the text of the fold button."""
        text = tr("lane.unfold") if folded else tr("lane.fold")
        self.fold_button.setToolTip(text)
        self.fold_button.setAccessibleName(text)

    def show_folded(self, folded: bool) -> None:
        """Show the controls only if the lane is unfolded."""
        for index in range(self.controls.count()):
            item = self.controls.itemAt(index)
            widget = item.widget() if item else None
            if widget is not None:
                widget.setVisible(not folded)
        self.fold_button.setArrowType(Qt.ArrowType.RightArrow if folded else Qt.ArrowType.DownArrow)

    def paint_surface(self, tokens: Tokens) -> None:
        """Colour the header by the theme."""
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.Window, QColor(tokens.surface))
        palette.setColor(QPalette.ColorRole.WindowText, QColor(tokens.text))
        self.setPalette(palette)

    # Qt overrides

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self.double_clicked.emit()
