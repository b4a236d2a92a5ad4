"""Kinds of gestures and of breaths: one row for each, read wherever kinds differ.

A new kind of gesture is a row here and a function among `app.plan.player.BY_MUSIC`; its reason is a message.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

Part: TypeAlias = Literal[
    "sway", "lean", "accent", "weight", "bell", "lowering", "feet", "nod", "beside", "eyes", "tracks"
]
"""Of the body's motion, what answers a gesture (`app.motion.gestures.body_layers`)."""


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
        The part of the body's motion that answers it.
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
    """

    id: str
    names: tuple[str, str]


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
    GestureRow("tap", ("Toe tap", "つま先タップ"), "Toe Tap", "feet", "footwork", True, "feet"),
    GestureRow("heel", ("Heel lift", "かかと上げ"), "Heel Lift", "feet", "footwork", True, "feet"),
    GestureRow("nod", ("Nod", "うなずき"), "Nod", "nod", "cue", row="beside"),
    GestureRow("count", ("Counts the bars", "小節を数える"), "Count the Bars", "beside", row="beside", idle=True),
    GestureRow(
        "look_about", ("Looks about", "周りを見る"), "Look About", "eyes", row="beside", moves_eyes=True, idle=True
    ),
    GestureRow("settle_grip", ("Settles the grip", "持ち直す"), "Settle the Grip", "beside", row="beside", idle=True),
    GestureRow("hold_still", ("Holds still", "静止"), "Hold Still", "beside", row="beside"),
    GestureRow("look_up", ("Looks up", "客席を見る"), "Look Up", "beside", row="beside", moves_eyes=True),
    GestureRow("bow", ("Bow", "お辞儀"), "Bow", "beside", row="beside"),
    # Of tables (`metadata.gestures`): each has a name of its own.
    GestureRow("named", ("Gesture", "ジェスチャー"), "", "tracks", row="beside"),
)
"""What a body does beside playing, in the order of menus."""
BREATHS: Final = (
    BreathRow("breath", ("Breath", "ブレス")),
    BreathRow("preparation", ("Breath preparation", "ブレスの準備動作")),
    BreathRow("within", ("Breath", "ブレス")),
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
EVENT_TEXTS: Final = {f"event.{kind.id}": kind.names for kind in (*GESTURES, *BREATHS)}
COMMAND_TEXTS: Final = {f"action.gesture.{kind.id}": (kind.command, kind.names[1]) for kind in GESTURES if kind.command}
"""Names of events and of the commands that add them, by id, in English and Japanese."""


def answered_by(part: Part) -> tuple[str, ...]:
    """Return the kinds of gestures that a part of the body's motion answers."""
    return tuple(kind.id for kind in GESTURES if kind.part == part)
