"""Teeth one by one, set along the arches of the base mesh's two tooth bands, which become the gums."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from character_cloth import grid_faces
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, modelled, triangulate

# Crown widths and heights in mm from the middle backwards (Wheeler's Dental Anatomy, tables of average crowns).
UPPER_WIDTHS, UPPER_HEIGHTS = (8.5, 6.5, 7.5, 7.0, 7.0, 10.0, 9.0), (10.5, 9.0, 10.0, 8.5, 8.5, 7.5, 7.0)
LOWER_WIDTHS, LOWER_HEIGHTS = (5.0, 5.5, 7.0, 7.0, 7.0, 11.0, 10.5), (9.0, 9.5, 11.0, 8.5, 8.0, 7.5, 7.0)
SIDES, ROWS = 10, 6


@dataclass(frozen=True)
class Arch:
    """One jaw's arch in the rest pose: radius, biting edge and gum top over the angle from straight ahead."""

    middle_z: float
    radius: np.poly1d
    edge: np.poly1d
    gum: np.poly1d
    last_angle: float
    crown: float

    def outline(self, angle: np.ndarray) -> np.ndarray:
        """(N, 2) x and z of the arch."""
        radius = self.radius(angle**2)
        return np.stack([radius * np.sin(angle), self.middle_z + radius * np.cos(angle)], axis=1)


def _arch(points: np.ndarray, crown: float) -> Arch:
    """Fit an arch to a band's vertices; `crown` is -1 for the upper jaw (crowns point down), 1 for the lower."""
    middle_z = points[:, 2].min() + 0.25 * np.ptp(points[:, 2])
    angle = np.arctan2(points[:, 0], points[:, 2] - middle_z)
    radius = np.hypot(points[:, 0], points[:, 2] - middle_z)
    outer = radius > 0.86 * radius[np.abs(angle) < 0.1].max()
    squares = angle[outer] ** 2
    height = points[outer, 1]
    trend = np.poly1d(np.polyfit(squares, height, 1))
    low, high = height < trend(squares) - 0.002, height > trend(squares) + 0.002
    edge, gum = (low, high) if crown < 0 else (high, low)
    return Arch(
        middle_z=float(middle_z),
        radius=np.poly1d(np.polyfit(squares, radius[outer], 3)),
        edge=np.poly1d(np.polyfit(squares[edge], height[edge], 1)),
        gum=np.poly1d(np.polyfit(squares[gum], height[gum], 1)),
        last_angle=float(np.abs(angle[outer]).max()),
        crown=crown,
    )


def _tooth(
    place: np.ndarray, tangent: np.ndarray, edge_m: float, crown: float, width: float, height: float, number: int
) -> np.ndarray:
    """(ROWS * SIDES, 3) points of one crown, from under the gum to the biting edge."""
    incisor = number < 3
    outward = np.array([-tangent[1], 0.0, tangent[0]])
    along = np.array([tangent[0], 0.0, tangent[1]])
    if outward @ np.array([place[0], 0.0, 0.02]) < 0:
        outward = -outward
    share = np.linspace(0.0, 1.0, ROWS)
    across = np.interp(share, [0, 0.35, 0.75, 0.93, 1], [0.80, 0.96, 1.0, 0.985, 0.88]) * width / 2
    depth = np.interp(share, [0, 0.4, 0.85, 1], [1.0, 1.0, 0.45, 0.1] if incisor else [0.95, 1.0, 0.95, 0.45])
    depth = depth * (0.0030 if incisor else 0.0045)
    if number == 2:
        across[-2:] *= (0.85, 0.5)
    turn = 2 * np.pi * np.arange(SIDES) / SIDES
    square = np.stack(
        [np.sign(np.cos(turn)) * np.abs(np.cos(turn)) ** 0.6, np.sign(np.sin(turn)) * np.abs(np.sin(turn)) ** 0.6]
    )
    base = np.array([place[0], edge_m - crown * (height + 0.003), place[1]])
    rows = []
    for row in range(ROWS):
        centre = (
            base
            + np.array([0.0, crown, 0.0]) * (height + 0.003) * share[row]
            - outward * (0.003 + 0.001 * (1 - share[row]))
        )
        rows.append(centre + np.outer(square[0] * across[row], along) + np.outer(square[1] * depth[row], outward))
    rows.append(np.tile(rows[-1].mean(axis=0), (SIDES, 1)))
    return np.concatenate(rows)


def _crowns(arch: Arch, widths: tuple[float, ...], heights: tuple[float, ...]) -> list[np.ndarray]:
    """All crowns of a jaw, spaced along the arch by its length."""
    angles = np.linspace(0.0, arch.last_angle, 400)
    outline = arch.outline(angles)
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
    scale = min(1.08, 0.97 * lengths[-1] / (sum(widths) / 1000)) / 1000
    crowns = []
    start = 0.0
    for number, (width, height) in enumerate(zip(widths, heights, strict=True)):
        angle = float(np.interp(start + width * scale / 2, lengths, angles))
        start += width * scale
        for sign in (1.0, -1.0):
            place, ahead = arch.outline(np.array([sign * angle, sign * angle + 1e-3]))
            tangent = (ahead - place) / np.linalg.norm(ahead - place)
            edge = float(arch.edge(angle**2))
            crowns.append(_tooth(place, tangent, edge, arch.crown, width * scale * 0.985, height * 0.86 / 1000, number))
    return crowns


def _gums(points: np.ndarray, arch: Arch) -> np.ndarray:
    """The band drawn back behind the crowns: its edge lifted to the gum line, its face set inwards."""
    angle = np.arctan2(points[:, 0], points[:, 2] - arch.middle_z)
    radius = np.hypot(points[:, 0], points[:, 2] - arch.middle_z)
    edge, gum = arch.edge(angle**2), arch.gum(angle**2)
    share = np.clip((points[:, 1] - edge) / (gum - edge), 0.0, 1.0)
    outer = radius > 0.86 * float(arch.radius(0.0))
    moved = points.copy()
    low = outer & (share < 0.3)
    moved[low, 1] = (edge + 0.40 * (gum - edge))[low]
    inwards = np.where(low, 0.005, np.where(outer, 0.0012, 0.0))
    scale = (radius - inwards) / np.maximum(radius, 1e-6)
    moved[:, 0] = points[:, 0] * scale
    moved[:, 2] = arch.middle_z + (points[:, 2] - arch.middle_z) * scale
    # Palate and floor of the mouth stay behind the crowns' edges.
    inner = ~outer
    moved[inner, 1] = (edge + np.maximum(share, 0.45) * (gum - edge))[inner]
    return moved


def teeth(source: Source, fit: SkeletonFit) -> Surface:
    """Both rows of teeth with their gums; the lower ones follow the jaw's shapes."""
    parts: list[np.ndarray] = []
    origins: list[np.ndarray] = []
    triangles: dict[str, list[np.ndarray]] = {"gums": [], "teeth": []}
    start = 0
    for group, crown, widths, heights in (
        ("helper-upper-teeth", -1.0, UPPER_WIDTHS, UPPER_HEIGHTS),
        ("helper-lower-teeth", 1.0, LOWER_WIDTHS, LOWER_HEIGHTS),
    ):
        used, quads = np.unique(source.groups[group].vertices, return_inverse=True)
        band = source.vertices[used]
        arch = _arch(band, crown)
        parts.append(_gums(band, arch))
        origins.append(used)
        triangles["gums"].append(start + triangulate(quads.reshape(-1, 4), band))
        start += len(used)
        for points in _crowns(arch, widths, heights):
            faces = grid_faces(ROWS + 1, SIDES, closed=True)
            faces = triangulate(faces, points)
            corners = points[faces]
            volume = np.einsum(
                "ni,ni->",
                corners[:, 0] - points.mean(axis=0),
                np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
            )
            triangles["teeth"].append(start + (faces if volume > 0 else faces[:, ::-1]))
            nearest = np.linalg.norm(band - points.mean(axis=0), axis=1).argmin()
            parts.append(points)
            origins.append(np.full(len(points), used[nearest]))
            start += len(points)
    positions = np.concatenate(parts)
    origin = np.concatenate(origins)
    faces = {name: np.concatenate(parts) for name, parts in triangles.items()}
    morphs = {label: delta[origin] for label, delta in zip(source.morph_names, source.morph_deltas, strict=True)}
    return modelled("teeth", positions, fit.weights[origin], faces, morphs=morphs, origin=origin)
