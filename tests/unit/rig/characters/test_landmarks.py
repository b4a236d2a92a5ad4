"""Landmarks found by geometry lie where our own characters' named ones are."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.characters.landmarks import found_landmarks
from app.rig.characters.t_pose import heaviest
from app.rig.figure import Figure
from app.rig.model import Character
from app.rig.skeleton import JointTransforms, forward
from app.rig.skinning import landmark_positions, mesh_named, patch, skin_matrices

TOLERANCE_M = {"thumb": 0.008, "pad": 0.006, "side": 0.006, "palm": 0.006, "lips": 0.008, "sole": 0.03}


def normal(character: Character, name: str, transforms: JointTransforms) -> np.ndarray:
    """Mean outward unit normal (3,) of a landmark at the first frame."""
    landmark = character.landmarks[name]
    part = patch(character, mesh_named(character, landmark.mesh), landmark.vertices)
    turns = skin_matrices(part.joints, part.joint_from_mesh, transforms)[0, :, :, :3]
    mean: np.ndarray = np.einsum("vj,jab,vb->a", part.weights, turns, part.normals)
    return mean / np.linalg.norm(mean)


@pytest.mark.parametrize("id", bundled_characters())
def test_what_is_found_lies_on_what_is_named(id: str) -> None:
    named = character_named(id)
    found = found_landmarks(named.skeleton, named.joint_from_mesh, named.meshes)
    assert set(named.landmarks) <= set(found)
    bare = Character(named.id, named.skeleton, named.joint_from_mesh, named.meshes, found)
    still = forward(named.skeleton, np.tile([0.0, 0.0, 0.0, 1.0], (1, len(named.skeleton.names), 1)))
    names = sorted(name for name in named.landmarks if not name.endswith(".hand"))
    off = np.linalg.norm(landmark_positions(bare, names, still) - landmark_positions(named, names, still), axis=2)[0]
    for name, distance in zip(names, off, strict=True):
        bound = next(bound for part, bound in TOLERANCE_M.items() if part in name)
        assert distance <= bound, name
    # Thumbs point their own way in every rig: only the fingers' pads are sure to face as named.
    pads = [name for name in names if name.endswith(".pad") and "thumb" not in name]
    alike = [float(normal(bare, name, still) @ normal(named, name, still)) for name in pads]
    assert np.degrees(np.arccos(np.clip(alike, -1.0, 1.0))).max() < 35.0


def test_a_vertex_is_held_by_the_bone_with_most_of_its_weight() -> None:
    mesh = SimpleNamespace(
        positions_m=np.arange(9.0).reshape(3, 3),
        weights=np.array([[0.2, 0.8], [0.7, 0.3], [0.5, 0.5]]),
        joints=np.array([[4, 9], [4, 9], [7, 2]]),
    )
    points, bones = heaviest(cast(Figure, SimpleNamespace(meshes=(mesh, mesh))))
    assert points.tolist() == 2 * mesh.positions_m.tolist()
    assert bones.tolist() == 2 * [9, 4, 7]
