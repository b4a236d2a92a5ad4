"""Scenes as GLB are equal after writing and reading, and conform to glTF."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest

from app.errors import FileError
from app.formats.continuous import continuous
from app.formats.gltf import write as writer
from app.formats.gltf.model import GltfModel, GltfPrimitive
from app.formats.gltf.primitives import primitives
from app.formats.gltf.read import decode_gltf
from app.formats.gltf.write import write_glb
from app.formats.scene import MorphTarget, NodePlace, Scene, SkinnedMesh
from app.formats.skin import influences
from tests.support.encoded import encode_glb
from tests.unit.formats import scenes

RATES = [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)]


def _document(data: bytes) -> dict[str, Any]:
    (length,) = struct.unpack_from("<I", data, 12)
    document: dict[str, Any] = json.loads(data[20 : 20 + length])
    return document


def _keys(data: bytes, path: str) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Times and values of every channel of a path by node, as loaded by another library."""
    loaded = pygltflib.GLTF2().load_from_bytes(data)
    (animation,) = loaded.animations

    def values(number: int) -> np.ndarray:
        accessor = loaded.accessors[number]
        view = loaded.bufferViews[accessor.bufferView]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        start = view.byteOffset + accessor.byteOffset
        return np.frombuffer(loaded.binary_blob(), np.float32, accessor.count * width, start).reshape(-1, width)

    result = {}
    for channel in animation.channels:
        if channel.target.path == path:
            sampler = animation.samplers[channel.sampler]
            assert sampler.interpolation == "LINEAR"
            result[channel.target.node] = values(sampler.input)[:, 0], values(sampler.output)
    return result


def _dense(joints: np.ndarray, weights: np.ndarray, bones: int) -> np.ndarray:
    result = np.zeros((len(joints), bones))
    for slot in range(joints.shape[1]):
        np.add.at(result, (np.arange(len(joints)), joints[:, slot]), weights[:, slot])
    return result


def _check_primitive(mesh: SkinnedMesh, found: GltfPrimitive, vertices: np.ndarray, bones: int) -> None:
    np.testing.assert_allclose(found.positions * 100, mesh.vertices_cm[vertices], atol=1e-5)
    np.testing.assert_allclose(
        _dense(found.joint_indices, found.weights, bones),
        _dense(mesh.joint_indices, mesh.weights, bones)[vertices],
        atol=1e-6,
    )
    assert [morph.name for morph in found.morphs] == [morph.name for morph in mesh.morphs]
    for given, morph in zip(mesh.morphs, found.morphs, strict=True):
        moved = np.zeros_like(mesh.vertices_cm)
        moved[given.vertex_indices] = given.position_deltas_cm
        deltas = np.zeros((len(vertices), 3))
        deltas[morph.vertex_indices] = morph.position_deltas * 100
        np.testing.assert_allclose(deltas, moved[vertices], atol=1e-5)


@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
def test_a_scene_comes_back(make: Any) -> None:
    scene: Scene = make(Fraction(30))
    model = decode_gltf(encode_glb(scene), "scene.glb")
    bones = len(scene.bones)
    assert [node.name for node in model.nodes] == [thing.name for thing in (*scene.bones, *scene.meshes)]  # type: ignore[attr-defined]
    assert [node.parent for node in model.nodes[:bones]] == [bone.parent for bone in scene.bones]
    for bone, node in zip(scene.bones, model.nodes[:bones], strict=True):
        np.testing.assert_allclose(node.translation * 100, bone.translation_cm, atol=1e-9)
        assert abs(abs(node.rotation_xyzw @ bone.rotation_xyzw) - 1) < 1e-12
    (skin,) = model.skins
    assert skin.joints == tuple(range(bones))
    binds = np.linalg.inv(skin.joint_from_mesh_bind)
    binds[:, :3, 3] *= 100
    np.testing.assert_allclose(binds, scene.meshes[0].world_from_bone_bind, atol=2e-5)
    for mesh, found in zip(scene.meshes, model.meshes, strict=True):
        assert found.name == mesh.name
        assert [model.materials[primitive.material or 0].name for primitive in found.primitives] == [
            material.name for material in mesh.materials
        ]
        for made, primitive in zip(primitives(mesh), found.primitives, strict=True):
            _check_primitive(mesh, primitive, made.vertices, bones)
    _check_materials(scene, model)


def _check_materials(scene: Scene, model: GltfModel) -> None:
    given = {material.name: material for mesh in scene.meshes for material in mesh.materials}
    assert {material.name for material in model.materials} == set(given)
    for material in model.materials:
        requested = given[material.name]
        assert material.base_color_rgba == pytest.approx(requested.base_color)
        assert (material.metallic, material.roughness) == (requested.metallic, requested.roughness)
        assert material.double_sided == requested.double_sided
        assert material.alpha_mode == ("BLEND" if requested.base_color[3] < 1 else "OPAQUE")


@pytest.mark.parametrize("fps", RATES, ids=str)
def test_every_frame_has_its_key(fps: Fraction) -> None:
    scene = scenes.character(fps, frames=31, amplitude_rad=4.0)
    assert scene.clip is not None
    data = encode_glb(scene)
    rotations, translations, weights = (_keys(data, path) for path in ("rotation", "translation", "weights"))
    assert set(rotations) == set(range(len(scene.bones)))
    assert set(translations) == {0, 1}
    exact = np.array([float(frame / fps) for frame in range(31)])
    for times, values in rotations.values():
        np.testing.assert_array_equal(times, exact.astype(np.float32))
        assert (np.einsum("ij,ij->i", values[1:], values[:-1]) > 0).all()
    for bone, (_, values) in rotations.items():
        given = np.asarray(scene.clip.rotations_xyzw[:, bone], float)
        assert (np.abs(np.einsum("ij,ij->i", values, given)) > 1 - 1e-6).all()
    for bone, (_, values) in translations.items():
        np.testing.assert_allclose(values * 100, scene.clip.translations_cm[bone], atol=1e-5)
    body, teeth = len(scene.bones), len(scene.bones) + 1
    assert set(weights) == {body, teeth}  # the shirt has no morphs
    both = np.stack([scene.clip.morph_weights[name] for name in ("jawOpen", "browInnerUp")], axis=1)
    np.testing.assert_allclose(weights[body][1].reshape(31, 2), both, atol=1e-7)
    np.testing.assert_allclose(weights[teeth][1].reshape(31, 1), both[:, :1], atol=1e-7)
    extras = _document(data)["animations"][0]["extras"]
    assert extras == {"frames": 31, "framesPerSecond": f"{fps.numerator}/{fps.denominator}"}


def test_an_hour_of_frames_is_where_the_documentation_says() -> None:
    frames = 3600 * 60 + 1
    seconds = (np.arange(frames) / 60).astype(np.float32)
    assert np.abs(seconds.astype(float) - np.arange(frames) / 60).max() < 0.00013


def test_the_same_scene_gives_the_same_bytes(tmp_path: Path) -> None:
    scene = scenes.character(Fraction(25))
    data = encode_glb(scene)
    write_glb(tmp_path / "scene.glb", scene)
    assert (tmp_path / "scene.glb").read_bytes() == data == encode_glb(scenes.character(Fraction(25)))
    assert len(data) % 4 == 0
    assert struct.unpack_from("<4sII", data) == (b"glTF", 2, len(data))


def test_weights_beyond_the_fourth_are_in_a_second_set_and_the_first_has_the_strongest() -> None:
    scene = scenes.character(Fraction(24))
    model = decode_gltf(encode_glb(scene), "scene.glb")
    for primitive in model.meshes[0].primitives:
        assert primitive.weights.shape[1] == 8
        assert (np.diff(primitive.weights, axis=1) <= 1e-7).all()
        np.testing.assert_allclose(primitive.weights.sum(axis=1), 1, atol=1e-6)
        # Unused slots name the first bone; nothing names a bone twice.
        assert (primitive.joint_indices[primitive.weights == 0] == 0).all()
    document = _document(encode_glb(scenes.instrument(Fraction(24))))
    assert "JOINTS_1" not in document["meshes"][0]["primitives"][0]["attributes"]


def test_a_vertex_that_nothing_moves_goes_with_the_root_and_doubles_add_up() -> None:
    mesh = scenes.instrument(Fraction(24)).meshes[0]
    count = len(mesh.vertices_cm)
    joints = np.tile([3, 1, 3], (count, 1))
    weights = np.tile([0.5, 1.0, 0.5], (count, 1))
    weights[0] = 0
    found_joints, found_weights = influences(replace(mesh, joint_indices=joints, weights=weights))
    assert found_joints.shape == (count, 2)
    np.testing.assert_array_equal(found_joints[0], [0, 0])
    np.testing.assert_array_equal(found_weights[0], [1.0, 0.0])
    np.testing.assert_array_equal(found_weights[1:], 0.5)
    assert {tuple(sorted(row)) for row in found_joints[1:].tolist()} == {(1, 3)}
    bare = replace(mesh, joint_indices=np.zeros((count, 0), int), weights=np.zeros((count, 0)))
    np.testing.assert_array_equal(influences(bare)[1], 1.0)


def test_polygons_and_corners_of_their_own() -> None:
    """Square of two materials with a normal per corner: each face has its corners, shared where they are equal."""
    scene = scenes.instrument(Fraction(24))
    mesh = scene.meshes[0]
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
    square = replace(
        mesh,
        vertices_cm=corners,
        faces=np.array([[0, 1, 2, 3], [1, 4, 5, 2]]),
        normals=np.array([[0, 0, 2.0]] * 4 + [[0, 1.0, 0]] * 2 + [[0, 0, 0.0]] * 2),
        uvs=np.arange(16).reshape(8, 2) / 16,
        joint_indices=np.zeros((6, 1), int),
        weights=np.ones((6, 1)),
    )
    (primitive,) = primitives(square)
    assert len(primitive.vertices) == 8
    assert len(primitive.triangles) == 4
    np.testing.assert_allclose(np.linalg.norm(primitive.normals, axis=1), 1)
    first, second, third = (corners[primitive.vertices[primitive.triangles[:, k]]] for k in range(3))
    area = np.cross(second - first, third - first)
    np.testing.assert_allclose(area, np.tile([0, 0, 1.0], (4, 1)))
    assert square.uvs is not None
    assert primitive.uvs is not None
    assert {tuple(row) for row in primitive.uvs} == {(u, 1 - v) for u, v in square.uvs}
    flat = replace(square, normals=np.tile([0, 0, 1.0], (6, 1)), uvs=None)
    (primitive,) = primitives(flat)
    np.testing.assert_array_equal(primitive.vertices, np.arange(6))
    decode_gltf(encode_glb(replace(scene, meshes=(square,))), "square.glb")


def test_normals_of_morphs_are_there_for_all_or_none() -> None:
    scene = scenes.character(Fraction(24))
    mesh = scene.meshes[0]
    first = mesh.morphs[0]
    given = MorphTarget(first.name, first.vertex_indices, first.position_deltas_cm, first.position_deltas_cm * 0.1)
    with_normals = replace(mesh, morphs=(given, *mesh.morphs[1:]))
    document = _document(encode_glb(replace(scene, meshes=(with_normals, *scene.meshes[1:]))))
    for primitive in document["meshes"][0]["primitives"]:
        assert [set(target) for target in primitive["targets"]] == [{"POSITION", "NORMAL"}] * 2
    model = decode_gltf(encode_glb(replace(scene, meshes=(with_normals,))), "scene.glb")
    found = model.meshes[0].primitives[0].morphs[0]
    assert found.normal_deltas is not None
    np.testing.assert_allclose(found.normal_deltas, found.position_deltas * 10, atol=1e-6)


def test_a_mesh_whose_morphs_move_is_on_the_node_at_the_place() -> None:
    """Blender would make an additional empty object for an animated node above a mesh; only the joints move the mesh,
    so it stays in place.
    """
    scene = scenes.character(Fraction(24), frames=2)
    placed = replace(scene, name="Ana", place=NodePlace(np.array([10.0, 0.0, 5.0]), np.array([0.0, 0.0, 0.0, 1.0])))
    top = _document(encode_glb(placed))["nodes"][0]
    assert (top["name"], top["mesh"], top["skin"], top["children"]) == ("Ana", 0, 0, [1])
    still = _document(encode_glb(replace(placed, clip=None)))["nodes"][0]
    assert "mesh" not in still


def test_a_morph_that_leaves_a_part_alone_has_bytes_for_it() -> None:
    """The format allows omitting them, but assimp does not open such a file."""
    scene = scenes.character(Fraction(24), frames=2)
    body = scene.meshes[0]
    front = np.setdiff1d(body.faces[body.face_materials == 0], body.faces[body.face_materials == 1])
    morph = MorphTarget("jawOpen", front, np.ones((len(front), 3)))
    data = encode_glb(replace(scene, clip=None, meshes=(replace(body, morphs=(morph,)),)))
    assert all("bufferView" in one or "sparse" in one for one in _document(data)["accessors"])
    found = decode_gltf(data, "scene.glb").meshes[0].primitives
    assert not found[1].morphs[0].position_deltas.any()


def test_bare_skeletons_single_frames_and_no_clip() -> None:
    scene = scenes.character(Fraction(24), frames=1)
    times, _ = _keys(encode_glb(scene), "rotation")[0]
    np.testing.assert_array_equal(times, [0.0])
    still = _document(encode_glb(replace(scene, clip=None)))
    assert "animations" not in still
    bare = _document(encode_glb(replace(scene, clip=None, meshes=())))
    assert "meshes" not in bare
    assert len(bare["nodes"]) == len(scene.bones)
    # By the skin alone programs take nodes for bones.
    assert [len(skin["joints"]) for skin in bare["skins"]] == [len(scene.bones)]


def test_quaternions_take_the_short_way_even_when_given_the_long_one() -> None:
    turns = scenes.rotations(5, 200, 1, 5.0)[:, 0]
    flipped = turns * np.where(np.random.default_rng(1).random(200) < 0.5, -1, 1)[:, None] * 3.0
    found = continuous(flipped)
    assert (np.einsum("ij,ij->i", found[1:], found[:-1]) > 0).all()
    np.testing.assert_allclose(np.abs(np.einsum("ij,ij->i", found, turns)), 1, atol=1e-6)


def test_more_than_a_file_can_have_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writer, "_MOST_BYTES", 1000)
    with pytest.raises(FileError, match="GLB"):
        write_glb(tmp_path / "scene.glb", scenes.instrument(Fraction(24)))
    assert not list(tmp_path.iterdir())
