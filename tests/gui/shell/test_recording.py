"""Recording by keys, with a recorder whose reports the test provides."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QLabel

from app.capture.journal import JournalHeader, JournalWriter
from app.capture.protocol import Back, EventsSaved, Lost, Opened, Ports, RequestRefused
from app.editor.live_player import REST_S
from app.errors import Message
from tests.support.recorder import EWI
from tests.support.studio import Studio
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.dialogs.midi_devices import MidiDevicesDialog


def take_text(studio: Studio) -> QLabel:
    label = studio.program.window.findChild(QLabel, "take_text")
    assert isinstance(label, QLabel)
    return label


def notes(studio: Studio):  # type: ignore[no-untyped-def]
    project = studio.session.project
    return project.part(project.players[0]).notes


def test_what_is_played_becomes_a_take_and_the_part(studio: Studio) -> None:
    studio.press(Qt.Key.Key_R)
    assert studio.session.recording.running
    studio.blow(60, 0.3)
    studio.blow(62, 0.6)
    studio.wait(lambda: studio.session.recording.breath == 0.0)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))
    assert not studio.session.recording.running
    assert [note.pitch for note in notes(studio)] == [60, 62]
    seconds = [studio.session.project.score.tempo_map.seconds(note.onset_tick) for note in notes(studio)]
    # Times as heard, up to the delay with which a test notices them.
    assert seconds == pytest.approx([0.3, 0.6], abs=0.15)
    assert len(studio.session.document.done) == 2
    studio.session.document.undo()
    assert not studio.session.project.takes
    assert not notes(studio)


def test_a_take_is_counted_in(studio: Studio) -> None:
    actions(studio.session)["record.count_in_1"].trigger()
    studio.session.recording.set(count_in_bars=1)
    studio.press(Qt.Key.Key_R)
    assert studio.session.recording.counted_from_s == -2.0
    studio.wait(lambda: studio.session.playhead_s > -1.9)
    assert take_text(studio).text() == "−4"
    studio.press(Qt.Key.Key_R)
    assert take_text(studio).text() == ""


@pytest.mark.parametrize(("bars", "counted_from_s"), [(1, -2.0), (0, None)])
def test_a_take_after_home_begins_with_the_piece(studio: Studio, bars: int, counted_from_s: float | None) -> None:
    studio.session.recording.set(count_in_bars=bars)
    actions(studio.session)["play.to_start"].trigger()
    home_s = studio.session.playhead_s
    assert home_s < 0.0
    studio.press(Qt.Key.Key_R)
    recording = studio.session.recording
    assert recording.start_s == 0.0
    # Without clicks the pre-roll leads in.
    assert recording.counted_from_s == (home_s if counted_from_s is None else counted_from_s)
    studio.press(Qt.Key.Key_R)


def test_each_pass_of_a_loop_is_a_take(studio: Studio) -> None:
    studio.session.set_loop((0.0, 0.8))
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.3)
    studio.wait(lambda: studio.session.recording.passes == 2)
    studio.blow(64, 0.3)
    studio.wait(lambda: studio.session.recording.passes == 3)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))
    takes = studio.session.project.takes[studio.session.project.players[0].id].takes
    assert [take.played.pitches.tolist() for take in takes] == [[60], [64]]
    assert all(0.2 < take.played.onsets_s[0] < 0.5 for take in takes)
    assert [note.pitch for note in notes(studio)] == [64]
    assert [take.name for take in takes] == ["Take 1", "Take 2"]
    # Another recording continues the numbering.
    studio.session.set_loop(None)
    studio.session.set_playhead(0.0)
    studio.press(Qt.Key.Key_R)
    studio.blow(67, 0.2)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: len(studio.session.project.takes[studio.session.project.players[0].id].takes) == 3)
    assert studio.session.project.takes[studio.session.project.players[0].id].takes[2].name == "Take 3"


def test_only_the_punch_range_is_taken_into_the_part(studio: Studio) -> None:
    studio.session.recording.set(punch=True, punch_ticks=(480, 960))
    studio.press(Qt.Key.Key_R)
    for pitch, at_s in ((60, 0.2), (61, 0.6), (62, 1.2)):
        studio.blow(pitch, at_s)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))
    assert [note.pitch for note in notes(studio)] == [61]
    take = studio.session.project.takes[studio.session.project.players[0].id].takes[0]
    assert len(take.played) == 3


def test_a_first_note_struck_a_little_early_is_in_the_part(studio: Studio) -> None:
    studio.session.set_playhead(1.0)
    studio.session.recording.set(count_in_bars=1)
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.95)
    studio.blow(62, 1.3)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))
    assert [note.pitch for note in notes(studio)] == [60, 62]


def test_who_is_recorded_plays_along_and_is_the_performance_again_afterwards(studio: Studio) -> None:
    live = studio.session.live_players
    player = studio.session.project.players[0].id
    studio.wait(lambda: player in studio.session.performance.plans)
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.2)
    assert list(live.playing) == [player]
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: not live.playing)


def test_a_held_note_is_played_as_long_as_it_is_held(studio: Studio) -> None:
    live = studio.session.live_players
    player = studio.session.project.players[0].id
    studio.wait(lambda: player in studio.session.performance.plans)
    studio.link.play(bytes((0x90, 60, 90)))
    studio.wait(lambda: bool(live.playing))
    end_s = time.monotonic() + REST_S + 0.5
    studio.wait(lambda: time.monotonic() > end_s)
    assert list(live.playing) == [player]
    studio.link.say(Lost(EWI, studio.clock.ns))
    studio.wait(lambda: not live.playing)


def test_stopping_the_transport_ends_the_take(studio: Studio) -> None:
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.2)
    actions(studio.session)["play.stop"].trigger()
    studio.wait(lambda: bool(studio.session.project.takes))


def test_nothing_played_is_no_take_and_leaves_no_file(studio: Studio) -> None:
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: studio.session.playhead_s > 0.2)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: not list(studio.folder.rglob("*.take-journal")))
    assert not studio.session.project.takes


def test_an_unplugged_device_leaves_what_was_played(studio: Studio) -> None:
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.2)
    studio.link.say(Lost(EWI, studio.clock.ns))
    studio.wait(lambda: studio.session.recording.connection == "lost")
    assert studio.session.recording.running
    studio.link.say(Back(EWI, studio.clock.ns))
    studio.wait(lambda: studio.session.recording.connection == "open")
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))


def test_a_midi_system_that_ends_is_reported_as_the_device_s_loss(studio: Studio) -> None:
    said: list[str] = []
    studio.session.noticed.connect(lambda message, severity: said.append(message.id))
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.2)
    # The missing audio device is reported first.
    said.clear()
    studio.link.say(Lost(EWI, studio.clock.ns), Ports((), (), ""), RequestRefused(Message("capture.no_system")))
    studio.wait(lambda: studio.session.recording.connection == "refused")
    assert said == ["record.device_lost_running"]
    assert studio.session.recording.running
    assert studio.session.recording.refusal == Message("capture.no_system")
    studio.link.say(Ports((EWI,), (), "test"), Back(EWI, studio.clock.ns))
    studio.wait(lambda: studio.session.recording.connection == "open")
    assert said[1:] == ["record.device_back"]
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))


def test_what_cannot_be_brought_in_is_not_said_to_be(studio: Studio) -> None:
    path = studio.folder / "piece.suisou"
    studio.program.editor.questions.path = path  # type: ignore[attr-defined]
    studio.program.editor.files.save_as()
    said: list[str] = []
    studio.session.noticed.connect(lambda message, severity: said.append(message.id))
    header = JournalHeader(str(path), "another user", EWI, "ewi_5000", 0.0, "2026-11-21T10:00:00.000+00:00")
    writer = JournalWriter(str(path.with_name(f"{path.name}.1.take-journal")), header)
    writer.sync(10**9, 0.0, 0)
    writer.event(15 * 10**8, bytes((0x90, 64, 90)))
    writer.close()
    studio.program.editor.files.open(path)
    assert said.count("record.player_gone") == 1
    assert "record.recovered" not in said


def test_a_take_that_a_crash_tore_off_is_brought_in_when_its_project_is_opened(studio: Studio) -> None:
    path = studio.folder / "piece.suisou"
    studio.program.editor.questions.path = path  # type: ignore[attr-defined]
    studio.program.editor.files.save_as()
    player = studio.session.project.players[0].id
    header = JournalHeader(str(path), player, EWI, "ewi_5000", 0.0, "2026-11-21T10:00:00.000+00:00")
    journal = path.with_name(f"{path.name}.1.take-journal")
    writer = JournalWriter(str(journal), header)
    writer.sync(10**9, 0.0, 0)
    writer.event(15 * 10**8, bytes((0x90, 64, 90)))
    writer.event(17 * 10**8, bytes((0x80, 64, 0)))
    writer.sync(2 * 10**9, 1.0, 0)
    writer.close()
    studio.program.editor.files.open(path)
    takes = studio.session.project.takes[player].takes
    assert [take.played.onsets_s.tolist() for take in takes] == [[0.5]]
    assert not notes(studio)
    # The take is in the autosave by now.
    assert not journal.exists()
    studio.program.editor.files.save()
    studio.program.editor.files.open(path)
    assert len(studio.session.project.takes[player].takes) == 1


@pytest.mark.parametrize("language", ["en", "ja"])
@pytest.mark.parametrize("has_file", [True, False])
def test_a_take_goes_on_in_a_second_place_where_its_disk_is_full(
    studio: Studio, has_file: bool, language: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.project.journals.tempfile.gettempdir", lambda: str(tmp_path))
    studio.program.editor.language.set(language)
    if has_file:
        studio.program.editor.questions.path = studio.folder / "piece.suisou"  # type: ignore[attr-defined]
        studio.program.editor.files.save_as()
    reported: list[Message] = []
    studio.session.noticed.connect(lambda message, severity: reported.append(message))
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.3)
    writer = studio.link.writer
    before = Path(writer.path)
    studio.link.move()
    studio.wait(lambda: any(message.id == "record.goes_on_elsewhere" for message in reported))
    after = Path(writer.path)
    assert after.parent == (studio.folder / "recovery" if has_file else tmp_path)
    assert not before.exists()
    assert str(after) in studio.program.window.status.notice_text
    studio.blow(62, 0.6)
    studio.press(Qt.Key.Key_R)
    studio.wait(lambda: bool(studio.session.project.takes))
    assert [note.pitch for note in notes(studio)] == [60, 62]
    studio.program.editor.questions.path = studio.folder / "piece.suisou"  # type: ignore[attr-defined]
    studio.program.editor.files.save()
    assert not after.exists()


def test_a_take_that_a_crash_left_in_a_second_place_is_brought_in(studio: Studio) -> None:
    path, folder = studio.folder / "piece.suisou", studio.folder / "recovery"
    studio.program.editor.questions.path = path  # type: ignore[attr-defined]
    studio.program.editor.files.save_as()
    player = studio.session.project.players[0].id
    for number, project in enumerate((path, studio.folder / "other.suisou")):
        header = JournalHeader(str(project), player, EWI, "ewi_5000", 0.0, f"2026-11-21T10:00:0{number}.000+00:00")
        writer = JournalWriter(str(folder / f"0123456789abcde{number}.1.take-journal"), header)
        writer.sync(10**9, 0.0, 0)
        writer.event(15 * 10**8, bytes((0x90, 64 + number, 90)))
        writer.close()
    (folder / "damaged.1.take-journal").write_text("?\n")
    studio.program.editor.files.open(path)
    assert [take.played.pitches.tolist() for take in studio.session.project.takes[player].takes] == [[64]]
    left = sorted(file.name for file in folder.glob("*.take-journal"))
    assert left == ["0123456789abcde1.1.take-journal", "damaged.1.take-journal"]


def test_a_take_stays_with_its_project_when_another_is_opened_meanwhile(studio: Studio) -> None:
    mine, other = studio.folder / "mine.suisou", studio.folder / "other.suisou"
    for path in (other, mine):
        studio.program.editor.questions.path = path  # type: ignore[attr-defined]
        studio.program.editor.files.save_as()
    studio.press(Qt.Key.Key_R)
    studio.blow(60, 0.2)
    # The players are the same, by id; the recorder reports its end only afterwards.
    report, studio.link.on_news = studio.link.on_news, lambda: None
    studio.program.editor.files.open(other)
    assert studio.link.writer is None
    studio.link.on_news = report
    report()
    studio.wait(lambda: not studio.link.reported)
    QApplication.processEvents()
    assert not studio.session.recording.running
    assert not studio.session.project.takes
    studio.program.editor.files.open(mine)
    takes = studio.session.project.takes[studio.session.project.players[0].id].takes
    assert [take.played.pitches.tolist() for take in takes] == [[60]]


def test_without_a_device_it_is_said_and_the_devices_are_shown(studio: Studio) -> None:
    recorder = studio.program.recorder
    recorder.choose("")
    said: list[str] = []
    studio.session.noticed.connect(lambda message, severity: said.append(message.id))
    studio.press(Qt.Key.Key_R)
    assert said == ["record.no_device"]
    assert not studio.session.recording.running
    dialog = child(studio.program.window, MidiDevicesDialog)
    assert dialog.isVisible()
    # A device chosen there is used for recording.
    dialog.chosen.emit(EWI)
    studio.link.say(Opened(EWI, 0))
    studio.wait(lambda: studio.session.recording.connection == "open")
    dialog.close()
    recorder.record()
    assert studio.session.recording.running


def test_events_on_the_disk_are_counted(studio: Studio) -> None:
    studio.link.say(EventsSaved(7))
    studio.wait(lambda: studio.session.recording.events == 7)
