"""Conversion of a character's scene to a BVH clip with joints from the hips on, in centimetres, optionally with bone
names of other programs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.export.joints import world_transforms
from app.export.target import TargetSkeleton
from app.formats.bvh.clip import BvhClip
from app.formats.joint_angles import order_along
from app.formats.scene import Clip, Scene
from app.formats.unique_names import numbered
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.model import Skeleton
from metadata.known_names import BoneNames
from metadata.load import load_bone_names

OWN_VERTEX = 0.5
"""Share of its skin weight above which a vertex belongs to a joint."""
_SHORTEST_CM = 1.0


def scene_bvh(
    scene: Scene, names: Mapping[int, str] = MappingProxyType({}), t_pose: AnyFloatArray | None = None
) -> BvhClip:
    """Return a scene's skeleton and motion as a BVH clip whose root is the hips; motion of the bones above is included
    in the root.

    In a BVH file only the root translates, so translations of other bones are lost, and bones that only translate, such
    as sockets, are left out. In BVH all angles are 0 at rest and bones are not rotated, so bones get new frames, which
    are parallel to the world in the T-pose.

    Parameters
    ----------
    scene : Scene
        Scene with a clip.
    names : mapping of int to str
        Names of bones that differ from the scene's.
    t_pose : ndarray, shape (B, 4), optional
        Rotations of the bones relative to their parents in the T-pose; by default those at rest.
    """
    clip = scene.clip
    if clip is None:
        raise ValueError("a scene without a clip has no motion")
    first = _first(scene, clip)
    chosen = _without_props(scene, clip, _below(scene, first), first)
    place = {bone: index for index, bone in enumerate(chosen)}
    translation_cm, rotation = _world(scene, clip, first)
    rotations = np.take(clip.rotations_xyzw, chosen, axis=1)
    for bone, turns in clip.whole_turns.items():
        rotations[:, place[bone]] = turns
    rotations[:, 0] = rotation
    offsets_cm = np.stack([np.asarray(scene.bones[bone].translation_cm, np.float64) for bone in chosen])
    offsets_cm[0] = 0.0
    frames = _frames(scene, t_pose)
    parents = [scene.bones[bone].parent if bone != first else -1 for bone in chosen]
    above = np.stack([frames[parent] if parent >= 0 else quaternion.IDENTITY for parent in parents])
    ends_cm = _end_sites_cm(scene, chosen)
    axes = [scene.bones[bone].axes for bone in chosen]
    return BvhClip(
        # BVH allows no spaces in names.
        names=numbered("_".join(names.get(bone, scene.bones[bone].name).split()) or "bone" for bone in chosen),
        parents=tuple(place[parent] if parent >= 0 else -1 for parent in parents),
        offsets_cm=quaternion.rotate(above, offsets_cm),
        end_sites_cm={place[bone]: quaternion.rotate(frames[bone], end) for bone, end in ends_cm.items()},
        fps=clip.fps,
        root_translation_cm=translation_cm,
        rotations_xyzw=quaternion.multiply(
            quaternion.multiply(above, np.asarray(rotations, np.float64)), quaternion.conjugate(frames[chosen])
        ),
        orders=tuple(
            order_along(None if own is None else quaternion.rotate(frames[bone], np.asarray(own, np.float64)))
            for bone, own in zip(chosen, axes, strict=True)
        ),
    )


def _frames(scene: Scene, t_pose: AnyFloatArray | None) -> FloatArray:
    """Return the world rotations (B, 4) of B bones in the pose in which the file's angles are 0."""
    rests = [bone.rotation_xyzw for bone in scene.bones]
    local = np.asarray(rests if t_pose is None else t_pose, np.float64)
    _, frames = world_placements([bone.parent for bone in scene.bones], np.zeros((len(local), 3)), local)
    return frames


def _first(scene: Scene, clip: Clip) -> int:
    """Return the lowest bone that translates and has more than half of the skeleton below it, normally the hips; this
    excludes hands and props.
    """
    below = {bone: len(_below(scene, bone)) for bone in clip.translations_cm}
    trunk = [bone for bone, count in below.items() if 2 * count > len(scene.bones)]
    return max(trunk, default=0)


def _below(scene: Scene, first: int) -> list[int]:
    """Return the indices of a bone and all its descendants, parents first."""
    chosen = {first}
    for index, bone in enumerate(scene.bones):
        if bone.parent in chosen:
            chosen.add(index)
    return sorted(chosen)


def _without_props(scene: Scene, clip: Clip, bones: list[int], first: int) -> list[int]:
    """Return ``bones`` without those that have no children and move relative to their parent, such as props; the bone
    ``first`` stays."""
    parents = {bone.parent for bone in scene.bones}
    return [bone for bone in bones if bone == first or bone in parents or bone not in clip.translations_cm]


def _world(scene: Scene, clip: Clip, bone: int) -> tuple[FloatArray, FloatArray]:
    """Return the world position (F, 3) and rotation (F, 4) of a bone in all frames."""
    place, rotation = np.zeros((clip.frames, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (clip.frames, 1))
    while bone >= 0:
        own = np.asarray(clip.rotations_xyzw[:, bone], np.float64)
        moved = np.asarray(clip.translations_cm.get(bone, scene.bones[bone].translation_cm), np.float64)
        place = quaternion.rotate(own, place) + moved
        rotation = quaternion.multiply(own, rotation)
        bone = scene.bones[bone].parent
    return place, rotation


def _end_sites_cm(scene: Scene, chosen: list[int]) -> dict[int, FloatArray]:
    """Return by bone index the end point (3,) of each chosen bone without children, in centimetres in the bone's frame:
    along its direction as far as its skin reaches."""
    parents = [bone.parent for bone in scene.bones]
    world_from_rest = world_transforms(
        tuple(parents),
        np.stack([np.asarray(bone.translation_cm, np.float64) for bone in scene.bones])[None],
        np.stack([np.asarray(bone.rotation_xyzw, np.float64) for bone in scene.bones])[None],
    )[0]
    last = sorted(set(chosen) - set(parents))
    points_cm = _own_points_cm(scene, last)
    ends = {}
    for bone in last:
        rest = world_from_rest[bone]
        way = rest[:3, :3].T @ (rest[:3, 3] - world_from_rest[parents[bone], :3, 3])
        length = np.linalg.norm(way)
        direction = way / length if length > 0 else np.array([0.0, 1.0, 0.0])
        lengths = [float(np.max(points @ direction)) for points in points_cm[bone]]
        ends[bone] = direction * max([*lengths, _SHORTEST_CM])
    return ends


def _own_points_cm(scene: Scene, bones: Sequence[int]) -> dict[int, list[FloatArray]]:
    """Return for each of some bones a list, with an array (N, 3) for each mesh, of the vertices that it mainly moves,
    in the bone's frame in centimetres.
    """
    found: dict[int, list[FloatArray]] = {bone: [] for bone in bones}
    requested = np.zeros(len(scene.bones), bool)
    requested[list(bones)] = True
    for mesh in scene.meshes:
        vertices, slots = np.nonzero(requested[mesh.joint_indices])
        joints, weights = mesh.joint_indices[vertices, slots], mesh.weights[vertices, slots]
        for bone in bones:
            here = joints == bone
            shares = np.bincount(vertices[here], weights[here])
            own = np.flatnonzero(shares > OWN_VERTEX)
            if own.size:
                bind = np.asarray(mesh.world_from_bone_bind[bone], np.float64)
                found[bone].append((mesh.vertices_cm[own] - bind[:3, 3]) @ bind[:3, :3])
    return found


SPINE = ("spine", "chest", "upperChest")


def joint_names(table: BoneNames) -> dict[str, str]:
    """Return a bone name for every joint in a table of names, the first if there are several. If the table names fewer
    bones between hips and neck than there are joints, the lowest joints get them.
    """
    result = {joint: names[0] for joint, names in table.middle.items()}
    result |= {joint: names[0] for joint, names in zip(SPINE, table.spine, strict=False)}
    for side, words in (("left", table.left), ("right", table.right)):
        result |= {side + joint: names[0].replace("{side}", words[0]) for joint, names in table.sides.items()}
    return result


def profile_names(profile: str, target: TargetSkeleton, skeleton: Skeleton) -> dict[int, str]:
    """Return names from a table of bone names for the bones of a target skeleton, by bone index; a bone that is no
    joint in the table keeps its name.

    Parameters
    ----------
    profile : str
        Name of the table.
    target : TargetSkeleton
        Skeleton whose bones are named.
    skeleton : Skeleton
        Skeleton of the character, whose joints correspond to the target's bones.
    """
    names = joint_names(load_bone_names()[profile])
    joints = {joint: names[name] for joint, name in enumerate(skeleton.names) if name in names}
    return {bone: joints[joint] for joint, bone in target.bone_of_joint.items() if joint in joints}
