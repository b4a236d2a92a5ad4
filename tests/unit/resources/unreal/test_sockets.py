"""Instruments attached to bones of hands in a fake editor: their parents and positions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.export.rig_options import RigOptions
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene
from tests.support.doubled import flutist
from tests.unit.export.test_rig import world_m
from tests.unit.export.unreal.conftest import quartet
from tests.unit.resources.unreal.conftest import Editor, exported
from tests.unit.resources.unreal.test_import import bindings, description, transform

FREE, SOCKET, IK = RigOptions(), RigOptions("socket"), RigOptions("ik")
PLAYER, HELD = "Trumpet 1", "Trumpet 1 (trumpet_Bb)"
TURNED = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""Rotation of the root by which importers convert a file from Y up to Z up, without mirroring."""
MIRRORED = np.diag([1.0, -1.0, 1.0, 1.0])
"""Conversion from a right-handed space to Unreal's left-handed one."""


def hung(binding: Any) -> list[tuple[str, int | None]]:
    """Bones to which an actor is attached, with the number of the actor that owns them."""
    tracks = [track for track in binding._tracks if type(track).__name__ == "MovieScene3DAttachTrack"]
    assert all(section._bounded == (False, False) for track in tracks for section in track._sections)
    return [(section.attach_socket_name, section._holder) for track in tracks for section in track._sections]


@pytest.fixture
def game(plugin: None, tmp_path: Path) -> Path:
    return tmp_path / "Game"


def imported(game: Path, rig: RigOptions, skeleton: str = "ue5") -> Editor:
    exported(game, quartet(), (PLAYER,), rig=rig, skeleton=skeleton)
    editor = Editor(game)
    editor.import_performance()
    return editor


@pytest.mark.parametrize(("rig", "bone"), [(SOCKET, "hand_l_socket"), (IK, "ik_hand_l_socket")])
def test_an_instrument_hangs_on_the_bone_of_its_player(game: Path, rig: RigOptions, bone: str) -> None:
    editor = imported(game, rig)
    there = bindings(editor)
    assert hung(there[HELD]) == [(bone, there[PLAYER]._id._value)]
    assert hung(there[PLAYER]) == []
    (player,) = description(editor)["players"]
    assert bone in player["character"]["bones"]
    # Nothing is doubled by an update.
    editor.update_performance()
    assert hung(bindings(editor)[HELD]) == [(bone, there[PLAYER]._id._value)]


def in_unreal(place: np.ndarray) -> np.ndarray:
    """Transform of a bone of a file in its actor, after the importer has rotated the root and mirrored everything."""
    result: np.ndarray = MIRRORED @ TURNED @ place @ MIRRORED
    return result


def skin_in_unreal(place: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Positions (N, 3) in Unreal in cm of points on a bone."""
    homogeneous = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    result: np.ndarray = (in_unreal(place) @ MIRRORED @ homogeneous.T).T[:, :3]
    return result


def relative(values: dict[str, float]) -> np.ndarray:
    """Transform of a section with a roll only, as in Unreal's FRotationMatrix, for column vectors."""
    assert values["Rotation.Y"] == values["Rotation.Z"] == 0.0
    roll = np.radians(values["Rotation.X"])
    result = np.eye(4)
    result[1:3, 1:3] = np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]]).T
    result[:3, 3] = [values[f"Location.{axis}"] for axis in "XYZ"]
    return result


def test_it_is_where_a_free_one_is(game: Path, tmp_path: Path) -> None:
    """After the importer's conversion of both files, the bell's rim is at the same place on the stage."""
    free = imported(tmp_path / "Free", FREE)
    found: dict[str, Scene] = {}
    on_socket = imported(game, SOCKET)
    values = transform(bindings(on_socket)[HELD])
    for name, editor in (("free", free), ("hung", on_socket)):
        (player,) = description(editor)["players"]
        for what in ("character", "instrument"):
            file = editor.folder / "SuisouSource" / "quartet" / player[what]["file"]
            found[f"{name} {what}"] = read_scene(file)
    points = np.random.default_rng(1).uniform(-30.0, 30.0, (20, 3))
    bones = [bone.name for bone in found["hung character"].bones]
    socket = world_m(found["hung character"])[:, bones.index("hand_l_socket")]
    root, alone = world_m(found["hung instrument"])[:, 0], world_m(found["free instrument"])[:, 0]
    for places in (socket, root, alone):
        places[:, :3, 3] *= 100.0
    for frame in (0, len(root) - 1):
        on_bone = in_unreal(socket[frame]) @ relative(values)
        hung_points = skin_in_unreal(root[frame], points)
        there = on_bone[:3, :3] @ hung_points.T + on_bone[:3, 3:]
        np.testing.assert_allclose(there.T, skin_in_unreal(alone[frame], points), atol=0.01)


def test_from_free_to_a_bone_and_back(game: Path) -> None:
    editor = imported(game, FREE)
    before = transform(bindings(editor)[HELD])
    number = bindings(editor)[HELD]._id._value
    exported(game, quartet(), (PLAYER,), rig=SOCKET, skeleton="ue5")
    editor.update_performance()
    there = bindings(editor)
    assert [bone for bone, _ in hung(there[HELD])] == ["hand_l_socket"]
    assert transform(there[HELD])["Rotation.X"] == -90.0
    exported(game, quartet(), (PLAYER,), rig=FREE, skeleton="ue5")
    editor.update_performance()
    assert hung(bindings(editor)[HELD]) == []
    assert transform(bindings(editor)[HELD]) == before
    assert bindings(editor)[HELD]._id._value == number


def test_what_an_artist_hangs_on_something_stays(game: Path) -> None:
    editor = imported(game, FREE)
    track = bindings(editor)[HELD].add_track(editor.unreal.MovieScene3DAttachTrack)
    section = track.add_section()
    section.attach_socket_name = "Stand"
    section.set_start_frame_bounded(False)
    section.set_end_frame_bounded(False)
    editor.update_performance()
    assert hung(bindings(editor)[HELD]) == [("Stand", None)]


def test_each_instrument_of_one_who_changes_has_its_bone(game: Path) -> None:
    exported(game, flutist(), ("Flute",), source="changes.mid", rig=SOCKET, skeleton="ue5")
    editor = Editor(game)
    editor.import_performance()
    there = {binding._display_name: binding for binding in editor.sequence("changes")._bindings}
    bones = [hung(there[name]) for name in ("Flute (flute)", "Flute (piccolo)")]
    number = there["Flute"]._id._value
    hand = bones[0][0][0].removesuffix("_socket")
    assert hand in ("hand_l", "hand_r")
    assert bones[0] == [(f"{hand}_socket", number)]
    assert bones[1][0][0].startswith("hand_")
    assert bones[1][0][0] != bones[0][0][0]


def test_where_the_root_bone_stands_at_the_place_the_actor_does_not(game: Path) -> None:
    editor = imported(game, RigOptions(root_bone="place"))
    for name in (PLAYER, HELD):
        values = transform(bindings(editor)[name])
        assert {values[f"Location.{axis}"] for axis in "XYZ"} == {0.0}
        assert values["Rotation.Z"] == 0.0
    (player,) = description(editor)["players"]
    scene = read_scene(editor.folder / "SuisouSource" / "quartet" / player["character"]["file"])
    root_cm = 100.0 * world_m(scene)[0, 0, :3, 3]
    np.testing.assert_allclose(root_cm[[0, 2]], [100.0 * player["stage"][axis] for axis in ("x_m", "z_m")], atol=0.1)
