"""Lists of instruments have score order, and keys a uniform spelling."""

from __future__ import annotations

import msgspec
import pytest

from app.cli import main
from app.errors import MapError
from instrument_maps.instrument_names import Vocabulary, vocabulary
from instrument_maps.instruments import Instrument, VocabularyTable
from instrument_maps.load import bundled_maps
from instrument_maps.score_order import in_score_order

EXPECTED = (
    *("piccolo", "flute", "oboe", "english_horn"),
    *("clarinet_Eb", "clarinet_Bb", "clarinet_A", "clarinet_bass_Bb", "bassoon", "contrabassoon"),
    *("sax_soprano_Bb", "sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb", "horn_F_single", "horn_double_F_Bb"),
    *("trumpet_C", "trumpet_Bb", "cornet_Bb", "flugelhorn_Bb", "trombone_tenor_F_attachment", "trombone_bass_F_Gb"),
    *("baritone_Bb", "euphonium_Bb_bassclef", "euphonium_baritone_Bb_treble"),
    *("tuba_F", "tuba_Eb", "tuba_CC", "tuba_BBb", "sousaphone_BBb", "recorder_soprano_C", "recorder_alto_F", "ewi"),
)
"""Order of a band's score: woodwinds, brass, others; within a family from high to low."""


def test_lists_are_in_score_order() -> None:
    maps = bundled_maps().values()
    assert tuple(one.id for one in in_score_order(maps)) == EXPECTED
    assert in_score_order(reversed(list(maps))) == in_score_order(maps)


def test_an_instrument_of_no_known_family_is_last() -> None:
    unknown = msgspec.structs.replace(bundled_maps()["piccolo"], id="a", plays=("nose flute",))
    assert in_score_order([unknown, *bundled_maps().values()])[-1] is unknown


def test_the_command_line_lists_them_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["instruments"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()[1:] if line.strip()]
    assert tuple(listed[: len(EXPECTED)]) == EXPECTED


def test_keys_are_written_with_the_sign_of_a_flat() -> None:
    names = [(one.name.en, one.name.ja) for one in bundled_maps().values()]
    assert [pair for pair in names if "flat" in " ".join(pair).casefold() or "変" in pair[1]] == []
    keyed = [pair for pair in names if "♭" in pair[0]]
    assert len(keyed) >= 8
    assert all("♭" in ja for _, ja in keyed)


def test_names_begin_with_a_capital_and_go_on_without() -> None:
    """Names have sentence case; keys, valves and abbreviations keep their capitals."""
    words = [word for one in bundled_maps().values() for word in one.name.en.split()[1:]]
    assert [word for word in words if word.istitle() and len(word.strip("()♭")) > 1] == []


def test_every_family_has_its_place_in_both_orders() -> None:
    assert sorted(vocabulary().score_order) == sorted(family for row in vocabulary().seating for family in row)
    assert sorted(vocabulary().family_names) == sorted(vocabulary().score_order)
    played = (Instrument("a", "wind", ("Blow",)),)
    table = VocabularyTable(instruments=played, seating=(("flutes",),), score_order=("oboes",))
    with pytest.raises(MapError):
        Vocabulary(table, "test.toml")
