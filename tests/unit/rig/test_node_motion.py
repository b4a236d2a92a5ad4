"""A motion is read identically from FBX, GLB and BVH files, with any rest rotations of bones."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.read_motion import read_motion
from app.errors import FileError
from app.export.humanoid import humanoid_scene, humanoid_target
from app.formats import motion_limits
from app.formats.bvh.clip import BvhClip
from app.formats.fbx.foreign import read_foreign_motion
from app.formats.gltf.vrma import write_vrma
from app.formats.scene import Bone, Clip, Scene
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.node_motion import read_gltf_motion
from tests.fuzz.harness.costly_motion import fbx_take
from tests.support.dances import HIPS_M, moving
from tests.support.encoded import encode_bvh, encode_glb, encode_scene
from tests.support.vrm_figures import document_of, write_document
from tests.unit.export.test_foreign_skeletons import random_motion

# A floor that rises under a body would be levelled.
CLIP = replace(moving(91), hips_m=moving(91).hips_m * (1.0, 0.0, 1.0) + (0.0, HIPS_M, 0.0))
IDENTITY = np.array((0.0, 0.0, 0.0, 1.0))


def scene_of(clip: MotionClip, seed: int, animated: bool = True) -> Scene:
    """Clip on bones with rest rotations, below a root that lies on its back."""
    names = ("Armature", *SEGMENTS, *(f"{name}_end" for name in ENDS))
    parents = [-1, 0, *(1 + SEGMENTS.index(above) for above in list(PARENT_OF.values())[1:])]
    parents += [1 + SEGMENTS.index(name) for name in ENDS]
    offsets = np.concatenate([np.zeros((1, 3)), clip.shape.offsets_m, clip.shape.ends_m])
    rest = quaternion.normalize(np.random.default_rng(seed).normal(size=(len(names), 4)))
    rest[0] = quaternion.from_axis_angle((1.0, 0.0, 0.0), -np.pi / 2.0)
    turns = np.zeros((len(clip), len(names), 4))
    turns[..., 3] = 1.0
    turns[:, 1 : 1 + len(SEGMENTS)] = clip.rotations
    back = quaternion.conjugate(np.array([rest[parent] if parent >= 0 else IDENTITY for parent in parents]))
    bones = tuple(
        Bone(names[at], parents[at], 100.0 * quaternion.rotate(back[at], offsets[at]), local)
        for at, local in enumerate(quaternion.multiply(back, rest))
    )
    hips_cm = 100.0 * quaternion.rotate(back[1], clip.hips_m)
    rotations = quaternion.multiply(back, quaternion.multiply(turns, rest))
    if not animated:
        return Scene(bones)
    return Scene(bones, (), Clip("dance", clip.fps, len(clip), rotations, {1: hips_cm}))


def plain_bvh(clip: MotionClip) -> BvhClip:
    """Clip on bones without rest rotations."""
    return BvhClip(
        names=tuple(SEGMENTS),
        parents=(-1, *(SEGMENTS.index(above) for above in list(PARENT_OF.values())[1:])),
        offsets_cm=100.0 * clip.shape.offsets_m * (np.arange(len(SEGMENTS)) > 0)[:, None],
        end_sites_cm={SEGMENTS.index(name): 100.0 * end for name, end in zip(ENDS, clip.shape.ends_m, strict=True)},
        fps=clip.fps,
        root_translation_cm=100.0 * clip.hips_m,
        rotations_xyzw=clip.rotations,
    )


def least_alike(one: FloatArray, other: FloatArray) -> float:
    """Cosine of half the greatest angle between rotations (F, S, 4)."""
    return float(np.abs(np.einsum("fsi,fsi->fs", one, other)).min())


def relative_m(clip: MotionClip) -> FloatArray:
    places: FloatArray = clip.world().positions_m[:, 1:]
    return places - places[:, :1]


@pytest.mark.parametrize(("suffix", "encode"), [(".fbx", encode_scene), (".glb", encode_glb)])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_motion_is_the_same_from_every_format(tmp_path: Path, suffix: str, encode: object, seed: int) -> None:
    path = tmp_path / f"dance{suffix}"
    assert callable(encode)
    path.write_bytes(encode(scene_of(CLIP, seed)))
    (tmp_path / "plain.bvh").write_bytes(encode_bvh(plain_bvh(CLIP)))
    read, plain = read_motion(path), read_motion(tmp_path / "plain.bvh")
    assert (read.clip.fps, read.file_fps, len(read.clip), read.up) == (60, 60, len(CLIP), "+Y")
    assert read.clip.shape.offsets_m == pytest.approx(plain.clip.shape.offsets_m, abs=1e-4)
    assert relative_m(read.clip) == pytest.approx(relative_m(CLIP), abs=2e-4)
    way = read.clip.hips_m - read.clip.hips_m[0]
    assert way == pytest.approx(CLIP.hips_m - CLIP.hips_m[0], abs=2e-4)
    # Rotations, not only places: the identity is the T-pose, whatever the bones' own axes are.
    same = np.cos(np.radians(0.1) / 2.0)
    assert least_alike(read.clip.rotations, plain.clip.rotations) > same
    # The motion shows the T-pose of limbs that bend; trunk, hands and feet are as they usually are.
    limbs = [1 + at for at, name in enumerate(SEGMENTS) if name.endswith(("Arm", "Leg"))]
    assert least_alike(read.clip.world().rotations[:, limbs], CLIP.world().rotations[:, limbs]) > same


@pytest.mark.parametrize(("suffix", "encode"), [(".fbx", encode_scene), (".glb", encode_glb)])
def test_a_file_without_animation_says_so(tmp_path: Path, suffix: str, encode: object) -> None:
    path = tmp_path / f"still{suffix}"
    assert callable(encode)
    path.write_bytes(encode(scene_of(CLIP, 1, animated=False)))
    with pytest.raises(FileError) as caught:
        read_motion(path)
    assert caught.value.message.id == "motion.no_animation"


def test_other_files_are_refused(tmp_path: Path) -> None:
    for name, problem in (("a.mp4", "motion.format"), ("a.fbx", "fbx.foreign_damaged"), ("a.glb", "gltf.not_gltf")):
        (tmp_path / name).write_bytes(b"something else")
        with pytest.raises(FileError) as caught:
            read_motion(tmp_path / name)
        assert caught.value.message.id == problem


@pytest.mark.parametrize("bound", ["MOST_TRANSFORMS", "FREE_TRANSFORMS", "FREE_FRAMES"])
def test_more_motion_than_memory_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, bound: str) -> None:
    for per_kb in ("TRANSFORMS_PER_KB", "FRAMES_PER_KB"):
        monkeypatch.setattr(motion_limits, per_kb, 0)
    path = tmp_path / "a.glb"
    path.write_bytes(encode_glb(scene_of(CLIP, 1)))
    nodes = 22
    exactly = len(CLIP) * (1 if bound == "FREE_FRAMES" else nodes)
    monkeypatch.setattr(motion_limits, bound, exactly)
    assert len(read_motion(path).clip) == len(CLIP)
    monkeypatch.setattr(motion_limits, bound, exactly - 1)
    with pytest.raises(FileError) as caught:
        read_motion(path)
    assert caught.value.message.id == "motion.too_long"


def test_the_last_channel_of_a_node_holds(tmp_path: Path) -> None:
    """A file that names a target repeatedly is sampled once."""
    data = encode_glb(scene_of(CLIP, 1))
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    channels = document["animations"][0]["channels"]
    document["animations"][0]["channels"] = channels[::-1] + channels
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = data[:8] + struct.pack("<III", 20 + len(text) + len(data) - 20 - length, len(text), 0x4E4F534A)
    (tmp_path / "a.glb").write_bytes(data)
    (tmp_path / "b.glb").write_bytes(head + text + data[20 + length :])
    one, other = (read_motion(tmp_path / f"{name}.glb").clip for name in "ab")
    assert np.array_equal(one.rotations, other.rotations)


def test_scaled_armatures_are_multiplied_out(tmp_path: Path) -> None:
    """Blender writes imported FBX files in this way: a root scaled by 0.01, with bones a hundred times as large."""
    data = encode_glb(scene_of(CLIP, 3))
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    names = [node.get("name") for node in document["nodes"]]
    document["nodes"][names.index("Armature")]["scale"] = [0.01] * 3
    hips = document["nodes"][names.index("hips")]
    hips["scale"] = [100.0] * 3
    hips["translation"] = [100.0 * value for value in hips["translation"]]
    animation = document["animations"][0]
    samplers, hips_at = animation["samplers"], names.index("hips")
    (moved,) = (
        channel["sampler"]
        for channel in animation["channels"]
        if channel["target"] == {"node": hips_at, "path": "translation"}
    )
    # The path of the hips is also a hundred times as long, so its keys are rewritten.
    clip = scene_of(CLIP, 3).clip
    keys = np.asarray(clip.translations_cm[1], "<f4")
    binary = data[20 + length + 8 :] + keys.tobytes()
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data) - 28 - length, "byteLength": keys.size * 4})
    document["accessors"].append(
        {"bufferView": len(document["bufferViews"]) - 1, "componentType": 5126, "count": len(keys), "type": "VEC3"}
    )
    samplers[moved]["output"] = len(document["accessors"]) - 1
    document["buffers"][0]["byteLength"] = len(binary)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A)
    (tmp_path / "a.glb").write_bytes(head + text + struct.pack("<II", len(binary), 0x004E4942) + binary)
    read = read_motion(tmp_path / "a.glb", Fraction(60))
    assert relative_m(read.clip) == pytest.approx(relative_m(CLIP), abs=2e-4)
    assert read.clip.hips_m - read.clip.hips_m[0] == pytest.approx(CLIP.hips_m - CLIP.hips_m[0], abs=2e-4)


@pytest.mark.parametrize(("seconds", "frames"), [(2.0, 49), (2000.0, 0)])
def test_an_animation_that_is_too_long_is_not_sampled(tmp_path: Path, seconds: float, frames: int) -> None:
    path = tmp_path / "take.fbx"
    path.write_bytes(fbx_take(seconds))
    motion = read_foreign_motion(path)
    assert len(motion.transforms) == frames
    assert motion.length_s == pytest.approx(seconds)


def test_bones_of_a_vrm_animation_are_those_that_it_says_and_its_face_is_no_bone(tmp_path: Path) -> None:
    """Names of nodes have no meaning; values of expressions and gaze move no body."""
    character = character_named("woman_adult")
    motion = random_motion(character)
    motion = replace(motion, morphs={"jawOpen": np.linspace(0.0, 1.0, motion.frames, dtype=np.float32)})
    scene = humanoid_scene(character, motion, "test", "test", humanoid_target(character))
    path = tmp_path / "a.vrma"
    write_vrma(path, scene)
    document, binary = document_of(path)
    for number, node in enumerate(document["nodes"]):
        node["name"] = f"n{number}"
    read = read_gltf_motion(write_document(tmp_path / "b.vrma", document, binary))
    assert scene.clip is not None
    assert {"jawOpen", "lookAt"}.isdisjoint(read.names)
    assert len(read.names) == len(scene.bones) + 1
    for at, bone in enumerate(scene.bones):
        if bone.name != "lookAt":
            turns = read.rotations_xyzw[:, read.names.index(bone.name)]
            alike = np.abs(np.sum(turns * scene.clip.rotations_xyzw[:, at], axis=-1))
            assert alike.min() > 1.0 - 1e-6, bone.name
