"""Choice of bars to export or evaluate: all, some, or those of the selection."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDoubleSpinBox, QSpinBox, QWidget

from app.editor.session import Session
from app.project import limits
from app.score.model import Score
from widgets.common.controls import Retranslated, named
from widgets.common.layouts import in_row
from widgets.common.plain import ComboBox, Label

_WHOLE, _BARS, _SELECTION = "whole", "bars", "selection"
TEXT_MARGIN_PX = 6
"""Left margin of the text in pixels as in other fields, since the style sheet does not affect spin boxes."""


class BeatsBox(QDoubleSpinBox):
    """Field for a number of felt beats before something."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self.setRange(*limits.PREROLL_BEATS)
        self.setSingleStep(1.0)
        self.setDecimals(2)


class RangeChooser(Retranslated, QWidget):
    """Choice of a range, with fields for the first and last bar.

    Parameters
    ----------
    session : Session
        Session with the selection.
    score : Score
        Score with the bars.
    parent : QWidget, optional
    prefix : str
        Prefix of the fields' object names.
    otherwise_id : str
        Text id of the choice that means no range of bars.
    """

    changed = Signal()

    def __init__(
        self,
        session: Session,
        score: Score,
        parent: QWidget | None = None,
        prefix: str = "export",
        otherwise_id: str = "range_chooser.whole_piece",
    ) -> None:
        super().__init__(parent)
        self._session, self._score = session, score
        choices = {_WHOLE: otherwise_id, _BARS: "range_chooser.bars"}
        if session.selection.span is not None:
            choices[_SELECTION] = "range_chooser.selected_bars"
        self._choice = self.texted(named(ComboBox(), f"{prefix}_range"), options=choices)
        self._first_bar, self._last_bar = QSpinBox(), QSpinBox()
        self._first_bar.setObjectName(f"{prefix}_first_bar")
        self._last_bar.setObjectName(f"{prefix}_last_bar")
        lowest = 0 if score.pickup_ticks else 1
        highest = max(score.last_bar, lowest)
        for spin, value in ((self._first_bar, lowest), (self._last_bar, highest)):
            spin.setRange(lowest, highest)
            spin.setValue(value)
            spin.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self._dash = Label("–")
        layout = in_row((self._choice, 1), of=self, margins=0)
        for widget in (self._first_bar, self._dash, self._last_bar):
            layout.addWidget(widget)
        for signal in (self._choice.currentIndexChanged, self._first_bar.valueChanged, self._last_bar.valueChanged):
            signal.connect(self._change)
        self._show_bars()

    @property
    def bars(self) -> tuple[int, int] | None:
        """The first and last bar; None if no bars are chosen."""
        if self._choice.currentData() == _WHOLE:
            return None
        span = self._session.selection.span
        if self._choice.currentData() == _SELECTION and span is not None:
            bar_of_tick = self._score.metre_map.bar_of_tick
            return bar_of_tick(span[0]), bar_of_tick(max(span[1] - 1, span[0]))
        return self._first_bar.value(), self._last_bar.value()

    def begin_with(self, bars: tuple[int, int] | None) -> None:
        """Set the initial bars, limited to the piece; None for no bars."""
        if bars is None:
            return
        self._choice.setCurrentIndex(self._choice.findData(_BARS))
        for spin, bar in zip((self._first_bar, self._last_bar), bars, strict=True):
            spin.setValue(bar)

    @property
    def problem(self) -> str:
        """Return the reason why the bars are invalid; empty if they are valid."""
        first, last = self.bars or (0, 0)
        return self.tr("range_chooser.last_bar_comes_before_first") if first > last else ""

    def _change(self) -> None:
        self._show_bars()
        self.changed.emit()

    def _show_bars(self) -> None:
        for widget in (self._first_bar, self._dash, self._last_bar):
            widget.setVisible(self._choice.currentData() == _BARS)
