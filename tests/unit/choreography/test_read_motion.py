"""Motion of other makers on the 16 segments: positions compared with bvhio, units, axes, refused files."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.contacts import foot_contacts
from app.choreography.foot_plants import stands
from app.choreography.place_units import PLACE_UNITS_M
from app.choreography.read_motion import guesses, motion_of, read_motion
from app.choreography.standing_feet import planted
from app.errors import FileError
from app.formats.bvh.clip import BvhClip
from app.messages import text
from app.rig import quaternion
from tests.support.dance_measures import SHARED
from tests.support.dances import stepping
from tests.support.rerigged import together

pytestmark = pytest.mark.slow

CLIPS = SHARED / "mocap"
LIMBS = {"UpperArm": 0, "LowerArm": 1, "Hand": 2, "UpperLeg": 3, "LowerLeg": 4, "Foot": 5}
POSER = ("Shldr", "ForeArm", "Hand", "Thigh", "Shin", "Foot")
MIXAMO = ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot")
ACCAD = ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
LEAN = 0.06
"""Forward distance of the hips of the usual lean in the T-pose; the joints of the figures in this module are exactly
above one another.
"""
KNOWN = {
    # Names of the limbs' joints in the file, tolerance of arms in metres (a shrug is not among the 16 segments), up.
    "cmu_salsa_01": (POSER, "l", 1e-6, "+Y"),
    "cmu_martial_04": (POSER, "l", 1e-6, "+Y"),
    "animateddrawings_cmu1_jumping_jacks": (ACCAD, "Left", 0.006, "+Y"),
    "animateddrawings_fair1_wave_hello": (MIXAMO, "Left", 0.06, "+Z"),
}


@pytest.mark.filterwarnings("ignore:Importing PyGLM:PendingDeprecationWarning")
@pytest.mark.skipif(not CLIPS.exists(), reason="no clips")
@pytest.mark.parametrize("name", KNOWN)
def test_limbs_are_where_another_reader_has_them(name: str) -> None:
    import bvhio  # warns at its first import

    names, side, tolerance_m, up = KNOWN[name]
    # At the rate stated in the file the motion would be faster than a body.
    read = read_motion(CLIPS / f"{name}.bvh", Fraction(60) if "salsa" in name else None)
    assert read.up == up
    # The neck moves the head by up to 26 mm.
    assert read.apart_m < 0.03 + tolerance_m
    ours = read.clip.world().positions_m
    frames = np.linspace(0, len(read.clip) - 1, 5).astype(int)
    root = bvhio.readAsHierarchy(str(CLIPS / f"{name}.bvh"))
    for frame in frames:
        root.loadPose(int(frame) + read.cleaned.lead_in)
        hips = root.PositionWorld
        for part, at in LIMBS.items():
            joint = next(one for one, _, _ in root.layout() if one.Name == side + names[at])
            way = np.array(joint.PositionWorld - hips, dtype=np.float64) * read.unit_m
            if up == "+Z":
                way = way[[0, 2, 1]] * (1.0, 1.0, -1.0)
            seen = ours[frame, 1 + SEGMENTS.index("left" + part)] - ours[frame, 1]
            allowed = 1e-5 + (tolerance_m if at < 3 else 0.0)
            apart = np.linalg.norm(seen - way)
            assert apart < allowed, (frame, part)
            assert apart < read.apart_m + 1e-6, (frame, part)


def bvh(turn: FloatArray, unit_m: float, frames: int = 20, toes: bool = True) -> str:
    """A small figure of 1.7 m with given axes and unit that stands still."""
    joints = {
        "Hips": ("", (0, 0, 0)),
        "Spine": ("Hips", (0, 0.1, 0)),
        "Spine1": ("Spine", (0, 0.2, 0)),
        "Head": ("Spine1", (0, 0.35, 0)),
        "HeadTop": ("Head", (0, 0.2, 0)),
    }
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        joints |= {
            f"{side}Arm": ("Spine1", (sign * 0.2, 0.2, 0)),
            f"{side}ForeArm": (f"{side}Arm", (sign * 0.1, -0.25, 0)),
            f"{side}Hand": (f"{side}ForeArm", (sign * 0.1, -0.22, 0)),
            f"{side}UpLeg": ("Hips", (sign * 0.1, 0, 0)),
            f"{side}Leg": (f"{side}UpLeg", (0, -0.42, 0)),
            f"{side}Foot": (f"{side}Leg", (0, -0.4, 0)),
        }
        if toes:
            joints[f"{side}ToeBase"] = (f"{side}Foot", (0, -0.05, 0.15))

    def lines(name: str) -> list[str]:
        parent, offset = joints[name]
        x, y, z = turn @ np.array(offset) / unit_m
        kind = "JOINT" if parent else "ROOT"
        channels = "3 Zrotation Xrotation Yrotation"
        if not parent:
            channels = f"6 Xposition Yposition Zposition {channels[2:]}"
        below = [line for child, (above, _) in joints.items() if above == name for line in lines(child)]
        tip = turn @ (0.0, -0.05, 0.15) / unit_m if name.endswith("Foot") else np.zeros(3)
        below = below or ["End Site", "{", f"OFFSET {tip[0]:.6f} {tip[1]:.6f} {tip[2]:.6f}", "}"]
        return [f"{kind} {name}", "{", f"OFFSET {x:.6f} {y:.6f} {z:.6f}", f"CHANNELS {channels}", *below, "}"]

    place = turn @ np.array([3.0, 5.0, 2.0]) / unit_m
    row = " ".join([*(f"{value:.6f}" for value in place), *["0"] * 3 * len(joints)])
    return "\n".join(["HIERARCHY", *lines("Hips"), "MOTION", f"Frames: {frames}", "Frame Time: 0.025", *[row] * frames])


Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize(
    ("unit", "unit_m"), [("m", 1.0), ("cm", 0.01), ("inch", 0.0254), ("CMU", 0.0254 / 0.45), ("mm", 1e-3)]
)
@pytest.mark.parametrize(("turn", "up"), [(np.eye(3), "+Y"), (Z_UP, "+Z")], ids=["y", "z"])
def test_a_figure_of_any_unit_and_axes_stands_on_the_floor(
    tmp_path: Path, turn: FloatArray, up: str, unit: str, unit_m: float
) -> None:
    (tmp_path / "a.bvh").write_text(bvh(turn, unit_m), encoding="utf-8")
    read = read_motion(tmp_path / "a.bvh", Fraction(60))
    assert (read.unit, read.up, read.file_fps, read.clip.fps) == (unit, up, 40, 60)
    shape = read.clip.shape
    # For feet that never move, only the usual shape determines how level their soles are.
    assert shape.offsets_m[0] == pytest.approx((0.0, 0.87, 0.0), abs=0.015)
    # The rest pose hangs its arms; the T-pose has them along +X.
    assert shape.offsets_m[SEGMENTS.index("leftLowerArm")] == pytest.approx((np.hypot(0.1, 0.25), 0, 0), abs=1e-4)
    assert read.clip.hips_m[0] == pytest.approx((0.0, 0.87, 0.0), abs=0.015)
    way = read.clip.world().positions_m[0, 1 + SEGMENTS.index("leftHand")] - read.clip.hips_m[0]
    assert way == pytest.approx((0.4, 0.03, 0.0), abs=1e-4)


@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, 180.0, -90.0, 135.0])
@pytest.mark.parametrize("axes", [np.eye(3), Z_UP], ids=["y", "z"])
@pytest.mark.parametrize("toes", [True, False], ids=["toes", "end sites"])
def test_a_rest_pose_that_faces_elsewhere_keeps_its_sides(
    tmp_path: Path, axes: FloatArray, yaw_deg: float, toes: bool
) -> None:
    yaw = Rotation.from_euler("y", yaw_deg, degrees=True).as_matrix()
    (tmp_path / "a.bvh").write_text(bvh(axes @ yaw, 0.01, toes=toes), encoding="utf-8")
    clip = read_motion(tmp_path / "a.bvh").clip
    # The body faces where it faces in the file, and its left hand is at its left.
    assert quaternion.rotate(clip.rotations[0, 0], (0.0, 0.0, 1.0)) == pytest.approx(yaw[:, 2], abs=LEAN)
    way = clip.world().positions_m[0, 1 + SEGMENTS.index("leftHand")] - clip.hips_m[0]
    assert way == pytest.approx(yaw @ (0.4, 0.03, 0.0), abs=1e-4)


X_UP = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SIDEWAYS = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])


@pytest.mark.parametrize(
    ("axes", "way_m"),
    [
        (np.eye(3), (0.4, 0.03, 0.0)),
        (Z_UP, (0.4, 0.03, 0.0)),
        (Z_UP.T, (0.4, 0.03, 0.0)),
        (X_UP, (0.4, 0.03, 0.0)),
        (SIDEWAYS, (0.0, 0.03, -0.4)),
    ],
    ids=["y", "z", "-z", "x", "sideways"],
)
def test_bones_without_names_are_found_by_shape_whatever_is_up(
    tmp_path: Path, axes: FloatArray, way_m: tuple[float, float, float]
) -> None:
    text = bvh(axes, 0.01)
    names = re.findall(r"(?:ROOT|JOINT) (\S+)", text)
    for number, name in enumerate(names):
        text = re.sub(rf"(ROOT|JOINT) {name}\n", rf"\1 b{number}\n", text)
    (tmp_path / "a.bvh").write_text(text, encoding="utf-8")
    read = read_motion(tmp_path / "a.bvh")
    assert read.profile == ""
    way = read.clip.world().positions_m[0, 1 + SEGMENTS.index("leftHand")] - read.clip.hips_m[0]
    assert way == pytest.approx(way_m, abs=1e-4)


def test_what_is_no_whole_body_is_refused_with_what_lacks(tmp_path: Path) -> None:
    (tmp_path / "b.bvh").write_text(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\nMOTION\nFrames: 1\n"
        "Frame Time: 0.1\n0 0 0",
        encoding="utf-8",
    )
    with pytest.raises(FileError) as caught:
        read_motion(tmp_path / "b.bvh")
    assert caught.value.message.id == "motion.incomplete"


def test_joints_beyond_any_body_are_damage(tmp_path: Path) -> None:
    text = bvh(np.eye(3), 0.01)
    (tmp_path / "a.bvh").write_text(text.replace("300.000000 500.000000", "3e300 500.000000"), encoding="utf-8")
    with pytest.raises(FileError) as caught:
        read_motion(tmp_path / "a.bvh")
    assert caught.value.message.id == "motion.far"


def test_a_body_without_size_is_refused(tmp_path: Path) -> None:
    text = re.sub("OFFSET .*", "OFFSET 0 0 0", bvh(np.eye(3), 0.01))
    (tmp_path / "a.bvh").write_text(text, encoding="utf-8")
    with pytest.raises(FileError) as caught:
        read_motion(tmp_path / "a.bvh")
    assert caught.value.message.id == "motion.no_size"


def test_a_frame_of_hours_is_refused_unless_the_rate_is_given(tmp_path: Path) -> None:
    path = tmp_path / "slow.bvh"
    path.write_text(bvh(np.eye(3), 0.01).replace("Frame Time: 0.025", "Frame Time: 9000"))
    with pytest.raises(FileError) as caught:
        read_motion(path)
    assert caught.value.message.id == "motion.rate_impossible"
    assert caught.value.message.arguments["frame_s"] == 9000.0
    assert read_motion(path, Fraction(60)).clip.fps == 60


def test_a_frame_time_in_milliseconds_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "mistaken.bvh"
    path.write_text(bvh(np.eye(3), 0.01).replace("Frame Time: 0.025", "Frame Time: 33.333"))
    read = read_motion(path)
    assert read.clip.fps == 30
    assert [message.id for message in guesses(read) if message.id.startswith("motion.mill")] == ["motion.milliseconds"]


@pytest.mark.parametrize("bones", PLACE_UNITS_M)
@pytest.mark.parametrize("places", PLACE_UNITS_M)
def test_positions_in_another_unit_than_the_bones_are_understood(bones: str, places: str) -> None:
    """Steps on the floor; some programs write the body's path and its bones in different units."""
    clip = stepping(8)
    sway_m = 0.08 * np.sin(np.arange(len(clip)) / 20.0)[:, None] * np.array((1.0, 0.0, 0.5))
    swaying = replace(clip, hips_m=clip.hips_m + sway_m - np.array((0.0, 0.03, 0.0)))
    clip = planted(swaying, stands(clip, foot_contacts(clip)))
    way_m = clip.hips_m
    parents = tuple(SEGMENTS.index(parent) if parent in SEGMENTS else -1 for parent in PARENT_OF.values())
    ends_m = zip(map(SEGMENTS.index, ENDS), clip.shape.ends_m, strict=True)
    unit = PLACE_UNITS_M[bones]
    offsets, ends = clip.shape.offsets_m / unit, {joint: end / unit for joint, end in ends_m}
    for file_unit in (bones, places):
        root = way_m / PLACE_UNITS_M[file_unit]
        read = motion_of(BvhClip(SEGMENTS, parents, offsets, ends, clip.fps, root, clip.rotations), "steps.bvh")
        said = [message.arguments for message in guesses(read) if message.id == "motion.place_unit"]
        assert said == ([{"unit": places, "bones": bones}] if file_unit != bones else [])
        assert read.unit == bones
        # The first frame is put over the origin.
        assert read.clip.hips_m == pytest.approx(way_m - way_m[0] * (1.0, 0.0, 1.0), abs=0.01)


@pytest.mark.parametrize("rise_m", [0.0, 0.28])
def test_positions_in_inches_and_bones_in_centimetres_are_understood_however_high_the_hips_are(rise_m: float) -> None:
    """Hips far over the hip joints are at a plausible height even where their positions are 2.54 times too small."""
    clip = stepping(8)
    offsets_m = clip.shape.offsets_m.copy()
    legs = [SEGMENTS.index(f"{side}UpperLeg") for side in ("left", "right")]
    offsets_m[legs, 1] -= rise_m
    offsets_m[0, 1] += rise_m
    parents = tuple(SEGMENTS.index(parent) if parent in SEGMENTS else -1 for parent in PARENT_OF.values())
    ends = {SEGMENTS.index(name): end_m / 0.01 for name, end_m in zip(ENDS, clip.shape.ends_m, strict=True)}
    hips_m = clip.hips_m + np.array((0.0, rise_m, 0.0))
    found = []
    for unit_m in (0.0254, 0.01):
        bvh_clip = BvhClip(SEGMENTS, parents, offsets_m / 0.01, ends, clip.fps, hips_m / unit_m, clip.rotations)
        read = motion_of(bvh_clip, "steps.bvh")
        found.append([message.arguments for message in guesses(read) if message.id == "motion.place_unit"])
        assert read.clip.hips_m[:, 1] == pytest.approx(hips_m[:, 1], abs=0.05)
    assert found == [[{"unit": "inch", "bones": "cm"}], []]


def test_a_body_that_is_captured_about_its_hips_keeps_its_unit(tmp_path: Path) -> None:
    path = tmp_path / "centred.bvh"
    head, _, motion = bvh(np.eye(3), 0.01).partition("MOTION\n")
    lines = motion.splitlines()
    rows = [" ".join(["0", f"{0.9 + 0.3 * np.sin(at):.4f}", "0", *row.split()[3:]]) for at, row in enumerate(lines[2:])]
    path.write_text("\n".join([f"{head}MOTION", *lines[:2], *rows]))
    read = read_motion(path)
    assert "motion.place_unit" not in [message.id for message in guesses(read)]
    assert np.ptp(read.clip.hips_m[:, 1]) < 0.01


SWORD = """HIERARCHY
ROOT sword
{
OFFSET 0 0 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 90 0
}
}
"""


def test_a_prop_before_the_body_is_not_taken_for_it(tmp_path: Path) -> None:
    """The first figure that is a body is read and reported; without one, the error names the figures and
    how to choose.
    """
    path, body = tmp_path / "a.bvh", bvh(np.eye(3), 0.01)
    sword = f"{SWORD}MOTION\nFrames: 20\nFrame Time: 0.025\n" + "0 0 0\n" * 20
    path.write_text(together(sword, body), encoding="utf-8")
    read = read_motion(path)
    assert (read.skeleton.figures, read.skeleton.figure_name) == (("sword", "Hips"), "Hips")
    said = next(message for message in guesses(read) if message.id == "motion.figures")
    assert said.arguments == {"name": "Hips", "others": "sword"}
    assert "--figure" in text(said)
    assert read_motion(path, joints={"neck": ""}).skeleton.figure_name == "Hips"
    path.write_text(together(sword, sword.replace("sword", "shield")), encoding="utf-8")
    with pytest.raises(FileError) as caught:
        read_motion(path)
    assert (caught.value.message.id, caught.value.message.arguments["figures"]) == ("motion.no_body", "sword, shield")


@pytest.mark.parametrize("suffix", [".vrma", ".bvh", ".txt"])
def test_content_decides_what_a_file_is(tmp_path: Path, suffix: str) -> None:
    example = Path("tests/data/motion/three_vrm_test.vrma")
    path = tmp_path / f"motion{suffix}"
    path.write_bytes(example.read_bytes())
    assert len(read_motion(path).clip) == len(read_motion(example).clip) > 1


def test_frames_of_seconds_are_counted_as_they_are_learned_from(tmp_path: Path) -> None:
    """A quarter of an hour at one frame per second has sixty times as many frames when a model is learned from it."""
    path = tmp_path / "long.bvh"
    head, _, rows = bvh(np.eye(3), 0.01).partition("Frames: ")
    row = rows.splitlines()[2]
    for frames, is_read in ((800, True), (2000, False)):
        # Seconds per frame: the file grows with its frames, and so does the limit.
        path.write_text(f"{head}Frames: {frames}\nFrame Time: 1\n" + f"{row}\n" * frames)
        if is_read:
            assert len(read_motion(path).clip) == frames
        else:
            with pytest.raises(FileError) as caught:
                read_motion(path)
            assert caught.value.message.id == "motion.too_long"


@pytest.mark.parametrize(("times", "count"), [((4,), Fraction(4)), ((2, 2, 1), Fraction(5, 3))])
def test_repeated_frames_are_read_as_the_distinct_ones(tmp_path: Path, times: tuple[int, ...], count: Fraction) -> None:
    """The number of times a converter wrote each frame changes neither the body nor its motion."""
    head, _, rows = bvh(np.eye(3), 0.01).partition("Frames: ")
    place, zeros = rows.splitlines()[2].split()[:3], len(rows.splitlines()[2].split()) - 3
    angles = 25.0 * np.sin(np.outer(np.arange(90) / 9.0, 0.5 + 0.1 * np.arange(zeros)))
    lines = [" ".join([*place, *(f"{value:.5f}" for value in angle)]) for angle in angles]
    held = [line for at, line in enumerate(lines) for _ in range(times[at % len(times)])]
    clips = []
    for name, some, rate in (("distinct", lines, Fraction(60)), ("held", held, 60 * count)):
        path = tmp_path / f"{name}.bvh"
        path.write_text(f"{head}Frames: {len(some)}\nFrame Time: {float(1 / rate):.9f}\n" + "\n".join(some) + "\n")
        clips.append(read_motion(path))
    distinct, repeated = clips
    assert (distinct.cleaned.held, repeated.cleaned.held) == (1, count)
    assert repeated.clip.fps == distinct.clip.fps
    assert np.array_equal(repeated.clip.rotations, distinct.clip.rotations)
    assert np.array_equal(repeated.clip.hips_m, distinct.clip.hips_m)
    assert "repeated" in " ".join(text(one) for one in guesses(repeated))
