"""Motion of the normalised skeleton's joints, computed from a file with any skeleton."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.export.face_curves import CurveNames, curve_names
from app.export.playback import ScenePlayback
from app.export.target import TargetSkeleton
from app.formats.scene import SkinnedMesh
from app.rig import quaternion
from app.rig.figure import OwnSkeleton
from app.rig.model import Character, Landmark, Skeleton

_TRUNK = ("spine", "chest", "upperChest", "neck", "head")


class JointPlayback:
    """Motion of joints derived from the bones of a file: ``world_from_joint = world_from_bone *
    inverse(joint_from_bone)``.

    Bones are matched by name. A joint without a bone does not rotate; joints of the trunk that the file merges into one
    bone share its rotation equally.

    Parameters
    ----------
    playback : ScenePlayback
        Motion of the file's bones.
    target : TargetSkeleton
        Correspondence of bones and joints.
    character : Character
        Character whose joints are computed.
    """

    def __init__(self, playback: ScenePlayback, target: TargetSkeleton, character: Character) -> None:
        self.playback = playback
        self._target = target
        self._character = character
        place = {name: bone for bone, name in enumerate(playback.bone_names)}
        absent = [name for name in target.names if name not in place]
        if absent:
            raise ValueError(f"the file lacks bones of the skeleton that it was written on: {', '.join(absent)}")
        self._bones = {joint: place[target.names[bone]] for joint, bone in target.bone_of_joint.items()}
        moved = target.loose | _elsewhere(target, character.skeleton)
        self._moved = {place[target.names[bone]] for bone in moved}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the character's joints, in the order of their indices."""
        return self._character.skeleton.names

    @cached_property
    def joint_names(self) -> Mapping[int, str]:
        """Names of the joints that the file's bones represent, by bone index."""
        return {bone: self.names[joint] for joint, bone in self._bones.items()}

    def bone(self, *joints: str) -> int:
        """Return the index of the bone of the first of some joints that has one; KeyError if none has."""
        for name in joints:
            if name in self.names and self.names.index(name) in self._bones:
                return self._bones[self.names.index(name)]
        raise KeyError(joints[0])

    @cached_property
    def rigid(self) -> BoolArray:
        """Mask (B,) of the bones whose length must be constant: all except roots, the hips and bones with
        constraints.
        """
        parents = self.playback.parents
        return np.array([parent >= 0 and bone not in self._moved for bone, parent in enumerate(parents)])

    def rotations(self, first: int, last: int) -> FloatArray:
        """Return the rotations ``parent_from_joint`` (n, J, 4) of all J joints at the n frames ``first`` .. ``last -
        1``."""
        if self._target.choice == "suisou" and self.playback.bone_names == self.names:
            return self.playback.rotations(first, last)
        return self._joint_rotations(slice(first, last))

    def curve(self, morph: str, names: CurveNames = "arkit") -> FloatArray:
        """Return the weight (F,) of a morph by its ARKit name; zeros if the file lacks it.

        ``names`` is the convention by which the file's curves are named.
        """
        curves = self.playback.clip.morph_weights
        frames = self.playback.clip.frames
        shapes: Mapping[str, float] = {morph: 1.0}
        if self._target.choice == "own" and self._character.own is not None:
            shapes = self._character.own.morphs.get(morph, {})
        table = curve_names(names)
        parts = [
            (curve, part * share)
            for shape, part in shapes.items()
            for curve, share in table.get(shape, {shape: 1.0}).items()
        ]
        shown = [np.asarray(curves[curve], np.float64) / part for curve, part in parts if curve in curves and part]
        return np.minimum(np.max(shown, axis=0), 1.0) if shown else np.zeros(frames)

    def surface(self, landmark: Landmark) -> tuple[SkinnedMesh, IntArray]:
        """Return the mesh of the exported file that contains a landmark, and the landmark's vertices in it (K,).

        A file on the character's own skeleton has separate meshes, any other has them joined in order.
        """
        meshes, start = self.playback.scene.meshes, 0
        own: OwnSkeleton | None = self._character.own if self._target.choice == "own" else None
        for index, mesh in enumerate(self._character.meshes):
            if mesh.name == landmark.mesh:
                return meshes[index if own is not None else 0], landmark.vertices.astype(np.int64) + start
            start += 0 if own is not None else len(mesh.positions_m)
        raise KeyError(landmark.mesh)

    def _joint_rotations(self, span: slice) -> FloatArray:
        turns = self.playback.rotations(span.start, span.stop).swapaxes(0, 1)
        bones = np.empty_like(turns)
        for bone, parent in enumerate(self.playback.parents):
            bones[bone] = quaternion.multiply(bones[parent], turns[bone]) if parent >= 0 else turns[bone]
        world: list[FloatArray] = []
        result = np.tile(quaternion.IDENTITY, (span.stop - span.start, len(self.names), 1))
        for joint, parent in enumerate(self._character.skeleton.parents):
            above = world[parent] if parent >= 0 else result[:, 0]
            if joint not in self._bones:
                world.append(above)
                continue
            own = self._target.joint_from_bone[self._target.bone_of_joint[joint]]
            world.append(quaternion.multiply(bones[self._bones[joint]], quaternion.conjugate(own)))
            turn = quaternion.multiply(quaternion.conjugate(above), world[joint])
            together = self._together(joint)
            if len(together) > 1:
                turn = quaternion.slerp(quaternion.IDENTITY, turn, 1.0 / len(together))
            result[:, together] = turn[:, None]
        return result

    def _together(self, joint: int) -> list[int]:
        """Return a joint and all trunk joints above it that the file merges into the same bone."""
        found = [joint]
        if self.names[joint] in _TRUNK:
            above = self._character.skeleton.parents[joint]
            while above not in self._bones and self.names[above] in _TRUNK:
                found.append(above)
                above = self._character.skeleton.parents[above]
        return found


def _elsewhere(target: TargetSkeleton, skeleton: Skeleton) -> set[int]:
    """Return the bones of joints whose nearest mapped ancestor joint is not above them in the file's hierarchy.

    An example is a thumb attached to the forearm in a rig where each finger has its own bone from the wrist on.
    """
    there, found = set(target.joint_of_bone), set[int]()
    for bone, joint in enumerate(target.joint_of_bone):
        top = skeleton.parents[joint] if joint >= 0 else -1
        while top >= 0 and top not in there:
            top = skeleton.parents[top]
        above = target.parents[bone]
        while above >= 0 and target.joint_of_bone[above] != top:
            above = target.parents[above]
        if top >= 0 and above < 0:
            found.add(bone)
    return found
