"""Shapes an instrument is made of: swept tubes, turned bodies, plates; with normals, UVs and collision proxies.

Everything is in the root frame of the model, metres. A `Shape` is a triangle mesh; a `Part` puts it into a
node and gives it a material. Tubes and turned bodies can hand out the closed bodies (as tables of an instrument
map) that stand for them when a hand is checked against the instrument.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

HARD_DEG = 35.0
TOLERANCE_M = 0.0012
"""Greatest deviation in metres of collision bodies from the shapes they represent."""


@dataclass(frozen=True)
class Shape:
    """Triangles with one normal and one UV per vertex."""

    points: Array
    normals: Array
    uvs: Array
    faces: NDArray[np.int64]
    proxies: tuple[dict[str, object], ...] = ()


@dataclass(frozen=True)
class Part:
    """A shape of one material in a node."""

    node: str
    material: str
    shape: Shape


@dataclass
class Model:
    """The parts of an instrument and where its nodes rest."""

    origins: dict[str, Array] = field(default_factory=lambda: {"root": np.zeros(3)})
    parts: list[Part] = field(default_factory=list)

    def node(self, name: str, origin: ArrayLike) -> None:
        """Declare a moving node and the point of the root frame it rests at."""
        self.origins[name] = np.asarray(origin, float)

    def add(self, material: str, *shapes: Shape, node: str = "root") -> None:
        """Put shapes into a node."""
        if node not in self.origins:
            raise KeyError(node)
        self.parts.extend(Part(node, material, shape) for shape in shapes)


def unit(vector: ArrayLike) -> Array:
    """The vector with length 1."""
    array = np.asarray(vector, float)
    return array / np.linalg.norm(array)


def square_to(way: Array) -> tuple[Array, Array]:
    """Two directions square to one (of length 1) and to each other."""
    across = np.eye(3)[np.argmin(np.abs(way))]
    across = unit(across - way * (across @ way))
    return across, np.cross(way, across)


def bend(corners: Sequence[ArrayLike], radii: float | Sequence[float], step_m: float = 0.004) -> Array:
    """A centre line through straight legs whose corners are rounded by arcs.

    Parameters
    ----------
    corners : n points
    radii : one, or one for each of the n - 2 inner corners
    step_m : distance of the points on an arc
    """
    points = [np.asarray(corner, float) for corner in corners]
    inner = [radii] * (len(points) - 2) if isinstance(radii, int | float) else list(radii)
    line = [points[0]]
    for before, corner, after, radius in zip(points, points[1:], points[2:], inner, strict=False):
        back, ahead = unit(before - corner), unit(after - corner)
        turn = np.pi - np.arccos(np.clip(back @ ahead, -1, 1))
        if turn < 1e-4:
            continue
        cut = radius * np.tan(turn / 2)
        centre = corner + unit(back + ahead) * radius / np.cos(turn / 2)
        start, end = corner + back * cut - centre, corner + ahead * cut - centre
        count = max(4, int(np.ceil(radius * turn / step_m)))
        for share in np.linspace(0, 1, count + 1):
            line.append(
                centre + (np.sin((1 - share) * turn) * start + np.sin(share * turn) * end) / np.sin(turn)
                if turn < 3.1
                else centre + start * np.cos(share * turn) + end * np.sin(share * turn)
            )
    line.append(points[-1])
    return _apart(np.array(line))


def half_circle(start: ArrayLike, end: ArrayLike, outward: ArrayLike, count: int = 20) -> Array:
    """Points of a half circle from start to end that bulges outward."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    centre, across = (a + b) / 2, (a - b) / 2
    angles = np.linspace(0, np.pi, count + 1)[:, None]
    return centre + across * np.cos(angles) + unit(outward) * np.linalg.norm(across) * np.sin(angles)


def joined(*lines: ArrayLike) -> Array:
    """Centre lines one after the other, doubled points dropped."""
    return _apart(np.vstack([np.atleast_2d(np.asarray(line, float)) for line in lines]))


def _apart(line: Array) -> Array:
    keep = np.r_[True, np.linalg.norm(np.diff(line, axis=0), axis=1) > 1e-6]
    return line[keep]


def lengths(line: Array) -> Array:
    """Arc length at every point of a line."""
    return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]


def resampled(line: Array, step_m: float) -> Array:
    """The line with no two neighbours further apart than ``step_m``."""
    out = [line[0]]
    for a, b in itertools.pairwise(line):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / step_m)))
        out.extend(a + (b - a) * share for share in np.linspace(0, 1, count + 1)[1:])
    return np.array(out)


def _frames(line: Array, side: ArrayLike | None) -> tuple[Array, Array, Array]:
    """Tangents and two normals at every point, carried along without twist."""
    steps = np.diff(line, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    tangents = np.vstack([steps[:1], steps[1:] + steps[:-1], steps[-1:]])
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    first = np.asarray(side, float) if side is not None else np.eye(3)[np.argmin(np.abs(tangents[0]))]
    normals = np.empty_like(line)
    for index, tangent in enumerate(tangents):
        source = first if index == 0 else normals[index - 1]
        normals[index] = unit(source - tangent * (source @ tangent))
    return tangents, normals, np.cross(tangents, normals)


def tube(
    line: ArrayLike,
    radii: float | ArrayLike,
    *,
    sides: int = 20,
    closed: bool = True,
    flat: tuple[float, float] = (1.0, 1.0),
    side: ArrayLike | None = None,
    proxy: bool = True,
    tolerance_m: float = TOLERANCE_M,
) -> Shape:
    """A tube along a centre line.

    Parameters
    ----------
    line : (n, 3)
    radii : outer radius, one or n
    sides : faces around
    closed : close the two ends with discs
    flat : scale of the section along the two normals (a strap instead of a tube)
    side : direction of the first normal
    proxy : hand out capsules and cones for it
    tolerance_m : how far the capsules may be off the tube
    """
    centres = np.asarray(line, float)
    radius = np.broadcast_to(np.asarray(radii, float), (len(centres),)).copy()
    tangents, across, over = _frames(centres, side)
    arc = lengths(centres)
    if closed:
        radius_c = np.r_[0.0, radius, 0.0]
        arc_c = np.r_[arc[0], arc, arc[-1]]
        rows = np.r_[0, np.arange(len(centres)), len(centres) - 1]
    else:
        radius_c, arc_c, rows = radius, arc, np.arange(len(centres))
    shape = _skin(centres[rows], tangents[rows], across[rows], over[rows], arc_c, radius_c, sides, flat, HARD_DEG)
    proxies = _tube_proxies(centres, radius * max(flat), tolerance_m) if proxy else ()
    return replace(shape, proxies=tuple(proxies))


def turned(
    start: ArrayLike,
    axis: ArrayLike,
    profile: Sequence[tuple[float, float]],
    *,
    sides: int = 28,
    proxy: bool = True,
    hard_deg: float = HARD_DEG,
) -> Shape:
    """A body turned on a lathe: ``profile`` is (distance along the axis, radius), outer side to the left; its edges
    sharper than ``hard_deg`` stay edges."""
    origin, direction = np.asarray(start, float), unit(axis)
    along = np.array([place for place, _ in profile])
    radius = np.array([r for _, r in profile])
    across, over = square_to(direction)
    count = len(profile)
    shape = _skin(
        origin + along[:, None] * direction,
        np.tile(direction, (count, 1)),
        np.tile(across, (count, 1)),
        np.tile(over, (count, 1)),
        along,
        radius,
        sides,
        (1.0, 1.0),
        hard_deg,
    )
    proxies = _turned_proxies(origin, direction, along, radius) if proxy else ()
    return replace(shape, proxies=tuple(proxies))


def solid(
    start: ArrayLike, axis: ArrayLike, profile: Sequence[tuple[float, float]], *, sides: int = 28, proxy: bool = True
) -> Shape:
    """A turned body closed by a disc at either end: of two equal radii a cylinder."""
    closed = [(profile[0][0], 0.0), *profile, (profile[-1][0], 0.0)]
    return turned(start, axis, closed, sides=sides, proxy=proxy)


def _skin(
    centres: Array,
    tangents: Array,
    across: Array,
    over: Array,
    along: Array,
    radius: Array,
    sides: int,
    flat: tuple[float, float],
    hard_deg: float,
) -> Shape:
    """Rings joined to a skin; a ring is doubled where the profile has an edge."""
    slope = np.column_stack([np.diff(along), np.diff(radius)])
    slope /= np.maximum(np.linalg.norm(slope, axis=1), 1e-12)[:, None]
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    circle = np.stack([np.cos(angles), np.sin(angles)], 1)
    rings: list[tuple[int, Array]] = []
    bands: list[tuple[int, int]] = []
    hard = np.cos(np.radians(hard_deg))
    for index in range(len(centres)):
        before = slope[index - 1] if index > 0 else None
        after = slope[index] if index < len(slope) else None
        if before is None or after is None or before @ after < hard:
            if before is not None:
                rings.append((index, before))
                bands.append((len(rings) - 2, len(rings) - 1))
            if after is not None:
                rings.append((index, after))
        else:
            rings.append((index, unit(before + after)))
            bands.append((len(rings) - 2, len(rings) - 1))
    points, normals, uvs, faces = [], [], [], []
    total = max(float(lengths(np.column_stack([along, radius]))[-1]), 1e-9)
    profile_length = lengths(np.column_stack([along, radius]))
    for index, direction in rings:
        a, b = across[index] * flat[0], over[index] * flat[1]
        points.append(centres[index] + radius[index] * (circle[:, :1] * a + circle[:, 1:] * b))
        radial = circle[:, :1] * across[index] / flat[0] + circle[:, 1:] * over[index] / flat[1]
        radial /= np.linalg.norm(radial, axis=1)[:, None]
        normals.append(direction[0] * radial - direction[1] * tangents[index])
        uvs.append(np.column_stack([angles / (2 * np.pi), np.full(sides + 1, profile_length[index] / total)]))
    for low, high in bands:
        first, second = low * (sides + 1), high * (sides + 1)
        for k in range(sides):
            quad = (first + k, first + k + 1, second + k + 1, second + k)
            if radius[rings[low][0]] > 1e-9:
                faces.append(
                    (quad[0], quad[1], quad[2]) if radius[rings[high][0]] > 1e-9 else (quad[0], quad[1], quad[3])
                )
            if radius[rings[high][0]] > 1e-9:
                faces.append((quad[0], quad[2], quad[3]))
    flat_normals = np.vstack(normals)
    flat_normals /= np.linalg.norm(flat_normals, axis=1)[:, None]
    return Shape(np.vstack(points), flat_normals, np.vstack(uvs), np.array(faces, np.int64))


def torus(
    centre: ArrayLike, axis: ArrayLike, radius: float, thick: float, *, sides: int = 14, around: int = 36
) -> Shape:
    """A ring."""
    middle, direction = np.asarray(centre, float), unit(axis)
    across, over = square_to(direction)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, around + 1), np.linspace(0, 2 * np.pi, sides + 1), indexing="ij")
    radial = np.cos(u)[..., None] * across + np.sin(u)[..., None] * over
    normals = np.cos(v)[..., None] * radial + np.sin(v)[..., None] * direction
    points = middle + radius * radial + thick * normals
    faces = []
    for i in range(around):
        for j in range(sides):
            a, b = i * (sides + 1) + j, (i + 1) * (sides + 1) + j
            faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    uvs = np.stack([u / (2 * np.pi), v / (2 * np.pi)], -1)
    ring = {"shape": "ring", "centre_m": middle, "axis": direction, "radius_m": radius, "tube_radius_m": thick}
    return Shape(points.reshape(-1, 3), normals.reshape(-1, 3), uvs.reshape(-1, 2), np.array(faces), (ring,))


def plate(centre: ArrayLike, half: ArrayLike, x_axis: ArrayLike, y_axis: ArrayLike) -> Shape:
    """A box with half sizes along x, y and their cross product."""
    middle, size = np.asarray(centre, float), np.asarray(half, float)
    axes = np.array([unit(x_axis), unit(y_axis), np.cross(unit(x_axis), unit(y_axis))])
    points, normals, uvs, faces = [], [], [], []
    for axis in range(3):
        for sign in (1, -1):
            a, b = axes[(axis + 1) % 3] * size[(axis + 1) % 3], axes[(axis + 2) % 3] * size[(axis + 2) % 3]
            start = len(points)
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                points.append(middle + sign * axes[axis] * size[axis] + s * a + t * b)
                normals.append(sign * axes[axis])
                uvs.append(((s + 1) / 2, (t + 1) / 2))
            corner = [start, start + 1, start + 2, start + 3]
            if sign < 0:
                corner = corner[::-1]
            faces += [(corner[0], corner[1], corner[2]), (corner[0], corner[2], corner[3])]
    box = {"shape": "box", "centre_m": middle, "half_m": size, "x_axis": axes[0], "y_axis": axes[1]}
    return Shape(np.array(points), np.array(normals), np.array(uvs), np.array(faces), (box,))


def _tube_proxies(line: Array, radius: Array, tolerance_m: float) -> list[dict[str, object]]:
    """Capsules (even radius) and cones along a line, within the tolerance of it."""
    found: list[dict[str, object]] = []
    for start, end in _runs(line, radius, tolerance_m):
        a, b = line[start], line[end]
        if abs(radius[start] - radius[end]) < tolerance_m:
            thick = float(max(radius[start : end + 1]))
            kind = "cylinder" if start == 0 and end == len(line) - 1 else "capsule"
            found.append({"shape": kind, "a_m": a, "b_m": b, "radius_m": thick})
        else:
            found.append({"shape": "cone", "a_m": a, "b_m": b, "radius_a_m": radius[start], "radius_b_m": radius[end]})
    return found


def _runs(line: Array, radius: Array, tolerance_m: float) -> list[tuple[int, int]]:
    """Longest runs of a line that are straight and evenly tapered within the tolerance."""
    found = []
    start = 0
    while start < len(line) - 1:
        end = start + 1
        while end + 1 < len(line) and _straight(line, radius, start, end + 1, tolerance_m):
            end += 1
        found.append((start, end))
        start = end
    return found


def _straight(line: Array, radius: Array, start: int, end: int, tolerance_m: float) -> bool:
    a, b = line[start], line[end]
    direction = b - a
    share = (line[start : end + 1] - a) @ direction / (direction @ direction)
    off = line[start : end + 1] - (a + share[:, None] * direction)
    thick = radius[start] + share * (radius[end] - radius[start])
    return bool(
        (np.linalg.norm(off, axis=1) < tolerance_m).all()
        and (np.abs(thick - radius[start : end + 1]) < tolerance_m).all()
    )


def _turned_proxies(origin: Array, axis: Array, along: Array, radius: Array) -> list[dict[str, object]]:
    """Cylinders and cones that stand for the outer side of a profile (where it runs forward)."""
    outer = [0]
    for index in range(1, len(along)):
        if along[index] > along[outer[-1]] + 1e-5:
            outer.append(index)
        elif along[index] >= along[outer[-1]] - 1e-5 and radius[index] > radius[outer[-1]]:
            outer[-1] = index
        elif along[index] < along[outer[-1]] - 1e-5:
            outer = [kept for kept in outer if along[kept] < along[index] - 1e-5] + [index]
    places = origin + along[outer, None] * axis
    found: list[dict[str, object]] = []
    for start, end in _runs(places, radius[outer], TOLERANCE_M):
        r, s = (max(float(radius[outer[k]]), 1e-4) for k in (start, end))
        if abs(r - s) < TOLERANCE_M:
            thick = float(max(radius[outer[start : end + 1]]))
            found.append({"shape": "cylinder", "a_m": places[start], "b_m": places[end], "radius_m": thick})
        else:
            found.append({"shape": "cone", "a_m": places[start], "b_m": places[end], "radius_a_m": r, "radius_b_m": s})
    return found
