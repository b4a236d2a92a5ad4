"""Container format of glTF files: the JSON document and the binary chunk.

Source: Khronos, "glTF 2.0 Specification", section 4 (GLB). Libraries are not used, since they create an object for
every accessor, which is too slow for characters with hundreds of morph targets.
"""

from __future__ import annotations

import json
import struct
from typing import Any, Final

from app.errors import FileError

MAGIC: Final = b"glTF"
JSON: Final = 0x4E4F534A
BINARY: Final = 0x004E4942
"""Codes of the two kinds of chunks, JSON and binary."""


def field(owner: object, name: str) -> Any:
    """Return a member of a JSON object; None if it is missing or the owner is no object."""
    return owner.get(name) if isinstance(owner, dict) else None


def split(data: bytes, file: str) -> tuple[dict[str, Any], bytes | None]:
    """Split a glTF or GLB file into its JSON document and its binary chunk, if any. Raises FileError."""
    text, binary = (data, None) if data[:4] != MAGIC else _chunks(data, file)
    try:
        document = json.loads(text.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise FileError("gltf.not_gltf", file=file) from error
    version = field(field(document, "asset"), "version")
    if not isinstance(document, dict) or not str(version).startswith("2."):
        raise FileError("gltf.not_gltf", file=file)
    return document, binary


def _chunks(data: bytes, file: str) -> tuple[bytes, bytes | None]:
    """Return the JSON chunk and the first binary chunk (None if missing) of a GLB file; other chunks are skipped, as
    specified."""
    kinds: dict[int, bytes] = {}
    if len(data) < 12 or struct.unpack_from("<I", data, 4)[0] != 2:
        raise FileError("gltf.not_gltf", file=file)
    end, at = min(struct.unpack_from("<I", data, 8)[0], len(data)), 12
    while at + 8 <= end:
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > end:
            raise FileError("gltf.damaged", file=file, what="chunk")
        if not kinds and kind != JSON:
            break
        kinds.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length
    if JSON not in kinds:
        raise FileError("gltf.not_gltf", file=file)
    return kinds[JSON], kinds.get(BINARY)
