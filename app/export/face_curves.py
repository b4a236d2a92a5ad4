"""Selection and names of the face curves in exported files.

A studio may combine parts of the face from a capture with others from this program. Other face rigs use other names for
the same shapes:

- ``arkit``: as Apple does (ARFaceAnchor.BlendShapeLocation, 52 names), which Live Link Face, Ready Player Me and
  Character Creator read too;
- ``metahuman``: the raw controls of a MetaHuman's face (``CTRL_expressions_...``, of which there are 251), by the table
  of `metadata`;
- ``audio2face``: the same 52 with a capital, as NVIDIA's Audio2Face-3D (``names.cpp`` of NVIDIA/Maya-ACE) and Unreal's
  Live Link (EARFaceBlendShape) name them, in the same order; the 16 further shapes of the tongue in its later version
  are not written.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, Literal, TypeAlias, get_args

import msgspec
import numpy as np

from app.arrays import SingleArray
from app.formats.scene import MorphTarget, Scene, SkinnedMesh
from metadata.load import load_face_names
from metadata.model import ARKIT_MORPHS

CurveNames: TypeAlias = Literal["arkit", "metahuman", "audio2face"]
CURVE_NAMES: Final[tuple[CurveNames, ...]] = get_args(CurveNames)
FacePart: TypeAlias = Literal["brows", "eyes", "gaze", "cheeks", "nose", "mouth"]
"""Parts of a face: brows, lids, direction of the eyes, cheeks and nose; the mouth comprises jaw, lips, tongue and
puffed cheeks.
"""
FACE_PARTS: Final[tuple[FacePart, ...]] = get_args(FacePart)
_BEGINNINGS: Final[Mapping[str, FacePart]] = {
    "brow": "brows",
    "eyeLook": "gaze",
    "eye": "eyes",
    "cheekPuff": "mouth",
    "cheek": "cheeks",
    "nose": "nose",
    "jaw": "mouth",
    "mouth": "mouth",
    "tongue": "mouth",
}
"""Part of the face by the beginning of a shape's name; the first match applies."""


class FaceOptions(msgspec.Struct, frozen=True):
    """Choice of face curves in exported files.

    Attributes
    ----------
    names : CurveNames
        Convention by which the curves are named.
    parts : tuple of FacePart
        Parts of the face whose curves are written.
    """

    names: CurveNames = "arkit"
    parts: tuple[FacePart, ...] = FACE_PARTS


DEFAULT_FACE: Final = FaceOptions()


def part_of(shape: str) -> FacePart | None:
    """Return the part of a face that a shape moves; None for shapes other than ARKit's, such as breathing of
    the trunk.
    """
    if shape not in ARKIT_MORPHS:
        return None
    return next(part for beginning, part in _BEGINNINGS.items() if shape.startswith(beginning))


def written_weights(weights: Mapping[str, SingleArray], parts: tuple[FacePart, ...]) -> dict[str, SingleArray]:
    """Return only those weights whose ARKit shapes belong to the given parts of the face; shapes other than ARKit's
    stay.
    """
    return {shape: values for shape, values in weights.items() if part_of(shape) in (None, *parts)}


def curve_names(names: CurveNames) -> Mapping[str, Mapping[str, float]]:
    """Return for each ARKit shape the names of its animation curves, each with the share 0..1 of the shape's weight
    that it receives.
    """
    if names == "arkit":
        return {shape: {shape: 1.0} for shape in ARKIT_MORPHS}
    if names == "audio2face":
        return {shape: {shape[0].upper() + shape[1:]: 1.0} for shape in ARKIT_MORPHS}
    first = {shape: ways[0] for shape, ways in load_face_names()[names].morphs.items()}
    return {shape: {way: 1.0} if isinstance(way, str) else way for shape, way in first.items()}


MOST_WEIGHT: Final = 1.0
"""Greatest weight of a face curve."""


def with_curve_names(scene: Scene, names: CurveNames) -> Scene:
    """Return a scene with renamed face curves and morph targets, in which the mesh moves as before.

    A shape may drive several curves, and a curve several shapes: curve weights are summed up to 1, beyond which a
    MetaHuman's controls have no effect, and the mesh's targets are chosen such that the curves together reproduce the
    shapes below that limit.
    """
    if names == "arkit" or scene.clip is None:
        return scene
    table = curve_names(names)
    weights: dict[str, SingleArray] = {}
    for shape, values in scene.clip.morph_weights.items():
        for curve, share in table.get(shape, {shape: 1.0}).items():
            part = values if share == 1.0 else (values * share).astype(values.dtype)
            summed = np.add(weights[curve], part, dtype=values.dtype) if curve in weights else part
            weights[curve] = np.minimum(summed, MOST_WEIGHT, dtype=values.dtype) if curve in weights else summed
    shares = _shares_of_shapes(table)
    meshes = tuple(_renamed(mesh, shares) for mesh in scene.meshes)
    return replace(scene, meshes=meshes, clip=replace(scene.clip, morph_weights=weights))


_SMALLEST_SHARE: Final = 1e-9
"""Shares below this value are rounding errors."""


def _shares_of_shapes(table: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, float]]:
    """Return the share of each ARKit shape's vertex offsets that forms the target of each curve, by curve and shape:
    the pseudo-inverse of the table."""
    curves = list(dict.fromkeys(curve for shares in table.values() for curve in shares))
    weights = np.array([[shares.get(curve, 0.0) for shares in table.values()] for curve in curves])
    inverse = np.linalg.pinv(weights)
    return {
        shape: {curve: float(share) for curve, share in zip(curves, row, strict=True) if abs(share) > _SMALLEST_SHARE}
        for shape, row in zip(table, inverse, strict=True)
    }


def _renamed(mesh: SkinnedMesh, shares: Mapping[str, Mapping[str, float]]) -> SkinnedMesh:
    parts: dict[str, list[tuple[MorphTarget, float]]] = {}
    for morph in mesh.morphs:
        for curve, share in shares.get(morph.name, {morph.name: 1.0}).items():
            parts.setdefault(curve, []).append((morph, share))
    return replace(mesh, morphs=tuple(_summed(curve, of) for curve, of in parts.items()))


def _summed(name: str, parts: Sequence[tuple[MorphTarget, float]]) -> MorphTarget:
    """Return a morph target that moves each vertex by the sum of given targets, each multiplied by its factor."""
    if len(parts) == 1:
        morph, share = parts[0]
        normals = None if morph.normal_deltas is None else morph.normal_deltas * share
        return MorphTarget(name, morph.vertex_indices, morph.position_deltas_cm * share, normals)
    vertices = np.unique(np.concatenate([morph.vertex_indices for morph, _ in parts]))
    deltas = np.zeros((len(vertices), 3))
    turned = None if any(morph.normal_deltas is None for morph, _ in parts) else np.zeros((len(vertices), 3))
    for morph, share in parts:
        rows = np.searchsorted(vertices, morph.vertex_indices)
        deltas[rows] += morph.position_deltas_cm * share
        if turned is not None and morph.normal_deltas is not None:
            turned[rows] += morph.normal_deltas * share
    return MorphTarget(name, vertices, deltas, turned)
