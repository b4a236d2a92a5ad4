"""Fingerings, curves, the recording and problems by mouse and keys, compared with the project."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import msgspec
import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from app.audio.waveform_peaks import Peaks
from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.timeline_view import Tool
from app.errors import Message
from app.plan.by_hand.corrections import PinFingering, SetEmbouchure
from app.plan.model import FingeringEvent
from app.project.edit import breaths_and_cues
from app.project.edit import events as edit
from app.project.recording import AudioTrack
from tests.gui.timeline.lane_hands import CTRL, SHIFT, click, double_click, drag, front_plan, viewport
from tests.support.windows import child
from widgets.common.chip import Chip
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.lanes.recording.waveform import WaveformLane
from widgets.timeline.model.fingerings import slide_places
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.panel import TimelinePanel


@pytest.fixture
def panel(panel: TimelinePanel) -> TimelinePanel:
    panel.axis.show(-1.0, 19.0)
    return panel


def fingering_lane(panel: TimelinePanel) -> FingeringLane:
    return child(panel, FingeringLane)


def curves_lane(panel: TimelinePanel) -> CurvesLane:
    return child(panel, CurvesLane)


def waveform_lane(panel: TimelinePanel) -> WaveformLane:
    return child(panel, WaveformLane)


def place_of(lane: FingeringLane | CurvesLane, start_s: float, end_s: float) -> QPointF:
    return QPointF(lane.axis.x_px((start_s + end_s) / 2), lane.plot.height() / 2)


def with_alternates(session: Session) -> FingeringEvent:
    """A visible note of the first selected player with several fingerings."""
    player = session.player
    assert player is not None
    pitches = {note.id: note.pitch for note in session.project.part(player).notes}
    instrument = session.performance.instrument(player)
    return next(
        event
        for event in front_plan(session).fingerings
        if len(instrument.fingerings_for(pitches[event.note_id])) > 1 and event.start_s > 0.5
    )


def pins(session: Session) -> dict[str, str]:
    found = session.project.corrections.get(session.player.id, ())
    return {item.note_id: item.label for item in found if isinstance(item, PinFingering)}


def add_recording(session: Session, offset_s: float = 0.5, confidence: float | None = 0.94) -> None:
    track = AudioTrack("/recording.wav", offset_s, confidence)
    session.apply(Message("edit.set_offset"), replace(session.project, audio=track))
    samples = (np.sin(np.arange(48_000 * 8) * 0.05) * 20_000).astype(np.int16)[:, None]
    session.listening.set_waveform(Peaks(samples, 48_000))


# Fingerings


def test_a_click_shows_all_ways_to_play_a_note_and_a_chip_pins_one(panel: TimelinePanel, session: Session) -> None:
    lane, event = fingering_lane(panel), with_alternates(session)
    click(lane, place_of(lane, event.start_s, event.end_s))
    assert session.selection.notes == {event.note_id}
    assert lane.alternates.isVisible()
    chips = {chip.text(): chip for chip in lane.alternates.findChildren(Chip) if chip.isVisible()}
    assert event.label in chips
    assert chips[event.label].isChecked()
    other = next(label for label in chips if label != event.label)
    QTest.mouseClick(chips[other], Qt.MouseButton.LeftButton)
    assert pins(session) == {event.note_id: other}
    assert not lane.alternates.isVisible()
    pinned = next(item for item in front_plan(session).fingerings if item.note_id == event.note_id)
    assert (pinned.label, pinned.corrected) == (other, True)


def test_the_chips_bring_the_generators_choice_back(panel: TimelinePanel, session: Session) -> None:
    lane, event = fingering_lane(panel), with_alternates(session)
    player_id = front_plan(session).player_id
    label = next(f.label for f in lane.alternates.choices(player_id, event) if f.label != event.label)
    session.attempt(
        Message("edit.pin_fingerings", {"count": 1, "of": ""}),
        lambda project: edit.pin_fingerings(project, player_id, {event.note_id: label}),
    )
    click(lane, place_of(lane, event.start_s, event.end_s))
    back = next(child for child in lane.alternates.children() if child.objectName() == "give_back")
    QTest.mouseClick(back, Qt.MouseButton.LeftButton)
    assert not session.project.corrections


def test_the_chips_go_with_escape_and_with_a_press_elsewhere(panel: TimelinePanel, session: Session) -> None:
    lane, event = fingering_lane(panel), with_alternates(session)
    click(lane, place_of(lane, event.start_s, event.end_s))
    QTest.keyClick(viewport(lane), Qt.Key.Key_Escape)
    assert not lane.alternates.isVisible()
    click(lane, place_of(lane, event.start_s, event.end_s))
    assert lane.alternates.isVisible()
    click(panel.lanes["breath"], QPoint(20, 5))
    assert not lane.alternates.isVisible()


def test_a_drag_over_fingerings_selects_their_notes(panel: TimelinePanel, session: Session) -> None:
    lane = fingering_lane(panel)
    events = [event for event in front_plan(session).fingerings if event.start_s > 0.5 and event.end_s < 12.0][:5]
    start = lane.axis.x_px(events[0].start_s) + 2
    drag(lane, QPointF(start, 20.0), dx=lane.axis.x_px(events[-1].start_s) + 2 - start)
    assert session.selection.notes == {event.note_id for event in events}
    click(lane, place_of(lane, events[0].start_s, events[0].end_s), CTRL)
    assert session.selection.notes == {event.note_id for event in events[1:]}


def test_a_slide_is_a_line_over_its_places(panel: TimelinePanel, session: Session) -> None:
    slide_player = next(
        player
        for player in session.project.players
        if any(control.kind == "slide" and control.role == "pitch"
               for control in session.performance.instrument(player).controls)
    )  # fmt: skip
    lane = fingering_lane(panel)
    session.set_players((slide_player.id,))
    instrument = session.performance.instrument(slide_player)
    slide = next(control for control in instrument.controls if control.kind == "slide" and control.role == "pitch")
    places = slide_places(instrument, slide)
    assert [label for _, label in places] == ["1", "2", "3", "4", "5", "6", "7"]
    assert [label for label, _ in lane.row_names()] == ["T", "1", "2", "3", "4", "5", "6", "7"]
    assert lane.data.slides.shape == (1, len(front_plan(session).fingerings))
    assert lane.data.pressed.shape == (1, len(front_plan(session).fingerings))


# Curves


def test_a_value_of_the_lips_is_dragged_for_all_selected_notes(panel: TimelinePanel, session: Session) -> None:
    lane = curves_lane(panel)
    lips = [event for event in front_plan(session).embouchures if 0.5 < event.start_s < 15][:3]
    session.select(Selection(notes=frozenset(event.note_id for event in lips)))
    height = lane.plot.height() - 8
    drag(lane, place_of(lane, lips[1].start_s, lips[1].end_s), dy=-height * 0.2)
    found = session.project.corrections[front_plan(session).player_id]
    values = {item.note_id: item.tension for item in found if isinstance(item, SetEmbouchure)}
    for event in lips:
        assert values[event.note_id] == pytest.approx(min(event.tension + 0.2, 1.0), abs=0.03)
    assert len(session.document.done) == 1
    session.document.undo()
    assert not session.project.corrections


def test_another_curve_is_chosen_and_shift_is_fine(panel: TimelinePanel, session: Session) -> None:
    lane = curves_lane(panel)
    lane.choice.setFocus()
    QTest.keyClick(lane.choice, Qt.Key.Key_Down)
    assert lane.curve == "effort"
    lips = next(event for event in front_plan(session).embouchures if event.start_s > 0.5)
    drag(lane, place_of(lane, lips.start_s, lips.end_s), dy=-(lane.plot.height() - 8) * 0.5, modifiers=SHIFT)
    (item,) = session.project.corrections[front_plan(session).player_id]
    assert isinstance(item, SetEmbouchure)
    assert item.effort == pytest.approx(lips.effort + 0.1, abs=0.02)
    assert item.tension is None


def test_escape_leaves_the_lips_as_they_were(panel: TimelinePanel, session: Session) -> None:
    lane, project = curves_lane(panel), session.project
    lips = next(event for event in front_plan(session).embouchures if event.start_s > 0.5)
    drag(lane, place_of(lane, lips.start_s, lips.end_s), dy=-20, release=False)
    assert session.project is not project
    QTest.keyClick(viewport(lane), Qt.Key.Key_Escape)
    assert session.project is project
    assert not session.document.done


# The recording


def test_dragging_the_recording_moves_its_offset(panel: TimelinePanel, session: Session) -> None:
    add_recording(session)
    lane = waveform_lane(panel)
    assert "0.500" in lane.offset_text()
    assert "0.94" in lane.offset_text()
    steps = len(session.document.done)
    drag(lane, QPoint(400, 30), dx=70)
    audio = session.project.audio
    assert audio.offset_s == pytest.approx(0.5 + 70 / lane.axis.px_per_s, abs=0.01)
    assert audio.confidence is None
    assert len(session.document.done) == steps + 1
    drag(lane, QPoint(400, 30), dx=-100, modifiers=SHIFT)
    assert session.project.audio.offset_s == pytest.approx(audio.offset_s - 10 / lane.axis.px_per_s, abs=0.01)


def test_the_offset_is_typed(panel: TimelinePanel, session: Session) -> None:
    add_recording(session)
    lane = waveform_lane(panel)
    double_click(lane, QPoint(300, 30))
    assert lane.editor.isVisible()
    lane.editor.clear()
    QTest.keyClicks(lane.editor, "-0,132")
    QTest.keyClick(lane.editor, Qt.Key.Key_Return)
    assert session.project.audio.offset_s == pytest.approx(-0.132)
    assert not lane.editor.isVisible()
    double_click(lane, QPoint(300, 30))
    QTest.keyClicks(lane.editor, "9")
    QTest.keyClick(lane.editor, Qt.Key.Key_Escape)
    assert session.project.audio.offset_s == pytest.approx(-0.132)


def test_without_a_recording_the_lane_says_what_to_do(panel: TimelinePanel, session: Session) -> None:
    lane = waveform_lane(panel)
    assert lane.offset_text() == ""
    assert "Drop an audio file here" in lane.empty_text()
    double_click(lane, QPoint(300, 30))
    drag(lane, QPoint(300, 30), dx=50)
    assert not session.document.done


# Problems


def test_a_problem_is_marked_and_a_click_selects_its_note(panel: TimelinePanel, session: Session) -> None:
    lane = child(panel, ProblemsLane)
    plan = front_plan(session)
    assert session.player is not None
    notes = session.project.part(session.player).notes
    breaths = {event.id for event in plan.breaths}
    note = next(
        following
        for note, following in pairwise(notes[2:])
        if note.end_tick == following.onset_tick and f"breath:{following.id}" not in breaths
    )
    before = len(lane.problems)
    session.attempt(
        Message("edit.add_breath", {"of": "1"}),
        lambda project: breaths_and_cues.add_breath(project, plan, note.onset_tick).project,
    )
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    assert len(lane.problems) > before
    problem = next(item for item in lane.problems if item.message.id == "breath.inside_note")
    click(lane, QPointF(lane.axis.x_px(problem.start_s), lane.plot.height() / 2))
    assert session.selection.notes == {problem.note_id}
    assert reported == [problem.message]
    assert lane.count.text() == str(len(lane.problems))


def test_the_menu_pins_all_selected_notes_that_can_be_played_so(panel: TimelinePanel, session: Session) -> None:
    lane, event = fingering_lane(panel), with_alternates(session)
    plan = front_plan(session)
    same = [item for item in plan.fingerings if item.label == event.label][:4]
    label = next(f.label for f in lane.alternates.choices(plan.player_id, event) if f.label != event.label)
    able = {
        item.note_id
        for item in (*same, event)
        if label in {f.label for f in lane.alternates.choices(plan.player_id, item)}
    }
    session.select(Selection(notes=frozenset(item.note_id for item in (*same, event))))
    menu = lane.context_menu(lane.mouse_at(place_of(lane, event.start_s, event.end_s)))
    assert menu is not None
    next(action for action in menu.actions() if action.text().split()[0] == label).trigger()
    assert pins(session) == dict.fromkeys(able, label)
    assert len(session.document.done) == 1


def tip_over(lane: FingeringLane, event: FingeringEvent) -> str:
    time_s = (event.start_s + event.end_s) / 2
    lane.hover(LaneMouse(float(lane.axis.x_px(time_s)), 5.0, time_s, 5.0, 0.0, 0))
    return lane.plot.toolTip()


def test_a_muted_passage_is_marked_and_told_under_the_mouse(session: Session, panel: TimelinePanel) -> None:
    lane, player = fingering_lane(panel), session.player
    assert player is not None
    part = session.project.part(player)
    spans = ((part.notes[2].onset_tick, part.notes[6].end_tick),)
    before = lane.grab().toImage()
    parts = tuple(
        msgspec.structs.replace(one, muted=spans) if one.id == part.id else one for one in session.project.score.parts
    )
    score = msgspec.structs.replace(session.project.score, parts=parts)
    session.document.apply(Message("edit.rename"), replace(session.project, score=score))
    (mute,) = front_plan(session).mutes
    assert lane.mutes == (mute,)
    assert lane.grab().toImage() != before
    event = next(one for one in front_plan(session).fingerings if one.start_tick == spans[0][0])
    assert "with a mute in the bell" in tip_over(lane, event)
    stroke = front_plan(session).tongues[0]
    first = next(one for one in front_plan(session).fingerings if one.note_id == stroke.note_id)
    assert tip_over(lane, first).endswith("ta: tongued")


def test_a_press_just_beside_a_fingering_takes_its_note(panel: TimelinePanel, session: Session) -> None:
    lane = panel.lanes["fingering"]
    before = next(a for a, b in pairwise(front_plan(session).fingerings) if b.start_s - a.end_s > 1.0)
    panel.axis.show(before.start_s - 1.0, before.end_s + 4.0)
    x = panel.axis.x_px(before.end_s)
    click(lane, QPointF(x + 5.0, 20.0))
    assert session.selection.notes == {before.note_id}
    click(lane, QPointF(x + 30.0, 20.0))
    assert not session.selection.notes


def test_values_of_several_notes_are_not_one_until_typed(panel: TimelinePanel, session: Session) -> None:
    """Enter in an unchanged field makes no undo step, whether it shows one value or several notes' different ones."""
    lane = curves_lane(panel)
    lips = [event for event in front_plan(session).embouchures if event.start_s > 0.5]
    apart = next(b for b in lips if round(b.tension, 2) != round(lips[0].tension, 2))
    for chosen in ((lips[0],), (lips[0], apart)):
        session.select(Selection(notes=frozenset(event.note_id for event in chosen)))
        QTest.keyClick(lane.plot, Qt.Key.Key_Return)
        field = lane.number
        assert field.isVisible()
        assert field.text() == (f"{lips[0].tension:.2f}" if len(chosen) == 1 else "")
        QTest.keyClick(field, Qt.Key.Key_Return)
        assert not session.document.done
        assert not field.isVisible()


def test_the_pencil_draws_a_curve_over_several_notes(panel: TimelinePanel, session: Session) -> None:
    lane = curves_lane(panel)
    lips = [event for event in front_plan(session).embouchures if event.start_s > 0.5][:4]
    panel.set_tool(Tool.DRAW)
    first, last = place_of(lane, lips[0].start_s, lips[0].end_s), place_of(lane, lips[-1].start_s, lips[-1].end_s)
    start = QPointF(first.x(), lane.plot_rect.height() * 0.25)
    drag(lane, start, last.x() - first.x(), lane.plot_rect.height() * 0.5)
    set_by_hand = session.project.corrections[front_plan(session).player_id]
    values = {item.note_id: item.tension for item in set_by_hand if isinstance(item, SetEmbouchure)}
    drawn = [values[event.note_id] for event in lips]
    assert all(value is not None for value in drawn)
    assert drawn == sorted(drawn, reverse=True)
    assert drawn[0] > 0.65 > 0.35 > drawn[-1]
    assert [step.name.id for step in session.document.done] == ["edit.set_embouchure"]


def test_a_double_click_where_nothing_can_be_typed_says_why(panel: TimelinePanel, session: Session) -> None:
    reported: list[str] = []
    session.noticed.connect(lambda message, severity: reported.append(message.id))
    lane = curves_lane(panel)
    first = front_plan(session).embouchures[0]
    double_click(lane, QPointF(panel.axis.x_px(first.start_s) - 20.0, 20.0))
    breaths = panel.lanes["breath"]
    assert isinstance(breaths, BreathLane)
    first_breath = min(region.start_s for region in breaths.regions)
    double_click(breaths, QPointF(panel.axis.x_px(first_breath) - 20.0, 4.0))
    assert reported == ["curves.no_note_here", "edit.is_there"]
    reported.clear()
    for id in ("fingering", "audio", "problems"):
        double_click(panel.lanes[id], QPointF(panel.axis.x_px(first.start_s) - 40.0, 20.0))
    assert reported == ["fingering.no_note_here", "audio.none_here", "problems.none_here"]
    assert not session.document.done
