"""Event section and lists by mouse and keys, compared with the project."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QTabWidget

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import ChangeExpression, ChangeGesture, PinFingering, PoseCorrection, SetBreath
from app.plan.model import PlayerPlan
from app.project.edit import events as edit
from app.project.edit.corrections import with_corrections
from app.project.performers import Player
from tests.gui.inspector.hands import child, click, click_line, drag, number, show_tab, type_into
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.panel import InspectorPanel
from widgets.inspector.rows import LineList

NAME = Message("edit.give_back", {"of": ""})


def plan(session: Session) -> PlayerPlan:
    return session.performance.plan(session.project.players[0])


def select(session: Session, event_id: str) -> None:
    player = session.project.players[0]
    session.select(Selection(events=frozenset((EventKey(player.id, event_id),))))


def said(session: Session) -> tuple[object, ...]:
    return session.project.corrections.get(session.project.players[0].id, ())


def player(session: Session) -> Player:
    return session.project.players[0]


def test_a_breath_is_made_deeper_and_given_back(panel: InspectorPanel, planned: Session) -> None:
    breath = next(event for event in plan(planned).breaths if event.kind == "breath")
    select(planned, breath.id)
    type_into(number(panel, "event_amount"), "0.4")
    [item] = said(planned)
    assert isinstance(item, SetBreath)
    assert item.depth == 0.4
    line = child(panel, ByHandLine, "event_by_hand")
    assert f"{breath.depth:.2f}" in line.text()
    assert "0.40" in line.text()
    assert number(panel, "event_amount").default == pytest.approx(breath.depth)
    click(line, "revert")
    assert said(planned) == ()


def test_start_and_end_in_bars_and_in_seconds(panel: InspectorPanel, planned: Session) -> None:
    gesture = next(event for event in plan(planned).gestures if event.kind == "bell_height" and event.start_tick > 0)
    select(planned, gesture.id)
    score = planned.project.score
    bar = score.metre_map.bar_of_tick(gesture.start_tick)
    type_into(number(panel, "event_end_tick"), f"{bar + 3}.2")
    [item] = said(planned)
    assert isinstance(item, ChangeGesture)
    assert (
        item.end_tick
        == score.metre_map.tick_of_bar(bar + 3) + 4 * score.ticks_per_quarter // score.metres[0].denominator
    )
    start_s = gesture.start_s - 0.2
    type_into(number(panel, "event_start_s"), f"{start_s:.3f}")
    [item] = said(planned)
    assert isinstance(item, ChangeGesture)
    assert item.start_tick == round(score.tempo_map.ticks(round(start_s, 3)))
    QTest.keyClick(number(panel, "event_end_tick"), Qt.Key.Key_Backspace)
    event = next(event for event in plan(planned).gestures if event.id == gesture.id)
    assert event.end_tick == gesture.end_tick


def test_a_drag_of_the_amount_is_one_step(panel: InspectorPanel, planned: Session) -> None:
    gesture = next(event for event in plan(planned).gestures if event.kind == "sway")
    select(planned, gesture.id)
    drag(number(panel, "event_amount"), -80)
    [item] = said(planned)
    assert isinstance(item, ChangeGesture)
    assert item.amount is not None
    assert item.amount < gesture.amount
    assert len(planned.document.done) == 1


def test_expressions_change_face_strength_and_fades(panel: InspectorPanel, planned: Session) -> None:
    event = next(event for event in plan(planned).expressions if event.expression != "neutral")
    select(planned, event.id)
    combo = child(panel, QComboBox, "event_expression")
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_End)
    type_into(number(panel, "event_amount"), "0.66")
    type_into(number(panel, "event_fade_out_s"), "1.5")
    [item] = said(planned)
    assert isinstance(item, ChangeExpression)
    assert item.expression == combo.itemData(combo.count() - 1)
    assert (item.strength, item.fade_out_s) == (0.66, 1.5)


def test_a_cue_comes_earlier(panel: InspectorPanel, planned: Session) -> None:
    leader = next(one for one in planned.project.players if planned.performance.plan(one).cues)
    cue = planned.performance.plan(leader).cues[0]
    planned.select(Selection(events=frozenset((EventKey(leader.id, cue.id),))))
    type_into(number(panel, "event_beats"), "1.5")
    after = next(event for event in planned.performance.plan(leader).cues if event.id == cue.id)
    assert after.beat_s == pytest.approx(1.5 * cue.beat_s, rel=0.02)
    assert not number(panel, "event_end_tick").isEnabled()


def test_a_pose_is_turned_and_faded(panel: InspectorPanel, planned: Session) -> None:
    owner = player(planned)
    planned.attempt(
        NAME, lambda p: with_corrections(p, owner.id, [PoseCorrection("own-1", "bell", 960, 1920, up_deg=5.0)])
    )
    select(planned, "pose:own-1")
    type_into(number(panel, "event_up_deg"), "-8")
    type_into(number(panel, "event_fade_in_s"), "0.5")
    [item] = said(planned)
    assert isinstance(item, PoseCorrection)
    assert item.up_deg == -8.0
    assert item.fade_in_ticks > 0
    assert "added manually" in child(panel, ByHandLine, "event_by_hand").text()


def lines(panel: InspectorPanel, name: str) -> LineList:
    return child(panel, LineList, name)


def test_handwork_is_listed_opened_and_reverted(panel: InspectorPanel, planned: Session) -> None:
    owner = player(planned)
    notes = planned.project.part(owner).notes
    gesture = plan(planned).gestures[3]
    planned.attempt(NAME, lambda p: edit.pin_fingerings(p, owner.id, {notes[20].id: "123"}))
    planned.attempt(NAME, lambda p: edit.set_amounts(p, plan(planned), {gesture.id: -0.9}))
    planned.attempt(NAME, lambda p: edit.add_gesture(p, owner.id, "sway", 96000, 96480).project)
    show_tab(panel, 1)
    view = lines(panel, "correction_list")
    titles = [line.title for line in view.lines.lines]
    assert len(titles) == 3
    assert "Fingering 123" in titles
    pinned = titles.index("Fingering 123")
    assert "generated" in view.lines.lines[pinned].detail
    revealed: list[float] = []
    planned.revealed.connect(revealed.append)
    click_line(view, pinned)
    assert planned.selection.notes == {notes[20].id}
    assert revealed == [pytest.approx(planned.project.score.tempo_map.seconds(float(notes[20].onset_tick)))]
    click(panel, "revert_selected")
    assert [line.title for line in view.lines.lines] == [title for title in titles if title != "Fingering 123"]
    click(panel, "revert_player")
    assert planned.project.corrections == {}
    assert not view.isVisible()


def test_a_lost_correction_is_attached_to_another_note(panel: InspectorPanel, planned: Session) -> None:
    owner = player(planned)
    note = planned.project.part(owner).notes[7]
    planned.attempt(NAME, lambda p: with_corrections(p, owner.id, [PinFingering("77:7", "12")]))
    show_tab(panel, 1)
    view = lines(panel, "correction_list")
    assert view.lines.lines[0].tone == "warning"
    click_line(view, 0)
    planned.select(Selection(notes=frozenset((note.id,))))
    click(panel, "reattach")
    assert said(planned) == (PinFingering(note.id, "12"),)
    assert view.lines.lines[0].tone == "by_hand"


def test_problems_are_counted_filtered_and_opened(panel: InspectorPanel, planned: Session) -> None:
    owner, other = planned.project.players[:2]
    note = planned.project.part(other).notes[4]
    before = sum(len(planned.problems(player.id)) for player in planned.project.players)
    planned.attempt(NAME, lambda p: with_corrections(p, other.id, [PinFingering(note.id, "no such")]))
    planned.attempt(NAME, lambda p: with_corrections(p, owner.id, [PinFingering("77:7", "12")]))
    tabs = child(panel, QTabWidget, "inspector_tabs")
    assert str(before + 2) in tabs.tabText(0)
    show_tab(panel, 0)
    view = lines(panel, "problem_list")
    assert len(view.lines.lines) == before + 2
    number_of = next(i for i, line in enumerate(view.lines.lines) if "no such" in line.detail)
    click_line(view, number_of)
    assert planned.selection.notes == {note.id}
    assert planned.players == (other.id,)
    who = child(panel, QComboBox, "problems_who")
    who.setFocus()
    QTest.keyClick(who, Qt.Key.Key_Down)
    assert {line.title for line in view.lines.lines} == {other.name}


def test_the_history_goes_back_and_forth(panel: InspectorPanel, planned: Session) -> None:
    owner = player(planned)
    first = planned.project
    for label in ("1", "2", "3"):
        planned.attempt(
            Message("edit.rename_player", {"player": label}),
            lambda p, label=label: with_corrections(p, owner.id, [PinFingering("1:1", label)]),
        )
    last = planned.project
    show_tab(panel, 2)
    view = lines(panel, "history_list")
    assert [line.title for line in view.lines.lines] == ["Opened", "Rename 1", "Rename 2", "Rename 3"]
    assert view.lines.lines[3].tone == "current"
    click_line(view, 0)
    assert planned.project is first
    assert [line.tone for line in view.lines.lines] == ["current", "faint", "faint", "faint"]
    click_line(view, 3)
    assert planned.project is last
    QTest.keyClick(view, Qt.Key.Key_Up)
    QTest.keyClick(view, Qt.Key.Key_Return)
    assert len(planned.document.undone) == 1
