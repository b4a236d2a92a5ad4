"""Hats left off in exported files, in the report, and in the names of bodies that players share in Unreal."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import mido
import msgspec
import pygltflib
import pytest

from app.cli import main
from app.errors import Message
from app.export.equipped_skeleton import socket_names
from app.export.request import cast_of
from app.export.unreal.layout import layout_of
from app.messages import text
from app.rig.characters.dressed_characters import character_in
from app.rig.people.wardrobe import OutfitChoice
from tests.unit.export.unreal.conftest import quartet, request_of

PLAYERS = {"Bass": "sousaphone_BBb", "Treble": "trumpet_Bb"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two players of one body in one uniform, exported."""
    made = tmp_path_factory.mktemp("hats")
    song = mido.MidiFile(ticks_per_beat=480)
    for channel, (name, pitch) in enumerate(zip(PLAYERS, (34, 62), strict=True)):
        notes = [
            mido.Message("note_on", channel=channel, note=pitch, velocity=90),
            mido.Message("note_off", channel=channel, note=pitch, time=960),
        ]
        song.tracks.append(mido.MidiTrack([mido.MetaMessage("track_name", name=name), *notes]))
    song.save(made / "piece.mid")
    options = ["export", str(made / "piece.mid"), "--fps", "8"]
    options += ["--outfit", "marching", "--set", "*.character=woman_adult"]
    for name, instrument in PLAYERS.items():
        options += ["--assign", f"{name}={instrument}"]
    assert main([*options, "--to", str(made), "--format", "glb"]) == 0
    return made


def triangles(path: Path) -> int:
    """Number of the triangles of a file."""
    made = pygltflib.GLTF2().load(str(path))
    assert made is not None
    return sum(made.accessors[one.indices].count // 3 for mesh in made.meshes for one in mesh.primitives)


def test_only_the_player_whose_instrument_is_in_the_way_has_no_hat(folder: Path) -> None:
    (hat,) = (one for one in character_in("woman_adult", OutfitChoice("marching")).meshes if one.name == "shako")
    with_hat, without_hat = (triangles(folder / f"{name}.glb") for name in ("Treble", "Bass"))
    assert with_hat - without_hat == len(hat.triangles)


def test_the_report_says_it(folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    left_off = {player["name"]: player["person"]["left_off"] for player in report["players"]}
    assert left_off == {"Bass": ["shako"], "Treble": []}
    said = text(Message("character.hat_left_off", {}))
    assert [said in warning for warning in report["warnings"] if said in warning] == [True]


def test_bodies_with_and_without_a_hat_are_two_in_unreal() -> None:
    project, worn = quartet(), OutfitChoice("marching")
    held = ("sousaphone_BBb", "trumpet_Bb", "sousaphone_BBb", "trumpet_Bb")
    players = tuple(
        msgspec.structs.replace(player, instrument_id=instrument, character_id="woman_adult", outfit=worn)
        for player, instrument in zip(project.players, held, strict=True)
    )
    project = replace(project, players=players)
    cast = cast_of(request_of(project, tuple(player.name for player in players)), text)
    layout = layout_of(project, "quartet")
    bodies = [layout.body(one.player, socket_names(one.target), one.left_off)[0] for one in cast.musicians]
    assert bodies[0] == bodies[2] != bodies[1] == bodies[3]
    assert bodies[0] == bodies[1].replace("marching", "marching_without_shako")
    first, second, third, _ = (one.character for one in cast.musicians)
    assert first is third
    assert first.id != second.id
