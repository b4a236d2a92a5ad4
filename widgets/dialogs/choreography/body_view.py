"""Direction from which drawn bodies are seen: an orbit about the vertical through the hips, without perspective."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from app.arrays import FloatArray

RAD_PER_PX: Final = math.radians(0.8)
LOWEST_RAD, HIGHEST_RAD = math.radians(-20.0), math.radians(89.9)

ViewName = Literal["front", "side", "three_quarter"]


@dataclass(frozen=True)
class BodyView:
    """Direction of the viewer from the body, which faces +Z.

    Attributes
    ----------
    yaw_rad : float
        Angle from the front towards the body's left.
    pitch_rad : float
        Angle above the horizontal.
    """

    yaw_rad: float = 0.0
    pitch_rad: float = 0.0

    def seen(self, points: FloatArray) -> FloatArray:
        """Convert points (..., 3) to the viewer's axes: X to the right, Y up, Z towards the viewer."""
        yaw_sin, yaw_cos = math.sin(self.yaw_rad), math.cos(self.yaw_rad)
        sin, cos = math.sin(self.pitch_rad), math.cos(self.pitch_rad)
        axes = ((yaw_cos, 0.0, -yaw_sin), (-yaw_sin * sin, cos, -yaw_cos * sin), (yaw_sin * cos, sin, yaw_cos * cos))
        return np.asarray(points @ np.array(axes).T)

    def dragged(self, right_px: float, down_px: float) -> BodyView:
        """Return the view after a drag, so that the body follows the mouse."""
        yaw_rad = math.remainder(self.yaw_rad - right_px * RAD_PER_PX, math.tau)
        return BodyView(yaw_rad, min(max(self.pitch_rad + down_px * RAD_PER_PX, LOWEST_RAD), HIGHEST_RAD))


VIEWS: Final[Mapping[ViewName, BodyView]] = {
    "front": BodyView(),
    "side": BodyView(math.radians(-90.0)),
    "three_quarter": BodyView(math.radians(-40.0), math.radians(15.0)),
}
"""Views from the front, from the body's right, and from between them and above."""
