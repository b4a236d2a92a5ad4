"""Corrections of an animator, anchored to note ids, event ids and ticks, so that regenerating keeps them.

A correction wins over the generator and its result carries ``corrected=True``. One whose anchor is gone (its note was
deleted, its event is no longer made) is handed back as a problem, never dropped silently.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import ClassVar, TypeAlias

from app.errors import Message
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.correction import OfEvent, OfNote, Own
from app.plan.by_hand.mark_corrections import RemoveMark, SetMark
from app.plan.event_id import EventId
from app.plan.events_by_hand import PoseTarget
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS, BreathKind, GestureKind
from app.plan.model import ExpressionEvent, GestureEvent
from app.score.tempo import TempoMap

BY_HAND = Message("correction.by_hand")


class PinFingering(OfNote, frozen=True, tag="pin_fingering"):
    """Play this note with the fingering of this label; the search solves the notes around it again."""

    event_kind: ClassVar[str] = "fingering"
    label: str

    @property
    def named(self) -> tuple[str, str]:
        """Kind and label of the fingering that the correction names."""
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
    def place(self) -> tuple[str, ...]:
        """Place of the correction: a note has one of each kind."""
        return self.tag, self.anchor, self.kind

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
        """Return whether the cue's note is gone; a cue without a note is kept by its place."""
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
        """Kind and id of the expression that replaces the generated one, if one does."""
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
        """Kind and id of the expression that the correction names."""
        return "expression", self.expression

    def event(self, clock: TempoMap) -> ExpressionEvent:
        """Kind and id of the expression that the correction names."""
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
        """Kind and name of the part that the correction poses."""
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
    """Play these bars in another style. ``name`` distinguishes such regions; the style fades in and out within the
    region, each over a number of ticks."""

    event_kind: ClassVar[str] = "style"
    style: str
    start_tick: int
    end_tick: int
    fade_in_ticks: int = 0
    fade_out_ticks: int = 0

    @property
    def named(self) -> tuple[str, str]:
        """Kind and id of the style that the correction names."""
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
    | SetMark
    | RemoveMark
)


REMOVABLE = (*BREATH_KINDS, "cue", *GESTURE_KINDS, "expression")
"""Kinds of event a `RemoveEvent` may leave out: see `EventId`."""


def of_kinds(corrections: tuple[Correction, ...], kinds: tuple[type[Correction], ...]) -> tuple[Correction, ...]:
    """Return the corrections of some kinds."""
    return tuple(item for item in corrections if isinstance(item, kinds))
