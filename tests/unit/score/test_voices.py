"""Who plays what in a track that players share."""

from __future__ import annotations

from app.score.model import Note
from app.score.tempo import TempoChange, TempoMap
from app.score.voices import split_voices

TEMPO = TempoMap(1000)  # 120 beats per minute: a tick is half a millisecond


def notes(*rows: tuple[float, float, int]) -> list[Note]:
    """Notes from (onset, duration in quarters, pitch)."""
    return [
        Note(f"1:{index}", round(1000 * onset), round(1000 * length), pitch, 64)
        for index, (onset, length, pitch) in enumerate(sorted(rows, key=lambda row: row[0]), 1)
    ]


def pitches(*rows: tuple[float, float, int]) -> list[list[int]]:
    return [[note.pitch for note in voice] for voice in split_voices(notes(*rows), TEMPO)]


def test_a_line_is_one_voice() -> None:
    assert pitches((0, 1, 60), (1, 1, 72), (2, 1, 48)) == [[60, 72, 48]]
    assert split_voices([], TEMPO) == []


def test_an_overlap_of_30_ms_is_legato_and_a_longer_one_is_two_voices() -> None:
    assert pitches((0, 1.06, 60), (1, 1, 62)) == [[60, 62]]
    assert len(pitches((0, 1.062, 60), (1, 1, 62))) == 2


def test_how_long_30_ms_are_depends_on_the_tempo() -> None:
    rows = notes((0, 1.1, 60), (1, 1, 62))
    assert len(split_voices(rows, TEMPO)) == 2
    assert len(split_voices(rows, TempoMap(1000, (TempoChange(0, 250_000),)))) == 1


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
    upper, lower = pitches((0, 1, 72), (0, 1, 60), *line)
    assert upper == [72, 71, 64, 72, 62, 69]
    assert lower == [60]


def test_a_line_that_ends_in_the_lower_note_of_a_chord_is_the_lower_players() -> None:
    # After a rest a line begins; only the chord it leads to shows whose it is.
    upper, lower = pitches((0, 1, 64), (0, 1, 60), (4, 1, 66), (5, 1, 64), (6, 1, 62), (7, 1, 76), (7, 1, 64))
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
