"""Sockets and other additions to skeletons in the files read back: body, skin and instrument keep their places."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.export.attachment import attached, in_world, own_path, without_place
from app.export.character import character_scene
from app.export.equipped_skeleton import equipped, socket_names
from app.export.instrument import instrument_scene
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback, Surface
from app.export.rig import floor_place, rig_of
from app.export.rig_options import Attachment, RigOptions
from app.export.scene_keys import key_count, keyed_character, keyed_instrument
from app.export.target import SkeletonChoice, TargetSkeleton
from app.export.targets import target_skeleton
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.scene import Scene
from app.motion.model import Motion
from app.performance.cast import Performer, performer_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.casting import StagePosition
from app.rig.model import Character
from tests.support import readers
from tests.support.foreign import foreign
from tests.support.performed import player_motion
from tests.support.skinned import GlbFile
from tests.unit.export.test_skeletons import FPS, what_it_holds, without_morphs
from tests.unit.export.unreal.conftest import quartet

MM = 1e-4
"""Tolerance in metres: a tenth of a millimetre."""
DEGREE = np.pi / 180.0
PLACE = StagePosition(1.5, -0.75, 0.6)
PLAIN = RigOptions()
EACH = (
    RigOptions("socket"),
    RigOptions("ik"),
    RigOptions(root_bone="place"),
    RigOptions(root_bone="motion"),
    RigOptions(rest_pose="t"),
    RigOptions(rest_pose="a"),
    RigOptions(twist_bones=True),
)
TOGETHER = (RigOptions("ik", "motion", "a", True), RigOptions("socket", "place", "t", True))


@dataclass(frozen=True)
class Files:
    """Contents of a character's and an instrument's file."""

    character: Character
    target: TargetSkeleton
    scene: Scene
    held: Scene

    @property
    def joints(self) -> JointPlayback:
        scene = without_place(self.scene, self.target.place)
        assert scene.clip is not None
        return JointPlayback(ScenePlayback(scene, scene.clip), self.target, self.character)

    def instrument(self) -> np.ndarray:
        """Transforms (F, N, 4, 4) of the instrument's bones in the player's space."""
        held = self.held
        for socket in socket_names(self.target):
            held = in_world(held, self.scene, socket)
        return world_m(without_place(held, self.target.place))


class Made:
    """A few seconds of a trumpeter who turns, to be written with any options."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.performance = Performance(quartet())
        self.player = quartet().players[0]
        self.performer: Performer = performer_of(self.performance, self.player)
        span = cut_span(self.performance.time_frame, FPS, -0.5, 2.0)
        self.motion: Motion = player_motion(self.performance, self.player, span)
        self.foreign = foreign(self.performer.character, roots=2)

    def target(self, choice: SkeletonChoice, options: RigOptions) -> tuple[Character, TargetSkeleton]:
        character = self.foreign if choice == "own" else self.performer.character
        rig = rig_of(options, PLACE, (self.performer,))
        return character, equipped(target_skeleton(character, choice), character, rig)

    def scenes(self, choice: SkeletonChoice, options: RigOptions) -> tuple[Character, TargetSkeleton, Scene, Scene]:
        character, target = self.target(choice, options)
        scene = character_scene(character, self.motion, "Player", "test", target)
        path = own_path(target, self.motion)
        one = self.performer
        held = instrument_scene(one.instrument, one.model, self.motion, "Player_trumpet", "test", path)
        return character, target, scene, held

    def read(self, choice: SkeletonChoice, options: RigOptions) -> Files:
        character, target, *scenes = self.scenes(choice, options)
        return Files(character, target, *(self.file(scene) for scene in scenes))

    def file(self, scene: Scene) -> Scene:
        write_scene(self.folder / f"{scene.name}.fbx", scene)
        return read_scene(self.folder / f"{scene.name}.fbx")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    return Made(tmp_path_factory.mktemp("rig"))


@pytest.fixture(scope="module")
def plain(made: Made) -> Files:
    return made.read("suisou", PLAIN)


def world_m(scene: Scene) -> np.ndarray:
    """World transforms (F, B, 4, 4) of all bones, from the definition."""
    clip = scene.clip
    result = np.tile(np.eye(4), (clip.frames, len(scene.bones), 1, 1))
    for index, bone in enumerate(scene.bones):
        local = np.tile(np.eye(4), (clip.frames, 1, 1))
        local[:, :3, :3] = Rotation.from_quat(clip.rotations_xyzw[:, index]).as_matrix()
        local[:, :3, 3] = np.asarray(clip.translations_cm.get(index, bone.translation_cm)) / 100.0
        result[:, index] = local if bone.parent < 0 else result[:, bone.parent] @ local
    return result


def rest_m(scene: Scene) -> dict[str, np.ndarray]:
    """Rest positions of the bones in metres by name."""
    clip = scene.clip
    assert clip is not None
    turns = np.stack([bone.rotation_xyzw for bone in scene.bones])[None]
    world = world_m(replace(scene, clip=replace(clip, frames=1, rotations_xyzw=turns, translations_cm={})))
    return {bone.name: place for bone, place in zip(scene.bones, world[0], strict=True)}


def angles_rad(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Angles between rotation matrices (..., 3, 3)."""
    turns = np.swapaxes(before, -1, -2) @ after
    return np.asarray(Rotation.from_matrix(turns.reshape(-1, 3, 3)).magnitude())


def check_body(plain: Files, found: Files) -> None:
    """Check that joints, landmarks, bone lengths and instrument are as in files without options."""
    before, after = plain.joints, found.joints
    here, there = world_m(before.playback.scene), world_m(after.playback.scene)
    shown = 0
    for joint, name in enumerate(found.character.skeleton.names):
        if joint in found.target.bone_of_joint and joint in plain.target.bone_of_joint:
            one, other = here[:, before.bone(name)], there[:, after.bone(name)]
            np.testing.assert_allclose(other[:, :3, 3], one[:, :3, 3], atol=MM, err_msg=name)
            own = Rotation.from_quat(found.target.joint_from_bone[found.target.bone_of_joint[joint]]).as_matrix()
            assert angles_rad(one[:, :3, :3], other[:, :3, :3] @ own.T).max() < 0.02 * DEGREE, name
            shown += 1
    assert shown >= 50
    frames = len(here)
    for name, landmark in found.character.landmarks.items():
        places = [
            Surface(joints.playback, *joints.surface(landmark)).positions_m(world, 0, frames).mean(axis=1)
            for joints, world in ((before, here), (after, there))
        ]
        np.testing.assert_allclose(places[1], places[0], atol=MM, err_msg=name)
    lengths = np.linalg.norm(after.playback.translations_m(0, frames), axis=-1)
    assert np.abs(lengths - np.linalg.norm(after.playback.rest_m, axis=-1))[:, after.rigid].max() < MM
    one, other = plain.instrument(), found.instrument()
    np.testing.assert_allclose(other[..., :3, 3], one[..., :3, 3], atol=MM)
    assert angles_rad(one[..., :3, :3], other[..., :3, :3]).max() < 0.02 * DEGREE


@pytest.mark.parametrize("choice", ["suisou", "ue5"])
@pytest.mark.parametrize("options", [*EACH, *TOGETHER], ids=str)
def test_body_skin_and_instrument_are_where_they_were(
    made: Made, plain: Files, choice: SkeletonChoice, options: RigOptions
) -> None:
    check_body(plain, made.read(choice, options))


@pytest.mark.parametrize("options", [RigOptions("socket", "place"), RigOptions("ik", "motion")], ids=str)
def test_a_skeleton_of_another_file_takes_sockets_and_a_root_that_moves(made: Made, options: RigOptions) -> None:
    found = made.read("own", options)
    own = made.foreign.own
    assert set(own.figure.bone_names) < set(found.target.names)
    # The character's own shapes do not turn the eyes.
    check_body(made.read("suisou", RigOptions(eyes="bones")), found)


def test_a_skeleton_of_another_file_keeps_its_rest_pose_and_twist_bones(made: Made) -> None:
    _, asked = made.target("own", RigOptions(rest_pose="t", twist_bones=True))
    _, plain = made.target("own", PLAIN)
    np.testing.assert_array_equal(asked.rest, plain.rest)
    assert asked.names == plain.names
    said = {message.id for message in asked.messages} - {message.id for message in plain.messages}
    assert said == {"skeleton.kept_rest_pose", "skeleton.kept_twist_bones"}


# The instrument


def turned(scene: Scene, name: str, degrees: float) -> Scene:
    """Scene with a bone rotated in all frames."""
    clip = scene.clip
    assert clip is not None
    bone = [bone.name for bone in scene.bones].index(name)
    rotations = np.array(clip.rotations_xyzw)
    turn = Rotation.from_rotvec(np.array([0.6, 0.0, 0.8]) * degrees * DEGREE)
    rotations[:, bone] = (Rotation.from_quat(rotations[:, bone]) * turn).as_quat()
    return replace(scene, clip=replace(clip, rotations_xyzw=rotations))


CARRIED = [
    ("suisou", "socket", "leftHand", "leftHand_socket"),
    ("ue5", "socket", "hand_l", "hand_l_socket"),
    ("suisou", "ik", "ik_hand_l", "ik_hand_l_socket"),
    ("ue5", "ik", "ik_hand_l", "ik_hand_l_socket"),
]


@pytest.mark.parametrize(("choice", "attachment", "hand", "socket"), CARRIED)
def test_an_edited_hand_takes_the_instrument_along(
    made: Made, choice: SkeletonChoice, attachment: str, hand: str, socket: str
) -> None:
    """The instrument rotates about the wrist with the hand, both in two files and in one scene."""
    _, target, character, held = made.scenes(choice, RigOptions(attachment))
    assert socket_names(target) == [socket]
    read, read_held = made.file(character), made.file(held)
    together = made.file(attached(character, [held], target))
    edited = turned(read, hand, 10.0)
    names = [bone.name for bone in read.bones]
    before, after = (world_m(scene)[:, names.index(hand)] for scene in (read, edited))
    carried = after @ np.linalg.inv(before)
    assert np.allclose(angles_rad(before[:, :3, :3], after[:, :3, :3]), 10.0 * DEGREE, atol=1e-3)
    rest = world_m(in_world(read_held, read, socket))
    np.testing.assert_allclose(world_m(in_world(read_held, edited, socket)), carried[:, None] @ rest, atol=1e-5)
    root = [bone.name for bone in together.bones].index("Player_trumpet")
    assert together.bones[root].parent == names.index(socket)
    where = world_m(together)[:, root:]
    np.testing.assert_allclose(where, rest, atol=1e-4)
    np.testing.assert_allclose(world_m(turned(together, hand, 10.0))[:, root:], carried[:, None] @ rest, atol=1e-4)


def test_a_free_instrument_stays_where_it_is_when_the_hand_is_edited(made: Made) -> None:
    found = made.read("suisou", PLAIN)
    assert socket_names(found.target) == []
    edited = replace(found, scene=turned(found.scene, "leftHand", 10.0))
    np.testing.assert_array_equal(edited.instrument(), found.instrument())


def test_an_instrument_on_a_socket_moves_its_parts_only(made: Made) -> None:
    found = made.read("suisou", RigOptions("socket"))
    assert found.held.clip is not None
    root = world_m(found.held)[:, 0]
    np.testing.assert_allclose(root, np.tile(np.eye(4), (len(root), 1, 1)), atol=1e-7)
    free = made.read("suisou", PLAIN).held
    np.testing.assert_allclose(world_m(found.held)[:, 1:], np.linalg.inv(world_m(free)[:, :1]) @ world_m(free)[:, 1:],
                               atol=1e-5)  # fmt: skip


def test_one_scene_shows_the_surfaces_of_both_files(made: Made, tmp_path: Path) -> None:
    """Skins of both, evaluated according to glTF and without the program's code."""
    _, target, character, held = made.scenes("suisou", RigOptions("socket"))
    _, _, free_character, free = made.scenes("suisou", PLAIN)
    write_glb(tmp_path / "both.glb", attached(character, [held], target))
    write_glb(tmp_path / "character.glb", free_character)
    write_glb(tmp_path / "instrument.glb", free)
    both, alone = GlbFile(tmp_path / "both.glb"), [GlbFile(tmp_path / f"{n}.glb") for n in ("character", "instrument")]
    for frame in (0, both.frames - 1):
        corners = both.shown(frame).corners_cm
        apart = {name: points for file in alone for name, points in file.shown(frame).corners_cm.items()}
        assert corners.keys() == apart.keys()
        for name, points in apart.items():
            np.testing.assert_allclose(corners[name], points, atol=100.0 * MM, err_msg=name)


def test_ik_targets_are_where_hands_and_feet_are(made: Made) -> None:
    for choice, names in (
        ("suisou", ("leftHand", "rightHand", "leftFoot", "rightFoot", "rightHand")),
        ("ue5", ("hand_l", "hand_r", "foot_l", "foot_r", "hand_r")),
    ):
        scene = made.read(choice, RigOptions("ik")).scene
        world, bones = world_m(scene), [bone.name for bone in scene.bones]
        targets = ("ik_hand_l", "ik_hand_r", "ik_foot_l", "ik_foot_r", "ik_hand_gun")
        for target, name in zip(targets, names, strict=True):
            np.testing.assert_allclose(world[:, bones.index(target)], world[:, bones.index(name)], atol=1e-5)
        above = {bone.name: scene.bones[bone.parent].name for bone in scene.bones}
        assert [above[name] for name in targets] == [
            "ik_hand_gun", "ik_hand_gun", "ik_foot_root", "ik_foot_root", "ik_hand_root",
        ]  # fmt: skip


# The skeleton


def test_the_root_bone_stands_at_the_place(made: Made) -> None:
    found, place = made.read("suisou", RigOptions(root_bone="place")), floor_place(PLACE)
    world = world_m(found.scene)
    np.testing.assert_allclose(100.0 * world[:, 0, :3, 3], np.tile([150.0, 0.0, -75.0], (len(world), 1)), atol=1e-3)
    ahead = world[0, 0, :3, :3] @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose(ahead, [np.sin(0.6), 0.0, np.cos(0.6)], atol=1e-5)
    free = world_m(made.read("suisou", PLAIN).held)
    moved = place.matrix
    moved[:3, 3] /= 100.0
    np.testing.assert_allclose(world_m(found.held), moved @ free, atol=MM)


@pytest.mark.parametrize("choice", ["suisou", "ue5"])
def test_the_root_bone_goes_below_the_hips(made: Made, choice: SkeletonChoice) -> None:
    turning = Rotation.from_euler("y", np.linspace(0.0, 400.0, made.motion.frames)[:, None], degrees=True)
    hips = made.performer.character.skeleton.index("hips")
    rotations, way = made.motion.rotations.copy(), made.motion.hips_m + 0.0
    rotations[:, hips] = (turning * Rotation.from_quat(rotations[:, hips])).as_quat()
    way[:, 0] += np.linspace(0.0, 2.0, len(way))
    dance = replace(made.motion, rotations=rotations, hips_m=way.astype(np.float32))
    character, target = made.target(choice, RigOptions(root_bone="motion"))
    scene = made.file(character_scene(character, dance, "dance", "test", target))
    world, pelvis = world_m(scene), target.hips
    np.testing.assert_allclose(world[:, 0, [0, 2], 3], way[:, [0, 2]], atol=MM)
    np.testing.assert_allclose(world[:, 0, 1, 3], 0.0, atol=MM)
    heading = world[:, 0, :3, :3] @ Rotation.from_quat(target.rest[0]).as_matrix().T
    np.testing.assert_allclose(heading[..., 1], np.tile([0.0, 1.0, 0.0], (len(world), 1)), atol=1e-5)
    np.testing.assert_allclose(world[:, pelvis, :3, 3], way, atol=MM)
    # Rotated like the hips: their relative direction stays as in the first frame, whatever the dance adds.
    from_root = world[:, 0, :3, :3].transpose(0, 2, 1) @ world[:, pelvis, :3, :3]
    lean = angles_rad(np.tile(from_root[:1], (len(world), 1, 1)), from_root)
    assert lean.max() < 20.0 * DEGREE


@pytest.mark.parametrize("choice", ["suisou", "ue5"])
@pytest.mark.parametrize(("pose", "down_deg"), [("t", 0.0), ("a", 45.0)])
def test_arms_at_rest(made: Made, choice: SkeletonChoice, pose: str, down_deg: float) -> None:
    found = made.read(choice, RigOptions(rest_pose=pose))
    rest, joints = rest_m(found.scene), found.joints
    names = [bone.name for bone in found.scene.bones]
    for side, out in (("left", 1.0), ("right", -1.0)):
        arm = [rest[names[joints.bone(f"{side}{part}")]][:3, 3] for part in ("UpperArm", "LowerArm", "Hand")]
        for above, below in itertools.pairwise(arm):
            way = (below - above) / np.linalg.norm(below - above)
            # As in the T-pose, in which our joints are within a few degrees of sideways.
            angle = np.degrees(np.arccos(way @ [out * np.cos(down_deg * DEGREE), -np.sin(down_deg * DEGREE), 0.0]))
            assert angle < 0.1
    # A reader that plays no animation shows the mesh as it is bound, and that is with the bones at rest.
    mesh = found.scene.meshes[0]
    for index, bone in enumerate(found.scene.bones):
        bound = np.array(mesh.world_from_bone_bind[index])
        bound[:3, 3] /= 100.0
        np.testing.assert_allclose(bound, rest[bone.name], atol=MM, err_msg=bone.name)


@pytest.mark.parametrize(("choice", "count"), [("suisou", 1), ("ue5", 2)])
def test_twist_bones_carry_skin_with_their_share(made: Made, choice: SkeletonChoice, count: int) -> None:
    found, before = made.read(choice, RigOptions(twist_bones=True)), made.read(choice, PLAIN)
    mesh, target = found.scene.meshes[0], found.target
    np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5)
    assert (mesh.weights >= 0.0).all()
    world, skeleton = world_m(found.scene), found.character.skeleton
    for side in ("left", "right"):
        for part in ("UpperArm", "LowerArm"):
            base = skeleton.index(f"{side}{part}")
            bones = [bone for bone, twist in target.twists.items() if twist.base == base]
            assert len(bones) == count
            carried = [np.where(mesh.joint_indices == bone, mesh.weights, 0.0).sum(axis=1) for bone in bones]
            # The weights of the limb are redistributed without loss.
            own = target.bone_of_joint[base]
            whole = before.scene.meshes[0]
            assert before.target.names[own] == target.names[own]
            limb = np.where(whole.joint_indices == own, whole.weights, 0.0).sum(axis=1)
            # A share of them, since a sleeve has few vertices or many.
            assert all((one > 0.5).sum() > max(20, 0.06 * (limb > 0.5).sum()) for one in carried)
            rest = np.where(mesh.joint_indices == own, mesh.weights, 0.0).sum(axis=1)
            off = np.abs(np.sum(carried, axis=0) + rest - limb)
            # But for the few vertices that would have hung on more than four bones (about 300 of 30,000).
            assert (off > 1e-5).mean() < 0.012
            assert off.max() < 0.05
            for bone in bones:
                twist = target.twists[bone]
                if count == 1:
                    assert abs(twist.share) == pytest.approx(0.5)
                joints = Rotation.from_quat(found.joints.rotations(0, len(world))[:, twist.joint])
                along = (joints.as_quat()[:, :3] @ twist.axis)[:, None] * twist.axis
                turn = Rotation.from_quat(np.concatenate([along, joints.as_quat()[:, 3:]], axis=1))
                meant = np.abs(twist.share) * turn.magnitude()
                turned_by = angles_rad(
                    world[:, own, :3, :3] @ Rotation.from_quat(target.joint_from_bone[own]).as_matrix().T,
                    world[:, bone, :3, :3] @ Rotation.from_quat(target.joint_from_bone[bone]).as_matrix().T,
                )
                np.testing.assert_allclose(turned_by, meant, atol=2e-3)
            assert np.ptp(turn.magnitude()) > 0.0


# Other programs


def read_by(made: Made, choice: SkeletonChoice, options: RigOptions, asked: list[str]) -> None:
    _, target, character, held = made.scenes(choice, options)
    together = replace(attached(without_morphs(character), [held], target), name="Together")
    for scene in (held, together):
        readers.judge(made.folder / f"{scene.name}.fbx", what_it_holds(made.file(scene)), asked)


@pytest.mark.parametrize("choice", ["suisou", "ue5"])
def test_other_programs_read_the_same(made: Made, choice: SkeletonChoice) -> None:
    read_by(made, choice, TOGETHER[choice == "ue5"], [name for name in readers.QUICK_FBX if readers.installed(name)])


@pytest.mark.readers
@pytest.mark.parametrize("reader", readers.SLOW_FBX)
def test_slow_readers_read_the_same(made: Made, reader: str) -> None:
    if not readers.installed(reader):
        pytest.skip(f"{reader} is not installed")
    read_by(made, "ue5", TOGETHER[0], [reader])


@pytest.mark.parametrize("attachment", ["socket", "ik"])
def test_with_reduced_keys_an_instrument_stays_on_its_socket(made: Made, attachment: Attachment) -> None:
    """In two files and in one scene the instrument's bounding box is where it is with keys on every frame."""
    character, target, scene, held = made.scenes("suisou", RigOptions(attachment))
    formats = frozenset(("fbx",))
    keyed = keyed_character(scene, "reduced", formats, character, target, [made.performer.model])
    keyed_held = keyed_instrument(held, "reduced", formats)
    assert key_count(keyed).written < 0.5 * key_count(keyed).every

    corners_m = np.concatenate([mesh.positions_m for mesh in made.performer.model.meshes])
    box_m = np.array(list(itertools.product(*zip(corners_m.min(axis=0), corners_m.max(axis=0), strict=True))))
    dense = Files(character, target, scene, held).instrument()[:, 0]
    (socket,) = socket_names(target)
    together = made.file(attached(keyed, [keyed_held], target))
    hook = [bone.name for bone in together.bones].index(socket)
    apart = Files(character, target, made.file(keyed), made.file(keyed_held))
    for read in (apart.instrument()[:, 0], world_m(together)[:, hook]):
        off = box_m @ (read - dense)[:, :3, :3].transpose(0, 2, 1) + (read - dense)[:, None, :3, 3]
        assert np.linalg.norm(off, axis=2).max() < 0.6e-3
