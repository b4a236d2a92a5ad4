"""CPU per repaint of the timeline over 50 players and 100,000 notes: pan, zoom, select, drag, play. Printed only."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from statistics import median

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.parameters import PlayerParameters
from app.project.casting import Footprint, stage_seats
from app.project.edit import notes
from app.project.model import Project
from app.project.performers import Player
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from tests.support.tasks import ImmediateTasks
from widgets.timeline.panel import TimelinePanel

PLAYERS, NOTES, TPQ = 50, 2000, 480
FRAMES = 41


def calibration() -> None:
    """A fixed piece of numpy and Python work."""
    a = np.random.default_rng(1).normal(size=20000)
    for _ in range(20):
        np.sort(a)
        sum(range(5000))


def crowd() -> Project:
    """Eighths in every part, within an octave around a pitch of its own."""
    random = np.random.default_rng(3)
    parts = []
    for number in range(PLAYERS):
        middle = 58 + number % 12
        pitches = middle + random.integers(0, 12, NOTES)
        velocities = random.integers(30, 120, NOTES)
        line = tuple(
            Note(f"{number + 1}:{i}", i * TPQ // 2, TPQ // 2 - 20, int(pitch), int(velocity))
            for i, (pitch, velocity) in enumerate(zip(pitches, velocities, strict=True))
        )
        parts.append(Part(f"{number + 1}.1.1", f"Player {number}", number, 0, 0, None, None, "trumpet_Bb", line))
    players = tuple(
        Player(part.id, part.name, part.id, "trumpet_Bb", "maria", PlayerParameters(), place)
        for part, place in zip(parts, stage_seats((Footprint(),) * PLAYERS), strict=True)
    )
    return Project(Score("Crowd", TPQ, TempoMap(TPQ), parts=tuple(parts)), players)


@pytest.fixture(scope="module")
def project() -> Project:
    return crowd()


@pytest.fixture
def panel(qapp: QApplication, qtbot: QtBot, project: Project) -> Iterator[TimelinePanel]:
    session = Session(project, ImmediateTasks())
    performance = Performance(project)
    performance.plans  # noqa: B018 - made, as the shell does
    session.set_performance(performance)
    panel = TimelinePanel(session)
    qtbot.addWidget(panel)
    panel.resize(1600, 700)
    panel.show()
    qtbot.waitExposed(panel)
    yield panel
    session.timeline_view = None
    session.deleteLater()


def settle() -> None:
    QApplication.processEvents()
    QCoreApplication.sendPostedEvents(None, 0)
    QApplication.processEvents()


def cpu_ms(act: Callable[[int], None]) -> float:
    """Median CPU of a change and the drawing that follows."""
    spent = []
    for number in range(FRAMES):
        start = time.process_time()
        act(number)
        settle()
        spent.append(time.process_time() - start)
    return 1000 * median(spent)


@pytest.mark.bench
def test_repaint(panel: TimelinePanel) -> None:
    session, axis = panel.session, panel.axis
    unit = []
    for _ in range(5):
        start = time.process_time()
        calibration()
        unit.append(time.process_time() - start)
    unit_ms = 1000 * median(unit)
    lowest, highest = axis.limits_s
    ids = [note.id for note in session.project.score.parts[0].notes]

    def pan(number: int) -> None:
        axis.pan(axis.span_s * 0.03 * (1 if number % 20 < 10 else -1))

    def zoom(number: int) -> None:
        axis.zoom(1.1 if number % 2 else 1 / 1.1, (axis.start_s + axis.end_s) / 2)

    def select(number: int) -> None:
        session.select(Selection(frozenset(ids[number : number + 200])))

    def drag(number: int) -> None:
        chosen = frozenset(ids[:200])
        session.apply(
            Message("edit.move_notes", {"count": 200, "of": ""}), notes.move(project, chosen, 10 * number + 1, 0), token
        )

    def play(number: int) -> None:
        session.set_playhead(axis.start_s + axis.span_s * (0.1 + 0.01 * number))

    print(f"\ncalibration loop {unit_ms:.1f} ms; {PLAYERS * NOTES} notes")
    for name, span_s in (("20 s", 20.0), ("2 min", 120.0), ("whole piece", highest - lowest)):
        axis.show(100.0, 100.0 + span_s)
        settle()
        for act in (pan, zoom, select, drag, play) if span_s < highest - lowest else (zoom, select, drag, play):
            project, token = session.project, object()
            spent = cpu_ms(act)
            session.document.end_gesture()
            if session.project is not project:
                session.document.undo()
            session.set_playing(False)
            axis.show(100.0, 100.0 + span_s)
            settle()
            print(f"{name:>12} {act.__name__:>7}: {spent:6.1f} ms of CPU a frame, {spent / unit_ms:5.2f} of the loop")
