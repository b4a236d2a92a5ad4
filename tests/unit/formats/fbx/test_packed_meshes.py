"""Meshes in their encoded form, which is computed only once."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from app.formats.fbx.packed_meshes import packed_mesh
from tests.unit.formats.scenes import character

MESH = character(Fraction(60), 2).meshes[0]


def test_a_mesh_that_holds_the_same_is_packed_once() -> None:
    again = replace(MESH, name="another", vertices_cm=np.asfortranarray(MESH.vertices_cm))
    assert packed_mesh(again) is packed_mesh(MESH)


@pytest.mark.parametrize("changed", ["vertices_cm", "faces", "normals", "uvs", "joint_indices", "weights"])
def test_a_mesh_that_differs_in_one_value_is_packed_by_itself(changed: str) -> None:
    values: Any = getattr(MESH, changed).copy()
    values.flat[-1] += 1
    assert packed_mesh(replace(MESH, **{changed: values})) is not packed_mesh(MESH)


def test_a_mesh_without_its_last_morph_is_packed_by_itself() -> None:
    fewer = packed_mesh(replace(MESH, morphs=MESH.morphs[:-1]))
    assert len(fewer.morphs) == len(packed_mesh(MESH).morphs) - 1
