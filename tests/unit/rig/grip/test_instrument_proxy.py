"""Signed distances of collision bodies: slope 1, and a step of that length along the slope ends on the surface."""

import numpy as np
import pytest

from app.rig.grip import instrument_proxy
from instrument_maps.hold import Box, Capsule, Cone, Cylinder, Proxy, Ring

SHAPES: list[Proxy] = [
    Cone("root", (0.0, 0.0, 0.0), (0.01, 0.02, 0.05), 0.02, 0.005),
    Cylinder("root", (0.0, 0.1, 0.0), (0.03, 0.1, 0.0), 0.01),
    Capsule("root", (0.0, 0.0, 0.1), (0.02, 0.0, 0.12), 0.01),
    Ring("root", (0.1, 0.0, 0.0), (0.0, 0.0, 1.0), 0.02, 0.006),
    Box("root", (0.0, -0.1, 0.0), (0.01, 0.02, 0.03), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
]


REST = instrument_proxy.InstrumentNodes(np.zeros((1, 3)), np.eye(3)[None])


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_a_step_of_the_distance_along_the_slope_ends_on_the_surface(shape: Proxy) -> None:
    some = instrument_proxy.bodies([shape], ["root"])
    points = np.random.default_rng(3).uniform(-0.15, 0.15, size=(3000, 3))
    far = instrument_proxy.distance(some, REST, points)
    slope = instrument_proxy.gradient(some, REST, points, np.zeros(len(points), dtype=np.intp))
    # On the ridges inside a body the slope jumps; outside it never does.
    outside = far > 1e-4
    np.testing.assert_allclose(np.linalg.norm(slope[outside], axis=1), 1.0, atol=1e-5)
    landed = points - slope * far[:, None]
    np.testing.assert_allclose(instrument_proxy.distance(some, REST, landed[outside]), 0.0, atol=1e-7)


def test_a_point_is_inside_where_the_union_says_so_and_as_deep() -> None:
    some = instrument_proxy.bodies(SHAPES, ["root"])
    points = np.random.default_rng(4).uniform(-0.12, 0.12, size=(20000, 3))
    depth, owner = instrument_proxy.inside(some, REST, points, np.zeros(len(points)))
    far = instrument_proxy.distance(some, REST, points)
    np.testing.assert_allclose(depth, np.maximum(-far, 0.0), atol=1e-12)
    assert np.count_nonzero(depth) > 50
    np.testing.assert_array_equal(owner >= 0, depth > 0.0)
    radius = np.random.default_rng(5).uniform(0.0, 0.03, size=len(points))
    reached, _ = instrument_proxy.inside(some, REST, points, radius)
    np.testing.assert_allclose(reached, np.maximum(radius - far, 0.0), atol=1e-12)


def test_bodies_move_with_their_nodes() -> None:
    some = instrument_proxy.bodies([Capsule("a", (0.0, 0.0, 0.0), (0.0, 0.0, 0.1), 0.01)], ["root", "a"])
    places, turns = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]), np.tile(np.eye(3), (2, 1, 1))
    turns[1] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
    nodes = instrument_proxy.InstrumentNodes(places, turns)
    points = np.array([[0.55, 0.0, 0.0], [0.5, 0.0, 0.05], [0.55, 0.008, 0.0]])
    depth, owner = instrument_proxy.inside(some, nodes, points, np.zeros(3))
    np.testing.assert_allclose(depth, [0.01, 0.0, 0.002], atol=1e-12)
    slope = instrument_proxy.gradient(some, nodes, points[2:], owner[2:])
    np.testing.assert_allclose(slope, [[0.0, 1.0, 0.0]], atol=1e-6)


def test_far_bodies_are_left_out() -> None:
    some = instrument_proxy.bodies(SHAPES, ["root"])
    close = instrument_proxy.near(some, np.zeros((1, 3)), np.array([0.0, 0.0, 0.11]), 0.02)
    assert len(close.capsules) == 1
    assert len(close) == 1
