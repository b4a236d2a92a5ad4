"""The camera of a film moves continuously or not at all."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from app.project.camera_bookmarks import VIEWS, View
from tests.unit.viewport.poses import pose, posed_stage, quartet
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage
from widgets.viewport.film_camera import Shot, times_looked_at
from widgets.viewport.framing import steady_camera, tracked

STEP_S = 0.1
ASPECT = 16.0 / 9.0


def posed(stage: Stage, times_s: list[float]) -> Iterator[Stage]:
    for time_s in times_s:
        stage.pose({player.id: pose(row, time_s) for row, player in enumerate(quartet().players)})
        yield stage


def filmed(view: View, row: int, start_s: float, end_s: float) -> list[Camera]:
    """Camera of every picture of a player's film."""
    stage = posed_stage()
    camera = steady_camera(view, posed(stage, times_looked_at(1, start_s, end_s)), [row], Camera(), ASPECT)
    shot = Shot(view, camera, (quartet().players[row].id,))
    times_s = [start_s + STEP_S * index for index in range(round((end_s - start_s) / STEP_S))]
    return [shot.camera_at(now, time_s) for now, time_s in zip(posed(stage, times_s), times_s, strict=True)]


# While trumpet 1 lifts the instrument, at -0.9 s, the bell hides the fingers for two tenths of a second; the slide of
# trombone 2 goes out and in.
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("row", [0, 3])
def test_it_looks_from_one_direction_and_distance(view: View, row: int) -> None:
    cameras = filmed(view, row, -1.5, 3.2)
    directions = np.array([(own.yaw_rad, own.pitch_rad, own.distance_m, own.fov_deg) for own in cameras])
    assert np.ptp(directions, axis=0) == pytest.approx(0.0)


@pytest.mark.parametrize("view", VIEWS)
def test_it_makes_no_jump(view: View) -> None:
    """No step is much longer than the adjacent ones."""
    eyes_m = np.array([own.eye_m for own in filmed(view, 0, -1.5, 3.2)])
    steps_m = np.linalg.norm(np.diff(eyes_m, axis=0), axis=1)
    turned_m = np.linalg.norm(np.diff(eyes_m, 2, axis=0), axis=1)
    assert steps_m.max() < 0.05
    assert turned_m.max() < 0.03
    if view in ("ensemble", "front", "side", "top"):
        assert steps_m.max() == 0.0


def test_travelling_feet_stay_in_the_picture() -> None:
    """At a metre a second the camera is no farther behind than the room that the view leaves around shoes."""
    stage = posed_stage()
    shot = Shot("feet", steady_camera("feet", [stage], [0], Camera(), ASPECT), (quartet().players[0].id,))
    shot.camera_at(stage, 0.0)
    for number in range(1, 61):
        stage.joints[0, :, 0, 3] += 1.0 / 30.0
        camera = shot.camera_at(stage, number / 30.0)
    middle_m = tracked("feet", stage, 0)
    assert middle_m is not None
    assert 0.0 < middle_m[0] - camera.target_m[0] < 0.15
