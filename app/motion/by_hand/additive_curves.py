"""An animator's additive curves, added to all layers of body and face before contacts are solved.

Curves of one channel are summed and limited softly to the channel's range.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.by_hand.pose_corrections import PoseAngles, within
from app.motion.curves.curve import rows_changed_s
from app.plan.by_hand.additive_curve import CHANNELS, FACE
from app.plan.by_hand.additive_events import POSED
from app.plan.by_hand.bezier import COLUMNS, rows, sampled_rows
from app.plan.events_by_hand import AdditiveEvent, PoseTarget
from metadata.model import Body

_NUMBERS: Final = {name: float(number) for number, name in enumerate(CHANNELS)}
OF_LIPS: Final = ("mouth", "jaw", "tongue", "cheekPuff")
"""Prefixes of the morph targets that belong to the embouchure while the instrument is at the lips."""


@dataclass(frozen=True)
class Added:
    """Values (F,) that the user adds to an animation channel, with the channel's limits; radians, metres or weights."""

    values: FloatArray
    low: float
    high: float

    def beside(self, other: FloatArray | float) -> FloatArray:
        """Limit the values (F,) so that together with another offset (F,) of the same channel they stay within the
        channel's limits.
        """
        return within(self.values, self.high - other, other - self.low)


@dataclass(frozen=True, eq=False)
class Additive:
    """All additive curves of a player.

    Attributes
    ----------
    events : tuple of AdditiveEvent
        Events ordered by start.
    tables : tuple of (S, 9) array
        Segments of each event.
    """

    events: tuple[AdditiveEvent, ...]
    tables: tuple[FloatArray, ...]

    @classmethod
    def of(cls, events: Sequence[AdditiveEvent]) -> Additive:
        """Collect the additive curves of a plan's events, so that they can be sampled."""
        return cls(tuple(events), tuple(rows(event.segments) for event in events))

    def sample(self, times_s: FloatArray) -> dict[str, Added]:
        """Sample the added values by channel. Every channel that has a curve anywhere in the piece is included, so that
        a frame gets the same result in every span.
        """
        sums: dict[str, Added] = {}
        for event, table in zip(self.events, self.tables, strict=True):
            size = float(np.deg2rad(1.0)) if CHANNELS[event.channel].unit == "deg" else 1.0
            values = size * sampled_rows(table, times_s)
            known = sums.get(event.channel)
            if known is not None:
                values = known.values + values
            sums[event.channel] = Added(values, size * event.low, size * event.high)
        return sums

    def changed_s(self, other: Additive) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both sets of curves have equal values."""
        mine, others = self._rows, other._rows
        return rows_changed_s(mine, others, mine[:, :2], others[:, :2])

    @property
    def _rows(self) -> FloatArray:
        """Describe all additive curves as rows of numbers for comparison: Bezier segment, channel number, hash of the
        event id, and bounds of the value.
        """
        found = [np.zeros((0, COLUMNS + 4))]
        for event, table in zip(self.events, self.tables, strict=True):
            whose = (_NUMBERS[event.channel], float(zlib.crc32(event.id.encode())), event.low, event.high)
            found.append(np.concatenate((table, np.tile(whose, (len(table), 1))), axis=1))
        return np.concatenate(found)


NOTHING: Final = Additive.of(())


def with_held(held: Mapping[PoseTarget, PoseAngles], added: Mapping[str, Added]) -> dict[PoseTarget, PoseAngles]:
    """Add the animator's curves to the angles that pose corrections hold, by target (bell, head ...), within each
    target's limits.
    """
    result = dict(held)
    for channel, more in added.items():
        if channel not in POSED:
            continue
        target, angle = POSED[channel]
        zero = np.zeros(len(more.values))
        offset = result.get(target, PoseAngles(zero, zero, zero))
        name = angle.removesuffix("_deg")
        own: FloatArray = getattr(offset, name)
        result[target] = replace(offset, **{name: own + more.beside(own)})
    return result


def with_added(motion: BodyMotion, added: Mapping[str, Added], body: Body, knee_rad: float) -> BodyMotion:
    """Add the animator's curves for hips, knees, shoulders and eyes to the motion of a body; ``knee_rad`` is the bend
    of the knees at rest.
    """
    changes: dict[str, object] = {}
    for channel, more in added.items():
        part, _, what = channel.partition(".")
        match part, what:
            case "hips", "left":
                changes["hips_side_m"] = motion.hips_side_m + more.beside(0.0)
            case "hips", "ahead":
                changes["hips_ahead_m"] = motion.hips_ahead_m + more.beside(0.0)
            case "hips", "tilt":
                changes["hips_forward_rad"] = motion.hips_forward_rad + more.beside(0.0)
            case "hips", "roll":
                changes["hips_roll_rad"] = motion.hips_roll_rad + more.beside(0.0)
            case "hips", "up":
                # Legs that are nearly straight cannot get longer: the body can rise only by as much as it has sunk.
                sunk = np.clip(motion.hips_bob_m, 0.0, more.high)
                changes["hips_bob_m"] = motion.hips_bob_m - np.minimum(within(more.values, sunk, -more.low), sunk)
            case "knees", _:
                room = motion.knee_rad + knee_rad
                bent = within(more.values, more.high, np.minimum(room, -more.low))
                changes["knee_rad"] = motion.knee_rad + bent
            case "shoulders", _:
                lifted = motion.shoulders_rad
                changes["shoulders_rad"] = lifted + more.beside(lifted)
            case "eyes", "left":
                changes["eyes_yaw_rad"] = _looked(motion.eyes_yaw_rad, more.beside(0.0), body.limits["eye"].twist_deg)
            case "eyes", _:
                changes["eyes_pitch_rad"] = _looked(
                    motion.eyes_pitch_rad, -more.beside(0.0), body.limits["eye"].flexion_deg
                )
    return replace(motion, **changes) if changes else motion  # type: ignore[arg-type]


def _looked(angle: FloatArray, offset: FloatArray, limit_deg: tuple[float, float]) -> FloatArray:
    low, high = np.deg2rad(limit_deg)
    return angle + within(offset, high - angle, angle - low)


def with_added_morphs(
    morphs: dict[str, FloatArray], added: Mapping[str, Added], at_lips: FloatArray
) -> dict[str, FloatArray]:
    """Add the curves of morph targets to the face.

    Curves of lips and jaw have no effect while they hold the mouthpiece, weighted by ``at_lips`` (F,), 0..1.
    """
    result = dict(morphs)
    for channel, more in added.items():
        if not channel.startswith(FACE):
            continue
        name = channel.removeprefix(FACE)
        values = more.values * (1.0 - at_lips) if name.startswith(OF_LIPS) else more.values
        result[name] = np.clip(result.get(name, np.zeros(len(at_lips))) + values, 0.0, 1.0)
    return result
