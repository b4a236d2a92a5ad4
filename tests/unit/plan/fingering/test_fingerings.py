"""Fingerings: the thesis's table, the search compared with players' practice, corrections, and flags."""

from __future__ import annotations

import pytest

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.fingering.search import PHRASE_SILENCE_S
from app.plan.fingering.trills_and_runs import trill_steps
from app.plan.generate import MonophonicPart
from app.plan.model import FingeringEvent, Problem, grips_of
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.plan import PlainClock, PlainNote, even, line_of, slide, valves

TRUMPET = bundled_maps()["trumpet_Bb"]
TROMBONE = bundled_maps()["trombone_tenor_F_attachment"]

# Table 3.1 of the 2018 thesis: concert pitch, valves, slide position.
TABLE_3_1 = [
    (0x39, "2", "2"),
    (0x3B, "123", "4"),
    (0x3C, "13", "3"),
    (0x3E, "12", "1"),
    (0x40, "2", "2"),
    (0x41, "0", "1"),
    (0x43, "12", "2"),
    (0x45, "2", "2"),
]


def plan(
    notes: tuple[PlainNote, ...], instrument: InstrumentMap, pins: dict[str, str] | None = None, bpm: float = 120.0
) -> tuple[tuple[FingeringEvent, ...], tuple[Problem, ...]]:
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock(((0, bpm),)))
    return plan_fingerings(notes, times, instrument, pins or {})


def labels(notes: tuple[PlainNote, ...], instrument: InstrumentMap, **more: object) -> list[str]:
    return [event.label for event in plan(notes, instrument, **more)[0]]


@pytest.mark.parametrize(("pitch", "valve_label", "slide_label"), TABLE_3_1)
def test_a_single_note_is_played_as_table_3_1_says(pitch: int, valve_label: str, slide_label: str) -> None:
    notes = line_of((0, 480, pitch))
    assert labels(notes, TRUMPET) == [valve_label]
    assert labels(notes, TROMBONE) == [slide_label]


def test_a_slow_scale_keeps_first_choices() -> None:
    scale = list(range(52, 88))
    assert {event.rank for event in plan(even(scale, 240), TRUMPET)[0]} == {1}
    slow = plan(even(list(range(36, 78)), 960), TROMBONE)[0]
    # But the valve stays turned from E 2 to F 2 and from B 2 to C 3.
    assert [(event.label, 36 + place) for place, event in enumerate(slow) if event.rank > 1] == [("T1", 41), ("T1", 48)]


def test_a_trill_shares_valves() -> None:
    # 60 is 13 and 62 is 12: two fingers a step; 62 on 3 leaves one.
    notes = even([60, 62] * 6, 120, start_tick=480)
    events, _ = plan(notes, TRUMPET, bpm=150.0)
    assert [event.label for event in events] == ["13", "3"] * 6
    assert events[3].reason.id == "fingering.trill"
    slow, _ = plan(even([60, 62] * 6, 480), TRUMPET)
    assert {event.rank for event in slow} == {1}


def test_no_trill_is_fast_enough_for_a_rare_fingering() -> None:
    # 63 on 1 and 64 on 2: 64 on 123 would be as few fingers, and none in contrary motion.
    for step_tick in (60, 120):
        events, _ = plan(even([63, 64] * 6, step_tick, start_tick=480), TRUMPET, bpm=120.0)
        assert {event.label for event in events} == {"1", "2"}


def test_a_hand_that_turns_to_side_keys_moves_nothing_else_where_it_can() -> None:
    # Palm keys take the left hand off the pearls: from high C the front key gives E; from D the palm keys go on.
    sax = bundled_maps()["sax_alto_Eb"]
    for low, label in ((84, "2L 3L ff oct"), (86, "oct pd peb se")):
        events, _ = plan(even([low - 9, 88 - 9] * 2, 120), sax, bpm=120.0)
        assert [event.label for event in events[1::2]] == [label] * 2


def test_a_trill_is_fingered_alike_from_its_first_note_to_its_last() -> None:
    flute = bundled_maps()["flute"]
    for low, high in ((66, 67), (66, 68), (78, 79)):
        events, _ = plan(even([low, high] * 6, 60), flute, bpm=120.0)
        assert len({event.label for event in events}) == 2


def test_a_correction_within_a_trill_is_for_its_note_alone() -> None:
    notes = even([63, 64] * 6, 60)
    usual = [event.label for event in plan(notes, TRUMPET, bpm=120.0)[0]]
    for place in (1, 3, 9, 11):
        events, _ = plan(notes, TRUMPET, {notes[place].id: "123"}, bpm=120.0)
        assert [at for at, event in enumerate(events) if event.label != usual[at]] == [place]
        assert events[place].corrected


def test_alternating_thirds_are_no_trill() -> None:
    times = line_times(MonophonicPart("p", even([60, 64] * 6, 100), TRUMPET), PlainClock())
    assert not trill_steps(times).any()
    times = line_times(MonophonicPart("p", even([60, 62] * 6, 100), TRUMPET), PlainClock())
    assert trill_steps(times).all()
    times = line_times(MonophonicPart("p", even([60, 62, 64, 65, 67], 100), TRUMPET), PlainClock())
    assert not trill_steps(times).any()


def test_the_slide_takes_the_attachment_where_six_is_too_far() -> None:
    # F 2 is 6, B flat 2 is 1: 0.46 m, 185 ms at 2.5 m/s; an eighth at 180 leaves 83 ms.
    notes = even([46, 41, 46, 41, 46], 240)
    assert labels(notes, TROMBONE, bpm=180.0) == ["1", "T1", "1", "T1", "1"]
    assert labels(notes, TROMBONE, bpm=60.0) == ["1", "6", "1", "6", "1"]


@pytest.mark.parametrize("bpm", [60.0, 100.0, 120.0, 140.0])
def test_the_slide_stays_near_and_comes_back_to_the_same_place(bpm: float) -> None:
    # B flat 2, C 3, D 3, C 3: without the trigger C is in 6, out and back between 1 and 4.
    figure = [46, 48, 50, 48]
    assert labels(even(figure, 120), TROMBONE, bpm=bpm) == ["1", "T1", "4", "T1"]
    assert labels(even(figure * 3, 120), TROMBONE, bpm=bpm) == ["1", "T1", "4", "T1"] * 3
    assert labels(even([*figure, 46], 120), TROMBONE, bpm=80.0) == ["1", "T1", "4", "T1", "1"]


@pytest.mark.parametrize("step_tick", [240, 120, 100, 80])
@pytest.mark.parametrize("figure", [[48, 50, 48, 50], [48, 50] * 4, [50, 48, 50, 48], [43, 48, 50, 48, 43]])
def test_d_beside_c_is_played_in_four_without_the_attachment(figure: list[int], step_tick: int) -> None:
    # Players do not turn the lever at every note to save a small distance of the slide.
    assert "T4" not in labels(even(figure, step_tick), TROMBONE)


def test_c_between_b_flats_takes_the_attachment_and_b_flat_does_not() -> None:
    # From the bass of the bundled quartet, at its tempo: C, B flat, C, D flat.
    notes = line_of((0, 480, 48), (480, 240, 46), (720, 240, 48), (960, 480, 49), (1440, 480, 49))
    assert labels(notes, TROMBONE, bpm=156.0) == ["T1", "1", "T1", "5", "5"]


def test_a_repeated_note_keeps_its_fingering_but_for_a_pin_or_a_rest() -> None:
    # B flat comes from B flat, D flat comes next: of two C, the one in between suits both, or one is changed.
    notes = line_of((0, 240, 44), (240, 240, 46), (480, 480, 48), (960, 480, 48), (1440, 480, 49))
    found = labels(notes, TROMBONE, bpm=156.0)
    assert found[2] == found[3]
    pinned, _ = plan(notes, TROMBONE, {"1:4": "6"}, bpm=156.0)
    assert [event.label for event in pinned[2:4]] == ["T1", "6"]
    free = line_of((0, 240, 44), (240, 240, 46), (480, 480, 48), (1440 + 960, 480, 48), (2880, 480, 49))
    assert labels(free, TROMBONE, bpm=156.0)[2:4] == ["T1", "6"]


def test_a_slur_over_natural_notes_leaves_the_slide_where_it_is() -> None:
    # G 3, B 3, D 4 are partials of the fourth position; D 4 is first in 1, and there is all the time to go there.
    assert labels(even([55, 59, 62, 59], 240), TROMBONE) == ["4", "4", "4", "4"]
    assert labels(even([55, 59, 62, 59], 960), TROMBONE) == ["4", "4", "1", "4"]


def test_a_slide_that_cannot_arrive_is_flagged_with_what_it_needs() -> None:
    notes = even([40, 46], 120)
    events, problems = plan(notes, slide(), {"1:1": "7", "1:2": "1"}, bpm=180.0)
    assert [event.label for event in events] == ["7", "1"]
    (problem,) = problems
    assert problem.message.id == "fingering.starts_early"
    assert problem.note_id == "1:2"
    needed = events[0].controls["slide"] * 0.62 / 2.5
    assert problem.message.arguments["needed_ms"] == round(needed * 1000)
    assert problem.message.arguments["available_ms"] == round(0.5 * (60 / 180 / 4) * 1000)
    assert problem.end_s - problem.start_s == pytest.approx(needed)


def test_a_rest_before_the_note_gives_the_slide_time() -> None:
    tight = line_of((0, 240, 46), (240, 240, 41))
    free = line_of((0, 240, 46), (480, 240, 41))
    assert labels(tight, TROMBONE, bpm=180.0)[1] == "T1"
    assert labels(free, TROMBONE, bpm=180.0)[1] == "6"


def test_intonation_controls_are_set_only_on_held_notes_of_their_fingerings() -> None:
    # 60 is 13 (third slide), 62 is 12 (first slide), 65 is open.
    events, _ = plan(line_of((0, 960, 60), (960, 960, 62), (1920, 960, 65), (2880, 120, 60)), TRUMPET)
    assert set(events[0].controls) == {"valve_1", "valve_3", "third_slide"}
    assert set(events[1].controls) == {"valve_1", "valve_2", "first_slide"}
    assert events[2].controls == {}
    assert set(events[3].controls) == {"valve_1", "valve_3"}


def test_the_slide_place_includes_the_partials_intonation() -> None:
    events, _ = plan(line_of((0, 480, 67), (480, 480, 69)), TROMBONE)
    g4, a4 = (event.controls["slide"] * 0.62 for event in events)
    assert [event.label for event in events] == ["2", "2"]
    assert a4 - g4 == pytest.approx(0.026, abs=0.002)


def test_a_note_out_of_range_is_flagged_and_played_an_octave_off() -> None:
    events, problems = plan(line_of((0, 480, 40), (480, 480, 60)), TRUMPET)
    assert events[0].label == TRUMPET.fingerings_for(52)[0].label
    assert [problem.message.id for problem in problems] == ["fingering.out_of_range"]
    assert problems[0].message.arguments == {"note": "1:1", "low": 52, "high": 87, "played_pitch": 52}


def test_a_pin_wins_and_the_search_solves_around_it() -> None:
    notes = even([46, 41, 46, 41, 46], 240)
    events, problems = plan(notes, TROMBONE, {"1:2": "6"}, bpm=180.0)
    assert events[1].label == "6"
    assert events[1].corrected
    assert events[1].reason.id == "fingering.by_hand"
    assert events[3].label == "T1"
    assert not events[3].corrected
    assert {problem.note_id for problem in problems} == {"1:2", "1:3"}


def test_a_pin_that_is_no_fingering_of_its_note_is_reported() -> None:
    events, problems = plan(line_of((0, 480, 65)), TRUMPET, {"1:1": "2"})
    assert events[0].label == "0"
    assert not events[0].corrected
    assert problems[0].message.id == "correction.no_such_fingering"


def test_events_carry_their_notes_times_and_ids() -> None:
    events, _ = plan(line_of((480, 480, 65), (900, 480, 67)), valves())
    assert [event.id for event in events] == ["fingering:1:1", "fingering:1:2"]
    assert (events[0].start_tick, events[0].end_tick) == (480, 900)
    assert events[0].end_s == events[1].start_s == pytest.approx(900 / 960)
    assert PHRASE_SILENCE_S > 0


def test_a_bassoon_flicks_at_the_attack_and_holds_the_note_without() -> None:
    """Short notes are vented throughout, and so are notes with a fingering set by the user."""
    notes = line_of((0, 480, 50), (480, 900, 57), (1920, 960, 60), (3840, 100, 57), (4320, 960, 45))
    instrument = bundled_maps()["bassoon"]
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock())
    events, _ = plan_fingerings(notes, times, instrument, {})
    grips = [(grip.note_id, round(grip.start_s, 3), round(grip.end_s, 3), grip.label) for grip in grips_of(events)]
    assert grips == [
        ("1:1", 0.0, 0.5, "L1 L2 Lt_w"),
        ("1:2", 0.5, 0.65, "L1 L2 L3 Lt_a R1 R2"),
        ("1:2", 0.65, 1.438, "L1 L2 L3 R1 R2"),
        ("1:3", 2.0, 2.15, "L1 L2 L3 Lt_c2"),
        ("1:3", 2.15, 3.0, "L1 L2 L3"),
        ("1:4", 4.0, 4.104, "L1 L2 L3 Lt_a R1 R2"),
        ("1:5", 4.5, 5.5, "L1 L2 L3 Lt_w R1 R2"),
    ]
    assert [event.note_id for event in events] == [note.id for note in notes]
    pinned, _ = plan_fingerings(notes, times, instrument, {"1:2": "L1 L2 L3 Lt_a R1 R2"})
    assert [grip.label for grip in grips_of(pinned) if grip.note_id == "1:2"] == ["L1 L2 L3 Lt_a R1 R2"]
    assert grips_of(events[:1]) == events[:1]
