"""Characters of people: the meshes, joints and morphs of a bundled body, moved as its base mesh changes by a phenotype.

The bundled body itself is unchanged. Hands are moved rigidly with their wrists, so that a grip fitted to the bundled
body's hands is valid for every person made from it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Final

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.formats.images import tinted
from app.formats.scene import Material
from app.formats.textures import Texture
from app.identity_cache import IdentityCache
from app.rig.mesh import Mesh, Morph, MorphsOnDemand
from app.rig.model import Character, Skeleton
from app.rig.people.body_shapes import BodyShapes, Phenotype, body_m
from app.rig.people.displacement import NO_CHANGE, Attaching, Binding, FaceChange, face_change, normals_of, places_of
from app.rig.people.eyeballs import NearEye, ball_rows, near_eyes, off_the_eyes
from app.rig.people.moved_joints import SIDES, MovedJoints, lowest_m, moved_joints, t_positions, with_arms_to
from app.rig.people.person import Color
from app.rig.skeleton import ancestors

HAND_SHARE = 0.5
"""Least weight of skin that belongs to a hand."""
SKIN = "body"
"""Mesh with the shapes of the face."""
SKIN_MATERIAL: Final = "skin"
NEUTRAL_MEANS: Final[Mapping[str, float]] = {"skin": 0.70, "hair": 0.32, "brows": 0.32, "iris": 0.35, "shirt": 0.80}
"""Means of the neutral textures of materials, by which a colour is divided to tint them (resources/build/README.md)."""


LIGHTER_STEPS: Final = 4
"""Number of textures that are made for colours from one to two times as light as a neutral texture."""


@dataclass(frozen=True, eq=False)
class Original:
    """A bundled body, prepared for making people from it.

    Attributes
    ----------
    character : Character
        The body.
    base_m : (V + J, 3)
        Base mesh and joints of its phenotype.
    bindings : dict of str to Binding
        Bindings of its meshes to the base mesh, by name of the mesh.
    hands : dict of str to (N, 2)
        By mesh: share 0..1 by which each vertex moves with the left and with the right hand.
    arms : dict of str to (N, 4)
        By mesh: share by which each vertex moves with left elbow, left wrist, right elbow and right wrist if an arm is
        lengthened.
    places : dict of str to (N,)
        By mesh: number of each vertex's position (`places_of`).
    normals : dict of str to (N, 3)
        By mesh: normals smoothed across vertices at one position (`normals_of`).
    """

    character: Character
    base_m: FloatArray
    bindings: Mapping[str, Binding]
    hands: Mapping[str, FloatArray]
    arms: Mapping[str, FloatArray]
    places: Mapping[str, IndexArray]
    normals: Mapping[str, FloatArray]


def original_of(character: Character, shapes: BodyShapes, phenotype: Phenotype) -> Original:
    """Prepare a bundled body with a phenotype for making people from it; takes a fraction of a second."""
    base_m, attaching = _BASES.step(_base, shapes, phenotype)
    places = {mesh.name: places_of(mesh) for mesh in character.meshes}
    return Original(
        character,
        base_m,
        {mesh.name: attaching.bound(mesh, _leg_shares(character, mesh)) for mesh in character.meshes},
        {mesh.name: _hand_shares(character, mesh) for mesh in character.meshes},
        {mesh.name: _arm_shares(character, mesh) for mesh in character.meshes},
        places,
        {
            mesh.name: normals_of(mesh.positions_m.astype(np.float64), mesh, places[mesh.name])
            for mesh in character.meshes
        },
    )


def _base(shapes: BodyShapes, phenotype: Phenotype) -> tuple[FloatArray, Attaching]:
    """Return the base mesh and joints (V + J, 3) of a bundled body's phenotype, and what binds meshes to it."""
    base_m = body_m(shapes, phenotype)
    ankle_m = float(base_m[len(shapes.vertices) + shapes.joints.index("leftFoot"), 1])
    return base_m, Attaching(base_m[: len(shapes.vertices)], ankle_m)


# A bundled body, its hair and its clothes are bound to the same base mesh.
_BASES: IdentityCache[tuple[FloatArray, Attaching]] = IdentityCache(4)


def _hand_shares(character: Character, mesh: Mesh) -> FloatArray:
    shares = []
    for side, _ in SIDES:
        weight = np.clip(_weight_below(character, mesh, f"{side}Hand") / HAND_SHARE, 0.0, 1.0)
        shares.append(weight * weight * (3.0 - 2.0 * weight))
    return np.stack(shares, axis=1).astype(np.float64)


def _leg_shares(character: Character, mesh: Mesh) -> FloatArray:
    """Return the weights (N, 2) of a mesh's vertices on the left and on the right leg."""
    return np.stack([_weight_below(character, mesh, f"{side}UpperLeg") for side, _ in SIDES], axis=1)


def _weight_below(character: Character, mesh: Mesh, name: str) -> FloatArray:
    """Return for each vertex (N,) the sum of its weights on a joint and all joints below it."""
    top = character.skeleton.index(name)
    joints = [joint for joint in range(len(character.skeleton.names)) if top in ancestors(character.skeleton, joint)]
    return np.asarray((mesh.weights * np.isin(mesh.joints, joints)).sum(axis=1), dtype=np.float64)


def _arm_shares(character: Character, mesh: Mesh) -> FloatArray:
    """Return the shares (N, 4) of the displacements of left elbow, left wrist, right elbow and right wrist that
    vertices follow: increasing along the arm, all of it beyond the wrist.
    """
    skeleton, columns = character.skeleton, []
    at = np.linalg.inv(character.joint_from_mesh)[:, :3, 3]
    for side, _ in SIDES:
        shoulder, elbow, wrist = (skeleton.index(f"{side}{part}") for part in ("UpperArm", "LowerArm", "Hand"))
        weights = [_weight_below(character, mesh, skeleton.names[joint]) for joint in (shoulder, elbow, wrist)]
        along = []
        for start, end in ((shoulder, elbow), (elbow, wrist)):
            bone = at[end] - at[start]
            along.append(np.clip((mesh.positions_m - at[start]) @ bone / float(bone @ bone), 0.0, 1.0))
        upper, lower = weights[0] - weights[1], weights[1] - weights[2]
        columns += [upper * along[0] + lower * (1.0 - along[1]), lower * along[1] + weights[2]]
    return np.stack(columns, axis=1)


def person_character(
    id: str,
    original: Original,
    shapes: BodyShapes,
    phenotype: Phenotype,
    colors: Mapping[str, Color] | None = None,
    worn: Mapping[str, Original] | None = None,
    skin_colors: Texture | None = None,
    hands: float = 1.0,
    hip_joints_m: float = 0.0,
) -> Character:
    """Make the character of a person from a bundled body and a phenotype.

    Parameters
    ----------
    colors : mapping of str to (float, float, float), optional
        Linear base colour by material.
    worn : mapping of str to Original, optional
        Bundled body from which a mesh (such as the hair) is taken, by mesh; its joints have the same names.
    skin_colors : Texture, optional
        Texture of the skin, instead of the bundled body's.
    hands : float
        Size of the hands relative to the bundled body's; if it is not 1, the bundled body's grips are not valid.
    hip_joints_m : float
        Distance between the hip joints; 0 for the distance by the phenotype.
    """
    body = body_m(shapes, phenotype)
    if hip_joints_m:
        body = _with_hip_joints(original, shapes, body, hip_joints_m)
    joints = _joints(original, shapes, body, hands)
    before = original.character
    skin = next(mesh for mesh in before.meshes if mesh.name == SKIN)
    skin_m = _moved(original, skin, body, joints)
    face = face_change(before, skin, skin_m)
    meshes = []
    for mesh, owner in _chosen(original, worn or {}):
        own = joints if owner is original else _joints(owner, shapes, body, hands)
        moved = skin_m if mesh is skin else _moved(owner, mesh, body, own)
        meshes.append(_recolored(_changed(owner, mesh, moved, own, face), colors or {}, skin_colors))
    hands_of = before if hands == 1.0 else None
    return _standing(replace(before, id=id, meshes=tuple(meshes), hands_of=hands_of, made_from=before), joints)


def carried(
    original: Original,
    shapes: BodyShapes,
    phenotype: Phenotype,
    hands: float = 1.0,
    wearer: Character | None = None,
) -> tuple[Mesh, ...]:
    """Return the meshes of garments (without a face), fitted to the body of a phenotype with hands of a size.

    ``wearer`` is a character made from another bundled body than the garments, whose arms are a little longer or
    shorter; their sleeves are adjusted to its elbows and wrists.
    """
    body = body_m(shapes, phenotype)
    joints = _joints(original, shapes, body, hands)
    if wearer is not None:
        places_m = np.linalg.inv(wearer.joint_from_mesh)[:, :3, 3].astype(np.float64)
        joints = with_arms_to(joints, wearer.skeleton, places_m)
    meshes = original.character.meshes
    return tuple(_changed(original, mesh, _moved(original, mesh, body, joints), joints, NO_CHANGE) for mesh in meshes)


def _chosen(original: Original, worn: Mapping[str, Original]) -> list[tuple[Mesh, Original]]:
    """Return the meshes of a person, each with the bundled body from which it is taken."""
    found = []
    for mesh in original.character.meshes:
        owner = worn.get(mesh.name, original)
        other = next((one for one in owner.character.meshes if one.name == mesh.name), None)
        found.append((mesh, original) if other is None else (other, owner))
    return found


def _with_hip_joints(original: Original, shapes: BodyShapes, body: FloatArray, apart_m: float) -> FloatArray:
    """Return ``body`` with its hip joints moved symmetrically until they are ``apart_m`` apart; all other points are
    unchanged.
    """
    moved, before = body.copy(), original.character
    for side, sign in SIDES:
        joint = before.skeleton.index(f"{side}UpperLeg")
        row = len(shapes.vertices) + shapes.joints.index(f"{side}UpperLeg")
        at_m = float(np.linalg.inv(before.joint_from_mesh[joint])[0, 3])
        moved[row, 0] = original.base_m[row, 0] + sign * apart_m / 2.0 - at_m
    return moved


def _joints(original: Original, shapes: BodyShapes, body: FloatArray, hands: float) -> MovedJoints:
    """Return the joints of a bundled body, moved as its base mesh becomes ``body``."""
    count = len(shapes.vertices)
    steps = body[count:] - original.base_m[count:]
    return moved_joints(original.character, dict(zip(shapes.joints, steps, strict=True)), hands)


@dataclass(frozen=True, eq=False)
class _Parts:
    """Parts of a bundled body's mesh with N vertices, which are the same for all people made from it.

    Attributes
    ----------
    points_m : (N, 3)
        The vertices.
    hands : tuple of ((K,) int, (K, 1))
        Vertices of the left and of the right hand, and their shares of its motion.
    balls : tuple of (K,) int
        Vertices of the left and of the right eyeball.
    lids : tuple of NearEye
        Vertices near the eyeballs.
    """

    points_m: FloatArray
    hands: tuple[tuple[IndexArray, FloatArray], ...]
    balls: tuple[IndexArray, ...]
    lids: tuple[NearEye, ...]


@lru_cache(maxsize=256)
def _parts(original: Original, mesh: Mesh) -> _Parts:
    points, index = mesh.positions_m.astype(np.float64), original.character.skeleton.index
    hands = []
    for share in original.hands[mesh.name].T[:, :, None]:
        rows = np.flatnonzero(share[:, 0] > 0.0)
        hands.append((rows, share[rows]))
    balls = tuple(ball_rows(mesh, index(f"{side}Eye")) for side, _ in SIDES)
    return _Parts(points, tuple(hands), balls, near_eyes(original.character, points))


def _moved(original: Original, mesh: Mesh, body: FloatArray, joints: MovedJoints) -> FloatArray:
    """Return the vertices (N, 3) of a mesh, moved as its base mesh becomes ``body``, including lengthened limbs."""
    parts, index = _parts(original, mesh), original.character.skeleton.index
    carried = original.bindings[mesh.name].carried(body - original.base_m)
    moved = parts.points_m + carried + original.arms[mesh.name] @ joints.lengthened
    for (side, _), (hand, share), ball in zip(SIDES, parts.hands, parts.balls, strict=True):
        if len(hand):
            rigid = joints.rigidly(index(f"{side}Hand"), parts.points_m[hand], joints.hands)
            moved[hand] += share * (rigid - moved[hand])
        if len(ball):
            moved[ball] = joints.rigidly(index(f"{side}Eye"), parts.points_m[ball])
    return moved


def _changed(original: Original, mesh: Mesh, moved: FloatArray, joints: MovedJoints, face: FaceChange) -> Mesh:
    """Return a mesh of a bundled body, fitted to another body: vertices, normals and morphs.

    ``moved`` (N, 3) are its vertices as in `_moved`, which are changed.
    """
    moved = off_the_eyes(_parts(original, mesh).lids, moved, joints)
    normals = mesh.normals + normals_of(moved, mesh, original.places[mesh.name]) - original.normals[mesh.name]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    morphs: Sequence[Morph] = ()
    if mesh.morphs:
        make = partial(_shapes, original, mesh, moved, joints, face)
        # Most people of a band are far away: a face is made when it is seen near, or lips meet a mouthpiece. Few and
        # small morphs take less memory than what they are made from.
        many = sum(len(morph.vertices) for morph in mesh.morphs) > 2 * len(moved)
        morphs = MorphsOnDemand(len(mesh.morphs), make) if many else make()
    positions = moved.astype(np.float32)
    return replace(mesh, positions_m=positions, normals=normals.astype(np.float32), morphs=morphs)


def _shapes(
    original: Original, mesh: Mesh, moved: FloatArray, joints: MovedJoints, face: FaceChange
) -> tuple[Morph, ...]:
    """Return the morphs of a mesh for another person's face: displacements are turned and stretched with the skin, and
    lids stay on the eyeballs. ``moved`` (N, 3) are the mesh's vertices on the other body.
    """
    rows = _moved_by_morphs(original, mesh)
    turned = np.einsum("nij,nj->ni", face.at(rows.moving_m).take(rows.numbered, axis=0), rows.moves_m)
    rest = moved.take(rows.vertices, axis=0)
    after = off_the_eyes(rows.lids, rest + turned, joints)
    made = np.split((after - rest).astype(np.float32), rows.ends)
    return tuple(replace(morph, deltas_m=own) for morph, own in zip(mesh.morphs, made, strict=True))


@dataclass(frozen=True, eq=False)
class _MorphRows:
    """Vertices that the morphs of a bundled body's mesh move, concatenated over the morphs.

    Attributes
    ----------
    vertices : (R,) int
        Indices of the vertices.
    moves_m : (R, 3)
        Their displacements.
    moving_m : (M, 3)
        Their positions without repetition.
    numbered : (R,) int
        Index into ``moving_m``.
    lids : tuple of NearEye
        Rows that are near the eyeballs when they are displaced.
    ends : (N - 1,) int
        First row of each of N morphs but the first.
    """

    vertices: IndexArray
    moves_m: FloatArray
    moving_m: FloatArray
    numbered: IndexArray
    lids: tuple[NearEye, ...]
    ends: IndexArray


@lru_cache(maxsize=64)
def _moved_by_morphs(original: Original, mesh: Mesh) -> _MorphRows:
    points = _parts(original, mesh).points_m
    rows = np.concatenate([morph.vertices for morph in mesh.morphs]).astype(np.intp)
    moving, numbered = np.unique(rows, return_inverse=True)
    ends = np.cumsum([len(morph.vertices) for morph in mesh.morphs])[:-1]
    before = points[rows] + np.concatenate([morph.deltas_m for morph in mesh.morphs])
    lids = near_eyes(original.character, before)
    return _MorphRows(rows, before - points[rows], points[moving], numbered, lids, ends)


def _recolored(mesh: Mesh, colors: Mapping[str, Color], skin: Texture | None) -> Mesh:
    def own(material: Material) -> Material:
        textures, color = material.textures, colors.get(material.name)
        if skin is not None and material.name == SKIN_MATERIAL and textures.color is not None:
            material = replace(material, textures=replace(textures, color=replace(textures.color, texture=skin)))
        if color is None:
            return material
        if textures.color is not None:
            red, green, blue = (part / NEUTRAL_MEANS.get(material.name, 1.0) for part in color)
            if (gain := _gain(max(red, green, blue))) > 1.0:
                lighter = tinted(textures.color.texture, (gain, gain, gain), solid=False)
                material = replace(material, textures=replace(textures, color=replace(textures.color, texture=lighter)))
            color = (red / gain, green / gain, blue / gain)
        return replace(material, base_color=(*color, material.base_color[3]))

    return replace(mesh, materials=tuple(own(material) for material in mesh.materials))


def _gain(factor: float) -> float:
    """Return by what a texture is to be lighter for a factor of its colour to be 1 at most, in few different steps."""
    return max(1.0, math.ceil(factor * LIGHTER_STEPS - 1e-6) / LIGHTER_STEPS)


def _standing(character: Character, joints: MovedJoints) -> Character:
    """Return a person whose skeleton in the T-pose follows from its moved joints, with the soles on the floor."""
    skeleton = character.skeleton
    joint_from_mesh = np.linalg.inv(joints.after).astype(np.float64)
    places = t_positions(skeleton, joints.after)
    root = joints.after[0, :3, 3]
    places += root
    floor_m = lowest_m(character, joint_from_mesh, places)
    places[1:, 1] -= floor_m
    offsets = places.copy()
    offsets[1:] -= places[list(skeleton.parents[1:])]
    return replace(
        character, skeleton=Skeleton(skeleton.names, skeleton.parents, offsets), joint_from_mesh=joint_from_mesh
    )
