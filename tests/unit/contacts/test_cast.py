"""Forty of the pairs of a person and an instrument, checked like all pairs by `resources.build.check_cast`."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.rig.characters.character_library import bundled_characters
from app.rig.people.bundled_people import bundled_people, bundled_person, not_cast_for
from instrument_maps.load import bundled_maps
from resources.build.check_cast import compass_project, faults, worse

CAST = {id: [one for one in bundled_maps() if one not in not_cast_for(id)] for id in bundled_people()}
PEOPLE = [id for id, instruments in CAST.items() if instruments]
PAIRS = [
    (id, CAST[id][(7 * turn + 3 * number) % len(CAST[id])]) for turn in range(3) for number, id in enumerate(PEOPLE)
][:40]


@pytest.mark.parametrize(("person_id", "instrument_id"), PAIRS, ids=["-".join(pair) for pair in PAIRS])
def test_a_person_plays_within_the_bounds_of_finished_bodies(
    tmp_path: Path, person_id: str, instrument_id: str
) -> None:
    project = compass_project(bundled_maps()[instrument_id], tmp_path / "compass.mid", step=5)
    found = faults(project, person_id)
    if found:
        assert worse(found, [faults(project, id) for id in bundled_characters()]) == {}


def test_a_body_that_is_too_small_misses_something(tmp_path: Path) -> None:
    # Last child not cast for some instrument: taller people may miss by less than this coarse compass shows.
    children = [id for id in bundled_people() if bundled_person(id).original == "child"]
    id, instrument_id = [(id, name) for id in children for name in sorted(not_cast_for(id))][-1]
    project = compass_project(bundled_maps()[instrument_id], tmp_path / "compass.mid")
    allowed = [faults(project, id) for id in bundled_characters()]
    assert worse(faults(project, id), allowed)
    assert not worse(allowed[0], allowed)


def test_children_are_cast_for_what_school_bands_begin_with() -> None:
    children = [id for id in bundled_people() if bundled_person(id).original == "child"]
    for name in ("trumpet_Bb", "clarinet_Bb", "oboe", "horn_F_single", "euphonium_Bb_bassclef", "recorder_soprano_C"):
        assert any(name in CAST[id] for id in children), name


def test_a_hold_that_cannot_reach_a_key_counts(tmp_path: Path) -> None:
    project = compass_project(bundled_maps()["clarinet_bass_Bb"], tmp_path / "compass.mid", step=5)
    thumb = "hold right.thumb.side on root"
    assert faults(project, "child_nia")[thumb] > 1.0
    assert thumb not in faults(project, "woman_adult")
    everyone = [one for one in bundled_people() if bundled_person(one).original == "child"]
    assert {"clarinet_bass_Bb" in not_cast_for(one) for one in everyone} == {True}
