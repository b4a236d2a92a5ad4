"""Straps keep their length when the instrument is lowered: they are of webbing, not of rubber."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.performance.bodies import hold_of, suited_to
from app.performance.supports import HeldInstrument, supports_of
from app.project.performers import Player
from app.rig.characters.character_library import character_named
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from tests.unit.viewport.poses import quartet

WORN: list[tuple[str, Posture]] = [
    (id, posture)
    for id, one in bundled_maps().items()
    for support in one.hold.supports
    for posture in support.postures
    if one.hold.possible(posture) == posture and support.kind != "seat_strap"
]
MOST = 1.04


@pytest.mark.parametrize("character_id", ["man_adult", "woman_adult"])
@pytest.mark.parametrize(("id", "posture"), WORN)
def test_a_strap_is_as_long_with_the_instrument_lowered(id: str, posture: Posture, character_id: str) -> None:
    first = quartet().players[0]
    parameters = msgspec.structs.replace(first.parameters, posture=posture)
    player: Player = msgspec.structs.replace(first, instrument_id=id, character_id=character_id, parameters=parameters)
    instrument = suited_to(player, bundled_maps()[id]).instrument
    held = HeldInstrument(player, instrument, hold_of(player, instrument))
    supports = supports_of(character_named(character_id), [held])
    assert supports is not None
    (strap,) = supports.straps
    tops_m = np.array([leg.top_m for leg in strap.legs])
    lengths_m = []
    for end_m in (strap.hook_m, strap.low_m):
        up = tops_m.mean(axis=0) - end_m
        meet_m = end_m + strap.cord_m * up / np.linalg.norm(up)
        lengths_m.append(float(np.linalg.norm(tops_m - meet_m, axis=1).mean()))
    played_m, lowered_m = lengths_m
    assert lowered_m < MOST * played_m
