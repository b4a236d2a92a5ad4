"""Characters and instrument models as values: skeleton, skinned meshes, morph targets, landmarks, moving nodes.

Every skeleton is *normalised*: in the rest pose (T-pose) all joint frames are parallel to the world, so that local
rotations are the identity. The bind pose of the skin may be another pose (see `Character.joint_from_mesh`). Values with
arrays compare and hash by identity, so that they can be keys of caches.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray
from app.rig.figure import OwnSkeleton
from app.rig.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints in topological order (parents before children); joint 0 is the only root.

    Attributes
    ----------
    names : tuple of str
        ``root``, then VRM 1.0 humanoid names and any further joints of the character.
    parents : tuple of int
        Index of each joint's parent, -1 for the root.
    offsets_m : (J, 3) float64
        Offset of each joint in its parent's frame at rest, metres.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: FloatArray

    def index(self, name: str) -> int:
        """Return the index of a joint; KeyError if there is none."""
        try:
            return self.names.index(name)
        except ValueError:
            raise KeyError(name) from None


@dataclass(frozen=True, eq=False)
class Landmark:
    """A named place on a mesh: the mean of some vertices, e.g. ``right.index.pad``."""

    mesh: str
    vertices: npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Character:
    """A body that can be posed and exported.

    Attributes
    ----------
    joint_from_mesh : (J, 4, 4) float64
        Inverse bind matrices; skinning is ``world_from_joint @ joint_from_mesh @ position``.
    own : OwnSkeleton or None
        Original figure and its bones, if the skeleton was made from those of the user's file; else None.
    hands_of : Character or None
        Character with identical hands, down to the vertices; None if the hands are unique.
    made_from : Character or None
        Bundled body that a person is made from; None for a character read from a file.
    made_of : str
        Digest of the phenotype of a bundled body that was made from another one; empty for other bodies.
    undressed : Character or None
        The same body in its own clothes, of a character in an outfit; None for one in its own clothes.
    """

    id: str
    skeleton: Skeleton
    joint_from_mesh: FloatArray
    meshes: tuple[Mesh, ...]
    landmarks: dict[str, Landmark]
    own: OwnSkeleton | None = None
    hands_of: Character | None = None
    made_from: Character | None = None
    made_of: str = ""
    undressed: Character | None = None


@dataclass(frozen=True, eq=False)
class InstrumentModel:
    """An instrument's nodes and meshes, in the instrument's frame (origin at the rim, +Z along the air, +Y up).

    Attributes
    ----------
    node_names : tuple of str
        Node 0 is the root; the others are the moving parts, each a child of the root.
    node_positions_m : (N, 3) float64
        Rest position of each node in the instrument's frame (rest rotations are the identity).
    meshes : tuple of Mesh
        Meshes with vertices in the instrument's frame at rest; `Mesh.joints` is the node that each vertex moves with.
    """

    id: str
    node_names: tuple[str, ...]
    node_positions_m: FloatArray
    meshes: tuple[Mesh, ...]
