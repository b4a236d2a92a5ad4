"""Navigation to problems and selected notes: playhead, active performer, and a suitable camera view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from app.editor.selection import Selection
from app.editor.session import Session, Severity
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS
from app.plan.model import Problem
from app.project.camera_bookmarks import View
from app.score.model import Note

_VIEWS: Final[dict[str, View]] = {
    "breath": "mouth",
    "character.lips_still": "mouth",
    "character.no_fingers": "hands",
    "character.some_fingers": "hands",
    "character.no_hand": "hands",
    "character.no_lips": "mouth",
    "character.touches_missed": "hands",
    "character.hands_slid": "hands",
    "character.instrument_hidden": "hands",
    "character.instrument_too_small": "hands",
    "choreography": "ensemble",
    "contact": "hands",
    "contact.foot_off": "feet",
    "contact.lips_off": "mouth",
    "dance": "ensemble",
    "fingering": "hands",
    "note": "hands",
}
"""View that shows a problem, by the id of its message or the first part of the id."""
_OTHER_VIEW: Final[View] = "front"
_EVENT_VIEWS: Final[dict[str, View]] = {
    "cue": "front",
    "embouchure": "mouth",
    "expression": "mouth",
    "fingering": "hands",
    "pose": "front",
}
"""View that shows a problem, by the kind of the event, for events that are neither breaths nor gestures."""


def view_of(problem: Problem) -> View:
    """Return the camera view in which the subject of a problem can be seen."""
    message_id = problem.message.id
    return _VIEWS.get(message_id) or _VIEWS.get(message_id.split(".")[0], _OTHER_VIEW)


def view_of_event(event_id: str) -> View | None:
    """Return the camera view in which an event of a plan can be seen; None if no view suits it."""
    kind = EventId.parse(event_id).kind
    if kind in BREATH_KINDS:
        return "mouth" if BREATH_KINDS[kind].draws_air else _OTHER_VIEW
    if kind in GESTURE_KINDS:
        return "feet" if GESTURE_KINDS[kind].part == "feet" else _OTHER_VIEW
    return _EVENT_VIEWS.get(kind)


def go_to_problem(session: Session, performer_id: str, problem: Problem) -> None:
    """Show a problem: activate its performer, select its note, and move the playhead, the timeline and the camera to
    it.

    Other selected players stay selected if the problem's player is among them.
    """
    project = session.project
    if performer_id in project.dancer_ids:
        session.set_dancer(performer_id)
    elif performer_id in {player.id for player in project.players}:
        others = tuple(id for id in session.players if id != performer_id)
        session.set_players((performer_id, *others) if performer_id in session.players else (performer_id,))
    notes = frozenset({problem.note_id}) if problem.note_id is not None else frozenset[str]()
    session.select(Selection(notes=notes))
    frame = session.performance.time_frame
    lasts_throughout = problem.start_s <= frame.first_frame_s and problem.end_s >= frame.end_s
    # A problem that lasts throughout is visible at the current time, so the playhead stays.
    at_s = session.playhead_s if lasts_throughout else problem.start_s
    if not session.recording.running:
        session.set_playhead(at_s)
    session.viewport.set_view(view_of(problem))
    session.reveal(at_s)
    session.set_problem((performer_id, problem))
    session.notice(problem.message, Severity.WARNING)


def forget_problems(session: Session) -> None:
    """From now on, clear the problem on display once it is solved or something else is selected."""

    def leave() -> None:
        session.set_problem(None)

    def look() -> None:
        shown = session.problem
        if shown is None or session.performance.project is not session.project:
            return
        performer_id, problem = shown
        found = session.problems(performer_id)
        if problem not in found:
            kind = problem.message.id, problem.note_id
            same = next((one for one in found if one.note_id and (one.message.id, one.note_id) == kind), None)
            session.set_problem(None if same is None else (performer_id, same))

    for signal in (session.selection_changed, session.players_changed, session.dancer_changed):
        signal.connect(leave)
    for signal in (session.performance_changed, session.problems_changed):
        signal.connect(look)


def show_mended(session: Session, performer_id: str, problems: Sequence[Problem]) -> None:
    """Select and show the notes of problems that were just fixed: those near the problem on display, or else the first
    ones.
    """
    gone_to = session.problem[1] if session.problem is not None else None
    start_s = (gone_to if gone_to is not None and gone_to in problems else problems[0]).start_s
    if performer_id in {player.id for player in session.project.players} and performer_id not in session.players:
        session.set_players((performer_id,))
    session.select(Selection(notes=frozenset(one.note_id for one in problems if one.note_id is not None)))
    session.reveal(start_s)


def follow_selection(session: Session) -> None:
    """From now on, move playhead and viewport to notes that the user selects, while the setting is on.

    If the playhead is already within the note it stays, since the note may be about to be split.
    """
    before = session.selection.notes

    def follow() -> None:
        nonlocal before
        added, before = session.selection.notes - before, session.selection.notes
        if len(before) != 1 or not added or session.playing or session.recording.running:
            return
        found = _note(session, next(iter(added)))
        if not session.viewport.follows_selection or found is None:
            return
        clock = session.project.score.tempo_map
        start_s, end_s = clock.seconds(float(found.onset_tick)), clock.seconds(float(found.end_tick))
        if not start_s <= session.playhead_s < end_s:
            session.set_playhead(start_s)

    session.selection_changed.connect(follow)


def _note(session: Session, note_id: str) -> Note | None:
    """Return the note with an id from any part; None if there is none."""
    for part in session.project.score.parts:
        if note_id in part.note_ids:
            return next(note for note in part.notes if note.id == note_id)
    return None
