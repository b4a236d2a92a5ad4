"""A close-up of the hands shows the hands: the eye goes round what would hide them."""

from __future__ import annotations

import math
from functools import cache

import msgspec
import numpy as np
import pytest

from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.project.model import project_from_score
from instrument_maps.load import bundled_maps
from tests.unit.viewport.poses import AT_S, posed_stage, quartet
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage, kit_of, member_of
from widgets.viewport.finger_visibility import visible_finger_shares
from widgets.viewport.framing import tracked, turn_rad, view_camera

USUAL = (-48.0, 14.0)


@cache
def playing(map_id: str) -> Stage:
    """The quartet's lowest part on another instrument."""
    maps, score = bundled_maps(), quartet().score
    part = msgspec.structs.replace(score.parts[3], map_id=map_id)
    project = project_from_score(msgspec.structs.replace(score, parts=(part,)), maps)
    (player,) = project.players
    pose = LiveMotion(Performance(project)).pose_now(player.id, AT_S)
    assert pose is not None
    stage = Stage([member_of(player, kit_of(player))])
    stage.pose({player.id: pose})
    return stage


def directed_deg(stage: Stage, row: int) -> tuple[float, float]:
    camera = view_camera("hands", stage, [row], Camera(), 1.6)
    turn = math.remainder(camera.yaw_rad - turn_rad(stage, row), 2.0 * math.pi)
    return math.degrees(turn), math.degrees(camera.pitch_rad)


@pytest.mark.parametrize("map_id", ["tuba_BBb", "euphonium_Bb_bassclef"])
def test_a_bell_before_the_hands_is_gone_round(map_id: str) -> None:
    stage = playing(map_id)
    turn = turn_rad(stage, 0)
    before, after = visible_finger_shares(stage, 0, [USUAL, directed_deg(stage, 0)], turn)
    assert before < 0.5
    assert after > before + 0.3
    hands_m = tracked("hands", stage, 0)
    assert hands_m is not None
    camera = view_camera("hands", stage, [0], Camera(), 1.6)
    assert np.asarray(camera.target_m) == pytest.approx(hands_m, abs=1e-6)


@pytest.mark.parametrize("row", range(4))
def test_where_enough_is_seen_the_eye_is_where_it_always_is(row: int) -> None:
    assert directed_deg(posed_stage(), row) == pytest.approx(USUAL)


def test_a_finger_behind_a_tube_is_not_seen() -> None:
    """Against a slow count: every line of sight against every vertex of the drawn model."""
    stage = playing("tuba_BBb")
    share = visible_finger_shares(stage, 0, [USUAL], turn_rad(stage, 0))[0]
    kit, held = stage.members[0].assets, stage.node_matrix(0)
    points = np.concatenate([mesh.positions_m for mesh in kit.instrument.meshes]) @ held[:, :3].T + held[:, 3]
    names = [
        f"{side}{finger}{joint}"
        for side in ("left", "right")
        for finger in ("Index", "Middle", "Ring", "Little")
        for joint in ("Intermediate", "Distal")
    ]
    fingers = np.array([stage.joint_m(0, name) for name in names])
    yaw, pitch = math.radians(USUAL[0]) + turn_rad(stage, 0), math.radians(USUAL[1])
    towards = np.array([math.cos(pitch) * math.sin(yaw), math.sin(pitch), math.cos(pitch) * math.cos(yaw)])
    eye = fingers.mean(axis=0) + 0.7 * towards
    visible = 0
    for finger in fingers:
        line = (eye - finger) / np.linalg.norm(eye - finger)
        off = points - finger
        along = off @ line
        aside = np.linalg.norm(off - along[:, None] * line, axis=1)
        visible += not ((along > 0.025) & (along < 0.7) & (aside < 0.012)).any()
    assert share == pytest.approx(visible / len(fingers), abs=0.25)
