"""Dances have no fewer steps in the same time than the captures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.accent_grid import AccentGrid
from app.choreography.hit_log_odds import HeardHits
from app.choreography.model import MotionSegment
from app.choreography.sequence import SegmentCandidates, Weights, choose
from app.choreography.step_balance import StepBalance, step_balance

GRID = AccentGrid(0.5 * np.arange(120), np.ones(120, bool))
COUNT = 12


def stiff(steps: float) -> tuple[SegmentCandidates, StepBalance]:
    """Motions of a beat: every third has as many steps, but follows all others badly."""
    joins_m = np.zeros((COUNT, COUNT))
    stepping = np.arange(COUNT) % 3 == 0
    joins_m[:, stepping] = 0.06
    quarter_s = np.full(COUNT, 0.25)
    own = SegmentCandidates(np.arange(COUNT), quarter_s, quarter_s, joins_m, np.zeros((COUNT, COUNT)))
    return own, StepBalance(np.where(stepping, steps, 0.0), 2.0 * quarter_s)


def danced(own: SegmentCandidates, steps: StepBalance | None) -> list[tuple[int, int]]:
    silence = HeardHits(np.zeros(0), np.zeros((1, COUNT)))
    return choose(GRID, own, silence, seed=0, weights=Weights(lately=0.0, repeats=0.0, chance=0.2), steps=steps)


def test_a_dance_without_steps_makes_up_for_them() -> None:
    own, balance = stiff(2.0)
    per_s = {}
    for name, steps in (("stiff", None), ("balanced", balance)):
        found = danced(own, steps)
        segments = [segment for _, segment in found]
        lasts_s = GRID.times_s[found[-1][0]] - GRID.times_s[found[0][0]]
        per_s[name] = balance.steps[segments].sum() / lasts_s
    assert per_s["stiff"] < 0.1 * balance.per_s
    assert 0.85 * balance.per_s <= per_s["balanced"] <= 1.2 * balance.per_s


def test_a_dance_with_enough_steps_is_left_as_it_is() -> None:
    _, balance = stiff(2.0)
    chosen = [(place, 0) for place in range(16)]
    assert balance.favoured(GRID, chosen, 16) == pytest.approx(0.0)
    chosen = [(place, 1) for place in range(16)]
    assert balance.favoured(GRID, chosen, 16) == pytest.approx(balance.steps - balance.per_s * balance.lasts_s)
    assert balance.favoured(GRID, [], 0) == pytest.approx(0.0)


def test_more_steps_are_asked_for_at_a_faster_pace() -> None:
    _, balance = stiff(2.0)
    chosen = [(place, 0 if place % 3 == 0 else 1) for place in range(48)]
    assert balance.favoured(GRID, chosen, 48) == pytest.approx(
        0.5 * (balance.steps - balance.per_s * balance.lasts_s), abs=1e-9
    )
    faster = replace(balance, pace=1.4)
    assert faster.favoured(GRID, chosen, 48) == pytest.approx(balance.steps - balance.per_s * balance.lasts_s)


def test_motions_that_never_step_are_all_alike() -> None:
    own, balance = stiff(0.0)
    assert danced(own, balance) == danced(own, None)


def test_steps_are_counted_by_segment() -> None:
    segments = [MotionSegment(0, 0, 15, 30, 0), MotionSegment(1, 60, 70, 90, 0), MotionSegment(0, 30, 45, 60, 1)]
    lands_s = [np.array([0.1, 0.5, 0.9]), np.array([0.9, 2.0, 2.1, 2.9])]
    balance = step_balance(segments, [60.0, 30.0], lands_s)
    assert balance.steps.tolist() == [1.0, 3.0, 2.0]
    assert balance.lasts_s == pytest.approx([0.5, 1.0, 0.5])
    assert balance.per_s == pytest.approx(3.0)
