"""Deeper shapes of the brows, written into a character's file: those of its source are hardly seen from a seat.

    python resources/build/character_brows.py resources/characters/*.glb

`build_characters.py` does it for what it has written. What a shape moves is what its source moves, further.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np
from pygltflib import GLTF2, Accessor

DEEPER: Final = {
    "browDownLeft": 1.6,
    "browDownRight": 1.6,
    "browInnerUp": 1.9,
    "browOuterUpLeft": 1.6,
    "browOuterUpRight": 1.6,
}
"""Factors of the shapes: a raised brow moves by about 10 mm, a lowered one by about 11."""
DEEP_M: Final = 0.008
"""Upward motion in metres of the inner brows that only a file with scaled shapes reaches."""


def deepen_brows(path: Path) -> None:
    """Scale the shapes of the brows in a character's file, unless this was done before."""
    gltf = GLTF2().load(str(path))
    blob = bytearray(gltf.binary_blob())
    scales: dict[int, float] = {}
    for mesh in gltf.meshes:
        names = (mesh.extras or {}).get("targetNames", [])
        for primitive in mesh.primitives:
            for name, target in zip(names, primitive.targets or [], strict=True):
                if name in DEEPER:
                    scales[target["POSITION"]] = DEEPER[name]
                    if name == "browInnerUp" and max(gltf.accessors[target["POSITION"]].max) > DEEP_M:
                        raise SystemExit(f"the brows of {path} are deep already")
    for index, scale in scales.items():
        _scale(gltf, blob, gltf.accessors[index], scale)
    gltf.set_binary_blob(bytes(blob))
    for accessor in gltf.accessors:
        if accessor.bufferView is None:
            accessor.byteOffset = None
    path.write_bytes(b"".join(gltf.save_to_bytes()))


def _scale(gltf: GLTF2, blob: bytearray, accessor: Accessor, scale: float) -> None:
    """Multiply the stored offsets of a sparse accessor."""
    stored = accessor.sparse.values
    start = (gltf.bufferViews[stored.bufferView].byteOffset or 0) + (stored.byteOffset or 0)
    count = 3 * accessor.sparse.count
    values = (np.frombuffer(bytes(blob), "<f4", count, start) * scale).astype("<f4")
    blob[start : start + values.nbytes] = values.tobytes()
    rows = values.reshape(-1, 3)
    accessor.min = np.minimum(rows.min(axis=0), 0.0).tolist()
    accessor.max = np.maximum(rows.max(axis=0), 0.0).tolist()


if __name__ == "__main__":
    for name in sys.argv[1:]:
        deepen_brows(Path(name))
