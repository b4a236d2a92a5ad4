"""File names of any bytes are preserved by projects, unsaved work, settings and journals."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from app.capture.journal import JournalHeader, JournalWriter, read_journal
from app.editor.settings import Settings
from app.encoding import restored, stored
from app.project.autosave import Autosave
from app.project.casting import StagePosition
from app.project.performers import Dancer
from app.project.recording import AudioTrack
from app.project.recovery import load_work, recoverable
from app.project.running_editors import Presence, note_of
from app.project.storage import decode, encode, load, save
from tests.support.odd_names import NAME, byte_names, odd, on_bytes
from tests.unit.project.pieces import small_project

pytestmark = on_bytes


@given(byte_names, byte_names, byte_names, st.booleans())
@example("piece", "bytes:", "a", False)
@example("piece", "\udc83N", "100%", True)
@settings(max_examples=200)
def test_a_project_finds_its_files(folder: str, media: str, name: str, moved: bool) -> None:
    """Beside the project or elsewhere; moved together with it where they lie in one tree."""
    home = Path("/home/me") / folder
    where = home / media if moved else Path("/media") / media
    dance = str(where / f"{name}.choreography")
    project = replace(
        small_project(),
        source=str(where / f"{name}.mid"),
        audio=AudioTrack(str(where / f"{name}.wav"), 0.0),
        dancers=(Dancer("dancer:1", "Ana", dance, "man_adult", StagePosition(0.0, 3.0, 0.0)),),
    )
    content = encode(project, home / "piece.suisou")
    assert decode(content, home / "piece.suisou") == project
    if moved:
        elsewhere = decode(content, Path("/mnt/piece.suisou"))
        assert elsewhere.source == os.path.normpath(Path("/mnt") / media / f"{name}.mid")
        assert elsewhere.dancers[0].choreography == os.path.normpath(Path("/mnt") / media / f"{name}.choreography")


def test_through_real_files(tmp_path: Path) -> None:
    folder = odd(tmp_path)
    folder.mkdir()
    source, recording, document = (odd(folder, ending) for ending in (".mid", ".wav", ".suisou"))
    recording.write_bytes(b"x")
    project = replace(small_project(), source=str(source), audio=AudioTrack(str(recording), 0.0))
    save(project, document)
    save(project, document)
    assert load(document) == project
    assert set(folder.iterdir()) == {recording, document, Path(f"{document}.bak")}


def test_unsaved_work_after_a_crash(tmp_path: Path) -> None:
    folder = odd(tmp_path)
    folder.mkdir()
    document, state = odd(folder, ".suisou"), odd(tmp_path, ".state")
    project = replace(small_project(), source=str(odd(folder, ".mid")))
    save(project, document)
    presence = Presence(state)
    autosave = Autosave(presence)
    autosave.opened(document)
    edited = replace(project, seed=5)
    autosave.changed(edited, 0.0)
    writing = autosave.take(0.0)
    autosave.written(writing, writing.run())
    assert note_of(state, presence.token).document == str(document)
    assert recoverable(state) == ()
    presence._stream.close()  # as when it is killed
    (found,) = recoverable(state)
    assert (found.document, found.name) == (document, f"{NAME}.suisou")
    assert load_work(found)[0] == edited


@given(st.lists(byte_names, min_size=1, max_size=3, unique=True), byte_names)
@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_settings(tmp_path_factory: Any, names: list[str], folder: str) -> None:
    file = odd(tmp_path_factory.mktemp("settings")) / "editor.toml"
    before = Settings(file)
    before.folder = before.export_folder = f"/home/{folder}"
    for name in names:
        before.add_recent(Path("/home") / name)
    before.sync()
    after = Settings(file)
    assert (after.folder, after.export_folder) == (f"/home/{folder}",) * 2
    assert after.recent == tuple(str(Path("/home") / name) for name in reversed(names))
    assert after.problems == ()


@given(byte_names)
@settings(max_examples=20)
def test_a_journal(tmp_path_factory: Any, name: str) -> None:
    path = odd(tmp_path_factory.mktemp("takes"), ".take-journal")
    header = JournalHeader(stored(f"/home/{name}"), "p", "EWI", "", 0.0, "2026-01-01T00:00:00")
    writer = JournalWriter(str(path), header)
    writer.mark("end", 1)
    writer.close()
    assert restored(read_journal(path).header.project) == f"/home/{name}"
