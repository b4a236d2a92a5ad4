"""Straps and chairs in exported files: hooked in, on the clothes, under seated players, and omitted on request."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mido
import numpy as np
import pytest

from app.cli import main
from app.export.playback import ScenePlayback
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene, SkinnedMesh
from instrument_maps.load import bundled_maps
from tests.support.skinned import GlbFile, UsdFile

PLAYERS = {"Alto": "sax_alto_Eb", "Bassoon": "bassoon", "Trumpet": "trumpet_Bb"}
NOTES = (57, 59, 60, 62, 64, 62, 60, 59)
FORMATS = "fbx,glb,usd"
TRUNK = ("hips", "spine", "chest", "upperChest", "neck", "leftShoulder", "rightShoulder")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two short phrases with a long rest between, in which instruments are lowered."""
    made = tmp_path_factory.mktemp("props")
    song = mido.MidiFile(ticks_per_beat=480)
    for channel, name in enumerate(PLAYERS):
        track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)])
        for rest in (0, 480 * 12):
            for number, pitch in enumerate(NOTES):
                track.append(
                    mido.Message("note_on", channel=channel, note=pitch, velocity=90, time=0 if number else rest)
                )
                track.append(mido.Message("note_off", channel=channel, note=pitch, time=240))
        song.tracks.append(track)
    song.save(made / "piece.mid")
    options = ["export", str(made / "piece.mid"), "--fps", "8"]
    for name, instrument in PLAYERS.items():
        options += ["--assign", f"{name}={instrument}"]
    options += [
        "--set",
        "Bassoon.posture=seated",
        "--set",
        "Alto.posture=standing",
        "--set",
        "Trumpet.posture=standing",
    ]
    assert main([*options, "--to", str(made / "with"), "--format", FORMATS]) == 0
    assert main([*options, "--to", str(made / "without"), "--format", "glb", "--without-props"]) == 0
    return made


def _players(folder: Path, name: str) -> dict[str, dict[str, Any]]:
    report = json.loads((folder / name / "report.json").read_text(encoding="utf-8"))
    return {player["name"]: player for player in report["players"]}


def _scene(folder: Path, name: str, held: str) -> Scene:
    return read_scene(folder / "with" / _players(folder, "with")[name]["files"][f"{held}_fbx"])


def _skinned(scene: Scene, mesh: SkinnedMesh, frames: range) -> np.ndarray:
    """Vertices (F, V, 3) in metres by a second implementation of linear blend skinning."""
    assert scene.clip is not None
    from_bind = np.linalg.inv(np.asarray(mesh.world_from_bone_bind, np.float64))
    from_bind[:, :3, 3] *= 0.01
    at_rest = np.c_[0.01 * np.asarray(mesh.vertices_cm, np.float64), np.ones(len(mesh.vertices_cm))]
    world = ScenePlayback(scene, scene.clip).world(0, scene.clip.frames)
    placed = [
        np.einsum("vk,vkij,vj->vi", mesh.weights, (world[frame] @ from_bind)[mesh.joint_indices], at_rest)[:, :3]
        for frame in frames
    ]
    return np.array(placed)


def _of_material(mesh: SkinnedMesh, name: str) -> np.ndarray:
    number = [material.name for material in mesh.materials].index(name)
    assert mesh.face_materials is not None
    return np.unique(mesh.faces[mesh.face_materials == number])


def _frames(scene: Scene, step: int) -> range:
    assert scene.clip is not None
    return range(0, scene.clip.frames, step)


def _mesh(scene: Scene, kind: str) -> SkinnedMesh:
    return next(mesh for mesh in scene.meshes if mesh.name.endswith(kind))


def test_files_and_report_say_who_has_what(folder: Path) -> None:
    players = _players(folder, "with")
    assert {name: player["props"] for name, player in players.items()} == {
        "Alto": ["neck_strap"],
        "Bassoon": ["seat_strap", "chair"],
        "Trumpet": [],
    }
    assert players["Alto"]["files"]["props_usd"] == "Alto_props.usdc"
    assert not any(key.startswith("props") for key in players["Trumpet"]["files"])
    written = {path.name for path in (folder / "with").iterdir() if "_props" in path.name}
    assert written == {f"{name}_props{end}" for name in ("Alto", "Bassoon") for end in (".fbx", ".glb", ".usdc")}


def test_nothing_else_changes_where_they_are_left_out(folder: Path) -> None:
    players = _players(folder, "without")
    assert not any(player["props"] for player in players.values())
    assert not [path for path in (folder / "without").iterdir() if "_props" in path.name]
    for name in ("Alto.glb", "Bassoon_bassoon.glb"):
        assert (folder / "without" / name).read_bytes() == (folder / "with" / name).read_bytes()


@pytest.mark.parametrize(("name", "kind"), [("Alto", "neck_strap"), ("Bassoon", "seat_strap")])
def test_a_strap_ends_at_its_hook_at_every_frame(folder: Path, name: str, kind: str) -> None:
    props, instrument = _scene(folder, name, "props"), _scene(folder, name, "instrument")
    mesh, frames = _mesh(props, kind), _frames(props, 1)
    (support,) = [one for one in bundled_maps()[PLAYERS[name]].hold.supports if one.kind == kind]
    assert instrument.clip is not None
    root = ScenePlayback(instrument, instrument.clip).world(0, instrument.clip.frames)[:, 0]
    size = _players(folder, "with")[name]["size"]
    hook_m = root[:, :3, :3] @ (size * np.asarray(support.hook_m)) + root[:, :3, 3]
    wire = _skinned(props, mesh, frames)[:, _of_material(mesh, "strap_metal")]
    away = np.linalg.norm(wire - hook_m[:, None], axis=-1).min(axis=1)
    assert away.max() < 0.002


def test_a_strap_is_hardly_longer_while_its_instrument_is_lowered(folder: Path) -> None:
    props = _scene(folder, "Alto", "props")
    mesh = _mesh(props, "neck_strap")
    band = _of_material(mesh, "strap")
    placed = _skinned(props, mesh, _frames(props, 4))[:, band]
    pairs = mesh.faces[np.isin(mesh.faces, band).all(axis=1)]
    edges = np.searchsorted(band, np.concatenate([pairs[:, [0, 1]], pairs[:, [1, 2]]]))
    lengths = np.linalg.norm(placed[:, edges[:, 0]] - placed[:, edges[:, 1]], axis=-1).sum(axis=1)
    playing = np.median(lengths)
    assert np.abs(lengths / playing - 1.0).max() < 0.25


def test_a_strap_lies_on_the_clothes(folder: Path) -> None:
    props, character = _scene(folder, "Alto", "props"), _scene(folder, "Alto", "character")
    mesh, frames = _mesh(props, "neck_strap"), _frames(props, 24)
    band = _skinned(props, mesh, frames)[:, _of_material(mesh, "strap")]
    of_trunk = np.isin([bone.name for bone in character.bones], TRUNK)
    for number in range(len(frames)):
        middles, ways = [], []
        for body in character.meshes:
            cards = [material.alpha_mode != "opaque" for material in body.materials]
            assert body.face_materials is not None
            cloth = ~np.array(cards)[body.face_materials]
            trunk = (body.weights * of_trunk[body.joint_indices]).sum(axis=1) > 0.5
            faces = body.faces[cloth & trunk[body.faces].all(axis=1)]
            placed = _skinned(character, body, frames[number : number + 1])[0][faces]
            middles.append(placed.mean(axis=1))
            ways.append(np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0]))
        middle, way = np.concatenate(middles), np.concatenate(ways)
        way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
        for point in band[number][::7]:
            nearest = np.argsort(np.linalg.norm(middle - point, axis=1))[:5]
            assert np.median(((point - middle[nearest]) * way[nearest]).sum(axis=1)) > -0.010


def test_a_chair_bears_the_thighs_and_nothing_goes_into_it(folder: Path) -> None:
    props, character = _scene(folder, "Bassoon", "props"), _scene(folder, "Bassoon", "character")
    mesh, frames = _mesh(props, "chair"), _frames(props, 12)
    placed = _skinned(props, mesh, frames)
    assert np.ptp(placed, axis=0).max() < 1e-6
    fabric = placed[0][_of_material(mesh, "chair_fabric")]
    heights = np.sort(fabric[:, 1])
    # The seat is below the widest gap, the back above it.
    top_m = heights[np.argmax(np.diff(heights))]
    seat = fabric[fabric[:, 1] <= top_m]
    (low_x, _, low_z), (high_x, _, high_z) = seat.min(axis=0), seat.max(axis=0)
    skin = np.concatenate([_skinned(character, body, frames) for body in character.meshes], axis=1)
    for points in skin:
        over = (points[:, 0] > low_x) & (points[:, 0] < high_x) & (points[:, 2] > low_z) & (points[:, 2] < high_z)
        lowest = points[over & (np.abs(points[:, 1] - top_m) < 0.06), 1].min() - top_m
        assert -0.004 < lowest < 0.010
    back = fabric[fabric[:, 1] > top_m + 0.1]
    assert skin[:, skin[0, :, 1] > top_m + 0.15, 2].min() > back[:, 2].max()


@pytest.mark.parametrize(("file", "reader"), [("Alto_props.glb", GlbFile), ("Alto_props.usdc", UsdFile)])
def test_every_format_shows_the_same(folder: Path, file: str, reader: type[GlbFile] | type[UsdFile]) -> None:
    props = _scene(folder, "Alto", "props")
    mesh = _mesh(props, "neck_strap")
    shown = reader(folder / "with" / file)
    number = [material.name for material in mesh.materials].index("strap")
    assert mesh.face_materials is not None
    corners = mesh.faces[mesh.face_materials == number].reshape(-1)
    for frame in (0, 40, 90):
        ours = 100.0 * _skinned(props, mesh, range(frame, frame + 1))[0][corners]
        found = shown.shown(frame).corners_cm["strap"]
        for low, high in ((ours.min(axis=0), found.min(axis=0)), (ours.max(axis=0), found.max(axis=0))):
            assert low == pytest.approx(high, abs=0.01)
