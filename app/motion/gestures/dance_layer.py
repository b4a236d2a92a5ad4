"""A learned dance as a layer of a player's body: hips, trunk and head around the player's place.

The layer is added to the others before contacts are solved, so the instrument follows the head, and hands stay on it.
Feet have separate moves (`app.motion.gestures.danced_feet`). While the instrument is played the head follows the chest,
so that wrists bend no further than without a dance; while it is lowered the head dances independently. Angles are
limited where the layer is made (`app.choreography.body_layer`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.curves.curve import Envelopes
from app.motion.gestures.danced_feet import GROWTH, DancedFeet, within_range
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES
from app.plan.model import BreathEvent
from metadata.model import Body

CHANNELS: Final = (
    "side_m",
    "ahead_m",
    "up_m",
    *(f"{part}_{angle}_rad" for part in ("hips", "trunk", "head") for angle in ("forward", "turn", "left")),
)
"""Channels of a layer: place of the hips (to the left, ahead, up), and the angles by which hips, chest and head lean
forward, turn to the left and lean to the left, all three seen from the floor."""
SINKS_M: Final = 0.017
"""Distance in metres by which the bent knees of a dancer lower the hips; their vertical motion about this height is
smaller.
"""
BREATH_ROOM: Final = 0.9
"""Reduction of the nodding of hips and trunk while the player breathes in: the breath has to be seen."""
BREATH_TURN_ROOM: Final = 0.6
"""Reduction of turning and leaning aside while the player breathes in."""
BREATH_EASE_S: Final = 0.35
"""Seconds before and after a breath in which these reductions take effect and end."""
LEGS_EASE_M: Final = 0.016
"""Difference in metres of the legs' reaches over which the limit changes smoothly from one leg to the other when the
hips roll.
"""


@dataclass(frozen=True, eq=False)
class BodyLayer:
    """Motion of a dance to be added to a body.

    Attributes
    ----------
    start_s, step_s : float
        Sample k is at ``start_s + k * step_s``.
    values : (K, 12) float64
        Values in the order of `CHANNELS`; at least two samples.
    feet : DancedFeet
        Foot movements of the dance.
    """

    start_s: float
    step_s: float
    values: FloatArray
    feet: DancedFeet = field(default_factory=DancedFeet.none)

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Values (F, 12) of the twelve channels at any times, smoothly interpolated; the first and last sample extend
        outwards.
        """
        last = len(self.values) - 1
        place = np.clip((times_s - self.start_s) / self.step_s, 0.0, float(last))
        at = np.minimum(place.astype(np.int64), last - 1)
        u = (place - at)[:, None]
        before, low = self.values[np.maximum(at - 1, 0)], self.values[at]
        high, after = self.values[at + 1], self.values[np.minimum(at + 2, last)]
        slope_low, slope_high = 0.5 * (high - before), 0.5 * (after - low)
        way = high - low
        cubic = slope_low + slope_high - 2.0 * way
        result: FloatArray = low + u * (slope_low + u * (way - slope_low - cubic + u * cubic))
        return result


_NODS: Final = [CHANNELS.index(f"{part}_forward_rad") for part in ("hips", "trunk")]
_TURNS: Final = [CHANNELS.index(f"{part}_{angle}_rad") for part in ("hips", "trunk") for angle in ("turn", "left")]


def breath_envelopes(breaths: Sequence[BreathEvent]) -> Envelopes:
    """Return the degree over time, 0..1, to which a dance is reduced for breaths."""
    drawn = [breath for breath in breaths if breath.draws_air]
    return Envelopes.of(
        [
            (breath.start_s - BREATH_EASE_S, breath.start_s, breath.end_s, breath.end_s + BREATH_EASE_S, BREATH_ROOM)
            for breath in drawn
        ]
    )


def giving_way(dance: FloatArray, to_breath: FloatArray) -> FloatArray:
    """Return a dance (F, 12) of twelve channels reduced during breaths by shares (F,) 0..1."""
    given = dance.copy()
    given[:, _NODS] *= (1.0 - to_breath)[:, None]
    given[:, _TURNS] *= _turned_less(to_breath)[:, None]
    return given


def leaning_less(danced: Mapping[str, FloatArray], to_breath: FloatArray) -> dict[str, FloatArray]:
    """Reduce hips and trunk in samples of dancing feet (`DancedFeet.sample`) during breaths, as in `giving_way`."""
    less = {"leans": danced["leans"] * _turned_less(to_breath)} if "leans" in danced else {}
    return {**danced, **less}


def _turned_less(to_breath: FloatArray) -> FloatArray:
    return np.asarray(1.0 - BREATH_TURN_ROOM / BREATH_ROOM * to_breath)


def with_dance(motion: BodyMotion, dance: FloatArray, amount: float, body: Body, *, legs: bool) -> BodyMotion:
    """Add a dance to the body.

    Parameters
    ----------
    motion : BodyMotion
        Motion with (F,) frames.
    dance : (F, 12) float64
        Values of a `BodyLayer`.
    amount : float
        Factor of the dance; 1: unchanged.
    body : Body
        Body with the ranges of its joints.
    legs : bool
        False: the hips do not move from their place.
    """
    sizes = np.array([amount if name.endswith("forward_rad") else amount**GROWTH for name in CHANNELS])
    of = dict(zip(CHANNELS, (sizes * dance).T, strict=True))
    angles = {"forward": dict(motion.forward_rad), "turn": dict(motion.turn_rad), "left": dict(motion.left_rad)}
    for angle, joints in angles.items():
        hips = of[f"hips_{angle}_rad"] if legs else np.zeros(len(dance))
        trunk = of[f"trunk_{angle}_rad"]
        apart = motion.lowered * (of[f"head_{angle}_rad"] - trunk)
        for shares, offset in ((TRUNK_SHARES, trunk - hips), (NECK_SHARES, apart)):
            for joint, share in shares.items():
                limits = body.limits[joint]
                limit_deg = {"forward": limits.flexion_deg, "turn": limits.twist_deg, "left": limits.sideways_deg}
                joints[joint] = within_range(joints[joint], share * offset, limit_deg[angle])
    moved = replace(
        motion,
        forward_rad=angles["forward"],
        turn_rad=angles["turn"],
        left_rad=angles["left"],
    )
    if not legs:
        return moved
    return replace(
        moved,
        hips_side_m=motion.hips_side_m + of["side_m"],
        hips_bob_m=motion.hips_bob_m + amount**GROWTH * SINKS_M - of["up_m"],
        hips_roll_rad=motion.hips_roll_rad + of["hips_left_rad"],
        hips_turn_rad=motion.hips_turn_rad + of["hips_turn_rad"],
        hips_danced={
            "ahead_m": of["ahead_m"],
            "forward_rad": of["hips_forward_rad"],
            "ease_m": np.full(len(dance), amount**GROWTH * LEGS_EASE_M),
        },
    )
