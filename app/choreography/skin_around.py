"""Skin around joints of a character, and its outermost vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from app.rig.skinning import Skin, skin_of

_DIRECTIONS: Final = np.array([way for way in product((-1.0, 0.0, 1.0), repeat=3) if any(way)])
"""Directions (26, 3) in which the outermost vertices are found."""


@dataclass(frozen=True, eq=False)
class SkinAround:
    """Vertices of a mesh whose greatest weight is that of one of some joints.

    Attributes
    ----------
    rows : (V,) int
        Indices of the vertices in the mesh.
    joints : (V,) int
        Joint of the greatest weight.
    rest_m : (V, 3) float64
        Positions in the T-pose in metres.
    """

    mesh: Mesh
    joint_from_mesh: FloatArray
    rows: IndexArray
    joints: IndexArray
    rest_m: FloatArray

    def outermost(self, of: BoolArray) -> IndexArray:
        """Return the places in the arrays of the outermost ones of some vertices ``of`` (V,)."""
        places = np.flatnonzero(of)
        return np.asarray(places[np.unique((self.rest_m[places] @ _DIRECTIONS.T).argmax(axis=0))])

    def skin(self, places: IndexArray) -> Skin:
        """Return the vertices at some places in the arrays, prepared for deformation."""
        return _skin(self.mesh, self.rows[places], self.joint_from_mesh)


def skin_around(character: Character, joints: Sequence[int]) -> list[SkinAround]:
    """Return the skin around joints, by mesh; meshes without any are left out."""
    at_rest = np.tile(np.eye(4), (1, len(character.skeleton.names), 1, 1))
    at_rest[0, :, :3, 3] = rest_positions(character.skeleton)
    found = []
    for mesh in character.meshes:
        most = mesh.joints[np.arange(len(mesh.joints)), mesh.weights.argmax(axis=1)]
        rows = np.flatnonzero(np.isin(most, joints))
        if len(rows):
            rest_m = _skin(mesh, rows, character.joint_from_mesh).deformed(at_rest)[0]
            found.append(SkinAround(mesh, character.joint_from_mesh, rows, most[rows], rest_m))
    return found


def _skin(mesh: Mesh, rows: IndexArray, joint_from_mesh: FloatArray) -> Skin:
    weights = mesh.weights[rows].astype(np.float64)
    return skin_of(rows, mesh.positions_m, mesh.joints[rows], weights, joint_from_mesh, ())
