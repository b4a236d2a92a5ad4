"""Corrections by an animator, anchored to note ids, event ids and ticks, so that they survive regeneration.

A correction overrides the generator, and its result has ``corrected=True``. If its anchor no longer exists (a deleted
note, an event that is no longer generated), it is reported as a problem, never dropped silently.
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
    """Play a note with the fingering of this label; the search adapts the fingerings around it."""

    event_kind: ClassVar[str] = "fingering"
    label: str

    @property
    def named(self) -> tuple[str, str]:
        """Kind ``"fingering"`` and label of the fingering, to name the correction in lists."""
        return "fingering", self.label


class RemoveEvent(OfEvent, frozen=True, tag="remove"):
    """Leave out a generated breath, preparation, cue, gesture or expression. ``note_id`` is the event's note if it has
    one: as long as that note exists the removal stays in force, even if nothing would be generated.
    """

    note_id: str | None = None

    @property
    def left_out(self) -> str:
        """Id of the planned event that is removed."""
        return self.event_id

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether the note of the removed event no longer exists, or the event itself if it has no note; also
        True for kinds of events that cannot be removed.
        """
        known = self.note_id in note_ids if self.note_id is not None else self.event_id in event_ids
        return not known or EventId.parse(self.event_id).kind not in REMOVABLE


class SetBreath(OfNote, frozen=True, tag="set_breath"):
    """Put a breath (or preparation) before a note, or a breath within it: added, or in place of the generated one.
    Ticks are relative to the note's onset, so the breath moves with its note.

    ``added``: the generator had no breath here, so deleting removes the correction. ``moved_from``: note whose breath
    was dragged here, and which gets none. ``number`` counts the breaths within one note.
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
        """Key by which corrections are distinguished: each note has at most one breath and one preparation."""
        return self.tag, self.anchor, self.kind

    @property
    def about(self) -> str:
        """Id of the breath event that the correction adds or changes."""
        return str(EventId(self.kind, self.note_id, self.number if BREATH_KINDS[self.kind].within else 1))

    @property
    def is_empty(self) -> bool:
        """True if the breath ends before it begins."""
        return self.start_offset_tick >= self.end_offset_tick


class SetCue(OfNote, frozen=True, tag="set_cue"):
    """Make this player give a cue for a note; ``beats`` is the distance from the preparatory beat to the note.

    ``note_id`` is ``"@"`` and a tick if the player gives an entry without playing in it. ``added`` and ``moved_from``
    as in `SetBreath`. ``takers`` are ids of the cued players; None: all who come in there.
    """

    event_kind: ClassVar[str] = "cue"
    beats: float = 1.0
    added: bool = False
    moved_from: str | None = None
    takers: tuple[str, ...] | None = None

    @property
    def tick(self) -> int | None:
        """Return the tick of a cue that belongs to no note; None if it belongs to one."""
        digits = self.note_id[1:]
        return int(digits) if self.note_id.startswith("@") and digits.lstrip("-").isdecimal() else None

    @property
    def is_empty(self) -> bool:
        """True if the preparatory beat has no length."""
        return self.beats <= 0.0

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether the cue's note no longer exists; False for a cue at a tick."""
        return self.tick is None and self.note_id not in note_ids


class SetEmbouchure(OfNote, frozen=True, tag="set_embouchure"):
    """Correction that sets values of a note's embouchure; None keeps the generated one."""

    event_kind: ClassVar[str] = "embouchure"
    tension: float | None = None
    effort: float | None = None
    air: float | None = None


class ChangeGesture(OfEvent, frozen=True, tag="change_gesture"):
    """Correction that moves a generated gesture or changes its amount; None keeps the generated value."""

    start_tick: int | None = None
    end_tick: int | None = None
    amount: float | None = None


class AddGesture(Own, frozen=True, tag="add_gesture"):
    """A gesture added by the animator in the score. ``name`` makes its event id unique; ``gesture`` is the name in
    `metadata.gestures` if the kind is ``"named"``.
    """

    kind: GestureKind
    start_tick: int
    end_tick: int
    amount: float
    gesture: str = ""

    @property
    def about(self) -> str:
        """Id of the gesture event that the correction adds."""
        return str(EventId(self.kind, self.name))

    def event(self, clock: TempoMap) -> GestureEvent:
        """Convert the correction to the gesture event that it adds; ``clock`` converts its ticks to seconds."""
        start, end = self.start_tick, self.end_tick
        start_s, end_s = clock.seconds(float(start)), clock.seconds(float(end))
        return GestureEvent(self.about, self.kind, start, end, start_s, end_s, self.amount, BY_HAND, True, self.gesture)


class ChangeExpression(OfEvent, frozen=True, tag="change_expression"):
    """Move a generated expression, replace it, or change its strength or fades; None keeps the generated value."""

    expression: str | None = None
    start_tick: int | None = None
    end_tick: int | None = None
    strength: float | None = None
    fade_in_s: float | None = None
    fade_out_s: float | None = None

    @property
    def named(self) -> tuple[str, str]:
        """Kind ``"expression"`` and id of the expression that replaces the generated one, if one does, to name the
        correction in lists."""
        return super().named if self.expression is None else ("expression", self.expression)


class AddExpression(Own, frozen=True, tag="add_expression"):
    """An expression added by the animator in the score. ``name`` makes its event id unique."""

    event_kind: ClassVar[str] = "expression"
    expression: str
    start_tick: int
    end_tick: int
    strength: float = 1.0
    fade_in_s: float = 0.2
    fade_out_s: float = 0.3

    @property
    def named(self) -> tuple[str, str]:
        """Kind ``"expression"`` and id of the facial expression, to name the correction in lists."""
        return "expression", self.expression

    def event(self, clock: TempoMap) -> ExpressionEvent:
        """Convert the correction to the expression event that it adds; ``clock`` converts its ticks to seconds."""
        start, end = self.start_tick, self.end_tick
        start_s, end_s = clock.seconds(float(start)), clock.seconds(float(end))
        shown = self.strength, self.fade_in_s, self.fade_out_s
        return ExpressionEvent(self.about, self.expression, start, end, start_s, end_s, *shown, BY_HAND, True)


class PoseCorrection(Own, frozen=True, tag="pose"):
    """Pose bell, head, an elbow or the trunk differently over a span of the score. ``name`` makes its event id unique.

    The angles are added to the generated motion before hands, lips and feet are solved. They have full effect from
    ``start_tick`` to ``end_tick``, fade in over ``fade_in_ticks`` before and out over ``fade_out_ticks`` after.

    Attributes
    ----------
    target : {"bell", "head", "left_elbow", "right_elbow", "torso"}
        Part of the body, or the instrument's bell, that is posed.
    up_deg : float
        Bell: raised. Head: the face up. Torso: leaning back. Elbow: outwards and up, about the line from shoulder to
        wrist.
    left_deg : float
        Turn of bell, head or torso to the player's left; not used for elbows.
    roll_deg : float
        Bell: the instrument's top leans to the player's left. Head and torso: lean to the left. Not used for elbows.
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
        """Kind ``"pose"`` and name of the posed part, to name the correction in lists."""
        return "pose", self.target


class Vary(Own, frozen=True, tag="vary"):
    """Use another random variation between two ticks. Where the generator uses no chance, nothing changes. ``name``
    distinguishes such spans; where several overlap, the last one counts.
    """

    event_kind: ClassVar[str] = "vary"
    has_event: ClassVar[bool] = False
    start_tick: int
    end_tick: int
    seed: int


class PlayStyle(Own, frozen=True, tag="play_style"):
    """Play a span in another style. ``name`` distinguishes such spans; the style fades in and out within the span, each
    over a number of ticks.
    """

    event_kind: ClassVar[str] = "style"
    style: str
    start_tick: int
    end_tick: int
    fade_in_ticks: int = 0
    fade_out_ticks: int = 0

    @property
    def named(self) -> tuple[str, str]:
        """Kind ``"style"`` and id of the style of playing, to name the correction in lists."""
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
"""Kinds of events that a `RemoveEvent` may remove; see `EventId`."""


def of_kinds(corrections: tuple[Correction, ...], kinds: tuple[type[Correction], ...]) -> tuple[Correction, ...]:
    """Return only the corrections of the given classes, in the same order."""
    return tuple(item for item in corrections if isinstance(item, kinds))
