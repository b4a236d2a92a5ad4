"""Sound of a project: tracks, mutes, panning, and sound of films."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
import soundfile
from hypothesis import given, settings
from hypothesis import strategies as st

from app.audio.mix import mixdown, place_gains, player_tracks
from app.audio.synth import Synthesiser, drum_phrases
from app.audio.track import RATE_HZ, AudioSegment, MixTrack, soft_clipped
from app.errors import Cancelled, FileError
from app.project.recording import AudioTrack
from app.score.model import PercussionHit
from tests.unit.audio.pieces import melody, piece, quartet, with_players

DUET = piece(melody((0, 480, 70), (480, 480, 72)), melody((960, 960, 65)))


@settings(max_examples=50, deadline=None)
@given(
    pieces=st.lists(st.tuples(st.integers(-500, 3000), st.integers(0, 800), st.integers(-9000, 9000)), max_size=12),
    start=st.integers(-800, 3500),
    count=st.integers(0, 1500),
)
def test_a_block_is_the_plain_sum(pieces: list[tuple[int, int, int]], start: int, count: int) -> None:
    long = np.zeros((6000, 2))
    for at, length, value in pieces:
        long[at + 1000 : at + 1000 + length] += np.array([0.5, 0.25]) * value / 32768
    track = MixTrack([AudioSegment(at, np.full(length, value, np.int16)) for at, length, value in pieces], 0.5, 0.25)
    out = np.zeros((count, 2), np.float32)
    track.add_to(out, start)
    assert out == pytest.approx(long[start + 1000 : start + 1000 + count], abs=1e-5)


def test_loud_sums_are_bent_and_soft_ones_are_not() -> None:
    soft = np.linspace(-0.79, 0.79, 100, dtype=np.float32).reshape(50, 2)
    assert soft_clipped(soft) is soft
    loud = np.linspace(-4.0, 4.0, 1000, dtype=np.float32).reshape(500, 2)
    bent = soft_clipped(loud)
    assert np.abs(bent).max() <= 1.0
    assert (np.diff(bent.ravel()) >= 0).all()
    same = np.abs(loud) < 0.8
    assert (bent[same] == loud[same]).all()


def test_mute_and_solo_are_obeyed_as_on_a_desk() -> None:
    pieces = {player.id: [AudioSegment(0, np.ones(10, np.int16))] for player in DUET.players}
    assert len(player_tracks(DUET, pieces)) == 2
    assert len(player_tracks(with_players(DUET, p0={"muted": True}), pieces)) == 1
    assert len(player_tracks(with_players(DUET, p0={"soloed": True}), pieces)) == 1
    assert len(player_tracks(with_players(DUET, p0={"soloed": True, "muted": True}), pieces)) == 1
    both = with_players(DUET, p0={"muted": True}, p1={"muted": True})
    assert player_tracks(both, pieces) == ()


def test_players_are_panned_by_their_places() -> None:
    left, right = place_gains(-1.0, 1.0)
    assert left > right > 0
    assert place_gains(1.0, 1.0) == pytest.approx((right, left))
    assert place_gains(0.0, 1.0) == pytest.approx((1.0, 1.0))
    assert place_gains(0.0, 0.0) == pytest.approx((1.0, 1.0))
    for x_m in np.linspace(-2, 2, 9):
        gains = place_gains(float(x_m), 2.0)
        assert gains[0] ** 2 + gains[1] ** 2 == pytest.approx(2.0)


def test_the_synthesiser_plays_notes_when_they_are_written() -> None:
    sound = mixdown(DUET, -0.5, 3.0)
    assert sound.shape == (round(3.5 * RATE_HZ), 2)
    level = np.sqrt((sound**2).mean(axis=1).reshape(-1, RATE_HZ // 100).mean(axis=1))
    assert (level[:48] < 1e-4).all()
    assert level[52:240].min() > 0.01
    onset_s = np.flatnonzero(level > 0.02)[0] / 100 - 0.5
    assert onset_s == pytest.approx(0.0, abs=0.021)


def test_a_span_is_a_part_of_the_whole() -> None:
    whole = mixdown(DUET, 0.0, 3.0)
    part = mixdown(DUET, 1.25, 2.25)
    assert part == pytest.approx(whole[round(1.25 * RATE_HZ) : round(2.25 * RATE_HZ)], abs=1e-6)


@pytest.mark.parametrize("rate_hz", [44100, 22050, 96000])
def test_any_rate(rate_hz: int) -> None:
    sound = mixdown(DUET, 0.0, 1.0, rate_hz)
    assert sound.shape == (rate_hz, 2)
    assert np.abs(sound).max() > 0.05


def test_percussion_sounds_when_it_is_struck_unless_a_player_is_soloed() -> None:
    hits = tuple(PercussionHit(tick, pitch, 100) for tick, pitch in ((1920, 36), (2400, 42), (2400, 26), (9600, 81)))
    drummed = replace(DUET, score=msgspec.structs.replace(DUET.score, percussion=hits))
    silent = with_players(drummed, **{f"p{number}": {"muted": True} for number in range(len(DUET.players))})
    sound = np.abs(mixdown(silent, 0.0, 12.0)).max(axis=1)
    for struck_s in (2.0, 2.5, 10.0):
        at = round(struck_s * RATE_HZ)
        assert sound[max(at - 4800, 0) : at - 48].max() < 0.2 * sound[at : at + 4800].max()
        assert np.flatnonzero(sound[at - 48 :] > 0.2 * sound[at : at + 4800].max())[0] < 0.02 * RATE_HZ
    assert sound.max() > 0.05
    soloed, alone = (mixdown(with_players(one, p0={"soloed": True}), 0.0, 3.0) for one in (drummed, DUET))
    np.testing.assert_array_equal(soloed, alone)


def test_the_kit_has_every_sound_of_general_midi() -> None:
    synthesiser = Synthesiser()
    for pitch in range(27, 88):
        (phrase,) = drum_phrases([PercussionHit(0, pitch, 90)], DUET.score.tempo_map)
        assert np.abs(synthesiser.render(phrase).samples).max() > 300, pitch


def test_a_muted_player_is_silent() -> None:
    alone = mixdown(with_players(DUET, p0={"muted": True}), 0.0, 0.9)
    assert np.abs(alone).max() < 1e-4


def test_with_a_recording_it_is_the_recording_at_its_place(tmp_path: Path) -> None:
    click = np.zeros((RATE_HZ, 2), np.float32)
    click[1000] = 0.5
    soundfile.write(tmp_path / "r.wav", click, RATE_HZ)
    project = replace(DUET, audio=AudioTrack(str(tmp_path / "r.wav"), offset_s=-0.25))
    sound = mixdown(project, -1.0, 1.0)
    loudest = int(np.abs(sound[:, 0]).argmax())
    assert loudest == round(0.75 * RATE_HZ) + 1000
    assert np.count_nonzero(np.abs(sound) > 1e-3) == 2
    with pytest.raises(FileError):
        mixdown(replace(DUET, audio=AudioTrack(str(tmp_path / "gone.wav"))), 0.0, 1.0)


def test_a_resampled_recording_stays_within_full_scale(tmp_path: Path) -> None:
    square = np.where(np.arange(RATE_HZ) // 24 % 2, 0.999, -0.999).astype(np.float32)
    soundfile.write(tmp_path / "r.wav", np.stack([square, square], axis=1), RATE_HZ)
    sound = mixdown(replace(DUET, audio=AudioTrack(str(tmp_path / "r.wav"))), 0.1, 0.9, 44100)
    assert 0.95 < np.abs(sound).max() <= 1.0


def test_it_can_be_stopped_and_says_where_it_stands() -> None:
    with pytest.raises(Cancelled):
        mixdown(quartet(), 0.0, 5.0, stop_requested=lambda: True)
    shares: list[float] = []
    mixdown(DUET, 0.0, 1.0, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_nothing_to_hear() -> None:
    assert not mixdown(piece(), 0.0, 0.1).any()
    assert mixdown(DUET, 1.0, 1.0).shape == (0, 2)


def test_an_ensemble_is_about_as_loud_as_one() -> None:
    one = piece(melody((0, 1920, 70)))
    eight = piece(*(melody((0, 1920, 60 + i)) for i in range(8)))
    levels = [np.sqrt((mixdown(project, 0.2, 1.8) ** 2).mean()) for project in (one, eight)]
    assert 0.05 < levels[0] < 0.4
    assert 0.5 < levels[1] / levels[0] < 2.0
