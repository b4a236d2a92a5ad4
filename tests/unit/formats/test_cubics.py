"""Cubics through few keys compared with scipy's, and the choice of the keys."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from app.formats.cubics import cubic_keys, cubic_values, curved_values, span_slopes, stretches_again

FRAMES = 400


def _waves(lanes: int = 3, numbers: int = 2) -> np.ndarray:
    random = np.random.default_rng(8)
    at = np.arange(FRAMES)
    speed, phase = random.uniform(0.02, 0.09, (2, lanes, numbers, 3)), random.uniform(0, 6, (lanes, numbers, 3))
    return np.stack([np.sin(speed[0] * frame + phase).sum(axis=-1) for frame in at], axis=1) * 20.0


def _by_scipy(values: np.ndarray, slopes: np.ndarray, keys: np.ndarray) -> np.ndarray:
    found = np.full(FRAMES, values[keys[-1]])
    for span, (first, last) in enumerate(itertools.pairwise(keys)):
        at = np.arange(first, last + 1)
        found[at] = CubicHermiteSpline([first, last], values[[first, last]], slopes[span])(at)
    return found


def test_curves_are_scipys_through_keys_and_slopes() -> None:
    values = _waves()
    kept = np.random.default_rng(9).random((len(values), FRAMES)) < 0.1
    kept[:, 0] = True
    drawn = curved_values(values, kept)
    for lane, row in enumerate(kept):
        keys = np.flatnonzero(row)
        slopes = span_slopes(values[lane], keys)
        for number in range(values.shape[2]):
            meant = _by_scipy(values[lane, :, number], slopes[..., number], keys)
            np.testing.assert_allclose(drawn[lane, :, number], meant, atol=1e-9)
            own = cubic_values(values[lane, keys, number], slopes[..., number], keys, FRAMES)
            np.testing.assert_allclose(own, meant, atol=1e-9)


def test_slopes_are_the_best_there_are() -> None:
    """No other slopes of a span have a smaller sum of squared errors."""
    values = _waves(1, 1)[0]
    keys = np.array([10, 31])
    (slopes,) = span_slopes(values, keys)
    at = np.arange(10, 32)

    def left(begin: float, end: float) -> float:
        return float(((CubicHermiteSpline(keys, values[keys, 0], [begin, end])(at) - values[at, 0]) ** 2).sum())

    best = left(*slopes[:, 0])
    for nudge in ((1e-3, 0), (-1e-3, 0), (0, 1e-3), (0, -1e-3)):
        assert left(slopes[0, 0] + nudge[0], slopes[1, 0] + nudge[1]) > best


def test_keys_keep_every_number_within_its_bound_and_are_few() -> None:
    values = _waves()
    kept = cubic_keys(values)
    assert np.abs(curved_values(values, kept) - values).max() <= 1.0 + 1e-9
    assert kept[:, [0, -1]].all()
    assert kept.sum(axis=1).max() < 0.12 * FRAMES


def _fewest(values: np.ndarray) -> int:
    """Keys of one curve (F, D) with every span as long as possible, found frame by frame."""
    keys, here = 1, 0
    while here < len(values) - 1:
        for length in range(1, len(values) - here):
            own = values[here : here + length + 1]
            share = np.arange(length + 1)[:, None] / length
            bends = np.concatenate([share * (1.0 - share), share**2 * (1.0 - share)], axis=1)
            off = own - own[0] - (own[-1] - own[0]) * share
            fitted = bends @ np.linalg.lstsq(bends, off, rcond=None)[0]
            if np.abs(off - fitted).max() > 1.0:
                break
            most = length
        here, keys = here + most, keys + 1
    return keys


def test_spans_are_nearly_as_long_as_they_can_be() -> None:
    values = _waves()
    kept = cubic_keys(values).sum(axis=1)
    fewest = [_fewest(lane) for lane in values]
    assert (kept <= 1.04 * np.array(fewest) + 1.0).all(), (kept, fewest)


def test_a_cubic_needs_its_ends_only() -> None:
    at = np.arange(129.0)
    values = (0.001 * at**3 - 0.2 * at**2 + at)[None, :, None]
    assert np.flatnonzero(cubic_keys(values)[0]).tolist() == [0, 128]


def test_what_stays_near_its_first_value_has_one_key() -> None:
    values = np.concatenate([0.9 * np.sin(np.arange(90.0)), np.zeros(30)])[None, :, None]
    kept = cubic_keys(values)
    assert np.flatnonzero(kept[0]).tolist() == [0]
    assert not curved_values(values, kept).any()


@pytest.mark.parametrize("frames", [1, 2, 3, 64, 65, 66])
def test_short_clips(frames: int) -> None:
    values = 30.0 * np.random.default_rng(frames).normal(size=(2, frames, 3))
    kept = cubic_keys(values)
    assert np.abs(curved_values(values, kept) - values).max() <= 1.0 + 1e-9


def test_stretches_chosen_again_keep_to_lower_limits_and_their_ends() -> None:
    values = _waves()
    limits = np.ones(values.shape[:2], np.float32)
    limits[1, 120:180] = 0.25
    kept = cubic_keys(values)
    lanes, begins, ends = np.array([1, 1, 2]), np.array([100, 260, 30]), np.array([200, 399, 300])
    chosen = stretches_again(values, limits, lanes, begins, ends)
    for lane, first, last, keys in zip(lanes, begins, ends, chosen, strict=True):
        assert ((keys > first) & (keys < last)).all()
        assert (np.diff(keys) > 0).all()
        again = kept.copy()
        again[lane, first : last + 1] = False
        again[lane, [first, *keys, last]] = True
        off = np.abs(curved_values(values, again) - values)[lane, first : last + 1].max(axis=-1)
        assert (off <= limits[lane, first : last + 1] + 1e-9).all()
    usual = stretches_again(values, np.ones_like(limits), lanes, begins, ends)
    assert len(usual[0]) < len(chosen[0])
