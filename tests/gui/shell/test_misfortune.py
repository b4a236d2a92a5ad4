"""Damaged files, full disks, files changed by others and absurd pieces: a clear message in both languages, and no loss
of work.
"""

from __future__ import annotations

import errno
import os
import string
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Severity
from app.errors import Message
from app.performance.ensemble import Performance
from app.project import storage
from app.project.edit.piece import new_piece, set_audio, set_title
from app.project.edit.tempo import set_metre, set_tempo
from app.project.model import Project
from app.score.model import Note, Part
from app.shell.app import Program
from tests.gui.conftest import quartet_project
from tests.gui.shell.conftest import Answers, Start, trigger
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.common.text import message_text


class Reported:
    """All messages to the user in the current language."""

    def __init__(self, program: Program) -> None:
        self.messages: list[tuple[Message, Severity]] = []
        program.session.noticed.connect(lambda message, severity: self.messages.append((message, severity)))

    def says(self, program: Program) -> str:
        """Last message, checked to be a whole sentence in both languages."""
        assert self.messages, "no message was shown"
        message = self.messages[-1][0]
        texts = []
        for code in ("ja", "en"):
            program.editor.speak(code)
            said = message_text(message)
            assert said
            assert not [name for _, name, _, _ in string.Formatter().parse(said) if name in message.arguments], said
            texts.append(said)
        assert texts[0] != texts[1], f"not translated: {texts[1]}"
        assert any("\u3040" <= sign <= "\u30ff" or "\u4e00" <= sign <= "\u9fff" for sign in texts[0]), texts[0]
        return texts[1]


@pytest.fixture
def reported(program: Program) -> Reported:
    result = Reported(program)
    tasks = program.tasks
    assert isinstance(tasks, ImmediateTasks)
    return result


def edit(program: Program, title: str = "Corrections") -> Project:
    assert program.session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, title))
    return program.session.project


def good_file(tmp_path: Path) -> Path:
    path = tmp_path / "good.suisou"
    storage.save(quartet_project(), path)
    return path


def damaged(path: Path, what: str) -> None:
    """Damage a valid file."""
    content = path.read_bytes()
    raw: Any = msgspec.json.decode(content)
    match what:
        case "empty":
            path.write_bytes(b"")
        case "half":
            path.write_bytes(content[: len(content) // 2])
        case "noise":
            path.write_bytes(np.random.default_rng(1).bytes(5000))
        case "list":
            path.write_bytes(b"[1, 2, 3]")
        case "deep":
            path.write_bytes(b"[" * 200_000)
        case "newer":
            path.write_bytes(msgspec.json.encode({**raw, "schema_version": 999}))
        case "no players' part":
            raw["players"][0]["part_id"] = "nowhere"
            path.write_bytes(msgspec.json.encode(raw))
        case "negative note":
            raw["score"]["parts"][0]["notes"][0]["duration_tick"] = -5
            path.write_bytes(msgspec.json.encode(raw))
        case "huge tick":
            raw["score"]["parts"][0]["notes"][-1]["onset_tick"] = 10**17
            path.write_bytes(msgspec.json.encode(raw))
        case "two of one name":
            raw["players"][1]["id"] = raw["players"][0]["id"]
            path.write_bytes(msgspec.json.encode(raw))
        case "wrong types":
            raw["players"] = {"a": 1}
            path.write_bytes(msgspec.json.encode(raw))
        case "zero frame rate":
            raw["fps"] = "0"
            path.write_bytes(msgspec.json.encode(raw))
        case "folder":
            path.unlink()
            path.mkdir()


DAMAGES = (
    *("empty", "half", "noise", "list", "deep", "newer", "no players' part", "negative note", "huge tick"),
    *("two of one name", "wrong types", "zero frame rate", "folder"),
)


def test_a_damaged_project_is_reported_and_the_open_one_stays(
    program: Program, reported: Reported, tmp_path: Path
) -> None:
    before = edit(program)
    for what in DAMAGES:
        reported.messages.clear()
        path = good_file(tmp_path)
        damaged(path, what)
        program.editor.files._load(path, at_start=False)
        assert "good.suisou" in reported.says(program), what
        assert reported.messages[-1][1] is Severity.ERROR
        assert program.session.project is before
        assert len(program.session.document.done) == 1


@pytest.mark.parametrize("content", [b"", b"MThd", b"hello", b"MThd\0\0\0\6\0\1\0\1\0\x60MTrk\0\0\xff\xff\0\xff"])
def test_a_damaged_midi_file_is_reported_and_the_open_piece_stays(
    program: Program, reported: Reported, answers: Answers, tmp_path: Path, content: bytes
) -> None:
    answers.answer = "discard"
    before = program.session.project
    path = tmp_path / "bad.mid"
    path.write_bytes(content)
    program.editor.files.open(path, ask=False)
    if reported.messages and reported.messages[-1][1] is Severity.ERROR:
        assert "bad.mid" in reported.says(program)
        assert program.session.project is before
    else:
        # The readable parts are read.
        assert program.editor.files.name.startswith("bad")


def test_files_that_are_not_there(program: Program, reported: Reported, tmp_path: Path) -> None:
    before = program.session.project
    for name in ("gone.suisou", "gone.mid", "ガッキ🎺.suisou", "n" * 300 + ".suisou"):
        reported.messages.clear()
        program.editor.files.open(tmp_path / name, ask=False)
        assert name[:20] in reported.says(program)
    assert program.session.project is before


# Saving


def refused(program: Program, reported: Reported) -> str:
    """Check that a failed save is reported, and that the work is still unsaved."""
    tasks = program.tasks
    assert isinstance(tasks, ImmediateTasks)
    assert tasks.errors
    reported.messages.append((tasks.errors[-1].message, Severity.ERROR))
    assert not program.session.document.is_saved
    assert program.window.isWindowModified()
    return reported.says(program)


def test_a_full_disk(program: Program, reported: Reported, answers: Answers, tmp_path: Path, monkeypatch: Any) -> None:
    answers.path = path = tmp_path / "work.suisou"
    trigger(program, "file.save")
    held = path.read_bytes()
    edit(program)

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr("app.formats.atomic.os.fsync", full)
        trigger(program, "file.save")
        assert "No space left" in refused(program, reported)
    assert path.read_bytes() == held
    assert [found.name for found in tmp_path.glob("*.partial")] == []
    trigger(program, "file.save")
    assert program.session.document.is_saved
    assert storage.load(path).score.title == "Corrections"


def test_a_place_that_cannot_be_written_to(
    program: Program, reported: Reported, answers: Answers, tmp_path: Path
) -> None:
    (tmp_path / "a file").write_text("x")
    (tmp_path / "taken.suisou").mkdir()
    edit(program)
    for place in (tmp_path / "a file" / "x.suisou", tmp_path / "nowhere" / "x.suisou", tmp_path / "taken.suisou"):
        answers.path = place
        trigger(program, "file.save_as")
        assert place.name in refused(program, reported)
        assert program.editor.files.path is None
    assert (tmp_path / "taken.suisou").is_dir()


def test_a_file_that_is_write_protected(
    program: Program, reported: Reported, answers: Answers, tmp_path: Path, monkeypatch: Any
) -> None:
    answers.path = path = tmp_path / "work.suisou"
    trigger(program, "file.save")
    edit(program)
    # The user who runs the tests may have all permissions.
    monkeypatch.setattr("app.project.storage.os.access", lambda *_: False)
    trigger(program, "file.save")
    assert "work.suisou" in refused(program, reported)
    assert storage.load(path).score.title != "Corrections"


def test_names_that_no_one_expects(program: Program, answers: Answers, tmp_path: Path) -> None:
    for name in ("四重奏 🎺 – Ünïcödé", "a" * 200, "...", "con", "a%20b{file}", "'quotes\" & <tags>"):
        edit(program, f"{name} ")
        answers.path = path = tmp_path / f"{name}.suisou"
        trigger(program, "file.save_as")
        assert program.session.document.is_saved, name
        assert name[:20] in program.window.windowTitle()
        assert storage.load(path).players == program.session.project.players
        program.editor.files.open(path)
        assert program.editor.files.path == path
        program.window._fill_recent()
        QApplication.processEvents()


# Others at the same file


def click(program: Program, name: str, qtbot: QtBot) -> None:
    button = child(program.window.banner, QPushButton, name)
    assert button.isVisible()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


@pytest.fixture
def overtaken(program: Program, answers: Answers, tmp_path: Path) -> Path:
    """A file changed by another program after this editor saved it, and an edit in the editor."""
    answers.path = path = tmp_path / "shared.suisou"
    trigger(program, "file.save")
    storage.save(set_title(program.session.project, "Of another user"), path)
    os.utime(path, ns=(1, 2))
    edit(program)
    return path


def test_work_of_others_is_not_written_over(
    program: Program, answers: Answers, overtaken: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    trigger(program, "file.save")
    assert storage.load(overtaken).score.title == "Of another user"
    assert not program.session.document.is_saved
    assert program.window.banner.isVisible()
    answers.path = tmp_path / "mine.suisou"
    click(program, "banner_answer_0", qtbot)
    assert storage.load(tmp_path / "mine.suisou").score.title == "Corrections"
    assert storage.load(overtaken).score.title == "Of another user"
    assert program.session.document.is_saved
    assert not program.window.banner.isVisible()


def test_work_of_others_is_replaced_where_the_user_confirms(program: Program, overtaken: Path, qtbot: QtBot) -> None:
    trigger(program, "file.save")
    click(program, "banner_answer_1", qtbot)
    assert storage.load(overtaken).score.title == "Corrections"
    assert storage.load(storage.backup_path(overtaken)).score.title == "Of another user"
    edit(program, "Once more")
    trigger(program, "file.save")
    assert storage.load(overtaken).score.title == "Once more"


def test_closing_does_not_write_over_work_of_others(
    program: Program, answers: Answers, overtaken: Path, qtbot: QtBot
) -> None:
    answers.answer = "save"
    program.window.close()
    QApplication.processEvents()
    assert program.window.isVisible()
    assert storage.load(overtaken).score.title == "Of another user"
    click(program, "banner_answer_1", qtbot)
    qtbot.waitUntil(lambda: not program.window.isVisible())
    assert storage.load(overtaken).score.title == "Corrections"


def test_a_file_that_was_removed_is_written_again(program: Program, overtaken: Path) -> None:
    overtaken.unlink()
    trigger(program, "file.save")
    assert storage.load(overtaken).score.title == "Corrections"


def test_two_editors_on_one_file_are_reported(start: Start, answers: Answers, tmp_path: Path) -> None:
    path = good_file(tmp_path)
    first, second = start(), start()
    first.editor.files.open(path)
    reported = Reported(second)
    second.editor.files.open(path)
    assert "another window" in reported.says(second)
    edit(first, "First")
    trigger(first, "file.save")
    edit(second, "Second")
    trigger(second, "file.save")
    assert storage.load(path).score.title == "First"
    assert second.window.banner.isVisible()


# Recordings


def tone(path: Path) -> Path:
    soundfile.write(path, 0.1 * np.sin(np.arange(11_025) * 0.1), 11_025)
    return path


@pytest.mark.parametrize("content", [b"", b"RIFF....WAVE", b"no sound at all"])
def test_a_recording_that_is_none(program: Program, answers: Answers, tmp_path: Path, content: bytes) -> None:
    reported = Reported(program)
    answers.path = path = tmp_path / "sound.wav"
    path.write_bytes(content)
    trigger(program, "file.add_audio")
    QApplication.processEvents()
    assert reported.messages[-1][1] is Severity.ERROR
    assert "sound.wav" in reported.says(program)
    trigger(program, "edit.undo")
    assert program.session.project.audio is None


def test_a_recording_that_is_removed_while_it_is_open(program: Program, answers: Answers, tmp_path: Path) -> None:
    path = tone(tmp_path / "sound.wav")
    program.session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, path))
    QApplication.processEvents()
    assert program.session.listening.waveform is not None
    path.unlink()
    edit(program)
    answers.path = tmp_path / "work.suisou"
    trigger(program, "file.save")
    assert program.session.document.is_saved
    program.editor.files.open(tmp_path / "work.suisou")
    assert program.window.banner.isVisible()
    assert program.session.project.audio is not None


# Absurd pieces


def with_notes(project: Project, notes: tuple[Note, ...]) -> Project:
    """Project whose first part has these notes."""
    parts = list(project.score.parts)
    parts[0] = msgspec.structs.replace(parts[0], notes=notes)
    return with_parts(project, tuple(parts))


def with_parts(project: Project, parts: tuple[Part, ...]) -> Project:
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


def strange(name: str) -> Project:
    base = quartet_project()
    notes = base.score.parts[0].notes
    quarter = base.score.ticks_per_quarter
    match name:
        case "no players":
            return new_piece()
        case "nothing to play":
            return with_notes(base, ())
        case "no instrument":
            players = tuple(msgspec.structs.replace(player, instrument_id="serpent") for player in base.players)
            return replace(base, players=players)
        case "no character":
            players = tuple(msgspec.structs.replace(player, character_id="unknown") for player in base.players)
            return replace(base, players=players)
        case "ticks":
            return with_notes(base, tuple(msgspec.structs.replace(note, duration_tick=1) for note in notes))
        case "chords":
            chords = tuple(
                Note(f"c{number}:{voice}", number * quarter, quarter, 60 + 4 * voice, 80)
                for number in range(8)
                for voice in range(5)
            )
            return with_notes(base, chords)
        case "all pitches":
            return with_notes(
                base, tuple(Note(f"p{pitch}", pitch * quarter, quarter // 2, pitch, 1) for pitch in range(128))
            )
        case "slow":
            return set_tempo(base, 0, 5.0)
        case "fast":
            return set_tempo(base, 0, 999.0)
        case "metre":
            return set_metre(base, 0, 127, 64)
        case "two hours":
            return with_notes(base, (*notes, Note("late", 7200 * 2 * quarter, quarter, 60, 80)))
        case "early":
            return replace(base, preroll_beats=64.0)
        case _:
            raise LookupError(name)


STRANGE = (
    *("no players", "nothing to play", "no instrument", "no character", "ticks", "chords", "all pitches", "slow"),
    *("fast", "metre", "two hours", "early"),
)


@pytest.mark.parametrize("name", STRANGE)
def test_a_piece_that_no_one_would_write(
    program: Program, answers: Answers, tmp_path: Path, qtbot: QtBot, name: str
) -> None:
    project = strange(name)
    path = tmp_path / "strange.suisou"
    storage.save(project, path)
    program.editor.files.open(path)
    session, window = program.session, program.window
    assert program.editor.files.path == path
    opened = session.project
    for action in ("timeline.fit", "timeline.zoom_in", "play.to_end", "play.to_start", "play.bar_on", "play.bar_back"):
        trigger(program, action)
        QApplication.processEvents()
    for code in ("ja", "en"):
        program.editor.speak(code)
        window.grab()
    for display in ("seconds", "frames", "bars"):
        trigger(program, f"timeline.count_{display}")
        QApplication.processEvents()
    program.editor.table.refresh()
    assert actions(session)["export.files"].isEnabled() == bool(project.players)
    if project.players:
        qtbot.waitUntil(lambda: session.performance.project is session.project)
        fresh = Performance(session.project)
        for player in session.project.players:
            assert session.performance.plan(player) == fresh.plan(player)
        for action in ("notes.select_all", "notes.up", "events.breath", "events.cue", "players.randomise"):
            program.editor.table.refresh()
            if actions(session)[action].isEnabled():
                actions(session)[action].trigger()
                QApplication.processEvents()
        while session.document.undo() is not None:
            pass
    assert session.project is opened
    answers.path = tmp_path / "again.suisou"
    trigger(program, "file.save_as")
    assert storage.load(tmp_path / "again.suisou") == opened
