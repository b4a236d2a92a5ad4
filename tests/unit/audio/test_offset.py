"""Offset and tempo of recordings with known values: renders of scores with many kinds of flaws."""

from __future__ import annotations

from functools import cache

import msgspec
import numpy as np
import pytest
from scipy.signal import fftconvolve, resample_poly

from app.audio.mix import mixdown
from app.audio.offset import Estimate, estimate_offset
from app.audio.track import RATE_HZ, Samples
from app.errors import AppError, Cancelled
from app.project.edit.tempo import scale_tempo
from app.project.model import Project
from app.score.model import Score
from tests.unit.audio.pieces import melody, piece, quartet, steady_run

RNG = np.random.default_rng(5)
MOST_ERROR_S = 0.02


@cache
def render(ratio: float = 1.0) -> np.ndarray:
    """Render the quartet at a tempo factor, from its first bar to two seconds after the end."""
    project = scale_tempo(quartet(), ratio)
    return mixdown(project, 0.0, end_s(project) + 2.0)


def end_s(project: Project) -> float:
    return project.score.tempo_map.seconds(float(project.score.end_tick))


def as_samples(sound: np.ndarray) -> Samples:
    return np.clip(np.round(sound / max(np.abs(sound).max(), 1e-9) * 24000), -32768, 32767).astype(np.int16)


def noise(seconds: float, level: float) -> np.ndarray:
    return RNG.normal(scale=level, size=(round(seconds * RATE_HZ), 2)).astype(np.float32)


def check(name: str, sound: np.ndarray, offset_s: float, ratio: float = 1.0, score: Score | None = None) -> Estimate:
    found = estimate_offset(as_samples(sound), RATE_HZ, score or quartet().score)
    error_s = found.offset_s - offset_s
    print(f"{name}: {1000 * error_s:+.1f} ms, tempo {found.tempo_ratio:.4f}, confidence {found.confidence:.2f}")
    assert abs(error_s) < MOST_ERROR_S
    assert found.tempo_ratio == pytest.approx(ratio, abs=5e-4)
    assert found.confidence > 0.6
    return found


@pytest.mark.parametrize("ratio", [0.94, 1.0, 1.06])
def test_tempi(ratio: float) -> None:
    check(f"tempo {ratio}", render(ratio), 0.0, ratio)


def test_silence_and_applause_around_it() -> None:
    check("37 s before", np.concatenate([noise(37.123, 0.002), render()]), -37.123)
    applause = noise(95.5, 0.1)
    check("applause", np.concatenate([applause, render(1.06), applause[: 20 * RATE_HZ]]), -95.5, 1.06)


def test_first_bars_and_last_bars_missing() -> None:
    check("first bars missing", render()[round(9.37 * RATE_HZ) :], 9.37)
    check("last half missing", render()[: len(render()) * 55 // 100], 0.0)


def test_noise_at_ten_decibels() -> None:
    sound = render()
    hiss = noise(len(sound) / RATE_HZ + 1, 1.0)[: len(sound)]
    hiss *= np.sqrt((sound**2).mean()) * 10 ** (-10 / 20)
    check("noise at 10 dB", sound + hiss, 0.0)


def test_a_hall() -> None:
    times_s = np.arange(RATE_HZ) / RATE_HZ
    response = RNG.normal(size=RATE_HZ) * np.exp(-6.9 * times_s / 1.2)
    response[0] = 20.0
    check("reverberation of 1.2 s", fftconvolve(render(), response[:, None] / 20.0, axes=0), 0.0)


def test_another_tuning() -> None:
    # 442.8 Hz: 156 / 155 faster is 11 cents higher too, so the truth has another tempo.
    sound = resample_poly(render(), 155, 156, axis=0)
    check("11 cents sharp", sound, 0.0, 156 / 155)


def test_another_sound() -> None:
    """The recording is low-passed and mixed to one channel, as through a telephone."""
    sound = render()[:, :1]
    kernel = np.sinc(np.arange(-200, 201) * 2 * 3000 / RATE_HZ) * np.hanning(401)
    low = fftconvolve(sound, kernel[:, None] / kernel.sum(), mode="same", axes=0)
    check("telephone", np.repeat(low, 2, axis=1), 0.0)


@pytest.mark.parametrize("ticks", [120, 240])
def test_the_silence_before_a_run_of_equal_notes_changes_nothing(ticks: int) -> None:
    """A shift by whole notes fits the onsets equally well, and frames begin anywhere within a note."""
    for seed in (1, 2):
        project = steady_run(seed, ticks, 19200 // ticks)
        sound = mixdown(project, 0.0, end_s(project) + 1.0)
        for lead_s in (0.0, 0.5, 1.8, 3.05, 8.0):
            before = np.zeros((round(lead_s * RATE_HZ), 2), np.float32)
            found = check(f"{ticks} {seed} {lead_s}", np.concatenate([before, sound]), -lead_s, score=project.score)
            assert found.runner_up is None or found.runner_up.confidence < found.confidence


def other_piece() -> Project:
    pitches = np.random.default_rng(3).integers(55, 80, 260)
    lengths = np.random.default_rng(4).choice([120, 240, 360, 480], 260)
    onsets = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    return piece(melody(*zip(onsets.tolist(), lengths.tolist(), pitches.tolist(), strict=True)))


def test_another_piece_is_not_recognised() -> None:
    other = other_piece()
    sound = mixdown(other, 0.0, end_s(other))
    found = estimate_offset(as_samples(sound), RATE_HZ, quartet().score)
    reverse = estimate_offset(as_samples(render()), RATE_HZ, other.score)
    print(f"another piece: {found.confidence:.2f}, {reverse.confidence:.2f}")
    assert found.confidence < 0.3
    assert reverse.confidence < 0.3
    check("that piece itself", sound, 0.0, score=other.score)


@pytest.mark.parametrize("semitones", [-3, 2, 5])
def test_a_transposed_piece_is_not_recognised(semitones: int) -> None:
    score = quartet().score
    parts = tuple(
        msgspec.structs.replace(
            part, notes=tuple(msgspec.structs.replace(note, pitch=note.pitch + semitones) for note in part.notes)
        )
        for part in score.parts
    )
    found = estimate_offset(as_samples(render()), RATE_HZ, msgspec.structs.replace(score, parts=parts))
    print(f"{semitones:+d} semitones: {found.confidence:.2f}")
    assert found.confidence < 0.3


def test_noise_alone_is_not_recognised() -> None:
    assert estimate_offset(as_samples(noise(60.0, 0.2)), RATE_HZ, quartet().score).confidence < 0.3


def test_a_few_notes_do() -> None:
    short = piece(melody((0, 480, 60), (480, 240, 64), (720, 720, 67), (1440, 480, 65), (1920, 960, 72)))
    sound = np.concatenate([noise(2.0, 0.001), mixdown(short, 0.0, 4.0)])
    found = estimate_offset(as_samples(sound), RATE_HZ, short.score)
    assert found.offset_s == pytest.approx(-2.0, abs=0.05)


def test_nothing_to_compare() -> None:
    silence = np.zeros((RATE_HZ, 2), np.int16)
    for samples, score in (
        (silence, quartet().score),
        (silence[:0], quartet().score),
        (as_samples(noise(1.0, 0.1)), piece().score),
    ):
        with pytest.raises(AppError, match="nothing_to_compare"):
            estimate_offset(samples, RATE_HZ, score)


def test_shorter_than_a_frame() -> None:
    found = estimate_offset(as_samples(noise(0.01, 0.1)), RATE_HZ, quartet().score)
    assert found.confidence < 0.3


def test_it_can_be_stopped_and_says_where_it_stands() -> None:
    with pytest.raises(Cancelled):
        estimate_offset(as_samples(noise(5.0, 0.1)), RATE_HZ, quartet().score, stop_requested=lambda: True)
    shares: list[float] = []
    estimate_offset(as_samples(noise(5.0, 0.1)), RATE_HZ, quartet().score, shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1.0)
