"""Names from files are displayed literally everywhere: none is interpreted as HTML or opens a file."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QLabel, QToolButton
from pytestqt.qtbot import QtBot

import instrument_maps.library as instruments
from app.editor.recorder import Recorder
from app.editor.selection import EventKey, Selection
from app.editor.session import Severity
from app.editor.settings import Settings
from app.errors import Message
from app.project import storage
from app.project.autosave import Autosave
from app.project.edit.piece import set_title
from app.project.recovery import Recoverable
from app.project.running_editors import Presence
from app.rig.characters import character_library
from app.rig.characters.load_character import read_character
from app.score.read import read_contents
from app.score.write import write_midi
from app.shell.app import Program
from app.shell.commands.events import choose_expression
from app.shell.questions import DialogQuestions, _may_replace
from instrument_maps.library import all_maps
from tests.gui.conftest import delete_now, quartet_project
from tests.gui.shell.conftest import Answers, Start, end
from tests.gui.shell.test_recovery import click, crash, edit, later
from tests.support.canary import WATCHES, Canary, canary
from tests.support.foreign_text import CHARACTER, Judge, Spoken, hostile_score, with_more, write_library
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show
from widgets.common.actions import actions
from widgets.common.section import SectionHeader
from widgets.dialogs.character import CharacterDialog
from widgets.dialogs.character_draft import CharacterDraft
from widgets.dialogs.import_midi import ImportDialog

pytestmark = pytest.mark.skipif(not WATCHES, reason="only Linux reports which files are opened")

SHOWN = {
    *("title", "track", "marker", "player", "take", "device", "expression", "audio", "source", "piece", "step"),
    *("instrument", "map_file", "character", "wrong_character", "bone", "figure", "preset", "wrong_preset"),
    *("port", "host", "recent", "lost", "notice", "asked", "removed", "replaced"),
}
"""Kinds of names that must be displayed during the test."""
DIALOGS = (
    *("application.about", "application.preferences", "application.shortcuts", "application.instruments"),
    *("application.characters", "export.files", "export.playblast", "file.evaluation"),
    "file.evaluation_results",
    *("file.reimport", "record.devices"),
    *("record.latency", "stream.settings", "dancers.learn", "file.piece_settings"),
)


@pytest.fixture
def watched(qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Canary]:
    """Files that must not be opened, in the working directory so that their bare names suffice."""
    with canary(tmp_path / "c") as result:
        monkeypatch.chdir(result.folder)
        yield result


@pytest.fixture
def walked(
    qtbot: QtBot, watched: Canary, settings: Settings, answers: Answers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Program]:
    """An editor with hostile names of settings, devices, instruments, characters and presets."""
    for name in ("instruments", "characters"):
        monkeypatch.setenv(f"SUISOU_{name.upper()}", str(tmp_path / name))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    write_library(
        watched, tmp_path / "instruments", tmp_path / "characters", tmp_path / "config" / "suisou" / "presets"
    )
    monkeypatch.setattr(instruments.LIBRARY, "last", None)
    character_library.reload_characters()
    settings.add_recent(tmp_path / watched.file_name("recent"))
    settings.midi_port, settings.stream_host = watched.name("port"), watched.name("host")
    program = Program(
        settings,
        ImmediateTasks(),
        answers,
        Autosave(Presence(tmp_path / "recovery")),
        audible=False,
        recorder=lambda session, files, settings, sound: Recorder(
            session, files, settings, sound, lambda on_news: Spoken(on_news, settings.midi_port)
        ),
    )
    program.recorder.begin_where_remembered()
    program.window.resize(1600, 1000)
    show(program.window)
    yield program
    end(program)
    delete_now()
    monkeypatch.undo()
    character_library.reload_characters()


def close_others(program: Program) -> None:
    """Close everything except the window."""
    while (popup := QApplication.activePopupWidget()) is not None:
        popup.close()
    for widget in QApplication.topLevelWidgets():
        if widget is not program.window and widget.isVisible():
            widget.close()
    delete_now()


def start_page(program: Program, judge: Judge, folder: Path) -> None:
    lost = Recoverable(folder / "a.suisou", None, judge.canary.name("lost"), 1.0e9, 400)
    program.editor.files.find_recoverable = lambda found: found((lost,))
    program.window.start_page.refresh()
    judge.look("start page")


def piece(program: Program, judge: Judge, folder: Path) -> None:
    """Check a MIDI file in the import dialog and as a piece, and then a project with content that only
    projects have.
    """
    midi = folder / f"{judge.canary.file_name('source')}.mid"
    write_midi(hostile_score(quartet_project().score, judge.canary), midi)
    ImportDialog(read_contents(midi), all_maps(), program.session.tokens, ImmediateTasks(), program.window).show()
    judge.look("import", program.window)
    close_others(program)
    program.editor.files.open(midi, ask=False)
    judge.look("imported")
    path = folder / f"{judge.canary.file_name('piece')}.suisou"
    storage.save(with_more(program.session.project, judge.canary), path)
    program.editor.files.open(path)
    assert program.editor.files.path == path
    judge.look("opened")


def selections(program: Program, judge: Judge) -> None:
    """Check all panels unfolded, with the mouse over every lane, and its menus."""
    session, timeline = program.session, program.window.timeline
    for header in program.window.findChildren(SectionHeader):
        header.set_open(True)
    player = session.project.players[0]
    notes, plan = session.project.part(player).notes, session.performance.plan(player)
    events = (*plan.breaths[:1], *plan.expressions[:1], *plan.gestures[:1])
    chosen = [Selection(), Selection(frozenset({notes[2].id})), Selection(take="take:1")]
    chosen += [Selection(events=frozenset({EventKey(player.id, event.id)})) for event in events]  # type: ignore[attr-defined]
    for selection in chosen:
        session.select(selection)
        judge.look(f"selected: {selection}")
    session.set_players(tuple(one.id for one in session.project.players))
    judge.look("players")
    session.set_players((player.id,))
    for flag in timeline.flags._flags:
        judge.rest(timeline.flags, flag.rect.center().toPoint())
    for lane in timeline.lanes.values():
        lane.set_folded(False)
    judge.look("lanes")
    for lane in timeline.lanes.values():
        judge.hover(lane.plot)
        judge.ask_menus(lane.plot)


def menus(program: Program, judge: Judge) -> None:
    judge.open_menus("menus")
    add = child(program.window, QToolButton, "players_add_button")
    for name, begin in (
        ("expressions", lambda: choose_expression(program.session)),
        ("instruments", add.click),
        ("palette", program.window.show_palette),
    ):
        begin()
        judge.look(name, program.window)
        close_others(program)
    program.window.palette_popup.hide()


def notices(program: Program, judge: Judge) -> None:
    """Show and check a notice, the lines of streaming, and the undo commands."""
    session = program.session
    session.streaming.set(state="no_receiver", lines=session.streaming.planned(session.project, session.players))
    session.notice(Message("midi.empty", {"file": judge.canary.name("notice")}), Severity.ERROR)
    judge.look("notice")
    session.streaming.set(state="off")
    program.window.status._unfold()
    judge.look("notices", program.window)
    close_others(program)
    session.attempt(
        Message("edit.clean_take", {"take": judge.canary.name("step")}), lambda project: set_title(project, "x")
    )
    program.editor.table.refresh()
    judge.open_menus("undo")
    judge.look("history")
    session.document.undo()


def dialogs(program: Program, judge: Judge) -> None:
    for action_id in DIALOGS:
        program.editor.table.refresh()
        actions(program.session)[action_id].trigger()
        shown = [widget for widget in QApplication.topLevelWidgets() if widget.isVisible()]
        assert len(shown) > 1, action_id
        judge.look(action_id, program.window)
        close_others(program)
    figure = read_character(CHARACTER).figure
    bones = tuple(f"{number} {judge.canary.name('bone')}" for number in range(len(figure.bone_names)))
    figure = dataclasses.replace(figure, bone_names=bones)
    path, name = Path(f"{judge.canary.file_name('figure')}.vrm"), judge.canary.name("player")
    CharacterDialog(program.session, path, figure, CharacterDraft(name), name, program.window).show()
    judge.look("character", program.window)
    close_others(program)


def questions(program: Program, judge: Judge) -> None:
    """Check message boxes that wait for an answer."""
    asked, name = DialogQuestions(), judge.canary.name

    def answer(state: str) -> None:
        judge.look(state, program.window)
        box = QApplication.activeModalWidget()
        box.close()

    steps: tuple[tuple[str, Callable[[], object]], ...] = (
        ("asked", lambda: asked.unsaved(name("asked"))),
        ("removed", lambda: asked.remove_character(name("removed"), (name("player"),))),
        ("replaced", lambda: _may_replace("Export", Path(judge.canary.file_name("replaced")))),
        ("files", lambda: asked.open_file("Open", str(judge.canary.folder.parent), "*")),
    )
    for state, ask in steps:
        QTimer.singleShot(100, program.window, lambda state=state: answer(state))
        ask()


@pytest.mark.drawn
def test_no_name_from_a_file_is_taken_for_html(walked: Program, watched: Canary, tmp_path: Path) -> None:
    judge = Judge(watched)
    start_page(walked, judge, tmp_path)
    piece(walked, judge, tmp_path)
    selections(walked, judge)
    menus(walked, judge)
    notices(walked, judge)
    dialogs(walked, judge)
    questions(walked, judge)
    assert not judge.faults, "\n".join(judge.faults)
    assert judge.seen >= SHOWN, SHOWN - judge.seen


def test_unsaved_work_whose_title_is_html_is_offered_and_opened(
    start: Start, watched: Canary, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    """A title that crashes the editor would do so at every start."""
    title = watched.name("title")
    first = start()
    first.editor.files.begin()
    edit(first, title)
    later(first, monkeypatch)
    crash(first)
    for _ in range(2):
        second = start()
        cards = [label.text() for label in second.window.start_page.findChildren(QLabel) if title in label.text()]
        assert len(cards) == 1
        second.window.hide()
    second.window.show()
    click(second, "recover", qtbot)
    assert second.session.project.score.title == title
    assert watched.opened() == []
