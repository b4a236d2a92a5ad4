"""Broken contacts: frames are joined to spans, spans of one contact to one problem, and nothing is reported twice."""

from __future__ import annotations

import numpy as np
import pytest

from app.contacts.breaks import APART_S, JUDGED_PER_S, Break, Kind, contact_problems, joined, runs
from app.contacts.reach import OUT_OF_REACH
from app.errors import Message
from app.plan.model import FingeringEvent, Problem


def grip(note_id: str, start_s: float) -> FingeringEvent:
    return FingeringEvent("x", note_id, 0, 1, start_s, start_s + 1.0, "", 1, {}, 0.0, Message("fingering.first_choice"))


def broken(start_s: float, end_s: float, kind: Kind = "touch", part: str = "left.index", gap_m: float = 0.01) -> Break:
    return Break(kind, part, "valve1", start_s, end_s, gap_m)


def test_frames_are_spans_that_gaps_part() -> None:
    times_s = np.arange(0.0, 4.0, 0.1)
    gaps_m = np.linspace(0.0, 0.039, 40)
    found = list(runs(("lips", "", ""), times_s, gaps_m, np.isin(np.arange(40), [3, 4, 5, 9, 20, 21])))
    assert [(one.start_s, one.end_s) for one in found] == [
        (pytest.approx(0.3), pytest.approx(0.9)),
        (pytest.approx(2.0), pytest.approx(2.1)),
    ]
    assert [one.gap_m for one in found] == [pytest.approx(0.009), pytest.approx(0.021)]
    assert list(runs(("lips", "", ""), times_s, gaps_m, np.zeros(40, bool))) == []


def test_breaks_of_one_contact_that_follow_are_one_and_others_are_not() -> None:
    near, far = broken(2.0, 3.0, gap_m=0.03), broken(4.0 + 2 * APART_S, 6.0)
    other = broken(1.0, 1.5, part="left.middle")
    assert joined([far, near, broken(1.0, 2.0 - APART_S), other]) == [broken(1.0, 3.0, gap_m=0.03), far, other]
    # A break within another one neither shortens it nor hides its gap.
    assert joined([broken(1.0, 3.0, gap_m=0.03), broken(1.5, 2.0)]) == [broken(1.0, 3.0, gap_m=0.03)]


def test_a_problem_names_the_note_that_is_held_then() -> None:
    grips = [grip(f"n{number}", float(number)) for number in range(3)]
    found = contact_problems([broken(2.5, 2.6), broken(0.2, 0.3, "foot", "left")], grips, ())
    assert [(one.note_id, one.message.id) for one in found] == [
        (None, "contact.foot_off"),
        ("n2", "contact.finger_off"),
    ]
    assert [one.end_s for one in found] == [
        pytest.approx(0.3 + 1 / JUDGED_PER_S),
        pytest.approx(2.6 + 1 / JUDGED_PER_S),
    ]
    assert contact_problems([broken(1.0, 1.1)], grips, ())[0].note_id == "n1"
    assert contact_problems([broken(-1.0, -0.9)], grips, ())[0].note_id == "n0"


def test_what_stops_short_of_a_note_out_of_reach_is_reported_once() -> None:
    grips: list[FingeringEvent] = [grip("n0", 0.0)]

    def out_of_reach(start_s: float, end_s: float) -> Problem:
        return Problem(Message(OUT_OF_REACH), "n0", start_s, end_s)

    def short(start_s: float, end_s: float) -> Break:
        return broken(start_s, end_s, "short", "right")

    def reported(found: Break, *known: Problem) -> bool:
        return bool(contact_problems([found], grips, known))

    assert not reported(short(1.0, 2.0), out_of_reach(1.2, 1.8))
    assert not reported(short(1.2, 1.6), out_of_reach(1.0, 2.0))
    # Two adjacent spans cover one that overlaps both; a long one is not cut by a short one within it.
    assert not reported(short(1.0, 3.0), out_of_reach(1.0, 1.8), out_of_reach(2.2, 3.0))
    assert not reported(short(1.0, 3.0), out_of_reach(1.0, 3.0), out_of_reach(1.2, 1.4))
    assert reported(short(1.0, 9.0), out_of_reach(1.0, 2.0), out_of_reach(8.0, 9.0))
    assert reported(short(3.0, 4.0), out_of_reach(1.0, 2.0))
    assert reported(broken(1.0, 2.0), out_of_reach(1.0, 2.0))
