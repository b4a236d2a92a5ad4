"""A small picture of a character's head, for lists to choose from."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPolygonF

from app.rig.character_library import character_named
from app.rig.model import Character, Mesh

HEAD_M = 0.30
"""So much of a body, from the top, is seen."""
_LIGHT = np.array([0.35, 0.45, 0.82])
_OVERSAMPLED = 3

Floats = npt.NDArray[np.float64]


@lru_cache(maxsize=32)
def portrait_of(character_id: str, size_px: int) -> QImage:
    """The portrait of a bundled character; drawn once."""
    return portrait(character_named(character_id), size_px)


def portrait(character: Character, size_px: int) -> QImage:
    """The head from the front, as it is modelled, on nothing. May be drawn in any thread.

    Parameters
    ----------
    character : Character
    size_px : int
        Width and height in pixels.
    """
    top_m = max(float(mesh.positions_m[:, 1].max()) for mesh in character.meshes)
    corners, shades = [], []
    for mesh in character.meshes:
        triangles, colours = _seen(mesh, top_m - HEAD_M)
        corners.append(triangles)
        shades.append(colours)
    points, colours = np.concatenate(corners), np.concatenate(shades)
    order = np.argsort(points[:, :, 2].mean(axis=1), kind="stable")
    size = size_px * _OVERSAMPLED
    scale = size / HEAD_M
    places = np.stack([size / 2.0 + points[..., 0] * scale, (top_m + 0.01 - points[..., 1]) * scale], axis=-1)
    image = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    for index in order.tolist():
        colour = QColor.fromRgbF(*colours[index].tolist())
        # The outline closes the seam between neighbours.
        painter.setPen(colour)
        painter.setBrush(colour)
        painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in places[index].tolist()]))
    painter.end()
    smooth = Qt.TransformationMode.SmoothTransformation
    return image.scaled(size_px, size_px, Qt.AspectRatioMode.KeepAspectRatio, smooth)


def _seen(mesh: Mesh, bottom_m: float) -> tuple[Floats, Floats]:
    """Triangles (n, 3, 3) of the head that face the viewer, and their colours (n, 3) in sRGB."""
    positions, normals = mesh.positions_m.astype(np.float64), mesh.normals.astype(np.float64)
    corners = positions[mesh.triangles]
    facing = normals[mesh.triangles].mean(axis=1)
    two_sided = np.array([material.double_sided for material in mesh.materials])[mesh.triangle_materials]
    kept = (corners[:, :, 1].max(axis=1) > bottom_m) & ((facing[:, 2] > 0.0) | two_sided)
    base = np.array([material.base_color[:3] for material in mesh.materials])[mesh.triangle_materials[kept]]
    facing = facing[kept] * np.where(facing[kept, 2:3] < 0.0, -1.0, 1.0)
    length = np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-9)
    lit = 0.30 + 0.75 * np.clip(facing / length @ _LIGHT, 0.0, 1.0)
    return corners[kept], np.clip(base * lit[:, None], 0.0, 1.0) ** (1.0 / 2.2)
