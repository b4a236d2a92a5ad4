"""A figure as its own file has it: bones under their own names, the rest pose they were built in, meshes, morphs.

A `Figure` becomes a `Character` when its bones are known as joints (`app.rig.characters.joint_mapping`); the character
remembers by `OwnSkeleton` where its joints came from, so that a motion can be given back to the very bones of the file.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

from app.arrays import FloatArray
from app.errors import FileError, Message
from app.rig.mesh import Mesh

Origin: TypeAlias = Literal["vrm0", "vrm1", "gltf", "fbx", "bvh"]
"""Kind of file that a figure came from."""
MOST_LISTED: Final = 100
"""Bones or meshes that the error of an unknown one lists."""


@dataclass(frozen=True, eq=False)
class Figure:
    """Bones and meshes at rest, in metres, Y up, facing +Z; scales of bones are multiplied out.

    Attributes
    ----------
    file : str
        For messages.
    bone_names : tuple of str
        As in the file, each once.
    parents : tuple of int
        A parent before its children; -1: a root.
    translations_m : (B, 3) float64
    rotations : (B, 4) float64
        ``parent_from_bone`` at rest.
    meshes : tuple of Mesh
        Vertices where they are in the world at rest; `Mesh.joints` are indices of bones.
    humanoid : mapping of str to int
        Bones whose VRM 1.0 joint the file itself says; empty where it says nothing.
    expressions : mapping of str to mapping of str to float
        What the file's own expressions (VRM presets, by their VRM 1.0 names) are: weights 0..1 of its morphs.
    notes : tuple of Message
        What the reader had to guess.
    posed : (B, 4) float64 or None
        ``parent_from_bone`` as the nodes of a VRM file stand, which is its T-pose: others than `rotations` where the
        skin was bound in another pose. None of other files.
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
        """The figure without some of its meshes, by name.

        Raises
        ------
        FileError
            ``figure.no_mesh`` where it has none of a name; ``figure.all_hidden`` where none is left.
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
    def morph_names(self) -> tuple[str, ...]:
        """Names of the morphs of all meshes, each once, in the file's order."""
        return tuple(dict.fromkeys(morph.name for mesh in self.meshes for morph in mesh.morphs))


@dataclass(frozen=True, eq=False)
class OwnSkeleton:
    """Origin of a character's joints.

    Attributes
    ----------
    bone_of_joint : tuple of int
        By joint of the character's skeleton: the bone of the figure, or -1 for a joint that the file lacks and that
        was supplied (a finger of a mitten, our root).
    joint_from_bone : (J, 4) float64
        In the T-pose, as a rotation: ``world_from_bone = world_from_joint * joint_from_bone`` in every pose.
    t_pose : (B, 4) float64
        ``parent_from_bone`` of the figure's bones in the T-pose; bones that are no joint keep their rest rotation.
    morphs : mapping of str to mapping of str to float
        By ARKit name: weights of the figure's morphs that make it.
    beside : mapping of int to int
        Joint by bone: further bones of a joint that has several, as a hand of which each finger has a bone from the
        wrist on.
    """

    figure: Figure
    bone_of_joint: tuple[int, ...]
    joint_from_bone: FloatArray
    t_pose: FloatArray
    morphs: Mapping[str, Mapping[str, float]]
    beside: Mapping[int, int] = field(default_factory=dict)
