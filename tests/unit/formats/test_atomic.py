from __future__ import annotations

import errno
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from app.errors import FileError
from app.formats.atomic import atomic_write, sweep


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


def test_a_full_disk_is_an_error_a_user_can_act_on(tmp_path: Path) -> None:
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


def test_what_a_killed_process_left_is_swept_and_what_a_living_one_writes_is_not(tmp_path: Path) -> None:
    target = tmp_path / "take.fbx"
    script = (
        "import os, signal, sys\n"
        "from app.formats.atomic import atomic_write\n"
        "with atomic_write(sys.argv[1]) as stream:\n"
        "    stream.write(b'half'); stream.flush()\n"
        "    print('writing', flush=True)\n"
        "    signal.pause()\n"
    )
    mine = tmp_path / ".notes.partial"
    mine.write_text("another user's")
    with subprocess.Popen([sys.executable, "-c", script, str(target)], stdout=subprocess.PIPE, text=True) as writer:
        assert writer.stdout.readline() == "writing\n"
        (partial,) = set(tmp_path.iterdir()) - {mine}
        sweep(tmp_path)
        assert partial.exists()
        writer.kill()
    assert partial.exists()
    sweep(tmp_path)
    assert list(tmp_path.iterdir()) == [mine]


def test_sweeping_in_the_midst_of_any_step_costs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another editor may clean up the folder at any time."""
    target, backup = tmp_path / "take.fbx", tmp_path / "take.fbx.bak"
    target.write_bytes(b"old")

    def sweeping(function):  # type: ignore[no-untyped-def]
        def swept(*arguments, **named):  # type: ignore[no-untyped-def]
            sweep(tmp_path)
            result = function(*arguments, **named)
            sweep(tmp_path)
            return result

        return swept

    for owner, name in ((os, "link"), (os, "fsync"), (shutil, "copymode"), (Path, "replace")):
        monkeypatch.setattr(owner, name, sweeping(getattr(owner, name)))
    with atomic_write(target, backup) as stream:
        stream.write(b"new")
    monkeypatch.undo()
    assert (target.read_bytes(), backup.read_bytes()) == (b"new", b"old")
    assert sorted(tmp_path.iterdir()) == [target, backup]


@pytest.mark.parametrize("unsupported", [False, True])
def test_without_second_names_or_locks_it_writes_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, unsupported: bool
) -> None:
    def refuse(*arguments: object) -> None:
        raise OSError(errno.EOPNOTSUPP, "not here")

    monkeypatch.setattr(os, "link", refuse)
    if unsupported:
        monkeypatch.setattr("app.formats.atomic.lock", refuse)
        monkeypatch.setattr("app.formats.locks.lock", refuse)
    target, backup = tmp_path / "take.fbx", tmp_path / "take.fbx.bak"
    target.write_bytes(b"old")
    with atomic_write(target, backup) as stream:
        stream.write(b"new")
        sweep(tmp_path)
    assert (target.read_bytes(), backup.read_bytes()) == (b"new", b"old")
    assert sorted(tmp_path.iterdir()) == [target, backup]


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
@pytest.mark.parametrize("target", ["there", "not_there"])
def test_a_link_in_the_place_of_a_file_of_ours_is_replaced(tmp_path: Path, target: str) -> None:
    (tmp_path / "there").write_bytes(b"of the user")
    link = tmp_path / "piece.autosave"
    link.symlink_to(tmp_path / target)
    with atomic_write(link, follow_link=False) as stream:
        stream.write(b"new")
    assert not link.is_symlink()
    assert link.read_bytes() == b"new"
    assert (tmp_path / "there").read_bytes() == b"of the user"
    assert not (tmp_path / "not_there").exists()


@pytest.mark.skipif(os.name != "posix", reason="links and pipes of POSIX")
def test_only_files_are_swept(tmp_path: Path) -> None:
    (tmp_path / "outside").write_bytes(b"of the user")
    names = [tmp_path / f".{digit * 16}.partial" for digit in "0123"]
    names[0].write_bytes(b"half")
    names[1].symlink_to(tmp_path / "outside")
    os.mkfifo(names[2])
    names[3].mkdir()
    sweep(tmp_path)
    assert [os.path.lexists(name) for name in names] == [False, True, True, True]
    assert (tmp_path / "outside").read_bytes() == b"of the user"
