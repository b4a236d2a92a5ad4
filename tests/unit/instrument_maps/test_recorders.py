"""The recorders' fingerings compared with a public chart, and the two sizes with each other."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from instrument_maps.load import bundled_maps

SOPRANO, ALTO = (bundled_maps()[name] for name in ("recorder_soprano_C", "recorder_alto_F"))
CHART = Path(__file__).parents[2] / "data" / "fingerings" / "recorder_soprano_C.csv"
EXCEPTIONS = {
    70: "the chart's B flat is not the baroque fingering: methods teach the first and third finger and the fourth",
    85: "the bell is closed on the knee, for which the instrument has no control",
}
HALVES = {"lth", "r3h", "r4h"}
"""Controls that may be half closed: the pinched thumb and the double holes."""
ALTO_ABOVE_SOPRANO = 5


def chart() -> dict[int, str]:
    """Fingerings by written pitch of the soprano."""
    with CHART.open(encoding="utf-8") as file:
        return {int(row["written_pitch"]): row["fingering"] for row in csv.DictReader(file)}


@pytest.mark.parametrize("written", range(60, 87))
def test_first_choices_are_the_charts(written: int) -> None:
    label = SOPRANO.fingerings_for(written + 12)[0].label
    assert (label == chart()[written]) == (written not in EXCEPTIONS)


def test_alto_is_fingered_a_fourth_higher_and_sounds_as_written() -> None:
    assert (SOPRANO.range.low, SOPRANO.range.high) == (72, 98)
    assert (ALTO.range.low, ALTO.range.high) == (65, 91)
    for fingering in SOPRANO.fingerings:
        same = [other.label for other in ALTO.fingerings_for(fingering.written_pitch + ALTO_ABOVE_SOPRANO)]
        assert fingering.label in same
    assert len(ALTO.fingerings) == len(SOPRANO.fingerings)


def test_only_thumb_and_double_holes_close_half() -> None:
    signs = {sign for fingering in SOPRANO.fingerings for sign in fingering.label.split() if sign.endswith("h")}
    assert signs == HALVES
    pinched = SOPRANO.fingerings_for(88)[0]
    assert 0 < pinched.controls["hole_lt"] < 1
