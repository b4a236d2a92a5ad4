"""Events that are only made by hand: poses held and curves laid over what is generated."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec

from app.errors import Message
from app.plan.acting import Acting

PoseTarget: TypeAlias = Literal["bell", "head", "left_elbow", "right_elbow", "torso"]
"""Parts of a player that the animator takes hold of."""


class PoseEvent(msgspec.Struct, frozen=True, gc=False):
    """A part of the body held differently over a span: whole from ``start_s`` to ``end_s``, with a fade before and one
    after it. Angles as in `app.plan.by_hand.corrections.PoseCorrection`."""

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
    """A region in which the player plays in another style: ``acting`` is what is shown in it, ``usual`` what elsewhere.
    It comes and goes within the region."""

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
    """A stretch of a curve: a cubic with two handles between both ends, or (``eased``) a minimum-jerk move. Handles are
    places: a time within the stretch, and a value."""

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
    """A curve that is added to a channel (`app.plan.by_hand.additive_curve`). Ticks are of its first and last key,
    seconds from when it begins to come in to when it is gone. ``low`` and ``high`` are how far the channel goes; values
    are in the channel's unit, weighted."""

    id: str
    channel: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    segments: tuple[CurveSegment, ...]
    low: float
    high: float
