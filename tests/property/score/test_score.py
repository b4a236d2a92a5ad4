"""Properties of the score: written content is read back, times convert in both directions, players lose and duplicate
nothing.
"""

from __future__ import annotations

import io
from collections import Counter
from itertools import pairwise

import mido
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.score.model import Note
from app.score.repair import repaired
from app.score.tempo import TempoChange, TempoMap
from app.score.voices import LEGATO_OVERLAP_S, split_voices
from tests.unit.score.midi_bytes import score_of

TEMPI = st.lists(
    st.tuples(st.integers(0, 20_000), st.integers(100_000, 2_000_000)),
    min_size=1,
    max_size=8,
    unique_by=lambda row: row[0],
)


@st.composite
def tempo_maps(draw: st.DrawFn) -> TempoMap:
    """Tempo maps of any resolution."""
    changes = [TempoChange(tick, tempo) for tick, tempo in draw(TEMPI)]
    return TempoMap.of_changes(draw(st.integers(1, 2000)), changes)


@given(tempo_maps(), st.lists(st.floats(-30_000, 60_000), min_size=1, max_size=50))
def test_ticks_invert_seconds_and_time_goes_forwards(tempo_map: TempoMap, ticks: list[float]) -> None:
    places = np.sort(np.array(ticks))
    seconds = tempo_map.seconds(places)
    np.testing.assert_allclose(tempo_map.ticks(seconds), places, atol=1e-6)
    assert np.all(np.diff(seconds)[np.diff(places) > 1e-6] > 0)


@given(tempo_maps(), st.integers(-100, 25_000))
def test_seconds_are_the_sum_over_the_tempi(tempo_map: TempoMap, tick: int) -> None:
    starts = [*(change.tick for change in tempo_map.changes[1:]), 10**9]
    total = 0.0
    for change, end in zip(tempo_map.changes, starts, strict=True):
        begin = min(change.tick, tick) if change.tick == 0 else change.tick
        length = min(end, tick) - begin if tick > 0 else (tick if change.tick == 0 else 0)
        total += max(length, 0 if tick > 0 else length) * change.microseconds_per_quarter
    assert abs(tempo_map.seconds(tick) - total / 1e6 / tempo_map.ticks_per_quarter) < 1e-6


NOTES = st.lists(
    st.tuples(st.integers(0, 5000), st.integers(1, 1000), st.integers(40, 80), st.integers(1, 127)),
    min_size=1,
    max_size=60,
)


def as_notes(rows: list[tuple[int, int, int, int]]) -> list[Note]:
    """Rows of (onset, duration, pitch, velocity) as notes by onset."""
    return [Note(f"1:{number}", *row) for number, row in enumerate(sorted(rows), 1)]


LEGATO_MOST_S = 0.2
"""Longest overlap in seconds of two notes of one player."""


@given(NOTES, tempo_maps(), st.booleans())
def test_players_share_the_notes_and_lose_and_double_none(
    rows: list[tuple[int, int, int, int]], tempo: TempoMap, every_chord: bool
) -> None:
    notes = as_notes(rows)
    shared = split_voices(notes, tempo, most=len(notes), every_chord=every_chord)
    played = [note for voice in shared.voices for note in voice]
    gone = [*shared.left_out, *shared.unisons]
    assert Counter(note.id for note in (*played, *gone)) == Counter(note.id for note in notes)
    assert not shared.unisons or {note.pitch for note in shared.unisons} <= {note.pitch for note in played}
    if every_chord:
        assert shared.left_out == []
    # What is changed is only ever shorter, and reported but where it was legato.
    read = {note.id: note for note in notes}
    changed = [(read[note.id], note) for note in played if note != read[note.id]]
    assert Counter(shared.shortened) <= Counter(before for before, _ in changed)
    for before, after in changed:
        if before not in shared.shortened:
            assert tempo.seconds(before.end_tick) - tempo.seconds(after.end_tick) <= LEGATO_MOST_S
    assert all(note.duration_tick <= read[note.id].duration_tick for note in played)
    for voice in shared.voices:
        assert list(voice) == sorted(voice, key=lambda note: note.onset_tick)
        for note, following in pairwise(voice):
            assert note.onset_tick < following.onset_tick
            # Ticks may be longer than a legato overlap.
            overlap = tempo.seconds(note.end_tick - 1) - tempo.seconds(following.onset_tick)
            assert overlap <= LEGATO_OVERLAP_S + 1e-6


@given(NOTES, tempo_maps())
def test_there_are_no_more_players_than_notes_sounding_together(
    rows: list[tuple[int, int, int, int]], tempo: TempoMap
) -> None:
    notes = as_notes(rows)
    together = max(sum(note.onset_tick <= at.onset_tick < note.end_tick for note in notes) for at in notes)
    assert len(split_voices(notes, tempo, most=len(notes), every_chord=True).voices) <= together


@given(st.lists(st.lists(st.integers(40, 80), min_size=3, max_size=3, unique=True), min_size=1, max_size=20))
def test_full_chords_never_cross(chords: list[list[int]]) -> None:
    rows = [(480 * index, 480, pitch, 64) for index, chord in enumerate(chords) for pitch in chord]
    voices = split_voices(as_notes(rows), TempoMap(480)).voices
    assert [[note.pitch for note in voice] for voice in voices] == [
        [sorted(chord, reverse=True)[place] for chord in chords] for place in range(3)
    ]


@st.composite
def pieces(draw: st.DrawFn) -> tuple[mido.MidiFile, list[list[tuple[int, int, int, int]]]]:
    """A file of trumpets that each play one line, and its notes."""
    file = mido.MidiFile(type=1, ticks_per_beat=draw(st.integers(24, 960)))
    lines = []
    for number in range(draw(st.integers(1, 4))):
        track = mido.MidiTrack([mido.MetaMessage("track_name", name=f"Trumpet {number}")])
        line, tick = [], 0
        for rest, length, pitch, velocity in draw(
            st.lists(
                st.tuples(st.integers(0, 700), st.integers(1, 700), st.integers(52, 82), st.integers(1, 127)),
                min_size=1,
                max_size=20,
            )
        ):
            track.append(mido.Message("note_on", note=pitch, velocity=velocity, time=rest, channel=number))
            track.append(mido.Message("note_off", note=pitch, time=length, channel=number))
            line.append((tick + rest, length, pitch, velocity))
            tick += rest + length
        if draw(st.booleans()):
            track.insert(draw(st.integers(0, len(track))), mido.Message("sysex", data=[1, 2, 3]))
        file.tracks.append(track)
        lines.append(line)
    return file, lines


@settings(deadline=None)
@given(pieces())
def test_what_mido_writes_is_read(piece: tuple[mido.MidiFile, list[list[tuple[int, int, int, int]]]]) -> None:
    file, lines = piece
    buffer = io.BytesIO()
    file.save(file=buffer)
    score = score_of(buffer.getvalue())
    read = [[(n.onset_tick, n.duration_tick, n.pitch, n.velocity) for n in part.notes] for part in score.parts]
    assert read == lines
    assert score.ticks_per_quarter == file.ticks_per_beat
    assert [part.name for part in score.parts] == [f"Trumpet {number}" for number in range(len(lines))]
    every = [note.id for part in score.parts for note in part.notes]
    assert len(set(every)) == len(every)
    assert score.warnings == ()


@settings(deadline=None)
@given(pieces())
def test_repair_changes_nothing_that_is_whole(
    piece: tuple[mido.MidiFile, list[list[tuple[int, int, int, int]]]],
) -> None:
    def messages(data: bytes) -> list[mido.Message]:
        start = b"MThd" + bytes([0, 0, 0, 6, 0, 0, 0, 1, 1, 0xE0]) + b"MTrk" + len(data).to_bytes(4, "big")
        track = mido.MidiFile(file=io.BytesIO(start + data)).tracks[0]
        out, tick = [], 0
        for message in track:
            tick += message.time
            if message.type in ("note_on", "note_off", "track_name", "end_of_track"):
                out.append(message.copy(time=tick))
        return out

    file, _ = piece
    for track in file.tracks:
        buffer = io.BytesIO()
        mido.MidiFile(type=0, tracks=[track]).save(file=buffer)
        data = buffer.getvalue()[22:]
        repair = repaired(data)
        assert (repair.truncated_at, repair.skipped) == (None, 0)
        assert messages(repair.data) == messages(data)
        for until in (1, len(data) // 2, len(data) - 1):
            assert messages(repaired(data, until).data) == messages(data)
