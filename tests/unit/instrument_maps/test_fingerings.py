"""Bundled tables of fingerings compared with published charts and acoustics."""

from __future__ import annotations

import itertools
import math

import pytest

from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering, InstrumentMap

TRUMPET = bundled_maps()["trumpet_Bb"]
TROMBONE = bundled_maps()["trombone_tenor_F_attachment"]
MAPS = [pytest.param(instrument, id=name) for name, instrument in bundled_maps().items()]
BRASS = [param for param in MAPS if param.values[0].acoustics is not None]

THESIS_TABLE_3_1 = {
    # concert pitch: trumpet valves, trombone position
    0x39: ("2", "2"),
    0x3B: ("123", "4"),
    0x3C: ("13", "3"),
    0x3E: ("12", "1"),
    0x40: ("2", "2"),
    0x41: ("0", "1"),
    0x43: ("12", "2"),
    0x45: ("2", "2"),
}

# The first choices (rank 1) of the public charts named in the maps' sources, concert pitch ascending.
TRUMPET_CHART = "123 13 23 12 1 2 0 123 13 23 12 1 2 0 23 12 1 2 0 12 1 2 0 1 2 0 23 12 1 2 0"  # E3 to B flat 5
TROMBONE_CHART = (  # C2 to B flat 4; A flat 4 in 3; E 2 and B 2 with the attachment, where the chart has 7
    "T6 T5 T4 T3 T2 6 5 4 3 2 1 T2 6 5 4 3 2 1 5 4 3 2 1 4 3 2 1 3 2 1 3 2 3 2 1"
)

SLIDE_TRAVEL_M = 0.62


def harmonic(partial: int) -> float:
    """Distance of a harmonic from the fundamental in cents."""
    return 1200 * math.log2(partial)


def slide_m(fingering: Fingering) -> float:
    return fingering.controls.get("slide", 0.0) * SLIDE_TRAVEL_M


def test_first_choices_are_the_thesis_table() -> None:
    for concert, (valves, position) in THESIS_TABLE_3_1.items():
        assert TRUMPET.fingerings_for(concert)[0].label == valves
        assert TROMBONE.fingerings_for(concert)[0].label == position


def test_first_choices_are_the_charts() -> None:
    assert [TRUMPET.fingerings_for(52 + k)[0].label for k in range(31)] == TRUMPET_CHART.split()
    assert [TROMBONE.fingerings_for(36 + k)[0].label for k in range(35)] == TROMBONE_CHART.split()


def test_written_and_concert_pitch() -> None:
    assert TRUMPET.fingerings_for(58)[0].written_pitch == 60  # written C 4 sounds B flat 3
    assert TROMBONE.fingerings_for(58)[0].written_pitch == 58


@pytest.mark.parametrize("instrument", MAPS)
def test_every_note_of_the_range_has_fingerings_in_order_of_rank(instrument: InstrumentMap) -> None:
    for concert in range(instrument.range.low, instrument.range.high + 1):
        found = instrument.fingerings_for(concert)
        assert [fingering.rank for fingering in found] == list(range(1, len(found) + 1))
        assert len({fingering.label for fingering in found}) == len(found)


@pytest.mark.parametrize("instrument", MAPS)
def test_out_of_range_gets_the_nearest_playable_note(instrument: InstrumentMap) -> None:
    low, high = instrument.range.low, instrument.range.high
    assert instrument.fingerings_for(low - 1) == instrument.fingerings_for(low)
    assert instrument.fingerings_for(0) == instrument.fingerings_for(low)
    assert instrument.fingerings_for(127) == instrument.fingerings_for(high)
    assert not instrument.in_range(low - 1)
    assert instrument.in_range(high)


def sounding_cents(instrument: InstrumentMap, fingering: Fingering, partial: int) -> float:
    """Deviation from the requested note if a harmonic is blown: from tube lengths only, none of the map's cents.

    A valve's own tube is as long as its semitones ask for when it is alone; a trigger lengthens the tube the
    slide then lengthens twice its extension.
    """
    acoustics = instrument.acoustics
    assert acoustics is not None
    ratio = again = 1.0
    for name, semitones in acoustics.semitones.items():
        added = fingering.controls.get(name, 0.0) * (2 ** (semitones / 12) - 1)
        if name == acoustics.compensator:
            again += added
        else:
            ratio += added
    length_m = acoustics.tube_m * ratio * again
    if acoustics.slide_control is not None:
        length_m += 2 * slide_m(fingering)
    lowered = 1200 * math.log2(length_m / acoustics.tube_m)
    requested = 100 * (fingering.written_pitch - instrument.transposition_semitones - acoustics.fundamental_pitch)
    return harmonic(partial) - lowered - requested


@pytest.mark.parametrize("instrument", BRASS)
def test_every_fingering_is_a_harmonic_of_its_tube_and_its_cents_are_true(instrument: InstrumentMap) -> None:
    for fingering in instrument.fingerings:
        deviation = min((sounding_cents(instrument, fingering, partial) for partial in range(1, 17)), key=abs)
        assert abs(deviation) < 60 or ("lipped" in fingering.tags and abs(deviation) < 105), fingering
        assert fingering.cents == pytest.approx(deviation, abs=2.0), fingering


@pytest.mark.parametrize(
    ("label", "published_cents"),
    [("12", 11), ("23", 16), ("13", 30), ("123", 54)],
)
def test_valve_sums_are_as_sharp_as_published(label: str, published_cents: int) -> None:
    # the second and fourth harmonics have no deviation of their own
    octaves = [f for f in TRUMPET.fingerings if f.label == label and f.written_pitch < 60]
    assert [f.cents for f in octaves] == [published_cents]


def test_intonation_slides_correct_the_sharp_sums_and_only_those() -> None:
    travels = {"first_slide": 0.020, "third_slide": 0.035}
    for fingering in TRUMPET.fingerings:
        expected = {"12": "first_slide", "13": "third_slide", "123": "third_slide"}.get(fingering.label)
        assert set(fingering.correction) == ({expected} if expected else set())
        for name, value in fingering.correction.items():
            # twice the slide's travel must add what the sum of the valves is short of
            semitones = sum({"1": 2, "2": 1, "3": 3}[valve] for valve in fingering.label)
            short = (
                2 ** (semitones / 12)
                - 1
                - sum(2 ** ({"1": 2, "2": 1, "3": 3}[valve] / 12) - 1 for valve in fingering.label)
            )
            assert 2 * value * travels[name] == pytest.approx(1.48 * short, abs=2e-4)


def test_slide_positions_are_the_usual_places() -> None:
    # octaves of the fundamental, untouched by the harmonics' deviations: B flat 2 down to E 2
    plain = [next(one for one in TROMBONE.fingerings_for(46 - k) if one.label == str(k + 1)) for k in range(7)]
    places = [slide_m(one) for one in plain]
    assert places == pytest.approx([0.0, 0.082, 0.169, 0.261, 0.359, 0.463, 0.572], abs=0.002)
    assert all(low < high for low, high in itertools.pairwise(places))


def test_positions_with_the_trigger_are_longer_and_six() -> None:
    plain = [slide_m(TROMBONE.fingerings_for(46 - k)[0]) for k in range(6)]
    trigger = [next(slide_m(f) for f in TROMBONE.fingerings_for(41 - k) if f.label == f"T{k + 1}") for k in range(6)]
    for near, far in zip(plain[1:], trigger[1:], strict=True):
        assert far / near == pytest.approx(2 ** (5 / 12), abs=0.002)
    assert trigger[-1] <= SLIDE_TRAVEL_M
    assert not any(f.label == "T7" for f in TROMBONE.fingerings)


def test_raised_second_for_g4_is_about_26_mm_short_of_second() -> None:
    second = slide_m(TROMBONE.fingerings_for(45)[0])
    raised = TROMBONE.fingerings_for(67)[0]
    assert raised.label == "2"
    assert second - slide_m(raised) == pytest.approx(0.026, abs=0.001)


@pytest.mark.parametrize("instrument", MAPS)
def test_labels_say_what_the_controls_do(instrument: InstrumentMap) -> None:
    labels = {control.name: control.label for control in instrument.controls if control.label}
    for fingering in instrument.fingerings:
        pressed = "".join(sign for name, sign in labels.items() if fingering.controls.get(name, 0.0) > 0)
        slide = instrument.acoustics is not None and instrument.acoustics.slide_control is not None
        if slide:
            position = fingering.label.lstrip("TG")
            assert fingering.label == pressed + position
            assert 1 <= int(position) <= 7
        elif any(control.kind in ("key", "hole") for control in instrument.controls):
            whole = {name: f"{labels[name]}{'h' if value < 1 else ''}" for name, value in fingering.controls.items()}
            assert fingering.label.split() == (sorted(whole.values()) or ["(open)"])
        else:
            assert sorted(fingering.label.replace("0", "")) == sorted(pressed)


def test_slide_stands_within_a_hand_of_its_position() -> None:
    # a place is its position, raised or lowered by what the harmonic is out of tune: never half a position
    tubes = {"": 2.76, "T": 2.76 * 2 ** (5 / 12)}
    for fingering in TROMBONE.fingerings:
        tube_m = tubes[fingering.label[:-1]]
        place = 12 * math.log2(1 + 2 * slide_m(fingering) / tube_m) + 1
        assert abs(place - int(fingering.label[-1])) < 0.32, fingering


def test_values_cover_every_control() -> None:
    held = TRUMPET.values(TRUMPET.fingerings_for(60)[0], held=True)
    assert held["valve_1"] == held["valve_3"] == 1.0
    assert held["valve_2"] == held["first_slide"] == 0.0
    assert held["third_slide"] == pytest.approx(0.49)
    assert TRUMPET.values(TRUMPET.fingerings_for(60)[0])["third_slide"] == 0.0
