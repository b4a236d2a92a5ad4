"""Recognition of the controllers in a file that represent dynamics."""

from __future__ import annotations

import pytest

from app.score.model import Score
from tests.unit.score.midi_bytes import note, one_track


def control(number: int, value: int) -> bytes:
    return bytes([0, 0xB0, number, value])


def curves(score: Score) -> dict[str, tuple[float, ...]]:
    (part,) = score.parts
    return {curve.kind: tuple(round(value * 127) for value in curve.values) for curve in part.curves}


def swell(number: int, *levels: int) -> bytes:
    """A note at each level of a controller."""
    return b"".join(control(number, level) + note(60) for level in levels)


@pytest.mark.parametrize(("number", "kind"), [(1, "expression"), (2, "breath"), (7, "volume"), (11, "expression")])
def test_a_controller_that_follows_the_notes_is_dynamics(number: int, kind: str) -> None:
    assert curves(one_track(swell(number, 40, 90, 60, 20))) == {kind: (40, 90, 60, 20)}


def test_a_modulation_wheel_that_comes_and_goes_is_a_vibrato() -> None:
    assert curves(one_track(swell(1, 0, 0, 50, 0, 0, 30, 0))) == {}
    assert curves(one_track(control(1, 64) + note(60) + note(62))) == {}


def test_breath_and_expression_that_move_go_before_the_modulation_wheel() -> None:
    both = b"".join(control(1, level) + control(11, 100 - level) + note(60) for level in (20, 40, 60))
    assert curves(one_track(both)) == {"expression": (80, 60, 40)}
    # Set once, they are a level of the mixer.
    assert curves(one_track(control(11, 100) + swell(1, 20, 40, 60))) == {"expression": (20, 40, 60)}
