"""Keys of the timeline for events, compared with the project."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QMenu
from pytestqt.qtbot import QtBot

from app.editor import additions
from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.editor.settings import Settings
from app.errors import Message
from app.plan.by_hand.corrections import AddExpression, AddGesture, PinFingering, RemoveEvent, SetBreath, SetCue
from app.plan.model import Problem
from app.project.edit import events as edit
from app.score.model import Note
from app.shell.actions import ActionTable
from app.shell.commands import edit as undoing
from app.shell.commands import events, fingerings, problems
from tests.gui.japanese import speaking
from tests.gui.timeline.lane_hands import front_plan, shown_panel
from tests.support.windows import child, show_in_front
from widgets.common.actions import actions
from widgets.common.chip import Chip
from widgets.common.event_names import expression_name, gesture_name, style_name
from widgets.common.text import message_text
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.panel import TimelinePanel


@pytest.fixture
def panel(session: Session, qtbot: QtBot, tmp_path: Path) -> Iterator[TimelinePanel]:
    result = shown_panel(session)
    qtbot.addWidget(result)
    all_rows = [*undoing.ACTIONS, *events.ACTIONS, *fingerings.ACTIONS, *problems.ACTIONS]
    table = ActionTable(session, Settings(tmp_path / "editor.toml"), all_rows)
    table.attach("timeline", result)
    table.refresh()
    show_in_front(result)
    result.lanes["fingering"].plot.setFocus()
    yield result
    table.deleteLater()


def press(panel: TimelinePanel, key: Qt.Key, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    """Press a key with the focus in the timeline."""
    QApplication.processEvents()
    QTest.keyClick(panel.lanes["fingering"].plot, key, modifiers)
    QApplication.processEvents()


def corrections(session: Session) -> tuple[object, ...]:
    return session.project.corrections.get(session.player.id, ())


def notes(session: Session) -> tuple[Note, ...]:
    assert session.player is not None
    return session.project.part(session.player).notes


def note_with(session: Session, *labels: str) -> Note:
    """A note that can be played with these fingerings."""
    assert session.player is not None
    instrument = session.performance.instrument(session.player)
    return next(
        note
        for note in notes(session)
        if set(labels) <= {fingering.label for fingering in instrument.fingerings_for(note.pitch)}
    )


def labels_of(session: Session, note: Note) -> set[str]:
    """Fingerings of a note except for obsolete ones."""
    assert session.player is not None
    instrument = session.performance.instrument(session.player)
    return {fingering.label for fingering in instrument.offered_for(note.pitch, "")}


def choose(session: Session, *chosen: Note) -> None:
    session.select(Selection(notes=frozenset(note.id for note in chosen)))


# Adding


def test_b_adds_a_breath_before_the_selected_note(panel: TimelinePanel, session: Session) -> None:
    taken = {event.id for event in front_plan(session).breaths}
    note = next(note for note in notes(session)[2:] if f"breath:{note.id}" not in taken)
    choose(session, note)
    press(panel, Qt.Key.Key_B)
    (item,) = corrections(session)
    assert isinstance(item, SetBreath)
    assert item.note_id == note.id
    assert session.selection == Selection(
        events=frozenset({EventKey(front_plan(session).player_id, f"breath:{note.id}")})
    )


def test_b_where_a_breath_is_already_selects_it_and_says_so(panel: TimelinePanel, session: Session) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    breath = next(event for event in front_plan(session).breaths if event.draws_air)
    session.set_playhead((breath.start_s + breath.end_s) / 2)
    press(panel, Qt.Key.Key_B)
    assert session.selection.events == {EventKey(front_plan(session).player_id, breath.id)}
    assert [message.id for message in reported] == ["edit.is_there"]
    assert not session.document.done


def test_b_adds_a_breath_at_the_playhead(panel: TimelinePanel, session: Session) -> None:
    taken = {event.id for event in front_plan(session).breaths}
    note = next(note for note in notes(session)[2:] if f"breath:{note.id}" not in taken)
    session.set_playhead(session.project.score.tempo_map.seconds(float(note.onset_tick)) - 0.02)
    press(panel, Qt.Key.Key_B)
    (item,) = corrections(session)
    assert isinstance(item, SetBreath)
    assert item.note_id == note.id


def test_c_adds_a_cue(panel: TimelinePanel, session: Session) -> None:
    note = notes(session)[8]
    choose(session, note)
    press(panel, Qt.Key.Key_C)
    (item,) = corrections(session)
    assert isinstance(item, SetCue)
    assert (item.note_id, item.added) == (note.id, True)


def popup() -> QMenu:
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    return menu


def test_g_offers_gestures_over_the_selection(panel: TimelinePanel, session: Session) -> None:
    chosen = notes(session)[4:7]
    choose(session, *chosen)
    press(panel, Qt.Key.Key_G)
    menu = popup()
    next(action for action in menu.actions() if action.objectName() == "gesture.bell_height").trigger()
    menu.close()
    (item,) = corrections(session)
    assert isinstance(item, AddGesture)
    assert (item.kind, item.start_tick, item.end_tick) == ("bell_height", chosen[0].onset_tick, chosen[-1].end_tick)


def test_x_offers_expressions(panel: TimelinePanel, session: Session) -> None:
    session.select(Selection(span=(960, 2880)))
    press(panel, Qt.Key.Key_X)
    menu = popup()
    next(action for action in menu.actions() if action.objectName() == "expression_strained").trigger()
    menu.close()
    (item,) = corrections(session)
    assert isinstance(item, AddExpression)
    assert (item.expression, item.start_tick, item.end_tick) == ("strained", 960, 2880)


def test_at_the_end_the_user_is_shown_why_not(panel: TimelinePanel, session: Session) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    session.set_playhead(session.performance.time_frame.end_s)
    press(panel, Qt.Key.Key_B)
    assert [message.id for message in reported] == ["edit.no_note_to_breathe_for"]
    assert not session.document.done


# Fingerings


def test_digits_typed_together_are_one_fingering_and_one_step(panel: TimelinePanel, session: Session) -> None:
    note = note_with(session, "0", "13")
    choose(session, note)
    press(panel, Qt.Key.Key_1)
    press(panel, Qt.Key.Key_3)
    assert corrections(session) == (PinFingering(note.id, "13"),)
    assert len(session.document.done) == 1
    assert next(e for e in front_plan(session).fingerings if e.note_id == note.id).label == "13"


def test_a_first_digit_that_is_a_fingering_is_pinned_at_once(session: Session) -> None:
    assert session.performance.plans is not None
    note = note_with(session, "12", "3")
    choose(session, note)
    fingerings.type_fingering(session, "3", now_s=10.0)
    assert corrections(session) == (PinFingering(note.id, "3"),)
    fingerings.type_fingering(session, "2", now_s=13.0)
    assert corrections(session) == (PinFingering(note.id, "3"),)
    fingerings.type_fingering(session, "1", now_s=13.3)
    assert corrections(session) == (PinFingering(note.id, "12"),)
    assert len(session.document.done) == 2


def test_a_slide_with_a_trigger_is_typed_too(session: Session) -> None:
    slide_player = next(
        player
        for player in session.project.players
        if any(control.label == "T" for control in session.performance.instrument(player).controls)
    )
    session.set_players((slide_player.id,))
    assert session.performance.plans is not None
    note = note_with(session, "T3")
    choose(session, note)
    fingerings.type_fingering(session, "T", now_s=1.0)
    fingerings.type_fingering(session, "3", now_s=1.2)
    assert corrections(session) == (PinFingering(note.id, "T3"),)


def test_what_is_no_fingering_is_said(session: Session) -> None:
    assert session.performance.plans is not None
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    choose(session, note_with(session, "0", "13"))
    fingerings.type_fingering(session, "7", now_s=1.0)
    assert [message.id for message in reported] == ["edit.no_such_fingering"]
    assert not session.document.done


def test_what_does_not_fit_is_said_beside_the_note_with_what_does(panel: TimelinePanel, session: Session) -> None:
    """1 and 3 are 13 although 1 alone would fit; no pin of 1 alone remains."""
    lane = panel.lanes["fingering"]
    assert isinstance(lane, FingeringLane)
    note = next(note for note in notes(session) if labels_of(session, note) & {"1", "13"} == {"1"})
    choose(session, note)
    before = session.project
    panel.axis.show(-1.0, 19.0)
    for key in (Qt.Key.Key_1, Qt.Key.Key_3):
        press(panel, key)
    assert session.project is before
    assert not session.document.done
    assert lane.alternates.isVisible()
    why = child(lane.alternates, QLabel, "why")
    assert why.isVisible()
    assert "13" in why.text()
    assert {chip.text() for chip in lane.alternates.findChildren(Chip) if chip.isVisible()} == labels_of(session, note)
    QTest.mouseClick(child(lane.alternates, Chip, "chip_1"), Qt.MouseButton.LeftButton)
    assert corrections(session) == (PinFingering(note.id, "1"),)


def test_what_is_shown_again_while_it_is_shown_has_its_room(panel: TimelinePanel, session: Session) -> None:
    """Neither 1 nor 2 fits: the message appears at the first key, and again at the second."""
    lane = panel.lanes["fingering"]
    assert isinstance(lane, FingeringLane)
    choose(session, next(note for note in notes(session) if not labels_of(session, note) & {"1", "12", "2"}))
    panel.axis.show(-1.0, 19.0)
    for key in (Qt.Key.Key_1, Qt.Key.Key_2):
        press(panel, key)
        shown = lane.alternates
        assert shown.isVisible()
        parts = [child(shown, QLabel, "why"), *(chip for chip in shown.findChildren(Chip) if chip.isVisible())]
        assert len(parts) > 1
        for part in parts:
            assert part.height() >= part.sizeHint().height(), (key, part.objectName())
            assert part.width() >= part.sizeHint().width(), (key, part.objectName())
            assert shown.rect().contains(part.geometry()), (key, part.objectName())


def test_a_fingering_typed_without_a_note_is_said(panel: TimelinePanel, session: Session) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    session.select(Selection())
    press(panel, Qt.Key.Key_1)
    assert [message.id for message in reported] == ["edit.no_note_to_finger"]


def test_f_cycles_the_alternates_and_backspace_returns(panel: TimelinePanel, session: Session) -> None:
    note = note_with(session, "0", "13")
    choose(session, note)
    first = next(e for e in front_plan(session).fingerings if e.note_id == note.id).label
    press(panel, Qt.Key.Key_F)
    assert isinstance(corrections(session)[0], PinFingering)
    assert next(e for e in front_plan(session).fingerings if e.note_id == note.id).label != first
    press(panel, Qt.Key.Key_Backspace)
    assert corrections(session) == ()
    assert next(e for e in front_plan(session).fingerings if e.note_id == note.id).label == first


# Taking away


def test_delete_removes_events_and_backspace_brings_them_back(panel: TimelinePanel, session: Session) -> None:
    plan = front_plan(session)
    breath = [event for event in plan.breaths if event.kind == "breath"][2]
    key = EventKey(plan.player_id, breath.id)
    session.select(Selection(events=frozenset({key})))
    press(panel, Qt.Key.Key_Delete)
    (item,) = corrections(session)
    assert isinstance(item, RemoveEvent)
    assert breath.id not in edit.events_of(front_plan(session))
    assert not session.selection
    session.select(Selection(events=frozenset({key})))
    press(panel, Qt.Key.Key_Backspace)
    assert corrections(session) == ()


def test_delete_erases_selected_notes(panel: TimelinePanel, session: Session) -> None:
    gone = notes(session)[3]
    choose(session, gone)
    press(panel, Qt.Key.Key_Delete)
    assert gone.id not in {note.id for note in notes(session)}
    session.document.undo()
    assert gone in notes(session)


def test_all_corrections_of_a_player_are_reverted_in_one_step(panel: TimelinePanel, session: Session) -> None:
    choose(session, *notes(session)[5:8])
    actions(session)["gesture.sway"].trigger()
    choose(session, notes(session)[9])
    actions(session)["events.cue"].trigger()
    assert len(corrections(session)) == 2
    QApplication.processEvents()
    actions(session)["events.give_back_player"].trigger()
    assert corrections(session) == ()
    session.document.undo()
    assert len(corrections(session)) == 2


def test_a_preparation_is_turned_off_and_on(panel: TimelinePanel, session: Session) -> None:
    plan = front_plan(session)
    prepared = next(event for event in plan.breaths if event.kind == "preparation")
    breath = prepared.id.replace("preparation", "breath")
    session.select(Selection(events=frozenset({EventKey(plan.player_id, breath)})))
    press(panel, Qt.Key.Key_B, Qt.KeyboardModifier.ShiftModifier)
    assert prepared.id not in edit.events_of(front_plan(session))
    press(panel, Qt.Key.Key_B, Qt.KeyboardModifier.ShiftModifier)
    assert corrections(session) == ()


# Problems


def test_f8_walks_through_the_problems_of_all_players(panel: TimelinePanel, session: Session) -> None:
    # A pinned fingering that does not exist is a problem of that note.
    requested = []
    for player in session.project.players[1:3]:
        note = session.project.part(player).notes[4]
        requested.append((player.id, note.id))
        session.attempt(
            Message("edit.pin_fingerings", {"count": 1, "of": ""}),
            lambda project, player=player, note=note: edit.pin_fingerings(project, player.id, {note.id: "99"}),
        )
    all_of_them = problems.problems(session)
    assert {(player, problem.note_id) for player, problem in all_of_them} >= set(requested)
    revealed: list[float] = []
    session.revealed.connect(revealed.append)
    session.set_playhead(-100.0)
    visited: list[Problem] = []
    QApplication.processEvents()
    for player_id, problem in all_of_them:
        actions(session)["problems.next"].trigger()
        assert session.players[0] == player_id
        if problem.note_id is not None:
            assert session.selection.notes == {problem.note_id}
        visited.append(problem)
    assert revealed == [problem.start_s for problem in visited]
    actions(session)["problems.next"].trigger()
    assert session.players[0] == all_of_them[0][0]
    actions(session)["problems.previous"].trigger()
    assert session.players[0] == all_of_them[-1][0]


def test_without_problems_it_says_so(session: Session) -> None:
    assert session.performance.plans is not None
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    if not problems.problems(session):
        problems.step_problems(session, 1)
        assert [message.id for message in reported] == ["problems.none"]


def test_rows_that_make_no_sense_now_are_off(panel: TimelinePanel, session: Session) -> None:
    QApplication.processEvents()
    assert not actions(session)["fingering.cycle"].isEnabled()
    assert not actions(session)["edit.delete"].isEnabled()
    assert not actions(session)["events.give_back"].isEnabled()
    choose(session, notes(session)[0])
    QApplication.processEvents()
    assert actions(session)["fingering.cycle"].isEnabled()
    assert not actions(session)["events.give_back"].isEnabled()


def test_the_history_names_what_was_added_whose_and_where(panel: TimelinePanel, session: Session) -> None:
    first, second = session.project.players[:2]
    label, ticks = session.project.metre_map.label, session.project.metre_map.tick_of_bar(3)
    spans = [(session.performance.plan(one), ticks, ticks + 960) for one in (first, second)]
    at, both = f"{first.name} · {label(ticks)}", f"{first.name}, {second.name} · {label(ticks)}"
    bare = next(
        note for note in notes(session) if not any(note.id in breath.id for breath in front_plan(session).breaths)
    )

    def by_key(key: Qt.Key) -> str:
        session.select(Selection(frozenset({bare.id})))
        press(panel, key)
        return f"{first.name} · {label(bare.onset_tick)}"

    adding: tuple[tuple[Callable[[], object], str, str], ...] = (
        (lambda: by_key(Qt.Key.Key_B), "Add Breath ({of})", "ブレスを追加（{of}）"),
        (lambda: by_key(Qt.Key.Key_C), "Add Cue ({of})", "合図を追加（{of}）"),
        (
            lambda: additions.add_gestures(session, "tap", spans[:1]),
            f"Add Gesture Toe Tap ({at})",
            f"ジェスチャー「つま先で拍を取る」を追加（{at}）",
        ),
        (
            lambda: additions.add_named_gestures(session, "head_shake", spans),
            f"Add Gesture {gesture_name('head_shake')} ({both})",
            f"を追加（{both}）",
        ),
        (
            lambda: additions.add_expressions(session, "smile", spans),
            f"Add Expression {expression_name('smile')} ({both})",
            f"を追加（{both}）",
        ),
        (
            lambda: additions.add_styles(session, "soloist", spans[:1]),
            f"Add Style {style_name('soloist')} ({at})",
            f"の区間を追加（{at}）",
        ),
    )
    for add, english, japanese in adding:
        before = len(session.document.done)
        of = add()
        assert len(session.document.done) == before + 1, english
        name = session.document.done[-1].name
        assert message_text(name, session) == english.format(of=of)
        with speaking():
            assert message_text(name, session).endswith(japanese.format(of=of))
