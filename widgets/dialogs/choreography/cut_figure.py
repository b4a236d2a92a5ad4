"""The pose at a frame of a motion as a stick figure, as seen from the front."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QSize
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.cuts import Cut
from app.choreography.features import POSES, features
from app.editor.session import Session
from widgets.common.choreography.figures import HIGHEST, draw_figures, placed

_WIDEST = 0.95
"""In parts of the body's height, with the arms to the sides."""
_PEN_PX = 2.5


def pose_of(clip: MotionClip, frame: int) -> FloatArray:
    """(21, 2) the body at a frame from the front: X to the right and Y up from the floor, in parts of its height."""
    poses = features(clip.span(frame, frame + 1), [Cut(0, 0, 0)])
    pose: FloatArray = poses.reshape(POSES, len(SEGMENTS) + len(ENDS), 3)[0, :, :2]
    return pose


class PoseFigure(QWidget):
    """Draws one pose.

    Parameters
    ----------
    session : Session
        For its colours.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("cut_figure")
        self._session = session
        self._pose: FloatArray | None = None
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Expanding)
        session.theme_changed.connect(self.update)

    @property
    def pose(self) -> FloatArray | None:
        """(21, 2) what is drawn, see `pose_of`; None: nothing."""
        return self._pose

    def show_pose(self, pose: FloatArray | None) -> None:
        """Draw another pose, or none."""
        self._pose = pose
        self.update()

    # Qt's own names

    def sizeHint(self) -> QSize:
        return QSize(180, 180)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = self._session.tokens
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        if self._pose is None:
            return
        height_px = 0.95 * min(self.height(), self.width() * HIGHEST / _WIDEST)
        floor_px = 0.5 * (self.height() + height_px) - 4.0
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(QPointF(0.0, floor_px), QPointF(self.width(), floor_px))
        points = placed(self._pose[None], np.array([self.width() / 2.0]), floor_px, height_px)
        draw_figures(painter, points, QColor(tokens.text), _PEN_PX, height_px)
