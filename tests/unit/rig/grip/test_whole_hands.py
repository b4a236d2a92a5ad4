"""Hands whose fingers do not bend lie on the instrument where short arms reach it."""

from __future__ import annotations

import numpy as np
import pytest

from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.grip.body_size import arm_m
from app.rig.grip.carriage import upright
from app.rig.grip.fitting.fitted_instrument import palm_middle_m
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import GripPose, HandHold
from app.rig.grip.whole_hands import slid_message, within_reach
from app.rig.model import Character
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.bodies import Proportions, odd_body, of_proportions
from tests.support.models import bundled_instrument

CLARINET = bundled_maps()["clarinet_Bb"]


def held(character: Character) -> tuple[GripPose, GripPose]:
    """An adult's grip, and the same for a character."""
    grip = hold_for(character_named("man_adult"), bundled_instrument(CLARINET), CLARINET, load_body())
    return grip, within_reach(character, bundled_instrument(CLARINET), CLARINET, load_body(), grip)


def short_m(character: Character, grip: GripPose, hand: HandHold) -> float:
    """Distance in metres that an arm lacks to the wrist's place; negative if it reaches it."""
    stand = upright(character, CLARINET, load_body(), grip.lips)
    wrist_m = stand.instrument_m + quaternion.rotate(stand.instrument_rotation, hand.instrument_from_hand_m[0])
    shoulder_m = stand.joints_m[character.skeleton.index(f"{hand.side}UpperArm")]
    return float(np.linalg.norm(wrist_m - shoulder_m)) - arm_m(character.skeleton, hand.side)


def off_m(character: Character, hand: HandHold) -> float:
    """Distance in metres of a palm's middle from the instrument."""
    palm_m = palm_middle_m(character, hand.side)
    place_m = hand.instrument_from_hand_m[0] + quaternion.rotate(hand.instrument_from_hand_rotation[0], palm_m)
    surface_m = np.concatenate([mesh.positions_m for mesh in bundled_instrument(CLARINET).meshes])
    return float(np.linalg.norm(surface_m - place_m, axis=1).min())


@pytest.mark.parametrize("id", ["man_adult", "mitten"])
def test_arms_that_reach_keep_their_hands(id: str) -> None:
    character = character_named(id) if id == "man_adult" else odd_body(id)
    before, after = held(character)
    assert after.slid_m == {}
    assert after.hands == before.hands
    assert slid_message(after.slid_m) is None


def test_fingers_that_play_stay_on_their_keys_however_short_the_arms_are() -> None:
    before, after = held(of_proportions(character_named("man_adult"), Proportions(arm=0.6), "short"))
    assert after is before


def test_a_mitten_slides_along_the_tube_until_its_arm_reaches() -> None:
    character = of_proportions(odd_body("mitten"), Proportions(arm=0.62), "short mitten")
    before, after = held(character)
    assert after.slid_m
    for old, new in zip(before.hands, after.hands, strict=True):
        assert max(short_m(character, before, old), 0.0) >= max(short_m(character, after, new), 0.0)
        assert off_m(character, new) <= off_m(character, old) + 0.016
        assert np.array_equal(old.instrument_from_hand_rotation, new.instrument_from_hand_rotation)
    assert max(short_m(character, after, hand) for hand in after.hands) < 0.0
    assert max(short_m(character, before, hand) for hand in before.hands) > 0.02
    message = slid_message(after.slid_m)
    assert message is not None
    assert message.id == "character.hands_slid"
