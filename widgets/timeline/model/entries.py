"""Who gives an entry to whom, as arrows from note to note."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from typing import NamedTuple

from app.plan.model import PlayerPlan
from app.project.model import Project


class EntryArrow(NamedTuple):
    """From the preparatory beat of who gives an entry to the note of who comes in with it.

    ``from_pitch`` and ``to_pitch`` are the notes' that they begin with.
    """

    giver_id: str
    taker_id: str
    from_s: float
    from_pitch: int
    to_s: float
    to_pitch: int


def entry_arrows(project: Project, plans: Mapping[str, PlayerPlan], player_id: str) -> tuple[EntryArrow, ...]:
    """The entries that a player gives or takes."""
    arrows = []
    known = {player.id for player in project.players}
    for plan in plans.values():
        for cue in plan.cues:
            if player_id != cue.player_id and player_id not in cue.takers:
                continue
            takers = cue.takers if player_id == cue.player_id else (player_id,)
            begins = _note_at(project, cue.player_id, cue.end_tick) if cue.player_id in known else None
            for taker in takers:
                entry = _note_at(project, taker, cue.end_tick) if taker in known else None
                if begins is not None and entry is not None:
                    at_s = project.score.tempo_map.seconds(float(entry[0]))
                    arrows.append(EntryArrow(cue.player_id, taker, cue.peak_s, begins[1], at_s, entry[1]))
    return tuple(arrows)


def _note_at(project: Project, player_id: str, tick: int) -> tuple[int, int] | None:
    """Onset and pitch of the first note from a tick on, else of the last one."""
    notes = project.part(project.player(player_id)).notes
    if not notes:
        return None
    note = notes[min(bisect_left(notes, tick, key=lambda note: note.onset_tick), len(notes) - 1)]
    return note.onset_tick, note.pitch
