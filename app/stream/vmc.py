"""A performer's pose as messages of the VMC protocol's sending side (https://protocol.vmc.info).

A receiver shows one character for each port. It receives the local rotation of every bone relative to a T-pose in which
all rotations are zero, the face, and for players the instrument as a tracker, to which a model can be attached.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.motion.faces.eyes import EYE_SHAPES
from app.project.casting import StagePosition
from app.rig import quaternion
from app.rig.model import Character
from app.stream.faces import FaceNames, face_layout
from app.stream.packets import Head, Packets

if TYPE_CHECKING:
    from app.performance.chunks import Pose


PORT: Final = 39539
"""Default port of a receiver."""
LOADED = 1
"""Value of the state message: the model is loaded."""
_TRANSFORM = 7
"""Number of floats of a position and a rotation."""
IN_THE_MIDDLE = StagePosition(0.0, 0.0, 0.0)


class Sent:
    """Converts a performer's poses to VMC messages: bones by name, face, and instrument.

    Parameters
    ----------
    instrument : str or None
        Name of the instrument's tracker; None if the performer holds no instrument.
    doubles : tuple of str
        Names of trackers of other instruments that the performer changes to.
    """

    def __init__(
        self, character: Character, instrument: str | None, faces: FaceNames = "arkit", doubles: tuple[str, ...] = ()
    ) -> None:
        skeleton, own = character.skeleton, character.own
        self._hips = skeleton.index("hips")
        self._holds = instrument is not None
        # Joints that the character's file lacks do not exist in the receiver: their rotation is passed to the joints
        # below.
        has = [joint > 0 and (own is None or own.bone_of_joint[joint] >= 0) for joint in range(len(skeleton.names))]
        self._joints = np.flatnonzero(has)
        self._offsets_m = skeleton.offsets_m[self._joints].copy()
        self._between = dict[int, tuple[int, ...]]()
        for place, joint in enumerate(self._joints):
            above, parent = list[int](), skeleton.parents[joint]
            while parent > 0 and not has[parent]:
                above.append(parent)
                parent = skeleton.parents[parent]
            if above:
                self._between[place] = tuple(reversed(above))
        self._skeleton_offsets_m = skeleton.offsets_m
        self._hips_place = int(np.flatnonzero(self._joints == self._hips)[0])
        # Bones turn the eyes, and receivers would add the rotation of eye shapes.
        morphs = {morph.name for mesh in character.meshes for morph in mesh.morphs} - set(EYE_SHAPES)
        self._face = face_layout(faces, sorted(morphs))
        names = [unity_bone(skeleton.names[joint]) for joint in self._joints]
        heads = [
            Head("/VMC/Ext/OK", (LOADED,)),
            Head("/VMC/Ext/T", (), 1),
            Head("/VMC/Ext/Root/Pos", ("root",), _TRANSFORM),
            *(Head("/VMC/Ext/Bone/Pos", (name,), _TRANSFORM) for name in names),
            *([] if instrument is None else [Head("/VMC/Ext/Tra/Pos", (instrument,), _TRANSFORM)]),
            *(Head("/VMC/Ext/Tra/Pos", (name,), _TRANSFORM) for name in doubles),
            *(Head("/VMC/Ext/Blend/Val", (name,), 1) for name in self._face.names),
        ]
        if self._face.names:
            heads.append(Head("/VMC/Ext/Blend/Apply"))
        self._packets = Packets(heads)

    def datagrams(
        self, pose: Pose, time_s: float, stage: StagePosition = IN_THE_MIDDLE, beside: Sequence[Pose] = ()
    ) -> list[bytes]:
        """Convert a pose to the network packets to send.

        Parameters
        ----------
        time_s : float
            Time since the beginning of the stream in seconds.
        stage : StagePosition, optional
            The performer's place; by default the middle, facing the audience.
        beside : sequence of Pose
            Poses of the same body with each of the other instruments.
        """
        root_m = np.array([stage.x_m, 0.0, stage.z_m])
        root = np.array([0.0, np.sin(stage.turn_rad / 2.0), 0.0, np.cos(stage.turn_rad / 2.0)])
        bones_m, bones = self._local(pose)
        values = [[time_s], _transforms(root_m[None], root[None]), _transforms(bones_m, bones)]
        for one in (pose, *beside) if self._holds else ():
            held_m = root_m + quaternion.rotate(root, one.instrument_position_m)
            held = quaternion.multiply(root, one.instrument_rotation)
            values.append(_transforms(held_m[None], held[None]))
        return self._packets.filled(np.concatenate([*values, self._face.values(pose.morphs)]))

    def _local(self, pose: Pose) -> tuple[AnyFloatArray, AnyFloatArray]:
        """Return positions (B, 3) and rotations (B, 4) of the sent bones, each relative to the nearest sent bone above
        it."""
        rotations = quaternion.normalize(pose.rotations[self._joints])
        positions_m = self._offsets_m.copy()
        positions_m[self._hips_place] = pose.hips_m
        for place, between in self._between.items():
            turned, moved_m = quaternion.IDENTITY, np.zeros(3)
            for joint in between:
                moved_m = moved_m + quaternion.rotate(turned, self._skeleton_offsets_m[joint])
                turned = quaternion.multiply(turned, pose.rotations[joint])
            positions_m[place] = moved_m + quaternion.rotate(turned, positions_m[place])
            rotations[place] = quaternion.multiply(turned, rotations[place])
        return positions_m, rotations


def _transforms(positions_m: AnyFloatArray, rotations: AnyFloatArray) -> AnyFloatArray:
    """Convert positions (B, 3) and rotations (B, 4) of B bones to Unity's coordinate system, as one row with seven
    numbers per bone.
    """
    return np.concatenate([unity_positions(positions_m), unity_rotations(rotations)], axis=1).ravel()


# Conversion to Unity's frame: left-handed, Y up, +X to the right when facing +Z; bones as in `HumanBodyBones`.
_UNITY_POSITION = np.array([-1.0, 1.0, 1.0])
_UNITY_ROTATION = np.array([1.0, -1.0, -1.0, 1.0])
# The first thumb bone is a metacarpal in VRM 1.0 and the proximal one in Unity.
_THUMB = {"ThumbMetacarpal": "ThumbProximal", "ThumbProximal": "ThumbIntermediate"}


def unity_positions(positions_m: AnyFloatArray) -> FloatArray:
    """Convert positions (..., 3) in metres to Unity's coordinate system."""
    return np.asarray(positions_m * _UNITY_POSITION + 0.0, np.float64)


def unity_rotations(rotations: AnyFloatArray) -> FloatArray:
    """Convert rotations (..., 4), xyzw, to Unity's coordinate system."""
    return np.asarray(rotations * _UNITY_ROTATION, np.float64)


def unity_bone(joint: str) -> str:
    """Return the name in Unity's `HumanBodyBones` of a VRM 1.0 joint."""
    for side in ("left", "right"):
        if joint.startswith(side):
            part = joint.removeprefix(side)
            return side.capitalize() + _THUMB.get(part, part)
    return joint[:1].upper() + joint[1:]
