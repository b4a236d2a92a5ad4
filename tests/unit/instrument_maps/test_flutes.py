"""The flutes' fingerings compared with three public charts, and their sizes with real ones."""

from __future__ import annotations

import numpy as np
import pytest

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from resources.build.instrument_flute import INSTRUMENTS
from tests.support.charts import Charts
from tests.support.plan import PlainClock, PlainNote, even

MAPS = bundled_maps()
FLUTE, PICCOLO = MAPS["flute"], MAPS["piccolo"]
CHARTS = Charts("flute")
PICCOLO_HIGHEST = 96

EXCEPTIONS = {
    94: "every chart has its own; one of them, which leaves the E flat key up, as methods for high notes do",
    95: "likewise",
    96: "every chart has its own, two of them for a foot that this flute has not; one's second",
    97: "two charts, each with its own",
}
"""Reason by written pitch why the map cannot follow the charts' majority."""


def twice(instrument: InstrumentMap, label: str) -> set[str]:
    """Fingers that a fingering would need in two places."""
    signs = label.split() if label != "(open)" else []
    at_work = [next(control.finger for control in instrument.controls if control.label == sign) for sign in signs]
    return {finger for finger in at_work if at_work.count(finger) > 1}


@pytest.mark.parametrize("written", range(60, 99))
def test_first_choices_are_the_charts_majority(written: int) -> None:
    label = FLUTE.fingerings_for(written)[0].label
    if written in EXCEPTIONS:
        assert CHARTS.majority(written) is None, "an exception that is none"
        assert label in CHARTS.notes[written]
    else:
        assert label == CHARTS.majority(written)


def test_every_fingering_is_in_a_chart_possible_and_has_a_reason() -> None:
    for fingering in FLUTE.fingerings:
        # The charts contain neither trills nor keys kept pressed between notes.
        if not {"trill", "held"} & set(fingering.tags):
            assert fingering.label in CHARTS.notes[fingering.written_pitch], fingering
        assert not twice(FLUTE, fingering.label), fingering
        assert bool(fingering.tags) == (fingering.rank > 1), fingering


def test_the_first_finger_is_lifted_for_d_and_e_flat_of_the_second_octave() -> None:
    for written in range(62, 84):
        low, high = (set(FLUTE.fingerings_for(at)[0].label.split()) for at in (written, min(written + 12, 85)))
        if written in (62, 63):
            assert low - high == {"L1"}
        elif written + 12 <= 85:
            assert low == high


def test_the_piccolo_is_fingered_as_the_flute_without_a_foot_and_sounds_an_octave_higher() -> None:
    assert PICCOLO.transposition_semitones == -12
    assert (PICCOLO.range.low, PICCOLO.range.high) == (62 + 12, PICCOLO_HIGHEST + 12)
    assert {one.label for one in FLUTE.controls} - {one.label for one in PICCOLO.controls} == {"C", "C#"}
    for written in range(62, PICCOLO_HIGHEST + 1):
        found = [(one.label, one.tags) for one in PICCOLO.fingerings_for(written + 12)]
        # Effects of the foot joint's keys are ignored.
        flutes = [(one.label, one.tags) for one in FLUTE.fingerings_for(written)]
        assert found == [(label, tags) for label, tags in flutes if "C" not in label.split()], written
        assert not any(twice(PICCOLO, label) for label, _ in found)
        assert all(label in CHARTS.notes[written] for label, tags in found if not {"trill", "held"} & set(tags))


@pytest.mark.parametrize(("name", "length_m", "tolerance_m"), [("flute", 0.670, 0.012), ("piccolo", 0.320, 0.012)])
def test_length_from_crown_to_foot(name: str, length_m: float, tolerance_m: float) -> None:
    build, *_ = INSTRUMENTS[name]
    every = np.vstack([part.shape.points for part in build().parts if part.node == "root"])
    assert np.ptp(every[:, 0]) == pytest.approx(length_m, abs=tolerance_m)


@pytest.mark.parametrize("instrument", [FLUTE, PICCOLO], ids=lambda one: one.id)
def test_the_tube_lies_on_the_left_index_finger_and_the_right_thumb(instrument: InstrumentMap) -> None:
    borne = {contact.part: contact for contact in instrument.contacts if contact.control is None}
    assert set(borne) == {"left.index.pad_proximal", "right.thumb.pad"}
    assert borne["left.index.pad_proximal"].normal[2] > 0.8  # held to the chin from the far side
    assert borne["right.thumb.pad"].normal[1] < -0.7  # and from below


@pytest.mark.parametrize("instrument", [FLUTE, PICCOLO], ids=lambda one: one.id)
@pytest.mark.parametrize("step_tick", [60, 120])
def test_high_d_is_trilled_with_e_by_both_trill_keys_and_nothing_else(
    instrument: InstrumentMap, step_tick: int
) -> None:
    high_d, trilled = "Eb L2 L3 T", "Eb L2 L3 T tr1 tr2"
    pitches = [written - instrument.transposition_semitones for written in (86, 88)]

    def planned(notes: tuple[PlainNote, ...]) -> list[str]:
        times = line_times(MonophonicPart("p", notes, instrument), PlainClock())
        return [event.label for event in plan_fingerings(notes, times, instrument, {})[0]]

    assert planned(even(pitches * 8, step_tick)) == [high_d, trilled] * 8
    # In a run and in slow notes E has a fingering of its own.
    assert trilled not in planned(even(pitches * 2, 480))
    run = [written - instrument.transposition_semitones for written in (83, 85, 86, 88, 90, 91)]
    assert trilled not in planned(even(run, step_tick))
