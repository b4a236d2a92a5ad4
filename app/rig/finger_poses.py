"""The fingers of a hold at every frame: tables over the controls, and what the hand's giving way asks of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from app.rig import quaternion
from app.rig.hold import (
    Chain,
    FingerTable,
    HandHold,
    Hold,
    Lean,
    Placed,
    StationTable,
    come_to,
    given_way,
    interpolated,
    mixed,
    wrist_given,
)

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]
Controls = Mapping[str, npt.NDArray[np.floating]]

LOW_HOVER = 0.123
"""In slow passages a finger waits as low as if its control had come so far: at the map's height, which is 1 / 1.3 of
the highest (`app.rig.grip_problem.HOVER_MORE`)."""
ROUNDS = 5
DAMPING_M = 0.004
STEP_M = 0.012
"""A finger is brought back to its place in steps of at most this length, stiff where its joints hardly move it."""
WAITING = 0.5
"""A finger waits for a hand that will give way for it lifted by this share of what it was lifted on its way there."""


def finger_rotations(
    hold: Hold,
    controls: Controls,
    frames: int,
    placed: Mapping[str, Placed] | None = None,
    raised: FloatArray | float = 0.0,
) -> FloatArray:
    """Pose the fingers.

    Parameters
    ----------
    hold : Hold
    controls : dict of str to (F,)
        Values 0..1; a control that is absent is at 0.
    frames : int
        F.
    placed : mapping of str to Placed, optional
        Where the fingers are that are not at home.
    raised : (F,) float64 or float
        0..1: how high fingers wait over their keys, from a slow passage to the fastest.

    Returns
    -------
    (F, len(hold.finger_joints), 4) float64
        ``parent_from_joint`` rotations in the order of ``hold.finger_joints``.
    """
    result = np.empty((frames, len(hold.finger_joints), 4))
    height = np.broadcast_to(np.asarray(raised, dtype=np.float64), (frames,))
    start = 0
    for hand in hold.hands:
        moved = np.zeros(frames, dtype=np.bool_)
        for lean in hand.leans:
            for share in (given_way(lean, placed), come_to(lean, placed)):
                if share is not None:
                    moved |= share > 0.0
        here = np.flatnonzero(moved)
        for table in hand.fingers:
            stop = start + len(table.joints)
            where = None if placed is None else placed.get(table.finger)
            if where is None:
                result[:, start:stop] = _at_station(table.stations[0], controls, height)
            else:
                result[:, start:stop] = _between(table, where, controls, height)
            if len(here):
                result[here, start:stop] = _kept(hand, table, result[here, start:stop], here, placed, controls, height)
            start = stop
    return result


def _at_station(
    station: StationTable, controls: Controls, raised: FloatArray, pressed: FloatArray | float = 1.0
) -> FloatArray:
    """Rotations (F, n, 4) at one station; ``pressed`` lifts a finger that is on its way off what it works."""
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
    """Rotations (F, n, 4) at the two stations a finger goes between.

    It lifts on its way, but where it keeps on something that it works at both ends of the way.
    """
    near, far = table.stations[first], table.stations[second]
    keeps = first == second or bool(set(near.controls) & set(far.controls))
    off, on = (1.0, 1.0) if keeps else (1.0 - share, share)
    return _at_station(near, controls, raised, off), _at_station(far, controls, raised, on)


def _between(table: FingerTable, where: Placed, controls: Controls, raised: FloatArray) -> FloatArray:
    """Rotations (F, n, 4) of a finger that goes from station to station."""
    result = np.empty((len(raised), len(table.joints), 4))
    for first, second, here in _pairs(where, np.arange(len(raised))):
        values = _sampled(table, controls, here)
        if first == second:
            result[here] = _at_station(table.stations[first], values, raised[here])
            continue
        share = where.share[here]
        near, far = _both(table, first, second, share, values, raised[here])
        result[here] = _on_way(table, first, second, near, far, share)
    return result


def _on_way(
    table: FingerTable, first: int, second: int, near: FloatArray, far: FloatArray, share: FloatArray
) -> FloatArray:
    """Rotations (K, n, 4) between two stations, lifted over what lies between."""
    pose = mixed(near, far, share[:, None, None])
    away = max((table.stations[first].away_m, table.stations[second].away_m), key=lambda one: float(one @ one))
    return raised_way(table, first, second, pose, share, away) if np.any(away) else pose


def raised_way(
    table: FingerTable, first: int, second: int, rotations: FloatArray, share: FloatArray, away_m: FloatArray
) -> FloatArray:
    """Lift a finger that is between two of its stations, most half way: rotations (K, n, 4)."""
    near, far = table.stations[first], table.stations[second]
    if table.chain is None or min(near.tip_joint, far.tip_joint) < 0 or not np.any(away_m):
        return rotations
    # What touches farther out is lifted, or it would dip into what the inner joints are lifted over.
    outer = max(near, far, key=lambda station: station.tip_joint)
    tips = np.broadcast_to(outer.tip_m, (len(share), 3))
    wanted = _tip(table, rotations, tips, outer.tip_joint) + np.multiply.outer(np.sin(np.pi * share), away_m)
    return _brought(table, rotations, tips, outer.tip_joint, wanted)


def _pairs(where: Placed, frames: IntArray) -> list[tuple[int, int, IntArray]]:
    """The ways between two stations among some frames, and the frames of each."""
    pairs = np.stack([where.before[frames], where.after[frames]], axis=1).astype(np.intp)
    return [
        (first, second, frames[(pairs[:, 0] == first) & (pairs[:, 1] == second)])
        for first, second in np.unique(pairs, axis=0).tolist()
    ]


def _sampled(table: FingerTable, controls: Controls, here: IntArray) -> Controls:
    names = {name for station in table.stations for name in station.controls if name in controls}
    return {name: np.asarray(controls[name])[here] for name in sorted(names)}


def _kept(
    hand: HandHold,
    table: FingerTable,
    rotations: FloatArray,
    here: IntArray,
    placed: Mapping[str, Placed] | None,
    controls: Controls,
    raised: FloatArray,
) -> FloatArray:
    """Rotations (K, n, 4) of a finger at frames where its hand gives way, or one of its fingers waits for that: brought
    back to where its tables have it."""
    if table.chain is None:
        return rotations
    where = None if placed is None else placed.get(table.finger)
    if where is None:
        still = np.zeros(len(raised))
        where = Placed(still, still, still + 1.0)
    rows = np.zeros(len(raised), dtype=np.intp)
    rows[here] = np.arange(len(here))
    given = [(lean, weight) for lean in hand.leans for weight in [given_way(lean, placed)] if weight is not None]
    result = np.empty_like(rotations)
    for first, second, frames in _pairs(where, here):
        share = where.share[frames]
        poses = _both(table, first, second, share, _sampled(table, controls, frames), raised[frames])
        now = [(lean, weight[frames]) for lean, weight in given]
        far = _at_place(hand, table, second, poses[1], now)
        if first != second:
            far = _on_way(table, first, second, _at_place(hand, table, first, poses[0], now), far, share)
        result[rows[frames]] = far
    return result


def _at_place(
    hand: HandHold, table: FingerTable, index: int, rotations: FloatArray, given: list[tuple[Lean, FloatArray]]
) -> FloatArray:
    """Rotations (K, n, 4) at a station, for another wrist than the one they were solved for."""
    station = table.stations[index]
    if station.tip_joint < 0:
        return rotations
    lean = next((lean for lean in hand.leans if _is(lean, table, index)), None)
    if lean is None:
        return with_wrist(table, station, rotations, wrist_given(hand, []), wrist_given(hand, given))
    waits = 1.0 - next((weight for one, weight in given if one is lean), np.zeros(len(rotations)))
    lifted = np.multiply.outer(waits, WAITING * station.away_m)
    own = wrist_given(hand, [(lean, np.ones(1))])
    return with_wrist(table, station, rotations, own, wrist_given(hand, given), lifted)


def with_wrist(
    table: FingerTable,
    station: StationTable,
    rotations: FloatArray,
    own: tuple[FloatArray, FloatArray],
    wrist: tuple[FloatArray, FloatArray],
    lifted_m: FloatArray | float = 0.0,
) -> FloatArray:
    """Rotations (K, n, 4) that leave what touches at a station where it is, for another wrist than their ``own``.

    Wrists are places (K, 3) and rotations (K, 4) in one frame; ``lifted_m`` (K, 3) is added in that of the wrist.
    """
    tips = np.broadcast_to(station.tip_m, (len(rotations), 3))
    wanted = own[0] + quaternion.rotate(own[1], _tip(table, rotations, tips, station.tip_joint))
    local = quaternion.rotate(quaternion.conjugate(wrist[1]), wanted - wrist[0]) + lifted_m
    return _brought(table, rotations, tips, station.tip_joint, local)


def tip_m(table: FingerTable, station: StationTable, rotations: FloatArray) -> FloatArray:
    """Where (K, 3) what touches at a station is in the wrist's frame."""
    return _tip(table, rotations, np.broadcast_to(station.tip_m, (len(rotations), 3)), station.tip_joint)


def _is(lean: Lean, table: FingerTable, station: int) -> bool:
    return lean.places == ((table.finger, station),)


def _tip(table: FingerTable, rotations: FloatArray, tip_m: FloatArray, joint: int) -> FloatArray:
    """Where a point (K, 3) of a joint is in the wrist's frame."""
    assert table.chain is not None
    point = tip_m
    for index in range(joint, -1, -1):
        point = table.chain.offsets_m[index] + quaternion.rotate(rotations[:, index], point)
    return point


def _brought(
    table: FingerTable, rotations: FloatArray, tip_m: FloatArray, joint: int, wanted_m: FloatArray
) -> FloatArray:
    """Rotations (K, n, 4) that bring a point of a joint to a place (K, 3) of the wrist's frame, within the limits.

    A few damped Gauss-Newton steps (Wampler 1986) on the angles that a finger has.
    """
    chain = table.chain
    assert chain is not None
    joints, kinds = chain.dofs.T.astype(np.intp)
    angles = _angles(chain, rotations)
    low, high = np.minimum(chain.low, angles[:, joints, kinds]), np.maximum(chain.high, angles[:, joints, kinds])
    for _ in range(ROUNDS):
        turned = _turned(chain, angles)
        places, bases = _forward(chain, turned)
        tip = places[:, joint] + quaternion.rotate(bases[:, joint], tip_m)
        off = wanted_m - tip
        length = np.sqrt(np.einsum("ki,ki->k", off, off))[:, None]
        off = off * np.minimum(1.0, STEP_M / np.maximum(length, 1e-9))
        above = np.concatenate([np.tile(quaternion.IDENTITY, (len(tip), 1, 1)), bases[:, :-1]], axis=1)
        axes = quaternion.rotate(above[:, joints], _axes(chain, angles)[:, joints, kinds])
        arms = tip[:, None] - places[:, joints]
        slopes = np.cross(axes, arms) * (joints <= joint)[None, :, None]
        now = angles[:, joints, kinds]
        step = _step(slopes, off)
        # What would leave its range stands still, and the other joints make up for it.
        for _ in range(2):
            stuck = (now + step < low) | (now + step > high)
            stand = np.clip(now + step, low, high) - now
            left = off - np.einsum("kdi,kd->ki", slopes, np.where(stuck, stand, 0.0))
            step = np.where(stuck, stand, _step(np.where(stuck[..., None], 0.0, slopes), left))
        angles[:, joints, kinds] = np.clip(now + step, low, high)
    return _turned(chain, angles)


def _axes(chain: Chain, angles: FloatArray) -> FloatArray:
    """About which axis (K, n, 3, 3) each of its angles turns a joint, in the frame of the one above."""
    swing = angles[..., 0, None] * chain.axes[:, 0] + angles[..., 1, None] * chain.axes[:, 1]
    angle = np.maximum(np.sqrt(np.einsum("kni,kni->kn", swing, swing)), 1e-9)[..., None, None]
    axis = np.broadcast_to(chain.axes, (len(angles), *chain.axes.shape))
    # Flexion and sideways are one turn about a common axis: what either adds is turned by half of it, nearly.
    once = np.cross(swing[:, :, None], axis)
    twice = np.cross(swing[:, :, None], once)
    result: FloatArray = axis + (1.0 - np.cos(angle)) / angle**2 * once + (angle - np.sin(angle)) / angle**3 * twice
    result[:, :, 2] = quaternion.rotate(quaternion.from_rotation_vector(swing), axis[:, :, 2])
    return result


def _step(slopes: FloatArray, off_m: FloatArray) -> FloatArray:
    """Damped least squares: the angles (K, D) that bring a point by ``off_m`` (K, 3)."""
    normal = np.einsum("kdi,kdj->kij", slopes, slopes) + DAMPING_M**2 * np.eye(3)
    step: FloatArray = np.einsum("kdi,ki->kd", slopes, np.linalg.solve(normal, off_m[..., None])[..., 0])
    return step


def _forward(chain: Chain, rotations: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places (K, n, 3) and rotations (K, n, 4) of the joints in the wrist's frame."""
    places, bases = np.empty((*rotations.shape[:2], 3)), np.empty_like(rotations)
    place, basis = np.zeros((len(rotations), 3)), np.tile(quaternion.IDENTITY, (len(rotations), 1))
    for index, offset in enumerate(chain.offsets_m):
        place = place + quaternion.rotate(basis, offset)
        basis = quaternion.multiply(basis, rotations[:, index])
        places[:, index], bases[:, index] = place, basis
    return places, bases


def _angles(chain: Chain, rotations: FloatArray) -> FloatArray:
    """Flexion, sideways and twist (K, n, 3) of rotations."""
    result = np.empty((*rotations.shape[:2], 3))
    for index, (flexion, sideways, twist) in enumerate(chain.axes):
        swing, _ = quaternion.swing_twist(rotations[:, index], twist)
        bent = quaternion.to_rotation_vector(swing)
        result[:, index, 0], result[:, index, 1] = bent @ flexion, bent @ sideways
        result[:, index, 2] = quaternion.twist_angle(rotations[:, index], twist)
    return result


def _turned(chain: Chain, angles: FloatArray) -> FloatArray:
    """Rotations (K, n, 4) of angles: swing after twist, as `app.rig.hand.joint_rotations`."""
    swing = angles[..., 0, None] * chain.axes[:, 0] + angles[..., 1, None] * chain.axes[:, 1]
    return quaternion.multiply(
        quaternion.from_rotation_vector(swing), quaternion.from_axis_angle(chain.axes[:, 2], angles[..., 2])
    )
