"""Writing of scenes as OpenUSD files: a SkelRoot with skeleton, skinned meshes, blend shapes and animation; several
scenes are below one prim with the clip's name, each at its place, and share materials.

Centimetres (``metersPerUnit`` 0.01), Y up, facing +Z; time code n is frame n. Names that are invalid for prims are
changed, and kept unchanged as the prim's display name, in the skeleton's ``jointNames`` and in the blend shapes'
tokens. Levels of detail are variants of the SkelRoot. Textures are separate files. The optional package usd-core
(module ``pxr``) is imported only when a file is written.

Source: OpenUSD documentation, "UsdSkel: Skeleton Schema", "UsdPreviewSurface Specification", "UsdMedia".
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any, Final

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray
from app.errors import FileError
from app.formats.atomic import atomic_write
from app.formats.continuous import continuous
from app.formats.euler import matrices
from app.formats.scene import Clip, MorphTarget, Scene, SkinnedMesh, checked_scenes
from app.formats.skin import influences
from app.formats.temporary_folders import scratch_folder
from app.formats.texture_files import TextureFiles
from app.formats.unique_names import numbered
from app.formats.usd_materials import UsdMaterials
from app.formats.usd_package import open_libraries, refuse_without_usd

METERS_PER_UNIT = 0.01
LEVELS: Final = "levelOfDetail"
"""Variant set of a SkelRoot with a variant for each level of detail of its meshes."""


@dataclass(frozen=True)
class UsdSound:
    """A sound file next to the USD file.

    Attributes
    ----------
    file : str
        File name, or path relative to the USD file's folder, with slashes.
    start_s : float
        Start in seconds relative to frame 0; negative if it starts earlier.
    """

    file: str
    start_s: float


ONE_AT_A_TIME: Final = Lock()
"""Lock for the USD library, in which two threads would deadlock."""


def write_usd(path: str | os.PathLike[str], scene: Scene, sound: UsdSound | None = None) -> None:
    """Write a scene as a USD file, atomically and deterministically.

    Parameters
    ----------
    path : str or path-like
        File to write, ``.usdc`` (binary) or ``.usda`` (text).
    sound : UsdSound, optional
        Sound to be played with the animation.

    Raises
    ------
    FileError
        The file cannot be written.
    UsageError
        The package usd-core is not installed.
    ValueError
        The scene is inconsistent.
    """
    write_usds(path, (scene,), sound)


def write_usds(path: str | os.PathLike[str], scenes: Iterable[Scene], sound: UsdSound | None = None) -> None:
    """Write several scenes into one file, like `write_usd`; each scene is released when the next is requested."""
    refuse_without_usd()
    with ONE_AT_A_TIME:
        open_libraries()
        from pxr import Tf, UsdUtils

        files = TextureFiles()
        layer = _stage_layer(scenes, sound, files)
        files.write(Path(path).parent)
        try:
            # USD writes only to files.
            with scratch_folder() as folder:
                made = folder / f"scene{Path(path).suffix}"
                # Without a listener USD prints a warning that time offsets of sounds need a newer version of its binary
                # format; errors are raised anyway.
                listener = UsdUtils.CoalescingDiagnosticDelegate()
                layer.Export(str(made))
                del listener
                with made.open("rb") as content, atomic_write(path) as stream:
                    shutil.copyfileobj(content, stream)
        except (OSError, Tf.ErrorException) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise FileError("file.cannot_write", file=os.fspath(path), reason=reason) from error


def _stage_layer(scenes: Iterable[Scene], sound: UsdSound | None, files: TextureFiles) -> Any:
    """Return the whole USD file as a layer in memory; the used textures are added to ``files``."""
    from pxr import Kind, Sdf, Usd, UsdGeom

    layer: Any = Sdf.Layer.CreateAnonymous(".usda")
    stage: Any = Usd.Stage.Open(layer)
    UsdGeom.SetStageMetersPerUnit(stage, METERS_PER_UNIT)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    group = ""
    materials: UsdMaterials | None = None
    for number, scene in enumerate(checked_scenes(scenes)):
        if number == 0:
            layer.comment = scene.creator
            if scene.place is not None:
                title = scene.title if scene.clip is None else scene.clip.name
                group = f"/{_identifiers([title])[0]}"
                prim = UsdGeom.Xform.Define(stage, group).GetPrim()
                prim.SetDisplayName(title)
                Usd.ModelAPI(prim).SetKind(Kind.Tokens.assembly)
            taken = {"Materials", "Sound"} if group else set[str]()
        (root_name,) = _identifiers([scene.title], taken)
        taken.add(root_name)
        root = f"{group}/{root_name}"
        default = group or root
        if materials is None:
            materials = UsdMaterials(stage, f"{default}/Materials", files, _identifiers)
        _Writer(scene, layer, stage, materials).write(root)
        if number == 0:
            stage.SetDefaultPrim(stage.GetPrimAtPath(default))
            if scene.clip is not None and sound is not None:
                _add_sound(stage, f"{default}/Sound", scene.clip, sound)
    return layer


class _Writer:
    """Writer of one scene with skeleton, meshes and animation to a USD stage."""

    def __init__(self, scene: Scene, layer: Any, stage: Any, materials: UsdMaterials) -> None:
        self._scene = scene
        self._layer = layer
        self._stage = stage
        self._materials = materials

    def write(self, root_path: str) -> None:
        """Add the scene's skeleton, meshes and animation to the USD stage below ``root_path``."""
        from pxr import Gf, Kind, Usd, UsdSkel

        scene, clip = self._scene, self._scene.clip
        root = UsdSkel.Root.Define(self._stage, root_path)
        prim = root.GetPrim()
        prim.SetDisplayName(scene.title)
        Usd.ModelAPI(prim).SetKind(Kind.Tokens.component)
        if scene.place is not None:
            x, y, z, w = (float(value) for value in scene.place.rotation_xyzw)
            root.AddTranslateOp().Set(Gf.Vec3d(*(float(value) for value in scene.place.translation_cm)))
            root.AddOrientOp().Set(Gf.Quatf(w, x, y, z))
        # Names of our own prims are reserved first, so that no mesh gets one. Programs name the armature and its
        # animation after them.
        name = prim.GetName()
        skeleton_name, motion_name = f"{name}_skeleton", f"{name}_motion"
        taken = {skeleton_name, motion_name, "Materials", "Sound"}
        mesh_names = _identifiers([mesh.name for mesh in scene.meshes], taken)
        joints = self._joint_paths()
        skeleton = self._skeleton(f"{root_path}/{skeleton_name}", joints)
        for mesh, mesh_name in zip(scene.meshes, mesh_names, strict=True):
            if not mesh.levels:
                self._mesh(f"{root_path}/{mesh_name}", mesh, skeleton)
        self._levels(
            root, {f"{root_path}/{name}": mesh for name, mesh in zip(mesh_names, scene.meshes, strict=True)}, skeleton
        )
        if clip is not None:
            self._motion(f"{root_path}/{motion_name}", clip, joints, skeleton)

    def _joint_paths(self) -> list[str]:
        """Return the USD paths of all joints: a joint's name below the path of its parent."""
        names = _identifiers([bone.name for bone in self._scene.bones])
        paths: list[str] = []
        for bone, name in zip(self._scene.bones, names, strict=True):
            paths.append(name if bone.parent < 0 else f"{paths[bone.parent]}/{name}")
        return paths

    def _skeleton(self, path: str, joints: list[str]) -> Any:
        from pxr import UsdSkel, Vt

        bones = self._scene.bones
        skeleton = UsdSkel.Skeleton.Define(self._stage, path)
        skeleton.CreateJointsAttr(joints)
        skeleton.CreateJointNamesAttr([bone.name for bone in bones])
        rest = np.stack([_matrix(bone.translation_cm, bone.rotation_xyzw) for bone in bones])
        if self._scene.meshes:
            bind = np.asarray(self._scene.meshes[0].world_from_bone_bind, dtype=np.float64)
        else:
            bind = rest.copy()
            for index, bone in enumerate(bones):
                bind[index] = bind[index] if bone.parent < 0 else bind[bone.parent] @ rest[index]
        # Matrices of USD act on row vectors.
        skeleton.CreateRestTransformsAttr(Vt.Matrix4dArray.FromNumpy(_rows(rest)))
        skeleton.CreateBindTransformsAttr(Vt.Matrix4dArray.FromNumpy(_rows(bind)))
        return skeleton

    def _levels(self, root: Any, meshes: Mapping[str, SkinnedMesh], skeleton: Any) -> None:
        """Add meshes that have levels of detail, given by their paths, as variants: one for each level, with the mesh
        itself selected.
        """
        found = {path: (mesh, *mesh.levels) for path, mesh in meshes.items() if mesh.levels}
        if not found:
            return
        # The content of a variant is below its prim; materials are not.
        for levels in found.values():
            for material in (material for level in levels for material in level.materials):
                self._materials[material]
        variants = root.GetPrim().GetVariantSets().AddVariantSet(LEVELS)
        for number in reversed(range(max(map(len, found.values())))):
            variants.AddVariant(f"LOD{number}")
            variants.SetVariantSelection(f"LOD{number}")
            with variants.GetVariantEditContext():
                for path, levels in found.items():
                    self._mesh(path, levels[min(number, len(levels) - 1)], skeleton)

    def _mesh(self, path: str, mesh: SkinnedMesh, skeleton: Any) -> None:
        from pxr import Gf, Sdf, UsdGeom, UsdSkel, Vt

        made = UsdGeom.Mesh.Define(self._stage, path)
        made.GetPrim().SetDisplayName(mesh.name)
        points = np.ascontiguousarray(mesh.vertices_cm, dtype=np.float32)
        made.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
        made.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([points.min(axis=0), points.max(axis=0)])))
        made.CreateFaceVertexCountsAttr(_integers(np.full(len(mesh.faces), mesh.faces.shape[1])))
        made.CreateFaceVertexIndicesAttr(_integers(mesh.faces.ravel()))
        # Polygons are exact, not the control cage of a subdivision surface.
        made.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        made.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(mesh.normals, dtype=np.float32)))
        made.SetNormalsInterpolation(_interpolation(mesh, mesh.normals))
        made.CreateDoubleSidedAttr(any(material.double_sided for material in mesh.materials))
        primvars = UsdGeom.PrimvarsAPI(made.GetPrim())
        if mesh.uvs is not None:
            uvs = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(mesh.uvs, dtype=np.float32))
            interpolation = _interpolation(mesh, mesh.uvs)
            primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, interpolation).Set(uvs)
        self._bind_materials(made, mesh)

        joints, weights = influences(mesh)
        binding = UsdSkel.BindingAPI.Apply(made.GetPrim())
        binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
        binding.CreateGeomBindTransformAttr(Gf.Matrix4d(1.0))
        binding.CreateJointIndicesPrimvar(False, joints.shape[1]).Set(_integers(joints.ravel()))
        numbers = np.ascontiguousarray(weights, dtype=np.float32).ravel()
        binding.CreateJointWeightsPrimvar(False, weights.shape[1]).Set(Vt.FloatArray.FromNumpy(numbers))
        if mesh.morphs:
            self._blend_shapes(path, mesh.morphs, binding)

    def _bind_materials(self, made: Any, mesh: SkinnedMesh) -> None:
        from pxr import UsdGeom, UsdShade

        binding = UsdShade.MaterialBindingAPI.Apply(made.GetPrim())
        if mesh.face_materials is None or len(mesh.materials) == 1:
            binding.Bind(self._materials[mesh.materials[0]])
            return
        for number, material in enumerate(mesh.materials):
            faces = np.flatnonzero(mesh.face_materials == number)
            name = self._materials[material].GetPath().name
            subset = binding.CreateMaterialBindSubset(name, _integers(faces), UsdGeom.Tokens.face)
            UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(self._materials[material])
        binding.SetMaterialBindSubsetsFamilyType(UsdGeom.Tokens.partition)

    def _blend_shapes(self, path: str, morphs: tuple[MorphTarget, ...], binding: Any) -> None:
        from pxr import UsdSkel, Vt

        subsets = {child.GetName() for child in self._stage.GetPrimAtPath(path).GetChildren()}
        targets = []
        for morph, name in zip(morphs, _identifiers([morph.name for morph in morphs], subsets), strict=True):
            shape = UsdSkel.BlendShape.Define(self._stage, f"{path}/{name}")
            shape.GetPrim().SetDisplayName(morph.name)
            offsets = np.ascontiguousarray(morph.position_deltas_cm, dtype=np.float32)
            normals = np.zeros_like(offsets) if morph.normal_deltas is None else morph.normal_deltas
            shape.CreateOffsetsAttr(Vt.Vec3fArray.FromNumpy(offsets))
            shape.CreateNormalOffsetsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(normals, dtype=np.float32)))
            shape.CreatePointIndicesAttr(_integers(morph.vertex_indices))
            targets.append(shape.GetPath())
        binding.CreateBlendShapesAttr([morph.name for morph in morphs])
        binding.CreateBlendShapeTargetsRel().SetTargets(targets)

    def _motion(self, path: str, clip: Clip, joints: list[str], skeleton: Any) -> None:
        from pxr import UsdSkel, Vt

        stage = self._stage
        stage.SetTimeCodesPerSecond(float(clip.fps))
        stage.SetFramesPerSecond(float(clip.fps))
        stage.SetStartTimeCode(0)
        stage.SetEndTimeCode(clip.frames - 1)
        motion = UsdSkel.Animation.Define(stage, path)
        motion.GetPrim().SetDisplayName(clip.name)
        motion.CreateJointsAttr(joints)
        motion.CreateScalesAttr(Vt.Vec3hArray.FromNumpy(np.ones((len(joints), 3), dtype=np.float16)))

        # All bones share their time samples, and so do all morphs.
        keys = clip.keys
        every = np.arange(clip.frames)
        poses = (every if keys is None or keys.pose is None else keys.pose).tolist()
        faces = (every if keys is None else keys.face).tolist()
        rotations = continuous(clip.rotations_xyzw)
        attribute = motion.CreateRotationsAttr().GetPath()
        for frame in poses:
            self._layer.SetTimeSample(attribute, frame, Vt.QuatfArray.FromNumpy(rotations[frame]))

        places = np.stack([bone.translation_cm for bone in self._scene.bones]).astype(np.float32)
        translations = motion.CreateTranslationsAttr(None if clip.translations_cm else Vt.Vec3fArray.FromNumpy(places))
        if clip.translations_cm:
            moved = {bone: np.asarray(values, dtype=np.float32) for bone, values in clip.translations_cm.items()}
            for frame in poses:
                for bone, values in moved.items():
                    places[bone] = values[frame]
                self._layer.SetTimeSample(translations.GetPath(), frame, Vt.Vec3fArray.FromNumpy(places))

        if clip.morph_weights:
            motion.CreateBlendShapesAttr(list(clip.morph_weights))
            weights = np.stack(list(clip.morph_weights.values()), axis=1).astype(np.float32)
            attribute = motion.CreateBlendShapeWeightsAttr().GetPath()
            for frame in faces:
                self._layer.SetTimeSample(attribute, frame, Vt.FloatArray.FromNumpy(weights[frame]))
        binding = UsdSkel.BindingAPI.Apply(skeleton.GetPrim())
        binding.CreateAnimationSourceRel().SetTargets([motion.GetPath()])


def _add_sound(stage: Any, path: str, clip: Clip, sound: UsdSound) -> None:
    from pxr import Sdf, UsdMedia

    made = UsdMedia.SpatialAudio.Define(stage, path)
    made.CreateFilePathAttr(Sdf.AssetPath(f"./{sound.file}"))
    made.CreateAuralModeAttr(UsdMedia.Tokens.nonSpatial)
    made.CreatePlaybackModeAttr(UsdMedia.Tokens.onceFromStart)
    made.CreateStartTimeAttr(Sdf.TimeCode(max(sound.start_s, 0.0) * float(clip.fps)))
    made.CreateMediaOffsetAttr(max(-sound.start_s, 0.0))


def _identifiers(names: Iterable[str], taken: Iterable[str] = ()) -> tuple[str, ...]:
    """Return valid and unique USD prim names for the given ones, also different from ``taken`` ignoring case."""
    from pxr import Sdf, Tf

    valid = (name if Sdf.Path.IsValidIdentifier(name) else Tf.MakeValidIdentifier(name) for name in names)
    return numbered(valid, taken)


def _matrix(translation: AnyFloatArray, rotation_xyzw: AnyFloatArray) -> FloatArray:
    result = np.eye(4)
    result[:3, :3] = matrices(rotation_xyzw)
    result[:3, 3] = translation
    return result


def _rows(values: FloatArray) -> FloatArray:
    return np.ascontiguousarray(values.transpose(0, 2, 1))


def _integers(values: AnyIntArray) -> Any:
    from pxr import Vt

    return Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32))


def _interpolation(mesh: SkinnedMesh, values: AnyFloatArray) -> Any:
    from pxr import UsdGeom

    return UsdGeom.Tokens.vertex if len(values) == len(mesh.vertices_cm) else UsdGeom.Tokens.faceVarying
