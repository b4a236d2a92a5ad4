"""Bar lines and beats moved to their times in the recording by mouse and keys, compared with the project."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu

from app.audio.waveform_peaks import Peaks
from app.editor.session import Session
from app.errors import Message
from app.project.edit.pins import pin_beat, recording_second
from app.project.edit.tempo import set_tempo
from app.project.recording import AudioTrack, BeatPin, Doubt
from app.project.storage import load, save
from tests.gui.timeline.lane_hands import SHIFT, click, double_click, drag, viewport
from tests.support.windows import child
from widgets.timeline.lanes.recording.waveform import WaveformLane
from widgets.timeline.panel import TimelinePanel

ALT = Qt.KeyboardModifier.AltModifier


@pytest.fixture
def panel(panel: TimelinePanel) -> TimelinePanel:
    panel.axis.show(-1.0, 19.0)
    return panel


@pytest.fixture
def lane(panel: TimelinePanel, session: Session) -> WaveformLane:
    """Recording that begins half a second before the piece, with two uncertain bars."""
    metre_map = session.project.metre_map
    bars = [int(metre_map.tick_of_bar(number)) for number in (4, 5, 6)]
    doubts = (Doubt(bars[0], bars[1], 0.31), Doubt(bars[1], bars[2], 0.0))
    track = AudioTrack("/recording.wav", -0.5, 0.94, (), doubts)
    session.apply(Message("edit.set_audio"), replace(session.project, audio=track))
    session.document.end_gesture()
    samples = np.random.default_rng(0).integers(-20_000, 20_000, (25 * 48_000, 2)).astype(np.int16)
    session.listening.set_waveform(Peaks(samples, 48_000))
    return child(panel, WaveformLane)


def bar(session: Session, number: int) -> int:
    return int(session.project.metre_map.tick_of_bar(number))


def handle(lane: WaveformLane, tick: int) -> QPoint:
    """Point at which the mouse grabs a bar line or beat."""
    x = lane.axis.x_px(lane.session.project.score.tempo_map.seconds(float(tick)))
    return QPoint(round(x), lane.plot.height() - 4)


def pins(session: Session) -> tuple[BeatPin, ...]:
    return session.project.audio.pins


def test_a_bar_line_dragged_on_the_waveform_is_pinned_where_it_sounds(lane: WaveformLane, session: Session) -> None:
    before, tick = session.project, bar(session, 3)
    steps = len(session.document.done)
    from_s = recording_second(before, tick)
    drag(lane, handle(lane, tick), dx=30)
    expected_s = from_s + 30 / lane.axis.px_per_s
    (pin,) = pins(session)
    assert (pin.tick, pin.recording_s) == (tick, pytest.approx(expected_s, abs=0.01))
    assert recording_second(session.project, tick) == pytest.approx(pin.recording_s, abs=1e-6)
    assert session.project.audio.offset_s == -0.5
    beat = session.project.metre_map.felt_ticks_at(tick)
    beside = [recording_second(session.project, at) - recording_second(before, at) for at in (tick - beat, tick + beat)]
    assert all(0.0 < moved_s < 30 / lane.axis.px_per_s for moved_s in beside)
    assert [part.notes for part in session.project.score.parts] == [part.notes for part in before.score.parts]
    assert session.project.corrections is before.corrections
    assert len(session.document.done) == steps + 1
    assert session.document.done[-1].name.id == "edit.pin_beat"
    session.document.undo()
    assert session.project is before


def test_shift_is_fine_and_escape_takes_the_drag_back(lane: WaveformLane, session: Session) -> None:
    before, tick = session.project, bar(session, 3)
    drag(lane, handle(lane, tick), dx=30, release=False)
    assert pins(session)
    QTest.keyClick(viewport(lane), Qt.Key.Key_Escape)
    assert session.project is before
    drag(lane, handle(lane, tick), dx=50, modifiers=SHIFT)
    moved_s = pins(session)[0].recording_s - recording_second(before, tick)
    assert moved_s == pytest.approx(5 / lane.axis.px_per_s, abs=0.002)


def test_beats_can_be_pinned_where_there_is_room_for_them(lane: WaveformLane, session: Session) -> None:
    lane.axis.show(0.0, 5.0)
    tick = bar(session, 2) + session.project.metre_map.felt_ticks_at(0)
    drag(lane, handle(lane, tick), dx=-12)
    assert [pin.tick for pin in pins(session)] == [tick]


def test_above_the_handles_the_recording_is_moved(lane: WaveformLane, session: Session) -> None:
    place = handle(lane, bar(session, 3))
    drag(lane, QPoint(place.x(), 24), dx=40)
    assert not pins(session)
    assert session.project.audio.offset_s > -0.4


def test_a_double_click_pins_and_lets_go(lane: WaveformLane, session: Session) -> None:
    tick, score = bar(session, 3), session.project.score
    double_click(lane, handle(lane, tick))
    assert [pin.tick for pin in pins(session)] == [tick]
    assert session.project.score is score
    assert not lane.editor.isVisible()
    double_click(lane, handle(lane, tick))
    assert not pins(session)


def test_by_keys_alone(lane: WaveformLane, session: Session) -> None:
    plot, tick = viewport(lane), bar(session, 3)
    session.set_playhead(session.project.score.tempo_map.seconds(float(bar(session, 2))))
    QTest.keyClick(plot, Qt.Key.Key_Right, ALT)
    assert lane.anchors.chosen == tick
    from_s = recording_second(session.project, tick)
    for _ in range(3):
        QTest.keyClick(plot, Qt.Key.Key_Right)
    QTest.keyClick(plot, Qt.Key.Key_Left, SHIFT)
    assert recording_second(session.project, tick) == pytest.approx(from_s + 0.029, abs=1e-3)
    QTest.keyClick(plot, Qt.Key.Key_Delete)
    assert not pins(session)
    assert session.document.done[-1].name.id == "edit.remove_pin"
    QTest.keyClick(plot, Qt.Key.Key_Return)
    assert [pin.tick for pin in pins(session)] == [tick]
    QTest.keyClick(plot, Qt.Key.Key_Left, ALT)
    assert lane.anchors.chosen == bar(session, 2)
    QTest.keyClick(plot, Qt.Key.Key_Escape)
    assert lane.anchors.chosen is None


def menu_at(lane: WaveformLane, place: QPoint) -> QMenu:
    menu = lane.context_menu(lane.mouse_at(place.toPointF()))
    assert menu is not None
    return menu


def test_the_menu_pins_and_removes(lane: WaveformLane, session: Session) -> None:
    place = handle(lane, bar(session, 3))
    menu_at(lane, place).actions()[0].trigger()
    session.attempt(Message("edit.pin_beat"), lambda project: pin_beat(project, bar(session, 6)))
    assert len(pins(session)) == 2
    texts = [action.text() for action in menu_at(lane, place).actions()]
    assert texts[:2] == ["Remove Pin", "Remove All Pins"]
    menu_at(lane, place).actions()[1].trigger()
    assert not pins(session)
    assert "Pin" not in menu_at(lane, QPoint(place.x() + 20, 20)).actions()[0].text()


def test_doubtful_bars_say_so_until_a_beat_of_theirs_is_pinned(lane: WaveformLane, session: Session) -> None:
    def tip(number: int) -> str:
        tick = bar(session, number) + session.project.score.ticks_per_quarter
        return lane.anchors.tip(lane.mouse_at(QPoint(handle(lane, tick).x(), 20).toPointF()))

    assert "31 %" in tip(4)
    assert "not in the recording" in tip(5)
    assert tip(3) == ""
    picture = lane.plot.grab().toImage()
    place = handle(lane, bar(session, 4) + session.project.score.ticks_per_quarter)
    double_click(lane, handle(lane, bar(session, 4)))
    assert tip(4) == ""
    assert lane.plot.grab().toImage().pixel(place.x(), 2) != picture.pixel(place.x(), 2)
    click(lane, QPoint(5, 40))
    assert "Pinned at" in lane.anchors.tip(lane.mouse_at(handle(lane, bar(session, 4)).toPointF()))


def test_pins_are_saved_and_stay_where_the_tempo_is_changed(
    lane: WaveformLane, session: Session, tmp_path: Path
) -> None:
    tick = bar(session, 3)
    drag(lane, handle(lane, tick), dx=30)
    save(session.project, tmp_path / "piece.suisou")
    assert load(tmp_path / "piece.suisou").audio == session.project.audio
    kept = pins(session)
    session.attempt(Message("edit.set_tempo"), lambda project: set_tempo(project, 0, 90.0))
    assert pins(session) == kept
    lane.plot.grab()
