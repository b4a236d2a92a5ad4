"""Bones and upright orientation of a figure, derived from its weights."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.rig.characters.t_pose import heaviest, rest_of, turned_figure, upright
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


PLACES_M = {
    "hips": (0.0, 1.0, 0.0),
    "head": (0.0, 1.6, 0.02),
    "leftUpperLeg": (0.1, 0.9, 0.0),
    "rightUpperLeg": (-0.1, 0.9, 0.0),
    "leftUpperArm": (0.2, 1.4, 0.0),
    "rightUpperArm": (-0.2, 1.4, 0.0),
}


@pytest.mark.parametrize("right_angle", range(0, 24, 5))
@pytest.mark.parametrize(
    ("askew_deg", "kept_deg"), [(0.0, 0.0), (12.0, 12.0), (-18.0, -18.0), (25.0, 0.0), (-40.0, 0.0)]
)
def test_a_figure_faces_ahead_and_only_what_stands_clearly_askew_is_turned_by_less_than_a_right_angle(
    right_angle: int, askew_deg: float, kept_deg: float
) -> None:
    bones = {name: index for index, name in enumerate(PLACES_M)}
    places = np.array(list(PLACES_M.values()))
    still = np.tile([0.0, 0.0, 0.0, 1.0], (len(places), 1))
    figure = Figure("a.glb", "gltf", tuple(bones), (-1,) * len(bones), places, still, ())
    fallen = Rotation.create_group("O")[right_angle] * Rotation.from_euler("y", askew_deg, degrees=True)
    stood_up = upright(turned_figure(figure, fallen.as_matrix()), bones)
    expected = Rotation.from_euler("y", kept_deg, degrees=True).apply(places)
    # The head leans a little: the trunk's own upright is not the file's.
    np.testing.assert_allclose(rest_of(stood_up).positions_m, expected, atol=0.06 if kept_deg != askew_deg else 1e-6)
