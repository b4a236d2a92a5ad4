"""Pitch classes, onsets and tuning of sounds with known values."""

from __future__ import annotations

import numpy as np
import pytest

from app.audio.features import chroma, onset_strength, tuning

RATE_HZ = 22050


def tone(pitch: float, seconds: float = 2.0, start_s: float = 0.0, harmonics: int = 4) -> np.ndarray:
    """A tone with fading overtones after a silence."""
    times_s = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    hz = 440.0 * 2.0 ** ((pitch - 69.0) / 12.0)
    sound = sum(np.sin(2 * np.pi * hz * k * times_s) / k**2 for k in range(1, harmonics + 1))
    return np.asarray(0.3 * sound * (times_s >= start_s), np.float32)


@pytest.mark.parametrize("pitch", [46, 60, 65, 71, 84])
def test_a_tone_is_its_pitch_class(pitch: int) -> None:
    energy = chroma(tone(pitch), RATE_HZ, 4096, 2048, 0.0)
    assert energy.shape == (12, 2 * RATE_HZ // 2048 + 1)
    assert (energy.argmax(axis=0) == pitch % 12).all()
    assert energy.sum(axis=1).argmax() == pitch % 12


@pytest.mark.parametrize("off", [-0.4, -0.1, 0.0, 0.25, 0.45])
def test_the_tuning_of_a_chord_is_found(off: float) -> None:
    chord = sum(tone(pitch + off, 4.0) for pitch in (58, 65, 70, 74))
    assert tuning(np.asarray(chord, np.float32), RATE_HZ) == pytest.approx(off, abs=0.03)


def test_silence_and_very_short_sounds_have_features_too() -> None:
    for sound in (np.zeros(4 * RATE_HZ, np.float32), np.zeros(1, np.float32), tone(60)[:300]):
        assert abs(tuning(sound, RATE_HZ)) <= 0.5
        assert np.isfinite(chroma(sound, RATE_HZ, 4096, 2048, 0.0)).all()
        assert np.isfinite(onset_strength(sound, RATE_HZ, 1024, 220)).all()


def test_tones_begin_where_they_begin() -> None:
    # Longer than the frames that are transformed at once: 1,024 of 10 ms.
    starts_s = np.arange(0.5, 14.0, 0.71)
    times_s = np.arange(15 * RATE_HZ) / RATE_HZ
    sound = np.zeros(len(times_s), np.float32)
    for index, start_s in enumerate(starts_s):
        sound += tone(55 + index, 15.0, start_s) * np.exp(-8.0 * np.maximum(times_s - start_s, 0.0)).astype(np.float32)
    strength = onset_strength(sound, RATE_HZ, 1024, 220)
    assert len(strength) == len(sound) // 220 + 1
    peaks = np.flatnonzero((strength[1:-1] > strength[:-2]) & (strength[1:-1] >= strength[2:])) + 1
    highest = np.sort(peaks[np.argsort(strength[peaks])[-len(starts_s) :]]) * 220 / RATE_HZ
    assert np.abs(highest - starts_s).max() < 0.025
