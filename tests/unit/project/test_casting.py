"""Places and amplitudes are reproducible and differ between players."""

from __future__ import annotations

import itertools
import math

import pytest

from app.project.casting import (
    SPACING_M,
    Footprint,
    amplitude,
    player_seed,
    stage_arc,
    stage_seats,
)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 10, 12])
def test_the_arc_is_open_to_the_audience(count: int) -> None:
    places = stage_arc(count)
    assert len(places) == count
    assert [place.x_m for place in places] == sorted(place.x_m for place in places)
    for place, mirrored in zip(places, reversed(places), strict=True):
        assert place.x_m == pytest.approx(-mirrored.x_m)
        assert place.turn_rad == pytest.approx(-mirrored.turn_rad)
        assert abs(place.turn_rad) < math.pi / 2  # no one turns the back to the audience
        # Everyone is turned towards the middle.
        assert place.x_m * place.turn_rad <= 0.0
    for one, other in itertools.pairwise(places):
        assert math.hypot(one.x_m - other.x_m, one.z_m - other.z_m) >= SPACING_M * 0.999


@pytest.mark.parametrize("count", [13, 20, 50, 200])
def test_a_band_sits_in_rows(count: int) -> None:
    places = stage_seats((Footprint(),) * count)
    assert len(places) == count
    for one, other in itertools.combinations(places, 2):
        assert math.hypot(one.x_m - other.x_m, one.z_m - other.z_m) >= SPACING_M * 0.999
    radii = [round(math.hypot(place.x_m, place.z_m), 6) for place in places]
    assert radii == sorted(radii)  # the first of the score in front
    for row in sorted(set(radii)):
        own = [place for place, radius in zip(places, radii, strict=True) if radius == row]
        assert sum(place.x_m for place in own) == pytest.approx(0.0, abs=1e-6)
        assert [place.x_m for place in own] == sorted(place.x_m for place in own)
    # A square block, not a ring: everyone is within the side of a square with five times the room a player needs.
    assert max(radii) < 2.0 * math.sqrt(5.0 * count)
    assert all(place.x_m * place.turn_rad <= 1e-12 and abs(place.turn_rad) < math.pi / 2 for place in places)


def test_players_differ_and_repeat() -> None:
    sizes = [amplitude(1, f"part-{index}") for index in range(50)]
    assert sizes == [amplitude(1, f"part-{index}") for index in range(50)]
    assert len(set(sizes)) > 40
    assert all(0.38 <= size <= 0.62 for size in sizes)
    assert amplitude(1, "x") != amplitude(2, "x")
    assert player_seed(0, "x") != player_seed(0, "y")
