"""Nods of players in thick clothes: the instrument that goes along takes no arm into jacket or lap."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import msgspec
import numpy as np
import pytest

from app.export.arm_depths import ARM_MM
from app.motion.contacts.arms_off_trunk import Outward
from app.motion.contacts.clear_carriage import BELL_NODS_DEG, NOD_DEG
from app.motion.contacts.ready_player import player_body
from app.motion.contacts.shares_of_help import smoothed_outward
from app.motion.contacts.solve import PlayerBody, body_with_help, needs, poses, with_elbows_out
from app.motion.contacts.still_player import ContactCurves
from app.motion.model import Motion
from app.performance.bodies import body_of, dressed_character, hold_of, suited_to
from app.rig.model import Character
from app.rig.people.wardrobe import OutfitChoice
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from tests.unit.motion.contacts.test_arms_off_trunk import depth_mm
from tests.unit.viewport.poses import quartet


def in_uniform(
    character_id: str, instrument_id: str, posture: Posture, outfit_id: str = "marching"
) -> tuple[PlayerBody, Character]:
    """A player in an outfit, such as the jacket of a marching band."""
    first = quartet().players[0]
    parameters = msgspec.structs.replace(first.parameters, posture=posture)
    outfit = OutfitChoice(outfit_id)
    player = msgspec.structs.replace(
        first, instrument_id=instrument_id, character_id=character_id, outfit=outfit, parameters=parameters
    )
    instrument, character = suited_to(player, bundled_maps()[instrument_id]).instrument, dressed_character(player)
    made = player_body(parameters, instrument, character, hold_of(player, instrument), body_of(player))
    return made, character


def nodding(player: PlayerBody) -> Motion:
    """One frame of a large nod, with elbows out of the way."""
    bent_rad = {joint: rad + np.deg2rad(NOD_DEG.get(joint, 0.0)) for joint, rad in player.still.forward_rad.items()}
    nod = replace(player.still, forward_rad=bent_rad, bell_cue_rad=np.array([-np.deg2rad(BELL_NODS_DEG)]))
    curves = ContactCurves(nod, {}, {}, np.zeros(1))
    curves = replace(curves, body=body_with_help(player, nod, needs(player, curves)))
    return poses(player, replace(curves, body=with_elbows_out(player, curves)), Fraction(1, 2), 0.0)


@pytest.mark.parametrize(
    ("character_id", "instrument_id", "posture"),
    [
        ("cast_grace", "sousaphone_BBb", "seated"),
        ("cast_grace", "bassoon", "standing"),
        ("cast_sachiko", "english_horn", "seated"),
    ],
)
def test_a_nod_takes_no_arm_into_thick_clothes(character_id: str, instrument_id: str, posture: Posture) -> None:
    """The three were 25 to 44 mm inside in motion."""
    player, character = in_uniform(character_id, instrument_id, posture)
    assert depth_mm(character, nodding(player)) <= ARM_MM


def test_the_elbow_of_a_slide_hand_stays_out_until_shortly_before_its_wrist_forbids_it() -> None:
    needed, most = np.full(161, 0.4), np.full(161, 1.2)
    most[95:] = 0.02
    outward = Outward({"right": needed}, {"right": most})
    slow, swift = (smoothed_outward(outward, 17, sides, 7)["right"] for sides in ((), {"right"}))
    assert swift[87] == pytest.approx(0.4, abs=0.02)
    assert slow[87] < 0.3
    assert (swift[95:140] <= 0.02 + 1e-9).all()
