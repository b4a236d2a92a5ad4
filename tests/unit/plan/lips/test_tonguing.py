"""Strokes of the tongue: single up to the tip's limit, then double and triple; effects of articulation."""

from __future__ import annotations

import pytest

from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.score.marks import Mark
from app.score.metre_map import Metre
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame

Q = 480
COMMON = Metre(0, 4, 4)


def plan(notes: tuple[PlainNote, ...], bpm: float, instrument: str = "trumpet_Bb", metre: Metre = COMMON) -> PlayerPlan:
    clock = PlainClock(((0, bpm),))
    line = MonophonicPart("p", notes, bundled_maps()[instrument])
    return make_plans(piece_of(clock, (metre,)), (line,), time_frame((line,), clock))["p"]


def run(count: int, step: int, pitch: int = 67, gate: float = 0.9) -> list[tuple[int, int, int]]:
    return [(place * step, round(step * gate), pitch) for place in range(count)]


def strokes(found: PlayerPlan) -> str:
    return " ".join(event.stroke for event in found.tongues)


@pytest.mark.parametrize("scale", [False, True])
def test_fast_sixteenths_are_double_tongued_and_slower_ones_are_not(scale: bool) -> None:
    notes = line_of(*((at, long, pitch + (place % 8 if scale else 0)) for place, (at, long, pitch) in
                      enumerate(run(16, Q // 4))), (4 * Q, Q, 67))  # fmt: skip
    assert strokes(plan(notes, 120.0)) == " ".join(["ta"] * 17)
    fast = plan(notes, 150.0)
    assert strokes(fast) == " ".join(["ta ka"] * 8) + " ta"
    assert {event.reason.id for event in fast.tongues} == {"tongue.double"}


def test_triplets_are_triple_tongued() -> None:
    notes = line_of(*run(12, Q // 3), (4 * Q, Q, 67))
    found = plan(notes, 200.0)
    assert strokes(found) == " ".join(["ta ta ka"] * 4) + " ta"
    assert found.tongues[0].reason.id == "tongue.triple"
    # In six eight, threes in a dotted beat are triplets too, and its sixteenths are not.
    compound = Metre(0, 6, 8)
    assert strokes(plan(line_of(*run(12, Q // 2)), 300.0, metre=compound)).startswith("ta ta ka ta ta ka")
    assert strokes(plan(line_of(*run(12, Q // 4)), 150.0, metre=compound)).startswith("ta ka ta ka ta ka")


def test_a_pair_of_quick_notes_is_tongued_singly_and_a_group_of_three_is_not() -> None:
    dotted = line_of((0, 360, 67), (360, 100, 67), (480, 360, 67), (840, 100, 67), (960, 480, 67))
    assert "ka" not in strokes(plan(dotted, 150.0))
    galop = line_of((0, 200, 67), (240, 100, 67), (360, 100, 67), (480, 200, 67))
    assert strokes(plan(galop, 150.0)) == "ta ta ka ta"


def test_the_limit_is_each_players_own_and_higher_on_a_reed() -> None:
    notes = line_of(*run(16, Q // 4), (4 * Q, Q, 67))
    assert "ka" not in strokes(plan(notes, 131.0))
    assert "ka" in strokes(plan(notes, 145.0))
    assert "ka" not in strokes(plan(notes, 142.0, "clarinet_Bb"))
    assert "ka" in strokes(plan(notes, 157.0, "clarinet_Bb"))


def test_slurred_notes_have_no_stroke_and_the_pattern_goes_by_strokes() -> None:
    # Slurred in pairs at sixteenths: strokes come in eighths, which the tip makes.
    notes = line_of(*((place * Q // 4, 130 if place % 2 == 0 else 100, 60 + place) for place in range(8)))
    found = plan(notes, 160.0)
    assert len(found.tongues) == 4
    assert strokes(found) == "ta ta ta ta"


def kinds(notes: tuple[PlainNote, ...]) -> list[str]:
    return [event.articulation for event in plan(notes, 100.0).tongues]


def test_articulation_is_read_from_length_and_loudness() -> None:
    plain = [(place * Q, 432, 60 + 2 * place, 80) for place in range(4)]
    marked = [
        (4 * Q, 240, 67, 80),  # staccato
        (5 * Q, 440, 65, 110),  # accent
        (6 * Q, 320, 67, 110),  # marcato
        (7 * Q, 480, 65, 80),  # tenuto: held to the next stroke of the same note
        (8 * Q, 432, 65, 80),
        (9 * Q, 432, 64, 80),
        (10 * Q, 432, 62, 80),
    ]
    found = kinds(line_of(*plain, *marked))
    assert found[4:8] == ["staccato", "accent", "marcato", "tenuto"]
    assert set(found[:4] + found[8:]) == {"tongued"}


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_short_forte_is_no_accents_where_the_level_is_known(count: int) -> None:
    """MuseScore's piano, forte and accent on piano (49, 96, 58): without a known level everything louder would be
    accented.
    """
    louds = [0.386] * 8 + [0.756] * count + [0.386] * 8
    levels = tuple(louds)
    louds[4] = 0.546
    notes = line_of(*((place * Q, 432, 60 + place % 8) for place in range(len(louds))))
    found = {}
    for known in ((), levels):
        line = MonophonicPart("p", notes, bundled_maps()["trumpet_Bb"], loudness=tuple(louds), levels=known)
        made = make_plans(piece_of(PlainClock(), (COMMON,)), (line,), time_frame((line,), PlainClock()))["p"]
        found[bool(known)] = [event.articulation for event in made.tongues]
        raised = {event.reason.arguments["more"] for event in made.gestures if event.reason.id == "gesture.bell_accent"}
        assert max(raised, default=0.0) == (0.16 if known else 0.37)
    assert [place for place, kind in enumerate(found[True]) if kind == "accent"] == [4]
    assert [place for place, kind in enumerate(found[False]) if kind == "accent"] == [4, *range(8, 8 + count)]


@pytest.mark.parametrize(("bpm", "kind"), [(46.0, "tongued"), (100.0, "staccato")])
def test_a_slow_eighth_before_an_eighths_rest_is_not_staccato(bpm: float, kind: str) -> None:
    """A phrase of Mozart's K. 315 ends in this way: 0.65 s is no short note; at 100 it may be a dotted quarter."""
    notes = line_of(
        (0, Q, 67, 80), (Q, Q, 65, 80), (2 * Q, Q // 2, 64, 80), (3 * Q, 3 * Q // 2, 67, 80), (5 * Q, Q, 65, 80)
    )
    assert plan(notes, bpm).tongues[2].articulation == kind


def test_strokes_differ_in_size() -> None:
    def size(found: PlayerPlan, kind: str) -> float:
        return next(event.strength for event in found.tongues if kind in (event.articulation, event.stroke))

    notes = line_of(
        (0, 432, 60, 80), (Q, 440, 62, 110), (2 * Q, 320, 64, 80), (3 * Q, 432, 65, 80), (4 * Q, 432, 65, 80)
    )
    found = plan(notes, 100.0)
    assert size(found, "accent") > size(found, "tongued")
    fast = plan(line_of(*run(16, Q // 4)), 160.0)
    assert size(fast, "ka") == pytest.approx(0.5 * size(fast, "ta"))


def scored(notes: tuple[PlainNote, ...], *marks: Mark) -> PlayerPlan:
    clock = PlainClock(((0, 90.0),))
    line = MonophonicPart("p", notes, bundled_maps()["trumpet_Bb"], marks=marks, source="score")
    return make_plans(piece_of(clock, (COMMON,)), (line,), time_frame((line,), clock))["p"]


def test_what_a_score_says_of_tongue_and_slurs_is_done() -> None:
    notes = line_of(*((place * Q, Q if place % 2 else Q // 2, 60 + place) for place in range(12)))
    id_of = [note.id for note in notes]
    found = scored(
        notes,
        Mark("slur", id_of[0], id_of[2]), Mark("accent", id_of[4]), Mark("staccato", id_of[5]),
        Mark("slur", id_of[6], id_of[7]), Mark("tenuto", id_of[7]),
        *(Mark("double_tongue", id_of[place]) for place in (8, 9)), Mark("flutter_tongue", id_of[10]),
    )  # fmt: skip
    by_note = {event.note_id: event for event in found.tongues}
    assert [id_of.index(id) for id in by_note] == [0, 3, 4, 5, 6, 7, 8, 9, 10, 11]
    said = [(event.stroke, event.articulation, event.reason.id) for event in by_note.values()]
    # Every other note is short: in a score without dots that is no staccato.
    plain = ("ta", "tongued", "tongue.attack")
    assert said == [
        plain, plain, ("ta", "accent", "tongue.written_accent"), ("ta", "staccato", "tongue.written_staccato"),
        plain, ("da", "tenuto", "tongue.written_tenuto"), ("ta", "tongued", "tongue.written_double_tongue"),
        ("ka", "tongued", "tongue.written_double_tongue"), ("ta", "tongued", "tongue.written_flutter_tongue"), plain,
    ]  # fmt: skip
