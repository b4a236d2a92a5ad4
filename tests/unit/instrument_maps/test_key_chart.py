"""Drawn fingerings: positions of holes and keys and closed ones, compared with published charts."""

from __future__ import annotations

import csv
from collections import defaultdict
from itertools import combinations
from pathlib import Path

import msgspec
import pytest

from instrument_maps.fingering_label import controls_of, says_words
from instrument_maps.key_chart import HOLE, PAD, ChartedKey, KeyChart, key_chart
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap

CHARTED = {id: one for id, one in bundled_maps().items() if says_words(one.controls)}
MAPS = [pytest.param(instrument, id=id) for id, instrument in CHARTED.items()]
PUBLISHED = Path("tests/data/fingerings")


def overlaps(one: ChartedKey, other: ChartedKey) -> bool:
    (wide, tall), (wide_2, tall_2) = ((HOLE, HOLE) if key.is_round else PAD for key in (one, other))
    return abs(one.x - other.x) < (wide + wide_2) / 2 and abs(one.y - other.y) < (tall + tall_2) / 2


@pytest.mark.parametrize("instrument", MAPS)
@pytest.mark.parametrize("said", [True, False], ids=["said", "not_said"])
def test_every_key_has_a_place_of_its_own(instrument: InstrumentMap, said: bool) -> None:
    """Also in maps without positions, such as a user's."""
    assert all(key.at is not None and key.sign for key in instrument.chart)
    chart = key_chart(instrument if said else msgspec.structs.replace(instrument, chart=()))
    assert {key.control.name for key in chart.keys} == {one.name for one in instrument.controls}
    assert not any(overlaps(*pair) for pair in combinations(chart.keys, 2))


@pytest.mark.parametrize("instrument", MAPS)
def test_the_left_hand_is_above_the_right_and_each_has_its_fingers_in_order(instrument: InstrumentMap) -> None:
    chart = key_chart(instrument)
    order = ["left.index", "left.middle", "left.ring", "right.index", "right.middle", "right.ring", "right.little"]
    fingers = [key.control.finger for key in chart.column]
    assert fingers == order[: len(fingers)]
    assert len(fingers) >= 6
    assert chart.between_hands is not None
    assert chart.column[2].y < chart.between_hands < chart.column[3].y
    # Within the reach of a small picture.
    assert -1.0 < chart.top < 0.0
    assert chart.bottom < 7.0


@pytest.mark.parametrize(
    ("id", "file", "signs"),
    [
        ("clarinet_Bb", "clarinet_Bb", "L1 L2 L3 R1 R2 R3"),
        ("flute", "flute", "L1 L2 L3 R1 R2 R3"),
        ("sax_alto_Eb", "saxophone", "1L 2L 3L 1R 2R 3R"),
        ("oboe", "oboe", "L1 L2 L3 R1 R2 R3"),
    ],
)
def test_the_column_is_that_of_a_published_chart(id: str, file: str, signs: str) -> None:
    instrument = CHARTED[id]
    published = defaultdict(set)
    with (PUBLISHED / f"{file}.csv").open(encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            words = row["fingering"].split()
            drawn = ["●" if one in words else "◐" if f"{one}h" in words else "○" for one in signs.split()]
            published[int(row["written_pitch"])].add("".join(drawn[:3]) + " " + "".join(drawn[3:]))
    first = {one.written_pitch: one.controls for one in instrument.fingerings if one.rank == 1}
    shared = sorted(published.keys() & first.keys())
    assert len(shared) >= 24
    for pitch in shared:
        assert " ".join(key_chart(instrument).in_signs(first[pitch]).split(" ")[:2]) in published[pitch], pitch


@pytest.mark.parametrize(
    ("id", "written", "line"),
    [
        # Method books: low E with the left little finger; throat B flat; first clarion note; side E flat.
        ("clarinet_Bb", 52, "●●● ●●● T E"),
        ("clarinet_Bb", 67, "○○○ ○○○"),
        ("clarinet_Bb", 70, "○○○ ○○○ R A"),
        ("clarinet_Bb", 74, "●●● ●●● T R"),
        ("clarinet_Bb", 63, "●●○ ○○○ T 4"),
        # Yamaha's charts: the E flat key on all but D; thumb B flat; the right little finger on C sharp.
        ("flute", 65, "●●● ●○○ T E♭"),
        ("flute", 67, "●●● ○○○ T E♭"),
        ("flute", 62, "●●● ●●● T"),
        ("flute", 73, "○○○ ○○○ E♭"),
        ("sax_alto_Eb", 62, "●●● ●●●"),
        ("sax_alto_Eb", 68, "●●● ○○○ G♯"),
        ("sax_alto_Eb", 58, "●●● ●●● B♭ C"),
        ("sax_alto_Eb", 73, "○○○ ○○○"),
        ("sax_alto_Eb", 86, "○○○ ○○○ 8 D"),
    ],
)
def test_a_fingering_that_every_player_knows(id: str, written: int, line: str) -> None:
    instrument = CHARTED[id]
    first = next(one for one in instrument.fingerings if one.written_pitch == written and one.rank == 1)
    assert key_chart(instrument).in_signs(first.controls) == line


def test_half_holes_are_half() -> None:
    recorder = CHARTED["recorder_soprano_C"]
    values = controls_of("l1 l2 l3 lth r1 r2 r3h", recorder.controls)
    assert values is not None
    assert key_chart(recorder).in_signs(values) == "●●● ●●◐○ T"


def test_an_instrument_without_two_hands_in_the_column_has_no_line_between_them() -> None:
    assert KeyChart(()).between_hands is None
    assert (KeyChart(()).top, KeyChart(()).bottom) == (0.0, 1.0)
