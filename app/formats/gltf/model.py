"""The contents of a glTF file as plain values.

Units as in glTF: metres, right-handed, Y up, quaternions xyzw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class GltfMorph:
    """A morph target with the vertices it moves.

    Attributes
    ----------
    name : str
        Name in the mesh's ``extras.targetNames``; else ``morph_0`` and so on.
    vertex_indices : ndarray of int64, shape (K,)
        Indices of the K moved vertices.
    position_deltas : ndarray, shape (K, 3)
        Their displacements at full weight.
    normal_deltas : ndarray, shape (K, 3), or None
        Changes of their normals.
    """

    name: str
    vertex_indices: IntArray
    position_deltas: FloatArray
    normal_deltas: FloatArray | None


@dataclass(frozen=True, eq=False)
class GltfPrimitive:
    """Triangles of one material in a glTF mesh.

    Attributes
    ----------
    positions : ndarray, shape (V, 3)
        Positions of the V vertices.
    normals : ndarray, shape (V, 3), or None
        Normals of the vertices.
    uvs : ndarray, shape (V, 2), or None
        First set of texture coordinates; v points down, as in glTF.
    triangles : ndarray of int64, shape (T, 3)
        Vertex indices.
    joint_indices : ndarray of int64, shape (V, 4 * sets)
        Indices into the skin's joints, all sets side by side; no columns without a skin.
    weights : ndarray, shape (V, 4 * sets)
        Weights of these joints.
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
    """A glTF mesh, made of one primitive for each material."""

    name: str
    primitives: tuple[GltfPrimitive, ...]

    @property
    def morph_names(self) -> tuple[str, ...]:
        """Names of the morph targets, shared by all primitives."""
        return tuple(morph.name for morph in self.primitives[0].morphs) if self.primitives else ()


@dataclass(frozen=True, eq=False)
class GltfSkin:
    """A skin: nodes that move a mesh.

    Attributes
    ----------
    joints : tuple of int
        Indices of nodes.
    joint_from_mesh_bind : ndarray, shape (J, 4, 4)
        Inverse bind matrices, for column vectors.
    """

    name: str
    joints: tuple[int, ...]
    joint_from_mesh_bind: FloatArray


@dataclass(frozen=True)
class GltfTextureUse:
    """A texture reference of a material, with scale and offset of ``KHR_texture_transform``."""

    image: int
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class GltfMaterial:
    """A metallic-roughness material; colours are linear."""

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
        Index of the parent; -1 for none.
    translation : ndarray, shape (3,)
        Translation relative to the parent.
    rotation_xyzw : ndarray, shape (4,)
        Rotation relative to the parent.
    scale : ndarray, shape (3,)
        Scale.
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
        Animated property: ``translation``, ``rotation``, ``scale`` or ``weights``.
    interpolation : str
        ``LINEAR``, ``STEP`` or ``CUBICSPLINE``.
    times_s : ndarray, shape (K,)
        Key times, ascending.
    values : ndarray, shape (K, W), or (3 * K, W) of cubic splines
        Values of width W at the keys; for cubic splines in-tangent, value and out-tangent of each key.
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
        Channels of nodes' transforms.
    weights : tuple of GltfChannel
        Channels of morph weights, by node; only if requested.
    extras : mapping
        The animation's ``extras``.
    """

    name: str
    channels: tuple[GltfChannel, ...]
    weights: tuple[GltfChannel, ...] = ()
    extras: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class GltfImage:
    """An image: the undecoded bytes of its file; empty if it is not in the glTF file."""

    name: str
    content: bytes


@dataclass(frozen=True, eq=False)
class GltfModel:
    """Contents of a glTF file.

    Attributes
    ----------
    nodes : tuple of GltfNode
        Nodes in file order; parents need not come first.
    meshes, skins, materials : tuples
        In file order.
    images : tuple of GltfImage
    extensions : mapping
        Extensions of the document, such as ``VRMC_vrm``, as parsed JSON.
    scene_extras : mapping
        The ``extras`` of the default scene.
    generator : str
        Program that wrote the file.
    animations : tuple of GltfAnimation
        Animations; only if requested.
    size_bytes : int
        Total size of the file and its external files.
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
