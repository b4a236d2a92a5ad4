"""Keeps the legs of a dance apart: feet are placed and swung around each other, and knees turned outwards.

Steps moved to beats and feet kept in place let legs pass through each other that go around each other in the capture.
Each time they would, one direction is chosen in which the legs are soonest apart, so that a foot passes on one side and
never snaps to the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.capsules import Capsules, depth_m
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.features import facing, height_m
from app.choreography.feet_on_floor import FREE_S, foot_paths, free, legs_along
from app.choreography.foot_plants import FootPlant, planted_frames
from app.choreography.footfalls import Footfalls
from app.choreography.limbs import smooth_share
from app.choreography.standing_feet import MovingBody, planted
from app.choreography.ways_apart import Span, least_way, overlaps
from app.rig import quaternion
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

RADII: Final = {"thigh": 0.034, "shank": 0.024, "foot": 0.023}
"""Radius of each part of a leg relative to the body's height: captured legs are hardly ever nearer, since soft parts
give way.
"""
PAIRS: Final = ((0, 0), (0, 1), (1, 0), (1, 1), (1, 2), (2, 1), (2, 2))
"""Parts of the left and the right leg that are kept apart, as indices in `RADII`; a foot does not reach a thigh."""
THIGH_FROM: Final = 0.5
"""Share of the thigh from the hip joint from which it is kept away from the other leg."""
PASSES: Final = 8
"""Greatest number of times that feet are moved, since one displacement may cause another overlap: legs that cross at a
run are apart after up to six."""
LEAST_M: Final = 0.003
"""Depth in metres below which legs stay as they are."""
WAYS: Final = 12
"""Number of compared directions over the floor."""
STEPS_M: Final = np.array([0.0, 0.01, 0.02, 0.035, 0.05, 0.07, 0.09, 0.12, 0.15, 0.19, 0.24])
"""Compared distances in metres by which a foot is moved."""
KNEE_SHARE: Final = 0.5
"""Share of a foot's way by which its knee moves along."""
TURNED: Final = 0.05
"""Cost of a direction at right angles to that in which the feet have been moved already, in metres."""
SMOOTH_S: Final = 0.06
"""Standard deviation in seconds over which a foot in the air moves aside."""
TURNS_RAD: Final = np.array([0.0, 0.06, 0.12, 0.2, 0.3, 0.42, 0.55])
"""Compared angles in radians by which a knee turns about the line between hip joint and ankle."""
TURNING: Final = ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Compared shares of such a turn of the left and the right knee; positive ones turn knees outwards."""
TURN_SMOOTH_S: Final = 0.1
"""Standard deviation in seconds over which knees turn."""


class FeetApart(NamedTuple):
    """Foot plants, and displacements (F, 2, 3) in metres of feet in the air, with which the legs are apart."""

    standing: tuple[FootPlant, ...]
    aside_m: FloatArray


def with_legs_apart(
    clip: MotionClip, shown: MotionClip, falls: Footfalls, weight: float
) -> tuple[MotionClip, tuple[FootPlant, ...]]:
    """Plant the feet of a motion again where its legs would enter each other, and turn its knees.

    Parameters
    ----------
    clip, shown : MotionClip
        The motion before and after its feet were planted as in ``falls``.
    weight : float
        See `app.choreography.standing_feet.planted`.

    Returns
    -------
    clip : MotionClip
        The motion with planted feet and legs apart.
    standing : tuple of FootPlant
        Foot plants, at the same times.
    """
    standing, aside_m = falls.standing, np.zeros((2, 3, len(clip))).transpose(2, 0, 1)
    body: MovingBody | None = None
    for _ in range(PASSES):
        apart = feet_apart(shown, standing, aside_m)
        if apart is None:
            return shown, standing
        if apart.standing == standing and np.array_equal(apart.aside_m, aside_m):
            break
        standing, aside_m = apart
        body = MovingBody.of(clip) if body is None else body
        shown = planted(clip, standing, weight, falls.shown, aside_m, body)
    return knees_apart(shown), standing


def with_swings_apart(clip: MotionClip, standing: Sequence[FootPlant]) -> MotionClip:
    """Return the motion with feet in the air swung around each other and knees turned where its legs enter each other;
    standing feet and the hips stay. The same object is returned if legs are apart.
    """
    on_floor, aside_m = planted_frames(standing, len(clip)), np.zeros((2, 3, len(clip))).transpose(2, 0, 1)
    for _ in range(PASSES):
        apart = feet_apart(clip, standing, aside_m)
        if apart is None:
            return clip
        more_m, aside_m = apart.aside_m - aside_m, apart.aside_m
        some = np.flatnonzero(more_m.any(axis=(1, 2)))
        if not len(some):
            break
        rotations, paths = clip.rotations.copy(order="K"), foot_paths(clip, tips_m(clip) + more_m, on_floor)
        part = clip.at(some)
        rotations[some] = legs_along(part, part.world(), paths.at(some), turned_back=False).rotations
        clip = replace(clip, rotations=quaternion.continuous(rotations))
    return knees_apart(clip)


class _Legs(NamedTuple):
    """Positions (2, N, 3) in metres of the joints of the left and the right leg, and of the feet's ends."""

    hips: FloatArray
    knees: FloatArray
    ankles: FloatArray
    toes: FloatArray

    @classmethod
    def of(cls, clip: MotionClip, world: JointTransforms, frames: slice | IntArray) -> _Legs:
        """Return the legs of a motion with the world transforms ``world`` in some of its frames."""
        rows = [[1 + SEGMENTS.index(f"{side}{part}") for side in SIDES] for part in ("UpperLeg", "LowerLeg", "Foot")]
        joints = [np.moveaxis(world.positions_m[frames][:, row], 1, 0) for row in rows]
        ends_m = clip.shape.ends_m[[ENDS.index(f"{side}Foot") for side in SIDES]]
        way = quaternion.rotate(np.moveaxis(world.rotations[frames][:, rows[2]], 1, 0), ends_m[:, None])
        return cls(joints[0], joints[1], joints[2], joints[2] + way)

    def moved(self, way: FloatArray) -> _Legs:
        """Return legs with ankles and ends of the feet moved by ``way`` (2, ..., 3); further axes are added."""
        more = (slice(None),) * 2 + (None,) * (way.ndim - 3)
        hips, knees, ankles, toes = (np.broadcast_to(points[more], way.shape) for points in self)
        return _Legs(hips, knees + KNEE_SHARE * way, ankles + way, toes + way)

    def turned(self, angles_rad: FloatArray) -> _Legs:
        """Return legs with knees turned about the line between hip joint and ankle by ``angles_rad`` (2, ...)."""
        more = (slice(None),) * 2 + (None,) * (angles_rad.ndim - 2)
        hips, knees, ankles, toes = (points[more] for points in self)
        turn = _turns(hips, ankles, angles_rad)
        knees = hips + quaternion.rotate(turn, np.broadcast_to(knees - hips, (*angles_rad.shape, 3)))
        hips, ankles, toes = (np.broadcast_to(points, knees.shape) for points in (hips, ankles, toes))
        return _Legs(hips, knees, ankles, toes)

    def depth_m(self, height: float) -> FloatArray:
        """Return the depth (N, ...) in metres in which the legs of a body of some height enter each other."""
        starts = np.array([self.hips + THIGH_FROM * (self.knees - self.hips), self.knees, self.ankles])
        ends = np.array([self.knees, self.ankles, self.toes])
        radii = height * np.array(list(RADII.values()))
        left, right = (Capsules(starts[:, side], ends[:, side], radii) for side in range(2))
        return depth_m(left, right, PAIRS)


def depths_m(clip: MotionClip, world: JointTransforms | None = None) -> FloatArray:
    """Return the depth (F,) in metres in which the legs of a motion enter each other; 0 or less if they are apart."""
    world, height = clip.world() if world is None else world, height_m(clip)
    legs = _Legs.of(clip, world, slice(None))
    # Legs on two sides of a plane between them are apart.
    points = np.array([0.5 * (legs.hips + legs.knees), *legs[1:]])
    across = (points[:, 0] - points[:, 1]).mean(axis=0)
    across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)
    along = np.einsum("psfi,fi->psf", points, across)
    room = along[:, 0].min(axis=0) - along[:, 1].max(axis=0)
    near = np.flatnonzero(room < 2.0 * height * max(RADII.values()))
    result = np.zeros(len(clip))
    if len(near):
        result[near] = np.maximum(_Legs.of(clip, world, near).depth_m(height), 0.0)
    return result


def feet_apart(clip: MotionClip, standing: Sequence[FootPlant], aside_m: FloatArray) -> FeetApart | None:
    """Return foot plants, moved as a whole, and displacements of feet in the air that keep the legs of a motion apart;
    None if they are, and the same ones if no displacement helps. ``aside_m`` (F, 2, 3) are the displacements that the
    motion already has.
    """
    world, fps = clip.world(), float(clip.fps)
    spans = overlaps(depths_m(clip, world), fps, LEAST_M)
    if not spans:
        return None
    on_floor = planted_frames(standing, len(clip))
    may = np.stack([free(on_floor[:, foot], fps) for foot in range(2)], axis=1)
    aside, places = aside_m.copy(order="K"), [np.array(stand.place_m) for stand in standing]
    for start, stop in spans:
        before = np.subtract(*np.moveaxis(aside_m[start:stop], 1, 0)).sum(axis=0)
        feet = _Feet(standing, may, _shares(standing, may, start, stop), fps)
        way, frames, size_m = _way_apart(clip, world, (start, stop), before)
        if size_m.max() < LEAST_M:
            continue
        for foot, sign in enumerate((1.0, -1.0)):
            own = sign * feet.shares[foot] * way
            for at in feet.near(foot, frames):
                places[at] = places[at] + feet.held(standing[at], frames, size_m) * own
            aside[frames, foot] += (size_m * may[frames, foot])[:, None] * own
    moved = (
        replace(stand, place_m=(float(place[0]), stand.place_m[1], float(place[2])))
        for stand, place in zip(standing, places, strict=True)
    )
    return FeetApart(tuple(moved), aside)


class _Feet(NamedTuple):
    """Feet that share a displacement: those in the air are moved aside, and the places at which others stand are moved.

    Attributes
    ----------
    may : (F, 2) float64
        Factor of the displacement in the air, 0 while a foot stands.
    shares : tuple of float
        Share of each foot.
    """

    standing: Sequence[FootPlant]
    may: FloatArray
    shares: tuple[float, float]
    fps: float

    def near(self, foot: int, frames: IntArray) -> list[int]:
        """Return the indices of a foot's plants in a span of frames (N,), if it is moved."""
        return [
            at
            for at, stand in enumerate(self.standing)
            if stand.foot == foot and self.shares[foot] and stand.start <= frames[-1] and stand.stop > frames[0]
        ]

    def held(self, stand: FootPlant, frames: IntArray, sizes_m: FloatArray) -> float:
        """Return the distance in metres that the place of a stand is moved by, for distances (N,) in some frames."""
        away = np.maximum(np.maximum(stand.start - frames, frames - stand.stop + 1), 0)
        near = 1.0 - smooth_share(away, (0.0, max(FREE_S * self.fps, 1.0)))
        return float((sizes_m * near).max(initial=0.0))


def _shares(standing: Sequence[FootPlant], may: FloatArray, start: int, stop: int) -> tuple[float, float]:
    """Return the shares of a displacement that each foot takes in some frames: half if both are in the air, all if the
    other one stands; of two standing feet, that takes it which landed last.
    """
    left, right = may[start:stop].min(axis=0)
    if left + right > 1e-6:
        return float(left / (left + right)), float(right / (left + right))
    landed = [
        max((stand.start for stand in standing if stand.foot == foot and stand.start < stop), default=0)
        for foot in range(2)
    ]
    return (1.0, 0.0) if landed[0] >= landed[1] else (0.0, 1.0)


def _way_apart(
    clip: MotionClip, world: JointTransforms, span: tuple[int, int], before: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return the direction (3,) over the floor in which the left foot of a motion is moved from the right one to keep
    the legs apart in a span of frames, and the frames (N,) with the distances (N,) in metres; ``before`` (3,) is the
    direction in which it has been moved already.
    """
    middle = sum(span) // 2
    angles = 2.0 * np.pi * np.arange(WAYS) / WAYS
    ways = np.stack([np.cos(angles), np.zeros(WAYS), np.sin(angles)], axis=1)
    ways = quaternion.rotate(facing(clip.span(middle, middle + 1)), ways)
    far = float(np.linalg.norm(before))
    turned = TURNED * (1.0 - ways @ before / far) if far > 0.0 else np.zeros(WAYS)

    def depths(frames: IntArray, some: IntArray) -> FloatArray:
        steps = np.zeros((2, len(frames), len(some), len(STEPS_M), 3))
        steps[0] = ways[some, None] * STEPS_M[:, None]
        return _Legs.of(clip, world, frames).moved(steps).depth_m(height_m(clip))

    found = least_way(depths, WAYS, Span(*span, len(clip), float(clip.fps)), STEPS_M, SMOOTH_S, turned)
    return ways[found.way], found.frames, found.sizes


def knees_apart(clip: MotionClip) -> MotionClip:
    """Return the motion with knees turned about the lines between hip joints and ankles where its legs enter each
    other; feet stay as they are. The same object is returned if legs are apart.
    """
    world = clip.world()
    angles = np.zeros((2, len(clip)))
    outwards = np.array([[-1.0], [1.0]]) * np.array(TURNING).T
    compared = outwards[:, None, :, None] * TURNS_RAD

    def depths(frames: IntArray, some: IntArray) -> FloatArray:
        turns = np.broadcast_to(compared[:, :, some], (2, len(frames), len(some), len(TURNS_RAD)))
        return _Legs.of(clip, world, frames).turned(turns).depth_m(height_m(clip))

    for start, stop in overlaps(depths_m(clip, world), float(clip.fps), LEAST_M):
        found = least_way(depths, len(TURNING), Span(start, stop, len(clip), float(clip.fps)), TURNS_RAD, TURN_SMOOTH_S)
        angles[:, found.frames] += outwards[:, found.way, None] * found.sizes
    return knees_turned(clip, world, angles) if angles.any() else clip


def knees_turned(clip: MotionClip, world: JointTransforms, angles_rad: FloatArray) -> MotionClip:
    """Return the motion with its knees turned about the lines between hip joints and ankles by ``angles_rad`` (2, F);
    ``world`` are its transforms."""
    rotations = clip.rotations.copy(order="K")
    hips = world.rotations[:, 1]
    for foot, side in enumerate(SIDES):
        thigh_at, shank_at, foot_at = (1 + SEGMENTS.index(f"{side}{part}") for part in ("UpperLeg", "LowerLeg", "Foot"))
        some = np.flatnonzero(angles_rad[foot])
        turn = _turns(world.positions_m[some, thigh_at], world.positions_m[some, foot_at], angles_rad[foot, some])
        thigh = quaternion.multiply(turn, world.rotations[some, thigh_at])
        shank = quaternion.multiply(turn, world.rotations[some, shank_at])
        rotations[some, thigh_at - 1] = quaternion.multiply(quaternion.conjugate(hips[some]), thigh)
        rotations[some, foot_at - 1] = quaternion.multiply(quaternion.conjugate(shank), world.rotations[some, foot_at])
    return replace(clip, rotations=quaternion.continuous(rotations))


def _turns(starts: FloatArray, ends: FloatArray, angles_rad: FloatArray) -> FloatArray:
    """Return rotations (..., 4) by angles (...) about the lines from starts to ends (..., 3)."""
    axis = ends - starts
    axis = axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-9)
    return quaternion.from_rotation_vector(axis * angles_rad[..., None])
