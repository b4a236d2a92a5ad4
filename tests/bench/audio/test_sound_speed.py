"""Speed of the sound code, printed as ratios to a loop of plain Python in the same run; nothing is asserted."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from statistics import median

import msgspec
import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from app.audio.mix import player_phrases
from app.audio.offset import estimate_offset
from app.audio.playback import Playback
from app.audio.reader import Reader
from app.audio.synth import Synthesiser
from app.audio.track import RATE_HZ, AudioSegment, Mix, MixTrack
from app.audio.waveform_peaks import Peaks
from app.editor.session import Session
from app.editor.sound import EditorSound
from app.errors import Message
from app.project.model import Project
from tests.gui.transport.devices import FakeDevices, Time
from tests.support.tasks import ImmediateTasks
from tests.unit.audio.pieces import quartet
from widgets.transport.bar import TransportBar

pytestmark = pytest.mark.bench


def took_s(work: Callable[[], object], times: int = 1) -> float:
    """Median of several runs."""
    runs = []
    for _ in range(times):
        start_s = time.perf_counter()
        work()
        runs.append(time.perf_counter() - start_s)
    return median(runs)


def report(name: str, seconds: float) -> None:
    def calibration() -> None:
        sum(number * number for number in range(200_000))

    print(f"{name}: {1000 * seconds:.2f} ms, {seconds / took_s(calibration, 3):.2f} x the calibration loop")


def crowd(count: int) -> Project:
    """The quartet's players repeatedly, each part 25 times as long: 50 players with about 160,000 notes."""
    project = quartet()
    score = project.score
    long = []
    for index in range(count):
        part = score.parts[index % 4]
        notes = tuple(
            msgspec.structs.replace(
                note, id=f"{index}:{turn}:{note.id}", onset_tick=note.onset_tick + turn * score.end_tick
            )
            for turn in range(25)
            for note in part.notes
        )
        long.append(msgspec.structs.replace(part, id=f"p{index}", notes=notes))
    players = tuple(
        msgspec.structs.replace(project.players[i % 4], id=f"p{i}", part_id=f"p{i}", name=f"P{i}") for i in range(count)
    )
    return replace(project, score=msgspec.structs.replace(score, parts=tuple(long)), players=players)


def test_the_synthesiser() -> None:
    project = quartet()
    phrases = [phrase for player in project.players for phrase in player_phrases(project, player)]
    report("cutting the quartet", took_s(lambda: [player_phrases(project, player) for player in project.players], 3))
    synthesiser = Synthesiser()
    runs = [took_s(lambda phrase=phrase: synthesiser.render(phrase)) for phrase in phrases]
    report(f"one phrase of {len(phrases)}", median(runs))
    report("the longest", max(runs))
    end_s = project.score.tempo_map.seconds(float(project.score.end_tick))
    print(f"{len(project.players) * end_s / sum(runs):.0f} times as fast as it is heard")


def test_reading_a_mix_of_fifty() -> None:
    noise = np.random.default_rng(0).integers(-3000, 3000, RATE_HZ * 8, dtype=np.int16)
    mix = Mix([MixTrack([AudioSegment(second * RATE_HZ, noise) for second in range(0, 600, 7)]) for _ in range(50)])
    for speed in (1.0, 0.5):
        reader = Reader(mix, 10.0, speed)
        report(f"10 ms of fifty players at {speed}", took_s(lambda reader=reader: reader.read(480), 200))


def test_a_frame_while_it_plays(qtbot: QtBot) -> None:
    session = Session(quartet(), ImmediateTasks())
    now = Time()
    playback = Playback(FakeDevices(now).open, now)
    sound = EditorSound(session, playback)
    bar = TransportBar(session)
    qtbot.addWidget(bar)
    bar.resize(1500, bar.sizeHint().height())
    with qtbot.waitExposed(bar):
        bar.show()
    playback.play(0.0)

    def frame() -> None:
        now.now_s += 1 / 60
        playback.feed()
        sound._follow_sound()

    report("feeding and following", took_s(frame, 200))

    def shown() -> None:
        frame()
        bar.repaint()

    report("with the bar painted", took_s(shown, 100))
    playback.stop()


def test_an_edit_of_a_large_score(qtbot: QtBot) -> None:
    project = crowd(50)
    session = Session(project, ImmediateTasks())
    sound = EditorSound(session, Playback(FakeDevices(Time()).open))
    print(sum(len(part.notes) for part in project.score.parts), "notes")
    phrases = took_s(lambda: [player_phrases(project, player) for player in project.players[:5]])
    report("cutting a player of 3,000 notes", phrases / 5)

    def edit() -> None:
        players = session.project.players
        first = msgspec.structs.replace(players[0], muted=not players[0].muted)
        session.apply(Message("edit.mute"), replace(session.project, players=(first, *players[1:])))

    report("an edit, passed to the sound", took_s(edit, 20))
    sound.deleteLater()


def test_the_picture_of_an_hour() -> None:
    samples = np.random.default_rng(0).integers(-9000, 9000, (RATE_HZ * 3600, 2), dtype=np.int16)
    report("making it", took_s(lambda: Peaks(samples, RATE_HZ)))
    peaks = Peaks(samples, RATE_HZ)
    for span_s in (0.01, 1.0, 60.0, 3600.0):
        report(f"{span_s:g} s on 1600 px", took_s(lambda span_s=span_s: peaks.levels(0.0, span_s, 1600), 20))


def test_the_offset_of_ten_minutes() -> None:
    project = quartet()
    score = project.score
    length = score.end_tick
    notes = {
        part.id: tuple(
            msgspec.structs.replace(note, onset_tick=note.onset_tick + turn * length, pitch=note.pitch + turn % 3)
            for turn in range(6)
            for note in part.notes
        )
        for part in score.parts
    }
    parts = tuple(msgspec.structs.replace(part, notes=notes[part.id]) for part in score.parts)
    noise = np.random.default_rng(0).integers(-9000, 9000, (RATE_HZ * 600, 2), dtype=np.int16)
    long = msgspec.structs.replace(score, parts=parts)
    estimate_offset(noise[: RATE_HZ * 5], RATE_HZ, long)
    report("the offset of ten minutes", took_s(lambda: estimate_offset(noise, RATE_HZ, long)))
