"""Players in unison breathe at different times: in part of a piece, in octaves, and within held notes."""

from __future__ import annotations

import itertools
import random
from collections import Counter

import msgspec
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from app.plan.breath import staggered_breaths
from app.plan.breath.staggered_breaths import Place, SharedLine, after_holds, caught_in_unison
from app.plan.by_hand.corrections import Correction, PinFingering, RemoveEvent, SetBreath
from app.plan.generate import EnsemblePlanning, MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.music.fermatas import Fermata
from app.plan.music.piece import line_times
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from app.steps import StepRuns
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame, valves

Q = 480
METRES = (Metre(0, 4, 4),)
Row = tuple[int, int, int]


def plans(*parts: list[Row], corrections: tuple[Correction, ...] = (), lung_s: float = 7.0) -> list[PlayerPlan]:
    """Plans at 120 of players whose notes are (onset, duration, pitch) in ticks."""
    clock = PlainClock()
    parameters = PlayerParameters(lung_s=lung_s)
    lines = tuple(
        MonophonicPart(
            f"p{number}", line_of(*rows, track=number), valves(), parameters, corrections if number == 1 else ()
        )
        for number, rows in enumerate(parts, 1)
    )
    return list(make_plans(piece_of(clock, METRES), lines, time_frame(lines, clock)).values())


def running(first: int, count: int, low: int = 60) -> list[Row]:
    return [((first + place) * Q, Q, low + place % 5) for place in range(count)]


TUNE = (60, 62, 64, 65, 67, 65, 64, 62)


def joined(own: int, shift: int) -> list[Row]:
    """Quarters without a rest: the common tune between the 16th and the 80th, individual notes elsewhere."""
    pitches = [
        TUNE[place % 8] + shift if 16 <= place < 80 else TUNE[(place * own) % 8] + own - 1 for place in range(96)
    ]
    return [(place * Q, Q, pitch) for place, pitch in enumerate(pitches)]


def caught(plan: PlayerPlan) -> set[float]:
    """Positions in quarters at which catch breaths end."""
    return {round(event.end_tick * 4 / Q) / 4 for event in plan.breaths if event.reason.id == "breath.catch"}


def within(plan: PlayerPlan) -> list[float]:
    return [event.start_s for event in plan.breaths if event.is_within]


def test_a_unison_in_a_part_of_the_piece_is_staggered() -> None:
    own = [(place * Q, Q // 2, 62 + place % 3) for place in range(0, 30, 2)]
    other = [(place * Q, Q, 67 - place % 4) for place in range(1, 30, 4)]
    together = running(32, 64)
    first, second = plans(own + together, other + [(onset, length, pitch + 12) for onset, length, pitch in together])
    both = [{tick for tick in caught(plan) if tick > 32} for plan in (first, second)]
    assert min(map(len, both)) >= 2
    assert not both[0] & both[1]


@pytest.mark.parametrize("shift", [0, 12])
def test_a_tune_that_another_player_joins_is_staggered(shift: int) -> None:
    made = plans(joined(1, 0), joined(3, shift))
    within_tune = [{tick for tick in caught(plan) if 16 <= tick < 80} for plan in made]
    assert min(map(len, within_tune)) >= 4
    # At the edges the lines differ.
    assert not {tick for tick in within_tune[0] & within_tune[1] if 18 <= tick < 78}


def test_a_unison_as_it_was_played_is_staggered_too() -> None:
    by_chance = random.Random(1)
    parts = [
        [(max(onset + by_chance.randint(-14, 14), 0), length - 40, pitch) for onset, length, pitch in running(0, 64)]
        for _ in range(2)
    ]
    first, second = plans(*parts)
    assert min(len(caught(first)), len(caught(second))) >= 2
    written = [{round(place) for place in caught(plan)} for plan in (first, second)]
    assert not written[0] & written[1]


ASKED: list[SharedLine] = []


def counting(line: SharedLine, other: SharedLine, caught: frozenset[Place]) -> frozenset[int]:
    ASKED.append(line)
    return caught_in_unison(line, other, caught)


def test_what_others_keep_clear_of_is_found_again_only_for_who_breathes_elsewhere(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = PlainClock()
    parameters = PlayerParameters(lung_s=7.0)
    parts = [running(0, 64, 60) for _ in range(5)]
    lines = [
        MonophonicPart(f"p{number}", line_of(*rows, track=number), valves(), parameters)
        for number, rows in enumerate(parts, 1)
    ]
    piece, frame = piece_of(clock, METRES), time_frame(tuple(lines), clock)
    runs = StepRuns()
    before = EnsemblePlanning(piece, tuple(lines), frame, runs=runs).finished()
    note = lines[0].notes[9]
    events = before["p1"].fingerings
    other = next(event.label for event in events if event.label != events[9].label)
    ASKED.clear()
    monkeypatch.setattr(staggered_breaths, "caught_in_unison", counting)
    lines[0] = msgspec.structs.replace(lines[0], corrections=(PinFingering(note.id, other),))
    runs = StepRuns(runs)
    after = EnsemblePlanning(piece, tuple(lines), frame, runs=runs).finished()
    assert not ASKED
    lines[2] = msgspec.structs.replace(lines[2], corrections=(SetBreath(lines[2].notes[9].id, -240),))
    last = EnsemblePlanning(piece, tuple(lines), frame, runs=StepRuns(runs)).finished()
    elsewhere = [n for n in range(5) if caught(last[f"p{n + 1}"]) != caught(after[f"p{n + 1}"])]
    assert elsewhere[0] == 2
    assert len(ASKED) == sum(4 - n for n in elsewhere) < 10
    assert last == make_plans(piece, tuple(lines), frame)


SCALE = (60, 62, 64, 65, 67, 69, 71, 72, 74, 76, 77, 79, 81, 83, 84)


def sixteenths(above: int = 0, seed: int = 3) -> list[Row]:
    """Forty seconds without a rest at 120, a number of scale steps above the tune."""
    by_chance, step, rows = random.Random(seed), 3, []
    for place in range(320):
        step = min(max(step + by_chance.choice((-2, -1, -1, 1, 1, 2)), 0), 7)
        rows.append((place * Q // 4, Q // 4, SCALE[step + above]))
    return rows


def left_out(plan: PlayerPlan) -> set[int]:
    """Sixteenths that a player omits."""
    counts = {"breath.catch_dropped": 1, "breath.catch_dropped_two": 2}
    ends = [(event.end_tick * 4 // Q, counts.get(event.reason.id, 0)) for event in plan.breaths]
    return {end - back for end, count in ends for back in range(1, count + 1)}


@pytest.mark.parametrize("above", [(0, 0), (0,) * 3, (0,) * 6, (0, 7), (0, 2), (0, 2, 0, 2), (0, 2, 4)])
def test_players_in_one_fast_line_leave_out_different_notes(above: tuple[int, ...]) -> None:
    made = plans(*map(sixteenths, above))
    alone = [plans(sixteenths(steps))[0] for steps in above]
    assert made[0].breaths == alone[0].breaths
    missing = [left_out(plan) for plan in made]
    assert all(len(each) >= 8 for each in missing)
    near = [{note + off for note in each for off in (-1, 0, 1)} for each in missing]
    assert not any(one & other for one, other in itertools.combinations(near, 2))
    # No player breathes much more often than alone, and each breath follows a note on a beat.
    assert all(len(plan.breaths) <= len(own.breaths) + 1 for plan, own in zip(made, alone, strict=True))
    assert all(note % 4 for each in missing for note in each)


def test_where_there_are_more_players_than_places_few_leave_out_one_note() -> None:
    """Sixteen players in unison, who omit two notes each about every eight seconds."""
    missing = [left_out(plan) for plan in plans(*[sixteenths()] * 16)]
    together = Counter(note for each in missing for note in each)
    assert max(together.values()) <= 3


def test_players_of_other_rhythms_leave_out_what_they_would_alone() -> None:
    triplets = [(place * Q // 6, Q // 6, 60 + place % 5) for place in range(480)]
    assert left_out(plans(sixteenths(), triplets)[1]) == left_out(plans(triplets)[0])


def test_players_in_thirds_breathe_together_where_no_note_is_left_out() -> None:
    tune = running(0, 64)
    beside = plans([(onset, length, pitch + 4) for onset, length, pitch in tune], tune)[1]
    assert caught(beside) == caught(plans(tune)[0])


def test_who_is_corrected_is_kept_clear_of() -> None:
    """The first player's breath is removed and thus moves; the other player avoids the new place."""
    rows = sixteenths()
    plain = plans(rows, rows)
    place = min(left_out(plain[0])) + 2
    moved = plans(rows, rows, corrections=(RemoveEvent(f"breath:1:{place + 1}", f"1:{place + 1}"),))
    assert left_out(moved[0]) != left_out(plain[0])
    assert not left_out(moved[0]) & left_out(moved[1])


def test_notes_that_meet_by_chance_are_no_unison() -> None:
    line = running(0, 64)
    alone = plans(line)[0]
    other = [(onset, length, pitch + (1 if place % 3 else 0)) for place, (onset, length, pitch) in enumerate(line)]
    beside = plans(other, line)[1]
    assert caught(beside) == caught(alone)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_long_held_note_is_handed_on(count: int) -> None:
    held = [(0, 24 * Q, 62), (26 * Q, Q, 64)]
    made = plans(
        *([(onset, length, pitch + 12 * (number % 2)) for onset, length, pitch in held] for number in range(count))
    )
    times = sorted(time for plan in made for time in within(plan))
    # Some breathe twice, to keep away from the others.
    assert count <= len(times) <= 2 * count
    assert all(after - before >= 0.9 for before, after in itertools.pairwise(times))
    assert all(1.0 <= time <= 10.6 for time in times)
    assert not [problem for plan in made for problem in plan.problems if problem.message.id == "breath.too_long"]


@pytest.mark.parametrize("lung_s", [0.3, 0.8, 1.4, 1.6, 2.0, 2.3])
def test_breaths_of_the_smallest_lungs_are_within_the_held_note(lung_s: float) -> None:
    for plan in plans(*([(0, 8 * Q, 60), (8 * Q, 20 * Q, 62)] for _ in range(3)), lung_s=lung_s):
        times = within(plan)
        held = [time for time in times if time > 3.5]
        assert held[0] > 4.0
        assert held[-1] + 0.5 < 14.0
        assert all(after - before >= 1.0 - 1e-9 for before, after in itertools.pairwise(held))


def test_a_held_note_out_of_a_line_without_rests_is_handed_on() -> None:
    line = [*running(0, 8), (8 * Q, 24 * Q, 62), *running(32, 8)]
    made = plans(line, [(onset, length, pitch - 12) for onset, length, pitch in line])
    assert all(1 <= len(within(plan)) <= 2 and all(4.0 < time < 16.0 for time in within(plan)) for plan in made)


def test_who_holds_a_note_alone_does_not_break_it() -> None:
    (plan,) = plans([(0, 24 * Q, 62)])
    assert within(plan) == []
    assert [problem.message.id for problem in plan.problems] == ["breath.too_long"]


def test_a_note_that_others_only_touch_is_not_broken() -> None:
    assert within(plans([(0, 24 * Q, 62)], [(0, Q, 62), (8 * Q, Q, 64)])[0]) == []


def test_a_breath_in_a_held_note_can_be_removed() -> None:
    held = [(0, 24 * Q, 62)]
    first, second = plans(held, held, corrections=(RemoveEvent("within:1:1"),))
    assert within(first) == []
    assert len(within(second)) == 1


def test_a_breath_in_a_held_note_is_as_near_its_middle_as_others_allow() -> None:
    held = [(0, 24 * Q, 62)]
    first, second = (within(plan) for plan in plans(held, held))
    assert len(first) == 1
    assert abs(first[0] - 6.0) <= 0.3
    assert all(abs(time - first[0]) >= 2.0 for time in second)


@given(
    count=st.integers(2, 6),
    quarters=st.integers(12, 240),
    lung_s=st.floats(6.0, 12.0),
    before=st.sampled_from((0, 4, 7, 12)),
    after=st.integers(0, 12),
)
@settings(max_examples=15, deadline=None, phases=(Phase.explicit, Phase.reuse, Phase.generate))
def test_a_pedal_is_held_on_by_breaths_no_further_apart_than_the_lungs(
    count: int, quarters: int, lung_s: float, before: int, after: int
) -> None:
    """Notes of half a second, a pedal, and again notes: all in unison, without a rest."""
    rows = [*running(0, before), (before * Q, quarters * Q, 62), *running(before + quarters, after)]
    made = plans(*[rows] * count, lung_s=lung_s)
    for plan in made:
        breaths = sorted((event.start_s, event.end_s) for event in plan.breaths if event.kind == "breath")
        edges = [*breaths[1:], (0.5 * (before + quarters + after), 0.0)]
        assert all(start - end <= lung_s + 0.01 for (_, end), (start, _) in zip(breaths, edges, strict=True))
        assert not [problem for problem in plan.problems if problem.message.id == "breath.too_long"]
    times = sorted(time for plan in made for time in within(plan))
    assert count > 2 or all(one - other >= 1.0 for other, one in itertools.pairwise(times))


def test_four_who_hold_a_pedal_for_a_minute_breathe_four_or_five_times_each() -> None:
    """The note lasts 53 s, the lungs 12 s, as for clarinets in a band."""
    made = plans(*[[(0, 107 * Q, 62)]] * 4, lung_s=12.0)
    assert all(4 <= len(within(plan)) <= 5 for plan in made)
    times = sorted(time for plan in made for time in within(plan))
    assert all(after - before >= 1.9 for before, after in itertools.pairwise(times))
    assert len({event.id for event in made[0].breaths}) == len(made[0].breaths)


def test_a_later_breath_in_a_held_note_is_removed_and_set_by_its_number() -> None:
    rows = [(0, 107 * Q, 62)]
    plain = plans(rows, rows, lung_s=12.0)[0]
    second = sorted((one for one in plain.breaths if one.is_within), key=lambda one: one.start_s)[1]
    assert second.id == "within.2:1:1"
    without = plans(rows, rows, corrections=(RemoveEvent(second.id, "1:1"),), lung_s=12.0)[0]
    assert set(within(without)) == set(within(plain)) - {second.start_s}
    moved = SetBreath("1:1", 20 * Q, 21 * Q, kind="within", number=2)
    placed = plans(rows, rows, corrections=(moved,), lung_s=12.0)[0]
    assert set(within(placed)) == set(within(plain)) - {second.start_s} | {10.0}


def held(tempo: float) -> list[PlayerPlan]:
    """Three bars of quarters, a note held by all for a bar at another tempo, and quarters again."""
    clock = PlainClock(((0, 120.0), (12 * Q, tempo), (16 * Q, 120.0)))
    rows = [*running(0, 12), (12 * Q, 4 * Q, 60), *running(16, 12)]
    lines = tuple(
        MonophonicPart(f"p{part}", line_of(*[(at, long, pitch + 3 * part) for at, long, pitch in rows]), valves())
        for part in range(3)
    )
    return list(make_plans(piece_of(clock, METRES), lines, time_frame(lines, clock)).values())


def test_all_breathe_after_a_fermata_and_no_one_just_before_it() -> None:
    for plan in held(40.0):
        ends = {round(event.end_tick / Q, 2) for event in plan.breaths if event.kind == "breath"}
        assert 16.0 in ends
        assert 12.0 not in ends
        assert [event.reason.id for event in plan.breaths if event.end_tick == 16 * Q] == ["breath.after_hold"]
    for plan in held(120.0):
        assert all(event.reason.id != "breath.after_hold" for event in plan.breaths)


def test_after_a_hold_no_one_goes_on_who_has_not_begun() -> None:
    hold = Fermata(0, 3 * Q, 4 * Q, returns=True)
    for rows, expected in (([(0, 3 * Q, 60), (4 * Q, Q, 62)], {1}), ([(4 * Q, Q, 62), (5 * Q, Q, 64)], set())):
        times = line_times(MonophonicPart("p", line_of(*rows), valves()), PlainClock())
        assert after_holds((hold,), times) == expected
