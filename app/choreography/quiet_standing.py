"""Dancers who stand before or after their dance breathe, and shift their weight from foot to foot.

People who stand quietly in captures move their fastest joint at about 0.05 m/s, as a mean of a second (two figures of
Animated Drawings and `cmu_martial_04` in ``shared/data/mocap``).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.features import height_m
from app.choreography.foot_plants import FootPlant
from app.choreography.joins import STATURE_M
from app.choreography.standing_feet import planted
from app.rig import quaternion

CALM_S: Final = 1.2
"""Time in seconds for which a pose is held before the body moves in it."""
RISES_S: Final = 1.5
"""Time in seconds in which this motion grows to its full size."""
SHIFTS_M: Final = (0.03, 0.01)
"""Distance in metres to which weight is shifted aside and ahead, by a body of `STATURE_M`."""
SHIFTS_S: Final = (4.4, 3.1)
"""Time in seconds from one shift aside, or ahead, to the next."""
BREATH_S: Final = 3.4
"""Time in seconds of a breath."""
LOOKS_S: Final = 7.3
"""Time in seconds of a slow turn of the head to both sides."""
UNEVEN: Final = 0.3
"""Size of a second, slower wave relative to the first, so that no two shifts are alike."""
_SLOWER: Final = 2.3
_TURNS_DEG: Final = {
    # Of each segment about +X (forward), +Y (to the left) and +Z, which lowers the right side: by breath, shift, look.
    "spine": ((-0.4, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)),
    "chest": ((-1.0, 0.0, 0.0), (0.0, 0.5, 0.6), (0.0, 0.4, 0.0)),
    "head": ((0.9, 0.0, 0.0), (0.0, 0.0, -0.9), (0.4, 3.0, 0.0)),
    "leftUpperArm": ((0.3, 0.0, 0.9), (0.5, 0.0, -0.5), (0.0, 0.0, 0.0)),
    "rightUpperArm": ((0.3, 0.0, -0.9), (-0.5, 0.0, -0.5), (0.0, 0.0, 0.0)),
    "leftLowerArm": ((-0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    "rightLowerArm": ((-0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
}
_UP: Final = np.array([0.0, 1.0, 0.0])


def quietly(clip: MotionClip, still: FloatArray, seed: int) -> MotionClip:
    """Return a motion whose dancer breathes and shifts weight over planted feet while it stands still.

    Parameters
    ----------
    still : (F,) float64
        For each frame how many seconds the body has been, or will be, at rest; 0 while it moves.
    seed : int
        Seed; another one gives other moments of breaths and shifts.
    """
    grown = np.clip((still - CALM_S) / RISES_S, 0.0, 1.0)
    (frames,) = np.nonzero(grown > 0.0)
    if not len(frames):
        return clip
    here = slice(int(frames[0]), int(frames[-1]) + 1)
    size = (grown**3 * (10.0 - 15.0 * grown + 6.0 * grown**2))[here]
    part, random = clip.span(here.start, here.stop), np.random.default_rng([seed, here.start > 0])
    times_s = np.arange(len(part)) / float(clip.fps)
    aside, ahead, breath, look = (size * _wave(times_s, every_s, random) for every_s in (*SHIFTS_S, BREATH_S, LOOKS_S))
    rotations, tips = part.rotations.copy(order="K"), tips_m(part)
    for name, turns in _TURNS_DEG.items():
        turn = np.radians(sum(np.outer(wave, by) for wave, by in zip((breath, aside, look), turns, strict=True)))
        at = SEGMENTS.index(name)
        rotations[:, at] = quaternion.multiply(quaternion.from_rotation_vector(turn), rotations[:, at])
    facing = quaternion.from_axis_angle(_UP, quaternion.twist_angle(part.rotations[:, 0], _UP))
    scale = height_m(clip) / STATURE_M
    moved = quaternion.rotate(facing, scale * np.stack([SHIFTS_M[0] * aside, 0.0 * aside, SHIFTS_M[1] * ahead], 1))
    moving = replace(part, hips_m=part.hips_m + moved, rotations=quaternion.continuous(rotations))
    plants = tuple(FootPlant(foot, 0, len(part), tuple(tips[0, foot].tolist())) for foot in range(2))
    moving = planted(moving, plants)
    hips_m, every = clip.hips_m.copy(order="K"), clip.rotations.copy(order="K")
    hips_m[here], every[here] = moving.hips_m, moving.rotations
    return replace(clip, hips_m=hips_m, rotations=quaternion.continuous(every))


def _wave(times_s: FloatArray, every_s: float, random: np.random.Generator) -> FloatArray:
    """Return an uneven wave (F,) of about -1 to 1 with a period of ``every_s`` seconds and random phases."""
    phases = random.uniform(0.0, 2.0 * np.pi, 2)
    first, second = (
        np.sin(2.0 * np.pi * times_s / (every_s * slower) + phase)
        for slower, phase in zip((1.0, _SLOWER), phases, strict=True)
    )
    return np.asarray((first + UNEVEN * second) / (1.0 + UNEVEN))
