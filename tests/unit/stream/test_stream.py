"""Poses as VMC over real UDP, read by an independent OSC reader: the world pose is reproduced within a float's
precision.
"""

from __future__ import annotations

import dataclasses
import math
import socket
import struct
import time
from fractions import Fraction
from functools import cache
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.performed.dancers import dancing_of
from app.editor.streaming import Streaming
from app.messages import error_text
from app.motion.faces.eyes import EYE_SHAPES
from app.performance.bodies import character_of
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.project.casting import StagePosition
from app.project.model import map_choices, project_from_score
from app.rig.characters.character_library import character_named, characters
from app.rig.characters.load_character import load_character
from app.rig.figure import Figure, OwnSkeleton
from app.rig.model import Character
from app.rig.skeleton import forward
from app.score.read import read_midi
from app.stream.faces import FACE_NAMES, VRM_PRESETS
from app.stream.packets import MOST_BYTES
from app.stream.sender import Sender, SendOutcome, StreamError, find_address, is_loopback, reaches_many
from app.stream.vmc import Sent, unity_bone
from instrument_maps.load import bundled_maps
from metadata.load import load_skeleton
from tests.support.doubled import flutist
from tests.support.osc import Frame, Receiver, frames, read_packet
from tests.unit.export.unreal.conftest import with_dancers

_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
HUMAN_BODY_BONES = (
    *("Hips", "Spine", "Chest", "UpperChest", "Neck", "Head", "Jaw"),
    *(
        side + part
        for side in ("Left", "Right")
        for part in (
            *("Eye", "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes"),
            *(finger + bone for finger in _FINGERS for bone in ("Proximal", "Intermediate", "Distal")),
        )
    ),
)
"""Members of Unity's enumeration HumanBodyBones, without LastBone."""
PARENT = {
    "Spine": "Hips",
    "Chest": "Spine",
    "UpperChest": "Chest",
    "Neck": "UpperChest",
    "Head": "Neck",
    "Jaw": "Head",
    "Eye": "Head",
    "Shoulder": "UpperChest",
    "UpperArm": "Shoulder",
    "LowerArm": "UpperArm",
    "Hand": "LowerArm",
    "UpperLeg": "Hips",
    "LowerLeg": "UpperLeg",
    "Foot": "LowerLeg",
    "Toes": "Foot",
    "Hips": "",
}
"""Parent of each of these bones in Unity."""


@cache
def played() -> tuple[Performance, LiveMotion]:
    maps = bundled_maps()
    quartet = Path(str(files("resources"))) / "examples" / "quartet.mid"
    performance = Performance(project_from_score(read_midi(quartet, maps=map_choices(maps.values())), maps))
    return performance, LiveMotion(performance)


def pose_of(index: int, time_s: float) -> tuple[Character, Pose]:
    performance, motion = played()
    player = performance.project.players[index]
    pose = motion.pose_now(player.id, time_s)
    assert pose is not None
    return character_of(player), pose


def parent_of(bone: str) -> str:
    side = next((side for side in ("Left", "Right") if bone.startswith(side)), "")
    part = bone.removeprefix(side)
    for first, second in (("Distal", "Intermediate"), ("Intermediate", "Proximal"), ("Proximal", "")):
        if part.endswith(first):
            return side + part.removesuffix(first) + second if second else side + "Hand"
    above = PARENT[part]
    return side + above if side and above not in ("Hips", "Head", "UpperChest") else above


def turned(rotation: tuple[float, ...]) -> FloatArray:
    """Matrix of a unit quaternion xyzw by the textbook formula, which also applies to left-handed spaces."""
    x, y, z, w = rotation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def world(frame: Frame) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Position and rotation of every bone as composed by a receiver, converted back to the program's space."""
    mirror = np.diag([-1.0, 1.0, 1.0])
    known: dict[str, tuple[FloatArray, FloatArray]] = {"": (np.array(frame.root[:3]), turned(frame.root[3:]))}

    def of(bone: str) -> tuple[FloatArray, FloatArray]:
        if bone not in known:
            above = parent_of(bone)
            while above and above not in frame.bones:
                above = parent_of(above)
            place, turn = of(above)
            values = frame.bones[bone]
            known[bone] = (place + turn @ np.array(values[:3]), turn @ turned(values[3:]))
        return known[bone]

    for bone in frame.bones:
        of(bone)
    return {bone: (mirror @ place, mirror @ turn @ mirror) for bone, (place, turn) in known.items() if bone}


def ours(character: Character, pose: Pose, stage: StagePosition) -> dict[str, tuple[FloatArray, FloatArray]]:
    rotations = pose.rotations[None].astype(np.float64)
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    at = forward(character.skeleton, rotations, pose.hips_m[None].astype(np.float64))
    cosine, sine = math.cos(stage.turn_rad), math.sin(stage.turn_rad)
    turn = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
    place = np.array([stage.x_m, 0.0, stage.z_m])
    return {
        unity_bone(name): (place + turn @ at.positions_m[0, joint], turn @ turned(tuple(at.rotations[0, joint])))
        for joint, name in enumerate(character.skeleton.names)
    }


def test_a_dancer_is_received_without_an_instrument(tmp_path: Path) -> None:
    project = with_dancers(played()[0].project, tmp_path, "Ana")
    dancing, stage = dancing_of(Performance(project), project.dancers[0]), project.dancers[0].stage
    motion = dancing.motion(Fraction(30), 0, 900)
    aside_m = motion.hips_m[:, 0]
    hips = []
    # Frames in which the dance is farthest from itself, whatever it is.
    for frame_index in (0, int(aside_m.argmin()), int(aside_m.argmax())):
        pose = Pose(
            rotations=motion.rotations[frame_index],
            hips_m=motion.hips_m[frame_index],
            morphs={"eyeBlinkLeft": 0.25},
            controls={},
            instrument_position_m=motion.instrument_position_m[frame_index],
            instrument_rotation=motion.instrument_rotation[frame_index],
        )
        sent = Sent(dancing.character, None).datagrams(pose, 1.5, stage)
        (frame,) = frames([(0.0, packet) for packet in sent])
        assert frame.trackers == {}
        assert frame.face["eyeBlinkLeft"] == 0.25
        assert frame.applied
        found, expected = world(frame), ours(dancing.character, pose, stage)
        for bone in found:
            np.testing.assert_allclose(found[bone][0], expected[bone][0], atol=1e-5)
            np.testing.assert_allclose(found[bone][1], expected[bone][1], atol=1e-5)
        hips.append(found["Hips"][0])
    assert np.ptp(hips, axis=0).max() > 0.01, "a dance, not a pose"


def test_every_joint_is_a_bone_of_unitys() -> None:
    names = [unity_bone(joint.name) for joint in load_skeleton().joints if joint.name != "root"]
    assert sorted(names) == sorted(HUMAN_BODY_BONES)


@pytest.mark.parametrize("index", range(4))
def test_what_is_received_is_the_pose(index: int) -> None:
    stage = StagePosition(1.25, -2.5, 0.7)
    for time_s in (0.0, 3.1, 9.7):
        character, pose = pose_of(index, time_s)
        sent = Sent(character, "horn").datagrams(pose, time_s, stage)
        (frame,) = frames([(0.0, packet) for packet in sent])
        found, expected = world(frame), ours(character, pose, stage)
        assert sorted(found) == sorted(set(expected) - {"Root"})
        assert set(HUMAN_BODY_BONES) - set(found) <= {"Jaw"}
        for bone, (place, turn) in found.items():
            np.testing.assert_allclose(place, expected[bone][0], atol=2e-6)
            np.testing.assert_allclose(turn, expected[bone][1], atol=2e-6)
        assert frame.time_s == pytest.approx(time_s, rel=1e-6)


def test_unity_s_left_is_left_and_forward_is_forward() -> None:
    """Neither mirrored nor rotated: the left hand is at -X, and objects in front at +Z."""
    character, pose = pose_of(0, 2.0)
    (frame,) = frames([(0.0, packet) for packet in Sent(character, "horn").datagrams(pose, 0.0)])
    assert frame.bones["LeftUpperLeg"][0] < -0.03 < 0.03 < frame.bones["RightUpperLeg"][0]
    (place,) = frame.trackers.values()
    assert place[2] > 0.1
    assert frame.bones["Hips"][1] > 0.4


def test_each_instrument_of_a_musician_is_a_tracker_of_one_performer() -> None:
    character, pose = pose_of(1, 5.0)
    aside = dataclasses.replace(pose, instrument_position_m=pose.instrument_position_m + np.float32(0.5))
    sent = Sent(character, "trumpet_Bb", doubles=("flugelhorn_Bb",)).datagrams(pose, 0.0, beside=[aside])
    (frame,) = frames([(0.0, packet) for packet in sent])
    assert set(frame.trackers) == {"trumpet_Bb", "flugelhorn_Bb"}
    apart = np.abs(np.asarray(frame.trackers["flugelhorn_Bb"][:3]) - np.asarray(frame.trackers["trumpet_Bb"][:3]))
    np.testing.assert_allclose(apart, 0.5, atol=1e-5)
    (alone,) = frames([(0.0, packet) for packet in Sent(character, "trumpet_Bb").datagrams(pose, 0.0)])
    assert frame.bones == alone.bones


def test_everyone_on_the_stage_is_sent_once() -> None:
    state, project = Streaming(), flutist()
    state.set(everyone=True)
    assert [line.player_id for line in state.planned(project, ())] == ["2.1.1", "3.1.1"]
    state.set(everyone=False)
    assert [line.player_id for line in state.planned(project, ("2.1.17",))] == ["2.1.1"]


def test_the_instrument_is_a_tracker_where_it_is_held() -> None:
    character, pose = pose_of(1, 5.0)
    (frame,) = frames([(0.0, packet) for packet in Sent(character, "trumpet_Bb").datagrams(pose, 0.0)])
    at = frame.trackers["trumpet_Bb"]
    np.testing.assert_allclose(np.array(at[:3]) * [-1, 1, 1], pose.instrument_position_m, atol=1e-6)
    mirror = np.diag([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(
        mirror @ turned(at[3:]) @ mirror, turned(tuple(map(float, pose.instrument_rotation))), atol=1e-6
    )


def test_packets_fit_and_the_face_is_applied_once_at_its_end() -> None:
    character, pose = pose_of(0, 4.0)
    for naming in FACE_NAMES:
        packets = Sent(character, "trombone_tenor", naming).datagrams(pose, 1.0)
        assert max(map(len, packets)) <= MOST_BYTES
        reported = [message for packet in packets for message in read_packet(packet)]
        assert [message.address for message in reported].count("/VMC/Ext/Blend/Apply") == 1
        assert reported[-1].address == "/VMC/Ext/Blend/Apply"
        assert reported[0].address == "/VMC/Ext/OK"


def test_faces_in_the_names_that_a_receiver_knows() -> None:
    character, pose = pose_of(0, 4.0)
    pose = dataclasses.replace(pose, morphs={"jawOpen": 0.4, "eyeBlinkLeft": 1.0, "mouthSmileLeft": 0.6})

    def face(naming: str) -> dict[str, float]:
        sent = Sent(character, "horn", naming)
        (frame,) = frames([(0.0, packet) for packet in sent.datagrams(pose, 0.0)])
        return frame.face

    arkit = face("arkit")
    # Eyes are turned by their bones.
    assert set(arkit) == {morph.name for mesh in character.meshes for morph in mesh.morphs} - set(EYE_SHAPES)
    moved = {name: value for name, value in arkit.items() if value}
    assert moved == pytest.approx({"jawOpen": 0.4, "eyeBlinkLeft": 1.0, "mouthSmileLeft": 0.6})
    assert face("arkit_capital")["JawOpen"] == pytest.approx(0.4)
    vrm = face("vrm")
    assert set(vrm) == set(VRM_PRESETS)
    assert (vrm["A"], vrm["Blink_L"], vrm["Blink_R"], vrm["Joy"]) == pytest.approx((0.4, 1.0, 0.0, 0.3))


def test_a_character_without_a_face_sends_none() -> None:
    character, pose = pose_of(0, 4.0)
    bare = dataclasses.replace(
        character, meshes=tuple(dataclasses.replace(mesh, morphs=()) for mesh in character.meshes)
    )
    for naming in FACE_NAMES:
        (frame,) = frames([(0.0, packet) for packet in Sent(bare, "horn", naming).datagrams(pose, 0.0)])
        assert frame.face == {}
        assert not frame.applied


def test_a_bone_the_file_lacks_is_not_sent_and_its_turn_is_not_lost() -> None:
    character, pose = pose_of(0, 6.0)
    lacking = {"upperChest", "leftThumbMetacarpal", "leftToes", "rightShoulder", "chest"}
    names = character.skeleton.names
    own = OwnSkeleton(
        figure=Figure("x.vrm", "vrm1", (), (), np.zeros((0, 3)), np.zeros((0, 4)), ()),
        bone_of_joint=tuple(-1 if name in lacking or name == "root" else at for at, name in enumerate(names)),
        joint_from_bone=np.tile([0.0, 0.0, 0.0, 1.0], (len(names), 1)),
        t_pose=np.zeros((0, 4)),
        morphs={},
    )
    foreign = dataclasses.replace(character, own=own)
    (frame,) = frames([(0.0, packet) for packet in Sent(foreign, "horn").datagrams(pose, 0.0)])
    assert {unity_bone(name) for name in names if name != "root"} - set(frame.bones) == {
        unity_bone(name) for name in lacking
    }
    found, expected = world(frame), ours(character, pose, StagePosition(0.0, 0.0, 0.0))
    for bone, (place, turn) in found.items():
        np.testing.assert_allclose(place, expected[bone][0], atol=2e-6)
        np.testing.assert_allclose(turn, expected[bone][1], atol=2e-6)


@pytest.mark.parametrize("name", ["toddler_vrm1.vrm", "man_cmu.fbx", "elder_vrm0.vrm"])
def test_characters_of_other_makers_in_any_pose(name: str) -> None:
    character = load_character(Path(__file__).parents[2] / "data" / "characters" / name)
    generator = np.random.default_rng(5)
    count = len(character.skeleton.names)
    rotations = generator.normal(0.0, 0.3, (count, 4))
    rotations[:, 3] += 1.0
    rotations /= np.linalg.norm(rotations, axis=1, keepdims=True)
    rotations[0] = (0.0, 0.0, 0.0, 1.0)
    hips_m = character.skeleton.offsets_m[character.skeleton.index("hips")] + (0.1, -0.05, 0.02)
    pose = Pose(
        rotations.astype(np.float32),
        hips_m.astype(np.float32),
        {},
        {},
        np.zeros(3, np.float32),
        rotations[0].astype(np.float32),
    )
    (frame,) = frames([(0.0, packet) for packet in Sent(character, "horn").datagrams(pose, 0.0)])
    found, expected = world(frame), ours(character, pose, StagePosition(0.0, 0.0, 0.0))
    own = character.own
    assert len(found) == sum(bone >= 0 for bone in own.bone_of_joint[1:]) > 20
    for bone, (place, turn) in found.items():
        np.testing.assert_allclose(place, expected[bone][0], atol=3e-6)
        np.testing.assert_allclose(turn, expected[bone][1], atol=3e-6)


def test_over_the_wire() -> None:
    character, pose = pose_of(2, 7.0)
    packets = Sent(character, "horn").datagrams(pose, 7.0)
    with Receiver() as receiver:
        sender = Sender(find_address("127.0.0.1", receiver.port))
        for _ in range(30):
            assert sender.send(packets) is SendOutcome.SENT
        assert receiver.wait(lambda: len(receiver.packets) == 30 * len(packets))
        sender.close()
        assert [packet for _, packet in receiver.packets] == packets * 30


def test_a_missing_receiver_is_no_error_and_a_later_one_receives() -> None:
    character, pose = pose_of(0, 1.0)
    packets = Sent(character, "horn").datagrams(pose, 1.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    sender = Sender(find_address("localhost", port))
    start_s = time.process_time()
    outcomes = {sender.send(packets) for _ in range(50)}
    assert time.process_time() - start_s < 0.5
    assert outcomes <= {SendOutcome.SENT, SendOutcome.NO_RECEIVER}
    with Receiver(port) as receiver:
        for _ in range(5):
            sender.send(packets)
        assert receiver.wait(lambda: len(receiver.frames) >= 3)
    sender.close()


def test_a_full_buffer_drops_the_frame_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sender = Sender(find_address("127.0.0.1", 40000))
    sender.close()

    class Full:
        def send(self, data: bytes) -> int:
            raise BlockingIOError

    monkeypatch.setattr(sender, "_socket", Full())
    assert sender.send([b"abcd"]) is SendOutcome.DROPPED


def test_what_cannot_be_reached_is_said() -> None:
    with pytest.raises(StreamError) as unknown:
        find_address("no such host.invalid", 39539)
    assert "no such host.invalid" in error_text(unknown.value)
    with pytest.raises(StreamError) as port:
        find_address("127.0.0.1", 70000)
    assert "70000" in error_text(port.value)
    with pytest.raises(StreamError):
        find_address(" ", 39539)


@pytest.mark.parametrize(
    "host", ["255.255.255.255", "127.255.255.255", "224.0.0.1", "239.255.0.1", "ff02::1", "::ffff:239.1.2.3"]
)
def test_many_computers_are_reached_only_where_that_is_asked_for(host: str) -> None:
    address = find_address(host, 39539)
    assert reaches_many(address)
    with pytest.raises(StreamError) as refused:
        Sender(address)
    assert host in error_text(refused.value)


def test_a_name_of_both_kinds_of_address_is_reached_by_the_older(monkeypatch: pytest.MonkeyPatch) -> None:
    both = [
        (socket.AF_INET6, socket.SOCK_DGRAM, 17, "", ("::1", 39539, 0, 0)),
        (socket.AF_INET, socket.SOCK_DGRAM, 17, "", ("127.0.0.1", 39539)),
    ]
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: both)
    address = find_address("studio", 39539)
    assert (address.family, address.at) == (socket.AF_INET, ("127.0.0.1", 39539))


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost"])
def test_one_computer_is_one(host: str) -> None:
    assert not reaches_many(find_address(host, 39539))


def test_loopback_is_known() -> None:
    assert all(map(is_loopback, ("127.0.0.1", "localhost", "::1", "127.1.2.3", " LocalHost ")))
    assert not any(map(is_loopback, ("192.168.0.2", "studio-pc", "0.0.0.0", "")))


def test_numbers_are_what_the_library_would_write() -> None:
    """The floats are at the positions where python-osc itself reads them."""
    from pythonosc.osc_bundle import OscBundle

    character = character_named(next(iter(characters())))
    _, pose = pose_of(0, 3.0)
    for packet in Sent(character, "horn").datagrams(pose, 2.5):
        messages = list(OscBundle(packet))
        assert [(message.address, tuple(message.params)) for message in messages] == [
            (reported.address, reported.arguments) for reported in read_packet(packet)
        ]


def test_a_frame_costs_little() -> None:
    character, pose = pose_of(0, 3.0)
    sent = Sent(character, "horn")
    start_s = time.process_time()
    for _ in range(200):
        sent.datagrams(pose, 1.0)
    assert (time.process_time() - start_s) / 200 < 0.0015


def test_a_reader_of_osc_refuses_what_is_none() -> None:
    for wrong in (b"abc", b"/a\0\0i\0\0\0", b"/a\0\0,i\0\0", struct.pack(">8sQi4s", b"#bundle\0", 1, 9, b"abcd")):
        with pytest.raises((ValueError, struct.error)):
            read_packet(wrong)
