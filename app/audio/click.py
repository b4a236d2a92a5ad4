"""The metronome: a track of clicks on the beats of the score."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Final

import numpy as np

from app.audio.track import RATE_HZ, Piece, Samples, Track
from app.project.model import Project

_BAR_HZ, _BEAT_HZ = 1760.0, 1320.0
_CLICK_S: Final = 0.035


def click_track(project: Project, start_s: float, end_s: float) -> Track:
    """Clicks on every beat of a span, the first of a bar higher.

    The beat is the one that is felt where it divides the bar (a 6/8 in two), else the metre's own.

    Parameters
    ----------
    project : Project
    start_s, end_s : float
        Seconds of the performance; from before the first note if the pre-roll is to be counted.
    """
    score = project.score
    tempo_map = score.tempo_map
    bar = score.bar_of_tick(int(np.floor(tempo_map.ticks(start_s))))
    pieces = []
    while True:
        bar_tick, next_tick = score.tick_of_bar(bar), score.tick_of_bar(bar + 1)
        if tempo_map.seconds(float(bar_tick)) >= end_s:
            break
        for index, tick in enumerate(_beats(project, bar_tick, next_tick)):
            at_s = tempo_map.seconds(float(tick))
            if start_s <= at_s < end_s:
                pieces.append(Piece(round(at_s * RATE_HZ), _click(_BEAT_HZ if index else _BAR_HZ)))
        bar += 1
    return Track(pieces)


def steady_clicks(times_s: Iterable[float], high: int) -> Track:
    """Clicks at times, the first ones higher."""
    return Track(
        Piece(round(at_s * RATE_HZ), _click(_BAR_HZ if index < high else _BEAT_HZ))
        for index, at_s in enumerate(times_s)
    )


def _beats(project: Project, bar_tick: int, next_tick: int) -> list[float]:
    """Ticks of a bar's beats."""
    score = project.score
    length = next_tick - bar_tick
    felt = project.felt_beat_ticks(bar_tick)
    if length % felt == 0:
        return [float(bar_tick + beat) for beat in range(0, length, felt)]
    metre = next(metre for metre in reversed(score.metres) if metre.tick <= max(bar_tick, score.metres[0].tick))
    step = 4 * score.ticks_per_quarter / metre.denominator
    # A pickup's beats are counted back from the bar line.
    count = int(np.ceil(length / step - 1e-9))
    return [tick for tick in (next_tick - (count - beat) * step for beat in range(count)) if tick >= bar_tick]


@cache
def _click(hz: float) -> Samples:
    times_s = np.arange(round(_CLICK_S * RATE_HZ)) / RATE_HZ
    fade = np.exp(-times_s / 0.008) * np.minimum(times_s / 0.0005, 1.0)
    click: Samples = np.round(np.sin(2 * np.pi * hz * times_s) * fade * 14000).astype(np.int16)
    return click
