"""Smoothing groups against meshes whose edges are known."""

from __future__ import annotations

import numpy as np
import pytest

from app.formats.fbx.geometry import geometry
from app.formats.fbx.smoothing import smoothing_groups
from app.formats.scene import Material, SkinnedMesh


def mesh_of(vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> SkinnedMesh:
    count = len(vertices)
    return SkinnedMesh(
        "m", vertices, faces, normals, None, (Material("m", (1.0, 1.0, 1.0, 1.0)),), None,
        np.zeros((count, 1), int), np.ones((count, 1)), np.eye(4)[None],
    )  # fmt: skip


def box() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Six sides of two triangles each, with vertices of their own; normals of the sides."""
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
