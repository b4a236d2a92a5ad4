"""The test beep is audible, short, and has no click at its ends."""

from __future__ import annotations

import numpy as np

from app.audio.click import BEEP_S, beep_track
from app.audio.track import RATE_HZ, Mix


def test_it_is_the_tuning_pitch_and_begins_and_ends_softly() -> None:
    sound = Mix([beep_track()]).read(0, RATE_HZ)[:, 0]
    count = round(BEEP_S * RATE_HZ)
    spectrum = np.abs(np.fft.rfft(sound[:count]))
    assert np.argmax(spectrum) * RATE_HZ / count == 440.0
    assert 0.2 < np.abs(sound).max() < 0.8
    assert np.abs(np.diff(sound)).max() < 0.05
    assert not sound[count:].any()
