"""Sound follows the project, playback moves the playhead, and the recording is aligned."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile
from pytestqt.qtbot import QtBot

from app.audio.mix import mixdown
from app.audio.playback import Playback
from app.audio.render_process import RenderProcess
from app.audio.track import RATE_HZ
from app.editor.listening import RecordedTake
from app.editor.session import Session, Severity
from app.editor.sound import EditorSound
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.edit.piece import set_audio, set_offset
from app.project.edit.takes import add_takes, remove_take
from app.project.edit.tempo import scale_tempo, set_tempo
from app.project.model import Project
from app.score.model import PercussionHit
from tests.gui.transport.conftest import Elapse
from tests.gui.transport.devices import FakeDevices
from tests.support.takes import take_of
from tests.support.tasks import ImmediateTasks
from tests.unit.audio.pieces import melody, piece, quartet, with_players
from tests.unit.audio.test_follow import recorded as bent_sound
from tests.unit.audio.test_follow import truth

NAME = Message("edit.set_offset")


@pytest.fixture
def ready(sound: EditorSound, session: Session, qtbot: QtBot) -> EditorSound:
    """A short duet with rendered sound."""
    session.document.open(piece(melody((0, 960, 70), (960, 960, 72)), melody((1920, 960, 65))))
    wait_ready(sound, qtbot)
    return sound


def wait_ready(sound: EditorSound, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: not sound.is_busy)


def excerpt(sound: EditorSound, start_s: float, end_s: float) -> np.ndarray:
    """Samples played between two times."""
    return sound.playback.mix.read(round(start_s * RATE_HZ), round((end_s - start_s) * RATE_HZ))


def loudness(sound: EditorSound, start_s: float, end_s: float) -> float:
    return float(np.sqrt((excerpt(sound, start_s, end_s) ** 2).mean()))


def edit(session: Session, project: Project) -> None:
    session.apply(NAME, project)


def test_playing_moves_the_playhead(ready: EditorSound, session: Session, elapse: Elapse, qtbot: QtBot) -> None:
    session.playback.play(0.0)
    assert session.playing
    elapse(0.5)
    qtbot.waitUntil(lambda: session.playhead_s == pytest.approx(0.5, abs=0.003))
    session.playback.stop()
    assert not session.playing
    assert session.playhead_s == pytest.approx(0.5, abs=0.003)


def test_moving_the_playhead_moves_the_sound(
    ready: EditorSound, session: Session, elapse: Elapse, devices: FakeDevices
) -> None:
    session.set_playhead(1.0)
    assert ready.playback.position_s() == 1.0
    assert np.abs(devices.sink.sound).max() > 0.01, "a grain is heard"
    ready.playback.play()
    elapse(0.3)
    session.set_playhead(0.25)
    assert ready.playback.position_s() == 0.25
    elapse(0.7)
    assert ready.playback.position_s() == pytest.approx(0.75, abs=0.003)


def test_scrubbing_can_be_silent(ready: EditorSound, session: Session, devices: FakeDevices) -> None:
    session.listening.set(scrub_sound=False)
    session.set_playhead(1.0)
    assert not devices.sinks
    assert ready.playback.position_s() == 1.0


def test_films_get_the_sound_of_playback(ready: EditorSound, session: Session) -> None:
    assert excerpt(ready, 0.0, 3.0) == pytest.approx(mixdown(session.project, 0.0, 3.0), abs=1e-6)


def test_percussion_is_heard_as_in_films_and_can_be_silenced(
    ready: EditorSound, session: Session, qtbot: QtBot
) -> None:
    import msgspec

    before = excerpt(ready, 0.0, 3.0)
    hits = (PercussionHit(480, 36, 110), PercussionHit(960, 42, 110))
    edit(session, replace(session.project, score=msgspec.structs.replace(session.project.score, percussion=hits)))
    wait_ready(ready, qtbot)
    heard = excerpt(ready, 0.0, 3.0)
    np.testing.assert_allclose(heard, mixdown(session.project, 0.0, 3.0), atol=1e-6)
    assert np.abs(heard - before).max() > 0.02
    session.listening.set(percussion=False)
    np.testing.assert_allclose(excerpt(ready, 0.0, 3.0), before, atol=1e-6)


def test_mute_and_solo_take_effect_at_once(ready: EditorSound, session: Session, tasks: ImmediateTasks) -> None:
    rendered = len(tasks.names)
    edit(session, with_players(session.project, p0={"muted": True}))
    assert loudness(ready, 0.2, 0.9) < 1e-4
    assert loudness(ready, 2.2, 2.9) > 0.01
    edit(session, with_players(session.project, p0={"muted": False, "soloed": True}))
    assert loudness(ready, 0.2, 0.9) > 0.01
    assert loudness(ready, 2.7, 2.95) < 1e-3
    assert len(tasks.names) == rendered, "nothing was rendered for it"


def test_after_an_edit_only_what_changed_is_rendered(
    ready: EditorSound, session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    rendered = []
    real = RenderProcess.__call__
    monkeypatch.setattr(RenderProcess, "__call__", lambda self, midi: rendered.append(midi) or real(self, midi))
    before = excerpt(ready, 0.0, 1.0)
    project = session.project
    other = melody((1920, 960, 60))
    score = project.score
    parts = (score.parts[0], replace_notes(score.parts[1], other.notes))
    edit(session, replace(project, score=replace_parts(score, parts)))
    qtbot.waitUntil(lambda: len(rendered) == 1)
    wait_ready(ready, qtbot)
    assert len(rendered) == 1
    assert (excerpt(ready, 0.0, 1.0) == before).all()
    session.document.undo()
    wait_ready(ready, qtbot)
    assert len(rendered) == 1, "undo finds what was made before"


def replace_notes(part: object, notes: object) -> object:
    import msgspec

    return msgspec.structs.replace(part, notes=notes)


def replace_parts(score: object, parts: object) -> object:
    import msgspec

    return msgspec.structs.replace(score, parts=parts)


def test_another_tempo_changes_the_sound(ready: EditorSound, session: Session, qtbot: QtBot) -> None:
    edit(session, set_tempo(session.project, 0, 60.0))
    qtbot.waitUntil(lambda: loudness(ready, 4.2, 5.0) > 0.01)
    assert excerpt(ready, 0.0, 6.0) == pytest.approx(mixdown(session.project, 0.0, 6.0), abs=1e-6)


def test_the_click(ready: EditorSound, session: Session) -> None:
    quiet = loudness(ready, -0.6, -0.01)
    session.listening.set(click=True)
    assert loudness(ready, -0.6, -0.01) > quiet + 0.005
    session.listening.set(click=False)
    assert loudness(ready, -0.6, -0.01) == quiet


def test_the_loop_and_the_speed_reach_the_playback(
    ready: EditorSound, session: Session, elapse: Elapse, qtbot: QtBot
) -> None:
    session.set_loop((0.5, 1.0))
    session.listening.set(speed=0.5)
    ready.playback.play(0.5)
    elapse(1.5)
    assert ready.playback.position_s() == pytest.approx(0.75, abs=0.03)


@pytest.fixture
def recording(tmp_path: Path, session: Session, ready: EditorSound) -> Path:
    """The duet as a file that begins two seconds earlier."""
    played = mixdown(session.project, -2.0, 5.0)
    played += np.random.default_rng(0).normal(scale=1e-3, size=played.shape).astype(np.float32)
    path = tmp_path / "録音.flac"
    soundfile.write(path, played, RATE_HZ)
    return path


def add(session: Session, path: Path, qtbot: QtBot) -> None:
    assert session.attempt(NAME, lambda project: set_audio(project, path))
    qtbot.waitUntil(lambda: session.listening.waveform is not None)


def test_a_recording_sounds_at_its_offset(
    recording: Path, ready: EditorSound, session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(EditorSound, "estimate", lambda self, **how: None)
    add(session, recording, qtbot)
    assert session.listening.waveform.duration_s == pytest.approx(7.0)
    assert loudness(ready, 2.1, 2.9) > 0.01
    assert loudness(ready, 0.2, 0.9) < 0.01
    session.attempt(NAME, lambda project: set_offset(project, -2.0))
    assert loudness(ready, 0.2, 0.9) > 0.01
    session.listening.set(source="both")
    assert loudness(ready, 0.2, 0.9) > 0.02
    session.listening.set(source="recording")
    edit(session, with_players(session.project, p0={"muted": True}, p1={"muted": True}))
    assert loudness(ready, 0.2, 0.9) > 0.01
    session.attempt(NAME, lambda project: set_audio(project, None))
    assert session.listening.waveform is None
    assert loudness(ready, 0.2, 0.9) < 1e-4


def test_a_new_recording_finds_its_place_by_itself(
    sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    reported: list[tuple[Message, Severity]] = []
    session.noticed.connect(lambda message, severity: reported.append((message, severity)))
    path = tmp_path / "take.wav"
    soundfile.write(path, mixdown(session.project, -3.21, 30.0), RATE_HZ)
    add(session, path, qtbot)
    qtbot.waitUntil(lambda: session.project.audio is not None and session.project.audio.confidence is not None)
    assert session.project.audio.offset_s == pytest.approx(-3.21, abs=0.02)
    assert session.project.audio.confidence is not None
    assert session.project.audio.confidence > 0.6
    assert session.document.done[-1].name.id == "edit.estimate_offset"
    assert reported[-1][0].id.startswith("audio.offset_found")
    session.document.undo()
    assert session.project.audio.offset_s == 0.0
    session.document.undo()
    session.document.redo()
    qtbot.waitUntil(lambda: session.listening.waveform is not None)
    assert session.project.audio.offset_s == 0.0, "it is not estimated again behind one's back"
    assert len(session.document.undone) == 1


def test_another_piece_changes_nothing(sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    noise = np.random.default_rng(1).normal(scale=0.1, size=(20 * RATE_HZ, 2))
    soundfile.write(tmp_path / "rain.wav", noise, RATE_HZ)
    add(session, tmp_path / "rain.wav", qtbot)
    qtbot.waitUntil(lambda: bool(reported))
    assert reported[-1].id == "audio.not_recognised"
    assert session.project.audio.offset_s == 0.0
    assert len(session.document.done) == 1


def test_a_faster_recording_gives_its_tempo_when_asked(
    sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    before = session.project.score.tempo_map
    faster = scale_tempo(session.project, 1.03)
    soundfile.write(tmp_path / "fast.wav", mixdown(faster, -1.0, 40.0), RATE_HZ)
    add(session, tmp_path / "fast.wav", qtbot)
    qtbot.waitUntil(lambda: bool(reported))
    assert reported[-1].id.startswith("audio.other_tempo")
    assert session.project.score.tempo_map is before
    sound.estimate(with_tempo=True)
    assert reported[-1].id.startswith("audio.tempo_fitted")
    assert session.project.score.tempo_map.bpm[0][1] == pytest.approx(faster.score.tempo_map.bpm[0][1], rel=5e-4)
    assert session.project.audio.offset_s == pytest.approx(-1.0, abs=0.02)
    session.document.undo()
    assert session.project.score.tempo_map is before


def test_the_beats_follow_a_recording_with_a_tempo_of_its_own(
    sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    reported: list[tuple[Message, Severity]] = []
    session.noticed.connect(lambda message, severity: reported.append((message, severity)))
    before = session.project
    assert before.score.tempo_map == quartet().score.tempo_map
    soundfile.write(tmp_path / "rubato.flac", np.concatenate([np.zeros((2 * RATE_HZ, 2)), bent_sound()]), RATE_HZ)
    add(session, tmp_path / "rubato.flac", qtbot)
    qtbot.waitUntil(lambda: bool(reported))
    session.playback.stop()
    count = len(session.document.done)
    sound.follow()
    qtbot.waitUntil(lambda: len(session.document.done) > count)
    assert session.document.done[-1].name.id == "edit.follow_recording"
    assert reported[-1][0].id.startswith("audio.followed") or reported[-1][0].id.startswith("align.")
    project = session.project
    assert project.audio is not None
    assert [part.notes for part in project.score.parts] == [part.notes for part in before.score.parts]
    notes = np.array([note.onset_tick for part in before.score.parts for note in part.notes], np.float64)
    true_s = truth().score.tempo_map.seconds(notes) + 2.0
    errors_s = np.abs(project.score.tempo_map.seconds(notes) - project.audio.offset_s - true_s)
    assert np.median(errors_s) < 0.015
    session.document.undo()
    assert session.project.score.tempo_map is before.score.tempo_map


def test_a_missing_recording_is_reported_once(
    sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    reported: list[tuple[Message, Severity]] = []
    session.noticed.connect(lambda message, severity: reported.append((message, severity)))
    session.attempt(NAME, lambda project: set_audio(project, tmp_path / "gone.wav"))
    qtbot.waitUntil(lambda: bool(reported))
    assert reported[0][0].id == "file.cannot_read"
    assert reported[0][1] is Severity.ERROR
    edit(session, set_tempo(session.project, 0, 90.0))
    qtbot.wait(1)
    assert len(reported) == 1


def test_a_project_brings_its_own_offset(sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    soundfile.write(tmp_path / "r.wav", mixdown(session.project, 0.0, 10.0), RATE_HZ)
    project = set_offset(set_audio(session.project, tmp_path / "r.wav"), 1.5)
    session.document.open(project)
    qtbot.waitUntil(lambda: session.listening.waveform is not None)
    assert session.project is project


def test_a_recording_that_was_moved_keeps_its_offset(
    sound: EditorSound, session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    soundfile.write(tmp_path / "here.wav", mixdown(session.project, -2.0, 10.0), RATE_HZ)
    session.document.open(set_offset(set_audio(session.project, tmp_path / "there.wav"), 1.5))
    add(session, tmp_path / "here.wav", qtbot)
    assert session.project.audio.offset_s == 1.5
    session.attempt(NAME, lambda project: set_audio(project, None))
    session.document.undo()
    qtbot.waitUntil(lambda: session.listening.waveform is not None)
    assert session.project.audio.offset_s == 1.5
    assert len(session.document.done) == 1


def test_opening_stops_the_sound(ready: EditorSound, session: Session, elapse: Elapse) -> None:
    ready.playback.play(0.0)
    elapse(0.2)
    session.document.open(piece(melody((0, 480, 60))))
    assert not session.playing


@pytest.mark.parametrize("by_playing", [False, True])
def test_a_large_piece_is_rendered_once_it_is_planned_or_played(
    ready: EditorSound,
    session: Session,
    playback: Playback,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
    by_playing: bool,
) -> None:
    monkeypatch.setattr("app.editor.sound.REPORTED_NOTES", 1)
    session.document.open(piece(melody((0, 480, 60), (960, 480, 62)), melody((480, 480, 65))))
    assert not ready.is_busy, "planning needs the processor"
    session.set_playhead(0.2)
    assert not ready.is_busy
    assert loudness(ready, 0.0, 0.4) == 0.0
    if by_playing:
        playback.play(0.0)
    else:
        session.set_performance(Performance(session.project))
    assert ready.is_busy
    wait_ready(ready, qtbot)
    assert loudness(ready, 0.0, 0.4) > 0.0


def test_for_a_picture_the_recording_is_only_seen(
    session: Session, playback: Playback, qtbot: QtBot, tmp_path: Path, tasks: ImmediateTasks
) -> None:
    sound = EditorSound(session, playback, audible=False)
    assert session.playback is None
    soundfile.write(tmp_path / "r.wav", mixdown(session.project, -2.0, 5.0), RATE_HZ)
    add(session, tmp_path / "r.wav", qtbot)
    session.set_playhead(1.0)
    assert [name.id for name in tasks.names] == ["work.read_recording"]
    assert not sound.is_busy


def test_an_empty_piece_is_silent(sound: EditorSound, session: Session, qtbot: QtBot) -> None:
    session.document.open(piece())
    wait_ready(sound, qtbot)
    assert not excerpt(sound, -1.0, 2.0).any()


# Takes


def first(session: Session) -> str:
    return session.project.players[0].id


@pytest.fixture
def recorded(ready: EditorSound, session: Session, qtbot: QtBot) -> EditorSound:
    """Two takes of the first player: one of the second second, and an empty one."""
    takes = [take_of([(1.0, 1.9, 74, 0.8)], tempo_map=session.project.score.tempo_map), take_of([])]
    edit(session, add_takes(session.project, first(session), takes)[0])
    wait_ready(ready, qtbot)
    return ready


def test_an_auditioned_take_replaces_the_part_until_playback_stops(
    recorded: EditorSound, session: Session, elapse: Elapse, qtbot: QtBot
) -> None:
    before, project = excerpt(recorded, 0.0, 3.0), session.project
    recorded.listen(RecordedTake(first(session), "take:1", alone=False), 0.5)
    qtbot.waitUntil(lambda: session.playing)
    assert session.playhead_s == pytest.approx(0.5, abs=0.02)
    wait_ready(recorded, qtbot)
    assert np.abs(excerpt(recorded, 1.0, 1.9) - before[RATE_HZ : round(1.9 * RATE_HZ)]).max() > 0.01
    assert loudness(recorded, 2.2, 2.9) > 0.01, "the others play on"
    assert session.project is project, "nothing was taken"
    session.playback.stop()
    assert session.listening.take is None
    wait_ready(recorded, qtbot)
    assert excerpt(recorded, 0.0, 3.0) == pytest.approx(before, abs=1e-6)


def test_a_take_auditioned_alone_is_the_only_sound(recorded: EditorSound, session: Session, qtbot: QtBot) -> None:
    edit(session, with_players(session.project, p0={"muted": True}, p1={"soloed": True}))
    recorded.listen(RecordedTake(first(session), "take:1", alone=True), 1.0)
    wait_ready(recorded, qtbot)
    assert loudness(recorded, 1.1, 1.8) > 0.01
    assert loudness(recorded, 2.7, 2.95) < 1e-3
    recorded.stop_listening()
    assert not session.playing


def test_a_deleted_take_sounds_no_more(recorded: EditorSound, session: Session, qtbot: QtBot) -> None:
    recorded.listen(RecordedTake(first(session), "take:1", alone=True), 1.0)
    wait_ready(recorded, qtbot)
    edit(session, remove_take(session.project, first(session), "take:1"))
    wait_ready(recorded, qtbot)
    assert loudness(recorded, 2.2, 2.9) > 0.01


def test_another_piece_ends_listening(recorded: EditorSound, session: Session) -> None:
    recorded.listen(RecordedTake(first(session), "take:1", alone=True), 1.0)
    session.document.open(piece(melody((0, 960, 60))))
    assert session.listening.take is None
    assert not session.playing
