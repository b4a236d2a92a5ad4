"""Conversion of glTF files to self-contained ones, with external files as data URIs.

Addresses of buffers and images are followed only to files in the document's folder or below it, after links are
resolved. Source: Khronos, "glTF 2.0 Specification", section 2.8 (URIs).
"""

from __future__ import annotations

import base64
import json
import os
import re
import struct
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

from app.errors import FileError
from app.formats.files import read_file
from app.formats.gltf.container import BINARY, JSON, MAGIC, field, split

MOST_BYTES: Final = 2**30
"""Largest file in bytes; characters have a hundredth of it."""
MOST_BESIDE: Final = 2**27
"""Greatest total size in bytes of all files that a glTF document names, since they are held in memory several times."""
_SCHEME: Final = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


def read_whole(path: str | os.PathLike[str]) -> bytes:
    """Read a glTF file with its external files embedded; unchanged bytes if there are none or it is no glTF file.

    Images that cannot be read are left out, since only colours depend on them.

    Raises
    ------
    FileError
        A buffer is outside the file's folder, or a file cannot be read.
    """
    file, data = Path(path), read_file(path, MOST_BYTES)
    if b'"uri"' not in data or not (data[:4] == MAGIC or data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")[:1] == b"{"):
        return data
    document, binary = split(data, str(file))
    left, changed = MOST_BESIDE, False
    known: dict[str, str] = {}
    for name in ("buffers", "images"):
        entries = field(document, name)
        for entry in entries if isinstance(entries, list) else []:
            uri = field(entry, "uri")
            if not isinstance(uri, str) or uri.startswith("data:"):
                continue
            if uri not in known:
                try:
                    content = read_file(_inside(file, uri), left)
                except FileError as error:
                    if name == "images":
                        continue
                    outside = error.message.id in ("file.cannot_read", "file.not_regular")
                    raise (_external(file, uri) if outside else error) from error
                left -= len(content)
                known[uri] = f"data:application/octet-stream;base64,{base64.b64encode(content).decode()}"
            elif (left := left - len(known[uri])) < 0:
                raise FileError("gltf.too_large", file=str(file))
            if name == "images":
                entry.setdefault("name", Path(unquote(uri)).stem)
            entry["uri"], changed = known[uri], True
    return _joined(document, binary) if changed else data


def _inside(file: Path, uri: str) -> Path:
    """Return the path of the file at an address. Raises FileError if it is outside the document's folder."""
    name = unquote(uri)
    if _SCHEME.match(name) or name.startswith(("/", "\\")) or "\0" in name:
        raise _external(file, uri)
    try:
        folder = file.parent.resolve()
        found = (folder / name.replace("\\", "/")).resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise _external(file, uri) from error
    if not found.is_relative_to(folder):
        raise _external(file, uri)
    return found


def _external(file: Path, uri: str) -> FileError:
    return FileError("gltf.external", file=str(file), uri=uri[:200])


def _joined(document: dict[str, Any], binary: bytes | None) -> bytes:
    """Join a document and its binary chunk as a GLB file."""
    text = json.dumps(document, ensure_ascii=False).encode()
    if binary is None:
        return text
    text += b" " * (-len(text) % 4)
    chunks = [struct.pack("<II", len(part), kind) + part for part, kind in ((text, JSON), (binary, BINARY))]
    return MAGIC + struct.pack("<II", 2, 12 + sum(map(len, chunks))) + b"".join(chunks)
