"""Textures of written files as Blender's importers show them."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.usd import write_usd
from tests.support import readers
from tests.support.textured import letter, textured_scene

_SCRIPT = """
import json, sys, bpy
path, importer = sys.argv[1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
{'glb': bpy.ops.import_scene.gltf, 'fbx, Python': bpy.ops.import_scene.fbx, 'fbx, C++': bpy.ops.wm.fbx_import,
 'usdc': bpy.ops.wm.usd_import}[importer](filepath=path)
(material,) = (m for m in bpy.data.materials if m.name == 'card')
(surface,) = (n for n in material.node_tree.nodes if n.type == 'BSDF_PRINCIPLED')
def image(socket):
    nodes = [link.from_node for link in socket.links]
    while nodes:
        node = nodes.pop(0)
        if node.type == 'TEX_IMAGE':
            return node.image
        nodes += [link.from_node for one in node.inputs for link in one.links]
found = {name: image(surface.inputs[name]) for name in ('Base Color', 'Normal', 'Roughness', 'Alpha')}
color = found['Base Color']
pixels = [color.pixels[4 * (y * 64 + x):4 * (y * 64 + x) + 4] for x, y in ((6, 58), (58, 6), (6, 6))]
(mesh,) = (o for o in bpy.data.objects if o.type == 'MESH' and len(o.data.vertices) == 4)
corners = {tuple(round(v, 3) for v in uv.uv): list(mesh.matrix_world @ mesh.data.vertices[loop.vertex_index].co)
           for uv, loop in zip(mesh.data.uv_layers.active.data, mesh.data.loops)}
spaces = {name: one and one.colorspace_settings.name for name, one in found.items()}
print('FOUND' + json.dumps({'spaces': spaces, 'pixels': pixels, 'top_left': corners[0.0, 1.0],
                            'bottom_right': corners[1.0, 0.0]}))
"""


def blender(path: Path, importer: str) -> dict[str, Any]:
    if not readers.installed("blender"):
        pytest.skip("the reader blender is not installed")
    pythons = [os.environ.get("SUISOU_BLENDER_PYTHON", ""), *os.environ.get("CHECK_ANIM_PYTHONS", "").split(":")]
    for python in dict.fromkeys(pythons):
        if Path(python).is_file():
            command = [python, "-c", _SCRIPT, str(path), importer]
            for line in subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines():
                if line.startswith("FOUND"):
                    found: dict[str, Any] = json.loads(line.removeprefix("FOUND"))
                    return found
    raise AssertionError("Blender read nothing")


@pytest.mark.readers
@pytest.mark.parametrize("importer", ["glb", "fbx, Python", "fbx, C++", "usdc"])
def test_a_letter_is_read_the_right_way_round(importer: str, tmp_path: Path) -> None:
    path = tmp_path / f"card.{importer.split(',')[0]}"
    {"glb": write_glb, "fbx": write_scene, "usdc": write_usd}[path.suffix[1:]](path, textured_scene())
    found = blender(path, importer)
    data, rough = "Non-Color", None if importer == "fbx, Python" else "Non-Color"
    assert found["spaces"]["Base Color"] == "sRGB"
    assert found["spaces"]["Normal"] == data
    assert found["spaces"]["Roughness"] == rough
    assert found["spaces"]["Alpha"] is not None
    # Rows from the bottom: the letter is at the upper left, the transparent part at the lower right.
    picture = letter()[::-1] / 255.0
    for shown, (x, y) in zip(found["pixels"], ((6, 58), (58, 6), (6, 6)), strict=True):
        assert np.allclose(shown[3], picture[y, x, 3], atol=0.01)
        assert shown[3] < 0.5 or np.allclose(shown, picture[y, x], atol=0.01)
    # Blender has Z up.
    assert found["top_left"] == pytest.approx([-0.1, 0.0, 0.2], abs=1e-4)
    assert found["bottom_right"] == pytest.approx([0.1, 0.0, 0.0], abs=1e-4)
