"""Bars of a piece contained in a recording, and the confidence of the result."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import Argument, Message
from app.messages import text
from app.score.beat_following import Following, RunnerUp, bars_named, message_of_place
from app.score.metre_map import MetreMap

QUARTER = 480
METRES = MetreMap(QUARTER)


def following(beats: int, doubtful: tuple[int, ...]) -> Following:
    """Beats in 4/4, some of which are uncertain; the last is the end of the piece."""
    confidence = np.ones(beats)
    confidence[list(doubtful)] = 0.1
    return Following(np.arange(beats) * QUARTER, np.arange(beats) * 0.5, confidence)


def test_the_bar_line_at_the_end_is_no_bar() -> None:
    assert [bar for bar, _ in following(9, (8,)).bars(METRES)] == [1, 2]
    assert following(9, (8,)).doubtful_bars(METRES) == []


def test_neighbouring_doubtful_bars_are_one_run_and_others_are_their_own() -> None:
    bars = [bar for doubtful in (2, 3, 4, 7) for bar in range(4 * doubtful - 4, 4 * doubtful)]
    assert following(33, tuple(bars)).doubtful_bars(METRES) == [(2, 4, 10), (7, 7, 10)]


def test_a_piece_that_ends_within_a_bar_has_that_bar() -> None:
    assert [bar for bar, _ in following(10, ()).bars(METRES)] == [1, 2, 3]


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        (((45, 45),), "check bar 45 by ear"),
        (((3, 5), (8, 8)), "check bars 3-5, 8 by ear"),
    ],
)
def test_bars_are_named_as_they_are_read(runs: tuple[tuple[int, int], ...], said: str) -> None:
    message = Message("audio.followed_but", {"percent": 96, **bars_named(*runs)})
    assert text(message).endswith(said)


def test_the_second_likeliest_place_is_part_of_every_message_of_a_place() -> None:
    second = RunnerUp(-12.345, 0.216)
    told: dict[str, Argument] = {"percent": 96, "offset_s": 1.0, "tempo_percent": 2.0, **bars_named((1, 2))}
    in_recording, offsets = ("followed", "followed_but"), ("offset_found", "other_tempo", "tempo_fitted")
    ids = [*((f"audio.{name}", "-12.3") for name in in_recording), *((f"audio.{name}", "+12.3") for name in offsets)]
    for id, said in (*ids, ("video.offset_found", "+12.3")):
        for language in ("en", "ja"):
            alone = text(message_of_place(id, told, None), language)
            both = text(message_of_place(id, told, second), language)
            assert said in both
            assert "22 %" in both
            assert "22 %" not in alone
