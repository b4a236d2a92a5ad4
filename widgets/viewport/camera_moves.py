"""Moves of the camera: flights between views, following a player, orbit, pan and zoom. Nothing here knows Qt or GL."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray
from app.project.camera_bookmarks import View
from widgets.viewport import camera as moves
from widgets.viewport.camera import Camera

TRANSITION_S = 0.35
ARRIVED_M = 0.0008
"""A close-up nearer to its middle than this has arrived."""
ARRIVED_SHARE = 0.002
"""A distance within this share of where it goes has arrived."""
SLACK = 1.15
"""Factor by which what a close-up shows may grow before the camera goes back."""
LONGEST_STEP_S = 0.1
"""After a pause the camera goes on as if it had been this long."""


class Eye:
    """Camera position of the picture, with its flights. Times are any clock's, in seconds.

    Attributes
    ----------
    camera : Camera
        Of now.
    view : View
        What is looked at: close-ups follow it.
    touched : bool
        Whether the camera stands where the user moved it; else it is the view's own.
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
        """The camera, or where its flight ends."""
        return self._flight[1] if self._flight is not None else self.camera

    @property
    def shift_m(self) -> FloatArray:
        """Target of a close-up against what it follows, as the user shifted it (3,)."""
        return self._shift_m

    @property
    def flying(self) -> bool:
        """True while it is on its way to another place."""
        return self._flight is not None

    def choose(self, view: View) -> None:
        """Look at something else from now on."""
        self.view, self.touched, self._framed = view, False, None
        self._shift_m = np.zeros(3)

    def place(self, shift_m: FloatArray) -> None:
        """Stand as if the user had moved the camera, a close-up with this shift."""
        self.touched, self._shift_m = True, shift_m

    def jump(self, camera: Camera) -> None:
        """Look from there at once."""
        self.camera, self._flight, self._framed = camera, None, None

    def fly(self, camera: Camera, now_s: float) -> None:
        """Move the camera to another view within a short time."""
        self._flight, self._framed = (self.camera, camera, now_s), None

    def advance(self, now_s: float) -> bool:
        """Go on with a flight; whether there was one."""
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
        """The target for a followed place: the user may have shifted it."""
        shifted: FloatArray = middle_m + self._shift_m
        return shifted

    def follow(self, middle_m: FloatArray | None, now_s: float, needed_m: float | None = None) -> bool:
        """Go after a place; whether there is still a way to go.

        Parameters
        ----------
        middle_m : array (3,) or None
        now_s : float
        needed_m : float, optional
            Distance from which all that the close-up shows is in the picture; as far as it grows, the camera goes back.
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
        """Distance that keeps what a close-up shows in the picture: as framed, or farther."""
        if needed_m is None:
            return self.camera.distance_m
        if self._framed is None:
            self._framed = (self.camera.distance_m, needed_m)
        framed_m, needed_then_m = self._framed
        return framed_m * max(needed_m / (SLACK * needed_then_m), 1.0)

    def orbit(self, right_px: float, down_px: float) -> None:
        """Turn by hand."""
        self._grasp()
        self.camera = moves.orbit(self.camera, right_px, down_px)

    def pan(self, right_px: float, down_px: float, height_px: float) -> None:
        """Shift by hand; a close-up keeps the shift while it follows."""
        self._grasp()
        before = np.asarray(self.camera.target_m)
        self.camera = moves.pan(self.camera, right_px, down_px, height_px)
        self._shift_m = self._shift_m + np.asarray(self.camera.target_m) - before

    def dolly(self, steps: float) -> None:
        """Come nearer by hand."""
        self._grasp()
        self.camera = moves.dolly(self.camera, steps)

    def _grasp(self) -> None:
        self.touched, self._flight, self._framed = True, None, None
