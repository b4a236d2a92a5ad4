"""A pitch that is struck again while it sounds is treated equally in files, takes and journals."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.score.model import Score
from app.score.sounding import SoundingNotes
from tests.unit.score.midi_bytes import END, MAPS, chunk, header, meta, notes_of, one_track, score_of
from tests.unit.score.test_mpe import track

Event = tuple[int, bytes]
LEGATO_TICKS = 6
"""Overlap of legato notes in ticks: 30 ms."""


def on(tick: int, pitch: int = 60, channel: int = 0) -> Event:
    return tick, bytes([0x90 | channel, pitch, 64])


def off(tick: int, pitch: int = 60, channel: int = 0) -> Event:
    return tick, bytes([0x80 | channel, pitch, 0])


def read(events: list[Event]) -> Score:
    return one_track(meta(3, b"Trumpet") + track(events))


def lengths(score: Score) -> list[tuple[int, int]]:
    """Onset and end of the notes of the only player."""
    (part,) = score.parts
    return [(one.onset_tick, one.end_tick) for one in part.notes]


@pytest.mark.parametrize("count", [2, 3, 8, 40])
@pytest.mark.parametrize("late", [0, 5])
@pytest.mark.parametrize("more", [[], [on(96 * 50, 62), off(96 * 51, 62)]])
def test_ends_that_come_late_make_no_more_players(count: int, late: int, more: list[Event]) -> None:
    strikes = [96 * place for place in range(count)]
    events = [on(tick) for tick in strikes] + [off(96 * count + late * place) for place in range(count)]
    found = lengths(read([*events, *more]))
    ends = [*strikes[1:], 96 * count + late * (count - 1)]
    assert found[:count] == list(zip(strikes, ends, strict=True))
    assert len(found) == count + bool(more)


def test_a_pile_of_one_pitch_is_ended_beside_other_notes_too() -> None:
    held = [on(0, 55), off(96 * 8, 55)]
    pile = [on(96 * place) for place in range(8)] + [off(96 * 8) for _ in range(8)]
    assert len(read([*held, *pile]).parts) == 2


def test_legato_repetitions_and_two_players_on_one_channel_keep_their_lengths() -> None:
    legato = [event for place in range(8) for event in (on(96 * place), off(96 * place + 100))]
    assert [end - onset for onset, end in lengths(read(legato))[:-1]] == [pytest.approx(98, abs=2)] * 7
    # A held note, struck by the other player too, in a staff of chords.
    events = [one for place in range(12) for one in (on(96 * place, 64), off(96 * place + 90, 64))]
    events += [one for place in range(12) for one in (on(96 * place, 67), off(96 * place + 90, 67))]
    events += [on(96 * 12, 67), on(96 * 14, 67), off(96 * 15, 67), off(96 * 16, 67)]
    assert (96 * 12, 96 * 3, 67) in notes_of(read(events))


def test_two_voices_in_unison_are_one_player_on_two_channels_too() -> None:
    def voices(second: int, pitch: int) -> Score:
        events = [
            one
            for place in range(8)
            for channel, own in ((0, 60 + place), (second, pitch + place))
            for one in (on(96 * place, own, channel), off(96 * place + 90, own, channel))
        ]
        return score_of(
            header(1, 1) + chunk(b"MTrk", meta(3, b"Trumpet") + bytes([0, 0xC0, 56]) + track(events) + END), maps=MAPS
        )

    for second in (0, 1, 5):
        (part,) = voices(second, 60).parts
        assert len(part.notes) == 8
    assert len(voices(1, 64).parts) == 2


@given(st.lists(st.booleans(), min_size=1, max_size=24).filter(any))
def test_files_and_takes_have_the_same_notes_of_a_pitch(steps: list[bool]) -> None:
    events = [(on if begins else off)(96 * place) for place, begins in enumerate(steps)]
    events.append(off(96 * len(steps)))
    sounding, struck = SoundingNotes[int](), []
    for tick, message in events:
        struck += [(onset, tick) for _, onset in sounding.receive(message, tick)]
    ours = sorted((one.onset_tick, one.end_tick) for part in read(events).parts for one in part.notes)
    assert [onset for onset, _ in ours] == [onset for onset, _ in struck]
    # Files give an end that comes late to the note before it, first in, first out.
    assert all(end <= again + LEGATO_TICKS for (_, end), (again, _) in pairwise(ours))
