"""Commands for notes: selecting, moving, splitting, copying and quantising them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import msgspec
from PySide6.QtCore import QByteArray, QMimeData
from PySide6.QtGui import QGuiApplication

from app.editor.edit_names import edit_at, edit_of_events, edit_of_notes
from app.editor.selection import EventKey, Selection
from app.editor.session import Session, Severity
from app.editor.timeline_view import Tool
from app.errors import Message
from app.project.edit import events as event_edits
from app.project.edit import notes
from app.project.model import Project
from app.shell.action import Action
from app.shell.commands.command_targets import has_notes, has_player, has_something, on_timeline

MIME_TYPE = "application/x-suisou-notes+json"
VELOCITY_STEP = 8


# Select


def select_all(session: Session) -> None:
    """Select every note of the selected players; if they are all selected already, every note of all players."""
    project = session.project
    mine = _notes_of(session, session.players)
    everyone = _notes_of(session, tuple(player.id for player in project.players))
    session.select(Selection(everyone if session.selection.notes == mine else mine))


def _notes_of(session: Session, player_ids: tuple[str, ...]) -> frozenset[str]:
    project = session.project
    return frozenset(note.id for player_id in player_ids for note in project.part(project.player(player_id)).notes)


def select_none(session: Session) -> None:
    """Clear the selection of notes, events and marks."""
    session.select(Selection())


def select_pitch(session: Session) -> None:
    """Select every note in the same part and at the same pitch as a selected note."""
    selected = session.selection.notes
    found: set[str] = set()
    for part, mine in notes.chosen_notes(session.project, selected):
        pitches = {note.pitch for note in mine}
        found.update(note.id for note in part.notes if note.pitch in pitches)
    session.select(Selection(frozenset(found)))


def select_bar(session: Session) -> None:
    """Select the notes that begin in the bars of the selected notes, else in the bar at the playhead."""
    project = session.project
    score = project.score
    chosen = list(notes.chosen_notes(project, session.selection.notes))
    if chosen:
        bars = {score.metre_map.bar_of_tick(note.onset_tick) for _, mine in chosen for note in mine}
        parts = [part for part, _ in chosen]
    else:
        bars = {score.metre_map.bar_of_tick(_playhead_tick(session))}
        parts = [project.part(session.player)] if session.player is not None else []
    found = frozenset(
        note.id for part in parts for note in part.notes if score.metre_map.bar_of_tick(note.onset_tick) in bars
    )
    session.select(Selection(found))


def select_span(session: Session) -> None:
    """Select the notes of the selected players that begin in the selected range of time, or else in the loop."""
    project, tempo = session.project, session.project.score.tempo_map
    span = session.selection.span
    if span is not None:
        start, end = float(span[0]), float(span[1])
    elif session.loop_s is not None:
        start, end = (tempo.ticks(edge) for edge in session.loop_s)
    else:
        return
    found = frozenset(
        note.id
        for player_id in session.players
        for note in project.part(project.player(player_id)).notes
        if start <= note.onset_tick < end
    )
    session.select(Selection(found))


# Edit


def _edit(session: Session, id: str, edit: Callable[[Project, frozenset[str]], Project]) -> None:
    ids = session.selection.notes
    if ids:
        session.attempt(edit_of_notes(session.project, id, ids), lambda project: edit(project, ids))


def _edit_making(
    session: Session, name: Message, edit: Callable[[Project], tuple[Project, tuple[str, ...]]], kept: frozenset[str]
) -> None:
    """Make an edit that adds notes, and select the new notes in addition to those with the ids ``kept``."""
    made: list[str] = []

    def run(project: Project) -> Project:
        project, ids = edit(project)
        made.extend(ids)
        return project

    if session.attempt(name, run):
        session.select(Selection(kept | frozenset(made)))


def split(session: Session) -> None:
    """Split the selected notes at the playhead; if none are selected, the notes of the active player there."""
    tick = _playhead_tick(session)
    ids = session.selection.notes
    if not ids and session.player is not None:
        part = session.project.part(session.player)
        ids = frozenset(note.id for note in part.notes if note.onset_tick < tick < note.end_tick)
    name = edit_of_notes(session.project, "edit.split_notes", ids)
    _edit_making(session, name, lambda project: notes.split(project, ids, tick), ids)


def join(session: Session) -> None:
    """Join neighbouring notes of the same pitch into one."""
    _edit(session, "edit.join_notes", notes.join)
    known = _notes_of(session, tuple(player.id for player in session.project.players))
    session.select(Selection(session.selection.notes & known))


def duplicate(session: Session) -> None:
    """Copy the selected notes to the grid line after them."""
    ids = session.selection.notes
    chosen = [note for _, mine in notes.chosen_notes(session.project, ids) for note in mine]
    if not chosen:
        return
    score = session.project.score
    first, end = min(note.onset_tick for note in chosen), max(note.end_tick for note in chosen)
    length = end - first
    if session.grid.enabled:
        step = session.grid.step_ticks(score.metre_map)
        length = round(-(-length // step) * step)
    name = edit_of_notes(session.project, "edit.duplicate_notes", ids)
    _edit_making(session, name, lambda project: notes.duplicate(project, ids, length), frozenset())


def transpose(session: Session, by_pitch: int) -> None:
    """Transpose the selected notes by semitones within the range of MIDI."""
    _edit(
        session,
        "edit.transpose_notes",
        lambda project, ids: notes.move(project, ids, *notes.reach_of_move(project, ids, 0, by_pitch)),
    )


def nudge(session: Session, steps: int) -> None:
    """Shift the selected notes or events by steps of the grid."""
    step = session.grid.quarters * session.project.score.ticks_per_quarter
    _shift(session, lambda onset: round(onset + steps * step))


def nudge_frames(session: Session, frames: int) -> None:
    """Shift the selected notes or events by a number of video frames, by at least one tick."""
    tempo = session.project.score.tempo_map
    by_s = float(frames / session.project.fps)

    def moved(onset: int) -> int:
        target = round(tempo.ticks(tempo.seconds(float(onset)) + by_s))
        return target if target != onset else onset + frames

    _shift(session, moved)


def _shift(session: Session, moved: Callable[[int], int]) -> None:
    """Shift the selected notes or events, all by the same number of ticks.

    Parameters
    ----------
    moved : callable
        Returns the new tick of the first selected note or event for its present tick.
    """
    selection = session.selection
    if selection.notes:
        chosen = [note for _, mine in notes.chosen_notes(session.project, selection.notes) for note in mine]
        if chosen:
            first = min(note.onset_tick for note in chosen)
            _edit(
                session,
                "edit.nudge_notes",
                lambda project, ids: notes.move(
                    project, ids, *notes.reach_of_move(project, ids, moved(first) - first, 0)
                ),
            )
    elif selection.events and session.performance.planned:
        _shift_events(session, moved)


def _shift_events(session: Session, moved: Callable[[int], int]) -> None:
    keys = session.selection.events
    plans = session.performance.plans
    now: set[EventKey] = set()

    def run(project: Project) -> Project:
        for player_id in sorted({key.player_id for key in keys}):
            plan = plans[player_id]
            ids = sorted(key.event_id for key in keys if key.player_id == player_id)
            placed = event_edits.placed_events(plan, ids)
            if not placed:
                continue
            first = min(event.start_tick for event in placed)
            edited = event_edits.move(project, plan, [event.id for event in placed], moved(first) - first)
            project = edited.project
            now.update(EventKey(player_id, event_id) for event_id in edited.event_ids)
        return project

    if session.attempt(edit_of_events(session, "edit.move_events", keys), run):
        session.select(Selection(events=frozenset(now) or keys))


def change_velocity(session: Session, by: int) -> None:
    """Change the MIDI velocity of the selected notes by a number."""
    _edit(session, "edit.change_velocity", lambda project, ids: notes.change_velocity(project, ids, by))


# Clipboard


def copy(session: Session) -> None:
    """Put the selected notes on the clipboard."""
    data = QMimeData()
    text = msgspec.json.encode(notes.copied(session.project, session.selection.notes))
    data.setData(MIME_TYPE, QByteArray(text))
    QGuiApplication.clipboard().setMimeData(data)


def cut(session: Session) -> None:
    """Put the selected notes on the clipboard and delete them."""
    copy(session)
    _edit(session, "edit.cut_notes", notes.erase)
    session.select(Selection())


def paste(session: Session) -> None:
    """Insert the clipboard's notes at the playhead: notes of a single part for the active player, notes of several
    parts for their own players.
    """
    clip = _clipboard()
    player = session.player
    if clip is None or not clip.lines:
        session.notice(Message("note.nothing_to_paste"), Severity.WARNING)
        return
    if player is None:
        session.notice(Message("note.nowhere_to_paste"), Severity.WARNING)
        return
    count = sum(len(line.notes) for line in clip.lines)
    tick = max(_playhead_tick(session), 0)
    _edit_making(
        session,
        edit_at(session.project, "edit.paste_notes", count, (player.id,), (tick,)),
        lambda project: notes.paste(project, player.part_id, clip, tick),
        frozenset(),
    )


def _clipboard() -> notes.ClipboardNotes | None:
    data = QGuiApplication.clipboard().mimeData()
    if data is None or not data.hasFormat(MIME_TYPE):
        return None
    return notes.read_clip(bytes(data.data(MIME_TYPE).data()))


def _playhead_tick(session: Session) -> int:
    """Return the tick of the playhead, rounded to a grid line that is less than half a video frame away."""
    score = session.project.score
    tick = score.tempo_map.ticks(session.playhead_s)
    snapped = session.grid.snap(score.metre_map, tick)
    near_s = abs(score.tempo_map.seconds(float(snapped)) - session.playhead_s)
    return snapped if near_s < 0.5 / float(session.project.fps) else round(tick)


def _tool(tool: Tool, key: str, icon: str) -> Action:
    return Action(
        f"notes.tool_{tool.value}",
        on_timeline(lambda view: view.set_tool(tool)),
        "edit/tool",
        key,
        "timeline",
        checked=lambda session: session.timeline_view is not None and session.timeline_view.tool is tool,
        icon=icon,
    )


def _row(
    id: str,
    run: Callable[..., None],
    keys: str = "",
    icon: str = "",
    menu: str = "edit/notes",
    enabled: Callable[[Session], bool] = has_notes,
) -> Action:
    return Action(id, run, menu, keys, "timeline", enabled=enabled, icon=icon)


ACTIONS: tuple[Action, ...] = (
    _row("notes.cut", cut, "Ctrl+X", "cut", "edit"),
    _row("notes.copy", copy, "Ctrl+C", "copy", "edit"),
    _row("notes.paste", paste, "Ctrl+V", "paste", "edit", has_player),
    _row("notes.duplicate", duplicate, "Ctrl+D", "duplicate", "edit"),
    _row("notes.select_all", select_all, "Ctrl+A", "", "edit/select", has_player),
    _row("notes.select_none", select_none, "Alt+A", "", "edit/select", lambda session: bool(session.selection)),
    _row("notes.select_pitch", select_pitch, "Alt+S", "", "edit/select"),
    _row("notes.select_bar", select_bar, "Alt+B", "", "edit/select", has_player),
    _row(
        "notes.select_span",
        select_span,
        "Alt+R",
        "",
        "edit/select",
        lambda session: session.selection.span is not None or session.loop_s is not None,
    ),
    _tool(Tool.SELECT, "V", "pointer"),
    _tool(Tool.DRAW, "D", "pencil"),
    _tool(Tool.ERASE, "E", "eraser"),
    _tool(Tool.SPLIT, "S", "split"),
    _row("notes.split", split, "Shift+S", "split", enabled=has_player),
    _row("notes.join", join, "J", "join"),
    _row("notes.quantise", on_timeline(lambda view: view.ask_quantise()), "Q", "quantise"),
    _row("notes.up", partial(transpose, by_pitch=1), "Up", "transpose"),
    _row("notes.down", partial(transpose, by_pitch=-1), "Down"),
    _row("notes.octave_up", partial(transpose, by_pitch=12), "Shift+Up"),
    _row("notes.octave_down", partial(transpose, by_pitch=-12), "Shift+Down"),
    _row("notes.earlier", partial(nudge, steps=-1), "Left", enabled=has_something),
    _row("notes.later", partial(nudge, steps=1), "Right", enabled=has_something),
    _row("notes.frame_earlier", partial(nudge_frames, frames=-1), "Ctrl+Left", enabled=has_something),
    _row("notes.frame_later", partial(nudge_frames, frames=1), "Ctrl+Right", enabled=has_something),
    _row("notes.louder", partial(change_velocity, by=VELOCITY_STEP), "+;="),
    _row("notes.softer", partial(change_velocity, by=-VELOCITY_STEP), "-"),
)
