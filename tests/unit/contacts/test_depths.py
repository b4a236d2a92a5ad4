"""Depth of hands inside an instrument, compared with slower methods. One deforms every vertex and measures it against
every body; the other is the former method by groups of the same frames.

One deforms every vertex one by one and measures it to every body; the other is the search by groups of the same frames
that the judge was before.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from app.arrays import AnyFloatArray, FloatArray
from app.contacts.bounds import NEARLY_ALL, reported_least_m
from app.contacts.depths import HandDepths
from app.contacts.distance_field import FAR_M, NEAR_M, DistanceField
from app.contacts.touches import world_from_nodes
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.edit.players import change
from app.project.model import map_choices, project_from_score
from app.rig import quaternion
from app.rig.grip.instrument_proxy import signed_distance
from app.rig.instrument import node_transforms
from app.rig.skeleton import JointTransforms, forward
from app.rig.skinning import Patch, mesh_named, patch
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.deformed import deform
from tests.support.grouped_depths import GroupedDepths
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)
SINGLE_PRECISION_M = 2e-6


class Played(NamedTuple):
    """Frames of a player with a displaced instrument."""

    instrument: InstrumentMap
    joints: JointTransforms
    world: FloatArray
    morphs: Mapping[str, AnyFloatArray]
    nodes: dict[str, FloatArray]
    hands: tuple[Patch, ...]


def played(
    index: int,
    push_m: tuple[float, float, float],
    seconds: float,
    instrument_id: str | None = None,
    every: int = 1,
) -> Played:
    maps = bundled_maps()
    project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    if instrument_id is not None:
        project = change(project, {project.players[index].id}, instrument_id=instrument_id)
    performance, player = Performance(project), project.players[index]
    motion = player_motion(performance, player, cut_span(performance.time_frame, FPS, 0.0, seconds))
    character, instrument = character_of(player), performance.instrument(player)
    model = model_of(instrument)
    joints = forward(character.skeleton, motion.rotations, motion.hips_m)
    world = np.tile(np.eye(4), (motion.frames, len(joints.joints), 1, 1))
    world[..., :3, :3], world[..., :3, 3] = quaternion.to_matrix(joints.rotations), joints.positions_m
    places_m, turns = node_transforms(model, instrument, motion.controls, motion.frames)
    pushed_m = np.where(np.arange(motion.frames)[:, None] % every, (0.0, 0.0, 0.0), push_m)
    nodes = world_from_nodes(
        motion.instrument_position_m.astype(np.float64) + pushed_m,
        motion.instrument_rotation.astype(np.float64),
        {name: (places_m[:, node], turns[:, node]) for node, name in enumerate(model.node_names)},
    )
    marks = [character.landmarks[hand] for hand in ("left.hand", "right.hand")]
    hands = tuple(patch(character, mesh_named(character, mark.mesh), mark.vertices) for mark in marks)
    return Played(instrument, joints, world, motion.morphs, nodes, hands)


@pytest.mark.parametrize(
    ("push_m", "every"),
    [((0.006, -0.004, 0.005), 1), ((-0.01, 0.0, 0.0), 1), ((0.0, 0.01, -0.006), 1), ((-0.06, 0.0, 0.0), 9)],
)
@pytest.mark.parametrize("index", [0, 2], ids=["trumpet", "trombone"])
def test_no_vertex_of_a_hand_is_left_out(index: int, push_m: tuple[float, float, float], every: int) -> None:
    """The instrument is moved into the hands in all frames or in one of several, since a part may be far in most frames
    and deep in one.
    """
    scene = played(index, push_m, 3.0, every=every)
    deepest = 0.0
    for skin in scene.hands:
        judge = HandDepths(skin, scene.instrument.proxy)
        found = judge.depths_m(scene.world[:, judge.joints, :3], scene.morphs, scene.nodes)
        points_m = deform(skin, scene.joints, scene.morphs)
        for frame in range(0, len(found), 9):
            slow = max(
                -signed_distance(body, (points_m[frame] - turn[:3, 3]) @ turn[:3, :3]).min()
                for body in scene.instrument.proxy
                for turn in [scene.nodes[body.node][frame]]
            )
            assert found[frame] == pytest.approx(max(slow, 0.0), abs=SINGLE_PRECISION_M)
            deepest = max(deepest, slow)
        # The result does not depend on which frames are judged together.
        part = slice(40, 71)
        few = judge.depths_m(
            scene.world[part][:, judge.joints, :3],
            {name: values[part] for name, values in scene.morphs.items()},
            {name: matrices[part] for name, matrices in scene.nodes.items()},
        )
        np.testing.assert_allclose(few, found[part], atol=SINGLE_PRECISION_M)
    assert deepest > 0.003


@pytest.mark.parametrize("instrument_id", ["flute", "sax_alto_Eb", "bassoon", "horn_double_F_Bb", "tuba_F"])
def test_the_search_finds_what_the_search_by_groups_finds(instrument_id: str) -> None:
    scene = played(2, (0.004, -0.003, 0.002), 8.0, instrument_id)
    for skin in scene.hands:
        judge = HandDepths(skin, scene.instrument.proxy)
        found = judge.depths_m(scene.world[:, judge.joints, :3], scene.morphs, scene.nodes)
        expected = GroupedDepths(skin, scene.instrument.proxy).depths_m(scene.world, scene.morphs, scene.nodes)
        np.testing.assert_allclose(found, expected, atol=SINGLE_PRECISION_M)
        assert expected.max() > 0.0


@pytest.mark.parametrize("share", [0.0, 0.5, 0.99, 1.0])
def test_what_is_less_than_asked_for_may_be_left_out(share: float) -> None:
    scene = played(2, (0.004, -0.003, 0.002), 4.0, "flute")
    for skin in scene.hands:
        judge = HandDepths(skin, scene.instrument.proxy)
        every = judge.depths_m(scene.world[:, judge.joints, :3], scene.morphs, scene.nodes)
        least_m = np.full(len(every), np.quantile(every, share))
        found = judge.depths_m(scene.world[:, judge.joints, :3], scene.morphs, scene.nodes, least_m)
        np.testing.assert_allclose(found, np.maximum(every, least_m), atol=SINGLE_PRECISION_M)


def test_the_deepest_of_all_frames_are_as_without_a_least_depth() -> None:
    """Results of some frames also bound those that are not examined."""
    scene = played(2, (0.004, -0.003, 0.002), 8.0, "sax_alto_Eb")
    for skin in scene.hands:
        judge = HandDepths(skin, scene.instrument.proxy)
        world = scene.world[:, judge.joints, :3]
        every = np.sort(judge.depths_m(world, scene.morphs, scene.nodes))
        found = np.sort(judge.depths_m(world, scene.morphs, scene.nodes, least_of=reported_least_m))
        deepest = (len(every) - 1) * NEARLY_ALL // 100
        np.testing.assert_array_equal(found[deepest:], every[deepest:])
        assert (found[:deepest] <= every[deepest]).all()


def test_hands_whose_vertices_morphs_move() -> None:
    """Morphs of foreign characters may change hands suddenly or gradually."""
    scene = played(2, (0.004, -0.003, 0.002), 4.0)
    frames = len(scene.world)
    swelling = np.linspace(-0.3, 1.0, frames)
    swelling[50:53] = 2.5
    for skin in scene.hands:
        outward = skin.normals * 0.002
        swollen = Patch(**{**vars(skin), "morphs": {"swollen": outward}})
        morphs = {"swollen": swelling}
        judge = HandDepths(swollen, scene.instrument.proxy)
        found = judge.depths_m(scene.world[:, judge.joints, :3], morphs, scene.nodes)
        expected = GroupedDepths(swollen, scene.instrument.proxy).depths_m(scene.world, morphs, scene.nodes)
        np.testing.assert_allclose(found, expected, atol=SINGLE_PRECISION_M)


@pytest.mark.parametrize("instrument_id", ["trumpet_Bb", "flute", "sousaphone_BBb"])
def test_the_field_is_the_distance_to_the_nearest_body(instrument_id: str) -> None:
    """Tested around the bodies of every node, and far from them."""
    instrument = bundled_maps()[instrument_id]
    random = np.random.default_rng(5)
    names = sorted({body.node for body in instrument.proxy})
    by_node = [[body for body in instrument.proxy if body.node == name] for name in names]
    field = DistanceField(by_node)
    for node, bodies in enumerate(by_node):
        spread = random.normal(scale=0.15, size=(400, 3))
        points_m = np.concatenate(
            [spread, np.repeat(spread[:40], 20, axis=0) + random.normal(scale=0.004, size=(800, 3))]
        )
        nodes = np.full(len(points_m), node)
        exact = np.min([signed_distance(body, points_m) for body in bodies], axis=0)
        about, error = field.about_m(points_m.astype(np.float32), nodes)
        off = np.abs(about - np.minimum(exact, FAR_M)) - error
        assert off[exact < FAR_M].max(initial=0.0) <= SINGLE_PRECISION_M
        assert (about - error)[exact >= FAR_M].max() <= FAR_M
        clear_m, depth_m = random.uniform((-0.01, 0.0), (0.05, 0.01), (len(points_m), 2)).astype(np.float32).T
        roughly, roughly_off = field.about_m(points_m.astype(np.float32), nodes, clear_m, depth_m)
        off = np.abs(roughly - exact) - roughly_off
        assert off[exact < FAR_M].max(initial=0.0) <= SINGLE_PRECISION_M
        # Whatever is known to be clear by the cells is known to be so.
        clear = about - error >= clear_m
        assert (roughly - roughly_off >= clear_m - SINGLE_PRECISION_M)[clear].all()
        deep = -about - error > np.maximum(depth_m, 0.0)
        assert (-roughly - roughly_off >= -about - error - SINGLE_PRECISION_M)[deep & (exact < clear_m)].all()
        found = field.distances_m(points_m, nodes)
        np.testing.assert_allclose(found, np.minimum(exact, NEAR_M), atol=SINGLE_PRECISION_M)
        beyond = field.beyond_m(points_m.astype(np.float32), nodes)
        assert (beyond <= exact + SINGLE_PRECISION_M).all()
