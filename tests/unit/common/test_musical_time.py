"""Places in a score as a person writes them."""

from __future__ import annotations

import pytest

from app.score.model import Metre, Score
from app.score.tempo import TempoMap
from widgets.common.musical_time import place_text, tick_of_place

SCORE = Score("t", 480, TempoMap(480), metres=(Metre(0, 4, 4), Metre(3840, 6, 8)))


@pytest.mark.parametrize(
    ("tick", "text"),
    [(0, "1.1"), (480, "1.2"), (2040, "2.1.120"), (3840, "3.1"), (4080, "3.2"), (4081, "3.2.001"), (-480, "0.4")],
)
def test_places_are_written_and_read(tick: int, text: str) -> None:
    assert place_text(SCORE, tick) == text
    assert tick_of_place(SCORE, text) == tick


@pytest.mark.parametrize(
    ("text", "tick"), [("2", 1920), (" 2 | 3 ", 2880), ("２．１", 1920), ("3:2:5", 4085), ("x", None), ("1.0", None)]
)
def test_what_is_typed_is_understood(text: str, tick: int | None) -> None:
    assert tick_of_place(SCORE, text) == tick
