"""Every action of the table is done at least once in the whole window; none of them ends in a fault."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QDialog, QMenu
from pytestqt.qtbot import QtBot

from app.plan.model import PlayerPlan
from app.shell.app import Program
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers
from widgets.common.selection import EventKey, Selection

LAST = ("file.close", "file.new", "file.open", "file.import_midi", "file.open_example", "file.quit")
"""These take the piece away."""

GREYED = frozenset(
    (
        *("edit.undo", "edit.redo", "events.give_back", "events.give_back_player", "generate.bars_back"),
        *("players.hear_everyone", "problems.next", "problems.previous"),
    )
)
"""These make no sense for the quartet as it is."""


def dismiss() -> None:
    """Close whatever asks something."""
    for widget in QApplication.topLevelWidgets():
        if isinstance(widget, QDialog | QMenu) and widget.isVisible():
            widget.close()


def select(program: Program, qtbot: QtBot) -> None:
    """Some notes, a breath and some bars of the player in front."""
    session = program.session
    qtbot.waitUntil(lambda: session.performance.project is session.project, timeout=20_000)
    session.set_players(tuple(player.id for player in session.project.players[:1]))
    player = session.player
    if player is None:
        return
    notes = session.project.part(player).notes
    plan: PlayerPlan = session.performance.plan(player)
    events = frozenset(EventKey(player.id, breath.id) for breath in plan.breaths[:1])
    chosen = frozenset(note.id for note in notes[3:6])
    session.select(Selection(notes=chosen, events=events, span=(notes[3].onset_tick, notes[9].end_tick)))
    session.set_playhead(session.project.score.tempo_map.seconds(float(notes[3].onset_tick + 1)))


def test_every_action_once(program: Program, answers: Answers, qtbot: QtBot) -> None:
    closer = QTimer()
    closer.setInterval(30)
    closer.timeout.connect(dismiss)
    closer.start()
    window, session = program.window, program.session
    answers.path = QUARTET.parent / "no such file.wav"
    answers.answer = "discard"
    table = program.editor.table
    done: set[str] = set()
    ordered = [id for id in table.rows if id not in LAST] + list(LAST)
    for action_id in ordered:
        if not program.editor.files.is_open:
            program.editor.files.open(QUARTET, ask=False)
        while action_id not in LAST and session.document.done:
            session.document.undo()
        select(program, qtbot)
        table.refresh()
        if action_id == "file.save":
            answers.path = None
        if session.actions[action_id].isEnabled():
            session.actions[action_id].trigger()
            done.add(action_id)
            QApplication.processEvents()
        if table.rows[action_id].checked is not None and window.is_full_screen:
            window.set_full_screen(False)
    closer.stop()
    dismiss()
    greyed = {id for id in table.rows if id not in done}
    # Nothing is heard here and nobody is muted, nothing was undone, and the quartet has no problems.
    assert {id for id in greyed if not id.startswith("play.")} <= GREYED, greyed
