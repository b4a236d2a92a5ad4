"""Feet of a dancing player: steps in place, heels and toes, each landing on its beat.

A foot stays where it was put down; to leave, the heel rises first and the ball last, and it lands on the ball. Where
hips may not leave their place, feet only lift heels and toes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Final, Literal, NamedTuple, get_args

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.motion.body_motion import BodyMotion
from app.motion.by_hand.pose_corrections import within
from app.motion.curves.curve import minimum_jerk, rows_changed_s
from app.plan.by_hand.pose_corrections import TRUNK_SHARES
from app.plan.kinds import answered_by
from app.plan.model import GestureEvent
from metadata.model import Body

MoveKind = Literal["step", "heel", "toes"]
MOVE_KINDS: Final[tuple[MoveKind, ...]] = get_args(MoveKind)

LIFT_M: Final = 0.08
"""Height in metres of the ball of the foot in the middle of the largest step."""
HEEL_RAD: Final = float(np.deg2rad(24.0))
"""Angle in radians of the sole with the heel raised in the largest step or heel lift."""
TOES_RAD: Final = float(np.deg2rad(14.0))
"""Angle in radians of raised toes of a player who stands."""
RISES_M: Final = 0.015
BACK_M: Final = 0.03
"""Distances in metres by which the hips rise, as far as the knees are bent, and go back while toes are raised: the
ankle needs the room.
"""
TAP_LEANS: Final = 0.25
"""Turn and lean of hips and trunk while toes are raised, relative to other moves."""
SEATED_TOES_RAD: Final = float(np.deg2rad(17.0))
"""Angle in radians of raised toes of a player whose feet keep their place."""
SEATED_HEEL_RAD: Final = float(np.deg2rad(8.5))
"""Angle in radians of a raised heel of a player whose feet keep their place, since instruments lie on thighs."""
EASED_RAD: Final = float(np.deg2rad(14.0))
"""Angle in radians of the rear foot's heel while the other foot takes the weight, since the ankle bends no farther."""
EASED_S: Final = (0.22, 0.13, 0.35)
"""Seconds of that motion from its beginning to the beat, from the beat to its maximum, and from there to its end."""
PEELS_S: Final = 0.12
"""Seconds between the heel and the ball leaving the ground, and between the ball and the heel landing."""
PEELED: Final = 0.35
"""Share of a step in which the heel rises, and in which it sinks."""
OVER_M: Final = 0.08
"""Distance in metres of the hips' motion over the foot that carries the weight."""
OVER_S: Final = 0.3
"""Seconds in which the weight shifts there, and back."""
ROLL_RAD, TURN_RAD = float(np.deg2rad(8.0)), float(np.deg2rad(8.0))
"""Angles in radians by which the hips are lower and farther forward on the side of the foot without weight."""
LEAN_RAD, COUNTER_RAD = float(np.deg2rad(5.0)), float(np.deg2rad(6.0))
"""Lean of the chest towards the foot that carries the weight, and its rotation against that of the hips, in radians."""
SPREAD_M: Final = 0.24
MOST_ROLL_RAD: Final = float(np.deg2rad(11.5))
"""Greatest sideways distance of the hips in metres beyond that of standing, and greatest roll in radians; more would
spread a thigh too far.
"""
LIGHT: Final = 0.6
"""Share of the weight that leaves a foot whose heel or toes are raised."""
SINKS_M: Final = 0.034
"""Distance in metres by which the hips sink when a foot takes the weight on a beat."""
SINK_S: Final = (0.1, 0.32)
"""Seconds from the beginning of that motion to the beat, and from the beat to its end."""
FOLLOWS: Final = 0.4
"""Share of each foot's displacement that the hips follow."""
IN_HIPS: Final = ("over", "sunk", "leans", "risen")
"""Samples that move the hips instead of the feet."""
CLEAR_S: Final = 0.3
"""Seconds for which the feet stand before and after the user's own foot gestures."""
GROWTH: Final = 0.3
"""Exponent of the amount for the motion of the feet, so that half the amount still shows in them."""


class _Moves(NamedTuple):
    """Moves of one foot of a dancer in order of time, as parallel arrays: kind, start, landing, size and so on."""

    kinds: IntArray
    start_s: FloatArray
    lands_s: FloatArray
    size: FloatArray
    seated: IntArray
    from_m: FloatArray
    to_m: FloatArray


@dataclass(frozen=True, eq=False)
class DancedFeet:
    """All foot movements of a dancing player: one row for each, ordered by landing.

    Attributes
    ----------
    sides : (N,) int64
        0: left foot, 1: right foot.
    kinds, seated : (N,) int64
        Index in `MOVE_KINDS`; ``seated`` applies to a player whose feet stay in place.
    start_s, lands_s : (N,) float64
        A step is in the air between them; heel or toes rise and come down between them. Landings are on beats.
    size : (N,) float64
        0..1.
    place_m : (N, 2) float64
        Target of a step, to the left and ahead of the foot's place without a dance.
    """

    sides: IntArray
    kinds: IntArray
    seated: IntArray
    start_s: FloatArray
    lands_s: FloatArray
    size: FloatArray
    place_m: FloatArray

    @classmethod
    def none(cls) -> DancedFeet:
        """Return the foot movements of a player who does not dance: both feet stand."""
        whole, real = np.zeros(0, np.int64), np.zeros(0)
        return cls(whole, whole, whole, real, real, real, np.zeros((0, 2)))

    def __len__(self) -> int:
        return len(self.sides)

    def sample(self, times_s: FloatArray, *, steps: bool) -> dict[str, FloatArray]:
        """Sample the feet at ascending times; parts at rest are omitted.

        ``left_heel`` and ``left_toes`` (radians), ``left_up``, ``left_ahead`` and ``left_aside`` (metres, to the left)
        are parts of a foot; ``over`` is the weight on the left foot, -1..1, ``leans`` the turn and lean of hips and
        trunk with it, ``sunk`` the bend of the knees, 0..1, ``risen`` their straightening. Without ``steps`` feet stay
        in place.
        """
        found: dict[str, FloatArray] = {}
        if not len(times_s) or not len(self):
            return found
        for side, (name, other) in enumerate((("left", "right"), ("right", "left"))):
            moves = self._of(side)
            if steps:
                _put(found, name, moves, times_s)
            taps_s = self.start_s[(self.sides != side) & (self.kinds == MOVE_KINDS.index("toes"))]
            late_s = max(PEELS_S, OVER_S, *SINK_S, EASED_S[1] + EASED_S[2])
            near = (moves.start_s - late_s <= times_s[-1]) & (moves.lands_s + late_s >= times_s[0])
            for row in np.flatnonzero(near).tolist():
                kind = MOVE_KINDS[int((moves.kinds if steps else moves.seated)[row])]
                span_s, size = (float(moves.start_s[row]), float(moves.lands_s[row])), float(moves.size[row])
                heel_rad, toes_rad = (HEEL_RAD, TOES_RAD) if steps else (SEATED_HEEL_RAD, SEATED_TOES_RAD)
                if kind == "step":
                    _add(found, f"{name}_up", size * LIFT_M * _air(times_s, span_s))
                    _add(found, f"{name}_heel", size * heel_rad * _peeled(times_s, span_s))
                    if not np.any((taps_s >= span_s[1]) & (taps_s < span_s[1] + EASED_S[1] + EASED_S[2])):
                        _add(found, f"{other}_heel", size * EASED_RAD * _eased(times_s, span_s[1]))
                elif kind == "heel":
                    _add(found, f"{name}_heel", size * heel_rad * _lifted(times_s, span_s))
                else:
                    up = _lifted(times_s, span_s)
                    _add(found, f"{name}_toes", size * toes_rad * up)
                    _add(found, "risen", size * up)
                over = (2.0 * side - 1.0) * (1.0 if kind == "step" else LIGHT)
                weight = size * over * _bump(times_s, span_s[0] - OVER_S, *span_s, OVER_S)
                _add(found, "over", weight)
                # The leg of raised toes is stretched, so that its hip stays higher.
                _add(found, "leans", (TAP_LEANS if kind == "toes" and steps else 1.0) * weight)
                _add(found, "sunk", size * _sunk(times_s, span_s[1]))
        return {name: values for name, values in found.items() if np.any(values)}

    def lifted_s(self, side: Literal["left", "right"]) -> list[tuple[float, float]]:
        """Spans in which a foot, or part of it, is off the ground."""
        foot = ("left", "right").index(side)
        own, steps = self._of(foot), (self.sides != foot) & (self.kinds == MOVE_KINDS.index("step"))
        eased = [(lands_s - EASED_S[0], lands_s + EASED_S[1] + EASED_S[2]) for lands_s in self.lands_s[steps].tolist()]
        return [(start_s - PEELS_S, lands_s + PEELS_S) for start_s, lands_s in zip(*own[1:3], strict=True)] + eased

    def steps_before(self, side: Literal["left", "right"], times_s: FloatArray) -> IntArray:
        """Number of steps (N,) that a foot has completed before each time."""
        steps = (self.sides == ("left", "right").index(side)) & (self.kinds == MOVE_KINDS.index("step"))
        return np.searchsorted(self.lands_s[steps], times_s, side="right")

    def changed_s(self, other: DancedFeet) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both dances have equal feet."""
        if self is other:
            return np.zeros((0, 2))
        (mine, mine_s), (theirs, theirs_s) = self._rows(), other._rows()
        return rows_changed_s(mine, theirs, mine_s, theirs_s)

    def giving_way(self, gestures: Iterable[GestureEvent]) -> DancedFeet:
        """Return the moves without those close to foot gestures that the animator corrected by hand."""
        kinds = answered_by("feet")
        spans = [(event.start_s, event.end_s) for event in gestures if event.corrected and event.kind in kinds]
        if not spans or not len(self):
            return self
        begin_s, end_s = np.array(spans).T[:, None]
        busy = (self.start_s[:, None] < end_s + CLEAR_S) & (self.lands_s[:, None] > begin_s - CLEAR_S)
        return self._chosen(~busy.any(axis=1))

    def _chosen(self, kept: BoolArray) -> DancedFeet:
        return replace(self, **{one.name: getattr(self, one.name)[kept] for one in fields(self)})

    def _of(self, side: int) -> _Moves:
        own = self._chosen(self.sides == side)
        steps = np.flatnonzero(own.kinds == MOVE_KINDS.index("step"))
        before = np.searchsorted(steps, np.arange(len(own)))
        places_m = np.concatenate([np.zeros((1, 2)), own.place_m[steps]])
        after = np.searchsorted(steps, np.arange(len(own)), side="right")
        return _Moves(own.kinds, own.start_s, own.lands_s, own.size, own.seated, places_m[before], places_m[after])

    def _rows(self) -> tuple[FloatArray, FloatArray]:
        """Describe the N moves as rows (N, C) of numbers, for comparing two dances, and the spans (N, 2) in seconds of
        their effect; the effect of a step lasts until the foot lands elsewhere.
        """
        rows, spans_s = list[FloatArray](), list[FloatArray]()
        for side in range(2):
            own = self._of(side)
            until_s = np.append(own.lands_s[1:], np.inf) if len(own.kinds) else own.lands_s
            rows.append(np.column_stack([np.full(len(own.kinds), side), *own]))
            spans_s.append(
                np.column_stack(
                    [
                        # A tap also decides about the heel in the other foot's step before it.
                        own.start_s - max(OVER_S, sum(EASED_S)),
                        np.maximum(until_s, own.lands_s + max(OVER_S, SINK_S[1], EASED_S[1] + EASED_S[2])),
                    ]
                )
            )
        return np.concatenate(rows), np.concatenate(spans_s)


def with_danced(
    moved: Mapping[str, FloatArray], danced: Mapping[str, FloatArray], amount: float
) -> dict[str, FloatArray]:
    """Combine generated foot movements (`app.motion.gestures.feet.feet_moved`) with those of a dance, which are scaled
    by ``amount``; by name of the movement.
    """
    feet, size = dict(moved), amount**GROWTH
    for name, values in danced.items():
        if name not in IN_HIPS:
            feet[name] = feet[name] + size * values if name in feet else size * values
    return feet


def with_danced_feet(
    motion: BodyMotion, danced: Mapping[str, FloatArray], amount: float, body: Body, *, steps: bool
) -> BodyMotion:
    """Add dancing feet to a body's motion.

    Parameters
    ----------
    danced : dict of str to (F,) float64
        Values from `DancedFeet.sample`.
    amount : float
        0..1.
    body : Body
        Body with the ranges of its joints.
    """
    if not danced or amount <= 0.0:
        return motion
    size, feet = amount**GROWTH, with_danced(motion.feet, danced, amount)
    nothing = np.zeros(len(motion.hips_side_m))
    over, sunk, leans, risen = (size * danced.get(name, nothing) for name in IN_HIPS)
    roll_rad, turn_rad = (ROLL_RAD * leans, TURN_RAD * leans) if steps else (nothing, nothing)
    left_rad, turned_rad = dict(motion.left_rad), dict(motion.turn_rad)
    for joint, share in TRUNK_SHARES.items():
        limits = body.limits[joint]
        left_rad[joint] = within_range(left_rad[joint], share * (LEAN_RAD * leans + roll_rad), limits.sideways_deg)
        turned_rad[joint] = within_range(turned_rad[joint], -share * (COUNTER_RAD * leans + turn_rad), limits.twist_deg)
    motion = replace(motion, feet=feet, left_rad=left_rad, turn_rad=turned_rad)
    if not steps:
        return motion
    aside_m, ahead_m = (
        FOLLOWS * size * (danced.get(f"left_{way}", nothing) + danced.get(f"right_{way}", nothing))
        for way in ("aside", "ahead")
    )
    left_m, right_m = (size * danced.get(f"{side}_aside", nothing) for side in ("left", "right"))
    side_m = motion.hips_side_m + aside_m + OVER_M * over
    bob_m = motion.hips_bob_m + SINKS_M * sunk
    return replace(
        motion,
        hips_side_m=within(side_m, SPREAD_M + right_m, SPREAD_M - left_m),
        hips_ahead_m=motion.hips_ahead_m + ahead_m - BACK_M * risen,
        hips_bob_m=bob_m - within(RISES_M * risen, np.maximum(bob_m, 0.0), nothing),
        hips_roll_rad=within(motion.hips_roll_rad - roll_rad, MOST_ROLL_RAD, MOST_ROLL_RAD),
        hips_turn_rad=motion.hips_turn_rad + turn_rad,
    )


def within_range(angle_rad: FloatArray, further_rad: FloatArray, range_deg: tuple[float, float]) -> FloatArray:
    """Add ``further_rad`` to an angle (F,), with the sum softly limited to the joint's range."""
    low, high = np.deg2rad(range_deg)
    return np.asarray(angle_rad + within(further_rad, high - angle_rad, angle_rad - low))


def _put(found: dict[str, FloatArray], name: str, moves: _Moves, times_s: FloatArray) -> None:
    """Add to ``found`` the position of a foot at ascending times: where it landed last, or on the way to the next
    landing."""
    if not len(moves.kinds):
        return
    begun = np.searchsorted(moves.start_s, times_s, side="right")
    row = np.maximum(begun - 1, 0)
    lasts_s = moves.lands_s[row] - moves.start_s[row]
    share = minimum_jerk(np.clip((times_s - moves.start_s[row]) / lasts_s, 0.0, 1.0))
    stays = np.all(moves.from_m[row] == moves.to_m[row], axis=1)
    for axis, way in enumerate(("aside", "ahead")):
        low, high = moves.from_m[row, axis], moves.to_m[row, axis]
        # A standing foot keeps its exact position.
        there = np.where(stays | (share >= 1.0), high, low + share * (high - low))
        found[f"{name}_{way}"] = np.where(begun > 0, there, moves.from_m[0, axis])


def _add(found: dict[str, FloatArray], name: str, values: FloatArray) -> None:
    # Adding to 0 keeps the sign of zero independent of moves before the span.
    found[name] = found.get(name, np.zeros(len(values))) + values


def _air(times_s: FloatArray, span_s: tuple[float, float]) -> FloatArray:
    """Return the height (N,), 0..1, of a stepping foot: 0 on the ground, 1 half way."""
    phase = np.clip((times_s - span_s[0]) / (span_s[1] - span_s[0]), 0.0, 1.0)
    height: FloatArray = np.where((phase > 0.0) & (phase < 1.0), np.sin(np.pi * phase) ** 2, 0.0)
    return height


def _peeled(times_s: FloatArray, span_s: tuple[float, float]) -> FloatArray:
    """Return the height (N,), 0..1, of a stepping foot's heel above its ball: it rises before the ball leaves the
    floor, and sinks after it has landed."""
    part_s = PEELED * (span_s[1] - span_s[0])
    return _bump(times_s, span_s[0] - PEELS_S, span_s[0] + part_s, span_s[1] - part_s, PEELS_S + part_s)


def _lifted(times_s: FloatArray, span_s: tuple[float, float]) -> FloatArray:
    """Return the lift (N,), 0..1, of heel or toes in a tap: slow rise, faster fall to the landing."""
    start_s, lands_s = span_s
    falls_s = 0.42 * (lands_s - start_s)
    return _bump(times_s, start_s, lands_s - falls_s, lands_s - falls_s, falls_s)


def _bump(times_s: FloatArray, rises_s: float, up_s: float, falls_s: float, lasts_s: float) -> FloatArray:
    """Smooth bump (N,) at given times: 0 before ``rises_s``, 1 from ``up_s`` to ``falls_s``, 0 again
    ``lasts_s`` later.
    """
    up = minimum_jerk(np.clip((times_s - rises_s) / (up_s - rises_s), 0.0, 1.0))
    down = minimum_jerk(np.clip((times_s - falls_s) / lasts_s, 0.0, 1.0))
    return np.asarray(up * (1.0 - down))


def _sunk(times_s: FloatArray, lands_s: float) -> FloatArray:
    """Bend (N,) of the knees, 0..1, that absorbs a landing at ``lands_s``."""
    before_s, after_s = SINK_S
    low_s = lands_s + after_s / 3.0
    return _bump(times_s, lands_s - before_s, low_s, low_s, after_s - after_s / 3.0)


def _eased(times_s: FloatArray, lands_s: float) -> FloatArray:
    """Lift (N,), 0..1, of the heel of the rear foot as the other foot lands at ``lands_s``."""
    before_s, up_s, after_s = EASED_S
    return _bump(times_s, lands_s - before_s, lands_s + up_s, lands_s + up_s, after_s)
