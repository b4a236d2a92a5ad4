"""Lowered instruments that make room for the arms: on a strap no farther than it reaches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.motion.contacts.clear_carriage import lowered_clear, played_clear
from app.motion.contacts.solve import PlayerBody
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import neck_m
from app.motion.contacts.upper_body import upper_body
from app.rig import quaternion
from instrument_maps.hold import Support
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from tests.unit.motion.contacts.test_arms_off_trunk import frames_of, still_player
from tests.unit.motion.contacts.test_nods import in_uniform

HOLD = bundled_maps()["ewi"].hold
(STRAP,) = HOLD.supports


def moved_m(support: Support | None) -> tuple[PlayerBody, np.ndarray]:
    """A player whose arms need room, and the way (3,) by which the instrument is lowered elsewhere than on the map."""
    player, _ = still_player("ewi", "man_adult", "standing")
    usual = replace(player, carriage=HOLD.carriage("standing"), lowered=HOLD.lowered("standing"))
    clear = lowered_clear(played_clear(usual), () if support is None else (support,))
    return clear, np.subtract(clear.lowered.offset_m, usual.lowered.offset_m)


def hook_from_neck_m(player: PlayerBody) -> float:
    """Distance of the strap's lower end from the neck with the instrument lowered."""
    low = ContactCurves(replace(player.still, lowered=np.ones(1)), {}, {}, np.zeros(1))
    carried = upper_body(player, low).carried
    hook_m = carried.position_m + quaternion.rotate(carried.rotation, np.array([STRAP.hook_m]))
    return float(np.linalg.norm(hook_m - neck_m(player.skeleton, player.base)))


def test_an_instrument_in_the_hands_alone_goes_straight_ahead() -> None:
    """No strap holds it back."""
    _, (left_m, up_m, forward_m) = moved_m(None)
    assert forward_m > 0.01
    assert left_m == pytest.approx(0.0) == up_m


def test_an_instrument_on_a_strap_goes_ahead_and_up() -> None:
    """It swings about the neck."""
    free, _ = moved_m(None)
    hung, (_, up_m, forward_m) = moved_m(STRAP)
    usual = replace(hung, lowered=HOLD.lowered("standing"))
    assert forward_m > 0.01
    assert up_m > 0.01
    assert hook_from_neck_m(hung) < hook_from_neck_m(usual) * 1.02 < hook_from_neck_m(free)


@pytest.mark.parametrize(
    ("instrument_id", "character_id", "posture", "outfit"),
    [
        ("piccolo", "cast_sachiko", "seated", ""),
        ("piccolo", "student_kaede", "seated", ""),
        ("recorder_alto_F", "student_sakura", "standing", "school_uniform"),
    ],
)
def test_lowering_an_instrument_bends_no_wrist_beyond_its_range(
    instrument_id: str, character_id: str, posture: Posture, outfit: str
) -> None:
    """There was room for the arms, with wrists 8.8 and 6.2 degrees beyond, and 5.0 halfway."""
    player, _ = in_uniform(character_id, instrument_id, posture, outfit)
    lowering = frames_of(player, out=True)
    for side, wrist in player.wrists.items():
        hand = lowering.rotations[1:, player.skeleton.index(f"{side}Hand")].astype(np.float64)
        assert wrist.outside_rad(hand).max() < np.deg2rad(1.0)


def test_an_instrument_on_a_strap_of_the_seat_stays() -> None:
    """The strap goes down from it, and would be torn."""
    _, way_m = moved_m(Support("seat_strap", STRAP.hook_m))
    assert not way_m.any()
