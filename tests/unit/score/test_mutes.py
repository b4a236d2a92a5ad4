"""Mutes are stored as spans of a part, whether given by program, name or text."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.score.model import Part
from app.score.mutes import is_muted, mute_at
from tests.unit.score.test_doublings import LOW, program, score_of, words


def muted(part: Part) -> list[bool]:
    return [is_muted(part.muted, note.onset_tick) for note in part.notes]


@pytest.mark.parametrize(
    ("put_in", "take_out"),
    [
        ("con sord.", "senza sord."),
        ("(con sordino)", "(senza sordino)"),
        ("mit Dämpfer", "ohne Dämpfer"),
        ("avec sourdine", "ôtez la sourdine"),
        ("com surdina", "sem surdina"),
        ("with cup mute", "remove mute"),
        ("Harmon mute", "open"),
        ("straight mute", "no mute"),
        ("stopped", "open"),
        ("gestopft", "offen"),
        ("ミュート付き", "ミュートを外す"),
        ("muted", "nat."),
    ],
)
def test_texts_put_a_mute_in_and_take_it_out(tmp_path: Path, put_in: str, take_out: str) -> None:
    (part,) = score_of(tmp_path, "Trumpet", LOW, words(put_in), LOW, words(take_out), LOW).parts
    assert muted(part) == [False, False, True, True, False, False]


def test_the_muted_program_is_muted(tmp_path: Path) -> None:
    (part,) = score_of(tmp_path, "Trumpet", program(56), LOW, program(59), LOW, program(56), LOW).parts
    assert muted(part) == [False, False, True, True, False, False]
    assert part.map_id == "trumpet_Bb"


@pytest.mark.parametrize("name", ["Trumpet (con sord.)", "Muted Trumpet", "Trompete mit Dämpfer"])
def test_a_name_mutes_all_until_a_text_says_otherwise(tmp_path: Path, name: str) -> None:
    (part,) = score_of(tmp_path, name, LOW, words("open"), LOW).parts
    assert muted(part) == [True, True, False, False]


@pytest.mark.parametrize(
    "text", ["Solo", "open the fan", "to Coda", "commuted", "mute all other tracks please", "con moto"]
)
def test_other_texts_say_nothing(tmp_path: Path, text: str) -> None:
    (part,) = score_of(tmp_path, "Trumpet", LOW, words(text), LOW).parts
    assert part.muted == ()


@pytest.mark.parametrize("text", ["gestopft", "stopped", "bouché", "chiuso", "ゲシュトップ"])
def test_the_hand_stops_what_is_stopped_and_no_mute_does(tmp_path: Path, text: str) -> None:
    (part,) = score_of(tmp_path, "Horn", LOW, words(text), LOW, words("con sord."), LOW, words("open"), LOW).parts
    assert muted(part) == [False, False, True, True, True, True, False, False]
    assert [is_muted(part.stopped, note.onset_tick) for note in part.notes] == [False] * 2 + [True] * 2 + [False] * 4


def test_a_plus_stops_only_the_notes_that_begin_with_it(tmp_path: Path) -> None:
    (part,) = score_of(tmp_path, "Horn", LOW, words("+"), LOW, LOW).parts
    assert [is_muted(part.stopped, note.onset_tick) for note in part.notes] == [False, False, True, False, False, False]


@pytest.mark.parametrize("text", ["harmon", "harmon, stem out", "in cup", "plunger", "stop mute", "mute in"])
def test_mutes_are_known_by_their_own_names(tmp_path: Path, text: str) -> None:
    (part,) = score_of(tmp_path, "Trumpet", LOW, words(text), LOW, words("open"), LOW).parts
    assert muted(part) == [False, False, True, True, False, False]
    assert part.stopped == ()


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("con sord.", "mute"),
        ("straight mute", "straight"),
        ("(with cup mute)", "cup"),
        ("cup", "cup"),
        ("con sord. (cup)", "cup"),
        ("Harmon, stem out", "harmon"),
        ("wah-wah mute", "harmon"),
        ("plunger", "plunger"),
        ("in bucket", "bucket"),
        ("カップミュート", "cup"),
        ("カップ・ミュート", "cup"),
        ("ハーマンミュート", "harmon"),
    ],
)
def test_the_words_say_which_mute(tmp_path: Path, text: str, kind: str) -> None:
    (part,) = score_of(tmp_path, "Trumpet", LOW, words(text), LOW, words("open"), LOW).parts
    assert muted(part) == [False, False, True, True, False, False]
    assert [mute_at(part.mute_kinds, note.onset_tick) for note in part.notes][2:4] == [kind] * 2


def test_a_name_says_which_mute(tmp_path: Path) -> None:
    (part,) = score_of(tmp_path, "Trumpet with cup mute", LOW, words("con sord."), LOW).parts
    assert part.mute_kinds[0][1] == "cup"
