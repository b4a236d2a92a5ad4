"""Joints of a bundled body, moved to those of another body: positions in the rest pose, and rotations of
their frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import AnyIntArray, FloatArray, IndexArray, SingleArray
from app.identity_cache import IdentityCache
from app.rig.model import Character, Skeleton
from app.rig.skeleton import ancestors

SIDES = (("left", 1.0), ("right", -1.0))


@dataclass(frozen=True, eq=False)
class MovedJoints:
    """The J joints of a body in the rest pose, before and after they are moved.

    Attributes
    ----------
    before, after : (J, 4, 4) float64
        ``mesh_from_joint``.
    lengthened : (4, 3) float64
        Additional displacement of left elbow, left wrist, right elbow and right wrist, which keeps arms from becoming
        shorter.
    hands : float
        Size of the hands relative to those before.
    """

    before: FloatArray
    after: FloatArray
    lengthened: FloatArray
    hands: float = 1.0

    def turn(self, joint: int) -> FloatArray:
        """Return the rotation (3, 3) of a joint's frame from before to after."""
        turned: FloatArray = self.after[joint, :3, :3] @ self.before[joint, :3, :3].T
        return turned

    def rigidly(self, joint: int, points: FloatArray, size: float = 1.0) -> FloatArray:
        """Return points (N, 3) moved and rotated with a joint, and scaled about it by ``size``."""
        moved: FloatArray = size * (points - self.before[joint, :3, 3]) @ self.turn(joint).T + self.after[joint, :3, 3]
        return moved


def with_arms_to(moved: MovedJoints, skeleton: Skeleton, places_m: FloatArray) -> MovedJoints:
    """Return moved joints with elbows and wrists at those of another body whose joints are at ``places_m`` (J, 3)."""
    after, lengthened = moved.after.copy(), moved.lengthened.copy()
    for place, (side, _) in enumerate(SIDES):
        elbow, wrist = (skeleton.index(f"{side}{part}") for part in ("LowerArm", "Hand"))
        steps = places_m[[elbow, wrist]] - after[[elbow, wrist], :3, 3]
        lengthened[2 * place : 2 * place + 2] += steps
        after[elbow, :3, 3] += steps[0]
        for joint in range(len(skeleton.names)):
            if wrist in ancestors(skeleton, joint):
                after[joint, :3, 3] += steps[1]
    return replace(moved, after=after, lengthened=lengthened)


def moved_joints(original: Character, moved_m: Mapping[str, FloatArray], hands: float = 1.0) -> MovedJoints:
    """Move the joints of a body.

    Parameters
    ----------
    moved_m : mapping of str to (3,)
        Displacement of each joint outside the hands. Hands move with their wrists; other joints that are not named
        stay.
    hands : float
        Size of the hands relative to the body's. If it is 1, arms do not become shorter.
    """
    skeleton = original.skeleton
    before = np.linalg.inv(original.joint_from_mesh).astype(np.float64)
    after = before.copy()
    for name, step in moved_m.items():
        if name in skeleton.names:
            after[skeleton.index(name), :3, 3] += step
    lengthened = np.zeros((2 * len(SIDES), 3))
    if hands == 1.0:
        lengthened = np.concatenate([_lengthen(skeleton, before, after, side) for side, _ in SIDES])
    for side, sign in SIDES:
        for joint, (old, new) in _limb_frames(skeleton, before, after, side, sign).items():
            after[joint, :3, :3] = new @ old.T @ before[joint, :3, :3]
        wrist, elbow = skeleton.index(f"{side}Hand"), skeleton.index(f"{side}LowerArm")
        turn = after[elbow, :3, :3] @ before[elbow, :3, :3].T
        place = before[wrist, :3, 3]
        for joint in range(len(skeleton.names)):
            if wrist in ancestors(skeleton, joint):
                after[joint, :3, :3] = turn @ before[joint, :3, :3]
                after[joint, :3, 3] = after[wrist, :3, 3] + hands * turn @ (before[joint, :3, 3] - place)
    return MovedJoints(before, after, lengthened, hands)


def _lengthen(skeleton: Skeleton, before: FloatArray, after: FloatArray, side: str) -> FloatArray:
    """Move elbow and wrist outwards along an arm that became shorter, in ``after``; return their
    displacements (2, 3).
    """
    rows = [skeleton.index(f"{side}{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    lengths = np.linalg.norm(np.diff(before[rows, :3, 3], axis=0), axis=1)
    bones = np.diff(after[rows, :3, 3], axis=0)
    factors = np.maximum(lengths / np.linalg.norm(bones, axis=1), 1.0)
    steps: FloatArray = np.cumsum((factors - 1.0)[:, None] * bones, axis=0)
    after[rows[1:], :3, 3] += steps
    return steps


def arm_after_m(original: Character, moved_m: Mapping[str, FloatArray]) -> float:
    """Return the length in metres of the right upper and lower arm after its joints are moved (see `moved_joints`)."""
    skeleton = original.skeleton
    names = [f"right{part}" for part in ("UpperArm", "LowerArm", "Hand")]
    at = np.linalg.inv(original.joint_from_mesh[[skeleton.index(name) for name in names]])[:, :3, 3]
    lengths = [
        np.linalg.norm(np.diff(places, axis=0), axis=1) for places in (at, at + [moved_m[name] for name in names])
    ]
    return float(np.maximum(*lengths).sum())


def t_positions(skeleton: Skeleton, joints: FloatArray) -> FloatArray:
    """Return the positions (J, 3) of J joints in the T-pose from their frames (J, 4, 4) in the rest pose."""
    places = np.zeros((len(joints), 3))
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            step = joints[parent, :3, :3].T @ (joints[joint, :3, 3] - joints[parent, :3, 3])
            places[joint] = places[parent] + step
    return places


def _limb_frames(
    skeleton: Skeleton, before: FloatArray, after: FloatArray, side: str, sign: float
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Return frames (3, 3) along the bones of an arm and a leg, by joint index: before and after the joints
    are moved.
    """
    found: dict[int, tuple[FloatArray, FloatArray]] = {}
    names = [f"{side}{part}" for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")]
    rows = [skeleton.index(name) for name in names]
    frames = [_frames(places[rows, :3, 3], sign) for places in (before, after)]
    for place, joint in zip((0, 1, 3, 4, 5, 6), rows[:2] + rows[3:], strict=True):
        found[joint] = (frames[0][place], frames[1][place])
    return found


def _frames(places: FloatArray, sign: float) -> dict[int, FloatArray]:
    shoulder, elbow, wrist, hip, knee, ankle, toes = places
    hinge = np.cross(elbow - shoulder, wrist - elbow)
    foot = _frame((toes - ankle) * np.array([1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]))
    side = foot[:, 2]
    return {
        0: _frame(sign * (elbow - shoulder), -sign * hinge),
        1: _frame(sign * (wrist - elbow), -sign * hinge),
        3: _frame(hip - knee, side),
        4: _frame(knee - ankle, side),
        5: foot,
        6: foot,
    }


def _frame(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return orthogonal axes as columns (3, 3): along ``first``, as near as possible to ``second``, and at right angles
    to both.
    """
    one = first / np.linalg.norm(first)
    two = second - one * (second @ one)
    two /= np.linalg.norm(two)
    return np.stack([one, two, np.cross(one, two)], axis=1)


def lowest_m(character: Character, joint_from_mesh: FloatArray, places: FloatArray) -> float:
    """Return the height in metres of the lowest vertex of the feet in the T-pose.

    ``places`` (J, 3) are the positions of the joints in the T-pose.
    """
    least_m = np.inf
    world = joint_from_mesh[:, 1, :].copy()
    world[:, 3] += places[:, 1]
    for mesh in character.meshes:
        own = _FEET.step(_feet, character.skeleton.names, mesh.joints, mesh.weights)
        if len(own):
            rows = world[mesh.joints[own]]
            heights = np.einsum("nka,na->nk", rows[..., :3], mesh.positions_m[own]) + rows[..., 3]
            least_m = min(least_m, float((heights * mesh.weights[own]).sum(axis=1).min()))
    return least_m if np.isfinite(least_m) else 0.0


def _feet(names: tuple[str, ...], joints: AnyIntArray, weights: SingleArray) -> IndexArray:
    """Return those of N vertices, given by joints and weights (N, K), that belong to the feet."""
    feet = [names.index(f"{side}{part}") for side, _ in SIDES for part in ("Foot", "Toes")]
    return np.flatnonzero((weights * np.isin(joints, feet)).sum(axis=1) > 0.5)


# People made from one body share joints and weights.
_FEET: IdentityCache[IndexArray] = IdentityCache(256)
