"""The metronome's clicks are on the beats."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.audio.click import click_track, steady_clicks
from app.audio.track import RATE_HZ
from app.score.metre_map import Metre
from tests.unit.audio.pieces import melody, piece


def beats(track: object) -> list[tuple[float, bool]]:
    """Times in seconds of the clicks, and whether each is the higher click of a bar."""
    found = sorted((p.start / RATE_HZ, p.samples) for p in track.pieces)  # type: ignore[attr-defined]
    high = {id(samples): (samples[:400].astype(int)[1:] * samples[:399] < 0).sum() for _, samples in found}
    most = max(high.values())
    return [(round(at, 3), high[id(samples)] == most) for at, samples in found]


def test_common_time_with_the_preroll() -> None:
    found = beats(click_track(piece(melody((0, 1920, 70))), -1.0, 2.1))
    assert [at for at, _ in found] == pytest.approx([-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0])
    assert [high for _, high in found] == [False, False, True, False, False, False, True]


def test_six_eight_is_counted_as_it_is_felt() -> None:
    project = piece(melody((0, 1440, 70)), metres=(Metre(0, 6, 8),))
    assert beats(click_track(project, 0.0, 1.5)) == [(0.0, True), (0.75, False)]
    quarters = replace(project, felt_beat_quarters=1.0)
    assert [at for at, _ in beats(click_track(quarters, 0.0, 1.5))] == pytest.approx([0.0, 0.5, 1.0])


def test_where_the_felt_beat_does_not_fit_the_metre_counts() -> None:
    project = piece(melody((0, 1200, 70)), metres=(Metre(0, 5, 8),))
    assert len(beats(click_track(project, 0.0, 1.25))) == 5


def test_a_pickup_is_counted_back_from_the_bar_line() -> None:
    project = piece(melody((0, 2000, 70)), metres=(Metre(0, 4, 4), Metre(720, 4, 4)), pickup_ticks=720)
    found = beats(click_track(project, 0.0, 2.0))
    assert 0.75 in [at for at, high in found if high]
    assert [at for at, _ in found if at < 0.75] == pytest.approx([0.25])


def test_steady_clicks_lie_at_their_times_the_first_ones_higher() -> None:
    times_s = (0.5, 1.0, 1.5)
    track = steady_clicks(times_s, high=1)
    assert [piece.start / RATE_HZ for piece in track.pieces] == list(times_s)
    high, *low = (int(np.argmax(np.abs(np.fft.rfft(piece.samples)))) for piece in track.pieces)
    assert high > low[0] == low[1]
