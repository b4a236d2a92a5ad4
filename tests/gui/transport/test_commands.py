"""Every playback command, triggered like by menu and keys."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.sound import EditorSound
from app.errors import Message
from app.project.edit.piece import set_audio
from app.shell.actions import ActionTable
from app.shell.commands import edit, playback
from tests.gui.transport.conftest import Elapse
from widgets.common.actions import actions


@pytest.fixture
def table(session: Session, sound: EditorSound, tmp_path: Path) -> ActionTable:
    result = ActionTable(session, Settings(tmp_path / "settings.toml"), (*edit.ACTIONS, *playback.ACTIONS))
    result.refresh()
    return result


@pytest.fixture
def run(session: Session, table: ActionTable) -> object:
    def trigger(name: str) -> None:
        table.refresh()
        assert actions(session)[f"play.{name}"].isEnabled()
        actions(session)[f"play.{name}"].trigger()

    return trigger


def seconds(session: Session, bar: int) -> float:
    score = session.project.score
    return score.tempo_map.seconds(float(score.metre_map.tick_of_bar(bar)))


def test_play_and_stop_here(run, session: Session, elapse: Elapse) -> None:  # type: ignore[no-untyped-def]
    session.set_playhead(4.0)
    run("toggle")
    assert session.playing
    elapse(0.5)
    run("toggle")
    assert not session.playing
    assert session.playhead_s == pytest.approx(4.5, abs=0.003)


def test_from_the_start_of_the_bar(run, session: Session, elapse: Elapse) -> None:  # type: ignore[no-untyped-def]
    session.set_playhead(seconds(session, 7) + 0.9)
    run("bar")
    elapse(0.25)
    assert session.playing
    assert session.playback.position_s() == pytest.approx(seconds(session, 7) + 0.25, abs=0.003)
    run("bar")
    assert session.playhead_s == pytest.approx(seconds(session, 7), abs=0.003)
    assert session.playing


def test_stop_goes_back_when_it_stands(run, session: Session) -> None:  # type: ignore[no-untyped-def]
    start_s = session.performance.time_frame.first_frame_s
    session.set_playhead(9.0)
    run("toggle")
    run("stop")
    assert not session.playing
    assert session.playhead_s == pytest.approx(9.0, abs=0.02)
    session.set_loop((8.0, 10.0))
    run("stop")
    assert session.playhead_s == 8.0
    run("stop")
    assert session.playhead_s == start_s


def test_start_and_end(run, session: Session) -> None:  # type: ignore[no-untyped-def]
    run("to_end")
    score = session.project.score
    assert session.playhead_s == score.tempo_map.seconds(float(score.end_tick))
    run("to_start")
    assert session.playhead_s == session.performance.time_frame.first_frame_s < 0


@pytest.mark.parametrize("from_s", [0.0, 1.0, 1.005, -0.5])
def test_frames_are_stepped(run, session: Session, from_s: float) -> None:  # type: ignore[no-untyped-def]
    fps = float(session.project.fps)
    session.set_playhead(from_s)
    run("frame_on")
    first = session.playhead_s
    assert from_s < first <= from_s + 1 / fps + 1e-9
    assert first * fps == pytest.approx(round(first * fps), abs=1e-9)
    for _ in range(100):
        run("frame_on")
    assert session.playhead_s == pytest.approx(first + 100 / fps, abs=1e-9)
    for _ in range(101):
        run("frame_back")
    assert session.playhead_s == pytest.approx(first - 1 / fps, abs=1e-9)


def test_notes_of_the_player_in_front(run, session: Session) -> None:  # type: ignore[no-untyped-def]
    player = session.project.players[2]
    session.set_players((player.id,))
    score = session.project.score
    onsets = sorted({score.tempo_map.seconds(float(n.onset_tick)) for n in session.project.part(player).notes})
    session.set_playhead(-1.0)
    seen = []
    for _ in range(12):
        run("note_on")
        seen.append(session.playhead_s)
    assert seen == onsets[:12]
    run("note_back")
    assert session.playhead_s == onsets[10]
    session.set_playhead(onsets[-1])
    run("note_on")
    assert session.playhead_s == onsets[-1]
    session.set_playhead(onsets[0])
    run("note_back")
    assert session.playhead_s == onsets[0]


def test_bars(run, session: Session) -> None:  # type: ignore[no-untyped-def]
    session.set_playhead(seconds(session, 4) + 0.1)
    run("bar_back")
    assert session.playhead_s == seconds(session, 4)
    run("bar_back")
    assert session.playhead_s == seconds(session, 3)
    for _ in range(5):
        run("bar_on")
    assert session.playhead_s == seconds(session, 8)


def test_the_loop_is_what_is_selected(run, session: Session) -> None:  # type: ignore[no-untyped-def]
    project = session.project
    clock = project.score.tempo_map.seconds
    notes = project.score.parts[0].notes[3:6]
    session.select(Selection(notes=frozenset(note.id for note in notes)))
    run("loop")
    assert session.loop_s == (clock(float(notes[0].onset_tick)), clock(float(notes[-1].end_tick)))
    session.select(Selection(span=(960, 1920)))
    run("loop")
    assert session.loop_s == (clock(960.0), clock(1920.0))
    run("loop")
    assert session.loop_s is None
    session.select(Selection())
    session.set_playhead(seconds(session, 5) + 0.3)
    run("loop")
    assert session.loop_s == (seconds(session, 5), seconds(session, 6))
    run("loop")
    assert session.loop_s is None


def test_speeds_are_alternatives(run, session: Session, table: ActionTable) -> None:  # type: ignore[no-untyped-def]
    for percent in (25, 50, 75, 150, 200, 100):
        run(f"speed_{percent}")
        assert session.listening.speed == percent / 100
        table.refresh()
        checked = [id for id, action in actions(session).items() if "speed" in id and action.isChecked()]
        assert checked == [f"play.speed_{percent}"]
    run("speed_100")
    assert session.listening.speed == 1.0
    table.refresh()
    assert actions(session)["play.speed_100"].isChecked()


def test_toggles(run, session: Session, table: ActionTable) -> None:  # type: ignore[no-untyped-def]
    for name, value in (
        ("click", lambda: session.listening.click),
        ("scrub", lambda: session.listening.scrub_sound),
        ("follow", lambda: session.follow),
    ):
        before = value()
        run(name)
        assert value() is not before
        table.refresh()
        assert actions(session)[f"play.{name}"].isChecked() is value()
        run(name)
        assert value() is before


def test_what_needs_a_recording_is_off_without(run, session: Session, table: ActionTable) -> None:  # type: ignore[no-untyped-def]
    names = ("source_recording", "source_both", "estimate_offset", "fit_tempo", "remove_recording")
    assert not any(actions(session)[f"play.{name}"].isEnabled() for name in names)
    session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, "/nowhere/a.wav"))
    run("source_both")
    assert session.listening.source == "both"
    run("source_synthesiser")
    assert session.listening.source == "synthesiser"
    assert not actions(session)["play.estimate_offset"].isEnabled(), "it is not read"
    run("remove_recording")
    assert session.project.audio is None
    assert session.document.done[-1].name.id == "edit.remove_audio"
    session.document.undo()
    assert session.project.audio is not None


def test_without_a_playback_nothing_plays(session: Session, table: ActionTable) -> None:
    session.playback = None
    table.refresh()
    assert not actions(session)["play.toggle"].isEnabled()
    playback.toggle(session)
    playback.stop(session)
    playback.play_bar(session)
    assert not session.playing
