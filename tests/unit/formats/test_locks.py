"""Locks as Windows has them: of a byte far behind the content, by the file's own position."""

from __future__ import annotations

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
