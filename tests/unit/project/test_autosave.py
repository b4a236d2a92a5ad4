"""Unsaved work survives a crash, and only a crash."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.errors import FileError
from app.project.autosave import Autosave, autosave_path
from app.project.model import Project
from app.project.presence import Presence, editors, is_open_elsewhere
from app.project.recovery import discard, recover, recoverable, recoverable_of
from app.project.storage import load, save
from tests.unit.project.pieces import small_project

Editor = Callable[[], Autosave]

ROOT = Path(__file__).parents[3]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "state" / "recovery"


@pytest.fixture
def document(tmp_path: Path) -> Path:
    (tmp_path / "work").mkdir()
    path = tmp_path / "work" / "piece.suisou"
    save(small_project(), path)
    return path


@pytest.fixture
def editor(folder: Path) -> Iterator[Editor]:
    """Editors of one computer; whatever the test does with them, their files are closed after it."""
    presences: list[Presence] = []

    def start() -> Autosave:
        presences.append(Presence(folder))
        return Autosave(presences[-1])

    yield start
    for presence in presences:
        presence.leave()


def later(project: Project) -> Project:
    return replace(project, seed=project.seed + 1)


def write(autosave: Autosave, now_s: float) -> Path | None:
    writing = autosave.due(now_s)
    if writing is None:
        return None
    writing.run()
    autosave.written(writing)
    return writing.path


def test_a_change_is_written_beside_the_file_after_the_delay_and_not_before(
    editor: Editor, folder: Path, document: Path
) -> None:
    autosave = editor()
    autosave.opened(document)
    before = document.read_bytes()
    changed = later(load(document))
    assert autosave.due_s is None
    autosave.changed(changed, 100.0)
    autosave.changed(later(changed), 110.0)
    assert autosave.due_s == 130.0
    assert write(autosave, 129.9) is None
    assert write(autosave, 130.0) == autosave_path(document)
    assert load(autosave_path(document)) == later(changed)
    assert document.read_bytes() == before
    assert write(autosave, 1000.0) is None


def test_a_clean_save_leaves_nothing_to_recover(editor: Editor, folder: Path, document: Path) -> None:
    autosave = editor()
    autosave.opened(document)
    autosave.changed(later(load(document)), 0.0)
    write(autosave, 30.0)
    autosave.saved(document)
    assert not autosave_path(document).exists()
    autosave.closed()
    assert list(folder.iterdir()) == []


def test_closing_without_saving_throws_the_work_away(editor: Editor, folder: Path) -> None:
    autosave = editor()
    autosave.opened(None)
    autosave.changed(small_project(), 0.0)
    path = write(autosave, 30.0)
    assert path is not None
    assert path.parent == folder
    autosave.closed()
    assert list(folder.iterdir()) == []


def test_what_finishes_after_a_save_is_thrown_away(editor: Editor, folder: Path, document: Path) -> None:
    autosave = editor()
    autosave.opened(document)
    autosave.changed(later(load(document)), 0.0)
    writing = autosave.due(30.0)
    assert writing is not None
    autosave.saved(document)
    writing.run()
    autosave.written(writing)
    assert not autosave_path(document).exists()


def test_what_could_not_be_written_is_tried_again(editor: Editor, tmp_path: Path, folder: Path) -> None:
    autosave = editor()
    autosave.opened(tmp_path / "gone" / "piece.suisou")
    autosave.changed(small_project(), 0.0)
    writing = autosave.due(30.0)
    assert writing is not None
    with pytest.raises(FileError):
        writing.run()
    autosave.failed(writing, 31.0)
    assert autosave.due_s == 61.0


def test_the_undone_change_is_not_written_again(editor: Editor, folder: Path, document: Path) -> None:
    autosave = editor()
    autosave.opened(document)
    changed = later(load(document))
    autosave.changed(changed, 0.0)
    write(autosave, 30.0)
    autosave.changed(later(changed), 40.0)
    autosave.changed(changed, 41.0)
    assert autosave.due_s is None


def test_two_editors_do_not_offer_each_others_work(editor: Editor, folder: Path, document: Path) -> None:
    first, second = editor(), editor()
    first.opened(None)
    first.changed(small_project(), 0.0)
    write(first, 30.0)
    second.opened(document)
    second.changed(later(load(document)), 0.0)
    write(second, 30.0)
    assert [alive for _, alive in editors(folder)] == [True, True]
    assert recoverable(folder) == ()
    assert is_open_elsewhere(document, folder, first.presence.token)
    assert not is_open_elsewhere(document, folder, second.presence.token)
    assert recoverable_of(document, folder) is None
    third = editor()
    third.opened(document)
    assert third.path != autosave_path(document)


SCRIPT = """
import sys, time
from dataclasses import replace
from pathlib import Path
from app.project.autosave import Autosave
from app.project.presence import Presence
from app.project.storage import load
from tests.unit.project.pieces import small_project
folder, document = Path(sys.argv[1]), Path(sys.argv[2]) if sys.argv[2] else None
autosave = Autosave(Presence(folder))
autosave.opened(document)
project = replace(load(document) if document else small_project(), seed=0)
for number in range(1, 1_000_000):
    autosave.changed(replace(project, seed=number), 0.0)
    writing = autosave.take()
    writing.run()
    autosave.written(writing)
    if number == 3:
        print("ready", flush=True)
"""


def killed_in_mid_write(folder: Path, document: Path | None, after_s: float) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(folder), str(document or "")], cwd=ROOT, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stdout.readline().strip() == b"ready"
    # It writes without a pause, so wherever this strikes it strikes a write.
    time.sleep(after_s)
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
@pytest.mark.parametrize("after_s", [0.0, 0.013, 0.031])
@pytest.mark.parametrize("has_file", [True, False])
def test_killed_in_mid_write(editor: Editor, folder: Path, document: Path, after_s: float, has_file: bool) -> None:
    killed_in_mid_write(folder, document if has_file else None, after_s)
    (item,) = recoverable(folder)
    assert item.document == (document if has_file else None)
    assert item.name == ("piece.suisou" if has_file else "Small piece")
    assert item.note_count == 8
    assert abs(item.changed_s - time.time()) < 60.0
    if has_file:
        found = recoverable_of(document, folder)
        assert found is not None
        assert found.autosave == item.autosave
    mine = editor()
    project = recover(item, mine)
    assert project.seed >= 3
    assert replace(project, seed=0) == replace(small_project(), seed=0)
    # It is this editor's work now, and would survive its crash too.
    assert load(Path(mine.presence.note.autosave)) == project
    assert recoverable(folder) == ()
    mine.closed()
    assert list(folder.iterdir()) == []
    assert not autosave_path(document).exists()
    # Nor the file that was being written.
    assert not [path for path in document.parent.iterdir() if path.name.endswith(".partial")]


def left_behind(editor: Editor, document: Path | None, project: Project) -> None:
    """An editor that ended without a word, as far as the others can see."""
    autosave = editor()
    autosave.opened(document)
    autosave.changed(project, 0.0)
    write(autosave, 30.0)
    autosave.presence._stream.close()


def test_work_older_than_the_file_or_the_same_is_not_offered(editor: Editor, folder: Path, document: Path) -> None:
    project = load(document)
    left_behind(editor, document, later(project))
    assert len(recoverable(folder)) == 1
    os.utime(document, (time.time() + 60.0, time.time() + 60.0))
    assert recoverable(folder) == ()
    assert recoverable_of(document, folder) is None
    autosave_path(document).unlink()
    left_behind(editor, document, project)
    os.utime(document, (1.0, 1.0))
    assert recoverable(folder) == ()


def test_undecided_work_is_not_written_over(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, document, later(load(document)))
    item = recoverable_of(document, folder)
    assert item is not None
    mine = editor()
    mine.opened(document)
    changed = replace(load(document), seed=99)
    mine.changed(changed, 0.0)
    own = write(mine, 30.0)
    assert own not in (None, item.autosave)
    assert load(item.autosave) == later(load(document))
    assert recover(item, mine) == later(load(document))
    assert not item.autosave.exists()
    mine.changed(changed, 50.0)
    assert write(mine, 80.0) == autosave_path(document)
    assert own is not None
    assert not own.exists()
    mine.saved(document)
    assert not autosave_path(document).exists()


def test_thrown_away(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, None, small_project())
    left_behind(editor, document, later(load(document)))
    items = recoverable(folder)
    assert len(items) == 2
    for item in items:
        discard(item, folder)
    assert recoverable(folder) == ()
    assert list(folder.iterdir()) == []
    assert [path.name for path in document.parent.iterdir()] == ["piece.suisou"]


def test_a_damaged_file_does_not_hide_the_work_on_it(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, document, later(load(document)))
    document.write_bytes(b"{")
    os.utime(document, (1.0, 1.0))
    assert len(recoverable(folder)) == 1


def test_rubbish_in_the_folder_is_no_work(folder: Path) -> None:
    folder.mkdir(parents=True)
    (folder / "a.suisou").write_bytes(b"rubbish")
    (folder / "a.lock").touch()
    (folder / "b.json").write_bytes(b"[")
    (folder / ".0123.partial").write_bytes(b"half")
    assert recoverable(folder) == ()
    assert recoverable(folder / "missing") == ()


def test_work_whose_lock_is_gone_is_still_offered(editor: Editor, folder: Path) -> None:
    left_behind(editor, None, small_project())
    for path in (*folder.glob("*.lock"), *folder.glob("*.json")):
        path.unlink()
    (item,) = recoverable(folder)
    mine = editor()
    assert recover(item, mine) == small_project()
    assert not item.autosave.exists()


def test_the_folder_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(FileError):
        Presence(tmp_path / "file" / "recovery")
