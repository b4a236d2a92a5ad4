"""Bundled tables are valid, and an invalid one is refused with its exact place."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from app.errors import FileError, MapError
from metadata.known_names import BoneNames, FaceNames, bone_key, morph_key
from metadata.load import (
    GENERIC_CONTROLLER,
    load_body,
    load_controllers,
    load_expression,
    load_expressions,
    load_skeleton,
    names,
    read_body,
    read_bone_names,
    read_controller,
    read_expression,
    read_face_names,
    read_skeleton,
    recognised_controller,
)
from metadata.model import Body, Controller, Expression, at_amplitude
from metadata.skeleton_profile import SkeletonProfile
from metadata.tables import ROOT

READERS = {
    "bodies": read_body,
    "bone_names": read_bone_names,
    "controllers": read_controller,
    "expressions": read_expression,
    "faces": read_face_names,
    "skeletons": read_skeleton,
}

# Effect of each positive axis on a point in the T-pose: (joint, axis, point on the bone, direction of its motion).
ANATOMY = [
    ("spine", "flexion", (0, 1, 0), (0, 0, 1)),
    ("spine", "sideways", (0, 1, 0), (1, 0, 0)),
    ("head", "twist", (0, 0, 1), (1, 0, 0)),
    ("jaw", "flexion", (0, 0, 1), (0, -1, 0)),
    ("leftUpperArm", "flexion", (1, 0, 0), (0, 0, 1)),
    ("rightUpperArm", "flexion", (-1, 0, 0), (0, 0, 1)),
    ("leftUpperArm", "sideways", (1, 0, 0), (0, 1, 0)),
    ("rightUpperArm", "sideways", (-1, 0, 0), (0, 1, 0)),
    ("leftLowerArm", "flexion", (1, 0, 0), (0, 0, 1)),
    ("rightLowerArm", "flexion", (-1, 0, 0), (0, 0, 1)),
    # Supination turns the palm (down) to the front.
    ("leftLowerArm", "twist", (0, -1, 0), (0, 0, 1)),
    ("rightLowerArm", "twist", (0, -1, 0), (0, 0, 1)),
    ("leftHand", "flexion", (1, 0, 0), (0, -1, 0)),
    ("rightHand", "flexion", (-1, 0, 0), (0, -1, 0)),
    ("leftHand", "sideways", (1, 0, 0), (0, 0, 1)),
    ("rightIndexProximal", "flexion", (-1, 0, 0), (0, -1, 0)),
    ("leftUpperLeg", "flexion", (0, -1, 0), (0, 0, 1)),
    ("leftUpperLeg", "sideways", (0, -1, 0), (1, 0, 0)),
    ("rightUpperLeg", "sideways", (0, -1, 0), (-1, 0, 0)),
    ("leftUpperLeg", "twist", (0, 0, 1), (1, 0, 0)),
    ("rightUpperLeg", "twist", (0, 0, 1), (-1, 0, 0)),
    ("leftLowerLeg", "flexion", (0, -1, 0), (0, 0, -1)),
    ("leftFoot", "flexion", (0, 0, 1), (0, 1, 0)),
]


def test_every_bundled_table_loads() -> None:
    assert set(load_expressions()) == {"neutral", "strained", "smile", "brows_up", "puffed", "focused", "tender",
        "eyes_closed", "mournful", "fierce", "bright", "surprised", "proud"}  # fmt: skip
    assert names("body") == ("adult",)
    assert names("skeleton") == ("vrm1",)
    for folder, reader in READERS.items():
        for path in (ROOT / folder).glob("*.toml"):
            assert isinstance(reader(path), Body | BoneNames | Controller | Expression | FaceNames | SkeletonProfile)


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("mixamorig:LeftArm", "leftarm"),
        ("Armature|ns:Left Arm", "leftarm"),
        ("upper_arm.L.001", "upperarml001"),
        ("左人指１", "左人指1"),
        ("name:", "name"),
        ("::", ""),
    ],
)
def test_names_of_bones_are_compared_without_what_does_not_count(name: str, key: str) -> None:
    assert bone_key(name) == key


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("A14_Eye_Blink_Left", "eyeblinkleft"),
        ("Wolf3D_Head.eyeBlinkLeft", "eyeblinkleft"),
        ("blendShape1.MTH_A", "mtha"),
        ("ｳｨﾝｸ２右", "ウィンク2右"),
        ("A1_Stage", "a1stage"),
    ],
)
def test_names_of_morphs_are_compared_without_what_does_not_count(name: str, key: str) -> None:
    assert morph_key(name) == key


def test_what_may_show_while_playing_leaves_the_lips_alone() -> None:
    for name, face in load_expressions().items():
        lips = {morph for morph in face.weights if morph.startswith(("mouth", "jaw", "tongue"))}
        assert not (face.while_playing and lips), name
        assert all(0.0 <= weight <= 1.0 for weight in face.weights.values())
    assert not load_expression("smile").while_playing


def test_the_profile_is_the_vrm_1_humanoid_under_a_root() -> None:
    profile = load_skeleton()
    # Root, hips to head, jaw, eyes, arms, legs, fingers.
    assert len(profile.joints) == 1 + 6 + 1 + 2 + 8 + 8 + 30
    required = {joint.name for joint in profile.joints if joint.required}
    assert {"root", "hips", "spine", "head", "leftUpperArm", "rightHand", "leftFoot"} <= required
    for chain in profile.chains.values():
        for parent, joint in itertools.pairwise(chain):
            assert profile.joint(joint).parent == parent
    for side, fingers in profile.fingers.items():
        assert set(fingers) == {"thumb", "index", "middle", "ring", "little"}
        for finger in fingers.values():
            parents = [profile.joint(name).parent for name in finger.joints]
            assert parents == [f"{side}Hand", *finger.joints[:2]]


@pytest.mark.parametrize(("joint", "axis", "point", "goes_to"), ANATOMY)
def test_positive_angles_do_what_their_names_say(
    joint: str, axis: str, point: tuple[int, int, int], goes_to: tuple[int, int, int]
) -> None:
    about = getattr(load_skeleton().joint_axes(joint), axis)
    assert np.allclose(np.cross(about, point), goes_to)


def test_limits_hold_the_t_pose_and_what_playing_asks() -> None:
    body, profile = load_body(), load_skeleton()
    for joint in profile.joints:
        if joint.kind != "root":
            limits = body.limits[joint.kind]
            assert limits.flexion_deg[0] <= 0.0 <= limits.flexion_deg[1]
            assert limits.source
    assert body.limits["upperArm"].sideways_deg[0] <= -90.0
    for posture in body.postures.values():
        for name, angle in posture.spine_deg.items():
            low, high = body.limits[profile.joint(name).kind].flexion_deg
            assert low <= angle <= high


def test_amplitude_scales_from_residual_to_exaggerated() -> None:
    scale = (0.2, 1.0, 3.0)
    found = [at_amplitude(scale, amplitude) for amplitude in (-1.0, 0.0, 0.25, 0.5, 0.75, 1.0, 2.0)]
    assert found == pytest.approx([0.2, 0.2, 0.6, 1.0, 2.0, 3.0, 3.0])
    body = load_body()
    for part in (body.sway, body.weight_shift, body.bell, body.cue):
        for field in part.__struct_fields__:
            value = getattr(part, field)
            if isinstance(value, tuple):
                assert 0.0 < value[0] < value[1] < value[2], field


@pytest.mark.parametrize(
    ("port", "name"),
    [
        ("EWI-USB MIDI 1", "ewi_usb"),
        ("EWI USB", "ewi_usb"),
        ("EWIUSB", "ewi_usb"),
        ("EWI5000", "ewi_5000"),
        ("Akai EWI 5000 Wind Controller", "ewi_5000"),
        ("EWI4000s", "ewi_4000s"),
        ("ewi-4000s via UM-ONE", "ewi_4000s"),
        ("UM-ONE MIDI 1", "generic"),
        ("", "generic"),
    ],
)
def test_a_controller_is_recognised_by_its_port(port: str, name: str) -> None:
    assert recognised_controller(port).name == name


def test_every_controller_breathes_and_says_how_that_is_known() -> None:
    controllers = load_controllers()
    assert set(controllers) == {"ewi_usb", "ewi_4000s", "ewi_5000", "generic"}
    for controller in controllers.values():
        assert set(controller.breath) == {"cc2", "cc7", "cc11", "channel_pressure"}
        assert controller.source.strip()
        assert (controller.ports == ()) == (controller.name == GENERIC_CONTROLLER)


def changed(tmp_path: Path, source: str, old: str, new: str, name: str | None = None) -> Path:
    text = (ROOT / source).read_text()
    assert old in text
    path = tmp_path / (name or Path(source).name)
    path.write_text(text.replace(old, new, 1))
    return path


@pytest.mark.parametrize(
    ("source", "old", "new", "key", "detail"),
    [
        ("controllers/generic.toml", "ports = []", "ports = ['(']", "ports[0]", "unterminated"),
        ("controllers/generic.toml", '"cc2", "cc11"', '"cc2", "cc2"', "breath", "twice"),
        ("controllers/generic.toml", '"cc2", "cc11"', '"cc2", "cc9"', "breath[1]", "cc9"),
        ("controllers/generic.toml", "channel = 0", "channel = 17", "channel", "<= 16"),
        ("controllers/generic.toml", 'bite = "none"', 'bite = "cc120"', "bite", "regex"),
        ("controllers/generic.toml", 'bite = "none"', 'bite = "cc7"', "bite", "breathes"),
        ("controllers/generic.toml", 'name = "generic"', 'name = "wx7"', "name", "generic"),
        ("expressions/smile.toml", "mouthSmileLeft = 0.72", "mouthGrin = 0.5", "weights.mouthGrin", "52 ARKit"),
        ("expressions/smile.toml", "mouthSmileLeft = 0.72", "mouthSmileLeft = 1.5", "weights", "<= 1.0"),
        ("expressions/smile.toml", "fade_in_s = 0.50", 'fade_in_s = "soon"', "fade_in_s", "float"),
        ("expressions/smile.toml", "fade_in_s = 0.50", "", "", "fade_in_s"),
        ("expressions/smile.toml", "fade_in_s = 0.50", "fade_in_s = 0.5\nfade_s = 1", "", "fade_s"),
        ("expressions/smile.toml", 'name = "smile"', 'name = "grin"', "name", "grin"),
        ("bodies/adult.toml", "hips = { flexion_deg = [-30, 45]", "hips = { flexion_deg = [5, 45]",
         "limits.hips.flexion_deg", "0"),
        ("bodies/adult.toml", "[limits]\nhips = {", "[limits]\ntail = {", "limits.tail", "tail"),
        ("bodies/adult.toml", "jaw = { flex", "# jaw = { flex", "limits", "jaw"),
        ("bodies/adult.toml", 'skeleton = "vrm1"', 'skeleton = "rigify"', "skeleton", "rigify"),
        ("bodies/adult.toml", "[postures.seated]", "[postures.kneeling]", "postures", "kneeling"),
        ("bodies/adult.toml", "upperChest = 2.0, neck", "lowerBack = 2.0, neck", "postures.standing.spine_deg",
         "lowerBack"),
        ("bodies/adult.toml", "mouthFunnel = 0.05", "mouthFunny = 0.05", "embouchure.cup.air.mouthFunny", "ARKit"),
        ("bodies/adult.toml", "side_deg = [0.22, 3.4, 9.0]", "side_deg = [0.22, 3.4]", "sway.side_deg", "length"),
        ("bodies/adult.toml", "chest_s = 0.07", "chest_s = 0.5", "overlap.chest_s", "0.12"),
        ("bodies/adult.toml", "lean_deg = [0.1, 4.0, 10.0]", "lean_deg = [0.1, 4.0, -1]", "phrase.lean_deg", ">= 0.0"),
        ("bodies/adult.toml", "step_s = 0.55", "step_s = 0.0", "footwork.step_s", "> 0.0"),
        ("bodies/adult.toml", "chest_share = 1.0", "chest_share = 1.5", "breath.chest_share", "<= 1.0"),
        ("bodies/adult.toml", "[face.nose]\n", "[face.nose]\nnoseUp = 0.1\n", "face.nose.noseUp", "ARKit"),
        ("bodies/adult.toml", "[face.strain]\n", "[face.strain]\nmouthPucker = 0.1\n", "face.strain.mouthPucker",
         "embouchure"),
        ("bodies/adult.toml", "left_right = [0.045, 0.105]", "left_right = [0.2, 0.1]", "face.left_right", "first"),
        ("bodies/adult.toml", "rise_s = 0.7", "rise_s = 0.0", "face.rise_s", "> 0"),
        ("bodies/adult.toml", "[face.phrase]", "[face.phrases]", "face", "phrase"),
        ("bodies/adult.toml", "give = 0.07", "give = 0.07\nvibrato_hz = [6.0, 5.0]", "embouchure.cup.vibrato_hz",
         "first"),
        ("bodies/adult.toml", "[embouchure.cup.chin]\n", "[embouchure.cup.chin]\nchin = 0.1\n",
         "embouchure.cup.chin.chin", "ARKit"),
        ("bone_names/mixamo.toml", 'name = "mixamo"', 'name = "adobe"', "name", "adobe"),
        ("bone_names/mixamo.toml", "Hand = [", "Paw = [", "sides", "leftPaw"),
        ("bone_names/mixamo.toml", "hips = [", "spine = [", "middle", "spine"),
        ("bone_names/mixamo.toml", '"{side}Shoulder"', '"LeftShoulder"', "sides.Shoulder", "{side}"),
        ("bone_names/mixamo.toml", 'neck = ["Neck"]', 'neck = ["HEAD"]', "head", "neck"),
        ("bone_names/mixamo.toml", 'neck = ["Neck"]', 'neck = ["_"]', "neck", "without letters"),
        ("bone_names/mixamo.toml", 'left = ["Left"]', "left = []", "left", "length"),
        ("faces/vrm.toml", "jawOpen =", "jawWide =", "morphs.jawWide", "ARKit"),
        ("faces/vrm.toml", "oh = 0.7", "oh = 7", "morphs", "<= 1.0"),
        ("faces/vrm.toml", "{ oh = 0.7 }", "{}", "morphs.mouthFunnel", "names nothing"),
        ("faces/vrm.toml", 'of = "expressions"', 'of = "bones"', "of", "bones"),
        ("skeletons/vrm1.toml", 'parent = "hips", kind = "spine"', 'parent = "belly", kind = "spine"',
         "joints[2].parent", "belly"),
        ("skeletons/vrm1.toml", '{ name = "hips", parent = "root"', '{ name = "root", parent = "root"',
         "joints[1].name", "twice"),
        ("skeletons/vrm1.toml", 'parent = "hips", kind = "spine"', 'parent = "", kind = "spine"',
         "joints[2].parent", "root"),
        ("skeletons/vrm1.toml", 'parent = "hips", kind = "spine"', 'parent = "hips", kind = "back"',
         "joints[2].kind", "back"),
        ("skeletons/vrm1.toml", "[axes.jaw]\nflexion = [1.0, 0.0, 0.0]", "[axes.jaw]\nflexion = [2.0, 0.0, 0.0]",
         "axes.jaw", "unit"),
        ("skeletons/vrm1.toml", "[axes.jaw]\nflexion = [1.0, 0.0, 0.0]", "[axes.jaw]\nflexion = [0.99, 0.0, 0.0]",
         "axes.jaw", "unit"),
        ("skeletons/vrm1.toml", '["spine", "chest", "upperChest"]', '["spine", "ribs"]', "chains.spine", "ribs"),
    ],
)  # fmt: skip
def test_a_wrong_table_is_refused_with_its_key(
    tmp_path: Path, source: str, old: str, new: str, key: str, detail: str
) -> None:
    path = changed(tmp_path, source, old, new)
    with pytest.raises(MapError) as caught:
        READERS[source.split("/")[0]](path)
    message = caught.value.message
    assert message.id == "table.invalid"
    assert message.arguments["file"] == path.name
    assert str(message.arguments["place"]).startswith(key)
    assert detail in str(message.arguments["detail"]) + str(message.arguments["place"])


def test_a_syntax_error_names_the_line(tmp_path: Path) -> None:
    path = changed(tmp_path, "expressions/smile.toml", "fade_in_s = 0.50", "fade_in_s = = 0.50")
    with pytest.raises(MapError) as caught:
        read_expression(path)
    assert caught.value.message.id == "table.syntax"
    assert caught.value.message.arguments["line"] == 4


def test_unreadable_files_and_unknown_names_are_our_errors(tmp_path: Path) -> None:
    with pytest.raises(FileError):
        read_expression(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_bytes(b'name = "\xff"')
    with pytest.raises(MapError):
        read_expression(tmp_path / "bad.toml")
    with pytest.raises(MapError) as caught:
        load_body("giant")
    assert caught.value.message.arguments["known"] == "adult"
