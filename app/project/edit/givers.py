"""Who gives an entry: a cue that another player takes over."""

from __future__ import annotations

from bisect import bisect_left

from app.plan.corrections import RemoveEvent, SetCue
from app.plan.cue import LEAD_BEATS
from app.plan.model import CueEvent, PlayerPlan
from app.project.edit.corrections import put, take_back
from app.project.edit.events import Edited, corrections_of, event_id_of, is_there, remove
from app.project.model import Project


def set_giver(project: Project, plan: PlayerPlan, cue_id: str, giver_id: str) -> Edited:
    """Let another player give an entry; it is marked as that player's, with a preparatory beat as long as before.

    Parameters
    ----------
    plan : PlayerPlan
        Of who gives it in the plan that the user saw.
    giver_id : str
        Who gives it from now on. Who had it taken away before by the user and gets it back is as generated again.
    """
    cue = next((event for event in plan.cues if event.id == cue_id), None)
    if cue is None or giver_id == plan.player_id or not is_there(project, plan.player_id, cue_id):
        return Edited(project, (cue_id,))
    notes = project.part(project.player(giver_id)).notes
    at = bisect_left(notes, cue.end_tick, key=lambda note: note.onset_tick)
    plays = at < len(notes) and notes[at].onset_tick == cue.end_tick
    note = notes[at].id if plays else f"@{cue.end_tick}"
    given = SetCue(note, _beats(project, cue), added=True)
    project = remove(project, plan, (cue_id,))
    said = corrections_of(project, giver_id, (event_id_of(given),))
    project = take_back(project, giver_id, said)
    if not any(isinstance(item, RemoveEvent) for item in said):
        project = put(project, giver_id, (given,))
    return Edited(project, (event_id_of(given),))


def _beats(project: Project, cue: CueEvent) -> float:
    """How long its preparatory beat is, in beats of the score."""
    beat = LEAD_BEATS * project.metre_map.felt_ticks_at(cue.end_tick)
    return max(round((cue.end_tick - cue.start_tick) / beat, 4), 0.05) if cue.corrected else 1.0
