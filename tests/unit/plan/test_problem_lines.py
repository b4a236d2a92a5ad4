"""Problems in reports: by place, and once per kind."""

from __future__ import annotations

from app.errors import Message
from app.messages import text
from app.plan.model import Problem
from app.plan.problem_lines import problem_lines, problems_in_bars
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap

QUARTER = 480
NOTES = tuple(Note(f"1:{index}", index * QUARTER, QUARTER, 60 + index, 80) for index in range(60))
PART = Part("1.1.1", "Trombone", 0, 0, 0, 57, "trombone", "trombone_tenor_F_attachment", NOTES)
SCORE = Score(title="", ticks_per_quarter=QUARTER, tempo_map=TempoMap(QUARTER), parts=(PART,))


def early(index: int) -> Problem:
    arguments = {"label": "T1", "needed_ms": 100 + index, "available_ms": 90, "note": NOTES[index].id}
    return Problem(Message("fingering.starts_early", arguments), NOTES[index].id, 0.5 * index - 0.1, 0.5 * index)


def test_a_note_is_named_by_pitch_bar_and_beat() -> None:
    (line,) = problem_lines([early(6)], SCORE, text)
    assert "before note F♯4 (2.3.000)" in line
    assert NOTES[6].id not in line


def test_a_kind_is_one_line_with_a_count_and_the_places() -> None:
    lines = problem_lines([early(0), early(5), early(8)], SCORE, text)
    assert len(lines) == 1
    assert "takes 100 ms" in lines[0]
    assert lines[0].endswith("2 more times: 2.2.000, 3.1.000")


def test_kinds_stay_apart_in_the_order_of_their_first() -> None:
    slip = Problem(Message("contact.foot_off", {"side": "left", "gap_mm": 3}), None, 4.0, 5.0)
    lines = problem_lines([slip, early(1), early(2)], SCORE, text)
    assert [line.split()[1] for line in lines] == ["left", "change"]


def test_both_hands_are_named() -> None:
    hands = [Problem(Message("character.no_fingers", {"side": side}), None, -2.0, 60.0) for side in ("left", "right")]
    assert [line.split()[4] for line in problem_lines(hands, SCORE, text)] == ["left", "right"]


def test_what_names_no_note_is_given_a_place_unless_it_lasts_from_the_beginning() -> None:
    (line,) = problem_lines([Problem(Message("contact.lips_off", {"gap_mm": 3}), None, 4.25, 5.0)], SCORE, text)
    assert line.endswith("(at 3.1.240)")
    lasting = Problem(Message("character.no_lips", {}), None, -2.0, 60.0)
    assert problem_lines([lasting], SCORE, text) == [text(lasting.message)]


def test_a_note_that_is_gone_keeps_its_id() -> None:
    gone = Problem(Message("breath.inside_note", {"note": "9:9"}), "9:9", 1.0, 1.0)
    assert "9:9" in problem_lines([gone], SCORE, text)[0]


def test_the_places_listed_are_limited() -> None:
    (line,) = problem_lines([early(index) for index in range(60)], SCORE, text)
    assert "59 more times" in line
    assert line.endswith(", 11.1.000, ...")


def test_problems_of_other_bars_are_left_out() -> None:
    found = [early(index) for index in range(60)]
    inside = problems_in_bars(found, SCORE, PART.id, (5, 8))
    assert [problem.note_id for problem in inside] == [NOTES[index].id for index in range(16, 32)]
    slip = Problem(Message("contact.lips_off", {"gap_mm": 3}), None, 4.25, 5.0)
    assert problems_in_bars([slip], SCORE, PART.id, (3, 3)) == (slip,)
    assert problems_in_bars([slip], SCORE, PART.id, (4, 9)) == ()
    lasting = Problem(Message("character.no_lips", {}), None, -2.0, 60.0)
    assert problems_in_bars([lasting], SCORE, PART.id, (9, 9)) == (lasting,)
    # Problems after the last note belong to the last bar.
    late = Problem(Message("contact.lips_off", {"gap_mm": 3}), None, 31.0, 31.5)
    assert problems_in_bars([late], SCORE, PART.id, (15, 15)) == (late,)
