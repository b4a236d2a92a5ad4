"""Mouse handling of the viewport: orbit, pan, zoom, click, and the handles of the pose tool."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from widgets.viewport.camera_moves import Eye
from widgets.viewport.handles import Handle
from widgets.viewport.overlay import handle_at
from widgets.viewport.pose_tool import PoseTool
from widgets.viewport.scene import ViewportScene

CLICK_PX = 4.0
"""A press that moves less than this number of pixels is a click."""
DOLLY_PX_PER_STEP = 40.0
WHEEL_STEP = 120.0
TOUCHPAD_PX_PER_STEP = 60.0


class Pointer(QObject):
    """Converts mouse events on the canvas to moves of the camera, selections, and poses.

    Parameters
    ----------
    canvas : QWidget
        Widget with the picture.
    session : Session
        Session with the selection.
    eye : Eye
        Camera to move.
    scene : ViewportScene
        Performers on the stage.
    tool : PoseTool
        Tool that changes poses.

    Signals
    -------
    moved()
        The picture changed: the camera moved, or another performer is under the mouse.
    posed()
        A handle was dragged.
    released()
        A drag has ended.
    menu_asked(QPoint)
        The right button was clicked at this point of the screen.
    framed(int)
        The dancer in this row of the stage was double-clicked, and the camera must frame it.
    """

    moved = Signal()
    posed = Signal()
    released = Signal()
    menu_asked = Signal(QPoint)
    framed = Signal(int)

    def __init__(self, canvas: QWidget, session: Session, eye: Eye, scene: ViewportScene, tool: PoseTool) -> None:
        super().__init__(canvas)
        self._canvas, self._session = canvas, session
        self._eye, self._scene, self._tool = eye, scene, tool
        self._press: QPointF | None = None
        self._last = QPointF()
        self.dragging = False
        """True once a press has become a drag."""
        self.hovered: int | None = None
        """Row of the player under the pointer."""
        canvas.setMouseTracking(True)
        canvas.installEventFilter(self)

    def row_at(self, at: QPointF) -> int | None:
        """Return the row of the performer under a point of the picture; None if there is none."""
        return self._scene.row_at(*self._eye.camera.ray(at.x(), at.y(), *self._size()))

    def forget(self) -> None:
        """Reset the performer under the mouse after a change of the stage."""
        self.hovered = None

    def _size(self) -> tuple[float, float]:
        return float(self._canvas.width()), float(self._canvas.height())

    def _handle_at(self, at: QPointF) -> Handle | None:
        return handle_at(self._scene.handles(), self._eye.camera, at.x(), at.y(), self._size())

    def _pressed(self, event: QMouseEvent) -> bool:
        self._press = self._last = event.position()
        self.dragging = False
        if event.button() == Qt.MouseButton.LeftButton:
            handle = self._handle_at(event.position())
            if handle is not None and self._tool.grasp(handle):
                self.moved.emit()
        return True

    def _dragged(self, event: QMouseEvent) -> bool:
        at = event.position()
        if self._press is None or not event.buttons():
            self._hover(at)
            return True
        if not self.dragging and (at - self._press).manhattanLength() < CLICK_PX:
            return True
        self.dragging = True
        step, self._last = at - self._last, at
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        left = bool(event.buttons() & Qt.MouseButton.LeftButton)
        if self._tool.grasped is not None:
            lean = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
            self._tool.drag(self._eye.camera, step.x(), step.y(), self._size()[1], shift, lean)
            self.posed.emit()
            return True
        control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        middle = bool(event.buttons() & Qt.MouseButton.MiddleButton)
        if event.buttons() & Qt.MouseButton.RightButton or (control and (left or middle)):
            self._eye.dolly(-step.y() / DOLLY_PX_PER_STEP)
        elif middle or (left and shift):
            self._eye.pan(step.x(), step.y(), self._size()[1])
        elif left:
            self._eye.orbit(step.x(), step.y())
        self.moved.emit()
        return True

    def _released(self, event: QMouseEvent) -> bool:
        clicked = self._press is not None and not self.dragging
        self._press, self.dragging = None, False
        if self._tool.grasped is not None:
            self._tool.release()
        elif clicked and event.button() == Qt.MouseButton.LeftButton:
            self._select(event.position(), bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))
        elif clicked and event.button() == Qt.MouseButton.RightButton:
            self.menu_asked.emit(event.globalPosition().toPoint())
        self._hover(event.position())
        self.released.emit()
        return True

    def _double_clicked(self, event: QMouseEvent) -> bool:
        handle = self._handle_at(event.position())
        if handle is not None:
            self._tool.reset(handle.target)
            return True
        row = self.row_at(event.position())
        if row is not None and self._dancer_id(row) is not None:
            self.framed.emit(row)
        elif row is not None:
            self._session.viewport.frame(True)
        return True

    def _wheeled(self, event: QWheelEvent) -> bool:
        turned, slid = event.angleDelta().y(), event.pixelDelta().y()
        self._eye.dolly(turned / WHEEL_STEP if turned else slid / TOUCHPAD_PX_PER_STEP)
        self.moved.emit()
        return True

    def _key_pressed(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape:
            if self._tool.cancel():
                self._press, self.dragging = None, False
                self.posed.emit()
                return True
            if self._session.viewport.posing:
                self._session.viewport.set_posing(False)
                return True
        # Other keys belong to the shell: shortcuts, and moving between panels.
        event.ignore()
        return False

    def _select(self, at: QPointF, add: bool) -> None:
        row, stage = self.row_at(at), self._scene.stage
        if row is None or stage is None:
            return
        dancer_id = self._dancer_id(row)
        if dancer_id is not None:
            # One dancer is selected at a time, beside the players.
            self._session.set_dancer(dancer_id)
            return
        player_id, before = stage.members[row].player_id, self._session.players
        if not add:
            self._session.set_players((player_id,))
        elif player_id not in before:
            self._session.set_players((*before, player_id))
        elif len(before) > 1:
            self._session.set_players(tuple(own for own in before if own != player_id))

    def _dancer_id(self, row: int) -> str | None:
        """Return the id of the dancer of a row; None for a player."""
        stage = self._scene.stage
        found = stage.members[row].player_id if stage is not None else ""
        return found if found in self._session.project.dancer_ids else None

    def _hover(self, at: QPointF | None) -> None:
        handle = self._handle_at(at) if at is not None else None
        row = self.row_at(at) if at is not None and handle is None else None
        if handle is not None:
            self._canvas.setCursor(Qt.CursorShape.SizeAllCursor)
        elif row is not None:
            self._canvas.setCursor(Qt.CursorShape.PointingHandCursor)
        else:
            self._canvas.unsetCursor()
        if row != self.hovered:
            self.hovered = row
            self.moved.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle the mouse, wheel and gestures on the canvas."""
        kind = event.type()
        if isinstance(event, QMouseEvent):
            if kind == QEvent.Type.MouseButtonPress:
                return self._pressed(event)
            if kind == QEvent.Type.MouseMove:
                return self._dragged(event)
            if kind == QEvent.Type.MouseButtonRelease:
                return self._released(event)
            if kind == QEvent.Type.MouseButtonDblClick:
                return self._double_clicked(event)
        elif isinstance(event, QWheelEvent):
            return self._wheeled(event)
        elif isinstance(event, QKeyEvent) and kind == QEvent.Type.KeyPress:
            return self._key_pressed(event)
        elif kind == QEvent.Type.Leave:
            self._hover(None)
        return super().eventFilter(watched, event)
