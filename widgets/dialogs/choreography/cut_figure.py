"""Drawing of a pose in a motion as a stick figure with feet, and of the skeleton of its file, seen from any side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.arrays import FloatArray
from app.choreography.body_pose import BodyPose
from app.choreography.features import facing, height_m
from app.choreography.raw_skeleton import RawSkeleton
from app.choreography.read_motion import ReadMotion
from app.editor.session import Session
from app.rig import quaternion
from app.rig.characters.joint_mapping import JointMapping
from widgets.common.choreography.figures import HIGHEST, draw_figures, placed
from widgets.dialogs.choreography.body_view import BodyView

_WIDEST = 1.15
"""Width of a body with the arms spread, relative to its height."""
_LEAST_WIDTH, _LEAST_HEIGHT = 0.5, 1.1
"""Least width and height of a fitted pose, relative to the body's height, with room for the head above its joints."""
_PEN_PX = 2.5
_AHEAD: Final = np.array(
    [(0.0, 0.0, 0.0), (0.0, 0.0, 0.34), (0.04, 0.0, 0.27), (-0.04, 0.0, 0.27), (0.0, 0.04, 0.27)], np.float64
)
"""Arrow on the floor that shows where the body faces: start, tip and ends of the barbs, relative to the height."""
_LOW_PART = 0.34
"""Way on the floor in front of the body that stays in sight, relative to the height."""


class PoseFigure(QWidget):
    """Draws one pose.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    is_fitted : bool
        Whether the pose is scaled to fill the picture, can be orbited and has an arrow that points ahead; else the
        scale is the same for all poses, which are seen from the front.

    Signals
    -------
    orbited(BodyView)
        The user dragged to this view.
    """

    orbited = Signal(object)

    def __init__(self, session: Session, is_fitted: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("cut_figure")
        self._session, self._is_fitted = session, is_fitted
        self._pose: BodyPose | None = None
        self._view = BodyView()
        self._held: QPointF | None = None
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Expanding)
        if is_fitted:
            self.setCursor(Qt.CursorShape.OpenHandCursor)
        session.theme_changed.connect(self.update)

    @property
    def pose(self) -> BodyPose | None:
        """The drawn pose; None for no pose."""
        return self._pose

    @property
    def view(self) -> BodyView:
        """The direction from which the pose is seen."""
        return self._view

    def show_pose(self, pose: BodyPose | None) -> None:
        """Draw a pose; None draws nothing."""
        self._pose = pose
        self.update()

    def show_from(self, view: BodyView) -> None:
        """Draw the pose from another direction."""
        self._view = view
        self.update()

    def _room(self) -> tuple[float, float]:
        """Return the drawn height of a body of the height `HIGHEST`, and the y of the floor below the hips, in
        pixels.
        """
        wide, high, below, points = _WIDEST, HIGHEST, 0.0, self._points()
        if self._is_fitted and len(points):
            wide = max(_LEAST_WIDTH, 2.0 * float(np.hypot(points[:, 0], points[:, 2]).max()))
            cos, sin = np.cos(self._view.pitch_rad), abs(np.sin(self._view.pitch_rad))
            below = max(_LOW_PART, 0.5 * wide) * sin
            high = max(_LEAST_HEIGHT, float(points[:, 1].max())) * cos + 2.0 * below
        height_px = 0.95 * HIGHEST * min(self.height() / high, self.width() / wide)
        return height_px, 0.5 * (self.height() + height_px * (high - 2.0 * below) / HIGHEST) - 4.0

    def _points(self) -> FloatArray:
        """Return the drawn points (N, 3)."""
        return np.zeros((0, 3)) if self._pose is None else self._pose.points

    def _placed(self, points: FloatArray) -> FloatArray:
        """Convert points (..., 3) to pixels (..., 2)."""
        height_px, floor_px = self._room()
        seen = self._view.seen(points)[..., :2].reshape(1, -1, 2)
        pixels = placed(seen, np.array([self.width() / 2.0]), floor_px, height_px)
        return np.asarray(pixels.reshape(*points.shape[:-1], 2))

    def _lines(self, points: FloatArray) -> list[QLineF]:
        """Return the lines (N, 2, 3) in pixels."""
        return [QLineF(*line) for line in self._placed(points).reshape(-1, 4).tolist()]

    def _draw_floor(self, painter: QPainter) -> None:
        painter.setPen(QPen(QColor(self._session.tokens.line_strong), 1.0))
        floor_px = self._room()[1]
        if abs(self._view.pitch_rad) < 1e-3:
            painter.drawLine(QPointF(0.0, floor_px), QPointF(self.width(), floor_px))
        if self._is_fitted:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(QColor(self._session.tokens.text_dim), 1.5))
            painter.drawLines(self._lines(np.array([(_AHEAD[barb], _AHEAD[1]) for barb in (0, 2, 3, 4)])))

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(180, 180)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if self._is_fitted and event.button() == Qt.MouseButton.LeftButton:
            self._held = event.position()
            self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._held is not None:
            step, self._held = event.position() - self._held, event.position()
            self.orbited.emit(self._view.dragged(step.x(), step.y()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._held is not None and event.button() == Qt.MouseButton.LeftButton:
            self._held = None
            self.setCursor(Qt.CursorShape.OpenHandCursor)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, pose = self._session.tokens, self._pose
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        if not len(self._points()):
            return
        self._draw_floor(painter)
        if pose is None:
            return
        draw_figures(painter, self._placed(pose.points)[None], QColor(tokens.text), _PEN_PX, self._room()[0])
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.text), 1.0))
        painter.setBrush(QColor(tokens.text))
        for foot in self._placed(pose.feet):
            ankle, *sole = (QPointF(*point) for point in foot.tolist())
            painter.drawPolygon(QPolygonF(sole))
            for start, end in zip(sole, sole[1:] + sole[:1], strict=True):
                painter.drawPolygon(QPolygonF([ankle, start, end]))
        if self._is_fitted:
            painter.setPen(QPen(QColor(tokens.accent), _PEN_PX + 0.5, c=Qt.PenCapStyle.RoundCap))
            painter.drawLines(self._lines(pose.knees))


@dataclass(frozen=True, eq=False)
class SkeletonPose:
    """A file's skeleton: X to its left, Y up from its lowest point, Z ahead, relative to the height.

    Attributes
    ----------
    lines : ndarray, shape (L, 2, 3)
        Start and end of each line.
    marked : ndarray, shape (3,), or None
        Position of the marked joint.
    """

    lines: FloatArray
    marked: FloatArray | None


def skeleton_pose(
    skeleton: RawSkeleton, mapping: JointMapping, motion: ReadMotion | None, bone: int | None
) -> SkeletonPose:
    """Return a file's skeleton for drawing, facing forwards as in the motion's first frame, or else by its hip joints;
    ``bone`` is marked.
    """
    across = np.zeros(3)
    if {"leftUpperLeg", "rightUpperLeg"} <= mapping.bones.keys():
        left, right = (skeleton.places[mapping.bones[f"{side}UpperLeg"]] for side in ("left", "right"))
        across = left - right
    turn = quaternion.from_axis_angle((0.0, 1.0, 0.0), float(np.arctan2(across[2], across[0])))
    if motion is not None:
        turn = quaternion.conjugate(facing(motion.clip.span(0, 1))[0])
    ends = skeleton.lines.reshape(-1, 3)
    tall = float(np.ptp(skeleton.places[:, 1])) if motion is None else height_m(motion.clip) / motion.unit_m
    middle = skeleton.places[mapping.bones.get("hips", 0)] * (1.0, 0.0, 1.0)
    low = np.array([0.0, float(ends[:, 1].min()), 0.0])

    def seen(places: FloatArray) -> FloatArray:
        return np.asarray(quaternion.rotate(turn, places - middle - low) / max(tall, 1e-9))

    return SkeletonPose(seen(skeleton.lines), None if bone is None else seen(skeleton.places[bone]))


class SkeletonFigure(PoseFigure):
    """Draws the skeleton of a file."""

    def __init__(self, session: Session, is_fitted: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(session, is_fitted, parent)
        self._skeleton: SkeletonPose | None = None

    @property
    def skeleton(self) -> SkeletonPose | None:
        """The skeleton that is drawn; None before a motion is shown."""
        return self._skeleton

    def show_skeleton(self, skeleton: SkeletonPose | None) -> None:
        """Draw a skeleton in one frame; None draws nothing."""
        self._skeleton = skeleton
        self.update()

    def _points(self) -> FloatArray:
        return np.zeros((0, 3)) if self._skeleton is None else self._skeleton.lines.reshape(-1, 3)

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._skeleton is None:
            return
        tokens = self._session.tokens
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.text), 1.5))
        painter.drawLines(self._lines(self._skeleton.lines))
        if self._skeleton.marked is not None:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.accent))
            painter.drawEllipse(QPointF(*self._placed(self._skeleton.marked).tolist()), 4.0, 4.0)
