"""Eyes in files, read back: both irises point to the object looked at, whether shapes or bones rotate them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.export.bvh_clip import scene_bvh
from app.export.character import character_scene
from app.export.equipped_skeleton import equipped
from app.export.mannequin import mannequin_target
from app.export.playback import ScenePlayback, Surface
from app.export.rig import Rig
from app.export.rig_options import EyeTurn, RigOptions
from app.export.target import TargetSkeleton, normalised_target
from app.formats.fbx.read import read_scene as read_fbx
from app.formats.fbx.write import write_scene
from app.formats.gltf.read_scene import read_scene as read_glb
from app.formats.gltf.write import write_glbs
from app.formats.scene import Scene
from app.motion.faces.eyes import EYE_SHAPES, EYE_SIDES, SHAPES_RAD, eye_turn, shape_name, sight_by, weights_for
from app.motion.model import Motion
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.plan.model import AUDIENCE, CONDUCTOR
from app.project.model import map_choices, project_from_score
from app.rig.model import Character
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.foreign import foreign
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)
SETTLED_S = 0.15
"""Seconds after the beginning and before the end of a look in which the eyes may move; saccades are shorter."""


class Eyes:
    """Two players of the quartet who look at music, each other and the audience."""

    def __init__(self) -> None:
        maps = bundled_maps()
        project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
        # The third is turned to the first, whose lead-in it looks at.
        players = list(project.players)
        stage = players[2].stage
        players[2] = msgspec.structs.replace(players[2], stage=msgspec.structs.replace(stage, turn_rad=-0.8))
        project = replace(project, players=tuple(players))
        self.performance = Performance(project)
        self.player = project.players[2]
        self.span = cut_span(self.performance.time_frame, FPS, -1.6, 0.6)
        self.motion = player_motion(self.performance, self.player, self.span)
        self.character = character_of(self.player)


@pytest.fixture(scope="module")
def eyes() -> Eyes:
    return Eyes()


def target_of(character: Character, name: str, turn: EyeTurn = "shapes") -> TargetSkeleton:
    target = mannequin_target(character.skeleton) if name == "ue5" else normalised_target(character.skeleton)
    return equipped(target, character, Rig(RigOptions(eyes=turn)))


def sights(scene: Scene, character: Character) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Position (F, 3) of each eyeball in metres, and direction (F, 3) from it to the centre of its pupil, from deformed
    vertices.
    """
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(0, scene.clip.frames)
    places, ways = {}, {}
    mesh = scene.meshes[0]
    names = [material.name for material in mesh.materials]
    assert mesh.face_materials is not None
    for side, sign in (("left", 1.0), ("right", -1.0)):
        found = []
        iris = np.unique(mesh.faces[mesh.face_materials == names.index("iris")])
        for material in ("mouth_eyes", "iris"):
            vertices = np.unique(mesh.faces[mesh.face_materials == names.index(material)])
            # Teeth have the material of the whites, and lie lower.
            high = np.abs(mesh.vertices_cm[vertices, 1] - mesh.vertices_cm[iris, 1].mean()) < 2.0
            vertices = vertices[high & (np.sign(mesh.vertices_cm[vertices, 0]) == sign)]
            found.append(Surface(playback, mesh, vertices).positions_m(world, 0, scene.clip.frames).mean(axis=1))
        places[side], ways[side] = found[0], found[1] - found[0]
        ways[side] /= np.linalg.norm(ways[side], axis=1, keepdims=True)
    return places, ways


def written(tmp_path: Path, scene: Scene, kind: str) -> Scene:
    path = tmp_path / f"eyes.{kind}"
    if kind == "fbx":
        write_scene(path, scene)
        return read_fbx(path)
    write_glbs(path, (scene,))
    return read_glb(path, scene.meshes)


def off_deg(ways: np.ndarray, places: np.ndarray, target: np.ndarray) -> np.ndarray:
    to = target - places
    to /= np.linalg.norm(to, axis=1, keepdims=True)
    return np.degrees(np.arccos(np.clip(np.sum(ways * to, axis=1), -1.0, 1.0)))


def stare(motion: Motion, character: Character, points_m: np.ndarray, at_m: dict[str, np.ndarray]) -> Motion:
    """Motion with a motionless head and both eyes on a point in every frame."""
    weights = {}
    rotations = np.tile(np.array([0.0, 0.0, 0.0, 1.0], np.float32), (len(points_m), len(character.skeleton.names), 1))
    for side in EYE_SIDES:
        way = points_m - at_m[side]
        way /= np.linalg.norm(way, axis=1, keepdims=True)
        weights |= weights_for(side, way)
        rotations[:, character.skeleton.index(f"{side}Eye")] = eye_turn(way)
    morphs = {name: values.astype(np.float32) for name, values in weights.items()}
    hips_m = np.tile(motion.hips_m[:1], (len(points_m), 1))
    return replace(motion, rotations=rotations, morphs=morphs, hips_m=hips_m)


@pytest.mark.parametrize(
    ("kind", "skeleton", "turn"),
    [("fbx", "ue5", "shapes"), ("glb", "ue5", "shapes"), ("fbx", "ue5", "bones"), ("glb", "suisou", "shapes")],
)
def test_a_partner_is_looked_at_by_both_eyes(
    eyes: Eyes, tmp_path: Path, kind: str, skeleton: str, turn: EyeTurn
) -> None:
    scene = character_scene(eyes.character, eyes.motion, "x", "test", target_of(eyes.character, skeleton, turn))
    scene = written(tmp_path, scene, kind)
    places, ways = sights(scene, eyes.character)
    glances = [
        one for one in eyes.performance.plan(eyes.player).glances if one.at in eyes.performance.places
        and one.at not in (CONDUCTOR, AUDIENCE)
    ]  # fmt: skip
    own = eyes.performance.places[eyes.player.id]
    seen = 0
    for glance in glances:
        other = eyes.performance.places[glance.at]
        # The partner's head above the place on the stage, seen from the player's own.
        across, ahead = other.x_m - own.x_m, other.z_m - own.z_m
        cos, sin = np.cos(own.turn_rad), np.sin(own.turn_rad)
        height = np.mean([places[side][:, 1].mean() for side in EYE_SIDES]) + other.eyes_m - own.eyes_m
        target = np.array([across * cos - ahead * sin, height, across * sin + ahead * cos])
        times = eyes.span.first_frame_s + np.arange(len(places["left"])) / float(FPS)
        here = (times > glance.start_s + SETTLED_S) & (times < glance.end_s - SETTLED_S)
        for side in EYE_SIDES:
            if here.any():
                found = off_deg(ways[side][here], places[side][here], target)
                seen += here.sum()
                # The head's rest height differs by what the posture bends: 0.5 degrees of it.
                assert found.max() < 1.0, (glance, side, found.round(2))
    assert seen > 20


@pytest.mark.parametrize("kind", ["fbx", "glb"])
def test_both_eyes_converge_on_what_is_near_and_far(eyes: Eyes, tmp_path: Path, kind: str) -> None:
    joints = {side: eyes.character.skeleton.index(f"{side}Eye") for side in EYE_SIDES}
    target = target_of(eyes.character, "ue5")
    ahead = stare(eyes.motion, eyes.character, np.array([[0.0, 0.0, 1e6]]), dict.fromkeys(EYE_SIDES, np.zeros(3)))
    still = character_scene(eyes.character, ahead, "x", "test", target_of(eyes.character, "suisou"))
    assert still.clip is not None
    world = ScenePlayback(still, still.clip).world(0, 1)[0]
    at_m = {side: world[joint, :3, 3] for side, joint in joints.items()}
    middle_m = 0.5 * (at_m["left"] + at_m["right"])
    ways_m = np.array([[0.0, 0.0, 1.0], [0.4, -0.35, 1.0], [-0.5, 0.3, 1.0]])
    points_m = middle_m + np.concatenate([away_m * ways_m for away_m in (0.25, 0.65, 3.0, 40.0)])
    staring = stare(eyes.motion, eyes.character, points_m, at_m)
    scene = written(tmp_path, character_scene(eyes.character, staring, "x", "test", target), kind)
    _, ways = sights(scene, eyes.character)
    for side in EYE_SIDES:
        assert off_deg(ways[side], np.tile(at_m[side], (len(points_m), 1)), points_m).max() < 0.2
    apart = np.degrees(np.arccos(np.clip(np.sum(ways["left"] * ways["right"], axis=1), -1, 1)))
    expected = np.degrees(0.06 / np.linalg.norm(points_m - middle_m, axis=1))
    assert np.all(np.abs(apart - expected) < 0.25 * expected + 0.05)


def test_the_eyes_read_with_the_convergence_of_a_page(eyes: Eyes) -> None:
    joints = [eyes.character.skeleton.index(f"{side}Eye") for side in EYE_SIDES]
    left, right = (
        2.0 * np.arctan2(eyes.motion.rotations[:, joint, 1], eyes.motion.rotations[:, joint, 3]) for joint in joints
    )
    apart = np.degrees(right - left)
    assert apart.min() > 0.2, "no one looks beyond the hall"
    assert 4.5 < np.percentile(apart, 90) < 6.0, "at the music, 60 to 75 cm away"


@pytest.mark.parametrize("skeleton", ["ue5", "suisou"])
def test_each_turn_is_made_once(eyes: Eyes, skeleton: str) -> None:
    for turn in ("shapes", "bones"):
        target = target_of(eyes.character, skeleton, turn)
        scene = character_scene(eyes.character, eyes.motion, "x", "test", target)
        assert scene.clip is not None
        names = [bone.name for bone in scene.bones]
        mesh = scene.meshes[0]
        for side in EYE_SIDES:
            bone = names.index({"ue5": f"eye_{side[0]}", "suisou": f"{side}Eye"}[skeleton])
            ball = np.flatnonzero(np.where(mesh.joint_indices == bone, mesh.weights, 0.0).sum(axis=1) > 0.99)
            assert len(ball) > 500, "the ball hangs on the bone"
            moved = np.ptp(scene.clip.rotations_xyzw[:, bone], axis=0).max()
            assert (moved > 0.05) == (turn == "bones")
            for way, angle in SHAPES_RAD.items():
                (morph,) = [one for one in mesh.morphs if one.name == shape_name(side, way)]
                here = np.isin(morph.vertex_indices, ball)
                furthest = np.linalg.norm(morph.position_deltas_cm[here], axis=1).max(initial=0.0)
                # The pupil is 13 mm from the joint, and a shape takes it along the chord.
                assert furthest == pytest.approx(2.65 * np.sin(0.5 * angle) if turn == "shapes" else 0.0, abs=0.15)
                assert scene.clip.morph_weights[morph.name].max() <= 1.0
        assert max(scene.clip.morph_weights[name].max() for name in EYE_SHAPES) > 0.2
        # BVH has no shapes: there the bones have the whole turn.
        clip = scene_bvh(scene)
        for side in EYE_SIDES:
            at = list(clip.names).index({"ue5": f"eye_{side[0]}", "suisou": f"{side}Eye"}[skeleton])
            turned = character_scene(
                eyes.character, eyes.motion, "x", "t", target_of(eyes.character, skeleton, "bones")
            )
            whole = scene_bvh(turned)
            bone = whole.names.index(clip.names[at])
            np.testing.assert_allclose(
                np.abs(np.sum(clip.rotations_xyzw[:, at] * whole.rotations_xyzw[:, bone], axis=1)), 1.0, atol=1e-6
            )


def test_weights_are_those_with_which_the_iris_lies_in_the_line_of_sight() -> None:
    random = np.random.default_rng(7)
    way = np.column_stack([random.uniform(-0.55, 0.55, 500), random.uniform(-0.5, 0.45, 500), np.ones(500)])
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    for side in EYE_SIDES:
        weights = weights_for(side, way)
        assert all(values.min() >= 0.0 and values.max() <= 1.0 for values in weights.values())
        assert not np.any(weights[shape_name(side, "In")] * weights[shape_name(side, "Out")])
        np.testing.assert_allclose(sight_by(side, weights, 500), way, atol=1e-9)


def test_a_figure_whose_own_shapes_turn_its_eyes_is_not_turned_twice(eyes: Eyes) -> None:
    from app.export.eyes import eyes_of_file
    from app.export.own_skeleton import own_target

    figure = foreign(eyes.character)
    assert figure.own is not None
    own = own_target(figure)
    plain = eyes_of_file(figure, eyes.motion, own)
    joint = figure.skeleton.index("leftEye")
    # Its shapes move only lids: the bones turn the eyes.
    np.testing.assert_allclose(plain.motion.rotations[:, joint], eyes.motion.rotations[:, joint], atol=1e-6)
