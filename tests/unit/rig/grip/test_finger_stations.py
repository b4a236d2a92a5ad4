"""Stations of fingers according to the contacts of a map."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.rig.grip.finger_stations import (
    HALF_ASIDE_M,
    aside_m,
    asked_together,
    fingers_at_work,
    height_share,
    only_at,
    station_for,
    stations,
    stations_of_notes,
)
from instrument_maps.load import bundled_maps, check_map, load_map
from instrument_maps.model import InstrumentMap
from tests.support import pipe


@pytest.fixture(scope="module")
def made_up(tmp_path_factory: pytest.TempPathFactory) -> InstrumentMap:
    path: Path = pipe.add(tmp_path_factory.mktemp("maps"))
    assert check_map(path) == ()
    return load_map(path)


def test_a_finger_has_a_place_for_everything_it_works_the_first_is_home(made_up: InstrumentMap) -> None:
    found = stations(made_up)
    assert [place.controls for place in found["right.little"]] == [("key_E",), ("key_F",), ("key_G",)]
    assert [place.controls for place in found["left.thumb"]] == [("hole_T",), ("key_Reg",), ("hole_T", "key_Reg")]
    assert [place.controls for place in found["right.thumb"]] == [()]


def test_brass_keeps_all_its_touches_all_the_time() -> None:
    for instrument in (bundled_maps()["trumpet_Bb"], bundled_maps()["trombone_tenor_F_attachment"]):
        assert set(only_at(instrument)) == {None}
        assert all(len(places) == 1 for places in stations(instrument).values())


def test_a_note_says_where_each_finger_is(made_up: InstrumentMap) -> None:
    thumb = stations(made_up)["left.thumb"]
    assert station_for(thumb, frozenset({"key_Reg"})) == 1
    assert station_for(thumb, frozenset({"hole_T", "key_Reg"})) == 2
    work = fingers_at_work(made_up, {"hole_T": 1.0, "key_E": 1.0, "key_F": 0.0}, {"key_E": "left.little"})
    assert work == {"left.thumb": frozenset({"hole_T"}), "left.little": frozenset({"key_E"})}
    notes = [({"hole_T": 1.0}, {}), ({"hole_T": 1.0, "key_Reg": 1.0}, {}), ({}, {})]
    assert stations_of_notes(made_up, notes)["left.thumb"].tolist() == [0, 2, -1]


def test_what_fingerings_ask_of_two_fingers_away_from_home(made_up: InstrumentMap) -> None:
    # Thumb on hole and register key, and the left little finger on its second lever, for one note.
    assert asked_together(made_up) == ((("left.little", 1), ("left.thumb", 2)),)
    assert asked_together(bundled_maps()["trumpet_Bb"]) == ()


def test_touches_of_keys_count_while_they_are_worked(made_up: InstrumentMap) -> None:
    by_contact = dict(zip(((c.part, c.control) for c in made_up.contacts), only_at(made_up), strict=True))
    assert by_contact["right.little.pad", "key_F"] == ("right.little", 1)
    assert by_contact["left.middle.pad", "hole_L2"] == ("left.middle", 0)
    assert by_contact["right.thumb.side", None] is None


def test_a_finger_comes_down_ahead_of_its_key_and_rolls_aside_for_half_a_hole(made_up: InstrumentMap) -> None:
    values = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    np.testing.assert_allclose(height_share(made_up.control("key_E"), values), (1.0 - values) ** 2)
    np.testing.assert_allclose(height_share(made_up.control("hole_L1"), values), [1.0, 0.25, 0.0, 0.0, 0.0])
    first = next(contact for contact in made_up.contacts if contact.control == "hole_L1")
    aside = aside_m(first, made_up, values)
    np.testing.assert_allclose(np.linalg.norm(aside, axis=1), HALF_ASIDE_M * np.array([0.0, 0.5, 1.0, 0.5, 0.0]))
    np.testing.assert_allclose(aside @ np.asarray(first.normal), 0.0, atol=1e-12)


def test_half_of_a_bare_hole_is_opened_towards_the_palm_and_of_a_plate_along_the_finger(made_up: InstrumentMap) -> None:
    first = next(contact for contact in made_up.contacts if contact.control == "hole_L1")
    seed = next(seed for seed in made_up.hands if seed.hand == "left")
    half = np.array([0.5])
    assert aside_m(first, made_up, half)[0] @ np.asarray(seed.palm_normal) < -0.5 * HALF_ASIDE_M
    plated = tuple(
        msgspec.structs.replace(control, node="ring_R3") if control.name == "hole_L1" else control
        for control in made_up.controls
    )
    plate = msgspec.structs.replace(made_up, controls=plated)
    along = aside_m(first, plate, half)[0]
    assert along @ np.asarray(seed.finger_direction) < 0.0
    assert not np.allclose(along, aside_m(first, made_up, half)[0])
