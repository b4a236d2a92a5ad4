"""Shapes of straps and chairs: a string around a ball, chairs for tall and small people, outward-facing meshes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import savgol_filter

from app.formats.scene import Material
from app.rig.mesh import Mesh
from app.rig.supports.band import SurfaceStrip, mesh_of, tube
from app.rig.supports.bands_on_body import BandRoute, LegShape, evened, leg_of, tapering
from app.rig.supports.chair import ChairFit, chair
from app.rig.supports.taut_string import PosedTrunk, taut_string

RADIUS_M = 0.15
PLAIN = (Material("plain", (0.5, 0.5, 0.5, 1.0)),)


def _ball() -> PosedTrunk:
    high, around = np.meshgrid(np.linspace(0.0, np.pi, 181), np.linspace(0.0, 2.0 * np.pi, 361), indexing="ij")
    points = RADIUS_M * np.stack([np.sin(high) * np.cos(around), np.cos(high), np.sin(high) * np.sin(around)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    corners = np.concatenate([np.stack(part, axis=-2).reshape(-1, 3, 3) for part in ((a, b, c), (a, c, d))])
    return PosedTrunk(corners, points.reshape(-1, 3), np.ones((points.size // 3, 1)))


def test_a_string_over_a_ball_is_as_long_as_geometry_says() -> None:
    """Half a turn minus the tangent's angle, and then the tangent, in a plane through the centre."""
    end = np.array([0.0, 0.0, 2.0 * RADIUS_M])
    string = taut_string(_ball(), np.array([0.0, 0.0, -RADIUS_M]), np.array([0.0, RADIUS_M, 0.0]), end)
    assert string is not None
    length = np.linalg.norm(np.diff(string.points_m, axis=0), axis=1)
    arc = RADIUS_M * (math.pi - math.acos(0.5))
    assert length[: string.leaves].sum() == pytest.approx(arc, rel=0.01)
    assert length[string.leaves :].sum() == pytest.approx(math.sqrt(3.0) * RADIUS_M, rel=0.02)
    ways = (string.outwards * string.points_m).sum(axis=1)[1 : string.leaves]
    assert (ways > 0.95 * RADIUS_M).all()


def test_there_is_no_string_where_there_is_no_body() -> None:
    far = np.array([5.0, 0.0, 0.0])
    assert taut_string(_ball(), far, far + np.array([0.0, 1.0, 0.0]), far + np.array([0.0, 0.0, 1.0])) is None


MEET_M = RADIUS_M * np.array([-0.4, -0.2, 1.4])


def _around(trunk: PosedTrunk) -> LegShape | None:
    """A band around a body to ``MEET_M``."""
    up = np.array([0.0, 1.0, 0.0])
    route = BandRoute(
        RADIUS_M * np.array([0.0, 0.3, -1.0]),
        RADIUS_M * np.array([1.0, 0.0, 0.0]),
        up,
        up,
        tapering([(0.0, 0.01), (2.0, 0.01)]),
        around=True,
    )
    return leg_of(trunk, route, MEET_M, MEET_M - np.array([0.0, 0.1, 0.0]))


def test_a_band_around_the_ribs_stays_outside_the_body_up_to_its_end() -> None:
    leg = _around(_ball())
    assert leg is not None
    assert np.linalg.norm(leg.centre_m, axis=1).min() > 0.98 * RADIUS_M
    assert np.allclose(leg.centre_m[-1], MEET_M)
    # In front of a belly, which moves, a band needs room.
    leaves = leg.centre_m[leg.on_body - 1]
    made = np.concatenate([strip.points_m.reshape(-1, 3) for strip in leg.strips({0: 0}, 1)])
    near = made[np.linalg.norm(made - leaves, axis=1) < 0.02]
    assert np.linalg.norm(near, axis=1).min() > RADIUS_M + 0.010


def test_a_band_around_the_ribs_does_not_go_around_a_hem_on_the_lap() -> None:
    ball = _ball()
    turns = np.linspace(0.0, 2.0 * np.pi, 181)
    edge = 2.0 * RADIUS_M * np.stack([np.sin(turns), np.zeros(181), np.cos(turns)], axis=1)
    high, low = (edge - np.array([0.0, below * RADIUS_M, 0.0]) for below in (0.34, 0.6))
    corners = np.concatenate([np.stack([high[:-1], high[1:], low[:-1]], 1), np.stack([high[1:], low[1:], low[:-1]], 1)])
    worn = PosedTrunk(np.concatenate([ball.corners_m, corners]), ball.vertices_m, ball.weights)
    plain, over = _around(ball), _around(worn)
    assert plain is not None
    assert over is not None
    assert np.allclose(plain.centre_m, over.centre_m)


def _seen_from_outside(mesh: Mesh) -> float:
    """Share of the triangles whose orientation agrees with their corners' normals."""
    corners = mesh.positions_m.astype(np.float64)[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    solid = np.linalg.norm(faces, axis=1) > 1e-9
    normals = mesh.normals[mesh.triangles].mean(axis=1)
    return float(((faces * normals).sum(axis=1)[solid] > 0.0).mean())


def _volume_m3(mesh: Mesh) -> float:
    corners = mesh.positions_m.astype(np.float64)[mesh.triangles]
    return float(np.einsum("ti,ti->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0)


@pytest.mark.parametrize(("top_m", "size"), [(0.50, 1.1), (0.44, 1.0), (0.27, 0.62)])
def test_a_chair_stands_on_the_floor_as_high_as_its_sitter_needs(top_m: float, size: float) -> None:
    fit = ChairFit(top_m, -0.15, size)
    mesh = chair(fit, 3)
    assert mesh.positions_m[:, 1].min() == pytest.approx(0.0, abs=1e-4)
    under = np.abs(mesh.positions_m[:, 2] - fit.middle_m[2]) < 0.05
    assert mesh.positions_m[under, 1].max() == pytest.approx(top_m, abs=1e-4)
    assert mesh.positions_m[:, 2].min() < -0.15 < fit.middle_m[2]
    assert set(mesh.joints[mesh.weights > 0.0].tolist()) == {3}
    assert _seen_from_outside(mesh) > 0.99
    assert _volume_m3(mesh) > 0.0


def test_a_tube_is_round_and_closed() -> None:
    line = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    line[0, 1], line[3, 1] = -1e-6, 1.0 + 1e-6
    strip: SurfaceStrip = tube(line, np.array([0.0, 0.02, 0.02, 0.0]), [[(0, 1.0)]] * 4, sides=64)
    mesh = mesh_of("rod", [strip], PLAIN)
    assert _volume_m3(mesh) == pytest.approx(math.pi * 0.02**2, rel=0.01)
    assert _seen_from_outside(mesh) == 1.0


@pytest.mark.parametrize(("window", "degree"), [(5, 2), (7, 1), (9, 2)])
def test_lines_are_smoothed_as_scipy_does(window: int, degree: int) -> None:
    line = np.random.default_rng(window).normal(size=(23, 3))
    assert np.allclose(evened(line, window, degree), savgol_filter(line, window, degree, axis=0), atol=1e-12)
