"""Assignment of notes to players in a shared track."""

from __future__ import annotations

from typing import Any

import pytest

from app.score.model import Note
from app.score.sounding_together import LEGATO_LEAST_S, spans_of
from app.score.tempo import TempoChange, TempoMap
from app.score.voices import LEGATO_OVERLAP_S, split_voices

TEMPO = TempoMap(1000)  # 120 beats per minute: a tick is half a millisecond


def notes(*rows: tuple[float, float, int]) -> list[Note]:
    """Notes from (onset, duration in quarters, pitch)."""
    return [
        Note(f"1:{index}", round(1000 * onset), round(1000 * length), pitch, 64)
        for index, (onset, length, pitch) in enumerate(sorted(rows, key=lambda row: row[0]), 1)
    ]


def pitches(*rows: tuple[float, float, int], **options: Any) -> list[list[int]]:
    return [[note.pitch for note in voice] for voice in split_voices(notes(*rows), TEMPO, **options).voices]


def test_a_line_is_one_voice() -> None:
    assert pitches((0, 1, 60), (1, 1, 72), (2, 1, 48)) == [[60, 72, 48]]
    assert split_voices([], TEMPO).voices == []


def scale(count: int, length: float = 1.0) -> list[tuple[float, float, int]]:
    """Consecutive notes without gaps, as (onset, duration in quarters, pitch)."""
    return [(index * length, length, 60 + index % 8) for index in range(count)]


@pytest.mark.parametrize("overlap_s", [0.005, 0.038, 0.06, 0.12, 0.4])
def test_one_overlap_in_many_notes_is_a_slur(overlap_s: float) -> None:
    rows = scale(64)
    rows[20] = (20, 1 + 2 * overlap_s, rows[20][2])
    shared = split_voices(notes(*rows), TEMPO)
    (line,) = shared.voices
    assert [note.pitch for note in line] == [pitch for _, _, pitch in rows]
    assert shared.left_out == []
    # The note still overlaps the next one, so that the slur is recognised, but no longer than legato allows.
    assert 0 < line[20].end_tick - line[21].onset_tick <= 60
    assert [note.id for note in shared.shortened] == (["1:21"] if overlap_s == 0.4 else [])
    assert (line[20].duration_tick < rows[20][1] * 1000) == (overlap_s > LEGATO_OVERLAP_S)


@pytest.mark.parametrize("overlap_s", [0.02, 0.06])
@pytest.mark.parametrize("length", [0.125, 0.25, 1.0, 4.0])
def test_legato_throughout_is_one_player(overlap_s: float, length: float) -> None:
    rows = [(onset, lasts + 2 * min(overlap_s, 0.3 * lasts), pitch) for onset, lasts, pitch in scale(40, length)]
    assert len(split_voices(notes(*rows), TEMPO).voices) == 1


@pytest.mark.parametrize("beats_per_minute", [60, 90, 100, 120, 133, 140, 152])
@pytest.mark.parametrize(("length", "overlap"), [(480, 120), (120, 60)])
def test_a_legato_of_just_the_longest_is_one(beats_per_minute: float, length: int, overlap: int) -> None:
    """A quarter of longer notes, half of short ones, regardless of rounding of seconds at their ticks."""
    tempo = TempoMap.of_changes(480, [TempoChange(0, round(60_000_000 / beats_per_minute))])
    longest_s = min(max(length / 4, tempo.ticks(LEGATO_LEAST_S)), length / 2, tempo.ticks(0.2))
    line = [Note(f"1:{index}", index * (length - overlap), length, 60 + index % 7, 80) for index in range(200)]
    depths = spans_of(line, tempo).depths()
    assert set(depths[1:].tolist()) == {1 if overlap <= longest_s else 2}


@pytest.mark.parametrize(("chords", "players"), [(1, 1), (3, 1), (4, 2), (12, 2)])
def test_a_second_player_is_there_for_several_notes_in_a_row(chords: int, players: int) -> None:
    rows = scale(64)
    rows += [(onset, length, pitch - 4) for onset, length, pitch in rows[30 : 30 + chords]]
    shared = split_voices(notes(*rows), TEMPO)
    assert len(shared.voices) == players
    assert len(shared.left_out) == (chords if players == 1 else 0)
    assert all(note.pitch < 64 for note in shared.left_out)
    assert len(split_voices(notes(*rows), TEMPO, every_chord=True).voices) == 2


def test_scattered_chords_make_no_player_and_leave_the_upper_notes() -> None:
    rows = scale(64)
    rows += [(onset, length, pitch - 5) for onset, length, pitch in rows[::10]]
    shared = split_voices(notes(*rows), TEMPO)
    assert [note.pitch for note in shared.voices[0]] == [pitch for _, _, pitch in scale(64)]
    assert len(shared.voices) == 1
    assert len(shared.left_out) == 7


def test_a_choice_of_octaves_at_cadences_makes_no_player_but_octaves_throughout_do() -> None:
    rows = scale(64)
    cadence = [(onset, length, pitch - 12) for onset, length, pitch in rows[28:33]]
    assert len(split_voices(notes(*rows, *cadence), TEMPO).voices) == 1
    octaves = [(onset, length, pitch - 12) for onset, length, pitch in rows]
    assert pitches(*rows, *octaves) == [[pitch for _, _, pitch in rows], [pitch - 12 for _, _, pitch in rows]]


def test_players_who_strike_a_chord_a_little_apart_keep_their_lines() -> None:
    upper = [(onset + (0.03 if index % 2 else 0.0), length - 0.1, pitch + 5) for index, (onset, length, pitch) in
             enumerate(scale(20))]  # fmt: skip
    lower = [(onset + (0.0 if index % 3 else 0.05), length - 0.1, pitch) for index, (onset, length, pitch) in
             enumerate(scale(20))]  # fmt: skip
    assert pitches(*upper, *lower) == [[row[2] for row in upper], [row[2] for row in lower]]


def test_the_players_of_a_section_play_a_long_line_together() -> None:
    thirds = [row for onset, length, pitch in scale(8) for row in ((onset, length, pitch), (onset, length, pitch - 3))]
    line = [(8 + index, 1, 70 + index) for index in range(4)]
    upper, lower = split_voices(notes(*thirds, *line), TEMPO, unison=True).voices
    assert [note.pitch for note in upper[8:]] == [note.pitch for note in lower[8:]] == [70, 71, 72, 73]
    assert len({note.id for note in (*upper, *lower)}) == 24
    # In lines that share a staff temporarily, one continues while the other rests.
    assert sorted(map(len, split_voices(notes(*thirds, *line), TEMPO).voices)) == [8, 12]


def test_players_whom_a_name_counts_are_there_for_a_single_chord_and_play_a_line_together() -> None:
    shared = split_voices(notes(*scale(16), (16, 1, 72), (16, 1, 69)), TEMPO, least=2)
    line = [row[2] for row in scale(16)]
    assert [[note.pitch for note in voice] for voice in shared.voices] == [[*line, 72], [*line, 69]]
    assert len({note.id for voice in shared.voices for note in voice}) == 34
    # Nothing but a line: the file holds one player's notes, whatever it is called.
    assert len(split_voices(notes(*scale(16)), TEMPO, least=2).voices) == 1


def test_short_notes_struck_together_are_two_voices() -> None:
    assert pitches((0, 0.01, 60), (0, 0.01, 64)) == [[64], [60]]


def test_the_first_player_has_the_upper_note_of_a_chord() -> None:
    assert pitches((0, 1, 60), (0, 1, 67), (1, 1, 72), (1, 1, 64), (2, 1, 65), (2, 1, 60)) == [
        [67, 72, 65],
        [60, 64, 60],
    ]


def test_a_line_stays_with_the_player_who_began_it() -> None:
    # A chord, then one line that leaps: no hopping between the players.
    line = [(1 + index, 1, pitch) for index, pitch in enumerate([71, 64, 72, 62, 69])]
    upper, lower = pitches((0, 1, 72), (0, 1, 60), *line, every_chord=True)
    assert upper == [72, 71, 64, 72, 62, 69]
    assert lower == [60]


def test_a_line_that_ends_in_the_lower_note_of_a_chord_is_the_lower_players() -> None:
    # After a rest a line begins, and only the chord it leads to shows which player's it is.
    upper, lower = pitches(
        (0, 1, 64), (0, 1, 60), (4, 1, 66), (5, 1, 64), (6, 1, 62), (7, 1, 76), (7, 1, 64), every_chord=True
    )
    assert upper == [64, 76]
    assert lower == [60, 66, 64, 62, 64]


def test_a_held_note_is_not_crossed_without_need() -> None:
    voices = pitches((0, 4, 60), (0, 1, 72), (1, 1, 71), (2, 1, 69), (3, 1, 67))
    assert voices == [[72, 71, 69, 67], [60]]


def test_many_voices() -> None:
    chord = [(0.0, 1.0, pitch) for pitch in range(48, 84, 3)]
    voices = pitches(*chord, (1.0, 1.0, 48), (1.0, 1.0, 81), (1.0, 1.0, 66))
    assert len(voices) == 12
    assert sorted(pitch for voice in voices for pitch in voice) == sorted([*range(48, 84, 3), 48, 66, 81])
    assert voices[0] == [81, 81]
    assert voices[-1] == [48, 48]


# --- two voices in unison ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shorter", [0.0, 0.3])
@pytest.mark.parametrize("apart", [0.0, 0.01])
@pytest.mark.parametrize("unison", [True, False])
def test_two_voices_in_unison_are_one_player(shorter: float, apart: float, unison: bool) -> None:
    rows = [
        row
        for onset, length, pitch in scale(12, 0.9)
        for row in ((onset, length, pitch), (onset + apart, length - shorter, pitch))
    ]
    shared = split_voices(notes(*rows), TEMPO, unison=unison)
    assert [[(note.pitch, note.duration_tick) for note in voice] for voice in shared.voices] == [
        [(pitch, 900) for _, _, pitch in scale(12)]
    ]
    assert (len(shared.unisons), shared.left_out) == (12, [])


def test_voices_that_part_are_two_players_who_both_have_the_unisons() -> None:
    rows = [row for onset, length, pitch in scale(8) for row in ((onset, length, pitch), (onset, length, pitch))]
    rows += [(8 + onset, length, pitch - third) for onset, length, pitch in scale(8) for third in (0, 4)]
    shared = split_voices(notes(*rows), TEMPO)
    assert [len(voice) for voice in shared.voices] == [16, 16]
    assert not shared.unisons
    assert len(split_voices(notes(*rows[:16]), TEMPO, least=2).voices) == 2


def test_a_note_struck_again_is_no_unison() -> None:
    rows = [(0.25 * index, 0.25, 60) for index in range(16)]
    assert [len(voice) for voice in split_voices(notes(*rows), TEMPO).voices] == [16]
