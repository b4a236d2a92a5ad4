"""Left and right of a captured body, determined by the bend of knees and the direction of toes instead of names."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.captured_joints import LEG, SIDES, Captured, unit
from app.rig import quaternion

CLEARLY: Final = 0.3
"""Sum of the backward directions of knees and toes (each at most 1) above which legs are exchanged against their
names.
"""


SIDE_WORDS: Final = (("left", "right"), ("l", "r"), ("links", "rechts"), ("左", "右"))
LEGS: Final = ("UpperLeg", "LowerLeg", "Foot", "Toes")
ARMS: Final = ("Shoulder", "Arm", "Hand", "Thumb", "Index", "Middle", "Ring", "Little")


def joints_by_side(body: Captured, named: bool, kept: Collection[str] = ()) -> dict[str, int]:
    """Assign left and right to joints by the motion, exchanging them where names or order have them wrong.

    Legs are exchanged if knees would bend backwards and toes point back; arms and eyes if their line is opposite to
    that of the hips.

    Parameters
    ----------
    named : bool
        Whether sides are known from names; then knees and toes must agree that these are wrong.
    kept : collection of str
        Joints that the user corrected: legs, arms or eyes including one of them keep their sides.
    """
    joints = dict(body.joints)
    hips = unit(body.hip_line)
    knees, toes = _knees_ahead(body), _toes_ahead(body)
    back = (max(knees, toes) <= 0.0 and knees + toes < -CLEARLY) if named else knees + toes < 0.0
    if back and not _any_of(kept, LEGS):
        joints = exchanged(joints, LEGS)
        hips = -hips
    lines: list[tuple[FloatArray, tuple[str, ...]]] = [(body.shoulder_line, ARMS)]
    if {"leftEye", "rightEye"} <= joints.keys():
        lines.append((body.at("leftEye") - body.at("rightEye"), ("Eye",)))
    for line, names in lines:
        if not _any_of(kept, names) and float(np.einsum("fi,fi->f", unit(line), hips).mean()) < 0.0:
            joints = exchanged(joints, names)
    return joints


def _any_of(joints: Collection[str], names: Sequence[str]) -> bool:
    return any(name in joint for joint in joints for name in names)


def _knees_ahead(body: Captured) -> float:
    """Return the certainty that the knees bend in the correct direction, 1, or in the opposite one, -1; 0
    if unknown.
    """
    hips, found = unit(body.hip_line), []
    for side, sign in SIDES:
        bend = body.bend([side + name for name in LEG], sign)
        size = float(np.linalg.norm(bend, axis=1).sum())
        found.append(body.bent(bend) * float(np.einsum("fi,fi->f", bend, hips).sum()) / max(size, 1e-12))
    return sum(found) / len(found)


def _toes_ahead(body: Captured) -> float:
    """Return the mean cosine between the toes and the hips' forward direction; 0 if the feet have no ends."""
    ahead, found = np.cross(unit(body.hip_line), body.up), []
    for side, _ in SIDES:
        name = f"{side}Foot"
        toes = quaternion.rotate(body.rotations[:, body.segments[name]], body.tips[name])
        found.append(float(np.einsum("fi,fi->f", unit(toes * (1.0, 0.0, 1.0)), ahead).mean()))
    return sum(found) / len(found)


def exchanged(joints: Mapping[str, int], names: Sequence[str] = ("",)) -> dict[str, int]:
    """Exchange the bones of left and right joints, only for joints whose names contain one of the given texts."""
    other = {"left": "right", "right": "left"}
    found = {}
    for joint, bone in joints.items():
        side = next((side for side in other if joint.startswith(side)), "")
        turned = side != "" and any(name in joint for name in names)
        found[other[side] + joint[len(side) :] if turned else joint] = bone
    return found


def called_after_the_other_side(joints: Mapping[str, int], names: Sequence[str]) -> tuple[str, ...]:
    """Return the upper arms and legs whose bones are named after the other side.

    Parameters
    ----------
    names : sequence of str
        Names of all bones of the file.
    """
    found = []
    for part in ("UpperArm", "UpperLeg"):
        left, right = (f"{side}{part}" for side in ("left", "right"))
        if _says_left(names[joints[right]], names[joints[left]]):
            found += [left, right]
    return tuple(found)


def _says_left(name: str, other: str) -> bool:
    """Return whether ``name`` is that of a left bone and ``other`` that of its right counterpart."""
    name, other = name.lower(), other.lower()
    return any(
        name[:at] + right + name[at + len(left) :] == other
        for left, right in SIDE_WORDS
        for at in range(len(name))
        if name.startswith(left, at)
    )
