"""Compressed files of other programs compared with the original files; damage, decompression bombs and a missing
library.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import meshopt
import numpy as np
import pytest
from scipy.spatial import cKDTree

from app.errors import FileError
from app.formats.gltf.container import split
from app.formats.gltf.read import decode_gltf, read_glb
from app.formats.gltf.self_contained import _joined
from app.formats.reading_child import NO_READER
from app.rig.characters.load_character import load_character

CHARACTERS = Path("tests/data/characters")
PLAIN = CHARACTERS / "woman_game_engine.glb"
PACKED = {"draco": CHARACTERS / "woman_draco.glb", "meshopt": CHARACTERS / "woman_meshopt.glb"}


@pytest.mark.parametrize("kind", PACKED)
def test_a_compressed_figure_is_the_one_that_was_compressed(kind: str) -> None:
    plain, packed = load_character(PLAIN), load_character(PACKED[kind])
    assert packed.skeleton.names == plain.skeleton.names
    np.testing.assert_allclose(packed.skeleton.offsets_m, plain.skeleton.offsets_m, atol=1e-4)
    known, found = plain.meshes[0], packed.meshes[0]
    distances_m, nearest = cKDTree(known.positions_m).query(found.positions_m)
    # Places of 14 bits over 1.5 m.
    assert distances_m.max() < 1.5e-4
    assert len(found.triangles) == len(known.triangles)
    share = np.zeros((2, len(found.positions_m), len(plain.skeleton.names)))
    for row, (mesh, at) in enumerate(((known, nearest), (found, np.arange(len(nearest))))):
        for column in range(mesh.joints.shape[1]):
            np.add.at(share[row], (np.arange(len(at)), mesh.joints[at, column]), mesh.weights[at, column])
    # Weights of 8 bits, and some places that two vertices share.
    assert np.mean(np.abs(share[0] - share[1]).max(axis=1) < 0.02) > 0.99


def test_content_and_not_the_suffix_says_what_a_file_is(tmp_path: Path) -> None:
    for source, name in ((PACKED["draco"], "a.fbx"), (CHARACTERS / "child_mixamo.fbx", "b.glb"), (PLAIN, "c.vrm")):
        shutil.copy(source, tmp_path / name)
        assert len(load_character(tmp_path / name).skeleton.names) > 50


def changed(kind: str, change: Any) -> bytes:
    document, binary = split(PACKED[kind].read_bytes(), "x")
    assert binary is not None
    data = bytearray(binary)
    change(document, data)
    return _joined(document, bytes(data))


def first_part(kind: str, document: dict[str, Any]) -> dict[str, Any]:
    if kind == "meshopt":
        part: dict[str, Any] = document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]
        return part
    packed = document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
    view: dict[str, Any] = document["bufferViews"][packed["bufferView"]]
    return view


@pytest.mark.parametrize("kind", PACKED)
def test_damage_of_a_compressed_part_is_named(kind: str) -> None:
    def overwrite(document: dict[str, Any], data: bytearray) -> None:
        start = first_part(kind, document)["byteOffset"]
        data[start : start + 200] = b"\xa5" * 200

    with pytest.raises(FileError) as raised:
        decode_gltf(changed(kind, overwrite), "bad.glb")
    assert raised.value.message.id == "gltf.packed_damaged"
    assert kind in str(raised.value.message.arguments["what"])


@pytest.mark.parametrize(
    ("member", "value", "problem"),
    [
        ("count", 10**9, "gltf.too_large"),
        ("byteStride", 10**6, "gltf.damaged"),
        ("byteLength", 10**9, "gltf.damaged"),
        ("mode", "SONGS", "gltf.damaged"),
        ("filter", "FLUTES", "gltf.damaged"),
        ("buffer", 9, "gltf.damaged"),
    ],
)
def test_what_a_compressed_view_asks_for_is_checked_before_it_is_unpacked(
    member: str, value: object, problem: str
) -> None:
    def ask(document: dict[str, Any], data: bytearray) -> None:
        first_part("meshopt", document)[member] = value

    with pytest.raises(FileError) as raised:
        decode_gltf(changed("meshopt", ask), "bad.glb")
    assert raised.value.message.id == problem


def test_parts_that_become_more_than_they_may_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.formats.gltf.packed.FREE_BYTES", 1000)
    monkeypatch.setattr("app.formats.gltf.packed.MOST_TIMES", 0)
    for path in PACKED.values():
        with pytest.raises(FileError, match="too_large"):
            read_glb(path)


def test_a_missing_library_is_named_with_the_extension_and_a_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.formats.gltf.packed.read_by_child", lambda *args: (NO_READER, b"meshopt"))
    with pytest.raises(FileError) as raised:
        read_glb(PACKED["meshopt"])
    assert raised.value.message.id == "gltf.no_unpacker"
    assert raised.value.message.arguments["what"] == "EXT_meshopt_compression"
    assert raised.value.message.arguments["package"] == "meshopt"


def test_a_view_that_may_be_read_without_unpacking_is() -> None:
    """The extension is used but not required: the uncompressed buffer is included."""
    values = np.arange(12, dtype=np.float32).reshape(4, 3)
    packed = meshopt.encode_gltf_buffer(values, "ATTRIBUTES")
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["EXT_meshopt_compression"],
        "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": values.nbytes + len(packed)}],
        "bufferViews": [
            {
                "buffer": 0,
                "byteLength": values.nbytes,
                "extensions": {
                    "EXT_meshopt_compression": {
                        "buffer": 0, "byteOffset": values.nbytes, "byteLength": len(packed), "byteStride": 12,
                        "count": 4, "mode": "ATTRIBUTES",
                    }
                },
            }
        ],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    }  # fmt: skip
    for required in ([], ["EXT_meshopt_compression"]):
        document["extensionsRequired"] = required
        text = json.loads(json.dumps(document))
        model = decode_gltf(_joined(text, values.tobytes() + packed), "x.glb")
        np.testing.assert_array_equal(model.meshes[0].primitives[0].positions, values)
