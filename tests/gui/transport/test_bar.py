"""The transport bar by mouse and keys."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from app.editor.design_tokens import LIGHT
from app.editor.grids import GRIDS
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.sound import EditorSound
from app.editor.stretches_of_time import place_limits
from app.errors import Message
from app.project.edit.piece import set_audio, set_fps
from app.project.edit.tempo import set_metre, set_tempo
from app.shell.actions import ActionTable
from app.shell.commands import edit, playback
from tests.gui.transport.conftest import Elapse
from tests.gui.transport.devices import FakeDevices
from tests.support.windows import show
from widgets.common.number_slider import NumberSlider
from widgets.common.text import sentence
from widgets.transport.bar import TransportBar
from widgets.transport.fields import clock_seconds, clock_text

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def bar(session: Session, sound: EditorSound, tmp_path: Path, qtbot: QtBot) -> TransportBar:
    table = ActionTable(session, Settings(tmp_path / "settings.toml"), (*edit.ACTIONS, *playback.ACTIONS))
    table.refresh()
    result = TransportBar(session)
    qtbot.addWidget(result)
    result.resize(1400, result.sizeHint().height())
    show(result)
    return result


def type_into(qtbot: QtBot, field: NumberSlider, text: str) -> None:
    field.setFocus()
    qtbot.keyClick(field, Qt.Key.Key_Return)
    # The one before may not be deleted yet.
    (editor,) = (child for child in field.findChildren(QLineEdit) if child.isVisible())
    editor.selectAll()
    qtbot.keyClicks(editor, text)
    qtbot.keyClick(editor, Qt.Key.Key_Return)


def test_play_and_stop(qtbot: QtBot, bar: TransportBar, session: Session, devices: FakeDevices, elapse: Elapse) -> None:
    button = bar.buttons["play.toggle"]
    standing = button.icon().cacheKey()
    qtbot.mouseClick(button, LEFT)
    assert session.playing
    assert button.icon().cacheKey() != standing
    elapse(1.0)
    assert session.playback.position_s() == pytest.approx(1.0, abs=0.003)
    qtbot.mouseClick(button, LEFT)
    assert not session.playing
    assert session.playhead_s == pytest.approx(1.0, abs=0.003)
    assert button.icon().cacheKey() == standing
    qtbot.mouseClick(bar.buttons["play.stop"], LEFT)
    assert session.playhead_s == session.performance.time_frame.first_frame_s
    session.set_playhead(5.0)
    qtbot.mouseClick(bar.buttons["play.to_start"], LEFT)
    assert session.playhead_s == session.performance.time_frame.first_frame_s


def test_the_light_flashes_on_each_beat_and_another_way_on_a_bars_first(bar: TransportBar, session: Session) -> None:
    score, light = session.project.score, bar.beat
    bar_s, beat_s = (
        score.tempo_map.seconds(score.metre_map.tick_of_bar(3) + beats * session.project.metre_map.beat_length(0))
        for beats in (0, 1)
    )

    def states() -> list[str]:
        seen = []
        for time_s in (bar_s - 0.02, bar_s, bar_s + 0.05, bar_s + 0.2, beat_s, beat_s + 0.05, beat_s + 0.2):
            light.show_time(time_s)
            seen.append(light.state)
        return seen

    session.listening.set(click=True)
    assert states() == ["off"] * 7
    session.set_playing(True)
    assert states() == ["off", "bar", "bar", "off", "beat", "beat", "off"]


def test_places_are_typed(qtbot: QtBot, bar: TransportBar, session: Session) -> None:
    score = session.project.score
    type_into(qtbot, bar.bars, "12.2")
    assert session.playhead_s == pytest.approx(
        score.tempo_map.seconds(score.metre_map.tick_of_bar(12) + 2 * score.ticks_per_quarter)
    )
    assert bar.bars.value_text() == "12.2.000"
    type_into(qtbot, bar.clock, "0:19.25")
    assert session.playhead_s == pytest.approx(19.25)
    assert bar.frames.value_text() == "1155"
    type_into(qtbot, bar.frames, "600")
    assert session.playhead_s == pytest.approx(10.0)
    assert bar.clock.value_text() == "00:10.000"
    type_into(qtbot, bar.clock, "nonsense")
    assert session.playhead_s == pytest.approx(10.0)
    assert not session.document.done


def test_a_typed_place_stays_within_the_piece_and_its_room_to_write(
    qtbot: QtBot, bar: TransportBar, session: Session
) -> None:
    score, (first_s, _) = session.project.score, place_limits(session)
    assert -5.0 < first_s <= session.performance.time_frame.first_frame_s
    end_s = score.tempo_map.seconds(float(score.end_tick))
    for field in (bar.bars, bar.clock, bar.frames):
        for _ in range(2):
            type_into(qtbot, field, "9999")
            assert end_s <= session.playhead_s <= max(60.0, 1.1 * end_s + 10.0)
            assert score.metre_map.tick_of_label(bar.bars.value_text()) == bar.bars.value
            assert bar.bars.value == pytest.approx(score.tempo_map.ticks(session.playhead_s), abs=1.0)
        for _ in range(2):
            type_into(qtbot, field, "-500")
            assert session.playhead_s == first_s
            assert bar.bars.value == pytest.approx(score.tempo_map.ticks(first_s), abs=1.0)


def test_text_that_is_no_place_is_said(qtbot: QtBot, bar: TransportBar, session: Session) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    for number, field in enumerate((bar.bars, bar.clock, bar.frames, bar.speed), 1):
        before = session.playhead_s
        type_into(qtbot, field, "abc")
        assert session.playhead_s == before
        assert len(reported) == number
        assert sentence(reported[-1]) == f"“abc” is not understood here; the value stays {field.value_text()}"


def test_places_are_dragged_and_copied(qtbot: QtBot, bar: TransportBar, session: Session) -> None:
    session.set_playhead(10.0)
    field = bar.frames
    centre = field.rect().center()
    qtbot.mousePress(field, LEFT, pos=centre)
    for step in range(1, 11):
        qtbot.mouseMove(field, centre + QPoint(4 * step, 0))
    qtbot.mouseRelease(field, LEFT, pos=centre + QPoint(40, 0))
    assert 10.05 < session.playhead_s < 10.5
    assert session.playhead_s * 60 == pytest.approx(round(session.playhead_s * 60), abs=1e-6)
    field.setFocus()
    qtbot.keyClick(field, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert QGuiApplication.clipboard().text().startswith(field.value_text())


def test_tempo_and_metre_at_the_playhead(bar: TransportBar, session: Session) -> None:
    score = session.project.score
    tick = score.metre_map.tick_of_bar(5)
    session.attempt(Message("edit.set_offset"), lambda project: set_metre(set_tempo(project, tick, 63.5), tick, 5, 8))
    session.set_playhead(0.0)
    assert "5/8" not in bar.tempo.text()
    session.set_playhead(session.project.score.tempo_map.seconds(float(tick)) + 0.01)
    assert "63.5" in bar.tempo.text()
    assert "5/8" in bar.tempo.text()


def test_the_picture_rate_counts_the_frames(bar: TransportBar, session: Session) -> None:
    session.set_playhead(10.0)
    session.attempt(Message("edit.set_offset"), lambda project: set_fps(project, Fraction(24000, 1001)))
    assert bar.frames.value_text() == "239"


def test_speed_volume_and_click(qtbot: QtBot, bar: TransportBar, session: Session, devices: FakeDevices) -> None:
    type_into(qtbot, bar.speed, "50")
    assert session.listening.speed == 0.5
    type_into(qtbot, bar.speed, "200")
    assert session.listening.speed == 2.0
    qtbot.mouseDClick(bar.speed, LEFT)
    assert session.listening.speed == 1.0
    type_into(qtbot, bar.volume, "100")
    qtbot.mouseClick(bar.buttons["play.toggle"], LEFT)
    assert devices.sink.gain == 1.0
    qtbot.mouseClick(bar.buttons["play.click"], LEFT)
    assert session.listening.click
    assert bar.buttons["play.click"].isChecked()
    qtbot.keyClick(bar.buttons["play.click"], Qt.Key.Key_Space)
    assert not session.listening.click


def test_snap(qtbot: QtBot, bar: TransportBar, session: Session) -> None:
    assert session.grid.enabled
    qtbot.mouseClick(bar.snap_button, LEFT)
    assert not session.grid.enabled
    bar.snap.setFocus()
    bar.snap.setCurrentIndex(bar.snap.findData("1/8T"))
    bar.snap.activated.emit(bar.snap.currentIndex())
    assert session.grid.enabled
    assert session.grid.quarters == Fraction(1, 3)
    assert bar.snap_button.isChecked()
    assert GRIDS["1/4"] == 1
    assert GRIDS["1/8."] == Fraction(3, 4)
    assert {"1/4", "1/8", "1/16", "1/32"} <= set(GRIDS)


def test_follow_and_loop(qtbot: QtBot, bar: TransportBar, session: Session) -> None:
    qtbot.mouseClick(bar.buttons["play.follow"], LEFT)
    assert not session.follow
    session.set_playhead(10.0)
    qtbot.mouseClick(bar.buttons["play.loop"], LEFT)
    assert session.loop_s[0] <= 10.0 < session.loop_s[1]
    assert bar.buttons["play.loop"].isChecked()
    qtbot.mouseClick(bar.buttons["play.loop"], LEFT)
    assert session.loop_s is None


def test_the_source_is_chosen_where_there_is_a_recording(bar: TransportBar, session: Session) -> None:
    assert not bar.source.isVisible()
    session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, "/nowhere/recording.wav"))
    assert bar.source.isVisible()
    bar.source.chosen.emit("both")
    assert session.listening.source == "both"
    assert bar.source.shown == "both"


def test_a_missing_device_is_said(qtbot: QtBot, bar: TransportBar, session: Session, devices: FakeDevices) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    assert not bar.silent_sign.isVisible()
    devices.there = False
    qtbot.mouseClick(bar.buttons["play.toggle"], LEFT)
    assert session.playing
    assert bar.silent_sign.isVisible()
    assert bar.silent_text.isVisible()
    qtbot.mouseClick(bar.buttons["play.toggle"], LEFT)
    qtbot.mouseClick(bar.buttons["play.toggle"], LEFT)
    assert [message.id for message in reported] == ["audio.no_device"]
    bar.resize(1000, bar.height())
    assert not bar.silent_text.isVisible()


def test_it_fits_and_follows_the_theme(bar: TransportBar, session: Session) -> None:
    session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, "/nowhere/recording.wav"))
    session.listening.set(silent=True)
    bar.resize(1000, bar.height())
    assert bar.minimumSizeHint().width() <= 985
    session.set_tokens(LIGHT)
    assert LIGHT.warning in bar.silent_text.styleSheet()
    for button in (*bar.buttons.values(), bar.snap_button):
        assert button.toolTip()
        assert button.accessibleName()
        assert button.width() >= 24
    assert "Space" in bar.buttons["play.toggle"].toolTip()


@pytest.mark.parametrize("width", [950, 1100, 1276])
def test_speed_and_volume_keep_their_names_beside_a_recording(bar: TransportBar, session: Session, width: int) -> None:
    session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, "/nowhere/recording.wav"))
    session.listening.set(silent=True)
    bar.resize(width, bar.height())
    QApplication.processEvents()
    assert bar.width() == width
    for slider in (bar.volume, bar.speed):
        assert slider.isVisible()
        assert slider.isEnabled()
        assert slider.width() >= slider.sizeHint().width()
    shown = sorted((one for one in bar.findChildren(QWidget) if one.isVisible()), key=QWidget.x)
    shown = [one for one in shown if one.parentWidget() is bar]
    for left, right in pairwise(shown):
        assert left.geometry().right() < right.x(), (left.objectName(), right.objectName())
    assert shown[-1].geometry().right() < bar.width()
    bar.resize(1500, bar.height())
    assert bar.clock.isVisible()
    assert bar.tempo.isVisible()


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("0", 0.0), ("19.25", 19.25), ("1:02.5", 62.5), ("-1.5", -1.5), ("−1.5", -1.5), ("1:00:00", 3600.0),
     ("１：０２", 62.0), (".5", 0.5), ("12 s", 12.0), ("x", None), ("1:2:3:4", None), ("", None), ("9e9", None),
     ("99999999", None)],
)  # fmt: skip
def test_times_as_people_write_them(text: str, seconds: float | None) -> None:
    assert clock_seconds(text) == seconds


@pytest.mark.parametrize("time_s", [0.0, 0.0004, 59.9996, 60.0, 3599.9994, 3661.5, -1.9226, -0.0001])
def test_a_written_time_is_read_back(time_s: float) -> None:
    read = clock_seconds(clock_text(time_s))
    assert read == pytest.approx(time_s, abs=0.00051)
    assert "60." not in clock_text(time_s)


def test_bars_stand_still(session: Session) -> None:
    label = session.project.score.metre_map.label
    assert label(0) == "1.1.000"
    lengths = {len(label(tick).split(".")[2]) for tick in range(0, 4000, 37)}
    assert lengths == {3}
