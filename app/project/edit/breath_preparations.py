"""Events that move with a breath: its preparation, and the lowered instrument in the same rest."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from app.plan.by_hand.corrections import ChangeGesture, Correction, SetBreath
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS, answered_by
from app.plan.model import BreathEvent, PlayerPlan
from app.project.edit.breaths_and_cues import breath_of, moved_from, notes_of
from app.project.edit.found_events import corrections_of
from app.project.model import Project

PREPARATION = next(kind.id for kind in BREATH_KINDS.values() if not kind.draws_air)
LOWERINGS = answered_by("lowering")


def preparations_of(plan: PlayerPlan) -> dict[str, BreathEvent]:
    """Return the preparations of a plan, by the id of the breath they lead to."""
    of_note = {EventId.parse(event.id).of: event for event in plan.breaths if not event.draws_air}
    breaths = ((event.id, EventId.parse(event.id)) for event in plan.breaths if event.draws_air)
    return {
        id: of_note[parts.of]
        for id, parts in breaths
        if parts.of in of_note and not BREATH_KINDS[parts.kind].within
    }  # fmt: skip


def preparation_with(
    project: Project, player_id: str, breath: BreathEvent, placed: SetBreath, prepared: BreathEvent
) -> SetBreath:
    """Return the correction of a breath's preparation, shifted by as much as the breath's start; it stays at the same
    note.
    """
    before = breath_of(project, player_id, prepared)
    onset, by = _start(project, player_id, breath, placed)
    return msgspec.structs.replace(
        before,
        note_id=placed.note_id,
        start_offset_tick=prepared.start_tick + by - onset,
        end_offset_tick=prepared.end_tick + by - onset,
        moved_from=moved_from(before, placed.note_id),
    )


def lowered_with(project: Project, player_id: str, breath: BreathEvent, placed: SetBreath) -> list[Correction]:
    """Return corrections that make the lowered instrument before a breath's note rise earlier or later by as much as
    the breath moved; empty if the generator adapts it anyway.
    """
    if BREATH_KINDS[placed.kind].within or not breath.draws_air:
        return []
    _, by = _start(project, player_id, breath, placed)
    note_id = EventId.parse(breath.id).of
    ids = [str(EventId(kind, note_id)) for kind in LOWERINGS]
    return [
        msgspec.structs.replace(item, end_tick=max(item.end_tick + by, (item.start_tick or item.end_tick + by - 1) + 1))
        for item in corrections_of(project, player_id, ids)
        if isinstance(item, ChangeGesture) and item.end_tick is not None
    ]


def moved_along(project: Project, player_id: str, event_ids: Iterable[str]) -> tuple[str, ...]:
    """Return the ids of preparations that moved with breaths placed by hand, since they end where these begin."""
    said = {item.about: item for item in project.corrections.get(player_id, ()) if isinstance(item, SetBreath)}
    found = []
    for event_id in event_ids:
        breath = said.get(event_id)
        prepared = said.get(str(EventId(PREPARATION, breath.note_id))) if breath is not None else None
        if breath is not None and prepared is not None and not prepared.added:
            found += [prepared.about] * (prepared.end_offset_tick == breath.start_offset_tick)
    return tuple(found)


def _start(project: Project, player_id: str, breath: BreathEvent, placed: SetBreath) -> tuple[int, int]:
    """Return the onset of the note after a placed breath, and the new start tick of the breath."""
    onset = next(note.onset_tick for note in notes_of(project, player_id) if note.id == placed.note_id)
    return onset, onset + placed.start_offset_tick - breath.start_tick
