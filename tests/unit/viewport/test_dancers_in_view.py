"""Dancers before the players: framed where a view is about everyone, and never over the selected player."""

from __future__ import annotations

import argparse
from functools import cache
from itertools import product

import numpy as np
import pytest
from msgspec.structs import replace

from app.cli.drawing import parsed_view
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.project.camera_bookmarks import View
from app.project.casting import StagePosition
from app.project.edit.dancers import add_dancer, place_dancers
from app.project.model import Project
from tests.unit.viewport.poses import AT_S, pose, quartet
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage, dancer_kit, dancing_member, kit_of, member_of
from widgets.viewport.framing import SEEN_THROUGH, in_the_way, view_camera

SIZE = (1600, 900)
BEFORE_ALL = StagePosition(0.0, 3.0, 0.0)


@cache
def danced() -> Project:
    """The quartet with a dancer in the middle before it."""
    project, dancer_id = add_dancer(quartet(), "salsa", "Dancer")
    return place_dancers(project, {dancer_id: BEFORE_ALL})


@cache
def dancer_pose() -> Pose:
    project = danced()
    result = LiveMotion(Performance(project)).pose_now(project.dancers[0].id, AT_S)
    assert result is not None
    return result


def stage_of(z_m: float = BEFORE_ALL.z_m, x_m: float = BEFORE_ALL.x_m) -> Stage:
    """Return the stage with the quartet and the dancer at a place."""
    project = danced()
    dancer = replace(project.dancers[0], stage=StagePosition(x_m, z_m, 0.0))
    stage = Stage(
        [*(member_of(player, kit_of(player)) for player in project.players), dancing_member(dancer, dancer_kit(dancer))]
    )
    poses = {player.id: pose(index) for index, player in enumerate(project.players)}
    stage.pose({**poses, dancer.id: dancer_pose()})
    return stage


@pytest.mark.parametrize("view", ["front", "side", "top"])
def test_a_film_of_no_named_player_shows_everyone(view: View) -> None:
    requested = argparse.Namespace(view=view, players=[])
    assert parsed_view(requested, danced())[1] == (danced().players[0].id,)
    _, ids = parsed_view(requested, danced(), of_all=(view,))
    stage = stage_of()
    rows = stage.rows(ids)
    camera = view_camera(view, stage, rows, Camera(), SIZE[0] / SIZE[1])
    assert rows == list(range(len(danced().players) + 1))
    assert in_the_way(view, stage, rows, camera) == {}
    for row in rows:
        pixels, depth = camera.project([stage.joint_m(row, name) for name in ("head", "hips")], *SIZE)
        assert (depth > 0.5).all()
        assert (pixels > 0.0).all()
        assert (pixels < SIZE).all()


def test_the_front_of_all_is_seen_from_the_audience() -> None:
    """Outer players of the quartet face its middle; the mean of all directions is the audience's."""
    stage = stage_of()
    rows = list(range(len(danced().players)))
    turned = view_camera("front", stage, rows[:1], Camera(), 1.6).yaw_rad
    assert abs(turned) > 0.1
    assert view_camera("front", stage, rows, Camera(), 1.6).yaw_rad == pytest.approx(0.0, abs=0.05)


def test_a_dancer_before_the_player_in_view_never_fills_the_picture() -> None:
    """A body near the camera is omitted, one close to the player is drawn transparently, one beside or behind fully."""
    first = stage_of()
    camera = view_camera("front", first, [0], Camera(), SIZE[0] / SIZE[1])
    player, dancer = first.joint_m(0, "hips"), len(first.members) - 1
    way = camera.eye_m - player
    way[1] = 0.0
    away_m = float(np.linalg.norm(way))
    way /= away_m

    def omitted(distance_m: float, aside_m: float = 0.0) -> float:
        x_m, _, z_m = player + distance_m * way + aside_m * camera.right - (first.joint_m(dancer, "hips") - stood_m)
        return in_the_way("front", stage_of(z_m, x_m), [0], camera).get(dancer, 0.0)

    stood_m = np.array([BEFORE_ALL.x_m, 0.0, BEFORE_ALL.z_m])
    assert omitted(0.9 * away_m) == omitted(0.6 * away_m) == 1.0
    assert omitted(0.29 * away_m) == SEEN_THROUGH
    assert omitted(0.5 * away_m, 1.5) == omitted(-1.0) == 0.0
    between = [omitted(share * away_m) for share in (0.42, 0.38, 0.34)]
    assert between == sorted(between, reverse=True)
    assert between[0] < 1.0


def test_both_feet_of_a_dancer_are_in_their_view() -> None:
    stage = stage_of()
    dancer, apart_m = len(stage.members) - 1, 0.9
    feet = [stage.members[dancer].assets.character.skeleton.index(name) for name in ("leftFoot", "rightFoot")]
    stage.joints[dancer, feet, 0, 3] = stage.joints[dancer, feet, 0, 3].mean() + np.array([0.5, -0.5]) * apart_m
    camera = view_camera("feet", stage, [dancer], Camera(), SIZE[0] / SIZE[1])
    placed = stage.joints[dancer, feet]
    # The camera of a film is behind by 15 cm when a dancer stops.
    for late_m in product((-0.15, 0.0, 0.15), (0.0,), (-0.15, 0.15)):
        for tip_m in (-0.1, 0.2):
            pixels, _ = camera.project(placed[:, :, 3] + tip_m * placed[:, :, 2] + late_m, *SIZE)
            assert (pixels > 0.0).all()
            assert (pixels < SIZE).all()
