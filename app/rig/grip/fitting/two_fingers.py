"""Giving way of a hand for two fingers at once, where the single offsets are not right for both.

The leans of single fingers (`app.rig.grip.fitting.leaning_hand`) are added. Where a finger then misses its place the
wrist is solved again for the two, with the poses that `app.rig.grip.finger_poses` makes, and the difference is kept.
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
"""Miss of one of the two fingers, or of one at home, beyond which the wrist is solved again; see `WORTH_M`."""
WORTH_M = 0.0005
"""Gain from which the new wrist is kept."""
PLACE_M, HOME_M, WHOLE_M = 0.0004, 0.0006, 0.001
"""Exactness with which the two fingers, the others at home, and palm and web keep their places."""
MOVED_M, TURNED_RAD = 0.006, 0.10
"""Spread of the wrist and its turn about where the single leans have them."""
STEP = 1e-4
ROUNDS = 25


@dataclass(frozen=True, eq=False)
class _Pair:
    """A hand with two of its fingers at other stations than home; the parameters (6,) are the wrist's place in 0.1 m
    and its turn, on top of its leans."""

    hand: HandHold
    stations: dict[str, int]
    whole_m: FloatArray

    @property
    def tables(self) -> list[FingerTable]:
        """Tables of the fingers that touch something."""
        return [table for table in self.hand.fingers if table.stations and table.stations[0].tip_joint >= 0]

    def wrist(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Places (B, 3) and turns (B, 4) of the wrist for parameters (B, 6)."""
        ones = np.ones(len(x))
        given = [(one, ones) for one in self.hand.leans if self.stations.items() >= set(one.places)]
        extra = [(WristOffset("", 0, np.eye(6)[k, :3] * METRES, np.eye(6)[k, 3:]), x[:, k]) for k in range(6)]
        return wrist_given(self.hand, [*given, *extra])

    def missed_m(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far (B, fingers, 3) fingers, and (B, N, 3) palm and web, are from their places."""
        wrist = self.wrist(x)
        fingers = [_missed(self.hand, table, self.stations.get(table.finger, 0), wrist) for table in self.tables]
        home_m, home = wrist_given(self.hand, [])
        local = quaternion.rotate(quaternion.conjugate(home), self.whole_m - home_m)
        whole = wrist[0][:, None] + quaternion.rotate(wrist[1][:, None], local[None]) - self.whole_m
        return np.stack(fingers, axis=1), whole

    def residuals(self, x: FloatArray) -> FloatArray:
        """(B, m)."""
        fingers, whole = self.missed_m(x)
        spread = np.array([PLACE_M if table.finger in self.stations else HOME_M for table in self.tables])
        parts = [fingers / spread[:, None], whole / WHOLE_M]
        gone = np.concatenate([x[:, :3] * METRES / MOVED_M, x[:, 3:] / TURNED_RAD], axis=1)
        return np.concatenate([*(part.reshape(len(x), -1) for part in parts), gone], axis=1)

    def worst_m(self, x: FloatArray) -> float:
        """The farthest that one of the fingers is from its place."""
        return float(np.linalg.norm(self.missed_m(x[None])[0], axis=2).max())

    def solved(self) -> FloatArray:
        """The parameters: damped Gauss-Newton from the single leans."""
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
    """Offsets by which a hand must give way more for two fingers at once than for each of them.

    Parameters
    ----------
    hand : HandHold
        With the leans of single fingers.
    whole_m : (N, 3) float64
        Where palm and web touch, in the instrument's frame.
    together : sequence of pairs of (finger, station)
        What is asked for at once (`app.rig.grip.finger_stations.asked_together`).
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
    """Return how far (B, 3) a finger is from its place, in the instrument's frame, with what it works there fully
    worked."""
    station = table.stations[index]
    own = wrist_given(hand, [(one, np.ones(1)) for one in hand.leans if one.places == ((table.finger, index),)])
    requested = own[0] + quaternion.rotate(own[1], tip_m(table, station, station.rotations[-1:]))
    rotations = np.repeat(station.rotations[-1:], len(wrist[0]), axis=0)
    there = solved_pose(with_wrist(table, station, rotations, own, wrist))
    return wrist[0] + quaternion.rotate(wrist[1], tip_m(table, station, there)) - requested
