"""Files of arrays are read as written; other files are refused before they take memory."""

from __future__ import annotations

import json
import zlib
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.errors import FileError
from app.formats.packed_arrays import MAGIC, read_arrays

ROOT = Path(__file__).parents[3]


def test_what_the_build_writes_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "resources" / "build"))
    written = {"a": np.arange(12, dtype=np.int16).reshape(3, 4), "b": np.linspace(0.0, 1.0, 5, dtype=np.float32)}
    import_module("character_arrays").write_arrays(tmp_path / "x.arrays", written, {"names": ("one", "two")})
    read = read_arrays(tmp_path / "x.arrays")
    assert read.names == {"names": ("one", "two")}
    assert list(read.arrays) == ["a", "b"]
    for name, values in written.items():
        np.testing.assert_array_equal(read.arrays[name], values)


def file_of(shape: list[int], kind: str, stream: bytes, **row: Any) -> bytes:
    entry = {"name": "a", "kind": kind, "shape": shape, "bytes": len(stream)} | row
    header = json.dumps({"arrays": [entry], "names": {}}).encode()
    return MAGIC + len(header).to_bytes(4, "little") + header + stream


FOUR = zlib.compress(bytes(4))


@pytest.mark.parametrize(
    "content",
    [
        b"",
        MAGIC,
        MAGIC + (2**31).to_bytes(4, "little"),
        file_of([4], "|u1", FOUR)[:-3],
        file_of([3], "|u1", FOUR),
        file_of([5], "|u1", FOUR),
        file_of([4], "|u1", b"nothing"),
        file_of([2**40], "|u1", FOUR),
        file_of([-4], "|u1", FOUR),
        file_of([1] * 5, "|u1", FOUR),
        file_of([1], "|O8", FOUR),
        file_of([4], "|u1", FOUR, bytes=-1),
        file_of([4], "|u1", zlib.compress(bytes(2**20))),
    ],
)
def test_anything_else_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x.arrays").write_bytes(content)
    with pytest.raises(FileError):
        read_arrays(tmp_path / "x.arrays")
