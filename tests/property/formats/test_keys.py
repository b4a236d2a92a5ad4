"""Straight lines between the kept keys stay near any curve at every frame."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation, Slerp

from app.arrays import AnyFloatArray, BoolArray, FloatArray, SingleArray
from app.formats.keys import Keys, KeySpans, runs, straight_keys

WITHIN = 1.0 + 1e-5


def _slow_off(values: AnyFloatArray, kept: BoolArray) -> float:
    """Greatest difference between the values of a curve (F, D) and those interpolated from the kept keys, frame by
    frame.
    """
    keys = [frame for frame in range(len(values)) if kept[frame]]
    worst = 0.0
    for frame in range(len(values)):
        before = max(key for key in keys if key <= frame)
        after = min((key for key in keys if key >= frame), default=before)
        for number in range(values.shape[1]):
            first, last = float(values[before, number]), float(values[after, number])
            share = (frame - before) / (after - before) if after > before else 0.0
            worst = max(worst, abs(first * (1.0 - share) + last * share - float(values[frame, number])))
    return worst


@st.composite
def curves(draw: st.DrawFn) -> FloatArray:
    """A few curves: noise, rests, ramps, steps and waves, sometimes over more than one chunk of frames."""
    lanes, width = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    frames = draw(st.sampled_from([1, 2, 3, 7, 40, 300]))
    seed, rough = draw(st.integers(0, 2**32 - 1)), draw(st.sampled_from([0.0, 0.01, 0.6, 5.0]))
    random = np.random.default_rng(seed)
    time = np.arange(frames)[:, None]
    values = np.zeros((lanes, frames, width))
    for lane in range(lanes):
        kind = draw(st.sampled_from(["rest", "ramp", "step", "wave", "late"]))
        size = random.uniform(-30.0, 30.0, width)
        shape = {
            "rest": np.zeros((frames, 1)),
            "ramp": time / frames,
            "step": (time > frames // 2) * 1.0,
            "wave": np.sin(time * random.uniform(0.01, 1.0)),
            "late": np.maximum(time - 0.9 * frames, 0.0) ** 2 / frames,
        }[kind]
        values[lane] = shape * size + rough * random.normal(size=(frames, width))
    return values


@given(curves())
def test_no_number_is_more_than_its_tolerance_off_at_any_frame(values: FloatArray) -> None:
    kept = straight_keys(values)
    assert kept[:, 0].all()
    for lane in range(len(values)):
        assert _slow_off(values[lane], kept[lane]) <= WITHIN
        if not kept[lane, -1]:
            assert kept[lane].sum() == 1, "what moves has a key at the end"


@given(arrays(np.float32, (2, 33, 2), elements=st.floats(-1e4, 1e4, width=32)))
def test_any_numbers_in_single_precision(values: SingleArray) -> None:
    kept = straight_keys(values)
    for lane in range(len(values)):
        # Lines between numbers of this size are not known better.
        assert _slow_off(values[lane], kept[lane]) <= 1.0 + 4e-7 * 1e4


@given(curves())
def test_every_curve_alone_has_the_keys_that_it_has_among_others_of_its_length(values: FloatArray) -> None:
    """Curves are walked at once, but none minds the others: only how they are cut into chunks may differ."""
    kept = straight_keys(values)
    if values.shape[1] <= 64:
        for lane in range(len(values)):
            np.testing.assert_array_equal(straight_keys(values[lane : lane + 1])[0], kept[lane])


def test_a_straight_line_has_two_keys_and_a_rest_one_over_any_length() -> None:
    time = np.arange(5000.0)
    lines = np.stack([0.37 * time - 3.0, np.full(5000, 2.0), np.where(time < 4000, 0.0, time - 4000)])[..., None]
    kept = straight_keys(lines)
    assert np.flatnonzero(kept[0]).tolist() == [0, 4999]
    assert np.flatnonzero(kept[1]).tolist() == [0]
    third = np.flatnonzero(kept[2]).tolist()
    assert len(third) <= 4
    assert any(3990 <= key <= 4010 for key in third)


def test_there_are_about_as_few_keys_as_a_search_of_all_finds() -> None:
    """Against the least number of keys, found by trying every line between two frames."""
    random = np.random.default_rng(4)
    time = np.arange(180)
    values = 12 * np.sin(0.07 * time) + 5 * np.sin(0.19 * time + 1) + 0.2 * random.normal(size=180)
    steps = np.full(180, 10_000)
    steps[0] = 0
    for last in range(1, 180):
        for first in range(last):
            share = (time[first : last + 1] - first) / (last - first)
            line = values[first] * (1 - share) + values[last] * share
            if np.abs(line - values[first : last + 1]).max() <= 1.0:
                steps[last] = min(steps[last], steps[first] + 1)
    found = int(straight_keys(values[None, :, None]).sum())
    assert steps[-1] + 1 <= found <= 1.3 * (steps[-1] + 1)


@given(arrays(np.bool_, st.integers(1, 30)))
def test_runs_are_what_is_flagged(flags: BoolArray) -> None:
    again = np.zeros(len(flags), bool)
    spans = list(runs(flags))
    for span in spans:
        again[span] = True
    np.testing.assert_array_equal(again, flags)
    assert all(one.stop < two.start for one, two in itertools.pairwise(spans))


@given(st.integers(0, 2**32 - 1), st.integers(1, 40))
def test_what_is_between_keys_is_as_other_libraries_have_it(seed: int, frames: int) -> None:
    random = np.random.default_rng(seed)
    kept = random.random(frames) < 0.3
    kept[0] = True
    turns = Rotation.random(frames, random_state=seed % 2**31).as_quat()
    numbers = random.normal(size=(frames, 2))
    spans, keys, time = KeySpans.of(kept[None]), np.flatnonzero(kept), np.arange(frames)
    drawn = spans.straight(numbers[None])[0]
    for column in range(2):
        np.testing.assert_allclose(drawn[:, column], np.interp(time, keys, numbers[keys, column]), atol=1e-5)
    if len(keys) > 1:
        meant = Slerp(keys, Rotation.from_quat(turns[keys]))(np.minimum(time, keys[-1]))
        assert (Rotation.from_quat(spans.turned(turns[None])[0]) * meant.inv()).magnitude().max() < 1e-5


@pytest.mark.parametrize(
    "keys",
    [
        Keys((np.array([0]),)),
        Keys((np.array([0]), np.array([1, 2]))),
        Keys((np.array([0]), np.array([0, 5]))),
        Keys((np.array([0]), np.array([0, 3, 3]))),
        Keys((np.array([0]), np.array([], int))),
        Keys((np.array([0]), np.array([0])), {"smile": np.array([0])}),
        Keys((np.array([0]), np.array([0])), face=np.array([2])),
        Keys((np.array([0]), np.array([0])), pose=np.array([4, 0])),
    ],
)
def test_keys_that_no_clip_can_have_are_refused(keys: Keys) -> None:
    with pytest.raises(ValueError, match="keys"):
        keys.check(2, 5, {})
