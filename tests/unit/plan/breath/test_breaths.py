"""Rule T6 of the thesis at its thresholds, with various tempi, tempo changes and felt beats; catch breaths."""

from __future__ import annotations

import dataclasses
import itertools

import msgspec
import pytest

from app.messages import LANGUAGES, text
from app.plan.breath.catch_breath_lengths import CATCH_MAX_S, CATCH_MIN_S, CATCH_NOTE_SHARE, LEAST_SOUNDING_S
from app.plan.by_hand.corrections import RemoveEvent, SetBreath
from app.plan.generate import MonophonicPart
from app.plan.model import BreathEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from instrument_maps.wind import Air
from tests.support.plan import PlainClock, PlainNote, even, line_of, make_plans, piece_of, time_frame, valves

Q = 480
METRE = (Metre(0, 4, 4),)


def plan(
    notes: tuple[PlainNote, ...],
    clock: PlainClock | None = None,
    felt: int | None = None,
    preroll: float = 4.0,
    **parameters: object,
) -> PlayerPlan:
    clock = clock or PlainClock()
    piece = piece_of(clock, METRE, felt)
    line = MonophonicPart("p", notes, valves(), PlayerParameters(**{"breath_need": 0.0, **parameters}))
    return make_plans(piece, (line,), time_frame((line,), clock, preroll, felt))["p"]


def before(plan_: PlayerPlan, note_id: str) -> dict[str, BreathEvent]:
    return {event.kind: event for event in plan_.breaths if event.id.endswith(note_id)}


def with_rest(rest_tick: int, start: int = 4 * Q) -> tuple[PlainNote, ...]:
    return line_of((start, Q, 65), (start + Q + rest_tick, Q, 67))


def with_velocities(notes: tuple[PlainNote, ...], *velocities: int) -> tuple[PlainNote, ...]:
    """Line with these velocities in turn."""
    return tuple(
        dataclasses.replace(note, velocity=velocity)
        for note, velocity in zip(notes, itertools.cycle(velocities), strict=False)
    )


@pytest.mark.parametrize("bpm", [60.0, 90.0, 120.0, 200.0])
@pytest.mark.parametrize(
    ("rest_beats", "breath_beats", "preparation_beats", "rule"),
    [
        (0.45, None, None, None),
        (0.5, 0.5, None, "breath.rest_whole"),
        (0.75, 0.75, None, "breath.rest_whole"),
        (1.0, 1.0, None, "breath.last_beat"),
        (1.5, 1.0, None, "breath.last_beat"),
        (1.95, 1.0, None, "breath.last_beat"),
        (2.0, 1.0, 1.0, "breath.prepared"),
        (7.0, 1.0, 1.0, "breath.prepared"),
    ],
)
def test_a_breath_follows_the_length_of_the_rest(
    bpm: float, rest_beats: float, breath_beats: float | None, preparation_beats: float | None, rule: str | None
) -> None:
    rest = round(rest_beats * Q)
    events = before(plan(with_rest(rest), PlainClock(((0, bpm),))), "1:2")
    onset = 5 * Q + rest
    if breath_beats is None:
        assert events == {}
        return
    breath = events["breath"]
    assert (breath.start_tick, breath.end_tick) == (onset - round(breath_beats * Q), onset)
    assert breath.reason.id == rule
    assert breath.start_s == pytest.approx(breath.start_tick / Q * 60.0 / bpm)
    assert breath.end_s == pytest.approx(onset / Q * 60.0 / bpm)
    if preparation_beats is None:
        assert "preparation" not in events
    else:
        assert (events["preparation"].start_tick, events["preparation"].end_tick) == (onset - 2 * Q, onset - Q)


def test_one_tick_decides() -> None:
    assert before(plan(with_rest(Q // 2 - 1)), "1:2") == {}
    assert before(plan(with_rest(Q // 2)), "1:2")["breath"].reason.id == "breath.rest_whole"
    assert before(plan(with_rest(Q - 1)), "1:2")["breath"].reason.id == "breath.rest_whole"
    assert before(plan(with_rest(Q)), "1:2")["breath"].reason.id == "breath.last_beat"
    assert set(before(plan(with_rest(2 * Q - 1)), "1:2")) == {"breath"}
    assert set(before(plan(with_rest(2 * Q)), "1:2")) == {"breath", "preparation"}


def test_a_tempo_change_inside_the_rest_moves_seconds_not_beats() -> None:
    # The rest is beats 5 to 8; from beat 7 on the tempo halves.
    clock = PlainClock(((0, 120.0), (7 * Q, 60.0)))
    events = before(plan(with_rest(3 * Q), clock), "1:2")
    assert (events["preparation"].start_s, events["preparation"].end_s) == pytest.approx((3.0, 3.5))
    assert (events["breath"].start_s, events["breath"].end_s) == pytest.approx((3.5, 4.5))


def test_a_felt_beat_replaces_the_quarter() -> None:
    # A dotted quarter in a fast 6/8: 2 quarters of rest are 1.33 felt beats, so there is no preparation.
    events = before(plan(with_rest(2 * Q), felt=3 * Q // 2), "1:2")
    assert set(events) == {"breath"}
    assert events["breath"].start_tick == 7 * Q - 3 * Q // 2


def test_thresholds_are_the_players() -> None:
    rest = with_rest(Q)
    assert before(plan(rest, breath_min_beats=1.5), "1:2") == {}
    whole = before(plan(with_rest(3 * Q // 2), breath_last_beat_beats=1.6), "1:2")["breath"]
    assert whole.start_tick == 5 * Q
    assert whole.reason.id == "breath.rest_whole"
    early = before(plan(with_rest(3 * Q // 2), breath_prepare_beats=1.5), "1:2")
    assert (early["preparation"].start_tick, early["preparation"].end_tick) == (5 * Q, 5 * Q + Q // 2)


def test_the_first_note_is_prepared_in_the_pre_roll() -> None:
    events = before(plan(line_of((0, Q, 65))), "1:1")
    assert (events["preparation"].start_s, events["preparation"].end_s) == (-1.0, -0.5)
    assert (events["breath"].start_s, events["breath"].end_s) == (-0.5, 0.0)
    assert events["breath"].reason.id == "breath.first"


def test_a_short_pre_roll_has_no_room_to_prepare() -> None:
    # One beat at 30 beats/min is 2 s: all there is.
    events = before(plan(line_of((0, Q, 65)), PlainClock(((0, 30.0),)), preroll=1.0), "1:1")
    assert set(events) == {"breath"}
    assert events["breath"].start_s == -2.0


def test_no_catch_breath_where_the_air_lasts() -> None:
    plan_ = plan(even([65] * 16, Q))
    assert len(plan_.breaths) == 2
    assert plan_.problems == ()


def test_a_catch_breath_is_taken_at_the_best_phrase_end() -> None:
    # 14 s without a rest; a half note stands before the bar line at beat 16 (tick 7680).
    notes = line_of(
        *((index * Q, Q, 65 + index % 3) for index in range(14)),
        (14 * Q, 2 * Q, 65),
        *((index * Q, Q, 72 + index % 3) for index in range(16, 28)),
    )
    plan_ = plan(notes)
    (catch,) = [event for event in plan_.breaths if event.reason.id == "breath.catch"]
    assert catch.end_tick == 16 * Q
    assert catch.end_s == pytest.approx(8.0)
    length_s = catch.end_s - catch.start_s
    assert CATCH_MIN_S <= length_s <= min(CATCH_MAX_S, CATCH_NOTE_SHARE * 1.0) + 1e-9
    assert catch.reason.arguments["after_note"] == "1:15"
    assert catch.reason.arguments["from_note_ms"] == round(length_s * 1000)
    # The lips leave with the breath; the fingers and the sounding note stay.
    assert plan_.embouchures[14].end_s == pytest.approx(catch.start_s)
    assert plan_.fingerings[14].end_tick == 16 * Q
    assert plan_.problems == ()


def test_a_short_silence_serves_a_catch_breath_before_any_note_is_cut() -> None:
    # A quarter of a beat at 60 is 0.25 s: less than the rest thresholds, enough for a catch breath.
    notes = line_of(*((index * Q, Q - (Q // 4 if index == 8 else 0), 65) for index in range(13)))
    plan_ = plan(notes, PlainClock(((0, 60.0),)))
    catches = [event for event in plan_.breaths if event.reason.id == "breath.catch"]
    assert [event.end_tick for event in catches] == [9 * Q]
    assert catches[0].start_s == pytest.approx(8.75)
    assert catches[0].reason.arguments["from_note_ms"] == 0


def test_a_phrase_longer_than_a_lungful_is_flagged() -> None:
    # 20 s of 32nds: no note is long enough to breathe instead of.
    plan_ = plan(even([65, 67] * 160, Q // 8))
    (problem,) = plan_.problems
    assert problem.message.id == "breath.too_long"
    assert problem.note_id == "1:1"
    assert problem.message.arguments["phrase_s"] == 20.0


@pytest.mark.parametrize("step_tick", [Q // 2, 7 * Q // 12])
def test_quick_notes_without_a_rest_are_clipped_for_air(step_tick: int) -> None:
    # 30 s of eighths at 120: a note shortened by a breath would be a staccato of a quarter of a second; the
    # phrase is too long for one breath.
    plan_ = plan(even([65, 67, 69, 67] * 30, step_tick))
    catches = [event for event in plan_.breaths if event.reason.id == "breath.catch"]
    assert plan_.problems == ()
    ends = [0.0, *(event.end_s for event in catches), 120 * step_tick / Q / 2]
    assert max(later - earlier for earlier, later in itertools.pairwise(ends)) <= 9.0
    for event in catches:
        assert CATCH_MIN_S - 1e-9 <= event.end_s - event.start_s <= step_tick / Q / 2 - LEAST_SOUNDING_S + 1e-9


def test_a_quarter_is_cut_rather_than_an_eighth() -> None:
    # Bars of six eighths and a quarter: every breath is taken out of the quarter, before the bar line.
    notes = []
    for bar in range(12):
        notes += [(bar * 4 * Q + index * Q // 2, Q // 2, 65 + index) for index in range(6)]
        notes.append((bar * 4 * Q + 3 * Q, Q, 65))
    catches = [event for event in plan(line_of(*notes)).breaths if event.reason.id == "breath.catch"]
    assert catches
    assert {event.end_tick % (4 * Q) for event in catches} == {0}


@pytest.mark.parametrize(("velocities", "air_s"), [((64,), 20.0), ((127, 95), 28.0)])
def test_a_catch_breath_says_how_much_air_is_needed_and_how_much_there_is(
    velocities: tuple[int, ...], air_s: float
) -> None:
    # 20 s without a rest at 120, on the lungs that a first breath fills; ff takes 1.4 of what mezzoforte does.
    catch, *others = [
        event
        for event in plan(with_velocities(even([65] * 40, Q), *velocities), lung_s=9.0).breaths
        if event.reason.id == "breath.catch"
    ]
    arguments = catch.reason.arguments
    assert (arguments["phrase_s"], arguments["lung_s"]) == (20.0, 9.0)
    assert arguments["air_s"] == pytest.approx(air_s, rel=0.02)
    # All are about the same stretch.
    assert {(event.reason.arguments["air_s"], event.reason.arguments["lung_s"]) for event in others} <= {
        (arguments["air_s"], arguments["lung_s"])
    }
    said = {language: text(catch.reason, language) for language in LANGUAGES}
    assert f"need {arguments['air_s']:g} s of air, but 9 s are available" in said["en"]
    assert f"{arguments['air_s']:g} 秒分の息が必要ですが、9 秒分しかありません" in said["ja"]


def test_loud_playing_needs_more_breaths_and_big_lungs_fewer() -> None:
    notes = even([65] * 60, Q)
    loud = with_velocities(notes, 127, 95)

    def count(notes_: tuple[PlainNote, ...], **parameters: object) -> int:
        return len(plan(notes_, **parameters).breaths)

    assert count(loud) > count(notes) > count(notes, lung_s=14.0)


@pytest.mark.parametrize(
    ("bpm", "left_out", "reason"),
    [
        (100.0, 1, "breath.catch_dropped"),
        (120.0, 2, "breath.catch_dropped_two"),
        (160.0, 2, "breath.catch_dropped_two"),
    ],
)
def test_in_endless_quick_notes_weak_notes_are_left_out(bpm: float, left_out: int, reason: str) -> None:
    notes, clock = even([60 + index % 5 for index in range(400)], Q // 4), PlainClock(((0, bpm),))
    made = plan(notes, clock)
    caught = [event for event in made.breaths if event.kind == "breath" and event.id != "breath:1:1"]
    assert caught
    assert {event.reason.id for event in caught} == {reason}
    assert not made.problems
    lips = [event for event in made.embouchures if event.note_id is not None]
    number = {note.id: index for index, note in enumerate(notes)}
    for event in caught:
        assert CATCH_MIN_S - 1e-6 <= event.end_s - event.start_s <= CATCH_MAX_S + 1e-6
        here = number[event.id.removeprefix("breath:")]
        first = here - left_out
        assert notes[first].onset_tick % Q != 0, "not the one on the beat"
        assert all(lips[index].start_s == lips[index].end_s for index in range(first, here))
        # The one before begins, and is shortened by half.
        assert lips[first - 1].end_s == pytest.approx(event.start_s)
        assert lips[first - 1].end_s - lips[first - 1].start_s >= 0.5 * 15.0 / bpm - 1e-6
    # Deleted, it is taken elsewhere, and the notes are played.
    gone = caught[0]
    corrections = (RemoveEvent(gone.id, gone.id.removeprefix("breath:")),)
    line = MonophonicPart("p", notes, valves(), PlayerParameters(), corrections)
    again = make_plans(piece_of(clock, METRE), (line,), time_frame((line,), clock))["p"]
    assert gone.id not in {event.id for event in again.breaths}
    played = {event.note_id: event for event in again.embouchures}[str(gone.reason.arguments["after_note"])]
    assert played.end_s > played.start_s


def test_no_note_is_left_out_right_after_the_rest_that_is_breathed_in() -> None:
    """The omitted note and the rest before it would be two overlapping breaths."""
    notes = line_of(*((60 * step, 60, 65) for step in range(9)), (780, 60, 65), (840, 1920, 67))
    made = plan(notes, PlainClock(((0, 100.0),)), lung_s=2.0)
    assert [event.id for event in made.breaths if event.kind == "breath"] == ["breath:1:1", "breath:1:10"]


@pytest.mark.parametrize("last_tick", [60, 90, 110, 119])
def test_a_note_cut_for_a_breath_that_leaves_out_the_next_keeps_half(last_tick: int) -> None:
    # An overlapping long note, a tiny one under its end, and then the entry: written, the long one has more room.
    ticks = [*((tick, 1) for tick in range(9)), (9, 120), (9 + last_tick, 1), (10 + last_tick, 960)]
    notes = tuple(PlainNote(f"1:{index + 1}", tick, lasts, 65, 64) for index, (tick, lasts) in enumerate(ticks))
    made = plan(notes, PlainClock(((0, 30.0),)), lung_s=3.0)
    (caught,) = (event for event in made.breaths if event.reason.id == "breath.catch_dropped")
    onset_s, end_s = (tick / 240.0 for tick in (9, 9 + last_tick))
    assert end_s - max(caught.start_s, onset_s) <= max(0.5 * (end_s - onset_s), CATCH_MIN_S) + 1e-6


def test_no_note_is_left_out_of_a_slur() -> None:
    # Four slurred sixteenths, four tongued ones, and so on: breaths come among the tongued.
    notes = line_of(
        *(
            (index * Q // 4, Q // 4 + (10 if index % 8 < 3 else -10 if index % 8 > 3 else -8), 60 + index % 5)
            for index in range(320)
        )
    )
    made = plan(notes, PlainClock(((0, 108.0),)))
    caught = [event for event in made.breaths if event.reason.id.startswith("breath.catch_dropped")]
    assert caught
    number = {note.id: index for index, note in enumerate(notes)}
    assert all(number[event.id.removeprefix("breath:")] % 8 not in {1, 2, 3, 4} for event in caught)


@pytest.mark.parametrize("bpm", [66.0, 96.0, 120.0, 144.0, 180.0])
def test_no_breath_is_a_gasp_while_another_place_or_a_note_left_out_gives_air(bpm: float) -> None:
    # Two bars of running notes, and one with a short rest; and again.
    rows, at = [], 0
    for _ in range(12):
        for length, sounds in (*[(Q // 4, True)] * 24, *[(Q // 2, True)] * 4, (Q // 4, False), *[(Q // 4, True)] * 7):
            rows += [(at, length, 60 + at // Q % 7)] * sounds
            at += length
    made = plan(line_of(*rows), PlainClock(((0, bpm),)), breath_need=0.35)
    breaths = [event for event in made.breaths if event.kind == "breath"]
    assert len(breaths) > 5
    assert min(event.end_s - event.start_s for event in breaths) >= CATCH_MIN_S - 1e-6
    assert not made.problems


def test_with_circular_breathing_the_line_goes_on_until_a_rest() -> None:
    notes = (*even([65, 67] * 60, Q), PlainNote("1:121", 124 * Q, Q, 65))
    usual = plan(notes)
    assert "breath.catch" in {event.reason.id for event in usual.breaths}
    found = plan(notes, circular_breathing=True)
    assert [event.id for event in found.breaths if event.kind == "breath"] == ["breath:1:1", "breath:1:121"]
    assert not found.problems
    # A breath by hand stays one.
    hand = SetBreath("1:40", -240, 0, 0.5)
    line = MonophonicPart("p", notes, valves(), PlayerParameters(circular_breathing=True), (hand,))
    clock = PlainClock()
    made = make_plans(piece_of(clock, METRE), (line,), time_frame((line,), clock))["p"]
    assert "breath:1:40" in {event.id for event in made.breaths}


def test_an_instrument_that_takes_little_air_is_breathed_for_seldom() -> None:
    notes = even([65 + index % 3 for index in range(120)], Q)

    def breaths(notes_: tuple[PlainNote, ...], air: Air | None, **parameters: float) -> list[BreathEvent]:
        instrument = msgspec.structs.replace(valves(), air=air)
        line, clock = MonophonicPart("p", notes_, instrument, PlayerParameters(**parameters)), PlainClock()
        made = make_plans(piece_of(clock, METRE), (line,), time_frame((line,), clock))["p"]
        return [event for event in made.breaths if event.kind == "breath"]

    clarinet, flute, tuba = Air(15.0, 12.0, 9.0), Air(14.0, 9.0, 6.0), Air(10.0, 6.5, 4.0)
    counts = [len(breaths(notes, air)) for air in (clarinet, flute, tuba)]
    assert counts == sorted(counts)
    assert len(set(counts)) == 3
    # 60 s: 12 on the first breath, 6 on each of 0.25 s out of a quarter (a full one takes 0.5 s).
    assert counts[0] == 9
    # However little air is taken, it goes stale.
    assert breaths(notes, Air(40.0, 32.0, 25.0)) == breaths(notes, Air(12.0, 12.0, 12.0))
    assert breaths(notes, Air(9.0, 9.0, 9.0)) == breaths(notes, None)
    # Values in a map refer to usual lungs; larger ones last longer in proportion.
    assert len(breaths(notes, tuba, lung_s=18.0)) == len(breaths(notes, Air(20.0, 13.0, 8.0)))
    soft = with_velocities(notes, 24, 56)
    assert len(breaths(soft, flute)) < len(breaths(notes, flute))
    (message,) = {
        event.reason.arguments["lung_s"] for event in breaths(notes, clarinet) if event.reason.id == "breath.catch"
    }
    assert message == 12.0


@pytest.mark.parametrize("octave", [0, 12])
def test_players_of_one_line_breathe_in_different_places(octave: int) -> None:
    notes = even([65 + index % 5 for index in range(60)], Q)
    twin = tuple(
        PlainNote(f"2:{index + 1}", n.onset_tick, n.duration_tick, n.pitch + octave) for index, n in enumerate(notes)
    )
    clock = PlainClock()
    lines = (MonophonicPart("a", notes, valves()), MonophonicPart("b", twin, valves()))
    plans = make_plans(piece_of(clock, METRE), lines, time_frame(lines, clock))
    places = [{event.end_tick for event in plans[name].breaths if event.reason.id == "breath.catch"} for name in "ab"]
    assert places[0]
    assert places[1]
    assert places[0].isdisjoint(places[1])


def test_depth_grows_with_the_phrase_and_is_limited_by_time() -> None:
    short = plan(line_of((0, Q, 65))).breaths[-1]
    long = plan(even([65] * 16, Q)).breaths[-1]
    hurried = before(plan(with_rest(Q // 2), PlainClock(((0, 200.0),))), "1:2")["breath"]
    assert 0.0 < short.depth < long.depth <= 1.0
    assert hurried.depth <= 0.3 + 1e-9
