"""Bundled characters, and synthetic files: rest rotations, no root, damage, no foot."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.errors import FileError, UsageError
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.characters.load_character import load_character
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import patch
from metadata.load import load_skeleton
from metadata.model import ARKIT_MORPHS, BREATH_MORPHS, REQUIRED_JOINTS
from tests.support.deformed import deform

STILL = np.array([0.0, 0.0, 0.0, 1.0])


@pytest.mark.parametrize("id", bundled_characters())
def test_a_bundled_character_has_what_playing_needs(id: str) -> None:
    character = character_named(id)
    skeleton = character.skeleton
    assert skeleton.parents[0] == -1
    assert all(0 <= parent < joint for joint, parent in enumerate(skeleton.parents) if joint)
    assert {joint.name for joint in load_skeleton().joints if joint.required} <= set(skeleton.names)
    body = next(mesh for mesh in character.meshes if mesh.name == "body")
    assert {morph.name for morph in body.morphs} - set(BREATH_MORPHS) == set(ARKIT_MORPHS)
    assert set(BREATH_MORPHS) <= {morph.name for mesh in character.meshes for morph in mesh.morphs}
    for mesh in character.meshes:
        np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5)
        assert mesh.triangles.max() < len(mesh.positions_m)
    # Left is +X, it faces +Z and stands upright on the floor.
    rest = rest_positions(skeleton)
    assert rest[skeleton.index("leftHand"), 0] > 0.5
    assert rest[skeleton.index("leftToes"), 2] > rest[skeleton.index("leftFoot"), 2]
    assert rest[skeleton.index("head"), 1] > 1.3


def test_an_unknown_character_is_refused() -> None:
    with pytest.raises(UsageError):
        character_named("unknown")


def test_our_file_rewritten_by_another_program_is_read_as_any_file(tmp_path: Path) -> None:
    """Its landmarks are preserved, but its vertices may differ."""
    data = bundled_characters()["man_adult"].read_bytes()
    changed = tmp_path / "changed.glb"
    changed.write_bytes(data.replace(b"Suisou build_characters", b"Khronos glTF Blender IO"))
    assert character_named("man_adult").own is None
    assert load_character(changed).own is not None


def _humanoid(tmp_path: Path, turned: bool, drop: str = "") -> Path:
    """Stick figure of an adult's height with one skinned point per joint, with or without rotated nodes."""
    profile = load_skeleton()
    ours = character_named("man_adult").skeleton
    places = dict(zip(ours.names, rest_positions(ours), strict=True))
    generator = np.random.default_rng(8)
    nodes: list[dict[str, Any]] = []
    place: dict[str, int] = {}
    world: list[np.ndarray] = []
    for joint in profile.joints:
        if joint.name in ("root", "jaw", drop):
            continue
        parent = place.get(joint.parent, -1)
        turn = Rotation.random(random_state=generator) if turned else Rotation.identity()
        up = world[parent] if parent >= 0 else np.eye(4)
        matrix = np.eye(4)
        # The place in the world is the same, turned or not.
        matrix[:3, :3], matrix[:3, 3] = turn.as_matrix(), places[joint.name]
        local = np.linalg.inv(up) @ matrix
        place[joint.name] = len(nodes)
        world.append(matrix)
        rotation = Rotation.from_matrix(local[:3, :3]).as_quat().tolist()
        nodes.append({"name": f"bone_{len(nodes)}", "rotation": rotation, "translation": local[:3, 3].tolist()})
        if parent >= 0:
            nodes[parent].setdefault("children", []).append(len(nodes) - 1)
    count = len(nodes)
    points = np.array([matrix[:3, 3] for matrix in world], np.float32) + np.float32(0.01)
    joints = np.zeros((count, 4), np.uint16)
    joints[:, 0] = np.arange(count)
    weights = np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    inverse = np.array([np.linalg.inv(matrix).T for matrix in world], np.float32)
    corners = np.array([0, 1, 2], np.uint16)
    blobs = [points.tobytes(), joints.tobytes(), weights.tobytes(), inverse.tobytes(), corners.tobytes() + b"\0\0"]
    starts = np.cumsum([0, *map(len, blobs)])
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, count]}],
        "nodes": [*nodes, {"name": "skin", "mesh": 0, "skin": 0}],
        "meshes": [
            {
                "name": "body",
                "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "indices": 4}],
            }
        ],
        "skins": [{"joints": list(range(count)), "inverseBindMatrices": 3}],
        "extensionsUsed": ["VRMC_vrm"],
        "extensions": {
            "VRMC_vrm": {"humanoid": {"humanBones": {name: {"node": node} for name, node in place.items()}}}
        },
        "buffers": [{"byteLength": int(starts[-1])}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(a), "byteLength": len(blob)} for a, blob in zip(starts, blobs, strict=False)
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": count,
                "type": "VEC3",
                "min": points.min(axis=0).tolist(),
                "max": points.max(axis=0).tolist(),
            },
            {"bufferView": 1, "componentType": 5123, "count": count, "type": "VEC4"},
            {"bufferView": 2, "componentType": 5126, "count": count, "type": "VEC4"},
            {"bufferView": 3, "componentType": 5126, "count": count, "type": "MAT4"},
            {"bufferView": 4, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(blobs)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    path = tmp_path / "stranger.glb"
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


@pytest.mark.parametrize("turned", [False, True])
def test_rest_rotations_of_a_stranger_are_removed_and_its_skin_stays(tmp_path: Path, turned: bool) -> None:
    character = load_character(_humanoid(tmp_path, turned))
    skeleton = character.skeleton
    assert skeleton.names[0] == "root"
    assert set(REQUIRED_JOINTS) <= set(skeleton.names)
    rest = rest_positions(skeleton)
    mesh = character.meshes[0]
    still = forward(skeleton, np.tile(STILL, (1, len(skeleton.names), 1)))
    skin = deform(patch(character, mesh, np.arange(len(mesh.positions_m))), still)[0]
    floor = mesh.positions_m[:, 1].min()
    np.testing.assert_allclose(skin, mesh.positions_m - [0.0, floor, 0.0], atol=1e-6)
    # A quarter turn of the elbow about the world's Y carries the hand's point about the elbow.
    elbow, hand = skeleton.index("leftLowerArm"), skeleton.index("leftHand")
    rotations = np.tile(STILL, (1, len(skeleton.names), 1))
    quarter = Rotation.from_euler("y", 90, degrees=True)
    rotations[0, elbow] = quarter.as_quat()
    moved = deform(patch(character, mesh, np.arange(len(mesh.positions_m))), forward(skeleton, rotations))[0]
    vertex = int(np.flatnonzero(mesh.joints[:, 0] == hand)[0])
    expected = rest[elbow] + quarter.apply(skin[vertex] - rest[elbow])
    np.testing.assert_allclose(moved[vertex], expected, atol=1e-6)


def test_a_body_without_a_foot_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="leftFoot"):
        load_character(_humanoid(tmp_path, turned=False, drop="leftFoot"))


def test_a_body_without_a_phalanx_gets_one_in_our_own_proportions(tmp_path: Path) -> None:
    ours = character_named("man_adult").skeleton
    character = load_character(_humanoid(tmp_path, turned=True, drop="leftIndexDistal"))
    joint = character.skeleton.index("leftIndexDistal")
    assert character.own.bone_of_joint[joint] == -1
    np.testing.assert_allclose(
        character.skeleton.offsets_m[joint], ours.offsets_m[ours.index("leftIndexDistal")], atol=2e-3
    )


def test_damage_is_a_file_error(tmp_path: Path) -> None:
    whole = _humanoid(tmp_path, turned=True).read_bytes()
    generator = np.random.default_rng(2)
    broken = tmp_path / "broken.glb"
    for _ in range(60):
        data = bytearray(whole[: int(generator.integers(0, len(whole)))])
        for place in generator.integers(0, max(len(data), 1), size=4):
            if data:
                data[place] = int(generator.integers(0, 256))
        broken.write_bytes(data)
        with pytest.raises(FileError):
            load_character(broken)
    with pytest.raises(FileError):
        load_character(tmp_path / "absent.glb")
