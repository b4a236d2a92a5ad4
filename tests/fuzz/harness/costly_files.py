"""Small files that require far more memory or time than their size suggests, one for each known cause."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.formats.fbx import encode
from app.formats.fbx.encode import Element, PackedArray
from metadata.model import REQUIRED_JOINTS
from tests.fuzz.harness.costly_media import COSTLY_RECORDINGS, m4a_minutes
from tests.fuzz.harness.costly_sound import COSTLY_SOUND, flac_steps
from tests.support.encoded import encode_elements

ABOVE: Final = {
    "spine": "hips", "head": "spine", "leftUpperArm": "spine", "rightUpperArm": "spine",
    **{f"{side}{low}": f"{side}{high}" for side in ("left", "right") for low, high in
       (("LowerArm", "UpperArm"), ("Hand", "LowerArm"), ("LowerLeg", "UpperLeg"), ("Foot", "LowerLeg"))},
    "leftUpperLeg": "hips", "rightUpperLeg": "hips",
}  # fmt: skip
PLACES: Final = {
    "hips": (0.0, 1.0, 0.0), "spine": (0.0, 0.3, 0.0), "head": (0.0, 0.3, 0.0),
    **{f"{side}{part}": (sign * x, y, 0.0) for side, sign in (("left", 1.0), ("right", -1.0)) for part, x, y in
       (("UpperArm", 0.15, 0.2), ("LowerArm", 0.25, 0.0), ("Hand", 0.25, 0.0),
        ("UpperLeg", 0.1, 0.0), ("LowerLeg", 0.0, -0.45), ("Foot", 0.0, -0.45))},
}  # fmt: skip
"""Joints of a figure that can play, relative to the joint above, so that the cost of using it counts too."""


# glTF


def glb(document: dict[str, Any], binary: bytes = b"") -> bytes:
    """A GLB file."""
    document = {"asset": {"version": "2.0"}, **document}
    if binary:
        document["buffers"] = [{"byteLength": len(binary)}]
        document.setdefault("bufferViews", [{"buffer": 0, "byteLength": len(binary)}])
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def figure(*more: dict[str, Any]) -> dict[str, Any]:
    """Nodes of a figure, and others without a parent."""
    joints = sorted(REQUIRED_JOINTS, key=lambda joint: (joint != "hips", joint))
    nodes: list[dict[str, Any]] = [{"name": joint, "translation": PLACES[joint]} for joint in joints]
    for number, joint in enumerate(joints):
        if joint in ABOVE:
            nodes[joints.index(ABOVE[joint])].setdefault("children", []).append(number)
    bones = {joint: {"node": number} for number, joint in enumerate(joints)}
    return {"nodes": [*nodes, *more], "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": bones}}}}


def _accessor(count: int, type_: str = "VEC3", **more: Any) -> dict[str, Any]:
    return {"componentType": 5121, "type": type_, "count": count, **more}


def _mesh(*primitives: dict[str, Any]) -> list[dict[str, Any]]:
    return [{"primitives": list(primitives)}]


_POSITION: Final = {"attributes": {"POSITION": 0}}
_ZEROS: Final = 2**22


def glb_zeros(size: int) -> bytes:
    """Parts whose vertices are all zeros, which cost the file nothing."""
    parts = [{"attributes": {"POSITION": 0}, "material": 0}] * (size // 45)
    return glb({**figure({"mesh": 0}), "materials": [{}], "accessors": [_accessor(_ZEROS)], "meshes": _mesh(*parts)})


def glb_strips(size: int) -> bytes:
    """Strips of triangles between zeros: three times as many corners as indices."""
    accessors = [_accessor(3), _accessor(_ZEROS, "SCALAR")]
    parts = [{**_POSITION, "indices": 1, "mode": 5 + number % 2} for number in range(size // 55)]
    return glb({**figure({"mesh": 0}), "accessors": accessors, "meshes": _mesh(*parts)})


def glb_bind_poses(size: int) -> bytes:
    """Skins of one joint with millions of bind matrices."""
    skins = [{"joints": [0], "inverseBindMatrices": 0}] * (size // 40)
    return glb({**figure(), "accessors": [_accessor(_ZEROS, "MAT4")], "skins": skins})


def glb_joint_sets(size: int) -> bytes:
    """Vertices with hundreds of sets of joints."""
    sets = range(size // 30)
    attributes = {"POSITION": 0, **{f"{name}_{number}": 1 for number in sets for name in ("JOINTS", "WEIGHTS")}}
    accessors = [_accessor(2**18), _accessor(2**18, "VEC4")]
    whole = figure({"mesh": 0, "skin": 0})
    return glb(
        {**whole, "accessors": accessors, "skins": [{"joints": [0]}], "meshes": _mesh({"attributes": attributes})}
    )


def glb_overlap(size: int) -> bytes:
    """Many accessors of the same bytes."""
    data, parts = os.urandom(size // 2), range(size // 2 // 95)
    accessors = [_accessor((len(data) - 2) // 3, bufferView=0, byteOffset=number % 3) for number in parts]
    meshes = _mesh(*({"attributes": {"POSITION": number}} for number in parts))
    return glb({**figure({"mesh": 0}), "accessors": accessors, "meshes": meshes}, data)


def glb_instances(size: int) -> bytes:
    """One mesh on thousands of nodes."""
    data = os.urandom(size // 2)
    shown = [{"mesh": 0}] * (size // 2 // 11)
    return glb(
        {**figure(*shown), "accessors": [_accessor(len(data) // 3, bufferView=0)], "meshes": _mesh(_POSITION)}, data
    )


def glb_morphs(size: int) -> bytes:
    """One change of all vertices as thousands of morph targets."""
    data = os.urandom(size // 2)
    part = {**_POSITION, "targets": [{"POSITION": 0}] * (size // 2 // 15)}
    return glb(
        {**figure({"mesh": 0}), "accessors": [_accessor(len(data) // 3, bufferView=0)], "meshes": _mesh(part)}, data
    )


def glb_parts(size: int) -> bytes:
    """Thousands of parts with a triangle each, that must be distinguished."""
    data = np.arange(size // 200 * 9, dtype="<f4").tobytes()
    parts = range(len(data) // 36)
    accessors = [
        {"bufferView": 0, "byteOffset": 36 * number, "componentType": 5126, "type": "VEC3", "count": 3}
        for number in parts
    ]
    meshes = _mesh(*({"attributes": {"POSITION": number}} for number in parts))
    return glb({**figure({"mesh": 0}), "accessors": accessors, "meshes": meshes}, data)


def glb_deep(size: int) -> bytes:
    """Deeply nested nodes."""
    whole = figure()
    first = len(whole["nodes"])
    whole["nodes"] += [{"children": [first + number + 1]} for number in range(size // 20)] + [{}]
    return glb(whole)


def glb_bones(size: int) -> bytes:
    """Thousands of bones of one name in one place, on a hand."""
    whole = figure()
    first, count = len(whole["nodes"]), min(size // 17, 4900)
    hand = next(node for node in whole["nodes"] if node["name"] == "leftHand")
    hand["children"] = list(range(first, first + count))
    whole["nodes"] += [{"name": "a"}] * count
    return glb(whole)


def glb_nameless(size: int) -> bytes:
    """Thousands of bones without names and positions, which only their shape could identify."""
    count = min(size // 14, 4900)
    top = {"children": list(range(1, count))}
    return glb({"nodes": [top, *[{}] * (count - 1)]})


def glb_pictures(size: int) -> bytes:
    """Hundreds of images of 16 million pixels each, all of the same few bytes."""
    side = 4096 if size > 5000 else 1024
    data = _png(side)
    count = max((size - len(data)) // 150, 1)
    views = [{"buffer": 0, "byteLength": len(data)}] * count
    surfaces = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": number}}} for number in range(count)]
    parts = [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": number} for number in range(count)]
    document = {
        **figure({"mesh": 0}),
        "bufferViews": views,
        "images": [{"bufferView": number} for number in range(count)],
        "textures": [{"source": number} for number in range(count)],
        "materials": surfaces,
        "accessors": [_accessor(3), {"componentType": 5126, "type": "VEC2", "count": 3}],
        "meshes": _mesh(*parts),
    }
    return glb(document, data)


def _png(side: int) -> bytes:
    """A square of black, a bit for each pixel."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = zlib.compress(bytes((side // 8 + 1) * side), 9)
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 1, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


# FBX


def fbx(objects: list[Element], connections: list[tuple[int, int]]) -> bytes:
    links = tuple(Element("C", ("OO", np.int64(child), np.int64(parent))) for child, parent in connections)
    return encode_elements(
        (
            Element("FBXHeaderExtension", (), (Element("FBXVersion", (np.int32(7400),)),)),
            Element("FileId", (encode.FILE_ID,)),
            Element("CreationTime", (encode.CREATION_TIME,)),
            Element("Objects", (), tuple(objects)),
            Element("Connections", (), links),
        )
    )


def _node(number: int, kind: str = "Mesh") -> Element:
    return Element("Model", (np.int64(number), f"m{number}\0\x01Model", kind), ())


def _geometry(faces: npt.NDArray[np.int32], points: int = 3) -> Element:
    """A mesh of equal points, packed into a thousandth of its size."""
    children = (
        Element("Vertices", (_packed(b"d", np.zeros(3 * points)),)),
        Element("PolygonVertexIndex", (_packed(b"i", faces),)),
    )
    return Element("Geometry", (np.int64(1), "g\0\x01Geometry", "Mesh"), children)


def _packed(code: bytes, values: npt.NDArray[Any]) -> PackedArray:
    data = zlib.compress(values.tobytes(), 9)
    return PackedArray(code + struct.pack("<III", len(values), 1, len(data)) + data)


def _triangles(corners: int) -> npt.NDArray[np.int32]:
    return np.tile(np.array([0, 0, -1], np.int32), max(corners // 3, 1))


def fbx_packed(size: int) -> bytes:
    """A mesh of equal points and corners."""
    return fbx([_geometry(_triangles(100 * size), 20 * size), _node(2)], [(1, 2), (2, 0)])


def fbx_instances(size: int) -> bytes:
    """One packed mesh on hundreds of nodes."""
    nodes = range(10, 10 + size // 150)
    links = [(1, number) for number in nodes] + [(number, 0) for number in nodes]
    return fbx([_geometry(_triangles(100 * size)), *map(_node, nodes)], links)


def fbx_polygon(size: int) -> bytes:
    """One polygon of millions of corners."""
    corners = np.zeros(200 * size, np.int32)
    corners[-1] = -1
    return fbx([_geometry(corners), _node(2)], [(1, 2), (2, 0)])


def fbx_deep(size: int) -> bytes:
    """Deeply nested bones."""
    nodes = range(10, 10 + size // 100)
    return fbx(
        [_node(number, "LimbNode") for number in nodes], [(number, number - 1) for number in nodes[1:]] + [(10, 0)]
    )


def fbx_nodes(size: int) -> bytes:
    """Thousands of nodes beside one another."""
    nodes = range(10, 10 + size // 100)
    return fbx([_node(number, "Null") for number in nodes], [(number, 0) for number in nodes])


def fbx_clusters(size: int) -> bytes:
    """A skin whose clusters each have a thousand packed weights of one vertex."""
    clusters = range(100, 100 + size // 260)
    weights = (Element("Indexes", (np.zeros(1000, np.int32),)), Element("Weights", (np.ones(1000),)))
    skin = Element("Deformer", (np.int64(3), "s\0\x01Deformer", "Skin"), ())
    parts = [Element("Deformer", (np.int64(number), "c\0\x01SubDeformer", "Cluster"), weights) for number in clusters]
    links = [(1, 2), (2, 0), (3, 1)]
    for number in clusters:
        links += [(number, 3), (2, number)]
    return fbx([_geometry(_triangles(3)), _node(2), skin, *parts], links)


def fbx_morphs(size: int) -> bytes:
    """Hundreds of morphs of a mesh of packed corners, each of one vertex that is at every corner."""
    morphs = range(size // 2 // 420 + 1)
    mesh = _geometry(_triangles(100 * (size // 2)), 3)
    deformer = Element("Deformer", (np.int64(3), "b\0\x01Deformer", "BlendShape"), ())
    moved = (Element("Indexes", (np.zeros(1, np.int32),)), Element("Vertices", (np.ones(3),)))
    parts, links = [mesh, _node(2), deformer], [(1, 2), (2, 0), (3, 1)]
    for number in morphs:
        channel, shape = 1000 + number, 100_000 + number
        parts.append(Element("Deformer", (np.int64(channel), "c\0\x01SubDeformer", "BlendShapeChannel"), ()))
        parts.append(Element("Geometry", (np.int64(shape), "s\0\x01Geometry", "Shape"), moved))
        links += [(channel, 3), (shape, channel)]
    return fbx(parts, links)


# Others


def bvh_still(size: int) -> bytes:
    """Thousands of joints that never move, in thousands of frames."""
    joints, frames = size // 24, size // 12
    head = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n" + "JOINT a\n{\n}\n" * joints
    return (head + f"}}\nMOTION\nFrames: {frames}\nFrame Time: 0.01\n" + "0 0 0\n" * frames).encode()


def bvh_deep(size: int) -> bytes:
    """Deeply nested joints."""
    return b"HIERARCHY\nROOT a\n{\n" + b"JOINT a\n{\n" * (size // 10)


def bvh_frames(size: int) -> bytes:
    """A number of frames that the file does not contain."""
    head = b"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\nMOTION\nFrames: "
    return head + b"9" * (size // 2) + b"\nFrame Time: 0.01\n" + b"0 0 0\n" * (size // 12)


PACKED_FBX: Final = (fbx_packed, fbx_instances, fbx_polygon, fbx_deep, fbx_nodes)
COSTLY_FILES: Final[dict[str, tuple[Callable[[int], bytes], ...]]] = {
    "gltf": (
        *(glb_zeros, glb_strips, glb_bind_poses, glb_joint_sets, glb_overlap, glb_instances, glb_morphs, glb_parts),
        *(glb_deep, glb_bones, glb_nameless, glb_pictures),
    ),
    "instrument_model": (glb_zeros, glb_instances, glb_deep),
    "foreign_fbx": (fbx_packed, fbx_instances, fbx_polygon, fbx_deep, fbx_nodes, fbx_clusters, fbx_morphs),
    "fbx": (fbx_packed, fbx_instances, fbx_polygon, fbx_deep, fbx_nodes, fbx_clusters, fbx_morphs),
    "bvh": (bvh_still, bvh_deep, bvh_frames),
    "audio": (*COSTLY_SOUND, *COSTLY_RECORDINGS),
    "followed": (flac_steps, m4a_minutes),
}
"""Functions that make costly files of about a given size in bytes, by kind of file
(`tests.fuzz.harness.readers.KINDS`).
"""
