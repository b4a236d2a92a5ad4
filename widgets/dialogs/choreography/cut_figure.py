"""Drawing of the front view of a pose in a motion as a stick figure, and of the skeleton of its file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.cuts import Cut
from app.choreography.features import POSES, facing, features, height_m
from app.choreography.raw_skeleton import RawSkeleton
from app.choreography.read_motion import ReadMotion
from app.editor.session import Session
from app.rig import quaternion
from app.rig.characters.joint_mapping import JointMapping
from widgets.common.choreography.figures import HIGHEST, draw_figures, placed

_WIDEST = 1.15
"""Width of a body with the arms spread, relative to its height."""
_LEAST_WIDTH, _LEAST_HEIGHT = 0.5, 1.1
"""Least width and height of a fitted pose, relative to the body's height, with room for the head above its joints."""
_PEN_PX = 2.5


def pose_of(clip: MotionClip, frame: int) -> FloatArray:
    """Return the front view (21, 2) of the body's 21 points at a frame: X to the right, Y up from the floor, relative
    to the body's height.
    """
    poses = features(clip.span(frame, frame + 1), [Cut(0, 0, 0)])
    pose: FloatArray = poses.reshape(POSES, len(SEGMENTS) + len(ENDS), 3)[0, :, :2]
    return pose


class PoseFigure(QWidget):
    """Draws one pose.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    is_fitted : bool
        Whether the pose is scaled to fill the picture; else the scale is the same for all poses.
    """

    def __init__(self, session: Session, is_fitted: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("cut_figure")
        self._session, self._is_fitted = session, is_fitted
        self._pose: FloatArray | None = None
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Expanding)
        session.theme_changed.connect(self.update)

    @property
    def pose(self) -> FloatArray | None:
        """Points (21, 2) of the drawn pose, see `pose_of`; None for no pose."""
        return self._pose

    def show_pose(self, pose: FloatArray | None) -> None:
        """Draw a pose given by its points; None draws nothing."""
        self._pose = pose
        self.update()

    def _room(self) -> tuple[float, float]:
        """Return the drawn height of a body of the height `HIGHEST`, and the y of the floor, in pixels."""
        wide, high, points = _WIDEST, HIGHEST, self._points()
        if self._is_fitted and len(points):
            wide = max(_LEAST_WIDTH, 2.0 * float(np.abs(points[:, 0]).max()))
            high = max(_LEAST_HEIGHT, float(points[:, 1].max()))
        height_px = 0.95 * HIGHEST * min(self.height() / high, self.width() / wide)
        return height_px, 0.5 * (self.height() + height_px * high / HIGHEST) - 4.0

    def _points(self) -> FloatArray:
        """Return the drawn points (N, 2)."""
        return np.zeros((0, 2)) if self._pose is None else self._pose

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(180, 180)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = self._session.tokens
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        if self._pose is None:
            return
        height_px, floor_px = self._room()
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(QPointF(0.0, floor_px), QPointF(self.width(), floor_px))
        points = placed(self._pose[None], np.array([self.width() / 2.0]), floor_px, height_px)
        draw_figures(painter, points, QColor(tokens.text), _PEN_PX, height_px)


@dataclass(frozen=True, eq=False)
class SkeletonPose:
    """Front view of a file's skeleton: X to the right, Y up from its lowest point, relative to the height.

    Attributes
    ----------
    lines : ndarray, shape (L, 2, 2)
        Start and end of each line.
    marked : ndarray, shape (2,), or None
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
        return np.asarray(quaternion.rotate(turn, places - middle - low)[..., :2] / max(tall, 1e-9))

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
        return np.zeros((0, 2)) if self._skeleton is None else self._skeleton.lines.reshape(-1, 2)

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._skeleton is None:
            return
        tokens, (height_px, floor_px) = self._session.tokens, self._room()
        middle_px = np.array([self.width() / 2.0])
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.text), 1.5))
        lines = placed(self._skeleton.lines.reshape(1, -1, 2), middle_px, floor_px, height_px).reshape(-1, 4)
        painter.drawLines([QLineF(*line) for line in lines.tolist()])
        if self._skeleton.marked is not None:
            x, y = placed(self._skeleton.marked[None, None], middle_px, floor_px, height_px)[0, 0].tolist()
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.accent))
            painter.drawEllipse(QPointF(x, y), 4.0, 4.0)
