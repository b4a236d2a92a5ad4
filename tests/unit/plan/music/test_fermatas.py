"""Fermatas as written by notation programs and sequencers: the tempo drops and returns."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.plan.music.fermatas import Fermata, fermatas
from app.plan.music.piece import note_times
from app.score.model import Note
from app.score.tempo import TempoChange, TempoMap
from tests.support.plan import piece_of

Q = 480
Rows = list[tuple[float, float]]
"""Onset and length in quarters."""


def steps(start: float, end: float, step: float = 1.0, gate: float = 0.95) -> Rows:
    """Consecutive notes of one length."""
    return [(start + step * index, gate * step) for index in range(round((end - start) / step))]


HELD: Rows = [*steps(0, 12), (12, 3.9), *steps(16, 32)]


def found(tempi: list[tuple[float, float]], *lines: Rows, heard: Rows | None = None) -> tuple[Fermata, ...]:
    clock = TempoMap(Q, tuple(TempoChange(round(at * Q), round(60e6 / bpm)) for at, bpm in tempi))
    rhythms = []
    for rows in lines:
        notes = tuple(
            Note(str(number), round(at * Q), max(round(length * Q), 1), 60, 80)
            for number, (at, length) in enumerate(rows)
        )
        rhythms.append(note_times(notes, (), clock).rhythm)
    spans = tuple((round(at * Q), round((at + length) * Q)) for at, length in heard or ())
    return fermatas(tuple(rhythms), piece_of(clock, accompaniment=spans))


def places(tempi: list[tuple[float, float]], *lines: Rows, heard: Rows | None = None) -> list[tuple[float, float]]:
    """Positions in quarters of fermatas, and of the entries after them."""
    return [(one.start_tick / Q, one.entry_tick / Q) for one in found(tempi, *lines, heard=heard)]


FERMATAS = {
    "the tempo drops with the held note": ([(0, 120), (12, 40), (16, 120)], HELD),
    "it drops just before": ([(0, 120), (11.75, 40), (16, 120)], HELD),
    "it drops while the note sounds": ([(0, 120), (13, 40), (16, 120)], HELD),
    "it comes back before the entry": ([(0, 120), (12, 40), (15.5, 120)], HELD),
    "a ritardando leads into it": ([(0, 120), (9, 108), (10, 96), (11, 80), (12, 40), (16, 120)], HELD),
    "it is half as fast, then doubled again": ([(0, 100), (12, 50), (16, 100)], HELD),
    "a quicker tempo follows": ([(0, 80), (12, 40), (16, 144)], HELD),
    "a slower tempo follows": ([(0, 120), (12, 30), (16, 60)], HELD),
    "the held bar is followed by little": ([(0, 120), (12, 40), (16, 120)], [*HELD[:13], (16, 1)]),
}


@pytest.mark.parametrize("name", FERMATAS)
def test_what_all_hold_is_a_fermata(name: str) -> None:
    tempi, line = FERMATAS[name]
    assert places(tempi, line) == [(12.0, 16.0)]
    assert places(tempi, line, line, steps(0, 12)) == [(12.0, 16.0)], "one of them is silent there"


def test_a_short_note_is_held_as_well() -> None:
    assert places([(0, 120), (15, 60), (16, 120)], steps(0, 32)) == [(15.0, 16.0)]
    assert places([(0, 120), (15.5, 30), (16, 120)], steps(0, 32, 0.5)) == [(15.5, 16.0)]


def test_one_voice_may_resolve_in_a_held_chord() -> None:
    moving = [*steps(0, 12), (12, 0.95), (13, 2.9), *steps(16, 32)]
    assert places([(0, 120), (12, 40), (16, 120)], HELD, moving) == [(12.0, 16.0)]


def test_a_held_silence_is_one() -> None:
    line = [*steps(0, 12), *steps(16, 32)]
    (pause,) = found([(0, 120), (12, 40), (16, 120)], line)
    assert (pause.release_tick / Q, pause.entry_tick / Q) == (pytest.approx(11.95), 16.0)


def test_the_end_of_the_sound_is_its_release() -> None:
    (fermata,) = found([(0, 120), (12, 40), (16, 120)], HELD, [*HELD[:12], (12, 2.5), *HELD[13:]])
    assert fermata.release_tick == round(15.9 * Q)
    assert fermata.returns
    (fermata,) = found([(0, 120), (12, 40), (16, 90)], HELD)
    assert not fermata.returns


CHORDS = {
    "three half notes": (
        [(0, 120), (12, 40), (18, 120)],
        [*steps(0, 12), *steps(12, 18, 2), *steps(18, 40)],
        [12, 14, 16],
    ),
    "the tempo comes back for each rest": (
        [(0, 120), (12, 40), (14, 120), (16, 40), (18, 120), (20, 40), (22, 120)],
        [*steps(0, 12), (12, 2), (16, 2), (20, 2), *steps(24, 40)],
        [12, 16, 20],
    ),
    "short chords with rests": (
        [(0, 120), (12, 30), (15, 120)],
        [*steps(0, 12), *steps(12, 15, 1.0, 0.5), *steps(15, 40)],
        [12, 13, 14],
    ),
    "the piece begins with them": ([(0, 40), (6, 120)], [*steps(0, 6, 2), *steps(6, 40)], [0, 2, 4]),
    "two whole bars": ([(0, 100), (16, 50), (24, 100)], [*steps(0, 16), *steps(16, 24, 4), *steps(24, 48)], [16, 20]),
}


@pytest.mark.parametrize("name", CHORDS)
def test_chords_may_each_have_one(name: str) -> None:
    tempi, line, starts = CHORDS[name]
    below = [(at, length) for at, length in line if at in starts] + [(at, 0.9) for at, _ in line if at not in starts]
    assert [start for start, _ in places(tempi, line, sorted(below))] == starts


NONE = {
    "one tempo": ([(0, 120)], HELD),
    "a tempo that stays": ([(0, 120), (12, 40)], HELD),
    "a tempo that stays to the end": ([(0, 120), (12, 60)], [*HELD[:13], *steps(16, 20)]),
    "a slow bar in which they move": ([(0, 120), (12, 40), (16, 120)], steps(0, 32)),
    "a slow end": ([(0, 120), (12, 40)], [*steps(0, 12), (12, 4)]),
    "a lingering last beat": ([(0, 120), (15, 92), (16, 120)], steps(0, 32)),
    "a ritardando, then the old tempo": (
        [(0, 120), (11, 108), (12, 98), (13, 88), (14, 78), (15, 68), (16, 120)],
        steps(0, 32),
    ),
    "a slow passage of long notes": (
        [(0, 120), (12, 40), (24, 120)],
        [*steps(0, 12), *steps(12, 24, 2), *steps(24, 40)],
    ),
    "long notes in a tempo that stays": ([(0, 120), (12, 40)], [*steps(0, 12), *steps(12, 18, 2), *steps(18, 30)]),
    "a quick tempo after a slow one": ([(0, 50), (24, 140)], steps(0, 48)),
    "a tempo that was played": ([(at, (120, 104, 88, 112)[at % 4]) for at in range(32)], steps(0, 32)),
}


@pytest.mark.parametrize("name", NONE)
def test_what_is_only_slow_is_none(name: str) -> None:
    tempi, line = NONE[name]
    assert places(tempi, line) == []


def test_who_goes_on_makes_it_none() -> None:
    assert places([(0, 120), (12, 40), (16, 120)], HELD, steps(0, 32)) == []
    assert places([(0, 120), (12, 40), (16, 120)], HELD, heard=[(at, 0.5) for at in range(32)]) == []


@given(
    bpm=st.sampled_from([50, 66, 72, 96, 120, 152]),
    factor=st.sampled_from([1.6, 2.0, 3.0, 4.0]),
    at=st.integers(2, 20),
    length=st.integers(1, 6),
    early=st.sampled_from([0.0, 0.1, 0.25]),
)
def test_every_hold_is_found_once_and_none_beside_it(
    bpm: int, factor: float, at: int, length: int, early: float
) -> None:
    line = [*steps(0, at), (at, length - 0.1), *steps(at + length, at + length + 12)]
    assert places([(0, bpm), (at - early, bpm / factor), (at + length, bpm)], line) == [(at, at + length)]
    assert places([(0, bpm), (at - early, bpm / factor)], line) == []
