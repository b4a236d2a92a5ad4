"""Random edits of a small piece for three players, two of whom share a part's music."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import msgspec
import numpy as np
from hypothesis import strategies as st

from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.by_hand.mark_corrections import SetMark
from app.plan.parameters import PARAMETERS
from app.project.casting import StagePosition
from app.project.edit.corrections import with_corrections
from app.project.model import Project, project_from_score
from app.project.performers import Player
from app.score.model import ControllerCurve, Note, Part, Score
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps
from metadata.model import Expression
from tests.support.parameters import others

Edit = Callable[[Project], Project]
QUARTER = 480


def _notes(track: int, low: int, seed: int, count: int = 40) -> tuple[Note, ...]:
    random = np.random.default_rng(seed)
    tick, pitch, result = 4 * QUARTER, low + 8, []
    for number in range(count):
        length = int(random.choice([60, 120, 240, 480, 960]))
        pitch = int(np.clip(pitch + random.integers(-3, 4), low, low + 20))
        result.append(Note(f"{track}:{number + 1}", tick, length, pitch, int(random.integers(40, 120))))
        tick += length + (int(random.choice([240, 480, 3840])) if random.random() < 0.15 else 0)
    return tuple(result)


@cache
def piece() -> Project:
    """Two trumpets with the same notes, and a trombone."""
    maps = bundled_maps()
    trumpet = next(id for id in maps if id.startswith("trumpet"))
    trombone = next(id for id in maps if id.startswith("trombone"))
    shared = _notes(1, 58, 1)
    parts = (
        Part("1.1.1", "Trumpet 1", 0, 0, 0, None, None, trumpet, shared),
        Part(
            "2.1.1", "Trumpet 2", 1, 0, 1, None, None, trumpet,
            tuple(msgspec.structs.replace(note, id=note.id.replace("1:", "2:")) for note in shared),
        ),
        Part("3.1.1", "Trombone", 2, 0, 2, None, None, trombone, _notes(3, 45, 2)),
    )  # fmt: skip
    return project_from_score(Score("piece", QUARTER, TempoMap(QUARTER), parts=parts), maps)


@cache
def _performed() -> Performance:
    performance = Performance(piece())
    performance.prepare()
    return performance


def _with_notes(project: Project, part: Part, notes: list[Note]) -> Project:
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    changed = msgspec.structs.replace(part, notes=ordered)
    parts = tuple(changed if other is part else other for other in project.score.parts)
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


def _with_player(project: Project, player: Player, **changes: object) -> Project:
    changed = msgspec.structs.replace(player, **changes)
    return replace(project, players=tuple(changed if other is player else other for other in project.players))


@st.composite
def _corrections(draw: st.DrawFn, project: Project, player: Player) -> Correction:
    plan = Performance(project, _performed()).plan(player)
    notes = project.part(player).notes
    note = draw(st.sampled_from(notes)).id if notes else "1:1"
    tick = draw(st.integers(0, 20 * QUARTER))
    end = tick + draw(st.integers(0, 8 * QUARTER))
    amount = draw(st.sampled_from([-1.0, -0.3, 0.2, 0.9]))
    gesture = draw(st.sampled_from(plan.gestures)).id if plan.gestures else "sway:@0"
    expression = draw(st.sampled_from(plan.expressions)).id if plan.expressions else "expression:neutral"
    breath = draw(st.sampled_from(plan.breaths)).id if plan.breaths else "breath:1:1"
    label = draw(st.sampled_from(plan.fingerings)).label if plan.fingerings else "0"
    choices: list[Correction] = [
        PinFingering(note, label),
        RemoveEvent(breath, note),
        RemoveEvent(gesture),
        SetBreath(note, -draw(st.integers(1, 480)), depth=0.5),
        SetCue(note),
        SetCue(note, takers=tuple(other.id for other in project.players if other is not player)),
        SetEmbouchure(note, effort=0.9),
        ChangeGesture(gesture, amount=amount),
        AddGesture("mine", "bell_height", tick, end, amount),
        AddGesture("beside", draw(st.sampled_from(BESIDE)), tick, end, abs(amount)),
        ChangeExpression(expression, strength=0.4),
        AddExpression("mine", draw(st.sampled_from(["strained", "smile", "grin"])), tick, end),
        PoseCorrection("mine", "bell", tick, end, up_deg=10.0 * amount, fade_in_ticks=240),
        PoseCorrection("other", "left_elbow", tick, end, up_deg=40.0 * amount),
        Vary("mine", tick, end, 5),
        SetMark(draw(st.sampled_from(["staccato", "breath", "double_tongue"])), note),
        SetMark("slur", note, notes[-1].id if notes else "1:9"),
        SetMark("dynamic", start_tick=tick, end_tick=draw(st.sampled_from([None, end + 1])), text="ff"),
        SetMark("crescendo", start_tick=tick, end_tick=end + 1),
        PlayStyle("mine", draw(st.sampled_from(["soloist", "reserved", "gone"])), tick, end, 240, 240),
    ]
    return draw(st.sampled_from(choices))


BESIDE = ("nod", "count", "look_about", "settle_grip", "hold_still", "look_up", "bow")


@st.composite
def edits(draw: st.DrawFn, project: Project) -> Project:
    """The project after one edit of any kind."""
    player = draw(st.sampled_from(project.players))
    part = project.part(player)
    kind = draw(st.sampled_from(_KINDS))
    if kind == "correct" or not part.notes:
        return with_corrections(project, player.id, [draw(_corrections(project, player))])
    if kind == "take back":
        return replace(project, corrections={key: said[1:] for key, said in project.corrections.items()})
    if kind in ("pitch", "move", "length", "delete", "draw"):
        notes = list(part.notes)
        index = draw(st.integers(0, len(notes) - 1))
        note = notes.pop(index)
        if kind == "pitch":
            notes.append(msgspec.structs.replace(note, pitch=note.pitch + draw(st.integers(-3, 3))))
        elif kind == "move":
            notes.append(
                msgspec.structs.replace(note, onset_tick=max(note.onset_tick + draw(st.integers(-960, 960)), 0))
            )
        elif kind == "length":
            notes.append(msgspec.structs.replace(note, duration_tick=draw(st.integers(1, 1920))))
        elif kind == "draw":
            new = msgspec.structs.replace(note, id=f"{note.id}.{len(notes)}", onset_tick=draw(st.integers(0, 30_000)))
            notes += [note, new]
        return _with_notes(project, part, notes)
    if kind == "parameter":
        name = draw(st.sampled_from([name for name in PARAMETERS if name != "choreography"]))
        value = draw(st.sampled_from(others(PARAMETERS[name], getattr(player.parameters, name))))
        return _with_player(project, player, parameters=msgspec.structs.replace(player.parameters, **{name: value}))
    if kind == "instrument":
        other = draw(st.sampled_from([*bundled_maps(), "serpent"]))
        return _with_player(project, player, instrument_id=other)
    if kind == "character":
        return _with_player(project, player, character_id=draw(st.sampled_from(["man_adult", "unknown"])))
    if kind == "stage":
        return _with_player(project, player, stage=StagePosition(draw(st.floats(-2.0, 2.0)), 0.5, 0.2))
    if kind == "tempo":
        changes = (TempoChange(0, draw(st.sampled_from([400_000.0, 600_000.0]))), TempoChange(9600, 500_000.0))
        return replace(project, score=msgspec.structs.replace(project.score, tempo_map=TempoMap(QUARTER, changes)))
    if kind == "curve":
        curve = ControllerCurve("breath", (0, 4000, 9000), (0.2, 0.9, draw(st.sampled_from([0.1, 0.5]))))
        changed = msgspec.structs.replace(part, curves=(curve,))
        parts = tuple(changed if other is part else other for other in project.score.parts)
        return replace(project, score=msgspec.structs.replace(project.score, parts=parts))
    if kind == "expression":
        weights = {"browInnerUp": draw(st.sampled_from([0.2, 0.8]))}
        return replace(project, expressions=(Expression("grin", "mine", weights, True, 0.2, 0.2),))
    if kind == "players":
        if len(project.players) > 1:
            return replace(project, players=tuple(other for other in project.players if other is not player))
        return replace(project, players=piece().players)
    if kind == "seed":
        return replace(project, seed=project.seed + 1)
    return replace(project, preroll_beats=draw(st.sampled_from([2.0, 4.0, 8.0])))


_KINDS = (
    "correct", "correct", "correct", "correct", "take back", "pitch", "move", "length", "delete", "draw", "parameter",
    "parameter", "instrument", "character", "tempo", "curve", "expression", "players", "seed", "preroll", "stage",
)  # fmt: skip
