"""Locks like those of Windows: on one byte far behind the content, at the file's current position."""

from __future__ import annotations

import contextlib
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.formats import locks


@pytest.mark.parametrize("is_free", [True, False])
def test_windows_locks_a_byte_behind_the_content_and_leaves_the_position(
    is_free: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    locked: list[int] = []

    def locking(descriptor: int, mode: int, count: int) -> None:
        assert (descriptor, mode, count) == (stream.fileno(), 2, 1)
        locked.append(stream.tell())
        if not is_free:
            raise PermissionError(13, "in use")

    monkeypatch.setattr(locks, "msvcrt", SimpleNamespace(locking=locking, LK_NBLCK=2), raising=False)
    path = tmp_path / "file"
    path.write_bytes(b"content")
    with path.open("r+b") as stream:
        stream.seek(3)
        with monkeypatch.context() as windows:
            windows.setattr(sys, "platform", "win32")
            assert locks.lock(stream) is is_free
        assert stream.tell() == 3
    assert locked == [2**30]


@pytest.mark.skipif(sys.platform == "win32", reason="processes are not copied")
def test_a_copied_process_does_not_keep_the_locks_of_the_other(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"content")
    waits, ends = os.pipe()
    is_there, is_ready = os.pipe()
    with path.open("r+b") as stream:
        assert locks.lock(stream)
        stream.write(b"not")
        copy = os.fork()
        if not copy:
            os.close(ends)
            with contextlib.suppress(Exception):
                stream.close()
                os.write(is_ready, b"x")
                os.read(waits, 1)
            os._exit(0)
        assert os.read(is_there, 1)
        assert locks.is_locked(path)
    assert not locks.is_locked(path)
    os.close(ends)
    os.waitpid(copy, 0)
    for end in (waits, is_there, is_ready):
        os.close(end)
    assert path.read_bytes() == b"nottent"
