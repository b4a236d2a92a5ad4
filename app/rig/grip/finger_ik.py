"""Inverse kinematics of fingers: a few steps bring each fingertip to its target, for many fingers and frames at once.

Fingers are independent; they are solved together because one frame takes as long as a hundred.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from app.arrays import BoolArray, FloatArray, IndexArray
from app.rig import quaternion
from app.rig.grip.grip_pose import Chain

ROUNDS = 5
DAMPING_M = 0.004
STEP_M = 0.012
"""Longest step in metres of a finger towards its place, with damping where its joints hardly move it."""
LEAST_COMPARED = 32
"""Number of rows below which solving takes less time than comparing them."""


@dataclass(frozen=True)
class ReachTarget:
    """Target of a fingertip in K frames: the chain of its n joints, and the point to reach.

    Attributes
    ----------
    rotations : (K, n, 4) float64
        Rotations of the joints before solving.
    joint : int
        Joint within the finger that carries the point.
    tip_m : (3,) float64
        Point of the finger in the frame of that joint.
    requested_m : (K, 3) float64
        Requested position of the point in the wrist's frame.
    stay_m : float
        Weight that keeps the angles near their values before solving: 0 if the exact position matters.
    """

    chain: Chain
    rotations: FloatArray
    joint: int
    tip_m: FloatArray
    requested_m: FloatArray
    stay_m: float = 0.0


@dataclass(frozen=True)
class _Rows:
    """Finger chains solved together, one for each of R rows (first axis of all arrays). ``used`` marks the angles that
    a finger has.
    """

    offsets_m: FloatArray
    axes: FloatArray
    joints: IndexArray
    kinds: IndexArray
    used: BoolArray
    low: FloatArray
    high: FloatArray

    @classmethod
    def of(cls, chains: Sequence[Chain], each: IndexArray) -> _Rows:
        most = max(len(chain.dofs) for chain in chains)
        dofs = np.zeros((len(chains), most, 2), np.intp)
        used = np.zeros((len(chains), most), dtype=bool)
        low, high = np.zeros(used.shape), np.zeros(used.shape)
        for row, chain in enumerate(chains):
            own = slice(0, len(chain.dofs))
            dofs[row, own], used[row, own], low[row, own], high[row, own] = chain.dofs, True, chain.low, chain.high
        return cls(
            offsets_m=np.array([chain.offsets_m for chain in chains])[each],
            axes=np.array([chain.axes for chain in chains])[each],
            joints=dofs[each, :, 0],
            kinds=dofs[each, :, 1],
            used=used[each],
            low=low[each],
            high=high[each],
        )


def fingers_at_targets(asked: Sequence[ReachTarget]) -> list[FloatArray]:
    """Return for each target the rotations (K, n, 4) of n joints in K frames that bring the finger's point to it,
    within the limits of the joints.
    """
    result: list[FloatArray] = [one.rotations for one in asked]
    lengths = [len(one.chain.offsets_m) for one in asked]
    for length in dict.fromkeys(lengths):
        places = [place for place, own in enumerate(lengths) if own == length]
        together = [asked[place] for place in places]
        counts = [len(one.requested_m) for one in together]
        chains = list({id(one.chain): one.chain for one in together}.values())
        numbers = {id(chain): number for number, chain in enumerate(chains)}
        rows = (
            np.repeat([numbers[id(one.chain)] for one in together], counts),
            np.concatenate([one.rotations for one in together]),
            np.repeat([one.joint for one in together], counts),
            np.repeat([one.tip_m for one in together], counts, axis=0),
            np.concatenate([one.requested_m for one in together]),
            np.repeat([one.stay_m for one in together], counts),
        )
        # While a hand rests or has arrived, consecutive frames are equal.
        firsts, same = distinct_rows(rows)
        each, *once = (values[firsts] for values in rows)
        solved = _brought(_Rows.of(chains, each), *once)[same]
        for place, own in zip(places, np.split(solved, np.cumsum(counts)[:-1]), strict=True):
            result[place] = own
    return result


def distinct_rows(columns: Sequence[npt.NDArray[Any]]) -> tuple[IndexArray, IndexArray]:
    """Find rows that are bitwise equal.

    Parameters
    ----------
    columns : sequence of (R, ...)
        Arrays whose entries with the same first index form a row.

    Returns
    -------
    firsts : (D,) intp
        Indices of distinct rows.
    same : (R,) intp
        Index of the distinct row equal to each row.
    """
    count = len(columns[0])
    if count >= LEAST_COMPARED:
        values = np.column_stack([column.reshape(count, -1) for column in columns]).astype(np.float64, copy=False)
        bits = values.view(np.uint64)
        sums = bits @ _factors(bits.shape[1])
        _, firsts, same = np.unique(sums, return_index=True, return_inverse=True)
        # Equal rows have equal sums; others almost never do.
        if len(firsts) < count and np.array_equal(bits, bits[firsts[same]]):
            return firsts, same
    each = np.arange(count)
    return each, each


@lru_cache(maxsize=16)
def _factors(count: int) -> npt.NDArray[np.uint64]:
    """Return ``count`` fixed odd numbers, by which values are multiplied and summed with wrap-around to hash them."""
    return np.random.default_rng(1).integers(0, 2**63, count, dtype=np.uint64) * np.uint64(2) + np.uint64(1)


def _brought(
    chains: _Rows,
    rotations: FloatArray,
    joint: IndexArray,
    tip_m: FloatArray,
    requested_m: FloatArray,
    stay_m: FloatArray,
) -> FloatArray:
    """Return rotations of the joints after a few damped Gauss-Newton steps (Wampler 1986) that bring the point
    ``tip_m`` of ``joint`` to ``requested_m``; ``stay_m`` is the weight of keeping the angles.
    """
    rows = np.arange(len(rotations))
    each, joints, kinds = rows[:, None], chains.joints, chains.kinds
    moves = (chains.used & (joints <= joint[:, None]))[..., None]
    angles = _angles(chains, rotations)
    now = angles[each, joints, kinds]
    start = now
    low, high = np.minimum(chains.low, now), np.maximum(chains.high, now)
    stiff = (DAMPING_M**2 + stay_m**2)[:, None, None] * np.eye(3)
    above = np.empty_like(rotations)
    above[:, 0] = quaternion.IDENTITY
    turned = _turned(chains, angles)
    for _ in range(ROUNDS):
        places, bases = _forward(chains, turned)
        tip = places[rows, joint] + quaternion.rotate(bases[rows, joint], tip_m)
        off = requested_m - tip
        length = np.sqrt(np.einsum("ki,ki->k", off, off))[:, None]
        off = off * np.minimum(1.0, STEP_M / np.maximum(length, 1e-9))
        above[:, 1:] = bases[:, :-1]
        axes = quaternion.rotate(above[each, joints], _axes(chains, angles)[each, joints, kinds])
        slopes = quaternion.cross(axes, tip[:, None] - places[each, joints]) * moves
        now = angles[each, joints, kinds]
        # First back to the initial position, weighted as required, then towards the target.
        back = np.where(stay_m[:, None] > 0.0, start - now, 0.0)
        off = off - np.einsum("kdi,kd->ki", slopes, back)
        step = back + _step(slopes, off, stiff)
        # A joint at its limit stays, and the other joints compensate.
        for _ in range(2):
            stuck = (now + step < low) | (now + step > high)
            stand = np.where(stuck, np.minimum(np.maximum(now + step, low), high) - now, 0.0)
            left = off - np.einsum("kdi,kd->ki", slopes, np.where(stuck, stand - back, 0.0))
            step = np.where(stuck, stand, back + _step(np.where(stuck[..., None], 0.0, slopes), left, stiff))
        now = np.minimum(np.maximum(now + step, low), high)
        for column in range(now.shape[1]):
            own = chains.used[:, column]
            angles[rows[own], joints[own, column], kinds[own, column]] = now[own, column]
        turned = _turned(chains, angles)
    return turned


def _axes(chains: _Rows, angles: FloatArray) -> FloatArray:
    """Return the axes (R, n, 3, 3) about which each of three angles turns each of n joints in R rows, in the frame of
    the joint above."""
    axis = chains.axes
    swing = angles[..., 0, None] * axis[:, :, 0] + angles[..., 1, None] * axis[:, :, 1]
    angle = np.maximum(np.sqrt(np.einsum("kni,kni->kn", swing, swing)), 1e-9)[..., None, None]
    # Flexion and sideways bending are one rotation about a common axis; each addition acts about an axis rotated by
    # half of it, approximately.
    once = quaternion.cross(swing[:, :, None], axis)
    twice = quaternion.cross(swing[:, :, None], once)
    result: FloatArray = axis + (1.0 - np.cos(angle)) / angle**2 * once + (angle - np.sin(angle)) / angle**3 * twice
    result[:, :, 2] = quaternion.rotate(quaternion.from_rotation_vector(swing), axis[:, :, 2])
    return result


def _step(slopes: FloatArray, off_m: FloatArray, stiff: FloatArray) -> FloatArray:
    """Return the changes (R, D) of D angles in R rows that move a point by ``off_m`` (R, 3), by damped least squares.

    ``slopes`` is the movement of the point per radian, ``stiff`` the damping.
    """
    normal = np.einsum("kdi,kdj->kij", slopes, slopes) + stiff
    step: FloatArray = np.einsum("kdi,ki->kd", slopes, np.linalg.solve(normal, off_m[..., None])[..., 0])
    return step


def _forward(chains: _Rows, rotations: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return positions (R, n, 3) and rotations (R, n, 4) of n joints in R rows, in the wrist's frame."""
    places, bases = np.empty((*rotations.shape[:2], 3)), np.empty_like(rotations)
    places[:, 0], bases[:, 0] = chains.offsets_m[:, 0], rotations[:, 0]
    for index in range(1, rotations.shape[1]):
        places[:, index] = places[:, index - 1] + quaternion.rotate(bases[:, index - 1], chains.offsets_m[:, index])
        bases[:, index] = quaternion.multiply(bases[:, index - 1], rotations[:, index])
    return places, bases


def _angles(chains: _Rows, rotations: FloatArray) -> FloatArray:
    """Return flexion, sideways bend and twist (R, n, 3), radians, of the rotations of n joints in R rows."""
    twist = chains.axes[:, :, 2]
    swing, _ = quaternion.swing_twist(rotations, twist)
    bent = quaternion.to_rotation_vector(swing)
    result: FloatArray = np.einsum("kni,knai->kna", bent, chains.axes)
    result[..., 2] = quaternion.twist_angle(rotations, twist)
    return result


def _turned(chains: _Rows, angles: FloatArray) -> FloatArray:
    """Return the rotations (R, n, 4) of n joints in R rows for given angles: swing after twist, as
    `app.rig.grip.fitting.hand_model.joint_rotations`."""
    axes = chains.axes
    swing = angles[..., 0, None] * axes[:, :, 0] + angles[..., 1, None] * axes[:, :, 1]
    return quaternion.multiply(
        quaternion.from_rotation_vector(swing), quaternion.from_axis_angle(axes[:, :, 2], angles[..., 2])
    )
