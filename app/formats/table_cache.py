"""Disk cache of values made from bundled tables, which is ten times as fast to read as the tables."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final, TypeVar

import msgspec

from app.errors import FileError
from app.formats.atomic import atomic_write
from app.formats.cache import cache_folder
from app.formats.files import read_file
from app.formats.json_data import UNREADABLE
from app.version import program_version

T = TypeVar("T")

MOST_BYTES: Final = 2**24
"""Largest file in the cache in bytes; real ones have at most a tenth of it."""


def kept(kind: str, name: str, folder: Path, decoder: msgspec.msgpack.Decoder[T], make: Callable[[], T]) -> T:
    """Return a value made from bundled tables, from the cache if possible.

    Parameters
    ----------
    kind, name : str
        Name of the cache's folder and of the file in it.
    folder : Path
        Folder with the tables and the code that reads them; when a file in it changes, the value is made again.
    decoder : Decoder
        Decoder of the value.
    make : callable
        Makes the value; its exceptions are passed on.
    """
    path = cache_folder(kind) / f"{name}-{digest_of(folder)}.msgpack"
    try:
        return decoder.decode(read_file(path, MOST_BYTES))
    except (FileError, *UNREADABLE):
        value = make()
    # If the cache cannot be written, only the next start takes some tenths of a second longer.
    with contextlib.suppress(OSError, FileError):
        path.parent.mkdir(parents=True, exist_ok=True)
        for older in path.parent.glob(f"{name}-*.msgpack"):
            older.unlink(missing_ok=True)
        with atomic_write(path) as file:
            file.write(msgspec.msgpack.encode(value))
    return value


@cache
def digest_of(folder: Path) -> str:
    """Return a hash of the tables and code in a folder, computed at the first call."""
    digest = hashlib.blake2b(program_version().encode(), digest_size=16)
    for path in sorted((*folder.rglob("*.toml"), *folder.glob("*.py"))):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(folder).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()
