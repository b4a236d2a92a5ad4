"""Holding still: freezes layers of the body for a while."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Envelopes
from app.motion.gestures.body_lag import Overlapped
from app.plan.model import GestureEvent

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

COMES_S: Final = 0.35
GOES_S: Final = 0.6
"""Seconds in which a body comes to rest and starts again."""
HELD: Final = ("sway", "lean", "accent", "weight", "giving", "height")
"""Layers without motion while the body is held still; breath, cue and lowering continue."""


def holds_of(gestures: Sequence[GestureEvent]) -> Envelopes:
    """Return the degree over time, 0..1, to which gestures of holding still freeze the body."""
    rows = []
    for event in gestures:
        if event.end_s > event.start_s:
            share = min(1.0, (event.end_s - event.start_s) / (COMES_S + GOES_S))
            full_s, fall_s = event.start_s + share * COMES_S, event.end_s - share * GOES_S
            rows.append((event.start_s, full_s, fall_s, event.end_s, event.amount))
    return Envelopes.of(rows)


L = TypeVar("L", bound="DataclassInstance")


def held_still(levels: L, holds: Envelopes, times_s: FloatArray, at: Callable[[FloatArray], L]) -> L:
    """Freeze layers of motion during each hold, at the values they have when the hold takes full effect.

    Parameters
    ----------
    at : callable
        Function that samples the same layers at other times.
    """
    first, last = (np.searchsorted(times_s, edges_s) for edges_s in (holds.start_s, holds.end_s))
    for index in np.flatnonzero(last > first).tolist():
        alone = Envelopes(*(getattr(holds, member.name)[index : index + 1] for member in fields(holds)))
        share = alone.sample(times_s)
        stays = at(holds.full_s[index : index + 1])
        levels = replace(levels, **{name: _held(getattr(levels, name), getattr(stays, name), share) for name in HELD})
    return levels


def _held(values: Any, stays: Any, share: FloatArray) -> Any:
    if isinstance(values, Overlapped):
        return Overlapped(*(_held(*part, share) for part in zip(values, stays, strict=True)))
    return values + (stays[0] - values) * share


def with_holds(spans_s: FloatArray, *holds: Envelopes) -> FloatArray:
    """Extend the K spans (K, 2) in which motion changed by every hold that overlaps them, since held values come from
    earlier times.
    """
    held = np.concatenate([one.spans_s for one in holds])
    if not len(held) or not len(spans_s):
        return spans_s
    meets = (held[:, None, 0] <= spans_s[None, :, 1]) & (spans_s[None, :, 0] <= held[:, None, 1])
    return np.concatenate((spans_s, held[meets.any(axis=1)]))
