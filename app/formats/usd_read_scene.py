"""Reading of OpenUSD files written by `app.formats.usd` back into scenes; requires usd-core."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from app.arrays import AnyFloatArray, FloatArray
from app.errors import FileError
from app.formats.rates import exact_rate
from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh, check_scene
from app.formats.usd import ONE_AT_A_TIME
from app.formats.usd_package import open_libraries, refuse_without_usd

_SURFACE = Material("surface", (0.8, 0.8, 0.8, 1.0))
"""Replacement for all materials of a mesh, which are not read."""


def read_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a file with one scene written by `write_usd`, without materials and UVs.

    Raises
    ------
    FileError
        The file was not written by `write_usd`, or is damaged.
    UsageError
        The package usd-core is not installed.
    """
    refuse_without_usd()
    file = os.fspath(path)
    with ONE_AT_A_TIME:
        open_libraries()
        from pxr import Tf, Usd

        try:
            scene = _scene(Usd.Stage.Open(file))
            check_scene(scene)
        except (ValueError, LookupError, TypeError, Tf.ErrorException) as error:
            raise FileError("usd.damaged", file=file, detail=str(error)) from error
    return scene


def _scene(stage: Any) -> Scene:
    from pxr import UsdGeom, UsdSkel

    prims = [*stage.Traverse()]
    (root,) = (prim for prim in prims if prim.IsA(UsdSkel.Root))
    (skeleton,) = (UsdSkel.Skeleton(prim) for prim in prims if prim.IsA(UsdSkel.Skeleton))
    joints = [str(joint) for joint in skeleton.GetJointsAttr().Get()]
    names, rows = skeleton.GetJointNamesAttr().Get(), {joint: row for row, joint in enumerate(joints)}
    rests = _columns(skeleton.GetRestTransformsAttr().Get())
    turns = Rotation.from_matrix(rests[:, :3, :3]).as_quat()
    bones = tuple(
        Bone(str(name), rows.get(joint.rpartition("/")[0], -1), rest[:3, 3], turn)
        for name, joint, rest, turn in zip(names, joints, rests, turns, strict=True)
    )
    binds = _columns(skeleton.GetBindTransformsAttr().Get())
    meshes = tuple(_mesh(prim, binds) for prim in prims if prim.IsA(UsdGeom.Mesh))
    clips = [_clip(stage, UsdSkel.Animation(prim)) for prim in prims if prim.IsA(UsdSkel.Animation)]
    clip = clips[0] if clips else None
    return Scene(bones, meshes, clip, stage.GetRootLayer().comment, root.GetDisplayName())


def _columns(matrices: Any) -> FloatArray:
    """Convert USD's matrices (N, 4, 4) for row vectors to matrices for column vectors."""
    return np.array(matrices, np.float64).reshape(-1, 4, 4).transpose(0, 2, 1)


def _mesh(prim: Any, binds: FloatArray) -> SkinnedMesh:
    from pxr import UsdGeom, UsdSkel

    mesh, binding = UsdGeom.Mesh(prim), UsdSkel.BindingAPI(prim)
    points = np.array(mesh.GetPointsAttr().Get(), np.float64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(), np.int64)
    shape = len(points), binding.GetJointIndicesPrimvar().GetElementSize()
    return SkinnedMesh(
        name=prim.GetDisplayName(),
        vertices_cm=points,
        faces=corners.reshape(len(mesh.GetFaceVertexCountsAttr().Get()), -1),
        normals=np.array(mesh.GetNormalsAttr().Get(), np.float64),
        uvs=None,
        materials=(_SURFACE,),
        face_materials=None,
        joint_indices=np.array(binding.GetJointIndicesPrimvar().Get(), np.int64).reshape(shape),
        weights=np.array(binding.GetJointWeightsPrimvar().Get(), np.float64).reshape(shape),
        world_from_bone_bind=binds,
        morphs=_morphs(prim, binding),
    )


def _morphs(prim: Any, binding: Any) -> tuple[MorphTarget, ...]:
    from pxr import UsdSkel

    names = binding.GetBlendShapesAttr().Get() or ()
    shapes = [UsdSkel.BlendShape(prim.GetStage().GetPrimAtPath(path)) for path in _targets(binding)]
    return tuple(
        MorphTarget(
            str(name),
            np.array(shape.GetPointIndicesAttr().Get(), np.int64),
            np.array(shape.GetOffsetsAttr().Get(), np.float64).reshape(-1, 3),
            np.array(shape.GetNormalOffsetsAttr().Get(), np.float64).reshape(-1, 3),
        )
        for name, shape in zip(names, shapes, strict=True)
    )


def _targets(binding: Any) -> list[Any]:
    return list(binding.GetBlendShapeTargetsRel().GetTargets())


def _clip(stage: Any, motion: Any) -> Clip:
    """Return the clip of a USD skeleton's animation sampled at every frame; between keys as USD interpolates them."""
    frames = round(stage.GetEndTimeCode() - stage.GetStartTimeCode()) + 1
    names = motion.GetBlendShapesAttr().Get() or ()
    weights = _at_frames(motion.GetBlendShapeWeightsAttr(), frames) if names else np.zeros((frames, 0))
    places = motion.GetTranslationsAttr()
    moved = _at_frames(places, frames) if places.GetNumTimeSamples() else None
    return Clip(
        motion.GetPrim().GetDisplayName(),
        exact_rate(stage.GetFramesPerSecond()),
        frames,
        _at_frames(motion.GetRotationsAttr(), frames),
        {} if moved is None else {bone: moved[:, bone] for bone in _moving(moved)},
        {str(name): weights[:, column] for column, name in enumerate(names)},
    )


def _at_frames(attribute: Any, frames: int) -> FloatArray:
    """Return the values (F, N, ...) of a USD attribute at all frames; quaternions as xyzw."""
    return np.stack([np.array(attribute.Get(frame)) for frame in range(frames)]).astype(np.float64)


def _moving(places_cm: AnyFloatArray) -> list[int]:
    """Return the indices of the bones whose position relative to the parent changes."""
    still = (places_cm == places_cm[:1]).all(axis=(0, 2))
    return np.flatnonzero(~still).tolist()
