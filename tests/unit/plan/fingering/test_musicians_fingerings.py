"""Fingerings that wind players expect: pedal notes, a trombone's valve kept pressed, complete trills, highest notes."""

from __future__ import annotations

import pytest

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, line_of

Q = 480


def labels(instrument: str, notes: list[tuple[float, float, int]], bpm: float = 120.0) -> list[str]:
    """Labels for notes of (onset, length) in quarters and sounding pitch; none may be out of range."""
    made, played = line_of(*((round(at * Q), round(long * Q), pitch) for at, long, pitch in notes)), bundled_maps()
    times = line_times(MonophonicPart("p", made, played[instrument]), PlainClock(((0, bpm),)))
    fingerings, problems = plan_fingerings(made, times, played[instrument], {})
    assert all(problem.message.id == "fingering.starts_early" for problem in problems)
    return [event.label for event in fingerings]


def even(pitches: list[int], step: float) -> list[tuple[float, float, int]]:
    return [(step * n, step, pitch) for n, pitch in enumerate(pitches)]


@pytest.mark.parametrize(
    ("instrument", "fingered"),
    [
        # The fundamental of the open tube, and of the tube with valves: a semitone lower each.
        ("euphonium_Bb_bassclef", {34: "0", 33: "2", 32: "1", 31: "12", 29: "4"}),
        ("euphonium_baritone_Bb_treble", {34: "0", 33: "2"}),
        ("horn_double_F_Bb", {34: "T0", 33: "T2", 32: "T1", 31: "T3", 30: "T23", 29: "0"}),
        ("trombone_tenor_F_attachment", {34: "1", 33: "2", 32: "3", 31: "4", 30: "5", 29: "6", 28: "7"}),
        ("trombone_bass_F_Gb", {34: "1", 33: "2", 32: "3", 31: "4", 29: "6"}),
        ("tuba_Eb", {27: "0", 26: "2", 25: "1"}),
        ("tuba_F", {29: "0", 28: "2"}),
        ("tuba_CC", {24: "0", 23: "2"}),
        ("tuba_BBb", {22: "0", 21: "2"}),
    ],
)
def test_pedal_notes_are_the_tubes_fundamentals(instrument: str, fingered: dict[int, str]) -> None:
    found = labels(instrument, [(4.0 * n, 2.0, pitch) for n, pitch in enumerate(fingered)])
    assert dict(zip(fingered, found, strict=True)) == fingered


def test_a_note_between_the_valves_and_the_pedals_is_lipped_from_the_end_of_the_slide() -> None:
    assert labels("trombone_tenor_F_attachment", even([36, 35, 34], 1.0)) == ["T6", "T6", "1"]


@pytest.mark.parametrize(
    ("pitches", "step", "bpm", "fingered"),
    [
        # Case 23: quarters and sixteenths between the F attachment and the slide's end.
        ([41, 40, 41, 40], 1.0, 120.0, ["T1", "T2", "T1", "T2"]),
        ([46, 47, 48, 49, 50], 0.25, 120.0, ["1", "T2", "T1", "5", "4"]),
        # Alone, or slowly, F 2 and C 3 are in 6.
        ([41], 4.0, 120.0, ["6"]),
        ([41, 43, 45, 46], 2.0, 60.0, ["6", "4", "2", "1"]),
        # Between notes that need the valve it stays.
        ([47, 48, 47, 48, 47], 0.5, 120.0, ["T2", "T1", "T2", "T1", "T2"]),
        ([39, 41, 40], 0.5, 120.0, ["T3", "T1", "T2"]),
    ],
)
def test_a_trombonist_stays_on_the_valve(pitches: list[int], step: float, bpm: float, fingered: list[str]) -> None:
    assert labels("trombone_tenor_F_attachment", even(pitches, step), bpm) == fingered


@pytest.mark.parametrize(
    ("instrument", "low", "high"),
    [("oboe", 72, 74), ("sax_alto_Eb", 63, 65), ("flute", 72, 74), ("trumpet_Bb", 60, 62)],
)
@pytest.mark.parametrize("rest", [0.5, 2.0, 4.0, 64.0])
def test_a_trill_is_fingered_alike_to_its_end_whatever_comes_after_a_rest(
    instrument: str, low: int, high: int, rest: float
) -> None:
    trill = even([low, high] * 8, 0.125)
    alone = labels(instrument, trill)
    after = labels(instrument, [*trill, (2.0 + rest, 1.0, high), (3.0 + rest, 1.0, high + 1)])
    assert after[:16] == alone
    assert len(set(alone)) == 2


@pytest.mark.parametrize(
    ("instrument", "pitch", "label"),
    [
        ("recorder_alto_F", 91, "l1 l3 lth r1 r3"),
        ("recorder_soprano_C", 98, "l1 l3 lth r1 r3"),
        # Altissimo, written G 6 and A 6 (Rascher).
        ("sax_soprano_Bb", 89, "1R 2L 2R leb oct"),
        ("sax_alto_Eb", 82, "1R 2L 2R leb oct"),
        ("sax_tenor_Bb", 79, "2L 3L leb oct"),
    ],
)
def test_the_highest_notes_of_the_charts_are_there(instrument: str, pitch: int, label: str) -> None:
    assert labels(instrument, [(0.0, 2.0, pitch)]) == [label]


@pytest.mark.parametrize("step", [0.5, 0.35, 0.4])
@pytest.mark.parametrize("around", [[83, 74, 83, 79, 83, 74, 83], [81, 83, 74, 83, 74], [76, 83, 74, 76]])
def test_an_oboist_rolls_to_the_half_hole_unless_notes_are_fast(step: float, around: list[int]) -> None:
    found = labels("oboe", even(around, step))
    assert {label for label, pitch in zip(found, around, strict=True) if pitch == 74} == {"L1h L2 L3 R1 R2 R3"}


def test_an_oboist_lifts_the_finger_off_the_half_hole_in_a_fast_figure() -> None:
    assert labels("oboe", even([83, 74, 83, 74, 83, 79], 0.2))[1] == "L2 L3 R1 R2 R3"
