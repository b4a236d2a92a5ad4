"""The tip of an endpin keeps its place, however lips and head move."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.motion.body_motion import BodyMotion
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.endpin import EndpinStand
from app.motion.perform import prepare
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.grip_files import hold_for
from app.steps import StepRuns
from instrument_maps.hold import Carriage
from instrument_maps.load import bundled_maps
from instrument_maps.model import Endpin
from metadata.load import load_body
from tests.support.models import bundled_instrument
from tests.unit.motion.events import fingerings, plan_of

PIN = Endpin(node="pin", axis=(0.0, -1.0, 0.0), tip_m=(0.0, -1.0, 0.3), most_m=0.3)
CARRIAGE = Carriage(pitch_down_deg=(-2.0, 0.0, 2.0), yaw_left_deg=(-9.0, 0.0, 9.0), roll_left_deg=(-1.0, 0.0, 1.0))
USUAL = InstrumentTransform(np.array([[0.0, 1.1, 0.2]]), np.array([[0.0, 0.0, 0.0, 1.0]]))
SWAYING = InstrumentTransform(
    np.array([[0.01, 1.08, 0.23], [-0.03, 1.12, 0.19], [0.0, 1.1, 0.2]]),
    quaternion.from_rotation_vector(np.array([[0.02, 0.01, 0.0], [-0.05, 0.0, 0.03], [0.0, 0.0, 0.0]])),
)


def motion(**held: list[float]) -> BodyMotion:
    still = BodyMotion.still(load_body().postures["seated"])
    angles = {name: np.array(held.get(name, [0.0, 0.0, 0.0])) for name in ("pitch", "yaw", "roll")}
    return replace(still, bell_rad=np.array([0.2, -0.1, 0.0]), bell_held_rad=angles if held else {})


def tips_m(stood: InstrumentTransform, stand: EndpinStand) -> np.ndarray:
    drawn_m = stand.endpin.most_m * stand.drawn_out(stood.position_m, stood.rotation)
    inside_m = np.asarray(PIN.tip_m) + np.outer(drawn_m, PIN.axis)
    return stood.position_m + quaternion.rotate(stood.rotation, inside_m)


def test_the_tip_stays_where_it_is_and_the_mouthpiece_at_the_lips() -> None:
    stand = EndpinStand.of(PIN, CARRIAGE, USUAL)
    stood = stand.stood(SWAYING, motion())
    np.testing.assert_array_equal(stood.position_m, SWAYING.position_m)
    np.testing.assert_allclose(tips_m(stood, stand), [[0.0, 0.0, 0.5]] * 3, atol=1e-9)
    # Undisturbed it stays as it is carried.
    np.testing.assert_allclose(stood.rotation[2], SWAYING.rotation[2], atol=1e-12)


def test_where_an_animator_turns_it_the_tip_goes_along_the_floor() -> None:
    stand = EndpinStand.of(PIN, CARRIAGE, USUAL)
    found_m = tips_m(stand.stood(SWAYING, motion(yaw=[0.05, -0.05, 0.0])), stand)
    turned = 0.3 * np.sin([0.05, -0.05, 0.0])
    np.testing.assert_allclose(found_m[:, 0], turned, atol=2e-4)
    np.testing.assert_allclose(found_m[:, 1], 0.0, atol=1e-9)


@pytest.mark.parametrize("lips_y", [1.31, 2.0])
def test_out_of_reach_of_the_floor_it_does_not_stand(lips_y: float) -> None:
    assert EndpinStand.of(PIN, CARRIAGE, replace(USUAL, position_m=np.array([[0.0, lips_y, 0.2]]))) is None


def test_a_short_player_has_it_pushed_in_wholly() -> None:
    stand = EndpinStand.of(PIN, CARRIAGE, replace(USUAL, position_m=np.array([[0.0, 0.99, 0.2]])))
    assert stand.drawn_out(stand.lips_m, USUAL.rotation).tolist() == [0.0]


def test_what_hangs_before_a_standing_player_has_its_pin_pushed_in() -> None:
    instrument, character, body = bundled_maps()["clarinet_bass_Bb"], character_named("man_adult"), load_body()
    hold = hold_for(character, bundled_instrument(instrument), instrument, body)
    plan = plan_of(fingerings([(0.0, 1.0, {})], 0.5))
    drawn = {}
    for posture in ("standing", "seated"):
        parameters = PlayerParameters(posture=posture)
        playing = prepare(StepRuns(), plan, parameters, instrument, character, hold, body, felt_beats=((0, 480),))
        drawn[posture] = playing.motion(Fraction(24), 0, 3).controls.get("endpin")
    assert drawn["standing"] is None
    assert drawn["seated"] is not None
    assert (drawn["seated"] > 0.1).all()
