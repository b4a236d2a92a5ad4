"""The air in the lungs is never more than full and never negative."""

from __future__ import annotations

import numpy as np

from app.plan.breath.lungs import CIRCULAR_SHARE, with_circular_breathing

LUNG_S = 9.0


def test_two_breaths_close_together_do_not_last_longer_than_one() -> None:
    used = np.arange(21.0)
    refill = np.zeros(20)
    refill[[0, 1]] = 1.0
    once = with_circular_breathing(used[1:], LUNG_S, refill[1:])
    twice = with_circular_breathing(used, LUNG_S, refill)
    np.testing.assert_allclose(twice[1:], once)


def test_through_the_nose_each_breath_lasts_for_its_part_of_what_is_in_the_lungs_then() -> None:
    # A full breath, and one that fills a fifth of the lungs 20 s later: two fifths are left of the first by then.
    used, refill = np.arange(41.0), np.zeros(40)
    refill[[0, 20]] = 1.0, 0.2
    found = with_circular_breathing(used, LUNG_S, refill)
    first, second = (1.0 - CIRCULAR_SHARE) * LUNG_S, (1.0 - CIRCULAR_SHARE) * (CIRCULAR_SHARE + 0.2) * LUNG_S
    np.testing.assert_allclose(found[[20, 40]], [first, first + second])
