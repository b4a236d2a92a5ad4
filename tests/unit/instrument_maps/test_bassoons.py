"""The bassoon's fingerings compared with the effects of its holes and keys, and its size with real ones."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering
from resources.build.instrument_bassoon import INSTRUMENTS

BASSOON = bundled_maps()["bassoon"]
LOW_ROW = {"Lt_d", "Lt_c", "Lt_b", "Lt_bes"}
THUMB_AT_ONCE = [LOW_ROW, LOW_ROW - {"Lt_bes"}, {"Lt_d", "Lt_c"}, {"Lt_cis", "Lt_w"}]
"""Sets of keys that the left thumb can press together."""
FLICKED = {57: "Lt_a", 58: "Lt_a", 59: "Lt_c2", 60: "Lt_c2", 62: "Lt_d2"}


def first(written: int) -> set[str]:
    return set(BASSOON.fingerings_for(written)[0].label.split())


@pytest.mark.parametrize("fingering", BASSOON.fingerings, ids=lambda one: f"{one.written_pitch}-{one.rank}")
def test_every_fingering_is_possible(fingering: Fingering) -> None:
    signs = [sign.removesuffix("h") for sign in fingering.label.split() if sign != "(open)"]
    thumb = {sign for sign in signs if sign.startswith("Lt_")}
    assert len(thumb) <= 1 or thumb in THUMB_AT_ONCE
    for group in ("Rt_", "Lp_", "Rp_"):
        assert sum(sign.startswith(group) for sign in signs) <= 1
    assert bool(fingering.tags) == (fingering.rank > 1)


def test_from_g_to_d_a_finger_is_lifted_for_every_step_of_the_scale() -> None:
    scale = [43, 45, 47, 48, 50, 52, 53]
    holes = [sorted(first(written) - {"Lt_w"}) for written in scale]
    assert [len(one) for one in holes] == [6, 5, 4, 3, 2, 1, 0]
    assert all(set(above) < set(below) for below, above in itertools.pairwise(holes))


def test_low_notes_close_one_key_of_the_thumb_after_the_other() -> None:
    keys = [first(written) & LOW_ROW for written in (38, 36, 35, 34)]
    assert [len(one) for one in keys] == [1, 2, 3, 4]
    assert all("Rp_f" in first(written) for written in range(34, 42))
    # Fingerings below F also close the E hole, with the right thumb; C sharp 2 is C 2 with an additional key.
    assert [written for written in range(34, 75) if "Rt_e" in first(written)] == list(range(34, 41))
    assert first(37) == first(36) | {"Lp_des"}


def test_whisper_key_is_down_up_to_g_sharp_and_the_half_hole_where_the_register_begins() -> None:
    for written in range(39, 57):
        assert "Lt_w" in first(written)
    for written in range(57, 75):
        assert "Lt_w" not in first(written)
    assert [written for written in range(34, 69) if "L1h" in first(written)] == [54, 55, 56]


def test_the_register_above_repeats_the_one_below_without_the_whisper_key() -> None:
    for written in (45, 46, 47, 48, 49, 50):
        assert first(written + 12) == first(written) - {"Lt_w"}
    for written, key in FLICKED.items():
        assert any(key in one.label.split() for one in BASSOON.fingerings_for(written)[1:])


def test_the_bassoon_reaches_from_b_flat_1_to_d_5() -> None:
    assert (BASSOON.range.low, BASSOON.range.high) == (34, 74)
    assert all(BASSOON.fingerings_for(written) for written in range(34, 75))


def test_the_bassoon_is_134_cm_long() -> None:
    build, *_ = INSTRUMENTS["bassoon"]
    points = np.vstack(
        [part.shape.points for part in build().parts if part.material in ("maple", "silver", "ivory_plastic")]
    )
    axis = np.linalg.svd(points[::7] - points.mean(0), full_matrices=False)[2][0]
    assert np.ptp(points @ axis) == pytest.approx(1.34, abs=0.03)
