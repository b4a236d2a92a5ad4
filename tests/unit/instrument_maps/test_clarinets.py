"""The clarinets' fingerings compared with four public charts, and their sizes with real ones."""

from __future__ import annotations

from collections import defaultdict

import pytest

from instrument_maps.load import bundled_maps
from tests.support.charts import Charts

MAPS = bundled_maps()
CLARINET = MAPS["clarinet_Bb"]
CHARTS = Charts("clarinet_Bb")

EXCEPTIONS = {
    53: "the charts are two to two; methods for beginners teach the right little finger (F beside E of the left)",
    72: "as F 3, a twelfth above",
    92: "every chart has its own; what one gives first and another as an alternate",
    93: "likewise",
    94: "likewise",
    95: "only one chart gives an order, and asks the left index for its hole and the G sharp key at once",
    96: "likewise",
}
"""Reason by written pitch why the map differs from the charts' majority, or which charts it follows without a
majority.
"""

HALF_FROM = 85
"""Written pitch from which the bass clarinet opens the small hole in the first plate instead of the whole hole."""
FINGER = {
    "T": "left thumb", "R": "left thumb", "A": "left index", "G#": "left index", "L1": "left index",
    "L2": "left middle", "L3": "left ring", "LEb": "left ring", "LE": "left little", "LF": "left little",
    "LF#": "left little", "LC#": "left little", "R1": "right index", "S1": "right index", "S2": "right index",
    "S3": "right index", "S4": "right index", "R2": "right middle", "R3": "right ring", "RB": "right ring",
    "RE": "right little", "RF": "right little", "RF#": "right little", "RG#": "right little",
}  # fmt: skip
TOGETHER = ({"T", "R"}, {"S3", "S4"}, {"S1", "S2"})


def possible(label: str) -> bool:
    """Return whether ten fingers can play a fingering."""
    asked: dict[str, set[str]] = defaultdict(set)
    for sign in label.split():
        if sign not in FINGER:
            return label == "(open)"
        asked[FINGER[sign]].add(sign)
    return all(len(signs) == 1 or signs in TOGETHER for signs in asked.values())


@pytest.mark.parametrize("written", range(52, 97))
def test_first_choices_are_the_charts_majority(written: int) -> None:
    shift = CLARINET.transposition_semitones
    label = CLARINET.fingerings_for(written - shift)[0].label
    assert possible(label)
    if written in EXCEPTIONS:
        assert label != CHARTS.majority(written), "an exception that is none"
        assert label in CHARTS.notes[written]
    else:
        assert label == CHARTS.majority(written)


def test_alternates_are_in_a_chart_and_have_a_reason() -> None:
    for fingering in CLARINET.fingerings:
        assert possible(fingering.label), fingering
        # The charts contain neither trills nor keys kept pressed between notes.
        if not {"trill", "held"} & set(fingering.tags):
            assert fingering.label in CHARTS.notes[fingering.written_pitch], fingering
        assert bool(fingering.tags) == (fingering.rank > 1), fingering


def test_a_and_e_flat_clarinets_are_fingered_as_the_b_flat_and_sound_elsewhere() -> None:
    for name, shift in (("clarinet_A", 3), ("clarinet_Eb", -3)):
        instrument = MAPS[name]
        assert instrument.transposition_semitones == shift
        assert instrument.fingerings == CLARINET.fingerings
        assert instrument.fingerings_for(60 - shift)[0].label == "L1 L2 L3 T"
        assert instrument.range.low == 52 - shift


def test_bass_clarinet_goes_to_e_flat_and_opens_a_small_hole_above_the_break() -> None:
    bass = MAPS["clarinet_bass_Bb"]
    assert bass.range.low == 37
    assert bass.fingerings_for(37)[0].label == "L1 L2 L3 R1 R2 R3 REb T"
    assert bass.fingerings_for(60 - 14)[0].label == "L1 L2 L3 T"
    half = bass.fingerings_for(88 - 14)[0]
    assert half.label == "L1h L2 L3 R RG# T"
    assert 0 < half.controls["hole_L1"] < 1
    for fingering in bass.fingerings:
        if 52 <= fingering.written_pitch < HALF_FROM:
            assert fingering in CLARINET.fingerings


def test_little_fingers_have_both_sides() -> None:
    for written in (52, 53, 54, 71, 72, 73):
        labels = [fingering.label for fingering in CLARINET.fingerings_for(written - 2)]
        sides = {sign[0] for label in labels[:2] for sign in label.split() if sign[1:] in ("E", "F", "F#")}
        assert sides == {"L", "R"}
