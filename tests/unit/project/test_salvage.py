"""A value that cannot be saved does not affect other values."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.messages import LANGUAGES, text
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey
from app.project.autosave import Autosave, autosave_path
from app.project.check import faults
from app.project.edit.piece import set_title
from app.project.model import Project
from app.project.running_editors import Presence
from app.project.salvage import salvaged
from app.project.storage import file_hash, load, save
from tests.unit.project.pieces import full_project

BAD_CURVE = AdditiveCurve("a1", "bell.up", (CurveKey(960, 5e9),))


def with_bad_curve(project: Project) -> Project:
    player = project.players[0].id
    return replace(project, corrections={**project.corrections, player: (*project.corrections[player], BAD_CURVE)})


def test_a_correction_is_left_out_and_everything_else_is_kept() -> None:
    project = full_project()
    rest = salvaged(with_bad_curve(project))
    assert rest.project == project
    [(place, detail)] = rest.left_out
    assert place.endswith(".keys[0].value")
    assert detail == "must be from -180 to 180 (player 'Trompete: 1/2', bar 1, additive 'bell.up')"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("seed", 10**30),
        ("preroll_beats", float("nan")),
        ("section_intensity", float("inf")),
        ("takes", {"no one": None}),
        ("read_notes", {"1.1.1": {"1:1": None}}),
    ],
)
def test_a_value_that_cannot_be_left_out_is_what_it_was(field: str, value: Any) -> None:
    former = full_project()
    edited = set_title(former, "Edited")
    if field in ("takes", "read_notes"):
        value = {**getattr(edited, field), "\ud800": next(iter(getattr(edited, field).values()))}
    broken = replace(edited, **{field: value})
    rest = salvaged(broken, former)
    assert not list(faults(rest.project))
    assert getattr(rest.project, field) == getattr(former, field)
    assert rest.left_out
    assert rest.project.score.title == "Edited"


def test_a_broken_score_is_the_former_one_and_what_was_corrected_is_kept() -> None:
    former = full_project()
    corrected = replace(former, section_intensity=0.25)
    part = msgspec.structs.replace(former.score.parts[0], name="\ud800")
    broken = replace(corrected, score=msgspec.structs.replace(former.score, parts=(part, *former.score.parts[1:])))
    assert salvaged(broken) is None
    rest = salvaged(broken, former)
    assert (rest.project.score, rest.project.section_intensity) == (former.score, 0.25)


def test_the_autosave_goes_on_without_it_and_says_which_value_it_is(tmp_path: Path) -> None:
    document = tmp_path / "piece.suisou"
    project = full_project(str(tmp_path))
    save(project, document)
    presence = Presence(tmp_path / "recovery")
    autosave = Autosave(presence, 4.0)
    try:
        autosave.opened(document, file_hash(document))
        titles = []
        for number, edit in enumerate((with_bad_curve, lambda broken: replace(broken, seed=10**30))):
            project = set_title(edit(project), f"Edited {number}")
            autosave.changed(project, 0.0)
            writing = autosave.take(0.0)
            written = writing.run()
            autosave.ended(writing, 0.0)
            autosave.written(writing, written)
            assert written.without is not None
            for language in LANGUAGES:
                assert "bell.up" in text(written.without, language)
            titles.append(load(autosave_path(document)).score.title)
            assert autosave.has(project)
        # The unsavable seed is replaced by the previously saved one; the title is the new one.
        assert titles == ["Edited 0", "Edited 1"]
        assert written.without.arguments["count"] == 2
        assert load(document) == full_project(str(tmp_path))
    finally:
        presence.leave()
