"""A figure as stored in its file: named bones, rest pose, meshes, morphs.

A `Figure` becomes a `Character` when its joints are identified (`app.rig.characters.joint_mapping`). The character
keeps the origin of its joints in an `OwnSkeleton`, so that motion can be transferred back to the file's bones.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from app.arrays import FloatArray
from app.errors import FileError, Message
from app.rig.mesh import Mesh

Origin: TypeAlias = Literal["vrm0", "vrm1", "gltf", "fbx", "bvh"]
"""Kind of file that a figure was read from."""
MOST_LISTED: Final = 100
"""Number of bones or meshes listed in the error about an unknown name."""


@dataclass(frozen=True, eq=False)
class Figure:
    """Bones and meshes at rest, in metres, Y up, facing +Z; without scales.

    Attributes
    ----------
    file : str
        Name of the file, for messages.
    bone_names : tuple of str
        Names in the file, made unique.
    parents : tuple of int
        Parent of each bone, before its children; -1 for a root.
    translations_m : (B, 3) float64
        Positions relative to the parent at rest.
    rotations : (B, 4) float64
        ``parent_from_bone`` at rest.
    meshes : tuple of Mesh
        Meshes with vertices in the world at rest; `Mesh.joints` are indices of bones.
    humanoid : mapping of str to int
        Bone of each VRM 1.0 joint, if the file contains this; otherwise empty.
    expressions : mapping of str to mapping of str to float
        Weights 0..1 of morphs in the file's expressions (VRM presets under VRM 1.0 names).
    notes : tuple of Message
        Notes about guesses of the reader.
    posed : (B, 4) float64 or None
        ``parent_from_bone`` of the nodes as stored in a VRM file, which are in T-pose; differs from `rotations` if the
        skin was bound in another pose. None for other files.
    """

    file: str
    origin: Origin
    bone_names: tuple[str, ...]
    parents: tuple[int, ...]
    translations_m: FloatArray
    rotations: FloatArray
    meshes: tuple[Mesh, ...]
    humanoid: Mapping[str, int] = field(default_factory=dict)
    expressions: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    notes: tuple[Message, ...] = ()
    posed: FloatArray | None = None

    def without(self, hidden: Collection[str]) -> Figure:
        """Return the figure without some meshes, given by name.

        Raises
        ------
        FileError
            A mesh is unknown, or no mesh would remain.
        """
        if not hidden:
            return self
        names = list(dict.fromkeys(mesh.name for mesh in self.meshes))
        for name in hidden:
            if name not in names:
                raise FileError("figure.no_mesh", file=self.file, mesh=name, meshes=", ".join(names[:MOST_LISTED]))
        shown = tuple(mesh for mesh in self.meshes if mesh.name not in hidden)
        if not shown:
            raise FileError("figure.all_hidden", file=self.file)
        return replace(self, meshes=shown)

    @property
    def is_skinned(self) -> bool:
        """True if different bones move parts of a mesh; False for meshes without a skeleton."""
        return any(
            bool(np.ptp(mesh.joints[mesh.weights > 0.0]) > 0) for mesh in self.meshes if (mesh.weights > 0.0).any()
        )

    @property
    def morph_names(self) -> tuple[str, ...]:
        """Names of the morphs of all meshes, each once, in the file's order."""
        return tuple(dict.fromkeys(morph.name for mesh in self.meshes for morph in mesh.morphs))


@dataclass(frozen=True, eq=False)
class OwnSkeleton:
    """The user's figure from which a character was made, and how its bones relate to the joints.

    Attributes
    ----------
    bone_of_joint : tuple of int
        Bone of the figure for each joint of the skeleton; -1 for an added joint (a mitten's finger, the root).
    joint_from_bone : (J, 4) float64
        Rotation from bone to joint in the T-pose: ``world_from_bone = world_from_joint * joint_from_bone`` in every
        pose.
    t_pose : (B, 4) float64
        ``parent_from_bone`` of the figure's bones in T-pose; bones that are no joints keep their rest rotation.
    morphs : mapping of str to mapping of str to float
        Weights of the figure's morphs by ARKit shape.
    beside : mapping of int to int
        Joint of each additional bone of a joint, as in a hand with a bone for each finger from the wrist on.
    """

    figure: Figure
    bone_of_joint: tuple[int, ...]
    joint_from_bone: FloatArray
    t_pose: FloatArray
    morphs: Mapping[str, Mapping[str, float]]
    beside: Mapping[int, int] = field(default_factory=dict)
