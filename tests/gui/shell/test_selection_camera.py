"""The camera follows selected or corrected objects if the setting is on: hands, mouth, feet, or the whole player."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest

from app.editor.problems import go_to_problem, view_of_event
from app.editor.selection import EventKey, Selection
from app.editor.viewport_state import Follows
from app.errors import Message
from app.plan.kinds import BREATHS, GESTURES
from app.plan.model import Problem
from app.project.edit.events import pin_fingerings
from app.shell.app import Program
from app.shell.selection_camera import SelectionCamera
from tests.gui.shell.conftest import Start
from tests.support.windows import child, pause, wait_until
from widgets.common.actions import actions


def _settled(program: Program, view: str) -> bool:
    return wait_until(lambda: program.session.viewport.view == view)


def _breath(program: Program, number: int) -> EventKey:
    player = program.session.project.players[number]
    return EventKey(player.id, program.session.plans[player.id].breaths[1].id)


def _fingering(program: Program, number: int) -> EventKey:
    player = program.session.project.players[number]
    return EventKey(player.id, program.session.plans[player.id].fingerings[1].id)


def _wait(program: Program) -> str:
    """Wait until the camera has moved if it will, and return the view."""
    soon = child(program.session, SelectionCamera)._soon
    wait_until(lambda: not soon.isActive())
    return program.session.viewport.view


def test_a_click_on_a_note_brings_the_hands_when_it_may_always(program: Program) -> None:
    session, timeline = program.session, program.window.timeline
    actions(session)["viewport.camera_follows_always"].trigger()
    assert session.player is not None
    note = session.project.part(session.player).notes[2]
    timeline.reveal(session.project.score.tempo_map.seconds(float(note.onset_tick)))
    x = timeline.axis.x_px(session.project.score.tempo_map.seconds(float(note.onset_tick))) + 3
    y = (timeline.roll.y_px(note.pitch) + timeline.roll.y_px(note.pitch + 1)) / 2
    QTest.mouseClick(timeline.roll.plot, Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))
    assert session.selection.notes == {note.id}
    assert _settled(program, "hands")


@pytest.mark.parametrize(
    ("follows", "before", "after"),
    [
        *(("always", view, "mouth") for view in ("ensemble", "side", "hands")),
        *(("close_ups", "hands", "mouth"), ("close_ups", "ensemble", "ensemble"), ("close_ups", "side", "side")),
        ("never", "hands", "hands"),
    ],
)
def test_a_breath_of_another_player(program: Program, follows: Follows, before: str, after: str) -> None:
    session = program.session
    session.viewport.set(camera_follows=follows)
    session.viewport.set_view(before)
    session.set_playhead(7.0)
    key = _breath(program, 2)
    session.select(Selection(events=frozenset({key})))
    assert _wait(program) == after
    breath = next(event for event in session.plans[key.player_id].breaths if event.id == key.event_id)
    assert session.playhead_s == (breath.start_s if before != after else 7.0)
    moves = before != after
    assert (session.players[0] == session.project.players[2].id) is moves


def test_a_correction_without_a_selection_is_shown_and_undo_is_not(program: Program) -> None:
    session = program.session
    session.viewport.set(camera_follows="always")
    other, player = session.project.players[:2]
    session.set_players((other.id, player.id))
    note = session.project.part(player).notes[3]
    session.apply(
        Message("edit.pin_fingerings", {"count": 1, "of": ""}),
        pin_fingerings(session.project, player.id, {note.id: "1-3"}),
    )
    assert _settled(program, "hands")
    assert session.players[0] == player.id
    session.viewport.set_view("ensemble")
    session.document.undo()
    assert _wait(program) == "ensemble"


def test_an_edit_of_a_player_who_is_not_selected_moves_nothing(program: Program) -> None:
    """A conductor's cue is edited in the lane of a player who receives it."""
    session = program.session
    session.viewport.set(camera_follows="always")
    front, other = session.players, session.project.players[1]
    note = session.project.part(other).notes[3]
    pinned = pin_fingerings(session.project, other.id, {note.id: "1-3"})
    session.apply(Message("edit.pin_fingerings", {"count": 1, "of": ""}), pinned)
    assert _wait(program) == "ensemble"
    assert session.players == front


def test_it_stays_while_a_button_is_down_or_the_piece_plays(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    session = program.session
    session.viewport.set(camera_follows="always")
    down = [Qt.MouseButton.LeftButton]
    monkeypatch.setattr(QGuiApplication, "mouseButtons", lambda: down[0])
    session.select(Selection(events=frozenset({_breath(program, 0)})))
    pause(150)
    assert session.viewport.view == "ensemble"
    down[0] = Qt.MouseButton.NoButton
    assert _settled(program, "mouth")
    session.set_playing(True)
    session.select(Selection(events=frozenset({_fingering(program, 0)})))
    assert _wait(program) == "mouth"
    session.set_playing(False)


def test_a_problem_chooses_its_camera_itself(program: Program) -> None:
    session = program.session
    session.viewport.set(camera_follows="always")
    player = session.project.players[0]
    note = session.project.part(player).notes[3]
    go_to_problem(session, player.id, Problem(Message("contact.lips_off", {"gap_mm": 12}), note.id, 2.0, 3.0))
    assert _wait(program) == "mouth"


def test_the_choice_is_remembered(start: Start) -> None:
    actions(start().session)["viewport.camera_follows_never"].trigger()
    assert start().session.viewport.camera_follows == "never"


def test_every_kind_that_has_a_body_is_shown() -> None:
    views = {kind.id: view_of_event(f"{kind.id}:1") for kind in (*GESTURES, *BREATHS)}
    assert None not in views.values()
    assert (views["tap"], views["breath"], views["preparation"], views["nod"]) == ("feet", "mouth", "front", "front")


def test_players_selected_after_a_note_remain_selected(program: Program) -> None:
    session = program.session
    session.viewport.set(camera_follows="always")
    first, second = session.project.players[:2]
    session.select(Selection(notes=frozenset({session.project.part(first).notes[2].id})))
    session.set_players((second.id,))
    _wait(program)
    assert session.players == (second.id,)
