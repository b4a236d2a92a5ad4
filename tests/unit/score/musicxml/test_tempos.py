"""Tempo and bars of a score."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.score.contents import score_of
from tests.unit.score.musicxml.documents import ATTRIBUTES, direction, document, listed, note, part, read, score, words


def metronome(unit: str, number: str, dots: int = 0) -> str:
    length = f"<beat-unit>{unit}</beat-unit>{'<beat-unit-dot/>' * dots}"
    return direction(f"<metronome>{length}<per-minute>{number}</per-minute></metronome>")


def bpm(folder: Path, *measures: str) -> list[tuple[float, float]]:
    """Position in quarters, and quarters per minute from there on."""
    contents = read(folder, document(*measures))
    quarter = contents.tempo_map.ticks_per_quarter
    return [(tick / quarter, round(tempo, 3)) for tick, tempo in contents.tempo_map.bpm]


BAR = note("C4", 16)


def test_tempo_by_sounds_marks_and_words(tmp_path: Path) -> None:
    assert bpm(tmp_path, BAR) == [(0, 120)]
    assert bpm(tmp_path, metronome("quarter", "80") + BAR, metronome("quarter", "60", 1) + BAR) == [(0, 80), (4, 90)]
    assert bpm(tmp_path, metronome("half", "ca. 66") + BAR) == [(0, 132)]
    assert bpm(tmp_path, words("Adagio") + BAR, words("Allegro", '<sound tempo="140"/>') + BAR) == [(0, 66), (4, 140)]


def test_a_ritardando_slows_down_until_a_tempo(tmp_path: Path) -> None:
    tempi = bpm(tmp_path, metronome("quarter", "100") + BAR, words("rit.") + BAR, words("a tempo") + BAR, BAR)
    assert tempi[0] == (0, 100)
    assert tempi[-1] == (8, 100)
    ramp = [tempo for place, tempo in tempi if 4 <= place < 8]
    assert len(ramp) == 8
    assert ramp == sorted(ramp, reverse=True)
    assert 60 < ramp[-1] < 80


@pytest.mark.parametrize(("said", "mark"), [("rit.", 90), ("rit.", 40), ("accel.", 108), ("accel.", 200)])
def test_a_gradual_change_never_goes_past_the_tempo_that_it_leads_to(said: str, mark: int, tmp_path: Path) -> None:
    start = metronome("quarter", "100") + BAR
    tempi = bpm(tmp_path, start, words(said) + BAR, metronome("quarter", str(mark)) + BAR)
    ramp = [tempo for place, tempo in tempi if place < 8]
    assert ramp == sorted(ramp, reverse=mark < 100)
    assert min(100, mark) <= min(ramp) < max(ramp) <= max(100, mark)
    assert tempi[-1][1] == mark


def test_a_fermata_holds_its_note(tmp_path: Path) -> None:
    held = note("C4", 8) + note("D4", 8, notations="<fermata/>")
    assert bpm(tmp_path, held, BAR) == [(0, 120), (2, 60), (4, 120)]


def test_a_pickup_and_a_bar_parted_by_a_repeat(tmp_path: Path) -> None:
    right = '<barline location="right"><repeat direction="backward"/></barline>'
    contents = read(tmp_path, document(note("C4", 4), BAR, note("C4", 12) + right, note("D4", 4), BAR))
    quarter = contents.tempo_map.ticks_per_quarter
    score = score_of(contents)
    assert contents.pickup_ticks == quarter
    # Pickup, a bar, three beats and the pickup again, a bar, three beats and the fourth, a bar.
    assert [score.metre_map.bar_of_tick(round(place * quarter)) for place in (0, 1, 5, 8, 9, 13, 16, 17)] == [
        *(0, 1, 2, 2, 3, 4, 4, 5)
    ]
    assert [metre.tick // quarter for metre in contents.metres] == [0, 1]


def test_rests_that_are_too_long_move_no_one(tmp_path: Path) -> None:
    """Scores of real programs contain them: a whole rest in a pickup, and rests after the notes of one part."""
    solo = part("P1", note("C4", 4) + note("r", 4), BAR, note("D4", 16) + note("r", 8), note("E4", 24), BAR)
    other = part("P2", note("r", 16), BAR, BAR, note("r", 16), note("F4", 16))
    text = score(listed("P1", "Flute"), listed("P2", "Oboe"), solo, other)
    contents = read(tmp_path, text.replace('number="1"', 'number="0" implicit="yes"'))
    quarter = contents.tempo_map.ticks_per_quarter
    first, second = (sorted({tick / quarter for tick in stream.onset_ticks}) for stream in contents.channels)
    # The pickup, a bar, a bar with a rest too many, a cadenza of six quarters, a bar.
    assert contents.pickup_ticks == 2 * quarter
    assert first[-2:] == [10, 16]
    assert second[-1] == 16


def test_changes_of_metre_and_a_long_measure(tmp_path: Path) -> None:
    three = "<attributes><time><beats>3</beats><beat-type>8</beat-type></time></attributes>"
    contents = read(tmp_path, document(BAR, note("C4", 24), BAR, three + note("C4", 6), note("C4", 6)))
    quarter = contents.tempo_map.ticks_per_quarter
    assert [(metre.tick / quarter, metre.numerator, metre.denominator) for metre in contents.metres] == [
        (0, 4, 4),
        (4, 6, 4),
        (10, 4, 4),
        (14, 3, 8),
    ]


@pytest.mark.parametrize(
    ("time", "metre"),
    [
        ("<beats>3+2</beats><beat-type>8</beat-type>", (5, 8)),
        ("<beats>1</beats><beat-type>4</beat-type><beats>3</beats><beat-type>8</beat-type>", (5, 8)),
        ("<senza-misura/>", (4, 4)),
    ],
)
def test_time_signatures(tmp_path: Path, time: str, metre: tuple[int, int]) -> None:
    attributes = ATTRIBUTES.replace("<beats>4</beats><beat-type>4</beat-type>", time)
    length = 16 if metre == (4, 4) else 10
    contents = read(tmp_path, document(note("C4", length), note("C4", length), attributes=attributes))
    assert [(one.numerator, one.denominator) for one in contents.metres] == [metre]
