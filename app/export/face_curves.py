"""Curves of a face in exported files: which parts of a face have them, and what they are called.

A studio may take some parts of a face from a capture, and others from here: brows of an actor, lips of a player. And
faces of other makers call the same shapes otherwise:

- ``arkit``: as Apple does (ARFaceAnchor.BlendShapeLocation, 52 names), which Live Link Face, Ready Player Me and
  Character Creator read too;
- ``metahuman``: the raw controls of a MetaHuman's face (``CTRL_expressions_...``, of which there are 251), by the table
  of `metadata`;
- ``audio2face``: the same 52 with a capital, as NVIDIA's Audio2Face-3D and Unreal's Live Link name them
  (EARFaceBlendShape); of its 16 further shapes of the tongue there is nothing in a wind player's face.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final, Literal, TypeAlias, get_args

import msgspec

from app.arrays import SingleArray
from app.formats.scene import MorphTarget, Scene, SkinnedMesh
from metadata.load import load_face_names
from metadata.model import ARKIT_MORPHS

CurveNames: TypeAlias = Literal["arkit", "metahuman", "audio2face"]
CURVE_NAMES: Final[tuple[CurveNames, ...]] = get_args(CurveNames)
FacePart: TypeAlias = Literal["brows", "eyes", "gaze", "cheeks", "nose", "mouth"]
"""Brows; lids; the turn of the eyes; cheeks that are raised; nose; jaw, lips, tongue and blown cheeks."""
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
"""The first that a shape's name begins with counts."""


class FaceOptions(msgspec.Struct, frozen=True):
    """Requested curves of faces.

    Attributes
    ----------
    names : CurveNames
    parts : tuple of FacePart
        Those whose curves are written.
    """

    names: CurveNames = "arkit"
    parts: tuple[FacePart, ...] = FACE_PARTS


DEFAULT_FACE: Final = FaceOptions()


def part_of(shape: str) -> FacePart | None:
    """The part of a face that a shape moves; None of one that is not ARKit's, as of the breath in a trunk."""
    if shape not in ARKIT_MORPHS:
        return None
    return next(part for beginning, part in _BEGINNINGS.items() if shape.startswith(beginning))


def written_weights(weights: Mapping[str, SingleArray], parts: tuple[FacePart, ...]) -> dict[str, SingleArray]:
    """Weights of ARKit's shapes without those of the other parts of a face."""
    return {shape: values for shape, values in weights.items() if part_of(shape) in (None, *parts)}


def curve_names(names: CurveNames) -> Mapping[str, Mapping[str, float]]:
    """Curves by ARKit's shape, each with its share of the shape's weight."""
    if names == "arkit":
        return {shape: {shape: 1.0} for shape in ARKIT_MORPHS}
    if names == "audio2face":
        return {shape: {shape[0].upper() + shape[1:]: 1.0} for shape in ARKIT_MORPHS}
    first = {shape: ways[0] for shape, ways in load_face_names()[names].morphs.items()}
    return {shape: {way: 1.0} if isinstance(way, str) else way for shape, way in first.items()}


def with_curve_names(scene: Scene, names: CurveNames) -> Scene:
    """A scene whose face curves and morph targets are called so, and show the same.

    Where one shape becomes several curves, each moves the mesh by its share of the shape.
    """
    if names == "arkit" or scene.clip is None:
        return scene
    table = curve_names(names)
    weights = {
        curve: values if share == 1.0 else values * share
        for shape, values in scene.clip.morph_weights.items()
        for curve, share in table.get(shape, {shape: 1.0}).items()
    }
    meshes = tuple(_renamed(mesh, table) for mesh in scene.meshes)
    return replace(scene, meshes=meshes, clip=replace(scene.clip, morph_weights=weights))


def _renamed(mesh: SkinnedMesh, table: Mapping[str, Mapping[str, float]]) -> SkinnedMesh:
    morphs: list[MorphTarget] = []
    for morph in mesh.morphs:
        shares = table.get(morph.name, {morph.name: 1.0})
        whole = sum(share * share for share in shares.values())
        for curve, share in shares.items():
            part = share / whole
            normals = None if morph.normal_deltas is None else morph.normal_deltas * part
            morphs.append(MorphTarget(curve, morph.vertex_indices, morph.position_deltas_cm * part, normals))
    return replace(mesh, morphs=tuple(morphs))
