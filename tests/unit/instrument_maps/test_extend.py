"""A map that extends another one contains only the differences."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import MapError
from instrument_maps.load import bundled_maps, load_map, parse_map

CORNET = """
extends = "trumpet_Bb"
id = "my_cornet"
name = { en = "My cornet", ja = "私のコルネット" }
fingerings = [{ written_pitch = 64, rank = 1, label = "3" }]

[range]
low = 54

[[controls]]
name = "valve_2"
move_window_s = 0.09
"""


def test_what_it_does_not_say_is_as_in_the_other() -> None:
    trumpet, cornet = bundled_maps()["trumpet_Bb"], parse_map(CORNET, "my_cornet.toml")
    assert (cornet.id, cornet.name.ja) == ("my_cornet", "私のコルネット")
    assert cornet.contacts == trumpet.contacts
    assert cornet.range.high == trumpet.range.high
    assert cornet.control("valve_2").move_window_s == 0.09
    assert cornet.control("valve_2").motion == trumpet.control("valve_2").motion
    assert [control.name for control in cornet.controls] == [control.name for control in trumpet.controls]


def test_its_fingerings_of_a_note_replace_the_others_and_the_range_cuts() -> None:
    trumpet, cornet = bundled_maps()["trumpet_Bb"], parse_map(CORNET, "my_cornet.toml")
    (only,) = cornet.fingerings_for(62)
    assert only.controls == {"valve_3": 1.0}
    assert cornet.fingerings_for(60) == trumpet.fingerings_for(60)
    assert min(fingering.written_pitch for fingering in cornet.fingerings) == 56


def test_controls_it_is_without_are_left_out() -> None:
    oboe, horn = bundled_maps()["oboe"], bundled_maps()["english_horn"]
    assert {control.name for control in oboe.controls} - {control.name for control in horn.controls} == {"key_B_flat"}
    assert min(fingering.written_pitch for fingering in horn.fingerings) == 59


@pytest.mark.parametrize(
    ("without", "reported"),
    [
        ('["valve_9"]', "there is no control 'valve_9' in 'trumpet_Bb'"),
        ("[3]", "there is no control 3 in 'trumpet_Bb'"),
        ('"valve_3"', "is not a list of names of controls"),
    ],
)
def test_what_it_is_without_must_be_there(without: str, reported: str) -> None:
    with pytest.raises(MapError) as caught:
        parse_map(CORNET.replace("id =", f"without = {without}\nid =", 1), "my_cornet.toml")
    assert caught.value.message.arguments == {"file": "my_cornet.toml", "place": "without", "detail": reported}


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ('extends = "nothing_there"', "there is no map named 'nothing_there'"),
        ('extends = "../trumpet_Bb"', "'../trumpet_Bb' is not the id of a map"),
        ("extends = 3", "3 is not the id of a map"),
        ('extends = "own"', "'own' extends itself"),
    ],
)
def test_a_base_that_is_none_is_reported(text: str, reported: str, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(MapError) as caught:
        load_map(path)
    assert caught.value.message.arguments == {"file": str(path), "place": "extends", "detail": reported}


def test_two_that_extend_each_other_are_reported(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text('extends = "b"', "utf-8")
    (tmp_path / "b.toml").write_text('extends = "a"', "utf-8")
    with pytest.raises(MapError, match="extends itself"):
        load_map(tmp_path / "a.toml")


def test_a_fault_of_the_base_names_its_file(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text('extends = "b"', "utf-8")
    (tmp_path / "b.toml").write_text("id = ", "utf-8")
    with pytest.raises(MapError) as caught:
        load_map(tmp_path / "a.toml")
    assert caught.value.message.id == "table.syntax"
    assert caught.value.message.arguments["file"] == str(tmp_path / "b.toml")
