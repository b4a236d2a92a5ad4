"""Small front views of a character, drawn without a graphics card in any thread."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from app.arrays import FloatArray, IndexArray, IntArray
from app.formats.texture_colors import linear, sampled
from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import rest_positions

Crop = Literal["body", "head"]

_LIGHT: Final = np.array([0.35, 0.45, 0.82])
_OVERSAMPLED: Final = 2
_AMBIENT, _DIFFUSE = 0.30, 0.75
_MARGIN: Final = 1.06
_HEAD_BELOW: Final = 0.45
"""Length of neck shown below the head, relative to the head's height (joint to crown)."""
_LARGEST_PX: Final = 2048
_DEPTHS: Final = float(2**20)
"""Number of depth levels from the rearmost to the foremost point."""
_CLOSE: Final = 1.3
"""Distance of drawn points relative to a pixel's width."""


@dataclass(frozen=True, eq=False)
class Seen:
    """A character in its T-pose, prepared for drawing with any facial expression.

    Attributes
    ----------
    positions_m, normals : (V, 3) float64
        Positions and normals of the V vertices of all meshes.
    triangles : (T, 3) int
        Vertex indices.
    colours : (T, 3) float64
        Linear colours of the triangles.
    morphs : mapping of str to ((n,) int, (n, 3) float64)
        Vertices moved by each morph, and their displacements.
    head_m : (float, float, float)
        Height of the head's joint and of the crown in metres; the middle is at x = 0.
    """

    positions_m: FloatArray
    normals: FloatArray
    triangles: IndexArray
    colours: FloatArray
    morphs: Mapping[str, tuple[IndexArray, FloatArray]]
    head_m: tuple[float, float]


def seen(character: Character) -> Seen:
    """Make a character ready to be drawn."""
    places = rest_positions(character.skeleton)
    world_from_mesh = character.joint_from_mesh[:, :3, :].copy()
    world_from_mesh[:, :, 3] += places
    positions, normals = list[FloatArray](), list[FloatArray]()
    triangles, colours = list[IndexArray](), list[FloatArray]()
    moved: dict[str, list[tuple[IndexArray, FloatArray]]] = {}
    first = 0
    for mesh in character.meshes:
        matrices = np.einsum("vk,vkij->vij", mesh.weights.astype(np.float64), world_from_mesh[mesh.joints])
        positions.append(np.einsum("vij,vj->vi", matrices[:, :, :3], mesh.positions_m) + matrices[:, :, 3])
        normals.append(np.einsum("vij,vj->vi", matrices[:, :, :3], mesh.normals))
        triangles.append(mesh.triangles.astype(np.intp) + first)
        colours.append(_colours(mesh))
        for morph in mesh.morphs:
            deltas = np.einsum("vij,vj->vi", matrices[morph.vertices, :, :3], morph.deltas_m)
            moved.setdefault(morph.name, []).append((morph.vertices.astype(np.intp) + first, deltas))
        first += len(mesh.positions_m)
    joined = np.concatenate(positions)
    head = float(places[character.skeleton.index("head"), 1])
    near = joined[np.abs(joined[:, 0]) < 0.3 * max(float(joined[:, 1].max()), 1e-6)]
    return Seen(
        positions_m=joined,
        normals=_unit(np.concatenate(normals)),
        triangles=np.concatenate(triangles),
        colours=np.concatenate(colours),
        morphs={
            name: (np.concatenate([at for at, _ in parts]), np.concatenate([deltas for _, deltas in parts]))
            for name, parts in moved.items()
        },
        head_m=(head, float(near[:, 1].max())),
    )


def picture(
    shown: Seen, width_px: int, height_px: int, crop: Crop = "body", weights: Mapping[str, float] | None = None
) -> QImage:
    """Return a front view of a character on a transparent background.

    Parameters
    ----------
    crop : Crop
        Whole body or head.
    weights : mapping of str to float, optional
        Weights of morphs; by default none.
    """
    positions = shown.positions_m
    for name, weight in (weights or {}).items():
        if name in shown.morphs and weight:
            at, deltas = shown.morphs[name]
            positions = positions.copy() if positions is shown.positions_m else positions
            np.add.at(positions, at, weight * deltas)
    low, high, half = _frame(shown, positions, crop)
    width, height = min(width_px, _LARGEST_PX) * _OVERSAMPLED, min(height_px, _LARGEST_PX) * _OVERSAMPLED
    scale = min(height / ((high - low) * _MARGIN), width / (2.0 * half * _MARGIN))
    middle_x = 0.0 if crop == "body" else _head_middle(shown)
    points = np.empty_like(positions)
    points[:, 0] = (positions[:, 0] - middle_x) * scale + width / 2.0
    points[:, 1] = ((low + high) / 2.0 - positions[:, 1]) * scale + height / 2.0
    points[:, 2] = positions[:, 2]
    normals = shown.normals
    if positions is not shown.positions_m:
        # A morph rotates the surface; the smoothing of the file's normals is kept.
        before, after = (_facing(shown.triangles, places) for places in (shown.positions_m, positions))
        normals = _unit(normals + after - before)
    front = _in_front(points, shown.triangles, width, height)
    canvas = _painted(front, points, positions, normals, shown, (width, height))
    image = QImage(canvas.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()
    smooth = Qt.TransformationMode.SmoothTransformation
    return image.scaled(width // _OVERSAMPLED, height // _OVERSAMPLED, Qt.AspectRatioMode.IgnoreAspectRatio, smooth)


def _colours(mesh: Mesh) -> FloatArray:
    """Return the linear colours (T, 3) of a mesh's T triangles; textures are read at the middle of each triangle."""
    base = np.array([material.base_color[:3] for material in mesh.materials], np.float64)
    result: FloatArray = base[mesh.triangle_materials]
    for number, material in enumerate(mesh.materials):
        own = np.flatnonzero(mesh.triangle_materials == number)
        if material.textures.color is not None and len(own):
            found = sampled(material.textures.color, mesh.uvs[mesh.triangles[own]].mean(axis=1))
            if found is not None:
                result[own] *= linear(found[:, :3])
    return result


def _frame(shown: Seen, positions: FloatArray, crop: Crop) -> tuple[float, float, float]:
    """Return the lowest and the highest y, and half the width, of the part of the character to draw, in metres."""
    if crop == "body":
        return float(positions[:, 1].min()), float(positions[:, 1].max()), float(np.abs(positions[:, 0]).max())
    joint, crown = shown.head_m
    low = joint - _HEAD_BELOW * (crown - joint)
    return low, crown, (crown - low) / 2.0


def _head_middle(shown: Seen) -> float:
    joint, _ = shown.head_m
    above = shown.positions_m[shown.positions_m[:, 1] > joint]
    return float((above[:, 0].min() + above[:, 0].max()) / 2.0) if len(above) else 0.0


def _unit(vectors: FloatArray) -> FloatArray:
    result: FloatArray = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return result


def _across(triangles: IndexArray, positions: FloatArray) -> FloatArray:
    """Return the normals (T, 3) of T triangles, with twice the triangle's area as length."""
    corners = positions[triangles]
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _facing(triangles: IndexArray, positions: FloatArray) -> FloatArray:
    """Return the unit normals (V, 3) of V vertices from the triangles around them."""
    across = _across(triangles, positions)
    return _unit(
        np.stack(
            [
                np.bincount(triangles.ravel(), np.repeat(across[:, axis], 3), minlength=len(positions))
                for axis in range(3)
            ],
            axis=1,
        )
    )


def _in_front(points: FloatArray, triangles: IndexArray, width: int, height: int) -> IntArray:
    """Return for each pixel (height, width) the index of the visible triangle, -1 for none; ``points`` are x, y in
    pixels and depth.

    Each triangle is drawn as closely spaced points; nearer points replace farther ones.
    """
    placed = points[triangles]
    inside = (placed[:, :, 0].max(1) > 0.0) & (placed[:, :, 0].min(1) < width)
    inside &= (placed[:, :, 1].max(1) > 0.0) & (placed[:, :, 1].min(1) < height)
    placed, steps = _by_edges(placed)
    # High bits depth, low bits triangle: the greatest value of a pixel is in front.
    depth = placed[:, :, 2]
    ranks = (depth - depth.min()) * (_DEPTHS / max(float(np.ptp(depth)), 1e-9))
    placed = np.concatenate([placed[:, :, :2], ranks[:, :, None]], axis=2).astype(np.float32)
    front = np.full(height * width, -1, np.int64)
    for step in np.unique(steps[inside], axis=0):
        chosen = np.flatnonzero(inside & (steps == step).all(axis=1))
        one, two = np.meshgrid(*(np.linspace(0.0, 1.0, 2 ** int(count) + 1) for count in step))
        kept = one + two <= 1.0
        shares = np.stack([1.0 - one[kept] - two[kept], one[kept], two[kept]], axis=1).astype(np.float32)
        for some in np.array_split(chosen, max(len(chosen) * len(shares) // 500_000, 1)):
            found = np.matmul(shares, placed[some])
            x, y = found[..., 0], found[..., 1]
            on = (x >= 0.0) & (x < width) & (y >= 0.0) & (y < height)
            pixels = y[on].astype(np.int64) * width + x[on].astype(np.int64)
            owners = np.broadcast_to(some[:, None], on.shape)[on]
            np.maximum.at(front, pixels, (found[..., 2][on].astype(np.int64) << 32) | owners)
    return np.where(front >= 0, front & 0xFFFFFFFF, -1)


def _painted(
    front: IntArray, points: FloatArray, positions: FloatArray, normals: FloatArray, shown: Seen, size: tuple[int, int]
) -> npt.NDArray[np.uint8]:
    """Return the RGBA colours (pixels, 4) of an image, shaded smoothly by the vertex normals; ``front`` is the visible
    triangle in each pixel.
    """
    width, height = size
    hit = np.flatnonzero(front >= 0)
    owners = front[hit]
    corners = shown.triangles[owners]
    shading = np.einsum("pk,pki->pi", _shares(points[corners][:, :, :2], hit, width), normals[corners])
    # Surfaces seen from behind are lit as from the front, whatever the winding of their triangles.
    across = _across(shown.triangles, positions)
    outward = np.einsum("ti,tki->t", across, normals[shown.triangles]) * across[:, 2]
    shading = _unit(shading) * np.where(outward[owners] < 0.0, -1.0, 1.0)[:, None]
    lit = _AMBIENT + _DIFFUSE * np.clip(shading @ _LIGHT, 0.0, 1.0)
    canvas = np.zeros((height * width, 4), np.uint8)
    canvas[hit, :3] = (255.0 * np.clip(shown.colours[owners] * lit[:, None], 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8)
    canvas[hit, 3] = 255
    return canvas


def _shares(corners: FloatArray, pixels: IndexArray, width: int) -> FloatArray:
    """Return the barycentric coordinates (P, 3) of the centres of P pixels, each in a triangle with ``corners`` (P, 3,
    2).
    """
    middle = np.stack([pixels % width, pixels // width], axis=1) + 0.5
    one, two, at = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], middle - corners[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    area = np.where(np.abs(area) < 1e-9, 1e-9, area)
    second = (at[:, 0] * two[:, 1] - at[:, 1] * two[:, 0]) / area
    third = (one[:, 0] * at[:, 1] - one[:, 1] * at[:, 0]) / area
    # At an edge the centre of the pixel may be outside the triangle.
    shares = np.clip(np.stack([1.0 - second - third, second, third], axis=1), 0.0, 1.0)
    result: FloatArray = shares / shares.sum(axis=1, keepdims=True)
    return result


def _by_edges(placed: FloatArray) -> tuple[FloatArray, IndexArray]:
    """Return triangles (T, 3, 3) with the corner opposite the longest edge first, and exponents (T, 2) of two.

    Dividing the two shorter edges into these powers of two gives points so close that no pixel is missed.
    """
    edges = np.linalg.norm((placed - np.roll(placed, -1, axis=1))[:, :, :2], axis=2)
    # The corner opposite the longest edge, which runs from corner k to k + 1, is k + 2.
    first = (edges.argmax(axis=1) + 2) % 3
    turned = placed[np.arange(len(placed))[:, None], (first[:, None] + np.arange(3)) % 3]
    lengths = np.linalg.norm((turned[:, 1:] - turned[:, :1])[:, :, :2], axis=2)
    return turned, np.clip(np.ceil(np.log2(np.maximum(_CLOSE * lengths, 1.0))), 0, 12).astype(np.intp)


def portrait_of(character_id: str, size_px: int) -> QImage:
    """Return the portrait of a character, drawn at the first call; can be called in any thread."""
    return _portrait(character_named(character_id), size_px)


@lru_cache(maxsize=32)
def _portrait(character: Character, size_px: int) -> QImage:
    return picture(seen(character), size_px, size_px, "head")
