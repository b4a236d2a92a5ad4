"""The whole editor with settings, recovery folder and answers of the test."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.audio.playback import Playback
from app.editor.design_tokens import Tokens
from app.editor.files import Files
from app.editor.questions import Answer, ReadAgain
from app.editor.recorder import Recorder
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.sound import EditorSound
from app.editor.tasks import Tasks
from app.errors import Message
from app.project.autosave import Autosave
from app.project.importing import ImportRequest, usual_rows
from app.project.running_editors import Presence
from app.score.contents import PieceContents
from app.shell.app import Program
from app.shell.questions import with_suffix
from instrument_maps.load import bundled_maps
from tests.gui.conftest import QUARTET, delete_now
from tests.support.desk import Desk
from tests.support.recorder import EWI, Clock, RunningClock, SpokenFor
from tests.support.studio import Studio
from tests.support.tasks import ImmediateTasks
from tests.support.windows import draw_coarsely, show_in_front
from widgets.common.actions import actions
from widgets.viewport.canvas import Canvas


class Answers:
    """Answers the editor's questions as set by the test, and records them."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.answer: Answer = "cancel"
        self.imports = True
        self.dances = False
        self.asked: list[str] = []
        self.titles: list[str] = []
        """Titles of the file dialogs."""
        self.removes = True
        self.stops = False
        self.works: tuple[Message, ...] = ()
        self.reported_players: tuple[str, ...] = ()

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Path set by the test."""
        self.asked.append("open")
        self.titles.append(title)
        return self.path

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """Path set by the test."""
        self.asked.append("save")
        return with_suffix(self.path, suffixes) if self.path is not None else None

    def unsaved(self, name: str) -> Answer:
        """Answer set by the test."""
        self.asked.append("unsaved")
        return self.answer

    def stop_writing(self, works: tuple[Message, ...]) -> bool:
        """Answer set by the test."""
        self.asked.append("stop_writing")
        self.works = works
        return self.stops

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """Answer set by the test."""
        self.asked.append("remove_character")
        self.reported_players = players
        return self.removes

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """Accept the dialog unchanged."""
        self.asked.append("import")
        return ImportRequest(usual_rows(contents, bundled_maps()), self.dances) if self.imports else None


@pytest.fixture
def answers() -> Answers:
    """Answers that the test gives instead of a user."""
    return Answers()


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Default settings in English, regardless of the system's language."""
    result = Settings(tmp_path / "settings" / "editor.toml")
    result.language = "en"
    return result


@pytest.fixture(autouse=True)
def _drawn(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw players only in tests marked ``drawn``, and generate their motion only in those and in tests marked
    ``moved``. If the processor does OpenGL's work, every change of the window takes up to 100 ms, 60 times as long as
    without.

    Where the processor does OpenGL's work, every change of the window costs up to 100 ms: 60 times as much as without.
    """
    monkeypatch.setattr(Canvas, "on_draw", draw_coarsely)
    marks = {mark.name for mark in request.node.iter_markers()}
    if "drawn" not in marks:
        monkeypatch.setattr("widgets.viewport.panel.why_no_gl", lambda: "not in this test")
        if "moved" not in marks:
            # Judging contacts computes motion, even if no test examines it.
            for making in ("work", "judge"):
                monkeypatch.setattr(f"app.performance.live.LiveMotion.{making}", lambda self, stop_requested: False)


def end(program: Program) -> None:
    """End an editor as by closing its window, and delete its parts."""
    program.window.hide()
    program.end()
    program.generator.deleteLater()
    program.editor.files.end()
    program.editor.language.set("en")
    program.window.deleteLater()
    program.session.deleteLater()


Start = Callable[[], Program]


@pytest.fixture
def start(qtbot: QtBot, qt_app: QApplication, settings: Settings, answers: Answers, tmp_path: Path) -> Iterator[Start]:
    """Function that starts editors, one after another, with common settings and recovery folder."""
    started: list[Program] = []

    def begin() -> Program:
        program = Program(settings, ImmediateTasks(), answers, Autosave(Presence(tmp_path / "recovery")), audible=False)
        show_in_front(program.window)
        started.append(program)
        return program

    yield begin
    for program in started:
        end(program)
    delete_now()


def trigger(program: Program, action_id: str) -> None:
    """Trigger an action if it is enabled."""
    program.editor.table.refresh()
    assert actions(program.session)[action_id].isEnabled(), action_id
    actions(program.session)[action_id].trigger()


@pytest.fixture
def program(start: Start) -> Program:
    """An editor with the quartet open."""
    result = start()
    result.editor.files.open(QUARTET, ask=False)
    return result


@pytest.fixture
def empty(start: Start) -> Program:
    """An editor without an open piece."""
    return start()


@pytest.fixture
def studio(
    qtbot: QtBot, qt_app: QApplication, settings: Settings, answers: Answers, tmp_path: Path
) -> Iterator[Studio]:
    """The editor with an empty piece for trumpet, and a wind controller."""
    made: list[SpokenFor] = []
    clock = Clock()

    def make_link(on_news: Callable[[], None]) -> SpokenFor:
        made.append(SpokenFor(on_news, clock))
        return made[-1]

    def recorder(session: Session, files: Files, settings: Settings, sound: EditorSound) -> Recorder:
        return Recorder(session, files, settings, sound, make_link, clock.now_ns, lambda: Playback(now=clock.now_s))

    settings.midi_port = EWI
    settings.count_in_bars = 0
    program = Program(
        settings,
        ImmediateTasks(),
        answers,
        Autosave(Presence(tmp_path / "recovery")),
        audible=False,
        playback=Playback(now=clock.now_s),
        recorder=recorder,
    )
    sound = program.editor.sound
    program.session.playback = sound.playback
    answers.answer = "discard"
    program.window.show()
    result = Studio(program, tmp_path, clock)
    result.links = made
    program.editor.files.begin()
    actions(program.session)["players.add"].trigger()
    program.recorder.begin_where_remembered()
    result.wait(lambda: program.session.recording.connection == "open")
    yield result
    end(program)


@pytest.fixture
def desk(
    qtbot: QtBot,
    qt_app: QApplication,
    settings: Settings,
    answers: Answers,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> Iterator[Desk]:
    """The whole editor with silent playback."""
    settings.midi_port = EWI
    program = Program(
        settings,
        ImmediateTasks(),
        answers,
        Autosave(Presence(tmp_path / "recovery")),
        audible=False,
        recorder=lambda session, files, settings, sound: Recorder(
            session, files, settings, sound, lambda on_news: SpokenFor(on_news, RunningClock())
        ),
    )
    program.recorder.begin_where_remembered()
    sound = program.editor.sound
    # Playback runs in time without a synthesiser.
    program.session.playback = sound.playback
    show_in_front(program.window)
    yield Desk(program, answers, tmp_path, monkeypatch)
    end(program)
    delete_now()
