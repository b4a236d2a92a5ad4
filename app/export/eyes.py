"""Division of the rotation of eyes between ARKit's eyeLook shapes and eye bones, so that it is applied once.

Programs add the effects of bones and shapes. If shapes rotate the eyeball, the bone has only the remainder, which is
zero for this program's shapes; in formats without shapes the bone has the whole rotation.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, SingleArray
from app.export.target import TargetSkeleton
from app.motion.faces.eyes import EYE_SHAPES, EYE_SIDES, SHAPES_RAD, EyeSide, eye_joint, shape_name, shape_turn
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.figure import Figure, OwnSkeleton
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character

BALL: Final = 0.5
"""Least skin weight of an eyeball's vertex for the joint of the eye."""
TURNS_RAD: Final = np.deg2rad(2.0)
"""Rotation in radians below which a shape does not turn the eyeball and only moves the lids."""
_AHEAD: Final = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class EyesOfFile:
    """Motion of a character whose eyes are rotated partly by joints and partly by morphs, as it is written to files.

    Attributes
    ----------
    motion : Motion
        Motion whose eye joints have only the rotation that the morphs do not make.
    turned : mapping of str to (F, 4) float64
        Rotation that the morphs make, by joint. The joint's rotation times this one is the complete rotation.
    """

    motion: Motion
    turned: Mapping[str, FloatArray]

    def whole(self, target: TargetSkeleton, character: Character, rotations: AnyFloatArray) -> dict[int, FloatArray]:
        """Return the complete rotations (F, 4) relative to the parent of those bones that are partly rotated by morphs,
        by bone; ``rotations`` are those of all bones without the morphs.
        """
        found = {}
        for name, turn in self.turned.items():
            bone = target.bone_of_joint.get(character.skeleton.index(name), -1)
            if bone >= 0:
                own = target.joint_from_bone[bone]
                added = quaternion.multiply(quaternion.conjugate(own), quaternion.multiply(turn, own))
                found[bone] = quaternion.multiply(np.asarray(rotations[:, bone], np.float64), added)
        return found


def eyes_of_file(character: Character, motion: Motion, target: TargetSkeleton) -> EyesOfFile:
    """Divide the rotation of the eyes between morphs and bones."""
    own = character.own if target.choice == "own" else None
    joints = {side: character.skeleton.index(eye_joint(side)) for side in EYE_SIDES if _has(character, side)}
    if own is None:
        ways = {side: {way: shape_turn(side, way) for way in SHAPES_RAD} for side in joints}
    else:
        ways = {side: _turns_of(own, character.skeleton.index(eye_joint(side)), side) for side in joints}
    if target.eyes == "bones":
        doubled = {shape_name(side, way) for side, turns in ways.items() for way in turns} if own is not None else set()
        return EyesOfFile(replace(motion, morphs=_without(motion.morphs, doubled)), {})
    rotations, turned = motion.rotations.copy(), dict[str, FloatArray]()
    for side, joint in joints.items():
        if not any(len(motion.morphs.get(shape_name(side, way), ())) for way in ways[side]):
            continue
        whole = quaternion.normalize(motion.rotations[:, joint].astype(np.float64))
        made = _made(ways[side], side, motion.morphs, motion.frames)
        left = _between(made, quaternion.rotate(whole, _AHEAD))
        left[np.abs(left[:, 3]) > 1.0 - 1e-9] = quaternion.IDENTITY
        rotations[:, joint] = left
        turned[eye_joint(side)] = quaternion.multiply(quaternion.conjugate(left), whole)
    return EyesOfFile(replace(motion, rotations=rotations), turned)


def looking_ahead(character: Character, motion: Motion) -> Motion:
    """Return a motion whose eyes do not turn in the head, for files that leave the gaze to a capture."""
    eyes = [character.skeleton.index(eye_joint(side)) for side in EYE_SIDES if _has(character, side)]
    rotations = motion.rotations.copy()
    rotations[:, eyes] = quaternion.IDENTITY
    return replace(motion, rotations=rotations, morphs=_without(motion.morphs, EYE_SHAPES))


def with_turned_balls(character: Character) -> Character:
    """Return a character whose eyeLook morphs also rotate its eyeballs."""
    if not any(_has(character, side) for side in EYE_SIDES):
        return character
    return replace(character, meshes=tuple(_turned_mesh(character, mesh) for mesh in character.meshes))


def _turned_mesh(character: Character, mesh: Mesh) -> Mesh:
    morphs = {morph.name: morph for morph in mesh.morphs}
    for side in EYE_SIDES:
        if not _has(character, side):
            continue
        joint = character.skeleton.index(eye_joint(side))
        shares = np.where(mesh.joints == joint, mesh.weights, 0.0).sum(axis=1)
        vertices = np.flatnonzero(shares > 0.0)
        if not len(vertices):
            continue
        place = np.linalg.inv(character.joint_from_mesh[joint])
        places_m = mesh.positions_m[vertices].astype(np.float64) - place[:3, 3]
        for way in SHAPES_RAD:
            turn = place[:3, :3] @ quaternion.to_matrix(shape_turn(side, way)) @ np.linalg.inv(place[:3, :3])
            moved = places_m @ (turn - np.eye(3)).T * shares[vertices, None]
            name = shape_name(side, way)
            morphs[name] = _added(morphs.get(name), name, vertices, moved, len(mesh.positions_m))
    return replace(mesh, morphs=tuple(morphs.values()))


def _added(morph: Morph | None, name: str, vertices: np.ndarray, moved: FloatArray, count: int) -> Morph:
    """Return a morph of ``count`` vertices that moves ``vertices`` by ``moved`` (metres) in addition to ``morph``; for
    None a new morph.
    """
    if morph is None:
        return Morph(name, vertices.astype(np.int32), moved.astype(np.float32), None)
    deltas_m = np.zeros((count, 3))
    deltas_m[morph.vertices] = morph.deltas_m
    deltas_m[vertices] += moved
    moving = np.union1d(morph.vertices, vertices).astype(np.int32)
    return Morph(name, moving, deltas_m[moving].astype(np.float32), None)


def _has(character: Character, side: EyeSide) -> bool:
    return eye_joint(side) in character.skeleton.names


def _without(morphs: Mapping[str, SingleArray], names: Collection[str]) -> dict[str, SingleArray]:
    return {name: weights for name, weights in morphs.items() if name not in names}


def _made(ways: Mapping[str, FloatArray], side: EyeSide, morphs: Mapping[str, SingleArray], frames: int) -> FloatArray:
    """Return the unit direction (F, 3) of an eye that looks ahead at rest, after its eyeLook morphs are applied.

    ``ways`` has the rotation by each morph.
    """
    place = np.tile(_AHEAD, (frames, 1))
    for way, turn in ways.items():
        weights = morphs.get(shape_name(side, way))
        if weights is not None:
            place += weights.astype(np.float64)[:, None] * (quaternion.rotate(turn, _AHEAD) - _AHEAD)
    unit: FloatArray = place / np.linalg.norm(place, axis=1, keepdims=True)
    return unit


def _between(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the shortest rotations (F, 4) from unit directions ``start`` (F, 3) to ``end`` (F, 3)."""
    across, along = np.cross(start, end), 1.0 + np.sum(start * end, axis=1)
    return quaternion.normalize(np.concatenate([across, along[:, None]], axis=1))


def _turns_of(own: OwnSkeleton, joint: int, side: EyeSide) -> dict[str, FloatArray]:
    """Return the rotation (4,) of the eyeball by each of a figure's own eyeLook morphs; morphs that only move lids are
    left out.
    """
    bone = own.bone_of_joint[joint]
    found: dict[str, FloatArray] = {}
    for way in SHAPES_RAD:
        recipe = own.morphs.get(shape_name(side, way), {})
        if bone >= 0 and recipe:
            turn = _turn_of_ball(own.figure, bone, recipe)
            if np.linalg.norm(quaternion.to_rotation_vector(turn)) > TURNS_RAD:
                found[way] = turn
    return found


def _turn_of_ball(figure: Figure, bone: int, recipe: Mapping[str, float]) -> FloatArray:
    """Return the rotation (4,) about a bone that best fits the displacement of its vertices by morphs with the weights
    ``recipe``.
    """
    places_m, _ = world_placements(figure.parents, figure.translations_m, figure.rotations)
    before, after = [np.zeros((0, 3))], [np.zeros((0, 3))]
    for mesh in figure.meshes:
        ball = np.where(mesh.joints == bone, mesh.weights, 0.0).sum(axis=1) > BALL
        moved = np.zeros((len(mesh.positions_m), 3))
        for morph in mesh.morphs:
            moved[morph.vertices] += recipe.get(morph.name, 0.0) * morph.deltas_m
        at_m = mesh.positions_m[ball] - places_m[bone]
        before.append(at_m)
        after.append(at_m + moved[ball])
    start, end = np.concatenate(before), np.concatenate(after)
    if len(start) < 4:
        return quaternion.IDENTITY
    left, _, right = np.linalg.svd(end.T @ start)
    turn: FloatArray = quaternion.from_matrix(left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right)
    return turn
