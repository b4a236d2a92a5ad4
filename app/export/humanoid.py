"""Target skeleton of a VRM animation: VRM's humanoid bones, unrotated in the rest pose of the character's own file.

A viewer applies the rotations of the animation's bones relative to their rest to a VRM's bones relative to its rest. So
the rest pose must be that of the character's VRM file, which may differ slightly from the T-pose; characters without
one use the T-pose.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.export.character import character_scene
from app.export.target import HIPS, TargetSkeleton
from app.formats.gltf.vrma import GAZE_EXPRESSIONS, LOOK_AT
from app.formats.scene import NodePlace, Scene
from app.motion.faces.eyes import EYE_SHAPES
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.characters.t_pose import AHEAD
from app.rig.model import Character, Skeleton
from metadata.load import load_face_names, load_skeleton
from metadata.model import ARKIT_MORPHS

EYES = ("leftEye", "rightEye")
_TRUNK = ("spine", "chest", "upperChest")
_ENDS = {
    f"{side}{limb}": f"{side}{end}"
    for side in ("left", "right")
    for limb, end in (("UpperArm", "LowerArm"), ("LowerArm", "Hand"), ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"))
}
"""Joint at the end of each limb's bones."""
_OF_VRM = ("vrm0", "vrm1")
_VRM = "vrm"


def humanoid_target(character: Character, place: NodePlace | None = None) -> TargetSkeleton:
    """Return the target skeleton of a character's VRM animation; its last bone is the gaze, in the middle between the
    eyes.

    A joint missing in the character's own file has no bone; its rotation is passed to the bones below.

    Parameters
    ----------
    character : Character
        The character.
    place : NodePlace or None
        Transform on the stage of the hips' path; None for the origin.
    """
    skeleton, own = character.skeleton, character.own
    known = {joint.name for joint in load_skeleton("vrm1").joints} - {"root", *EYES}
    joints = [
        joint
        for joint, name in enumerate(skeleton.names)
        if name in known and (own is None or own.bone_of_joint[joint] >= 0)
    ]
    unturned = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1))
    positions_m, turns = world_placements(skeleton.parents, np.asarray(skeleton.offsets_m, np.float64), unturned)
    if own is not None and own.figure.posed is not None:
        figure = own.figure
        rest_m, resting = world_placements(figure.parents, figure.translations_m, own.figure.posed)
        for joint in joints:
            bone = own.bone_of_joint[joint]
            positions_m[joint] = rest_m[bone]
            turns[joint] = quaternion.multiply(resting[bone], quaternion.conjugate(own.joint_from_bone[joint]))
        _point_at_ends(skeleton, positions_m, turns, [joint for joint in joints if skeleton.names[joint] in _ENDS])
    bone_of_joint = {joint: bone for bone, joint in enumerate(joints)}
    parents: list[int] = []
    for joint in joints:
        above = skeleton.parents[joint]
        while above >= 0 and above not in bone_of_joint:
            above = skeleton.parents[above]
        parents.append(bone_of_joint.get(above, -1))
    offsets_m = [
        positions_m[joint] - (positions_m[joints[parent]] if parent >= 0 else 0.0)
        for joint, parent in zip(joints, parents, strict=True)
    ]
    head = bone_of_joint[skeleton.index("head")]
    eyes_m = np.mean([skeleton.offsets_m[skeleton.index(eye)] for eye in EYES], axis=0)
    offsets_m.append(quaternion.rotate(turns[joints[head]], np.asarray(eyes_m, np.float64)))
    still = np.tile(quaternion.IDENTITY, (len(joints) + 1, 1))
    away = np.concatenate([quaternion.conjugate(turns[joints]), still[:1]])
    # In a trunk with fewer bones our uppermost joint uses the last bone; VRM has no upper chest without a chest.
    trunk = iter(_TRUNK)
    names = [next(trunk) if skeleton.names[joint] in _TRUNK else skeleton.names[joint] for joint in joints]
    return TargetSkeleton(
        "suisou",
        (*names, LOOK_AT),
        (*parents, head),
        np.array(offsets_m),
        still,
        still,
        (*joints, -1),
        away,
        hips=bone_of_joint[skeleton.index(HIPS)],
        place=place,
    )


def _point_at_ends(skeleton: Skeleton, positions_m: FloatArray, turns: FloatArray, limbs: Sequence[int]) -> None:
    """Rotate limbs (in ``turns``, in place) so that each points to its next joint as in the rest pose.

    Bones between the two, which a viewer does not move, may be bent there.
    """
    for joint in limbs:
        end = skeleton.index(_ENDS[skeleton.names[joint]])
        bound = quaternion.rotate(turns[joint], np.asarray(skeleton.offsets_m[end], np.float64))
        resting = positions_m[end] - positions_m[joint]
        lengths_m = np.linalg.norm(bound), np.linalg.norm(resting)
        if min(lengths_m) > 0.0:
            way = quaternion.between(bound / lengths_m[0], resting / lengths_m[1])
            turns[joint] = quaternion.multiply(way, turns[joint])


def humanoid_scene(character: Character, motion: Motion, name: str, creator: str, target: TargetSkeleton) -> Scene:
    """Return the scene of a VRM animation on a `humanoid_target`, with a mesh that shows how a viewer displays it."""
    scene = character_scene(character, motion, name, creator, target)
    clip = scene.clip
    assert clip is not None
    rotations = np.array(clip.rotations_xyzw)
    rotations[:, -1] = gaze(character, motion)
    translations_cm = {target.hips: clip.translations_cm[target.hips]}
    # The gaze turns the eye bones; ARKit's eye expressions would turn the eyes twice.
    weights = {name: weight for name, weight in clip.morph_weights.items() if name not in EYE_SHAPES}
    clip = replace(clip, rotations_xyzw=rotations, translations_cm=translations_cm, morph_weights=weights)
    return replace(scene, clip=clip)


def gaze(character: Character, motion: Motion) -> FloatArray:
    """Return the rotations (F, 4) relative to the head that turn +Z to the mean direction of both eyes: about the
    vertical axis, then up or down.
    """
    skeleton = character.skeleton
    ways = sum(quaternion.rotate(quaternion.normalize(motion.rotations[:, skeleton.index(eye)]), AHEAD) for eye in EYES)
    x, y, z = np.asarray(ways, np.float64).T
    yaw, pitch = np.arctan2(x, z) / 2.0, np.arctan2(-y, np.hypot(x, z)) / 2.0
    nought = np.zeros_like(yaw)
    level = np.stack([nought, np.sin(yaw), nought, np.cos(yaw)], axis=1)
    return quaternion.multiply(level, np.stack([np.sin(pitch), nought, nought, np.cos(pitch)], axis=1))


def vrm_expressions(character: Character) -> Mapping[str, Mapping[str, float]]:
    """Return the expressions of VRM's presets as weights of ARKit shapes, by preset.

    If the character's VRM file has an expression named like an ARKit shape, in any spelling, the shape is used only for
    that expression, so that nothing moves the face twice.
    """
    own, shapes = character.own, {name.casefold(): name for name in ARKIT_MORPHS}
    spelled = {
        shapes[name.casefold()]: name
        for name in (() if own is None or own.figure.origin not in _OF_VRM else own.figure.expressions)
        if name.casefold() in shapes
    }
    made: dict[str, dict[str, float]] = defaultdict(dict)
    for shape, ways in load_face_names()[_VRM].morphs.items():
        best = ways[0]
        for preset, share in ({best: 1.0} if isinstance(best, str) else best).items():
            if shape not in spelled and preset not in GAZE_EXPRESSIONS:
                made[preset][shape] = share
    return made | {name: {shape: 1.0} for shape, name in spelled.items() if name != shape}
