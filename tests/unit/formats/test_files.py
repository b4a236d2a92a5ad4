"""Only regular files are read, only up to a size, and without waiting."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from app.errors import FileError
from app.formats.files import files_in, open_file, read_file
from app.messages import error_text

MOST = 1000


def _loop(path: Path) -> None:
    path.symlink_to(path)


def _large(path: Path) -> None:
    with path.open("wb") as stream:
        stream.truncate(2**40)  # A hole: it takes no room on the disk.


ODD: dict[str, tuple[Callable[[Path], object], str]] = {
    "folder": (Path.mkdir, "file.not_regular"),
    "pipe": (os.mkfifo, "file.not_regular"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "file.not_regular"),
    "terminal": (lambda path: path.symlink_to("/dev/tty"), "file.not_regular"),
    "circle": (_loop, "file.cannot_read"),
    "nothing": (lambda path: None, "file.cannot_read"),
    "large": (_large, "file.too_large"),
    "endless": (lambda path: path.symlink_to("/proc/self/smaps"), "file.too_large"),
}


@pytest.mark.skipif(os.name != "posix", reason="pipes, devices and links of POSIX")
@pytest.mark.parametrize("kind", ODD)
def test_what_is_no_ordinary_file_is_refused_at_once(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "odd.toml"
    make, id = ODD[kind]
    make(path)
    begun_s = time.monotonic()
    with pytest.raises(FileError) as caught:
        read_file(path, MOST)
    assert time.monotonic() - begun_s < 2.0
    assert caught.value.message.id == id
    assert str(path) in error_text(caught.value)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "secret"
    path.write_bytes(b"x")
    path.chmod(0)
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        read_file(path, MOST)


def test_a_name_that_no_system_knows() -> None:
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        read_file("a\0b", MOST)
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        read_file("x" * 5000, MOST)


def test_ordinary_files(tmp_path: Path) -> None:
    path = tmp_path / "some"
    for content in (b"", b"a", bytes(MOST)):
        path.write_bytes(content)
        assert read_file(path, MOST) == content
    path.write_bytes(bytes(MOST + 1))
    with pytest.raises(FileError, match=r"file\.too_large"):
        read_file(path, MOST)
    with open_file(path) as stream:
        assert stream.read(3) == bytes(3)


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="files of Linux that have no size")
def test_a_file_of_the_system_without_a_size() -> None:
    assert b"Name:" in read_file("/proc/self/status", 2**20)


def test_folders(tmp_path: Path) -> None:
    for name in ("b.toml", "A.TOML", "c.glb", "d.txt"):
        (tmp_path / name).touch()
    assert [path.name for path in files_in(tmp_path, ".toml", ".glb")] == ["A.TOML", "b.toml", "c.glb"]
    assert files_in(tmp_path / "none", ".toml") == []
    for wrong in (tmp_path / "b.toml", Path("a\0b")):
        with pytest.raises(FileError, match=r"file\.cannot_read"):
            files_in(wrong, ".toml")
