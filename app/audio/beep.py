"""A short tone to test the audio output."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.audio.track import RATE_HZ, AudioSegment, MixTrack

BEEP_S: Final = 0.5
_HZ: Final = 440.0
_FADE_S: Final = 0.02


def beep_track() -> MixTrack:
    """A tone of the tuning pitch at 0 s."""
    times_s = np.arange(round(BEEP_S * RATE_HZ)) / RATE_HZ
    fade = np.minimum(1.0, np.minimum(times_s, BEEP_S - times_s) / _FADE_S)
    return MixTrack([AudioSegment(0, np.round(np.sin(2 * np.pi * _HZ * times_s) * fade * 12000).astype(np.int16))])
