"""Visible parts of the body: head, neck and hands, cut by material; eyes, teeth, tongue, lashes."""

from __future__ import annotations

import numpy as np
from character_garments import Tailoring, above_collar
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, compact, keep_triangles, split_seams, triangulate, vertex_normals

HAND_IN_CUFF_M, NECK_IN_COLLAR_M = 0.045, 0.02


def surface_of(
    source: Source, fit: SkeletonFit, name: str, groups: tuple[str, ...], material: str, morphs: bool
) -> Surface:
    """One surface from whole groups of the base mesh."""
    corners = np.concatenate([source.groups[group].vertices for group in groups])
    uv_corners = np.concatenate([source.groups[group].uvs for group in groups])
    origin, uv_index, faces = split_seams(corners, uv_corners)
    normals = vertex_normals(source.vertices, triangulate(corners, source.vertices))
    deltas = (
        {label: delta[origin] for label, delta in zip(source.morph_names, source.morph_deltas, strict=True)}
        if morphs
        else {}
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
    """Skin, lips and their edge, nails and the inside of the mouth, by the masks that come with the base mesh."""
    triangles = whole.triangles["skin"]
    centres = whole.uvs[triangles].mean(axis=1)
    # The mask fades over a triangle or two: a colour between skin and lips there keeps the edge from looking cut out.
    vermilion = _mask_at(source.masks["lips"], centres)
    lips = vermilion > 0.5
    edge = (vermilion > 0.05) & ~lips
    nails = (_mask_at(source.masks["fingernails"], centres) > 0.5) & ~lips & ~edge
    mouth = (_mask_at(source.masks["inside-mouth"], centres) > 0.5) & ~lips & ~edge & ~nails
    parts = {
        "skin": triangles[~lips & ~edge & ~nails & ~mouth],
        "lips": triangles[lips],
        "lip_edge": triangles[edge],
        "nails": triangles[nails],
        "mouth": triangles[mouth],
    }
    return Surface(**(whole.__dict__ | {"triangles": parts}))


def visible(tailoring: Tailoring, places: np.ndarray) -> np.ndarray:
    """Mask (N,) of the T-pose points of the skin that belong to head, neck or hands."""
    hands = np.abs(places[:, 0]) > tailoring.wrist_m - HAND_IN_CUFF_M
    trunk = np.abs(places[:, 0]) < tailoring.shoulder[0]
    return hands | (trunk & (above_collar(tailoring, places) > -NECK_IN_COLLAR_M))


def visible_body(source: Source, fit: SkeletonFit, tailoring: Tailoring) -> Surface:
    """Head, neck and hands, which shirt, trousers and shoes leave visible, and a margin beneath the edges."""
    whole = _by_material(surface_of(source, fit, "body", ("body",), "skin", morphs=True), source)
    t_pose = fit.to_t_pose(whole.positions, whole.weights)
    shown = visible(tailoring, t_pose)
    return keep_triangles(whole, {name: shown[faces].all(axis=1) for name, faces in whole.triangles.items()})


def tongue(source: Source, fit: SkeletonFit) -> Surface:
    """The base mesh's tongue."""
    return compact(surface_of(source, fit, "tongue", ("helper-tongue",), "tongue", morphs=True))
