"""Meshes of bands, cords and rounded solids: strips of rings with normals, joined to one mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from app.arrays import FloatArray, IntArray
from app.formats.scene import Material
from app.rig import quaternion
from app.rig.mesh import Mesh

Shares: TypeAlias = Sequence[tuple[int, float]]
"""Bones with their weights."""


@dataclass(frozen=True, eq=False)
class SurfaceStrip:
    """A surface of one material, given as a grid of R rings of C points.

    Attributes
    ----------
    points_m : (R, C, 3) float64
        Points; seen from outside, columns advance to the left if rings advance upwards.
    weights : sequence of shares
        Bones and their weights for each ring.
    closed : bool
        Whether the last point of a ring is connected to the first.
    material : int
        Index of the material.
    """

    points_m: FloatArray
    weights: Sequence[Shares]
    closed: bool
    material: int = 0


def mesh_of(name: str, strips: Sequence[SurfaceStrip], materials: tuple[Material, ...]) -> Mesh:
    """Join strips to a mesh. The texture coordinate u goes around a ring, v from ring to ring."""
    columns = 4
    positions, normals, uvs, triangles, looks = [], [], [], [], []
    joints, weights = list[IntArray](), list[FloatArray]()
    start = 0
    for strip in strips:
        points = strip.points_m
        if strip.closed:
            points = np.concatenate([points, points[:, :1]], axis=1)
        rings, count = points.shape[:2]
        positions.append(points.reshape(-1, 3))
        normals.append(_normals(points, strip.closed).reshape(-1, 3))
        around, along = np.meshgrid(np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, rings))
        uvs.append(np.stack([around, along], axis=-1).reshape(-1, 2))
        corner = start + np.arange(rings * count).reshape(rings, count)
        a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
        faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
        triangles.append(faces)
        looks.append(np.full(len(faces), strip.material))
        bones, shares = _padded(strip.weights, columns)
        joints.append(np.repeat(bones, count, axis=0))
        weights.append(np.repeat(shares, count, axis=0))
        start += rings * count
    return Mesh(
        name=name,
        positions_m=np.concatenate(positions).astype(np.float32),
        normals=np.concatenate(normals).astype(np.float32),
        uvs=np.concatenate(uvs).astype(np.float32),
        triangles=np.concatenate(triangles).astype(np.int32),
        triangle_materials=np.concatenate(looks).astype(np.int32),
        materials=materials,
        joints=np.concatenate(joints).astype(np.int32),
        weights=np.concatenate(weights).astype(np.float32),
    )


def _padded(weights: Sequence[Shares], columns: int) -> tuple[IntArray, FloatArray]:
    """Return the ``columns`` strongest bones of each of R rings, and their weights, which add up to 1; both (R,
    columns).
    """
    bones, shares = np.zeros((len(weights), columns), np.int64), np.zeros((len(weights), columns))
    for row, own in enumerate(weights):
        strongest = sorted(own, key=lambda one: -one[1])[:columns]
        for column, (bone, share) in enumerate(strongest):
            bones[row, column], shares[row, column] = bone, share
    return bones, shares / shares.sum(axis=1, keepdims=True)


def _normals(points: FloatArray, closed: bool) -> FloatArray:
    """Return the normals (R, C, 3) of a grid of R rings with C corners; a ring whose points coincide gets the normals
    of its neighbour.
    """
    along = np.gradient(points, axis=0)
    if closed:
        wrapped = np.concatenate([points[:, -2:-1], points, points[:, 1:2]], axis=1)
        around = wrapped[:, 2:] - wrapped[:, :-2]
    else:
        around = np.gradient(points, axis=1)
    found = quaternion.cross(around, along)
    length = np.linalg.norm(found, axis=-1, keepdims=True)
    flat = length[..., 0] < 1e-12
    found = np.where(flat[..., None], 0.0, found / np.maximum(length, 1e-12))
    for row in np.flatnonzero(flat.all(axis=1)):
        # The centre of a cap gets the mean direction of its surroundings.
        mean = found[row - 1 if row else 1].mean(axis=0)
        found[row] = mean / max(float(np.linalg.norm(mean)), 1e-12)
    return found


def band(
    centre_m: FloatArray,
    across: FloatArray,
    outwards: FloatArray,
    half_m: FloatArray,
    thick_m: FloatArray,
    weights: Sequence[Shares],
    over_m: FloatArray,
    material: int = 0,
    edges_m: tuple[FloatArray, FloatArray] | None = None,
) -> list[SurfaceStrip]:
    """Return the surfaces of a flat band along a line of R points: outer and inner face and two edges. The ends stay
    open: the band is too thin for it to show.

    Parameters
    ----------
    centre_m, across, outwards : (R, 3) float64
        Points of its middle line, and unit vectors from there to one of its edges and away from the surface below it.
    half_m, thick_m : (R,) float64
        Half its width, and its thickness.
    weights : sequence of shares
        Skin weights of each of the R points.
    over_m : (R,) float64
        Distance of the inner face from the surface below it.
    material : int
        Index of the material of its surfaces.
    edges_m : two of (R, 3), optional
        Points of both edges; absent: the middle line moved by half the width.
    """
    raised = outwards * over_m[:, None]
    if edges_m is None:
        edges_m = (centre_m + across * half_m[:, None], centre_m - across * half_m[:, None])
    one, other = edges_m[0] + raised, edges_m[1] + raised
    middle = centre_m + raised
    over = outwards * thick_m[:, None]
    inner, outer = np.stack([one, middle, other], axis=1), np.stack([one + over, middle + over, other + over], axis=1)
    strips = [
        outer[:, ::-1],
        inner,
        np.stack([inner[:, 2], outer[:, 2]], axis=1),
        np.stack([outer[:, 0], inner[:, 0]], 1),
    ]
    return [SurfaceStrip(points, weights, False, material) for points in strips]


def tube(
    line_m: FloatArray, radii_m: FloatArray, weights: Sequence[Shares], material: int = 0, sides: int = 10
) -> SurfaceStrip:
    """Return the surface of a round tube along a line of R points (R, 3); radii of 0 close its ends."""
    tangents = np.gradient(line_m, axis=0)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-12)
    first = np.array([0.0, 0.0, 1.0]) if abs(tangents[0][2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    angles = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rings = []
    for point, tangent, radius in zip(line_m, tangents, radii_m, strict=True):
        first = first - tangent * (first @ tangent)
        first = first / max(float(np.linalg.norm(first)), 1e-12)
        second = quaternion.cross(tangent, first)
        rings.append(point + radius * (np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second))
    return SurfaceStrip(np.array(rings), weights, True, material)
