"""How full the lungs are: never more than full, never owing air."""

from __future__ import annotations

import numpy as np

from app.plan.breath.lungs import with_circular_breathing

LUNG_S = 9.0


def test_two_breaths_close_together_do_not_last_longer_than_one() -> None:
    used = np.arange(21.0)
    refill = np.zeros(20)
    refill[[0, 1]] = 1.0
    once = with_circular_breathing(used[1:], LUNG_S, refill[1:])
    twice = with_circular_breathing(used, LUNG_S, refill)
    np.testing.assert_allclose(twice[1:], once)
