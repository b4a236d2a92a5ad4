"""Pitch bends in semitones, whatever range the file sets."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from app.score.bend_range import BendRanges
from app.score.model import Score
from tests.unit.score.midi_bytes import END, chunk, header, meta, note, one_track, score_of

DOWN = bytes([0, 0xE0, 0, 0x20])
"""Half of the range downwards."""


def set_to(*controls: tuple[int, int], channel: int = 0) -> bytes:
    return b"".join(bytes([0, 0xB0 | channel, control, value]) for control, value in controls)


def semitones(score: Score, part: int = 0) -> list[float]:
    """The bends of a part, in semitones."""
    curve = next(curve for curve in score.parts[part].curves if curve.kind == "pitch_bend")
    return [2.0 * value for value in curve.values]


SELECT = ((101, 0), (100, 0))


@pytest.mark.parametrize(
    ("controls", "expected"),
    [
        ((), 2.0),
        ((*SELECT, (6, 12)), 12.0),
        ((*SELECT, (6, 12), (38, 0)), 12.0),
        ((*reversed(SELECT), (6, 7), (38, 50)), 7.5),
        # Cents before semitones, and semitones alone.
        ((*SELECT, (38, 50), (6, 0)), 0.5),
        ((*SELECT, (6, 0), (38, 50), (6, 2)), 2.0),
        ((*SELECT, (6, 0), (38, 0)), 0.0),
        # Null, another parameter, an unregistered one, a reset: what follows is not for the range.
        ((*SELECT, (6, 12), (101, 127), (100, 127), (6, 1)), 12.0),
        ((*SELECT, (6, 12), (100, 1), (6, 64)), 12.0),
        ((*SELECT, (99, 1), (98, 8), (6, 64)), 2.0),
        ((*SELECT, (6, 12), (121, 0), (6, 64)), 12.0),
        ((*SELECT, (99, 1), (98, 8), (6, 64), *SELECT, (6, 24)), 24.0),
        ((*SELECT, (6, 12), (96, 127), (96, 0)), 12.02),
        ((*SELECT, (6, 12), (97, 0)), 11.99),
        # Data without a parameter.
        (((6, 12), (38, 0)), 2.0),
    ],
)
def test_a_registered_parameter_sets_the_range(controls: Iterable[tuple[int, int]], expected: float) -> None:
    ranges = BendRanges()
    for control, value in controls:
        ranges.receive(3, control, value)
    assert ranges.semitones(3) == pytest.approx(expected)
    assert ranges.semitones(4) == 2.0


def test_bends_are_read_in_semitones() -> None:
    assert semitones(one_track(DOWN + note(60))) == [-1.0]
    assert semitones(one_track(set_to(*SELECT, (6, 12)) + DOWN + note(60))) == [-6.0]


def test_the_range_holds_from_where_it_is_set_on() -> None:
    later = bytes([24, 0xB0, 101, 0]) + set_to((100, 0), (6, 24))
    assert semitones(one_track(DOWN + note(60) + later + DOWN + note(62))) == [-1.0, -12.0]


def two_tracks(one: bytes, other: bytes) -> Score:
    return score_of(header(1, 2) + chunk(b"MTrk", one + END) + chunk(b"MTrk", other + END))


def test_another_track_sets_the_range_of_a_channel() -> None:
    conductor = set_to(*SELECT, (6, 12))
    assert semitones(two_tracks(conductor, DOWN + note(60))) == [-6.0]
    assert semitones(two_tracks(set_to(*SELECT, (6, 12), channel=1), DOWN + note(60))) == [-1.0]


def test_a_track_that_sets_the_range_itself_goes_by_its_own() -> None:
    score = two_tracks(
        set_to(*SELECT, (6, 12)) + DOWN + note(60) + meta(1, b"", 48), set_to(*SELECT, (6, 24)) + DOWN + note(62)
    )
    assert [semitones(score, part) for part in range(2)] == [[-6.0], [-12.0]]


def test_a_reset_ends_a_bend() -> None:
    assert semitones(one_track(DOWN + note(60) + bytes([0, 0xB0, 121, 0]) + note(62))) == [-1.0, 0.0]
