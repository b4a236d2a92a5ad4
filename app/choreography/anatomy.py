"""Finds the T-pose of a captured skeleton in the frames of its motion.

The zero pose of a motion file need not be a standing body, since programs choose any axes for bones. But some
directions are fixed in a bone whatever its axes are: towards the next joint, between the hip joints or the shoulders,
the axis about which a knee or an elbow bends, and the up direction of a standing foot. These determine how each bone is
rotated in the T-pose, so that a motion gives the same result on any rig. Rotations that nothing in the motion
determines follow from the usual human posture, applied to the mean of the motion.

The twist of a limb is that of its hinge, as in `app.rig.characters.t_pose`.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_check import LEVEL, SURE
from app.choreography.captured_joints import ARM, LEG, SIDES, Captured, X, Y, Z, angle_deg, middle, unit
from app.rig import quaternion

LEANS_DEG: Final = {"hips": -3.0, "spine": -2.0, "chest": 2.0}
"""Forward lean in degrees of the trunk's bones in a standing body: the mean of rigs with a standing zero pose (CMU,
Mixamo, MakeHuman).
"""
MOST_LEAN_DEG: Final = 20.0
"""Greatest mean angle in degrees from upright of a line along the trunk."""
EYES_DEG: Final = 45.0
"""Angle between upright and the way from the head's joint to between the eyes."""
BALL_DEG: Final = 25.0
TIP_DEG: Final = 16.0
"""Usual downward angle in degrees from ankle to ball and toes in standing zero poses."""
USUAL_PART: Final = 0.65
"""Weight of the usual angle against the observed one of a standing foot, since soles are not flat and heels rise."""
THUMB_DEG: Final = 15.0
"""Angle in degrees of a thumb below the plane of the palm in a T-pose."""
PRONATED_DEG: Final = 10.0
"""Turn of the palm, thumb inwards, from where the elbow's axis has it, in the mean of a motion
(of 250 arms of 7 makers; standard deviation 18)."""
WRIST_BACK_DEG: Final = 10.0
"""Mean bend of the wrist in degrees, the back of the hand towards the arm, in the same 250 arms; standard
deviation 10.
"""
SLOW_PART: Final = 3
"""Divisor of the number of frames: the slowest frames, in which a foot counts as standing."""
FLAT_DEG: Final = 8.0
"""Angle in degrees within which a foot is flat in most of these frames."""
SETTLES: Final = 10
"""Iterations of averaging the frames with a flat foot."""
MOST_STANCES: Final = 400
EDGE_DEG: Final = 20.0
"""Sideways angle in degrees within which soles agree with the knee's hinge."""


def t_pose(body: Captured) -> dict[str, FloatArray]:
    """Rotation (4,) of each segment's bone in the T-pose, by segment name."""
    found = _trunk(body)
    for side, sign in SIDES:
        leg, arm = ([side + name for name in limb] for limb in (LEG, ARM))
        found[leg[2]] = _foot(body, side)
        found |= _limb(body, leg, sign, _ways(body, leg[2], found[leg[2]], X) if body.tips[leg[2]].any() else None)
        palm = _palm(body, side, sign)
        elbow = quaternion.rotate(quaternion.from_axis_angle(X, -np.radians(PRONATED_DEG)), Y)
        found |= _limb(body, arm, sign, None if palm is None else _ways(body, arm[2], palm, elbow))
        if palm is not None and _turns_palm(body, arm, sign, palm):
            along = body.mean(arm[1], body.at(arm[2]) - body.at(arm[1]))
            found[arm[1]] = _limb_frame(along, body.mean(arm[1], _ways(body, arm[2], palm, Y)), False, sign)
        found[arm[2]] = _hand(body, side, sign, found[arm[1]]) if palm is None else palm
    return {name: found[name] for name in SEGMENTS}


def _ways(body: Captured, name: str, turn: FloatArray, way: FloatArray) -> FloatArray:
    """World directions (F, 3), over the motion, of a direction ``way`` (3,) that is given in the T-pose of a body
    segment; ``turn`` is the rotation of the segment's bone in the T-pose.
    """
    return quaternion.rotate(
        quaternion.multiply(body.rotations[:, body.segments[name]], quaternion.conjugate(turn)), way
    )


def _trunk(body: Captured) -> dict[str, FloatArray]:
    lines = {"hips": body.hip_line, "spine": unit(body.hip_line) + unit(body.shoulder_line)}
    lines["chest"] = body.shoulder_line
    nexts = {"hips": body.at("spine") if "spine" in body.joints else body.start("chest"), "chest": body.at("head")}
    nexts["spine"] = body.start("chest")
    found = {}
    across = {name: body.mean(name, line) for name, line in lines.items()}
    for name in lines:
        found[name] = _column(body, name, across[name], nexts[name] - body.start(name))
    if body.segments["spine"] in (body.segments["hips"], body.segments["chest"]):
        same = "hips" if body.segments["spine"] == body.segments["hips"] else "chest"
        found["spine"] = found[same]
    found["head"] = _head(body, found["chest"])
    return found


def _column(body: Captured, name: str, across: FloatArray, ways: FloatArray) -> FloatArray:
    """T-pose rotation (4,) of a part of the trunk in its bone's axes: X along the line ``across`` (between hips or
    shoulders), made horizontal, and the next joint at the usual lean `LEANS_DEG`.
    """
    upright = middle(body.within(name, body.up)[body.standing])
    if name != "hips":
        # The mean direction of the trunk is used, not the vertical: a runner leans forward all the time.
        upright = body.mean(name, body.top - body.start("hips"))
    along = body.mean(name, ways) if np.linalg.norm(ways, axis=1).min() > 1e-6 else upright
    plain = _framed(across, upright)
    way = quaternion.rotate(plain, along) * (0.0, 1.0, 1.0)
    lean_deg = float(np.degrees(np.arctan2(way[2], way[1])))
    if abs(lean_deg - LEANS_DEG[name]) > MOST_LEAN_DEG:
        return plain
    # A positive rotation about X leans forward.
    return quaternion.multiply(quaternion.from_axis_angle(X, np.radians(LEANS_DEG[name] - lean_deg)), plain)


def _head(body: Captured, chest: FloatArray) -> FloatArray:
    """T-pose rotation (4,) of the head in its bone's axes, such that the eyes are level and look ahead: found from the
    eyes' positions, from a T-pose in the clip, or from the usual posture during the motion.
    """
    if {"leftEye", "rightEye"} <= body.joints.keys():
        left, right = body.at("leftEye"), body.at("rightEye")
        level = _framed(body.mean("head", left - right), body.mean("head", 0.5 * (left + right) - body.at("head")))
        return quaternion.multiply(quaternion.from_axis_angle(X, np.radians(EYES_DEG)), level)
    lines = unit(body.shoulder_line * LEVEL) + unit(body.hip_line * LEVEL)
    if len(body.posed):
        shown = (body.within("head", ways)[body.posed].mean(axis=0) for ways in (lines, body.up))
        return _framed(*shown)
    upright = unit(middle(body.within("head", body.up)[body.standing]))
    upright = upright + unit(middle(body.within("head", _ways(body, "chest", chest, Y))))
    crown = body.tips["head"]
    if np.linalg.norm(crown) and angle_deg(crown, upright) < MOST_LEAN_DEG:
        upright = crown
    across = middle(body.within("head", lines))
    return _framed(_beside(across, upright), upright)


def _limb(body: Captured, limb: list[str], sign: float, known: FloatArray | None) -> dict[str, FloatArray]:
    """Find the T-pose rotations (4,) of the bones of the upper and the lower part of a limb, by segment name.

    Parameters
    ----------
    known : (F, 3) float64, optional
        Axis of the knee or elbow in the world as the foot or hand suggests it, used for a limb that never bends.
    """
    leg = limb[0].endswith("Leg")
    bend = body.bend(limb, sign)
    ahead = np.cross(unit(body.shoulder_line), body.up)
    found = {}
    for segment, start, end in ((limb[0], limb[0], limb[1]), (limb[1], limb[1], limb[2])):
        way = body.mean(segment, body.at(end) - body.at(start))
        axis, sure = body.hinge(segment, bend)
        if segment.endswith("LowerArm"):
            # A forearm may pronate, so no bend axis is fixed in it; the mean axis is its usual orientation.
            sure = body.bent(bend)
        if known is not None:
            usual = body.mean(segment, known)
        elif leg:
            usual = body.mean(segment, body.hip_line)
        else:
            usual = np.cross(body.mean(segment, ahead), sign * way)
        by_hinge, by_usual = (_limb_frame(way, side, leg, sign) for side in (axis, usual))
        target = -Y if leg else sign * X
        angle = quaternion.twist_angle(quaternion.multiply(by_hinge, quaternion.conjugate(by_usual)), target)
        found[segment] = quaternion.multiply(quaternion.from_axis_angle(target, float(angle) * sure), by_usual)
    return found


def _turns_palm(body: Captured, arm: list[str], sign: float, palm: FloatArray) -> bool:
    """Return whether a forearm's bone rotates together with the palm: the hand's axes are more constant in that bone
    than the elbow's axis is.
    """
    bend = body.bend(arm, sign)
    return body.axis(arm[1], _ways(body, arm[2], palm, Y))[1] > body.axis(arm[1], bend)[1]


def _limb_frame(way: FloatArray, across: FloatArray, leg: bool, sign: float) -> FloatArray:
    if leg:
        return quaternion.conjugate(quaternion.from_frames(_beside(across, way), -unit(way)))
    return quaternion.conjugate(quaternion.from_frames(sign * unit(way), _beside(across, way)))


def _along(body: Captured, side: str) -> FloatArray:
    """Direction (3,) of the fingers in the axes of a hand's bone: towards a knuckle or the hand's end, else the
    forearm's mean direction.
    """
    name, knuckles = f"{side}Hand", body.knuckles(side)
    if knuckles:
        return body.mean(name, knuckles[min(1, len(knuckles) - 1)] - body.at(name))
    if np.linalg.norm(body.tips[name]) > 1e-9:
        return body.tips[name]
    return body.mean(name, body.at(name) - body.at(f"{side}LowerArm"))


def _palm(body: Captured, side: str, sign: float) -> FloatArray | None:
    """T-pose rotation (4,) of a hand in its bone's axes (fingers along the arm, palm down), found from knuckles or
    thumb; None if the file has neither. ``sign`` is 1 for the left hand, -1 for the right.
    """
    name, knuckles, along = f"{side}Hand", body.knuckles(side), _along(body, side)
    if len(knuckles) > 1:
        ahead = body.mean(name, knuckles[0] - knuckles[-1])
        up = np.cross(ahead, sign * along)
    elif np.linalg.norm(thumb := body.mean(name, body.thumbs[name])) > 0.5:
        ahead = _beside(thumb, along)
        up = np.cross(ahead, sign * unit(along))
        # The thumb lies below the plane of the palm.
        up = up * np.cos(np.radians(THUMB_DEG)) - ahead * np.sin(np.radians(THUMB_DEG))
    else:
        return None
    return quaternion.conjugate(quaternion.from_frames(sign * unit(along), _beside(up, along)))


def _hand(body: Captured, side: str, sign: float, forearm: FloatArray) -> FloatArray:
    """Find the T-pose rotation (4,) of a hand whose palm direction is unknown: from a T-pose in the clip, else from the
    mean axis of the elbow.

    Parameters
    ----------
    forearm : ndarray, shape (4,)
        T-pose rotation of the forearm's bone.
    """
    name, along = f"{side}Hand", _along(body, side)
    limb = [side + part for part in ARM]
    if len(body.posed):
        up = body.within(name, body.up)[body.posed].mean(axis=0)
        return quaternion.conjugate(quaternion.from_frames(sign * unit(along), _beside(up, along)))
    bend = body.bend(limb, sign)
    sure = body.bent(bend)
    seen = body.mean(name, _ways(body, limb[1], forearm, Y))
    elbow = sure * unit(body.axis(name, bend)[0]) + (1.0 - sure) * unit(seen)
    turn = quaternion.conjugate(quaternion.from_frames(sign * unit(along), _beside(elbow, along)))
    turn = quaternion.multiply(quaternion.from_axis_angle(X, -np.radians(PRONATED_DEG)), turn)
    if body.tips[name].any():
        return turn
    return quaternion.multiply(quaternion.from_axis_angle(sign * Z, -np.radians(WRIST_BACK_DEG)), turn)


def _foot(body: Captured, side: str) -> FloatArray:
    """T-pose rotation (4,) of a foot in its bone's axes: toes forward, sideways as the knee's hinge, the sole about
    horizontal when standing.
    """
    name = f"{side}Foot"
    has_toes = body.has_toes(side)
    toes = body.mean(name, body.at(f"{side}Toes") - body.at(name)) if has_toes else body.tips[name]
    bend = body.bend([side + part for part in LEG], 1.0)
    far = np.linalg.norm(bend, axis=1)
    # The ankle rotates too, so the mean over the frames with the clearest knee axis is used.
    axis = middle(unit(body.within(name, bend))[far >= np.median(far)])
    sure = body.hinge(name, bend)[1]
    up = _sole_up(body, name)
    if not np.linalg.norm(toes):
        return _framed(axis if sure > SURE else body.mean(name, body.hip_line), up)
    toes = unit(toes)
    beside = unit(np.cross(up, toes))
    if sure > SURE:
        # For a foot that stands on its edge only the knee axis shows which direction is level.
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
    """Most frequent up direction (3,) of the world in the axes of a foot's bone while the foot moves slowly."""
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
        # Starting from any of several equally good frames leads to the same mean.
        mean = ups[ups @ unit(mean) > np.cos(np.radians(FLAT_DEG))].mean(axis=0)
    return mean


def _framed(across: FloatArray, up: FloatArray) -> FloatArray:
    """Return the rotation (4,) that takes the direction ``across`` to +X and ``up`` approximately to +Y."""
    return quaternion.conjugate(quaternion.from_frames(unit(across), _beside(up, across)))


def _beside(vector: FloatArray, axis: FloatArray) -> FloatArray:
    """Unit vector (3,) of the component of ``vector`` orthogonal to ``axis``; any orthogonal direction if there is
    none.
    """
    axis = unit(axis)
    for candidate in (vector, Z, X):
        part = candidate - axis * (candidate @ axis)
        if np.linalg.norm(part) > 1e-6:
            return unit(part)
    return X
