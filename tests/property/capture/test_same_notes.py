"""A recorded stream means the same notes as a take in the window, as a file of `suisou record`, and live."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.capture.journal import JournalHeader, JournalWriter, read_journal
from app.capture.journal_to_takes import takes_of
from app.cli import main
from app.performance.play_along import PlayAlong
from app.project.model import map_choices
from app.score.read import read_midi
from app.score.take import ControllerMapping, Take
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps
from tests.support.live import QUARTER, playing_alone

MAPS = map_choices(bundled_maps().values())
HEADER = JournalHeader("", "", "EWI", "ewi_usb", 0.0, "2026-11-28T00:00:00+00:00")
WIRING = ControllerMapping(channel=1, breath="cc2", bite="none")
TICK_S = 0.5 / 960
PITCHES = st.sampled_from((60, 62, 64))
MESSAGES = st.one_of(
    st.builds(lambda pitch: bytes((0x90, pitch, 80)), PITCHES),
    st.builds(lambda pitch: bytes((0x80, pitch, 64)), PITCHES),
    st.builds(lambda pitch: bytes((0x90, pitch, 0)), PITCHES),
    st.builds(lambda value: bytes((0xB0, 2, value)), st.integers(1, 127)),
    st.just(bytes((0xB0, 123, 0))),
)
STREAMS = st.lists(st.tuples(st.integers(3, 400), MESSAGES), min_size=1, max_size=25)
"""Lists of messages, each with the milliseconds after the previous one."""
Note = tuple[float, float, int]
"""Onset and end in seconds, and pitch."""


def recorded(path: Path, stream: list[tuple[int, bytes]]) -> Take | None:
    """Write the journal of a stream; the take that the window makes of it, None without notes."""
    writer = JournalWriter(str(path), HEADER)
    writer.sync(0, 0.0, 0)
    at_ms = 0
    for gap_ms, message in stream:
        at_ms += gap_ms
        writer.event(at_ms * 1_000_000, message)
    end_ms = at_ms + 500
    writer.sync(end_ms * 1_000_000, end_ms / 1e3, 0)
    writer.mark("end", end_ms * 1_000_000)
    writer.close()
    takes = takes_of(read_journal(path), TempoMap.of_changes(960, []), WIRING, "Take {number}")
    return takes[0] if takes else None


def notes_of(take: Take) -> list[Note]:
    notes = take.played
    return list(zip(notes.onsets_s.tolist(), notes.ends_s.tolist(), notes.pitches.tolist(), strict=True))


@cache
def live_player() -> Any:
    return playing_alone("trumpet_Bb", [(4 * QUARTER, QUARTER, 60)])


class Listener(PlayAlong):
    """A live player without a body."""

    def _sound(self, now_s: float, pitch: int, velocity: int, attacked: bool) -> None:
        pass


def held_live(stream: list[tuple[int, bytes]]) -> list[tuple[float, set[int]]]:
    """Pitches that the live player holds after each message, with the message's time in seconds."""
    player = Listener(live_player())
    at_ms, found = 0, []
    for gap_ms, message in stream:
        at_ms += gap_ms
        player.receive(at_ms / 1e3, message.hex(), WIRING)
        found.append((at_ms / 1e3, set(player._held)))
    return found


@settings(max_examples=60)
@given(STREAMS)
def test_the_file_and_the_take_have_the_same_notes(stream: list[tuple[int, bytes]]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "take.mid"
        take = recorded(path.with_name("take.mid.take-journal"), stream)
        assert main(["record", "--rescue", "--to", str(path)]) == 0
        parts = read_midi(path, maps=MAPS).parts
    own = [] if take is None else notes_of(take)
    read = sorted(
        (note.onset_tick * TICK_S, (note.onset_tick + note.duration_tick) * TICK_S, note.pitch)
        for part in parts
        for note in part.notes
    )
    assert [pitch for _, _, pitch in read] == [pitch for _, _, pitch in own]
    for (onset_s, end_s, _), (own_onset_s, own_end_s, _) in zip(read, own, strict=True):
        assert onset_s == pytest.approx(own_onset_s, abs=TICK_S)
        assert end_s == pytest.approx(own_end_s, abs=TICK_S)


@settings(max_examples=60)
@given(STREAMS)
def test_the_live_player_holds_what_sounds_in_the_take(stream: list[tuple[int, bytes]]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        take = recorded(Path(folder) / "take", stream)
    own = [] if take is None else notes_of(take)
    for at_s, held in held_live(stream):
        assert held == {pitch for onset_s, end_s, pitch in own if onset_s <= at_s + 1e-7 and end_s > at_s + 1e-7}
