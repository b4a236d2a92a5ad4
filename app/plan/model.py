"""Plan of a player: named events in time, each with its reason.

Times are given twice: in integer ticks of the score (anchor of the event, moved by corrections) and in float64 seconds
of the performance, negative before the first tick. Ranges are half-open.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final, Generic, Literal, NamedTuple, TypeAlias, TypeVar

import msgspec

from app.errors import Message
from app.identity_cache import IdentityCache
from app.plan.event_id import EventId
from app.plan.events_by_hand import AdditiveEvent, PoseEvent, StyleEvent
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS, BreathKind, GestureKind, Part
from app.plan.sampled_lip_curves import SampledCurves
from app.score.mutes import MuteName
from metadata.gestures import Gesture

E = TypeVar("E")


# Events contain no cycles (`gc=False`): a hundred thousand notes have a million events, and a garbage collection that
# visits them all would stop the editor for half a second.


class Vent(msgspec.Struct, frozen=True, gc=False):
    """Controls that only help the attack of a note, with the time of their release; ``label`` is the fingering held
    afterwards.
    """

    controls: tuple[str, ...]
    end_tick: int
    end_s: float
    label: str


class FingeringEvent(msgspec.Struct, frozen=True, gc=False):
    """The fingering of one note.

    ``controls`` has the value 0..1 of every control that is not at rest; ``fingers`` the finger of those not worked by
    their usual one. ``vent`` has the controls released once the note speaks. A slide that glides to the note leaves its
    previous position at ``glide_from_s``.
    """

    id: str
    note_id: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    label: str
    rank: int
    controls: dict[str, float]
    cents: float
    reason: Message
    corrected: bool = False
    fingers: dict[str, str] = {}
    vent: Vent | None = None
    glide_from_s: float | None = None


class BreathEvent(msgspec.Struct, frozen=True, gc=False):
    """An inhalation, or its preparatory motion. ``depth`` is 0..1 of a full lung; a catch breath is shallow."""

    id: str
    kind: BreathKind
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    depth: float
    reason: Message
    corrected: bool = False

    @property
    def draws_air(self) -> bool:
        """True if it fills the lungs; False for a preparatory motion."""
        return BREATH_KINDS[self.kind].draws_air

    @property
    def is_within(self) -> bool:
        """True if it is within a note instead of before one."""
        return BREATH_KINDS[EventId.parse(self.id).kind].within


Stroke: TypeAlias = Literal["ta", "ka", "da"]
"""Strokes of the tongue: with its tip, with its back, and softly with its tip."""
Articulation: TypeAlias = Literal["tongued", "staccato", "accent", "marcato", "tenuto"]
ATTACK: Final = Message("tongue.attack")


class TongueEvent(msgspec.Struct, frozen=True, gc=False):
    """Stroke of the tongue before an attacked note; the tongue releases at ``end_s``, the onset.

    ``strength`` is its size relative to a plain stroke of the tip.
    """

    note_id: str
    start_s: float
    end_s: float
    stroke: Stroke = "ta"
    articulation: Articulation = "tongued"
    strength: float = 1.0
    reason: Message = ATTACK

    @property
    def id(self) -> str:
        """Id made of the note's id; there is one event for every note."""
        return f"tongue:{self.note_id}"


MuteKind: TypeAlias = Literal["mute", "stopped"] | MuteName


class MuteEvent(msgspec.Struct, frozen=True, gc=False):
    """A passage played with a mute, or with the hand closing the bell."""

    id: str
    kind: MuteKind
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    reason: Message


class EmbouchureEvent(msgspec.Struct, frozen=True, gc=False):
    """Lips during one note, all values 0..1: ``tension`` (by pitch), ``effort`` (height, loudness, length), ``air``
    (dynamics).

    Attributes
    ----------
    planned : (float, float, float) or None
        Generated tension, effort and air, if other values were set by hand.
    """

    note_id: str
    start_s: float
    end_s: float
    tension: float
    effort: float
    air: float
    reason: Message
    planned: tuple[float, float, float] | None = None

    @property
    def corrected(self) -> bool:
        """True if values were set by hand."""
        return self.planned is not None

    @property
    def id(self) -> str:
        """Id made of the note's id; there is one event for every note."""
        return f"embouchure:{self.note_id}"


class CueEvent(msgspec.Struct, frozen=True, gc=False):
    """A cue with body and instrument: up on the preparatory beat, down on the beat of the entry.

    Attributes
    ----------
    start_s : float
        When head and instrument begin to rise.
    peak_s : float
        Time of the preparatory beat, one beat (``beat_s``) before the entry at ``end_s``, more before a pickup.
    amount : float
        Size relative to a cue for mezzoforte.
    takers : tuple of str
        Ids of the cued players, without the player who gives the cue.
    """

    id: str
    player_id: str
    start_tick: int
    end_tick: int
    start_s: float
    peak_s: float
    end_s: float
    beat_s: float
    reason: Message
    corrected: bool = False
    amount: float = 1.0
    takers: tuple[str, ...] = ()

    @property
    def downbeat_s(self) -> float:
        """Time of the beat on which the nod's acceleration peaks: the entry, or before a pickup the beat that contains
        it.
        """
        return self.peak_s + self.beat_s


ACCENT_AT: Final = 0.45
"""Share of an accent's length at which its note begins."""


class GestureEvent(msgspec.Struct, frozen=True, gc=False):
    """A body motion over a span. ``amount`` is -1..1: positive to the left, up, forward, or down for an accent; for
    feet the sign selects the foot; kinds without a direction are 0..1. A nod marks the beat at its end. An event of
    kind ``"named"`` is the gesture ``name`` of `metadata.gestures`, fitted to the player.
    """

    id: str
    kind: GestureKind
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    amount: float
    reason: Message
    corrected: bool = False
    name: str = ""
    gesture: Gesture | None = None

    @property
    def part(self) -> Part:
        """Part of the motion that performs the gesture."""
        return GESTURE_KINDS[self.kind].part


class ExpressionEvent(msgspec.Struct, frozen=True, gc=False):
    """An event in which the face shows an expression of `metadata`, with strength 0..1 and fades."""

    id: str
    expression: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    strength: float
    fade_in_s: float
    fade_out_s: float
    reason: Message
    corrected: bool = False


AUDIENCE: Final = "audience"
ABOUT: Final = "about"
FAR_M: Final = 4.0
"""Distance in metres of objects of unknown distance that players look at."""
CONDUCTOR: Final = "conductor"
"""Id of the conductor in places, cues and glances, in which players have theirs."""


class GlanceEvent(msgspec.Struct, frozen=True, gc=False):
    """A look away from the music, at another player, the conductor or the audience.

    Attributes
    ----------
    at : str
        Id of a player, `CONDUCTOR`, `AUDIENCE`, or `ABOUT` for a look at nothing in particular.
    yaw_rad, pitch_rad : float
        Direction relative to the player's facing, left and down positive.
    head_share : float
        Share of the turn made by the head.
    away_m : float
        Distance of the object looked at.
    """

    id: str
    at: str
    start_s: float
    end_s: float
    yaw_rad: float
    pitch_rad: float
    head_share: float
    away_m: float = FAR_M


Event: TypeAlias = (
    FingeringEvent
    | BreathEvent
    | TongueEvent
    | EmbouchureEvent
    | CueEvent
    | GestureEvent
    | ExpressionEvent
    | PoseEvent
    | StyleEvent
)


class Problem(msgspec.Struct, frozen=True, gc=False):
    """A problem for the animator to check, anchored to a note if possible."""

    message: Message
    note_id: str | None
    start_s: float
    end_s: float


class Planned(NamedTuple, Generic[E]):
    """Planned events with the problems found."""

    events: tuple[E, ...]
    problems: tuple[Problem, ...]


class TimeFrame(msgspec.Struct, frozen=True):
    """Time span of a performance in seconds, shared by all players. Frame 0 is at ``first_frame_s``."""

    first_frame_s: float
    end_s: float


class PlayerPlan(msgspec.Struct, frozen=True):
    """Everything one player does. Each tuple is ordered by start; ``glances`` do not overlap; ``traces`` exist if there
    are controller curves or dynamics within notes.
    """

    player_id: str
    time_frame: TimeFrame
    fingerings: tuple[FingeringEvent, ...]
    breaths: tuple[BreathEvent, ...]
    tongues: tuple[TongueEvent, ...]
    embouchures: tuple[EmbouchureEvent, ...]
    cues: tuple[CueEvent, ...]
    gestures: tuple[GestureEvent, ...]
    expressions: tuple[ExpressionEvent, ...]
    problems: tuple[Problem, ...]
    poses: tuple[PoseEvent, ...] = ()
    additive: tuple[AdditiveEvent, ...] = ()
    traces: SampledCurves | None = None
    glances: tuple[GlanceEvent, ...] = ()
    styles: tuple[StyleEvent, ...] = ()
    mutes: tuple[MuteEvent, ...] = ()

    @property
    def has_recorded_lips(self) -> bool:
        """True if the lips within notes were recorded, including vibrato."""
        return self.traces is not None and self.traces.recorded

    @property
    def grips(self) -> tuple[FingeringEvent, ...]:
        """Successive fingerings of the player; one with controls that only help the attack counts as two."""
        return grips_of(self.fingerings)


def grips_of(fingerings: tuple[FingeringEvent, ...]) -> tuple[FingeringEvent, ...]:
    """Return the fingerings with each vented one (keys released once the note speaks) split in two; the same tuple if
    none is vented."""
    if all(event.vent is None for event in fingerings):
        return fingerings
    return _GRIPS.step(_all_grips, fingerings)


_GRIPS: Final[IdentityCache[tuple[FingeringEvent, ...]]] = IdentityCache(64)


def _all_grips(fingerings: tuple[FingeringEvent, ...]) -> tuple[FingeringEvent, ...]:
    return tuple(grip for event in fingerings for grip in _grips(event))


def _grips(event: FingeringEvent) -> tuple[FingeringEvent, ...]:
    vent = event.vent
    if vent is None:
        return (event,)
    held = msgspec.structs.replace(
        event,
        id=f"{event.id}:held",
        start_tick=vent.end_tick,
        start_s=vent.end_s,
        label=vent.label,
        controls={name: value for name, value in event.controls.items() if name not in vent.controls},
        vent=None,
    )
    return msgspec.structs.replace(event, end_tick=vent.end_tick, end_s=vent.end_s, vent=None), held


def only(plan: PlayerPlan, fields: tuple[str, ...]) -> PlayerPlan:
    """Return a plan with only the events of the given fields, so that a result computed from it cannot depend on other
    fields.
    """
    none = no_events(plan.player_id, plan.time_frame)
    return msgspec.structs.replace(none, **{name: getattr(plan, name) for name in fields})


@lru_cache(maxsize=256)
def no_events(player_id: str, frame: TimeFrame) -> PlayerPlan:
    """Return a player's plan without any events, such as for a part without notes."""
    return PlayerPlan(player_id, frame, (), (), (), (), (), (), (), ())
