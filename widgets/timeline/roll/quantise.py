"""Popover for quantising notes: grid, strength, onsets or ends, with a preview."""

from __future__ import annotations

from fractions import Fraction

from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QHideEvent, QKeyEvent
from PySide6.QtWidgets import QCheckBox, QFrame, QGridLayout, QPushButton, QWidget

from app.editor.edit_names import edit_of_notes
from app.editor.session import Session
from app.project.edit import notes
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated
from widgets.common.layouts import STRETCH, in_row
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import ComboBox, Label

GRIDS: tuple[tuple[str, Fraction], ...] = (
    ("1/1", Fraction(4)),
    ("1/2", Fraction(2)),
    ("1/4", Fraction(1)),
    ("1/4 T", Fraction(2, 3)),
    ("1/8", Fraction(1, 2)),
    ("1/8 T", Fraction(1, 3)),
    ("1/16", Fraction(1, 4)),
    ("1/16 T", Fraction(1, 6)),
    ("1/32", Fraction(1, 8)),
    ("1/32 T", Fraction(1, 12)),
)


class QuantisePopover(Retranslated, QFrame):
    """Popover that quantises the selected notes with a preview, as a single undo step; Enter accepts, Escape
    cancels.
    """

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("quantise_popover")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._session = session
        self._token = object()
        self._base = session.project
        self._ours = self._base
        self._kept = False
        self._percent = 100.0
        self.grid_label = self.texted(Label(parent=self), text="quantise_popover.grid")
        self.grid_box = ComboBox(self)
        for name, quarters in GRIDS:
            self.grid_box.addItem(name, quarters)
        self.strength = self.texted(
            NumberSlider(session, 0.0, 100.0, default=100.0, step=5.0, decimals=0, parent=self),
            words=("quantise_popover.strength", "%"),
        )
        self.strength.setMinimumWidth(180)
        self.onsets, self.ends = QCheckBox(self), QCheckBox(self)
        self.onsets.setChecked(True)
        self.keep_button = self.texted(QPushButton(self), text="quantise_popover.quantise")
        self.keep_button.setDefault(True)
        grid = QGridLayout(self)
        grid.setContentsMargins(10, 8, 10, 8)
        grid.addWidget(self.grid_label, 0, 0)
        grid.addWidget(self.grid_box, 0, 1, 1, 2)
        grid.addWidget(self.strength, 1, 0, 1, 3)
        row = in_row(self.onsets, self.ends, STRETCH, self.keep_button)
        grid.addLayout(row, 2, 0, 1, 3)
        self.strength.changed.connect(self._set_strength)
        self.grid_box.currentIndexChanged.connect(self._show)
        self.onsets.toggled.connect(self._show)
        self.ends.toggled.connect(self._show)
        on_click(self.keep_button, self._keep)
        self.texted(self.onsets, text="quantise_popover.beginnings")
        self.texted(self.ends, text="quantise_popover.ends")

    def open_over(self, widget: QWidget) -> None:
        """Open the popover in the middle of a widget, set to the editor's grid."""
        if not self._session.selection.notes:
            return
        self._token, self._base = object(), self._session.project
        self._ours, self._kept = self._base, False
        quarters = [value for _, value in GRIDS]
        if self._session.grid.quarters in quarters:
            self.grid_box.setCurrentIndex(quarters.index(self._session.grid.quarters))
        self.adjustSize()
        middle = QPoint((widget.width() - self.width()) // 2, max((widget.height() - self.height()) // 2, 0))
        self.move(widget.mapToGlobal(middle))
        self.show()
        self.grid_box.setFocus()
        self._show()

    def _set_strength(self, value: float, token: object) -> None:
        self._percent = value
        self.strength.show_value(value)
        self._show()

    def _show(self) -> None:
        if self._session.project is not self._ours or not self.isVisible():
            return
        ids, base = self._session.selection.notes, self._base
        self._session.attempt(
            edit_of_notes(base, "edit.quantise_notes", ids),
            lambda _: notes.quantise(
                base,
                ids,
                self.grid_box.currentData(),
                self._percent / 100.0,
                onsets=self.onsets.isChecked(),
                ends=self.ends.isChecked(),
            ),
            self._token,
            self,
        )
        self._ours = self._session.project

    def _keep(self) -> None:
        self._kept = True
        self.hide()

    # Qt overrides

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride:
            # Keys act on these settings and not on the timeline's shortcuts.
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._keep()
        else:
            super().keyPressEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        if not self._kept and self._session.project is self._ours and self._ours is not self._base:
            self._session.apply(
                edit_of_notes(self._base, "edit.quantise_notes", self._session.selection.notes),
                self._base,
                self._token,
                self,
            )
        self._session.document.end_gesture()
        self._kept = True
