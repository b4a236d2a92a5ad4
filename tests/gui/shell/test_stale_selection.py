"""Selected objects that disappear, for instance by undo, are deselected, and no command fails because of them."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.project.edit.notes import erase
from app.project.edit.takes import add_takes
from app.shell.action_rows import rows
from app.shell.app import Program
from tests.gui.shell.conftest import trigger
from tests.support.takes import take_of
from widgets.common.actions import actions

COMMANDS = [
    row.id
    for row in rows()
    if row.id.partition(".")[0] in ("notes", "events", "edit", "gesture", "fingering", "take", "takes", "generate")
    and row.id not in ("edit.undo", "edit.redo")
]


def draw(program: Program) -> Selection:
    session = program.session
    first = session.project.score.parts[0].notes[0]
    session.select(Selection(notes=frozenset((first.id,))))
    trigger(program, "notes.duplicate")
    return session.selection


def breathe(program: Program) -> Selection:
    session = program.session
    session.select(Selection(notes=frozenset((session.project.score.parts[0].notes[3].id,))))
    trigger(program, "events.breath")
    return session.selection


def sway(program: Program) -> Selection:
    trigger(program, "gesture.sway")
    return program.session.selection


def hire(program: Program) -> Selection:
    session = program.session
    trigger(program, "players.add")
    player = session.project.players[-1]
    return Selection(events=frozenset((EventKey(player.id, "sway:1"),)))


def record(program: Program) -> Selection:
    session = program.session
    take = take_of([(0.0, 1.0, 70, 0.6)])
    id = session.player.id
    session.attempt(Message("edit.record", {"count": 1}), lambda project: add_takes(project, id, (take,))[0])
    return Selection(take=take.id)


@pytest.mark.parametrize("lag", [False, True])
def test_undo(program: Program, lag: bool, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    session = program.session
    for make in (draw, breathe, sway, hire, record):
        made = make(program)
        session.select(made)
        assert session.selection == made
        assert made
        with monkeypatch.context() as patch:
            if lag:
                # The plans of what is not there any more stay.
                patch.setattr(session, "set_performance", lambda performance: None)
            trigger(program, "edit.undo")
            if not lag:
                qtbot.waitUntil(lambda: session.performance.project is session.project)
            # Only a plan shows that a breath was not generated.
            assert not session.selection or (lag and make is breathe), make.__name__
            before, steps = session.project, len(session.document.done)
            for id in COMMANDS if lag else ():
                session.select(made)
                program.editor.table.refresh()
                actions(session)[id].trigger()  # what raises in a slot fails the test
                while len(session.document.done) > steps:
                    session.document.undo()
            assert session.project is before


def test_an_event_whose_note_is_gone(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    """The old plan still contains it, and a lane shows it until the next plan."""
    session = program.session
    player = session.project.players[0]
    breath = next(event for event in session.performance.plan(player).breaths if event.id.startswith("breath:"))
    session.select(Selection(events=frozenset((EventKey(player.id, breath.id),))))
    monkeypatch.setattr(session, "set_performance", lambda performance: None)
    note_id = breath.id.partition(":")[2]
    session.attempt(Message("edit.erase_notes", {"count": 1, "of": ""}), lambda project: erase(project, (note_id,)))
    assert not session.selection


def still_selected(session: Session) -> Selection:
    player = session.project.players[0]
    plan = session.performance.plan(player)
    events = (plan.breaths[0], plan.cues[0], plan.gestures[0], plan.expressions[0])
    notes = frozenset(note.id for note in session.project.score.parts[1].notes[:3])
    session.select(Selection(notes, frozenset(EventKey(player.id, event.id) for event in events), (0, 960)))
    return session.selection


def test_what_is_there_stays_selected(program: Program) -> None:
    session = program.session
    chosen = still_selected(session)
    assert len(chosen.events) == 4
    hire(program)
    assert session.selection is chosen
    trigger(program, "edit.undo")
    assert session.selection is chosen
