"""Fingers waiting over their keys: curved, at the solved height, and coupled to their neighbours."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

from app.arrays import FloatArray
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import GripPose, StationTable
from app.rig.grip.lifted_fingers import with_curved_fingers
from app.rig.model import Skeleton
from app.rig.skeleton import forward
from instrument_maps.load import bundled_maps
from metadata.load import load_body, load_skeleton
from tests.support.models import bundled_instrument

CASES = [
    (instrument_id, character_id)
    for instrument_id in ("clarinet_Bb", "sax_alto_Eb", "flute", "oboe", "bassoon")
    for character_id in bundled_characters()
]


@lru_cache(maxsize=16)
def _holds(instrument_id: str, character_id: str) -> tuple[Skeleton, GripPose, GripPose]:
    instrument, character = bundled_maps()[instrument_id], character_named(character_id)
    hold = hold_for(character, bundled_instrument(instrument), instrument, load_body())
    return character.skeleton, hold, with_curved_fingers(hold, character.skeleton, load_skeleton())


def _tips_m(skeleton: Skeleton, joints: tuple[int, ...], station: StationTable) -> FloatArray:
    """Positions of the touching part of a finger over the values of a control in the wrist's frame, by the skeleton's
    kinematics.
    """
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (len(station.values), len(skeleton.names), 1))
    rotations[:, list(joints)] = station.rotations
    posed = forward(skeleton, rotations)
    wrist = skeleton.parents[joints[0]]
    at_m, turn = posed.of(joints[station.tip_joint])
    tips_m: FloatArray = at_m + _rotated(turn, station.tip_m) - posed.of(wrist)[0]
    return tips_m


def _rotated(turn: FloatArray, vector: FloatArray) -> FloatArray:
    u, w = turn[:, :3], turn[:, 3:]
    t = 2.0 * np.cross(u, vector)
    return vector + w * t + np.cross(u, t)


def _bent_deg(skeleton: Skeleton, joint: int, rotation: FloatArray) -> float:
    axis = np.asarray(load_skeleton().joint_axes(skeleton.names[joint]).flexion)
    return float(np.degrees(2.0 * np.arctan2(rotation[:3] @ axis, rotation[3])))


def _changed(instrument_id: str, character_id: str) -> list[tuple[tuple[int, ...], StationTable, StationTable]]:
    _, before, after = _holds(instrument_id, character_id)
    return [
        (table.joints, old, new)
        for hands in zip(before.hands, after.hands, strict=True)
        for tables in zip(*(hand.fingers for hand in hands), strict=True)
        for table in tables[:1]
        for old, new in zip(*(one.stations for one in tables), strict=True)
        if old is not new and new.tip_joint == 2
    ]


@pytest.mark.parametrize(("instrument_id", "character_id"), CASES)
def test_fingers_press_as_they_did_and_wait_as_high_but_curved(instrument_id: str, character_id: str) -> None:
    skeleton, _, _ = _holds(instrument_id, character_id)
    changed = _changed(instrument_id, character_id)
    assert len(changed) >= 6
    straightest = []
    for joints, old, new in changed:
        assert np.array_equal(np.abs(new.rotations[-1]), np.abs(old.rotations[-1]))
        was_m, is_m = _tips_m(skeleton, joints, old), _tips_m(skeleton, joints, new)
        way_m = was_m[0] - was_m[-1]
        way = way_m / np.linalg.norm(way_m)
        assert np.abs((is_m - was_m) @ way).max() < 0.0005
        assert np.linalg.norm(is_m - was_m, axis=1).max() < 0.017
        # The pad is nowhere dragged along its key while it presses.
        assert np.linalg.norm(is_m[-2] - was_m[-2]) < 0.0025
        waits = np.linalg.norm(is_m[0] - is_m[-1])
        assert 0.0005 < waits < 0.022
        middle = _bent_deg(skeleton, joints[1], new.rotations[0, 1])
        pressed = _bent_deg(skeleton, joints[1], new.rotations[-1, 1])
        assert middle < 75.0 or middle < pressed
        straightest.append(middle)
    assert np.median(straightest) > 24.0
    assert min(straightest) > 4.0


@pytest.mark.parametrize("character_id", bundled_characters())
def test_a_pressing_finger_takes_its_neighbours_along_by_a_fraction(character_id: str) -> None:
    skeleton, _, hold = _holds("clarinet_Bb", character_id)
    order = list(hold.finger_joints)
    tips = {}
    for ring in (0.0, 1.0):
        posed = finger_rotations(hold, {"hole_R3": np.array([ring]), "hole_R2": np.zeros(1), "hole_R1": np.zeros(1)}, 1)
        rotations = np.tile([0.0, 0.0, 0.0, 1.0], (1, len(skeleton.names), 1))
        rotations[:, order] = posed
        joints = forward(skeleton, rotations)
        for finger in ("Index", "Middle", "Ring"):
            tips[finger, ring] = joints.of(skeleton.index(f"right{finger}Distal"))[0][0]
    moved_m = {finger: float(np.linalg.norm(tips[finger, 1.0] - tips[finger, 0.0])) for finger, _ in tips}
    assert 0.0003 < moved_m["Middle"] < 0.4 * moved_m["Ring"]
    assert moved_m["Index"] < 0.5 * moved_m["Middle"]


@pytest.mark.parametrize("raised", [0.0, 0.5, 1.0])
def test_neighbours_never_press(raised: float) -> None:
    skeleton, _, hold = _holds("clarinet_Bb", "woman_adult")
    joint = skeleton.index("rightMiddleDistal")
    column = hold.finger_joints.index(joint)
    pressing = {"hole_R3": np.ones(1), "hole_R1": np.ones(1)}
    waiting, pressed = (
        finger_rotations(hold, pressing | {"hole_R2": np.array([value])}, 1, raised=raised)[0, column - 2]
        for value in (0.0, 1.0)
    )
    assert abs(_bent_deg(skeleton, joint - 2, waiting) - _bent_deg(skeleton, joint - 2, pressed)) > 1.0


@pytest.mark.parametrize(("instrument_id", "character_id"), CASES[:4])
def test_fingers_wait_higher_where_notes_are_fast(instrument_id: str, character_id: str) -> None:
    skeleton, _, hold = _holds(instrument_id, character_id)
    order = list(hold.finger_joints)
    worked = {
        name: np.zeros(2)
        for hand in hold.hands
        for table in hand.fingers
        for s in table.stations
        for name in s.controls
    }
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (2, len(skeleton.names), 1))
    rotations[:, order] = finger_rotations(hold, worked, 2, raised=np.array([0.0, 1.0]))
    joints = forward(skeleton, rotations)
    for finger in ("Index", "Middle", "Ring"):
        at_m, _ = joints.of(skeleton.index(f"right{finger}Distal"))
        assert 0.001 < np.linalg.norm(at_m[1] - at_m[0]) < 0.008, finger


@pytest.mark.parametrize("character_id", bundled_characters())
def test_what_is_beyond_a_key_pressed_with_the_first_phalanx_is_bent(character_id: str) -> None:
    skeleton, before, after = _holds("sax_alto_Eb", character_id)
    bent = {}
    for old_hand, new_hand in zip(before.hands, after.hands, strict=True):
        for old_table, table in zip(old_hand.fingers, new_hand.fingers, strict=True):
            for old, new in zip(old_table.stations, table.stations, strict=True):
                if new.controls and new.tip_joint == 0 and not table.finger.endswith("thumb"):
                    assert np.array_equal(new.rotations[:, 0], old.rotations[:, 0])
                    bent[new.controls] = _bent_deg(skeleton, table.joints[1], new.rotations[-1, 1])
    assert {("key_palm_D",), ("key_palm_F",), ("key_side_E",)} <= bent.keys()
    assert min(bent.values()) > 25.0
