from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from app.errors import FileError
from app.formats.atomic import atomic_write


def test_the_file_takes_its_name_only_at_the_end(tmp_path: Path) -> None:
    target = tmp_path / "take.fbx"
    target.write_bytes(b"old")
    with atomic_write(target) as stream:
        stream.write(b"new")
        stream.flush()
        assert target.read_bytes() == b"old"
    assert target.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
def test_nothing_is_left_of_a_write_that_failed(error: type[BaseException], tmp_path: Path) -> None:
    target = tmp_path / "take.fbx"
    target.write_bytes(b"old")
    with pytest.raises(error), atomic_write(target) as stream:  # noqa: PT012
        stream.write(b"half")
        raise error
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_full_disk_is_an_error_a_person_can_act_on(tmp_path: Path) -> None:
    with pytest.raises(FileError) as raised, atomic_write(tmp_path / "take.fbx"):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert raised.value.message.id == "file.cannot_write"
    assert raised.value.message.arguments["reason"] == os.strerror(errno.ENOSPC)
    assert not list(tmp_path.iterdir())


def test_a_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError), atomic_write(tmp_path / "missing" / "take.fbx"):
        raise AssertionError("the block must not run")


@pytest.mark.skipif(os.name != "posix", reason="links and modes of POSIX")
def test_links_stay_links_and_the_mode_is_that_of_a_new_file(tmp_path: Path) -> None:
    folder = tmp_path / "real"
    folder.mkdir()
    link = tmp_path / "take.fbx"
    link.symlink_to(folder / "take.fbx")
    with atomic_write(link) as stream:
        stream.write(b"new")
    (tmp_path / "plain").touch()
    assert link.is_symlink()
    assert (folder / "take.fbx").read_bytes() == b"new"
    assert stat.S_IMODE((folder / "take.fbx").stat().st_mode) == stat.S_IMODE((tmp_path / "plain").stat().st_mode)
