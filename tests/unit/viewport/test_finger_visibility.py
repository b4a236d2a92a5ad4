"""A close-up of the hands shows the playing fingers from the side of their keys."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import msgspec
import numpy as np
import pytest

from app.arrays import FloatArray
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.plan.model import FingeringEvent
from app.project.model import project_from_score
from instrument_maps.load import bundled_maps
from tests.unit.viewport.poses import AT_S, quartet
from widgets.viewport.camera import Camera
from widgets.viewport.camera_moves import Eye
from widgets.viewport.cast import Stage, kit_of, member_of
from widgets.viewport.finger_visibility import fingers_seen
from widgets.viewport.framing import needed_distance_m, tracked, turn_rad, view_camera

USUAL = (-48.0, 14.0)
BONES = ("Proximal", "Intermediate", "Distal")


@cache
def playing(map_id: str) -> Stage:
    """The quartet with its lowest part on another instrument."""
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
    before, after = fingers_seen(stage, 0, [USUAL, directed_deg(stage, 0)], turn)
    assert before < 0.5
    assert after > before + 0.3
    hands_m = tracked("hands", stage, 0)
    assert hands_m is not None
    camera = view_camera("hands", stage, [0], Camera(), 1.6)
    assert np.asarray(camera.target_m) == pytest.approx(hands_m, abs=1e-6)


@pytest.mark.parametrize(
    ("map_id", "least"), [("trumpet_Bb", 1.0), ("cornet_Bb", 1.0), ("clarinet_Bb", 0.75), ("flute", 0.75)]
)
def test_fingertips_are_nearer_to_the_eye_than_the_knuckles_that_could_hide_them(map_id: str, least: float) -> None:
    """The back of the hand hides fingertips behind it: from the usual direction those on a trumpet's valves."""
    stage = playing(map_id)
    camera = view_camera("hands", stage, [0], Camera(), 1.6)
    hands = {control.finger.split(".")[0] for control in bundled_maps()[map_id].controls if control.role == "pitch"}
    fingers = [f"{hand}{finger}" for hand in hands for finger in ("Index", "Middle", "Ring")]
    nearer = [
        np.linalg.norm(stage.joint_m(0, f"{name}Distal") - camera.eye_m)
        < np.linalg.norm(stage.joint_m(0, f"{name}Proximal") - camera.eye_m)
        for name in fingers
    ]
    assert np.mean(nearer) >= least


def test_the_instrument_hides_what_is_behind_it() -> None:
    """Compared with a slow count of lines of sight against every vertex of the drawn model."""
    stage = playing("tuba_BBb")
    turn = turn_rad(stage, 0)
    kit, held = stage.members[0].assets, stage.node_matrix(0)
    points = np.concatenate([mesh.positions_m for mesh in kit.instrument.meshes]) @ held[:, :3].T + held[:, 3]
    tips = np.array([stage.joint_m(0, f"right{finger}Distal") for finger in ("Index", "Middle", "Ring", "Little")])
    hidden = []
    for side, height in (USUAL, (0.0, 34.0)):
        yaw, pitch = math.radians(side) + turn, math.radians(height)
        towards = np.array([math.cos(pitch) * math.sin(yaw), math.sin(pitch), math.cos(pitch) * math.cos(yaw)])
        eye = tips.mean(axis=0) + 0.7 * towards
        count = 0
        for tip in tips:
            line = (eye - tip) / np.linalg.norm(eye - tip)
            off = points - tip
            along = off @ line
            aside = np.linalg.norm(off - along[:, None] * line, axis=1)
            count += bool(((along > 0.025) & (along < 0.7) & (aside < 0.012)).any())
        hidden.append(count)
    behind, before = fingers_seen(stage, 0, [USUAL, (0.0, 34.0)], turn)
    assert hidden[0] > hidden[1]
    assert behind < before - 0.3


def hands_share(stage: Stage, camera: Camera, aspect: float) -> FloatArray:
    """Distance of a player's hands from the picture's centre, relative to half its width and height."""
    names = ["Hand", *(f"{finger}{bone}" for finger in ("Index", "Middle", "Ring", "Little") for bone in BONES)]
    joints_m = np.array([stage.joint_m(0, side + name) for side in ("left", "right") for name in names])
    away = joints_m - camera.eye_m
    tangent = math.tan(math.radians(camera.fov_deg) / 2.0)
    seen = np.stack([away @ camera.right / aspect, away @ camera.up], axis=1) / (-away @ camera.backward)[:, None]
    share: FloatArray = np.abs(seen).max(axis=0) / tangent
    return share


def test_a_slide_that_goes_far_out_later_stays_in_the_picture() -> None:
    project = quartet()
    player = project.players[3]
    performance = Performance(project)
    slid = sorted(performance.plan(player).fingerings, key=lambda event: event.controls.get("slide", 0.0))
    live, stage = LiveMotion(performance), Stage([member_of(player, kit_of(player))])

    def show(event: FingeringEvent) -> None:
        pose = live.pose_now(player.id, (event.start_s + event.end_s) / 2.0)
        assert pose is not None
        stage.pose({player.id: pose})

    show(slid[0])
    eye, now_s = Eye(), 0.0
    eye.choose("hands")
    eye.jump(view_camera("hands", stage, [0], Camera(), 2.3))

    def follow() -> None:
        nonlocal now_s
        now_s += 1.0 / 60.0
        middle_m = tracked("hands", stage, 0)
        while eye.follow(middle_m, now_s, needed_distance_m("hands", stage, 0, eye.camera, 2.3)):
            now_s += 1.0 / 60.0

    follow()
    framed_m = eye.camera.distance_m
    show(slid[-1])
    follow()
    assert hands_share(stage, eye.camera, 2.3).max() < 1.0
    assert hands_share(stage, replace(eye.camera, distance_m=framed_m), 2.3).max() > 1.0, "it would not have been"
    show(slid[0])
    follow()
    assert eye.camera.distance_m == pytest.approx(framed_m, rel=0.01)


@pytest.mark.parametrize(
    "map_id", ["trumpet_Bb", "clarinet_Bb", "flute", "bassoon", "horn_double_F_Bb", "sax_baritone_Eb", "tuba_BBb"]
)
@pytest.mark.parametrize("aspect", [1.0, 2.3])
def test_both_hands_fill_the_picture(map_id: str, aspect: float) -> None:
    """By an independent projection, every finger is in the picture, and the hands take most of its height or width."""
    stage = playing(map_id)
    share = hands_share(stage, view_camera("hands", stage, [0], Camera(), aspect), aspect)
    assert share.max() < 0.95
    assert share.max() > 0.7
