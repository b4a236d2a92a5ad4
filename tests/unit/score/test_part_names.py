"""What parts are called in scores of seven languages: a table written before the vocabulary was extended."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from instrument_maps.vocabulary import vocabulary

NAMES = tomllib.loads(Path(__file__, "../../../data/part_names/part_names.toml").resolve().read_text(encoding="utf-8"))


@pytest.mark.parametrize("language", sorted(NAMES))
def test_every_part_name_gives_its_instrument(language: str) -> None:
    found = {
        (name, expected): "none" if (instrument := vocabulary().by_name(name)) is None else instrument.id
        for expected, names in NAMES[language].items()
        for name in names
    }
    assert found
    assert {name: id for (name, expected), id in found.items() if id != expected} == {}


@pytest.mark.parametrize("name", ["Tenor 1", "Alto 2", "Bajo"])
def test_a_name_that_only_some_ensembles_use_is_vague(name: str) -> None:
    instrument = vocabulary().by_name(name)
    assert instrument is not None
    assert instrument.vague
    assert not vocabulary().instruments[instrument.id].vague
