"""Writing arrays into one file, deflated: what `app.formats.packed_arrays` reads."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

MAGIC = b"SUISOU-ARRAYS-1\n"


def write_arrays(path: Path, arrays: Mapping[str, np.ndarray], names: Mapping[str, Sequence[str]]) -> None:
    """Write arrays and lists of names by name; the same bytes for the same values."""
    streams = {name: zlib.compress(np.ascontiguousarray(array).tobytes(), 9) for name, array in arrays.items()}
    table = [
        {
            "name": name,
            "kind": array.dtype.newbyteorder("<").str,
            "shape": list(array.shape),
            "bytes": len(streams[name]),
        }
        for name, array in arrays.items()
    ]
    header = json.dumps({"arrays": table, "names": {name: list(texts) for name, texts in names.items()}}).encode()
    path.write_bytes(MAGIC + len(header).to_bytes(4, "little") + header + b"".join(streams.values()))
