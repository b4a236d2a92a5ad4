"""Positions between notes after a changed file is read again."""

from __future__ import annotations

from fractions import Fraction

import pytest

from app.project.moved_ticks import place_map


@pytest.mark.parametrize(("tick", "moved"), [(-50, -50), (0, 0), (90, 90), (400, 100), (480, 100), (500, 120)])
def test_a_place_stays_between_the_notes_around_it(tick: int, moved: int) -> None:
    # The second note moved 380 ticks earlier: positions after the first note must stay before it.
    assert place_map([(0, 0), (480, 100)], Fraction(1))(tick) == moved


def test_without_notes_a_place_moves_with_the_division() -> None:
    assert place_map([], Fraction(2))(480) == 960
