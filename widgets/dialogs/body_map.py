"""Drawing of a body with a dot for every joint and enlarged hands, which shows found, guessed and missing bones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import Final

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QHelpEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.editor.design_tokens import Tokens
from app.editor.session import Session
from metadata.load import load_skeleton
from widgets.dialogs.character_draft import State

ASPECT: Final = 0.86
"""Width divided by height."""
_DOT: Final = 0.0105
_TARGET: Final = 0.030
_LIMBS: Final = (
    # Start, end and width in heights of the drawing; the character's left is at the right.
    ((0.0, 0.30), (0.0, 0.47), 0.135),
    ((-0.035, 0.47), (0.035, 0.47), 0.115),
    ((0.0, 0.17), (0.0, 0.24), 0.050),
    ((0.075, 0.265), (0.175, 0.40), 0.055),
    ((0.175, 0.40), (0.245, 0.50), 0.045),
    ((0.055, 0.52), (0.065, 0.72), 0.078),
    ((0.065, 0.72), (0.070, 0.90), 0.058),
    ((0.070, 0.925), (0.085, 0.94), 0.045),
)
_HEAD: Final = (0.0, 0.105, 0.066, 0.085)
_BODY: Final[Mapping[str, tuple[float, float]]] = {
    "hips": (0.0, 0.475),
    "spine": (0.0, 0.415),
    "chest": (0.0, 0.355),
    "upperChest": (0.0, 0.295),
    "neck": (0.0, 0.222),
    "head": (0.0, 0.052),
    "jaw": (0.0, 0.158),
    "leftEye": (0.027, 0.100),
    "leftShoulder": (0.042, 0.252),
    "leftUpperArm": (0.088, 0.283),
    "leftLowerArm": (0.175, 0.400),
    "leftHand": (0.245, 0.500),
    "leftUpperLeg": (0.050, 0.530),
    "leftLowerLeg": (0.066, 0.720),
    "leftFoot": (0.071, 0.890),
    "leftToes": (0.088, 0.942),
}
_PALM: Final = (0.305, 0.700)
"""Centre of the enlarged left palm, as shares of the picture's width and height."""
_FINGERS: Final[Mapping[str, tuple[tuple[float, float], float, tuple[float, float, float]]]] = {
    # First joint relative to the centre of the palm, angle in degrees from upright (towards the thumb), positions of
    # the joints along it.
    "Thumb": ((-0.050, 0.035), 48.0, (0.0, 0.045, 0.082)),
    "Index": ((-0.036, -0.055), 9.0, (0.0, 0.048, 0.085)),
    "Middle": ((-0.011, -0.063), 1.0, (0.0, 0.053, 0.094)),
    "Ring": ((0.014, -0.058), -6.0, (0.0, 0.049, 0.088)),
    "Little": ((0.038, -0.044), -15.0, (0.0, 0.039, 0.070)),
}


@cache
def places() -> Mapping[str, tuple[float, float]]:
    """Return the position of each joint in the drawing of a body: x from the middle and y from the top, in heights of
    the drawing.
    """
    found = dict(_BODY)
    for finger, (first, degrees, along) in _FINGERS.items():
        way = (-math.sin(math.radians(degrees)), -math.cos(math.radians(degrees)))
        parts = ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
        for part, far in zip(parts, along, strict=True):
            found[f"left{finger}{part}"] = (_PALM[0] + first[0] + way[0] * far, _PALM[1] + first[1] + way[1] * far)
    for joint, (x, y) in list(found.items()):
        if joint.startswith("left"):
            found[joint.replace("left", "right", 1)] = (-x, y)
    return found


class BodyMap(QWidget):
    """Drawing of a body with selectable joints.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    name_of : callable
        Returns the description of a joint and its bone.

    Signals
    -------
    chosen(str)
        The user chose a joint.
    opened(str)
        The user opened the joint, to choose another bone for it.
    """

    chosen = Signal(str)
    opened = Signal(str)

    def __init__(self, session: Session, name_of: Callable[[str], str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._name_of = session, name_of
        self._states: Mapping[str, State] = {}
        self._joint = ""
        self._hovered = ""
        self.setObjectName("body_map")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        session.theme_changed.connect(self.update)

    @property
    def joint(self) -> str:
        """Name of the selected joint; empty for none."""
        return self._joint

    def show_states(self, states: Mapping[str, State]) -> None:
        """Display in colour how reliable the bone of each joint is."""
        if states != self._states:
            self._states = dict(states)
            self.update()

    def choose(self, joint: str) -> None:
        """Mark a joint as selected without emitting a signal."""
        if joint != self._joint:
            self._joint = joint
            self.update()

    def place(self, joint: str) -> QPointF:
        """Return the centre of a joint's dot in pixels."""
        box = self._box()
        x, y = places()[joint]
        return QPointF(box.center().x() + x * box.height(), box.top() + y * box.height())

    def _box(self) -> QRectF:
        height = min(self.height(), self.width() / ASPECT)
        return QRectF((self.width() - height * ASPECT) / 2, (self.height() - height) / 2, height * ASPECT, height)

    def _at(self, position: QPointF) -> str:
        """Return the name of the joint whose dot is under the mouse; empty if none."""
        near = [(math.hypot(*(self.place(joint) - position).toTuple()), joint) for joint in self._states]
        distance, joint = min(near, default=(math.inf, ""))
        return joint if distance <= max(_TARGET * self._box().height(), 12.0) else ""

    # Drawing

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the outline of the body and the hands, and a dot for each joint."""
        tokens, box = self._session.tokens, self._box()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(box.center().x(), box.top())
        painter.scale(box.height(), box.height())
        self._paint_body(painter, tokens)
        for side in (1.0, -1.0):
            self._paint_hand(painter, tokens, side)
        for joint, state in self._states.items():
            self._paint_dot(painter, tokens, joint, state)
        painter.end()

    def _paint_body(self, painter: QPainter, tokens: Tokens) -> None:
        for side in (1.0, -1.0):
            for (x0, y0), (x1, y1), width in _LIMBS:
                _line(painter, tokens.line, QPointF(side * x0, y0), QPointF(side * x1, y1), width)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.line))
        x, y, across, down = _HEAD
        painter.drawEllipse(QPointF(x, y), across, down)

    def _paint_hand(self, painter: QPainter, tokens: Tokens, side: float) -> None:
        hand = QPointF(side * _BODY["leftHand"][0], _BODY["leftHand"][1])
        palm = QPointF(side * _PALM[0], _PALM[1])
        painter.setPen(QPen(QColor(tokens.line_strong), 0.002, Qt.PenStyle.DotLine))
        painter.drawLine(hand, QPointF(palm.x(), palm.y() - 0.175))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.line))
        painter.drawRoundedRect(QRectF(palm.x() - 0.054, palm.y() - 0.062, 0.108, 0.125), 0.03, 0.03)
        known = places()
        for finger in _FINGERS:
            joints = [joint for joint in known if joint.startswith(f"left{finger}")]
            ends = [QPointF(side * known[joint][0], known[joint][1]) for joint in (joints[0], joints[-1])]
            tip = ends[1] + (ends[1] - ends[0]) * 0.28
            _line(painter, tokens.line, ends[0], tip, 0.023)
        _line(painter, tokens.line, palm, QPointF(palm.x(), palm.y() + 0.085), 0.062)

    def _paint_dot(self, painter: QPainter, tokens: Tokens, joint: str, state: State) -> None:
        x, y = places()[joint]
        colour = {"mapped": tokens.good, "doubtful": tokens.warning, "missing": tokens.text_dim}[state]
        chosen = joint == self._joint
        if chosen or joint == self._hovered:
            ring = QColor(tokens.accent if chosen else tokens.text_dim)
            painter.setPen(QPen(ring, 0.005 if chosen else 0.003))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(QPointF(x, y), _DOT * 1.75, _DOT * 1.75)
        painter.setPen(QPen(QColor(colour if state == "missing" else tokens.surface), 0.003))
        # Distinguishable without colours: hollow if no bone is mapped, notched if it is a guess.
        painter.setBrush(QColor(tokens.surface if state == "missing" else colour))
        painter.drawEllipse(QPointF(x, y), _DOT, _DOT)
        if state == "doubtful":
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.surface))
            painter.drawEllipse(QPointF(x, y), _DOT * 0.38, _DOT * 0.38)

    # Qt overrides

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        hovered = self._at(event.position())
        if hovered != self._hovered:
            self._hovered = hovered
            self.setCursor(Qt.CursorShape.PointingHandCursor if hovered else Qt.CursorShape.ArrowCursor)
            self.update()

    def leaveEvent(self, event: QEvent) -> None:
        self._hovered = ""
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        joint = self._at(event.position())
        if joint and event.button() is Qt.MouseButton.LeftButton:
            self.choose(joint)
            self.chosen.emit(joint)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        joint = self._at(event.position())
        if joint:
            self.opened.emit(joint)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        ways = {
            Qt.Key.Key_Left: (-1.0, 0.0),
            Qt.Key.Key_Right: (1.0, 0.0),
            Qt.Key.Key_Up: (0.0, -1.0),
            Qt.Key.Key_Down: (0.0, 1.0),
        }
        key = Qt.Key(event.key())
        if key in ways:
            joint = self._next(*ways[key])
            if joint:
                self.choose(joint)
                self.chosen.emit(joint)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self._joint:
            self.opened.emit(self._joint)
        else:
            super().keyPressEvent(event)

    def _next(self, x: float, y: float) -> str:
        """Return the name of the nearest joint in the direction (x, y) from the selected one, for the arrow keys."""
        if not self._joint:
            return next(iter(self._states), "")
        at = places()[self._joint]
        best, least = "", math.inf
        for joint in self._states:
            across, down = places()[joint][0] - at[0], places()[joint][1] - at[1]
            ahead, aside = across * x + down * y, abs(across * y) + abs(down * x)
            if ahead > 1e-6 and ahead + 2.0 * aside < least and aside <= 1.5 * ahead + 1e-6:
                best, least = joint, ahead + 2.0 * aside
        return best

    def event(self, event: QEvent) -> bool:
        if event.type() is QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            joint = self._at(QPointF(event.pos()))
            QToolTip.showText(event.globalPos(), self._name_of(joint) if joint else "", self)
            return True
        return super().event(event)

    def sizeHint(self) -> QSize:
        return QSize(430, 500)

    def minimumSizeHint(self) -> QSize:
        return QSize(310, 360)


def joints() -> tuple[str, ...]:
    """Return the names of the joints that can be selected in the drawing, in the skeleton's order."""
    return tuple(joint.name for joint in load_skeleton().joints if joint.name != "root")


def _line(painter: QPainter, colour: str, start: QPointF, end: QPointF, width: float) -> None:
    pen = QPen(QColor(colour), width)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    painter.setPen(pen)
    painter.drawLine(start, end)
