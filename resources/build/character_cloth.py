"""Cloth in the T-pose, where limbs lie along the axes: refining, cutting, draping and folding a skinned surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from character_surface import Surface, modelled
from scipy.ndimage import gaussian_filter1d
from scipy.sparse import coo_array
from scipy.spatial import ConvexHull

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit


@dataclass(frozen=True)
class Cloth:
    """A piece of cloth in the T-pose: `points` (N, 3), `weights` (N, J) and quads (F, 4) or triangles (F, 3)."""

    points: np.ndarray
    weights: np.ndarray
    faces: np.ndarray


def catmull_clark(cloth: Cloth) -> Cloth:
    """One Catmull-Clark step over quads; weights are carried along linearly, open borders become smooth curves."""
    values = np.concatenate([cloth.points, cloth.weights], axis=1)
    quads, count = cloth.faces, len(cloth.points)
    centres = values[quads].mean(axis=1)
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    unique, inverse, uses = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.reshape(-1)
    middles = values[unique].mean(axis=1)
    centre_sum = np.zeros_like(middles)
    np.add.at(centre_sum, inverse, np.repeat(centres, 4, axis=0))
    border = uses == 1
    edge_points = np.where(border[:, None], middles, middles / 2 + centre_sum / 4)
    valence = np.bincount(unique.ravel(), minlength=count).astype(float)
    face_mean, middle_mean = np.zeros_like(values), np.zeros_like(values)
    np.add.at(face_mean, quads.ravel(), np.repeat(centres, 4, axis=0))
    face_mean /= np.maximum(np.bincount(quads.ravel(), minlength=count), 1)[:, None]
    np.add.at(middle_mean, unique.ravel(), np.repeat(middles, 2, axis=0))
    middle_mean /= np.maximum(valence, 1)[:, None]
    n = np.maximum(valence, 3)[:, None]
    moved = (face_mean + 2 * middle_mean + (n - 3) * values) / n
    border_mean = np.zeros_like(values)
    border_edges = unique[border]
    np.add.at(border_mean, border_edges.ravel(), np.repeat(middles[border], 2, axis=0))
    on_border = np.bincount(border_edges.ravel(), minlength=count) == 2
    moved[on_border] = values[on_border] / 2 + border_mean[on_border] / 4
    moved[:, 3:] = values[:, 3:]
    e = inverse.reshape(-1, 4) + count
    f = np.arange(len(quads)) + count + len(unique)
    faces = np.concatenate([np.stack([quads[:, k], e[:, k], f, e[:, k - 1]], axis=1) for k in range(4)])
    result = np.concatenate([moved, edge_points, centres])
    weights = result[:, 3:]
    return Cloth(result[:, :3], weights / weights.sum(axis=1, keepdims=True), faces)


def to_triangles(cloth: Cloth) -> Cloth:
    a, b, c, d = cloth.faces.T
    return replace(cloth, faces=np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def cut(cloth: Cloth, height: np.ndarray) -> Cloth:
    """The part of a triangle cloth where `height` (N,) is positive, cut cleanly along its zero line."""
    height = np.where(np.abs(height) < 1e-5, 1e-5, height)
    positive = height > 0
    inside = positive[cloth.faces].sum(axis=1)
    faces = [cloth.faces[inside == 3]]
    crossing = cloth.faces[(inside == 1) | (inside == 2)]
    lone_sign = inside[(inside == 1) | (inside == 2)] == 1
    # Turn each crossing triangle so that the corner that is alone on its side comes first.
    lone = np.argmax(positive[crossing] == lone_sign[:, None], axis=1)
    turned = np.take_along_axis(crossing, (lone[:, None] + np.arange(3)) % 3, axis=1)
    edges = np.concatenate([turned[:, [0, 1]], turned[:, [0, 2]]])
    unique, inverse = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    share = height[unique[:, 0]] / (height[unique[:, 0]] - height[unique[:, 1]])
    new = len(cloth.points) + inverse.reshape(2, -1)
    faces.append(np.stack([turned[:, 0], new[0], new[1]], axis=1)[lone_sign])
    faces.append(np.stack([new[0], turned[:, 1], turned[:, 2]], axis=1)[~lone_sign])
    faces.append(np.stack([new[0], turned[:, 2], new[1]], axis=1)[~lone_sign])

    def extended(values: np.ndarray) -> np.ndarray:
        ends = values[unique[:, 0]] * (1 - share[:, None]) + values[unique[:, 1]] * share[:, None]
        return np.concatenate([values, ends])

    return drop_unused(Cloth(extended(cloth.points), extended(cloth.weights), np.concatenate(faces)))


def relaxed(cloth: Cloth, share: np.ndarray, steps: int) -> Cloth:
    """The cloth with its points drawn towards their neighbours' mean, by `share` (N,) in 0..1 at every step."""
    edges = np.unique(
        np.sort(np.stack([cloth.faces, np.roll(cloth.faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1), axis=0
    )
    count = len(cloth.points)
    ones = np.ones(len(edges))
    neighbours = coo_array((ones, (edges[:, 0], edges[:, 1])), shape=(count, count)).tocsr()
    neighbours = neighbours + neighbours.T
    degree = np.maximum(neighbours.sum(axis=1), 1)[:, None]
    points = cloth.points
    for _ in range(steps):
        points = points + 0.5 * share[:, None] * (neighbours @ points / degree - points)
    return replace(cloth, points=points)


def drop_unused(cloth: Cloth) -> Cloth:
    used, faces = np.unique(cloth.faces, return_inverse=True)
    return Cloth(cloth.points[used], cloth.weights[used], faces.reshape(cloth.faces.shape))


def border_loops(faces: np.ndarray) -> list[np.ndarray]:
    """The open borders of a mesh as closed vertex loops, longest first, in the direction of the faces."""
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    forward = {(int(a), int(b)) for a, b in edges}
    following = {a: b for a, b in sorted(forward) if (b, a) not in forward}
    loops = []
    while following:
        start = min(following)
        loop = [start]
        while (after := following.pop(loop[-1])) != start:
            loop.append(after)
        loops.append(np.array(loop))
    return sorted(loops, key=len, reverse=True)


def grid_faces(rows: int, columns: int, closed: bool) -> np.ndarray:
    """Quads of a (rows, columns) grid of vertices; `closed` joins the last column to the first."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij")
    after = (column + 1) % columns
    corners = [row * columns + column, row * columns + after, (row + 1) * columns + after, (row + 1) * columns + column]
    return np.stack([corner.ravel() for corner in corners], axis=1)


def join(*parts: Cloth) -> Cloth:
    starts = np.cumsum([0] + [len(part.points) for part in parts])
    return Cloth(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.weights for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]),
    )


@dataclass(frozen=True)
class Profile:
    """A body of rotation-like shape: radius over (level, angle) about a straight or bent axis.

    Attributes
    ----------
    levels : (L,) coordinate along the axis, ascending.
    centres : (L, 2) of the axis in the plane across it.
    radii : (L, A) over angles 2 pi a / A.
    """

    levels: np.ndarray
    centres: np.ndarray
    radii: np.ndarray

    def polar(self, along: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(angle, radius, centre) of points given by their coordinates along (N,) and across (N, 2) the axis."""
        centre = np.stack([np.interp(along, self.levels, self.centres[:, k]) for k in range(2)], axis=1)
        offset = across - centre
        return np.arctan2(offset[:, 1], offset[:, 0]), np.linalg.norm(offset, axis=1), centre

    def radius_at(self, along: np.ndarray, angle: np.ndarray) -> np.ndarray:
        count = self.radii.shape[1]
        level = np.interp(along, self.levels, np.arange(len(self.levels)))
        row = np.minimum(level.astype(int), len(self.levels) - 2)
        column = (angle / (2 * np.pi) * count) % count
        left = column.astype(int) % count
        u, v = level - row, column - column.astype(int)
        right = (left + 1) % count
        low = self.radii[row, left] * (1 - v) + self.radii[row, right] * v
        high = self.radii[row + 1, left] * (1 - v) + self.radii[row + 1, right] * v
        return low * (1 - u) + high * u


def hull_profile(
    along: np.ndarray, across: np.ndarray, levels: np.ndarray, centres: np.ndarray, window_m: float
) -> Profile:
    """The convex hull of every slice of a point cloud, as radii over 72 angles: how cloth spans hollows."""
    angles = 2 * np.pi * np.arange(72) / 72
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    radii = np.full((len(levels), 72), np.nan)
    for row, (level, centre) in enumerate(zip(levels, centres, strict=True)):
        slice_points = across[np.abs(along - level) < window_m]
        if len(slice_points) < 8:
            continue
        hull = ConvexHull(slice_points)
        normals, offsets = hull.equations[:, :2], hull.equations[:, 2] + hull.equations[:, :2] @ centre
        facing = normals @ directions.T
        reach = np.where(facing > 1e-9, -offsets[:, None] / np.maximum(facing, 1e-9), np.inf)
        radii[row] = np.maximum(reach.min(axis=0), 0.0)
    # A level beyond the cloud's ends takes the nearest level that has a slice.
    filled = np.flatnonzero(~np.isnan(radii[:, 0]))
    radii = radii[filled[np.abs(filled[:, None] - np.arange(len(levels))).argmin(axis=0)]]
    return Profile(levels, centres, radii)


def hang(profile: Profile, slope: float | np.ndarray) -> Profile:
    """Cloth that falls from its widest place above: radii shrink downwards by at most `slope` per metre (a number, or
    one per level)."""
    radii = profile.radii.copy()
    slopes = np.broadcast_to(slope, profile.levels.shape)
    for row in range(len(radii) - 2, -1, -1):
        drop = (profile.levels[row + 1] - profile.levels[row]) * slopes[row]
        radii[row] = np.maximum(radii[row], radii[row + 1] - drop)
    return replace(profile, radii=radii)


def smoothed(profile: Profile, levels: float, angles: float) -> Profile:
    radii = gaussian_filter1d(profile.radii, levels, axis=0, mode="nearest")
    return replace(profile, radii=gaussian_filter1d(radii, angles, axis=1, mode="wrap"))


def folds(along: np.ndarray, angle: np.ndarray, wavelength_m: float, seed: int) -> np.ndarray:
    """Soft creases in -1..1 that run round a limb aslant: a sum of a few seeded waves, rounded on top."""
    rng = np.random.Generator(np.random.PCG64(seed))
    total = np.zeros_like(along)
    for _ in range(5):
        length = wavelength_m * rng.uniform(0.7, 1.6)
        turns, phase = rng.integers(-2, 3), rng.uniform(0, 2 * np.pi)
        total += np.sin(2 * np.pi * along / length + turns * angle + phase)
    return np.tanh(total / 2.0)


def smoothstep(value: np.ndarray, low: float, high: float) -> np.ndarray:
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3 - 2 * t)


def cloth_surface(name: str, parts: dict[str, Cloth], fit: SkeletonFit) -> Surface:
    """A surface of the file from triangle cloths in the T-pose, one per material. Texture coordinates are the plan of
    the front, one unit per metre."""
    joined = join(*parts.values())
    # Cloth does with four bones; only skin that touches things needs all of its own.
    weights = np.where(joined.weights < 1e-3, 0.0, joined.weights)
    np.put_along_axis(weights, np.argsort(-weights, axis=1, kind="stable")[:, 4:], 0.0, axis=1)
    weights /= weights.sum(axis=1, keepdims=True)
    triangles, start = {}, 0
    for material, part in parts.items():
        triangles[material] = joined.faces[start : start + len(part.faces)]
        start += len(part.faces)
    uvs = joined.points[:, :2] + np.array([1.0, 0.0])
    return modelled(name, fit.to_rest_pose(joined.points, weights), weights, triangles, uvs=uvs)
