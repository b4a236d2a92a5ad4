"""Cached steps from a project to every player's part, and to plans of players with several instruments."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import msgspec

from app.performance.loudness import controller_input, note_levels, note_loudness, unaccented
from app.plan.acting import Acting, acting_of, with_style
from app.plan.by_hand.corrections import Correction, PlayStyle, RemoveEvent, SetBreath, SetCue, Vary
from app.plan.by_hand.mark_corrections import OfMark, corrected_marks, mark_corrections
from app.plan.doubling import held_plan
from app.plan.generate import MonophonicPart, Piece
from app.plan.model import PlayerPlan
from app.plan.music.dynamics_from_velocities import read_velocities
from app.plan.parameters import PlayerParameters, deciding_values
from app.steps import StepTable, reading
from metadata.acting import Habit, Style
from metadata.model import Expression

LIGHT = 8
"""Factor by which planning is cheaper if neither breaths nor cues are looked for."""


def work_of(part: MonophonicPart, before: MonophonicPart | None) -> int:
    """Estimated cost, in notes, of planning a part again after an edit that changed it from ``before`` (None: a new
    part).
    """
    if part is before:
        return 0
    if before is None or part.notes is not before.notes or part.instrument_map is not before.instrument_map:
        return len(part.notes)
    same = deciding_values(part.parameters, "breaths", "cues") == deciding_values(before.parameters, "breaths", "cues")
    kept, said = set(before.corrections), set(part.corrections)
    if not same or any(isinstance(item, RemoveEvent | SetBreath | SetCue | Vary | OfMark) for item in kept ^ said):
        return len(part.notes)
    return len(part.notes) // LIGHT


def all_expressions(installed: dict[str, Expression], own: tuple[Expression, ...]) -> dict[str, Expression]:
    return installed | {expression.name: expression for expression in own}


def _actings(
    corrections: tuple[Correction, ...],
    own_parameters: PlayerParameters,
    musician_id: str,
    section_intensity: float,
    styles: Mapping[str, Style],
    habits: Mapping[str, Habit],
) -> tuple[tuple[str, Acting], ...]:
    """Return a player's amounts of acting in each style that a correction selects for a span, as (style, acting);
    unknown styles are left out.
    """
    named = sorted({item.style for item in corrections if isinstance(item, PlayStyle) and item.style in styles})
    shown = (msgspec.structs.replace(own_parameters, style=style) for style in named)
    acted = (with_style(other, musician_id, section_intensity, styles, habits) for other in shown)
    return tuple(zip(named, map(acting_of, acted), strict=True))


def _styled(corrections: tuple[Correction, ...]) -> bool:
    return any(isinstance(item, PlayStyle) for item in corrections)


def _named(name: str, styled: bool) -> str:
    """Return the player's name if messages about style spans need it, else an empty one, so that renaming does not
    change the part.
    """
    return name if styled else ""


def _styles_known(styles: Mapping[str, Style], styled: bool) -> str:
    return ", ".join(sorted(styles)) if styled else ""


def _kept(value: tuple[object, ...]) -> tuple[object, ...]:
    return value


def with_parts(plan: PlayerPlan, parts: tuple[tuple[object, ...], ...]) -> PlayerPlan:
    """Return the plan with the fields named in `ASIDE` replaced by ``parts``: events without those while the instrument
    is put aside.
    """
    return msgspec.structs.replace(plan, **dict(zip(ASIDE, parts, strict=True)))


WHOLE: Final = StepTable(
    piece=reading(Piece, accompaniment="accompaniment"),
    velocity_reading=reading(read_velocities, parts="velocities"),
    expressions=all_expressions,
)
"""Steps that all players share."""
PLAYED: Final = StepTable(
    velocities=unaccented,
    controller=controller_input,
    parameters=reading(with_style, parameters="own_parameters", player_id="musician_id"),
    actings=_actings,
    styled=_styled,
    shown_name=_named,
    styles_known=_styles_known,
)
"""Steps that compute each player's notes, for any instrument or none."""
LINE: Final = StepTable(
    notes="part.notes",
    loudness=reading(note_loudness, reading="velocity_reading"),
    levels=reading(note_levels, reading="velocity_reading"),
    muted="part.muted",
    stopped="part.stopped",
    mute_kinds="part.mute_kinds",
    mark_corrections=mark_corrections,
    read_marks="part.marks",
    marks=reading(corrected_marks, marks="read_marks", corrections="mark_corrections"),
    source="part.source",
    line=reading(
        MonophonicPart,
        instrument_map="instrument",
        parameters="parameters",
        corrections="corrections",
        loudness="loudness",
        levels="levels",
        controller="controller",
        musician="musician",
        actings="actings",
        name="shown_name",
        styles_known="styles_known",
        muted="muted",
        stopped="stopped",
        marks="marks",
        source="source",
        mute_kinds="mute_kinds",
    ),
)
"""Steps that compute the part of a player with an instrument."""
ASIDE: Final = ("cues", "gestures", "expressions", "problems", "glances")
"""Fields of a plan that differ while the instrument is put aside. Fields that do not differ stay the same objects,
since motions are compared by identity."""
HELD: Final = StepTable(
    held=held_plan,
    **{f"held_{name}": f"held.{name}" for name in ASIDE},
    **{f"kept_{name}": reading(_kept, value=f"held_{name}") for name in ASIDE},
    shown=reading(with_parts, parts=tuple(f"kept_{name}" for name in ASIDE)),
)
"""Steps that remove events from the plan of a player with several instruments."""
