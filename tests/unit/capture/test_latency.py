"""Measurement of latency from synthetic players with known latency."""

from __future__ import annotations

import random
from statistics import NormalDist

import pytest

from app.capture.latency import LEAST_HITS, LatencyMeasurement, events_on_time_line, hits, measured_latency

CLICKS_S = tuple(0.6 * index for index in range(12))


def player(
    latency_s: float, jitter_s: float, seed: int, missed: int = 0, doubled: int = 0, stray: int = 0
) -> list[float]:
    """Times of a synthetic player's hits on the clicks."""
    chance = random.Random(seed)
    struck = sorted(chance.sample(range(len(CLICKS_S)), len(CLICKS_S) - missed))
    times = [CLICKS_S[index] + latency_s + chance.gauss(0.0, jitter_s) for index in struck]
    times += [time_s + chance.uniform(0.16, 0.3) for time_s in chance.sample(times, doubled)]
    times += [chance.uniform(0.0, CLICKS_S[-1]) for _ in range(stray)]
    return sorted(times)


def most_wrong_s(jitter_s: float, count: int) -> float:
    """Error in seconds of a median of normally distributed hits that is exceeded once in a hundred thousand: its
    standard error times the quantile.
    """
    return NormalDist().inv_cdf(1.0 - 5e-6) * 1.2533 * jitter_s / count**0.5


@pytest.mark.parametrize("latency_s", [-0.05, 0.0, 0.012, 0.08, 0.2])
@pytest.mark.parametrize("jitter_s", [0.0, 0.008, 0.015])
def test_the_latency_of_an_even_player_is_found(latency_s: float, jitter_s: float) -> None:
    for seed in range(20):
        found = measured_latency(CLICKS_S, player(latency_s, jitter_s, seed))
        assert not found.fault
        assert found.latency_s == pytest.approx(latency_s, abs=most_wrong_s(jitter_s, 12) + 1e-9)


def test_missing_double_and_stray_hits_do_little_harm() -> None:
    for seed in range(40):
        found = measured_latency(CLICKS_S, player(0.06, 0.012, seed, missed=3, doubled=3, stray=2))
        assert not found.fault
        assert found.latency_s == pytest.approx(0.06, abs=most_wrong_s(0.012, 7))


def test_the_spread_is_the_player_s() -> None:
    spreads = sorted(measured_latency(CLICKS_S, player(0.05, 0.015, seed)).spread_s for seed in range(100))
    assert spreads[50] == pytest.approx(0.015, rel=0.25)


def test_a_hit_far_off_is_shown_but_does_not_count() -> None:
    times = player(0.05, 0.005, 1)
    times[4] += 0.15
    found = measured_latency(CLICKS_S, times)
    assert found.offsets_s[4] == pytest.approx(0.2, abs=0.03)
    assert not found.used[4]
    assert sum(found.used) == 11


def test_irregular_or_sparse_hits_are_refused() -> None:
    faults = []
    for seed in range(20):
        chance = random.Random(seed)
        faults.append(measured_latency(CLICKS_S, sorted(chance.uniform(0.0, 7.0) for _ in range(12))).fault)
    assert all(faults)
    few = measured_latency(CLICKS_S, player(0.05, 0.005, 1, missed=12 - LEAST_HITS + 1))
    assert few.fault == "too_few"
    assert measured_latency(CLICKS_S, ()) == LatencyMeasurement((None,) * 12, (False,) * 12, 0.0, 0.0, "too_few")


def test_a_hit_is_a_note_and_what_follows_at_once_is_the_same() -> None:
    events = [
        (0.9, bytes((0xB0, 2, 40))),
        (1.0, bytes((0x90, 60, 80))),
        (1.01, bytes((0x80, 60, 0))),
        (1.02, bytes((0x90, 61, 80))),
        (1.3, bytes((0x90, 61, 0))),
        (1.6, bytes((0x90, 60, 80))),
    ]
    assert hits(events, "cc2") == (1.0, 1.6)


def test_without_notes_a_hit_is_where_the_breath_begins() -> None:
    values = (0, 5, 20, 90, 60, 10, 20, 3, 0, 15, 70)
    events = [(0.2 * index, bytes((0xB0, 2, value))) for index, value in enumerate(values)]
    assert hits(events, "cc2") == pytest.approx((0.4, 1.8))
    assert hits(events, "cc11") == ()


def test_events_lie_at_the_position_that_sounded() -> None:
    positions = [(1_000_000_000, 0.0), (2_000_000_000, 1.0), (3_000_000_000, 2.5)]
    moments = (500_000_000, 1_500_000_000, 2_500_000_000, 3_250_000_000)
    found = events_on_time_line([(moment, b"") for moment in moments], positions)
    assert [at_s for at_s, _ in found] == pytest.approx([-0.5, 0.5, 1.75, 2.75])
    assert events_on_time_line([(1, b"")], []) == []
