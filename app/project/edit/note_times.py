"""Edit that moves note onsets to the times at which they were played. Notes keep their ids and so their corrections."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from app.project.edit.length import with_score
from app.project.model import Project
from app.score.model import Note, Part
from app.score.tempo import TempoMap


def shift_onsets(project: Project, seconds: Mapping[str, float]) -> Project:
    """Delay the onsets of notes by ``seconds`` (by note id); ends stay. A note that lasted until the next one still
    does, none gets shorter than a tick, and none moves before the previous note or the start of the piece.
    """
    clock = project.score.tempo_map
    parts = tuple(_shifted(part, seconds, clock) for part in project.score.parts)
    if all(one is other for one, other in zip(parts, project.score.parts, strict=True)):
        return project
    return with_score(project, msgspec.structs.replace(project.score, parts=parts))


def _shifted(part: Part, seconds: Mapping[str, float], clock: TempoMap) -> Part:
    if seconds.keys().isdisjoint(part.note_ids):
        return part
    result: list[Note] = []
    for index, note in enumerate(part.notes):
        before = result[-1] if result else None
        before_end = part.notes[index - 1].end_tick
        onset = note.onset_tick
        if note.id in seconds:
            onset = round(clock.ticks(clock.seconds(float(onset)) + seconds[note.id]))
        least = 0 if before is None else before.onset_tick + (1 if note.onset_tick > before.onset_tick else 0)
        onset = max(min(onset, note.end_tick - 1), least)
        if before is not None and before.onset_tick < onset and _goes_on(before_end, before.end_tick, note, onset):
            result[-1] = msgspec.structs.replace(before, duration_tick=onset - before.onset_tick)
        length = max(note.end_tick - onset, 1)
        moved = onset != note.onset_tick
        result.append(msgspec.structs.replace(note, onset_tick=onset, duration_tick=length) if moved else note)
    ordered = tuple(sorted(result, key=lambda note: (note.onset_tick, note.pitch)))
    return part if ordered == part.notes else msgspec.structs.replace(part, notes=ordered)


def _goes_on(was_end: int, end: int, note: Note, onset: int) -> bool:
    """Return whether the previous note, which ended at ``was_end`` and would end at ``end``, should end at the new
    onset of ``note``: it did so before, or would now overlap.
    """
    return was_end == note.onset_tick or (was_end < note.onset_tick and end > onset)
