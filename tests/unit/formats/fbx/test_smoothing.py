"""Smoothing groups of meshes with known edges."""

from __future__ import annotations

import json
import os
import subprocess
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.formats.fbx.geometry import geometry
from app.formats.fbx.smoothing import smoothing_groups
from app.formats.fbx.write import write_scene
from app.formats.scene import Bone, Clip, Material, Scene, SkinnedMesh


def mesh_of(vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> SkinnedMesh:
    count = len(vertices)
    return SkinnedMesh(
        "m", vertices, faces, normals, None, (Material("m", (1.0, 1.0, 1.0, 1.0)),), None,
        np.zeros((count, 1), int), np.ones((count, 1)), np.eye(4)[None],
    )  # fmt: skip


def box() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Six sides of two triangles each with separate vertices, and the normals of the sides."""
    vertices, faces, normals = [], [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            across, along = np.roll(normal, 1), np.roll(normal, 2)
            first = len(vertices)
            vertices += [normal + a * across + b * along for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
            normals += [normal] * 4
    return np.array(vertices), np.array(faces), np.array(normals)


def test_the_sides_of_a_box_are_apart_and_each_is_one() -> None:
    groups = smoothing_groups(mesh_of(*box()))
    sides = groups.reshape(6, 2)
    assert (sides[:, 0] == sides[:, 1]).all()
    for one in range(6):
        for other in range(6):
            opposite = one // 2 == other // 2
            if one != other and not opposite:
                assert not sides[one, 0] & sides[other, 0], "sides that meet at a hard edge share no group"
    assert (groups > 0).all()


@pytest.mark.parametrize("corners", [False, True])
def test_a_smooth_box_is_one_surface(corners: bool) -> None:
    vertices, faces, _ = box()
    normals = vertices / np.sqrt(3.0)
    mesh = mesh_of(vertices, faces, normals[faces].reshape(-1, 3) if corners else normals)
    assert set(smoothing_groups(mesh).tolist()) == {1}


def test_a_file_has_them() -> None:
    mesh = mesh_of(*box())
    (layer,) = [one for one in geometry(mesh) if one.name == "LayerElementSmoothing"]
    (values,) = [one.properties[0] for one in layer.children if one.name == "Smoothing"]
    np.testing.assert_array_equal(np.asarray(values), smoothing_groups(mesh))


IN_BLENDER = """
import json, sys
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.fbx_import(filepath=sys.argv[1])
(mesh,) = (one.data for one in bpy.data.objects if one.type == "MESH")
sides = [[list(mesh.corner_normals[corner].vector) for corner in face.loop_indices] for face in mesh.polygons]
print("NORMALS " + json.dumps(sides))
"""


@pytest.mark.readers
@pytest.mark.parametrize("smooth", [False, True], ids=["hard", "smooth"])
def test_blender_keeps_edges_hard_or_smooth(smooth: bool, tmp_path: Path) -> None:
    python = os.environ.get("SUISOU_BLENDER_PYTHON", "")
    if not Path(python).is_file():
        pytest.skip("no Blender: SUISOU_BLENDER_PYTHON names no interpreter that has bpy")
    vertices, faces, normals = box()
    if smooth:
        normals = vertices / np.sqrt(3.0)
    bone = Bone("root", -1, np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]))
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (2, 1, 1))
    write_scene(
        tmp_path / "box.fbx", Scene((bone,), (mesh_of(vertices, faces, normals),), Clip("c", Fraction(30), 2, turns))
    )
    command = [python, "-c", IN_BLENDER, str(tmp_path / "box.fbx")]
    answer = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    (line,) = (line for line in answer.splitlines() if line.startswith("NORMALS "))
    shown = np.array(json.loads(line[8:]))
    assert shown.shape == (12, 3, 3)
    # Corners may be numbered otherwise; the normals of a side's corners are alike or one for each of its corners.
    for triangle, found in zip(faces, shown, strict=True):
        expected = normals[triangle]
        off = np.linalg.norm(found[:, None] - expected[None], axis=-1)
        assert off.min(axis=1).max() < 1e-3
