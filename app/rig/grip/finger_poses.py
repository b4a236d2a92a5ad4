"""Poses of a grip's fingers at every frame, interpolated in tables over the controls, with corrections if the wrist is
offset.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import AnyFloatArray, BoolArray, FloatArray, IndexArray
from app.rig import quaternion
from app.rig.grip.finger_ik import ReachTarget, fingers_at_targets
from app.rig.grip.grip_pose import (
    FingerTable,
    GripPose,
    HandHold,
    StationBlend,
    StationTable,
    WristOffset,
    come_to,
    given_way,
    wrist_given,
)
from app.rig.quaternion import interpolated, mixed

Controls = Mapping[str, AnyFloatArray]

LIFT_STAY_M = 0.004
"""Weight in metres of keeping the pose while a finger is lifted on its way: a finger that cannot reach the height would
jump between the ends of its range.
"""
LOW_HOVER = 0.123
"""Value of a finger's control at which it waits in slow passages: the map's height, which is 1 / 1.3 of the highest
(`app.rig.grip.fitting.touch_targets.HOVER_MORE`).
"""

NEIGHBOURS = {
    "index": {"middle": 0.3},
    "middle": {"index": 0.2, "ring": 0.5},
    "ring": {"middle": 0.5, "little": 0.5},
    "little": {"ring": 1.0},
}
"""Shares by which fingers move together with others: ring with little and middle most (Zatsiorsky, Li & Latash
2000).
"""
GIVES = 0.10
"""Most that a waiting finger moves together with others, as a share of its control's travel: about 2 mm."""


def finger_rotations(
    grip: GripPose,
    controls: Controls,
    frames: int,
    placed: Mapping[str, StationBlend] | None = None,
    raised: FloatArray | float = 0.0,
) -> FloatArray:
    """Return the rotations of the fingers.

    Parameters
    ----------
    controls : dict of str to (F,)
        Values 0..1 by control; missing controls are at 0.
    frames : int
        Number of frames F.
    placed : mapping of str to StationBlend, optional
        Positions of fingers that are not at their home station.
    raised : (F,) float64 or float
        Height of waiting fingers, 0..1: from a slow passage to the fastest.

    Returns
    -------
    (F, len(hold.finger_joints), 4) float64
        ``parent_from_joint`` rotations in the order of ``grip.finger_joints``.
    """
    result = np.empty((len(grip.finger_joints), 4, frames)).transpose(2, 0, 1)
    height = np.broadcast_to(np.asarray(raised, dtype=np.float64), (frames,))
    start = 0
    for hand in grip.hands:
        ways: list[_Way] = []
        moved = _moved(hand, frames, placed)
        for table in hand.fingers:
            stop = start + len(table.joints)
            where = None if placed is None else placed.get(table.finger)
            free = np.arange(frames) if table.chain is None else np.flatnonzero(~moved)
            ways += _ways(table, where, free, slice(start, stop), given=False)
            if table.chain is not None:
                ways += _ways(table, where, np.flatnonzero(moved), slice(start, stop), given=True)
            start = stop
        heights = _heights(hand, controls, height)
        for way, rotations in zip(ways, _posed(hand, ways, placed, controls, heights), strict=True):
            result[slice(None) if len(way.frames) == frames else way.frames, way.joints] = rotations
    return result


def _heights(hand: HandHold, controls: Controls, raised: FloatArray) -> dict[str, FloatArray]:
    """Return the height share (F,) of each waiting finger: ``raised``, lower while a neighbour that shares muscles and
    tendons presses.
    """
    heights = {table.finger: raised for table in hand.fingers}
    if not any(station.hovers for table in hand.fingers for station in table.stations):
        return heights
    pressing: dict[str, FloatArray] = {}
    for table in hand.fingers:
        worked = {name for station in table.stations for name in station.controls if name in controls}
        if worked:
            values = [np.asarray(controls[name], dtype=np.float64) for name in sorted(worked)]
            pressing[table.finger.split(".")[1]] = np.clip(np.maximum.reduce(values), 0.0, 1.0)
    for finger in heights:
        for neighbour, share in NEIGHBOURS.get(finger.split(".")[1], {}).items():
            if neighbour in pressing:
                heights[finger] = heights[finger] - GIVES / LOW_HOVER * share * pressing[neighbour]
    return heights


@dataclass(frozen=True)
class _Way:
    """Frames in which a finger moves from station ``first`` to ``second``, or stays if these are equal.

    ``share`` is how far it has moved, ``joints`` the slice of its joints; ``given`` is True if the wrist is offset or
    the finger waits for that.
    """

    table: FingerTable
    first: int
    second: int
    frames: IndexArray
    share: FloatArray
    joints: slice
    given: bool


def _moved(hand: HandHold, frames: int, placed: Mapping[str, StationBlend] | None) -> BoolArray:
    """Return in a mask (F,) the frames in which a hand's wrist is offset, or a finger waits for such an offset."""
    moved = np.zeros(frames, dtype=np.bool_)
    for offset in hand.leans:
        for share in (given_way(offset, placed), come_to(offset, placed)):
            if share is not None:
                moved |= share > 0.0
    return moved


def _ways(table: FingerTable, where: StationBlend | None, frames: IndexArray, joints: slice, given: bool) -> list[_Way]:
    """Split ``frames`` by the pair of stations between which a finger moves; ``where`` is None if it has one station
    only.
    """
    if not len(frames):
        return []
    if where is None:
        return [_Way(table, 0, 0, frames, np.ones(len(frames)), joints, given)]
    before, after = where.before[frames].astype(np.intp), where.after[frames].astype(np.intp)
    ways = []
    for first, second in sorted(set(zip(before.tolist(), after.tolist(), strict=True))):
        here = frames[(before == first) & (after == second)]
        ways.append(_Way(table, first, second, here, where.share[here], joints, given))
    return ways


def _posed(
    hand: HandHold,
    ways: Sequence[_Way],
    placed: Mapping[str, StationBlend] | None,
    controls: Controls,
    raised: Mapping[str, FloatArray],
) -> list[FloatArray]:
    """Return the rotations (K, n, 4) of a hand's fingers for each item of ``ways``, with all targets solved together.

    Fingers are first placed for the actual wrist; poses between two stations are lifted over obstacles.
    """
    given = [(offset, weight) for offset in hand.leans for weight in [given_way(offset, placed)] if weight is not None]
    wrist = wrist_given(hand, given)
    ends: list[FloatArray | ReachTarget] = []
    for way in ways:
        values = _sampled(way.table, controls, way.frames)
        poses: tuple[FloatArray | ReachTarget, ...] = _both(
            way.table, way.first, way.second, way.share, values, raised[way.table.finger][way.frames]
        )
        if way.given:
            here = (wrist[0][way.frames], wrist[1][way.frames]) if given else wrist
            now = _Given(given, way.frames, here)
            near, far = poses
            assert not isinstance(near, ReachTarget)
            assert not isinstance(far, ReachTarget)
            at_far = _at_place(hand, way.table, way.second, far, now)
            at_near = at_far if way.first == way.second else _at_place(hand, way.table, way.first, near, now)
            poses = (at_near, at_far)
        ends += poses
    solved = _solved(ends)
    return _solved(
        [
            far if way.first == way.second else _on_way(way.table, way.first, way.second, near, far, way.share)
            for way, near, far in zip(ways, solved[::2], solved[1::2], strict=True)
        ]
    )


def _solved(asked: Sequence[FloatArray | ReachTarget]) -> list[FloatArray]:
    """Return finger poses, in which each `ReachTarget` is replaced by the pose that reaches it; equal targets are
    solved once.
    """
    requested = {id(one): one for one in asked if isinstance(one, ReachTarget)}
    found = dict(zip(requested, fingers_at_targets(list(requested.values())), strict=True))
    return [found[id(one)] if isinstance(one, ReachTarget) else one for one in asked]


def solved_pose(asked: FloatArray | ReachTarget) -> FloatArray:
    """Return a finger's rotations: those that reach a target, or given ones unchanged."""
    return _solved([asked])[0]


def _at_station(
    station: StationTable, controls: Controls, raised: FloatArray, pressed: FloatArray | float = 1.0
) -> FloatArray:
    """Return the rotations (F, n, 4) of a finger's n joints at one station for values of its controls.

    ``raised`` is the height share of a waiting finger; ``pressed`` below 1 lifts a finger that moves off its control.
    """
    known = [np.asarray(controls[name], dtype=np.float64) for name in station.controls if name in controls]
    if not known or len(station.values) == 1:
        return np.broadcast_to(station.rotations[0], (len(raised), *station.rotations.shape[1:]))
    value = np.clip(np.maximum.reduce(known), 0.0, 1.0) * pressed
    if station.hovers:
        value = value + LOW_HOVER * (1.0 - raised) * (1.0 - value) ** 4
    return interpolated(station.values, station.rotations, value)


def _both(
    table: FingerTable, first: int, second: int, share: FloatArray, controls: Controls, raised: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the rotations (F, n, 4) of a finger at the first and at the second of the stations between which it moves.

    On the way it is lifted off its control, unless it works the same control at both stations.
    """
    near, far = table.stations[first], table.stations[second]
    if first == second:
        stays = _at_station(near, controls, raised)
        return stays, stays
    keeps = bool(set(near.controls) & set(far.controls))
    off, on = (1.0, 1.0) if keeps else (1.0 - share, share)
    return _at_station(near, controls, raised, off), _at_station(far, controls, raised, on)


def _on_way(
    table: FingerTable, first: int, second: int, near: FloatArray, far: FloatArray, share: FloatArray
) -> FloatArray | ReachTarget:
    """Return the rotations (K, n, 4) of a finger between two stations, lifted over obstacles.

    ``near`` and ``far`` are its rotations at the stations, ``share`` is how far it has moved.
    """
    pose = mixed(near, far, share[:, None, None])
    away = max((table.stations[first].away_m, table.stations[second].away_m), key=lambda one: float(one @ one))
    return raised_way(table, first, second, pose, share, away) if np.any(away) else pose


def raised_way(
    table: FingerTable, first: int, second: int, rotations: FloatArray, share: FloatArray, away_m: FloatArray
) -> FloatArray | ReachTarget:
    """Return the rotations (K, n, 4) of a finger between two stations, lifted by ``away_m`` at half way and less before
    and after.
    """
    near, far = table.stations[first], table.stations[second]
    if table.chain is None or min(near.tip_joint, far.tip_joint) < 0 or not np.any(away_m):
        return rotations
    # Contacts farther out on the finger are lifted too, or they would dip into the body below the lifted inner joints.
    outer = max(near, far, key=lambda station: station.tip_joint)
    tips = np.broadcast_to(outer.tip_m, (len(share), 3))
    requested = _tip(table, rotations, tips, outer.tip_joint) + np.multiply.outer(np.sin(np.pi * share), away_m)
    return ReachTarget(table.chain, rotations, outer.tip_joint, outer.tip_m, requested, LIFT_STAY_M)


def _sampled(table: FingerTable, controls: Controls, here: IndexArray) -> Controls:
    names = {name for station in table.stations for name in station.controls if name in controls}
    return {name: np.asarray(controls[name])[here] for name in sorted(names)}


@dataclass(frozen=True)
class _Given:
    """Wrist offsets of a hand: ``leans`` are the offsets, each with its share (F,) in all frames.

    ``wrist`` is the resulting position (K, 3) and rotation (K, 4) in the K ``frames``, or in one row for all.
    """

    leans: Sequence[tuple[WristOffset, FloatArray]]
    frames: IndexArray
    wrist: tuple[FloatArray, FloatArray]

    def waits(self, offset: WristOffset) -> FloatArray:
        """Return the share (K,) of a wrist offset that is still missing in each frame, 0..1."""
        weight = next((weight[self.frames] for one, weight in self.leans if one is offset), np.zeros(len(self.frames)))
        return 1.0 - weight


def _at_place(
    hand: HandHold, table: FingerTable, index: int, rotations: FloatArray, given: _Given
) -> FloatArray | ReachTarget:
    """Return the rotations (K, n, 4) of a finger that keep its fingertip at a station although the wrist is offset."""
    station = table.stations[index]
    if station.tip_joint < 0:
        return rotations
    offset = next((offset for offset in hand.leans if offset.places == ((table.finger, index),)), None)
    if offset is None:
        return with_wrist(table, station, rotations, wrist_given(hand, []), given.wrist)
    lifted = np.multiply.outer(given.waits(offset), station.waits_m)
    own = wrist_given(hand, [(offset, np.ones(1))])
    return with_wrist(table, station, rotations, own, given.wrist, lifted)


def with_wrist(
    table: FingerTable,
    station: StationTable,
    rotations: FloatArray,
    own: tuple[FloatArray, FloatArray],
    wrist: tuple[FloatArray, FloatArray],
    lifted_m: FloatArray | float = 0.0,
) -> ReachTarget:
    """Return the target that keeps the touching point of a station in place if the wrist is not the one of the
    solution.

    ``own`` is the wrist for which ``rotations`` were solved, ``wrist`` the actual one: positions (K, 3) and rotations
    (K, 4) in one frame. ``lifted_m`` (K, 3) is added in the wrist's frame.
    """
    assert table.chain is not None
    tips = np.broadcast_to(station.tip_m, (len(rotations), 3))
    requested = own[0] + quaternion.rotate(own[1], _tip(table, rotations, tips, station.tip_joint))
    local = quaternion.rotate(quaternion.conjugate(wrist[1]), requested - wrist[0]) + lifted_m
    return ReachTarget(
        table.chain, rotations, station.tip_joint, station.tip_m, np.broadcast_to(local, (len(rotations), 3))
    )


def tip_m(table: FingerTable, station: StationTable, rotations: FloatArray) -> FloatArray:
    """Return the position (K, 3) of a station's touching point in the wrist's frame in K frames, metres."""
    return _tip(table, rotations, np.broadcast_to(station.tip_m, (len(rotations), 3)), station.tip_joint)


def _tip(table: FingerTable, rotations: FloatArray, tip_m: FloatArray, joint: int) -> FloatArray:
    """Return the position (K, 3) in the wrist's frame of a point of one of the finger's joints, in K poses."""
    assert table.chain is not None
    point = tip_m
    for index in range(joint, -1, -1):
        point = table.chain.offsets_m[index] + quaternion.rotate(rotations[:, index], point)
    return point
