"""Motion of a player from the messages of a wind controller."""

from __future__ import annotations

import pytest

from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan
from app.project.edit.placed_takes import BEFORE
from app.project.edit.takes import add_takes, comp, comp_whole
from app.project.model import Project
from app.score.take import Cleaning
from tests.support.takes import take_of
from tests.unit.project.pieces import small_project

TRUMPET = "1.1.1"
# Four quarters of half a second that touch in the score; breathed in the middle, for 0.34 s.
PLAYED = [(0.01, 0.5, 60, 0.3), (0.5, 0.7, 61, 0.9), (1.04, 1.5, 62, 0.5), (1.5, 2.0, 63, 0.5)]


def recorded() -> Project:
    take = take_of(PLAYED, cleaning=Cleaning(align=1.0), end_s=2.2)
    return add_takes(small_project(), TRUMPET, [take])[0]


def plan(project: Project) -> PlayerPlan:
    return Performance(project).plan(project.players[0])


def test_the_breath_is_where_it_was_taken_though_the_notes_land_on_the_scores() -> None:
    project = comp_whole(recorded(), TRUMPET, "take:1")
    part = project.part(project.players[0])
    assert [(note.onset_tick, note.end_tick) for note in part.notes] == [(i * 480, i * 480 + 480) for i in range(4)]
    made = plan(project)
    breath = next(event for event in made.breaths if event.id == f"breath:{part.notes[2].id}")
    assert breath.reason.id == "breath.blown"
    assert breath.start_s == pytest.approx(0.7, abs=0.02)
    assert breath.end_s == pytest.approx(1.0, abs=0.05), "it ends with the note's onset at the latest"
    air = [event.air for event in made.embouchures]
    assert air[0] == pytest.approx(0.3, abs=0.02)
    assert air[3] == pytest.approx(0.5, abs=0.02)
    assert made.traces is not None


def test_beside_the_recorded_bars_it_is_played_as_before() -> None:
    project = comp(recorded(), TRUMPET, "take:1", 0, 960)
    made, before = plan(project), plan(small_project())
    for field in ("air", "tension", "effort"):
        values, expected = ([getattr(event, field) for event in one.embouchures][2:] for one in (made, before))
        assert values == pytest.approx(expected, abs=0.001)


def test_who_takes_it_back_has_the_very_plan_of_before() -> None:
    project = comp_whole(comp_whole(recorded(), TRUMPET, "take:1"), TRUMPET, BEFORE)
    assert plan(project) == plan(small_project())
