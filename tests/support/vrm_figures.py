"""VRM figures for the readers of VRM animations: GLB files with the extension of VRM 1.0."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from app.formats.gltf.vrma import PRESETS


def document_of(path: Path) -> tuple[dict[str, Any], bytes]:
    """JSON document of a GLB and the bytes of its binary chunk."""
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def write_document(path: Path, document: dict[str, Any], binary: bytes) -> Path:
    """Write a GLB."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


def as_vrm(
    glb: Path, to: Path, bones: Mapping[str, str], expressions: Mapping[str, Sequence[str]] | None = None
) -> Path:
    """Write a GLB as a VRM 1.0 figure whose eye bones rotate by the full angle of the gaze.

    Parameters
    ----------
    bones : mapping of str to str
        Names of the nodes by humanoid bone.
    expressions : mapping of str to sequence of str, optional
        Names of morphs by expression.
    """
    document, binary = document_of(glb)
    nodes = {node.get("name"): number for number, node in enumerate(document["nodes"])}
    document.pop("animations", None)
    meshes = [(number, node["mesh"]) for number, node in enumerate(document["nodes"]) if "mesh" in node]
    names = {number: document["meshes"][mesh].get("extras", {}).get("targetNames", []) for number, mesh in meshes}
    faces: dict[str, dict[str, Any]] = {"preset": {}, "custom": {}}
    for expression, morphs in (expressions or {}).items():
        binds = [
            {"node": node, "index": targets.index(morph), "weight": 1.0}
            for morph in morphs
            for node, targets in names.items()
            if morph in targets
        ]
        faces["preset" if expression in PRESETS else "custom"][expression] = {"morphTargetBinds": binds}
    turns = {"inputMaxValue": 90.0, "outputScale": 90.0}
    sides = ("HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp")
    document["extensionsUsed"] = ["VRMC_vrm"]
    document["extensions"] = {
        "VRMC_vrm": {
            "specVersion": "1.0",
            "meta": {"name": "test", "authors": ["test"], "licenseUrl": "https://vrm.dev/licenses/1.0/"},
            "humanoid": {"humanBones": {bone: {"node": nodes[name]} for bone, name in bones.items() if name in nodes}},
            "lookAt": {"type": "bone", "offsetFromHeadBone": [0.0, 0.06, 0.0]}
            | {f"rangeMap{side}": turns for side in sides},
            "expressions": faces,
        }
    }
    return write_document(to, document, binary)
