"""Display of a number as a slim bar with name, value and unit."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QWidget

from app.editor.design_tokens import LEAST_TARGET_PX, Tokens
from app.editor.session import Session
from widgets.common.numbers import MIXED, number_text

_PAD_PX = 7.0


class NumberDisplay(QWidget):
    """Display of a number as a bar filled by its share of a range; can also stand for several different values.
    `NumberSlider` makes it editable.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    ends : (float, float)
        Values at both ends of the bar.
    default : float
        Value that is not marked as changed by the user.
    decimals : int
        Number of decimals shown.
    slides : bool
        Whether the bar is filled, for a range short enough to be used as a slider.
    resets : bool
        Whether there is a default to which the number can be reset.
    """

    def __init__(
        self,
        session: Session,
        ends: tuple[float, float],
        default: float,
        decimals: int,
        slides: bool,
        resets: bool,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._decimals, self._slides, self._resets = decimals, slides, resets
        self._ends = ends
        self._default = default
        self._value = default
        self._mixed = False
        self._by_hand: bool | None = None
        self._painted: tuple[float, str, bool] | None = None
        """Value, text and mark that were drawn last."""
        self._label, self._unit = "", ""
        self._words: Callable[[float], str] | None = None
        self._reads: Callable[[str], float | None] | None = None
        self._dragging = False
        """True while the user drags the value."""
        self._after_drag: tuple[float, bool] | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        session.theme_changed.connect(self.update)

    # Display

    @property
    def value(self) -> float:
        """The displayed value; the first of several different ones."""
        return self._value

    @property
    def default(self) -> float:
        """Value that a reset of the number restores."""
        return self._default

    @property
    def mixed(self) -> bool:
        """True if it stands for several different values."""
        return self._mixed

    @property
    def by_hand(self) -> bool:
        """True if the value is marked as the user's."""
        if self._by_hand is not None:
            return self._by_hand
        return self._resets and (self._value != self._default or self._mixed)

    def show_value(
        self, value: float, *, mixed: bool = False, default: float | None = None, by_hand: bool | None = None
    ) -> None:
        """Set the value without a signal.

        Parameters
        ----------
        mixed : bool
            Whether it stands for several different values; a drag then starts from ``value``.
        default : float, optional
            New default.
        by_hand : bool, optional
            Whether it is marked as changed by the user; None to mark it if it differs from the default.
        """
        if default is not None:
            self._default = default
        self._by_hand = by_hand
        if self._dragging:
            # During a drag the display follows the mouse; the resulting value is shown afterwards.
            self._after_drag = (value, mixed)
        else:
            self._value, self._mixed = value, mixed
        if self._look != self._painted:
            self.update()

    @property
    def _look(self) -> tuple[float, str, bool]:
        # Equal values may have different texts: a pitch on another instrument, for example.
        return self._value, self.value_text(), self.by_hand

    def set_texts(self, label: str, unit: str = "", tool_tip: str = "") -> None:
        """Set the label, the unit and the tool tip of the number, in the language of the editor."""
        self._label, self._unit = label, unit
        self.setAccessibleName(label)
        self.setToolTip(tool_tip)
        self.updateGeometry()
        self.update()

    def set_wording(self, words: Callable[[float], str], reads: Callable[[str], float | None]) -> None:
        """Set functions that write and read the value in a form other than a number, such as pitch names."""
        self._words, self._reads = words, reads
        self.update()

    def show_as_place(self) -> None:
        """Show and read the value, in ticks of the score, as bar, beat and ticks."""

        def tick(text: str) -> float | None:
            found = self._session.project.score.metre_map.tick_of_label(text)
            return None if found is None else float(found)

        self.set_wording(lambda value: self._session.project.score.metre_map.label(round(value)), tick)

    def value_text(self) -> str:
        """Return the displayed text of the value without its unit."""
        if self._mixed:
            return MIXED
        return self._words(self._value) if self._words is not None else number_text(self._value, self._decimals)

    # Drawing

    def _text_width(self, text: str) -> float:
        return QFontMetricsF(self.font()).horizontalAdvance(text)

    def _share(self, value: float) -> float:
        low, high = self._ends
        return min(max((value - low) / (high - low), 0.0), 1.0) if high > low else 0.0

    # Qt overrides

    def sizeHint(self) -> QSize:
        sample = number_text(self._ends[1] if self._slides else 0.0, self._decimals) + " " + self._unit
        width = self._text_width(self._label) + self._text_width(sample) + 4 * _PAD_PX
        return QSize(round(width), max(LEAST_TARGET_PX + 1, round(QFontMetricsF(self.font()).height()) + 9))

    def minimumSizeHint(self) -> QSize:
        return QSize(60, self.sizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:
        self._painted = self._look
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(0.75, 0.75, -0.75, -0.75)
        shape = QPainterPath()
        shape.addRoundedRect(box, 4, 4)
        hovered = self.isEnabled() and (self.underMouse() or self._dragging)
        painter.fillPath(shape, QColor(tokens.raised if hovered else tokens.sunken))
        painter.save()
        painter.setClipPath(shape)
        if self._slides and not self._mixed:
            fill = QColor(tokens.accent if self.isEnabled() else tokens.line)
            if self.isEnabled():
                fill.setAlphaF(0.42 if hovered else 0.30)
            edge = box.left() + self._share(self._value) * box.width()
            left, right = sorted((box.left() + self._share(0.0) * box.width(), edge))
            painter.fillRect(QRectF(left, box.top(), right - left, box.height()), fill)
            mark = QColor(tokens.accent if self.isEnabled() else tokens.line_strong)
            # The text is drawn over the mark.
            mark.setAlphaF(1.0 if hovered else 0.7)
            painter.fillRect(QRectF(min(edge, box.right() - 2) - 1, box.top(), 2, box.height()), mark)
        if self.by_hand and self.isEnabled():
            painter.fillRect(QRectF(box.left(), box.top(), 3, box.height()), QColor(tokens.by_hand))
        painter.restore()
        focused = self.hasFocus()
        painter.setPen(QPen(QColor(tokens.accent if focused else tokens.line), 1.5 if focused else 1.0))
        painter.drawPath(shape)
        self._paint_texts(painter, box, tokens)

    def _paint_texts(self, painter: QPainter, box: QRectF, tokens: Tokens) -> None:
        enabled = self.isEnabled()
        inner = box.adjusted(_PAD_PX + 2, 0, -_PAD_PX, 0)
        number = self.value_text()
        unit = f" {self._unit}" if self._unit and not self._mixed else ""
        middle = Qt.AlignmentFlag.AlignVCenter
        unit_px, number_px = self._text_width(unit), self._text_width(number)
        # A dim unit would be illegible on the fill.
        covered = (
            self._slides
            and not self._mixed
            and box.left() + self._share(self._value) * box.width() > (inner.right() - unit_px)
        )
        painter.setPen(QColor(tokens.text if covered and enabled else tokens.text_dim))
        painter.drawText(inner, middle | Qt.AlignmentFlag.AlignRight, unit)
        painter.setPen(QColor(tokens.text if enabled else tokens.text_dim))
        painter.drawText(inner.adjusted(0, 0, -unit_px, 0), middle | Qt.AlignmentFlag.AlignRight, number)
        room = inner.width() - unit_px - number_px - 8
        metrics = QFontMetricsF(self.font())
        label = metrics.elidedText(self._label, Qt.TextElideMode.ElideRight, max(room, 0.0))
        painter.setPen(QColor(tokens.text if enabled else tokens.text_dim))
        painter.drawText(inner, middle | Qt.AlignmentFlag.AlignLeft, label)
