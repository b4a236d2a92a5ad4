"""The camera's calculations compared with matrices and with the expected effect of the mouse."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from widgets.viewport.camera import (
    FARTHEST_M,
    HIGHEST_RAD,
    LOWEST_RAD,
    NEAREST_M,
    Camera,
    between,
    dolly,
    followed,
    frame,
    frame_points,
    orbit,
    pan,
)

SIZE = (800.0, 600.0)
ANGLES = st.floats(-3.0, 3.0)
CAMERAS = st.builds(
    Camera,
    target_m=st.tuples(st.floats(-5, 5), st.floats(-1, 3), st.floats(-5, 5)),
    yaw_rad=ANGLES,
    pitch_rad=st.floats(LOWEST_RAD, HIGHEST_RAD),
    distance_m=st.floats(0.2, 50.0),
)


def clip(camera: Camera, point: np.ndarray) -> np.ndarray:
    """Pixels calculated with the matrices for the graphics card."""
    x, y, _, w = camera.clip_from_world(SIZE[0] / SIZE[1]) @ [*point, 1.0]
    return np.array([(x / w + 1.0) * SIZE[0] / 2.0, (1.0 - y / w) * SIZE[1] / 2.0])


def test_a_camera_of_yaw_zero_stands_with_the_audience_and_sees_left_as_left() -> None:
    camera = Camera(target_m=(0.0, 1.0, 0.0), yaw_rad=0.0, pitch_rad=0.0, distance_m=5.0)
    assert camera.eye_m == pytest.approx([0.0, 1.0, 5.0])
    places, depths = camera.project([[-1.0, 1.0, 0.0], [1.0, 2.0, 0.0]], *SIZE)
    assert places[0][0] < 400.0 < places[1][0]
    assert places[0][1] == pytest.approx(300.0)
    assert places[1][1] < 300.0
    assert depths == pytest.approx([5.0, 5.0])


@given(CAMERAS, st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)))
def test_projection_and_matrices_agree_and_a_ray_goes_back_through_the_point(
    camera: Camera, aside: tuple[float, float, float]
) -> None:
    point = np.asarray(camera.target_m) + 0.1 * camera.distance_m * np.asarray(aside)
    (place,), (depth,) = camera.project(point, *SIZE)
    assert depth > 0.0
    assert clip(camera, point) == pytest.approx(place, abs=1e-4)
    origin, direction = camera.ray(place[0], place[1], *SIZE)
    away = point - origin
    assert np.linalg.norm(np.cross(direction, away)) < 1e-6 * max(1.0, float(np.linalg.norm(away)))


@given(CAMERAS)
def test_depths_between_near_and_far_are_in_the_clip_volume(camera: Camera) -> None:
    for depth in (1.01 * camera.near_m, camera.distance_m, 0.99 * camera.far_m):
        point = camera.eye_m - depth * camera.backward
        z, w = (camera.clip_from_world(1.0) @ [*point, 1.0])[2:]
        assert -1.0 <= z / w <= 1.0


@given(CAMERAS, st.floats(-400, 400), st.floats(-400, 400))
def test_panning_takes_the_target_along_with_the_hand(camera: Camera, right: float, down: float) -> None:
    moved = pan(camera, right, down, SIZE[1])
    (place,), _ = moved.project(camera.target_m, *SIZE)
    assert place == pytest.approx([400.0 + right, 300.0 + down], abs=1e-6 * SIZE[0] + 1e-3)
    assert moved.distance_m == camera.distance_m


@given(CAMERAS, st.floats(-2000, 2000), st.floats(-2000, 2000))
def test_orbiting_keeps_target_and_distance_and_never_tips_over(camera: Camera, right: float, down: float) -> None:
    turned = orbit(camera, right, down)
    assert turned.target_m == camera.target_m
    assert turned.distance_m == camera.distance_m
    assert LOWEST_RAD <= turned.pitch_rad <= HIGHEST_RAD
    assert turned.up[1] > 0.0


def test_dragging_right_turns_the_scene_to_the_right() -> None:
    camera = Camera(target_m=(0.0, 0.0, 0.0), pitch_rad=0.0)
    nearest = np.array([0.0, 0.0, 1.0])
    before, after = (c.project(nearest, *SIZE)[0][0][0] for c in (camera, orbit(camera, 50.0, 0.0)))
    assert after > before


def test_a_step_of_the_wheel_there_and_back_is_none_and_ends_are_kept() -> None:
    camera = Camera()
    assert dolly(dolly(camera, 3.0), -3.0).distance_m == pytest.approx(camera.distance_m)
    assert dolly(camera, 1.0).distance_m < camera.distance_m
    assert dolly(camera, 1000.0).distance_m == NEAREST_M
    assert dolly(camera, -1000.0).distance_m == FARTHEST_M


@given(CAMERAS, st.tuples(st.floats(0.05, 3), st.floats(0.05, 3), st.floats(0.05, 3)), st.floats(0.5, 2.5))
def test_a_framed_box_is_wholly_in_the_picture_and_fills_it(
    camera: Camera, size: tuple[float, float, float], aspect: float
) -> None:
    low = np.array([1.0, 0.0, -2.0])
    framed = frame(camera, low, low + size, aspect, 1.0)
    corners = [low + np.array(size) * [x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    clipped = np.array([framed.clip_from_world(aspect) @ [*corner, 1.0] for corner in corners])
    shown = np.abs(clipped[:, :2] / clipped[:, 3:])
    assert shown.max() <= 1.0 + 1e-6
    if framed.distance_m > NEAREST_M:
        assert shown.max() > 0.999
    assert (framed.yaw_rad, framed.pitch_rad) == (camera.yaw_rad, camera.pitch_rad)


@given(CAMERAS, st.integers(0, 1000), st.floats(0.5, 4.0))
@example(Camera((0.0, 0.0, 0.0), yaw_rad=-1.25, pitch_rad=0.203125, distance_m=1.0), 241, 3.0)
def test_framed_points_are_in_the_picture_with_equal_room_on_both_sides(
    camera: Camera, seed: int, aspect: float
) -> None:
    points = np.random.default_rng(seed).normal(size=(12, 3)) * [3.0, 0.6, 2.0] + [1.0, 0.8, -2.0]
    framed = frame_points(camera, points, aspect, 1.0)
    clipped = np.column_stack([points, np.ones(len(points))]) @ framed.clip_from_world(aspect).T
    shown = clipped[:, :2] / clipped[:, 3:]
    assert np.abs(shown).max() <= 1.0 + 1e-6
    away_m = clipped[:, 3]
    assert away_m.min() >= NEAREST_M - 1e-9
    if away_m.min() > NEAREST_M + 1e-6:
        assert np.abs(shown).max() > 0.999
    assert shown.min(axis=0) == pytest.approx(-shown.max(axis=0), abs=1e-6)
    assert (framed.yaw_rad, framed.pitch_rad) == (camera.yaw_rad, camera.pitch_rad)


@given(CAMERAS, CAMERAS)
def test_a_flight_begins_and_ends_where_it_should_and_turns_the_shorter_way(start: Camera, end: Camera) -> None:
    assert between(start, end, 0.0).eye_m == pytest.approx(start.eye_m, abs=1e-9)
    assert between(start, end, 1.0) is end
    half = between(start, end, 0.5)
    turn = abs(math.remainder(end.yaw_rad - start.yaw_rad, 2.0 * math.pi))
    assert abs(math.remainder(half.yaw_rad - start.yaw_rad, 2.0 * math.pi)) == pytest.approx(turn / 2.0, abs=1e-9)
    low, high = sorted((start.distance_m, end.distance_m))
    assert low - 1e-9 <= half.distance_m <= high + 1e-9


def test_half_way_of_a_flight_is_between_both_ends() -> None:
    start = Camera((0.0, 1.0, 2.0), yaw_rad=0.2, pitch_rad=0.3, distance_m=1.0, fov_deg=30.0)
    end = Camera((1.0, 3.0, 4.0), yaw_rad=0.6, pitch_rad=0.5, distance_m=4.0, fov_deg=50.0)
    half = between(start, end, 0.5)
    assert half.target_m == pytest.approx((0.5, 2.0, 3.0))
    found = (half.yaw_rad, half.pitch_rad, half.distance_m, half.fov_deg)
    assert found == pytest.approx((0.4, 0.4, 2.0, 40.0))


def test_following_is_the_same_in_one_step_and_in_many_and_never_overshoots() -> None:
    camera = replace(Camera(), target_m=(0.0, 0.0, 0.0))
    goal = np.array([1.0, 2.0, -1.0])
    once, many = followed(camera, goal, 0.5), camera
    for _ in range(50):
        many = followed(many, goal, 0.01)
    assert many.target_m == pytest.approx(once.target_m)
    assert followed(camera, goal, 100.0).target_m == pytest.approx(goal)
    assert 0.0 < once.target_m[0] < 1.0


@pytest.mark.parametrize("yaw_rad", [-2.4, 0.0, 0.7, 3.0])
@pytest.mark.parametrize("pitch_rad", [-0.3, 0.0, 0.4, 1.5])
def test_up_stands_upright_on_backward_and_right(yaw_rad: float, pitch_rad: float) -> None:
    camera = Camera(yaw_rad=yaw_rad, pitch_rad=pitch_rad)
    assert camera.up == pytest.approx(np.cross(camera.backward, camera.right), abs=1e-12)
