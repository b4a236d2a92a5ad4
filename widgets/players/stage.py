"""Top view of the stage with the places and directions of the performers, which can be dragged."""

from __future__ import annotations

import math
from collections.abc import Mapping

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPolygonF,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.session import Session
from app.project.casting import StagePosition
from app.project.performers import Dancer, Player

DISC_M = 0.28
NOSE_M = 0.62
"""Distance in metres from a player's centre to the handle that turns the player."""
LEAST_DISC_PX = 7.0
LEAST_NOSE_PX = 20.0
REACH_PX = 12.0
"""Distance in pixels within which a press grabs a handle."""
LEAST_WIDTH_M, LEAST_DEPTH_M = 4.0, 2.6
MARGIN_M = 0.9
FARTHEST_M = 50.0
SNAP_M = 0.1
SNAP_RAD = math.radians(5.0)
STEP_M = 0.05
FAR_STEP_M = 0.5
_ARROWS = {
    Qt.Key.Key_Left: (-1.0, 0.0),
    Qt.Key.Key_Right: (1.0, 0.0),
    Qt.Key.Key_Up: (0.0, -1.0),
    Qt.Key.Key_Down: (0.0, 1.0),
}


class StageView(QWidget):
    """Top view: players are discs and dancers are rings, with a nose that shows the direction; the audience is below. A
    drag moves a player (with all selected ones) or a dancer, a drag of the nose turns; arrow keys move, with Ctrl they
    turn.

    Signals
    -------
    placed(object, object)
        New places (dict of str to StagePosition) and a gesture token.
    released()
        The drag has ended.
    chosen(object)
        The user selected the players with these ids (tuple of str); the first becomes active.
    """

    placed = Signal(object, object)
    released = Signal()
    chosen = Signal(object)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.snaps = False
        self._grabbed: str | None = None
        self._of_dancer = False
        """True if the last drag was of a dancer, False if of a player."""
        self._turning = False
        self._press = QPointF()
        self._start: dict[str, StagePosition] = {}
        self._token: object | None = None
        self._view: tuple[float, float, float] | None = None
        self._collapse: str | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        session.theme_changed.connect(self.update)

    # Conversion of metres and pixels

    def _frame(self) -> tuple[float, float, float]:
        """Return the scale in pixels per metre, and x and z of the centre of the view in metres; constant during a
        drag.
        """
        if self._view is not None:
            return self._view
        places = [one.stage for one in self._session.project.performers]
        left = min((place.x_m for place in places), default=0.0) - MARGIN_M
        right = max((place.x_m for place in places), default=0.0) + MARGIN_M
        back = min((place.z_m for place in places), default=0.0) - MARGIN_M
        front = max((place.z_m for place in places), default=0.0) + MARGIN_M
        width, depth = max(right - left, LEAST_WIDTH_M), max(front - back, LEAST_DEPTH_M)
        scale = min(self.width() / width, (self.height() - self._audience_px()) / depth)
        return max(scale, 1e-3), (left + right) / 2.0, (back + front) / 2.0

    def _audience_px(self) -> float:
        return QFontMetricsF(self.font()).height() + 8.0

    def point(self, x_m: float, z_m: float) -> QPointF:
        """Convert a position on stage in metres to pixels of the plan."""
        scale, middle_x, middle_z = self._frame()
        height = self.height() - self._audience_px()
        return QPointF(self.width() / 2 + (x_m - middle_x) * scale, height / 2 + (z_m - middle_z) * scale)

    def _metres(self, position: QPointF) -> tuple[float, float]:
        scale, middle_x, middle_z = self._frame()
        height = self.height() - self._audience_px()
        return (position.x() - self.width() / 2) / scale + middle_x, (position.y() - height / 2) / scale + middle_z

    def disc_px(self) -> float:
        """Return the radius in pixels of the disc that stands for a player on the stage plan."""
        return max(self._frame()[0] * DISC_M, LEAST_DISC_PX)

    def nose_point(self, player: Player | Dancer) -> QPointF:
        """Return the point of the handle that turns a performer."""
        length = max(self._frame()[0] * NOSE_M, LEAST_NOSE_PX)
        turn = player.stage.turn_rad
        return self.point(player.stage.x_m, player.stage.z_m) + QPointF(
            math.sin(turn) * length, math.cos(turn) * length
        )

    def _is_selected(self, one: Player | Dancer) -> bool:
        dancer = self._session.dancer
        if isinstance(one, Player):
            return any(player.id in self._session.players for player in self._session.project.played_by(one))
        return dancer is not None and one.id == dancer.id

    def _at(self, position: QPointF) -> tuple[Player | Dancer | None, bool]:
        """Return the performer at a point, and whether the point hits the nose, which only selected performers have."""
        players = self._session.project.seen
        for player in filter(self._is_selected, players):
            if _distance(self.nose_point(player), position) <= REACH_PX * 0.75:
                return player, True
        reach = max(self.disc_px(), REACH_PX)
        near = [(_distance(self.point(player.stage.x_m, player.stage.z_m), position), player) for player in players]
        within = [(distance, not self._is_selected(player), player) for distance, player in near
                  if distance <= reach]  # fmt: skip
        return (min(within, key=lambda item: item[:2])[2], False) if within else (None, False)

    # Changing

    def _moved(self, dx_m: float, dz_m: float, snaps: bool) -> dict[str, StagePosition]:
        if self._grabbed is not None and snaps:
            # The grabbed player snaps to the grid; the others keep their positions relative to it.
            place = self._start[self._grabbed]
            dx_m = round((place.x_m + dx_m) / SNAP_M) * SNAP_M - place.x_m
            dz_m = round((place.z_m + dz_m) / SNAP_M) * SNAP_M - place.z_m
        return {
            player_id: StagePosition(_held(place.x_m + dx_m), _held(place.z_m + dz_m), place.turn_rad)
            for player_id, place in self._start.items()
        }

    def _turned(self, position: QPointF, snaps: bool) -> dict[str, StagePosition]:
        assert self._grabbed is not None
        held = self._start[self._grabbed]
        x_m, z_m = self._metres(position)
        turn = math.atan2(x_m - held.x_m, z_m - held.z_m)
        if snaps:
            turn = round(turn / SNAP_RAD) * SNAP_RAD
        by = turn - held.turn_rad
        return {
            player_id: StagePosition(place.x_m, place.z_m, _wrapped(place.turn_rad + by))
            for player_id, place in self._start.items()
        }

    def _places(self) -> dict[str, StagePosition]:
        project, dancer = self._session.project, self._session.dancer
        if self._of_dancer and dancer is not None:
            return {dancer.id: dancer.stage}
        return {player_id: project.player(player_id).stage for player_id in self._session.players}

    def _end(self) -> None:
        self._grabbed, self._start, self._view, self._collapse = None, {}, None, None
        self.update()
        if self._token is not None:
            self._token = None
            self.released.emit()

    def _emit(self, places: Mapping[str, StagePosition]) -> None:
        self._token = self._token or object()
        self.placed.emit(dict(places), self._token)

    # Drawing

    def _paint_floor(self, painter: QPainter) -> None:
        tokens = self._session.tokens
        scale, middle_x, middle_z = self._frame()
        step = 1.0 if scale > 9 else 5.0
        painter.setPen(QPen(QColor(tokens.line), 1.0))
        wide, deep = self.width() / 2 / scale, self.height() / 2 / scale
        for number in range(math.floor((middle_x - wide) / step), math.ceil((middle_x + wide) / step) + 1):
            x = self.point(number * step, 0.0).x()
            painter.drawLine(QPointF(x, 0.0), QPointF(x, float(self.height())))
        for number in range(math.floor((middle_z - deep) / step), math.ceil((middle_z + deep) / step) + 2):
            y = self.point(0.0, number * step).y()
            painter.drawLine(QPointF(0.0, y), QPointF(float(self.width()), y))
        band = QRectF(0, self.height() - self._audience_px(), self.width(), self._audience_px())
        painter.fillRect(band, QColor(tokens.surface))
        painter.setPen(QColor(tokens.text_dim))
        painter.drawText(band, Qt.AlignmentFlag.AlignCenter, self.tr("stage_view.audience"))
        painter.drawText(
            band.adjusted(6, 0, -6, 0),
            Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
            self.tr("stage_view.grid_m").format(step=f"{step:g}"),
        )

    def _paint_performer(self, painter: QPainter, number: int, player: Player | Dancer) -> None:
        tokens = self._session.tokens
        centre, radius = self.point(player.stage.x_m, player.stage.z_m), self.disc_px()
        colour = QColor(self._session.colour(player))
        selected, dances = self._is_selected(player), isinstance(player, Dancer)
        nose = self.nose_point(player)
        if selected:
            painter.setPen(QPen(colour, 2.0))
            painter.drawLine(centre, nose)
            painter.setBrush(QColor(tokens.sunken))
            painter.drawEllipse(nose, 4.5, 4.5)
        turn = player.stage.turn_rad
        forward = QPointF(math.sin(turn), math.cos(turn))
        side = QPointF(forward.y(), -forward.x())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPolygon(
            QPolygonF([centre + forward * radius * 1.45, centre + side * radius * 0.7, centre - side * radius * 0.7])
        )
        if dances:
            painter.setPen(QPen(QColor(tokens.text) if selected else colour, 2.0))
            painter.setBrush(QColor(tokens.sunken))
        elif selected:
            painter.setPen(QPen(QColor(tokens.text), 2.0))
        painter.drawEllipse(centre, radius, radius)
        font = painter.font()
        if radius >= 9:
            painter.setPen(colour if dances else QColor("#101216" if colour.lightnessF() > 0.45 else "#ffffff"))
            painter.drawText(
                QRectF(centre.x() - radius, centre.y() - radius, 2 * radius, 2 * radius),
                Qt.AlignmentFlag.AlignCenter,
                str(number),
            )
        painter.setFont(font)

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(240, 190)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._session.tokens, QPainter(self)
        held, self._view = self._view, self._frame()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        shape = QPainterPath()
        box = QRectF(self.rect()).adjusted(0.75, 0.75, -0.75, -0.75)
        shape.addRoundedRect(box, 4, 4)
        painter.save()
        painter.setClipPath(shape)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        self._paint_floor(painter)
        project = self._session.project
        numbered: list[tuple[int, Player | Dancer]] = [*enumerate(project.players, 1), *enumerate(project.dancers, 1)]
        # A musician with several instruments is drawn once, with the number of the first.
        numbered = [item for item in numbered if isinstance(item[1], Dancer) or project.musician(item[1]) is item[1]]
        # Selected players are drawn on top.
        for number, player in sorted(numbered, key=lambda item: self._is_selected(item[1])):
            self._paint_performer(painter, number, player)
        painter.restore()
        self._view = held
        painter.setBrush(Qt.BrushStyle.NoBrush)
        focused = self.hasFocus()
        painter.setPen(QPen(QColor(tokens.accent if focused else tokens.line), 1.5 if focused else 1.0))
        painter.drawPath(shape)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        player, by_nose = self._at(event.position())
        if player is None:
            return
        self._of_dancer = isinstance(player, Dancer)
        if self._of_dancer:
            self._session.set_dancer(player.id)
            self._grab(player, by_nose, event.position())
            return
        chosen = self._session.players
        adding = bool(event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier))
        if adding and player.id in chosen and len(chosen) > 1:
            self.chosen.emit(tuple(player_id for player_id in chosen if player_id != player.id))
            return
        if player.id not in chosen:
            self.chosen.emit((player.id, *chosen) if adding else (player.id,))
        elif len(chosen) > 1 and not by_nose and not adding:
            self._collapse = player.id
        self._grab(player, by_nose, event.position())

    def _grab(self, player: Player | Dancer, by_nose: bool, position: QPointF) -> None:
        self._view = self._frame()
        self._grabbed, self._turning, self._press = player.id, by_nose, position
        self._start = self._places()
        self._token = None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grabbed is None:
            player, by_nose = self._at(event.position())
            free = Qt.CursorShape.OpenHandCursor if not by_nose else Qt.CursorShape.PointingHandCursor
            self.setCursor(Qt.CursorShape.ArrowCursor if player is None else free)
            self.setToolTip("" if player is None else player.name)
            return
        moved = event.position() - self._press
        if self._token is None and moved.manhattanLength() < 3:
            return
        self._collapse = None
        snaps = self.snaps != bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        if self._turning:
            self._emit(self._turned(event.position(), snaps))
        else:
            scale = self._frame()[0]
            self._emit(self._moved(moved.x() / scale, moved.y() / scale, snaps))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._grabbed is not None:
            collapse = self._collapse
            self._end()
            if collapse is not None:
                self.chosen.emit((collapse,))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key == Qt.Key.Key_Escape and self._grabbed is not None:
            if self._token is not None:
                self.placed.emit(dict(self._start), self._token)
            self._end()
        elif key in _ARROWS and self._grabbed is None and self._places():
            x, z = _ARROWS[key]
            self._start = self._places()
            if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
                by = SNAP_RAD * (x or -z)
                places = {
                    player_id: StagePosition(place.x_m, place.z_m, _wrapped(place.turn_rad + by))
                    for player_id, place in self._start.items()
                }
            else:
                step = FAR_STEP_M if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else STEP_M
                places = self._moved(x * step, z * step, snaps=False)
            self._emit(places)
        else:
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if Qt.Key(event.key()) in _ARROWS and not event.isAutoRepeat() and self._grabbed is None:
            self._end()
        else:
            super().keyReleaseEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        if self._grabbed is None:
            self._end()
        super().focusOutEvent(event)


def _distance(one: QPointF, other: QPointF) -> float:
    return math.hypot(one.x() - other.x(), one.y() - other.y())


def _held(metres: float) -> float:
    """Return a coordinate rounded to millimetres and limited to the visible stage."""
    return round(min(max(metres, -FARTHEST_M), FARTHEST_M), 3) + 0.0


def _wrapped(radians: float) -> float:
    """Return an angle wrapped to (-pi, pi] and rounded to a thousandth of a degree."""
    turned = math.remainder(radians, 2.0 * math.pi)
    return round(turned, 5)
