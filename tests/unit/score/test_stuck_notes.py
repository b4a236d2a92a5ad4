"""Notes that sound for hours because of a stuck key or a lost connection."""

from __future__ import annotations

import pytest

from app.messages import text
from app.score.model import Score
from tests.fuzz.harness.costly_midi import END, midi, note
from tests.unit.score.midi_bytes import score_of

QUARTER = 480
HOUR = 2 * 3600 * QUARTER
"""Ticks at 120 quarters a minute."""
PROGRAM = b"\0\xc0\x38"
MUSIC = b"".join(note(60 + at % 5) for at in range(40))


def lengths(score: Score) -> list[int]:
    return [note.duration_tick for part in score.parts for note in part.notes if note.pitch == 70]


def test_a_note_of_twelve_hours_is_cut_where_the_music_ends_and_named() -> None:
    score = score_of(midi(PROGRAM + MUSIC + END, PROGRAM + note(70, 12 * HOUR, 4 * QUARTER) + END))
    assert lengths(score) == [36 * QUARTER]
    (warning,) = (message for message in score.warnings if message.id == "midi.stuck_notes")
    assert warning.arguments == {"track": 2, "count": 1, "place": "2.1.000", "pitch": 70, "hours": 12.0}
    assert "2.1.000" in text(warning)
    assert "(B♭4, 12 hours long)" in text(warning)


def test_four_of_them_at_once_are_four_notes() -> None:
    score = score_of(midi(*[PROGRAM + note(70, 12 * HOUR) + END] * 4))
    assert lengths(score) == [4 * QUARTER] * 4
    assert sum(message.id == "midi.stuck_notes" for message in score.warnings) == 4


@pytest.mark.parametrize("ticks", [2 * HOUR, 2**28 - 1])
def test_a_file_that_only_a_stuck_note_makes_too_long_opens(ticks: int) -> None:
    assert lengths(score_of(midi(PROGRAM + MUSIC + note(70, ticks) + END))) == [4 * QUARTER]


def test_long_notes_of_music_stay() -> None:
    drone = note(70, HOUR // 2)
    music = b"".join(note(60, QUARTER) for _ in range(HOUR // 2 // QUARTER))
    for tracks in (
        # Alone; as long as the music; half an hour after music of a quarter of an hour.
        [drone],
        [drone, music],
        [drone, music[: len(music) // 2]],
    ):
        score = score_of(midi(*(PROGRAM + track + END for track in tracks)))
        assert lengths(score) == [HOUR // 2]
        assert not any(message.id == "midi.stuck_notes" for message in score.warnings)


def test_a_note_of_an_hour_after_a_short_piece_is_stuck() -> None:
    score = score_of(midi(PROGRAM + MUSIC + END, PROGRAM + note(70, HOUR * 3 // 4) + END))
    assert lengths(score) == [40 * QUARTER]
