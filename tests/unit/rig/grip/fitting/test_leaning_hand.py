"""Offset of a hand for two fingers simultaneously."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from app.rig.characters.character_library import character_named
from app.rig.grip.finger_stations import asked_together
from app.rig.grip.fitting import leaning_hand
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.fitting.leaning_hand import LEAN_FROM_M, LEAN_WORTH_M, leanings, whole_hand
from app.rig.grip.fitting.two_fingers import leans_beside
from app.rig.grip.grip_pose import HandHold
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from tests.support.models import bundled_instrument


@pytest.fixture(scope="module")
def instrument() -> InstrumentMap:
    return bundled_maps()["clarinet_bass_Bb"]


@pytest.fixture(scope="module")
def left(instrument: InstrumentMap) -> HandHold:
    """Small hand with the thumb on hole and register key and the little finger on distant levers."""
    character = character_named("woman_adult")
    hold = hold_for(character, bundled_instrument(instrument), instrument, load_body())
    return next(hand for hand in hold.hands if hand.side == "left")


def test_what_two_fingers_ask_beyond_each_alone_is_found_again(instrument: InstrumentMap, left: HandHold) -> None:
    model = bundled_instrument(instrument)
    whole_m = [
        model.node_positions_m[model.node_names.index(contact.node)] + np.asarray(contact.position_m)
        for contact in instrument.contacts
        if contact.part in whole_hand("left")
    ]
    alone = replace(left, leans=tuple(lean for lean in left.leans if not lean.beside))
    stored = next(lean for lean in left.leans if lean.beside)
    pair = next(pair for pair in asked_together(instrument) if set(pair) == set(stored.places))
    (found,) = leans_beside(alone, np.reshape(whole_m, (-1, 3)), [pair])
    assert found.places == stored.places
    assert 0.0001 < np.linalg.norm(found.moved_m) < 0.010
    np.testing.assert_allclose(found.moved_m, stored.moved_m, atol=0.0005)
    np.testing.assert_allclose(found.turned, stored.turned, atol=0.02)


def test_a_hand_that_no_one_asks_or_that_gives_way_for_no_one_keeps_its_leans(
    instrument: InstrumentMap, left: HandHold
) -> None:
    assert leans_beside(left, np.zeros((0, 3)), ()) == ()
    assert leans_beside(replace(left, leans=()), np.zeros((0, 3)), asked_together(instrument)) == ()


@pytest.mark.parametrize(
    ("missed_m", "leant_m", "leans"),
    [
        (LEAN_FROM_M - 1e-6, 0.0, False),
        (0.004, 0.004 - LEAN_WORTH_M + 1e-6, False),
        (0.004, 0.004 - LEAN_WORTH_M - 1e-6, True),
        (0.004, 0.0045, False),
    ],
)
def test_a_hand_gives_way_only_where_that_is_worth_it(
    monkeypatch: pytest.MonkeyPatch, missed_m: float, leant_m: float, leans: bool
) -> None:
    home, there = object(), object()
    one: Any = SimpleNamespace(number=0, station=there, missed_m=missed_m)
    problem: Any = SimpleNamespace(stations=[[home, there]])
    scene: Any = SimpleNamespace(carrier=None)
    leant = SimpleNamespace(scene=scene, solved=SimpleNamespace(missed_m=leant_m))
    monkeypatch.setattr(leaning_hand, "missed_m", lambda problem, scene, solved: solved.missed_m)
    monkeypatch.setattr(leaning_hand, "_leant", lambda *_: leant)
    assert leanings(problem, scene, np.zeros(0), [one]) == ((leant,) if leans else ())
