"""Letters of dynamics in the engravers' bold italic, drawn with a broad pen along curves.

No music font is needed, and letters look the same on every system.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import cos, radians, sin
from typing import Final

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainterPath, QPolygonF

Curve = tuple[tuple[float, float], ...]
"""A start point, and three points for each following cubic curve: in heights of a small letter, y upwards."""

PEN_ANGLE: Final = radians(24.0)
BROAD, THIN = 0.29, 0.085
"""The pen's edges, in heights of a small letter."""
STEPS = 14
GAP = 0.06

_STEM_I: Final[Curve] = ((0.02, 0.72), (0.12, 0.9), (0.26, 1.06), (0.34, 0.94))
LETTERS: Final[dict[str, tuple[float, tuple[Curve, ...]]]] = {
    "p": (
        1.08,
        (
            (*_STEM_I, (0.4, 0.84), (0.18, 0.1), (-0.02, -0.52)),
            ((-0.22, -0.5), (-0.1, -0.56), (0.1, -0.56), (0.22, -0.5)),
            ((0.3, 0.62), (0.44, 0.92), (0.66, 1.04), (0.8, 0.92), (1.02, 0.74), (0.82, 0.14), (0.54, 0.02),
             (0.38, -0.04), (0.26, 0.06), (0.24, 0.2)),
        ),
    ),
    "m": (
        1.62,
        (
            (*_STEM_I, (0.4, 0.82), (0.26, 0.3), (0.18, 0.0)),
            ((0.3, 0.5), (0.44, 0.84), (0.6, 1.04), (0.74, 0.96), (0.9, 0.86), (0.72, 0.3), (0.66, 0.0)),
            ((0.8, 0.5), (0.94, 0.84), (1.1, 1.04), (1.24, 0.96), (1.4, 0.84), (1.18, 0.26), (1.2, 0.12),
             (1.22, -0.06), (1.4, 0.02), (1.52, 0.24)),
        ),
    ),
    "f": (
        0.92,
        (
            ((1.06, 1.4), (1.02, 1.62), (0.78, 1.66), (0.66, 1.34), (0.52, 0.94), (0.44, 0.2), (0.26, -0.3),
             (0.14, -0.62), (-0.12, -0.62), (-0.18, -0.4)),
            ((0.18, 0.94), (0.38, 0.98), (0.6, 0.98), (0.84, 0.94)),
        ),
    ),
    "s": (
        0.74,
        (
            ((0.66, 0.74), (0.68, 0.98), (0.34, 1.06), (0.26, 0.82), (0.18, 0.58), (0.62, 0.46), (0.56, 0.2),
             (0.5, -0.06), (0.1, -0.06), (0.08, 0.24)),
        ),
    ),
    "z": (
        0.82,
        (
            ((0.12, 0.78), (0.28, 1.02), (0.5, 0.84), (0.72, 0.96), (0.6, 0.7), (0.2, 0.3), (0.04, 0.02),
             (0.26, 0.2), (0.42, -0.04), (0.58, 0.02), (0.7, 0.06), (0.74, 0.14), (0.74, 0.24)),
        ),
    ),
    "r": (
        0.78,
        (
            (*_STEM_I, (0.4, 0.82), (0.26, 0.3), (0.18, 0.0)),
            ((0.3, 0.5), (0.42, 0.84), (0.54, 1.0), (0.72, 0.92)),
        ),
    ),
    "n": (
        1.12,
        (
            (*_STEM_I, (0.4, 0.82), (0.26, 0.3), (0.18, 0.0)),
            ((0.3, 0.5), (0.44, 0.84), (0.6, 1.04), (0.74, 0.96), (0.9, 0.84), (0.68, 0.26), (0.7, 0.12),
             (0.72, -0.06), (0.9, 0.02), (1.02, 0.24)),
        ),
    ),
}  # fmt: skip
"""Advance and curves of each letter."""
ASCENT, DESCENT = 1.6, 0.6
"""Extent of the highest and the lowest letter, in heights of a small letter."""


def are_letters(text: str) -> bool:
    """Return whether a text consists only of `LETTERS`."""
    return bool(text) and all(letter in LETTERS for letter in text)


@lru_cache(maxsize=256)
def letters_path(text: str, height_px: float) -> tuple[QPainterPath, float]:
    """Return the outline of a text from its left end on the base line, and its width.

    Parameters
    ----------
    text : str
        Only characters of `LETTERS`.
    height_px : float
        Height of a small letter.
    """
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.WindingFill)
    x = 0.0
    for letter in text:
        advance, curves = LETTERS[letter]
        for curve in curves:
            _sweep(path, curve, x, height_px)
        x += advance + GAP
    return path.simplified(), max(x - GAP, 0.0) * height_px


def _sweep(path: QPainterPath, curve: Curve, left: float, scale: float) -> None:
    """Add to ``path`` the area that a broad pen covers along a curve; ``left`` and ``scale`` place it in pixels."""
    points = _sampled(curve)
    long_x, long_y = BROAD / 2 * cos(PEN_ANGLE), BROAD / 2 * sin(PEN_ANGLE)
    wide_x, wide_y = -THIN / 2 * sin(PEN_ANGLE), THIN / 2 * cos(PEN_ANGLE)
    corners = [(a * long_x + b * wide_x, a * long_y + b * wide_y) for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    for (x0, y0), (x1, y1) in pairwise(points):
        covered = _hull([(x + dx, y + dy) for x, y in ((x0, y0), (x1, y1)) for dx, dy in corners])
        path.addPolygon(QPolygonF([QPointF((left + x) * scale, -y * scale) for x, y in covered]))
        path.closeSubpath()


def _sampled(curve: Curve) -> list[tuple[float, float]]:
    points = [curve[0]]
    for at in range(1, len(curve), 3):
        control = curve[at - 1 : at + 3]
        for step in range(1, STEPS + 1):
            t = step / STEPS
            weights = (1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t**2, t**3
            x, y = (sum(w * c[axis] for w, c in zip(weights, control, strict=True)) for axis in (0, 1))
            points.append((x, y))
    return points


def _hull(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the convex hull of points, always in the same sense of rotation, so that overlapping hulls fill without
    holes.
    """
    points = sorted(set(points))
    result: list[tuple[float, float]] = []
    for ordered in (points, points[::-1]):
        side: list[tuple[float, float]] = []
        for x, y in ordered:
            while len(side) > 1 and _turn(side[-2], side[-1], (x, y)) <= 0:
                side.pop()
            side.append((x, y))
        result += side[:-1]
    return result


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
