"""Dancers as stick figures, for the timeline, menus and the dialog about a choreography."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPen, QPixmap

from app.arrays import FloatArray

HIGHEST = 1.3
"""Height with the arms raised, relative to the body's height."""
LEAST_HEAD = 0.13
"""Least size of the head relative to the body's height, since motion-capture skeletons often end within the head."""
ICON_PX = 40


def draw_figures(painter: QPainter, points: FloatArray, colour: QColor, width_px: float, height_px: float) -> None:
    """Draw N stick figures (N, 21, 2), in pixels; ``height_px`` is the value given to `placed`, ``width_px`` the width
    of lines.
    """
    from app.choreography.performed.dance_steps import BONES, HEAD

    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    pen = QPen(colour, width_px)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    painter.setPen(pen)
    ends = points[:, np.array(BONES)].reshape(-1, 4)
    painter.drawLines([QLineF(*line) for line in ends.tolist()])
    neck, crown = points[:, HEAD[0]], points[:, HEAD[1]]
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    for start, up in zip(neck, crown - neck, strict=True):
        long = float(np.linalg.norm(up))
        tall = max(long, LEAST_HEAD * height_px / HIGHEST)
        upright = up / long if long else np.array([0.0, -1.0])
        painter.drawEllipse(QPointF(*(start + upright * tall / 2.0)), 0.36 * tall, 0.5 * tall)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def placed(drawn: FloatArray, middles_px: FloatArray, floor_px: float, height_px: float) -> FloatArray:
    """Return N stick figures (N, 21, 2) converted from parts of the body's height to pixels.

    Each figure's middle is at ``middles_px`` (N,), its feet at ``floor_px``; ``height_px`` is the height of the
    tallest.
    """
    scale = height_px / HIGHEST
    return np.stack([middles_px[:, None] + scale * drawn[..., 0], floor_px - scale * drawn[..., 1]], axis=-1)


def figure_icon(drawn: FloatArray, colour: QColor, ratio: float) -> QIcon:
    """Return a stick figure (21, 2) as the icon of a menu entry; ``ratio`` is the number of screen pixels per pixel."""
    picture = QPixmap(QSize(ICON_PX, ICON_PX) * ratio)
    picture.setDevicePixelRatio(ratio)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    draw_figures(
        painter, placed(drawn[None], np.array([ICON_PX / 2]), ICON_PX - 2.0, ICON_PX - 4.0), colour, 1.6, ICON_PX - 4.0
    )
    painter.end()
    return QIcon(picture)
