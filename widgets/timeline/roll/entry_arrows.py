"""Arrows in the piano roll for cues between players."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from app.editor.translated import tr
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.roll.entries import End, EntryArrow, EntryDrag, end_at, entry_arrows
from widgets.timeline.plot.drawing import shade
from widgets.timeline.plot.plot import LaneItem
from widgets.timeline.roll.drawn_notes import RollView

HEAD_PX = 7.0
DOT_PX = 2.5
BEND = 0.5
"""Share of the way after which the arrow bends towards the other note."""
HELD = 1.6
"""Factor by which an end under the mouse is enlarged."""


class EntryArrows(LaneItem[RollView]):
    """Draws arrows for cues that the active player gives or receives, in the giver's colour."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 12.0)
        self._known: tuple[tuple[object, ...], tuple[EntryArrow, ...]] = ((), ())
        self._drag: EntryDrag | None = None
        self._hovered: tuple[EntryArrow, End] | None = None

    @property
    def arrows(self) -> tuple[EntryArrow, ...]:
        """Return the arrows to draw, computed again only when plans or players change."""
        session = self.lane.session
        player, plans = session.player, session.plans
        if player is None:
            return ()
        key = (plans, session.project.players, session.project.score, player.id)
        if len(self._known[0]) != len(key) or any(a is not b for a, b in zip(key, self._known[0], strict=True)):
            self._known = (key, entry_arrows(session.project, plans, player.id))
        return self._known[1]

    def end_at(self, mouse: LaneMouse) -> tuple[EntryArrow, End] | None:
        """Return the arrow whose tail or head is under the mouse, and which of them; None if there is none."""
        return end_at(self.lane, self.arrows, mouse)

    def hover(self, mouse: LaneMouse | None) -> bool:
        """Highlight the arrow's end under the mouse, and return whether there is one."""
        found = None if mouse is None else self.end_at(mouse)
        if found != self._hovered:
            self._hovered = found
            self.update()
        return found is not None

    def show(self, drag: EntryDrag | None) -> None:
        """Draw the dragged arrow at its new place; None ends that."""
        self._drag = drag
        self._hovered = None
        self.update()

    @property
    def dragged(self) -> EntryArrow | None:
        """The dragged arrow of a cue at its new place; None if none is dragged."""
        return self._drag.shown if self._drag is not None and self._drag.began else None

    def drag_text(self, drag: EntryDrag) -> str:
        """Return the giver, receiver and place of a dragged cue as text."""
        project = self.lane.session.project
        if not drag.meant:
            return tr("piano_roll.entry_unchanged")
        names = [project.player(id).name for id in (drag.shown.giver_id, drag.shown.taker_id)]
        tick = project.score.tempo_map.ticks(drag.shown.from_s if drag.end == "tail" else drag.shown.to_s)
        return tr("piano_roll.entry_to").format(
            giver=names[0], taker=names[1], place=project.score.metre_map.label(round(tick))
        )

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        session = self.lane.session
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        dragged = self._drag.arrow if self._drag is not None and self._drag.began else None
        for arrow in self.arrows:
            held: End | None = self._hovered[1] if self._hovered is not None and self._hovered[0] == arrow else None
            colour = shade(session.colour(session.project.player(arrow.giver_id)), 60 if arrow == dragged else 220)
            self._paint(painter, arrow, colour, exposed, held)
        if self._drag is not None and dragged is not None:
            shown = self._drag.shown
            accent = QColor(session.colour(session.project.player(shown.giver_id)))
            self._paint(painter, shown, accent, exposed, self._drag.end, certain=self._drag.meant)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint(
        self,
        painter: QPainter,
        arrow: EntryArrow,
        colour: QColor,
        exposed: QRectF,
        held: End | None,
        certain: bool = True,
    ) -> None:
        axis = self.lane.axis
        start = QPointF(axis.x_px(arrow.from_s), self.lane.y_px(arrow.from_pitch + 0.5))
        end = QPointF(axis.x_px(arrow.to_s), self.lane.y_px(arrow.to_pitch + 0.5))
        if max(start.x(), end.x()) < exposed.left() - HEAD_PX or min(start.x(), end.x()) > exposed.right() + HEAD_PX:
            return
        head_px, dot_px = HEAD_PX * (HELD if held == "head" else 1.0), DOT_PX * (HELD if held == "tail" else 1.0)
        tip = end - QPointF(head_px, 0.0)
        bend = BEND * max(tip.x() - start.x(), 0.0)
        path = QPainterPath(start)
        path.cubicTo(start + QPointF(bend, 0.0), tip - QPointF(bend, 0.0), tip)
        painter.setPen(QPen(colour, 1.6, Qt.PenStyle.SolidLine if certain else Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(path)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(start, dot_px, dot_px)
        half = head_px / 2.0
        painter.drawPolygon(QPolygonF([end, tip + QPointF(0.0, half), tip - QPointF(0.0, half)]))
