"""Styles, habits and the section's intensity in the performance, and the steps recomputed when a table changes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.motion.model import frame_count
from app.performance.ensemble import Performance
from app.project.edit.piece import set_section_intensity
from app.project.edit.players import randomise, set_habit, set_parameters
from app.project.model import Project
from metadata.acting import AMOUNTS
from metadata.library import STYLES
from tests.property.performance.edits import piece
from tests.support.performed import performance_curves

FPS = Fraction(10)


def rotations(project: Project, player: int = 0) -> np.ndarray:
    performance = Performance(project)
    curves = performance_curves(performance, project.players[player])
    return curves.motion(FPS, 0, frame_count(curves.plan.time_frame, FPS)).rotations


def test_players_of_one_style_are_variations_and_no_clones() -> None:
    project = piece()
    performance = Performance(project)
    shown = [performance.parameters(player) for player in project.players]
    for name in AMOUNTS:
        amounts = [getattr(one, name) for one in shown]
        assert all(0.8 <= amount <= 1.2 for amount in amounts)
        assert len(set(amounts)) == len(amounts)


def test_a_style_moves_the_body_otherwise_and_the_others_play_on() -> None:
    project = piece()
    changed = set_parameters(project, (project.players[0].id,), style="soloist")
    assert np.abs(rotations(changed) - rotations(project)).max() > 0.01
    assert np.array_equal(rotations(changed, 2), rotations(project, 2))


def test_the_section_moves_less_together() -> None:
    project = piece()

    def moved(intensity: float) -> list[float]:
        quiet = set_section_intensity(project, intensity)
        return [float(np.abs(np.diff(rotations(quiet, player), axis=0)).mean()) for player in (0, 2)]

    for less, usual, more in zip(moved(0.0), moved(1.0), moved(2.0), strict=True):
        assert less < usual < more


def test_only_what_changed_is_planned_anew() -> None:
    project = piece()
    before = Performance(project)
    before.prepare()
    after = Performance(set_section_intensity(project, 0.5), before)
    for id, plan in after.plans.items():
        assert plan.breaths is before.plans[id].breaths
        assert plan.fingerings is before.plans[id].fingerings


def test_what_is_not_installed_is_reported_and_changes_nothing() -> None:
    project = piece()
    first = project.players[0]
    lost = set_parameters(project, (first.id,), style="gone", habits="tapper,lost")
    performance = Performance(lost)
    said = [problem.message for problem in performance.problems(first.id)]
    assert [(message.id, message.arguments["name"]) for message in said[:2]] == [
        ("project.style_missing", "gone"),
        ("project.habit_missing", "lost"),
    ]
    assert performance.parameters(performance.project.players[0]).sway == 1.0


def test_a_table_that_changes_changes_the_performance(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(STYLES.variable, str(tmp_path))
    monkeypatch.setattr(STYLES, "last", None)
    project = piece()
    player = project.players[0]
    mine = set_parameters(project, (player.id,), style="mine")
    text = 'name = "mine"\ntitle = { en = "Mine" }\nvariation = 0.0\n[factors]\nsway = '
    (tmp_path / "mine.toml").write_text(f"{text}0.5\n", encoding="utf-8")
    STYLES.reload()
    before = Performance(mine)
    assert before.parameters(mine.players[0]).sway == 0.5
    (tmp_path / "mine.toml").write_text(f"{text}0.25\n", encoding="utf-8")
    STYLES.reload()
    after = Performance(mine, before)
    assert not after.metadata.is_still(before.metadata)
    assert after.parameters(mine.players[0]).sway == 0.25
    assert before.parameters(mine.players[0]).sway == 0.5, "what was made once stays right"


def test_randomised_players_get_habits_and_amounts_and_keep_their_style() -> None:
    project = piece()
    ids = [player.id for player in project.players]
    thrown = [project := randomise(project, ids, 1.0) for _ in range(6)]
    habits = {player.parameters.habits for one in thrown for player in one.players}
    assert len(habits) > 3
    assert {player.parameters.style for one in thrown for player in one.players} == {"section_player"}
    assert len({player.parameters.face_intensity for player in thrown[-1].players}) == len(ids)
    kept = randomise(set_habit(piece(), ids, "tapper", True), ids, 0.0)
    assert {player.parameters.habits for player in kept.players} == {"tapper"}


def test_who_plays_two_instruments_is_one_person_and_the_same_after_an_edit() -> None:
    project = piece()
    first, second, *others = project.players
    doubled = replace(project, players=(first, msgspec.structs.replace(second, doubles=first.id), *others))
    before = Performance(doubled)
    before.prepare()
    shown = [before.parameters(player) for player in doubled.players]
    assert shown[0] == shown[1]
    assert shown[0] != shown[2]
    after = Performance(set_parameters(doubled, (others[0].id,), gaze=0.5), before)
    after.prepare()
    assert [after.parameters(player) is one for player, one in zip(after.project.players, shown, strict=True)] == [
        *(True, True, False),
    ]
