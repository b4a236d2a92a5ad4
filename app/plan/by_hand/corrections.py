"""What an animator changed by hand, anchored to note ids, event ids and ticks, so that regenerating keeps it.

A correction wins over the generator and its result carries ``corrected=True``. One whose anchor is gone (its note was
deleted, its event is no longer made) is handed back as a problem, never dropped silently.

Messages: ``correction.orphaned``, ``correction.no_such_fingering``, ``breath.inside_note``, ``correction.by_hand``,
``correction.empty_span``, ``correction.unknown_expression``.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import ClassVar, TypeAlias, TypeVar

import msgspec

from app.errors import Message
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.correction import OfEvent, OfNote, Own
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS, BreathKind, GestureKind
from app.plan.model import (
    BreathEvent,
    CueEvent,
    EmbouchureEvent,
    ExpressionEvent,
    GestureEvent,
    Planned,
    PoseTarget,
    Problem,
)
from app.score.tempo import TempoMap

BY_HAND = Message("correction.by_hand")


class PinFingering(OfNote, frozen=True, tag="pin_fingering"):
    """Play this note with the fingering of this label; the search solves the notes around it again."""

    event_kind: ClassVar[str] = "fingering"
    label: str

    @property
    def named(self) -> tuple[str, str]:
        """The fingering."""
        return "fingering", self.label


class RemoveEvent(OfEvent, frozen=True, tag="remove"):
    """Leave out a generated breath, preparation, cue, gesture or expression. ``note_id`` is the note it belongs to,
    where it has one: while that note lives, the removal is in force even if nothing would be generated."""

    note_id: str | None = None

    @property
    def left_out(self) -> str:
        """The id of the event."""
        return self.event_id

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether its note, or else its event, is gone, or is of a kind that is never left out."""
        known = self.note_id in note_ids if self.note_id is not None else self.event_id in event_ids
        return not known or EventId.parse(self.event_id).kind not in REMOVABLE


class SetBreath(OfNote, frozen=True, tag="set_breath"):
    """Put a breath (or preparation) before a note, or a breath within it: added, or in place of the generated one.
    Ticks are relative to the note's onset, so the breath moves with its note.

    ``added`` says that the generator had none here: to delete it is to forget it. ``moved_from`` is the note whose
    breath it was before the animator dragged it here; that one is then left out. ``number`` counts the breaths within
    one note.
    """

    start_offset_tick: int
    end_offset_tick: int = 0
    depth: float = 1.0
    kind: BreathKind = "breath"
    added: bool = False
    moved_from: str | None = None
    number: int = 1

    @property
    def about(self) -> str:
        """The id of the breath."""
        return str(EventId(self.kind, self.note_id, self.number if BREATH_KINDS[self.kind].within else 1))

    @property
    def is_empty(self) -> bool:
        """True if it ends before it begins."""
        return self.start_offset_tick >= self.end_offset_tick


class SetCue(OfNote, frozen=True, tag="set_cue"):
    """Let this player give a cue to the entry of a note; ``beats`` is how long before it the preparatory beat is.

    ``note_id`` is ``"@"`` and a tick where the player gives an entry without playing in it. ``added`` and
    ``moved_from`` as in `SetBreath`. ``takers`` are ids of the players it brings in; None: who comes in there.
    """

    event_kind: ClassVar[str] = "cue"
    beats: float = 1.0
    added: bool = False
    moved_from: str | None = None
    takers: tuple[str, ...] | None = None

    @property
    def tick(self) -> int | None:
        """Return where a cue without a note gives the entry; None where it belongs to a note."""
        digits = self.note_id[1:]
        return int(digits) if self.note_id.startswith("@") and digits.lstrip("-").isdecimal() else None

    @property
    def is_empty(self) -> bool:
        """True if its preparatory beat has no length."""
        return self.beats <= 0.0

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether its note is gone; one without a note has its place."""
        return self.tick is None and self.note_id not in note_ids


class SetEmbouchure(OfNote, frozen=True, tag="set_embouchure"):
    """Set values of a note's embouchure; None keeps the generated one."""

    event_kind: ClassVar[str] = "embouchure"
    tension: float | None = None
    effort: float | None = None
    air: float | None = None


class ChangeGesture(OfEvent, frozen=True, tag="change_gesture"):
    """Move a generated gesture or change its amount; None keeps what was generated."""

    start_tick: int | None = None
    end_tick: int | None = None
    amount: float | None = None


class AddGesture(Own, frozen=True, tag="add_gesture"):
    """A gesture of the animator's own, at a place of the score. ``name`` makes its event id unique; ``gesture`` is what
    one of the kind ``"named"`` is called in `metadata.gestures`."""

    kind: GestureKind
    start_tick: int
    end_tick: int
    amount: float
    gesture: str = ""

    @property
    def about(self) -> str:
        """The id of the gesture."""
        return str(EventId(self.kind, self.name))

    def event(self, clock: TempoMap) -> GestureEvent:
        """The gesture."""
        start, end = self.start_tick, self.end_tick
        start_s, end_s = clock.seconds(float(start)), clock.seconds(float(end))
        return GestureEvent(self.about, self.kind, start, end, start_s, end_s, self.amount, BY_HAND, True, self.gesture)


class ChangeExpression(OfEvent, frozen=True, tag="change_expression"):
    """Move a generated expression, replace it by another, change its strength or fades; None keeps what was
    generated."""

    expression: str | None = None
    start_tick: int | None = None
    end_tick: int | None = None
    strength: float | None = None
    fade_in_s: float | None = None
    fade_out_s: float | None = None

    @property
    def named(self) -> tuple[str, str]:
        """The other expression, if it is replaced."""
        return super().named if self.expression is None else ("expression", self.expression)


class AddExpression(Own, frozen=True, tag="add_expression"):
    """An expression of the animator's own, at a place of the score. ``name`` makes its event id unique."""

    event_kind: ClassVar[str] = "expression"
    expression: str
    start_tick: int
    end_tick: int
    strength: float = 1.0
    fade_in_s: float = 0.2
    fade_out_s: float = 0.3

    @property
    def named(self) -> tuple[str, str]:
        """The expression."""
        return "expression", self.expression

    def event(self, clock: TempoMap) -> ExpressionEvent:
        """The expression."""
        start, end = self.start_tick, self.end_tick
        start_s, end_s = clock.seconds(float(start)), clock.seconds(float(end))
        shown = self.strength, self.fade_in_s, self.fade_out_s
        return ExpressionEvent(self.about, self.expression, start, end, start_s, end_s, *shown, BY_HAND, True)


class PoseCorrection(Own, frozen=True, tag="pose"):
    """Hold bell, head, an elbow or the trunk differently over a span of the score. ``name`` makes its event id unique.

    The angles are added to what the generator does, before hands, lips and feet are put where they belong. They are
    whole from ``start_tick`` to ``end_tick``, come in over ``fade_in_ticks`` before it and go over ``fade_out_ticks``
    after it.

    Attributes
    ----------
    target : {"bell", "head", "left_elbow", "right_elbow", "torso"}
    up_deg : float
        Bell: raised. Head: the face up. Torso: leaning back. Elbow: outwards and up, about the line from shoulder to
        wrist.
    left_deg : float
        Bell, head and torso: turned to the player's left. An elbow has no such angle.
    roll_deg : float
        Bell: the instrument's top leans to the player's left. Head and torso: leaning to the left. An elbow has no
        such angle.
    """

    event_kind: ClassVar[str] = "pose"
    target: PoseTarget
    start_tick: int
    end_tick: int
    up_deg: float = 0.0
    left_deg: float = 0.0
    roll_deg: float = 0.0
    fade_in_ticks: int = 0
    fade_out_ticks: int = 0

    @property
    def named(self) -> tuple[str, str]:
        """What is held differently."""
        return "pose", self.target


class Vary(Own, frozen=True, tag="vary"):
    """Another random variation of the player between two ticks: another performance of these bars. Where the
    generator leaves nothing to chance nothing changes. ``name`` distinguishes them; of several that overlap the
    last counts."""

    event_kind: ClassVar[str] = "vary"
    has_event: ClassVar[bool] = False
    start_tick: int
    end_tick: int
    seed: int


class PlayStyle(Own, frozen=True, tag="play_style"):
    """Play these bars in another style. ``name`` distinguishes them; it comes and goes within the region, in so many
    ticks."""

    event_kind: ClassVar[str] = "style"
    style: str
    start_tick: int
    end_tick: int
    fade_in_ticks: int = 0
    fade_out_ticks: int = 0

    @property
    def named(self) -> tuple[str, str]:
        """The style."""
        return "style", self.style


Correction: TypeAlias = (
    PinFingering
    | RemoveEvent
    | SetBreath
    | SetCue
    | SetEmbouchure
    | ChangeGesture
    | AddGesture
    | ChangeExpression
    | AddExpression
    | PoseCorrection
    | AdditiveCurve
    | Vary
    | PlayStyle
)

E = TypeVar("E", BreathEvent, CueEvent, GestureEvent, ExpressionEvent)
Span = TypeVar("Span", GestureEvent, ExpressionEvent)


REMOVABLE = (*BREATH_KINDS, "cue", *GESTURE_KINDS, "expression")
"""Kinds of event a `RemoveEvent` may leave out: see `EventId`."""


def sound_corrections(
    corrections: tuple[Correction, ...], expressions: Collection[str], at_s: float
) -> Planned[Correction]:
    """Keep the corrections that can be done, and report each that cannot: a span that ends before it begins, an
    expression that does not exist.

    Parameters
    ----------
    expressions : collection of str
        Names of the expressions there are.
    at_s : float
        Where the problems are shown.
    """
    sound: list[Correction] = []
    problems = []
    for item in corrections:
        if isinstance(item, ChangeExpression | AddExpression) and item.expression not in (None, *expressions):
            message = Message(
                "correction.unknown_expression", {"name": str(item.expression), "known": ", ".join(expressions)}
            )
        elif item.is_empty:
            message = Message("correction.empty_span", {"kind": item.tag, "anchor": item.anchor})
        else:
            sound.append(item)
            continue
        problems.append(Problem(message, None, at_s, at_s))
    return Planned(tuple(sound), tuple(problems))


def removed_ids(corrections: tuple[Correction, ...]) -> frozenset[str]:
    """Ids of the events that must not appear: removed, or moved to another place."""
    return frozenset(item.left_out for item in corrections if item.left_out is not None)


def without_removed(events: tuple[E, ...], removed: frozenset[str]) -> tuple[E, ...]:
    """The events that were not removed by hand."""
    return tuple(event for event in events if event.id not in removed) if removed else events


def correct_embouchures(
    events: tuple[EmbouchureEvent, ...], corrections: tuple[Correction, ...]
) -> tuple[EmbouchureEvent, ...]:
    """Embouchures with the values set by hand."""
    by_note = {item.note_id: item for item in corrections if isinstance(item, SetEmbouchure)}
    if not by_note:
        return events
    return tuple(
        msgspec.structs.replace(
            event,
            tension=event.tension if item.tension is None else item.tension,
            effort=event.effort if item.effort is None else item.effort,
            air=event.air if item.air is None else item.air,
            reason=BY_HAND,
            planned=(event.tension, event.effort, event.air),
        )
        if (item := by_note.get(event.note_id)) is not None
        else event
        for event in events
    )


def of_kinds(corrections: tuple[Correction, ...], kinds: tuple[type[Correction], ...]) -> tuple[Correction, ...]:
    """Return the corrections of some kinds."""
    return tuple(item for item in corrections if isinstance(item, kinds))


def correct_gestures(
    events: tuple[GestureEvent, ...], corrections: tuple[Correction, ...], clock: TempoMap
) -> tuple[GestureEvent, ...]:
    """Gestures without the removed ones, with the changed and the added ones, ordered by start."""
    added = [item.event(clock) for item in corrections if isinstance(item, AddGesture)]
    changes = {item.event_id: item for item in corrections if isinstance(item, ChangeGesture)}
    return _corrected_spans(events, corrections, changes, added, clock)


def correct_expressions(
    events: tuple[ExpressionEvent, ...], corrections: tuple[Correction, ...], clock: TempoMap
) -> tuple[ExpressionEvent, ...]:
    """Expressions without the removed ones, with the changed and the added ones, ordered by start."""
    added = [item.event(clock) for item in corrections if isinstance(item, AddExpression)]
    changes = {item.event_id: item for item in corrections if isinstance(item, ChangeExpression)}
    return _corrected_spans(events, corrections, changes, added, clock)


def _corrected_spans(
    events: tuple[Span, ...],
    corrections: tuple[Correction, ...],
    changes: Mapping[str, ChangeGesture | ChangeExpression],
    added: Sequence[Span],
    clock: TempoMap,
) -> tuple[Span, ...]:
    removed = removed_ids(corrections)
    kept: list[Span] = [event for event in events if event.id not in removed]
    if not changes and not added:
        return tuple(kept)
    result = [_changed(event, changes.get(event.id), clock) for event in kept]
    result.extend(added)
    result.sort(key=lambda event: event.start_s)
    return tuple(result)


def _changed(event: Span, change: ChangeGesture | ChangeExpression | None, clock: TempoMap) -> Span:
    """The event with what of a change is not None."""
    if change is None:
        return event
    start = event.start_tick if change.start_tick is None else change.start_tick
    end = event.end_tick if change.end_tick is None else change.end_tick
    if start >= end:
        # Only one end was set, and the generated other end has since moved past it: a correction wins.
        start, end = (start, start + 1) if change.end_tick is None else (end - 1, end)
    said = {name: value for name, value in msgspec.structs.asdict(change).items() if value is not None}
    said |= {"start_tick": start, "end_tick": end}
    del said["event_id"]
    return msgspec.structs.replace(
        event,
        start_s=event.start_s if start == event.start_tick else clock.seconds(float(start)),
        end_s=event.end_s if end == event.end_tick else clock.seconds(float(end)),
        reason=BY_HAND,
        corrected=True,
        **said,
    )


def orphans(
    corrections: tuple[Correction, ...], note_ids: frozenset[str], event_ids: frozenset[str], at_s: float
) -> tuple[Problem, ...]:
    """A problem for every correction whose note or event is no longer there.

    Parameters
    ----------
    note_ids, event_ids : frozenset of str
        The notes of the line, and every event the generator made before removals.
    at_s : float
        Where such a problem is shown: it has no place any more, so the performance's start.
    """
    return tuple(
        Problem(Message("correction.orphaned", {"kind": item.tag, "anchor": item.anchor}), None, at_s, at_s)
        for item in corrections
        if item.is_lost(note_ids, event_ids)
    )
