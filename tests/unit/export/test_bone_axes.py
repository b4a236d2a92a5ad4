"""Curves of exported bones are readable for animators: near 0 at rest, and away from gimbal lock during playing."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from app.export.bone_axes import bone_axes
from app.export.bvh_clip import scene_bvh
from app.export.character import character_scene
from app.export.target import SkeletonChoice, TargetSkeleton
from app.export.targets import target_skeleton
from app.formats.bvh.read import decode_bvh
from app.formats.fbx.curves import rotation_curves
from app.formats.joint_angles import AXES, channel_degrees, order_along
from app.formats.scene import Scene
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.rig import quaternion
from tests.gui.conftest import quartet_project
from tests.support.encoded import encode_bvh
from tests.support.performed import player_motion

FPS = Fraction(60)
FREE_DEG = 70.0
"""Angle in degrees of the middle rotation up to which the other two rotate at most three times as fast as the bone
itself.
"""
MOST_TIMES, ROUNDING_DEG = 3.0, 0.05

Played = dict[tuple[str, SkeletonChoice], tuple[Scene, TargetSkeleton]]


@pytest.fixture(scope="module")
def played() -> Played:
    """A trumpeter and a trombonist on two skeletons, for some bars."""
    performance = Performance(quartet_project())
    span = bars_span(performance, FPS, (1, 6), performance.project.preroll_beats)
    found: Played = {}
    for player in (performance.project.players[0], performance.project.players[2]):
        motion, character = player_motion(performance, player, span), character_of(player)
        for choice in ("suisou", "ue5"):
            target = target_skeleton(character, choice)
            found[player.name, choice] = character_scene(character, motion, "p", "t", target), target
    return found


def _turned_deg(rotations: np.ndarray) -> np.ndarray:
    """Rotation from frame to frame (F - 1, B) in degrees."""
    q = np.asarray(rotations, np.float64)
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    sides = np.minimum(np.linalg.norm(q[1:] - q[:-1], axis=-1), np.linalg.norm(q[1:] + q[:-1], axis=-1))
    return np.degrees(4.0 * np.arcsin(np.minimum(sides / 2.0, 1.0)))


def _judge(degrees: np.ndarray, orders: list[str], rotations: np.ndarray, names: list[str]) -> None:
    """Compare curves (B, 3, F) with the rotation of the bones."""
    for bone, order in enumerate(orders):
        middle = np.abs(degrees[bone, AXES.index(order[1])]).max()
        assert middle < FREE_DEG, f"{names[bone]}: {order}, {middle:.0f} degrees in the middle"
    steps = np.abs(np.diff(degrees, axis=-1)).max(axis=(1, 2))
    turned = _turned_deg(rotations).max(axis=0)
    worst = int(np.argmax(steps - MOST_TIMES * turned))
    assert steps[worst] <= MOST_TIMES * turned[worst] + ROUNDING_DEG, f"{names[worst]}: {steps[worst]:.1f} degrees"
    assert np.abs(degrees).max() < 200.0


def test_curves_of_fbx_go_no_faster_than_the_bones(played: Played) -> None:
    for scene, _ in played.values():
        assert scene.clip is not None
        names = [bone.name for bone in scene.bones]
        degrees = rotation_curves(scene.bones, scene.clip)
        _judge(degrees, [bone.order for bone in scene.bones], scene.clip.rotations_xyzw, names)
        hips = next(iter(scene.clip.translations_cm))
        assert np.abs(degrees[hips]).max() < 15.0, "a player who stands turns the hips little"


def test_channels_of_bvh_go_no_faster_than_the_bones(played: Played) -> None:
    for scene, target in played.values():
        clip = scene_bvh(scene, t_pose=target.t_pose)
        degrees = channel_degrees(clip.rotations_xyzw, clip.orders)
        _judge(degrees, list(clip.orders), clip.rotations_xyzw, list(clip.names))
        assert len(set(clip.orders)) > 2


def test_a_bvh_whose_angles_are_nothing_is_in_the_t_pose(played: Played) -> None:
    for scene, target in played.values():
        clip = decode_bvh(encode_bvh(scene_bvh(scene, t_pose=target.t_pose)).decode(), "x.bvh")
        places = np.zeros((len(clip.names), 3))
        for joint, parent in enumerate(clip.parents[1:], start=1):
            places[joint] = places[parent] + clip.offsets_cm[joint]
        suffix = {"suisou": ("leftHand", "leftUpperArm", "head"), "ue5": ("hand_l", "upperarm_l", "head")}[
            target.choice
        ]
        hand, shoulder, head = (places[clip.names.index(name)] for name in suffix)
        assert abs(hand[1] - shoulder[1]) < 0.5
        assert hand[0] - shoulder[0] > 40.0
        assert head[1] > 40.0
        assert abs(head[0]) < 0.5


def test_the_order_of_a_bone_hangs_on_its_skeleton_alone(played: Played) -> None:
    for choice in ("suisou", "ue5"):
        by_name = [
            {bone.name: bone.order for bone in scene.bones}
            for (_, kind), (scene, _) in played.items()
            if kind == choice
        ]
        assert by_name[0] == by_name[1]


def test_hinges_of_the_mannequin_turn_about_their_own_axis_first(played: Played) -> None:
    scene, _ = played["Trombone 1", "ue5"]
    orders = {bone.name: bone.order for bone in scene.bones}
    # The mannequin's limbs lie along X and bend about Z.
    assert [orders[name] for name in ("lowerarm_l", "calf_r", "index_02_r")] == ["ZYX"] * 3
    assert orders["upperarm_l"][1] == orders["upperarm_r"][1] == "X"


def test_axes_are_those_of_the_anatomy_in_the_space_of_the_bone(played: Played) -> None:
    performance = Performance(quartet_project())
    character = character_of(performance.project.players[0])
    target = target_skeleton(character, "ue5")
    axes = bone_axes(target, character.skeleton)
    bone = target.names.index("lowerarm_l")
    own = axes[bone]
    assert own is not None
    in_world = quaternion.rotate(target.joint_from_bone[bone], own)
    np.testing.assert_allclose(in_world, [[0, -1, 0], [0, 0, 1], [-1, 0, 0]], atol=1e-9)
    assert axes[target.names.index("interaction")] is None
    assert order_along(axes[target.names.index("ik_hand_l")])[1] == "X"
