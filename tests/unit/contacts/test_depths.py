"""How deep hands are inside an instrument; against every vertex, deformed one by one, and every body."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.contacts.depths import HandDepths
from app.contacts.touches import world_from_nodes
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.model import map_choices, project_from_score
from app.rig import quaternion
from app.rig.instrument import node_transforms
from app.rig.proxy import signed_distance
from app.rig.skeleton import forward
from app.rig.skinning import mesh_named, patch
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.deformed import deform
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)


@pytest.mark.parametrize("push_m", [(0.006, -0.004, 0.005), (-0.01, 0.0, 0.0), (0.0, 0.01, -0.006)])
@pytest.mark.parametrize("index", [0, 2], ids=["trumpet", "trombone"])
def test_no_vertex_of_a_hand_is_left_out(index: int, push_m: tuple[float, float, float]) -> None:
    """The search by groups, with the instrument pushed into the hands."""
    maps = bundled_maps()
    project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    performance, player = Performance(project), project.players[index]
    motion = player_motion(performance, player, cut_span(performance.time_frame, FPS, 0.0, 3.0))
    character, instrument = character_of(player), performance.instrument(player)
    model = model_of(instrument)
    joints = forward(character.skeleton, motion.rotations, motion.hips_m)
    world = np.tile(np.eye(4), (motion.frames, len(joints.joints), 1, 1))
    world[..., :3, :3], world[..., :3, 3] = quaternion.to_matrix(joints.rotations), joints.positions_m
    places_m, turns = node_transforms(model, instrument, motion.controls, motion.frames)
    nodes = world_from_nodes(
        motion.instrument_position_m.astype(np.float64) + push_m,
        motion.instrument_rotation.astype(np.float64),
        {name: (places_m[:, node], turns[:, node]) for node, name in enumerate(model.node_names)},
    )
    deepest = 0.0
    for hand in ("left.hand", "right.hand"):
        mark = character.landmarks[hand]
        skin = patch(character, mesh_named(character, mark.mesh), mark.vertices)
        judge = HandDepths(skin, instrument.proxy)
        found = judge.depths_m(world, motion.morphs, nodes)
        points_m = deform(skin, joints, motion.morphs)
        for frame in range(0, motion.frames, 9):
            slow = max(
                -signed_distance(body, (points_m[frame] - turn[:3, 3]) @ turn[:3, :3]).min()
                for body in instrument.proxy
                for turn in [nodes[body.node][frame]]
            )
            assert found[frame] == pytest.approx(max(slow, 0.0), abs=1e-9)
            deepest = max(deepest, slow)
        # Frames are judged one by one: it does not matter which are looked at together.
        part = slice(40, 71)
        few = judge.depths_m(
            world[part],
            {name: values[part] for name, values in motion.morphs.items()},
            {name: matrices[part] for name, matrices in nodes.items()},
        )
        np.testing.assert_allclose(few, found[part], atol=1e-12)
    assert deepest > 0.003
