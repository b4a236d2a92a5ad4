"""The cost of an edit is known before planning, and planning can be cancelled."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from app.errors import Cancelled
from app.performance.ensemble import Performance
from app.performance.ensemble_steps import LIGHT
from app.plan.by_hand.corrections import PoseCorrection, SetBreath
from app.project.edit.corrections import with_corrections
from tests.property.performance.edits import piece


def test_what_has_to_be_planned_is_counted() -> None:
    project = piece()
    performance = Performance(project)
    everything = sum(len(project.part(player).notes) for player in project.players)
    assert performance.unplanned_notes == everything
    performance.prepare()
    assert performance.unplanned_notes == 0
    player = project.players[0]
    count = len(project.part(player).notes)
    pose = with_corrections(project, player.id, [PoseCorrection("x", "head", 0, 960, up_deg=5.0)])
    assert Performance(pose, performance).unplanned_notes == count // LIGHT
    breath = with_corrections(project, player.id, [SetBreath(project.part(player).notes[5].id, -120)])
    assert Performance(breath, performance).unplanned_notes == count
    assert Performance(replace(project, seed=3), performance).unplanned_notes == everything
    calm = msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, amplitude=0.1))
    assert (
        Performance(replace(project, players=(calm, *project.players[1:])), performance).unplanned_notes
        == count // LIGHT
    )
    louder = replace(project, audio=None, preroll_beats=project.preroll_beats)
    assert Performance(louder, performance).unplanned_notes == 0


def test_a_plan_can_be_stopped_and_begun_again() -> None:
    performance = Performance(piece())
    shares: list[float] = []
    with pytest.raises(Cancelled):
        performance.prepare(lambda: len(shares) > 0, shares.append)
    assert not performance.planned
    performance.prepare(progress=shares.append)
    assert shares[-1] == 1.0
    fresh = Performance(piece())
    assert performance.plans == fresh.plans
    assert [performance.problems(id) for id in fresh.plans] == [fresh.problems(id) for id in fresh.plans]


def test_performances_do_not_hold_those_before_them() -> None:
    project = piece()
    performance = Performance(project)
    performance.prepare()
    after = Performance(replace(project, seed=1), performance)
    after.prepare()
    assert after._before is None
    # A performance that was never played does not stay in memory.
    unplayed = Performance(replace(project, seed=2), after)
    assert Performance(replace(project, seed=3), unplayed)._before is after
