"""A small button for a choice among a few visible alternatives, such as fingerings or filters."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QKeySequence, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session

_PAD_PX = 9.0
_GAP_PX = 6.0


class Chip(QAbstractButton):
    """A rounded button with a text and a smaller note; filled if checked, marked if chosen by the user."""

    def __init__(self, session: Session, text: str, note: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._note, self._by_hand, self._outlined = note, False, False
        self.setText(text)
        # The text is drawn literally: an `&` defines no mnemonic.
        self.setShortcut(QKeySequence())
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(f"{text} {note}".strip())
        session.theme_changed.connect(self.update)

    @property
    def by_hand(self) -> bool:
        """True if it is marked as the user's choice."""
        return self._by_hand

    @property
    def outlined(self) -> bool:
        """True if it is marked as the generator's choice."""
        return self._outlined

    def show_state(self, checked: bool, by_hand: bool, outlined: bool) -> None:
        """Set whether the choice is checked, whether the user made it, and whether the generator made it."""
        self.setChecked(checked)
        if (by_hand, outlined) != (self._by_hand, self._outlined):
            self._by_hand, self._outlined = by_hand, outlined
            self.updateGeometry()
            self.update()

    def show_text(self, text: str, note: str) -> None:
        """Replace the chip's text and its note."""
        if (text, note) != (self.text(), self._note):
            self._note = note
            self.setText(text)
            self.setShortcut(QKeySequence())
            self.setAccessibleName(f"{text} {note}".strip())
            self.updateGeometry()
            self.update()

    def _note_font(self) -> QFont:
        font = QFont(self.font())
        font.setPointSizeF(max(font.pointSizeF() - 1.0, 9.0))
        return font

    def face_px(self) -> QSizeF:
        """Return the size in pixels of the chip's text without the note."""
        metrics = QFontMetricsF(self.font())
        return QSizeF(metrics.horizontalAdvance(self.text()), metrics.height())

    def draw_face(self, painter: QPainter, box: QRectF, colour: QColor) -> None:
        """Draw the chip's text without the note into a box of the size `face_px`."""
        painter.drawText(box.adjusted(-1, -2, 1, 2), Qt.AlignmentFlag.AlignCenter, self.text())

    # Qt overrides

    def sizeHint(self) -> QSize:
        face = self.face_px()
        width = face.width() + 2 * _PAD_PX
        if self._note:
            width += QFontMetricsF(self._note_font()).horizontalAdvance(self._note) + _GAP_PX
        if self._by_hand:
            width += 6
        return QSize(max(round(width) + 1, LEAST_TARGET_PX + 4), max(LEAST_TARGET_PX + 1, round(face.height()) + 8))

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        checked, hovered = self.isChecked(), self.underMouse()
        box = QRectF(self.rect()).adjusted(1, 1, -1, -1)
        fill = QColor(tokens.accent if checked else tokens.raised if hovered else tokens.sunken)
        edge = tokens.text_dim if self._outlined else tokens.line
        painter.setBrush(fill)
        painter.setPen(QPen(QColor(edge), 1.5 if self._outlined else 1.0))
        painter.drawRoundedRect(box, 5, 5)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(tokens.text if checked else tokens.accent), 1.5))
            painter.drawRoundedRect(box.adjusted(1.5, 1.5, -1.5, -1.5), 4, 4)
        inner = box.adjusted(_PAD_PX - 1, 0, -_PAD_PX + 1, 0)
        if self._by_hand:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.accent_text if checked else tokens.by_hand))
            painter.drawRect(QRectF(inner.left() - 3, box.center().y() - 3, 6, 6))
            inner.setLeft(inner.left() + 6)
        colour, face = QColor(tokens.accent_text if checked else tokens.text), self.face_px()
        left = inner.left() if self._note else inner.center().x() - face.width() / 2
        painter.setPen(colour)
        self.draw_face(painter, QRectF(QPointF(left, inner.center().y() - face.height() / 2), face), colour)
        if self._note:
            painter.setFont(self._note_font())
            painter.setPen(QColor(tokens.accent_text if checked else tokens.text_dim))
            painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, self._note)
