"""Shapes that widen a character's ribs and belly with the air in them, added to its file: clothes and skin alike.

    python resources/build/character_breath.py resources/characters/*.glb

`build_characters.py` does it for what it has written. The trunk widens away from its own axis, most in front, by a
smooth function of height alone; so shirt, trousers and belt go together. Arms and neck stay, by their skin weights.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from pygltflib import FLOAT, GLTF2, UNSIGNED_SHORT, VEC3, Accessor, BufferView, Sparse

CHEST, BELLY = "chestExpand", "bellyExpand"
TRUNK = ("hips", "spine", "chest", "upperChest", "neck", "leftUpperLeg", "rightUpperLeg")
LEAST_M, SEEN_M = 2e-6, 1e-4
"""Offset in metres below which none is stored, and motion below which a mesh gets no such shape."""
GROWS_M = {CHEST: 0.0062, BELLY: 0.0056}
"""Outward motion in metres of the sides at the middle of each."""
AHEAD, BACK = {CHEST: 1.25, BELLY: 1.7}, {CHEST: 0.75, BELLY: 0.35}
"""Motion of front and back as shares of that of the sides."""


def add_breath(path: Path, least_m: float = LEAST_M) -> None:
    """Add the two shapes to a character's file that has none yet, without offsets below the least."""
    gltf = GLTF2().load(str(path))
    blob = bytearray(gltf.binary_blob())
    names = [gltf.nodes[node].name for node in gltf.skins[0].joints]
    places = _places_m(gltf)
    trunk = [index for index, name in enumerate(names) if name in TRUNK]
    for mesh in gltf.meshes:
        known = (mesh.extras or {}).get("targetNames", [])
        if CHEST in known:
            raise SystemExit(f"{path} breathes already")
        attributes = mesh.primitives[0].attributes
        points = _read(gltf, blob, attributes.POSITION)
        share = np.zeros(len(points))
        for number in (0, 1):
            joints, weights = (getattr(attributes, f"{part}_{number}", None) for part in ("JOINTS", "WEIGHTS"))
            if joints is not None:
                share += (np.isin(_read(gltf, blob, joints), trunk) * _read(gltf, blob, weights)).sum(axis=1)
        found = {name: share[:, None] * _widened_m(name, points, places) for name in (CHEST, BELLY)}
        found = {name: deltas for name, deltas in found.items() if np.abs(deltas).max() > max(SEEN_M, least_m)}
        if not found:
            continue
        for name, deltas in found.items():
            accessor = _sparse(gltf, blob, deltas, least_m)
            for primitive in mesh.primitives:
                primitive.targets = [*(primitive.targets or []), {"POSITION": accessor}]
            known = [*known, name]
        mesh.weights = [0.0] * len(known)
        mesh.extras = (mesh.extras or {}) | {"targetNames": known}
    gltf.buffers[0].byteLength = len(blob)
    gltf.set_binary_blob(bytes(blob))
    for accessor in gltf.accessors:
        if accessor.bufferView is None:
            accessor.byteOffset = None
    path.write_bytes(b"".join(gltf.save_to_bytes()))


def _widened_m(name: str, points: np.ndarray, places: dict[str, np.ndarray]) -> np.ndarray:
    """Outward displacements (N, 3) of points of the trunk."""
    low, high = places["hips"][1], places["neck"][1]
    height = (points[:, 1] - low) / (high - low)
    middle, half = (0.68, 0.42) if name == CHEST else (0.26, 0.36)
    inside = 1.0 - np.square(np.clip((height - middle) / half, -1.0, 1.0))
    axis = np.stack(
        [np.interp(height, _heights(places, low, high), _column(places, column)) for column in (0, 2)], axis=1
    )
    out = points[:, [0, 2]] - axis
    # A trunk is broader than deep: seen from its axis it is made round first.
    out /= np.maximum(np.linalg.norm(out, axis=1), 0.02)[:, None]
    ahead = np.where(out[:, 1] >= 0.0, AHEAD[name], BACK[name])
    size = GROWS_M[name] * np.square(inside) * (out[:, 0] ** 2 + ahead * out[:, 1] ** 2)
    return np.stack([size * out[:, 0], np.zeros(len(points)), size * out[:, 1]], axis=1)


def _heights(places: dict[str, np.ndarray], low: float, high: float) -> list[float]:
    return [(places[name][1] - low) / (high - low) for name in ("hips", "spine", "chest", "upperChest", "neck")]


def _column(places: dict[str, np.ndarray], column: int) -> list[float]:
    return [places[name][column] for name in ("hips", "spine", "chest", "upperChest", "neck")]


def _places_m(gltf: GLTF2) -> dict[str, np.ndarray]:
    """Positions of joints in the T-pose, whose trunk equals that of the mesh's own pose."""
    parents = {child: index for index, node in enumerate(gltf.nodes) for child in node.children or []}
    found = {}
    for index, node in enumerate(gltf.nodes):
        place, at = np.zeros(3), index
        while at is not None:
            place = place + np.array(gltf.nodes[at].translation or (0.0, 0.0, 0.0))
            at = parents.get(at)
        found[node.name] = place
    return found


def _read(gltf: GLTF2, blob: bytearray, index: int) -> np.ndarray:
    accessor = gltf.accessors[index]
    view = gltf.bufferViews[accessor.bufferView]
    kind = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}[accessor.componentType]
    width = {"VEC3": 3, "VEC4": 4}[accessor.type]
    start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
    rows = np.frombuffer(bytes(blob), kind, accessor.count * width, start).reshape(-1, width).astype(np.float64)
    return rows / np.iinfo(kind).max if accessor.normalized else rows


def _sparse(gltf: GLTF2, blob: bytearray, deltas: np.ndarray, least_m: float) -> int:
    """A sparse accessor of offsets: only the rows that differ from zero are stored."""
    rows = np.flatnonzero(np.abs(deltas).max(axis=1) > least_m)
    values = deltas[rows].astype("<f4")
    views: list[Any] = []
    for payload in (rows.astype("<u2").tobytes(), values.tobytes()):
        blob.extend(b"\0" * (-len(blob) % 4))
        gltf.bufferViews.append(BufferView(buffer=0, byteOffset=len(blob), byteLength=len(payload)))
        blob.extend(payload)
        views.append(len(gltf.bufferViews) - 1)
    low, high = np.minimum(values.min(axis=0), 0.0), np.maximum(values.max(axis=0), 0.0)
    sparse = Sparse(
        count=len(rows),
        indices={"bufferView": views[0], "componentType": UNSIGNED_SHORT},
        values={"bufferView": views[1]},
    )
    accessor = Accessor(
        componentType=FLOAT, count=len(deltas), type=VEC3, min=low.tolist(), max=high.tolist(), sparse=sparse
    )
    gltf.accessors.append(accessor)
    return len(gltf.accessors) - 1


if __name__ == "__main__":
    for name in sys.argv[1:]:
        add_breath(Path(name))
