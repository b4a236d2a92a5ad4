"""What instruments are called, in five languages."""

import tomllib

import pytest

from app.errors import MapError
from instrument_maps.library import all_maps
from instrument_maps.vocabulary import PATH, Instrument, Vocabulary, vocabulary


@pytest.mark.parametrize(
    "text",
    [
        "",
        "Alto",
        "Sopran",
        "Tenor",
        "Bass",
        "Soprano 1",
        "Melody",
        "Solo",
        "Track 3",
        "Cornwall",
        "Hornpipe",
        "Tubular",
        "1",
        "♭",
    ],
)
def test_voices_and_words_that_only_begin_like_an_instrument_are_none(text: str) -> None:
    assert vocabulary().by_name(text) is None


def test_general_midi_is_covered_once() -> None:
    table = tomllib.loads(PATH.read_text(encoding="utf-8"))
    programs = sorted(program for instrument in table["instruments"] for program in instrument.get("programs", []))
    assert programs == list(range(128))


@pytest.mark.parametrize(
    ("program", "instrument"),
    [
        (56, "trumpet"),
        (57, "trombone"),
        (58, "tuba"),
        (60, "horn"),
        (65, "alto_saxophone"),
        (71, "clarinet"),
        (73, "flute"),
        (0, "piano"),
    ],
)
def test_programs_count_from_zero(program: int, instrument: str) -> None:
    found = vocabulary().by_program(program)
    assert found is not None
    assert found.id == instrument


def test_what_the_bundled_maps_play_is_in_the_vocabulary_and_blown() -> None:
    known = vocabulary().instruments
    named = {id_ for instrument in all_maps().values() for id_ in (*instrument.plays, *instrument.substitutes_for)}
    assert named
    assert all(known[id_].kind == "wind" for id_ in named)


def test_a_name_that_belongs_to_two_is_refused() -> None:
    with pytest.raises(MapError, match="blow"):
        Vocabulary((Instrument("a", "wind", ("Blow",)), Instrument("b", "wind", ("blow!",))), "test.toml")
