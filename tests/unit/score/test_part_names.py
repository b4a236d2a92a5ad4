"""Names of parts in scores of seven languages, from a table written before the vocabulary was extended."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from instrument_maps.instrument_names import vocabulary

NAMES = tomllib.loads(Path(__file__, "../../../data/part_names/part_names.toml").resolve().read_text(encoding="utf-8"))


def test_every_part_name_gives_its_instrument() -> None:
    wrong, count = {}, 0
    for section, expected, names in ((key, *row) for key, table in NAMES.items() for row in table.items()):
        for name in names:
            found = vocabulary().by_name(name)
            answers = {"none"} if found is None else {found.id, "nobody" if found.kind != "wind" else found.id}
            if expected not in answers:
                wrong[section, name] = expected, found and found.id
            count += 1
    assert count > 2000
    assert wrong == {}


@pytest.mark.parametrize("name", ["Tenor 1", "Alto 2", "Bajo"])
def test_a_name_that_only_some_ensembles_use_is_vague(name: str) -> None:
    instrument = vocabulary().by_name(name)
    assert instrument.vague
    assert not vocabulary().instruments[instrument.id].vague


@pytest.mark.parametrize("name", ["Bass B", "C Bass"])
def test_a_bass_with_the_letter_of_a_key_beside_it_is_vague(name: str) -> None:
    instrument = vocabulary().by_name(name)
    assert instrument.vague


@pytest.mark.parametrize("name", ["Bass in Es", "Bässe in B", "Cornetto in Sib"])
def test_a_bass_or_cornetto_in_a_key_is_sure(name: str) -> None:
    instrument = vocabulary().by_name(name)
    assert not instrument.vague


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("Oboe 2 / Engl. Horn", "oboe"),
        ("Flauto e Ottavino", "flute"),
        ("Fl. & Oboe", "flute"),
        ("Flöte und Piccolo", "flute"),
        ("Trompeta y Fliscorno", "trumpet"),
        ("Trombone 3 / Bass Trombone", "bass_trombone"),
        ("D/E♭ Trumpet", "trumpet_Eb"),
        ("Flauti I e II", "flute"),
    ],
)
def test_of_two_instruments_of_one_player_the_first_counts(name: str, expected: str) -> None:
    instrument = vocabulary().by_name(name)
    assert instrument.id == expected


@pytest.mark.parametrize(
    "name", ["Bass", "Basse", "Basso 1", "Bass 2", "Tenor", "Soprano", "Alphorn", "Krummhorn", "B", "Es"]
)
def test_a_voice_a_key_or_an_unknown_instrument_is_asked_about(name: str) -> None:
    assert vocabulary().by_name(name) is None
