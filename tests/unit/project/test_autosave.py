"""Unsaved work survives a crash, but not a regular end."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import msgspec
import pytest

from app.errors import FileError
from app.formats import atomic
from app.messages import error_text, text
from app.project.autosave import PATIENCE_S, Autosave, AutosaveResult, Writing, autosave_path
from app.project.model import Project
from app.project.recovery import Recoverable, discard, load_work, recoverable, recoverable_of
from app.project.running_editors import Presence, editors, is_open_elsewhere
from app.project.storage import encode, file_hash, load, save
from tests.unit.project.pieces import full_project, small_project

Editor = Callable[[], Autosave]

ROOT = Path(__file__).parents[3]
DELAY_S = 4.0


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
    """Start editors of one computer, whose files are closed after the test."""
    presences: list[Presence] = []

    def start() -> Autosave:
        presences.append(Presence(folder))
        return Autosave(presences[-1], DELAY_S)

    yield start
    for presence in presences:
        presence.leave()


def later(project: Project) -> Project:
    return replace(project, seed=project.seed + 1)


def made(autosave: Autosave, writing: Writing, now_s: float) -> AutosaveResult:
    """Perform a due autosave like the shell, and return its result."""
    try:
        written = writing.run()
    finally:
        autosave.ended(writing, now_s)
    autosave.written(writing, written)
    return written


def write(autosave: Autosave, now_s: float) -> Path | None:
    writing = autosave.due(now_s)
    return None if writing is None else made(autosave, writing, now_s).path


def open_in(autosave: Autosave, document: Path) -> Project:
    autosave.opened(document, file_hash(document))
    return load(document)


def recover(item: Recoverable, autosave: Autosave) -> Project:
    """Restore recovered work like the shell, and return its project."""
    project, base = load_work(item)
    autosave.opened(item.document, base, item.facts, item.autosave)
    autosave.changed(project, 0.0)
    return project


class Disks:
    """Folders that refuse writing, as for a user without permission."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.refusing: dict[Path, int] = {}
        new_partial = atomic._new_partial

        def asked(folder: Path) -> tuple[Path, BinaryIO]:
            for refusing, number in self.refusing.items():
                if folder == refusing:
                    raise OSError(number, os.strerror(number))
            return new_partial(folder)

        monkeypatch.setattr(atomic, "_new_partial", asked)


@pytest.fixture
def disks(monkeypatch: pytest.MonkeyPatch) -> Disks:
    return Disks(monkeypatch)


def test_a_change_is_written_beside_the_file_after_the_delay_and_not_before(editor: Editor, document: Path) -> None:
    autosave = editor()
    changed = later(open_in(autosave, document))
    before = document.read_bytes()
    assert autosave.due_s is None
    autosave.changed(changed, 100.0)
    # A drag that goes on does not postpone it.
    for number in range(30):
        autosave.changed(later(changed), 100.0 + 0.1 * number)
    assert autosave.due_s == 104.0
    assert write(autosave, 103.9) is None
    assert write(autosave, 104.0) == autosave_path(document)
    assert load(autosave_path(document)) == later(changed)
    assert document.read_bytes() == before
    assert write(autosave, 1000.0) is None


def test_what_changes_while_it_is_written_is_written_next(editor: Editor, document: Path) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    writing = autosave.due(4.0)
    assert writing is not None
    autosave.changed(project, 4.1)
    made(autosave, writing, 4.3)
    assert autosave.due_s == 8.1


def test_a_clean_save_leaves_nothing_to_recover(editor: Editor, folder: Path, document: Path) -> None:
    autosave = editor()
    autosave.changed(later(open_in(autosave, document)), 0.0)
    assert write(autosave, 4.0) is not None
    autosave.opened(document, "saved")
    assert not autosave_path(document).exists()
    autosave.closed()
    assert list(folder.iterdir()) == []


def test_closing_without_saving_throws_the_work_away(editor: Editor, folder: Path) -> None:
    autosave = editor()
    autosave.opened(None)
    autosave.changed(small_project(), 0.0)
    path = write(autosave, 4.0)
    assert path.parent == folder
    autosave.closed()
    assert list(folder.iterdir()) == []


def test_what_finishes_after_a_save_is_thrown_away(editor: Editor, document: Path) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    writing = autosave.due(4.0)
    assert writing is not None
    autosave.opened(document, "saved")
    made(autosave, writing, 5.0)
    assert not autosave_path(document).exists()
    assert autosave.due_s is None


def test_what_finishes_after_a_save_does_not_stay_in_place_of_newer_work(editor: Editor, document: Path) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    held_up = autosave.due(4.0)
    assert held_up is not None
    # The writing is in progress and checks nothing any more.
    held_up = replace(held_up, held=frozenset((autosave_path(document),)))
    autosave.opened(document, "saved")
    newer = later(later(project))
    autosave.changed(newer, 6.0)
    assert write(autosave, 10.0) == autosave_path(document)
    made(autosave, held_up, 11.0)
    assert write(autosave, 12.0) == autosave_path(document)
    assert load(autosave_path(document)) == newer


def test_the_undone_change_is_not_written_again(editor: Editor, document: Path) -> None:
    autosave = editor()
    changed = later(open_in(autosave, document))
    autosave.changed(changed, 0.0)
    write(autosave, 4.0)
    autosave.changed(later(changed), 40.0)
    autosave.changed(changed, 41.0)
    assert autosave.due_s is None


def test_two_editors_do_not_offer_each_others_work(editor: Editor, folder: Path, document: Path) -> None:
    first, second = editor(), editor()
    first.opened(None)
    first.changed(small_project(), 0.0)
    write(first, 4.0)
    second.changed(later(open_in(second, document)), 0.0)
    write(second, 4.0)
    assert [alive for _, alive in editors(folder)] == [True, True]
    assert recoverable(folder) == ()
    assert is_open_elsewhere(document, folder, first.presence.token)
    assert not is_open_elsewhere(document, folder, second.presence.token)
    assert recoverable_of(document, folder, first.presence.token) == ()
    third = editor()
    third.changed(later(open_in(third, document)), 0.0)
    assert write(third, 4.0) == third.presence.own_path


# The second place


def test_a_folder_that_refuses_the_work_does_not_lose_it(
    editor: Editor, folder: Path, document: Path, disks: Disks
) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    for number in (errno.EROFS, errno.ENOSPC, errno.EACCES, errno.EIO):
        project = later(project)
        autosave.changed(project, 0.0)
        disks.refusing[document.parent] = number
        writing = autosave.due(4.0)
        assert writing is not None
        written = made(autosave, writing, 4.0)
        assert written.path == autosave.presence.own_path
        assert written.warning is not None
        reported = text(written.warning)
        assert os.strerror(number) in reported
        assert str(document) in reported
        assert str(folder) in reported
        assert load(autosave.presence.own_path) == project
    # The autosave appears as soon as the folder accepts it, and only there.
    disks.refusing.clear()
    autosave.changed(later(project), 0.0)
    writing = autosave.due(4.0)
    assert writing is not None
    written = made(autosave, writing, 4.0)
    assert (written.path, written.held, written.warning) == (autosave_path(document), {autosave_path(document)}, None)
    assert not autosave.presence.own_path.exists()


@pytest.mark.parametrize("what", ["read-only", "gone", "a file"])
def test_what_is_in_the_second_place_is_offered_like_work_beside_the_file(
    editor: Editor, folder: Path, document: Path, disks: Disks, what: str
) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    assert write(autosave, 4.0) == autosave_path(document)
    if what == "read-only":
        disks.refusing[document.parent] = errno.EROFS
    else:
        shutil.rmtree(document.parent)
    if what == "a file":
        document.parent.write_text("no folder any more")
    newest = later(later(project))
    autosave.changed(newest, 0.0)
    assert write(autosave, 4.0) == autosave.presence.own_path
    crash(autosave)
    (item,) = recoverable(folder)
    assert (item,) == recoverable_of(document, folder)
    assert (item.document, item.name) == (document, "piece.suisou")
    assert (item.is_file_missing, item.is_file_changed) == (what != "read-only", False)
    mine = editor()
    assert recover(item, mine) == newest
    assert mine.document == document
    assert recoverable(folder) == ()
    assert write(mine, 4.0) == mine.presence.own_path
    assert not item.autosave.exists()
    mine.closed()
    assert recoverable(folder) == ()


def test_an_older_generation_that_could_not_be_removed_is_not_offered(
    editor: Editor, folder: Path, document: Path, disks: Disks, monkeypatch: pytest.MonkeyPatch
) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    write(autosave, 4.0)
    older = autosave_path(document).read_bytes()
    disks.refusing[document.parent] = errno.EROFS
    newest = later(later(project))
    autosave.changed(newest, 0.0)
    write(autosave, 4.0)
    autosave_path(document).write_bytes(older)
    # The clock was set back meanwhile.
    os.utime(autosave_path(document), (2e9, 2e9))
    os.utime(autosave.presence.own_path, (1.0, 1.0))
    crash(autosave)
    (item,) = recoverable_of(document, folder)
    assert load_work(item)[0] == newest


def test_no_place_at_all(editor: Editor, folder: Path, document: Path, disks: Disks) -> None:
    autosave = editor()
    project = later(open_in(autosave, document))
    autosave.changed(project, 0.0)
    disks.refusing |= {document.parent: errno.ENOSPC, folder: errno.EROFS}
    with pytest.raises(FileError) as raised:
        write(autosave, 4.0)
    reported = error_text(raised.value)
    assert raised.value.message.id == "autosave.refused"
    assert os.strerror(errno.ENOSPC) in reported
    assert os.strerror(errno.EROFS) in reported
    # The autosave is tried again.
    assert autosave.due_s == 8.0
    disks.refusing.clear()
    assert write(autosave, 8.0) == autosave_path(document)


def test_no_place_for_a_piece_without_a_file(editor: Editor, folder: Path, disks: Disks) -> None:
    autosave = editor()
    autosave.opened(None)
    autosave.changed(small_project(), 0.0)
    disks.refusing[folder] = errno.ENOSPC
    with pytest.raises(FileError) as raised:
        write(autosave, 4.0)
    assert raised.value.message.id == "autosave.nowhere"
    assert str(folder) in error_text(raised.value)


def test_a_disk_that_does_not_answer_is_not_waited_for(editor: Editor, folder: Path, document: Path) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    held_up = autosave.due(4.0)
    assert held_up is not None
    newer = later(later(project))
    autosave.changed(newer, 4.5)
    assert autosave.due_s == 4.0 + PATIENCE_S
    assert write(autosave, 9.0) == autosave.presence.own_path
    # At last one of both is written: newer work has priority.
    made(autosave, held_up, 60.0)
    assert not autosave_path(document).exists()
    crash(autosave)
    (item,) = recoverable(folder)
    assert load_work(item)[0] == newer


def test_while_two_disks_do_not_answer_no_third_writing_is_begun(editor: Editor, document: Path) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    first = autosave.due(4.0)
    autosave.changed(later(later(project)), 4.5)
    second = autosave.due(9.0)
    assert first is not None
    assert second is not None
    autosave.changed(project, 10.0)
    assert autosave.due(1000.0) is None
    made(autosave, second, 1000.0)
    assert autosave.due(1000.0) is not None


def test_a_writing_that_was_held_up_and_then_refused_does_not_replace_a_newer_one(
    editor: Editor, document: Path, disks: Disks
) -> None:
    autosave = editor()
    project = open_in(autosave, document)
    autosave.changed(later(project), 0.0)
    held_up = autosave.due(4.0)
    assert held_up is not None
    newer = later(later(project))
    autosave.changed(newer, 4.5)
    assert write(autosave, 9.0) == autosave.presence.own_path
    disks.refusing[document.parent] = errno.ETIMEDOUT
    assert made(autosave, held_up, 60.0).path is None
    assert load(autosave.presence.own_path) == newer


def test_a_folder_of_unsaved_work_that_refuses_costs_nothing_else(tmp_path: Path, document: Path, disks: Disks) -> None:
    """Neither the start nor the autosave beside the file fails."""
    blocked = tmp_path / "state"
    blocked.write_text("no folder")
    presence = Presence(blocked / "recovery")
    assert presence.refusal is not None
    assert str(blocked) in error_text(presence.refusal)
    autosave = Autosave(presence)
    with pytest.raises(FileError, match=r"presence\.refused"):
        autosave.opened(document, file_hash(document))
    project = later(load(document))
    autosave.changed(project, 0.0)
    with pytest.raises(FileError, match=r"presence\.refused"):
        write(autosave, 4.0)
    assert load(autosave_path(document)) == project
    (item,) = recoverable_of(document, presence.folder)
    assert load_work(item)[0] == project
    # The folder is available at last.
    blocked.unlink()
    autosave.changed(later(project), 8.0)
    write(autosave, 12.0)
    assert is_open_elsewhere(document, presence.folder)
    presence.leave()


def test_an_editor_whose_folder_is_cleared_away_is_seen_again(editor: Editor, folder: Path) -> None:
    autosave = editor()
    autosave.opened(None)
    autosave.changed(small_project(), 0.0)
    write(autosave, 4.0)
    shutil.rmtree(folder)
    autosave.changed(later(small_project()), 5.0)
    assert write(autosave, 9.0) == autosave.presence.own_path
    assert recoverable(folder) == ()
    crash(autosave)
    (item,) = recoverable(folder)
    assert load_work(item)[0] == later(small_project())


# After a crash


def test_dancers_that_were_never_saved_are_recovered_with_their_files(
    editor: Editor, folder: Path, tmp_path: Path
) -> None:
    autosave = editor()
    autosave.opened(None)
    danced = full_project(str(tmp_path / "media"))
    autosave.changed(danced, 0.0)
    written = write(autosave, 4.0)
    assert written.parent == folder
    crash(autosave)
    (item,) = recoverable(folder)
    assert load_work(item)[0] == danced


SCRIPT = """
import sys
from dataclasses import replace
from pathlib import Path
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.project.storage import file_hash, load
from tests.unit.project.pieces import small_project
folder, document = Path(sys.argv[1]), Path(sys.argv[2]) if sys.argv[2] else None
autosave = Autosave(Presence(folder))
autosave.opened(document, file_hash(document) if document else "")
project = replace(load(document) if document else small_project(), seed=0)
for number in range(1, 1_000_000):
    autosave.changed(replace(project, seed=number), 0.0)
    writing = autosave.take(0.0)
    written = writing.run()
    autosave.ended(writing, 0.0)
    autosave.written(writing, written)
    if number == 3:
        print("ready", flush=True)
"""


def killed_in_mid_write(folder: Path, document: Path | None, after_s: float) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(folder), str(document or "")], cwd=ROOT, stdout=subprocess.PIPE
    )
    assert process.stdout.readline().strip() == b"ready"
    # The process writes continuously, so the kill interrupts a write.
    time.sleep(after_s)
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
@pytest.mark.parametrize(("after_s", "has_file"), [(0.0, True), (0.031, True), (0.013, False)])
def test_killed_in_mid_write(editor: Editor, folder: Path, document: Path, after_s: float, has_file: bool) -> None:
    killed_in_mid_write(folder, document if has_file else None, after_s)
    (item,) = recoverable(folder)
    assert item.document == (document if has_file else None)
    assert item.name == ("piece.suisou" if has_file else "Small piece")
    assert item.note_count == 8
    assert abs(item.changed_s - time.time()) < 60.0
    if has_file:
        assert recoverable_of(document, folder) == (item,)
    mine = editor()
    project = recover(item, mine)
    assert project.seed >= 3
    assert replace(project, seed=0) == replace(small_project(), seed=0)
    # The work belongs to this editor immediately and would survive its crash too.
    assert recoverable(folder) == ()
    assert write(mine, 4.0) == Path(mine.presence.note.autosave)
    assert load(Path(mine.presence.note.autosave)) == project
    assert recoverable(folder) == ()
    mine.closed()
    assert recoverable(folder) == ()
    assert list(folder.iterdir()) == []
    assert not autosave_path(document).exists()
    # Nor the file that was being written.
    assert not [path for path in document.parent.iterdir() if path.name.endswith(".partial")]


def crash(autosave: Autosave) -> None:
    """End an editor without notice to the others."""
    autosave.presence._stream.close()


def left_behind(editor: Editor, document: Path | None, project: Project) -> None:
    """End an editor with unsaved work by a crash."""
    autosave = editor()
    autosave.opened(document, "" if document is None else file_hash(document))
    autosave.changed(project, 0.0)
    write(autosave, 4.0)
    crash(autosave)


def test_a_clock_that_is_set_back_hides_no_work(editor: Editor, folder: Path, document: Path) -> None:
    project = load(document)
    left_behind(editor, document, later(project))
    os.utime(document, (time.time() + 1e6, time.time() + 1e6))
    (item,) = recoverable(folder)
    assert recoverable_of(document, folder) == (item,)
    assert not item.is_file_changed


def test_work_on_a_file_that_has_changed_since_is_offered_and_says_so(
    editor: Editor, folder: Path, document: Path
) -> None:
    project = load(document)
    left_behind(editor, document, later(project))
    base = file_hash(document)
    save(replace(project, seed=77), document)
    # The result is independent of the clock.
    os.utime(document, (1.0, 1.0))
    (item,) = recoverable_of(document, folder)
    assert recoverable(folder) == (item,)
    assert item.is_file_changed
    # The next save is known to be based on the file's content at that time.
    assert load_work(item) == (later(project), base)


def test_work_that_is_in_the_file_is_not_offered_and_goes(editor: Editor, folder: Path, document: Path) -> None:
    project = later(load(document))
    left_behind(editor, document, project)
    save(project, document)
    assert recoverable(folder) == ()
    assert not autosave_path(document).exists()
    assert list(folder.iterdir()) == []


def test_autosaves_of_older_versions_still_work(editor: Editor, folder: Path, document: Path) -> None:
    """They contain only the project, and a note beside them names the file."""
    project = later(load(document))
    left_behind(editor, document, project)
    autosave_path(document).write_bytes(encode(project, autosave_path(document)))
    (item,) = recoverable(folder)
    assert recoverable_of(document, folder) == (item,)
    assert (item.facts, item.is_file_changed) == (None, False)
    assert load_work(item) == (project, file_hash(document))
    # The base is unknown: the work may be older.
    os.utime(document, (time.time() + 1e6, time.time() + 1e6))
    (item,) = recoverable(folder)
    assert item.is_file_changed
    mine = editor()
    recover(item, mine)
    assert write(mine, 4.0) == autosave_path(document)
    crash(mine)
    (item,) = recoverable(folder)
    assert item.facts is not None


def test_undecided_work_is_not_written_over_and_stays(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, document, later(load(document)))
    (item,) = recoverable_of(document, folder)
    mine = editor()
    changed = replace(open_in(mine, document), seed=99)
    mine.changed(changed, 0.0)
    assert write(mine, 4.0) == mine.presence.own_path
    assert load(item.autosave) == later(load(document))
    # Nor does saving decide about it.
    mine.opened(document, save(changed, document))
    assert not mine.presence.own_path.exists()
    (item,) = recoverable_of(document, folder, mine.presence.token)
    assert item.is_file_changed
    work = recover(item, mine)
    assert work == replace(changed, seed=work.seed)
    mine.changed(later(work), 50.0)
    assert write(mine, 54.0) == autosave_path(document)
    mine.opened(document, file_hash(document))
    assert not autosave_path(document).exists()


def test_works_of_two_crashes_are_both_offered(editor: Editor, folder: Path, document: Path) -> None:
    project = load(document)
    left_behind(editor, document, later(project))
    left_behind(editor, document, later(later(project)))
    items = recoverable(folder)
    assert {load_work(item)[0].seed for item in items} == {project.seed + 1, project.seed + 2}
    assert set(recoverable_of(document, folder)) == set(items)


def test_thrown_away(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, None, small_project())
    left_behind(editor, document, later(load(document)))
    items = recoverable(folder)
    assert len(items) == 2
    for item in items:
        discard(item)
    assert recoverable(folder) == ()
    assert list(folder.iterdir()) == []
    assert [path.name for path in document.parent.iterdir()] == ["piece.suisou"]


def test_a_damaged_file_does_not_hide_the_work_on_it(editor: Editor, folder: Path, document: Path) -> None:
    left_behind(editor, document, later(load(document)))
    document.write_bytes(b"{")
    (item,) = recoverable(folder)
    assert item.is_file_changed


def test_rubbish_in_the_folder_is_no_work_and_is_kept(folder: Path) -> None:
    """Another version of the program may be able to use it."""
    folder.mkdir(parents=True)
    (folder / "a.suisou").write_bytes(b"rubbish")
    (folder / "a.lock").touch()
    (folder / "b.json").write_bytes(b"[")
    (folder / f".{16 * '0'}.partial").write_bytes(b"half")
    assert recoverable(folder) == ()
    assert recoverable(folder / "missing") == ()
    assert sorted(path.name for path in folder.iterdir()) == ["a.lock", "a.suisou"]


def test_an_autosave_says_nothing_that_becomes_a_path(editor: Editor, folder: Path, document: Path) -> None:
    """An autosave beside a file may come from a stranger: its project is determined by its location only."""
    left_behind(editor, document, later(load(document)))
    beside = autosave_path(document)
    raw = msgspec.json.decode(beside.read_bytes())
    raw["autosave"] |= {"document": "/etc/passwd", "editor": "../../../etc/passwd"}
    beside.write_bytes(msgspec.json.encode(raw))
    (item,) = recoverable_of(document, folder)
    assert item.document == document


def test_work_whose_lock_is_gone_is_still_offered(editor: Editor, folder: Path) -> None:
    left_behind(editor, None, small_project())
    for path in (*folder.glob("*.lock"), *folder.glob("*.json")):
        path.unlink()
    (item,) = recoverable(folder)
    mine = editor()
    assert recover(item, mine) == small_project()
    assert write(mine, 4.0) == mine.presence.own_path
    assert not item.autosave.exists()


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
def test_a_link_beside_a_file_leads_nowhere(editor: Editor, document: Path, tmp_path: Path) -> None:
    """A folder may come from anywhere, and a link with an autosave's name may lead to the user's own files."""
    own, link = tmp_path / "own.suisou", autosave_path(document)
    save(small_project(), own)
    before = own.read_bytes()
    link.symlink_to(own)
    autosave = editor()
    changed = later(open_in(autosave, document))
    autosave.changed(changed, 0.0)
    assert write(autosave, 4.0) == autosave.presence.own_path
    # Taken over as unsaved work, it is written again.
    autosave.opened(document, held=link)
    autosave.changed(changed, 0.0)
    assert write(autosave, 4.0) == link
    assert not link.is_symlink()
    assert load(link) == changed
    assert own.read_bytes() == before
