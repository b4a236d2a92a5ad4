"""What a figure's own weights say of its bones."""

from __future__ import annotations

import numpy as np

from app.rig.characters.t_pose import heaviest
from app.rig.figure import Figure
from app.rig.mesh import Mesh


def test_a_vertex_is_held_by_the_bone_that_carries_most_of_it() -> None:
    places = np.array([[0.0, 1.0, 0.0], [0.0, 2.0, 0.0], [0.0, 3.0, 0.0]], np.float32)
    joints = np.array([[4, 7], [7, 4], [5, 4]], np.int32)
    weights = np.array([[0.3, 0.7], [0.6, 0.4], [1.0, 0.0]], np.float32)
    nothing = np.zeros((0, 3), np.int32)
    mesh = Mesh("m", places, places, places[:, :2], nothing, nothing[:, 0], (), joints, weights)
    figure = Figure("a.glb", "gltf", (), (), np.zeros((0, 3)), np.zeros((0, 4)), (mesh,))
    points, holders = heaviest(figure)
    np.testing.assert_array_equal(points, places)
    assert holders.tolist() == [7, 7, 5]
