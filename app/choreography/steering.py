"""Steering of a dance: the dancer is brought back to the usual place, and faces the audience, at the end in particular.

Each run of frames is turned and moved slightly where it begins.
"""

from __future__ import annotations

import cmath
import math
from typing import Final, NamedTuple

import numpy as np

from app.arrays import ComplexArray, FloatArray, IntArray
from app.choreography.joins import FADE_S
from app.choreography.sequence import CLOSING_S
from app.choreography.stage import STAGE_M
from app.rig import quaternion

FACES_RAD: Final = math.radians(6.0)
"""Greatest mean angle in radians of a motion from facing the audience; spins and turns of the capture remain
complete.
"""
TURN_BACK: Final = 1.0
MOST_TURN_RAD: Final = math.radians(70.0)
STEP_BACK: Final = 0.2
MOST_STEP_M: Final = 0.08
"""`TURN_BACK` and `STEP_BACK` are the shares of the excess over `FACES_RAD` and `STAGE_M` that each run corrects,
`MOST_TURN_RAD` and `MOST_STEP_M` the greatest corrections.
"""
SPINS_RAD_S: Final = 5.0
"""Speed in radians per second from which a turn of the hips is a spin, in which facing is not corrected."""
FACES_S: Final = 0.2
"""Seconds of motion whose mean is the direction in which a dance ends."""
_UP: Final = np.array([0.0, 1.0, 0.0])


class Ahead(NamedTuple):
    """Directions in which R runs of captured frames face, as complex numbers.

    Attributes
    ----------
    faces : list of complex
        Mean direction of the hips in each run, small if they turn around in it; in runs that begin within `CLOSING_S`
        before the end of the dance, the direction in which it would end.
    spins : list of bool
        Whether the hips turn at `SPINS_RAD_S` or more at some moment soon after the start of each run.
    """

    faces: list[complex]
    spins: list[bool]

    @classmethod
    def of(cls, rotations: FloatArray, runs: IntArray, ends: int, fps: float) -> Ahead:
        """Return the directions in a captured motion.

        Parameters
        ----------
        rotations : (N, 16, 4) float64
            Local rotations in which each run is followed by one more frame of its motion.
        runs : (R + 1,) int64
            First frame of each run, and the frame after the last one, without these additional frames.
        ends : int
            Frame before which the dance ends.
        """
        yaw = quaternion.twist_angle(rotations[:, 0], _UP)
        turns_rad = np.abs(np.diff(yaw, append=yaw[-1:]))
        turns_rad, directions = np.minimum(turns_rad, 2.0 * np.pi - turns_rad), np.exp(1j * yaw)
        soon, added = round(FADE_S * fps) + 1, np.arange(len(runs) - 1)
        spans = list(zip((runs[:-1] + added).tolist(), (runs[1:] + added).tolist(), strict=True))
        faces = [complex(directions[start:stop].mean()) for start, stop in spans]
        fastest = [turns_rad[start : min(stop, start + soon) - 1].max(initial=0.0) for start, stop in spans]
        last = min(int(np.searchsorted(runs, ends)), len(spans)) - 1
        first = min(int(np.searchsorted(runs, ends - CLOSING_S * fps)), last + 1)
        for run, left in _turning_left(directions, spans[first : last + 1], ends + last, FACES_S * fps):
            faces[first + run] = complex(directions[spans[first + run][0]] * left)
        return cls(faces, [float(one) * fps >= SPINS_RAD_S for one in fastest])

    def steered(self, run: int, turn: float, moved: complex, here: complex, lately: complex) -> tuple[float, complex]:
        """Correct rotation and move of a run of frames slightly. A spin in progress is not turned.

        Parameters
        ----------
        turn, moved
            Rotation in radians, and move over the floor (complex, metres).
        here, lately : complex
            Present position of the hips, and the recent mean, from which the dancer is brought back.
        """
        off = cmath.phase(cmath.exp(1j * turn) * self.faces[run])
        if abs(off) > FACES_RAD and not self.spins[run]:
            nudge = -math.copysign(min(TURN_BACK * (abs(off) - FACES_RAD), MOST_TURN_RAD), off)
            # Rotated about the position of the body, so that it does not orbit the centre of the stage.
            moved = here + complex(np.exp(1j * nudge)) * (moved - here)
            turn += nudge
        away = abs(lately)
        if away > 0.5 * STAGE_M:
            moved -= lately / away * min(STEP_BACK * (away - 0.5 * STAGE_M), MOST_STEP_M)
        return turn, moved


def _turning_left(
    directions: ComplexArray, spans: list[tuple[int, int]], ends: int, mean_frames: float
) -> list[tuple[int, complex]]:
    """For each of some runs, given as spans (start, stop), return its index and the rotation (complex) from its start
    to the end of the dance, in the last of them before the frame ``ends``; the body goes on in its direction at joins.
    """
    left, found = 1.0 + 0.0j, []
    for run, (start, stop) in reversed(list(enumerate(spans))):
        there = directions[stop]
        if run == len(spans) - 1:
            stop = min(ends, stop)
            there = directions[max(start, stop - round(mean_frames)) : stop].mean()
        left *= there / directions[start]
        found.append((run, complex(left)))
    return found
