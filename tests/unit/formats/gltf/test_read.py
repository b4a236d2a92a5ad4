"""The glTF reader with files written by pygltflib and trimesh."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from app.errors import FileError
from app.formats.gltf.model import GltfModel
from app.formats.gltf.read import decode_gltf, read_glb

CODES = {"float32": 5126, "int8": 5120, "uint8": 5121, "uint16": 5123, "uint32": 5125, "int16": 5122}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Maker:
    """Builds a document and its buffer."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.document: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "accessors": [],
            "bufferViews": [],
            "buffers": [{"byteLength": 0}],
        }

    def view(self, values: np.ndarray, stride: int | None = None) -> int:
        rows = np.atleast_2d(values.T).T
        raw = np.ascontiguousarray(rows).tobytes()
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)}
        if stride is not None:
            padded = np.zeros((len(rows), stride), np.uint8)
            padded[:, : rows.shape[1] * rows.itemsize] = np.frombuffer(raw, np.uint8).reshape(len(rows), -1)
            raw, view["byteStride"], view["byteLength"] = padded.tobytes(), stride, padded.size
        self.data += raw + bytes(-len(raw) % 4)
        self.document["bufferViews"].append(view)
        self.document["buffers"][0]["byteLength"] = len(self.data)
        return len(self.document["bufferViews"]) - 1

    def accessor(self, values: np.ndarray, stride: int | None = None, **more: object) -> int:
        width = values.shape[1] if values.ndim > 1 else 1
        self.document["accessors"].append(
            {"bufferView": self.view(values, stride), "componentType": CODES[values.dtype.name], "count": len(values),
             "type": TYPES[width], **more}
        )  # fmt: skip
        return len(self.document["accessors"]) - 1

    def sparse(self, count: int, rows: np.ndarray, values: np.ndarray, base: int | None = None) -> int:
        accessor = {
            "componentType": CODES[values.dtype.name], "count": count, "type": TYPES[values.shape[1]],
            "sparse": {
                "count": len(rows),
                "indices": {"bufferView": self.view(rows), "componentType": CODES[rows.dtype.name]},
                "values": {"bufferView": self.view(values)},
            },
        }  # fmt: skip
        if base is not None:
            accessor["bufferView"] = base
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def glb(self) -> bytes:
        text = json.dumps(self.document).encode()
        text += b" " * (-len(text) % 4)
        body = bytes(self.data)
        head = b"glTF" + np.array([2, 12 + 8 + len(text) + 8 + len(body)], "<u4").tobytes()
        return (
            head + np.array([len(text)], "<u4").tobytes() + b"JSON" + text
            + np.array([len(body)], "<u4").tobytes() + b"BIN\0" + body
        )  # fmt: skip


POSITIONS = np.random.default_rng(1).normal(size=(6, 3)).astype(np.float32)
JOINTS = np.random.default_rng(2).integers(0, 3, (6, 8)).astype(np.uint8)
WEIGHTS = np.random.default_rng(3).random((6, 8)).astype(np.float32)
BINDS = np.random.default_rng(4).normal(size=(3, 4, 4)).astype(np.float32)
DELTAS = np.array([[0, 1, 0], [2, 0, 0]], np.float32)


def character() -> Maker:
    """Two skinned triangles with two sets of joints, a sparse morph, a morph over a base, a dense morph, and a node
    with a matrix.
    """
    maker = Maker()
    attributes = {
        "POSITION": maker.accessor(POSITIONS, stride=20),
        "NORMAL": maker.accessor(POSITIONS[::-1].copy()),
        "TEXCOORD_0": maker.accessor(np.arange(12, dtype=np.uint16).reshape(6, 2) * 5000, normalized=True),
        "JOINTS_0": maker.accessor(JOINTS[:, :4].copy()),
        "JOINTS_1": maker.accessor(JOINTS[:, 4:].astype(np.uint16)),
        "WEIGHTS_0": maker.accessor(WEIGHTS[:, :4].copy()),
        "WEIGHTS_1": maker.accessor((WEIGHTS[:, 4:] * 255).astype(np.uint8), normalized=True),
    }
    dense = np.zeros((6, 3), np.float32)
    dense[3] = [0, 0, 5]
    rows = np.array([1, 4], np.uint16)
    targets = [
        {"POSITION": maker.sparse(6, rows, DELTAS)},
        {"POSITION": maker.sparse(6, rows, DELTAS, base=maker.view(dense))},
        {"POSITION": maker.accessor(dense), "NORMAL": maker.sparse(6, np.array([0], np.uint8), DELTAS[:1])},
    ]
    indices = maker.accessor(np.array([0, 1, 2, 3, 4, 5], np.uint16))
    binds = maker.accessor(BINDS.transpose(0, 2, 1).reshape(3, 16).copy())
    surface = {"baseColorFactor": [0.5, 0.25, 0.125, 1], "roughnessFactor": 0.5, "metallicFactor": 0}
    turn = np.eye(4)
    turn[:3, :3] = Rotation.from_euler("xyz", [2.0, -0.5, 1.0]).as_matrix() * [1.0, 2.0, 3.0]
    turn[:3, 3] = [4, 5, 6]
    maker.document |= {
        "meshes": [{
            "name": "Body",
            "primitives": [{"attributes": attributes, "indices": indices, "material": 0, "targets": targets}],
            "extras": {"targetNames": ["jawOpen", "blink"]},
        }],
        "materials": [{"name": "Skin", "pbrMetallicRoughness": surface}, {}],
        "skins": [{"joints": [2, 0, 1], "inverseBindMatrices": binds}],
        "nodes": [
            {"name": "hand", "translation": [1, 2, 3], "rotation": [0, 0, 2, 0], "extras": {"note": 1}},
            {"name": "arm", "children": [0], "scale": [1, 1, 2]},
            {"name": "root", "children": [1]},
            {"mesh": 0, "skin": 0, "matrix": turn.T.ravel().tolist()},
        ],
        "scene": 0,
        "scenes": [{"nodes": [2, 3], "extras": {"suisou": {"height_m": 1.7}}}],
        "extensions": {"VRMC_vrm": {"specVersion": "1.0"}},
        "extensionsUsed": ["VRMC_vrm"],
    }  # fmt: skip
    return maker


def test_a_character_is_read_whole() -> None:
    model = decode_gltf(character().glb(), "x.glb")
    assert [node.name for node in model.nodes] == ["hand", "arm", "root", "node_3"]
    assert [node.parent for node in model.nodes] == [1, 2, -1, -1]
    np.testing.assert_array_equal(model.nodes[0].rotation_xyzw, [0, 0, 1, 0])
    np.testing.assert_array_equal(model.nodes[0].translation, [1, 2, 3])
    np.testing.assert_array_equal(model.nodes[1].scale, [1, 1, 2])
    assert (model.nodes[3].mesh, model.nodes[3].skin) == (0, 0)
    assert model.extensions == {"VRMC_vrm": {"specVersion": "1.0"}}
    assert model.scene_extras == {"suisou": {"height_m": 1.7}}
    (skin,) = model.skins
    assert skin.joints == (2, 0, 1)
    np.testing.assert_array_equal(skin.joint_from_mesh_bind, BINDS)

    (primitive,) = model.meshes[0].primitives
    np.testing.assert_array_equal(primitive.positions, POSITIONS)
    np.testing.assert_array_equal(primitive.normals, POSITIONS[::-1])
    np.testing.assert_allclose(primitive.uvs, np.arange(12).reshape(6, 2) * 5000 / 65535)
    np.testing.assert_array_equal(primitive.triangles, [[0, 1, 2], [3, 4, 5]])
    np.testing.assert_array_equal(primitive.joint_indices, JOINTS)
    np.testing.assert_array_equal(primitive.weights[:, :4], WEIGHTS[:, :4])
    np.testing.assert_allclose(primitive.weights[:, 4:], WEIGHTS[:, 4:], atol=1 / 255)
    assert primitive.material == 0

    skin_material, plain = model.materials
    assert skin_material.base_color_rgba == (0.5, 0.25, 0.125, 1.0)
    assert (skin_material.metallic, skin_material.roughness) == (0.0, 0.5)
    assert (plain.base_color_rgba, plain.metallic, plain.roughness) == ((1, 1, 1, 1), 1.0, 1.0)


def test_the_least_of_normalised_integers_is_minus_one() -> None:
    """The least integer has no positive counterpart; glTF 2.0, 3.6.2.2."""
    maker = character()
    normals = np.array([[-128, -127, 127], [0, 0, 64]] * 3, np.int8)
    attributes = maker.document["meshes"][0]["primitives"][0]["attributes"]
    attributes["NORMAL"] = maker.accessor(normals, stride=4, normalized=True)
    found = decode_gltf(maker.glb(), "x.glb").meshes[0].primitives[0].normals
    np.testing.assert_allclose(found[:2], [[-1.0, -1.0, 1.0], [0.0, 0.0, 64 / 127]])


def test_morphs_of_every_form_are_read() -> None:
    jaw, blink, third = decode_gltf(character().glb(), "x.glb").meshes[0].primitives[0].morphs
    assert (jaw.name, blink.name, third.name) == ("jawOpen", "blink", "morph_2")
    np.testing.assert_array_equal(jaw.vertex_indices, [1, 4])
    np.testing.assert_array_equal(jaw.position_deltas, DELTAS)
    assert jaw.normal_deltas is None
    np.testing.assert_array_equal(blink.vertex_indices, [1, 3, 4])
    np.testing.assert_array_equal(blink.position_deltas, [DELTAS[0], [0, 0, 5], DELTAS[1]])
    np.testing.assert_array_equal(third.vertex_indices, [0, 3])
    np.testing.assert_array_equal(third.position_deltas, [[0, 0, 0], [0, 0, 5]])
    np.testing.assert_array_equal(third.normal_deltas, [DELTAS[0], [0, 0, 0]])


@pytest.mark.parametrize("seed", range(30))
def test_a_matrix_is_its_translation_rotation_and_scale(seed: int) -> None:
    generator = np.random.default_rng(seed)
    half_turns = Rotation.from_euler("xyz", 180 * np.eye(3)[seed % 9 // 3], degrees=True)
    rotation = Rotation.random(None, generator) if seed % 3 else half_turns
    scale = generator.uniform(0.5, 2, 3)
    if seed % 2:
        scale[0] *= -1
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation.as_matrix() * scale, generator.normal(size=3)
    maker = character()
    maker.document["nodes"][3]["matrix"] = matrix.T.ravel().tolist()
    node = decode_gltf(maker.glb(), "x.glb").nodes[3]
    found = np.eye(4)
    found[:3, :3] = Rotation.from_quat(node.rotation_xyzw).as_matrix() * node.scale
    found[:3, 3] = node.translation
    np.testing.assert_allclose(found, matrix, atol=1e-12)


@pytest.mark.parametrize(
    ("mode", "triangles"),
    [(4, [[0, 1, 2], [3, 4, 5]]), (5, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]),
     (6, [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]])],
)  # fmt: skip
@pytest.mark.parametrize("indexed", [True, False])
def test_strips_and_fans_become_triangles(mode: int, triangles: list[list[int]], indexed: bool) -> None:
    maker = character()
    primitive = maker.document["meshes"][0]["primitives"][0]
    primitive["mode"] = mode
    if not indexed:
        del primitive["indices"]
    found = decode_gltf(maker.glb(), "x.glb").meshes[0].primitives[0].triangles
    np.testing.assert_array_equal(found, triangles)


def test_a_text_file_with_data_uris_is_the_same() -> None:
    maker = character()
    inside = base64.b64encode(bytes(maker.data)).decode()
    maker.document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + inside
    model = decode_gltf(json.dumps(maker.document).encode(), "x.gltf")
    np.testing.assert_array_equal(model.meshes[0].primitives[0].positions, POSITIONS)


def test_a_scene_that_trimesh_writes(tmp_path: Path) -> None:
    box = trimesh.creation.box((0.1, 0.2, 0.3))
    brass = {"name": "Brass", "baseColorFactor": [204, 153, 51, 255], "metallicFactor": 1.0, "roughnessFactor": 0.3}
    box.visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.PBRMaterial(**brass))
    scene = trimesh.Scene()
    place = trimesh.transformations.compose_matrix(angles=(0.1, 0.2, 0.3), translate=(1, 2, 3))
    scene.add_geometry(box, node_name="valve_1", geom_name="valve", transform=place)
    scene.add_geometry(box, node_name="valve_2", geom_name="valve", parent_node_name="valve_1", transform=place)
    path = tmp_path / "scene.glb"
    path.write_bytes(scene.export(file_type="glb"))
    model = read_glb(path)
    by_name = {node.name: node for node in model.nodes}
    assert model.nodes[by_name["valve_2"].parent].name == "valve_1"
    np.testing.assert_allclose(by_name["valve_1"].translation, [1, 2, 3])
    np.testing.assert_allclose(
        Rotation.from_quat(by_name["valve_2"].rotation_xyzw).as_matrix(), place[:3, :3], atol=1e-6
    )
    mesh = model.meshes[by_name["valve_1"].mesh or 0]
    found = trimesh.Trimesh(mesh.primitives[0].positions, mesh.primitives[0].triangles, process=False)
    assert abs(found.volume - 0.006) < 1e-8
    material = model.materials[mesh.primitives[0].material or 0]
    assert (material.metallic, material.roughness) == (1.0, 0.3)
    np.testing.assert_allclose(material.base_color_rgba, [0.8, 0.6, 0.2, 1.0])


def test_a_file_that_pygltflib_writes(tmp_path: Path) -> None:
    raw = POSITIONS.tobytes()
    document = pygltflib.GLTF2(
        meshes=[pygltflib.Mesh(primitives=[pygltflib.Primitive(attributes=pygltflib.Attributes(POSITION=0))])],
        accessors=[pygltflib.Accessor(bufferView=0, componentType=5126, count=6, type="VEC3")],
        bufferViews=[pygltflib.BufferView(buffer=0, byteLength=len(raw))],
        buffers=[pygltflib.Buffer(byteLength=len(raw))],
        nodes=[pygltflib.Node(mesh=0)],
    )
    document.set_binary_blob(raw)
    document.save_binary(tmp_path / "a.glb")
    model = read_glb(tmp_path / "a.glb")
    np.testing.assert_array_equal(model.meshes[0].primitives[0].positions, POSITIONS)
    assert model.meshes[0].primitives[0].joint_indices.shape == (6, 0)


# ------------------------------------------------------------------------------------------------------------ damage


def _set(path: str, value: object) -> Any:
    def change(maker: Maker) -> None:
        owner: Any = maker.document
        *steps, last = path.split("/")
        for step in steps:
            owner = owner[int(step)] if isinstance(owner, list) else owner[step]
        owner[int(last) if isinstance(owner, list) else last] = value

    return change


def _point_beyond(maker: Maker) -> None:
    """Triangle of six points with an index of a seventh."""
    indices = maker.accessor(np.array([0, 1, 2, 3, 4, 6], np.uint16))
    _set("meshes/0/primitives/0/indices", indices)(maker)


ATTRIBUTES = "meshes/0/primitives/0/attributes/"
DAMAGE = {
    "a point beyond the last": (_point_beyond, "damaged"),
    "an index beyond the accessors": (_set(ATTRIBUTES + "POSITION", 99), "damaged"),
    "a negative index": (_set(ATTRIBUTES + "POSITION", -1), "damaged"),
    "an index of text": (_set(ATTRIBUTES + "POSITION", "0"), "damaged"),
    "a true index": (_set(ATTRIBUTES + "POSITION", True), "damaged"),
    "no positions": (_set("meshes/0/primitives/0/attributes", {}), "damaged"),
    "a mesh of text": (_set("meshes", "many"), "damaged"),
    "normals of another count": (_set(ATTRIBUTES + "NORMAL", 2), "damaged"),
    "joints without weights": (_set(ATTRIBUTES + "WEIGHTS_1", None), "damaged"),
    "joints of reals": (_set(ATTRIBUTES + "JOINTS_0", 5), "damaged"),
    "an accessor past its view": (_set("accessors/0/count", 7), "damaged"),
    "an accessor of a billion": (_set("accessors/0/count", 10**9), "damaged"),
    "an offset past the view": (_set("accessors/0/byteOffset", 10**18), "damaged"),
    "an unknown component": (_set("accessors/0/componentType", 5124), "damaged"),
    "an unknown type": (_set("accessors/0/type", "VEC9"), "damaged"),
    "a view past its buffer": (_set("bufferViews/0/byteLength", 10**9), "damaged"),
    "a stride below the element": (_set("bufferViews/0/byteStride", 4), "damaged"),
    "a buffer longer than its bytes": (_set("buffers/0/byteLength", 10**9), "damaged"),
    "another file": (_set("buffers/0/uri", "../../secret.bin"), "external"),
    "a web address": (_set("buffers/0/uri", "https://example.org/a.bin"), "external"),
    "a data URI that is none": (_set("buffers/0/uri", "data:;base64,@@"), "damaged"),
    "sparse rows beyond the accessor": (_set("accessors/7/count", 3), "damaged"),
    "sparse rows out of order": (_set("accessors/7/sparse/indices/byteOffset", 1), "damaged"),
    "a sparse count past its view": (_set("accessors/7/sparse/count", 3), "damaged"),
    "sparse rows of reals": (_set("accessors/7/sparse/indices/componentType", 5126), "damaged"),
    "zeros without end": (_set("accessors/0", {"componentType": 5126, "count": 10**9, "type": "VEC3"}), "too_large"),
    "a node that is its own child": (_set("nodes/0/children", [2]), "damaged"),
    "a node of two parents": (_set("nodes/3/children", [0]), "damaged"),
    "a child beyond the nodes": (_set("nodes/3/children", [9]), "damaged"),
    "a skin joint beyond the nodes": (_set("skins/0/joints", [0, 9]), "damaged"),
    "more joints than binds": (_set("skins/0/joints", [0, 1, 2, 3]), "damaged"),
    "a rotation of nothing": (_set("nodes/0/rotation", [0, 0, 0, 0]), "damaged"),
    "a translation of two numbers": (_set("nodes/0/translation", [0, 0]), "damaged"),
    "a translation of text": (_set("nodes/0/translation", "here"), "damaged"),
    "a matrix that shears": (_set("nodes/3/matrix", [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "damaged"),
    "a flat matrix": (_set("nodes/3/matrix", [0.0] * 16), "damaged"),
    "a material beyond the list": (_set("meshes/0/primitives/0/material", 5), "damaged"),
    "a colour of text": (_set("materials/0/pbrMetallicRoughness/baseColorFactor", "red"), "damaged"),
    "lines": (_set("meshes/0/primitives/0/mode", 1), "unsupported"),
    "a compression": (_set("extensionsRequired", ["EXT_unheard_of_compression"]), "compressed"),
    "an extension": (_set("extensionsRequired", ["KHR_unheard_of"]), "unsupported"),
    "a scene beyond the list": (_set("scene", 4), "damaged"),
    "version 1": (_set("asset/version", "1.0"), "not_gltf"),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str) -> None:
    change, problem = DAMAGE[name]
    maker = character()
    change(maker)
    with pytest.raises(FileError) as raised:
        decode_gltf(maker.glb(), "bad.glb")
    assert raised.value.message.id == f"gltf.{problem}"
    assert raised.value.message.arguments["file"] == "bad.glb"


@pytest.mark.parametrize("data", [b"", b"glTF", b"glTF" + bytes(8), b"[]", b"[" * 100_000, b"\xff"])
def test_what_is_no_gltf_is_refused(data: bytes) -> None:
    with pytest.raises(FileError) as raised:
        decode_gltf(data, "bad.glb")
    assert raised.value.message.id == "gltf.not_gltf"


@pytest.mark.parametrize("data", [b"{}", b"null", b'{"asset": {"version": "2.0"}}'])
def test_a_document_without_anything_is_refused(data: bytes) -> None:
    with pytest.raises(FileError):
        decode_gltf(data, "bad.gltf")


def test_many_views_of_one_buffer_do_not_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.formats.gltf.accessors._FREE_BYTES", 0)
    monkeypatch.setattr("app.formats.gltf.accessors._MOST_TIMES", 0)
    with pytest.raises(FileError) as raised:
        decode_gltf(character().glb(), "big.glb")
    assert raised.value.message.id == "gltf.too_large"


def test_a_missing_file_is_an_error_a_user_can_act_on(tmp_path: Path) -> None:
    with pytest.raises(FileError) as raised:
        read_glb(tmp_path / "missing.glb")
    assert raised.value.message.id == "file.cannot_read"


def test_the_bundled_characters_are_read() -> None:
    """All are humanoids with normalised weights and ARKit's morphs."""
    for path in sorted(Path("resources/characters").glob("*.glb")):
        model: GltfModel = read_glb(path)
        assert "VRMC_vrm" in model.extensions
        for mesh in model.meshes:
            for primitive in mesh.primitives:
                np.testing.assert_allclose(primitive.weights.sum(axis=1), 1.0, atol=1e-5)
                assert primitive.joint_indices.max() < len(model.skins[0].joints)
        assert any("jawOpen" in [m.name for m in mesh.primitives[0].morphs] for mesh in model.meshes)
