"""Arms beside the body: no forearm in clothes, hands where the instrument has them, elbows that move calmly."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.export.arm_depths import ARM_MM, arm_depth
from app.export.character import character_scene
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback
from app.export.target import normalised_target
from app.motion.contacts.arms_off_trunk import MOST_RAD, Outward
from app.motion.contacts.ready_player import player_body
from app.motion.contacts.shares_of_help import smoothed_outward
from app.motion.contacts.solve import PlayerBody, body_with_help, needs, poses, with_elbows_out
from app.motion.contacts.still_player import ContactCurves
from app.motion.model import Motion
from app.plan.parameters import PlayerParameters
from app.rig.characters.character_library import character_named
from app.rig.characters.dressed_characters import character_in
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.model import Character
from app.rig.people.wardrobe import OutfitChoice
from app.rig.skeleton import forward
from app.rig.trunk_shape import dressed_shape, trunk_shape
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from metadata.load import load_body
from tests.support.models import bundled_instrument

CASES: tuple[tuple[str, str, Posture], ...] = (
    ("trombone_tenor_F_attachment", "man_adult", "standing"),
    ("sax_alto_Eb", "man_adult", "seated"),
    ("baritone_Bb", "man_adult", "standing"),
    ("english_horn", "woman_adult", "seated"),
)
"""Each was 40 to 90 mm in shirt or trousers."""


def still_player(
    instrument_id: str, character_id: str, posture: Posture, outfit: str = ""
) -> tuple[PlayerBody, Character]:
    """A player who keeps still."""
    character, instrument, body = character_named(character_id), bundled_maps()[instrument_id], load_body()
    grip = hold_for(character, bundled_instrument(instrument), instrument, body)
    dressed = character_in(character_id, OutfitChoice(outfit))
    return player_body(PlayerParameters(posture=posture), instrument, dressed, grip, body), dressed


def frames_of(player: PlayerBody, *, out: bool) -> Motion:
    """Three frames: the instrument at the lips, halfway down and lowered."""
    still = replace(player.still.for_frames(3), lowered=np.array([0.0, 0.5, 1.0]))
    curves = ContactCurves(still, {}, {}, np.zeros(3))
    curves = replace(curves, body=body_with_help(player, still, needs(player, curves)))
    if out:
        curves = replace(curves, body=with_elbows_out(player, curves))
    return poses(player, curves, Fraction(1, 2), 0.0)


def depth_mm(character: Character, motion: Motion) -> float:
    """Depth of the arms in the body, of the surfaces as they are exported."""
    target = normalised_target(character.skeleton)
    scene = character_scene(character, motion, "a", "test", target)
    assert scene.clip is not None
    return arm_depth(JointPlayback(ScenePlayback(scene, scene.clip), target, character)).depth_mm


@pytest.mark.parametrize(("instrument_id", "character_id", "posture"), CASES)
def test_forearms_stay_out_of_clothes(instrument_id: str, character_id: str, posture: Posture) -> None:
    """Carried as the map has it and with elbows as they hang, arms are inside; otherwise they are not. The turn of the
    elbows moves no hand."""
    player, character = still_player(instrument_id, character_id, posture)
    hold = bundled_maps()[instrument_id].hold
    usual = replace(player, carriage=hold.carriage(posture), lowered=hold.lowered(posture))
    assert depth_mm(character, frames_of(usual, out=False)) > 1.5 * ARM_MM
    inside, outside = (frames_of(player, out=out) for out in (False, True))
    assert depth_mm(character, outside) <= 1.1 * ARM_MM
    placed = [
        forward(player.skeleton, one.rotations.astype(np.float64), one.hips_m.astype(np.float64))
        for one in (inside, outside)
    ]
    for side in ("left", "right"):
        hand = player.skeleton.index(f"{side}Hand")
        (before_m, before), (after_m, after) = (one.of(hand) for one in placed)
        assert np.abs(before_m - after_m).max() < 1e-5
        assert np.abs(np.abs((before * after).sum(axis=1)) - 1.0).max() < 1e-6


@pytest.mark.parametrize(("instrument_id", "character_id", "posture"), CASES)
def test_wrists_stay_in_their_range(instrument_id: str, character_id: str, posture: Posture) -> None:
    """The elbows go no farther than wrists allow."""
    player, _ = still_player(instrument_id, character_id, posture)
    motions = [frames_of(player, out=out) for out in (False, True)]
    for side, wrist in player.wrists.items():
        hand = player.skeleton.index(f"{side}Hand")
        before, after = (wrist.outside_rad(one.rotations[:, hand].astype(np.float64)) for one in motions)
        assert (after <= before + np.deg2rad(0.6)).all(), side


def test_a_body_of_unknown_shape_is_left_as_it_is() -> None:
    """There is nothing to keep arms out of: no elbow is turned."""
    player, _ = still_player(*CASES[0])
    bare = replace(player, shape=None)
    assert not with_elbows_out(bare, ContactCurves(bare.still, {}, {}, np.zeros(1))).elbow_out_rad


def test_an_elbow_that_must_go_out_at_once_begins_early_and_stays_under_what_its_wrist_allows() -> None:
    """A need of one frame becomes a smooth hill; what the wrist allows is never passed."""
    needed, most = np.zeros(121), np.full(121, MOST_RAD)
    needed[60], most[90:] = 0.8, 0.1
    needed[95] = 0.8
    given = smoothed_outward(Outward({"left": needed}, {"left": most}), 10)["left"]
    assert given[60] == pytest.approx(0.8, abs=0.02)
    assert given[45] > 0.05
    assert given[30] == 0.0
    assert (given[90:100] <= 0.1 + 1e-9).all()
    assert np.abs(np.diff(given)).max() < 0.15


def test_elbows_leave_room_for_the_clothes_that_are_worn() -> None:
    """The instrument is played as in the body's own clothes."""
    own, _ = still_player("trumpet_Bb", "woman_adult", "standing")
    worn, dressed = still_player("trumpet_Bb", "woman_adult", "standing", "marching")
    assert worn.carriage == own.carriage
    assert (own.shape, worn.shape) == (trunk_shape(dressed), dressed_shape(dressed))
    as_in_own, moved = (frames_of(player, out=True) for player in (own, worn))
    assert depth_mm(dressed, moved) <= min(ARM_MM, depth_mm(dressed, as_in_own))
    np.testing.assert_allclose(as_in_own.instrument_position_m[0], moved.instrument_position_m[0], atol=1e-6)
