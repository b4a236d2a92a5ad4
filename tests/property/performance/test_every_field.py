"""After a change of any single field of the inputs, updated plans equal plans made from nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any

import msgspec
import pytest

from app.errors import AppError
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.generate import EnsemblePlanning
from app.plan.music.piece import MonophonicPart, Piece
from app.plan.parameters import PlayerParameters
from app.project.model import Project
from app.score.metre_map import Metre, MetreMap
from app.score.model import ControllerCurve, Note
from app.score.tempo import TempoChange, TempoMap
from app.steps import StepRuns
from instrument_maps.load import bundled_maps
from tests.property.performance.edits import QUARTER, piece
from tests.support.plan import make_plans, time_frame

KEPT = frozenset({"id", "kind", "target", "ticks_per_quarter", "schema_version", "map_id", "part_id", "read_notes"})
"""Fields that identify a thing or its kind; changing them would make a different thing."""
OTHERS: dict[str, Any] = {
    "cue_leader": True,
    "felt_beat_quarters": 2.0,
    "posture": "seated",
    "instrument_id": "flugelhorn_Bb",
    "character_id": "woman_adult",
    "choreography": "",
    "channel": "head.left",
    "interpolation": "linear",
    "expression": "smile",
    "label": "123",
    "layers_off": "gestures,toe_taps",
    "reason": None,
    "numerator": 3,
    "denominator": 8,
}
"""Other valid values of fields whose type does not determine them."""


WHOLE = frozenset({"parts", "metres", "changes", "ticks", "values"})
"""Sequences whose length is bound to another field."""


def other(name: str, value: Any) -> Any:
    """Another value of a field that has no parts."""
    if name in OTHERS and value != OTHERS[name]:
        return OTHERS[name]
    match value:
        case bool():
            return not value
        case int():
            return value + 1
        case float():
            return 0.8 * value + 0.05
        case str():
            return f"{value}x"
    return value


def variants(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """The value with one leaf changed: every field, in long sequences of the first, a middle and the last item, and the
    sequence without that item.
    """
    if name in KEPT:
        return
    if isinstance(value, msgspec.Struct) or is_dataclass(value):
        change = msgspec.structs.replace if isinstance(value, msgspec.Struct) else replace
        names = (
            value.__struct_fields__ if isinstance(value, msgspec.Struct) else [field.name for field in fields(value)]
        )
        for field in names:
            for path, changed in variants(field, getattr(value, field)):
                yield f"{field}.{path}".rstrip("."), change(value, **{field: changed})
    elif isinstance(value, tuple):
        for index in sorted({0, len(value) // 2, len(value) - 1} & set(range(len(value)))):
            for path, changed in variants(name if index else f"{name}[0]", value[index]):
                yield f"{index}.{path}", (*value[:index], changed, *value[index + 1 :])
            if name not in WHOLE:
                yield f"{index} gone", (*value[:index], *value[index + 1 :])
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            for path, changed in variants(name, inner):
                yield f"{key}.{path}", {**value, key: changed}
    elif (changed := other(name, value)) != value:
        yield "", changed


@cache
def performed() -> Project:
    """A piece with all content on which plans depend."""
    project = piece()
    first, second, third = project.players
    notes = project.part(first).notes
    at = [note.id for note in notes[5:30:5]]
    corrections = (
        PinFingering(at[0], "13"),
        SetBreath(at[1], -300, -20, 0.4),
        SetCue(at[2], 1.5),
        SetEmbouchure(at[3], 0.3, None, 0.6),
        ChangeGesture("lower_instrument:end", amount=0.5),
        AddGesture("added-1", "sway", 4 * QUARTER, 8 * QUARTER, 0.5),
        ChangeExpression("expression:smile:end", strength=0.4),
        AddExpression("added-2", "smile", 8 * QUARTER, 10 * QUARTER, 0.7, 0.2, 0.3),
        RemoveEvent(f"breath:{at[4]}"),
        PoseCorrection("pose-1", "bell", 6 * QUARTER, 9 * QUARTER, 5.0, 2.0, 0.0, 100, 100),
        Vary("varied-1", 10 * QUARTER, 20 * QUARTER, 3),
        PlayStyle("own-1", "soloist", 12 * QUARTER, 24 * QUARTER, QUARTER, QUARTER),
    )
    curve = ControllerCurve(
        "breath", tuple(range(0, 60 * QUARTER, 200)), tuple(0.2 + 0.1 * (k % 7) for k in range(144))
    )
    parts = tuple(
        msgspec.structs.replace(part, curves=(curve,)) if part.id == third.part_id else part
        for part in project.score.parts
    )
    score = msgspec.structs.replace(
        project.score,
        parts=parts,
        metres=(Metre(0, 4, 4), Metre(2 * QUARTER, 4, 4), Metre(22 * QUARTER, 6, 8)),
        pickup_ticks=2 * QUARTER,
        tempo_map=TempoMap(QUARTER, (TempoChange(0, 500_000.0), TempoChange(20 * QUARTER, 600_000.0))),
    )
    lungs = msgspec.structs.replace(second.parameters, lung_s=4.0)
    players = (first, msgspec.structs.replace(second, parameters=lungs), third)
    return replace(project, score=score, players=players, corrections={first.id: corrections})


def made(performance: Performance) -> Any:
    """Plans, or the error."""
    try:
        problems = {player.id: performance.problems(player.id) for player in performance.project.players}
        unseen = performance.unseen
        return performance.plans, problems, performance.time_frame, performance.piece, performance.parts, unseen
    except AppError as error:
        return error.message


def test_any_other_field_is_seen() -> None:
    project = performed()
    differing = set()
    before = Performance(project)
    base = made(before)
    for path, edited in variants("", project):
        warm, cold = made(Performance(edited, before)), made(Performance(edited))
        assert warm == cold, path
        if isinstance(cold, tuple) and cold[0] != base[0]:
            differing.add(path.rsplit(".", 1)[-1] if "gone" not in path else path)
    # Verify that they are tried at all.
    assert {
        "pitch",
        "velocity",
        "onset_tick",
        "duration_tick",
        "lung_s",
        "seed",
        "microseconds_per_quarter",
    } <= differing


MOTIF = (65, 65, 65, 63, 62, 65)
"""Pitches with which the line begins after a rest and which it later repeats without a rest."""


@pytest.mark.parametrize(("index", "semitones"), [(9, 2), (37, -1)])
def test_a_semitone_that_breaks_a_figure_moves_the_breaths_after_an_edit_too(index: int, semitones: int) -> None:
    """Less than a leap, but no longer the figure of the entry, before which a player would breathe again."""
    clock = TempoMap(QUARTER)
    whole, rest = Piece(clock, MetreMap(QUARTER)), 2 * QUARTER
    notes = [
        Note(f"1:{k + 1}", QUARTER // 2 * k + rest * (k > 5), QUARTER // 2, pitch, 80)
        for k, pitch in enumerate(14 * MOTIF)
    ]
    line = MonophonicPart("p", tuple(notes), bundled_maps()["trumpet_Bb"], PlayerParameters(lung_s=4.0))
    notes[index] = msgspec.structs.replace(notes[index], pitch=notes[index].pitch + semitones)
    edited = msgspec.structs.replace(line, notes=tuple(notes))
    frame = time_frame((line,), clock)
    runs = StepRuns()
    before = EnsemblePlanning(whole, (line,), frame, runs=runs).finished()
    cold = make_plans(whole, (edited,), frame)
    assert EnsemblePlanning(whole, (edited,), frame, runs=StepRuns(runs)).finished() == cold
    assert before["p"].breaths != cold["p"].breaths
