"""Fine hairs: small cards along the hairline, which bridge from the hair's edge to the skin, and cards that stand off.

MakeHuman's hair is a cap that hovers over the scalp and ends in an edge. Each card here carries about a dozen single
hairs, drawn in an unused part of the picture of the hair, thin towards both ends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from character_surface import Surface, triangulate, vertex_normals
from PIL import Image, ImageDraw
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from character_source import Source

PATCH_PX: Final = (80, 200)
"""Height and width of the part of the picture with the hairs of all cards."""
KINDS, STRANDS, SUPERSAMPLED = 4, (15, 7), 4
"""Cards drawn, of which the last are those that stand off; hairs in a card of either use."""
LOOSE_KINDS, CURL = 1, 0.16
MARGIN_PX: Final = 3
SPACING_M, MOST = 0.0024, 330
"""Distance between cards along the hairline, and their greatest number."""
LENGTH_M, LOOSE_LENGTH_M = (0.008, 0.016), (0.014, 0.024)
WIDTH_M: Final = (0.0045, 0.0070)
OUTSIDE: Final = 0.45
"""Share of a card that lies before the edge."""
ABOVE_SKIN_M, ABOVE_HAIR_M = 0.0005, 0.0008
REACH_M, BURIED_M = 0.016, 0.001
"""Distance from the skin within which an edge is a hairline, and depth in it from which it is hidden."""
EDGE_PX, NEAR_BARE_PX = 3.0, 10.0
"""Width along the border of the parts that cover the scalp, and distance of where they end, for it to be an edge."""
INNER_PX: Final = 12.0
"""Least distance of cards that stand off from the end of the hair."""
INWARDS, ACROSS = 0.55, 1.6
"""Least share of a card's direction that goes across the edge, and how strongly what lacks is added."""
TURNED_DEG: Final = 20.0


@dataclass(frozen=True)
class Loose:
    """Cards that stand off: distance between them, their greatest number, and how far their outer ends stand off."""

    spacing_m: float
    most: int
    lift_m: tuple[float, float]


STRAIGHT: Final = Loose(0.011, 110, (0.0015, 0.0045))
CURLY: Final = Loose(0.006, 0, (0.0, 0.0))
"""None of curls: cards of them are dark leaves on the hair, and ragged scraps at its edge."""


@dataclass(frozen=True)
class Laid:
    """A picture's pixels on the surface that shows it: places, normals and steps per pixel, (H, W, 3) in metres.

    Attributes
    ----------
    face : (H, W) the triangle of each pixel, -1 where there is none.
    down, right : the displacement of a step to the next row, and to the next column.
    """

    face: np.ndarray
    places: np.ndarray
    normals: np.ndarray
    down: np.ndarray
    right: np.ndarray


def free_patch(used: np.ndarray) -> tuple[int, int] | None:
    """First row and column of an unused part of PATCH_PX with a margin, None if there is none."""
    height, width = (side + 2 * MARGIN_PX for side in PATCH_PX)
    if min(used.shape) < max(height, width):
        return None
    sums = np.pad(used.astype(np.int64).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    within = sums[height:, width:] - sums[:-height, width:] - sums[height:, :-width] + sums[:-height, :-width]
    rows, columns = np.nonzero(within == 0)
    return (int(rows[0]) + MARGIN_PX, int(columns[0]) + MARGIN_PX) if len(rows) else None


def drawn_hairs(curled: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Shade (about 1 on average) and alpha of single hairs, PATCH_PX: the ends of cards' outer sides at the top."""
    rng = np.random.Generator(np.random.PCG64(41))
    height, width = (side * SUPERSAMPLED for side in PATCH_PX)
    each = width // KINDS
    shade, alpha = Image.new("F", (width, height), 1.0), Image.new("L", (width, height))
    draw_shade, draw_alpha = ImageDraw.Draw(shade), ImageDraw.Draw(alpha)
    for kind in range(KINDS):
        loose = kind >= KINDS - LOOSE_KINDS
        for _ in range(STRANDS[loose]):
            x = (kind + rng.uniform(0.10, 0.90)) * each
            # Hairs are of different lengths, so that neither end of a card is a line.
            top, bottom = rng.uniform(0.02, 0.42) * height, rng.uniform(0.72, 0.99) * height
            lean, bow = rng.normal(0, 0.13) * each, rng.normal(0, 0.12) * each
            share = np.linspace(0.0, 1.0, 25)
            bent = bow * np.sin(np.pi * share)
            if curled:
                bent = CURL * each * np.sin(2.0 * np.pi * (rng.uniform(1.5, 3.0) * share + rng.uniform()))
            line_x = np.clip(x + lean * (share - 0.5) + bent, kind * each + 8, (kind + 1) * each - 8)
            line_y = top + (bottom - top) * share
            widest = rng.uniform(1.0, 1.8) * SUPERSAMPLED * (0.8 if loose else 1.0)
            tone = float(np.exp(rng.normal(0.0, 0.35)))
            for i in range(24):
                thick = widest * min(1.0, 0.30 + 1.6 * share[i], 0.5 + 2.5 * (1 - share[i]))
                ends = [(line_x[i], line_y[i]), (line_x[i + 1], line_y[i + 1])]
                draw_alpha.line(ends, fill=255, width=max(1, round(thick)))
                draw_shade.line(ends, fill=tone, width=max(1, round(thick)) + 4)
    reduced = (PATCH_PX[0], SUPERSAMPLED, PATCH_PX[1], SUPERSAMPLED)
    return (
        np.asarray(shade).reshape(reduced).mean(axis=(1, 3)),
        np.asarray(alpha, dtype=np.float64).reshape(reduced).mean(axis=(1, 3)) / 255.0,
    )


def laid(surface: Surface, size: int) -> Laid:
    """The pixels of a picture (size, size) on its surface."""
    triangles = surface.all_triangles()
    face = Image.new("I", (size, size), -1)
    drawing = ImageDraw.Draw(face)
    pixels = np.stack([surface.uvs[:, 0], 1.0 - surface.uvs[:, 1]], axis=1) * size
    for number, corners in enumerate(triangles):
        drawing.polygon([tuple(pixels[corner]) for corner in corners], fill=number, outline=number)
    number = np.asarray(face)
    rows, columns = np.nonzero(number >= 0)
    own = triangles[number[rows, columns]]
    a, b, c = (pixels[own[:, k]] for k in range(3))
    edges = np.stack([b - a, c - a], axis=2)
    flat = np.abs(np.linalg.det(edges)) < 1e-9
    edges[flat] = np.eye(2)
    inverse = np.linalg.inv(edges)
    shares = np.einsum("nij,nj->ni", inverse, np.stack([columns + 0.5, rows + 0.5], axis=1) - a)
    corner = [surface.positions[own[:, k]] for k in range(3)]
    steps = np.stack([corner[1] - corner[0], corner[2] - corner[0]], axis=2)
    result = [np.zeros((size, size, 3)) for _ in range(4)]
    result[0][rows, columns] = corner[0] + np.einsum("nij,nj->ni", steps, shares)
    weights = np.concatenate([1 - shares.sum(axis=1, keepdims=True), shares], axis=1)
    normals = sum(weights[:, k, None] * surface.normals[own[:, k]] for k in range(3))
    result[1][rows, columns] = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    per_pixel = steps @ inverse
    result[2][rows, columns], result[3][rows, columns] = per_pixel[:, :, 1], per_pixel[:, :, 0]
    return Laid(number, *result)


def _apart(places: np.ndarray, spacing_m: float, most: int, rng: np.random.Generator) -> np.ndarray:
    """Rows of at most `most` of the places (N, 3) in random order, none nearer than a distance to another."""
    order = rng.permutation(len(places))
    tree, taken, blocked = cKDTree(places), [], np.zeros(len(places), dtype=bool)
    for row in order:
        if len(taken) == most:
            break
        if not blocked[row]:
            taken.append(row)
            blocked[tree.query_ball_point(places[row], spacing_m)] = True
    return np.array(taken, dtype=np.int64)


@dataclass(frozen=True)
class _Skin:
    points: np.ndarray
    normals: np.ndarray
    tree: cKDTree

    def above(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Heights (N,) over the skin, and its normals (N, 3)."""
        nearest = self.tree.query(places)[1]
        return np.einsum("nk,nk->n", places - self.points[nearest], self.normals[nearest]), self.normals[nearest]


def skin_of(source: Source) -> _Skin:
    """The skin of a body, also between its vertices."""
    quads = source.groups["body"].vertices
    normals = vertex_normals(source.vertices, triangulate(quads, source.vertices))
    shares = np.array(
        [
            (x * y, (1 - x) * y, (1 - x) * (1 - y), x * (1 - y))
            for x in (0, 0.25, 0.5, 0.75)
            for y in (0, 0.25, 0.5, 0.75)
        ]
    )
    points = np.einsum("sk,qkd->sqd", shares, source.vertices[quads]).reshape(-1, 3)
    found = np.einsum("sk,qkd->sqd", shares, normals[quads]).reshape(-1, 3)
    return _Skin(points, found / np.linalg.norm(found, axis=1, keepdims=True), cKDTree(points))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)


def _cards(
    surface: Surface,
    middles: np.ndarray,
    kinds: np.ndarray,
    corner: tuple[int, int],
    size: int,
    normals: np.ndarray,
    aside: np.ndarray,
) -> Surface:
    """The surface with cards: `middles` (C, 3, 3) from the inner end to the outer one, `aside` (C, 3) half their
    widths, `normals` (C, 3).
    """
    count = len(middles)
    points = np.stack([middles - aside[:, None], middles + aside[:, None]], axis=2).reshape(-1, 3)
    each = PATCH_PX[1] / KINDS
    left = corner[1] + kinds * each + 1.0
    u = np.stack([left, left + each - 2.0], axis=1)[:, None, :].repeat(3, axis=1) / size
    v = 1.0 - (corner[0] + np.array([PATCH_PX[0] - 1.0, PATCH_PX[0] * OUTSIDE, 1.0])) / size
    uvs = np.stack([u, np.broadcast_to(v[None, :, None], u.shape)], axis=-1).reshape(-1, 2)
    start = len(surface.positions) + 6 * np.arange(count)[:, None, None]
    faces = (start + np.array([[0, 3, 1], [0, 2, 3], [2, 5, 3], [2, 4, 5]])).reshape(-1, 3)
    nearest = cKDTree(surface.positions).query(middles[:, 0])[1].repeat(6)
    (material,) = surface.triangles
    return replace(
        surface,
        positions=np.concatenate([surface.positions, points]),
        normals=np.concatenate([surface.normals, normals.repeat(6, axis=0)]),
        uvs=np.concatenate([surface.uvs, uvs]),
        weights=np.concatenate([surface.weights, surface.weights[nearest]]),
        triangles={material: np.concatenate([surface.triangles[material], faces])},
        morphs={},
        origin=np.concatenate([surface.origin, np.full(len(points), -1)]),
    )


def _edge(on: Laid, skin: _Skin, scalp: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Pixels (E, 2) of the hairline: the border of what covers the scalp, near the skin."""
    pixels = np.stack(np.nonzero(scalp & (distance_transform_edt(scalp) <= EDGE_PX) & (inside < NEAR_BARE_PX)), axis=1)
    height = skin.above(on.places[tuple(pixels.T)])[0]
    return pixels[(height < REACH_M) & (height > -BURIED_M)]


def _ways(
    on: Laid, pixels: np.ndarray, is_edge: np.ndarray, steps: tuple[np.ndarray, np.ndarray], rng: np.random.Generator
) -> np.ndarray:
    """Directions (C, 3) of cards towards their outer ends, by those in the picture: `steps` outwards and along the
    strands.
    """
    at = tuple(pixels.T)
    down, right, normal = on.down[at], on.right[at], on.normals[at]
    outwards, strand = (_unit(own[at][:, :1] * down + own[at][:, 1:] * right) for own in steps)
    strand *= np.where(np.einsum("nk,nk->n", strand, outwards) < 0, -1.0, 1.0)[:, None]
    lacking = np.maximum(0.0, INWARDS - np.einsum("nk,nk->n", strand, outwards))
    way = strand + np.where(is_edge, ACROSS * lacking[:, None], 0.0) * outwards
    way += np.tan(np.radians(rng.normal(0.0, TURNED_DEG, (len(pixels), 1)))) * np.cross(normal, _unit(way))
    return _unit(way - np.einsum("nk,nk->n", way, normal)[:, None] * normal)


def _between(rng: np.random.Generator, limits: tuple[float, float], count: int) -> np.ndarray:
    return rng.uniform(*limits, (count, 1))


def with_fine_hairs(
    surface: Surface,
    skin: _Skin,
    along: np.ndarray,
    scalp: np.ndarray,
    bare: np.ndarray,
    corner: tuple[int, int],
    standing: Loose = STRAIGHT,
) -> Surface:
    """A style of hair with fine hairs along its hairline and standing off.

    Parameters
    ----------
    along : (H, W, 2) directions of the strands (row, column).
    scalp : (H, W) the parts that cover the scalp, as far as they show.
    bare : (H, W) where these parts end.
    corner : the first row and column of the hairs drawn (`free_patch`).
    """
    rng = np.random.Generator(np.random.PCG64(43))
    size = len(scalp)
    on = laid(surface, size)
    seen = scalp & (on.face >= 0)
    inside = distance_transform_edt(~bare)
    edge, inner = _edge(on, skin, seen, inside), np.stack(np.nonzero(seen & (inside > INNER_PX)), axis=1)
    edge = edge[_apart(on.places[tuple(edge.T)], SPACING_M, MOST, rng)]
    inner = inner[_apart(on.places[tuple(inner.T)], standing.spacing_m, standing.most, rng)]
    pixels, count = np.concatenate([edge, inner]), len(edge) + len(inner)
    is_edge = (np.arange(count) < len(edge))[:, None]
    slope = np.stack(np.gradient(gaussian_filter(inside, 2.0)), axis=-1)
    way = _ways(on, pixels, is_edge, (-slope, along), rng)
    place, normal = on.places[tuple(pixels.T)], on.normals[tuple(pixels.T)]
    length = np.where(is_edge, _between(rng, LENGTH_M, count), _between(rng, LOOSE_LENGTH_M, count))
    lift = np.where(is_edge, ABOVE_HAIR_M, _between(rng, standing.lift_m, count))
    ends = [
        place - way * length * (1.0 - OUTSIDE) + normal * 0.5 * ABOVE_HAIR_M,
        place + normal * np.where(is_edge, ABOVE_HAIR_M, 0.4 * lift),
        place + way * length * OUTSIDE + normal * lift,
    ]
    for number in (1, 2):
        over, up = skin.above(ends[number])
        goal = np.maximum(over, ABOVE_SKIN_M)
        if number == 2:
            # The outer ends of the hairline lie on the skin where that is near.
            goal = np.where(is_edge[:, 0] & (over < REACH_M), ABOVE_SKIN_M, goal)
        ends[number] = ends[number] + (goal - over)[:, None] * up
    aside = np.cross(normal, way) * _between(rng, WIDTH_M, count) / 2.0
    kinds = rng.integers(
        np.where(is_edge[:, 0], 0, KINDS - LOOSE_KINDS), np.where(is_edge[:, 0], KINDS - LOOSE_KINDS, KINDS)
    )
    return _cards(surface, np.stack(ends, axis=1), kinds, corner, size, normal, aside)
