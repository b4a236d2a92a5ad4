"""The camera as a value: an orbit about a target; independent of Qt and GL.

World coordinates are metres with Y up; the audience is towards +Z, from where a camera with yaw 0 looks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray

FOV_DEG = 32.0
"""Vertical angle of view, as of a 42 mm lens on a full-frame camera: faces keep their shape."""
NEAREST_M, FARTHEST_M = 0.08, 120.0
LOWEST_RAD, HIGHEST_RAD = math.radians(-20.0), math.radians(89.9)
ORBIT_RAD_PER_PX = math.radians(0.35)
DOLLY_PER_STEP = 0.88
"""Factor of the distance for one step of the wheel."""


@dataclass(frozen=True)
class Camera:
    """A camera that looks at a target from a distance.

    Attributes
    ----------
    target_m : (float, float, float)
        Point in the middle of the picture.
    yaw_rad : float
        Angle from the audience (+Z), increasing towards +X.
    pitch_rad : float
        Angle above the horizontal; positive looks from above.
    distance_m : float
        Distance from the target.
    fov_deg : float
        Vertical angle of view.
    """

    target_m: tuple[float, float, float] = (0.0, 1.0, 0.0)
    yaw_rad: float = 0.0
    pitch_rad: float = math.radians(8.0)
    distance_m: float = 6.0
    fov_deg: float = FOV_DEG

    @property
    def eye_m(self) -> FloatArray:
        """Position (3,) of the camera in the world, metres."""
        return np.asarray(self.target_m) + self.distance_m * self.backward

    @property
    def backward(self) -> FloatArray:
        """Unit vector (3,) from the target to the camera."""
        level = math.cos(self.pitch_rad)
        return np.array(
            [math.sin(self.yaw_rad) * level, math.sin(self.pitch_rad), math.cos(self.yaw_rad) * level], np.float64
        )

    @property
    def right(self) -> FloatArray:
        """Unit vector (3,) in the world that points to the right in the picture."""
        return np.array([math.cos(self.yaw_rad), 0.0, -math.sin(self.yaw_rad)], np.float64)

    @property
    def up(self) -> FloatArray:
        """Unit vector (3,) in the world that points upwards in the picture."""
        steepness = math.sin(self.pitch_rad)
        return np.array(
            [-steepness * math.sin(self.yaw_rad), math.cos(self.pitch_rad), -steepness * math.cos(self.yaw_rad)],
            np.float64,
        )

    @property
    def near_m(self) -> float:
        """Distance of the near clipping plane in metres."""
        return min(max(0.04 * self.distance_m, 0.01), 0.4)

    @property
    def far_m(self) -> float:
        """Distance of the far clipping plane in metres."""
        return self.distance_m + 80.0

    def view(self) -> FloatArray:
        """Return the view matrix ``eye_from_world`` (4, 4)."""
        rotation = np.stack([self.right, self.up, self.backward])
        matrix = np.eye(4)
        matrix[:3, :3] = rotation
        matrix[:3, 3] = -rotation @ self.eye_m
        return matrix

    def projection(self, aspect: float) -> FloatArray:
        """Return the projection matrix ``clip_from_eye`` (4, 4) for a picture ``aspect`` times as wide as high."""
        f = 1.0 / math.tan(math.radians(self.fov_deg) / 2.0)
        near, far = self.near_m, self.far_m
        return np.array(
            [
                [f / aspect, 0.0, 0.0, 0.0],
                [0.0, f, 0.0, 0.0],
                [0.0, 0.0, (far + near) / (near - far), 2.0 * far * near / (near - far)],
                [0.0, 0.0, -1.0, 0.0],
            ]
        )

    def clip_from_world(self, aspect: float) -> FloatArray:
        """Return projection times view as a matrix (4, 4) for a picture of the given aspect (width / height)."""
        return self.projection(aspect) @ self.view()

    def pixels_per_metre(self, height_px: float, distance_m: float | None = None) -> float:
        """Return the pixels per metre at a distance (by default the target's) in a picture of a height in pixels."""
        distance = self.distance_m if distance_m is None else max(distance_m, 1e-3)
        return 0.5 * height_px / (distance * math.tan(math.radians(self.fov_deg) / 2.0))

    def project(self, points_m: npt.ArrayLike, width_px: float, height_px: float) -> tuple[FloatArray, FloatArray]:
        """Return the pixels (N, 2) of points from the upper left corner, and depths (N,) in metres in front of the
        eye.
        """
        points = np.atleast_2d(np.asarray(points_m, np.float64))
        view = self.view()
        eye = points @ view[:3, :3].T + view[:3, 3]
        depth = -eye[:, 2]
        scale = (
            0.5 * height_px / math.tan(math.radians(self.fov_deg) / 2.0) / np.where(np.abs(depth) < 1e-9, 1e-9, depth)
        )
        pixels = np.stack([0.5 * width_px + eye[:, 0] * scale, 0.5 * height_px - eye[:, 1] * scale], axis=-1)
        return pixels, depth

    def ray(self, x_px: float, y_px: float, width_px: float, height_px: float) -> tuple[FloatArray, FloatArray]:
        """Return origin (metres) and unit direction (3,) in the world of the line of sight through a pixel."""
        scale = math.tan(math.radians(self.fov_deg) / 2.0) / (0.5 * height_px)
        direction = -self.backward + scale * ((x_px - 0.5 * width_px) * self.right + (0.5 * height_px - y_px) * self.up)
        return self.eye_m, direction / np.linalg.norm(direction)


def orbit(camera: Camera, right_px: float, down_px: float) -> Camera:
    """Return the camera turned about the target by a drag, so that objects follow the mouse."""
    pitch = camera.pitch_rad + down_px * ORBIT_RAD_PER_PX
    return replace(
        camera,
        yaw_rad=_wrapped(camera.yaw_rad - right_px * ORBIT_RAD_PER_PX),
        pitch_rad=min(max(pitch, LOWEST_RAD), HIGHEST_RAD),
    )


def pan(camera: Camera, right_px: float, down_px: float, height_px: float) -> Camera:
    """Return the camera shifted by a drag, so that objects at the target's distance follow the mouse."""
    metre = 1.0 / camera.pixels_per_metre(height_px)
    target = np.asarray(camera.target_m) + metre * (down_px * camera.up - right_px * camera.right)
    return replace(camera, target_m=triple(target))


def dolly(camera: Camera, steps: float) -> Camera:
    """Return the camera moved nearer by steps of the wheel; negative steps move it away."""
    distance = camera.distance_m * DOLLY_PER_STEP**steps
    return replace(camera, distance_m=min(max(distance, NEAREST_M), FARTHEST_M))


def frame(camera: Camera, low_m: npt.ArrayLike, high_m: npt.ArrayLike, aspect: float, margin: float = 1.1) -> Camera:
    """Return the camera, in its direction, at the distance at which a whole box (``low_m`` to ``high_m``) is in the
    picture.
    """
    low, high = np.asarray(low_m, np.float64), np.asarray(high_m, np.float64)
    return frame_around(camera, (low + high) / 2.0, box_corners(low, high), aspect, margin)


def box_corners(low_m: FloatArray, high_m: FloatArray) -> FloatArray:
    """Return the corners (8, 3) of a box from its least and greatest one (3,)."""
    ends = np.stack([low_m, high_m], axis=1)
    return np.array([[x, y, z] for x in ends[0] for y in ends[1] for z in ends[2]])


def frame_points(camera: Camera, points_m: FloatArray, aspect: float, margin: float = 1.06) -> Camera:
    """Return the camera, in its direction, as near to points (N, 3) as all of them can be in the picture, with equal
    room on opposite sides; they fill at most 1 / ``margin`` of a side.
    """
    before = points_m @ camera.backward
    tangent = math.tan(math.radians(camera.fov_deg) / 2.0) / margin
    sides = ((points_m @ camera.right, tangent * aspect), (points_m @ camera.up, tangent))
    # A camera at (c, d) sees a point at (p, b) if |p - c| <= slope (d - b).
    needed = [((at + slope * before).max() - (at - slope * before).min()) / (2.0 * slope) for at, slope in sides]
    depth = (float(before.max()) + float(before.min())) / 2.0
    # The eye could be in the nearest point.
    eye = max(float(max(needed)), float(before.max()) + NEAREST_M)
    eye = min(eye, depth + FARTHEST_M)
    across, over = (_centre(at, np.maximum(eye - before, 1e-6)) for at, _ in sides)
    target = across * camera.right + over * camera.up + depth * camera.backward
    return replace(camera, target_m=triple(target), distance_m=eye - depth)


def _centre(places_m: FloatArray, away_m: FloatArray) -> float:
    """Return the place from which places (N,) at distances (N,) are seen equally far to both sides, by bisection."""
    low, high = float(places_m.min()), float(places_m.max())
    for _ in range(50):
        middle = (low + high) / 2.0
        seen = (places_m - middle) / away_m
        low, high = (middle, high) if seen.max() > -seen.min() else (low, middle)
    return (low + high) / 2.0


def frame_around(camera: Camera, middle_m: npt.ArrayLike, points_m: FloatArray, aspect: float, margin: float) -> Camera:
    """Return the camera, in its direction, aimed at a point (3,) with points (N, 3) in the picture, which fill at most
    1 / ``margin`` of a side.
    """
    middle = np.asarray(middle_m, np.float64)
    away = points_m - middle
    tangent = math.tan(math.radians(camera.fov_deg) / 2.0) / margin
    across, over, before = away @ camera.right, away @ camera.up, away @ camera.backward
    needed = before + np.maximum(np.abs(across) / (tangent * aspect), np.abs(over) / tangent)
    distance = min(max(float(needed.max()), NEAREST_M), FARTHEST_M)
    return replace(camera, target_m=triple(middle), distance_m=distance)


_FRONTAL_RAD = math.radians(10.0)
"""Angle within which a camera counts as being in front of a person."""


def from_other_side(camera: Camera, front_rad: float) -> Camera:
    """Return the camera on the other side of a person facing ``front_rad`` (from +Z towards +X)."""
    side = _wrapped(camera.yaw_rad - front_rad)
    is_frontal = min(abs(side), math.pi - abs(side)) < _FRONTAL_RAD
    return replace(camera, yaw_rad=_wrapped(front_rad + (side + math.pi if is_frontal else -side)))


def between(start: Camera, end: Camera, share: float) -> Camera:
    """Return a camera between two at a share 0..1 of the way, by the shorter rotation, eased at both ends."""
    if share >= 1.0:
        return end
    share = max(share, 0.0)
    eased = share * share * (3.0 - 2.0 * share)
    target = (1.0 - eased) * np.asarray(start.target_m) + eased * np.asarray(end.target_m)
    return Camera(
        target_m=triple(target),
        yaw_rad=_wrapped(start.yaw_rad + eased * _wrapped(end.yaw_rad - start.yaw_rad)),
        pitch_rad=start.pitch_rad + eased * (end.pitch_rad - start.pitch_rad),
        distance_m=start.distance_m ** (1.0 - eased) * end.distance_m**eased,
        fov_deg=start.fov_deg + eased * (end.fov_deg - start.fov_deg),
    )


def followed(
    camera: Camera, target_m: npt.ArrayLike, elapsed_s: float, distance_m: float | None = None, settle_s: float = 0.35
) -> Camera:
    """Return the camera moved towards a target and distance for ``elapsed_s`` seconds, like a damped spring without
    overshoot.

    ``settle_s`` is the time constant in seconds, in which 63 % of a jump is covered.
    """
    share = 1.0 - math.exp(-max(elapsed_s, 0.0) / settle_s)
    target = np.asarray(camera.target_m)
    goal_m = camera.distance_m if distance_m is None else distance_m
    return replace(
        camera,
        target_m=triple(target + share * (np.asarray(target_m, np.float64) - target)),
        distance_m=camera.distance_m ** (1.0 - share) * goal_m**share,
    )


def _wrapped(angle_rad: float) -> float:
    return (angle_rad + math.pi) % (2.0 * math.pi) - math.pi


def triple(vector: FloatArray) -> tuple[float, float, float]:
    """Convert a vector (3,) to a tuple of Python floats."""
    return float(vector[0]), float(vector[1]), float(vector[2])
