"""The selection follows the plans: removed events are deselected."""

from __future__ import annotations

from app.editor.selection import UNPLANNED, EventKey, Selection
from app.plan.generate import MonophonicPart
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame, valves


def selected(*ids: str) -> Selection:
    return Selection(events=frozenset(EventKey("p", id) for id in ids))


def test_only_events_that_the_plan_has_stay_selected() -> None:
    part = MonophonicPart("p", line_of((0, 480, 60), (480, 480, 62)), valves())
    plans = make_plans(piece_of(PlainClock(), (Metre(0, 4, 4),)), (part,), time_frame((part,), PlainClock()))
    here = plans["p"].fingerings[0].id
    assert selected(here).planned(plans) == selected(here)
    assert selected(here, "breath:gone").planned(plans) == selected(here)
    assert not selected(here).planned({})


def test_what_no_plan_holds_stays_selected() -> None:
    every = selected(*(f"{kind}:x" for kind in UNPLANNED))
    assert every.planned({}) is every
