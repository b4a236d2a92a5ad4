"""Eyes, brows and lashes."""

from __future__ import annotations

import numpy as np
from character_cloth import grid_faces
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, modelled, triangulate

PUPIL_M, IRIS_M, LIMBUS_M = 0.0020, 0.0053, 0.0060
BROW_HAIRS = 150


def eyes(source: Source, fit: SkeletonFit) -> Surface:
    """Two eyeballs that turn with their joints; rings of the sphere lie on the edges of pupil, iris and limbus."""
    points, weights, triangles = [], [], {name: [] for name in ("eye_white", "limbus", "iris", "pupil")}
    for side, letter in (("left", "l"), ("right", "r")):
        joint = fit.index(side + "Eye")
        centre = fit.world_from_joint_rest[joint, :3, 3]
        helper = source.vertices[np.unique(source.groups[f"helper-{letter}-eye"].vertices)]
        radius = float(np.linalg.norm(helper - centre, axis=1).mean())
        edges = np.arcsin(
            np.array([0.0, PUPIL_M * 0.5, PUPIL_M, (PUPIL_M + IRIS_M) / 2, IRIS_M, LIMBUS_M, LIMBUS_M * 1.15]) / radius
        )
        polar = np.concatenate([edges, np.linspace(edges[-1], np.radians(140), 12)[1:]])
        # The cornea stands a little proud of the white.
        bulge = 0.0009 * np.maximum(0.0, 1 - (polar / edges[-1]) ** 2)
        angles = 2 * np.pi * np.arange(32) / 32
        rings = [
            centre
            + (radius + out)
            * np.stack([np.sin(p) * np.cos(angles), np.sin(p) * np.sin(angles), np.full(32, np.cos(p))], axis=1)
            for p, out in zip(polar, bulge, strict=True)
        ]
        start = sum(len(part) for part in points)
        points.append(np.concatenate(rings))
        rows = np.zeros((len(points[-1]), len(fit.names)))
        rows[:, joint] = 1.0
        weights.append(rows)
        quads = grid_faces(len(rings), 32, closed=True)[:, ::-1]
        band = quads.min(axis=1) // 32
        for name, (low, high) in {"pupil": (0, 2), "iris": (2, 4), "limbus": (4, 5), "eye_white": (5, 99)}.items():
            triangles[name].append(start + triangulate(quads[(band >= low) & (band < high)], points[-1]))
    positions = np.concatenate(points)
    faces = {name: np.concatenate(parts) for name, parts in triangles.items()}
    return modelled("eyes", positions, np.concatenate(weights), faces, uvs=positions[:, :2] * 10.0 % 1.0)


def _attached(
    name: str,
    source: Source,
    fit: SkeletonFit,
    corners: np.ndarray,
    shares: np.ndarray,
    offsets: np.ndarray,
    faces: np.ndarray,
) -> Surface:
    """A surface of one material whose vertices are shares (N, K) of base vertices (N, K) plus offsets (N, 3).

    It moves as they do.
    """
    positions = np.einsum("nk,nka->na", shares, source.vertices[corners]) + offsets
    morphs = {
        label: np.einsum("nk,nka->na", shares, delta[corners])
        for label, delta in zip(source.morph_names, source.morph_deltas, strict=True)
    }
    weights = np.einsum("nk,nkj->nj", shares, fit.weights[corners])
    return modelled(name, positions, weights, {name: faces}, morphs=morphs)


def lashes(source: Source, fit: SkeletonFit) -> Surface:
    """Tapered lashes on the base mesh's lash strips, two to a quad, from the edge of the lid outwards."""
    lid = np.unique(source.groups["body"].vertices)
    lid = lid[np.abs(source.vertices[lid] - fit.world_from_joint_rest[fit.index("head"), :3, 3]).max(axis=1) < 0.15]
    corners, shares, faces = [], [], []
    for group in ("helper-l-eyelashes-1", "helper-l-eyelashes-2", "helper-r-eyelashes-1", "helper-r-eyelashes-2"):
        length = 0.6 if group.endswith("2") else 0.35
        for quad in source.groups[group].vertices:
            gaps = np.linalg.norm(source.vertices[quad][:, None] - source.vertices[lid][None], axis=2).min(axis=1)
            edge = int(np.argmin(gaps + np.roll(gaps, -1)))
            a, b, c, d = np.roll(quad, -edge)
            if gaps[edge] + gaps[(edge + 1) % 4] > 0.0012:
                continue
            for low, high in ((0.0, 0.45), (0.5, 0.95)):
                middle = (low + high) / 2
                start = len(corners)
                corners += [[a, b, c, d]] * 3
                shares += [[1 - low, low, 0, 0], [1 - high, high, 0, 0]]
                shares.append(
                    [(1 - length) * (1 - middle), (1 - length) * middle, length * middle, length * (1 - middle)]
                )
                faces.append([start, start + 1, start + 2])
    return _attached(
        "lashes", source, fit, np.array(corners), np.array(shares), np.zeros((len(corners), 3)), np.array(faces)
    )


def _on_face(source: Source, triangles: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners, barycentric shares and normals of the foremost skin at each (x, y)."""
    a, b, c = (source.vertices[triangles[:, k]] for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    front = area > 1e-10
    triangles, a, b, c, area = triangles[front], a[front], b[front], c[front], area[front]
    x, y = places[:, 0, None], places[:, 1, None]
    v = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (y - a[:, 1])) / area
    w = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])) / area
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    depth = np.where(inside, a[:, 2] + v * (b[:, 2] - a[:, 2]) + w * (c[:, 2] - a[:, 2]), -np.inf)
    best = depth.argmax(axis=1)
    rows = np.arange(len(places))
    shares = np.stack([1 - v[rows, best] - w[rows, best], v[rows, best], w[rows, best]], axis=1)
    normals = np.cross(b - a, c - a)[best]
    return triangles[best], shares, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def brows(source: Source, fit: SkeletonFit, thickness: float) -> Surface:
    """Single brow hairs rooted in the skin above the eyes; `thickness` 1 is a full brow."""
    body = source.groups["body"]
    triangles = triangulate(body.vertices, source.vertices)
    head = fit.world_from_joint_rest[fit.index("head"), :3, 3]
    triangles = triangles[
        (source.vertices[triangles][:, :, 1] > head[1]).all(axis=1)
        & (source.vertices[triangles][:, :, 2] > head[2]).all(axis=1)
    ]
    rng = np.random.Generator(np.random.PCG64(41))
    along = np.sort(rng.uniform(0, 1, BROW_HAIRS))
    up = rng.normal(0, 0.5, BROW_HAIRS).clip(-1, 1)
    width = (0.0042 * (1 - along) ** 0.6 + 0.0008) * thickness
    jitter = rng.uniform(0.7, 1.2, BROW_HAIRS)
    corners, shares, offsets, faces = [], [], [], []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        eye = fit.world_from_joint_rest[fit.index(side + "Eye"), :3, 3]
        x = eye[0] * sign - 0.016 + 0.043 * along
        y = eye[1] + 0.0185 + 0.0062 * np.sin(np.pi * np.clip(along * 0.78, 0, 1)) - 0.004 * along**3 + up * width
        roots, share, normal = _on_face(source, triangles, np.stack([x * sign, y], axis=1))
        angle = np.radians(70 - 80 * np.minimum(along * 1.6, 1.0)) - up * 0.35
        length = 0.0075 * jitter * (1 - 0.35 * along)
        direction = np.stack([np.cos(angle) * sign, np.sin(angle), np.zeros(BROW_HAIRS)], axis=1)
        direction -= normal * np.einsum("na,na->n", direction, normal)[:, None]
        across = np.cross(normal, direction)
        across *= (0.00045 * np.sqrt(thickness) / np.linalg.norm(across, axis=1))[:, None]
        lift = normal * 0.0004
        start = sum(len(part) for part in corners)
        corners += [roots] * 3
        shares += [share] * 3
        offsets += [lift + across, lift - across, lift + direction * length[:, None] + normal * 0.0007]
        index = start + np.arange(BROW_HAIRS)
        faces.append(np.stack([index, index + BROW_HAIRS, index + 2 * BROW_HAIRS], axis=1))
    return _attached("brows", source, fit, *(np.concatenate(rows) for rows in (corners, shares, offsets, faces)))
