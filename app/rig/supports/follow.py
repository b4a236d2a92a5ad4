"""Transforms of the bones of straps and chair in each frame, from the body's joints and the instruments."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.supports.model import Strap, StrapLeg, Supports

LETS_GO = (1.4, 1.8)
"""Distances of the instrument, as multiples of the strap's reach, up to which the strap is hooked in and beyond which
it hangs down; it changes gradually between.
"""
_MOST_SLACK = 0.35
"""Greatest sag of a slack leg, as a share of its length."""


def support_matrices(supports: Supports, joints: FloatArray, instruments: Sequence[FloatArray]) -> FloatArray:
    """Return the transforms ``world_from_rest`` (F, B, 3, 4) of all B bones of straps and chair; rest is the pose in
    which they were made.

    Parameters
    ----------
    joints : (F, J, 3, 4) float64
        ``world_from_joint``, in the player's frame.
    instruments : sequence of (F, 3, 4) float64
        ``world_from_instrument`` of the musician's instruments, in their order.
    """
    result = np.zeros((len(joints), len(supports.bones), 3, 4))
    result[..., :3] = np.eye(3)
    posed = [_posed(supports, strap, joints, instruments) for strap in supports.straps]
    for number, bone in enumerate(supports.bones):
        if bone.role == "joint":
            result[:, number] = _from_rest(supports, joints, bone.joint)
        elif bone.role != "still":
            turn, places_m = posed[bone.strap]
            _put(result[:, number], *_of_strap(turn, places_m, bone.role, bone.leg), bone.place_m)
    return result


def hooked_m(supports: Supports, strap: Strap, joints: FloatArray, instruments: Sequence[FloatArray]) -> FloatArray:
    """Return the lower end (F, 3) of a strap: at the nearest of its hooks, or hanging down if that is too far away."""
    ends = np.stack(
        [
            instruments[hook.instrument][..., :3] @ hook.at_m + instruments[hook.instrument][..., 3]
            for hook in strap.hooks
        ]
    )
    carried = _carried(supports, strap, joints)
    root = carried[..., :3] @ strap.root_m + carried[..., 3]
    away = np.linalg.norm(ends - root, axis=-1)
    nearest, frames = np.argmin(away, axis=0), np.arange(len(joints))
    end, distance = ends[nearest, frames], away[nearest, frames]
    reach = float(np.linalg.norm(strap.hook_m - strap.root_m))
    gone = np.clip((distance / reach - LETS_GO[0]) / (LETS_GO[1] - LETS_GO[0]), 0.0, 1.0)
    gone = (gone * gone * (3.0 - 2.0 * gone))[:, None]
    hanging = carried[..., :3] @ strap.hanging_m + carried[..., 3]
    result: FloatArray = end + gone * (hanging - end)
    return result


def _carried(supports: Supports, strap: Strap, joints: FloatArray) -> FloatArray:
    """Return the transform (F, 3, 4), from the pose in which a strap was made, of what carries it: the chest, or the
    seat, which does not move.
    """
    if strap.turning >= 0:
        return _from_rest(supports, joints, strap.turning)
    return np.tile(np.eye(3, 4), (len(joints), 1, 1))


_Turns = dict[tuple[str, int], FloatArray]
_Places = dict[tuple[str, int], FloatArray]


def _of_strap(turn: _Turns, places_m: _Places, role: str, leg: int) -> tuple[FloatArray, FloatArray]:
    key = ("cord", -1) if role == "cord" else ("leg", leg)
    return turn[key], places_m[(role, -1 if role == "cord" else leg)]


def _put(target: FloatArray, turn: FloatArray, place_m: FloatArray, rest_m: FloatArray) -> None:
    target[..., :3] = turn
    target[..., 3] = place_m - turn @ rest_m


def _posed(
    supports: Supports, strap: Strap, joints: FloatArray, instruments: Sequence[FloatArray]
) -> tuple[_Turns, _Places]:
    """Return the rotations (F, 3, 3) and the positions (F, 3) of a strap's bones, each by role and leg."""
    body = _carried(supports, strap, joints)[..., :3]
    tops = _tops(supports, strap, joints)
    middle = tops.mean(axis=1)
    end = hooked_m(supports, strap, joints, instruments)
    up = middle - end
    meet = end + strap.cord_m * up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9)
    lowered = _lowered(strap, _carried(supports, strap, joints), end)
    turns: _Turns = {("cord", -1): _turned(body, strap.meet_m - strap.hook_m, meet - end)}
    places: _Places = {("cord", -1): end}
    for number, leg in enumerate(strap.legs):
        top = tops[:, number]
        turns["leg", number] = _turned(body, leg.top_m - strap.meet_m, top - meet)
        places["top", number], places["end", number] = top, meet
        places["middle", number] = 0.5 * (top + meet) + _bow(strap, leg, top - meet, body, lowered)
    return turns, places


def _lowered(strap: Strap, carried: FloatArray, end: FloatArray) -> FloatArray:
    """Return the share (F, 1), 0..1, of the way from the played to the lowered instrument that a strap's lower end has
    covered.

    ``carried`` is the transform of what carries the strap, ``end`` its lower end.
    """
    way = strap.low_m - strap.hook_m
    usual = carried[..., :3] @ strap.hook_m + carried[..., 3]
    gone = ((end - usual) * (carried[..., :3] @ way)).sum(axis=-1) / max(float(way @ way), 1e-9)
    # A straight band would soon run into the body after it leaves its attachment.
    share = np.clip(gone, 0.0, 1.0)[:, None]
    found: FloatArray = share * (2.0 - share)
    return found


def _bow(strap: Strap, leg: StrapLeg, chord: FloatArray, body: FloatArray, lowered: FloatArray) -> FloatArray:
    """Return the displacement (F, 3) of the control point in the middle of a leg: outwards if the leg is longer than
    the distance of its ends, or if the body is in between.
    """
    length = float(np.linalg.norm(leg.top_m - strap.meet_m))
    way = np.maximum(np.linalg.norm(chord, axis=-1, keepdims=True), 1e-6)
    out = body @ leg.out
    out = out - chord * (out * chord).sum(axis=-1, keepdims=True) / way**2
    out /= np.maximum(np.linalg.norm(out, axis=-1, keepdims=True), 1e-6)
    # A shallow parabola with sag s over a chord c has the length c + 8 s^2 / 3 c; its control point is at twice the
    # sag.
    sag = np.sqrt(np.maximum(length / way - 1.0, 0.0) * 3.0 / 8.0)
    bowed: FloatArray = np.maximum(2.0 * np.minimum(sag, _MOST_SLACK) * way, lowered * leg.low_bow_m) * out
    return bowed


def _turned(body: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Return rotations (F, 3, 3) that take the direction ``before`` (3,) to ``after`` (F, 3) and otherwise rotate with
    the body.
    """
    carried = body @ before
    return quaternion.to_matrix(quaternion.between(_unit(carried), _unit(after))) @ body


def _unit(ways: FloatArray) -> FloatArray:
    found: FloatArray = ways / np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-9)
    return found


def _tops(supports: Supports, strap: Strap, joints: FloatArray) -> FloatArray:
    """Return the upper ends (F, L, 3) of a strap's L legs in the world, metres, moved with the joints."""
    tops = np.zeros((len(joints), len(strap.legs), 3))
    for number, leg in enumerate(strap.legs):
        if not leg.joints:
            tops[:, number] = leg.top_m
        for joint, share in zip(leg.joints, leg.shares, strict=True):
            matrix = _from_rest(supports, joints, joint)
            tops[:, number] += share * (matrix[..., :3] @ leg.top_m + matrix[..., 3])
    return tops


def _from_rest(supports: Supports, joints: FloatArray, joint: int) -> FloatArray:
    """Return the transform (F, 3, 4) of a joint from the pose in which the straps were made to each frame."""
    rest = supports.joints[joint]
    turn = joints[:, joint, :, :3] @ rest[:, :3].T
    return np.concatenate([turn, (joints[:, joint, :, 3] - turn @ rest[:, 3])[..., None]], axis=-1)
