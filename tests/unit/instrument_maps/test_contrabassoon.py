"""The contrabassoon's fingerings compared with the bassoon's where they must agree, and its size with real ones."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering
from resources.build import instrument_contrabassoon as model

BASSOON, CONTRA = (bundled_maps()[name] for name in ("bassoon", "contrabassoon"))
OCTAVE = 12


def first(written: int) -> set[str]:
    return set(CONTRA.fingerings_for(written - OCTAVE)[0].label.split()) - {"(open)"}


def bassoon(written: int) -> set[str]:
    return set(BASSOON.fingerings_for(written)[0].label.split())


@pytest.mark.parametrize("fingering", CONTRA.fingerings, ids=lambda one: f"{one.written_pitch}-{one.rank}")
def test_every_fingering_is_possible(fingering: Fingering) -> None:
    signs = fingering.label.split()
    thumb = {sign for sign in signs if sign.startswith("Lt_")}
    low = ["Lt_d", "Lt_c", "Lt_b", "Lt_bes"]
    assert len(thumb) <= 1 or thumb in ({"Lt_c2", "Lt_cis"}, *(set(low[:count]) for count in (2, 3, 4)))
    for group in (("Rt_",), ("Lp_",), ("Rp_",), ("L3", "Lr_"), ("R3", "Rr_")):
        assert sum(sign.startswith(group) for sign in signs) <= 1
    assert bool(fingering.tags) == (fingering.rank > 1)


def test_the_seven_lowest_notes_are_the_bassoons() -> None:
    for written in range(34, 41):
        assert first(written) == bassoon(written) - {"Lt_w"}
        assert {"Rp_f", "Rt_e"} <= first(written)


def test_first_register_is_the_bassoons_without_whisper_key() -> None:
    for written in range(41, 54):
        assert (first(written) == bassoon(written) - {"Lt_w"}) == (written != 51)
    assert first(51) == {"L1", "L2", "Lr_es"}  # The fork is the bassoon's alone.
    assert not any(sign in ("Lt_w", "L1h") for one in CONTRA.fingerings for sign in one.label.split())


def test_the_index_finger_is_lifted_where_the_bassoon_half_closes_its_hole() -> None:
    for written in (54, 55, 56):
        assert first(written) == bassoon(written) - {"Lt_w", "L1h"}
        assert "L1h" in bassoon(written)


def test_a_vent_stays_open_from_a_to_c() -> None:
    for written in range(57, 61):
        assert first(written) == bassoon(written) | {"Lt_c2"}


def test_an_octave_below_what_is_written_and_the_register_begins_at_the_breaks() -> None:
    assert CONTRA.transposition_semitones == OCTAVE
    assert (CONTRA.range.low, CONTRA.range.high) == (22, 60)
    fingers = [len(first(written) & {"L1", "L2", "L3", "R1", "R2", "R3"}) for written in range(41, 64)]
    rises = [42 + k for k, (a, b) in enumerate(itertools.pairwise(fingers)) if b > a + 1]
    assert rises == [written for written in CONTRA.breaks if written != 57]
    assert "Lt_c2" in first(57)
    assert "Lt_c2" not in first(56)


def test_the_contrabassoon_is_135_cm_high_with_its_pin_out() -> None:
    build, *_ = model.INSTRUMENTS["contrabassoon"]
    points = np.vstack([part.shape.points for part in build().parts])
    high_m = points[:, 1].max() - points[:, 1].min()
    assert 1.25 < high_m < 1.35 < high_m + CONTRA.endpin.most_m < 1.45
    assert points[:, 1].min() == pytest.approx(CONTRA.endpin.tip_m[1], abs=0.001)
