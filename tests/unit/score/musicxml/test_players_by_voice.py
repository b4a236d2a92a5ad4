"""Assignment of a staff's voices to players."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.project.importing import import_project, usual_rows
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.unit.score.musicxml.documents import document, note, words

BACK = "<backup><duration>16</duration></backup>"
HIDDEN = ' print-object="no"'
NAMES = ("C4", "D4", "E4", "F4", "G4", "A4", "B4", "C5", "D5")
PITCHES = dict(zip(NAMES, (60, 62, 64, 65, 67, 69, 71, 72, 74), strict=True))


def players(folder: Path, *measures: str, name: str = "Trumpet 1.2") -> list[list[tuple[float, int]]]:
    """Onsets in quarters and pitches of each player of a staff for two."""
    path = folder / "piece.musicxml"
    path.write_text(document(*measures, name=name), "utf-8")
    contents, maps = read_contents(path), bundled_maps()
    score = import_project(contents, usual_rows(contents, maps), maps).score
    quarter = score.ticks_per_quarter
    return [[(note.onset_tick / quarter, note.pitch) for note in part.notes] for part in score.parts]


def line(*names: str, voice: int = 1, more: str = "") -> str:
    return "".join(note(name, 16 // len(names), voice=voice, more=more) for name in names)


def test_voices_that_cross_stay_with_their_players(tmp_path: Path) -> None:
    crossing = line("C5", "A4", "F4", "D4") + BACK + line("D4", "F4", "A4", "C5", voice=2)
    assert [[pitch for _, pitch in one] for one in players(tmp_path, crossing)] == [[72, 69, 65, 62], [62, 65, 69, 72]]


def test_stems_say_who_is_the_first_where_the_numbers_do_not(tmp_path: Path) -> None:
    lower = "".join(note(name, 4, "<stem>down</stem>") for name in ("C5", "C5", "C5", "C5"))
    upper = "".join(note(name, 4, "<stem>up</stem>", voice=2) for name in ("D4", "E4", "F4", "G4"))
    assert [[pitch for _, pitch in one] for one in players(tmp_path, lower + BACK + upper)] == [
        [62, 64, 65, 67],
        [72] * 4,
    ]


def test_who_has_a_rest_of_their_own_rests_and_a_hidden_one_says_nothing(tmp_path: Path) -> None:
    both = line("C5", "D5", "C5", "D5") + BACK + line("E4", "F4", "E4", "F4", voice=2)
    rest = line("C5") + BACK + line("r", voice=2)
    hidden = line("D5") + BACK + line("r", voice=2, more=HIDDEN)
    first, second = players(tmp_path, both, rest, hidden)
    assert (4.0, 72) in first
    assert (4.0, 72) not in second
    assert (8.0, 74) in first
    assert (8.0, 74) in second


def test_words_win_over_voices(tmp_path: Path) -> None:
    both = line("C5", "D5", "C5", "D5") + BACK + line("E4", "F4", "E4", "F4", voice=2)
    _, second = players(tmp_path, both, words("2.") + line("G4", "A4", "B4", "C5"), words("a2") + line("D5"))
    assert [(onset, pitch) for onset, pitch in second if onset >= 4.0] == [
        (4.0, 67), (5.0, 69), (6.0, 71), (7.0, 72), (8.0, 74)
    ]  # fmt: skip
    first, _ = players(tmp_path, both, words("2.") + line("G4", "A4", "B4", "C5"), words("a2") + line("D5"))
    assert [pitch for onset, pitch in first if onset >= 4.0] == [74]


@settings(deadline=None, max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(
        st.one_of(
            st.tuples(st.lists(st.sampled_from(NAMES), min_size=4, max_size=4),
                      st.lists(st.sampled_from(NAMES), min_size=4, max_size=4)),
            st.tuples(st.lists(st.sampled_from(NAMES), min_size=4, max_size=4), st.none()),
        ),
        min_size=1,
        max_size=6,
    )
)  # fmt: skip
def test_each_player_has_their_voice_and_both_have_what_is_written_once(
    tmp_path: Path, drawn: list[tuple[list[str], list[str] | None]]
) -> None:
    # Enough of two voices that two players are there.
    drawn = [(["C5"] * 4, ["E4"] * 4), *drawn]
    measures = [line(*upper) + ("" if lower is None else BACK + line(*lower, voice=2)) for upper, lower in drawn]
    expected = [
        [
            (at * 4.0 + place, PITCHES[name])
            for at, bar in enumerate(drawn)
            for place, name in enumerate(bar[who] or bar[0])
        ]
        for who in (0, 1)
    ]
    assert players(tmp_path, *measures) == expected


@pytest.mark.parametrize("name", ["Horn in F 1.2", "Horns 1+2", "Trumpet 1, 2"])
@pytest.mark.parametrize(
    ("said", "first", "second"),
    [
        (("1.", "a2", "solo", ""), [0, 1, 2, 3], [1]),
        (("", "1.", "a2", "2."), [0, 1, 2], [0, 2, 3]),
    ],
)
def test_two_players_of_one_line_play_as_the_words_say(
    tmp_path: Path, name: str, said: tuple[str, ...], first: list[int], second: list[int]
) -> None:
    bars = [f"{words(text) if text else ''}{line('C4', 'D4')}" for text in said]
    found = players(tmp_path, *bars, name=name)
    assert [sorted({onset // 4 for onset, _ in one}) for one in found] == [first, second]
    assert [len(one) for one in found] == [2 * len(first), 2 * len(second)]


def test_one_line_without_such_words_is_of_one_player(tmp_path: Path) -> None:
    assert len(players(tmp_path, line("C4"))) == 1
