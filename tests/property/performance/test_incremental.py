"""A performance updated after an edit equals a new one."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import AppError
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.performance.span import FrameSpan
from app.project.model import Project
from tests.property.performance.edits import edits, piece
from tests.support.performed import player_motion

FPS = Fraction(12)
"""Frame rate, lower than in use; the number of compared chunks is the same."""

CALM = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@given(st.data())
@settings(CALM, max_examples=30)
def test_plans_after_edits_are_those_of_a_fresh_performance(data: st.DataObject) -> None:
    project = piece()
    performance = Performance(project)
    for _ in range(data.draw(st.integers(1, 6))):
        project = data.draw(edits(project))
        performance = Performance(project, performance)
        if data.draw(st.booleans()):
            performance.prepare()
    fresh = Performance(project)
    assert performance.plans == fresh.plans
    assert [performance.problems(id) for id in fresh.plans] == [fresh.problems(id) for id in fresh.plans]
    assert performance.time_frame == fresh.time_frame
    assert performance.piece == fresh.piece
    assert performance.parts == fresh.parts


@given(st.data())
@settings(CALM, max_examples=8)
def test_the_motion_shown_after_edits_is_that_of_the_newest_performance(data: st.DataObject) -> None:
    project = replace(piece(), fps=FPS)
    performance = Performance(project)
    live = LiveMotion(performance)
    for _ in range(data.draw(st.integers(1, 4))):
        for _ in range(data.draw(st.sampled_from([0, 3, 1000]))):
            if not live.work():
                break
        project = data.draw(edits(project))
        performance = Performance(project, performance)
        live.show(performance)
        if data.draw(st.booleans()):
            for player in project.players:
                live.make_now(player.id, data.draw(st.sampled_from([0.0, 5.0, 9.0])))
    while live.work():
        pass
    assert live.ready_share == 1.0
    fresh = Performance(project)
    for player in project.players:
        _judge(live, fresh, project, player.id)


def _judge(live: LiveMotion, fresh: Performance, project: Project, player_id: str) -> None:
    fps, player = project.fps, project.player(player_id)
    frame = fresh.time_frame
    count = int((frame.end_s - frame.first_frame_s) * fps)
    if live.error(player_id) is not None:
        assert live.pose(player_id, 0.0) is None
        with pytest.raises(AppError) as raised:
            player_motion(fresh, player, FrameSpan(fps, 0, 1, frame.first_frame_s))
        assert live.error(player_id) == raised.value.message
        return
    whole = player_motion(fresh, player, FrameSpan(fps, 0, count, frame.first_frame_s))
    for index in range(0, count, 3):
        pose = live.pose(player_id, float(frame.first_frame_s + index / Fraction(fps)))
        assert np.array_equal(pose.rotations, whole.rotations[index])
        assert np.array_equal(pose.hips_m, whole.hips_m[index])
        assert np.array_equal(pose.instrument_position_m, whole.instrument_position_m[index])
        assert np.array_equal(pose.instrument_rotation, whole.instrument_rotation[index])
        for name, values in whole.morphs.items():
            assert pose.morphs.get(name, 0.0) == float(values[index])
        assert pose.controls == {name: float(values[index]) for name, values in whole.controls.items()}
