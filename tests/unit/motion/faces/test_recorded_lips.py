"""Recorded breath is visible: cheeks and lips follow the curve within a note, vibrato has its own rate,
contacts hold.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import BoolArray, FloatArray
from app.contacts.breaks import joined
from app.contacts.judge import ContactJudge
from app.motion.contacts.solve import padding_frames
from app.motion.curves.curve import EVERYWHERE, Trace, moves
from app.motion.model import Motion
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.plan.by_hand.corrections import Correction, SetEmbouchure
from app.plan.model import PlayerPlan
from app.project.model import Project, project_from_score
from app.score.model import ControllerCurve, Score
from instrument_maps.load import bundled_maps
from tests.support.blown import TEMPO, Blow, breath_curve, take, vibrato_curve
from tests.support.performed import performance_curves, player_motion

FPS = Fraction(60)
SWELL = Blow(0.99, 5.0, lambda s: 0.25 + 0.7 * np.minimum(s / 4.0, 1.0))
BREATH_S = (5.6, 6.0)


@dataclass
class Seen:
    """A played take, frame by frame."""

    performance: Performance
    motion: Motion

    @property
    def plan(self) -> PlayerPlan:
        return self.performance.plan(self.performance.project.players[0])

    def between(self, morph: str, start_s: float, end_s: float) -> FloatArray:
        values: FloatArray = self.motion.morphs[morph][self.frames(start_s, end_s)].astype(np.float64)
        return values

    def frames(self, start_s: float, end_s: float) -> BoolArray:
        times_s = self.times_s
        return (times_s >= start_s) & (times_s < end_s)

    @property
    def times_s(self) -> FloatArray:
        return self.motion.first_frame_s + np.arange(self.motion.frames) / float(FPS)


def seen(*curves: ControllerCurve, map_id: str = "trumpet_Bb", corrections: tuple[Correction, ...] = ()) -> Seen:
    """A long note with a crescendo, a note that fades with the breath, and one more."""
    maps = bundled_maps()
    low = maps[map_id].range.easy_low + 5
    part = take([(1.0, 5.0, low), (5.0, 6.0, low + 2), (6.0, 8.6, low + 4)], *curves, map_id=map_id)
    project = project_from_score(Score("Take", 480, TEMPO, parts=(part,)), maps)
    project = Project(project.score, project.players, {project.players[0].id: corrections})
    performance = Performance(project)
    span = whole_span(performance.time_frame, FPS)
    return Seen(performance, player_motion(performance, project.players[0], span))


BLOWN = breath_curve([SWELL, Blow(5.0, BREATH_S[0]), Blow(BREATH_S[1], 8.6)])


@pytest.mark.parametrize("map_id", ["trumpet_Bb", "sax_alto_Eb", "oboe", "flute", "recorder_alto_F"])
def test_cheeks_follow_the_breath_and_the_breath_is_seen_with_every_contact_kept(map_id: str) -> None:
    shown = seen(BLOWN, vibrato_curve(7.0, 8.6, 0.15, 5.5), map_id=map_id)
    times_s = shown.times_s[shown.frames(1.3, 4.9)]
    asked = SWELL.dynamics(times_s - SWELL.start_s)
    if map_id in ("oboe", "flute"):
        # Their cheeks stay flat; nothing else moves them here.
        assert "cheekPuff" not in shown.motion.morphs
    else:
        cheeks = shown.between("cheekPuff", 1.3, 4.9)
        assert np.corrcoef(asked, cheeks)[0, 1] > 0.97
        assert cheeks[-1] > 2.0 * cheeks[0]
    breath = next(event for event in shown.plan.breaths if event.id == "breath:1:3")
    assert (breath.start_s, breath.end_s) == pytest.approx(BREATH_S, abs=0.04)
    inside = shown.between("jawOpen", *BREATH_S).max()
    assert inside > shown.between("jawOpen", 2.0, 4.9).max() + 0.03, "the mouth opens for it"
    player = shown.performance.project.players[0]
    judge = ContactJudge(
        performance_curves(shown.performance, player),
        character_of(player),
        model_of(shown.performance.instrument(player)),
    )
    assert [(found.contact, found.start_s, found.gap_m) for found in joined(judge.breaks(shown.motion))] == []


@pytest.mark.parametrize("rate_hz", [4.5, 5.5, 6.5])
@pytest.mark.parametrize("kind", ["pitch_bend", "bite"])
def test_a_vibrato_shows_at_its_own_rate_and_by_its_depth(kind: str, rate_hz: float) -> None:
    sizes = []
    for depth in (0.05, 0.15):
        curve = vibrato_curve(6.2, 8.6, depth, rate_hz, kind, 0.0 if kind == "pitch_bend" else 0.5)
        lips = seen(BLOWN, curve).between("mouthPressLeft", 6.5, 8.5)
        spectrum = np.abs(np.fft.rfft((lips - lips.mean()) * np.hanning(len(lips))))
        found_hz = np.fft.rfftfreq(len(lips), 1.0 / float(FPS))[spectrum[2:].argmax() + 2]
        assert found_hz == pytest.approx(rate_hz, abs=0.5)
        sizes.append(float(np.ptp(lips)))
    assert 0.005 < sizes[0] < 0.5 * sizes[1]
    assert sizes[1] < 0.3


def test_a_note_set_by_hand_keeps_what_was_set() -> None:
    by_hand = SetEmbouchure("1:1", tension=0.2, air=0.9)
    shown = seen(BLOWN, vibrato_curve(1.0, 8.6, 0.15, 5.5), corrections=(by_hand,))
    traces = shown.plan.traces
    assert traces.air is not None
    assert traces.effort is not None
    at_s = traces.start_s + traces.step_s * np.arange(len(traces.air))
    inside = (at_s > 1.2) & (at_s < 4.8)
    np.testing.assert_allclose(traces.air[inside], 0.9)
    np.testing.assert_allclose(traces.tension[inside], 0.2)
    assert np.ptp(traces.effort[inside]) > 0.1, "what was not set follows the breath"


def test_without_curves_nothing_is_traced() -> None:
    assert seen().plan.traces is None


@given(st.integers(-50, 50), st.lists(st.floats(0, 1), min_size=2, max_size=20), st.lists(st.floats(-2, 2), max_size=9))
def test_a_trace_is_straight_between_its_samples(first: int, values: list[float], times_s: list[float]) -> None:
    trace = Trace(first * 0.01, 0.01, np.array(values))
    at_s = np.sort(np.array(times_s))
    known_s = first * 0.01 + 0.01 * np.arange(len(values))
    np.testing.assert_allclose(trace.sample(at_s), np.interp(at_s, known_s, values), atol=1e-9)
    if len(at_s):
        assert trace.sample(at_s[-1:])[0] == trace.sample(at_s)[-1], "a time alone gives the very same"


@given(
    st.tuples(st.integers(-9, 9), st.lists(st.integers(0, 2), min_size=2, max_size=12)),
    st.tuples(st.integers(-9, 9), st.lists(st.integers(0, 2), min_size=2, max_size=12)),
)
def test_what_changed_holds_every_difference(one: tuple[int, list[int]], other: tuple[int, list[int]]) -> None:
    mine, others = (Trace(first * 0.01, 0.01, np.array(values, np.float64)) for first, values in (one, other))
    spans = mine.changed_s(others)
    at_s = np.arange(-40, 41) * 0.005
    covered = np.any(
        [(at_s >= low - 1e-9) & (at_s <= high + 1e-9) for low, high in spans.tolist()] or [at_s > 9], axis=0
    )
    differ = ~np.isclose(mine.sample(at_s), others.sample(at_s), atol=1e-9)
    assert not (differ & ~covered).any()
    if not differ.any() and one == other:
        assert len(spans) == 0


def test_a_trace_in_place_of_a_curve_changes_everything() -> None:
    trace, curve = Trace(0.0, 0.01, np.zeros(5)), moves(())
    assert trace.changed_s(curve) is EVERYWHERE
    assert curve.changed_s(trace) is EVERYWHERE


def test_after_an_edit_only_the_spans_that_are_reported_have_changed() -> None:
    maps = bundled_maps()
    low = maps["trumpet_Bb"].range.easy_low + 5
    part = take([(1.0, 5.0, low), (5.0, 6.0, low + 2), (6.0, 8.6, low + 4)], BLOWN, vibrato_curve(6.2, 8.6, 0.1, 5.0))
    project = project_from_score(Score("Take", 480, TEMPO, parts=(part,)), maps)
    player = project.players[0]
    first = Performance(project)
    before = performance_curves(first, player)
    edited = replace(project, corrections={player.id: (SetEmbouchure("1:2", tension=0.9, air=0.1),)})
    second = Performance(edited, first)
    after = performance_curves(second, player, before)
    span = whole_span(second.time_frame, FPS)
    old, new = (player_motion(one, player, span) for one in (first, second))
    times_s = new.first_frame_s + np.arange(new.frames) / float(FPS)
    reported_s = after.changed_s(before)
    pad_s = (padding_frames(FPS) + 1) / float(FPS)
    reported = np.any(
        [(times_s >= low_s - pad_s) & (times_s <= high_s + pad_s) for low_s, high_s in reported_s], axis=0
    )
    changed = np.any([old.morphs[name] != new.morphs[name] for name in new.morphs], axis=0)
    changed |= (old.rotations != new.rotations).any(axis=(1, 2))
    assert changed.any()
    assert not (changed & ~reported).any()
    assert reported.mean() < 0.5, "and not everything is made anew"
