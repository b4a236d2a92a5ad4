"""The metronome (clicks on the beats of the score), and a tone to test the audio output."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Final

import numpy as np

from app.audio.track import RATE_HZ, AudioSegment, MixTrack, Samples
from app.project.model import Project

_BAR_HZ, _BEAT_HZ = 1760.0, 1320.0
_CLICK_S: Final = 0.035


def click_track(project: Project, start_s: float, end_s: float) -> MixTrack:
    """Return clicks on every counted beat of a span (`MetreMap.counted`), with a higher pitch on the first of a bar.

    Parameters
    ----------
    start_s, end_s : float
        Seconds of the performance; the start may precede the first note to count the pre-roll.
    """
    tempo_map, metre_map = project.score.tempo_map, project.metre_map
    first, last = (metre_map.bar_of_tick(int(np.floor(tempo_map.ticks(at_s)))) for at_s in (start_s, end_s))
    ticks, beats = metre_map.counted(first, max(last + 1, first))
    times_s = tempo_map.seconds(ticks)
    within = (times_s >= start_s) & (times_s < end_s)
    return MixTrack(
        AudioSegment(round(at_s * RATE_HZ), _click(_BEAT_HZ if beat else _BAR_HZ))
        for at_s, beat in zip(times_s[within].tolist(), beats[within].tolist(), strict=True)
    )


def steady_clicks(times_s: Iterable[float], high: int) -> MixTrack:
    """Return clicks at given times, with a higher pitch for the first ``high`` of them."""
    return MixTrack(
        AudioSegment(round(at_s * RATE_HZ), _click(_BAR_HZ if index < high else _BEAT_HZ))
        for index, at_s in enumerate(times_s)
    )


@cache
def _click(hz: float) -> Samples:
    times_s = np.arange(round(_CLICK_S * RATE_HZ)) / RATE_HZ
    fade = np.exp(-times_s / 0.008) * np.minimum(times_s / 0.0005, 1.0)
    click: Samples = np.round(np.sin(2 * np.pi * hz * times_s) * fade * 14000).astype(np.int16)
    return click


BEEP_S: Final = 0.5
_HZ: Final = 440.0
_FADE_S: Final = 0.02


def beep_track() -> MixTrack:
    """Return a tone of the tuning pitch at 0 s."""
    times_s = np.arange(round(BEEP_S * RATE_HZ)) / RATE_HZ
    fade = np.minimum(1.0, np.minimum(times_s, BEEP_S - times_s) / _FADE_S)
    return MixTrack([AudioSegment(0, np.round(np.sin(2 * np.pi * _HZ * times_s) * fade * 12000).astype(np.int16))])
