"""Steps of players who dance: on the beat at every tempo, with alternating feet, near each foot's place."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from app.choreography.dance import Dance, Manner
from app.choreography.performed.choreographers import choreographer_of
from app.choreography.player_steps import AHEAD_M, HEARD_S, IN_FRONT_M, IN_M, MOST_LEAD, OUT_M, danced_feet
from app.choreography.rhythm import Rhythm
from app.motion.gestures.danced_feet import MOVE_KINDS, DancedFeet

BEATS = 48
TEMPI = [184.0, 118.0, 63.0]


def rhythm_of(tempo: float, silent: tuple[int, int] = (0, 0)) -> Rhythm:
    """Rhythm with a stroke on every beat except during a silence."""
    beats_s = 60.0 / tempo * np.arange(BEATS)
    sounds = (np.arange(BEATS) < silent[0]) | (np.arange(BEATS) >= silent[1])
    hits_s = beats_s[sounds]
    symbols = np.where(np.arange(len(hits_s)) % 2 == 0, 1, 3)
    return Rhythm(beats_s, np.arange(BEATS) % 4, hits_s, symbols, np.ones(len(hits_s)), derived=False)


@cache
def dance(tempo: float) -> Dance:
    return choreographer_of("salsa").dance(rhythm_of(tempo), Manner(seed=1), Fraction(30))


def made(tempo: float, seed: int = 1) -> DancedFeet:
    return danced_feet(dance(tempo), rhythm_of(tempo), seed, 1.0)


@pytest.mark.parametrize("tempo", TEMPI)
def test_feet_land_on_the_beat_one_at_a_time(tempo: float) -> None:
    feet, beat_s = made(tempo), 60.0 / tempo
    assert np.abs(feet.lands_s / beat_s * 2.0 - np.rint(feet.lands_s / beat_s * 2.0)).max() < 1e-6
    assert np.all(np.diff(feet.lands_s) > 0.25)
    steps = feet.kinds == MOVE_KINDS.index("step")
    # A foot leaves the ground when the other one is back, and each is up again only after it is down.
    assert np.all(feet.start_s[steps][1:] > feet.lands_s[steps][:-1])
    for side in range(2):
        own = feet.sides == side
        assert np.all(feet.start_s[own][1:] > feet.lands_s[own][:-1])
    # About as often as dancers step, with both feet.
    seconds = BEATS * beat_s
    assert steps.sum() > 0.6 * seconds
    assert 0.25 < feet.sides[steps].mean() < 0.75


@pytest.mark.parametrize("tempo", TEMPI)
def test_both_feet_step_alike_often_at_any_time_of_a_dance_that_prefers_one(tempo: float) -> None:
    """A dancer whose left foot always steps farther leaves a player's right one no post."""
    farther = [one for one in dance(tempo).standing if one.foot == 0 or one.start == 0]
    feet = danced_feet(replace(dance(tempo), standing=tuple(farther)), rhythm_of(tempo), 1, 1.0)
    for whole in (feet, made(tempo)):
        sides = whole.sides[whole.kinds == MOVE_KINDS.index("step")]
        leads = np.cumsum(np.where(sides == 0, 1, -1))
        assert len(sides) > 10
        assert np.abs(leads).max() <= MOST_LEAD


@pytest.mark.parametrize("tempo", TEMPI)
def test_short_steps_become_taps_of_the_front_foot_and_lifts_of_heels(tempo: float) -> None:
    feet, beat_s = made(tempo), 60.0 / tempo
    step, toes, heel = (feet.kinds == MOVE_KINDS.index(kind) for kind in ("step", "toes", "heel"))
    assert 0.08 < toes.sum() / BEATS * max(1.0, 0.5 / beat_s) < 0.4
    assert heel.any()
    assert step.sum() > 0.5 * len(feet)
    for row in np.flatnonzero(toes).tolist():
        place_m = [feet.place_m[:row][step[:row] & (feet.sides[:row] == side)] for side in range(2)]
        ahead_m = [own[-1, 1] if len(own) else 0.0 for own in place_m]
        own = feet.sides[row]
        # A player stands with the left foot ahead.
        assert ahead_m[own] - ahead_m[1 - own] >= (-IN_FRONT_M if own == 0 else 0.9 * IN_FRONT_M) - 1e-9
    # Taps stand between beats with weight on the foot, not one after the other.
    assert not np.any(toes[2:] & toes[1:-1] & toes[:-2])


@pytest.mark.parametrize("tempo", TEMPI)
def test_feet_stay_near_their_places_and_on_their_sides(tempo: float) -> None:
    feet = made(tempo)
    out_m = np.where(feet.sides == 0, feet.place_m[:, 0], -feet.place_m[:, 0])
    assert out_m.min() >= -IN_M
    assert out_m.max() <= OUT_M
    assert np.abs(feet.place_m[:, 1]).max() <= AHEAD_M
    # They go somewhere: standing on the spot is no dance.
    assert np.ptp(out_m) > 0.03


@pytest.mark.parametrize("tempo", TEMPI)
def test_no_beat_that_sounds_is_long_without_feet(tempo: float) -> None:
    feet, danced = made(tempo), dance(tempo)
    start_s, end_s = danced.steps[0].start_s, danced.steps[-1].end_s
    lands_s = feet.lands_s[(feet.lands_s > start_s) & (feet.lands_s < end_s)]
    assert np.diff(lands_s).max() <= max(2.0 * 60.0 / tempo, 1.0) + 1e-6


def test_silence_is_not_marked_and_no_music_is_not_danced() -> None:
    silent = danced_feet(dance(118.0), rhythm_of(118.0, (16, 32)), 1, 1.0)
    beat_s = 60.0 / 118.0
    marks = silent.lands_s[silent.kinds != MOVE_KINDS.index("step")]
    assert not np.any((marks > 16 * beat_s + HEARD_S) & (marks < 32 * beat_s - HEARD_S - 1e-6))
    empty = Rhythm(np.zeros(0), np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64), np.zeros(0), derived=False)
    assert not len(danced_feet(dance(118.0), empty, 1, 1.0))


def test_the_same_seed_marks_the_same_beats_and_others_others() -> None:
    def kinds(seed: int) -> tuple[list[int], list[int]]:
        feet = made(63.0, seed)
        return feet.kinds.tolist(), feet.seated.tolist()

    assert kinds(1) == kinds(1)
    assert len({str(kinds(seed)) for seed in range(1, 5)}) > 1
