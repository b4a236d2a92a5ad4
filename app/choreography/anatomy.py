"""The T-pose of a skeleton, found in the frames of its motion.

A file's zero pose need not be a standing body: programs lay every bone along an axis of its own. But in each bone some
directions are fixed, whatever the zero pose is: to the next joint, between the hip joints or the shoulders, about which
a knee or an elbow bends, away from the floor a foot stands on. They say how the bone is turned in the T-pose. Where the
zero pose is a standing body and far from what the frames say, trunk, head, hands and feet are as it has them: frames
may show too little. Where it is near it is not used, so that a motion is the same to the last digits on any rig.

A twist is that of the hinge as in `app.rig.characters.t_pose`: the motion of a knee or an elbow shows more of it than a
pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import FEET, SEGMENTS
from app.choreography.body_check import ASKEW_DEG, SURE
from app.choreography.captured_joints import ARM, LEG, SIDES, Captured, X, Y, Z, angle_deg, unit
from app.rig import quaternion

NEAR_DEG: Final = 10.0
"""A bone of a standing zero pose that is nearer than this to how the motion shows it in the T-pose is as shown."""
MOST_TWIST_DEG: Final = 75.0
"""A hinge farther from where a standing zero pose has it is none."""
ALIKE_DEG: Final = 40.0
"""Lines of neighbouring bones are taken for the same if the motion has them nearer than this in the mean."""
LEANS_DEG: Final = {"hips": -3.0, "spine": -2.0, "chest": -4.0}
"""Lean, ahead positive, of the way to the next joint of the trunk in a body that stands: the mean of rigs whose zero
pose does (CMU, Mixamo, MakeHuman)."""
MOST_LEAN_DEG: Final = 20.0
"""Largest mean angle from upright at which a line between joints is taken to go along the trunk."""
EYES_DEG: Final = 45.0
"""Angle between upright and the way from the head's joint to between the eyes."""
BALL_DEG: Final = 25.0
TIP_DEG: Final = 16.0
"""Angle by which the ways from ankle to ball and to the tip of the toes usually go down in standing zero poses."""
USUAL_PART: Final = 0.65
"""Weight of the usual angle against the one that is seen where the foot stands: soles are not flat, and heels rise."""
STILL_PALM_DEG, MOST_PALM_DEG = 10.0, 120.0
STILL_PALM: Final = 0.9995
"""A forearm does not turn the palm if its elbow's axis is as fixed in it as this and nearer to the upper arm's than the
first of the angles; farther than the second no palm is held most of the time."""
THUMB_DEG: Final = 15.0
"""Angle by which a thumb is below the plane of the palm in a T-pose."""
SLOW_PART: Final = 3
"""Share of the frames, the slowest ones, in which a foot is taken to stand."""
FLAT_DEG: Final = 8.0
"""and flat in most of these, to this."""
SETTLES: Final = 10
"""Times that the mean of frames in which a foot is flat is taken again, of those that are near to it."""
MOST_STANCES: Final = 400
EDGE_DEG: Final = 20.0
"""Soles that stand flat are level to the sides as the knee's hinge is, to this."""


def t_pose(body: Captured, rest: Mapping[str, FloatArray] | None) -> dict[str, FloatArray]:
    """Rotations (4,) of each segment's bone in the T-pose.

    Parameters
    ----------
    rest : mapping of str to ndarray, shape (4,), or None
        The same by the zero pose, if that is a standing body.
    """
    shown = _by(body, None)
    if rest is None:
        return shown
    standing = _by(body, rest)
    if not _shows_knees(body):
        return standing
    # How a chest leans is known of rigs that have a neck.
    usual = [name for name in SEGMENTS if name != "chest" or "neck" in body.joints]
    return standing | {name: shown[name] for name in usual if _near(standing[name], shown[name])}


def _shows_knees(body: Captured) -> bool:
    """Return whether both knees bend surely: a body that hardly moves shows nothing that its zero pose does not."""
    legs = [([side + name for name in LEG], sign) for side, sign in SIDES]
    return all(body.hinge(limb[0], body.bend(limb, sign))[1] > SURE for limb, sign in legs)


def _near(turn: FloatArray, other: FloatArray) -> bool:
    off = quaternion.multiply(turn, quaternion.conjugate(other))
    return bool(np.degrees(np.linalg.norm(quaternion.to_rotation_vector(off))) < NEAR_DEG)


def _by(body: Captured, rest: Mapping[str, FloatArray] | None) -> dict[str, FloatArray]:
    """See `t_pose`: by the zero pose where there is one, else by the motion alone."""
    found = dict(rest) if rest is not None else _trunk(body)
    if rest is not None:
        found |= {name: _toes_ahead(rest[name], body.tips[name]) for name in FEET}
    for side, sign in SIDES:
        for limb in (LEG, ARM):
            found |= _limb(body, [side + name for name in limb], sign, limb is LEG, rest)
        if rest is None:
            found[f"{side}Hand"] = _hand(body, side, sign, found[f"{side}LowerArm"])
            found[f"{side}Foot"] = _foot(body, side)
    return {name: found[name] for name in SEGMENTS}


def _trunk(body: Captured) -> dict[str, FloatArray]:
    lines = {"hips": body.hip_line, "spine": unit(body.hip_line) + unit(body.shoulder_line)}
    lines["chest"] = body.shoulder_line
    nexts = {"hips": body.at("spine") if "spine" in body.joints else body.start("chest"), "chest": body.top}
    nexts["spine"] = body.start("chest")
    found = {}
    across = {name: body.mean(name, line) for name, line in lines.items()}
    for name in lines:
        found[name] = _column(body, name, across[name], nexts[name] - body.start(name))
    if body.segments["spine"] in (body.segments["hips"], body.segments["chest"]):
        same = "hips" if body.segments["spine"] == body.segments["hips"] else "chest"
        found["spine"] = found[same]
    found["head"] = _head(body, across["chest"], nexts["chest"] - body.start("chest"))
    return found


def _column(body: Captured, name: str, across: FloatArray, ways: FloatArray) -> FloatArray:
    """Turn of a part of the trunk: its line is level, and the way to the next joint leans as usual."""
    upright = np.median(body.within(name, body.up)[body.standing], axis=0)
    if name != "hips":
        # Not the vertical: who runs leans ahead all the time.
        upright = body.mean(name, body.top - body.start("hips"))
    along = body.mean(name, ways) if np.linalg.norm(ways, axis=1).min() > 1e-6 else upright
    plain = _framed(across, upright)
    way = quaternion.rotate(plain, along) * (0.0, 1.0, 1.0)
    lean_deg = float(np.degrees(np.arctan2(way[2], way[1])))
    if abs(lean_deg - LEANS_DEG[name]) > MOST_LEAN_DEG:
        return plain
    # A positive turn about X leans ahead.
    return quaternion.multiply(quaternion.from_axis_angle(X, np.radians(LEANS_DEG[name] - lean_deg)), plain)


def _carried(line: FloatArray, seen: FloatArray) -> FloatArray:
    """Return a line of the bone below in the axes of the next, if these are alike; else as it is seen in the mean.

    Programs that lay bones along an axis turn neighbours about it alike: their zero pose does not show how they
    lean, but which way they face.
    """
    return line if angle_deg(line, seen) < ALIKE_DEG else seen


def _head(body: Captured, chest_line: FloatArray, chest_ways: FloatArray) -> FloatArray:
    """Turn of the head: its eyes are level and look ahead, or it does so most of the time.

    Where bones lie along an axis, as the chest and the neck do, the head is upright when this axis of it is.
    """
    standing = body.standing
    upright = np.median(body.within("head", body.up)[standing], axis=0)
    if {"leftEye", "rightEye"} <= body.joints.keys():
        left, right = body.at("leftEye"), body.at("rightEye")
        level = _framed(body.mean("head", left - right), body.mean("head", 0.5 * (left + right) - body.at("head")))
        return quaternion.multiply(quaternion.from_axis_angle(X, np.radians(EYES_DEG)), level)
    seen = np.median(body.within("head", unit(body.shoulder_line))[standing], axis=0)
    across = _carried(chest_line, seen)
    crown, axis = body.tips["head"], body.mean("chest", chest_ways)
    if np.linalg.norm(crown) and angle_deg(crown, upright) < MOST_LEAN_DEG:
        upright = crown
    elif across is chest_line and not np.linalg.norm(crown) and angle_deg(axis, upright) < MOST_LEAN_DEG:
        upright = axis
    if across is chest_line and abs(angle_deg(across, upright) - 90.0) < MOST_LEAN_DEG / 2.0:
        return _framed(across, upright)
    return _framed(across - upright * (across @ upright) / (upright @ upright), upright)


def _limb(
    body: Captured, limb: list[str], sign: float, leg: bool, rest: Mapping[str, FloatArray] | None
) -> dict[str, FloatArray]:
    """Turns of the upper and the lower part of a limb."""
    bend = body.bend(limb, sign)
    ahead = np.cross(unit(body.shoulder_line), body.up)
    found = {}
    for segment, start, end in ((limb[0], limb[0], limb[1]), (limb[1], limb[1], limb[2])):
        way = body.mean(segment, body.at(end) - body.at(start))
        axis, sure = body.hinge(segment, bend)
        if leg:
            target, usual = -Y, _carried(body.mean("hips", body.hip_line), body.mean(segment, body.hip_line))
        else:
            target, usual = sign * X, np.cross(body.mean(segment, ahead), sign * way)
        by_hinge, by_usual = (_limb_frame(way, side, leg, sign) for side in (axis, usual))
        before = by_usual if rest is None else rest[segment]
        twist = quaternion.multiply(by_hinge, quaternion.conjugate(before))
        angle = float(quaternion.twist_angle(twist, target))
        if rest is not None and abs(np.degrees(angle)) > MOST_TWIST_DEG:
            angle = 0.0
        found[segment] = quaternion.multiply(quaternion.from_axis_angle(target, angle * sure), before)
    if rest is None and not leg and body.in_line(limb):
        found[limb[1]] = _as_upper(body, limb, sign, found)
    return found


def _as_upper(body: Captured, limb: list[str], sign: float, found: Mapping[str, FloatArray]) -> FloatArray:
    """Turn of a forearm whose bone has the axes of the upper arm's: it turns the palm, so that its elbow's axis is not
    fixed in it, and what a motion shows of it is how the palm is held most of the time."""
    lower = limb[1]
    across = quaternion.rotate(quaternion.conjugate(found[limb[0]]), Y)
    turn = _limb_frame(body.mean(lower, body.at(limb[2]) - body.at(lower)), across, False, sign)
    twist = quaternion.multiply(found[lower], quaternion.conjugate(turn))
    palm_deg = abs(np.degrees(float(quaternion.twist_angle(twist, X))))
    still = palm_deg < STILL_PALM_DEG and body.axis(lower, body.bend(limb, sign))[1] > STILL_PALM
    return turn if palm_deg < MOST_PALM_DEG and not still else found[lower]


def _limb_frame(way: FloatArray, across: FloatArray, leg: bool, sign: float) -> FloatArray:
    if leg:
        return quaternion.conjugate(quaternion.from_frames(_beside(across, way), -unit(way)))
    return quaternion.conjugate(quaternion.from_frames(sign * unit(way), _beside(across, way)))


def _hand(body: Captured, side: str, sign: float, forearm: FloatArray) -> FloatArray:
    """Turn of a hand: fingers along the arm, the palm down as its knuckles or its thumb say, or as the forearm has it.

    Parameters
    ----------
    forearm : ndarray, shape (4,)
        Turn of the forearm's bone.
    """
    name = f"{side}Hand"
    knuckles = [
        body.at(joint) for finger in ("Index", "Middle", "Ring", "Little")
        if (joint := f"{side}{finger}Proximal") in body.joints
    ]  # fmt: skip
    along = body.tips[name]
    if not knuckles and not np.linalg.norm(along) and body.in_line([side + part for part in ARM]):
        return forearm
    if knuckles:
        along = body.mean(name, knuckles[min(1, len(knuckles) - 1)] - body.at(name))
    if np.linalg.norm(along) < 1e-9:
        along = body.mean(name, body.at(name) - body.at(f"{side}LowerArm"))
    if len(knuckles) > 1:
        ahead = body.mean(name, knuckles[0] - knuckles[-1])
        up = np.cross(ahead, sign * along)
    elif np.linalg.norm(thumb := body.mean(name, body.thumbs[name])) > 0.5:
        ahead = _beside(thumb, along)
        up = np.cross(ahead, sign * unit(along))
        # A thumb is below the palm.
        up = up * np.cos(np.radians(THUMB_DEG)) - ahead * np.sin(np.radians(THUMB_DEG))
    else:
        lower = body.rotations[:, body.segments[f"{side}LowerArm"]]
        seen = body.mean(name, quaternion.rotate(quaternion.multiply(lower, quaternion.conjugate(forearm)), Y))
        up = _carried(quaternion.rotate(quaternion.conjugate(forearm), Y), seen)
    return quaternion.conjugate(quaternion.from_frames(sign * unit(along), _beside(up, along)))


def _foot(body: Captured, side: str) -> FloatArray:
    """Turn of a foot: toes ahead, level to the sides as the knee's hinge is, the sole about level where it stands."""
    name = f"{side}Foot"
    has_toes = f"{side}Toes" in body.joints
    toes = body.mean(name, body.at(f"{side}Toes") - body.at(name)) if has_toes else body.tips[name]
    bend = body.bend([side + part for part in LEG], 1.0)
    far = np.linalg.norm(bend, axis=1)
    # The ankle turns as well: the middle of its turns, in frames in which the knee shows its axis best.
    axis = np.median(unit(body.within(name, bend))[far >= np.median(far)], axis=0)
    sure = body.hinge(name, bend)[1]
    up = _sole_up(body, name)
    if not np.linalg.norm(toes):
        return _framed(axis if sure > SURE else body.mean(name, body.hip_line), up)
    toes = unit(toes)
    beside = unit(np.cross(up, toes))
    if sure > SURE:
        # Of a foot that stands on its edge only the knee says what is level.
        by_knee = _beside(axis, toes)
        between = FLAT_DEG < angle_deg(by_knee, beside) < EDGE_DEG
        beside = unit(by_knee + beside) if between else by_knee
    usual_deg = BALL_DEG if has_toes else TIP_DEG
    seen_deg = float(np.degrees(np.arcsin(np.clip(-unit(up) @ toes, -1.0, 1.0))))
    seen_deg = float(np.clip(seen_deg, 0.0, 2.0 * usual_deg))
    down = np.radians(USUAL_PART * usual_deg + (1.0 - USUAL_PART) * seen_deg)
    above = np.cross(toes, beside)
    level = unit(toes * np.cos(down) + above * np.sin(down))
    return quaternion.conjugate(quaternion.from_frames(beside, np.cross(level, beside)))


def _sole_up(body: Captured, name: str) -> FloatArray:
    """Up (3,) in a foot's bone, as it has it most often while the foot is slow."""
    places = body.start(name)
    tips = places + quaternion.rotate(body.rotations[:, body.segments[name]], body.tips[name])
    slow = np.zeros(len(places))
    for points in (places, tips):
        speeds = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)
        slow += speeds / max(float(np.median(speeds)), 1e-9)
    stances = np.argsort(slow)[: max(1, len(slow) // SLOW_PART)]
    stances = stances[:: max(1, len(stances) // MOST_STANCES)]
    ups = body.within(name, body.up)[stances]
    near = ups @ ups.T > np.cos(np.radians(FLAT_DEG))
    mean: FloatArray = ups[near[int(near.sum(axis=1).argmax())]].mean(axis=0)
    for _ in range(SETTLES):
        # Of several frames that are as good, any leads to the same mean.
        mean = ups[ups @ unit(mean) > np.cos(np.radians(FLAT_DEG))].mean(axis=0)
    return mean


def _toes_ahead(turn: FloatArray, tip: FloatArray) -> FloatArray:
    """Turn of a foot of a standing body whose toes point a little aside."""
    way = quaternion.rotate(turn, tip)
    yaw = float(np.arctan2(way[0], way[2]))
    if np.hypot(way[0], way[2]) < 0.3 * np.linalg.norm(way) or abs(np.degrees(yaw)) > ASKEW_DEG:
        return turn
    return quaternion.multiply(quaternion.from_axis_angle(Y, -yaw), turn)


def _framed(across: FloatArray, up: FloatArray) -> FloatArray:
    """Turn that takes a line to +X and what is up, nearly, to +Y."""
    return quaternion.conjugate(quaternion.from_frames(unit(across), _beside(up, across)))


def _beside(vector: FloatArray, axis: FloatArray) -> FloatArray:
    """Unit part of a vector at right angles to an axis; any such direction where it has none."""
    axis = unit(axis)
    for candidate in (vector, Z, X):
        part = candidate - axis * (candidate @ axis)
        if np.linalg.norm(part) > 1e-6:
            return unit(part)
    return X
