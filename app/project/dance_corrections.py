"""Corrections of a dance, in musical time; a regenerated dance satisfies them."""

from __future__ import annotations

from typing import TypeAlias

import msgspec


class _Correction(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="correction"):
    pass


class PinState(_Correction, frozen=True, tag="pin_state"):
    """Correction that requires a basic motion at a tick.

    Attributes
    ----------
    state : int
        Index of the basic motion in the choreography.
    """

    tick: int
    state: int


class ForbidState(_Correction, frozen=True, tag="forbid_state"):
    """Correction that excludes a basic motion from ``start_tick`` to before ``end_tick``."""

    start_tick: int
    end_tick: int
    state: int


class UseSegment(_Correction, frozen=True, tag="use_segment"):
    """Correction that requires a segment of the motion capture at a tick, and with it its basic motion.

    Attributes
    ----------
    segment : int
        Index of the segment in the choreography.
    """

    tick: int
    segment: int


DanceCorrection: TypeAlias = PinState | ForbidState | UseSegment
