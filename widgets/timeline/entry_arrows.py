"""Arrows in the piano roll: who gives an entry to whom."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from widgets.timeline.drawing import shade
from widgets.timeline.model.entries import EntryArrow, entry_arrows
from widgets.timeline.plot import LaneItem
from widgets.timeline.roll_items import RollView

HEAD_PX = 7.0
DOT_PX = 2.5
BEND = 0.5
"""How far the arrow goes level before it turns to the other's note."""


class EntryArrows(LaneItem[RollView]):
    """The entries that the player in front gives or takes, in the giver's colour."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 12.0)
        self._known: tuple[tuple[object, ...], tuple[EntryArrow, ...]] = ((), ())

    @property
    def arrows(self) -> tuple[EntryArrow, ...]:
        """What is drawn; found again only where plans or players are others."""
        session = self.lane.session
        player, plans = session.player, session.plans
        if player is None:
            return ()
        key = (plans, session.project.players, session.project.score, player.id)
        if len(self._known[0]) != len(key) or any(a is not b for a, b in zip(key, self._known[0], strict=True)):
            self._known = (key, entry_arrows(session.project, plans, player.id))
        return self._known[1]

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        session, axis = self.lane.session, self.lane.axis
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        for arrow in self.arrows:
            start = QPointF(axis.x_px(arrow.from_s), self.lane.y_px(arrow.from_pitch + 0.5))
            end = QPointF(axis.x_px(arrow.to_s), self.lane.y_px(arrow.to_pitch + 0.5))
            if end.x() < exposed.left() - HEAD_PX or start.x() > exposed.right() + HEAD_PX:
                continue
            colour = shade(session.colour(session.project.player(arrow.giver_id)), 220)
            self._paint(painter, start, end, colour)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint(self, painter: QPainter, start: QPointF, end: QPointF, colour: QColor) -> None:
        tip = end - QPointF(HEAD_PX, 0.0)
        bend = BEND * max(tip.x() - start.x(), 0.0)
        path = QPainterPath(start)
        path.cubicTo(start + QPointF(bend, 0.0), tip - QPointF(bend, 0.0), tip)
        painter.setPen(QPen(colour, 1.6))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(path)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(start, DOT_PX, DOT_PX)
        half = HEAD_PX / 2.0
        painter.drawPolygon(QPolygonF([end, tip + QPointF(0.0, half), tip - QPointF(0.0, half)]))
