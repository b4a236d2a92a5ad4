"""A captured motion is read identically on any rig, regardless of zero pose, names and axes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise, product
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.cuts import Cut
from app.choreography.features import features
from app.choreography.read_motion import guesses, motion_of
from app.errors import FileError
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.read import read_bvh
from app.rig import quaternion
from tests.support.rerigged import (
    REST_POSES,
    mirrored,
    renamed,
    rerigged,
    turned,
    without_joints,
    without_names,
)

SALSA: Final = read_bvh(Path(__file__).parents[2] / "data" / "motion" / "salsa_step.bvh")
"""Captured motion of 19 poses whose zero pose is a standing body."""
MOST_DEG: Final = 3.0
PARTS: Final = (
    *("hip", "abdomen", "chest", "neck", "head"),
    *("Collar", "Shldr", "ForeArm", "Hand", "Buttock", "Thigh", "Shin", "Foot"),
)
TABLES: Final = {
    "mixamo": (
        *("Hips", "Spine", "Spine1", "Neck", "Head"),
        *("{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand", "{}Hip", "{}UpLeg", "{}Leg", "{}Foot"),
    ),
    "nobody's": (
        *("Becken", "Lende", "Brust", "Hals", "Kopf"),
        *("{}Schluesselbein", "{}Oberarm", "{}Elle", "{}Faust", "{}Po", "{}Schenkel", "{}Wade", "{}Sohle"),
    ),
}


def by_table(table: Sequence[str]) -> Callable[[str], str]:
    """Names of bones by another table; fingers and eyes keep theirs."""
    names, sides = dict(zip(PARTS, table, strict=True)), {"l": "Left", "r": "Right"}
    return lambda name: names.get(name) or names.get(name[1:], name).format(sides.get(name[0]))


def off_deg(clip: MotionClip, other: MotionClip) -> dict[str, float]:
    """Angle between the turns of each segment in the world, in the middle frame by size."""
    ours, theirs = clip.world().rotations[:, 1:], other.world().rotations[:, 1:]
    apart = np.abs(np.einsum("fsi,fsi->fs", ours, theirs))
    found = np.degrees(2.0 * np.arccos(np.clip(np.median(apart, axis=0), 0.0, 1.0)))
    return dict(zip(SEGMENTS, found.tolist(), strict=True))


def require_same(bvh: BvhClip, other: BvhClip = SALSA) -> None:
    read, expected = motion_of(bvh, "a.bvh"), motion_of(other, "b.bvh")
    assert {name: off for name, off in off_deg(read.clip, expected.clip).items() if off > MOST_DEG} == {}
    ours, theirs = (clip.world().positions_m[:, 1:] for clip in (read.clip, expected.clip))
    assert ours == pytest.approx(theirs, abs=0.02)


NAMES: Final[dict[str, Callable[[BvhClip], BvhClip]]] = {
    "poser": lambda bvh: bvh,
    **{name: lambda bvh, table=table: renamed(bvh, by_table(table)) for name, table in TABLES.items()},
    "none": without_names,
}


@pytest.mark.parametrize("names", NAMES)
@pytest.mark.parametrize("rest", REST_POSES)
def test_the_dance_is_the_same_whatever_the_zero_pose_and_the_names_are(rest: str, names: str) -> None:
    bvh = NAMES[names](rerigged(SALSA, REST_POSES[rest]))
    require_same(bvh)


LOST: Final = {
    "nothing": "^$",
    "eyes": "Eye",
    "fingers": "Thumb|Index|Mid|Ring|Pinky",
    "eyes and fingers": "Eye|Thumb|Index|Mid|Ring|Pinky",
    "all fingers but one": "Thumb|Index|Ring|Pinky",
}


@pytest.mark.parametrize("rest", ["random", "rolled"])
@pytest.mark.parametrize("lost", LOST)
def test_no_decision_depends_on_the_zero_pose_or_the_unit(rest: str, lost: str) -> None:
    """Dances consist of discrete choices, which last digits could change: the bodies are equal except for rounding,
    even if the rotation of a head or palm in the T-pose is undefined.
    """
    bvh = without_joints(SALSA, lambda name: re.search(LOST[lost], name) is not None)
    other = rerigged(bvh, REST_POSES[rest])
    other = replace(
        other,
        offsets_cm=other.offsets_cm / 2.54,
        root_translation_cm=other.root_translation_cm / 2.54,
        end_sites_cm={joint: end / 2.54 for joint, end in other.end_sites_cm.items()},
    )
    read, expected = motion_of(other, "a.bvh").clip, motion_of(bvh, "b.bvh").clip
    assert max(off_deg(read, expected).values()) < 0.01
    cuts = (Cut(0, 6, 12), Cut(6, 12, 18))
    assert features(read, cuts) == pytest.approx(features(expected, cuts), abs=1e-4)


def test_limbs_that_never_bend_are_the_same_on_any_rig() -> None:
    """The roll of such limbs is undefined by motion; feet, hands, hips and shoulders determine the usual one."""
    straight = {
        f"{side}{part}": np.tile(quaternion.IDENTITY, (len(SALSA.rotations_xyzw), 1))
        for side in "lr"
        for part in ("ForeArm", "Shin")
    }
    rotations = np.array(SALSA.rotations_xyzw)
    for name, turn in straight.items():
        rotations[:, SALSA.names.index(name)] = turn
    bvh = replace(SALSA, rotations_xyzw=rotations)
    read, expected = (motion_of(one, "a.bvh") for one in (rerigged(bvh, REST_POSES["random"]), bvh))
    assert max(off_deg(read.clip, expected.clip).values()) < 0.01
    named = {guess.id: str(guess.arguments.get("joints")) for guess in guesses(read)}
    assert {"leftUpperLeg", "rightUpperLeg"} <= set(named["motion.mean_turns"].split(", "))


def _smooth(bvh: BvhClip) -> BvhClip:
    """Clip with poses between its poses, as in continuous motion."""
    parts = np.linspace(0.0, 1.0, 12, endpoint=False)[:, None]
    rotations = np.array(bvh.rotations_xyzw)
    between = [quaternion.slerp(a, b, np.tile(parts, (1, len(a)))) for a, b in pairwise(rotations)]
    places = [a + parts * (b - a) for a, b in pairwise(np.array(bvh.root_translation_cm))]
    return replace(bvh, rotations_xyzw=np.concatenate(between), root_translation_cm=np.concatenate(places))


def test_a_t_pose_before_the_motion_shows_the_head_and_the_palms() -> None:
    """Many files begin with a T-pose followed by a jump; a dancer's posture counts only on average."""
    bvh = _smooth(without_joints(SALSA, lambda name: re.search(LOST["eyes and fingers"], name) is not None))
    rotations = np.array(bvh.rotations_xyzw)
    rotations[0] = quaternion.IDENTITY
    posed = rerigged(replace(bvh, rotations_xyzw=rotations), REST_POSES["random"])
    expected, found = _smooth(SALSA), {}
    for name, one in (("posed", posed), ("mean", bvh)):
        read = motion_of(one, "a.bvh")
        named = {guess.id: str(guess.arguments.get("joints")) for guess in guesses(read)}
        assert ("motion.mean_turns" in named) == (name == "mean")
        lead = read.cleaned.lead_in
        found[name] = off_deg(read.clip, motion_of(expected, "b.bvh").clip.span(lead, lead + len(read.clip)))
    assert found["posed"]["head"] < MOST_DEG < found["mean"]["head"]
    for hand in ("leftHand", "rightHand"):
        # The palms of that T-pose are not as its knuckles have them.
        assert found["posed"][hand] < 15.0


def _held_at_ends(bvh: BvhClip, before: int, after: int) -> BvhClip:
    """Clip with its zero pose held before and after the motion."""
    rotations, places = np.array(bvh.rotations_xyzw), np.array(bvh.root_translation_cm)
    zero = np.tile(quaternion.IDENTITY, (1, rotations.shape[1], 1))
    parts = [np.repeat(zero, before, axis=0), rotations, np.repeat(zero, after, axis=0)]
    ends = [np.repeat(places[:1], before, axis=0), places, np.repeat(places[-1:], after, axis=0)]
    return replace(bvh, rotations_xyzw=np.concatenate(parts), root_translation_cm=np.concatenate(ends))


@pytest.mark.parametrize("rest", [None, "rolled", "random"])
@pytest.mark.parametrize(("before", "after"), [(60, 0), (1200, 0), (0, 1200), (300, 300)])
def test_a_zero_pose_held_at_the_ends_does_not_move_the_means(rest: str | None, before: int, after: int) -> None:
    """The pose is a T-pose or no body at all, held for 2 to 40 s next to 7 s of motion."""
    bvh = _smooth(SALSA)
    bvh = bvh if rest is None else rerigged(bvh, REST_POSES[rest])
    read, expected = motion_of(_held_at_ends(bvh, before, after), "a.bvh"), motion_of(bvh, "b.bvh")
    assert (read.cleaned.lead_in, len(read.clip)) == (before, len(expected.clip))
    assert max(off_deg(read.clip, expected.clip).values()) < MOST_DEG
    assert read.apart_m == pytest.approx(expected.apart_m, abs=0.01)


def test_repeated_frames_may_differ_by_rounding() -> None:
    bvh = _smooth(SALSA)
    noise = np.random.default_rng(1).normal(
        scale=1e-7, size=(4 * len(bvh.rotations_xyzw), *SALSA.rotations_xyzw.shape[1:])
    )
    held = replace(
        bvh,
        fps=4 * bvh.fps,
        rotations_xyzw=quaternion.normalize(np.repeat(np.array(bvh.rotations_xyzw), 4, axis=0) + noise),
        root_translation_cm=np.repeat(np.array(bvh.root_translation_cm), 4, axis=0),
    )
    read = motion_of(held, "a.bvh")
    assert (read.cleaned.held, read.clip.fps, len(read.clip)) == (4, bvh.fps, len(bvh.rotations_xyzw))


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**31 - 1))
def test_the_dance_is_the_same_for_any_zero_pose(seed: int) -> None:
    """Whole bodies, with head and hands: every bone turned anyhow."""
    turns = np.asarray(Rotation.random(len(SALSA.names), random_state=seed).as_quat(), np.float64)
    require_same(rerigged(SALSA, lambda _: turns))


@pytest.mark.parametrize(
    ("lost", "joints"),
    [("Eye", "head"), ("Index|Ring|Pinky", ""), ("Thumb|Index|Mid|Ring|Pinky", "leftHand, rightHand")],
)
def test_parts_that_only_their_mean_turns_are_named(lost: str, joints: str) -> None:
    """Eyes determine the direction of a face; knuckles, or one knuckle and a thumb, that of a palm."""
    bvh = without_joints(SALSA, lambda name: re.search(lost, name) is not None)
    read = motion_of(rerigged(bvh, REST_POSES["x"]), "a.bvh")
    named = {guess.id: guess.arguments for guess in guesses(read)}
    assert named.get("motion.mean_turns", {"joints": ""}) == {"joints": joints}
    if not joints:
        off = off_deg(read.clip, motion_of(bvh, "b.bvh").clip)
        assert max(off["leftHand"], off["rightHand"]) < 10.0


def test_a_head_at_which_the_file_ends_is_no_crown() -> None:
    """A head without eyes, end and names is recognised by its rotation, which the top of a head does not have."""
    bvh = without_names(without_joints(SALSA, lambda name: re.search("Eye", name) is not None))
    head = SALSA.names.index("head")
    ended = replace(bvh, end_sites_cm={**bvh.end_sites_cm, head: np.zeros(3)})
    read, expected = motion_of(ended, "a.bvh"), motion_of(SALSA, "b.bvh")
    assert off_deg(read.clip, expected.clip)["head"] < 10.0
    places = [one.clip.world().positions_m[:, 1 + SEGMENTS.index("head")] for one in (read, expected)]
    assert places[0] == pytest.approx(places[1], abs=0.03)


@pytest.mark.parametrize("names", NAMES)
def test_a_standing_zero_pose_is_the_same_whatever_the_names_are(names: str) -> None:
    read, expected = motion_of(NAMES[names](SALSA), "a.bvh"), motion_of(SALSA, "b.bvh")
    assert max(off_deg(read.clip, expected.clip).values()) < 0.01


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
@pytest.mark.parametrize("names", ["poser", "none"])
def test_any_axis_may_be_up(axis: tuple[float, float, float], names: str) -> None:
    turn = quaternion.from_axis_angle(axis, 0.5 * np.pi)
    read = motion_of(NAMES[names](rerigged(turned(SALSA, turn), REST_POSES["x"])), "a.bvh")
    assert read.up == ("+Z" if axis[0] else "-X")
    expected = motion_of(SALSA, "b.bvh").clip
    up = read.clip.world().positions_m[:, 1:, 1] - expected.world().positions_m[:, 1:, 1]
    assert np.abs(up - up.mean()).max() < 0.02
    assert max(_local_deg(read.clip, expected)) < MOST_DEG


def _local_deg(clip: MotionClip, other: MotionClip) -> list[float]:
    """Angles like those of `off_deg`, but relative to the hips, whose facing differs between worlds."""
    found = []
    for at in range(1, len(SEGMENTS)):
        turns = [
            quaternion.multiply(quaternion.conjugate(world[:, 1]), world[:, 1 + at])
            for world in (clip.world().rotations, other.world().rotations)
        ]
        apart = float(np.median(np.abs(np.einsum("fi,fi->f", *turns))))
        found.append(float(np.degrees(2.0 * np.arccos(min(1.0, apart)))))
    return found


@pytest.mark.parametrize("rest", [None, "x", "random"])
@pytest.mark.parametrize("names", NAMES)
def test_the_left_is_where_the_knees_and_toes_say(rest: str | None, names: str) -> None:
    """A mirrored motion is danced mirrored, although the names of its bones are not exchanged."""
    mirror = mirrored(SALSA if rest is None else rerigged(SALSA, REST_POSES[rest]))
    read, expected = motion_of(NAMES[names](mirror), "a.bvh"), motion_of(SALSA, "b.bvh")
    said = [guess for guess in guesses(read) if guess.id == "motion.sides"]
    # Names that say nothing are not gainsaid; nor are those of a motion that is as they say.
    assert bool(said) is (names != "none")
    assert all("leftUpperArm" in str(guess.arguments["joints"]) for guess in said)
    assert "motion.sides" not in {guess.id for guess in guesses(motion_of(NAMES[names](SALSA), "c.bvh"))}
    ours, theirs = (one.clip.world().positions_m[:, 1:] for one in (read, expected))
    sides = {"left": "right", "righ": "left"}
    other = [SEGMENTS.index(sides.get(name[:4], name[:4]) + name[4 + name.startswith("right") :]) for name in SEGMENTS]
    assert ours[:, other] * (-1.0, 1.0, 1.0) == pytest.approx(theirs, abs=0.02)


@pytest.mark.parametrize("lost", ["Eye", "(Thumb|Index|Mid|Ring|Pinky)"])
@pytest.mark.parametrize("names", ["poser", "none"])
def test_joints_are_where_they_were_though_bones_lack(lost: str, names: str) -> None:
    bvh = without_joints(SALSA, lambda name: re.search(lost, name) is not None)
    read, expected = motion_of(NAMES[names](rerigged(bvh, REST_POSES["y"])), "a.bvh"), motion_of(bvh, "b.bvh")
    ours, theirs = (one.clip.world().positions_m[:, 1:] for one in (read, expected))
    assert ours == pytest.approx(theirs, abs=0.03)


@pytest.mark.parametrize("names", NAMES)
@pytest.mark.parametrize("rest", [None, "x", "random"])
def test_a_joint_straight_below_the_ankle_does_not_say_where_the_foot_points(rest: str | None, names: str) -> None:
    """Some rigs have a forefoot there whose end is ahead of it."""
    frames, joints = SALSA.rotations_xyzw.shape[:2]
    feet = {side: SALSA.names.index(f"{side}Foot") for side in "lr"}
    below = {at: np.array([0.0, -0.15 * np.linalg.norm(SALSA.end_sites_cm[at]), 0.0]) for at in feet.values()}
    ends = {at: end for at, end in SALSA.end_sites_cm.items() if at not in below}
    still = np.tile(quaternion.IDENTITY, (frames, len(feet), 1))
    bvh = replace(
        SALSA,
        names=(*SALSA.names, *(f"{side}ForeFoot" for side in feet)),
        parents=(*SALSA.parents, *feet.values()),
        offsets_cm=np.concatenate([SALSA.offsets_cm, list(below.values())]),
        end_sites_cm=ends | {joints + n: SALSA.end_sites_cm[at] - below[at] for n, at in enumerate(feet.values())},
        rotations_xyzw=np.concatenate([SALSA.rotations_xyzw, still], axis=1),
    )
    bvh = NAMES[names](bvh)
    require_same(bvh if rest is None else rerigged(bvh, REST_POSES[rest]))


@pytest.mark.parametrize("names", NAMES)
@pytest.mark.parametrize("rest", [None, "x"])
def test_an_animal_on_four_legs_is_not_danced(rest: str | None, names: str) -> None:
    """Rigs of animals have names of people's bones, and their heads are farthest from their feet along the trunk."""
    rotations, offsets = np.array(SALSA.rotations_xyzw), np.array(SALSA.offsets_cm)
    turns = {"Thigh": (1.0, -90.0), "Shin": (1.0, 6.0), "Shldr": (0.0, 90.0), "ForeArm": (0.0, 6.0)}
    for (part, (across, deg)), side in product(turns.items(), "lr"):
        turned_deg = deg if across or side == "r" else -deg
        turn = quaternion.from_axis_angle((across, 1.0 - across, 0.0), np.radians(turned_deg))
        rotations[:, SALSA.names.index(side + part)] = turn
    for part in ("abdomen", "chest", "neck"):
        offsets[SALSA.names.index(part)] *= 3.0
    bvh = NAMES[names](replace(SALSA, rotations_xyzw=rotations, offsets_cm=offsets))
    with pytest.raises(FileError) as raised:
        motion_of(bvh if rest is None else rerigged(bvh, REST_POSES[rest]), "elephant.bvh")
    assert raised.value.message.id == "motion.misread"
    assert "hips" in str(raised.value.message.arguments["joints"])


def test_feet_that_point_back_are_named() -> None:
    """Such a motion is refused, with the joint and the angle in the message."""
    back = {
        joint: end * ((1.0, 1.0, -1.0) if "Foot" in SALSA.names[joint] else (1.0, 1.0, 1.0))
        for joint, end in SALSA.end_sites_cm.items()
    }
    for rest in REST_POSES.values():
        with pytest.raises(FileError) as caught:
            motion_of(rerigged(replace(SALSA, end_sites_cm=back), rest), "a.bvh")
        assert caught.value.message.id == "motion.misread"
        joints = str(caught.value.message.arguments["joints"])
        assert re.search(r"\b(left|right)Foot 1[0-8]\d°", joints), joints


def _turned(bvh: BvhClip, turns: dict[str, FloatArray]) -> BvhClip:
    """Clip with additional rotations (F, 4) of some bones in their own axes."""
    rotations = np.array(bvh.rotations_xyzw)
    for name, turn in turns.items():
        joint = bvh.names.index(name)
        rotations[:, joint] = quaternion.multiply(rotations[:, joint], turn)
    return replace(bvh, rotations_xyzw=rotations)


@pytest.mark.parametrize("palm_deg", [-60.0, 70.0])
def test_a_palm_that_is_turned_all_the_time_is_danced_so(palm_deg: float) -> None:
    """A thumb reveals the palm's direction, also if the forearm's bone rotates it: the constant rotation is not
    mistaken for the T-pose.
    """
    frames = len(SALSA.rotations_xyzw)
    angles = np.radians(palm_deg + 8.0 * np.sin(np.arange(frames)))
    palm = quaternion.from_axis_angle((1.0, 0.0, 0.0), angles)
    plain = rerigged(
        without_joints(SALSA, lambda name: re.search("Index|Mid|Ring|Pinky", name) is not None), REST_POSES["x"]
    )
    read, usual = (motion_of(one, "a.bvh").clip for one in (_turned(plain, {"lForeArm": palm}), plain))
    for name, most_deg in (("leftHand", 1.0), ("leftUpperArm", 1.0), ("rightHand", 1.0)):
        at = 1 + SEGMENTS.index(name)
        ours, theirs = (clip.world().rotations[:, at] for clip in (read, usual))
        off = np.degrees(
            np.linalg.norm(
                quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(theirs), ours)), axis=1
            )
        )
        expected = abs(np.degrees(angles)) if name == "leftHand" else 0.0
        assert np.abs(off - expected).max() < most_deg, name


def test_who_leans_ahead_all_the_time_is_danced_so() -> None:
    """A runner's constant lean is not mistaken for the T-pose."""
    plain = rerigged(SALSA, REST_POSES["x"])
    lean = np.tile(quaternion.from_axis_angle((1.0, 0.0, 0.0), 0.45), (len(SALSA.rotations_xyzw), 1))
    leaning = rerigged(_turned(SALSA, {"abdomen": lean}), REST_POSES["x"])
    read, usual = (motion_of(one, "a.bvh").clip for one in (leaning, plain))
    assert max(off_deg(read, motion_of(_turned(SALSA, {"abdomen": lean}), "b.bvh").clip).values()) < 2.0 * MOST_DEG
    assert off_deg(read, usual)["chest"] == pytest.approx(np.degrees(0.45), abs=5.0)
