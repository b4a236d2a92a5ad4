"""Graph of learned transitions: basic motions on a circle, with an arrow for each transition."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.arrays import FloatArray
from app.editor.session import Session
from widgets.common.choreography.figures import draw_figures, placed

LEARNED: Final = 1.5
"""Ratio to the row's least probability (caused by smoothing) above which a transition was learned."""
NODE_PX, LEAST_FIGURE_PX = 44.0, 30.0
WIDEST_PX = 7.0
BEND = 0.14
"""Bend of an arrow relative to its length, which separates both directions."""
DIM = 60


class TransitionGraph(QWidget):
    """Draws the transitions of a choreography; those of the basic motion under the mouse, or selected by arrow keys,
    are highlighted.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.

    Attributes
    ----------
    pointed : signal (int)
        Signal: the highlighted basic motion; -1 for none.
    """

    pointed = Signal(int)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._transition: FloatArray = np.zeros((0, 0))
        self._figures: FloatArray = np.zeros((0, 21, 2))
        self._used: frozenset[int] = frozenset()
        self._colour = ""
        self.looked_at = -1
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        session.theme_changed.connect(self.update)

    def show_graph(self, transition: FloatArray, figures: FloatArray, used: frozenset[int], colour: str) -> None:
        """Draw another choreography.

        Parameters
        ----------
        transition : (K, K) float64
            Probability of each basic motion (column) after each (row).
        figures : (K, 21, 2) float64
            See `widgets.common.choreography.figures`.
        used : frozenset of int
            Basic motions that the dancer dances, drawn in the dancer's colour.
        """
        self._transition, self._figures, self._used, self._colour = transition, figures, used, colour
        if self.looked_at >= len(transition):
            self.look_at(-1)
        self.update()

    def arrows(self) -> list[tuple[int, int]]:
        """Return the learned transitions as (from, to) indices of basic motions, the most probable last."""
        if not len(self._transition):
            return []
        least = self._transition.min(axis=1, keepdims=True)
        rows, columns = np.nonzero(self._transition > LEARNED * least)
        order = np.argsort(self._transition[rows, columns], kind="stable")
        return list(zip(rows[order].tolist(), columns[order].tolist(), strict=True))

    def place(self, state: int) -> QPointF:
        """Return the centre of a basic motion on the circle in pixels of the widget."""
        count = max(len(self._transition), 1)
        angle = 2.0 * math.pi * state / count - 0.5 * math.pi
        middle = QRectF(self.rect()).center()
        wide, high = (max(0.0, 0.5 * side - NODE_PX) for side in (self.width(), self.height()))
        return middle + QPointF(wide * math.cos(angle), high * math.sin(angle))

    def look_at(self, state: int) -> None:
        """Highlight the arrows of a basic motion; -1 for none."""
        if state != self.looked_at:
            self.looked_at = state
            self.pointed.emit(state)
            self.update()

    def _state_at(self, place: QPointF) -> int:
        for state in range(len(self._transition)):
            off = self.place(state) - place
            if math.hypot(off.x(), off.y()) <= 0.5 * NODE_PX:
                return state
        return -1

    def _paint_arrow(self, painter: QPainter, first: int, second: int) -> None:
        tokens, share = self._session.tokens, float(self._transition[first, second])
        own = self.looked_at < 0 or first == self.looked_at
        colour = QColor(tokens.accent if first == self.looked_at else tokens.text_dim)
        colour.setAlpha(255 if first == self.looked_at else 130 if own else DIM)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(colour, 0.8 + (WIDEST_PX - 0.8) * share))
        # Points as complex numbers x + i y.
        start, end = (complex(at.x(), at.y()) for at in (self.place(first), self.place(second)))
        radius = 0.5 * NODE_PX
        if first == second:
            middle = QRectF(self.rect()).center()
            out = start + 0.75 * radius * _unit(start - complex(middle.x(), middle.y()))
            painter.drawEllipse(_point(out), 0.55 * radius, 0.55 * radius)
            return
        way = _unit(end - start)
        start, end = start + radius * way, end - radius * way
        bent = (start + end) / 2.0 + BEND * abs(end - start) * 1j * way
        path = QPainterPath(_point(start))
        path.quadTo(_point(bent), _point(end))
        painter.drawPath(path)
        back, tip = _unit(bent - end), 4.0 + 8.0 * share
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPolygon([_point(end + tip * part) for part in (0.0, (2.0 + 1j) * back, (2.0 - 1j) * back)])

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(520, 420)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.look_at(self._state_at(event.position()))

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.look_at(-1)
        super().focusOutEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Right: 1, Qt.Key.Key_Down: 1, Qt.Key.Key_Left: -1, Qt.Key.Key_Up: -1}
        step, count = steps.get(Qt.Key(event.key())), len(self._transition)
        if step is None or not count:
            super().keyPressEvent(event)
            return
        self.look_at((self.looked_at + step) % count if self.looked_at >= 0 else 0)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        for first, second in sorted(self.arrows(), key=lambda arrow: arrow[0] == self.looked_at):
            self._paint_arrow(painter, first, second)
        count = len(self._transition)
        # Neighbours are closest on the shorter axis of the ring.
        room = math.pi * max(0.0, min(self.width(), self.height()) - 2.0 * NODE_PX) / max(count, 1)
        for state in range(count):
            place, radius = self.place(state), 0.5 * min(NODE_PX, max(room, 6.0))
            colour = QColor(self._colour if state in self._used else tokens.text_dim)
            painter.setBrush(QColor(tokens.surface))
            painter.setPen(QPen(QColor(tokens.accent) if state == self.looked_at else colour, 1.6))
            painter.drawEllipse(place, radius, radius)
            if 2.0 * radius >= LEAST_FIGURE_PX:
                drawn = placed(self._figures[state][None], np.array([place.x() + 5.0]), place.y() + 17.0, 38.0)
                draw_figures(painter, drawn, colour, 1.6, 38.0)
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QColor(tokens.text))
            box = QRectF(place.x() - radius, place.y() - radius, 0.8 * radius, 2.0 * radius)
            painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter), str(state + 1))


def _unit(way: complex) -> complex:
    """Return a vector, given as a complex number, scaled to length 1; a zero vector is unchanged."""
    return way / max(abs(way), 1e-9)


def _point(place: complex) -> QPointF:
    return QPointF(place.real, place.imag)
