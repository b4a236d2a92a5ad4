"""Gestures defined by keys: the curve passes smoothly through the keys, and the motion breaks no contact."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.by_hand.pose_corrections import PoseAngles
from app.motion.gestures.named_gestures import Gestured, angles_deg, slopes_of, with_gestures
from app.plan.by_hand.pose_corrections import GENTLE_RAD_S2, HANDS_FOLLOW_DEG
from app.plan.model import GestureEvent
from metadata.gestures import AngleKey, AngleTrack, Gesture
from metadata.library import bundled_gestures
from metadata.tables import Title
from tests.unit.motion.events import REASON
from tests.unit.motion.test_perform import made, piece

KEYS = (AngleKey(0.0, 0.0), AngleKey(0.3, 8.0), AngleKey(0.6, 5.0), AngleKey(1.0, 0.0))
TRACK = AngleTrack("head", "up", KEYS)
TILT = Gesture("tilt", Title("Tilt"), 2.0, (TRACK, AngleTrack("torso", "left", KEYS)))


def event(start_s: float, end_s: float, gesture: Gesture = TILT, amount: float = 1.0, name: str = "x") -> GestureEvent:
    ticks = (round(960 * start_s), round(960 * end_s))
    return GestureEvent(f"named:{name}", "named", *ticks, start_s, end_s, amount, REASON, True, gesture.name, gesture)


def test_the_curve_goes_through_its_keys_and_stays_between_them() -> None:
    phase = np.linspace(-0.5, 1.5, 2001)
    angles = angles_deg(TRACK, phase)
    for key in KEYS:
        assert angles_deg(TRACK, np.array([key.at]))[0] == pytest.approx(key.deg)
    assert angles.min() >= -1e-9
    assert angles.max() <= 8.0 + 1e-9
    assert not angles[(phase < 0.0) | (phase > 1.0)].any()


def test_tangents_are_level_at_turns_onwards_between_and_as_given() -> None:
    slopes = slopes_of(TRACK)
    assert slopes[[0, 1, 3]].tolist() == [0.0, 0.0, 0.0]
    assert slopes[2] < 0.0
    steep = AngleTrack("head", "up", (AngleKey(0.0, 0.0), AngleKey(0.5, 8.0, 40.0), AngleKey(1.0, 0.0)))
    near = angles_deg(steep, np.array([0.5 - 1e-5, 0.5 + 1e-5]))
    assert np.diff(near)[0] / 2e-5 == pytest.approx(40.0, rel=1e-3)


@given(st.lists(st.floats(-20.0, 20.0), min_size=1, max_size=8))
def test_speed_and_acceleration_have_no_jump(angles: list[float]) -> None:
    at = np.linspace(0.0, 1.0, len(angles) + 2)
    track = AngleTrack(
        "head", "up", tuple(AngleKey(float(t), deg) for t, deg in zip(at, [0.0, *angles, 0.0], strict=True))
    )
    step = 1e-4
    curve = angles_deg(track, np.arange(-0.1, 1.1, step))
    speed = np.diff(curve) / step
    acceleration = np.diff(speed) / step
    scale = (1.0 + np.abs(angles).max()) * (len(angles) + 1) ** 3
    assert np.abs(np.diff(acceleration)).max() <= 500.0 * step * scale


def test_the_same_frames_are_the_same_in_every_span_and_changes_are_where_they_are() -> None:
    quick = msgspec.structs.replace(TILT, amplitude=(0.1, 1.0, 2.0))
    one = Gestured.of((event(1.0, 3.0), event(2.0, 4.0, quick), event(8.0, 9.0)))
    times_s = np.arange(0.0, 10.0, 0.05)
    whole = with_gestures({}, one.sample(times_s), 0.7, 1.0)
    part = with_gestures({}, one.sample(times_s[30:60]), 0.7, 1.0)
    assert whole.keys() == part.keys() == {"head", "torso"}
    for target, offset in whole.items():
        assert np.array_equal(offset.up[30:60], part[target].up)
        assert np.array_equal(offset.left[30:60], part[target].left)
    other = Gestured.of((event(1.0, 3.0), event(2.0, 4.0, quick, 0.5), event(8.0, 9.0)))
    assert one.changed_s(other).tolist() == [[2.0, 4.0], [2.0, 4.0]]
    assert not len(one.changed_s(one))
    slower = Gestured.of((event(1.0, 3.0, msgspec.structs.replace(TILT, length_s=3.0)),))
    assert len(one.changed_s(slower)) == 4


def test_the_size_follows_amplitude_and_amount_up_to_the_largest() -> None:
    sums = Gestured.of((event(0.0, 2.0),)).sample(np.array([0.6]))

    def head(amplitude: float, amount: float) -> float:
        found = with_gestures({}, sums, amplitude, amount)
        return float(np.rad2deg(found["head"].up[0])) if found else 0.0

    assert head(0.5, 1.0) == pytest.approx(8.0, rel=0.05)
    assert head(0.0, 1.0) == pytest.approx(0.3 * 8.0, rel=0.05)
    assert head(0.5, 0.5) == pytest.approx(4.0, rel=0.05)
    assert head(1.0, 2.0) == head(1.0, 1.0)
    assert head(0.5, 0.0) == 0.0


def test_with_what_the_animator_holds_it_goes_no_further_than_hands_follow() -> None:
    high = np.deg2rad(HANDS_FOLLOW_DEG["head"]["up_deg"][1])
    zero = np.zeros(1)
    held = {"head": PoseAngles(np.array([high - 0.02]), zero, zero)}
    sums = Gestured.of((event(0.0, 2.0),)).sample(np.array([0.6]))
    both = with_gestures(held, sums, 1.0, 1.0)
    assert high - 0.02 < both["head"].up[0] <= high


def test_the_head_follows_and_the_rest_of_the_performance_is_as_it_was() -> None:
    plan = piece()
    with_it = msgspec.structs.replace(plan, gestures=(*plan.gestures, event(4.0, 6.0)))
    before, after = made(plan), made(with_it)
    differs = np.abs(after.rotations - before.rotations).reshape(len(after.rotations), -1).max(axis=1)
    times_s = plan.time_frame.first_frame_s + np.arange(len(differs)) / 60.0
    inside = (times_s > 4.2) & (times_s < 5.6)
    assert differs[inside].min() > 1e-3
    assert differs[(times_s < 3.8) | (times_s > 6.2)].max() < 1e-6


@pytest.mark.parametrize("name", sorted(bundled_gestures()))
def test_every_bundled_gesture_is_gentle_as_it_is_usually_done(name: str) -> None:
    gesture = bundled_gestures()[name]
    fps = 120.0
    phase = np.arange(0.0, gesture.length_s, 1.0 / fps) / gesture.length_s
    for track in gesture.tracks:
        angles = np.deg2rad(gesture.amplitude[2] * angles_deg(track, phase))
        assert np.abs(np.diff(angles, 2)).max() * fps * fps <= GENTLE_RAD_S2, (name, track.target)


def test_sampling_is_quick_however_many_there_are() -> None:
    many = Gestured.of(tuple(event(3.0 * k, 3.0 * k + 2.0, name=str(k)) for k in range(2000)))
    found = many.sample(np.arange(0.0, 2.0, float(Fraction(1, 60))))
    assert found[TILT.amplitude]["head"].shape == (3, 120)
