"""Kinds of gestures and breaths: one table row for each, used wherever kinds differ.

A new kind of gesture needs a row here and a function in `app.plan.player.BY_MUSIC`; its reason is a message.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

Part: TypeAlias = Literal[
    "sway",
    "lean",
    "accent",
    "weight",
    "bell",
    "lowering",
    "feet",
    "nod",
    "count",
    "settle",
    "still",
    "glance",
    "audience",
    "bow",
    "tracks",
]
"""Parts that a gesture moves: a layer of the body (`app.motion.gestures.layers`), the eyes (`app.plan.faces.glances`),
or both.
"""


class GestureRow(NamedTuple):
    """A kind of gesture.

    Attributes
    ----------
    id : str
        First part of the events' ids; also stored in project files.
    names : (str, str)
        Name of such an event, in English and Japanese.
    command : str
        English title of the command that adds one; empty if there is none.
    part : str
        Part of the motion that performs it.
    layer : str
        The field of `app.plan.acting.Acting` that scales its amount in another style.
    signed : bool
        Whether it has two directions; other kinds are never below 0.
    row : str
        Row of the timeline's lane; kinds with an equal row share it, and an empty one gets its own row.
    look : {"span", "strip", "curve"}
        Drawing: as single spans, as bars of a calm strip, or as a strip that continues from the previous event's end.
    moves_eyes : bool
        Whether glances depend on it.
    idle : bool
        Whether it is omitted while a hand is off the instrument.
    """

    id: str
    names: tuple[str, str]
    command: str
    part: Part
    layer: str = ""
    signed: bool = False
    row: str = ""
    look: Literal["span", "strip", "curve"] = "span"
    moves_eyes: bool = False
    idle: bool = False


class BreathRow(NamedTuple):
    """A kind of breath.

    Attributes
    ----------
    id : str
        First part of the events' ids; also stored in project files.
    names : (str, str)
        Name of such an event, in English and Japanese.
    draws_air : bool
        Whether it fills the lungs; otherwise it is the motion before a breath.
    within : bool
        Whether it is within a note, which may have several; otherwise before a note.
    shown_as : str
        Kind of its events in plans, if different from the id.
    """

    id: str
    names: tuple[str, str]
    draws_air: bool = True
    within: bool = False
    shown_as: str = ""

    @property
    def event_kind(self) -> str:
        """Kind that events of this row have in plans: ``shown_as``, or the id."""
        return self.shown_as or self.id


GESTURES: Final = (
    GestureRow("sway", ("Sway", "揺れ"), "Sway", "sway", "sway", signed=True, look="curve"),
    GestureRow(
        "weight_shift", ("Weight shift", "重心移動"), "Weight Shift", "weight", "weight_shift", True, look="strip"
    ),
    GestureRow("bell_height", ("Bell height", "ベルの高さ"), "Bell Height", "bell", "bell_height", True, look="strip"),
    GestureRow(
        "lower_instrument",
        ("Instrument lowered", "楽器を下ろす"),
        "Lower Instrument",
        "lowering",
        row="pose",
        moves_eyes=True,
    ),
    GestureRow("lean", ("Lean", "前後の傾き"), "Lean", "lean", "phrase", True, look="curve"),
    GestureRow("accent", ("Accent", "アクセント"), "Accent", "accent", "phrase", True, look="strip"),
    GestureRow("step", ("Step", "踏み出し"), "Step", "feet", "footwork", True, "feet"),
    GestureRow("tap", ("Toe tap", "つま先で拍を取る"), "Toe Tap", "feet", "footwork", True, "feet"),
    GestureRow("heel", ("Heel lift", "かかと上げ"), "Heel Lift", "feet", "footwork", True, "feet"),
    GestureRow("nod", ("Nod", "うなずき"), "Nod", "nod", "cue", row="beside"),
    GestureRow("count", ("Counts the bars", "小節を数える"), "Count the Bars", "count", row="beside", idle=True),
    GestureRow(
        "look_about", ("Looks about", "周りを見る"), "Look About", "glance", row="beside", moves_eyes=True, idle=True
    ),
    GestureRow("settle_grip", ("Settles the grip", "持ち直す"), "Settle the Grip", "settle", row="beside", idle=True),
    GestureRow("hold_still", ("Holds still", "静止"), "Hold Still", "still", row="beside"),
    GestureRow("look_up", ("Looks up", "客席を見る"), "Look Up", "audience", row="beside", moves_eyes=True),
    GestureRow("bow", ("Bow", "お辞儀"), "Bow", "bow", row="beside"),
    # Gestures from tables (`metadata.gestures`) have names of their own.
    GestureRow("named", ("Gesture", "ジェスチャー"), "", "tracks", row="beside"),
)
"""Motions of a body besides playing, in the order of menus."""
BREATHS: Final = (
    BreathRow("breath", ("Breath", "ブレス")),
    BreathRow("preparation", ("Breath preparation", "ブレスの準備動作"), draws_air=False),
    BreathRow("within", ("Breath", "ブレス"), within=True, shown_as="breath"),
)
GESTURE_KINDS: Final[Mapping[str, GestureRow]] = {kind.id: kind for kind in GESTURES}
BREATH_KINDS: Final[Mapping[str, BreathRow]] = {kind.id: kind for kind in BREATHS}
if TYPE_CHECKING:
    GestureKind: TypeAlias = str
    BreathKind: TypeAlias = str
else:
    # Readers of files refuse all other kinds.
    GestureKind = Literal[tuple(GESTURE_KINDS)]
    BreathKind = Literal[tuple(BREATH_KINDS)]
BEFORE_NOTES: Final = tuple(kind.id for kind in BREATHS if not kind.within)
EVENT_TEXTS: Final = {f"event.{kind.id}": kind.names for kind in (*GESTURES, *BREATHS)}
COMMAND_TEXTS: Final = {f"action.gesture.{kind.id}": (kind.command, kind.names[1]) for kind in GESTURES if kind.command}
"""Names in English and Japanese of commands that add events, by text id."""


def answered_by(part: Part) -> tuple[str, ...]:
    """Return the ids of the kinds of `GESTURES` that are performed by one part of the generated motion, such as the
    trunk or the head."""
    return tuple(kind.id for kind in GESTURES if kind.part == part)
