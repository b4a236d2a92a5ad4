"""Moves of the camera: flights between views, following a player, orbit, pan and zoom; independent of Qt and GL."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray
from app.project.camera_bookmarks import View
from widgets.viewport import camera as moves
from widgets.viewport.camera import Camera

TRANSITION_S = 0.35
ARRIVED_M = 0.0008
"""Distance in metres from its centre below which a close-up has arrived."""
ARRIVED_SHARE = 0.002
"""Relative difference of the distance below which it has arrived."""
SLACK = 1.15
"""Factor by which a close-up's contents may grow before the camera moves back."""
LONGEST_STEP_S = 0.1
"""Longest step in seconds after a pause."""


class Eye:
    """The viewport's camera with its flights. Times are seconds of any one clock.

    Attributes
    ----------
    camera : Camera
        The present camera.
    view : View
        Present view; close-ups follow their object.
    touched : bool
        Whether the user has moved the camera.
    """

    def __init__(self) -> None:
        self.camera = Camera()
        self.view: View = "ensemble"
        self.touched = False
        self._flight: tuple[Camera, Camera, float] | None = None
        self._shift_m = np.zeros(3)
        self._last_s = 0.0
        self._framed: tuple[float, float] | None = None
        """The distance as framed, and the one that was needed then; None: not known yet."""

    @property
    def destination(self) -> Camera:
        """The camera, or the camera at the end of its flight."""
        return self._flight[1] if self._flight is not None else self.camera

    @property
    def shift_m(self) -> FloatArray:
        """Shift (3,) in metres of a close-up's centre from the followed object, as set by the user."""
        return self._shift_m

    @property
    def flying(self) -> bool:
        """True while the camera moves to a new view."""
        return self._flight is not None

    def choose(self, view: View) -> None:
        """Choose a named view (such as the front), and discard the user's own moves and shift; the camera itself does
        not move yet.
        """
        self.view, self.touched, self._framed = view, False, None
        self._shift_m = np.zeros(3)

    def place(self, shift_m: FloatArray) -> None:
        """Record that the user has moved the camera; ``shift_m`` (3,) is the distance in metres of a close-up's centre
        from the followed object, zero in other views."""
        self.touched, self._shift_m = True, shift_m

    def jump(self, camera: Camera) -> None:
        """Set the camera immediately, without a flight."""
        self.camera, self._flight, self._framed = camera, None, None

    def fly(self, camera: Camera, now_s: float) -> None:
        """Move the camera to another view within a short time."""
        self._flight, self._framed = (self.camera, camera, now_s), None

    def advance(self, now_s: float) -> bool:
        """Continue a flight, and return whether there was one."""
        if self._flight is None:
            return False
        start, end, since_s = self._flight
        share = (now_s - since_s) / TRANSITION_S
        self.camera = moves.between(start, end, share)
        self._last_s = now_s
        if share >= 1.0:
            self._flight = None
        return True

    def centred(self, middle_m: FloatArray) -> FloatArray:
        """Return the point (3,) that the camera looks at: a followed point plus the user's shift."""
        shifted: FloatArray = middle_m + self._shift_m
        return shifted

    def follow(self, middle_m: FloatArray | None, now_s: float, needed_m: float | None = None) -> bool:
        """Move the camera towards a followed point, and return whether it must move further.

        Parameters
        ----------
        middle_m : array (3,) or None
            The followed point; None if the view follows nothing.
        now_s : float
            Present time.
        needed_m : float, optional
            Distance in metres at which all of a close-up's contents are visible; the camera moves back if it grows.
        """
        elapsed_s, self._last_s = min(now_s - self._last_s, LONGEST_STEP_S), now_s
        if middle_m is None or self._flight is not None:
            return False
        goal = self.centred(middle_m)
        distance_m = self._distance_m(needed_m)
        self.camera = moves.followed(self.camera, goal, elapsed_s, distance_m)
        away = np.linalg.norm(goal - np.asarray(self.camera.target_m)) > ARRIVED_M
        return bool(away or abs(self.camera.distance_m / distance_m - 1.0) > ARRIVED_SHARE)

    def _distance_m(self, needed_m: float | None) -> float:
        """Return the distance in metres that keeps a close-up's contents visible: as framed, or greater."""
        if needed_m is None:
            return self.camera.distance_m
        if self._framed is None:
            self._framed = (self.camera.distance_m, needed_m)
        framed_m, needed_then_m = self._framed
        return framed_m * max(needed_m / (SLACK * needed_then_m), 1.0)

    def orbit(self, right_px: float, down_px: float) -> None:
        """Turn the camera by a drag of the user."""
        self._grasp()
        self.camera = moves.orbit(self.camera, right_px, down_px)

    def pan(self, right_px: float, down_px: float, height_px: float) -> None:
        """Shift the camera by a drag of the user; a close-up keeps the shift while following."""
        self._grasp()
        before = np.asarray(self.camera.target_m)
        self.camera = moves.pan(self.camera, right_px, down_px, height_px)
        self._shift_m = self._shift_m + np.asarray(self.camera.target_m) - before

    def dolly(self, steps: float) -> None:
        """Move the camera nearer by steps of the user's mouse wheel."""
        self._grasp()
        self.camera = moves.dolly(self.camera, steps)

    def _grasp(self) -> None:
        self.touched, self._flight, self._framed = True, None, None
