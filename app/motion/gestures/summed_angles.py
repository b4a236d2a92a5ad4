"""Sums the layers' angles for trunk, neck and pelvis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import TRUNK
from app.motion.curves.curve import Noise
from app.motion.curves.seeded_chance import generator
from app.motion.gestures.body_lag import Leads, Overlapped
from app.motion.gestures.layers import LayerSamples
from app.plan.acting import Acting
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES
from app.plan.parameters import PlayerParameters
from metadata.model import AmplitudeScale, Body, Posture, at_amplitude

RESIDUE_SHARE = 0.6
"""Root mean square of the constant random motion, as a share of the sizes at amplitude 0."""
NOISE_SHARE = 0.30
"""Size of the random motion relative to the planned gestures."""
EYES_LEVEL = 0.5
"""Share of the trunk's sideways lean that neck and head compensate, so that the eyes stay level."""
HIPS_SWAY, HIPS_TURN = 0.4, 0.3
"""Shares of the chest's sideways lean and rotation that the hips take, so that the lean begins in the hips."""
WEIGHT_IN_CHEST = 0.2
"""Share of the hips' roll that the chest takes."""
ACCENT_IN_HIPS = 0.35
"""Motion of the pelvis in an accent, relative to that in a lean."""
BREATHES_WITH_TRUNK = (0.3, 1.0)
"""Range of the share of the trunk's motion in breathing, so that players breathe simultaneously but not identically."""
SHOULDERS_INSTEAD = 0.6
"""Additional rise of the shoulders for a player whose share is lower by one."""
SEATED_ROLL = 0.5
"""Sideways lean of a seated player's pelvis relative to a standing player's; a seated player does not turn
the pelvis.
"""


@dataclass(frozen=True)
class Sizes:
    """Factors that scale a body's motion for one player: amplitude, visible share of each layer, and the player's own
    noise."""

    body: Body
    parameters: PlayerParameters
    player_id: str
    acting: Acting
    posture: Posture

    @property
    def seated(self) -> bool:
        """True for a seated posture."""
        return self.posture.seat_height_shank > 0.0

    def of(self, scale: AmplitudeScale) -> float:
        """Return the size of a motion at the player's amplitude, in the unit of ``scale``."""
        return at_amplitude(scale, self.parameters.amplitude)

    def rad(self, scale: AmplitudeScale) -> float:
        """Size at the player's amplitude, converted from degrees to radians."""
        return float(np.deg2rad(self.of(scale)))

    @property
    def aslant(self) -> float:
        """Direction of the player's diagonal weight shifts: 1 if the hips move forward with the weight on the left
        foot, -1 if backward.
        """
        return 1.0 if _own(self.player_id, self.parameters.seed, "aslant") < 0.5 else -1.0

    @property
    def breathing(self) -> tuple[float, float]:
        """Return the player's shares of breathing with the trunk and with the shoulders."""
        low, high = BREATHES_WITH_TRUNK
        share = low + (high - low) * _own(self.player_id, self.parameters.seed, "breathes")
        return share, 1.0 + SHOULDERS_INSTEAD * (0.5 * (low + high) - share)

    def wander(self, layer: str, scale: AmplitudeScale, times_s: FloatArray, shown: FloatArray | float) -> FloatArray:
        """Slow noise (N,) in degrees for one layer of a player's motion: a part that is always present, plus a part in
        proportion to ``shown``.
        """
        noise = _noise(self.player_id, self.parameters.seed, layer, self.body.sway.residual_hz)
        size = NOISE_SHARE * (self.of(scale) - scale[0])
        wandering: FloatArray = noise.sample(times_s) * (RESIDUE_SHARE * scale[0] + shown * size)
        return wandering


@lru_cache(maxsize=4096)
def _noise(player_id: str, seed: int, layer: str, low_hz: float) -> Noise:
    return Noise.of(generator(player_id, seed, layer), 0.4 * low_hz, 2.5 * low_hz)


@lru_cache(maxsize=4096)
def _own(player_id: str, seed: int, what: str) -> float:
    return float(generator(player_id, seed, what).random())


@dataclass
class Sum:
    """Running sums of the angles of trunk and neck, by joint: bend forward, lean to the left, turn to the left."""

    frames: int
    angles: tuple[dict[str, FloatArray], dict[str, FloatArray], dict[str, FloatArray]] = field(
        default_factory=lambda: ({}, {}, {})
    )

    def forward(self, shares: Mapping[str, float], values: FloatArray | float) -> None:
        """Add a forward bend ``values`` (F,) in radians, distributed over joints by ``shares``."""
        self._add(0, shares, values)

    def left(self, shares: Mapping[str, float], values: FloatArray | float) -> None:
        """Add a lean to the left ``values`` (F,) in radians, distributed over joints by ``shares``."""
        self._add(1, shares, values)

    def turn(self, shares: Mapping[str, float], values: FloatArray | float) -> None:
        """Add a turn to the left ``values`` (F,) in radians, distributed over joints by ``shares``."""
        self._add(2, shares, values)

    def all(self) -> tuple[dict[str, FloatArray], dict[str, FloatArray], dict[str, FloatArray]]:
        """Return three dicts of the angles (F,) in radians by joint of the trunk and neck: bend forward, lean to the
        left, turn to the left.
        """
        nothing = np.zeros(self.frames)
        forward, left, turn = ({joint: one.get(joint, nothing) for joint in TRUNK} for one in self.angles)
        return forward, left, turn

    def _add(self, angle: int, shares: Mapping[str, float], values: FloatArray | float) -> None:
        joints = self.angles[angle]
        for joint, share in shares.items():
            joints[joint] = joints.get(joint, 0.0) + np.multiply(share, values)


@dataclass(frozen=True)
class Angles:
    """Sums of a player's delayed motions, as world angles of hips, chest, head and elbows.

    Attributes
    ----------
    side, twist, bowed : Overlapped
        Lean to the left, turn to the left, and forward.
    pelvis : (F,) float64
        Forward tilt of the pelvis.
    roll : Overlapped
        Roll of the hips to the left with the weight.
    seated : bool
        Whether the player is seated.
    """

    side: Overlapped
    twist: Overlapped
    bowed: Overlapped
    pelvis: FloatArray
    roll: Overlapped
    seated: bool

    @classmethod
    def of(cls, levels: LayerSamples, sizes: Sizes, times_s: FloatArray, wandering: FloatArray | float) -> Angles:
        """Compute the summed angles of the layers in the player's sizes; ``wandering`` is the share of
        random motion.
        """
        swings, phrase, acting, rad, seated = sizes.body.sway, sizes.body.phrase, sizes.acting, sizes.rad, sizes.seated
        at = Leads.of(sizes.body.overlap).at(times_s)
        share = phrase.seated_share if seated else 1.0

        def waving(layer: str, scale: AmplitudeScale, size: float) -> Overlapped:
            return Overlapped(
                *(
                    size * level + np.deg2rad(sizes.wander(layer, scale, moment, wandering))
                    for level, moment in zip(levels.sway, at, strict=True)
                )
            )

        chest = (share * acting.phrase * rad(phrase.lean_deg), share * acting.phrase * rad(phrase.accent_deg))
        head = (share * acting.phrase * rad(phrase.head_deg), share * acting.phrase * rad(phrase.accent_head_deg))
        pelvis = (phrase.seated_pelvis if seated else 1.0) * rad(phrase.pelvis_deg)
        bowed = [
            leant * own[0]
            + dipped * own[1]
            + np.deg2rad(sizes.wander("forward", swings.forward_deg, moment, wandering))
            for leant, dipped, own, moment in zip(
                levels.lean, levels.accent, (chest, chest, head, chest), at, strict=True
            )
        ]
        return cls(
            side=waving("side", swings.side_deg, acting.sway * rad(swings.side_deg)),
            twist=waving("turn", swings.turn_deg, -acting.sway * rad(swings.turn_deg)),
            bowed=Overlapped(*bowed),
            pelvis=pelvis * (acting.phrase * levels.lean.hips + ACCENT_IN_HIPS * acting.phrase * levels.accent.hips),
            roll=Overlapped(
                *(acting.weight_shift * rad(sizes.body.weight_shift.roll_deg) * part for part in levels.weight)
            ),
            seated=seated,
        )

    @property
    def hips_roll_rad(self) -> FloatArray:
        """Roll (F,) of the hips to the left in radians, including their part in the sway; less when seated."""
        share = SEATED_ROLL if self.seated else 1.0
        rolled: FloatArray = share * (self.roll.hips + HIPS_SWAY * self.side.hips)
        return rolled

    @property
    def hips_turn_rad(self) -> FloatArray:
        """Turn (F,) of the hips to the left in radians; 0 when seated."""
        turned: FloatArray = (0.0 if self.seated else HIPS_TURN) * self.twist.hips
        return turned

    def add_to(self, total: Sum) -> None:
        """Add to the joints of trunk and neck in ``total`` the angles that give chest and head these world angles."""
        total.forward(TRUNK_SHARES, self.bowed.chest - self.pelvis)
        total.forward(NECK_SHARES, self.bowed.head - self.bowed.chest)
        total.left(TRUNK_SHARES, self.side.chest + WEIGHT_IN_CHEST * self.roll.chest - self.hips_roll_rad)
        chest, head = (side + WEIGHT_IN_CHEST * roll for side, roll in zip(self.side[1:3], self.roll[1:3], strict=True))
        total.left(NECK_SHARES, (1.0 - EYES_LEVEL) * head - chest)
        total.turn(TRUNK_SHARES, self.twist.chest - self.hips_turn_rad)
        total.turn(NECK_SHARES, self.twist.head - self.twist.chest)

    def elbows_late(self) -> dict[str, FloatArray]:
        """Return the angles (F,) in radians by which the elbows lag behind the chest, as ``forward``, ``turn`` and
        ``left``.
        """
        angles = {"forward": self.bowed, "turn": self.twist, "left": self.side}
        return {name: angle.elbows - angle.chest for name, angle in angles.items()}
