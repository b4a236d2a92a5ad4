"""Check of a captured body's T-pose for implausible angles and bones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.captured_joints import ARM, LEG, SIDES, Captured, X, Y, Z, angle_deg, unit
from app.errors import Message
from app.rig import quaternion

SURE: Final = 0.5
"""Least reliability of a hinge to be considered."""
MOST_DEG: Final = {"hips": 5.0, "shoulders": 5.0, "spine": 35.0, "knees": 45.0, "elbows": 80.0, "toes": 45.0}
"""Greatest angles in degrees in the T-pose between the lines of hips and shoulders and +X, the trunk and +Y, knees and
toes and the forward direction.
"""
MOST_TURNED_DEG: Final = {"shoulders": 60.0, "knees": 75.0, "toes": 75.0}
"""Greatest same angles in degrees in the mean of the motion, relative to the hips."""
MOST_LYING_DEG: Final = 60.0
"""Greatest angle in degrees from straight down at which both legs and arms are in half of the motion, from hips to feet
and from shoulders to hands: at most 17 in 112 captures of people, 85 in those of animals on four legs, along whose
trunks their heads are farthest from their feet.
"""
LEVEL: Final = np.array([1.0, 0.0, 1.0])
UNLIKE: Final = 0.4
"""Least length of a part of a limb relative to the other part."""
CHANGES: Final = 0.4
"""Greatest relative change of a part's length."""


@dataclass(frozen=True)
class Checked:
    """An angle of a captured body's T-pose, with its limit.

    Attributes
    ----------
    kind : str
        Key of `MOST_DEG`.
    joint : str
        VRM 1.0 joint.
    """

    kind: str
    joint: str
    off_deg: float

    most_deg: float

    @property
    def wrong(self) -> bool:
        """True if the angle exceeds the limit."""
        return self.off_deg > self.most_deg


def checked(body: Captured, turns: Mapping[str, FloatArray]) -> tuple[Checked, ...]:
    """Measure angles of a body's T-pose with their limits: lines that should be level, an upright trunk, and knees,
    elbows and toes that point forward.

    Parameters
    ----------
    turns : mapping of str to ndarray, shape (4,)
        Rotation of each segment's bone in the T-pose.
    """
    found = []

    def off(kind: str, joint: str, way: FloatArray, target: FloatArray, limits: Mapping[str, float] = MOST_DEG) -> None:
        if np.linalg.norm(way):
            found.append(Checked(kind, joint, angle_deg(way, target), limits[kind]))

    def turned(segment: str, ways: FloatArray) -> FloatArray:
        return quaternion.rotate(turns[segment], body.within(segment, ways).mean(axis=0))

    off("hips", "hips", turned("hips", body.hip_line), X)
    off("shoulders", "chest", turned("chest", body.shoulder_line), X)
    trunk = ("hips", "spine", "chest")
    ways = pairwise([*map(body.start, trunk), body.top])
    column = [turned(name, end - start) for name, (start, end) in zip(trunk, ways, strict=True)]
    off("spine", "spine", np.sum(column, axis=0), Y)
    off("shoulders", "chest", turned("hips", unit(body.shoulder_line)), X, MOST_TURNED_DEG)
    found.append(Checked("spine", "hips", _lying_deg(body), MOST_LYING_DEG))
    for side, sign in SIDES:
        for kind, limb, ahead in (("knees", LEG, X), ("elbows", ARM, Y)):
            bend = body.bend([side + name for name in limb], sign)
            for segment in limb[:2]:
                axis, sure = body.hinge(side + segment, bend)
                if sure > SURE:
                    off(kind, side + segment, quaternion.rotate(turns[side + segment], axis), ahead)
            if kind == "knees" and sure > SURE:
                off(kind, f"{side}LowerLeg", turned("hips", bend), X, MOST_TURNED_DEG)
        foot = f"{side}Foot"
        off("toes", foot, quaternion.rotate(turns[foot], body.tips[foot]) * LEVEL, Z)
        # The axes across and above the foot are compared: a runner's toes point down and back half of the time.
        own = quaternion.multiply(body.rotations[:, body.segments[foot]], quaternion.conjugate(turns[foot]))
        off("toes", foot, turned("hips", quaternion.rotate(own, X) * LEVEL) * LEVEL, X, MOST_TURNED_DEG)
        off("toes", foot, turned("hips", quaternion.rotate(own, Y)), Y, MOST_TURNED_DEG)
    return tuple(found)


def _lying_deg(body: Captured) -> float:
    """Angle in degrees from straight down that legs or arms, whichever is less, have in half of the motion."""
    angles = []
    for limb in (LEG, ARM):
        ways = np.sum([body.at(side + limb[2]) - body.at(side + limb[0]) for side, _ in SIDES], axis=0)
        angles.append(float(np.degrees(np.median(np.arccos(np.clip(-unit(ways)[:, 1], -1.0, 1.0))))))
    return min(angles)


def unlike(body: Captured, parents: Sequence[int]) -> tuple[str, ...]:
    """Return the joints that do not form proper limbs: a bone much shorter or longer than the one of the other side, of
    changing length, or attached to the other side's limb.

    Parameters
    ----------
    parents : sequence of int
        Parent of each bone, -1 for none.
    """
    wrong = []
    for side, other in (("left", "right"), ("right", "left")):
        for limb in (LEG, ARM):
            parts = np.linalg.norm(np.diff([body.at(side + name) for name in limb], axis=0), axis=2)
            short, long = sorted(np.median(parts, axis=1))
            if short <= UNLIKE * long:
                wrong.append(side + limb[1])
            theirs = {body.joints[other + name] for name in limb}
            for part, name in zip(parts, limb[1:], strict=True):
                changes = np.ptp(np.percentile(part, (5.0, 95.0))) > CHANGES * np.median(part)
                if changes or theirs & _above(parents, body.joints[side + name]):
                    wrong.append(side + name)
    return tuple(dict.fromkeys(wrong))


def _above(parents: Sequence[int], bone: int) -> set[int]:
    found = set()
    while (bone := parents[bone]) >= 0:
        found.add(bone)
    return found


def report(found: Sequence[Checked]) -> Message:
    """Return a message about the exceeded limits of a T-pose, with the largest angle of each kind."""
    most = dict.fromkeys(MOST_DEG, 0.0)
    for one in found:
        if one.most_deg == MOST_DEG[one.kind]:
            most[one.kind] = max(most[one.kind], one.off_deg)
    return Message("motion.checked", {kind: round(off_deg) for kind, off_deg in most.items()})
