"""Seats of players whose instruments stand on the floor: small players sit high enough for hands and pin."""

from __future__ import annotations

from functools import lru_cache

import msgspec
import numpy as np
import pytest

from app.export.arm_depths import ARM_MM
from app.motion.contacts.clear_carriage import lacking_m
from app.motion.contacts.clear_seat import ROOM_M, highest_seat, on_seat
from app.motion.contacts.ready_player import body_as_fitted, player_body
from app.motion.contacts.solve import PlayerBody
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import stance
from app.motion.contacts.upper_body import upper_body
from app.performance.bodies import body_of, dressed_character, hold_of, suited_to
from app.performance.supports import instrument_matrices, joints_of, still_pose
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.grip.carriage import carrying
from app.rig.model import Character
from app.rig.people.wardrobe import OutfitChoice
from app.rig.supports.seat_fit import chair_fit
from instrument_maps.load import bundled_maps
from tests.unit.motion.contacts.test_arms_off_trunk import depth_mm, frames_of
from tests.unit.viewport.poses import quartet

SMALL, TALL = "cast_sachiko", "cast_thomas"


@lru_cache(maxsize=8)
def seated(instrument_id: str, character_id: str, outfit: str) -> tuple[PlayerBody, PlayerBody, Character]:
    """A seated player in an outfit, the same one on the usual seat, and the dressed character."""
    first = quartet().players[0]
    parameters = msgspec.structs.replace(first.parameters, posture="seated")
    player = msgspec.structs.replace(
        first,
        instrument_id=instrument_id,
        character_id=character_id,
        outfit=OutfitChoice(outfit),
        parameters=parameters,
    )
    instrument, character = suited_to(player, bundled_maps()[instrument_id]).instrument, dressed_character(player)
    made = player_body(parameters, instrument, character, hold_of(player, instrument), body_of(player))
    posture = carrying(body_of(player), "seated", instrument.hold.carriage("seated"))
    return made, on_seat(made, stance(made.skeleton, posture, made.place.ankle), instrument.endpin), character


def pin_m(player: PlayerBody) -> float:
    """Length by which the pin of a still player's instrument is pulled out; negative: the floor is in its way."""
    assert player.stand is not None
    return player.stand.pin_m(upper_body(player, ContactCurves(player.still, {}, {}, np.zeros(1))).carried)


@pytest.mark.parametrize(
    ("instrument_id", "outfit"),
    [("clarinet_bass_Bb", "concert_black"), ("clarinet_bass_Bb", "evening"), ("contrabassoon", "concert_black")],
)
def test_a_small_player_sits_higher_with_an_instrument_on_the_floor(instrument_id: str, outfit: str) -> None:
    """On the usual seat a hand is in the lap, and a contrabassoon ends below the floor."""
    made, usual, character = seated(instrument_id, SMALL, outfit)
    assert pin_m(usual) < (-0.01 if instrument_id == "contrabassoon" else 0.02)
    assert depth_mm(character, frames_of(usual, out=True)) > 2.0 * ARM_MM
    assert pin_m(made) >= 0.0
    assert depth_mm(character, frames_of(made, out=True)) <= ARM_MM
    assert 0.05 < made.place.hips_m[1] - usual.place.hips_m[1] < 0.2


def test_a_small_player_sits_higher_with_an_instrument_on_straps() -> None:
    """A hand has room for the motion over the lap; the elbows alone cannot give it."""
    made, usual, _ = seated("sax_baritone_Eb", SMALL, "concert_black")
    assert lacking_m(usual, ROOM_M) > 0.02
    assert lacking_m(made, ROOM_M) < 0.01
    assert 0.02 < made.place.hips_m[1] - usual.place.hips_m[1] < 0.1


@pytest.mark.parametrize("character_id", [SMALL, "student_mei"])
def test_the_right_arm_of_a_bass_clarinettist_is_clear_of_a_tunic(character_id: str) -> None:
    """It was 23 and 10 mm in its skirt on the lap, with the wrist at the end of its range, which sways passed."""
    made, _, character = seated("clarinet_bass_Bb", character_id, "marching")
    motion = frames_of(made, out=True)
    assert depth_mm(character, motion) <= 0.5 * ARM_MM
    hand = motion.rotations[:1, made.skeleton.index("rightHand")].astype(np.float64)
    assert made.wrists["right"].outside_rad(hand, within=True)[0] < np.deg2rad(-3.0)
    pin, drawn_out = bundled_maps()["clarinet_bass_Bb"].endpin, float(motion.controls["endpin"][0])
    assert pin is not None
    tip_m = np.array(pin.tip_m) + drawn_out * pin.most_m * np.array(pin.axis)
    foot_m = quaternion.rotate(motion.instrument_rotation[0].astype(np.float64), tip_m)
    across_m, up_m, _ = motion.instrument_position_m[0] + foot_m
    assert up_m == pytest.approx(0.0, abs=1e-4)
    # Between the shoes.
    assert abs(across_m) < 0.07


def test_players_with_room_keep_the_usual_seat() -> None:
    """A tall body has the lap far below its hands; an instrument in the hands alone has room elsewhere."""
    for instrument_id, character_id in (("contrabassoon", TALL), ("clarinet_Bb", SMALL)):
        made, usual, _ = seated(instrument_id, character_id, "concert_black")
        np.testing.assert_array_equal(made.place.hips_m, usual.place.hips_m)


def test_a_musician_of_two_instruments_has_one_seat() -> None:
    """It is as high as the one that needs it requires."""
    high, low, _ = seated("clarinet_bass_Bb", SMALL, "concert_black")
    assert highest_seat([low, high]) is high.place
    clarinet, _, _ = seated("clarinet_Bb", SMALL, "concert_black")
    moved = on_seat(clarinet, high.place, None)
    assert moved.base.head_m[0, 1] - clarinet.base.head_m[0, 1] == pytest.approx(
        high.place.hips_m[1] - clarinet.place.hips_m[1]
    )


def test_the_chair_is_as_high_as_its_sitter() -> None:
    """It carries the part of the thighs that does not descend far: no gap is left below the hips."""
    player, _, character = seated("contrabassoon", SMALL, "concert_black")
    still = still_pose(player)
    joints = joints_of(character, still)[0]
    below_hips_m = joints[character.skeleton.index("hips"), 1, 3] - chair_fit(character, joints).top_m
    usual_m = joints_of(character_named(SMALL), still_pose(seated("clarinet_Bb", SMALL, "")[0]))[0]
    own = chair_fit(character_named(SMALL), usual_m)
    assert below_hips_m == pytest.approx(usual_m[character.skeleton.index("hips"), 1, 3] - own.top_m, abs=0.05)


@pytest.mark.parametrize("instrument_id", ["sax_baritone_Eb", "contrabassoon"])
def test_curved_fingers_change_nothing_of_how_a_player_sits_and_holds(instrument_id: str) -> None:
    """Chairs and straps are made without them."""
    made, _, character = seated(instrument_id, SMALL, "")
    player = msgspec.structs.replace(
        quartet().players[0], instrument_id=instrument_id, character_id=SMALL, outfit=OutfitChoice("")
    )
    parameters = msgspec.structs.replace(player.parameters, posture="seated")
    instrument = suited_to(player, bundled_maps()[instrument_id]).instrument
    fitted = hold_of(player, instrument)
    with_curves, without = (
        body_as_fitted(parameters, instrument, character, grip, body_of(player)) for grip in (made.grip, fitted)
    )
    assert made.grip is not fitted
    for one in (made, with_curves):
        assert one.place.hips_m.tolist() == without.place.hips_m.tolist()
        assert one.carriage == without.carriage
        assert one.lowered == without.lowered
        assert one.bell_room == without.bell_room
    ends = [instrument_matrices(still_pose(one, 1.0)) for one in (made, without)]
    np.testing.assert_array_equal(*ends)


def test_the_left_hand_holds_a_sousaphone_from_the_front() -> None:
    """Round the tube from behind, its forearm was in thick jackets."""
    made, _, character = seated("sousaphone_BBb", "cast_grace", "marching")
    assert depth_mm(character, frames_of(made, out=True)) <= 0.5 * ARM_MM
