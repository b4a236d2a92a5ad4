"""Characters of other makers: motion is exported to the bones of their own files."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.export.character import character_scene
from app.export.check_skeleton import check_skeleton
from app.export.joint_playback import JointPlayback
from app.export.mannequin import mannequin_target
from app.export.own_skeleton import own_target
from app.export.playback import ScenePlayback, Surface
from app.export.target import TargetSkeleton
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.scene import Scene
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.figure_to_character import figure_character
from app.rig.characters.joint_mapping import map_joints
from app.rig.characters.load_character import load_character
from app.rig.characters.read_figure import read_figure
from app.rig.characters.split_hands import bones_beside_hands
from app.rig.characters.t_pose import rest_of
from app.rig.figure import Figure
from app.rig.model import Character
from app.rig.skeleton import forward

FOLDER = Path(__file__).parents[2] / "data" / "characters"
FILES = sorted(path for path in FOLDER.iterdir() if path.suffix in (".fbx", ".vrm", ".glb"))
FRAMES = 4
MM = 1e-3
STILL = ("root", "jaw")


@pytest.fixture(scope="module", params=FILES, ids=lambda path: path.stem)
def character(request: pytest.FixtureRequest) -> Character:
    return load_character(request.param)


def random_motion(character: Character, seed: int = 1) -> Motion:
    random = np.random.default_rng(seed)
    names = character.skeleton.names
    vectors = random.uniform(-0.6, 0.6, (FRAMES, len(names), 3))
    vectors[:, [joint for joint, name in enumerate(names) if name in STILL]] = 0.0
    rotations = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_quat().reshape(FRAMES, len(names), 4)
    zeros = np.zeros((FRAMES, 3), np.float32)
    own = character.own
    return Motion(
        fps=Fraction(30),
        first_frame_s=0.0,
        rotations=rotations.astype(np.float32),
        hips_m=random.uniform(-0.2, 1.0, (FRAMES, 3)).astype(np.float32),
        morphs={name: np.linspace(0.0, 1.0, FRAMES, dtype=np.float32) for name in list(own.morphs if own else ())[:1]},
        controls={},
        instrument_position_m=zeros,
        instrument_rotation=np.tile(np.float32([0, 0, 0, 1]), (FRAMES, 1)),
    )


def written(character: Character, motion: Motion, target: TargetSkeleton | None, folder: Path) -> ScenePlayback:
    write_scene(folder / "x.fbx", character_scene(character, motion, "x", "test", target))
    scene = read_scene(folder / "x.fbx")
    assert scene.clip is not None
    return ScenePlayback(scene, scene.clip)


def all_m(playback: ScenePlayback) -> np.ndarray:
    world = playback.world(0, FRAMES)
    scene: Scene = playback.scene
    return np.concatenate(
        [
            Surface(playback, mesh, np.arange(len(mesh.vertices_cm))).positions_m(world, 0, FRAMES)
            for mesh in scene.meshes
        ],
        axis=1,
    )


def test_names_hierarchy_and_rest_pose_are_the_files(character: Character) -> None:
    """A file has no differences from its own export, so that the animation fits the original asset."""
    (path,) = [path for path in FILES if path.stem == character.id]
    assert check_skeleton(own_target(character), read_figure(path)) == ()


def test_joints_are_where_they_should_be(character: Character, tmp_path: Path) -> None:
    motion = random_motion(character)
    joints = forward(character.skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    for target in (own_target(character), mannequin_target(character.skeleton)):
        playback = written(character, motion, target, tmp_path)
        world = playback.world(0, FRAMES)
        for joint, bone in target.bone_of_joint.items():
            place = playback.bone_names.index(target.names[bone])
            off_m = np.linalg.norm(world[:, place, :3, 3] - joints.positions_m[:, joint], axis=1).max()
            assert off_m < 0.01 * MM, (target.choice, target.names[bone])
            expected = Rotation.from_quat(joints.rotations[:, joint]) * Rotation.from_quat(target.joint_from_bone[bone])
            turn = Rotation.from_matrix(world[:, place, :3, :3]) * expected.inv()
            assert np.degrees(turn.magnitude()).max() < 0.01, (target.choice, target.names[bone])


def test_feet_that_hang_from_the_root_stay_at_their_legs(tmp_path: Path) -> None:
    """In rigs whose feet are children of the root (Quaternius), the file moves the feet, and no bone stretches."""
    figure = read_figure(FOLDER / "woman_game_engine.glb")
    rest = rest_of(figure)
    parents, offsets, turns = list(figure.parents), figure.translations_m.copy(), figure.rotations.copy()
    for name in ("foot_l", "foot_r"):
        foot = figure.bone_names.index(name)
        back = quaternion.conjugate(rest.rotations[0])
        parents[foot] = 0
        offsets[foot] = quaternion.rotate(back, rest.positions_m[foot] - rest.positions_m[0])
        turns[foot] = quaternion.multiply(back, rest.rotations[foot])
    loose = replace(figure, parents=tuple(parents), translations_m=offsets, rotations=turns)
    character = figure_character(loose, "loose", map_joints(loose).bones, {})
    test_joints_are_where_they_should_be(character, tmp_path)
    test_skin_and_morphs_are_where_they_are_on_the_character(character, tmp_path)
    require_constant_lengths(character, tmp_path)


def require_constant_lengths(character: Character, tmp_path: Path) -> None:
    target = own_target(character)
    motion = random_motion(character)
    playback = JointPlayback(written(character, motion, target, tmp_path), target, character)
    world_m = playback.playback.world(0, FRAMES)[:, :, :3, 3]
    lengths_m = np.linalg.norm(world_m - world_m[:, [max(parent, 0) for parent in playback.playback.parents]], axis=-1)
    assert np.ptp(lengths_m[:, playback.rigid], axis=0).max() < 0.01 * MM


def handless(figure: Figure) -> Figure:
    """Figure whose forearms have a bone for each finger, and a thumb, instead of a hand (robots of Quaternius)."""
    fingers = ("index", "middle", "ring", "pinky")
    copies = [
        [f"palm_{finger}{name[-2:]}" for finger in fingers] if name.startswith("hand_") else [name]
        for name in figure.bone_names
    ]
    order = [(name, bone) for bone, own in enumerate(copies) for name in own]
    place = {name: at for at, (name, _) in enumerate(order)}
    of = [bone for _, bone in order]
    parents, translations, rotations = [], figure.translations_m[of], figure.rotations[of]
    for at, (name, bone) in enumerate(order):
        above = figure.parents[bone]
        if above >= 0 and figure.bone_names[above].startswith("hand_"):
            palm = place.get(f"palm_{name.split('_')[0]}{name[-2:]}")
            if palm is None:
                turn = figure.rotations[above]
                translations[at] = figure.translations_m[above] + quaternion.rotate(turn, translations[at])
                rotations[at] = quaternion.multiply(turn, rotations[at])
                above = figure.parents[above]
            else:
                parents.append(palm)
                continue
        parents.append(place[copies[above][0]] if above >= 0 else -1)
    first = np.array([place[own[0]] for own in copies], np.int32)
    meshes = []
    for mesh in figure.meshes:
        joints, weights = first[mesh.joints], mesh.weights
        for side in ("_l", "_r"):
            held = joints == place[f"palm_index{side}"]
            half = np.where(held, weights, 0.0).sum(axis=1, keepdims=True) / 2.0
            weights = np.concatenate([np.where(held, weights / 2.0, weights), half], axis=1)
            joints = np.concatenate([joints, np.full((len(joints), 1), place[f"palm_ring{side}"], np.int32)], axis=1)
        meshes.append(replace(mesh, joints=joints, weights=weights.astype(np.float32)))
    return replace(
        figure,
        bone_names=tuple(name for name, _ in order),
        parents=tuple(parents),
        translations_m=translations,
        rotations=rotations,
        meshes=tuple(meshes),
    )


def test_a_hand_of_several_bones_moves_as_one(tmp_path: Path) -> None:
    """In forearms with a bone for each finger, these form the hand, and the forearm remains the forearm."""
    whole = read_figure(FOLDER / "woman_game_engine.glb")
    figure = handless(whole)
    mapping, before = map_joints(figure), map_joints(whole)
    found = {joint: figure.bone_names[bone] for joint, bone in mapping.bones.items()}
    expected = {joint: whole.bone_names[bone] for joint, bone in before.bones.items()}
    expected |= {"leftHand": "palm_middle_l", "rightHand": "palm_middle_r"}
    assert found == expected
    beside = {figure.bone_names[bone]: joint for bone, joint in bones_beside_hands(figure, mapping.bones).items()}
    fingers = ("index", "ring", "pinky")
    assert beside == {f"palm_{one}_{side[0]}": f"{side}Hand" for one in fingers for side in ("left", "right")}
    assert bones_beside_hands(whole, before.bones) == {}
    character = figure_character(figure, "handless", mapping.bones, {})
    target = own_target(character)
    hand = character.skeleton.index("leftHand")
    palms = [target.names[bone] for bone, joint in enumerate(target.joint_of_bone) if joint == hand]
    assert palms == [f"palm_{finger}_l" for finger in ("index", "middle", "ring", "pinky")]
    test_joints_are_where_they_should_be(character, tmp_path)
    require_constant_lengths(character, tmp_path)
    test_skin_and_morphs_are_where_they_are_on_the_character(character, tmp_path)


def test_skin_and_morphs_are_where_they_are_on_the_character(character: Character, tmp_path: Path) -> None:
    motion = random_motion(character, 2)
    target = replace(own_target(character), twists={})  # the character's own skin has no twist
    own = all_m(written(character, motion, target, tmp_path))
    ours = all_m(written(character, motion, None, tmp_path))
    assert own.shape == ours.shape
    assert np.linalg.norm(own - ours, axis=-1).max() < 0.1 * MM
