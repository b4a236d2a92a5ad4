"""Felt beginnings of bars in files without marked pickups."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import pytest

from app.plan.generate import Piece
from app.plan.music import felt_bars
from app.plan.music.piece import LineTimes, MonophonicPart, line_times
from app.score.metre_map import Metre
from tests.support.engraved_breaths import TICKS, marked_lines
from tests.support.plan import PlainClock, line_of, piece_of, valves


def with_felt_bars(piece: Piece, lines: Sequence[LineTimes]) -> Piece:
    return felt_bars.with_felt_bars(piece, tuple(times.rhythm for times in lines), felt_bars.lowest(lines))


def times_of(*notes: tuple[int, int, int]) -> LineTimes:
    return line_times(MonophonicPart("p", line_of(*notes), valves()), PlainClock())


def piece_in(numerator: int, denominator: int) -> Piece:
    return piece_of(PlainClock(), (Metre(0, numerator, denominator),))


def waltz(pickup: int, late_ticks: int = 0) -> LineTimes:
    """Bars of a half and two eighths after some quarters; every other note is late."""
    notes = [(beat * TICKS, TICKS, 67) for beat in range(pickup)]
    for bar in range(16):
        start = (pickup + 3 * bar) * TICKS
        notes += [(start, 2 * TICKS, 65), *((start + half * TICKS // 2, TICKS // 2, 67) for half in (4, 5))]
    late = [(start + index % 2 * late_ticks, long, pitch) for index, (start, long, pitch) in enumerate(notes)]
    return times_of(*late)


@pytest.mark.parametrize("late_ticks", [0, 11])
@pytest.mark.parametrize("pickup", [1, 2])
def test_bars_begin_after_the_pickup(pickup: int, late_ticks: int) -> None:
    felt = with_felt_bars(piece_in(3, 4), (waltz(pickup, late_ticks),))
    bars = felt.bars(0, 18 * 3 * TICKS)
    assert set(bars % (3 * TICKS)) == {pickup * TICKS}
    assert bars[0] <= 0
    assert len(bars) == 19


def test_bars_may_be_late_by_grace_notes_that_come_before_the_first() -> None:
    """A notation program places three small notes before the first bar, so that everything after them is a sixth too
    late.
    """
    late = TICKS // 6
    notes = [(0, late, 64), *((late + beat * TICKS, TICKS, 60 + beat % 4) for beat in range(48))]
    felt = with_felt_bars(piece_in(2, 4), (times_of(*notes),))
    assert set(felt.bars(0, 48 * TICKS) % TICKS) == {late}


@pytest.mark.parametrize("parts", [1, 2, 3])
def test_a_pickup_may_be_shorter_than_a_beat(parts: int) -> None:
    """Some sixteenths, then bars of a quarter, running notes and a quarter."""
    early = parts * TICKS // 4
    notes = [(index * TICKS // 4, TICKS // 4, 65) for index in range(parts)]
    for bar in range(12):
        start = early + 3 * bar * TICKS
        notes += [(start, TICKS, 60), *((start + step * TICKS // 4, TICKS // 4, 65 + step) for step in range(4, 8))]
        notes.append((start + 2 * TICKS, TICKS, 67))
    felt = with_felt_bars(piece_in(3, 4), (times_of(*notes),))
    assert set(felt.bars(0, 36 * TICKS) % (3 * TICKS)) == {early}


def test_syncopation_moves_no_bars() -> None:
    """Eighth, quarter, eighth, and a half note on the beat."""
    rhythm = ((0, 1), (1, 2), (3, 1), (4, 4))
    notes = [(4 * bar + at, long) for bar in range(0, 32, 2) for at, long in rhythm]
    piece = piece_in(4, 4)
    times = times_of(*((at * TICKS // 2, long * TICKS // 2, 65) for at, long in notes))
    assert with_felt_bars(piece, (times,)) is piece


def test_bars_that_fit_stay() -> None:
    piece = piece_in(3, 4)
    assert with_felt_bars(piece, (waltz(0),)) is piece


def test_even_notes_say_nothing() -> None:
    piece = piece_in(3, 4)
    assert with_felt_bars(piece, (times_of(*((beat * TICKS, TICKS, 65) for beat in range(48))),)) is piece
    assert with_felt_bars(piece, ()) is piece


def test_a_known_pickup_and_changes_of_metre_are_left_alone() -> None:
    known = piece_of(PlainClock(), (Metre(0, 3, 4), Metre(2 * TICKS, 3, 4)), has_pickup=True)
    assert with_felt_bars(known, (waltz(1),)) is known
    changing = piece_of(PlainClock(), (Metre(0, 3, 4), Metre(30 * TICKS, 4, 4)))
    assert with_felt_bars(changing, (waltz(1),)) is changing


def test_engraved_pieces_are_never_moved_away_from_their_bars() -> None:
    """Read like MIDI files, with the first metre beginning at the first note."""
    pieces = defaultdict(list)
    for row in marked_lines():
        pieces[row["source"]].append(row)
    moved = 0
    for rows in pieces.values():
        metre = rows[0]["metre"]
        notes = [[(round(at * TICKS), round(long * TICKS), pitch) for at, long, pitch in row["notes"]] for row in rows]
        bar = 4 * TICKS * metre[0] // metre[1]
        piece = piece_in(metre[0], metre[1])
        felt = with_felt_bars(piece, [times_of(*one) for one in notes])
        moved += felt is not piece
        assert felt is piece or felt.bars(0, 1)[0] % bar == rows[0]["pickup_quarters"] * TICKS
    assert moved == 1


def test_another_pitch_asks_for_no_other_bars_unless_another_line_is_the_lowest() -> None:
    lines = [times_of(*((beat * TICKS, TICKS, pitch) for beat in range(8))) for pitch in (65, 40, 70)]
    higher = times_of(*((beat * TICKS, TICKS, 65 + beat) for beat in range(8)))
    assert higher.rhythm == lines[0].rhythm
    assert felt_bars.lowest([higher, *lines[1:]]) == felt_bars.lowest(lines) == (False, True, False)
    assert felt_bars.lowest([*lines[2:], times_of()]) == (True, False)
    assert felt_bars.lowest([]) == ()
