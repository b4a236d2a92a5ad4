"""The contents of an animation file as plain values: bones, skinned meshes, morphs, materials, one clip; a file may
hold several such scenes, each with a place.

Centimetres, right-handed, Y up. Quaternions are xyzw, matrices apply to column vectors. There is no scaling.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray
from app.formats.euler import matrices
from app.formats.joint_angles import order_along
from app.formats.keys import Keys
from app.formats.textures import NO_TEXTURES, AlphaMode, MaterialTextures


@dataclass(frozen=True, eq=False)
class Bone:
    """A joint of the skeleton.

    Attributes
    ----------
    parent : int
        Index of a previous bone; -1 for the only root.
    translation_cm : ndarray, shape (3,)
        Rest position relative to the parent.
    rotation_xyzw : ndarray, shape (4,)
        Rest rotation relative to the parent; used if the clip does not animate the bone.
    axes : ndarray, shape (3, 3), or None
        Rotation axes in the bone's space, outermost first, for formats with Euler angles: a hinge first, the axis with
        least rotation in the middle. None for no preferred axes.
    """

    name: str
    parent: int
    translation_cm: AnyFloatArray
    rotation_xyzw: AnyFloatArray
    axes: AnyFloatArray | None = None

    @property
    def order(self) -> str:
        """Euler order of the bone, as in `app.formats.euler`."""
        return order_along(self.axes)


@dataclass(frozen=True, eq=False)
class MorphTarget:
    """A morph target (blend shape).

    Attributes
    ----------
    name : str
        Name, unique within a mesh; the clip's weight of this name drives all morphs of that name.
    vertex_indices : ndarray of int, shape (K,)
        Indices of the K moved vertices.
    position_deltas_cm : ndarray, shape (K, 3)
        Their displacements at weight 1.
    normal_deltas : ndarray, shape (K, 3), or None
        Changes of their normals; None if they do not change.
    """

    name: str
    vertex_indices: AnyIntArray
    position_deltas_cm: AnyFloatArray
    normal_deltas: AnyFloatArray | None = None


@dataclass(frozen=True)
class Material:
    """A metallic-roughness material as in glTF 2.0: linear base colour RGBA, metallic and roughness from 0 to 1.

    Attributes
    ----------
    textures : MaterialTextures
        Textures that are multiplied with these values, if the mesh has UVs.
    alpha : AlphaMode or None
        Use of alpha; None for blending if the base colour is transparent, else opaque.
    alpha_cutoff : float
        Smallest visible alpha in mode ``mask``.
    """

    name: str
    base_color: tuple[float, float, float, float]
    metallic: float = 0.0
    roughness: float = 1.0
    double_sided: bool = False
    textures: MaterialTextures = NO_TEXTURES
    alpha: AlphaMode | None = None
    alpha_cutoff: float = 0.5

    @property
    def alpha_mode(self) -> AlphaMode:
        """The alpha mode in effect: the given one; else blending if the base colour is transparent, opaque
        otherwise.
        """
        return self.alpha or ("blend" if self.base_color[3] < 1.0 else "opaque")


@dataclass(frozen=True, eq=False)
class SkinnedMesh:
    """A mesh deformed by bones, in world space in its bind pose.

    Attributes
    ----------
    name : str
        Name, different from all bone names.
    vertices_cm : ndarray, shape (V, 3)
        Positions of the vertices.
    faces : ndarray of int, shape (T, N)
        Triangles, or polygons of N corners each, counter-clockwise seen from outside.
    normals : ndarray, shape (V, 3) or (T * N, 3)
        Normals per vertex or per corner; per vertex if both counts are equal.
    uvs : ndarray, shape (V, 2) or (T * N, 2), or None
        Texture coordinates per vertex or per corner; v points up (in glTF down).
    materials : tuple of Material
        At least one material.
    face_materials : ndarray of int, shape (T,), or None
        Index into `materials`; None if all faces have the first one.
    joint_indices : ndarray of int, shape (V, K)
        Indices of the bones that move each vertex, any number K.
    weights : ndarray, shape (V, K)
        Their weights; weights of 0 are ignored, and those of a repeated bone are added.
    world_from_bone_bind : ndarray, shape (J, 4, 4)
        Transform of every bone when the mesh was bound; equal for all meshes of a scene, and possibly different from
        the rest pose.
    levels : tuple of SkinnedMesh
        Lower levels of detail: the same mesh with fewer and fewer triangles; these have no levels.
    """

    name: str
    vertices_cm: AnyFloatArray
    faces: AnyIntArray
    normals: AnyFloatArray
    uvs: AnyFloatArray | None
    materials: tuple[Material, ...]
    face_materials: AnyIntArray | None
    joint_indices: AnyIntArray
    weights: AnyFloatArray
    world_from_bone_bind: AnyFloatArray
    morphs: tuple[MorphTarget, ...] = ()
    levels: tuple[SkinnedMesh, ...] = ()


@dataclass(frozen=True, eq=False)
class Clip:
    """A baked animation: values at every frame, the first at time zero.

    Attributes
    ----------
    frames : int
        Number of frames F, at least 1; the duration is ``(F - 1) / fps`` seconds.
    rotations_xyzw : ndarray, shape (F, J, 4)
        Rotation relative to the parent.
    translations_cm : mapping of int to ndarray, shape (F, 3)
        Translation relative to the parent, by bone index; only bones that translate.
    morph_weights : mapping of str to ndarray, shape (F,)
        Weight 0 to 1 by morph name.
    whole_turns : mapping of int to ndarray, shape (F, 4)
        Full rotations of bones that are partly rotated by morphs, for formats without morphs.
    keys : Keys or None
        The frames written as keys, in formats that support fewer keys; None for every frame.
    """

    name: str
    fps: Fraction
    frames: int
    rotations_xyzw: AnyFloatArray
    translations_cm: Mapping[int, AnyFloatArray] = field(default_factory=dict)
    morph_weights: Mapping[str, AnyFloatArray] = field(default_factory=dict)
    whole_turns: Mapping[int, AnyFloatArray] = field(default_factory=dict)
    keys: Keys | None = None

    @property
    def kind(self) -> tuple[str, Fraction, int]:
        """Return name, frame rate and number of frames, which must be equal for all clips of a file."""
        return self.name, self.fps, self.frames


@dataclass(frozen=True, eq=False)
class NodePlace:
    """Transform of a node: translation (3,) in centimetres and rotation (4,) xyzw."""

    translation_cm: AnyFloatArray
    rotation_xyzw: AnyFloatArray

    @property
    def matrix(self) -> FloatArray:
        """Transform ``world_from_node`` (4, 4) of the place."""
        result = np.eye(4)
        result[:3, :3] = matrices(np.asarray(self.rotation_xyzw, dtype=np.float64))
        result[:3, 3] = self.translation_cm
        return result


@dataclass(frozen=True, eq=False)
class Scene:
    """A character or an instrument with its animation.

    Attributes
    ----------
    bones : tuple of Bone
        Bones, parents first; the first one is the only root.
    creator : str
        Program and version for the file.
    name : str
        Name of the armature in other programs; empty for the clip's name, or else the root bone's.
    place : NodePlace or None
        Transform of a node of that name above the root bone. None for no such node, since Unreal may turn it into a
        bone; the name is then used only where the format allows.
    """

    bones: tuple[Bone, ...]
    meshes: tuple[SkinnedMesh, ...] = ()
    clip: Clip | None = None
    creator: str = "Suisou"
    name: str = ""
    place: NodePlace | None = None

    @property
    def title(self) -> str:
        """The name of the scene, or else that of the clip or of the root bone."""
        return self.name or (self.bones[0].name if self.clip is None else self.clip.name)


def without_meshes(scene: Scene) -> Scene:
    """Return the scene without meshes; its morph weights then refer to morphs in other files."""
    return replace(scene, meshes=())


def check_scene(scene: Scene) -> None:
    """Raise ValueError for a scene that no file can hold.

    Raises
    ------
    ValueError
        The scene is inconsistent, which is a programming error.
    """
    bone_count = len(scene.bones)
    if not bone_count or scene.bones[0].parent != -1:
        raise ValueError("the first bone must be the root")
    for index, bone in enumerate(scene.bones[1:], start=1):
        if not 0 <= bone.parent < index:
            raise ValueError(f"bone {bone.name!r}: its parent must come before it, and only the first is a root")
    meshes = [one for mesh in scene.meshes for one in (mesh, *mesh.levels)]
    names = [bone.name for bone in scene.bones] + [mesh.name for mesh in meshes]
    if len(set(names)) != len(names) or not all(names):
        raise ValueError("bones and meshes must have different, non-empty names")
    for mesh in meshes:
        _check_mesh(mesh, bone_count)
        if not np.array_equal(mesh.world_from_bone_bind, scene.meshes[0].world_from_bone_bind):
            raise ValueError(f"mesh {mesh.name!r}: bound in another pose than {scene.meshes[0].name!r}")
    if scene.clip is not None:
        _check_clip(scene.clip, bone_count)
        morphs = {morph.name for mesh in scene.meshes for morph in mesh.morphs}
        unknown = sorted(set(scene.clip.morph_weights) - morphs)
        if scene.meshes and unknown:
            raise ValueError(f"weights of morphs that no mesh has: {', '.join(unknown)}")


def checked_scenes(scenes: Iterable[Scene]) -> Iterator[Scene]:
    """Yield the scenes of one file, checking each.

    Raises
    ------
    ValueError
        A scene is inconsistent (see `check_scene`), one of several scenes has no place or name, or the clips have
        different names, rates or lengths.
    """
    names: set[str] = set()
    before: Clip | None = None
    for number, scene in enumerate(scenes):
        check_scene(scene)
        if number and (not names or not scene.name or scene.name in names or scene.place is None):
            raise ValueError(f"scene {scene.name!r}: several in one file need a place, and a name of their own")
        if scene.name and scene.place is not None:
            names.add(scene.name)
        clip = scene.clip
        if number and (None if clip is None else clip.kind) != (None if before is None else before.kind):
            raise ValueError(f"scene {scene.name!r}: a clip of another name, rate or length than the one before")
        before = clip
        yield scene


def _check_mesh(mesh: SkinnedMesh, bone_count: int) -> None:
    vertex_count = len(mesh.vertices_cm)
    if mesh.faces.ndim != 2 or mesh.faces.shape[1] < 3:
        raise ValueError(f"mesh {mesh.name!r}: faces of shape {mesh.faces.shape}")
    corner_count = mesh.faces.size
    shapes = {
        "vertices_cm": (mesh.vertices_cm.shape, [(vertex_count, 3)]),
        "normals": (mesh.normals.shape, [(vertex_count, 3), (corner_count, 3)]),
        "weights": (mesh.weights.shape, [mesh.joint_indices.shape]),
        "world_from_bone_bind": (mesh.world_from_bone_bind.shape, [(bone_count, 4, 4)]),
    }
    if mesh.uvs is not None:
        shapes["uvs"] = (mesh.uvs.shape, [(vertex_count, 2), (corner_count, 2)])
    if mesh.face_materials is not None:
        shapes["face_materials"] = (mesh.face_materials.shape, [(len(mesh.faces),)])
    for what, (given, allowed) in shapes.items():
        if given not in allowed:
            raise ValueError(f"mesh {mesh.name!r}: {what} of shape {given}, not {allowed}")
    if len(mesh.joint_indices) != vertex_count:
        raise ValueError(f"mesh {mesh.name!r}: joints for {len(mesh.joint_indices)} of {vertex_count} vertices")
    _check_indices(mesh, "faces", mesh.faces, vertex_count)
    _check_indices(mesh, "joint_indices", mesh.joint_indices, bone_count)
    if mesh.face_materials is not None:
        _check_indices(mesh, "face_materials", mesh.face_materials, len(mesh.materials))
    if not mesh.materials or len(set(mesh.materials)) != len(mesh.materials):
        raise ValueError(f"mesh {mesh.name!r}: no material, or one twice")
    _check_morphs(mesh, vertex_count)
    numbers = [mesh.vertices_cm, mesh.normals, mesh.weights, mesh.world_from_bone_bind]
    numbers += [morph.position_deltas_cm for morph in mesh.morphs]
    if not all(np.isfinite(values).all() for values in numbers):
        raise ValueError(f"mesh {mesh.name!r}: not all its values are finite")


def _check_morphs(mesh: SkinnedMesh, vertex_count: int) -> None:
    if len({morph.name for morph in mesh.morphs}) != len(mesh.morphs):
        raise ValueError(f"mesh {mesh.name!r}: two morphs of one name")
    for morph in mesh.morphs:
        _check_indices(mesh, f"morph {morph.name!r}", morph.vertex_indices, vertex_count)
        deltas = (len(morph.vertex_indices), 3)
        if morph.position_deltas_cm.shape != deltas or (
            morph.normal_deltas is not None and morph.normal_deltas.shape != deltas
        ):
            raise ValueError(f"mesh {mesh.name!r}: morph {morph.name!r} has not one delta per vertex")


def _check_indices(mesh: SkinnedMesh, what: str, indices: AnyIntArray, count: int) -> None:
    if indices.size and not 0 <= indices.min() <= indices.max() < count:
        raise ValueError(f"mesh {mesh.name!r}: {what} beyond 0..{count - 1}")


def _check_clip(clip: Clip, bone_count: int) -> None:
    if clip.frames < 1 or clip.fps <= 0:
        raise ValueError(f"a clip of {clip.frames} frames at {clip.fps} frames/s")
    curves: dict[str, tuple[AnyFloatArray, tuple[int, ...]]] = {}
    curves |= {f"translations of bone {bone}": (values, (3,)) for bone, values in clip.translations_cm.items()}
    curves |= {f"weights of {name!r}": (values, ()) for name, values in clip.morph_weights.items()}
    curves["rotations"] = (clip.rotations_xyzw, (bone_count, 4))
    for what, (values, shape) in curves.items():
        if values.shape != (clip.frames, *shape):
            raise ValueError(f"{what}: shape {values.shape}, not {(clip.frames, *shape)}")
        if not np.isfinite(values).all():
            raise ValueError(f"{what}: not all values are finite")
    if any(not 0 <= bone < bone_count for bone in clip.translations_cm):
        raise ValueError("translations of a bone that is not there")
    if clip.keys is not None:
        clip.keys.check(bone_count, clip.frames, clip.morph_weights)
