"""Keeps forearms out of trunk and thighs: the elbow goes outwards about the line from shoulder to hand.

The hand stays where the instrument has it. The elbow goes as far as it takes, and no farther than the wrist's range
allows. Each frame is computed independently, and continuously in its pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.motion.contacts.arms import SolvedArm, solved_arms
from app.motion.contacts.instrument_put_aside import AsidePlace
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.trunk_and_legs import Side, solve_legs
from app.motion.contacts.upper_body import UpperBody
from app.motion.contacts.wrists import Wrist
from app.rig import quaternion
from app.rig.ik import end_of
from app.rig.model import Skeleton
from app.rig.skeleton import closure
from app.rig.trunk_shape import ALONG, BEYOND_M, TrunkShape

MOST_RAD = float(np.deg2rad(70.0))
"""Most an elbow goes outwards."""
TRIED = 9
"""Number of angles up to there at which the forearm's depth is measured."""
EASE_M = 0.012
"""Width in metres over which a forearm counts more and more as inside, beyond the room that is kept."""
SLACK_M = 0.006
"""Depth beyond the least possible one that is accepted."""
BENT_RAD = float(np.deg2rad(4.0))
"""Angle before the end of its range over which a wrist lets the elbow go less and less."""
TIGHT_POWER = 3
"""Power of the used share of its room that a wrist keeps from an elbow before thick clothes; 1 before others."""
IN_MOTION = 0.75
"""Share of what wrists of a still body allow that they allow all through its motion, before thick clothes."""
PAST_RAD = float(np.deg2rad(1.5))
"""Angle past the end of its range to which a wrist lets an elbow go out of thick clothes."""
PALM, PALM_M = np.array([0.5, 1.0]), 0.02
"""Places between wrist and knuckles, and about how thick the hand is there."""
LEAST_ROOM_RAD = float(np.deg2rad(0.5))
"""Least such angle, also for a wrist that is at the end of its range already."""


@dataclass(frozen=True, eq=False)
class TrunkPose:
    """A body's trunk and thighs at some frames: rotation (J, F, 4) and position (J, F, 3) of the shape's J joints."""

    shape: TrunkShape
    rotations: FloatArray
    positions_m: FloatArray

    @classmethod
    def of(cls, shape: TrunkShape, skeleton: Skeleton, upper: UpperBody, legs: Mapping[int, FloatArray]) -> TrunkPose:
        """Pose a trunk and its thighs.

        Parameters
        ----------
        legs : mapping of int to (F, 4)
            Rotations of the thighs by joint, as solved.
        """
        local, hips = {**upper.trunk.local, **legs}, skeleton.index("hips")
        world = {hips: (upper.hips, upper.hips_m)}
        for joint in closure(skeleton, shape.joints):
            if joint <= hips:
                continue
            above, above_m = world[skeleton.parents[joint]]
            turn = quaternion.multiply(above, local[joint]) if joint in local else above
            world[joint] = turn, above_m + quaternion.rotate(above, skeleton.offsets_m[joint])
        rotations, positions_m = zip(*(world[joint] for joint in shape.joints), strict=True)
        return cls(shape, np.stack(rotations), np.stack(positions_m))

    @cached_property
    def matrices(self) -> FloatArray:
        """Return the rotation (J, F, 3, 3) of each joint."""
        return quaternion.to_matrix(self.rotations)

    def depths_m(self, points_m: FloatArray) -> FloatArray:
        """Return the depth (F, P) of P points (F, P, 3) in each frame; at least minus `BEYOND_M`."""
        deepest = np.full(points_m.shape[:2], -BEYOND_M)
        low_m, high_m = self.shape.bounds_m
        for number, (matrix, position_m) in enumerate(zip(self.matrices, self.positions_m, strict=True)):
            local_m = np.matmul(points_m - position_m[:, None], matrix)
            near = ((local_m > low_m[number]) & (local_m < high_m[number])).all(axis=2)
            if near.any():
                deepest[near] = np.maximum(deepest[near], self.shape.depths_m(number, local_m[near]))
        return deepest


@dataclass(frozen=True)
class Outward:
    """Turns of the elbows away from the trunk at some frames, by side.

    Attributes
    ----------
    needed_rad : dict of side to (F,) float64
        Turn about the line from shoulder to hand that takes a forearm out of the trunk.
    most_rad : dict of side to (F,) float64
        Turn up to which the wrist stays in its range.
    """

    needed_rad: dict[Side, FloatArray]
    most_rad: dict[Side, FloatArray]


def outward(
    player: StillPlayer,
    curves: ContactCurves,
    upper: UpperBody,
    put_aside: AsidePlace | None = None,
    within: int = 0,
) -> Outward | None:
    """Find how far elbows have to go outwards, frame by frame; None for a body of unknown shape.

    Parameters
    ----------
    curves : ContactCurves
        Curves with all other help for far hands.
    put_aside : AsidePlace, optional
        Place of the instrument while the musician uses another one.
    within : int
        Number of frames before and after each frame in which an elbow has to go outwards for which its greatest turn is
        found too: an elbow that begins early and returns late is out in them. It is `MOST_RAD` in all other frames.
    """
    if player.shape is None:
        return None
    needed_rad, most_rad = dict[Side, FloatArray](), dict[Side, FloatArray]()
    posed = _posed(player, player.shape, curves, upper)
    away = player.away(curves.body, upper.carried)
    arms = solved_arms(player, curves, upper, None, away)
    if put_aside is not None and curves.stowed is not None and np.any(curves.stowed):
        # The hand that takes it there is far from the trunk; the other one lets go where it was lowered.
        taken = replace(upper, carried=put_aside.put(upper.carried, curves.stowed))
        swung, side = put_aside.turned(curves.stowed), put_aside.aside.side
        arms |= {one: arm for one, arm in solved_arms(player, curves, taken, swung).items() if one == side}
    for side, solved in arms.items():
        forearm = _Forearm.of(side, solved, posed)
        needed_rad[side], most_rad[side] = _outward_rad(forearm, side, solved, player.wrists[side], within)
    return Outward(needed_rad, most_rad)


def _posed(player: StillPlayer, shape: TrunkShape, curves: ContactCurves, upper: UpperBody) -> TrunkPose:
    legs = solve_legs(player.place, player.skeleton, upper.hips_m, upper.hips, curves.body.feet)
    return TrunkPose.of(shape, player.skeleton, upper, legs)


def slow_share(
    player: StillPlayer, curves: ContactCurves, upper: UpperBody, slow_rad: Mapping[str, FloatArray]
) -> dict[str, FloatArray]:
    """Return the share (F,) 0..1 by which each wrist lets its elbow go outwards slowly beside a reaching shoulder.

    It falls from 1 to 0 as the slow elbow bends the wrist farther over its range than the elbow of ``curves`` does.

    Parameters
    ----------
    curves : ContactCurves
        Curves whose elbows go along with the shoulder at its own speed.
    slow_rad : mapping of side to (F,) float64
        `BodyMotion.elbow_along_rad` of elbows that begin earlier and return later.
    """
    away, shares = player.away(curves.body, upper.carried), dict[str, FloatArray]()
    slowly = replace(curves, body=replace(curves.body, elbow_along_rad=dict(slow_rad)))
    usual, slow = (solved_arms(player, one, upper, None, away) for one in (curves, slowly))
    for side in sorted(usual.keys() & slow_rad.keys()):
        quick_rad, bent_rad = (player.wrists[side].outside_rad(one[side].pose.end) for one in (usual, slow))
        shares[side] = 1.0 - np.clip((bent_rad - quick_rad) / LEAST_ROOM_RAD, 0.0, 1.0)
    return shares


@dataclass(frozen=True)
class Remaining:
    """Depth of arms in the body and bend of wrists at some frames, after elbows have gone outwards; each (F,) float64.

    Attributes
    ----------
    depth_m : array
        Greatest depth of a forearm or hand in trunk and thighs; negative: room.
    bent_rad : array
        Greatest excess of a wrist over its range.
    hands_m : array
        Greatest depth of a wrist or palm alone, which no elbow moves.
    """

    depth_m: FloatArray
    bent_rad: FloatArray
    hands_m: FloatArray


def remaining(player: StillPlayer, curves: ContactCurves, upper: UpperBody) -> Remaining | None:
    """Return depth and bend after elbows have gone outwards; None for a body of unknown shape. Parameters as in
    `outward`."""
    if player.shape is None:
        return None
    posed, frames = _posed(player, player.shape, curves, upper), np.arange(len(curves))
    depth_m, bent_rad = np.full(len(curves), -BEYOND_M), np.zeros(len(curves))
    hands_m = depth_m
    for side, solved in solved_arms(player, curves, upper, None, player.away(curves.body, upper.carried)).items():
        forearm = _Forearm.of(side, solved, posed)
        needed_rad, most_rad = _outward_rad(forearm, side, solved, player.wrists[side], 0)
        turn_rad = np.minimum(needed_rad, (IN_MOTION if player.shape.tight else 1.0) * most_rad)
        turn_rad = turn_rad if side == "left" else -turn_rad
        inside_m = forearm.inside_m(frames, turn_rad)
        depth_m = np.maximum(depth_m, inside_m.max(axis=1))
        hand_m = player.skeleton.offsets_m[player.skeleton.index(f"{side}MiddleProximal")]
        palm_m = forearm.wrist_m[:, None] + quaternion.rotate(solved.hand[:, None], hand_m * PALM[:, None])
        in_palm_m = (posed.depths_m(palm_m) + PALM_M + player.shape.room_m).max(axis=1)
        hands_m = np.maximum(hands_m, np.maximum(inside_m[:, -1], in_palm_m))
        bent_rad = np.maximum(bent_rad, player.wrists[side].outside_rad(_hand_at(solved, frames, turn_rad)))
    return Remaining(np.maximum(depth_m, hands_m), bent_rad, hands_m)


@dataclass(frozen=True, eq=False)
class _Forearm:
    """A solved forearm beside a posed trunk, whose elbow goes about the line from shoulder to hand.

    Attributes
    ----------
    shape : TrunkShape
    thick_m : (P,) float64
        Room for the forearm at `ALONG`.
    wrist_m : (F, 3) float64
        World position of the wrist.
    seen_m : (4, J, F, 3) float64
        In the frame of each of the shape's J joints: centre of the elbow's circle, wrist, vector from the centre to the
        elbow, and the vector a quarter of a turn further.
    """

    shape: TrunkShape
    thick_m: FloatArray
    wrist_m: FloatArray
    seen_m: FloatArray

    @classmethod
    def of(cls, side: Side, solved: SolvedArm, posed: TrunkPose) -> _Forearm:
        """Return the forearm of a solved arm."""
        pose, limb, line = solved.pose, solved.limb, solved.line
        elbow_m = quaternion.rotate(pose.bones[0], limb.upper_vector_m)
        wrist_m = solved.shoulder.joint_m + elbow_m + quaternion.rotate(pose.bones[1], limb.lower_vector_m)
        along_m = line * quaternion.dot(line, elbow_m)[:, None]
        centre_m, off_m = solved.shoulder.joint_m + along_m, elbow_m - along_m
        vectors_m = np.stack([centre_m, wrist_m, off_m, quaternion.cross(line, off_m)], axis=1)
        from_joints_m = np.repeat(vectors_m[None], len(posed.positions_m), axis=0)
        from_joints_m[:, :, :2] -= posed.positions_m[:, :, None]
        seen_m = np.ascontiguousarray(np.matmul(from_joints_m, posed.matrices).transpose(2, 0, 1, 3))
        return cls(posed.shape, posed.shape.radii_m[side] + posed.shape.room_m, wrist_m, seen_m)

    def inside_m(self, frames: IndexArray, turn_rad: float | FloatArray) -> FloatArray:
        """Return the depth (K, P) at `ALONG` in K frames with the elbow turned about the line by an angle, or by angles
        (K,)."""
        deepest_m = np.full((len(frames), len(ALONG)), -BEYOND_M)
        turns_rad = np.reshape(turn_rad, (-1, 1))
        cosine, sine = np.cos(turns_rad), np.sin(turns_rad)
        centres_m, wrists_m, off_m, across_m = self.seen_m[:, :, frames]
        elbows_m = centres_m + cosine * off_m + sine * across_m
        low_m, high_m = self.shape.bounds_m
        reaches = (np.maximum(elbows_m, wrists_m) > low_m) & (np.minimum(elbows_m, wrists_m) < high_m)
        for number, near in enumerate(map(np.flatnonzero, reaches.all(axis=2))):
            if not len(near):
                continue
            elbow_m, wrist_m = elbows_m[number, near, None], wrists_m[number, near, None]
            points_m = (elbow_m + ALONG[:, None] * (wrist_m - elbow_m)).reshape(-1, 3)
            found_m = self.shape.depths_m(number, points_m).reshape(len(near), -1)
            deepest_m[near] = np.maximum(deepest_m[near], found_m)
        return deepest_m + self.thick_m


def _outward_rad(
    forearm: _Forearm, side: Side, solved: SolvedArm, wrist: Wrist, within: int
) -> tuple[FloatArray, FloatArray]:
    """Return an arm's needed and greatest turn, each (F,); parameters as in `outward`."""
    sign, count = (1.0 if side == "left" else -1.0), len(solved.line)
    needed_rad, most_rad = np.zeros(count), np.full(count, MOST_RAD)
    depth_m = forearm.inside_m(np.arange(count), 0.0)
    frames, angles = np.flatnonzero((depth_m > -EASE_M).any(axis=1)), np.linspace(0.0, MOST_RAD, TRIED)
    if not len(frames):
        return needed_rad, most_rad
    # An elbow that is clear goes no farther.
    depths_m = np.full((TRIED, len(frames), len(ALONG)), -BEYOND_M)
    depths_m[0] = depth_m[frames]
    for number in range(1, TRIED):
        inside = np.flatnonzero((depths_m[number - 1] > -EASE_M).any(axis=1))
        if not len(inside):
            break
        depths_m[number, inside] = forearm.inside_m(frames[inside], sign * float(angles[number]))
    # Where a place, such as the wrist, stays inside at every angle, nearly its least depth is good enough.
    over = (depths_m - np.maximum(depths_m.min(axis=0) + SLACK_M, 0.0)).max(axis=2)
    # No place becomes clear at the cost of another one that is deeper.
    deepest_m = depths_m.max(axis=2)
    risen = np.clip((deepest_m - np.minimum.accumulate(deepest_m, axis=0)) / SLACK_M, 0.0, 1.0)
    needed_rad[frames] = _turned(np.clip(1.0 + over / EASE_M, 0.0, 1.0) * (1.0 - risen), angles)
    around = np.zeros(count + 1)
    np.add.at(around, np.maximum(frames - within, 0), 1.0)
    np.add.at(around, np.minimum(frames + within + 1, count), -1.0)
    out = np.flatnonzero(np.cumsum(around[:count]) > 0.5)
    power, past_rad = (TIGHT_POWER, PAST_RAD) if forearm.shape.tight else (1, 0.0)
    most_rad[out] = _within_room(_used_room(solved, wrist, out, sign * angles, past_rad), angles, power)
    return needed_rad, most_rad


def _hand_at(solved: SolvedArm, frames: IndexArray, turn_rad: FloatArray) -> FloatArray:
    """Return the hand's rotation (K, 4) relative to the forearm in K frames, with the elbow turned by angles (K,)."""
    turn = quaternion.from_axis_angle(solved.line[frames], turn_rad)
    lower = quaternion.multiply(turn, solved.pose.bones[1][frames])
    return end_of(solved.limb, lower, solved.hand[frames])


def _used_room(solved: SolvedArm, wrist: Wrist, frames: IndexArray, angles: FloatArray, past_rad: float) -> FloatArray:
    """Return the share (A, K) of a wrist's room, up to ``past_rad`` past its range, that the elbow uses at each of A
    angles, in K frames, 0 or more.

    It does not fall again. The wrist lets the elbow go on less and less, and not at all from 1 on.
    """

    def bent_rad(here: IndexArray, angle: float) -> FloatArray:
        return wrist.outside_rad(_hand_at(solved, here, np.full(len(here), angle)), within=True)

    usual_rad = bent_rad(frames, 0.0)
    room_rad = np.minimum(np.maximum(past_rad - usual_rad, LEAST_ROOM_RAD), BENT_RAD)
    from_rad = np.maximum(usual_rad, past_rad - BENT_RAD)
    used = np.zeros((len(angles), len(frames)))
    for number in range(1, len(angles)):
        used[number] = used[number - 1]
        going = np.flatnonzero(used[number - 1] < 1.0)
        if not len(going):
            continue
        over_rad = bent_rad(frames[going], float(angles[number])) - from_rad[going]
        used[number, going] = np.maximum(over_rad / room_rad[going], used[number - 1, going])
    return used


def _within_room(used: FloatArray, angles: FloatArray, power: int) -> FloatArray:
    """Return the turn (F,) whose rate at each of A angles is what a power of a share ``used`` (A, F) leaves of 1,
    integrated over the angles; the share is linear between them."""
    below, above = used[:-1], used[1:]
    ways, share = power + 1, np.minimum(below, 1.0)
    partly = (1.0 - share - (1.0 - share**ways) / ways) / np.maximum(above - below, 1e-9)
    mean = sum(below**number * above ** (power - number) for number in range(ways)) / ways
    turned: FloatArray = np.where(above > 1.0, partly, 1.0 - mean).sum(axis=0) * (angles[1] - angles[0])
    return turned


def _turned(going: FloatArray, angles: FloatArray) -> FloatArray:
    """Return the turn (F,) whose rate at each of A angles is a share (A, F), integrated over the angles."""
    turned: FloatArray = 0.5 * (going[1:] + going[:-1]).sum(axis=0) * (angles[1] - angles[0])
    return turned
