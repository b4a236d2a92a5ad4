"""Left and right of a captured body: knees bend back and toes point ahead, whatever names say."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.captured_joints import LEG, SIDES, Captured, unit
from app.rig import quaternion

CLEARLY: Final = 0.3
"""Knees and toes that together point back more than this exchange the legs that names say; each is 1 at most."""


SIDE_WORDS: Final = (("left", "right"), ("l", "r"), ("links", "rechts"), ("左", "右"))
LEGS: Final = ("UpperLeg", "LowerLeg", "Foot", "Toes")
ARMS: Final = ("Shoulder", "Arm", "Hand", "Thumb", "Index", "Middle", "Ring", "Little")


def joints_by_side(body: Captured, named: bool, kept: Collection[str] = ()) -> dict[str, int]:
    """Joints with the names left and right exchanged where the motion says so.

    Legs are exchanged if the knees would bend back and the toes point there; arms and eyes if their line runs against
    that of the hips.

    Parameters
    ----------
    named : bool
        True if names say the sides: then knees and toes must agree that they are wrong.
    kept : collection of str
        Joints that a user corrected: legs, arms or eyes of which one is corrected keep their sides.
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
    """Return how surely the knees bend as they would between these hips: 1, or -1 if the other way."""
    hips, found = unit(body.hip_line), []
    for side, sign in SIDES:
        bend = body.bend([side + name for name in LEG], sign)
        size = float(np.linalg.norm(bend, axis=1).sum())
        found.append(body.bent(bend) * float(np.einsum("fi,fi->f", bend, hips).sum()) / max(size, 1e-12))
    return sum(found) / len(found)


def _toes_ahead(body: Captured) -> float:
    """Cosine between the toes and ahead, as the hips have it, in the mean; 0 where the feet have no ends."""
    ahead, found = np.cross(unit(body.hip_line), body.up), []
    for side, _ in SIDES:
        name = f"{side}Foot"
        toes = quaternion.rotate(body.rotations[:, body.segments[name]], body.tips[name])
        found.append(float(np.einsum("fi,fi->f", unit(toes * (1.0, 0.0, 1.0)), ahead).mean()))
    return sum(found) / len(found)


def exchanged(joints: Mapping[str, int], names: Sequence[str] = ("",)) -> dict[str, int]:
    """Joints with left and right exchanged; of those only whose names hold one of these."""
    other = {"left": "right", "right": "left"}
    found = {}
    for joint, bone in joints.items():
        side = next((side for side in other if joint.startswith(side)), "")
        turned = side != "" and any(name in joint for name in names)
        found[other[side] + joint[len(side) :] if turned else joint] = bone
    return found


def called_after_the_other_side(joints: Mapping[str, int], names: Sequence[str]) -> tuple[str, ...]:
    """Upper arms and legs whose bones' names say that they are of the other side.

    Parameters
    ----------
    names : sequence of str
        Of all bones of the file.
    """
    found = []
    for part in ("UpperArm", "UpperLeg"):
        left, right = (f"{side}{part}" for side in ("left", "right"))
        if _says_left(names[joints[right]], names[joints[left]]):
            found += [left, right]
    return tuple(found)


def _says_left(name: str, other: str) -> bool:
    """Return whether a name is that of a left bone, and the other is its right one's."""
    name, other = name.lower(), other.lower()
    return any(
        name[:at] + right + name[at + len(left) :] == other
        for left, right in SIDE_WORDS
        for at in range(len(name))
        if name.startswith(left, at)
    )
