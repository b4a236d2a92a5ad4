"""An orchestra chair: padded seat and back on a frame of steel tubes, adapted to the leg length of the sitter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.formats.scene import Material
from app.rig.mesh import Mesh
from app.rig.supports.band import Shares, SurfaceStrip, mesh_of, tube

CHAIR: Final = "chair"
_MATERIALS: Final = (
    Material("chair_fabric", (0.030, 0.032, 0.038, 1.0), 0.0, 0.92),
    Material("chair_steel", (0.045, 0.046, 0.050, 1.0), 1.0, 0.42),
    Material("chair_rubber", (0.012, 0.012, 0.013, 1.0), 0.0, 0.9),
)
_FABRIC, _STEEL, _RUBBER = range(3)
_HALF_WIDTH_M, _DEPTH_M, _THICK_M = 0.205, 0.385, 0.052
_TUBE_M = 0.0105
_BACK_M = (0.215, 0.405)
"""Heights in metres of the lower and upper edge of the back above the seat."""
_LEAN = 0.16
"""Slope of the back: backward distance per height."""
_ROUND = 28


@dataclass(frozen=True, eq=False)
class ChairFit:
    """Sizes of a chair for a sitter, in the player's frame.

    Attributes
    ----------
    top_m : float
        Height of the top of the seat.
    rear_m : float
        z coordinate of the sitter's back; the chair's back is behind it.
    size : float
        Scale relative to an adult's chair.
    """

    top_m: float
    rear_m: float
    size: float

    @property
    def half_width_m(self) -> float:
        """Half the width of the seat in metres."""
        return self.size * _HALF_WIDTH_M

    @property
    def middle_m(self) -> FloatArray:
        """Middle (3,) of the top of the seat in the player's frame, metres."""
        return np.array([0.0, self.top_m, self.rear_m + self.size * (0.5 * _DEPTH_M - 0.015)])


def chair(fit: ChairFit, bone: int) -> Mesh:
    """Return the mesh of a chair, skinned to one bone, facing +Z, with its feet on the floor."""
    only: Shares = [(bone, 1.0)]
    size, half = fit.size, fit.half_width_m
    middle, deep = fit.middle_m, 0.5 * fit.size * _DEPTH_M
    top, thick = fit.top_m, min(size * _THICK_M, 0.4 * fit.top_m)
    strips = [_cushion(middle, half, deep, thick, only)]
    back_z, front_z = float(middle[2]) - deep, float(middle[2]) + deep
    low, high = (top + size * edge for edge in _BACK_M)
    strips += _back(half, size, top, back_z - 0.022 * size, (low, high), only)
    under = top - thick - _TUBE_M
    for side in (1.0, -1.0):
        x = side * (half - 0.022 * size)
        foot_x = x + side * 0.012 * size
        front = [(foot_x, 0.012, front_z - 0.030 * size), (x, under - 0.03, front_z - 0.045 * size)]
        strips.append(_leg(_bent([*front, (x, under, front_z - 0.085 * size), (x, under, back_z + 0.02 * size)]), only))
        back_x = side * (half - 0.008 * size)
        rear = [(back_x, 0.012, back_z - 0.055 * size), (back_x, under, back_z - 0.012 * size)]
        end = (back_x, high - 0.02 * size, back_z - 0.03 * size - _LEAN * (high - top))
        strips.append(_leg(_bent([*rear, (back_x, top + 0.05 * size, back_z - 0.016 * size), end]), only))
        for x_m, z_m in ((foot_x, front_z - 0.030 * size), (back_x, back_z - 0.055 * size)):
            strips.append(_foot(x_m, z_m, only))
    for z, y in ((front_z - 0.10 * size, under), (back_z + 0.012 * size, under)):
        strips.append(_leg(np.array([(-half + 0.012 * size, y, z), (half - 0.012 * size, y, z)]), only))
    return mesh_of(CHAIR, strips, _MATERIALS)


def _cushion(middle: FloatArray, half: float, deep: float, thick: float, only: Shares) -> SurfaceStrip:
    """Return the surface of a seat with rounded edges and a flat top: ``half`` the width, half the depth ``deep`` and
    thickness ``thick`` in metres, with the ``middle`` (3,) of its top; ``only`` is its bone.
    """
    rounding = 0.42 * thick
    edge = [(1.5 * rounding, 0.0), (rounding, 0.0), (0.3 * rounding, 0.25 * rounding), (0.0, rounding)]
    profile = [(0.4, -thick), *((inset, height - thick) for inset, height in edge)]
    profile += [*((inset, -height) for inset, height in reversed(edge)), (0.4, 0.0)]
    return _slab(middle, half, deep, 0.22 * half, profile, np.eye(3), only)


def _back(
    half: float, size: float, top: float, z: float, edges_m: tuple[float, float], only: Shares
) -> list[SurfaceStrip]:
    """Return the surfaces of the padded, inclined back of a chair between two heights ``edges_m``; ``half`` is half its
    width, ``top`` the height of the seat, ``z`` the place of the back's front, and ``only`` its bone.
    """
    low, high = edges_m
    tall, thick = 0.5 * (high - low), 0.028 * size
    middle = np.array([0.0, low + tall, z - _LEAN * (low + tall - top)])
    lean = np.array([0.0, 1.0, -_LEAN]) / np.hypot(1.0, _LEAN)
    # Columns: sideways, the direction of the front, and downwards.
    turn = np.stack([[1.0, 0.0, 0.0], np.cross([1.0, 0.0, 0.0], lean) * -1.0, -lean], axis=1)
    turn[:, 1] = np.cross(turn[:, 2], turn[:, 0])
    rounding = 0.45 * thick
    profile = [(0.4, -thick), (1.6 * rounding, -thick), (rounding, -thick), (0.0, -thick + rounding)]
    profile += [(0.0, -rounding), (rounding, 0.0), (1.6 * rounding, 0.0), (0.4, 0.0)]
    return [_slab(middle, half - 0.004, tall, 0.5 * tall, profile, turn, only)]


def _slab(
    middle: FloatArray,
    half: float,
    deep: float,
    corner: float,
    profile: Sequence[tuple[float, float]],
    turn: FloatArray,
    only: Shares,
) -> SurfaceStrip:
    """Return the surface of a rounded rectangular body.

    ``profile`` has (inset, height) of its outlines, from below to above; an inset of 0.4 m or more contracts the
    outline to a point in the middle. ``half`` and ``deep`` are half its width and half its depth.
    """
    rings = []
    for inset, height in profile:
        if inset >= 0.4:
            outline = np.zeros((_ROUND, 2))
        else:
            outline = _rounded(half - inset, deep - inset, max(corner - inset, 0.2 * corner))
        local = np.stack([outline[:, 0], np.full(_ROUND, height), outline[:, 1]], axis=1)
        rings.append(middle + local @ turn.T)
    return SurfaceStrip(np.array(rings), [only] * len(rings), True, _FABRIC)


def _rounded(half: float, deep: float, corner: float) -> FloatArray:
    """Return the outline (N, 2) of a rectangle with rounded corners; seen from +Y, the first coordinate points to the
    right, the second down, and the outline runs anticlockwise.
    """
    corner = min(corner, half, deep)
    quarters = np.array([(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]).repeat(_ROUND // 4, axis=0)
    outline: FloatArray = quarters * [half - corner, deep - corner] + corner * _CIRCLE
    return outline


_ANGLES_RAD = 0.5 * np.pi * (np.linspace(1.0, 0.0, _ROUND // 4) - np.arange(4)[:, None]).ravel()
_CIRCLE = np.stack([np.cos(_ANGLES_RAD), np.sin(_ANGLES_RAD)], axis=1)
"""Corners of an outline: four quarters of a circle, each with both of its ends."""


def _leg(line_m: FloatArray, only: Shares) -> SurfaceStrip:
    radii = np.full(len(line_m), _TUBE_M)
    line = np.concatenate([line_m[:1], line_m, line_m[-1:]])
    line[0] += 1e-5 * (line_m[0] - line_m[1])
    line[-1] += 1e-5 * (line_m[-1] - line_m[-2])
    return tube(line, np.concatenate([[0.0], radii, [0.0]]), [only] * len(line), _STEEL, 12)


def _foot(x_m: float, z_m: float, only: Shares) -> SurfaceStrip:
    heights = np.array([0.0, 0.0, 0.012, 0.022, 0.022])
    line = np.stack([np.full(5, x_m), heights, np.full(5, z_m)], axis=1)
    line[0, 1], line[4, 1] = -1e-5, 0.02201
    return tube(line, np.array([0.0, 0.0145, 0.0145, 0.0115, 0.0]), [only] * 5, _RUBBER, 12)


def _bent(corners: Sequence[tuple[float, float, float]]) -> FloatArray:
    """Return points (N, 3) of a line along the given corners, with each corner rounded."""
    points = np.array(corners)
    line = [points[0]]
    for before, corner, after in zip(points[:-2], points[1:-1], points[2:], strict=True):
        back, on = before - corner, after - corner
        reach = min(0.05, 0.45 * float(np.linalg.norm(back)), 0.45 * float(np.linalg.norm(on)))
        a, b = corner + back / np.linalg.norm(back) * reach, corner + on / np.linalg.norm(on) * reach
        line += [(1 - t) ** 2 * a + 2 * t * (1 - t) * corner + t**2 * b for t in np.linspace(0.0, 1.0, 7)]
    return np.array([*line, points[-1]])
