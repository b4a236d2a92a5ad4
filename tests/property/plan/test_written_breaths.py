"""In any line, players breathe at breath marks and break no slurs while there is air."""

from __future__ import annotations

from itertools import chain, combinations, pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.breath.catch_breath_places import AIR_STEPS, BREAKING_COST, cheapest_chain
from app.plan.breath.lungs import lungful_s
from app.plan.generate import MonophonicPart
from app.plan.model import BreathEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.score.marks import Mark, Source
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock(((0, 100.0),))


@st.composite
def lines(draw: st.DrawFn) -> tuple[tuple[PlainNote, ...], tuple[Mark, ...], frozenset[int], list[tuple[int, int]]]:
    """Notes of a score with breath marks after some of them, and slurs that do not overlap, by their notes."""
    lengths = draw(st.lists(st.sampled_from((60, 120, 240, 240, 480, 480, 960, 1920)), min_size=2, max_size=40))
    rests = draw(st.lists(st.sampled_from((0, 0, 0, 0, 120, 240, 480, 1920)), min_size=40, max_size=40))
    notes, at = [], 0
    for number, (length, rest) in enumerate(zip(lengths, rests, strict=False)):
        notes.append(PlainNote(f"1:{number + 1}", at, length, 60 + number % 5))
        at += length + rest
    count = len(notes)
    marked = draw(st.frozensets(st.integers(0, count - 2), max_size=4))
    ends = sorted(draw(st.sets(st.integers(0, count - 1), max_size=8)))
    slurs = list(zip(ends[::2], ends[1::2], strict=False))
    marks = [Mark("slur", f"1:{first + 1}", f"1:{last + 1}") for first, last in slurs]
    marks += [Mark(draw(st.sampled_from(("breath", "caesura"))), f"1:{place + 1}") for place in sorted(marked)]
    if draw(st.booleans()):
        marks += [Mark("staccato", note.id) for note in notes[::2]]
    return tuple(notes), tuple(marks), marked, slurs


def planned(
    notes: tuple[PlainNote, ...], marks: tuple[Mark, ...], source: Source, parameters: PlayerParameters
) -> PlayerPlan:
    line = MonophonicPart("p", notes, valves(), parameters, marks=marks, source=source)
    return make_plans(piece_of(CLOCK, (Metre(0, 4, 4),)), (line,), time_frame((line,), CLOCK))["p"]


def breath_before(plan: PlayerPlan, note: PlainNote) -> BreathEvent | None:
    return next((event for event in plan.breaths if event.id == f"breath:{note.id}"), None)


@settings(deadline=None, max_examples=150)
@given(
    lines(), st.sampled_from((2.0, 5.0, 9.0)), st.sampled_from((0.0, 0.35, 1.0)), st.sampled_from(("score", "sound"))
)
def test_every_breath_mark_is_a_breath_and_no_slur_is_broken_while_there_is_air(
    drawn: tuple[tuple[PlainNote, ...], tuple[Mark, ...], frozenset[int], list[tuple[int, int]]],
    lung_s: float,
    need: float,
    source: Source,
) -> None:
    notes, marks, marked, slurs = drawn
    parameters = PlayerParameters(lung_s=lung_s, breath_need=need)
    plan = planned(notes, marks, source, parameters)
    for place in marked:
        before, after = notes[place], notes[place + 1]
        breath = breath_before(plan, after)
        assert breath is not None
        assert breath.reason.arguments.get("why") == "breath.why_written" or breath.reason.id == "breath.written"
        assert before.onset_tick <= breath.start_tick < breath.end_tick <= after.onset_tick
        follows_rest = after.onset_tick > before.onset_tick + before.duration_tick
        assert breath.start_tick <= before.onset_tick + before.duration_tick or follows_rest
        assert breath.end_s - breath.start_s > 0.03
    # None of them overlap.
    breaths = sorted((event.start_s, event.end_s) for event in plan.breaths if event.kind == "breath")
    assert all(first[1] <= second[0] + 0.002 for first, second in pairwise(breaths))
    seconds = CLOCK.seconds(np.array([(note.onset_tick, note.onset_tick + note.duration_tick) for note in notes]))
    said = {problem.note_id for problem in plan.problems if problem.message.id == "breath.breaks_slur"}
    for first, last in slurs:
        length_s = float(seconds[last, 1] - seconds[first, 0])
        for place in range(first, last):
            breath = breath_before(plan, notes[place + 1])
            rest_s = float(seconds[place + 1, 0] - seconds[place, 1])
            if breath is None or place in marked or rest_s >= 1.5 - 1e-6:
                continue
            # The shortest breath before it fills so much of the lungs.
            assert length_s > 0.4 * lungful_s(parameters), (place, length_s)
            if rest_s > 0.0:
                assert notes[place].id in said or "slurred" not in breath.reason.id or "rest" in breath.reason.id
                continue
            assert notes[place].id in said


@settings(deadline=None, max_examples=150)
@given(st.data())
def test_no_more_slurs_are_broken_than_by_the_best_of_all_ways_to_breathe(data: st.DataObject) -> None:
    """All sets of places are tried. Seconds are whole and a lungful has as many as amounts of air are told apart."""
    lung_s = AIR_STEPS - 1
    count = data.draw(st.integers(1, 8))
    needed = data.draw(st.lists(st.integers(1, 20), min_size=count + 1, max_size=count + 1))
    drawn = data.draw(st.lists(st.integers(12, lung_s), min_size=count, max_size=count))
    costs = data.draw(st.lists(st.sampled_from((0.0, 5.0, 300.0)), min_size=count, max_size=count))
    used = np.concatenate(([0.0], np.cumsum(needed, dtype=np.float64)))
    numbers = used.tobytes(), used.tobytes(), np.array(costs).tobytes(), np.array(drawn, np.float64).tobytes()

    def lasts(places: tuple[int, ...]) -> bool:
        air = lung_s
        for place, seconds in enumerate(needed):
            air -= seconds
            if air < 0:
                return False
            if place in places:
                air = min(air + drawn[place], lung_s)
        return True

    def broken(places: tuple[int, ...]) -> int:
        return sum(costs[place] >= BREAKING_COST for place in places)

    every = chain.from_iterable(combinations(range(count), size) for size in range(count + 1))
    least = min((broken(places) for places in every if lasts(places)), default=None)
    found, is_enough = cheapest_chain(*numbers, 1.0, float(lung_s), 0.0, steps=AIR_STEPS)
    assert is_enough == lasts(found)
    assert (broken(found) if is_enough else None) == least
