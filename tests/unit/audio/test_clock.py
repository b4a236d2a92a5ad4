"""The smoothed clock of a device that counts in steps and reports them with random delays."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.audio.clock import DeviceClock


class Device:
    """A device that counts in steps at a slightly different rate, reports each with a random delay, and may pause."""

    def __init__(
        self, seed: int, step_s: float, jitter_s: float, drift: float, stands: tuple[float, float] | None
    ) -> None:
        rng = np.random.default_rng(seed)
        steps = np.arange(1, int(12.0 / step_s))
        played_at = steps * step_s / (1.0 + drift)
        if stands is not None:
            played_at = played_at + np.where(played_at > stands[0], stands[1], 0.0)
        self._reported_at = np.maximum.accumulate(played_at + rng.uniform(0.0, jitter_s, len(steps)))
        self._step_s = step_s

    def processed_s(self, time_s: float) -> float:
        return float(np.searchsorted(self._reported_at, time_s, side="right")) * self._step_s


def sampled(device: Device, poll_s: float, end_s: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Times of irregular polls, and the clock's values."""
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.5 * poll_s, 1.5 * poll_s, int(end_s / poll_s)))
    now = [0.0]
    clock = DeviceClock(lambda: now[0])
    said = []
    for time_s in times:
        now[0] = float(time_s)
        clock.observe(device.processed_s(now[0]))
        said.append(clock.time_s())
    return times, np.array(said)


@settings(deadline=None, max_examples=60)
@given(
    seed=st.integers(0, 10_000),
    step_s=st.floats(0.002, 0.010),
    jitter_s=st.floats(0.0, 0.0065),
    drift=st.floats(-1e-4, 1e-4),
    poll_s=st.floats(0.004, 0.016),
)
def test_after_a_second_it_runs_evenly(seed: int, step_s: float, jitter_s: float, drift: float, poll_s: float) -> None:
    times, said = sampled(Device(seed, step_s, jitter_s, drift, None), poll_s, 6.0, seed)
    assert (np.diff(said) >= 0.0).all()
    late = times * (1.0 + drift) - said
    settled = late[times > 1.0]
    # Evenly: within a millisecond; and where the device is, to a step and its jitter.
    assert np.sqrt(((settled - settled.mean()) ** 2).mean()) < 1e-3
    assert np.abs(settled - settled.mean()).max() < 2.5e-3
    assert 0.0 <= settled.mean() + 1e-3 <= step_s + jitter_s + 2e-3


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 10_000), stands_s=st.floats(0.02, 1.5))
def test_a_device_that_stands_still_is_waited_for(seed: int, stands_s: float) -> None:
    times, said = sampled(Device(seed, 0.005, 0.0065, 0.0, (2.0, stands_s)), 0.01, 7.0, seed)
    assert (np.diff(said) >= 0.0).all()
    standing = (times > 2.1) & (times < 2.0 + stands_s)
    assert (said[standing] <= 2.0 + 0.04).all()
    after = times > 2.0 + stands_s + 1.2
    assert np.abs(times[after] - stands_s - said[after]).max() < 0.012


def test_it_waits_until_the_device_begins() -> None:
    now = [0.0]
    clock = DeviceClock(lambda: now[0])
    for _ in range(200):
        now[0] += 0.01
        clock.observe(0.0)
        assert clock.time_s() == 0.0
    clock.observe(0.005)
    assert abs(clock.time_s() - 0.005) < 1e-9
    now[0] += 0.01
    assert abs(clock.time_s() - 0.015) < 1e-9


def test_a_stalled_window_catches_up() -> None:
    device = Device(3, 0.005, 0.0065, 0.0, None)
    now = [0.0]
    clock = DeviceClock(lambda: now[0])
    for time_s in [*np.arange(0.01, 3.0, 0.01), 4.5, *np.arange(4.51, 5.0, 0.01)]:
        now[0] = float(time_s)
        clock.observe(device.processed_s(now[0]))
        said = clock.time_s()
        if time_s > 1.0:
            assert abs(said - time_s) < 0.012
