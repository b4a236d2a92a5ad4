"""Names from a MIDI file stay plain texts; file names are valid on every system."""

from __future__ import annotations

import unicodedata
from pathlib import PurePosixPath, PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.project.names import file_stem, file_stems, unique_names

texts = st.text(max_size=120)


def test_shared_names_are_numbered_and_single_ones_kept() -> None:
    assert unique_names(["trumpet", "trumpet", "trombone"]) == ("trumpet 1", "trumpet 2", "trombone")


def test_a_number_that_is_taken_is_passed_over() -> None:
    assert unique_names(["Horn", "Horn 1", "HORN"]) == ("Horn 2", "Horn 1", "HORN 3")


@given(st.lists(st.sampled_from(["a", "A", "a 1", "a 2", "b", "", "á", "á"]), max_size=12))
def test_names_are_unique_where_case_does_not_count(names: list[str]) -> None:
    unique = unique_names(names)
    assert len(unique) == len(names)
    assert len({name.casefold() for name in unique}) == len(unique)
    assert unique == unique_names(names)


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("../../etc/passwd", "_.._etc_passwd"),
        ("CON", "_CON"),
        ("com1.txt", "_com1.txt"),
        ("..", "player"),
        ("", "player"),
        ("///", "player"),
        ("C:\\x", "C__x"),
        (".hidden", "hidden"),
        ("Tuba. ", "Tuba"),
        ("1. Trompete in B♭", "1. Trompete in B♭"),
        ("トランペット", "トランペット"),
        ("a\x00b\nc", "ab c"),
        ("\u202egpj.exe", "gpj.exe"),
    ],
)
def test_known_traps(name: str, stem: str) -> None:
    assert file_stem(name) == stem


@given(texts)
def test_a_stem_is_one_plain_component(name: str) -> None:
    stem = file_stem(name)
    file = f"{stem}.fbx"
    assert PurePosixPath(file).name == file
    assert PureWindowsPath(file).name == file
    assert PureWindowsPath(file).anchor == ""
    # PureWindowsPath.is_reserved is deprecated from 3.13 on, so the parts are judged by hand.
    assert stem.split(".")[0].strip().casefold() not in {"con", "prn", "aux", "nul", "com1", "lpt9"}
    assert stem == stem.strip(" .")
    assert not any(unicodedata.category(c) in ("Cc", "Cs") for c in stem)
    assert 0 < len(stem.encode()) <= 81


@given(st.lists(texts, max_size=8))
def test_stems_of_several_players_never_meet(names: list[str]) -> None:
    stems = file_stems(names)
    assert len({unicodedata.normalize("NFC", stem.casefold()) for stem in stems}) == len(names)
