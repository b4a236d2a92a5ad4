"""The wind controller's fingerings compared with the effect of each key, its octaves with the rollers, and its size."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from app.rig.grip.finger_stations import stations
from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering
from resources.build import instrument_ewi as model

EWI = bundled_maps()["ewi"]
OCTAVES = 7
LOWEST_C = 24
"""Lowest C in the lowest octave; between the third and fourth knurled rollers it is C 3."""


def sounding(keys: set[str]) -> int:
    """Pitch of some keys in semitones above the low C of the thumb's octave."""
    first, second, little = "L1" in keys, "L2" in keys, "Lp1" in keys
    steps = {
        "L1": -2, "L2": -2 if first else -1, "bis": 0 if first and second else -1, "L3": -2, "Lp1": 1, "Lp2": -1,
        "Rs": 0 if little else 1, "R1": -2 if "L3" in keys else -1, "R2": -1, "R3": -2, "Rp1": 1, "Rp2": -1, "Rp3": -2,
    }  # fmt: skip
    return 13 + sum(step for key, step in steps.items() if key in keys)


def signs(fingering: Fingering) -> tuple[set[str], int]:
    """Keys of a fingering without the thumb, and the thumb's octave."""
    words = fingering.label.split()
    (octave,) = (word for word in words if word[0] == "o")
    return set(words) - {octave}, int(octave[1:])


@pytest.mark.parametrize("fingering", EWI.fingerings, ids=lambda one: f"{one.written_pitch}-{one.rank}")
def test_keys_and_octave_sum_up_to_the_note(fingering: Fingering) -> None:
    keys, octave = signs(fingering)
    assert LOWEST_C + 12 * (octave - 1) + sounding(keys) == fingering.written_pitch
    assert bool(fingering.tags) == (fingering.rank > 1)


def test_it_reaches_over_seven_octaves_and_sounds_as_written() -> None:
    assert (EWI.range.low, EWI.range.high) == (22, 109)
    assert all(EWI.fingerings_for(pitch) for pitch in range(22, 110))
    assert EWI.transposition_semitones == 0


def test_every_octave_is_fingered_alike() -> None:
    for pitch in range(EWI.range.low + 12, EWI.range.high - 12 + 1):
        if pitch >= EWI.breaks[0] and pitch + 12 <= EWI.range.high:
            below, above = (signs(EWI.fingerings_for(place)[0]) for place in (pitch, pitch + 12))
            assert below[0] == above[0]
            assert above[1] == below[1] + 1


def test_the_thumb_moves_on_at_d_and_at_the_breaks_only() -> None:
    octaves = [signs(EWI.fingerings_for(pitch)[0])[1] for pitch in range(EWI.range.low, EWI.range.high + 1)]
    assert octaves == sorted(octaves)
    assert set(octaves) == set(range(1, OCTAVES + 1))
    moved = [EWI.range.low + 1 + k for k, (a, b) in enumerate(itertools.pairwise(octaves)) if a != b]
    assert moved == list(EWI.breaks)
    assert all(pitch % 12 == 2 for pitch in moved)


def test_what_lies_in_two_octaves_can_be_played_in_both() -> None:
    for pitch in range(36, 98):
        found = {signs(one)[1] for one in EWI.fingerings_for(pitch)}
        assert len(found) == (2 if pitch % 12 in (0, 1, 10, 11) else 1)


def test_the_thumb_lies_between_neighbouring_rollers() -> None:
    thumb = stations(EWI)["left.thumb"]
    assert thumb[0].controls == (f"octave_{model.HOME_OCTAVE}",)
    places = {place.controls[0]: EWI.contacts[place.contacts[0]].position_m for place in thumb}
    along = [places[f"octave_{number}"][2] for number in range(1, 8)]
    # A higher octave is nearer to the mouth, and the steps are the rollers'.
    assert np.allclose(np.diff(along), -model.ROLLER_APART, atol=2e-5)
    assert all(EWI.control(f"octave_{number}").hover_m == 0 for number in range(1, 8))


def test_nothing_moves_and_thirteen_keys_are_touched() -> None:
    assert EWI.moving_parts == ()
    assert len([one for one in EWI.controls if not one.name.startswith("octave_")]) == 13


def test_the_controller_is_62_cm_long() -> None:
    build, *_ = model.INSTRUMENTS["ewi"]
    points = np.vstack([part.shape.points for part in build().parts])
    assert np.ptp(points[:, 2]) == pytest.approx(0.62, abs=0.01)
    assert np.ptp(points[:, 0]) < 0.066
