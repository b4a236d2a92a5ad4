"""Events that exist only by hand: held poses, styles and additive curves."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec

from app.errors import Message
from app.plan.acting import Acting

PoseTarget: TypeAlias = Literal["bell", "head", "left_elbow", "right_elbow", "torso"]
"""Parts of a player that the user can pose."""


class PoseEvent(msgspec.Struct, frozen=True, gc=False):
    """A part of the body posed differently from ``start_s`` to ``end_s``, with a fade before and after. Angles as in
    `app.plan.by_hand.corrections.PoseCorrection`.
    """

    id: str
    target: PoseTarget
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    up_deg: float
    left_deg: float
    roll_deg: float
    fade_in_s: float
    fade_out_s: float
    reason: Message
    corrected: bool = True


class StyleEvent(msgspec.Struct, frozen=True, gc=False):
    """A span in which a player plays in another style: ``acting`` within it, ``usual`` elsewhere. The style fades in
    and out within the span.
    """

    id: str
    style: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    fade_in_s: float
    fade_out_s: float
    acting: Acting
    usual: Acting
    reason: Message
    corrected: bool = True


class CurveSegment(msgspec.Struct, frozen=True, gc=False):
    """A stretch of a curve: a cubic with two handles, or (``eased``) a minimum-jerk move. A handle is a point, with a
    time within the stretch and a value.
    """

    start_s: float
    end_s: float
    before: float
    after: float
    leave_s: float
    leave_value: float
    arrive_s: float
    arrive_value: float
    eased: bool


class AdditiveEvent(msgspec.Struct, frozen=True, gc=False):
    """A curve added to a channel (`app.plan.by_hand.additive_curve`). Ticks are those of its first and last key;
    seconds include fading in and out. ``low`` and ``high`` are the limits of the channel; values are in its unit,
    weighted.
    """

    id: str
    channel: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    segments: tuple[CurveSegment, ...]
    low: float
    high: float
