"""Limits sudden changes of the rotation speeds of legs where feet land or leave, by raising or lowering heels and by
turning knees.

A foot that lands earlier or later than captured stops within a frame, and with it the knee. The tip of the foot must be
where it is, but its heel may follow a moment later: ankle, knee and hip then slow down over a few frames, and the foot
neither moves nor skids.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_speeds import changes_rad, runs, sudden, turns_rad
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import LEG, foot_paths, legs_along, soles_m
from app.choreography.legs_apart import knees_turned
from app.rig import quaternion
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

ROOM: Final = 0.85
FROM: Final = 0.9
"""Share of the limit to which changes are reduced, since other limits change the legs again slightly, and above which
they are.
"""
AROUND_S: Final = 0.1
"""Time in seconds before and after a sudden change within which a heel is moved."""
EDGE: Final = 2
"""Number of unchanged frames at either end of such a span."""
ROUNDS: Final = 100
"""Number of steps by which the angles of heels are found."""
TRIES: Final = 3
"""Greatest number of passes, since legs follow heels only approximately in proportion."""
MOST_RAD: Final = 0.35
"""Greatest angle in radians by which a heel is raised or lowered about the tip of its foot."""
LEAST_FOLLOW: Final = 0.1
"""Sum of squares of the turns per radian of a heel below which a leg counts as following no less."""
SOME_RAD: Final = 0.01
"""Angle in radians by which heels are raised to find how legs follow."""
EXACT_M: Final = 1e-4
"""Distance in metres within which the tip of a standing foot stays."""
_ACROSS: Final = (1.0, 0.0, 0.0)
_ANKLES: Final = tuple(1 + SEGMENTS.index(name) for name in FEET)


@dataclass(frozen=True, eq=False)
class _Legs:
    """Turns of the joints of a leg from frame to frame as vectors in radians, and how they follow the heel.

    Attributes
    ----------
    path : (F, 3, 3) float64
        Sum of the turns of thigh, shank and foot up to each frame.
    follow : (F, 3, 3) float64
        Change of each turn per radian by which the heel is raised.
    """

    path: FloatArray
    follow: FloatArray


def heels_within_changes(clip: MotionClip, planted: BoolArray, most_rad_s: float, most_m_s2: float) -> MotionClip:
    """Return the motion with the angular velocity of each joint of the legs changing by at most ``most_rad_s`` from
    frame to frame, as far as heels can be raised and lowered for it; tips of feet stay. The same object is returned if
    no change is greater.

    Parameters
    ----------
    planted : (F, 2) bool
        Frames in which the left and the right foot stand.
    most_m_s2 : float
        Acceleration of ankles in m/s^2 above which none becomes greater.
    """
    fps = float(clip.fps)
    for _ in range(TRIES):
        calmer = _calmer(clip, planted, ROOM * most_rad_s / fps, most_m_s2 / fps**2, _heels)
        if calmer is clip:
            break
        clip = calmer
    return clip


def knees_within_changes(clip: MotionClip, planted: BoolArray, most_rad_s: float) -> MotionClip:
    """Return the motion with the angular velocity of each joint of the legs changing by at most ``most_rad_s`` from
    frame to frame, as far as knees can be turned about the line between hip joint and ankle for it; feet stay. The same
    object is returned if no change is greater.
    """
    return _calmer(clip, planted, ROOM * most_rad_s / float(clip.fps), np.inf, _knees)


class _Moves(NamedTuple):
    """Motion of legs that are moved by angles.

    Attributes
    ----------
    moved : callable
        Motion in some frames (N,) with both legs moved by angles (N, 2) in radians.
    least_rad : (N, 2) float64
        Least angles.
    """

    moved: Callable[[FloatArray], MotionClip]
    least_rad: FloatArray


def _heels(clip: MotionClip, part: MotionClip, planted: BoolArray, frames: IntArray, tips: FloatArray) -> _Moves:
    """Heels that are raised about the tips of feet; they are lowered down to the floor."""
    paths, world = foot_paths(clip, tips, planted).at(frames), part.world(_ANKLES)
    reach_m = [float(np.linalg.norm(clip.shape.ends_m[ENDS.index(name)])) for name in FEET]
    least_rad = -np.minimum(np.maximum(soles_m(part, world)[..., 1], 0.0) / reach_m, MOST_RAD)
    return _Moves(lambda raised: legs_along(part, _heels_turned(world, raised), paths), least_rad)


def _knees(clip: MotionClip, part: MotionClip, planted: BoolArray, frames: IntArray, tips: FloatArray) -> _Moves:
    """Knees that are turned about the lines between hip joints and ankles."""
    world = part.world()
    return _Moves(lambda turned: knees_turned(part, world, turned.T), np.full((len(frames), 2), -MOST_RAD))


def _calmer(
    clip: MotionClip,
    planted: BoolArray,
    most_rad: float,
    most_m: float,
    moves_of: Callable[[MotionClip, MotionClip, BoolArray, IntArray, FloatArray], _Moves],
) -> MotionClip:
    """Move legs where their angular velocities change by more than ``most_rad`` a frame; the same object is returned
    if none does, or if the moves cannot help. Second differences of ankles greater than ``most_m`` do not grow.
    """
    around = 2 * (round(AROUND_S * float(clip.fps)) + EDGE) + 1
    snaps = sudden(clip.rotations, FROM / ROOM * most_rad)
    spans = [
        (foot, slice(start, stop))
        for foot in range(2)
        for start, stop in runs(maximum_filter1d(snaps[:, _leg(foot)].any(axis=1), around))
    ]
    if not spans:
        return clip
    legs_world, moves = clip.world(_ANKLES), np.zeros(len(clip), bool)
    tips = tips_m(clip, legs_world)
    for _, here in spans:
        moves[here] = True
    frames = np.flatnonzero(moves)
    # Legs are moved only in the frames of the spans, of which ``along`` are the places among these frames.
    part, along = clip.at(frames), np.cumsum(moves) - 1
    moved_by = moves_of(clip, part, planted, frames, tips)
    some = moved_by.moved(np.full((len(frames), 2), SOME_RAD))
    lengths = [here.stop - here.start for _, here in spans]
    legs, least = [], []
    follow = [_turns(part.rotations[:, leg], some.rotations[:, leg]) / SOME_RAD for leg in map(_leg, range(2))]
    places = [slice(along[here.start], along[here.start] + here.stop - here.start) for _, here in spans]
    for (foot, here), place in zip(spans, places, strict=True):
        path = np.pad(np.cumsum(turns_rad(clip.rotations[here, _leg(foot)]), axis=0), ((1, 0), (0, 0), (0, 0)))
        legs.append(_Legs(path, follow[foot][place]))
        least.append(moved_by.least_rad[place, foot])
    raised = np.zeros((len(frames), 2))
    # All spans are one path: the frames at which they meet stay.
    every = _angles(_joined(legs), np.concatenate(least), _inside(lengths), most_rad)
    for (foot, _), place, angles in zip(spans, places, np.split(every, np.cumsum(lengths)[:-1]), strict=True):
        raised[place, foot] = angles
    found = moved_by.moved(raised)
    moved = found.world(_ANKLES)
    off = planted[frames] & (np.linalg.norm(tips_m(found, moved) - tips[frames], axis=-1) > EXACT_M)
    rotations, changed = clip.rotations.copy(order="K"), False
    for (foot, here), place in zip(spans, places, strict=True):
        beside, leg = slice(max(0, here.start - 2), here.stop + 2), _leg(foot)
        inside = slice(here.start - beside.start, here.stop - beside.start)
        new = rotations[beside, leg].copy()
        new[inside] = found.rotations[place, leg]
        ankle = legs_world.of(leg.stop)[0][beside].copy()
        before = _acceleration(ankle)
        ankle[inside] = moved.of(leg.stop)[0][place]
        if off[place, foot].any() or _acceleration(ankle) > max(most_m, before):
            continue
        if _square(turns_rad(new), most_rad) < _square(turns_rad(rotations[beside, leg]), most_rad):
            rotations[beside, leg] = new
            changed = True
    return replace(clip, rotations=quaternion.continuous(rotations)) if changed else clip


def _leg(foot: int) -> slice:
    """Indices of thigh, shank and foot."""
    first = SEGMENTS.index(f"{SIDES[foot]}{LEG[0]}")
    assert SEGMENTS[first : first + 3] == tuple(f"{SIDES[foot]}{part}" for part in LEG)
    return slice(first, first + 3)


def _heels_turned(world: JointTransforms, raised: FloatArray) -> JointTransforms:
    """Turn the feet by angles (F, 2) in radians about their own axes to the left, heels up."""
    result = world.only(world.joints)
    for foot, joint in enumerate(_ANKLES):
        turn = quaternion.from_rotation_vector(quaternion.columns(*(raised[:, foot] * axis for axis in _ACROSS)))
        turned = result.of(joint)[1]
        turned[:] = quaternion.multiply(turned, turn)
    return result


def _turns(rotations: FloatArray, others: FloatArray) -> FloatArray:
    """Vectors (F, 3, 3) in radians that turn rotations (F, 3, 4) to others."""
    return quaternion.to_rotation_vector(quaternion.multiply(others, quaternion.conjugate(rotations)))


def _acceleration(path_m: FloatArray) -> float:
    """Greatest second difference of a path (F, 3)."""
    return float(np.linalg.norm(np.diff(path_m, 2, axis=0), axis=-1).max(initial=0.0))


def _square(turns: FloatArray, most_rad: float) -> float:
    return float(np.square(np.maximum(_greatest(turns) - most_rad, 0.0)).sum())


def _greatest(turns: FloatArray) -> FloatArray:
    """Greatest change (F,) of the turns (F - 1, 3, 3) of a leg's joints from frame to frame."""
    return np.asarray(changes_rad(turns).max(axis=1))


def _joined(legs: Sequence[_Legs]) -> _Legs:
    frames = sum(len(one.path) for one in legs)
    joined = _Legs(quaternion.planes(frames, 3, 3), quaternion.planes(frames, 3, 3))
    np.concatenate([one.path for one in legs], out=joined.path)
    np.concatenate([one.follow for one in legs], out=joined.follow)
    return joined


def _inside(lengths: Sequence[int]) -> BoolArray:
    """Mark in consecutive spans of given lengths all frames but `EDGE` at either end."""
    inside = np.ones(sum(lengths), bool)
    for stop in np.cumsum(lengths).tolist():
        inside[stop - EDGE : stop + EDGE] = False
    inside[:EDGE] = False
    return inside


def _angles(legs: _Legs, least_rad: FloatArray, inside: BoolArray, most_rad: float) -> FloatArray:
    """Smallest angles (F,) in radians by which a heel is raised, from ``least_rad`` on, so that joints change their
    turns by at most ``most_rad``; by gradient steps with Nesterov's momentum. Only frames ``inside`` (F,) change.
    """
    raised, before = np.zeros(len(least_rad)), np.zeros(len(least_rad))
    step = 1.0 / (16.0 * np.maximum(np.square(legs.follow).sum(axis=(1, 2)), LEAST_FOLLOW))
    possible = inside[:-2] | inside[1:-1] | inside[2:]
    for number in range(ROUNDS):
        ahead = raised + number / (number + 3.0) * (raised - before)
        change = np.diff(legs.path + legs.follow * ahead[:, None, None], 2, axis=0)
        size = np.linalg.norm(change, axis=-1, keepdims=True)
        excess = change * np.maximum(0.0, 1.0 - most_rad / np.maximum(size, 1e-12))
        if not number % 20 and size[possible].max(initial=0.0) <= 1.001 * most_rad:
            break
        back = np.zeros_like(legs.path)
        back[:-2] += excess
        back[1:-1] -= 2.0 * excess
        back[2:] += excess
        slope = np.einsum("fpi,fpi->f", back, legs.follow)
        before, raised = raised, np.where(inside, np.clip(ahead - step * slope, least_rad, MOST_RAD), 0.0)
    return raised
