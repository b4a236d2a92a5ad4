"""Hair: a close cap under many tapered locks that follow the skull, short for one character, tied in a bun for another.

All shapes are laid out as directions from the middle of the skull and a lift above its skin.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from character_cloth import grid_faces, smoothstep
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, modelled, triangulate
from scipy.interpolate import RBFInterpolator

CAP_LIFT_M = 0.0025
FOREHEAD_M = 0.060
ARCH = np.array([[-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
"""Cross-section of a lock: sideways in half widths, outwards in heights."""


@dataclass(frozen=True)
class Skull:
    """The head's skin as a distance from its centre over direction.

    Attributes
    ----------
    centre : (3,) middle of the skull in the rest pose.
    radius : function of (N, 3) unit directions.
    eye_m : height of the eyes above `centre`.
    """

    centre: np.ndarray
    radius: Callable[[np.ndarray], np.ndarray]
    eye_m: float

    def at(self, directions: np.ndarray, lift: np.ndarray) -> np.ndarray:
        return self.centre + directions * (self.radius(directions) + lift)[:, None]


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def skull(source: Source, fit: SkeletonFit, ears: np.ndarray) -> Skull:
    """The skull of a body; `ears` (V,) flags vertices that are left out."""
    head = np.unique(source.groups["body"].vertices)
    head = head[(fit.weights[head, fit.index("head")] > 0.6) & ~ears[head]]
    points = source.vertices[head]
    eye = fit.world_from_joint_rest[fit.index("leftEye"), :3, 3]
    top, back = points[:, 1].max(), points[:, 2].min()
    front = points[points[:, 1] > eye[1] + 0.02, 2].max()
    centre = np.array([0.0, (top + eye[1]) / 2 - 0.005, (front + back) / 2])
    offsets = points - centre
    near = (
        (offsets[:, 1] > -0.13)
        & (np.linalg.norm(offsets, axis=1) > 0.05)
        & ((offsets[:, 2] < 0.06) | (offsets[:, 1] > -0.01))
    )
    directions, distances = _unit(offsets[near]), np.linalg.norm(offsets[near], axis=1)
    fitted = RBFInterpolator(directions, distances, neighbors=24, smoothing=1e-3, kernel="linear")
    return Skull(centre, fitted, float(eye[1] - centre[1]))


def _angles(directions: np.ndarray) -> np.ndarray:
    """(N,) azimuth away from the front, 0..pi on either side."""
    return np.abs(np.arctan2(directions[:, 0], directions[:, 2]))


def hairline(head: Skull, directions: np.ndarray) -> np.ndarray:
    """(N,) height in metres of skin above the hairline at its azimuth; hair grows where it is positive."""
    degrees = np.degrees(_angles(directions))
    knots = [0, 25, 45, 58, 66, 76, 84, 100, 112, 125, 150, 180]
    above_eyes = [
        FOREHEAD_M,
        FOREHEAD_M - 0.001,
        FOREHEAD_M - 0.012,
        FOREHEAD_M - 0.026,
        0.024,
        -0.006,
        -0.002,
        0.028,
        0.006,
        -0.030,
        -0.052,
        -0.056,
    ]
    height = directions[:, 1] * head.radius(directions) - head.eye_m
    return height - np.interp(degrees, knots, above_eyes)


def _cap(source: Source, fit: SkeletonFit, head: Skull, ears: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of a close cap: the scalp's own skin, lifted."""
    body = source.groups["body"]
    triangles = triangulate(body.vertices, source.vertices)
    scalp = fit.weights[:, fit.index("head")] > 0.6
    directions = _unit(source.vertices - head.centre)
    grows = np.full(len(scalp), -1.0)
    grows[scalp] = hairline(head, directions[scalp])
    grows[ears] = -1.0
    inside = (grows[triangles] > -0.002).all(axis=1)
    used, faces = np.unique(triangles[inside], return_inverse=True)
    lift = CAP_LIFT_M * smoothstep(grows[used], 0.0, 0.012) + 0.0003
    return source.vertices[used] + directions[used] * lift[:, None], faces.reshape(-1, 3)


def _lock(
    centres: np.ndarray, outward: np.ndarray, half_width: np.ndarray, height: np.ndarray, roll: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Positions and quads of one lock along (K, 3) centres."""
    tangent = _unit(np.gradient(centres, axis=0))
    across = _unit(np.cross(outward, tangent))
    normal = np.cross(tangent, across)
    if roll:
        across, normal = across * np.cos(roll) + normal * np.sin(roll), normal * np.cos(roll) - across * np.sin(roll)
    rows = [centres + across * (half_width * side)[:, None] + normal * (height * out)[:, None] for side, out in ARCH]
    points = np.stack(rows, axis=1).reshape(-1, 3)
    return points, grid_faces(len(centres), len(ARCH), closed=False)


def _assemble(
    fit: SkeletonFit,
    cap: tuple[np.ndarray, np.ndarray],
    locks: list[tuple[np.ndarray, np.ndarray]],
    rng: np.random.Generator,
) -> Surface:
    """Cap and locks as one mesh in two shades."""
    shades = rng.uniform(0, 1, len(locks)) < 0.35
    points, triangles = [cap[0]], {"hair": [cap[1]], "hair_light": []}
    start = len(cap[0])
    for (positions, quads), shade in zip(locks, shades, strict=True):
        triangles["hair_light" if shade else "hair"].append(start + triangulate(quads, positions))
        points.append(positions)
        start += len(positions)
    positions = np.concatenate(points)
    weights = np.zeros((len(positions), len(fit.names)))
    weights[:, fit.index("head")] = 1.0
    return modelled("hair", positions, weights, {shade: np.concatenate(parts) for shade, parts in triangles.items()})


def _roots(
    head: Skull, count: int, astray: float, lowest: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Directions of locks above a height, of `count` spread evenly over the sphere (Fibonacci's spiral) and a little
    astray; and how far above the hairline they are."""
    index = np.arange(count) + 0.5
    up = 1 - 2 * index / count
    turn = np.pi * (1 + np.sqrt(5)) * index
    flat = np.sqrt(1 - up**2)
    even = np.stack([flat * np.cos(turn), up, flat * np.sin(turn)], axis=1)
    roots = _unit(even + rng.normal(0, astray, (count, 3)))
    roots = roots[roots[:, 1] > lowest]
    return roots, hairline(head, roots)


def short_hair(source: Source, fit: SkeletonFit, ears: np.ndarray) -> Surface:
    """A short cut, longer on top and swept forward and aside from the whorl."""
    head = skull(source, fit, ears)
    rng = np.random.Generator(np.random.PCG64(51))
    roots, margin = _roots(head, 1750, 0.02, -0.75, rng)
    roots, margin = roots[margin > 0.001], margin[margin > 0.001]
    whorl = _unit(np.array([0.12, 0.80, -0.60]))
    steps = 5
    locks = []
    for root, room in zip(roots, margin, strict=True):
        top = float(smoothstep(np.array([root[1]]), 0.25, 0.75)[0])
        edge = float(smoothstep(np.array([room]), 0.0, 0.04)[0])
        front = float(smoothstep(np.array([root[2]]), 0.2, 0.8)[0]) * top
        length = (0.016 + 0.004 * edge) * (1 - top) + 0.044 * top
        length *= rng.uniform(0.8, 1.15)
        rise = (0.0025 + 0.001 * edge) * (1 - top) + top * rng.uniform(0.007, 0.012) + 0.006 * front
        direction = root.copy()
        path, normals = [], []
        turn = rng.normal(0, 0.22)
        for step in range(steps):
            share = step / (steps - 1)
            path.append(
                head.at(direction[None], np.array([0.001 + rise * share**0.8 * (1 - 0.45 * share * (1 - front))]))[0]
            )
            normals.append(direction)
            away = direction - whorl
            sweep = np.array([0.55, 0.0, 0.35]) * top + np.array([0.0, -0.6, -0.25]) * (1 - top)
            heading = _unit(away / np.linalg.norm(away) + sweep)
            heading = _unit(heading - direction * (heading @ direction))
            side = np.cross(direction, heading)
            heading = heading * np.cos(turn) + side * np.sin(turn)
            direction = _unit(direction + heading * length / (steps - 1) / 0.1)
        share = np.linspace(0, 1, steps)
        width = (0.0036 - 0.0008 * (1 - top)) * np.sqrt(np.maximum(1 - share**3.0, 0.0)) * np.minimum(
            0.55 + 2 * share, 1.0
        ) + 0.0002
        locks.append(_lock(np.array(path), np.array(normals), width, 0.35 * width, rng.normal(0, 0.25)))
    return _assemble(fit, _cap(source, fit, head, ears), locks, rng)


def _slerp(start: np.ndarray, end: np.ndarray, shares: np.ndarray) -> np.ndarray:
    angle = np.arccos(np.clip(start @ end, -1, 1))
    return (np.sin((1 - shares) * angle)[:, None] * start + np.sin(shares * angle)[:, None] * end) / np.sin(angle)


def _bun(head: Skull, knot: np.ndarray, rng: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """Locks wound about the knot: each runs once over a flattened ball, aslant."""
    base = head.at(knot[None], np.array([0.016]))[0]
    first = _unit(np.cross(knot, np.array([1.0, 0.0, 0.0])))
    second = np.cross(knot, first)
    locks = []
    for number in range(46):
        phase = 2 * np.pi * number / 46 + rng.normal(0, 0.04)
        share = np.linspace(0, 1, 12)
        polar = np.pi * (0.02 + 0.70 * share)
        around = phase + 2.6 * share + 0.25 * np.sin(3 * share)
        size = 0.033 * rng.uniform(0.95, 1.06)
        radial = np.cos(around)[:, None] * first + np.sin(around)[:, None] * second
        ball = np.sin(polar)[:, None] * radial * size * 1.08 + np.cos(polar)[:, None] * knot * size * 0.72
        outward = _unit(np.sin(polar)[:, None] * radial + np.cos(polar)[:, None] * knot)
        width = 0.0052 * np.sin(polar) ** 0.7 + 0.0006
        locks.append(_lock(base + ball, outward, width, 0.5 * width))
    return locks


def bun_hair(source: Source, fit: SkeletonFit, ears: np.ndarray) -> Surface:
    """Long hair combed back from the hairline into a low bun."""
    head = skull(source, fit, ears)
    rng = np.random.Generator(np.random.PCG64(52))
    knot = _unit(np.array([0.0, -0.08, -1.0]))
    roots, margin = _roots(head, 2350, 0.012, -0.85, rng)
    near_edge = (margin > 0.0005) & ((margin < 0.014) | (rng.uniform(0, 1, len(roots)) < 0.30))
    steps = np.linspace(0, 1, 10)
    locks = []
    for root in roots[near_edge]:
        distance = float(np.arccos(np.clip(root @ knot, -1, 1)))
        if distance < 0.25:
            continue
        # Combed over the ears: a lock from the temple first rises a little.
        side = abs(root[0]) * max(0.0, root[2] + 0.25)
        path = _slerp(root, knot, steps * 0.96)
        path = _unit(path + np.sin(np.pi * steps)[:, None] * np.array([0.0, 0.22, 0.0]) * side)
        volume = rng.uniform(0.003, 0.0065) * min(1.0, distance / 1.2)
        lift = (
            0.0012
            + volume * np.sin(np.pi * np.minimum(steps * 1.25 + 0.02, 1.0)) ** 0.6
            + 0.006 * smoothstep(steps, 0.75, 1.0)
        )
        gather = np.sin(np.clip(np.arccos(np.clip(path @ knot, -1, 1)), 0.15, np.pi / 2)) ** 0.8
        width = (0.0068 * gather * np.minimum(0.35 + 5 * steps, 1.0)) + 0.0003
        locks.append(_lock(head.at(path, lift), path, width, 0.30 * width, rng.normal(0, 0.12)))
    locks += _bun(head, knot, rng)
    return _assemble(fit, _cap(source, fit, head, ears), locks, rng)
