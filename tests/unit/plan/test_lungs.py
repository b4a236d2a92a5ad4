"""How full the lungs are: never more than full, never owing air."""

from __future__ import annotations

import numpy as np

from app.plan.lungs import needed_rests, with_circular_breathing

LUNG_S = 9.0


def test_two_breaths_close_together_do_not_last_longer_than_one() -> None:
    used = np.arange(21.0)
    refill = np.zeros(20)
    refill[[0, 1]] = 1.0
    once = with_circular_breathing(used[1:], LUNG_S, refill[1:])
    twice = with_circular_breathing(used, LUNG_S, refill)
    np.testing.assert_allclose(twice[1:], once)


def test_who_was_out_of_air_is_full_after_a_full_breath_and_passes_the_next_short_rest() -> None:
    # A phrase of two lungfuls, a rest, a second of playing, a rest that may be passed, another second, a long rest.
    used = np.array([0.0, 18.0, 19.0, 20.0, 21.0])
    refill = np.array([1.0, 1.0, 1.0, 1.0])
    optional = np.array([False, False, True, False])
    assert needed_rests(used, LUNG_S, refill, optional, 0.5).tolist() == [True, True, False, True]
