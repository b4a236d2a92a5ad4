"""Curves of paths, accents and feet: values, smoothness, and ranges in which two differ."""

from __future__ import annotations

import numpy as np
import pytest

from app.motion.breath.air_in_trunk import air
from app.motion.curves.path import Path
from app.motion.gestures.accents import Accents
from app.motion.gestures.feet import UNLOADS_S, Feet
from app.plan.model import ACCENT_AT, GestureEvent
from tests.unit.motion.events import REASON, breath


def gesture(kind: str, start_s: float, end_s: float, amount: float = 1.0) -> GestureEvent:
    return GestureEvent(f"{kind}:{start_s}", kind, 0, 1, start_s, end_s, amount, REASON)


def test_a_path_passes_what_it_does_not_turn_at_and_rests_where_it_turns() -> None:
    path = Path.through([(0.0, 1.0, 0.4), (1.0, 2.0, 0.8), (2.0, 3.0, -0.5), (3.0, 4.0, -0.5)])
    np.testing.assert_allclose(path.sample(np.arange(5.0)), [0.0, 0.4, 0.8, -0.5, -0.5])
    speed = (path.sample(np.arange(5.0) + 1e-5) - path.sample(np.arange(5.0) - 1e-5)) / 2e-5
    np.testing.assert_allclose(speed, [0.0, 0.4, 0.0, 0.0, 0.0], atol=1e-3)
    times_s = np.arange(-1.0, 5.0, 1e-3)
    values = path.sample(times_s)
    assert values.max() == pytest.approx(0.8)
    assert values.min() == pytest.approx(-0.5)
    # Nothing jumps: neither the way nor speed nor acceleration.
    assert np.abs(np.diff(values, 3)).max() < 1e-6


def test_a_path_of_one_way_is_a_minimum_jerk_move() -> None:
    path = Path.through([(1.0, 3.0, 1.0)])
    assert path.sample(np.array([2.0]))[0] == pytest.approx(0.5)
    with pytest.raises(ValueError, match="begins before"):
        Path.through([(1.0, 3.0, 1.0), (2.0, 4.0, 0.0)])


@pytest.mark.parametrize("place", [0, 3, 7])
def test_two_paths_differ_where_they_say_so(place: int) -> None:
    rows = [(float(i), i + 1.0, (-1.0) ** i * (0.2 + 0.1 * i)) for i in range(8)]
    one, other = (
        Path.through(rows),
        Path.through([(a, b, 0.9 if i == place else v) for i, (a, b, v) in enumerate(rows)]),
    )
    _differ_only_there(one, other)
    assert not len(one.changed_s(Path.through(rows)))


def _differ_only_there(one: Path | Accents, other: Path | Accents) -> None:
    times_s = np.linspace(-3.0, 12.0, 3001)
    spans = one.changed_s(other)
    inside = np.zeros(len(times_s), np.bool_)
    for start_s, end_s in spans:
        inside |= (times_s >= start_s) & (times_s <= end_s)
    differ = one.sample(times_s) != other.sample(times_s)
    assert differ.any()
    assert not (differ & ~inside).any()
    assert inside.mean() < 0.6


def test_an_accent_is_prepared_strikes_on_its_note_and_is_followed_through() -> None:
    accents = Accents.of([gesture("accent", 2.0, 3.1)])
    times_s = np.arange(0.0, 5.0, 1e-3)
    down = accents.sample(times_s)
    note_s = 2.0 + 1.1 * ACCENT_AT
    assert times_s[down.argmax()] == pytest.approx(note_s, abs=0.002)
    assert down.max() == pytest.approx(1.0, abs=0.01)
    assert times_s[np.diff(down, 2).argmin()] == pytest.approx(note_s, abs=0.005)
    before, after = down[(times_s > 2.0) & (times_s < note_s)], down[(times_s > note_s) & (times_s < 3.1)]
    assert -0.3 < before.min() < -0.1
    assert -0.2 < after.min() < -0.05
    assert not down[(times_s < 2.0) | (times_s > 3.1)].any()
    # The same times in a span are the same bits, also where accents lie over one another.
    both = Accents.of([gesture("accent", 2.0, 3.1), gesture("accent", 2.6, 3.7, 0.5)])
    np.testing.assert_array_equal(both.sample(times_s)[2700:3000], both.sample(times_s[2700:3000]))
    _differ_only_there(both, accents)


def test_a_step_goes_out_stands_and_comes_home_while_the_weight_is_on_the_other_foot() -> None:
    feet = Feet.of([gesture("step", 2.0, 6.0, -0.8)], 0.5)
    times_s = np.arange(0.0, 8.0, 0.01)
    moved = feet.sample(times_s)
    assert moved.keys() == {f"right_{part}" for part in ("ahead", "up", "push", "unloaded")}
    ahead, up, unloaded = (moved[f"right_{part}"] for part in ("ahead", "up", "unloaded"))
    stands = (times_s > 2.5) & (times_s < 5.5)
    np.testing.assert_allclose(ahead[stands], 0.8)
    assert not ahead[(times_s < 2.0) | (times_s > 6.0)].any()
    assert not up[(times_s <= 2.0) | stands | (times_s >= 6.0)].any()
    assert unloaded[up > 0.0].min() == pytest.approx(0.8)
    assert unloaded[np.searchsorted(times_s, 2.0 - UNLOADS_S / 2)] == pytest.approx(0.4, abs=0.05)
    other = Feet.of([gesture("step", 2.0, 6.0, -0.8), gesture("tap", 7.0, 7.4, 0.5)], 0.5)
    np.testing.assert_allclose(feet.changed_s(other), [[7.0, 7.4]])
    assert not Feet.of([gesture("step", 2.0, 6.0, -0.8)], 0.5).sample(times_s[:100])


def test_ribs_are_widest_at_the_end_of_a_breath_and_sink_through_the_phrase() -> None:
    curve = air((breath(0.0, 0.5, 1.0), breath(8.0, 8.3, 0.2), breath(9.0, 9.4, 1.0)))
    times_s = np.array([-1.0, 0.48, 2.0, 4.0, 6.0, 7.9, 8.29, 9.39])
    level = curve.sample(times_s)
    assert level[1] == pytest.approx(1.0)
    assert np.all(np.diff(level[1:6]) < 0.0)
    assert level[5] < 0.2
    # Every breath shows, also a shallow one and one that comes soon.
    assert level[6] > level[5] + 0.3
    assert level[7] == pytest.approx(1.0)
