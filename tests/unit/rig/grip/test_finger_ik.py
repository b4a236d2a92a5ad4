"""Fingers moved to places: repeated requests are solved once, with identical results."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.rig.characters.character_library import character_named
from app.rig.grip import finger_ik
from app.rig.grip.finger_ik import ReachTarget, distinct_rows, fingers_at_targets
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import StationBlend, giving_for
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.models import bundled_instrument

PLACES = 40


def _asked(rows: np.ndarray[tuple[int], np.dtype[np.intp]]) -> list[ReachTarget]:
    """Two fingers of a clarinettist, each moved to some of 40 places within about a centimetre."""
    instrument = bundled_maps()["clarinet_Bb"]
    hold = hold_for(character_named("woman_adult"), bundled_instrument(instrument), instrument, load_body())
    offsets_m = np.random.default_rng(3).normal(0.0, 0.01, (PLACES, 3))
    found = []
    for table in hold.hands[0].fingers[1:3]:
        assert table.chain is not None
        rotations = table.stations[0].rotations[-1]
        tip_m = table.stations[0].tip_m
        at_m = table.chain.offsets_m.sum(axis=0) + offsets_m
        found.append(ReachTarget(table.chain, np.repeat(rotations[None], len(rows), axis=0), 2, tip_m, at_m[rows]))
    return found


def test_a_place_that_is_asked_for_often_is_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = np.random.default_rng(5).integers(0, PLACES, 500)
    alone = [
        np.concatenate(ways)
        for ways in zip(*(fingers_at_targets(_asked(rows[[row]])) for row in range(60)), strict=True)
    ]
    solved = []
    solve = finger_ik._brought

    def counted(chains: object, rotations: np.ndarray, *others: object) -> object:
        solved.append(len(rotations))
        return solve(chains, rotations, *others)

    monkeypatch.setattr(finger_ik, "_brought", counted)
    together = fingers_at_targets(_asked(rows))
    assert solved == [2 * len(set(rows.tolist()))]
    assert len(together) == 2
    for ours, single in zip(together, alone, strict=True):
        assert ours.shape == (500, 3, 4)
        assert np.array_equal(ours[:60], single)


def test_fingers_wait_for_a_hand_that_does_not_give_way_as_frame_by_frame() -> None:
    instrument = bundled_maps()["clarinet_bass_Bb"]
    hold = hold_for(character_named("woman_adult"), bundled_instrument(instrument), instrument, load_body())
    share = np.array([0.0, 0.3, 1.0, 1.0, 0.0])
    home = StationBlend(np.zeros(5), np.zeros(5), np.ones(5))
    leans = [lean for hand in hold.hands for lean in hand.leans if not lean.beside]
    assert leans
    for lean in leans:
        coming = StationBlend(np.zeros(5), np.full(5, float(lean.station)), share)
        together = finger_rotations(hold, {}, 5, {lean.finger: coming, giving_for(lean.finger): home})
        for frame in range(5):
            one = {
                name: StationBlend(*(values[[frame]] for values in placed))
                for name, placed in ((lean.finger, coming), (giving_for(lean.finger), home))
            }
            assert np.array_equal(together[[frame]], finger_rotations(hold, {}, 1, one))


@given(st.lists(st.tuples(st.sampled_from([0.0, -0.0, 1.0, float("nan"), 2.0**-60]), st.integers(0, 3)), max_size=120))
def test_distinct_rows_are_those_whose_bits_differ(rows: list[tuple[float, int]]) -> None:
    values = np.array([value for value, _ in rows])
    numbers = np.array([number for _, number in rows], np.intp)
    firsts, same = distinct_rows((values, numbers))
    keys = [(value.tobytes(), int(number)) for value, number in zip(values, numbers, strict=True)]
    assert [keys[firsts[row]] for row in same.tolist()] == keys
    if len(rows) >= finger_ik.LEAST_COMPARED:
        assert len(firsts) == len(set(keys))
