"""A musician with several instruments in an Unreal project: one character, and an actor for each instrument."""

from __future__ import annotations

import json

from app.export.unreal.layout import layout_of
from app.export.unreal.project import UnrealProject
from tests.support.doubled import flutist
from tests.unit.export.unreal.conftest import Export, request_of


def test_one_character_with_both_instruments(unreal: UnrealProject, export: Export) -> None:
    written = export(request_of(flutist(), ("Piccolo",), source="changes.mid", last_bar=1))
    sources = unreal.folder / "SuisouSource" / "changes"
    figures = {
        path.relative_to(sources).as_posix() for path in sources.rglob("*.fbx")
    }  # fmt: skip
    assert figures == {
        "Characters/SK_Flute.fbx",
        "Instruments/SK_Flute_flute.fbx",
        "Instruments/SK_Flute_piccolo.fbx",
    }
    assert {path.as_posix() for path in written.plan.written} >= {f"SuisouSource/changes/{name}" for name in figures}
    reported = json.loads((sources / "performance.json").read_text(encoding="utf-8"))
    (player,) = reported["players"]
    assert player["name"] == "Flute"
    assert [double["instrument_id"] for double in player["doubles"]] == ["piccolo"]
    assert player["doubles"][0]["instrument"]["file"] == "Instruments/SK_Flute_piccolo.fbx"
    images = {one["file"] for one in reported["textures"]}
    assert set(reported["files"]) == figures | images | {"Audio/S_changes.wav"}


def test_names_of_who_doubles_no_one_are_what_they_were() -> None:
    layout = layout_of(flutist(), "changes")
    assert set(layout.characters) == {"2.1.1", "3.1.1"}
    assert set(layout.instruments) == {"2.1.1", "2.1.17", "3.1.1"}
    assert layout.instruments["3.1.1"].file.name == "SK_Oboe_oboe.fbx"
