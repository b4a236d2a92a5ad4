"""Kinds of gestures and of breaths: one row for each, read wherever kinds differ.

A new kind of gesture is a row here and a function among `app.plan.player.BY_MUSIC`; its reason is a message.
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
"""Parts that answer a gesture: a layer of the body (`app.motion.gestures.layers`), eyes (`app.plan.faces.glances`), or
both."""


class GestureRow(NamedTuple):
    """A kind of gesture.

    Attributes
    ----------
    id : str
        First part of its events' ids; also in users' files.
    names : (str, str)
        Of an event, in English and Japanese.
    command : str
        English title of the command that adds one; empty: there is none.
    part : str
        What answers it.
    layer : str
        The field of `app.plan.acting.Acting` that scales its amount in another style, where one gesture has one size.
    signed : bool
        It goes one way or the other; of all others there is no less than nothing.
    row : str
        Of the timeline's lane; those of the same row share it, and one without has a row of its own.
    look : {"span", "strip", "curve"}
        What is generated is drawn one by one, as bars of a calm strip, or as a strip that goes on from where the one
        before ended.
    moves_eyes : bool
        Glances depend on it.
    idle : bool
        It is left out where a hand of the player is away.
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
        First part of its events' ids; also in users' files.
    names : (str, str)
        Of an event, in English and Japanese.
    draws_air : bool
        It fills the lungs; else it is the motion that leads to a breath.
    within : bool
        It is taken within a note, of which there may be several; else before one.
    shown_as : str
        The kind of its events in plans, where that is another.
    """

    id: str
    names: tuple[str, str]
    draws_air: bool = True
    within: bool = False
    shown_as: str = ""

    @property
    def event_kind(self) -> str:
        """The kind of its events in plans."""
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
    # Of tables (`metadata.gestures`): each has a name of its own.
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
    # Readers of files refuse all others.
    GestureKind = Literal[tuple(GESTURE_KINDS)]
    BreathKind = Literal[tuple(BREATH_KINDS)]
BEFORE_NOTES: Final = tuple(kind.id for kind in BREATHS if not kind.within)
EVENT_TEXTS: Final = {f"event.{kind.id}": kind.names for kind in (*GESTURES, *BREATHS)}
COMMAND_TEXTS: Final = {f"action.gesture.{kind.id}": (kind.command, kind.names[1]) for kind in GESTURES if kind.command}
"""Names of events and of the commands that add them, by id, in English and Japanese."""


def answered_by(part: Part) -> tuple[str, ...]:
    """Return the kinds of gestures that one part of the motion answers."""
    return tuple(kind.id for kind in GESTURES if kind.part == part)
