"""Keeps the arms of a dancing character out of its trunk, head and thighs, and apart from each other.

A character has other proportions than the captured dancer, whose arms may enter the body in the capture too. Each time
an arm would, it is moved in one of several ways: its elbow turns about the line between shoulder and wrist, so that the
hand stays, or its hand is moved in one direction.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.body_capsules import ARM, body_capsules, positions_m
from app.choreography.capsules import Capsules, depth_m
from app.choreography.limbs import BENT, STRAIGHT, smooth_share
from app.choreography.ways_apart import Span, least_way, overlaps
from app.rig import quaternion
from app.rig.model import Character
from app.rig.sole import SIDES

PASSES: Final = 3
"""Greatest number of passes, since an arm moved out of one part may enter another."""
PARTS: Final = ((0.6, 1.0), (0.1, 1.0), (0.0, 1.0))
"""Spans of upper arm, forearm and hand that are kept out: the rest of an upper arm lies on the trunk."""
UPPER_SHARE: Final = 0.3
"""Share of an upper arm's radius that is kept out of the body, on which it hangs."""
_NOT_MET: Final = ((0, 4), (0, 5), (0, 8), (0, 9))
"""Part of an arm and of the body that do not meet, see `_Body.around`: an upper arm, and head, other upper arm or
thighs."""
WAYS: Final = np.array(
    [
        (0.0, 0.0, 1.0), (0.7, 0.0, 0.7), (1.0, 0.0, 0.0), (0.7, 0.0, -0.7), (0.0, 0.7, 0.7), (0.7, 0.7, 0.0),
        (0.0, -0.7, 0.7), (-0.7, 0.0, 0.7),
    ]
)  # fmt: skip
"""Compared directions of a left hand, in the frame of the chest: forward, outwards, up and between."""
STEPS_M: Final = np.array([0.0, 0.015, 0.03, 0.05, 0.08, 0.12, 0.17, 0.23])
"""Compared distances in metres."""
RAD_PER_M: Final = 5.0
"""Angle in radians by which an elbow turns that counts as much as a metre."""
TURNING: Final = np.array([1.0, -1.0])
HAND_M: Final = 0.01
"""Additional cost in metres of a hand's displacement, since an elbow is turned more readily."""
LEAST_M: Final = 0.006
"""Depth in metres below which arms stay as they are."""
NEAR_M: Final = 0.06
"""Distance in metres of an arm from a part of the body from which it is expected not to enter that when it is moved."""
STRETCHED: Final = 0.995
"""Greatest reach of a moved arm relative to its length, unless it is stretched farther already."""
SMOOTH_S: Final = 0.08
"""Standard deviation in seconds over which an arm moves aside."""
_ELBOW: Final = np.array([0.0, 0.0, -1.0])
"""Direction of the elbow of a straight arm, in the frame of the upper arm."""


class _Arm(NamedTuple):
    """Positions (..., 3) in metres of the joints of an arm and of its fingertips, and the direction (..., 3) of its
    elbow from the line between shoulder and wrist.
    """

    shoulder: FloatArray
    elbow: FloatArray
    wrist: FloatArray
    tip: FloatArray
    pole: FloatArray

    def moved(self, way: FloatArray, angles_rad: FloatArray) -> _Arm:
        """Return the arm with its wrist moved by ``way`` (..., 3) and its elbow then turned by ``angles_rad`` (...)
        about the line from shoulder to wrist.
        """
        upper, lower, own = (
            np.linalg.norm(end - start, axis=-1, keepdims=True)
            for start, end in ((self.shoulder, self.elbow), (self.elbow, self.wrist), (self.shoulder, self.wrist))
        )
        line = self.wrist + way - self.shoulder
        length = np.linalg.norm(line, axis=-1, keepdims=True)
        along = line / np.maximum(length, 1e-9)
        length = np.clip(length, np.abs(upper - lower) + 1e-4, np.maximum(own, STRETCHED * (upper + lower)))
        pole = _unit(self.pole - along * np.sum(along * self.pole, axis=-1, keepdims=True))
        angles = angles_rad[..., None]
        pole = np.cos(angles) * pole + np.sin(angles) * quaternion.cross(along, pole)
        ahead = (upper * upper - lower * lower + length * length) / (2.0 * length)
        aside = np.sqrt(np.maximum(upper * upper - ahead * ahead, 0.0))
        elbow, wrist = self.shoulder + along * ahead + pole * aside, self.shoulder + along * length
        return _Arm(self.shoulder, elbow, wrist, wrist + self.tip - self.wrist, pole)

    def capsules(self, radii_m: FloatArray) -> Capsules:
        """Return upper arm, forearm and hand as capsules."""
        joints = np.broadcast_arrays(self.shoulder, self.elbow, self.wrist, self.tip)
        bones = [
            (start + low * (end - start), start + high * (end - start))
            for start, end, (low, high) in zip(joints[:-1], joints[1:], PARTS, strict=True)
        ]
        starts, ends = (np.array(points) for points in zip(*bones, strict=True))
        return Capsules(starts, ends, radii_m)


class _Body(NamedTuple):
    """A moving character.

    Attributes
    ----------
    world : dict of int to (F, 4) float64
        World rotations of all joints above the legs, of hip joints and of knees, by joint.
    hips_m : (F, 3) float64
        Positions of the hips in metres.
    """

    character: Character
    world: dict[int, FloatArray]
    hips_m: FloatArray
    fps: float

    def joint(self, name: str) -> int:
        """Return the index of a joint."""
        return self.character.skeleton.index(name)

    def arm(self, side: int, places_m: dict[int, FloatArray]) -> _Arm:
        """Return the left (0) or right (1) arm, from the positions (F, 3) of joints."""
        upper, lower, hand = (self.joint(f"{SIDES[side]}{part}") for part in ARM)
        shoulder, elbow, wrist = (places_m[joint] for joint in (upper, lower, hand))
        way = np.array([body_capsules(self.character).hand_m * (1.0 if side == 0 else -1.0), 0.0, 0.0])
        line = _unit(wrist - shoulder)
        off = elbow - shoulder - line * np.sum(line * (elbow - shoulder), axis=-1, keepdims=True)
        length = np.linalg.norm(elbow - shoulder, axis=-1) + np.linalg.norm(wrist - elbow, axis=-1)
        share = smooth_share(np.linalg.norm(off, axis=-1) / length, (STRAIGHT, BENT))[:, None]
        behind = quaternion.rotate(self.world[upper], _ELBOW)
        return _Arm(
            shoulder,
            elbow,
            wrist,
            wrist + quaternion.rotate(self.world[hand], way),
            _unit(share * _unit(off) + (1.0 - share) * behind),
        )

    def around(self, other: _Arm, places_m: dict[int, FloatArray]) -> Capsules:
        """Return the capsules of trunk, head, the other arm and thighs, from the positions (F, 3) of joints."""
        shape = body_capsules(self.character)
        bones = (*shape.body, *shape.thighs)
        starts, ends = (
            [places_m[joint] + quaternion.rotate(self.world[joint], way) for joint, way in points]
            for points in (
                [(one.start, one.start_way_m) for one in bones],
                [(one.end, one.end_way_m) for one in bones],
            )
        )
        arm, radii, count = other.capsules(shape.radii_m), [one.radius_m for one in bones], len(shape.body)
        return Capsules(
            np.concatenate([starts[:count], arm.starts_m, starts[count:]]),
            np.concatenate([ends[:count], arm.ends_m, ends[count:]]),
            np.concatenate([radii[:count], arm.radii_m, radii[count:]]),
        )

    def with_arm(self, side: int, arm: _Arm, moved: _Arm, some: IntArray) -> _Body:
        """Return the body with an arm ``arm`` turned to that of ``moved`` in some frames; the hand keeps its world
        rotation.
        """
        world = dict(self.world)
        ways = (
            (arm.elbow - arm.shoulder, moved.elbow - moved.shoulder),
            (arm.wrist - arm.elbow, moved.wrist - moved.elbow),
        )
        for part, (before, after) in zip(ARM[:2], ways, strict=True):
            joint = self.joint(f"{SIDES[side]}{part}")
            turned = quaternion.between(_unit(before[some]), _unit(after[some]))
            world[joint] = world[joint].copy()
            world[joint][some] = quaternion.multiply(turned, world[joint][some])
        return self._replace(world=world)


def arms_apart(
    character: Character, world: dict[int, FloatArray], hips_m: FloatArray, fps: float
) -> dict[int, FloatArray]:
    """Return world rotations (F, 4) of a character's joints, by joint, with its arms bent so that they are out of its
    body and of each other.

    Parameters
    ----------
    world : dict of int to (F, 4) float64
        World rotations of all joints above the legs, of hip joints and of knees, by joint.
    hips_m : (F, 3) float64
        Positions of the hips in metres.
    """
    body = _Body(character, world, hips_m, fps)
    for _ in range(PASSES):
        before = body
        for side in range(2):
            body = _one_apart(body, side)
        if body is before:
            break
    return body.world


def depths_m(character: Character, world: dict[int, FloatArray], hips_m: FloatArray) -> FloatArray:
    """Return the depth (F, 2) in metres in which a character's left and right arm enter its body or each other."""
    body = _Body(character, world, hips_m, 1.0)
    places = positions_m(character, world, hips_m)
    arms = [body.arm(side, places) for side in range(2)]
    return np.stack(
        [_depths_m(arms[side], body.around(arms[1 - side], places), _radii_m(body))[0] for side in range(2)], axis=1
    )


def _one_apart(body: _Body, side: int) -> _Body:
    """Move one arm; the same object is returned if it is apart."""
    places = positions_m(body.character, body.world, body.hips_m)
    arm, other = body.arm(side, places), body.arm(1 - side, places)
    around, radii = body.around(other, places), _radii_m(body)
    depths, deepest = _depths_m(arm, around, radii)
    moved, angles = np.zeros_like(body.hips_m), np.zeros(len(body.hips_m))
    chest = body.world[body_capsules(body.character).body[-2].end]
    for start, stop in overlaps(depths, body.fps, LEAST_M):
        ways = quaternion.rotate(chest[(start + stop) // 2], _unit(WAYS) * (1.0 if side == 0 else -1.0, 1.0, 1.0))
        steps = np.zeros((len(TURNING) + len(WAYS), len(STEPS_M), 3))
        steps[len(TURNING) :] = ways[:, None] * STEPS_M[:, None]
        turns = np.zeros(steps.shape[:2])
        turns[: len(TURNING)] = RAD_PER_M * TURNING[:, None] * STEPS_M
        near = tuple(pair for pair, deep in deepest.items() if deep[start:stop].max() > -NEAR_M)
        compared = _Compared(arm, around, radii, steps, turns, near)
        more = np.repeat((0.0, HAND_M), (len(TURNING), len(WAYS)))
        found = least_way(
            compared.depths_m, len(steps), Span(start, stop, len(depths), body.fps), STEPS_M, SMOOTH_S, more
        )
        if found.way < len(TURNING):
            angles[found.frames] += RAD_PER_M * TURNING[found.way] * found.sizes
        else:
            moved[found.frames] += found.sizes[:, None] * ways[found.way - len(TURNING)]
    some = np.flatnonzero(moved.any(axis=1) | (angles != 0.0))
    return body.with_arm(side, arm, arm.moved(moved, angles), some) if len(some) else body


class _Compared(NamedTuple):
    """Ways in which an arm is moved.

    Attributes
    ----------
    steps : (W, K, 3) float64
        Displacements of its wrist for each of W ways with each of K sizes.
    turns : (W, K) float64
        Turns of its elbow in radians.
    near : tuple of pairs of int
        Parts of the arm and of the body that may meet.
    """

    arm: _Arm
    around: Capsules
    radii_m: FloatArray
    steps: FloatArray
    turns: FloatArray
    near: tuple[tuple[int, int], ...]

    def depths_m(self, frames: IntArray, ways: IntArray) -> FloatArray:
        """Return the depth (N, V, K) in metres of the arm in frames (N,), moved in V of the ways."""
        own = _Arm(*(points[frames, None, None] for points in self.arm)).moved(self.steps[ways], self.turns[ways])
        starts, ends = (points[:, frames, None, None] for points in self.around[:2])
        return depth_m(own.capsules(self.radii_m), Capsules(starts, ends, self.around.radii_m), self.near)


def _depths_m(arm: _Arm, around: Capsules, radii_m: FloatArray) -> tuple[FloatArray, dict[tuple[int, int], FloatArray]]:
    """Return the depth (F,) in metres of an arm in what is around it, at least 0, and the depth (F,) of each of its
    parts in each part of that; negative if apart, and roughly then.
    """
    own = arm.capsules(radii_m)
    deepest = {}
    for pair in ((one, other) for one in range(len(own.radii_m)) for other in range(len(around.radii_m))):
        if pair in _NOT_MET:
            continue
        # No two points of two capsules are nearer than their middles less their halves.
        bones = [(every.starts_m[at], every.ends_m[at]) for every, at in zip((own, around), pair, strict=True)]
        halves = sum(0.5 * np.linalg.norm(end - start, axis=-1) for start, end in bones)
        apart = np.linalg.norm(np.subtract(*(0.5 * (start + end) for start, end in bones)), axis=-1)
        depth = halves + own.radii_m[pair[0]] + around.radii_m[pair[1]] - apart
        near = np.flatnonzero(depth > 0.0)
        if len(near):
            depth[near] = depth_m(own.at(pair[0], near), around.at(pair[1], near), ((0, 0),))
        deepest[pair] = depth
    return np.maximum(np.max(list(deepest.values()), axis=0), 0.0), deepest


def _radii_m(body: _Body) -> FloatArray:
    """Radii (3,) of an arm's parts that are kept out."""
    return body_capsules(body.character).radii_m * (UPPER_SHARE, 1.0, 1.0)


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9))
