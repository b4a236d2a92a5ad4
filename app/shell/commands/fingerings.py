"""Commands for fingerings: typing a label, and stepping through the alternatives."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from weakref import WeakKeyDictionary

from app.editor.edit_names import edit_of_notes
from app.editor.session import Session, Severity
from app.errors import AppError, Argument, Message
from app.project.edit.events import pin_fingerings
from app.project.model import Project
from app.project.performers import Player
from app.score.model import Note
from app.shell.action import Action
from app.shell.commands.command_targets import has_notes, has_player, notes_by_player
from instrument_maps.fingering_words import fingering_words
from instrument_maps.model import Fingering
from widgets.common.instrument_name import language

TYPED_TOGETHER_S = 2.0
"""Signs typed within this time in seconds form one label: 1 and then 3 is 13."""


class _Typed:
    """The first signs of a fingering label that the user is still typing."""

    def __init__(self) -> None:
        self.text = ""
        self.at_s = float("-inf")
        self.notes: frozenset[str] = frozenset()
        self.gesture = object()


_typed: WeakKeyDictionary[Session, _Typed] = WeakKeyDictionary()


def choices(session: Session, player: Player, note: Note) -> tuple[Fingering, ...]:
    """Return every fingering of a note on the player's instrument, the preferred one first."""
    try:
        return session.performance.instrument(player).fingerings_for(note.pitch)
    except AppError:
        # The instrument is not installed.
        return ()


def type_fingering(session: Session, sign: str, now_s: float | None = None) -> None:
    """Pin the fingering whose label is being typed. The order of the signs does not matter.

    A label that is no fingering is shown beside the first note together with the valid ones, and a fingering pinned
    from its beginning is undone.

    Parameters
    ----------
    sign : str
        One sign of a label: a digit or ``T``.
    now_s : float, optional
        Time on a monotonic clock in seconds.
    """
    at_s = time.monotonic() if now_s is None else now_s
    typed = _typed.setdefault(session, _Typed())
    notes = notes_by_player(session)
    if not notes:
        session.notice(Message("edit.no_note_to_finger"), Severity.WARNING)
        return
    if at_s - typed.at_s > TYPED_TOGETHER_S or typed.notes != session.selection.notes:
        typed.text, typed.gesture = "", object()
    typed.notes = session.selection.notes
    typed.text += sign
    pins: dict[str, dict[str, str]] = {}
    begun = False
    for player, found in notes.items():
        for note in found:
            for fingering in choices(session, player, note):
                if sorted(fingering.label) == sorted(typed.text):
                    pins.setdefault(player.id, {})[note.id] = fingering.label
                begun = begun or _holds(fingering.label, typed.text)
    if pins:
        _pin(session, pins, typed.gesture)
    else:
        session.document.cancel_gesture(typed.gesture)
        _offer(session, notes, typed.text, is_refused=not begun)
        typed.text = typed.text if begun else ""
    # Time spent drawing a sign does not count as a pause between two keys.
    typed.at_s = time.monotonic() if now_s is None else now_s


def _offer(session: Session, notes: Mapping[Player, Sequence[Note]], text: str, is_refused: bool) -> None:
    """Show beside the first note its fingerings and the text typed so far.

    If no fingering's label begins with the text (``is_refused``), say so in the status line too.
    """
    player, found = next(iter(notes.items()))
    offered = choices(session, player, found[0])
    instrument = session.performance.instrument(player) if offered else None
    known = dict.fromkeys(fingering_words(instrument, one.label, language()) for one in offered) if instrument else {}
    place: dict[str, Argument] = {"label": text, "note": found[0].id}
    if is_refused:
        session.notice(Message("edit.no_such_fingering", {**place, "known": ", ".join(known)}), Severity.WARNING)
    if session.timeline_view is not None and known:
        session.timeline_view.offer_fingerings(player.id, found[0].id, Message("edit.fingerings_that_fit", place))


def _holds(label: str, signs: str) -> bool:
    """Return whether a fingering's label contains all the typed signs, in any order."""
    return all(label.count(sign) >= signs.count(sign) for sign in signs)


def _pin(session: Session, pins: dict[str, dict[str, str]], token: object | None = None) -> None:
    ids = {note_id for labels in pins.values() for note_id in labels}

    def edit(project: Project) -> Project:
        for player_id, labels in pins.items():
            project = pin_fingerings(project, player_id, labels)
        return project

    session.attempt(edit_of_notes(session.project, "edit.pin_fingerings", ids, pins), edit, token)


def cycle_fingering(session: Session) -> None:
    """Pin the next alternative fingering of each selected note; the first choice follows the last."""
    pins: dict[str, dict[str, str]] = {}
    for player, notes in notes_by_player(session).items():
        plan = session.plans.get(player.id)
        now = {event.note_id: event.label for event in plan.fingerings} if plan is not None else {}
        for note in notes:
            known = choices(session, player, note)
            labels = [fingering.label for fingering in known if not fingering.is_obsolete]
            if len(labels) > 1:
                place = labels.index(now[note.id]) if now.get(note.id) in labels else -1
                pins.setdefault(player.id, {})[note.id] = labels[(place + 1) % len(labels)]
    if pins:
        _pin(session, pins)


def _sign(sign: str) -> Action:
    return Action(
        f"fingering.type_{sign.lower()}",
        lambda session: type_fingering(session, sign),
        "edit/fingering",
        sign,
        "timeline",
        has_player,
    )


ACTIONS: tuple[Action, ...] = (
    Action("fingering.cycle", cycle_fingering, "edit/fingering", "F", "timeline", has_notes, icon="fingering"),
    _sign("0"),
    _sign("1"),
    _sign("2"),
    _sign("3"),
    _sign("4"),
    _sign("5"),
    _sign("6"),
    _sign("7"),
    _sign("T"),
)
