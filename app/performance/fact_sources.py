"""Sources of a plan's facts: score, sound of a file, correction by hand, or guess."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

from app.plan.by_hand.correction import Correcting
from app.plan.by_hand.mark_corrections import corrected_marks
from app.plan.model import BreathEvent, FingeringEvent, PlayerPlan, TongueEvent
from app.plan.music.piece import TOUCHING_GATE
from app.plan.music.written_marks import WrittenMarks, written_marks
from app.score.model import Note, Part, Score
from app.score.musicxml.tempos import USUAL
from app.score.mutes import is_muted

FactSource: TypeAlias = Literal["score", "sound", "guess", "hand"]

FACTS: Final = ("dynamic", "slur", "articulation", "tonguing", "fingering", "mute")
"""Facts that are reported for each note."""
_BLOWN: Final = "breath.blown"
_MARKED: Final[dict[str, FactSource]] = {
    "breath.written": "score", "breath.why_written": "score", "breath.by_hand": "hand", "breath.why_by_hand": "hand"
}  # fmt: skip
"""Origin of breath marks by their reason."""
_TONGUING: Final = "_tongue"
"""Suffix of the reasons for tongue strokes that follow a mark."""


def breath_source(event: BreathEvent) -> FactSource:
    """Source of a breath: a breath mark, a recorded breath, a correction by hand, or the rules for rests and air."""
    if event.corrected:
        return "hand"
    for id in (event.reason.id, str(event.reason.arguments.get("why"))):
        if id in _MARKED:
            return _MARKED[id]
    return "sound" if event.reason.id.startswith(_BLOWN) else "guess"


def tempo_source(score: Score) -> FactSource:
    """Source of the tempo: ``"sound"`` for a MIDI file; for a score ``"score"``, or ``"guess"`` if it has 120 beats per
    minute throughout, the default of programs.
    """
    if all(part.source != "score" for part in score.parts):
        return "sound"
    return "guess" if [bpm for _, bpm in score.tempo_map.bpm] == [USUAL] else "score"


def note_sources(
    part: Part, notes: Sequence[Note], plan: PlayerPlan, corrections: tuple[Correcting, ...], quarter: int
) -> list[dict[str, FactSource]]:
    """Sources of the facts about each note, by the names in `FACTS`.

    Parameters
    ----------
    notes : sequence of Note
        Notes of the part that are played.
    quarter : int
        Ticks per quarter.
    """
    played = tuple(notes)
    marks = corrected_marks(part.marks, corrections)
    written = written_marks(played, marks, part.source, quarter)
    read = written if marks == part.marks else written_marks(played, part.marks, part.source, quarter)
    fingerings = {event.note_id: event for event in plan.fingerings}
    tongues = {event.note_id: event for event in plan.tongues}
    found = []
    for index, note in enumerate(played):
        slur = _slur(index, played, written, read)
        found.append(
            {
                "dynamic": _dynamic(index, written, read),
                "slur": slur,
                "articulation": _articulation(index, written, read),
                "tonguing": _tonguing(tongues.get(note.id), index, written, read, slur),
                "fingering": _fingering(fingerings[note.id], index, written, read),
                "mute": _mute(part, note),
            }
        )
    return found


def _marked(same: bool) -> FactSource:
    """Return ``"score"`` as the source of a mark if the score has the same mark, else ``"hand"``."""
    return "score" if same else "hand"


def _dynamic(index: int, written: WrittenMarks, read: WrittenMarks) -> FactSource:
    level = written.level[index]
    if level == level:
        return _marked(level == read.level[index])
    if written.swell[index]:
        return "hand"
    # In a score without a preceding dynamic mark the velocity is not meaningful.
    return "guess" if written.is_score else "sound"


def _slur(index: int, notes: Sequence[Note], written: WrittenMarks, read: WrittenMarks) -> FactSource:
    """Return the source of the slur to note ``index``: ``"score"``, ``"sound"`` (the recording), ``"guess"``, or a mark
    by hand.
    """
    if not index:
        return "score" if written.is_score else "sound"
    before = index - 1
    same = written.slurred[before] == read.slurred[before] and written.tongued_next[before] == read.tongued_next[before]
    if written.is_score or not same:
        return _marked(bool(same))
    first, second = notes[before], notes[index]
    touching = first.duration_tick >= TOUCHING_GATE * (second.onset_tick - first.onset_tick)
    overlaps = first.onset_tick + first.duration_tick > second.onset_tick
    return "guess" if touching and not overlaps else "sound"


def _articulation(index: int, written: WrittenMarks, read: WrittenMarks) -> FactSource:
    same = (written.stroke[index], written.struck[index]) == (read.stroke[index], read.struck[index])
    if written.is_score or not same:
        return _marked(bool(same))
    return "sound"


def _tonguing(
    event: TongueEvent | None, index: int, written: WrittenMarks, read: WrittenMarks, slur: FactSource
) -> FactSource:
    if event is None:
        return slur
    if str(event.reason.arguments.get("mark", event.reason.id)).endswith(_TONGUING):
        return _marked(written.tonguing[index] == read.tonguing[index])
    return "guess"


def _fingering(event: FingeringEvent, index: int, written: WrittenMarks, read: WrittenMarks) -> FactSource:
    if event.corrected:
        return "hand"
    if written.fingering[index] and event.reason.id in ("fingering.written", "fingering.by_hand"):
        return _marked(written.fingering[index] == read.fingering[index])
    return "guess"


def _mute(part: Part, note: Note) -> FactSource:
    if part.source == "score":
        return "score"
    return "sound" if is_muted(part.muted, note.onset_tick) else "guess"
