"""Overlay painted with Qt: names, skeletons, contact points, handles of the pose tool."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from app.arrays import FloatArray
from app.editor.design_tokens import Tokens
from app.plan.events_by_hand import PoseTarget
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage
from widgets.viewport.contacts import ContactReading
from widgets.viewport.handles import Handle

HANDLE_RADIUS_PX = 13.0
CROWN_M = np.array([0.0, 0.12, 0.0])
"""Position of the crown in the frame of the head's joint in metres."""
NAME_UP_M = 0.19
_RING_PX = HANDLE_RADIUS_PX + 2.0
_FACE_M, _FACE_HALF_M = np.array([0.0, 0.08, 0.04]), 0.13
"""Centre of the face in the frame of the head's joint, and half the side of a square around it, in metres."""
_STEPS, _SAME_PX2 = 5, 1e-3
"""Number of distances tried for a label, and difference of areas in square pixels that counts as equal."""
_SIDES = ((0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
"""Directions to the right and down in order of preference."""
CLOSE_MM, NEAR_MM = 2.0, 4.0
"""Distances in millimetres within which a touch is displayed as correct, and as almost correct."""


@dataclass(frozen=True, eq=False)
class NameTag:
    """A performer's name to be painted over the head."""

    text: str
    color: str
    """Colour of an active player; empty for others."""
    at_m: FloatArray
    in_front: bool


@dataclass(frozen=True, eq=False)
class OverlayMarks:
    """Names, skeletons, contact points and handles to be painted over the 3D picture."""

    names: Sequence[NameTag] = ()
    skeletons: Sequence[tuple[int, str]] = ()
    """Skeletons that are drawn: rows of the stage with their colour."""
    touches: Sequence[ContactReading] = ()
    handles: Sequence[Handle] = ()
    grasped: PoseTarget | None = None
    corrected: frozenset[PoseTarget] = field(default_factory=frozenset)
    reading: str = ""
    """Angles displayed beside the dragged handle."""

    def __bool__(self) -> bool:
        return bool(self.names or self.skeletons or self.touches or self.handles)


def paint(
    painter: QPainter, marks: OverlayMarks, stage: Stage, camera: Camera, size: tuple[float, float], tokens: Tokens
) -> None:
    """Paint marks over a picture of a size (width, height)."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    for row, color in marks.skeletons:
        _paint_skeleton(painter, stage, row, color, camera, size, tokens)
    names = _placed_names(painter, marks.names, camera, size) if marks.names else []
    if marks.touches:
        _paint_touches(painter, marks.touches, camera, size, tokens, [box for _, box in names])
    if marks.handles:
        seen = [box for _, box in names] + (faces(stage, camera, size) if marks.reading else [])
        _paint_handles(painter, marks, camera, size, tokens, seen)
    for name, box in names:
        _paint_pill(painter, name.text, box, tokens, name.color if name.in_front else "")


def over_heads_m(stage: Stage, rows: Sequence[int], upwards: FloatArray) -> FloatArray:
    """Return points (R, 3) a little above the heads of R players in the direction ``upwards`` of the picture."""
    heads = stage.joints[rows, stage.heads[rows]]
    places_m: FloatArray = heads[..., :3] @ CROWN_M + heads[..., 3] + NAME_UP_M * upwards
    return places_m


def handle_at(
    handles: Sequence[Handle], camera: Camera, x_px: float, y_px: float, size: tuple[float, float]
) -> Handle | None:
    """Return the handle at a point of the picture; of several, the one nearest to the camera; None if there is none."""
    if not handles:
        return None
    places, depths = camera.project(np.array([handle.at_m for handle in handles]), *size)
    off = np.hypot(places[:, 0] - x_px, places[:, 1] - y_px)
    # As large as a target for a finger or pen, larger than it is drawn.
    found = [index for index in range(len(handles)) if off[index] <= HANDLE_RADIUS_PX + 4.0 and depths[index] > 0.0]
    return handles[min(found, key=lambda index: off[index])] if found else None


def _paint_skeleton(
    painter: QPainter, stage: Stage, row: int, color: str, camera: Camera, size: tuple[float, float], tokens: Tokens
) -> None:
    skeleton = stage.members[row].assets.character.skeleton
    places, depths = camera.project(stage.joints[row, : len(skeleton.names), :, 3], *size)
    lines, dots = [], []
    for joint, parent in enumerate(skeleton.parents):
        if depths[joint] <= 0.0 or parent < 0:
            continue
        dots.append(QPointF(*places[joint]))
        if parent > 0 and depths[parent] > 0.0:
            lines.append(QLineF(QPointF(*places[parent]), QPointF(*places[joint])))
    painter.setPen(QPen(_faded(tokens.sunken, 0.7), 3.6, c=Qt.PenCapStyle.RoundCap))
    painter.drawLines(lines)
    painter.setPen(QPen(QColor(color), 1.6, c=Qt.PenCapStyle.RoundCap))
    painter.drawLines(lines)
    painter.setPen(QPen(QColor(tokens.text), 4.2, c=Qt.PenCapStyle.RoundCap))
    painter.drawPoints(dots)


def _paint_touches(
    painter: QPainter,
    touches: Sequence[ContactReading],
    camera: Camera,
    size: tuple[float, float],
    tokens: Tokens,
    names: Sequence[QRectF],
) -> None:
    """Paint contact points of fingers with their distances from where they should be, without overlapping names."""
    requested, depths = camera.project(np.array([touch.requested_m for touch in touches]), *size)
    found, _ = camera.project(np.array([touch.found_m for touch in touches]), *size)
    font = _font(painter, 9.0)
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    taken = list(names)
    for touch, goal, place, depth in zip(touches, requested, found, depths, strict=True):
        if depth <= 0.0:
            continue
        distance = touch.distance_mm
        color = tokens.good if distance <= CLOSE_MM else tokens.warning if distance <= NEAR_MM else tokens.error
        if not touch.firm:
            color = tokens.text_dim
        painter.setPen(QPen(QColor(color), 1.6))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(QPointF(*goal), 4.5, 4.5)
        painter.drawLine(QPointF(*goal), QPointF(*place))
        painter.setBrush(QColor(color))
        painter.drawEllipse(QPointF(*place), 2.0, 2.0)
        if not touch.firm or camera.pixels_per_metre(size[1], float(depth)) < 500.0:
            continue
        text = f"{distance:.1f} mm"
        box = QRectF(
            goal[0] + 9.0, goal[1] - metrics.height() / 2.0, metrics.horizontalAdvance(text) + 8.0, metrics.height()
        )
        for _ in range(24):
            other = next((item for item in taken if item.intersects(box)), None)
            if other is None:
                break
            box.moveTop(other.bottom() + 1.0)
        taken.append(box)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(_faded(tokens.sunken, 0.78))
        painter.drawRoundedRect(box, 3.0, 3.0)
        painter.setPen(QColor(color))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def _paint_handles(
    painter: QPainter,
    marks: OverlayMarks,
    camera: Camera,
    size: tuple[float, float],
    tokens: Tokens,
    taken: Sequence[QRectF],
) -> None:
    """Paint handles and the angles of the dragged one, without overlapping names, faces and other handles."""
    places, depths = camera.project(np.array([handle.at_m for handle in marks.handles]), *size)
    for handle, place, depth in zip(marks.handles, places, depths, strict=True):
        if depth <= 0.0:
            continue
        at = QPointF(*place)
        grasped = handle.target == marks.grasped
        ring = tokens.accent if grasped else tokens.by_hand if handle.target in marks.corrected else tokens.text
        painter.setBrush(_faded(tokens.sunken, 0.55))
        painter.setPen(QPen(_faded(tokens.sunken, 0.8), 4.0))
        painter.drawEllipse(at, HANDLE_RADIUS_PX, HANDLE_RADIUS_PX)
        painter.setPen(QPen(QColor(ring), 2.0))
        painter.drawEllipse(at, HANDLE_RADIUS_PX, HANDLE_RADIUS_PX)
        painter.setBrush(QColor(ring))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.drawEllipse(at, 3.0, 3.0)
    grasped_at = next(
        (QPointF(*at) for one, at in zip(marks.handles, places, strict=True) if one.target == marks.grasped), None
    )
    if grasped_at is None or not marks.reading:
        return
    seen = [*taken, *(QRectF(x - _RING_PX, y - _RING_PX, 2.0 * _RING_PX, 2.0 * _RING_PX) for x, y in places)]
    metrics = QFontMetricsF(_font(painter, 9.0, bold=True))
    box = clear_of(_pill_box(metrics, marks.reading, grasped_at, size), grasped_at, seen, size)
    _paint_pill(painter, marks.reading, box, tokens, tokens.accent)


def clear_of(box: QRectF, at: QPointF, taken: Sequence[QRectF], size: tuple[float, float]) -> QRectF:
    """Return the rectangle ``box`` placed beside a handle at ``at``, inside the picture and with the least overlap with
    ``taken``: preferably above, else below, beside, or farther away."""
    far = HANDLE_RADIUS_PX + 4.0
    picture = QRectF(0.0, 0.0, *size)
    best, least = box, float("inf")
    for step in range(_STEPS):
        off = far + step * (box.height() + 2.0)
        for right, down in _SIDES:
            middle = at + QPointF(right * (off + box.width() / 2.0), down * (off + box.height() / 2.0))
            moved = QRectF(box)
            moved.moveCenter(middle)
            inside = moved.intersected(picture)
            covered = sum((_area(moved.intersected(other)) for other in taken), _area(moved) - _area(inside))
            if covered < least - _SAME_PX2:
                best, least = moved, covered
    return best


def _area(box: QRectF) -> float:
    return box.width() * box.height() if box.isValid() else 0.0


def faces(stage: Stage, camera: Camera, size: tuple[float, float]) -> list[QRectF]:
    """Return squares in pixels around the heads of all visible performers, which labels should not cover."""
    rows = [row for row in np.flatnonzero(stage.shown) if stage.members[row].has_body]
    if not rows:
        return []
    heads = stage.joints[rows, stage.heads[rows]]
    places, depths = camera.project(heads[:, :, :3] @ _FACE_M + heads[:, :, 3], *size)
    boxes = []
    for (x, y), depth in zip(places, depths, strict=True):
        if depth > 0.0:
            half = _FACE_HALF_M * camera.pixels_per_metre(size[1], float(depth))
            boxes.append(QRectF(x - half, y - half, 2.0 * half, 2.0 * half))
    return boxes


def _placed_names(
    painter: QPainter, names: Sequence[NameTag], camera: Camera, size: tuple[float, float]
) -> list[tuple[NameTag, QRectF]]:
    """Return the name tags with room in the picture and their rectangles in pixels, nearest first; a tag that would
    cover a nearer one is left out."""
    places, depths = camera.project(np.array([name.at_m for name in names]), *size)
    metrics = {bold: QFontMetricsF(_font(painter, 9.0, bold)) for bold in (False, True)}
    placed: list[tuple[NameTag, QRectF]] = []
    # Selected players first, then the nearest; a name that would cover another is omitted.
    for index in sorted(range(len(names)), key=lambda index: (not names[index].in_front, depths[index])):
        name, place = names[index], places[index]
        if depths[index] <= 0.0 or not (-50.0 < place[0] < size[0] + 50.0 and 0.0 < place[1] < size[1]):
            continue
        box = _pill_box(metrics[name.in_front], name.text, QPointF(*place), size)
        if not name.in_front and any(box.intersects(other) for _, other in placed):
            continue
        placed.append((name, box))
    return placed


def _pill_box(metrics: QFontMetricsF, text: str, at: QPointF, size: tuple[float, float]) -> QRectF:
    """Return the rectangle of a short text at a point, kept within the picture."""
    width, height = metrics.horizontalAdvance(text) + 14.0, metrics.height() + 4.0
    left = min(max(at.x() - width / 2.0, 4.0), max(size[0] - width - 4.0, 4.0))
    top = min(max(at.y() - height / 2.0, 4.0), max(size[1] - height - 4.0, 4.0))
    return QRectF(left, top, width, height)


def _paint_pill(painter: QPainter, text: str, box: QRectF, tokens: Tokens, color: str) -> None:
    """Paint a short text on a rounded background, with a coloured border if given."""
    painter.setFont(_font(painter, 9.0, bold=bool(color)))
    painter.setBrush(_faded(tokens.sunken, 0.72))
    painter.setPen(QPen(QColor(color), 1.2) if color else Qt.PenStyle.NoPen)
    painter.drawRoundedRect(box, box.height() / 2.0, box.height() / 2.0)
    painter.setPen(QColor(tokens.text if color else tokens.text_dim))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def _font(painter: QPainter, size_pt: float, bold: bool = False) -> QFont:
    font = QFont(painter.font())
    font.setPointSizeF(size_pt)
    font.setBold(bold)
    return font


def _faded(color: str, opacity: float) -> QColor:
    result = QColor(color)
    result.setAlphaF(opacity)
    return result
