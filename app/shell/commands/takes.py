"""Commands for recorded takes: listening to them, using them in the part, cleaning and removing them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.arrays import FloatArray
from app.editor.listening import RecordedTake
from app.editor.selection import Selection
from app.editor.session import Session, Severity
from app.errors import AppError, Message, Progress, StopRequested
from app.project.edit import takes as edit
from app.project.edit.placed_takes import BEFORE
from app.project.limits import LAST_TICK
from app.project.model import Project
from app.project.performers import Player
from app.score.take import Cleaning, Take
from app.shell.action import Action
from app.shell.commands.command_targets import on_timeline
from app.shell.editor import Editor, EditorAction


def _takes(session: Session) -> tuple[Take, ...]:
    """Return the takes of the active player in the order of their lanes; empty if no player is active."""
    return _takes_of(session.project, session.player.id) if session.player is not None else ()


def _chosen(session: Session) -> tuple[Player, Take] | None:
    """Return the take selected in the editor with its player; None if there is none."""
    player, take_id = session.player, session.selection.take
    found = [take for take in _takes(session) if take.id == take_id]
    return (player, found[0]) if player is not None and found else None


def listen(editor: Editor, alone: bool = False) -> None:
    """Play the selected take together with the other players or alone; stop if it plays already."""
    session, sound = editor.session, editor.sound
    player, take_id = session.player, session.selection.take
    if player is None or take_id is None:
        return
    requested = RecordedTake(player.id, take_id, alone)
    if session.listening.take == requested:
        sound.stop_listening()
    else:
        sound.listen(requested, _listen_from(session))


def _listen_from(session: Session) -> float:
    """Return the time in seconds from which a take is played: the start of the selected range, else the playhead if it
    is within the take, else the start of the take.
    """
    clock, span, chosen = session.project.score.tempo_map, session.selection.span, _chosen(session)
    if span is not None:
        return clock.seconds(float(span[0]))
    if chosen is None:
        return session.playhead_s
    start_s, end_s = clock.seconds(chosen[1].start_tick), clock.seconds(chosen[1].end_tick)
    return session.playhead_s if start_s <= session.playhead_s < end_s else start_s


def whole(session: Session) -> None:
    """Use all of the selected take in the part, or all of the notes that the part had before its first take."""
    player, take_id, chosen = session.player, session.selection.take, _chosen(session)
    if player is None or take_id is None:
        return
    name = Message("edit.comp_before") if chosen is None else Message("edit.comp_whole", {"take": chosen[1].name})
    session.attempt(name, lambda project: edit.comp_whole(project, player.id, take_id))


def before(session: Session) -> None:
    """Restore the notes that the part had before its first take, in the selected range or everywhere."""
    player, span = session.player, session.selection.span or (0, LAST_TICK)
    if player is not None:
        session.attempt(Message("edit.comp_before"), lambda project: edit.comp(project, player.id, BEFORE, *span))


def _change(session: Session, id: str, change: Callable[..., Project], *values: object) -> bool:
    """Apply a change to the selected take, if there is one, and return whether it was applied."""
    chosen = _chosen(session)
    if chosen is None:
        return False
    player, take = chosen
    return session.attempt(
        Message(id, {"take": take.name}), lambda project: change(project, player.id, take.id, *values)
    )


def remove(session: Session) -> None:
    """Remove the selected take; its notes that the part uses stay."""
    if _change(session, "edit.remove_take", edit.remove_take):
        session.select(Selection())


def move(session: Session, by: int) -> None:
    """Move the selected take up (-1) or down (1) by a lane."""
    chosen = _chosen(session)
    if chosen is not None:
        place = _takes(session).index(chosen[1]) + by
        _change(session, "edit.move_take", edit.move_take, place if by < 0 else place + 1)


def usual_cleaning(session: Session) -> None:
    """Clean the selected take with the default settings."""
    _change(session, "edit.clean_take", edit.set_cleaning, Cleaning())


def find_beats(session: Session) -> None:
    """Give the piece the tempo that is found in the selected take."""
    chosen = _chosen(session)
    if chosen is None:
        return
    player, take = chosen
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> FloatArray:
        return edit.beats_of(project, player.id, take.id)

    def done(beats_s: FloatArray) -> None:
        found = [one for one in _takes_of(session.project, player.id) if one.id == take.id]
        if not found or found[0].played is not take.played:
            session.notice(Message("take.changed", {"take": take.name}), Severity.WARNING)
            return
        name = Message("edit.follow_beats", {"take": take.name})
        if session.attempt(name, lambda project: edit.follow_beats(project, player.id, take.id, beats_s)):
            bpm = 60.0 * (len(beats_s) - 1) / float(beats_s[-1] - beats_s[0])
            session.notice(Message("take.beats_found", {"take": take.name, "count": len(beats_s), "bpm": bpm}))

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.find_beats", {"take": take.name}), work, done, failed, key="find_beats")


def _takes_of(project: Project, player_id: str) -> tuple[Take, ...]:
    recorded = project.takes.get(player_id)
    return recorded.takes if recorded is not None else ()


def _has_chosen(session: Session) -> bool:
    return _chosen(session) is not None


def _has_row(session: Session) -> bool:
    """Return whether a take, or the row of the notes from before the first take, is selected."""
    return _has_chosen(session) or (session.selection.take == BEFORE and bool(_takes(session)))


def _can_take_whole(session: Session) -> bool:
    return _has_chosen(session) or (session.selection.take == BEFORE and _differs_from_before(session))


def _differs_from_before(session: Session) -> bool:
    """Return whether the active player's part differs from its notes before the first take."""
    player = session.player
    recorded = session.project.takes.get(player.id) if player is not None else None
    if player is None or recorded is None or not recorded.takes:
        return False
    part = session.project.part(player)
    return bool(recorded.comp) or (part.notes, part.curves) != (recorded.before_notes, recorded.before_curves)


def _can_listen(editor: Editor) -> bool:
    return editor.session.playback is not None and _has_row(editor.session)


def _has_takes(session: Session) -> bool:
    return bool(_takes(session))


def _can_step(session: Session) -> bool:
    return _has_takes(session) and session.timeline_view is not None and session.selection.span is not None


def _may_move(session: Session, edge: int) -> bool:
    """Return whether a take is selected that is not the first (``edge`` 0) or not the last (``edge`` -1)."""
    chosen = _chosen(session)
    return chosen is not None and chosen[1] is not _takes(session)[edge]


def _is_cleaned_otherwise(session: Session) -> bool:
    chosen = _chosen(session)
    return chosen is not None and chosen[1].cleaning != Cleaning()


ACTIONS: tuple[Action | EditorAction, ...] = (
    EditorAction("takes.listen", listen, "record/takes", "Ctrl+L", enabled=_can_listen, icon="play"),
    EditorAction(
        "takes.listen_alone",
        partial(listen, alone=True),
        "record/takes",
        "Ctrl+Shift+L",
        enabled=_can_listen,
        icon="solo",
    ),
    Action("takes.whole", whole, "record/takes", enabled=_can_take_whole, icon="check"),
    Action(
        "takes.above",
        on_timeline(lambda view: view.step_take(-1)),
        "record/takes",
        "Alt+Up",
        "timeline",
        enabled=_can_step,
        icon="chevron_up",
    ),
    Action(
        "takes.below",
        on_timeline(lambda view: view.step_take(1)),
        "record/takes",
        "Alt+Down",
        "timeline",
        enabled=_can_step,
        icon="chevron_down",
    ),
    Action("takes.before", before, "record/takes", enabled=_differs_from_before, icon="history"),
    Action(
        "takes.rename",
        on_timeline(lambda view: view.ask_take_name()),
        "record/takes",
        "F2",
        "timeline",
        enabled=_has_chosen,
        icon="pencil",
    ),
    Action("takes.earlier_lane", partial(move, by=-1), "record/takes", enabled=lambda session: _may_move(session, 0)),
    Action("takes.later_lane", partial(move, by=1), "record/takes", enabled=lambda session: _may_move(session, -1)),
    Action("takes.usual_cleaning", usual_cleaning, "record/takes", enabled=_is_cleaned_otherwise, icon="reset"),
    Action("takes.find_beats", find_beats, "record/takes", enabled=_has_chosen, icon="tempo"),
    Action("takes.remove", remove, "record/takes", enabled=_has_chosen, icon="delete"),
)
