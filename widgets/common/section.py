"""Sections of a panel that can be folded, each with a header."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from widgets.common.layouts import STRETCH, in_column, in_row, panel

_CHEVRON_PX = 4.0


class SectionHeader(QWidget):
    """A title line that folds the section below by a click, Space, Return, Left or Right."""

    toggled = Signal(bool)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._title, self._note, self._warns = "", "", False
        self._open = True
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._row = in_row(STRETCH, of=self, margins=(0, 0, 4, 0), spacing=2)
        session.theme_changed.connect(self.update)

    @property
    def is_open(self) -> bool:
        """True if the contents below are shown."""
        return self._open

    def set_open(self, is_open: bool) -> None:
        """Fold or unfold the section that the header belongs to; emits ``toggled`` if this changes it."""
        if is_open != self._open:
            self._open = is_open
            self.update()
            self.toggled.emit(is_open)

    def set_texts(self, title: str, note: str = "", warns: bool = False) -> None:
        """Set the title and a short note at the right of it; ``warns`` shows the note as a warning."""
        if (title, note, warns) != (self._title, self._note, self._warns):
            self._title, self._note, self._warns = title, note, warns
            self.setAccessibleName(f"{title} {note}".strip())
            self.update()

    def add_button(self, button: QWidget) -> None:
        """Add a small button at the right end."""
        self._row.addWidget(button)

    def _title_font(self) -> QFont:
        font = QFont(self.font())
        font.setBold(True)
        return font

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(120, max(LEAST_TARGET_PX + 2, round(QFontMetricsF(self.font()).height()) + 10))

    def minimumSizeHint(self) -> QSize:
        return QSize(40, self.sizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(tokens.raised))
        painter.setPen(QColor(tokens.line))
        painter.drawLine(self.rect().topLeft(), self.rect().topRight())
        middle = self.height() / 2.0
        painter.save()
        painter.translate(12.0, middle)
        painter.rotate(0.0 if self._open else -90.0)
        painter.setPen(QPen(QColor(tokens.text if self.underMouse() else tokens.text_dim), 1.6))
        painter.drawPolyline(QPolygonF([QPointF(-_CHEVRON_PX, -2), QPointF(0, 2), QPointF(_CHEVRON_PX, -2)]))
        painter.restore()
        buttons = [child for child in self.findChildren(QWidget) if child.isVisible()]
        taken = sum(button.width() + 2 for button in buttons)
        room = QRectF(self.rect()).adjusted(24, 0, -8 - taken, 0)
        note_px = QFontMetricsF(self.font()).horizontalAdvance(self._note)
        painter.setPen(QColor(tokens.warning if self._warns else tokens.text_dim))
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, self._note)
        font = self._title_font()
        painter.setFont(font)
        painter.setPen(QColor(tokens.text))
        title = QFontMetricsF(font).elidedText(
            self._title, Qt.TextElideMode.ElideRight, max(room.width() - note_px - 8, 0)
        )
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, title)
        if self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 1.5))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 3, 3)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self.set_open(not self._open)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        if key in (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.set_open(not self._open)
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self.set_open(key == Qt.Key.Key_Right)
        else:
            super().keyPressEvent(event)


class Section(QWidget):
    """A header and the contents that it folds.

    Parameters
    ----------
    name : str
        Object name, under which the folded state is stored.
    folded : bool
        Whether it is folded until the user changes this.
    remembers : bool
        Whether the state is stored; if not, it is the same at every start.

    Attributes
    ----------
    header : SectionHeader
        Title line.
    body : QVBoxLayout
        Layout for the contents.
    """

    def __init__(
        self,
        session: Session,
        name: str,
        parent: QWidget | None = None,
        *,
        folded: bool = False,
        remembers: bool = True,
    ) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._session, self._remembers = session, remembers
        self.header = SectionHeader(session)
        self.body = in_column(margins=(8, 6, 8, 8), spacing=4)
        self._content = panel(self.body)
        in_column(self.header, self._content, of=self, margins=0, spacing=0)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        self.header.toggled.connect(self._content.setVisible)
        was_folded = session.folded.get(name, folded) if remembers else folded
        self.header.set_open(not was_folded)
        # Only folding by the user is stored from now on.
        self.header.toggled.connect(self._keep)

    def _keep(self, is_open: bool) -> None:
        if self._remembers:
            self._session.set_folded(self.objectName(), not is_open)

    @property
    def is_open(self) -> bool:
        """True if the contents are shown."""
        return self.header.is_open

    def set_open(self, is_open: bool) -> None:
        """Fold or unfold the section's contents."""
        self.header.set_open(is_open)
