"""The camera between views, in flights, following players, and moved by the user, with a clock controlled
by the test.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from widgets.viewport.camera import Camera
from widgets.viewport.camera_moves import ARRIVED_M, SLACK, TRANSITION_S, Eye

FAR = replace(Camera(), target_m=(2.0, 1.0, 0.0), distance_m=3.0)


def test_a_flight_takes_its_time_and_arrives() -> None:
    eye = Eye()
    eye.fly(FAR, 10.0)
    assert eye.flying
    assert eye.destination is FAR
    assert eye.advance(10.0 + 0.5 * TRANSITION_S)
    assert 0.0 < eye.camera.target_m[0] < 2.0
    assert eye.advance(10.01 + TRANSITION_S)
    assert eye.camera is FAR
    assert not eye.flying
    assert not eye.advance(11.0)


def test_following_goes_on_until_it_has_arrived() -> None:
    eye, goal, now_s = Eye(), np.array([0.3, 1.2, 0.1]), 0.0
    steps = 0
    while eye.follow(goal, now_s):
        now_s += 1.0 / 60.0
        steps += 1
        assert steps < 600
    assert np.linalg.norm(np.asarray(eye.camera.target_m) - goal) <= ARRIVED_M
    assert steps > 20


def test_a_pause_is_no_leap() -> None:
    eye, goal = Eye(), np.array([1.0, 1.0, 0.0])
    eye.follow(goal, 0.0)
    eye.follow(goal, 1000.0)
    assert eye.camera.target_m[0] < 0.5


def test_a_close_up_goes_back_where_what_it_shows_grows_and_comes_again() -> None:
    eye, goal, now_s = Eye(), np.array([0.0, 1.0, 0.0]), 0.0
    eye.jump(replace(Camera(), distance_m=0.6))

    def settle(needed_m: float) -> float:
        nonlocal now_s
        now_s += 1.0 / 60.0
        while eye.follow(goal, now_s, needed_m):
            now_s += 1.0 / 60.0
        return eye.camera.distance_m

    assert settle(0.6) == pytest.approx(0.6)
    assert settle(0.66) == pytest.approx(0.6), "a little more has room"
    assert settle(1.2) == pytest.approx(1.2 / SLACK, rel=0.01)
    assert settle(0.5) == pytest.approx(0.6, rel=0.01)
    # A distance by hand is the user's own, and grows by the same share.
    eye.dolly(4)
    nearer = eye.camera.distance_m
    assert settle(0.6) == pytest.approx(nearer)
    assert settle(1.2) == pytest.approx(nearer * 2.0 / SLACK, rel=0.01)


def test_nothing_is_followed_in_flight_or_where_there_is_nothing_to_follow() -> None:
    eye = Eye()
    before = eye.camera
    assert not eye.follow(None, 1.0)
    eye.fly(FAR, 1.0)
    assert not eye.follow(np.zeros(3), 1.1)
    assert eye.camera == before


def test_a_pan_by_hand_is_kept_while_following_and_given_up_with_another_view() -> None:
    eye, goal = Eye(), np.array([0.0, 1.0, 0.0])
    eye.pan(100.0, 0.0, 600.0)
    shift = np.asarray(eye.camera.target_m) - goal
    assert np.linalg.norm(shift) > 0.1
    for step in range(200):
        eye.follow(goal, step / 60.0)
    assert eye.camera.target_m == pytest.approx(goal + shift, abs=ARRIVED_M)
    eye.choose("hands")
    assert eye.centred(goal) == pytest.approx(goal)
    assert not eye.touched


@pytest.mark.parametrize("move", ["orbit", "pan", "dolly"])
def test_a_hand_on_the_camera_ends_a_flight_where_it_is(move: str) -> None:
    eye = Eye()
    eye.fly(FAR, 0.0)
    eye.advance(0.5 * TRANSITION_S)
    between = eye.camera
    {"orbit": lambda: eye.orbit(1.0, 0.0), "pan": lambda: eye.pan(0.0, 0.0, 500.0), "dolly": lambda: eye.dolly(0.0)}[
        move
    ]()
    assert eye.touched
    assert not eye.flying
    assert eye.camera.distance_m == pytest.approx(between.distance_m)
    assert eye.camera.distance_m != pytest.approx(FAR.distance_m)
