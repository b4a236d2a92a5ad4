"""Arrows of cues in the roll, dragged by mouse and compared with the document."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu

from app.editor.selection import EventKey
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import RemoveEvent, SetCue
from app.plan.model import CueEvent
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.hand import ALT, Place
from tests.gui.timeline.lane_hands import planned
from tests.support.windows import child
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.model.roll.entries import EntryArrow

FIRST, SECOND, THIRD = "p1.1.1", "p2.1.1", "p3.1.1"
START = 4 * TPQ


@pytest.fixture
def trio(stage: Stage) -> Stage:
    """Three players who enter together in the second bar, the third an octave below the first."""
    project = stage.session.project
    parts = []
    for number, part in enumerate((*project.score.parts, project.score.parts[0]), 1):
        notes = tuple(
            msgspec.structs.replace(
                note,
                id=f"{number}:{index}",
                onset_tick=note.onset_tick + START,
                pitch=note.pitch - (12 if number == 3 else 0),
            )
            for index, note in enumerate(part.notes)
        )
        parts.append(msgspec.structs.replace(part, id=f"{number}.1.1", notes=notes))
    third = msgspec.structs.replace(project.players[0], id=THIRD, name="Third", part_id="3.1.1")
    score = msgspec.structs.replace(project.score, parts=tuple(parts))
    stage.session.apply(
        Message("edit.add_player", {"player": "Third"}),
        replace(project, score=score, players=(*project.players, third)),
    )
    performance = Performance(stage.session.project)
    assert performance.plans is not None
    stage.session.set_performance(performance)
    planned(stage.session)
    stage.session.set_players((FIRST,))
    stage.panel.axis.show(0.0, 5.0)
    stage.roll.choose_pitches(42, 76)
    return stage


def cues(stage: Stage) -> list[CueEvent]:
    return [cue for plan in stage.session.plans.values() for cue in plan.cues]


def arrow_to(stage: Stage, taker: str) -> EntryArrow:
    return next(arrow for arrow in stage.roll.entries.arrows if arrow.taker_id == taker)


def head(stage: Stage, arrow: EntryArrow) -> Place:
    """Position in the arrow's head, just before the note."""
    return stage.roll.axis.x_px(arrow.to_s) - 4.0, stage.roll.y_px(arrow.to_pitch + 0.5)


def tail(stage: Stage, arrow: EntryArrow) -> Place:
    return stage.roll.axis.x_px(arrow.from_s), stage.roll.y_px(arrow.from_pitch + 0.5)


def made(stage: Stage) -> int:
    return len(stage.session.document.done)


def test_the_tail_dragged_to_another_players_row_makes_that_player_the_giver(trio: Stage) -> None:
    (cue,) = cues(trio)
    assert (cue.player_id, cue.takers) == (FIRST, (SECOND, THIRD))
    before, steps = trio.session.project, made(trio)
    start = tail(trio, arrow_to(trio, THIRD))
    target = start[0], trio.roll.y_px(57 + 0.5)
    hand = trio.hand
    hand.press(start)
    hand.move((start[0] + 1, (start[1] + target[1]) / 2))
    hand.move(target)
    assert trio.session.project is before, "nothing changes before the button goes up"
    hand.release(target)
    (cue,) = cues(trio)
    assert (cue.player_id, cue.takers) == (SECOND, (FIRST, THIRD))
    assert isinstance(trio.session.project.corrections[FIRST][0], RemoveEvent)
    assert trio.session.selection.events == {EventKey(SECOND, cue.id)}
    assert made(trio) == steps + 1
    trio.session.document.undo()
    assert trio.session.project is before


def test_the_head_dragged_to_another_players_note_brings_in_that_player(trio: Stage) -> None:
    (cue,) = cues(trio)
    before = trio.session.project
    arrow = arrow_to(trio, SECOND)
    third = trio.place(START, 48)
    trio.hand.drag(head(trio, arrow), third)
    (cue,) = cues(trio)
    assert (cue.player_id, cue.takers) == (FIRST, (THIRD,))
    assert trio.session.project.corrections == {FIRST: (SetCue("1:0", 1.0, takers=(THIRD,)),)}
    trio.session.document.undo()
    assert trio.session.project is before


def test_the_head_dragged_along_moves_the_entry_to_the_players_note_there(trio: Stage) -> None:
    arrow = arrow_to(trio, SECOND)
    note = trio.note("2:2")
    x, y = trio.place(note.onset_tick, note.pitch)
    trio.hand.drag(head(trio, arrow), (x + 8.0, y + 3.0))
    (cue,) = cues(trio)
    assert cue.end_tick == note.onset_tick
    assert cue.player_id == FIRST


def test_the_tail_dragged_along_changes_the_preparatory_beat(trio: Stage) -> None:
    arrow = arrow_to(trio, SECOND)
    x, y = tail(trio, arrow)
    by = trio.place(START - 2 * TPQ, 60)[0] - trio.place(START - TPQ, 60)[0]
    trio.hand.drag((x, y), (x + by + 3.0, y))
    (cue,) = cues(trio)
    assert round(trio.session.project.score.tempo_map.ticks(cue.peak_s)) == START - 2 * TPQ
    trio.session.document.undo()
    trio.hand.drag((x, y), (x + by + 7.0, y), ALT)
    (cue,) = cues(trio)
    assert round(trio.session.project.score.tempo_map.ticks(cue.peak_s)) != START - 2 * TPQ


def test_escape_and_empty_ground_change_nothing(trio: Stage) -> None:
    before, steps = trio.session.project, made(trio)
    start = head(trio, arrow_to(trio, SECOND))
    hand = trio.hand
    hand.press(start)
    hand.move(trio.place(START, 48))
    assert trio.roll.entries.dragged is not None
    trio.roll.plot.setFocus()
    QTest.keyClick(trio.roll.plot, Qt.Key.Key_Escape)
    assert trio.roll.entries.dragged is None
    hand.release(trio.place(START, 48))
    assert (trio.session.project, made(trio)) == (before, steps)
    trio.hand.drag(start, trio.place(2 * TPQ, 74))
    assert (trio.session.project, made(trio)) == (before, steps)
    trio.hand.click(start)
    assert (trio.session.project, made(trio)) == (before, steps)


def test_an_end_under_the_mouse_shows_that_it_can_be_held(trio: Stage) -> None:
    trio.hand.move(head(trio, arrow_to(trio, SECOND)))
    assert trio.roll.plot.cursor().shape() == Qt.CursorShape.OpenHandCursor
    trio.hand.move(trio.place(TPQ, 70))
    assert trio.roll.plot.cursor().shape() == Qt.CursorShape.ArrowCursor


def test_who_comes_in_is_chosen_from_the_menu_of_a_cue(trio: Stage) -> None:
    lane = child(trio.panel, ActingLane)
    lane.set_folded(False)
    lane.refresh()
    region = next(region for region in lane.regions if region.kind == "cue" and not region.guest)

    def takers() -> QMenu:
        menu = QMenu(trio.panel)
        lane.menu_entries(menu, region, lane.mouse_at(lane.box(region).center()))
        return child(menu, QMenu, "takers")

    assert [action.isChecked() for action in takers().actions() if action.isCheckable()] == [True, True]
    takers().actions()[0].trigger()
    assert [cue.takers for cue in cues(trio)] == [(THIRD,)]
    lane.refresh()
    takers().actions()[-1].trigger()
    assert [cue.takers for cue in cues(trio)] == [(SECOND, THIRD)]
