"""A timeline of a scale over four bars: quarters from C4 upwards, and a second player a third below."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.settings import Settings
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.model import Project
from app.project.performers import Player
from app.project.snap_grid import Grid
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from app.shell.actions import ActionTable
from app.shell.commands import edit, events, notes, timeline
from tests.gui.timeline.hand import Hand, Place
from tests.gui.timeline.lane_hands import shown_panel
from tests.support.tasks import ImmediateTasks
from tests.support.windows import show_in_front
from widgets.timeline.panel import TimelinePanel
from widgets.timeline.roll.piano_roll import PianoRoll

TPQ = 480
SCALE = (60, 62, 64, 65, 67, 69, 71, 72)


def scale_project() -> Project:
    """Eight quarters each; the second player a third lower, in the same rhythm."""
    parts = tuple(
        Part(
            f"{track}.1.1",
            name,
            track - 1,
            0,
            0,
            None,
            None,
            "trumpet_Bb",
            tuple(Note(f"{track}:{i}", TPQ * i, TPQ - 40, pitch - lower, 80) for i, pitch in enumerate(SCALE)),
        )
        for track, name, lower in ((1, "First", 0), (2, "Second", 3))
    )
    players = tuple(
        Player(f"p{part.id}", part.name, part.id, "trumpet_Bb", "maria", PlayerParameters(), StagePosition(0, 0, 0))
        for part in parts
    )
    return Project(Score("Scale", TPQ, TempoMap(TPQ), parts=parts), players)


@dataclass
class Stage:
    """The timeline with mouse actions."""

    session: Session
    panel: TimelinePanel
    table: ActionTable

    @property
    def roll(self) -> PianoRoll:
        return self.panel.roll

    @property
    def hand(self) -> Hand:
        return Hand(self.roll.plot)

    def place(self, tick: float, pitch: float) -> Place:
        """Pixel position in the roll, in the middle of a pitch's row."""
        seconds = self.session.project.score.tempo_map.seconds(float(tick))
        return self.roll.axis.x_px(seconds), self.roll.y_px(pitch + 0.5)

    def note(self, note_id: str) -> Note:
        return next(note for part in self.session.project.score.parts for note in part.notes if note.id == note_id)

    def middle(self, note_id: str) -> Place:
        note = self.note(note_id)
        return self.place(note.onset_tick + note.duration_tick / 2, note.pitch)

    def end(self, note_id: str) -> Place:
        note = self.note(note_id)
        x, y = self.place(note.end_tick, note.pitch)
        return x - 2, y

    def do(self, action_id: str) -> None:
        self.table.refresh()
        action = self.table.actions[action_id]
        assert action.isEnabled(), action_id
        action.trigger()

    @property
    def steps(self) -> list[str]:
        return [step.name.id for step in self.session.document.done]

    @property
    def selected(self) -> set[str]:
        return set(self.session.selection.notes)


@pytest.fixture
def stage(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> Iterator[Stage]:
    session = Session(scale_project(), ImmediateTasks())
    table = ActionTable(
        session, Settings(tmp_path / "editor.toml"), [*edit.ACTIONS, *events.ACTIONS, *notes.ACTIONS, *timeline.ACTIONS]
    )
    panel = TimelinePanel(session)
    qtbot.addWidget(panel)
    table.attach("timeline", panel)
    panel.resize(1200, 700)
    show_in_front(panel)
    panel.axis.show(-0.5, 6.0)
    session.set_grid(Grid(Fraction(1, 4)))
    panel.setFocus()
    yield Stage(session, panel, table)
    session.timeline_view = None
    session.deleteLater()


@pytest.fixture
def panel(session: Session, qtbot: QtBot) -> TimelinePanel:
    """Timeline of the bundled quartet, with space for all lanes and plans that follow the project."""
    result = shown_panel(session)
    qtbot.addWidget(result)
    result.axis.show(-3.0, 27.0)
    return result
