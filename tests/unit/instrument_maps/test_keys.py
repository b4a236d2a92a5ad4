"""Keys and holes: labels, half holes, linked parts, and fingers that cannot do two things simultaneously."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import pytest

from app.rig.instrument import part_transform, part_values
from instrument_maps.fingering_label import controls_of, words_of
from instrument_maps.load import bundled_maps
from instrument_maps.model import Control, Endpin, Fingering, InstrumentMap, Link
from instrument_maps.validate import problems

TRUMPET = bundled_maps()["trumpet_Bb"]


def hole(name: str, label: str, finger: str = "left.index", **more: Any) -> Control:
    return Control(name=name, kind="hole", role="pitch", finger=finger, label=label, **more)


HOLES = (hole("first", "L1", half_value=0.5), hole("second", "L2"), hole("sharp", "C#"))


def test_labels_of_holes_are_words() -> None:
    assert controls_of("C# L1", HOLES) == {"sharp": 1.0, "first": 1.0}
    assert controls_of("L1h L2", HOLES) == {"first": 0.5, "second": 1.0}
    assert controls_of("(open)", HOLES) == {}
    assert controls_of("L3", HOLES) is None
    assert controls_of("L2h", HOLES) is None
    assert words_of({"sharp": 1.0, "first": 0.5, "second": 1.0}, HOLES) == "C# L1h L2"
    assert words_of({}, HOLES) == "(open)"


def test_labels_of_valves_are_put_together() -> None:
    assert controls_of("13", TRUMPET.controls) == {"valve_1": 1.0, "valve_3": 1.0}
    assert controls_of("0", TRUMPET.controls) == {}
    assert controls_of("5", TRUMPET.controls) is None
    assert controls_of("1", bundled_maps()["trombone_tenor_F_attachment"].controls) is None


def found(instrument: InstrumentMap) -> set[str]:
    return {f"{path}: {detail}" for path, detail in problems(instrument)}


def test_a_finger_is_asked_for_one_thing_at_a_time() -> None:
    one_finger = [
        msgspec.structs.replace(control, finger="right.index") if control.name == "valve_2" else control
        for control in TRUMPET.controls
    ]
    reported = found(msgspec.structs.replace(TRUMPET, controls=tuple(one_finger)))
    assert any("no contact lets 'right.index' work 'valve_1' and 'valve_2' together" in line for line in reported)


def test_another_finger_than_usual_needs_a_contact_of_its_own() -> None:
    changed = tuple(
        msgspec.structs.replace(fingering, fingers={"valve_3": "right.little"}) if fingering.label == "3" else fingering
        for fingering in TRUMPET.fingerings
    )
    reported = found(msgspec.structs.replace(TRUMPET, fingerings=changed))
    assert any("no contact lets 'right.little' work 'valve_3'" in line for line in reported)


@pytest.mark.parametrize(
    ("control", "reported"),
    [
        (Control("x", "key", "pitch", "left.index", label="X"), "only a hole may be without a moving part"),
        (hole("x", "two words"), "must be one word"),
        (hole("x", "X", half_value=1.5), "1.5 is not between"),
        (hole("x", "1"), "'1' is used twice"),
    ],
)
def test_what_a_key_or_hole_must_say(control: Control, reported: str) -> None:
    assert any(
        reported in line for line in found(msgspec.structs.replace(TRUMPET, controls=(*TRUMPET.controls, control)))
    )


def test_a_linked_part_goes_with_its_controls() -> None:
    motion = TRUMPET.control("valve_1").motion
    assert motion is not None
    link = Link(node="rod", motion=motion, controls=("valve_1", "valve_2"))
    linked = msgspec.structs.replace(TRUMPET, links=(link,))
    assert found(linked) == set()
    (part,) = [part for part in linked.moving_parts if part.node == "rod"]
    values = {"valve_1": np.array([0.0, 0.2, 1.0]), "valve_2": np.array([0.5, 0.1, 0.0])}
    assert part_values(part, values, 3).tolist() == [0.5, 0.2, 1.0]
    assert part_values(part._replace(when="all"), values, 3).tolist() == [0.0, 0.1, 0.0]
    wrong = Link(node="valve_1", motion=motion, controls=("nothing",))
    reported = found(msgspec.structs.replace(TRUMPET, links=(wrong,)))
    assert any("is moved by something else already" in line for line in reported)
    assert any("there is no control named 'nothing'" in line for line in reported)


def test_an_endpin_slides_by_a_value_of_its_own_name() -> None:
    pin = Endpin(node="pin", axis=(0.0, -1.0, 0.0), tip_m=(0.0, -1.0, 0.3), most_m=0.2)
    standing = msgspec.structs.replace(TRUMPET, endpin=pin)
    assert found(standing) == set()
    part = standing.moving_parts[-1]
    assert (part.name, part.node, part.motion.travel_m) == ("pin", "pin", 0.2)
    moved_m, _ = part_transform(part.motion, part_values(part, {"pin": np.array([0.0, 0.5])}, 2))
    assert moved_m.tolist() == [[0.0, 0.0, 0.0], [0.0, -0.1, 0.0]]


@pytest.mark.parametrize(
    ("change", "reported"),
    [
        ({"node": "valve_1"}, "endpin.node: 'valve_1' is moved by something else already"),
        ({"node": "root"}, "endpin.node: 'root' is moved by something else already"),
        ({"axis": (0.0, -2.0, 0.0)}, "endpin.axis: [0.0, -2.0, 0.0] has the length 2, not 1"),
        ({"tip_m": (0.0, -9.0, 0.0)}, "endpin.tip_m: [0.0, -9.0, 0.0] is not a point in metres near the instrument"),
        ({"most_m": 0.0}, "endpin.most_m: 0 is not between 0.001 and 1"),
    ],
)
def test_what_an_endpin_must_say(change: dict[str, Any], reported: str) -> None:
    pin = Endpin(node="pin", axis=(0.0, -1.0, 0.0), tip_m=(0.0, -1.0, 0.3), most_m=0.2)
    wrong = msgspec.structs.replace(TRUMPET, endpin=msgspec.structs.replace(pin, **change))
    assert found(wrong) == {reported}


def test_fingerings_without_controls_read_them_from_their_label() -> None:
    assert Fingering(60, 1, "13").controls == {}
    for fingering in TRUMPET.fingerings:
        assert controls_of(fingering.label, TRUMPET.controls) == fingering.controls
