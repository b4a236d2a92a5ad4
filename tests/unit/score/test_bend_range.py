"""Pitch bends in semitones for any range set by the file."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from app.score.bend_range import BendRanges
from app.score.model import Score
from tests.unit.score.midi_bytes import END, chunk, header, meta, note, one_track, score_of

DOWN = bytes([0, 0xE0, 0, 0x20])
"""Pitch bend message of half the range downwards."""


def set_to(*controls: tuple[int, int], channel: int = 0) -> bytes:
    return b"".join(bytes([0, 0xB0 | channel, control, value]) for control, value in controls)


def semitones(score: Score, part: int = 0) -> list[float]:
    """Bends of a part in semitones."""
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
        # Null parameter, another parameter, an unregistered one, and a reset: following data do not set the range.
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


def exclusive(*message: int) -> bytes:
    return bytes([0, 0xF0, len(message) + 1, *message, 0xF7])


def gs(*address_and_value: int) -> bytes:
    """Message that writes data to a GS address, with Roland's checksum."""
    return exclusive(0x41, 0x10, 0x42, 0x12, *address_and_value, -sum(address_and_value) % 128)


def xg(*address_and_value: int) -> bytes:
    return exclusive(0x43, 0x10, 0x4C, *address_and_value)


GM_ON, GM2_ON = exclusive(0x7E, 0x7F, 9, 1), exclusive(0x7E, 0x7F, 9, 3)
GS_RESET, XG_ON, XG_ALL = gs(0x40, 0, 0x7F, 0), xg(0, 0, 0x7E, 0), xg(0, 0, 0x7F, 0)
RANGE_12 = set_to(*SELECT, (6, 12))


@pytest.mark.parametrize(
    ("messages", "expected"),
    [
        # Roland SC-8850 owner's manual, "patch parameters": 40 2x 10, "bend pitch control", 40 to 58 for 0 to 24
        # semitones; part 1 is block 1, part 10 block 0. 40 1x 10 is "Rx. portamento".
        (gs(0x40, 0x21, 0x10, 0x4C), -6.0),
        (gs(0x40, 0x21, 0x10, 0x58), -12.0),
        (gs(0x40, 0x21, 0x10, 0x40), 0.0),
        (gs(0x40, 0x21, 0x10, 0x59), -1.0),
        (gs(0x40, 0x20, 0x10, 0x4C), -1.0),
        (gs(0x40, 0x22, 0x10, 0x4C), -1.0),
        (gs(0x40, 0x11, 0x10, 0x4C), -1.0),
        (gs(0x50, 0x21, 0x10, 0x4C), -1.0),
        # Several bytes from an address before it on; the part that receives on channel 1.
        (gs(0x40, 0x21, 0x0F, 0x40, 0x4C), -6.0),
        (gs(0x40, 0x15, 2, 0) + gs(0x40, 0x25, 0x10, 0x44), -2.0),
        # Yamaha MU80 data list, "MIDI parameter change table (multi part)": 08 nn 23, "bend pitch control", 28 to 58
        # for -24 to 24 semitones, 42 at first.
        (xg(8, 0, 0x23, 0x4C), -6.0),
        (xg(8, 0, 0x23, 0x28), 12.0),
        (xg(8, 0, 0x23, 0x27), -1.0),
        (xg(8, 1, 0x23, 0x4C), -1.0),
        (xg(8, 16, 0x23, 0x4C), -1.0),
        # The last one holds, of whichever kind; a reset takes it back, and the parameter that was selected.
        (gs(0x40, 0x21, 0x10, 0x44) + RANGE_12, -6.0),
        (RANGE_12 + b"\1" + gs(0x40, 0x21, 0x10, 0x44)[1:], -2.0),
        *((RANGE_12 + b"\1" + reset[1:], -1.0) for reset in (GM_ON, GM2_ON, GS_RESET, XG_ON, XG_ALL)),
        (set_to(*SELECT) + b"\1" + GS_RESET[1:] + set_to((6, 12)), -1.0),
        (gs(0x40, 0x21, 0x10, 0x4C) + b"\1" + XG_ON[1:], -1.0),
        (GS_RESET + RANGE_12, -6.0),
        (RANGE_12 + gs(0x40, 1, 0x30, 4), -6.0),
    ],
)
def test_a_sound_modules_messages_set_the_range(messages: bytes, expected: float) -> None:
    assert semitones(one_track(messages + DOWN + note(60))) == [expected]
    if RANGE_12 not in messages and set_to(*SELECT) not in messages:
        assert semitones(two_tracks(messages, b"\2" + DOWN[1:] + note(60))) == [expected]


def test_a_reset_of_the_sound_module_ends_a_bend() -> None:
    assert semitones(one_track(DOWN + note(60) + GS_RESET + note(62))) == [-1.0, 0.0]
    assert semitones(one_track(GS_RESET + DOWN + note(60))) == [-1.0]
