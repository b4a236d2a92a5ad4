"""Contents of a glTF file, as plain values.

Units are glTF's: metres, right-handed, Y up, quaternions xyzw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class GltfMorph:
    """A morph target: the vertices it moves.

    Attributes
    ----------
    name : str
        From the mesh's ``extras.targetNames``; else ``morph_0`` ...
    vertex_indices : ndarray of int64, shape (K,)
    position_deltas : ndarray, shape (K, 3)
    normal_deltas : ndarray, shape (K, 3), or None
    """

    name: str
    vertex_indices: IntArray
    position_deltas: FloatArray
    normal_deltas: FloatArray | None


@dataclass(frozen=True, eq=False)
class GltfPrimitive:
    """Triangles of one material.

    Attributes
    ----------
    positions : ndarray, shape (V, 3)
    normals : ndarray, shape (V, 3), or None
    uvs : ndarray, shape (V, 2), or None
        First set; v points down, as glTF has it.
    triangles : ndarray of int64, shape (T, 3)
    joint_indices : ndarray of int64, shape (V, 4 * sets)
        Into the skin's joints; all sets side by side, no columns without a skin.
    weights : ndarray, shape (V, 4 * sets)
    """

    positions: FloatArray
    normals: FloatArray | None
    uvs: FloatArray | None
    triangles: IntArray
    material: int | None
    joint_indices: IntArray
    weights: FloatArray
    morphs: tuple[GltfMorph, ...]


@dataclass(frozen=True, eq=False)
class GltfMesh:
    """A mesh: its parts of one material each."""

    name: str
    primitives: tuple[GltfPrimitive, ...]

    @property
    def morph_names(self) -> tuple[str, ...]:
        """Names of its morph targets, which all its parts have."""
        return tuple(morph.name for morph in self.primitives[0].morphs) if self.primitives else ()


@dataclass(frozen=True, eq=False)
class GltfSkin:
    """A skin: nodes that move a mesh.

    Attributes
    ----------
    joints : tuple of int
        Indices of nodes.
    joint_from_mesh_bind : ndarray, shape (J, 4, 4)
        The inverse bind matrices, for column vectors.
    """

    name: str
    joints: tuple[int, ...]
    joint_from_mesh_bind: FloatArray


@dataclass(frozen=True)
class GltfTextureUse:
    """An image as a material uses it, with the scale and offset of ``KHR_texture_transform``."""

    image: int
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class GltfMaterial:
    """A metallic-roughness surface; colours are linear."""

    name: str
    base_color_rgba: tuple[float, float, float, float]
    metallic: float
    roughness: float
    alpha_mode: str
    double_sided: bool
    alpha_cutoff: float = 0.5
    color: GltfTextureUse | None = None
    normal: GltfTextureUse | None = None
    metallic_roughness: GltfTextureUse | None = None
    occlusion: GltfTextureUse | None = None
    normal_scale: float = 1.0
    occlusion_strength: float = 1.0


@dataclass(frozen=True, eq=False)
class GltfNode:
    """A node of the hierarchy.

    Attributes
    ----------
    parent : int
        -1: none.
    translation : ndarray, shape (3,)
    rotation_xyzw : ndarray, shape (4,)
    scale : ndarray, shape (3,)
    """

    name: str
    parent: int
    translation: FloatArray
    rotation_xyzw: FloatArray
    scale: FloatArray
    mesh: int | None
    skin: int | None
    extensions: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class GltfChannel:
    """Animation of one part of a node's transform; see `app.formats.gltf.animation`.

    Attributes
    ----------
    path : str
        ``translation``, ``rotation``, ``scale`` or ``weights``.
    interpolation : str
        ``LINEAR``, ``STEP`` or ``CUBICSPLINE``.
    times_s : ndarray, shape (K,)
        Ascending.
    values : ndarray, shape (K, W), or (3 * K, W) of cubic splines
    """

    node: int
    path: str
    interpolation: str
    times_s: FloatArray
    values: FloatArray


@dataclass(frozen=True, eq=False)
class GltfAnimation:
    """An animation of a glTF file: its channels.

    Attributes
    ----------
    channels : tuple of GltfChannel
        Of nodes' transforms.
    weights : tuple of GltfChannel
        Of the morphs of the meshes on nodes; only where they were asked for.
    extras : mapping
        Its ``extras``.
    """

    name: str
    channels: tuple[GltfChannel, ...]
    weights: tuple[GltfChannel, ...] = ()
    extras: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class GltfImage:
    """An image: the bytes of its file, not decoded; empty if it is not in the glTF file."""

    name: str
    content: bytes


@dataclass(frozen=True, eq=False)
class GltfModel:
    """A whole file.

    Attributes
    ----------
    nodes : tuple of GltfNode
        In the file's order, which need not have parents first.
    meshes, skins, materials : tuples
    images : tuple of GltfImage
    extensions : mapping
        The document's, e.g. ``VRMC_vrm``, as parsed JSON.
    scene_extras : mapping
        The ``extras`` of the scene that is shown.
    generator : str
        The program that wrote the file.
    animations : tuple of GltfAnimation
        Only where they were asked for.
    size_bytes : int
        Of the file and of what lies beside it.
    """

    nodes: tuple[GltfNode, ...]
    meshes: tuple[GltfMesh, ...]
    skins: tuple[GltfSkin, ...]
    materials: tuple[GltfMaterial, ...]
    images: tuple[GltfImage, ...] = ()
    extensions: Mapping[str, Any] = field(default_factory=dict)
    scene_extras: Mapping[str, Any] = field(default_factory=dict)
    generator: str = ""
    animations: tuple[GltfAnimation, ...] = ()
    size_bytes: int = 0
