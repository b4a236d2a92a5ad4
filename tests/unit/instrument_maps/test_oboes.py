"""The oboes' fingerings compared with a public chart, and their sizes with real ones."""

from __future__ import annotations

import csv
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering, InstrumentMap
from resources.build.instrument_oboe import INSTRUMENTS
from tests.support.plan import PlainClock, PlainNote, even

MAPS = bundled_maps()
OBOE, ENGLISH_HORN = MAPS["oboe"], MAPS["english_horn"]
CHART = Path(__file__).parents[2] / "data" / "fingerings" / "oboe.csv"
SAME_CUP = {"Ri_gis": "Lp_gis", "Rp_ees": "Lp_ees"}
"""Key with the same effect as a chart's key: the G sharp and E flat cups by either hand."""
FINGER = {"oct1": "left thumb", "oct2": "left index"} | {
    f"{hand}{number}": f"{side} {finger}"
    for hand, side in (("L", "left"), ("R", "right"))
    for number, finger in (("1", "index"), ("2", "middle"), ("3", "ring"))
}
PLACE = {"i": "index", "m": "middle", "r": "ring", "p": "little"}


def chart() -> dict[int, dict[int, set[str]]]:
    """Fingerings by written pitch and rank."""
    found: dict[int, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
    with CHART.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found[int(row["written_pitch"])][int(row["rank"])].add(row["fingering"])
    return found


def alike(label: str, charted: str) -> bool:
    if label == charted:
        return True
    return any(
        label == " ".join(sorted(other if sign == key else sign for sign in charted.split()))
        for key, other in SAME_CUP.items()
    )


def finger(sign: str) -> str:
    if sign.removesuffix("h") in FINGER:
        return FINGER[sign.removesuffix("h")]
    return f"{'left' if sign[0] == 'L' else 'right'} {PLACE[sign[1]]}"


@pytest.mark.parametrize("written", range(58, 94))
def test_first_choices_are_the_charts(written: int) -> None:
    label = OBOE.fingerings_for(written)[0].label
    assert any(alike(label, one) for one in chart()[written][1])


@pytest.mark.parametrize("fingering", OBOE.fingerings, ids=lambda one: f"{one.written_pitch}-{one.rank}")
def test_every_fingering_is_in_the_chart_and_possible(fingering: Fingering) -> None:
    charted = {one for ranked in chart()[fingering.written_pitch].values() for one in ranked}
    # The chart contains neither trills nor keys kept pressed between notes.
    assert any(alike(fingering.label, one) for one in charted) or {"trill", "held"} & set(fingering.tags)
    assert bool(fingering.tags) == (fingering.rank > 1)
    at_work = [finger(sign) for sign in fingering.label.split()]
    twice = {one for one in at_work if at_work.count(one) > 1}
    # The first finger rolls up against the second octave key without leaving its plate.
    assert not twice or (twice == {"left index"} and "oct2" in fingering.label)


def test_english_horn_is_fingered_as_the_oboe_a_fifth_lower_from_b_up() -> None:
    assert ENGLISH_HORN.transposition_semitones == 7
    assert ENGLISH_HORN.range.low == 59 - 7
    for written in range(59, ENGLISH_HORN.range.high + 8):
        assert ENGLISH_HORN.fingerings_for(written - 7) == OBOE.fingerings_for(written)
    assert ENGLISH_HORN.fingerings_for(58 - 7)[0].written_pitch == 59


def test_f_has_three_fingerings() -> None:
    for written in (65, 77):
        labels = [one.label.split() for one in OBOE.fingerings_for(written) if "trill" not in one.tags]
        assert [next(sign for sign in ("Rr_f", "Lp_f", "R3") if sign in one) for one in labels] == [
            "Rr_f",
            "Lp_f",
            "R3",
        ]


@pytest.mark.parametrize(("name", "wood_m", "tolerance_m"), [("oboe", 0.590, 0.005), ("english_horn", 0.750, 0.02)])
def test_length_of_the_wood(name: str, wood_m: float, tolerance_m: float) -> None:
    build, *_ = INSTRUMENTS[name]
    wood = [part.shape.points for part in build().parts if part.material == "grenadilla"]
    every = np.vstack(wood)
    ends = every[np.argmin(every[:, 2])], every[np.argmax(every[:, 2])]
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(wood_m, abs=tolerance_m)


@pytest.mark.parametrize("instrument", [OBOE, ENGLISH_HORN], ids=lambda one: one.id)
@pytest.mark.parametrize("step_tick", [60, 120])
@pytest.mark.parametrize(
    ("low", "high", "lower", "upper"), [(72, 74, "L1 R1", "L1 Lr_d R1"), (71, 73, "L1", "L1 Rm_cis")]
)
def test_trills_over_the_break_open_a_trill_key_and_nothing_else(
    instrument: InstrumentMap, step_tick: int, low: int, high: int, lower: str, upper: str
) -> None:
    pitches = [written - instrument.transposition_semitones for written in (low, high)]

    def planned(notes: tuple[PlainNote, ...]) -> list[str]:
        times = line_times(MonophonicPart("p", notes, instrument), PlainClock())
        return [event.label for event in plan_fingerings(notes, times, instrument, {})[0]]

    assert planned(even(pitches * 8, step_tick)) == [lower, upper] * 8
    assert upper not in planned(even(pitches * 2, 480))
    run = [written - instrument.transposition_semitones for written in (69, 71, 72, 73, 74, 76)]
    assert upper not in planned(even(run, step_tick))
