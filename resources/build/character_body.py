"""What of the body is seen: head, neck and hands, cut by material; eyes, teeth, tongue, lashes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, compact, keep_triangles, split_seams, triangulate, vertex_normals

EYE_MORPHS_ON_BALL = False


@dataclass(frozen=True)
class Body:
    """The whole body's surface, from which clothes are made, and the part of it that clothes leave visible."""

    whole: Surface
    visible: Surface


def surface_of(source: Source, fit: SkeletonFit, name: str, groups: tuple[str, ...], material: str, morphs: bool) -> Surface:
    """One surface from whole groups of the base mesh."""
    corners = np.concatenate([source.groups[group].vertices for group in groups])
    uv_corners = np.concatenate([source.groups[group].uvs for group in groups])
    origin, uv_index, faces = split_seams(corners, uv_corners)
    normals = vertex_normals(source.vertices, triangulate(corners, source.vertices))
    deltas = (
        {label: delta[origin] for label, delta in zip(source.morph_names, source.morph_deltas, strict=True)} if morphs else {}
    )
    return Surface(
        name=name,
        positions=source.vertices[origin],
        normals=normals[origin],
        uvs=source.uvs[uv_index],
        weights=fit.weights[origin],
        triangles={material: triangulate(faces, source.vertices[origin])},
        morphs=deltas,
        origin=origin,
    )


def _mask_at(mask: np.ndarray, uvs: np.ndarray) -> np.ndarray:
    rows = np.clip(((1.0 - uvs[:, 1]) * mask.shape[0]).astype(int), 0, mask.shape[0] - 1)
    columns = np.clip((uvs[:, 0] * mask.shape[1]).astype(int), 0, mask.shape[1] - 1)
    return mask[rows, columns]


def _by_material(whole: Surface, source: Source) -> Surface:
    """Skin, lips, nails and the inside of the mouth, by the masks that come with the base mesh."""
    triangles = whole.triangles["skin"]
    centres = whole.uvs[triangles].mean(axis=1)
    lips = _mask_at(source.masks["lips"], centres) > 0.5
    nails = (_mask_at(source.masks["fingernails"], centres) > 0.5) & ~lips
    mouth = (_mask_at(source.masks["inside-mouth"], centres) > 0.5) & ~lips & ~nails
    parts = {"skin": triangles[~lips & ~nails & ~mouth], "lips": triangles[lips], "nails": triangles[nails], "mouth": triangles[mouth]}
    return Surface(**(whole.__dict__ | {"triangles": parts}))


def body_surface(source: Source, fit: SkeletonFit) -> Body:
    """The body, whole and as left visible by a shirt, trousers and shoes."""
    whole = _by_material(surface_of(source, fit, "body", ("body",), "skin", morphs=True), source)
    hand_joints = [joint for joint, name in enumerate(fit.names) if "Hand" in name or "Proximal" in name or "Intermediate" in name or "Distal" in name or "Metacarpal" in name]
    head_joints = [fit.index("head"), fit.index("neck"), fit.index("leftEye"), fit.index("rightEye")]
    shown = (whole.weights[:, hand_joints].sum(axis=1) > 0.02) | (whole.weights[:, head_joints].sum(axis=1) > 0.25)
    visible = keep_triangles(whole, {name: shown[faces].any(axis=1) for name, faces in whole.triangles.items()})
    return Body(whole, visible)


def mouth_surfaces(source: Source, fit: SkeletonFit) -> tuple[Surface, ...]:
    teeth = surface_of(source, fit, "teeth", ("helper-upper-teeth", "helper-lower-teeth"), "teeth", morphs=True)
    tongue = surface_of(source, fit, "tongue", ("helper-tongue",), "tongue", morphs=True)
    eyes = surface_of(source, fit, "eyes", ("helper-l-eye", "helper-r-eye"), "eye_white", morphs=False)
    return tuple(compact(surface) for surface in (teeth, tongue, eyes))
