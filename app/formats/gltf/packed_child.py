"""Child process that decompresses parts of a glTF file with DracoPy and meshopt (`app.formats.reading_child`).

A library is imported only if a part needs it, since it may be unavailable for some Python versions.
"""

from __future__ import annotations

import os
import sys
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt

from app.child_limits import confine_this_process
from app.formats.gltf.packed_parts import (
    INDICES,
    LIMITS_ROW,
    DracoPart,
    MeshoptPart,
    PackedParts,
    UnpackedArray,
)
from app.formats.reading_child import NO_MEMORY, NO_READER, UNREADABLE


def meshopt_rows(part: MeshoptPart) -> dict[str, UnpackedArray]:
    """Decompress a buffer view of EXT_meshopt_compression; the single array has the key `INDICES`."""
    import meshopt

    rows = meshopt.decode_gltf_buffer(part.data, part.count, part.stride, part.mode, part.filter)
    return {INDICES: UnpackedArray("|u1", part.stride, np.ascontiguousarray(rows).tobytes())}


def draco_arrays(part: DracoPart) -> dict[str, UnpackedArray]:
    """Decompress attributes and triangles of a Draco primitive, by name. Raises KeyError if an attribute is missing."""
    import DracoPy

    mesh = DracoPy.decode(part.data)
    by_id = {attribute["unique_id"]: attribute["data"] for attribute in mesh.attributes}
    arrays = {name: _array(by_id[number]) for name, number in part.attributes.items()}
    faces = getattr(mesh, "faces", None)
    return arrays if faces is None else arrays | {INDICES: _array(np.asarray(faces).reshape(-1, 1))}


def _array(values: npt.NDArray[Any]) -> UnpackedArray:
    rows = np.ascontiguousarray(values).reshape(len(values), -1)
    return UnpackedArray(rows.dtype.str, rows.shape[1], rows.tobytes())


def unpack(request: PackedParts) -> list[dict[str, UnpackedArray]]:
    """Decompress parts one after another; return the arrays of each by name. Raises MemoryError if they exceed the
    limit.
    """
    left, unpacked = request.most_bytes, []
    for part in request.parts:
        arrays = meshopt_rows(part) if isinstance(part, MeshoptPart) else draco_arrays(part)
        left -= sum(len(array.data) for array in arrays.values())
        if left < 0:
            raise MemoryError
        unpacked.append(arrays)
    return unpacked


def main() -> None:
    """Read a request on standard input, and print the decompressed arrays."""
    status, printed = 0, b""
    try:
        data = sys.stdin.buffer.read()
        request = msgspec.msgpack.decode(data, type=PackedParts)
        for library in {"meshopt" if isinstance(part, MeshoptPart) else "DracoPy" for part in request.parts}:
            __import__(library)
        confine_this_process(LIMITS_ROW, len(data))
        printed = msgspec.msgpack.encode(unpack(request))
    except ImportError as error:
        status, printed = NO_READER, str(error.name).encode()
    except MemoryError:
        status = NO_MEMORY
    # The errors of these libraries have no common base class.
    except Exception as error:  # noqa: BLE001 - whatever a damaged file does here is said there
        status, printed = UNREADABLE, str(error)[:300].encode()
    sys.stdout.buffer.write(printed)
    sys.stdout.buffer.flush()
    os._exit(status)


if __name__ == "__main__":
    main()
