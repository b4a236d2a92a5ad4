"""Matrices of all players compared with the rig's forward kinematics and skinning, player by player."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from app.performance.bodies import model_of
from app.rig.instrument import node_transforms
from app.rig.quaternion import rotate
from app.rig.skeleton import forward
from app.rig.skinning import patch
from tests.support.deformed import deform
from tests.unit.viewport.poses import pose, posed_stage, quartet
from widgets.viewport.cast import Stage, kit_of, member_of, placed
from widgets.viewport.contacts import touches
from widgets.viewport.limb_capsules import LIMBS, LimbCapsules, hit


@pytest.mark.parametrize("row", range(4))
def test_joints_and_skin_are_where_the_rig_puts_them(row: int) -> None:
    stage, player = posed_stage(), quartet().players[row]
    character = stage.members[row].assets.character
    own = pose(row)
    transforms = forward(character.skeleton, own.rotations[None], own.hips_m[None])
    world = placed(player.stage)
    requested = transforms.positions_m[0] @ world[:, :3].T + world[:, 3]
    assert stage.joints[row, : len(requested), :, 3] == pytest.approx(requested, abs=1e-6)

    mesh = character.meshes[0]
    vertices = np.arange(0, len(mesh.positions_m), 97)
    skin = deform(patch(character, mesh, vertices), transforms)[0] @ world[:, :3].T + world[:, 3]
    blended = np.einsum("vk,vkij->vij", mesh.weights[vertices], stage.bones[row][mesh.joints[vertices]])
    found = np.einsum("vij,vj->vi", blended[..., :3], mesh.positions_m[vertices]) + blended[..., 3]
    assert found == pytest.approx(skin, abs=2e-6)


@pytest.mark.parametrize("row", range(4))
def test_instruments_nodes_are_where_the_map_moves_them(row: int) -> None:
    stage, player = posed_stage(), quartet().players[row]
    kit, own, world = stage.members[row].assets, pose(row), placed(player.stage)
    controls = {name: np.array([value]) for name, value in own.controls.items()}
    places, turns = node_transforms(model_of(kit.map), kit.map, controls, 1)
    for node, rest in enumerate(kit.instrument.node_positions_m):
        for off in ([0.0, 0.0, 0.0], [0.01, 0.02, -0.03]):
            inside = rotate(turns[0, node], np.array(off)) + places[0, node]
            player_m = rotate(own.instrument_rotation, inside) + own.instrument_position_m
            requested = world[:, :3] @ player_m + world[:, 3]
            matrix = stage.node_matrix(row, node)
            assert matrix[:, :3] @ (rest + off) + matrix[:, 3] == pytest.approx(requested, abs=2e-6)


def test_the_hands_of_a_real_performance_touch_their_instruments() -> None:
    stage = posed_stage()
    for row in range(4):
        found = touches(stage, row)
        assert len(found) >= 3
        firm = [touch.distance_mm for touch in found if touch.firm]
        assert max(firm) < 2.5, (row, firm)


def test_poses_of_some_leave_the_others_as_they_were() -> None:
    stage = posed_stage()
    before = stage.bones.copy()
    players = quartet().players
    assert stage.pose({players[1].id: pose(1, 9.0), players[2].id: None})
    assert (stage.bones[[0, 2, 3]] == before[[0, 2, 3]]).all()
    assert np.abs(stage.bones[1] - before[1]).max() > 1e-4


def test_no_one_is_shown_before_there_is_a_pose() -> None:
    project = quartet()
    stage = Stage([member_of(player, kit_of(player)) for player in project.players])
    assert not stage.shown.any()
    assert not stage.pose({player.id: None for player in project.players})
    stage.pose({project.players[2].id: pose(2)})
    assert stage.shown.tolist() == [False, False, True, False]


@pytest.mark.parametrize("more", [1, -1])
def test_a_pose_of_another_character_leaves_who_is_drawn_as_they_were(more: int) -> None:
    stage = posed_stage()
    before = stage.bones.copy()
    players, own = quartet().players, pose(0, 9.0)
    rotations = np.concatenate([own.rotations, own.rotations[:1]]) if more > 0 else own.rotations[:more]
    assert not stage.pose({players[0].id: replace(own, rotations=rotations)})
    assert (stage.bones == before).all()
    assert stage.pose({players[0].id: own})


def test_only_who_is_seated_has_a_seat_under_the_hips() -> None:
    player = quartet().players[0]
    seated = msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, posture="seated"))
    standing, sitting = (member_of(one, kit_of(one)) for one in (player, seated))
    assert standing.seat_m is None
    assert 0.3 < sitting.seat_m[1] < 0.5
    assert quartet() is not replace(quartet())


def test_a_ray_finds_the_nearest_player_and_misses_between_them() -> None:
    stage = posed_stage()
    capsules = LimbCapsules(stage).capsules()
    assert capsules.shape == (4, LIMBS, 2, 4)
    for row in range(4):
        chest = stage.joint_m(row, "chest")
        found = hit(capsules, chest + np.array([0.0, 0.0, 6.0]), np.array([0.0, 0.0, -1.0]))
        assert found[0] == row
        assert 5.0 < found[1] < 6.2
    assert hit(capsules, np.array([0.0, 5.0, 6.0]), np.array([0.0, 0.0, -1.0])) is None
    assert hit(capsules, np.array([0.0, 1.0, 6.0]), np.array([0.0, 0.0, 1.0])) is None


def test_feet_stand_on_the_floor() -> None:
    """The capsules of the feet touch the floor when the soles do."""
    capsules = LimbCapsules(posed_stage()).capsules()
    feet = capsules[:, LIMBS - 4 : LIMBS - 2]
    assert np.abs(feet[..., 1] - 0.6 * feet[..., 3]).max() < 0.012
