"""Changes who gives a cue and which players it cues."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection

import msgspec

from app.errors import AppError
from app.plan.by_hand.corrections import RemoveEvent, SetCue
from app.plan.cues.cues import LEAD_BEATS
from app.plan.event_id import EventId
from app.plan.model import CueEvent, PlayerPlan
from app.project.edit.corrections import Edited, take_back, with_corrections
from app.project.edit.events import corrections_of, is_there, move, remove
from app.project.model import Project

LEAST_BEATS, MOST_BEATS = 0.05, 8.0
"""Limits of the preparatory beat, in felt beats."""


def set_giver(project: Project, plan: PlayerPlan, cue_id: str, giver_id: str, peak_tick: float | None = None) -> Edited:
    """Assign a cue to another player; it is stored as that player's correction with a preparatory beat of equal length.

    Parameters
    ----------
    plan : PlayerPlan
        Plan of the current giver, as shown to the user.
    giver_id : str
        The new giver. If the cue was generated for that player and removed by the user, the generated cue returns.
    peak_tick : float, optional
        New time of the preparatory beat.
    """
    cue = _cue(project, plan, cue_id)
    if cue is None:
        return Edited(project, (cue_id,))
    beats = _beats(project, cue) if peak_tick is None else _beats_from(project, cue, peak_tick)
    if giver_id == plan.player_id:
        if peak_tick is None:
            return Edited(project, (cue_id,))
        changed = msgspec.structs.replace(_said(project, plan.player_id, cue), beats=beats)
        return Edited(with_corrections(project, plan.player_id, (changed,)), (cue_id,))
    notes = project.part(project.player(giver_id)).notes
    at = bisect_left(notes, cue.end_tick, key=lambda note: note.onset_tick)
    plays = at < len(notes) and notes[at].onset_tick == cue.end_tick
    note = notes[at].id if plays else f"@{cue.end_tick}"
    chosen = _said(project, plan.player_id, cue).takers
    if chosen is not None:
        chosen = tuple(plan.player_id if taker == giver_id else taker for taker in chosen)
    given = SetCue(note, beats, added=True, takers=chosen)
    project = remove(project, plan, (cue_id,))
    said = corrections_of(project, giver_id, (given.about,))
    project = take_back(project, giver_id, said)
    if peak_tick is not None or chosen is not None or not any(isinstance(item, RemoveEvent) for item in said):
        project = with_corrections(project, giver_id, (given,))
    return Edited(project, (given.about,))


def set_takers(project: Project, plan: PlayerPlan, cue_id: str, takers: Collection[str] | None) -> Project:
    """Set the ids of the players that a cue brings in; None for all who come in there."""
    cue = _cue(project, plan, cue_id)
    if cue is None:
        return project
    ordered = None if takers is None else tuple(player.id for player in project.players if player.id in takers)
    changed = msgspec.structs.replace(_said(project, plan.player_id, cue), takers=ordered)
    return with_corrections(project, plan.player_id, (changed,))


def hand_over(project: Project, plan: PlayerPlan, cue_id: str, taker_id: str, other_id: str, entry_tick: int) -> Edited:
    """Replace one cued player of a cue by another, possibly at another place.

    Parameters
    ----------
    taker_id, other_id : str
        The former and the new cued player; equal if only the place changes.
    entry_tick : int
        New place of the entry.

    Raises
    ------
    AppError
        The player has no note from there on.
    """
    cue = _cue(project, plan, cue_id)
    if cue is None:
        return Edited(project, (cue_id,))
    if not any(note.onset_tick >= entry_tick for note in project.part(project.player(other_id)).notes):
        raise AppError("edit.no_note_to_take")
    if other_id != taker_id:
        takers = {other_id if taker == taker_id else taker for taker in cue.takers}
        project = set_takers(project, plan, cue_id, takers)
    return move(project, plan, (cue_id,), entry_tick - cue.end_tick)


def _cue(project: Project, plan: PlayerPlan, cue_id: str) -> CueEvent | None:
    """Return the cue with an id in a plan; None if it no longer exists in plan or project."""
    there = is_there(project, plan.player_id, cue_id)
    return next((event for event in plan.cues if event.id == cue_id), None) if there else None


def _said(project: Project, player_id: str, cue: CueEvent) -> SetCue:
    """Return the existing correction of a cue, or a new one that equals the generated cue."""
    said = corrections_of(project, player_id, (cue.id,))
    found = next((item for item in said if isinstance(item, SetCue)), None)
    return found or SetCue(EventId.parse(cue.id).of, _beats_from(project, cue, _peak_tick(project, cue)))


def _peak_tick(project: Project, cue: CueEvent) -> float:
    return project.score.tempo_map.ticks(cue.peak_s)


def _beats_from(project: Project, cue: CueEvent, peak_tick: float) -> float:
    """Return the length in felt beats of a preparatory beat from ``peak_tick`` to the cue's entry."""
    beats = (cue.end_tick - peak_tick) / project.metre_map.felt_ticks_at(cue.end_tick)
    return min(max(round(beats, 4), LEAST_BEATS), MOST_BEATS)


def _beats(project: Project, cue: CueEvent) -> float:
    """Return the present length of a cue's preparatory beat in felt beats."""
    beat = LEAD_BEATS * project.metre_map.felt_ticks_at(cue.end_tick)
    return max(round((cue.end_tick - cue.start_tick) / beat, 4), LEAST_BEATS) if cue.corrected else 1.0
