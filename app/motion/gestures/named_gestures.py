"""Keyed gestures written by an animator (`metadata.gestures`), as offsets of bell, head, elbows and trunk.

Between keys an angle follows a quintic with the keys' slopes and no acceleration at them; with level keys that is a
minimum-jerk move.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Self, TypeAlias

import numpy as np

from app.arrays import FloatArray
from app.motion.by_hand.pose_corrections import PoseAngles, within
from app.motion.curves.curve import rows_changed_s
from app.plan.by_hand.pose_corrections import ELBOW_DEG, HANDS_FOLLOW_DEG
from app.plan.events_by_hand import PoseTarget
from app.plan.model import GestureEvent
from metadata.gestures import AngleTrack, Gesture
from metadata.model import AmplitudeScale, at_amplitude

Sums: TypeAlias = dict[AmplitudeScale, dict[PoseTarget, FloatArray]]
"""Angles (3, F) in radians (up, left, roll) by part of the body, summed over gestures that scale equally with the
amplitude.
"""
_TURNS = ("up", "left", "roll")


def slopes_of(track: AngleTrack) -> FloatArray:
    """Slope of each key in degrees per length of the gesture: as the key gives it, else level at turning points and
    towards the neighbours elsewhere, without overshoot.
    """
    slopes = _monotone(np.array([key.at for key in track.keys]), np.array([key.deg for key in track.keys]))
    given = np.array([np.nan if key.slope is None else key.slope for key in track.keys])
    return np.where(np.isnan(given), slopes, given)


def _monotone(at: FloatArray, values: FloatArray) -> FloatArray:
    steps = np.diff(values) / np.diff(at)
    slopes = np.zeros(len(at))
    before, after = steps[:-1], steps[1:]
    onwards = before * after > 0.0
    # The harmonic mean (Fritsch and Butland 1984) keeps the curve within the range of its keys.
    slopes[1:-1][onwards] = 2.0 * before[onwards] * after[onwards] / (before + after)[onwards]
    return slopes


def angles_deg(track: AngleTrack, phase: FloatArray) -> FloatArray:
    """Angle (F,) in degrees of a gesture's track at phases (F,) of the gesture; 0 outside 0..1."""
    at = np.array([key.at for key in track.keys])
    return _between(at, np.array([key.deg for key in track.keys]), slopes_of(track), phase)


def keyed(at: FloatArray, values: FloatArray, phase: FloatArray) -> FloatArray:
    """Interpolate key values at phases (N,) with monotone cubics, without overshoot; 0 outside 0..1. ``at`` are the
    keys' phases."""
    return _between(at, values, _monotone(at, values), phase)


def _between(at: FloatArray, values: FloatArray, slopes: FloatArray, phase: FloatArray) -> FloatArray:
    place = np.clip(np.searchsorted(at, phase, side="right") - 1, 0, len(at) - 2)
    length = (at[1:] - at[:-1])[place]
    u = (phase - at[place]) / length
    cubed = u * u * u
    moved = cubed * (10.0 + u * (6.0 * u - 15.0))
    leaving = u + cubed * (-6.0 + u * (8.0 - 3.0 * u))
    arriving = cubed * (-4.0 + u * (7.0 - 3.0 * u))
    first, last = values[place], values[place + 1]
    found = first + (last - first) * moved + length * (slopes[place] * leaving + slopes[place + 1] * arriving)
    inside: FloatArray = np.where((phase > 0.0) & (phase < 1.0), found, 0.0)
    return inside


@dataclass(frozen=True, eq=False)
class KeyedGestures:
    """Keyed gestures of a player.

    Attributes
    ----------
    rows : (N, 4) float64
        Start, end, size, and index in ``gestures``.
    gestures : tuple of Gesture
        Distinct gestures.
    """

    rows: FloatArray
    gestures: tuple[Gesture, ...]

    @classmethod
    def of(cls, events: Sequence[GestureEvent]) -> Self:
        """Collect the keyed gestures among a plan's gesture events, as far as this class handles them."""
        gestures: list[Gesture] = []
        rows = []
        for event in events:
            if event.gesture is None or not cls.takes(event.gesture) or event.end_s <= event.start_s:
                continue
            if event.gesture not in gestures:
                gestures.append(event.gesture)
            rows.append((event.start_s, event.end_s, event.amount, float(gestures.index(event.gesture))))
        return cls(np.array(rows, dtype=np.float64).reshape(-1, 4), tuple(gestures))

    @staticmethod
    def takes(gesture: Gesture) -> bool:
        """Return whether this class handles a gesture; subclasses accept only some."""
        return True

    def done(self, times_s: FloatArray) -> Iterator[tuple[Gesture, float, FloatArray, slice]]:
        """Yield every gesture active at any of the ascending times: the gesture, its amount, its phases 0..1 (K,), and
        the slice of the times in which it is active.
        """
        first = np.searchsorted(times_s, self.rows[:, 0])
        last = np.searchsorted(times_s, self.rows[:, 1])
        for index in np.flatnonzero(last > first).tolist():
            here = slice(first[index], last[index])
            start_s, end_s, amount, number = self.rows[index].tolist()
            yield self.gestures[int(number)], amount, (times_s[here] - start_s) / (end_s - start_s), here

    def changed_s(self, other: Self) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both have equal gestures."""
        if self.gestures != other.gestures:
            return np.concatenate((self.rows[:, :2], other.rows[:, :2]))
        return rows_changed_s(self.rows, other.rows, self.rows[:, :2], other.rows[:, :2])


class Gestured(KeyedGestures):
    """All gestures of a player whose keys move bell, head, elbows or trunk, as offsets of their angles."""

    def sample(self, times_s: FloatArray) -> Sums:
        """Sum of the gestures at ascending times, before scaling by the player's amplitude."""
        # Sums include all gestures for any span, so that the same frames are identical to the bit.
        sums: Sums = {}
        for gesture in self.gestures:
            alike = sums.setdefault(gesture.amplitude, {})
            for track in gesture.tracks:
                alike.setdefault(track.target, np.zeros((3, len(times_s))))
        for gesture, amount, phase, here in self.done(times_s):
            for track in gesture.tracks:
                total = sums[gesture.amplitude][track.target]
                total[_TURNS.index(track.turn), here] += np.deg2rad(amount * angles_deg(track, phase))
        return sums


def with_gestures(
    held: dict[PoseTarget, PoseAngles], gestured: Sums | None, amplitude: float, amount: FloatArray | float
) -> dict[PoseTarget, PoseAngles]:
    """Add gestures to the angles held by pose corrections: scaled by the player's amplitude and amount, and limited to
    the range that the hands can follow.
    """
    if not gestured or not np.any(amount):
        return held
    sums: dict[PoseTarget, FloatArray] = {}
    for scale, targets in sorted(gestured.items()):
        size = np.minimum(amount * at_amplitude(scale, amplitude), scale[2])
        for target, angles in targets.items():
            sums[target] = sums.get(target, 0.0) + size * angles
    both = dict(held)
    for target in sorted(sums):
        there = held.get(target)
        zero = np.zeros(sums[target].shape[1])
        own: tuple[FloatArray, ...] = (zero,) * 3 if there is None else (there.up, there.left, there.roll)
        limits = _limits_rad(target)
        added = [
            angle + (turn if limit is None else within(turn, limit[1] - angle, angle - limit[0]))
            for angle, turn, limit in zip(own, sums[target], limits, strict=True)
        ]
        both[target] = PoseAngles(*(np.asarray(angles) for angles in added))
    return both


def _limits_rad(target: PoseTarget) -> tuple[tuple[float, float] | None, ...]:
    """Range in radians of each angle of a target that the hands can follow; None for angles that the instrument's
    carriage limits already.
    """
    if target in ("left_elbow", "right_elbow"):
        low, high = np.deg2rad(ELBOW_DEG).tolist()
        return (low, high), None, None
    if target not in HANDS_FOLLOW_DEG:
        return None, None, None
    found = [np.deg2rad(HANDS_FOLLOW_DEG[target][f"{turn}_deg"]).tolist() for turn in _TURNS]
    return tuple((low, high) for low, high in found)
