"""Signed distances compared with a slow reference: the nearest point of a dense sampling of the surface."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from app.rig.grip.instrument_proxy import signed_distance
from instrument_maps.hold import Box, Capsule, Cone, Cylinder, Proxy, Ring


def mesh_of(shape: Proxy) -> trimesh.Trimesh:
    match shape:
        case Capsule():
            height = float(np.linalg.norm(np.subtract(shape.b_m, shape.a_m)))
            mesh = trimesh.creation.capsule(height, shape.radius_m, count=[64, 64]).convex_hull
            mesh.apply_translation([0, 0, -mesh.bounds[0][2] - shape.radius_m])
        case Cylinder():
            height = float(np.linalg.norm(np.subtract(shape.b_m, shape.a_m)))
            mesh = trimesh.creation.cylinder(shape.radius_m, height, sections=128)
            mesh.apply_translation([0, 0, height / 2])
        case Cone():
            height = float(np.linalg.norm(np.subtract(shape.b_m, shape.a_m)))
            profile = [[0, 0], [shape.radius_a_m, 0], [shape.radius_b_m, height], [0, height]]
            mesh = trimesh.creation.revolve(profile, sections=128)
        case Ring():
            mesh = trimesh.creation.torus(shape.radius_m, shape.tube_radius_m, major_sections=96, minor_sections=48)
            to_axis = trimesh.geometry.align_vectors([0, 0, 1], shape.axis)
            mesh.apply_transform(to_axis)
            mesh.apply_translation(shape.centre_m)
            return mesh
        case Box():
            mesh = trimesh.creation.box(2 * np.asarray(shape.half_m))
            frame = np.eye(4)
            frame[:3, 0], frame[:3, 1] = shape.x_axis, shape.y_axis
            frame[:3, 2] = np.cross(shape.x_axis, shape.y_axis)
            frame[:3, 3] = shape.centre_m
            mesh.apply_transform(frame)
            return mesh
    direction = np.subtract(shape.b_m, shape.a_m)
    mesh.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], direction))
    mesh.apply_translation(shape.a_m)
    return mesh


def winding_numbers(mesh: trimesh.Trimesh, points: np.ndarray) -> np.ndarray:
    """Generalised winding number (van Oosterom and Strackee 1983): 1 inside a closed mesh, 0 outside."""
    a, b, c = (mesh.triangles[None, :, i] - points[:, None] for i in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    numerator = np.einsum("pti,pti->pt", a, np.cross(b, c))
    dot = np.einsum
    denominator = (
        la * lb * lc + dot("pti,pti->pt", a, b) * lc + dot("pti,pti->pt", b, c) * la + dot("pti,pti->pt", c, a) * lb
    )
    return 2 * np.arctan2(numerator, denominator).sum(axis=1) / (4 * np.pi)


A, B = (0.01, 0.02, -0.01), (0.03, -0.01, 0.04)
X = (0.6, 0.8, 0.0)
Y = (-0.8, 0.6, 0.0)


@pytest.mark.parametrize(
    "shape",
    [
        Capsule("root", A, B, 0.012),
        Cylinder("root", A, B, 0.012),
        Cone("root", A, B, 0.02, 0.006),
        Cone("root", A, B, 0.004, 0.03),
        Ring("root", A, (0.0, 0.6, 0.8), 0.03, 0.008),
        Box("root", A, (0.03, 0.01, 0.02), X, Y),
    ],
    ids=lambda shape: type(shape).__name__,
)
def test_against_a_mesh(shape: Proxy) -> None:
    mesh = mesh_of(shape)
    assert mesh.is_watertight
    random = np.random.default_rng(1)
    points = random.uniform(-0.06, 0.07, (150, 3))
    inner = mesh.sample(50, seed=1)
    points = np.concatenate([points, inner * 0.9 + mesh.centroid * 0.1])
    nearest, distance, _ = trimesh.proximity.closest_point_naive(mesh, points)
    assert nearest.shape == points.shape
    signs = np.where(winding_numbers(mesh, points) > 0.5, -1.0, 1.0)
    ours = signed_distance(shape, points)
    clear = distance > 3e-4  # the mesh is a polyhedron: signs near its faces may differ
    np.testing.assert_allclose(np.abs(ours), distance, atol=2.5e-4)
    np.testing.assert_array_equal(np.sign(ours[clear]), signs[clear])


def test_shapes_of_points_are_kept() -> None:
    points = np.zeros((4, 5, 3), np.float32)
    for shape in (Capsule("r", A, B, 0.01), Cone("r", A, B, 0.01, 0.02), Box("r", A, (1, 1, 1), X, Y)):
        distance = signed_distance(shape, points)
        assert distance.shape == (4, 5)
        assert distance.dtype == np.float32
