"""Corrections of a motion's bones by the user, where no body or a wrong one is found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.choreography.captured_body import captured_body
from app.choreography.raw_skeleton import JOINTS, BodyError
from app.choreography.read_motion import motion_of
from app.cli import main, parser
from app.cli.choreography.command import PairFiles
from app.cli.status import BAD_INPUT, BAD_USE
from app.formats.bvh.write import write_bvh
from tests.support.rerigged import REST_POSES, mirrored, rerigged, with_prop, without_names
from tests.unit.choreography.test_command import write_drums
from tests.unit.choreography.test_hostile_rests import MOST_DEG, SALSA, off_deg

TRUE: Final = {joint: bone for joint, bone in captured_body(SALSA, "a.bvh").body.joints.items() if joint in JOINTS}
"""Correct bones of `SALSA`, which keep their numbers in its variants."""
SWORD: Final = without_names(with_prop(SALSA, "lHand", [(30.0, 0.0, 0.0)] * 4))
"""Variant without names in which a sword makes an arm's lengths unlike an arm's."""


def corrections(skeleton_bones: dict[str, int]) -> dict[str, str]:
    """Corrections of bones that do not match the true ones."""
    return {joint: SWORD.names[bone] for joint, bone in TRUE.items() if skeleton_bones.get(joint) != bone}


@pytest.mark.parametrize("rest", [None, "x"])
def test_a_body_that_is_not_found_dances_with_its_bones_corrected(rest: str | None) -> None:
    bvh = SWORD if rest is None else rerigged(SWORD, REST_POSES[rest])
    with pytest.raises(BodyError) as caught:
        motion_of(bvh, "a.bvh")
    assert caught.value.message.arguments["joints"]
    wrong = corrections(dict(caught.value.skeleton.found.bones))
    assert wrong
    read = motion_of(bvh, "a.bvh", joints=wrong)
    assert max(off_deg(read.clip, motion_of(SALSA, "b.bvh").clip).values()) < MOST_DEG
    # What is found by itself stays known, so that a correction can be taken back.
    assert read.skeleton.found.bones == caught.value.skeleton.found.bones
    assert {joint: read.skeleton.corrected(wrong).bones[joint] for joint in TRUE} == TRUE


def test_a_correction_that_makes_no_body_is_named_and_can_be_taken_back() -> None:
    with pytest.raises(BodyError) as caught:
        motion_of(SALSA, "a.bvh", joints={"leftLowerLeg": "lHand"})
    assert caught.value.message.id == "motion.incomplete"
    assert caught.value.message.arguments["joints"] == "leftHand"
    assert dict(caught.value.skeleton.found.bones) == dict(captured_body(SALSA, "a.bvh").body.joints)


@settings(max_examples=8)
@given(st.dictionaries(st.sampled_from(JOINTS), st.sampled_from(("", *SALSA.names)), min_size=1, max_size=4))
def test_any_correction_gives_a_body_or_an_error_that_keeps_the_bones(joints: dict[str, str]) -> None:
    found = captured_body(SALSA, "a.bvh").body.joints
    try:
        kept = motion_of(SALSA, "a.bvh", joints=joints).skeleton
    except BodyError as error:
        kept = error.skeleton
    assert dict(kept.found.bones) == dict(found)


def test_a_figure_is_chosen_for_the_pair_before() -> None:
    typed = "choreography learn --pair a.bvh a.mid --figure partner --pair b.bvh b.mid --to x"
    assert [pair.figure for pair in parser().parse_args(typed.split()).pairs] == ["partner", None]


def test_corrections_belong_to_the_pair_before_them() -> None:
    typed = "choreography learn --pair a.bvh a.mid --bone head=Kopf --bone neck= --pair b.bvh b.mid --to x"
    assert parser().parse_args(typed.split()).pairs == (
        PairFiles(Path("a.bvh"), Path("a.mid"), joints={"head": "Kopf", "neck": ""}),
        PairFiles(Path("b.bvh"), Path("b.mid")),
    )


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("--bone head=x --pair a.bvh a.mid", "write it behind a --pair"),
        ("--pair a.bvh a.mid --bone head", "'head' does not assign a bone to a joint"),
        ("--pair a.bvh a.mid --bone head=x --bone head=y", "has head twice"),
    ],
)
def test_a_correction_that_is_mistyped_is_refused(typed: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["choreography", "learn", *typed.split(), "--to", "x"]) == BAD_USE
    assert said in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("correction", "said"),
    [("leftWing=lHand", f"'leftWing' does not exist; choose one of: {', '.join(JOINTS)}"), ("head=kopf", "'kopf'")],
)
def test_a_correction_of_nothing_is_named_with_what_there_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], correction: str, said: str
) -> None:
    motion, drums = tmp_path / "salsa.bvh", write_drums(tmp_path / "drums.mid")
    write_bvh(motion, SALSA)
    learn = ["choreography", "learn", "--pair", str(motion), str(drums), "--bone", correction]
    learn += ["--to", str(tmp_path / "x")]
    assert main(learn) == BAD_INPUT
    assert said in (error := capsys.readouterr().err)
    assert correction.startswith("left") or ", ".join(SALSA.names) in error


@pytest.mark.parametrize("still", [False, True])
@pytest.mark.parametrize("part", ["Foot", "Hand"])
def test_crossed_limbs_are_named(part: str, still: bool) -> None:
    """A lower leg that ends in the other foot is reported, also in a single pose."""
    bvh = replace(SALSA, rotations_xyzw=SALSA.rotations_xyzw[:1], root_translation_cm=SALSA.root_translation_cm[:1])
    crossed = {f"left{part}": f"r{part}", f"right{part}": f"l{part}"}
    with pytest.raises(BodyError) as caught:
        motion_of(bvh if still else SALSA, "a.bvh", joints=crossed)
    assert caught.value.message.id == "motion.misread"
    assert {f"left{part}", f"right{part}"} <= set(str(caught.value.message.arguments["joints"]).split(", "))


@pytest.mark.parametrize("joint", ["neck", "leftIndexProximal"])
def test_sides_are_exchanged_though_another_bone_was_corrected(joint: str) -> None:
    """Names of a mirrored motion have both sides exchanged: the legs' too if only a finger was corrected."""
    bvh = mirrored(SALSA)
    read, expected = motion_of(bvh, "a.bvh", joints={joint: ""}), motion_of(bvh, "b.bvh")
    kept = "Arm" if joint.startswith("left") else ""
    for name, off in off_deg(read.clip, expected.clip).items():
        assert off < MOST_DEG or (kept and (kept in name or "Hand" in name)), name


def test_sides_that_a_user_corrected_stay() -> None:
    bvh = mirrored(SALSA)
    legs = {f"{side}{part}": f"{side[0]}{bone}" for side in ("left", "right")
            for part, bone in (("UpperLeg", "Thigh"), ("LowerLeg", "Shin"), ("Foot", "Foot"))}  # fmt: skip
    with pytest.raises(BodyError) as caught:
        motion_of(bvh, "a.bvh", joints=legs)
    assert caught.value.message.id == "motion.misread"
