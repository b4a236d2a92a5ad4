"""Beats pinned to the recording: moved beats, unchanged beats, refused pins."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from app.errors import UsageError
from app.project.edit.pins import pin_beat, recording_second, remove_pins
from app.project.edit.tempo import set_tempo
from app.project.model import Project
from app.project.recording import AudioTrack, BeatPin, Doubt, with_places
from tests.unit.audio.pieces import quartet

OFFSET_S = -1.5


@pytest.fixture
def project() -> Project:
    """The quartet with a recording and a change of tempo in bar 5."""
    piece = quartet()
    piece = set_tempo(piece, int(piece.metre_map.tick_of_bar(5)), 100.0)
    return replace(piece, audio=AudioTrack("/music/concert.wav", OFFSET_S, 0.9))


def bar(project: Project, number: int) -> int:
    return int(project.metre_map.tick_of_bar(number))


def beats_s(project: Project) -> np.ndarray:
    """Time in seconds of every quarter in the recording."""
    ticks = np.arange(0, project.score.end_tick, project.score.ticks_per_quarter)
    return np.asarray(project.score.tempo_map.seconds(ticks) - project.audio.offset_s)


def pins(project: Project) -> tuple[BeatPin, ...]:
    return project.audio.pins


@pytest.mark.parametrize("by_s", [0.3, -0.3, 0.02])
def test_a_pinned_bar_takes_its_neighbours_along_and_nothing_far_away(project: Project, by_s: float) -> None:
    tick = bar(project, 8)
    to_s = recording_second(project, tick) + by_s
    after = pin_beat(project, tick, to_s)
    assert recording_second(after, tick) == pytest.approx(to_s, abs=1e-9)
    assert pins(after) == (BeatPin(tick, pytest.approx(to_s)),)
    moved_s = beats_s(after) - beats_s(project)
    ticks = np.arange(len(moved_s)) * project.score.ticks_per_quarter
    beats = (ticks - tick) / project.metre_map.felt_ticks_at(tick)
    assert np.abs(moved_s[np.abs(beats) > 9.0]).max() < 1e-9
    assert np.all(moved_s * np.sign(by_s) > -1e-9)
    near = moved_s[np.abs(beats) <= 8]
    assert np.abs(np.diff(near, n=2)).max() < 0.25 * abs(by_s), "smoothly"
    assert np.all(np.diff(beats_s(after)) > 0.0)
    assert (after.audio.offset_s, after.audio.confidence) == (OFFSET_S, 0.9)
    assert [part.notes for part in after.score.parts] == [part.notes for part in project.score.parts]
    assert after.corrections is project.corrections


def test_other_pins_stay(project: Project) -> None:
    for number in (6, 10):
        project = pin_beat(project, bar(project, number))
    before = project
    project = pin_beat(project, bar(project, 8), recording_second(project, bar(project, 8)) + 0.4)
    for number in (6, 10):
        assert recording_second(project, bar(project, number)) == pytest.approx(
            recording_second(before, bar(before, number)), abs=1e-9
        )
    far = pin_beat(project, bar(project, 8), 1000.0)
    assert recording_second(far, bar(far, 8)) < recording_second(far, bar(far, 10))
    assert [pin.tick for pin in pins(far)] == [bar(project, number) for number in (6, 8, 10)]
    assert np.all(np.diff(beats_s(far)) > 0.0)


def test_what_is_pinned_where_it_is_moves_nothing(project: Project) -> None:
    after = pin_beat(project, bar(project, 3))
    assert after.score is project.score
    assert pin_beat(after, bar(project, 3)) is after


def test_the_beginning_moves_the_recording(project: Project) -> None:
    after = pin_beat(project, 0, 1.7)
    assert after.audio.offset_s == pytest.approx(-1.7)
    assert after.audio.confidence is None
    assert beats_s(after)[20:] == pytest.approx(beats_s(project)[20:], abs=1e-9)
    other = pin_beat(project, bar(project, 1) + project.score.ticks_per_quarter, 2.2)
    assert other.audio.offset_s == OFFSET_S


def test_it_goes_back_to_what_following_makes_of_it(project: Project) -> None:
    after = pin_beat(pin_beat(project, bar(project, 3)), bar(project, 5))
    assert len(pins(remove_pins(after, {bar(project, 3)}))) == 1
    gone = remove_pins(after)
    assert not pins(gone)
    assert gone.score is after.score
    with pytest.raises(UsageError, match=r"pins\.none_here"):
        remove_pins(gone)


def test_a_bar_whose_beat_is_pinned_is_no_longer_doubtful(project: Project) -> None:
    assert project.audio is not None
    doubts = tuple(Doubt(bar(project, number), bar(project, number + 1), 0.2) for number in (7, 8))
    project = replace(project, audio=msgspec.structs.replace(project.audio, doubts=doubts))
    after = pin_beat(project, bar(project, 8))
    assert after.audio.doubts == doubts[:1]


def test_what_cannot_be_is_refused(project: Project) -> None:
    for tick in (-480, 2**62):
        with pytest.raises(UsageError, match=r"pins\.before_the_piece"):
            pin_beat(project, tick, 1.0)
    silent = replace(project, audio=None)
    for edit in (lambda: pin_beat(silent, 0), lambda: remove_pins(silent)):
        with pytest.raises(UsageError, match=r"piece\.no_recording"):
            edit()
    beside = bar(project, 3) + 2
    assert recording_second(project, beside) - recording_second(project, bar(project, 3)) < 0.02
    with pytest.raises(UsageError, match=r"pins\.no_room"):
        pin_beat(pin_beat(project, bar(project, 3)), beside)
    stale = pin_beat(pin_beat(project, bar(project, 3)), bar(project, 5))
    stale = set_tempo(stale, 0, 40.0)
    with pytest.raises(UsageError, match=r"pins\.no_room"):
        pin_beat(stale, bar(project, 4))


def test_pins_go_along_with_another_division() -> None:
    audio = AudioTrack("/x.wav", 0.0, None, (BeatPin(480, 1.0), BeatPin(960, 2.0)), (Doubt(0, 480, 0.1),))
    assert with_places(audio, lambda tick: 2 * tick).pins == (BeatPin(960, 1.0), BeatPin(1920, 2.0))
    assert not with_places(audio, lambda tick: 2 * tick).doubts
    assert [pin.tick for pin in with_places(audio, lambda tick: 7).pins] == [7]
