"""Motion follows the dynamics: larger when loud, smaller when soft, raised with accents, and unchanged without
dynamics.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.motion.gestures.layers import LAYERS, Layers
from app.plan.generate import MonophonicPart
from app.plan.gestures.gestures import ARCH, RELEASE
from app.plan.model import PlayerPlan
from app.plan.music.dynamics import amount_at_vigour, mean_around, vigour_of
from app.plan.music.piece import ControllerInput, ControllerSteps
from app.score.metre_map import Metre
from metadata.load import load_body
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))
TUNE = [60, 64, 67, 72, 71, 67, 65, 62]
BODY = load_body()
FELT = PIECE.metre_map.felt_beats


def plan_of(notes: tuple[PlainNote, ...], **more: object) -> PlayerPlan:
    line = MonophonicPart("p", notes, valves(), **more)
    return make_plans(PIECE, (line,), time_frame((line,), CLOCK))["p"]


def tune(*velocities: int) -> tuple[PlainNote, ...]:
    """Four bars at each velocity."""
    return line_of(
        *(
            ((16 * part + beat) * Q, Q, TUNE[beat % 8], velocity)
            for part, velocity in enumerate(velocities)
            for beat in range(16)
        )
    )


def sizes(plan: PlayerPlan, kind: str, start_s: float, end_s: float) -> float:
    found = [abs(event.amount) for event in plan.gestures if event.kind == kind and start_s <= event.start_s < end_s]
    return float(np.mean(found))


def motion(plan: PlayerPlan, start_s: float, end_s: float) -> dict[str, float]:
    """Range of each layer of the body's motion within a time span, before the player's amplitude is applied."""
    times_s = np.arange(start_s, end_s, 0.02)
    levels = layers_of(plan).sample(times_s)
    return {name: float(np.ptp(getattr(levels, name))) for name in ("sway", "height", "lean")}


def layers_of(plan: PlayerPlan) -> Layers:
    return LAYERS.begin(plan=plan, body=BODY, felt_beats=FELT, generated_feet=1.0).of(Layers)


def test_fortissimo_is_larger_than_pianissimo_in_every_layer() -> None:
    plan = plan_of(tune(33, 112))
    soft, loud = motion(plan, 1.5, 6.5), motion(plan, 9.5, 14.5)
    assert loud["sway"] > 2.0 * soft["sway"]
    assert loud["height"] > 2.0 * soft["height"]
    assert loud["lean"] > 1.5 * soft["lean"]
    assert soft["sway"] < 0.5
    assert soft["height"] < 0.4


def test_a_start_to_play_softly_is_cued_softly() -> None:
    soft, loud = plan_of(tune(33, 112)).cues[0], plan_of(tune(112, 33)).cues[0]
    assert soft.amount < 0.5 < 1.0 < loud.amount
    assert plan_of(tune(80, 80)).cues[0].amount == 1.0


def test_a_curve_drawn_for_the_dynamics_counts_within_a_held_note() -> None:
    notes = line_of((0, 16 * Q, 67), (16 * Q, 4 * Q, 65))
    swell = ControllerSteps(np.arange(0.0, 16.0 * Q, Q / 4), np.linspace(0.2, 1.0, 64))
    plan = plan_of(notes, loudness=(0.6, 1.0), controller=ControllerInput(breath=swell))
    assert sizes(plan, "sway", 5.0, 8.0) > 1.5 * sizes(plan, "sway", 0.0, 3.0)


@pytest.mark.parametrize("velocity", [64, 80, 90, 100])
def test_one_velocity_throughout_moves_a_body_as_ever(velocity: int) -> None:
    notes = tune(velocity, velocity)
    one, other = plan_of(notes), plan_of(tuple(replace(note, velocity=80) for note in notes))
    assert one.gestures == other.gestures
    # Sways are as large as chance has them, the bell goes to the contour, but for the arch.
    sways = [abs(event.amount) for event in one.gestures if event.kind == "sway" and 0.0 < event.start_s < 14.0]
    assert min(sways) < 0.6 <= max(sways) <= 1.0
    mean = float(np.mean(TUNE))
    for event in one.gestures:
        if event.kind == "bell_height":
            contour = np.clip((TUNE[event.start_tick // Q % 8] - mean) / 10.0, -1.0, 1.0)
            assert -RELEASE * ARCH - 1e-3 <= event.amount - contour <= ARCH + 1e-3


def test_an_accent_lifts_the_bell() -> None:
    plain = tune(70, 71)
    accented = tuple(replace(note, velocity=110) if note.onset_tick == 10 * Q else note for note in plain)
    before, after = plan_of(plain), plan_of(accented)
    heights = [layers_of(plan).sample(np.array([5.4])).height[0] for plan in (before, after)]
    assert heights[1] > heights[0] + 0.2
    (event,) = [event for event in after.gestures if event.reason.id == "gesture.bell_accent"]
    assert (event.kind, event.start_tick) == ("bell_height", 10 * Q)


def test_the_bell_sinks_at_the_end_of_a_phrase() -> None:
    notes = line_of(*((beat * Q, Q, 67 + (beat == 6)) for beat in range(12)), (16 * Q, 4 * Q, 67))
    bells = [event for event in plan_of(notes).gestures if event.kind == "bell_height"]
    layers = layers_of(plan_of(notes)).sample(np.array([3.3, 5.9]))
    assert len(bells) >= 2
    assert layers.height[1] < layers.height[0]


@given(st.floats(-1.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
@settings(max_examples=200, deadline=None)
def test_amounts_stay_amounts_and_grow_with_loudness(amount: float, soft: float, loud: float) -> None:
    soft, loud = sorted((soft, loud))
    amounts, vigours = np.array([amount, amount]), vigour_of(np.array([soft, loud]))
    small, large = amount_at_vigour(amounts, vigours)
    assert abs(small) <= abs(large) + 1e-9
    assert abs(large) <= 1.0 + 1e-9
    assert large * amount >= 0.0
    assert amount_at_vigour(np.array([amount]), np.array([1.0]))[0] == pytest.approx(amount)


def test_loudness_around_a_time_is_the_mean_of_what_sounds_there() -> None:
    rng = np.random.default_rng(1)
    starts_s = np.cumsum(rng.uniform(0.5, 1.5, 12))
    lasts_s = np.diff(np.append(starts_s, starts_s[-1] + 1.0)) * rng.uniform(0.3, 1.0, 12)
    loudness = rng.uniform(0.0, 1.0, 12)
    around_s = 1.3
    expected = []
    for start_s in starts_s:
        sampled_s = np.arange(start_s - around_s, start_s + around_s, 0.0005)
        sounding = (sampled_s[:, None] >= starts_s) & (sampled_s[:, None] < starts_s + lasts_s)
        expected.append((sounding * loudness).sum() / sounding.sum())
    np.testing.assert_allclose(mean_around(starts_s, lasts_s, loudness, starts_s, around_s), expected, atol=0.002)
