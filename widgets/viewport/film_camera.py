"""The camera of a film: fixed, or smoothly following the object of a close-up."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from app.project.camera_bookmarks import View
from widgets.viewport.camera import Camera, followed
from widgets.viewport.cast import Stage
from widgets.viewport.framing import tracked

_POSES: Final = 64
"""Greatest number of poses examined before a film."""
_LEAST_TIMES, _MOST_TIMES = 3, 17
_SETTLE_S: Final[dict[View, float]] = {"feet": 0.12}
"""Time constant in seconds with which the camera follows the object of a view, if not the usual one: travelling feet
would leave the picture.
"""
_USUAL_SETTLE_S: Final = 0.35


class Shot:
    """The camera of consecutive pictures, with fixed direction and distance.

    Parameters
    ----------
    view : View
        The view.
    camera : Camera
        Direction, distance and angle of view of the whole film.
    player_ids : tuple of str
        Filmed performers; a close-up shows the first.
    shift_m : (3,) float, optional
        Shift of a close-up's object from the middle of the picture.
    cameras : dict of float to Camera, optional
        Cameras by time in seconds: existing ones are used, others are added, so that two films agree.
    """

    def __init__(
        self,
        view: View,
        camera: Camera,
        player_ids: tuple[str, ...],
        shift_m: npt.ArrayLike = (0.0, 0.0, 0.0),
        cameras: dict[float, Camera] | None = None,
    ) -> None:
        self.view, self.player_ids = view, player_ids
        self._camera = camera
        self._cameras = cameras
        self._shift_m = np.asarray(shift_m, np.float64)
        self._last_s = -math.inf
        self.marked = False
        """Names, marks and rings are drawn."""

    def camera_at(self, stage: Stage, time_s: float) -> Camera:
        """Return the camera for a time (later than at the previous call) and the stage's poses then; the first camera
        is centred.
        """
        if self._cameras is not None and time_s in self._cameras:
            return self._cameras[time_s]
        rows = stage.rows(self.player_ids)
        middle_m = tracked(self.view, stage, rows[0]) if rows else None
        if middle_m is not None:
            settle_s = _SETTLE_S.get(self.view, _USUAL_SETTLE_S)
            elapsed_s = time_s - self._last_s
            self._camera = followed(self._camera, middle_m + self._shift_m, elapsed_s, settle_s=settle_s)
        self._last_s = time_s
        if self._cameras is not None:
            self._cameras[time_s] = self._camera
        return self._camera


def times_looked_at(players: int, start_s: float, end_s: float) -> list[float]:
    """Return the times in seconds at which players are measured before a film, to find a camera that shows them at all
    times.
    """
    if end_s <= start_s:
        return [start_s]
    count = min(max(_POSES // max(players, 1), _LEAST_TIMES), _MOST_TIMES)
    return [float(time_s) for time_s in np.linspace(start_s, end_s, count)]
