"""An animator's pose corrections, added to the body's layers before contacts are solved.

Offsets fade in and out, may overlap, and are limited softly to a joint's range.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Envelopes, rows_changed_s
from app.plan.by_hand.pose_corrections import BELL_LEFT, BELL_UP, NECK_SHARES, TRUNK_SHARES
from app.plan.events_by_hand import PoseEvent, PoseTarget
from metadata.model import Body

LEAST_ROOM_RAD = 1e-3
_COLUMNS: tuple[PoseTarget, ...] = ("bell", "head", "left_elbow", "right_elbow", "torso")


@dataclass(frozen=True)
class PoseAngles:
    """Angles (F,) up, left and roll in radians; see `app.plan.by_hand.corrections.PoseCorrection`."""

    up: FloatArray
    left: FloatArray
    roll: FloatArray


@dataclass(frozen=True, eq=False)
class PoseCorrectionTable:
    """All pose corrections of a player, one per row.

    Attributes
    ----------
    targets : (N,) int64
        Index in the list of targets.
    times_s : (N, 4) float64
        Start of fade-in, start and end of full effect, end of fade-out.
    angles_rad : (N, 3) float64
        Up, left, roll.
    """

    targets: FloatArray
    times_s: FloatArray
    angles_rad: FloatArray

    @classmethod
    def of(cls, events: Sequence[PoseEvent]) -> PoseCorrectionTable:
        """Collect the pose corrections of a plan's events, so that they can be sampled."""
        times_s = [
            (event.start_s - event.fade_in_s, event.start_s, event.end_s, event.end_s + event.fade_out_s)
            for event in events
        ]
        angles_deg = [(event.up_deg, event.left_deg, event.roll_deg) for event in events]
        return cls(
            np.array([_COLUMNS.index(event.target) for event in events], dtype=np.float64),
            np.array(times_s, dtype=np.float64).reshape(-1, 4),
            np.deg2rad(np.array(angles_deg, dtype=np.float64).reshape(-1, 3)),
        )

    def sample(self, times_s: FloatArray) -> dict[PoseTarget, PoseAngles]:
        """Return the summed corrections of the pose at ascending times (N,), by target: angles (N,) in radians."""
        sums: dict[PoseTarget, FloatArray] = {}
        for target, span_s, angle_rad in zip(self.targets, self.times_s, self.angles_rad, strict=True):
            total = sums.setdefault(_COLUMNS[int(target)], np.zeros((3, len(times_s))))
            total += angle_rad[:, None] * Envelopes.of([(*span_s.tolist(), 1.0)]).sample(times_s)
        return {target: PoseAngles(*total) for target, total in sums.items()}

    def changed_s(self, other: PoseCorrectionTable) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both tables have equal values."""
        mine, others = self._rows, other._rows
        return rows_changed_s(mine, others, mine[:, [1, 4]], others[:, [1, 4]])

    @property
    def _rows(self) -> FloatArray:
        return np.concatenate((self.targets[:, None], self.times_s, self.angles_rad), axis=1)


def within(offset: FloatArray, room_above: FloatArray | float, room_below: FloatArray | float) -> FloatArray:
    """Limit an offset (radians) softly to the available angle above and below; up to half of it the offset is almost
    unchanged.
    """
    room = np.maximum(np.where(offset >= 0.0, room_above, room_below), LEAST_ROOM_RAD)
    held: FloatArray = offset / np.power(1.0 + np.power(offset / room, 4), 0.25)
    return held


def hold_body(
    offsets: dict[PoseTarget, PoseAngles],
    body: Body,
    forward_rad: dict[str, FloatArray],
    left_rad: dict[str, FloatArray],
    turn_rad: dict[str, FloatArray],
) -> None:
    """Add the ``offsets`` for trunk and neck to the angles of their joints (in place, by joint), within the joints'
    ranges.
    """
    torso, head, bell = offsets.get("torso"), offsets.get("head"), offsets.get("bell")
    for shares, own, part in ((TRUNK_SHARES, torso, "trunk"), (NECK_SHARES, head, "neck")):
        if own is None and bell is None:
            continue
        zero = np.zeros(len(next(iter(forward_rad.values()))))
        up, left, roll = (zero, zero, zero) if own is None else (own.up, own.left, own.roll)
        if bell is not None:
            up, left = up + BELL_UP[part] * bell.up, left + BELL_LEFT[part] * bell.left
        for joint, share in shares.items():
            limits = body.limits[joint]
            for angles, offset, limit in (
                (forward_rad, -up, limits.flexion_deg),
                (turn_rad, left, limits.twist_deg),
                (left_rad, roll, limits.sideways_deg),
            ):
                low, high = np.deg2rad(limit)
                angles[joint] = angles[joint] + within(share * offset, high - angles[joint], angles[joint] - low)
