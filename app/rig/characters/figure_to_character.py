"""Conversion of a figure with known joints to a character: normalised skeleton, missing joints added.

Vertices stay in the file's rest pose, which is the bind pose of the character; the skeleton's rest pose is the T-pose.
A joint missing in the file is added in a way that allows exact transfer of the motion to the file's bones:

- between two bones, it coincides with the upper one (a neck with the head, a shoulder with the arm);
- in the trunk, the highest joint without a bone takes the bone below, since shoulders and neck depend on it, and
  joints between coincide with it too;
- at the end of a chain (fingers of a mitten, toes, eyes) it is placed by the proportions of bundled bodies and moves
  nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, SingleArray
from app.errors import FileError
from app.rig import quaternion
from app.rig.characters.figure_build import at_height
from app.rig.characters.landmarks import found_landmarks
from app.rig.characters.split_hands import bones_beside_hands
from app.rig.characters.supplied_joints import Fit, inverse_binds, on_the_floor, supplied_ends
from app.rig.characters.t_pose import Rest, rest_of, turns_to_t_pose, upright
from app.rig.figure import Figure, OwnSkeleton
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character, Skeleton
from metadata.load import load_skeleton
from metadata.model import REQUIRED_JOINTS

OPTIONAL: Final = frozenset({"jaw"})
"""Joints that are not added if missing, since they are not needed."""
EYES: Final = ("leftEye", "rightEye")
TRUNK: Final = ("hips", "spine", "chest", "upperChest")


def figure_character(
    figure: Figure,
    id: str,
    bones: Mapping[str, int],
    morphs: Mapping[str, Mapping[str, float]],
    height_m: float = 0.0,
) -> Character:
    """Return a character made from a figure.

    Parameters
    ----------
    bones : mapping of str to int
        Bone of each VRM 1.0 joint that has one.
    morphs : mapping of str to mapping of str to float
        Weights of the figure's morphs by ARKit shape.
    height_m : float
        Height of the character; 0 for the figure's height.

    Raises
    ------
    FileError
        A required joint has no bone.
    """
    missing = [name for name in REQUIRED_JOINTS if name not in bones]
    if missing and not figure.is_skinned:
        raise FileError("character.no_skeleton", file=figure.file)
    if missing:
        raise FileError("character.incomplete", file=figure.file, joints=", ".join(missing))
    figure = at_height(upright(figure, bones), height_m)
    rest = rest_of(figure)
    fit = _fitted(figure, rest, bones)
    beside = {bone: fit.names.index(joint) for bone, joint in bones_beside_hands(figure, bones).items()}
    joint_of_bone = _joints_of_bones(figure, rest, fit, beside)
    eyes = [fit.names.index(name) for name in EYES if name in fit.names]
    meshes = tuple(_without_turned_balls(_mesh(mesh, joint_of_bone, morphs), eyes) for mesh in figure.meshes)
    fit = supplied_ends(fit, meshes)
    fit = on_the_floor(fit, meshes)
    joint_from_mesh = inverse_binds(fit)
    offsets = fit.places_m.copy()
    offsets[1:] -= fit.places_m[list(fit.parents[1:])]
    skeleton = Skeleton(fit.names, fit.parents, offsets)
    return Character(
        id=id,
        skeleton=skeleton,
        joint_from_mesh=joint_from_mesh,
        meshes=meshes,
        landmarks=found_landmarks(skeleton, joint_from_mesh, meshes),
        own=_own(figure, rest, fit, morphs, beside),
    )


# ------------------------------------------------------------------------------------------------------------- joints


def _fitted(figure: Figure, rest: Rest, bones: Mapping[str, int]) -> Fit:
    """Return the joints of the character in the order of the skeleton profile, with their bones. Missing joints at the
    ends of chains have no position yet (NaN).
    """
    profile = [joint for joint in load_skeleton().joints if joint.name not in OPTIONAL or joint.name in bones]
    names = tuple(joint.name for joint in profile)
    index = {name: place for place, name in enumerate(names)}
    parents = tuple(index[joint.parent] if joint.parent else -1 for joint in profile)
    turn_of = turns_to_t_pose(figure, rest, bones)
    own, lies_on = _attributed(names, parents, bones)
    turns = np.tile(quaternion.IDENTITY, (len(names), 1))
    rest_m = np.full((len(names), 3), np.nan)
    places = np.full((len(names), 3), np.nan)
    rest_m[0] = places[0] = 0.0
    for joint, parent in enumerate(parents):
        like = lies_on.get(joint, joint)
        if parent < 0:
            continue
        turns[joint] = turn_of.get(names[like], turns[parent])
        bone = bones[names[like]] if names[like] in bones else own[like]
        if bone >= 0:
            rest_m[joint] = rest.positions_m[bone]
            places[joint] = places[parent] + quaternion.rotate(turns[parent], rest_m[joint] - rest_m[parent])
            if parent == 0:
                places[joint] = rest_m[joint]
    return Fit(names, parents, own, turns, rest_m, places)


def _attributed(
    names: Sequence[str], parents: Sequence[int], bones: Mapping[str, int]
) -> tuple[list[int], dict[int, int]]:
    """Return the bone of each joint, and by each joint without a bone the joint whose position it shares (rules in the
    module's docstring).
    """
    own = [bones.get(name, -1) for name in names]
    index = {name: place for place, name in enumerate(names)}
    lies_on: dict[int, int] = {}
    top = index["upperChest"]
    if own[top] < 0:
        below = next(index[name] for name in reversed(TRUNK) if name in bones)
        own[top] = own[below]
        if below != index["hips"]:
            own[below] = -1
        for joint in range(below + 1, top + 1):
            lies_on[joint] = below
    for joint in reversed(range(1, len(names))):
        if own[joint] >= 0 or joint in lies_on or names[joint] in bones:
            continue
        above = [child for child in range(len(names)) if parents[child] == joint]
        placed = [child for child in above if own[child] >= 0 or child in lies_on]
        if len(placed) == 1:
            lies_on[joint] = lies_on.get(placed[0], placed[0])
    return own, lies_on


def _joints_of_bones(figure: Figure, rest: Rest, fit: Fit, beside: Mapping[int, int]) -> npt.NDArray[np.int32]:
    """Return for each bone of the figure (bones,) the joint of the character that moves its skin.

    That is its own joint, else its nearest ancestor's; the hips for bones above the hips; else the nearest in space.
    ``beside`` has the joint of additional bones.
    """
    hips = fit.names.index("hips")
    joint_of = {bone: joint for joint, bone in enumerate(fit.bones) if bone >= 0} | dict(beside)
    carried = np.full(len(figure.parents), -1, dtype=np.int32)
    for bone, parent in enumerate(figure.parents):
        carried[bone] = joint_of.get(bone, carried[parent] if parent >= 0 else -1)
    above = fit.bones[hips]
    while above >= 0:
        if carried[above] < 0:
            carried[above] = hips
        above = figure.parents[above]
    mapped = np.array(sorted(joint_of.values()))
    for bone in np.flatnonzero(carried < 0).tolist():
        parent = figure.parents[bone]
        if parent >= 0 and carried[parent] >= 0 and carried[parent] != hips:
            carried[bone] = carried[parent]
            continue
        away = np.linalg.norm(fit.rest_m[mapped] - rest.positions_m[bone], axis=1)
        carried[bone] = mapped[int(np.argmin(away))]
    return carried


def _own(
    figure: Figure,
    rest: Rest,
    fit: Fit,
    morphs: Mapping[str, Mapping[str, float]],
    beside: Mapping[int, int],
) -> OwnSkeleton:
    joint_from_bone = np.tile(quaternion.IDENTITY, (len(fit.names), 1))
    world = rest.rotations.copy()
    joint_of = {bone: joint for joint, bone in enumerate(fit.bones) if bone >= 0} | dict(beside)
    t_pose = figure.rotations.copy()
    for bone, parent in enumerate(figure.parents):
        joint = joint_of.get(bone)
        above = world[parent] if parent >= 0 else quaternion.IDENTITY
        if joint is None:
            world[bone] = quaternion.multiply(above, figure.rotations[bone])
            continue
        world[bone] = quaternion.multiply(fit.turns[joint], rest.rotations[bone])
        t_pose[bone] = quaternion.multiply(quaternion.conjugate(above), world[bone])
        if bone not in beside:
            joint_from_bone[joint] = world[bone]
    return OwnSkeleton(figure, tuple(fit.bones), joint_from_bone, t_pose, morphs, beside)


# --------------------------------------------------------------------------------------------------------------- skin


def _mesh(mesh: Mesh, joint_of_bone: npt.NDArray[np.int32], morphs: Mapping[str, Mapping[str, float]]) -> Mesh:
    joints, weights = _merged(joint_of_bone[mesh.joints], mesh.weights.astype(np.float64))
    return replace(mesh, joints=joints, weights=weights, morphs=_composed(mesh.morphs, morphs))


def _without_turned_balls(mesh: Mesh, eyes: Sequence[int]) -> Mesh:
    """Return a mesh whose ``eyeLook`` morphs do not move vertices of the eye joints, since the joints rotate these
    already.
    """
    shares = np.where(np.isin(mesh.joints, eyes), mesh.weights, 0.0).sum(axis=1)
    if not shares.any():
        return mesh
    kept = (1.0 - shares)[:, None].astype(np.float32)
    morphs = [
        replace(morph, deltas_m=morph.deltas_m * kept[morph.vertices]) if morph.name.startswith("eyeLook") else morph
        for morph in mesh.morphs
    ]
    return replace(mesh, morphs=tuple(morphs))


def _merged(joints: npt.NDArray[np.int32], weights: FloatArray) -> tuple[npt.NDArray[np.int32], SingleArray]:
    """Return joints and weights (V, K) in which every joint occurs once per vertex, heaviest first, with K as small as
    possible.
    """
    joints, weights = joints.copy(), weights.copy()
    for column in range(1, joints.shape[1]):
        for before in range(column):
            same = (joints[:, before] == joints[:, column]) & (weights[:, column] > 0.0)
            weights[same, before] += weights[same, column]
            weights[same, column] = 0.0
    order = np.argsort(-weights, axis=1, kind="stable")
    joints, weights = np.take_along_axis(joints, order, axis=1), np.take_along_axis(weights, order, axis=1)
    width = max(int((weights > 0.0).sum(axis=1).max(initial=1)), 1)
    joints, weights = joints[:, :width], weights[:, :width]
    joints = np.where(weights > 0.0, joints, joints[:, :1])
    return joints.astype(np.int32), weights.astype(np.float32)


def _composed(own: Sequence[Morph], morphs: Mapping[str, Mapping[str, float]]) -> tuple[Morph, ...]:
    """Return the morphs in ``morphs``, each computed as a weighted sum of the mesh's ``own`` morphs."""
    known = {morph.name: morph for morph in own}
    found = []
    for name, recipe in morphs.items():
        shares = [(known[part], weight) for part, weight in recipe.items() if part in known and weight]
        if len(shares) == 1 and shares[0][1] == 1.0:
            found.append(replace(shares[0][0], name=name))
        elif shares:
            found.append(_summed(name, shares))
    return tuple(found)


def _summed(name: str, shares: Sequence[tuple[Morph, float]]) -> Morph:
    vertices = np.unique(np.concatenate([morph.vertices for morph, _ in shares]))
    deltas = np.zeros((len(vertices), 3))
    normals = np.zeros((len(vertices), 3))
    has_normals = all(morph.normal_deltas is not None for morph, _ in shares)
    for morph, weight in shares:
        places = np.searchsorted(vertices, morph.vertices)
        np.add.at(deltas, places, weight * morph.deltas_m)
        if morph.normal_deltas is not None:
            np.add.at(normals, places, weight * morph.normal_deltas)
    return Morph(name, vertices, deltas.astype(np.float32), normals.astype(np.float32) if has_normals else None)
