"""Temporary folders are removed when their work is done or their process was killed, but not while the
process lives.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from app.errors import FileError
from app.formats.cache import CACHE_VARIABLE
from app.formats.temporary_folders import abandoned_folders, scratch_folder, scratch_places

ROOT = Path(__file__).parents[3]


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    return scratch_places()[0]


def test_a_folder_is_gone_when_its_work_is_done(place: Path) -> None:
    with scratch_folder() as folder:
        (folder / "sub").mkdir()
        (folder / "sub" / "file").write_text("x")
        assert folder.parent == place
        # Another process that looks meanwhile leaves the folder alone.
        assert list(abandoned_folders()) == []
    assert list(place.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
def test_what_a_killed_process_left_is_found_once(place: Path) -> None:
    script = (
        "from app.formats.temporary_folders import scratch_folder\n"
        "with scratch_folder() as folder:\n"
        "    (folder / 'large').write_bytes(bytes(1000))\n"
        "    print(folder, flush=True)\n"
        "    input()\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script], cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdin is not None
    with process.stdin, process.stdout as stdout:
        left = Path(stdout.readline().strip())
        assert list(abandoned_folders()) == []
        process.send_signal(signal.SIGKILL)
        process.wait()
    with scratch_folder() as mine:
        found = abandoned_folders()
        assert next(found) == left
        # Another process that starts at the same moment does not get the folder.
        assert list(abandoned_folders()) == []
        assert list(found) == []
        assert list(place.iterdir()) == [mine]


def test_one_that_was_killed_before_it_had_its_lock_is_removed_and_others_are_not_ours(place: Path) -> None:
    (place / f"{0:016x}").mkdir(parents=True)
    (place / "of another user").mkdir()
    assert list(abandoned_folders()) == []
    assert [path.name for path in place.iterdir()] == ["of another user"]


def test_where_the_first_place_refuses_there_is_a_second(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cache").write_text("no folder")
    second = tmp_path / "second"
    monkeypatch.setattr("app.formats.temporary_folders.tempfile.gettempdir", lambda: str(second))
    with scratch_folder() as folder:
        assert folder.parent.parent == second
    second.rename(tmp_path / "away")
    second.write_text("no folder either")
    with pytest.raises(FileError, match=r"file\.cannot_write"), scratch_folder():
        raise AssertionError("the block must not run")
