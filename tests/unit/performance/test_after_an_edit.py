"""An edit recomputes only what it affects: the remaining plan and curves are reused."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from app.performance.ensemble import Performance
from app.plan.breath import catch_breath_places
from app.project.model import Project
from tests.bench.performance.large import large_project
from tests.support.performed import performance_curves


@pytest.fixture(scope="module")
def performance() -> Performance:
    made = Performance(large_project(2, 400))
    made.prepare()
    return made


def raised(project: Project, semitones: int = 1, row: int = 0) -> Project:
    """Project with a note of a player raised by semitones."""
    part = project.part(project.players[row])
    notes = tuple(
        msgspec.structs.replace(note, pitch=note.pitch + semitones) if index == 200 else note
        for index, note in enumerate(part.notes)
    )
    parts = tuple(
        msgspec.structs.replace(other, notes=notes) if other is part else other for other in project.score.parts
    )
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


def test_stretches_that_an_edit_left_alone_are_not_searched_again(performance: Performance) -> None:
    before = catch_breath_places.cheapest_chain.cache_info()
    assert before.currsize > 4, "the piece asks for catch breaths"
    edited = Performance(raised(performance.project, 12), performance)
    edited.prepare()
    after = catch_breath_places.cheapest_chain.cache_info()
    assert after.hits > before.hits
    # The note's own stretch, and the next one where it begins with the leap from it.
    assert after.misses - before.misses <= 2


def test_a_semitone_changes_no_breath_and_no_cue(performance: Performance) -> None:
    player = performance.project.players[0]
    edited = Performance(raised(performance.project), performance)
    assert edited.plan(player).breaths is performance.plan(player).breaths
    assert edited.plan(player).cues is performance.plan(player).cues


def test_what_an_edit_of_another_player_left_alone_is_known_at_the_next_edit(performance: Performance) -> None:
    player = performance.project.players[1]
    between = Performance(raised(performance.project), performance)
    assert between.plan(player) is performance.plan(player)
    edited = Performance(raised(between.project, row=1), between)
    assert edited.plan(player).fingerings is not performance.plan(player).fingerings
    assert edited.plan(player).breaths is performance.plan(player).breaths
    assert edited.plan(player).cues is performance.plan(player).cues


def test_a_semitone_changes_neither_gaze_nor_swings(performance: Performance) -> None:
    player = performance.project.players[0]
    edited = Performance(raised(performance.project), performance)
    old = performance_curves(performance, player)
    assert edited.plan(player).fingerings is not old.plan.fingerings
    assert edited.plan(player).gestures is not old.plan.gestures
    new = performance_curves(edited, player, old)
    assert new.gaze is old.gaze
    assert new.layers.sway is old.layers.sway
    assert new.layers.weight is old.layers.weight
    assert new.layers.lowered is old.layers.lowered
    assert new.layers.height is not old.layers.height
    fresh = performance_curves(Performance(edited.project), player)
    assert not new.changed_s(fresh).size, "what was taken over is what would be made"
