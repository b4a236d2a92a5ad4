"""Wrist offsets for two fingers at the same time, for cases in which the sum of the single offsets does not suit both.

Offsets of single fingers (`app.rig.grip.fitting.leaning_hand`) are added. If a finger then misses its place, the wrist
is solved again for both with the poses of `app.rig.grip.finger_poses`, and the difference is stored as a further
offset.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.finger_poses import solved_pose, tip_m, with_wrist
from app.rig.grip.fitting.hand_problem import METRES
from app.rig.grip.grip_pose import FingerTable, HandHold, WristOffset, wrist_given

Place: TypeAlias = tuple[str, int]

MISSED_M = 0.0015
"""Distance in metres by which one of the two fingers, or one at home, must miss its place for the wrist to be solved
again; see `WORTH_M`.
"""
WORTH_M = 0.0005
"""Least gain in metres for which the new wrist is used."""
PLACE_M, HOME_M, WHOLE_M = 0.0004, 0.0006, 0.001
"""Tolerances in metres of the two fingers, the others at home, and palm and web."""
MOVED_M, TURNED_RAD = 0.006, 0.10
"""Standard deviations of the wrist's position in metres and its rotation in radians from the sum of the single
offsets.
"""
STEP = 1e-4
ROUNDS = 25


@dataclass(frozen=True, eq=False)
class _Pair:
    """Least-squares problem of a hand with two fingers at stations other than home.

    The six parameters are a shift of the wrist in units of 0.1 m and a rotation vector, added to its single offsets.
    """

    hand: HandHold
    stations: dict[str, int]
    whole_m: FloatArray

    @property
    def tables(self) -> list[FingerTable]:
        """Tables of the fingers that have contacts."""
        return [table for table in self.hand.fingers if table.stations and table.stations[0].tip_joint >= 0]

    def wrist(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return positions (B, 3) and rotations (B, 4) of the wrist for B candidates (B, 6)."""
        ones = np.ones(len(x))
        given = [(one, ones) for one in self.hand.leans if self.stations.items() >= set(one.places)]
        extra = [(WristOffset("", 0, np.eye(6)[k, :3] * METRES, np.eye(6)[k, 3:]), x[:, k]) for k in range(6)]
        return wrist_given(self.hand, [*given, *extra])

    def missed_m(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the vectors in metres from fingers (B, fingers, 3), and from the N touching points of palm and web (B,
        N, 3), to their places.
        """
        wrist = self.wrist(x)
        fingers = [_missed(self.hand, table, self.stations.get(table.finger, 0), wrist) for table in self.tables]
        home_m, home = wrist_given(self.hand, [])
        local = quaternion.rotate(quaternion.conjugate(home), self.whole_m - home_m)
        whole = wrist[0][:, None] + quaternion.rotate(wrist[1][:, None], local[None]) - self.whole_m
        return np.stack(fingers, axis=1), whole

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return for candidates ``x`` (B, 6) the residuals (B, m): distances of fingers from their places, and the
        shift of the hand."""
        fingers, whole = self.missed_m(x)
        spread = np.array([PLACE_M if table.finger in self.stations else HOME_M for table in self.tables])
        parts = [fingers / spread[:, None], whole / WHOLE_M]
        gone = np.concatenate([x[:, :3] * METRES / MOVED_M, x[:, 3:] / TURNED_RAD], axis=1)
        return np.concatenate([*(part.reshape(len(x), -1) for part in parts), gone], axis=1)

    def worst_m(self, x: FloatArray) -> float:
        """Return the greatest distance in metres of a finger from its place."""
        return float(np.linalg.norm(self.missed_m(x[None])[0], axis=2).max())

    def solved(self) -> FloatArray:
        """Return the six parameters of a hand that leans towards two stations, by damped Gauss-Newton."""
        x, damping = np.zeros(6), 1e-2
        cost = float(np.square(self.residuals(x[None])).sum())
        for _ in range(ROUNDS):
            found = self.residuals(np.concatenate([x[None], x + STEP * np.eye(6)]))
            slopes = (found[1:] - found[0]) / STEP
            normal = slopes @ slopes.T
            step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -slopes @ found[0])
            new_cost = float(np.square(self.residuals((x + step)[None])).sum())
            damping = damping * 0.3 if new_cost < cost else damping * 5.0
            if new_cost < cost:
                x, cost = x + step, new_cost
        return x


def leans_beside(
    hand: HandHold, whole_m: FloatArray, together: Sequence[tuple[Place, Place]]
) -> tuple[WristOffset, ...]:
    """Return the additional wrist offsets for pairs of stations that the single offsets do not suit.

    Parameters
    ----------
    hand : HandHold
        Hand with the offsets for single fingers.
    whole_m : (N, 3) float64
        Contact points of palm and web in the instrument's frame.
    together : sequence of pairs of (finger, station)
        Pairs of finger and station needed simultaneously (`app.rig.grip.finger_stations.asked_together`).
    """
    leaning = {place for lean in hand.leans for place in lean.places}
    found = []
    for first, second in together:
        if not first[0].startswith(f"{hand.side}.") or not leaning & {first, second}:
            continue
        pair = _Pair(hand, dict((first, second)), whole_m)
        missed = pair.worst_m(np.zeros(6))
        if missed <= MISSED_M:
            continue
        x = pair.solved()
        if pair.worst_m(x) < missed - WORTH_M:
            found.append(WristOffset(*first, moved_m=x[:3] * METRES, turned=x[3:], beside=(second,)))
    return tuple(found)


def _missed(hand: HandHold, table: FingerTable, index: int, wrist: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Return the vector (B, 3) in the instrument's frame, in metres, by which a finger misses its place for B wrists,
    with its controls fully worked.
    """
    station = table.stations[index]
    own = wrist_given(hand, [(one, np.ones(1)) for one in hand.leans if one.places == ((table.finger, index),)])
    requested = own[0] + quaternion.rotate(own[1], tip_m(table, station, station.rotations[-1:]))
    rotations = np.repeat(station.rotations[-1:], len(wrist[0]), axis=0)
    there = solved_pose(with_wrist(table, station, rotations, own, wrist))
    return wrist[0] + quaternion.rotate(wrist[1], tip_m(table, station, there)) - requested
