"""The report's bytes, and its criteria for failures."""

from __future__ import annotations

import json
import math
from pathlib import Path

import msgspec
import pytest

from app.cli.summary import columns, summary
from app.contacts.bounds import Spread
from app.contacts.controls import ControlMeasure
from app.export.arm_depths import ArmDepth
from app.export.joint_measures import JointMeasure
from app.export.measure import BreathMeasure, PlayerMeasures
from app.export.report import (
    DancerMeasures,
    PlaceReport,
    PlayerReport,
    Report,
    UnplayedPartReport,
    encode_report,
    failures,
)
from app.export.scene_keys import KeyCount


def measures(**changes: object) -> PlayerMeasures:
    good = PlayerMeasures(
        sounding_frames=10,
        contacts={
            "right.index.pad on valve_1": Spread(1.0, 0.5, 2.0, 10),
            "left.palm on root": Spread(2.5, 2.0, 3.0, 10),
        },
        lips=Spread(0.5, 0.5, 2.0, 10),
        upper_lip_in_breaths=Spread(0.5, 0.5, 2.0, 10),
        feet={"left.foot.sole": Spread(0.1, 0.1, 1.0, 10)},
        bones=Spread(0.0, 0.0, 0.01, 10),
        penetration=Spread(2.9, 2.0, 3.0, 10),
        controls={"valve_1": ControlMeasure(10, 10, 2, 0, 100, 0)},
        limits=JointMeasure("leftHand flexion", -3.0, 0.0, 0),
        acceleration=JointMeasure("head", 10.0, 150.0, 0),
        breaths=BreathMeasure(3, 3, 3, 3),
    )
    return msgspec.structs.replace(good, **changes)


def player(found: PlayerMeasures | None, sway: float | None = 0.5) -> PlayerReport:
    place = PlaceReport(0.0, 0.0, 0.0)
    files = {"character_fbx": "x.fbx"}
    return PlayerReport("Ünal 🎺", "p", "i", "c", "standing", files, place, 10, found, sway, 0.95)


def report(*players: PlayerReport, first_frame_s: float = -2.0) -> Report:
    unplayed = (UnplayedPartReport("tuba", "no map", 3),)
    return Report("v", "s.mid", first_frame_s, 30.0, "30", 10, 1.0, None, 0, players, ("look here",), unplayed)


def test_a_dancer_is_within_bounds_with_feet_that_stand_and_bones_that_keep_their_length() -> None:
    good = DancerMeasures(standing_s=9.0, slide_mm_s=0.1, slide_most_mm_s=9.0, bones_mm=0.0, below_mm=0.0)
    assert good.kept
    assert not msgspec.structs.replace(good, slide_mm_s=50.0).kept
    assert not msgspec.structs.replace(good, bones_mm=5.0).kept


def test_within_all_bounds_is_no_failure() -> None:
    assert failures(player(measures())) == ()
    assert failures(player(None)) == ()


def test_fitted_keys_may_be_beyond_a_joints_limit_by_as_much_as_they_may_turn_a_bone() -> None:
    beyond = player(measures(limits=JointMeasure("x sideways", 0.2, 0.0, 3)))
    assert failures(msgspec.structs.replace(beyond, keys=KeyCount(10, 100))) == ()
    assert failures(msgspec.structs.replace(beyond, keys=KeyCount(100, 100))) == ("limits of x sideways",)
    further = player(measures(limits=JointMeasure("x sideways", 0.3, 0.0, 3)))
    assert failures(msgspec.structs.replace(further, keys=KeyCount(10, 100))) == ("limits of x sideways",)


def test_a_joint_may_pass_the_edge_of_its_range_by_less_than_a_tenth_of_a_degree() -> None:
    limits = {beyond: measures(limits=JointMeasure("x sideways", beyond, 0.1, 3)) for beyond in (0.09, 0.11)}
    assert failures(player(limits[0.09])) == ()
    assert failures(player(limits[0.11])) == ("limits of x sideways",)


@pytest.mark.parametrize(
    "changes",
    [
        {"lips": Spread(2.1, 0.0, 2.0, 10)},
        {"feet": {"left.foot.sole": Spread(1.1, 0.0, 1.0, 10)}},
        {"contacts": {"x": Spread(2.1, 0.0, 2.0, 10)}},
        {"penetration": Spread(3.1, 0.0, 3.0, 10)},
        {"bones": Spread(0.02, 0.0, 0.01, 10)},
        {"controls": {"valve_1": ControlMeasure(10, 9, 0, 0, 100, 0)}},
        {"controls": {"valve_1": ControlMeasure(10, 10, 0, 0, 100, 1)}},
        {"limits": JointMeasure("x", 1.0, 0.0, 1)},
        {"acceleration": JointMeasure("x", 200.0, 150.0, 1)},
        {"breaths": BreathMeasure(3, 3, 2, 2)},
    ],
)
def test_each_broken_bound_is_one(changes: dict[str, object]) -> None:
    assert len(failures(player(measures(**changes)))) == 1


def test_moving_alike_is_a_failure() -> None:
    assert failures(player(measures(), sway=0.95)) == ("sway",)


def test_the_report_is_json() -> None:
    found = json.loads(encode_report(report(player(measures()))).decode("utf-8"))
    assert found["players"][0]["name"] == "Ünal 🎺"
    assert found["players"][0]["measures"]["lips"]["max_mm"] == 0.5


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_are_finite(value: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        encode_report(report(player(measures()), first_frame_s=value))


def test_the_table_marks_what_is_beyond() -> None:
    text = "\n".join(summary(report(player(measures(lips=Spread(2.1, 0.0, 2.0, 10))), player(None)), Path("out")))
    assert "2.10*" in text
    assert "! Ünal 🎺: lips" in text
    assert "tuba (3 notes): no map" in text
    assert "look here" in text
    assert "10/10" in text


def test_every_mark_in_the_table_has_a_line() -> None:
    found = measures(
        contacts={"x": Spread(6.3, 6.3, 2.0, 10)},
        penetration=Spread(12.7, 12.7, 3.0, 10),
        arms=ArmDepth("left", 61.8, 1),
    )
    missed = msgspec.structs.replace(player(found), missed={"x": 7.8, "penetration": 11.4})
    lines = summary(report(missed), Path("out"))
    assert "6.30*" in "\n".join(lines)
    (line,) = (line for line in lines if line.startswith("!"))
    assert line.startswith("! Ünal 🎺: arms, as the hold")
    assert line.endswith(": x, penetration")


def test_the_table_says_that_a_mouth_without_curves_is_not_judged() -> None:
    def said(jaw_open: int | None) -> bool:
        found = report(player(measures(breaths=BreathMeasure(3, jaw_open, 3, 3))))
        return "curves of the mouth are left out" in "\n".join(summary(found, Path("out")))

    assert said(None)
    assert not said(3)


def test_the_table_says_that_a_mouth_is_guessed() -> None:
    """The distance from a guessed place is 0.00 by itself."""
    lines = summary(report(player(measures(lips=Spread(0.0, 0.0, 2.0, 10), lips_guessed=True))), Path("out"))
    assert "?" in next(line for line in lines if line.startswith("Ünal"))
    assert any("its place is guessed" in line and line.endswith("Ünal 🎺)") for line in lines)
    assert not any("guessed" in line for line in summary(report(player(measures())), Path("out")))


def test_columns_stand_below_each_other() -> None:
    assert columns([("a", "bb"), ("ccc", "d")]) == ["a    bb", "ccc   d"]
