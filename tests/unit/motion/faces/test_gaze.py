"""Properties of the curves of eyes and lids that hold for every player and seed."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.motion.faces.blinks import BLINK_S, ENTRY_GUARD_S
from app.motion.faces.gaze import (
    EYES_RAD,
    GAZE,
    HEAD_TURNS,
    LINE_RAD,
    MUSIC_PITCH_RAD,
    PLAYING_TURN_RAD,
    Gaze,
    GazeFrames,
    Watching,
    plan_gaze,
    with_instrument,
)
from app.motion.faces.silences import Silences, holds
from app.plan.model import GlanceEvent, PlayerPlan
from tests.unit.motion.events import breath, fingerings, plan_of
from tests.unit.motion.faces.test_face_curves import TIMES_S, plan

SEEDS = range(30)


def gaze_of(made: PlayerPlan, watching: Watching) -> Gaze:
    return GAZE.begin(plan=made, watching=watching).of(plan_gaze)


def gazes(made: PlayerPlan, **watching: object) -> list[Gaze]:
    return [gaze_of(made, Watching(seed, **watching)) for seed in SEEDS]


def starts_s(made: PlayerPlan) -> np.ndarray:
    return np.concatenate([gaze.left_lid.start_s for gaze in gazes(made)])


def phrases(length_s: float = 3.0, count: int = 20) -> PlayerPlan:
    """Phrases of quarters with a breath of 0.4 s before each."""
    rows, breaths = [], []
    for number in range(count):
        at_s = number * (length_s + 0.4)
        breaths.append(breath(at_s - 0.4, at_s))
        rows += [(at_s + 0.5 * i, at_s + 0.5 * i + 0.5, {}) for i in range(int(length_s / 0.5))]
    return plan_of(fingerings(rows), breaths=tuple(breaths))


def test_blinks_come_as_often_as_peoples_and_not_on_an_entry() -> None:
    made = plan()
    found_s = starts_s(made)
    per_minute = len(found_s) / len(SEEDS) / ((made.time_frame.end_s - made.time_frame.first_frame_s) / 60)
    assert 5 < per_minute < 25
    for entry_s in (0.0, 14.0):
        assert not np.any((found_s + BLINK_S > entry_s - ENTRY_GUARD_S) & (found_s < entry_s + ENTRY_GUARD_S))


def test_no_one_blinks_in_a_quick_run() -> None:
    rows = [(0.12 * i, 0.12 * i + 0.1, {}) for i in range(250)] + [(30.0 + i, 31.0 + i, {}) for i in range(30)]
    found_s = starts_s(plan_of(fingerings(rows)))
    assert not np.any((found_s > -BLINK_S) & (found_s < 0.12 * 249))
    assert np.any((found_s > 30.5) & (found_s < 60.0)), "but within slow notes"


def test_most_blinks_are_at_the_ends_of_phrases() -> None:
    made = phrases()
    found_s = starts_s(made)
    found_s = found_s[(found_s > 0.5) & (found_s < made.fingerings[-1].end_s - 0.5)]
    near = np.stack(([event.start_s - 0.4 for event in made.breaths], [event.end_s for event in made.breaths]), axis=1)
    assert holds(near, found_s).mean() > 0.6
    share = len(found_s) / len(SEEDS) / len(made.breaths)
    assert 0.7 < share < 1.6


def test_the_eyes_close_almost_alike_and_each_player_in_an_own_way() -> None:
    lags = []
    for gaze in gazes(phrases()):
        lag_s = gaze.right_lid.start_s - gaze.left_lid.start_s
        heights = np.sort(np.stack((gaze.left_lid.height, gaze.right_lid.height)), axis=0)
        assert np.all((np.abs(lag_s) > 0.002) & (np.abs(lag_s) < 0.02))
        assert np.all((heights[0] < heights[1]) & (heights[0] > 0.85 * heights[1]))
        assert np.ptp(lag_s) < 1e-9
        lags.append(round(float(lag_s[0]), 5))
    assert min(lags) < 0.0 < max(lags)
    assert len(set(lags)) > 25


def test_fewer_blinks_by_amount() -> None:
    made = phrases()
    often, seldom = (sum(len(gaze.left_lid.start_s) for gaze in gazes(made, blink=amount)) for amount in (1.0, 0.3))
    assert 0 < seldom < 0.5 * often
    assert not sum(len(gaze.left_lid.start_s) for gaze in gazes(made, blink=0.0))


def test_the_music_is_read_from_left_to_right_line_by_line() -> None:
    made = plan_of(fingerings([(i, i + 1.0, {}) for i in range(60)]))
    gaze = gaze_of(made, Watching(3, gaze=0.0))
    times_s = np.arange(1.0, 58.0, 0.1)
    yaw, pitch = gaze.yaw_rad.sample(times_s), gaze.pitch_rad.sample(times_s)
    assert np.abs(yaw).max() < LINE_RAD + 0.02
    assert np.abs(pitch - MUSIC_PITCH_RAD).max() < 0.06
    steps = np.diff(gaze.yaw_rad.after)
    sweeps = steps > LINE_RAD
    assert 58.0 / 8.5 - 2 < sweeps.sum() < 58.0 / 4.5 + 2
    assert np.mean(steps[~sweeps] < 0.01) > 0.8, "to the right between them"


def test_eyes_rest_on_the_music_and_go_up_at_a_cue() -> None:
    gaze = gaze_of(plan(), Watching(3))
    pitch = gaze.pitch_rad.sample(TIMES_S)
    playing = (TIMES_S > 1.0) & (TIMES_S < 10.0)
    assert np.median(pitch[playing]) > 0.1
    assert gaze.pitch_rad.sample(np.array([13.4]))[0] < 0.05


def glance(left_rad: float, start_s: float = 12.7, end_s: float = 14.2, head_share: float = 0.3) -> GlanceEvent:
    return GlanceEvent("glance", "leader", start_s, end_s, left_rad, 0.02, head_share)


@pytest.mark.parametrize("left_rad", [-0.4, 0.3])
def test_the_eyes_are_where_a_glance_goes_and_then_back_at_the_music(left_rad: float) -> None:
    for gaze in gazes(plan(cues=(), glances=(glance(left_rad),))):
        yaw, pitch = (curve.sample(np.array([13.0, 14.15])) for curve in (gaze.yaw_rad, gaze.pitch_rad))
        np.testing.assert_allclose(yaw, left_rad)
        np.testing.assert_allclose(pitch, 0.02)
        assert abs(gaze.yaw_rad.sample(np.array([15.0]))[0]) < 0.15


def test_a_glance_goes_before_the_look_up_of_a_cue() -> None:
    for gaze in gazes(plan(glances=(glance(0.4, 13.0, 13.4),))):
        yaw = gaze.yaw_rad.sample(np.array([12.95, 13.3, 13.64]))
        assert yaw[1] == pytest.approx(0.4)
        np.testing.assert_allclose(np.abs(yaw[[0, 2]]), 0.22)


def test_what_is_far_aside_comes_in_sight_with_the_head() -> None:
    times_s = np.arange(12.0, 16.0, 0.01)
    for gaze in gazes(plan(cues=(), glances=(glance(1.05, head_share=0.45),))):
        look = gaze.sample(times_s)
        in_head = look.yaw_rad - HEAD_TURNS * look.head_yaw_rad
        assert np.abs(in_head).max() <= 0.52 + 1e-9
        seen = look.yaw_rad[(times_s > 12.8) & (times_s < 14.0)]
        assert np.all(np.diff(seen) > -0.01)
        assert seen[0] < 0.9 * seen[-1] > 0.85


def test_eyes_lead_and_the_head_follows_later_and_slower() -> None:
    times_s = np.arange(12.0, 14.0, 0.01)
    for gaze in gazes(plan(cues=(), glances=(glance(0.45),)), gaze=0.0):
        look = gaze.sample(times_s)
        half = []
        for curve in (look.yaw_rad, look.head_yaw_rad):
            from_s, to_s = curve[times_s < 12.6][-1], curve[-20]
            half.append(times_s[np.argmax((curve - from_s) / (to_s - from_s) > 0.5)])
        assert 0.10 < half[1] - half[0] < 0.45
        at_once = gaze.sample(np.array([half[0] + 0.06]))
        assert abs(at_once.head_yaw_rad[0] - look.head_yaw_rad[times_s < 12.6][-1]) < 0.03, "80 ms the head is still"


def test_the_head_follows_the_eyes_up_to_a_cue_and_not_down_to_the_music() -> None:
    cued = np.array([gaze.sample(np.array([13.6])).head_pitch_rad[0] for gaze in gazes(plan())])
    assert cued.max() < -0.005


def test_in_rests_the_eyes_wander_to_both_sides_and_the_lids_close_more_often() -> None:
    made = plan_of(fingerings([(60.0 + i, 61.0 + i, {}) for i in range(60)]))
    resting = np.arange(2.0, 55.0, 0.1)
    found = gazes(made)
    yaw, pitch = (
        np.concatenate([getattr(gaze, name).sample(resting) for gaze in found]) for name in ("yaw_rad", "pitch_rad")
    )
    assert yaw.min() < -0.2 < 0.2 < yaw.max()
    assert np.abs(yaw).max() <= 0.5
    assert pitch.min() >= -0.15
    blinks_s = starts_s(made)
    assert np.count_nonzero(blinks_s < 58.0) > 1.3 * np.count_nonzero(blinks_s > 62.0)


def test_at_the_end_the_eyes_go_up_to_the_audience() -> None:
    made = plan_of(fingerings([(i, i + 1.0, {}) for i in range(20)]))
    for gaze in gazes(made):
        before, after = gaze.pitch_rad.sample(np.array([19.9, 21.5]))
        assert before > 0.12
        assert after < 0.05


def test_no_eye_turns_faster_than_eyes_do() -> None:
    to_and_fro = tuple(glance(0.9 * (-1) ** i, 2.0 + 0.6 * i, 2.6 + 0.6 * i) for i in range(10))
    for gaze in gazes(plan(glances=to_and_fro)):
        for curve in (gaze.yaw_rad, gaze.pitch_rad):
            most = 5.7735 * np.abs(curve.after - curve.before) / np.square(curve.end_s - curve.start_s)
            assert most.max(initial=0.0) < 1500.0


def test_an_edit_changes_the_gaze_near_it_only() -> None:
    made = phrases()
    rows = [(event.start_s, event.end_s, {}) for event in made.fingerings]
    rows[60] = (rows[60][0] + 0.1, rows[60][1], {})
    later = msgspec.structs.replace(made, fingerings=fingerings(rows))
    for seed in SEEDS:
        one, other = (gaze_of(each, Watching(seed)) for each in (made, later))
        for name in ("yaw_rad", "pitch_rad", "head", "left_lid", "right_lid"):
            spans = getattr(one, name).changed_s(getattr(other, name))
            assert np.all(np.abs(spans - rows[60][0]) < 6.0), name


def test_other_players_blink_and_look_at_other_times() -> None:
    made = phrases()
    other = msgspec.structs.replace(made, player_id="other")
    one, two = gaze_of(made, Watching()), gaze_of(other, Watching())
    assert len(np.intersect1d(one.left_lid.start_s, two.left_lid.start_s)) == 0
    assert not np.array_equal(one.yaw_rad.after, two.yaw_rad.after)


def test_silences_are_rests_runs_and_entries() -> None:
    rows = [(1.0, 1.5, {}), (2.0, 2.1, {}), (2.12, 2.2, {}), (4.0, 5.0, {})]
    found = Silences.of(plan_of(fingerings(rows), breaths=(breath(3.5, 4.0), breath(0.2, 0.4, 0.5, "preparation"))))
    np.testing.assert_allclose(found.rests_s, [[-2.0, 1.0], [2.2, 4.0], [5.0, 7.0]])
    np.testing.assert_allclose(found.entries_s, [1.0, 4.0])
    np.testing.assert_allclose(found.quick_s, [[2.0, 2.12]])
    np.testing.assert_allclose(found.breaths_s, [[3.5, 4.0]])


def test_a_plan_without_notes_is_looked_through_too() -> None:
    frame = plan().time_frame
    made = PlayerPlan("player", frame, (), (), (), (), (), (), (), ())
    assert len(gaze_of(made, Watching()).sample(TIMES_S).yaw_rad) == len(TIMES_S)


def test_a_head_with_an_instrument_at_its_mouth_turns_little() -> None:
    yaw = np.linspace(-1.4, 1.4, 57)
    still = np.zeros(len(yaw))
    look = GazeFrames(
        yaw_rad=yaw,
        pitch_rad=still,
        near_per_m=still,
        own=still,
        head_yaw_rad=yaw,
        head_pitch_rad=still,
        left_lid=still,
        right_lid=still,
    )
    playing, lowered = (with_instrument(look, np.full(len(yaw), low)) for low in (0.0, 1.0))
    assert np.abs(playing.head_yaw_rad).max() < PLAYING_TURN_RAD
    assert np.all(np.diff(playing.head_yaw_rad) > 0.0)
    assert np.abs(lowered.head_yaw_rad - yaw).max() < 0.2
    for held in (playing, lowered):
        assert np.abs(held.yaw_rad - HEAD_TURNS * held.head_yaw_rad).max() <= EYES_RAD + 1e-12
