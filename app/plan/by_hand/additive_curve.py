"""Curves that an animator adds to the generated motion: keys on one channel of the body or face.

Keys are anchored to ticks of the score; the curve fades in before the first key and out after the last. Its values are
added to all generated layers before contacts are solved.
"""

from __future__ import annotations

from itertools import pairwise
from typing import ClassVar, Final, Literal, NamedTuple, TypeAlias

import msgspec

from app.plan.by_hand.correction import Own
from metadata.model import ARKIT_MORPHS

Interpolation: TypeAlias = Literal["bezier", "linear", "constant"]
INTERPOLATIONS: Final[tuple[Interpolation, ...]] = ("bezier", "linear", "constant")
Unit: TypeAlias = Literal["deg", "m", "weight"]

MOST_KEYS: Final = 5000
"""Greatest number of keys in a curve."""


class AdditiveChannel(NamedTuple):
    """Unit and limits of an additive curve's channel.

    Attributes
    ----------
    unit : {"deg", "m", "weight"}
        Unit of the values.
    most : float
        No key of a file may be further from 0.
    """

    unit: Unit
    most: float


_ANGLE, _PLACE = AdditiveChannel("deg", 180.0), AdditiveChannel("m", 1.0)
BODY_CHANNELS: Final[dict[str, AdditiveChannel]] = {
    "bell.up": _ANGLE,
    "bell.left": _ANGLE,
    "bell.roll": _ANGLE,
    "head.up": _ANGLE,
    "head.left": _ANGLE,
    "head.roll": _ANGLE,
    "torso.up": _ANGLE,
    "torso.left": _ANGLE,
    "torso.roll": _ANGLE,
    "left_elbow.up": _ANGLE,
    "right_elbow.up": _ANGLE,
    "shoulders.up": _ANGLE,
    "hips.left": _PLACE,
    "hips.ahead": _PLACE,
    "hips.up": _PLACE,
    "hips.tilt": _ANGLE,
    "hips.roll": _ANGLE,
    "knees.bend": _ANGLE,
    "eyes.up": _ANGLE,
    "eyes.left": _ANGLE,
}
"""Channels of the body: a part and its motion. Angles of bell, head, torso and elbows are as in
`app.plan.by_hand.corrections.PoseCorrection`.
"""
FACE: Final = "face."
"""Prefix of channels of the face, followed by the name of a morph target."""
CHANNELS: Final[dict[str, AdditiveChannel]] = BODY_CHANNELS | {
    f"{FACE}{name}": AdditiveChannel("weight", 1.0) for name in ARKIT_MORPHS
}


class Tangent(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Handle of a key, relative to the key: ``ticks`` away (never negative, on the handle's own side) and ``value``
    above it.
    """

    ticks: int
    value: float


class CurveKey(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A key of a curve.

    Attributes
    ----------
    value : float
        Degrees, metres or the weight of a morph target.
    interpolation : {"bezier", "linear", "constant"}
        Interpolation to the next key. A constant key holds its value, then moves to the next one in the least time a
        body needs.
    arrive, leave : Tangent or None
        Handles before and after the key; None: automatic, without overshoot.
    """

    tick: int
    value: float
    interpolation: Interpolation = "bezier"
    arrive: Tangent | None = None
    leave: Tangent | None = None


class AdditiveCurve(Own, frozen=True, tag="additive"):
    """An additive curve over a span of the score. ``name`` makes its event id unique.

    Attributes
    ----------
    channel : str
        One of `CHANNELS`.
    keys : tuple of CurveKey
        Keys at ascending ticks, at least one.
    blend_in_ticks, blend_out_ticks : int
        Ticks of fading in before the first key, and of fading out after the last.
    weight : float
        Factor of the values, 0..1.
    title : str
        Name given by the user; may be empty.
    """

    event_kind: ClassVar[str] = "additive"
    has_event: ClassVar[bool] = False
    channel: str
    keys: tuple[CurveKey, ...]
    blend_in_ticks: int = 0
    blend_out_ticks: int = 0
    weight: float = 1.0
    enabled: bool = True
    title: str = ""

    @property
    def start_tick(self) -> int:
        """Tick of the first key."""
        return self.keys[0].tick

    @property
    def end_tick(self) -> int:
        """Tick of the last key."""
        return self.keys[-1].tick

    @property
    def is_empty(self) -> bool:
        """Return whether the curve has no keys, or keys that are not in ascending order."""
        return not self.keys or any(key.tick >= following.tick for key, following in pairwise(self.keys))
