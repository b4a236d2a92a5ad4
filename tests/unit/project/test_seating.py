"""Seating: sections in a band's rows, and no overlap of instruments with neighbours."""

from __future__ import annotations

import math
from itertools import combinations, pairwise

import numpy as np
import pytest

from app.project.casting import BACK_M, ELBOW_M, Footprint, StagePosition, stage_arc, stage_seats
from app.project.footprint import footprint
from instrument_maps.instrument_names import vocabulary
from instrument_maps.load import bundled_maps

MAPS = list(bundled_maps().values())


def corners(place: StagePosition, taken: Footprint) -> np.ndarray:
    """Corners (4, 2) on the stage of the rectangle of body and instrument; left is +X before the rotation."""
    left, right = max(taken.left_m, ELBOW_M), max(taken.right_m, ELBOW_M)
    box = np.array([[left, -BACK_M], [left, taken.ahead_m], [-right, taken.ahead_m], [-right, -BACK_M]])
    cosine, sine = math.cos(place.turn_rad), math.sin(place.turn_rad)
    turned = np.stack([box @ [cosine, sine], box @ [-sine, cosine]], axis=1)
    return turned + np.array([place.x_m, place.z_m])


def apart(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two rectangles are separated by a line along a side of either."""
    for box in (one, other):
        for side in (box[1] - box[0], box[2] - box[1]):
            normal = np.array([-side[1], side[0]])
            if (one @ normal).max() < (other @ normal).min() or (other @ normal).max() < (one @ normal).min():
                return True
    return False


@pytest.mark.parametrize("count", [2, 3, 5, 12, 13, 28, 30, 50])
def test_no_seats_overlap(count: int) -> None:
    taken = [footprint(MAPS[index * 7 % len(MAPS)]) for index in range(count)]
    boxes = [corners(place, own) for place, own in zip(stage_seats(taken), taken, strict=True)]
    for (place, one), (index, other) in combinations(enumerate(boxes), 2):
        assert apart(one, other), (MAPS[place * 7 % len(MAPS)].id, MAPS[index * 7 % len(MAPS)].id)


def test_wide_instruments_get_more_room_and_long_ones_more_depth() -> None:
    wide = [Footprint(left_m=0.8, right_m=0.7)] * 4
    places = stage_seats(wide)
    gaps = [math.dist((a.x_m, a.z_m), (b.x_m, b.z_m)) for a, b in pairwise(places)]
    assert min(gaps) >= 1.5
    flat, deep = [Footprint(row=1)] * 10, [Footprint(row=1, ahead_m=2.0)] * 10
    front = [Footprint(row=0)] * 10
    assert stage_seats([*front, *deep])[-1].z_m < stage_seats([*front, *flat])[-1].z_m - 0.5


def test_a_band_sits_in_its_sections_from_the_audience_backwards() -> None:
    rows = vocabulary().seating
    families = [(row, place) for row, names in enumerate(rows) for place in range(len(names))]
    # In the order of a score that mixes them up.
    taken = [Footprint(*families[index * 5 % len(families)]) for index in range(30)]
    places = stage_seats(taken)
    radius = [math.hypot(place.x_m, place.z_m) for place in places]
    for (a, one), (b, other) in combinations(enumerate(taken), 2):
        if one.row < other.row:
            assert radius[a] < radius[b]
        if one.row == other.row and one.place < other.place and abs(radius[a] - radius[b]) < 1e-6:
            assert places[a].x_m < places[b].x_m


def test_a_few_stay_on_their_arc() -> None:
    assert stage_seats([footprint(MAPS[0])] * 4) == stage_arc(4)
    assert stage_seats([]) == ()
    assert footprint(None).row == len(vocabulary().seating)


def test_what_a_hand_pulls_out_counts() -> None:
    trombone = bundled_maps()["trombone_tenor_F_attachment"]
    assert footprint(trombone).ahead_m > 1.2
    assert footprint(bundled_maps()["trumpet_Bb"]).ahead_m < 0.9
