"""Values that a file would not restore are found in every field of a project at any depth."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from typing import Any

import msgspec
import numpy as np
import pytest

from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey
from app.project.check_stored import _groups, stored_faults
from app.project.model import Project
from tests.unit.project.pieces import full_project

PROJECT = full_project()
PLAINLY_CHECKED = {"source", "fps"}
"""Fields that are stored as texts with a format of their own."""


def test_every_field_of_a_project_is_written_and_read() -> None:
    names = {re.match(r"\w+", group.place)[0] for group in _groups(PROJECT)}
    called = {"edited_notes": "read_notes", "edited_curves": "read_curves"}
    assert {called.get(name, name) for name in names} | PLAINLY_CHECKED == {field.name for field in fields(Project)}


def places(project: Project, before: Project | None = None) -> list[str]:
    return [place for place, _ in stored_faults(project, before)]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "\ud800", b"x", None, object()])
def test_a_value_of_any_field_that_no_file_holds_is_found(value: Any) -> None:
    score, player = PROJECT.score, PROJECT.players[0]
    part = score.parts[0]
    note = msgspec.structs.replace(part.notes[0], id=value)
    part = msgspec.structs.replace(part, notes=(note, *part.notes[1:]))
    broken = {
        "score.parts[0]": replace(PROJECT, score=msgspec.structs.replace(score, parts=(part, *score.parts[1:]))),
        "players[0]": replace(PROJECT, players=(msgspec.structs.replace(player, name=value), *PROJECT.players[1:])),
        "score.title": replace(PROJECT, score=msgspec.structs.replace(score, title=value)),
        "seed": replace(PROJECT, seed=value),
    }
    for place, project in broken.items():
        # Compared with an edited project: common parts are not examined again.
        for found in (places(project), places(project, PROJECT)):
            assert [one.startswith(place) for one in found] == [True], (place, found)
    assert places(PROJECT) == []


def test_numbers_of_numpy_are_numbers_and_a_tick_that_is_no_whole_number_is_found() -> None:
    curve = AdditiveCurve("a", "bell.up", (CurveKey(np.int64(480), np.float64(0.1)),))
    assert places(replace(PROJECT, corrections={"1.1.1": (curve,)})) == []
    halves = AdditiveCurve("a", "bell.up", (CurveKey(480.0, 0.1),))
    assert places(replace(PROJECT, corrections={"1.1.1": (halves,)})) == ["corrections['1.1.1'][0].keys[0].tick"]
