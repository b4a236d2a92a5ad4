"""The share of an instrument that hands and head leave in sight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.grip.body_size import sized_character, sized_model
from app.rig.grip.fitting.grip_files import hold_for, usual_wrists
from app.rig.grip.lips import fit_lips
from app.rig.grip.visible_share import LEAST_IN_SIGHT, VisibleShare, hidden_message, visible_share
from app.rig.model import Character
from instrument_maps.load import bundled_maps
from instrument_maps.size import scaled
from metadata.load import load_body
from tests.support.bodies import Proportions, of_proportions
from tests.support.models import bundled_instrument

TRUMPET = bundled_maps()["trumpet_Bb"]


def shares(character: Character, size: float = 1.0) -> VisibleShare:
    """Shares in sight with the wrists of an adult."""
    instrument, body = scaled(TRUMPET, size), load_body()
    model = sized_model(bundled_instrument(TRUMPET), size)
    wrists = {side: (size * place_m, turn) for side, (place_m, turn) in usual_wrists(TRUMPET.id).items()}
    lips = fit_lips(character, instrument, body)
    return visible_share(character, model, instrument, body, lips, wrists, {})


def test_an_adult_leaves_a_trumpet_in_sight_and_nothing_is_said() -> None:
    adult, model, body = character_named("man_adult"), bundled_instrument(TRUMPET), load_body()
    grip = hold_for(adult, model, TRUMPET, body)
    assert hidden_message(adult, model, TRUMPET, body, grip) is None
    assert min(shares(adult)) > LEAST_IN_SIGHT


def test_a_smaller_instrument_in_larger_hands_is_hidden_from_the_side_more() -> None:
    large = of_proportions(character_named("man_adult"), Proportions(hand=2.0, thick=1.5), "large")
    beside = [
        shares(body, size).side for body, size in ((character_named("man_adult"), 1.0), (large, 1.0), (large, 0.5))
    ]
    assert beside == sorted(beside, reverse=True)
    assert beside[2] < LEAST_IN_SIGHT < beside[0] - 0.1


def test_hands_far_away_hide_nothing() -> None:
    adult, body = character_named("man_adult"), load_body()
    far = {side: (np.array([0.0, -9.0, 0.0]), quaternion.IDENTITY) for side in ("left", "right")}
    lips = fit_lips(adult, TRUMPET, body)
    share = visible_share(adult, bundled_instrument(TRUMPET), TRUMPET, body, lips, far, {})
    assert share == pytest.approx((1.0, 1.0), abs=0.02)


def test_a_giant_whose_hands_hide_the_largest_instrument_is_asked_for_less_height() -> None:
    adult, model, body = character_named("man_adult"), bundled_instrument(TRUMPET), load_body()
    grip = hold_for(adult, model, TRUMPET, body)
    giant, found = sized_character(adult, 3.0), []
    for size in (1.0, TRUMPET.hold.size_range[1]):
        instrument, shape = scaled(TRUMPET, size), sized_model(model, size)
        message = hidden_message(giant, shape, instrument, body, replace(grip, lips=fit_lips(giant, instrument, body)))
        assert message is not None
        found.append(message.id)
    assert found == ["character.instrument_hidden", "character.instrument_too_small"]
