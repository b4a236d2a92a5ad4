"""Joints of a captured body with unknown bone names, found by the lengths of bones, which are independent of poses.

Limbs are the two pairs of similar branches without large branches of their own; the pair with longer bones are the
legs. A limb's two parts are the two consecutive bones of greatest length. Sides are arbitrary here:
`app.choreography.sides` finds them in the motion.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.rig.characters.joints_by_shape import Tree, fingers, spread_spine, tree_of

POSES: Final = 25
"""Number of examined poses, evenly over the motion."""
ALIKE: Final = 0.12
"""Relative difference of lengths below which branches are similar."""
SIDE_BRANCH: Final = 0.4
"""Length relative to a limb below which branches are fingers, toes and heels."""
PARTS_ALIKE: Final = 0.5
"""Least ratio of the shorter part of a limb to the longer."""
LIMB_PART: Final = 0.5
"""Least share of a limb that its two parts take; otherwise bones are split."""
AS_LONG: Final = 0.95
"""Least length of two consecutive bones relative to the longest two at which they may be the limb's parts: of these the
outermost are, since a collar bone may be as long as a forearm.
"""
ASIDE_RAD: Final = 0.25
"""Difference of the mean angles between the forearm and both branches of a hand from which the one farther aside is the
thumb, radians.
"""
STRAIGHT: Final = 0.03
"""Sine of the bend up to which a joint is within a bone."""


@dataclass(frozen=True)
class _Limb:
    """An arm or leg found by lengths: its first joint on the trunk (``root``), the ``path`` of joints to its end, the
    three joints that bound its two parts, and its length.
    """

    root: int
    path: tuple[int, ...]
    joints: tuple[int, int, int]
    length: float


def joints_by_lengths(
    parents: Sequence[int],
    positions: FloatArray,
    end_lengths: Mapping[int, float],
    turning: Collection[int] = (),
) -> dict[str, int]:
    """Find the bones of a humanoid body by their lengths, by VRM 1.0 joint; empty if there is none.

    Parameters
    ----------
    positions : ndarray, shape (F, J, 3)
        Joints in the world.
    end_lengths : mapping of int to float
        Length of the bones without a child joint, by joint.
    turning : collection of int
        Joints that rotate: the last one above the neck is then a head and not a crown.
    """
    frames = np.linspace(0, len(positions) - 1, min(POSES, len(positions))).round().astype(int)
    poses = positions[frames]
    tree = tree_of(parents, poses[0], frozenset())
    return _Body(tree, poses, end_lengths, turning).joints()


class _Body:
    """A tree of bones with their lengths, in which the joints of a humanoid body are searched."""

    def __init__(
        self, tree: Tree, poses: FloatArray, end_lengths: Mapping[int, float], turning: Collection[int]
    ) -> None:
        self._tree, self._poses, self._turning = tree, poses, turning
        above = np.maximum(tree.parents, 0)
        self._bone = np.median(np.linalg.norm(poses - poses[:, above], axis=2), axis=0)
        self._reach = np.zeros(len(tree.parents))
        """Length of the longest chain from each joint to an end."""
        for joint in range(len(tree.parents) - 1, -1, -1):
            ways = [self._bone[child] + self._reach[child] for child in tree.children[joint]]
            self._reach[joint] = max([*ways, end_lengths.get(joint, 0.0)])

    def joints(self) -> dict[str, int]:
        pairs = [pair for joint in range(len(self._tree.parents)) if (pair := self._pair(joint)) is not None]
        pairs.sort(key=lambda pair: pair[0].length + pair[1].length)
        if len(pairs) < 2:
            return {}
        longest = pairs[-2:]
        arms, legs = sorted(longest, key=lambda pair: sum(self._parts(limb) for limb in pair))
        hips, chest = legs[0].root, arms[0].root
        head = self._head(chest, {arms[0].path[0], arms[1].path[0]}, hips)
        if hips == chest or not head:
            return {}
        found = {"hips": hips, "head": head[-1]} | ({"neck": head[0]} if len(head) > 1 else {})
        if hips in self._tree.above[chest]:
            found |= spread_spine(self._tree, self._tree.path(hips, chest))
        for side, leg, arm in zip(("left", "right"), legs, arms, strict=True):
            found |= self._named(leg, [f"{side}{part}" for part in ("", "UpperLeg", "LowerLeg", "Foot", "Toes")])
            found |= self._named(arm, [f"{side}{part}" for part in ("Shoulder", "UpperArm", "LowerArm", "Hand", "")])
            found |= fingers(self._tree, side, arm.joints[2]) or self._thumb(side, arm)
        children = self._tree.children[head[-1]]
        if len(children) == 2 and not any(self._tree.children[eye] for eye in children) and self._alike(*children):
            found |= dict(zip(("leftEye", "rightEye"), children, strict=True))
        return found

    def _thumb(self, side: str, arm: _Limb) -> dict[str, int]:
        """Return the thumb of a hand that has one bone for it and one for all fingers, which go on from the forearm."""
        elbow, wrist = arm.joints[1:]
        branches = self._tree.children[wrist]
        if len(branches) != 2:
            return {}
        ahead, *ways = (
            self._poses[:, to] - self._poses[:, at] for at, to in ((elbow, wrist), *((wrist, one) for one in branches))
        )
        aside_rad = [float(np.mean(_angle_rad(ahead, way))) for way in ways]
        near, far = sorted(range(2), key=lambda at: aside_rad[at])
        return {f"{side}ThumbMetacarpal": branches[far]} if aside_rad[far] - aside_rad[near] > ASIDE_RAD else {}

    def _pair(self, joint: int) -> tuple[_Limb, _Limb] | None:
        """Return the two longest branches of a joint that are similar limbs."""
        limbs = [limb for child in self._tree.children[joint] if (limb := self._limb(joint, child)) is not None]
        alike = [pair for pair in combinations(limbs, 2) if self._alike(*(limb.path[0] for limb in pair))]
        return max(alike, key=lambda pair: pair[0].length + pair[1].length, default=None)

    def _alike(self, one: int, other: int) -> bool:
        lengths = sorted(float(self._bone[child] + self._reach[child]) for child in (one, other))
        return lengths[1] - lengths[0] <= ALIKE * lengths[1]

    def _limb(self, root: int, child: int) -> _Limb | None:
        whole = float(self._bone[child] + self._reach[child])
        path = [child]
        while self._tree.children[path[-1]]:
            first, *others = sorted(
                self._tree.children[path[-1]], key=lambda one: self._bone[one] + self._reach[one], reverse=True
            )
            if any(self._bone[one] + self._reach[one] > SIDE_BRANCH * whole for one in others):
                return None
            path.append(first)
        parts = self._longest_parts(path)
        if parts is None or self._sum(parts) < LIMB_PART * self._reach[child]:
            parts = self._longest_parts(self._unsplit(path)) or parts
        return None if parts is None else _Limb(root, tuple(path), parts, whole)

    def _longest_parts(self, path: Sequence[int]) -> tuple[int, int, int] | None:
        found = []
        for start, middle, end in zip(path, path[1:], path[2:], strict=False):
            short, long = sorted((self._apart(start, middle), self._apart(middle, end)))
            if short > PARTS_ALIKE * long:
                found.append((start, middle, end))
        longest = max(map(self._sum, found), default=0.0)
        return next((parts for parts in reversed(found) if self._sum(parts) >= AS_LONG * longest), None)

    def _sum(self, parts: tuple[int, int, int]) -> float:
        return self._apart(parts[0], parts[1]) + self._apart(parts[1], parts[2])

    def _parts(self, limb: _Limb) -> float:
        return self._sum(limb.joints)

    def _apart(self, one: int, other: int) -> float:
        return float(np.median(np.linalg.norm(self._poses[:, one] - self._poses[:, other], axis=1)))

    def _unsplit(self, path: Sequence[int]) -> list[int]:
        """Remove from a path the joints at which it never bends."""
        kept = [path[0]]
        for joint, after in pairwise(path[1:]):
            before, behind = (self._poses[:, one] - self._poses[:, joint] for one in (kept[-1], after))
            sizes = np.linalg.norm(before, axis=1) * np.linalg.norm(behind, axis=1)
            if (np.linalg.norm(np.cross(before, behind), axis=1) > STRAIGHT * sizes).any():
                kept.append(joint)
        return [*kept, path[-1]]

    def _named(self, limb: _Limb, names: Sequence[str]) -> dict[str, int]:
        """Assign names to the joints of a limb; the first and last name are for the joints before and after it, empty
        if not needed.
        """
        before = limb.path[: limb.path.index(limb.joints[0])]
        behind = limb.path[limb.path.index(limb.joints[2]) + 1 :]
        joints = [before[-1] if before else None, *limb.joints, behind[0] if behind else None]
        return {
            name: joint
            for name, joint in zip(names, joints, strict=True)
            if joint is not None and name not in ("", "left", "right")
        }

    def _head(self, chest: int, arms: set[int], hips: int) -> list[int]:
        """Return the joints from the chest to the head. The head is the last joint that has something beyond it or that
        rotates.
        """
        children = [one for one in self._tree.children[chest] if one not in arms and one not in self._tree.above[hips]]
        if hips not in self._tree.above[chest]:
            children = [one for one in children if one != hips]
        path: list[int] = []
        while len(children) == 1 or (children and not path):
            path.append(max(children, key=lambda one: float(self._bone[one] + self._reach[one])))
            children = list(self._tree.children[path[-1]])
        if len(path) > 1 and not children and not self._reach[path[-1]] and path[-1] not in self._turning:
            path.pop()  # the crown, present in files without end sites
        return path


def _angle_rad(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the angles (F,) between vectors (F, 3) in radians."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.sum(one * other, axis=1)))
