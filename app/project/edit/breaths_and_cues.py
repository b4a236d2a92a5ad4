"""Adding and moving breaths and cues by hand: each belongs to a note, and changes its note when moved."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

import msgspec

from app.errors import AppError
from app.plan.by_hand.corrections import (
    Correction,
    SetBreath,
    SetCue,
)
from app.plan.cues.cues import LEAD_BEATS
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS, BreathKind
from app.plan.model import BreathEvent, CueEvent, PlayerPlan
from app.project.edit.corrections import Edited, take_back, with_corrections
from app.project.edit.found_events import OWN as OWN
from app.project.edit.found_events import Placed as Placed
from app.project.edit.found_events import corrections_of as corrections_of
from app.project.edit.found_events import events_of as events_of
from app.project.edit.found_events import is_there as is_there
from app.project.edit.found_events import placed_events as placed_events
from app.project.model import Project
from app.score.model import Note

CATCH_S = 0.3
"""Length in seconds of a breath added between notes that touch."""


def add_breath(project: Project, plan: PlayerPlan, tick: int, kind: BreathKind = "breath") -> Edited:
    """Add a breath (or preparation) for the first note at or after a tick, unless it already has one.

    It uses the rest before the note, at most one felt beat; if notes touch, `CATCH_S` of the previous note, at most
    half of it. A preparation uses the beat before the breath.
    """
    notes = notes_of(project, plan.player_id)
    index = bisect_left(notes, tick, key=lambda note: note.onset_tick)
    if index == len(notes):
        raise AppError("edit.no_note_to_breathe_for")
    note = notes[index]
    event_id = f"{kind}:{note.id}"
    there = {event.id: event for event in plan.breaths}
    if event_id in there:
        return Edited(project, (event_id,))
    end = note.onset_tick
    if not BREATH_KINDS[kind].draws_air:
        beat = project.metre_map.felt_ticks_at(end)
        breath = there.get(f"breath:{note.id}")
        end = breath.start_tick if breath is not None else end - beat
        start = end - beat
    else:
        start = _room_before(project, notes, index)
    return _added(
        project, plan.player_id, SetBreath(note.id, start - note.onset_tick, end - note.onset_tick, 1.0, kind)
    )


def add_cue(project: Project, plan: PlayerPlan, tick: int) -> Edited:
    """Add a cue for the player's first entry at or after a tick, unless it already has one."""
    notes = notes_of(project, plan.player_id)
    index = bisect_left(notes, tick, key=lambda note: note.onset_tick)
    if index == len(notes):
        raise AppError("edit.no_note_to_cue")
    event_id = f"cue:{notes[index].id}"
    if any(event.id == event_id for event in plan.cues):
        return Edited(project, (event_id,))
    return _added(project, plan.player_id, SetCue(notes[index].id))


def notes_of(project: Project, player_id: str) -> tuple[Note, ...]:
    return project.part(project.player(player_id)).notes


def removals_of(project: Project, player_id: str, event_id: str) -> tuple[Correction, ...]:
    """Return the corrections of a player that only remove a generated event, without adding another in its place."""
    return tuple(item for item in corrections_of(project, player_id, (event_id,)) if item.left_out == event_id)


def _added(project: Project, player_id: str, item: SetBreath | SetCue) -> Edited:
    """Add a breath or cue by hand; if a generated one was removed there, it is restored with the new times. Return the
    project and the event's id.
    """
    removed = removals_of(project, player_id, item.about)
    item = msgspec.structs.replace(item, added=not removed)
    return Edited(with_corrections(take_back(project, player_id, removed), player_id, (item,)), (item.about,))


def breath_of(project: Project, player_id: str, event: BreathEvent) -> SetBreath:
    """Return the existing correction of a breath, or a new one that equals the generated breath."""
    for item in corrections_of(project, player_id, (event.id,)):
        if isinstance(item, SetBreath):
            return item
    kind, note_id, number = EventId.parse(event.id)
    onset = next(note.onset_tick for note in notes_of(project, player_id) if note.id == note_id)
    offsets = event.start_tick - onset, event.end_tick - onset
    return SetBreath(note_id, *offsets, event.depth, kind, number=number)


def breath_at(
    project: Project, player_id: str, event: BreathEvent, start: int, end: int, may_change_note: bool
) -> SetBreath:
    before = breath_of(project, player_id, event)
    notes = notes_of(project, player_id)
    index = next(index for index, note in enumerate(notes) if note.id == before.note_id)
    if BREATH_KINDS[before.kind].within:
        return _breath_within(before, notes[index], start, end, may_change_note)
    if may_change_note:
        index = _note_after(notes, end)
    note = notes[index]
    if end > note.onset_tick:
        # A breath never ends after the onset it serves.
        start, end = (start - end + note.onset_tick if may_change_note else start), note.onset_tick
    return msgspec.structs.replace(
        before,
        note_id=note.id,
        start_offset_tick=min(start, end - 1) - note.onset_tick,
        end_offset_tick=end - note.onset_tick,
        moved_from=moved_from(before, note.id),
    )


def _breath_within(before: SetBreath, note: Note, start: int, end: int, moves: bool) -> SetBreath:
    """Return the breath ``before`` from ``start`` to ``end`` (ticks), limited so that it ends at its note at the
    latest: by a shift if ``moves``, else by shortening.
    """
    first, last = start - note.onset_tick, end - note.onset_tick
    if moves:
        by = max(-first, 0) + min(note.duration_tick - last, 0)
        first, last = first + by, last + by
    first = min(max(first, 0), note.duration_tick - 1)
    last = min(max(last, first + 1), note.duration_tick)
    return msgspec.structs.replace(before, start_offset_tick=first, end_offset_tick=last)


def _note_after(notes: Sequence[Note], end: int) -> int:
    """Return the index of the note that a breath ending at a tick belongs to: the next note, or the note in whose first
    half it ends.
    """
    index = bisect_left(notes, end, key=lambda note: note.onset_tick)
    if index > 0 and (index == len(notes) or end < notes[index - 1].onset_tick + notes[index - 1].duration_tick / 2):
        return index - 1
    return index


def moved_from(before: SetBreath | SetCue, note_id: str) -> str | None:
    """Return the note to which the event belonged originally; None if it is at its original note or was added."""
    if before.added:
        return None
    home = before.note_id if before.moved_from is None else before.moved_from
    return None if home == note_id else home


def cue_at(project: Project, player_id: str, event: CueEvent, start: int, end: int) -> SetCue:
    said = corrections_of(project, player_id, (event.id,))
    before = next((item for item in said if isinstance(item, SetCue)), SetCue(EventId.parse(event.id).of))
    note = next((note.id for note in notes_of(project, player_id) if note.onset_tick == end), f"@{end}")
    beats = max(round((end - start) / (LEAD_BEATS * project.metre_map.felt_ticks_at(end)), 4), 0.05)
    return msgspec.structs.replace(before, note_id=note, beats=beats, moved_from=moved_from(before, note))


def _room_before(project: Project, notes: Sequence[Note], index: int) -> int:
    """Return the tick at which a breath added before the note with an index starts."""
    onset, clock = notes[index].onset_tick, project.score.tempo_map
    beat = project.metre_map.felt_ticks_at(onset)
    if index == 0:
        return onset - beat
    before = notes[index - 1]
    silence = onset - before.end_tick
    if silence >= beat // 4:
        return onset - min(silence, beat)
    catch = onset - round(clock.ticks(clock.seconds(float(onset)) - CATCH_S))
    return onset - max(min(catch, (onset - before.onset_tick) // 2), 1)
