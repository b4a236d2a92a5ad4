"""Individual traits of a player's face: asymmetry, vibrato rate, slow variation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Noise
from app.motion.curves.seeded_chance import generator
from app.motion.curves.spline import Spline
from metadata.face_model import EmbouchureWeights, FaceMotion
from metadata.model import ARKIT_MORPHS

GRID_S: Final = 0.1
LEFT, RIGHT = "Left", "Right"
PAIRS: Final = tuple(
    name.removesuffix(LEFT) for name in ARKIT_MORPHS if name.endswith(LEFT) and not name.startswith("eyeLook")
)
"""Names without side of morphs that exist on both sides, except for those that rotate the eyes."""
STRONGER_SIDE: Final = 0.75
"""Share of the pairs in which the same side is stronger."""
VARIES: Final = 0.012
"""Slow variation of the difference between left and right, relative to its size."""
RATE_VARIES_RAD: Final = 0.8
"""Variation of a vibrato's phase in radians: about 0.3 Hz."""
MOST: Final = 2.5
"""Greatest value of noise, as a multiple of its root mean square."""
_BANDS: Final = {
    # Frequencies (Hz) of the noise, whose root mean square is 1.
    "lips": (0.25, 1.1),
    "corners": (0.12, 0.7),
    "chin": (0.12, 0.8),
    "brows": (0.06, 0.5),
    "lids": (0.08, 0.6),
    "nose": (0.1, 0.7),
    "sides": (0.03, 0.12),
    "rate": (0.15, 0.5),
}


@dataclass(frozen=True, eq=False)
class Wandering:
    """Slow random variation of the parts of a face over F frames: factors (F,) near 1, and ``sides`` (F,) -1..1 for the
    difference of left and right.
    """

    lips: FloatArray
    corners: FloatArray
    chin: FloatArray
    brows: FloatArray
    lids: FloatArray
    nose: FloatArray
    sides: FloatArray
    rate: FloatArray


@dataclass(frozen=True, eq=False)
class OwnFace:
    """Individual traits of a player's face.

    Attributes
    ----------
    left_more : dict of str to float
        Relative excess of the left morph over the right for each pair of `PAIRS`.
    vibrato_hz, vibrato_rad : float
        Rate and phase of the vibrato.
    noises : dict of str to Noise
        Noise for each field of `Wandering`.
    """

    left_more: dict[str, float]
    vibrato_hz: float
    vibrato_rad: float
    noises: dict[str, Noise]

    def wandering(self, times_s: FloatArray) -> Wandering:
        """Sample the slow random variation of the face at ascending times."""
        if len(times_s) == 0:
            return Wandering(**dict.fromkeys(self.noises, times_s))
        first = int(np.floor(times_s[0] / GRID_S)) - 1
        count = int(np.floor(times_s[-1] / GRID_S)) + 3 - first
        at_s = (first + np.arange(count, dtype=np.float64)) * GRID_S
        values = np.clip(np.stack([noise.sample(at_s) for noise in self.noises.values()]), -MOST, MOST)
        sampled = dict(zip(self.noises, Spline(first, GRID_S, values).sample(times_s), strict=True))
        sampled["sides"] = np.clip(0.7 * sampled["sides"], -1.0, 1.0)
        return Wandering(**sampled)

    def vibrato(self, times_s: FloatArray, wandering: Wandering) -> FloatArray:
        """Return the oscillation (N,) of the vibrato at given times, -1..1; its rate varies with ``wandering``."""
        turns: FloatArray = 2.0 * np.pi * self.vibrato_hz * times_s + self.vibrato_rad
        swing: FloatArray = np.sin(turns + RATE_VARIES_RAD * wandering.rate)
        return swing

    def lopsided(self, morphs: dict[str, FloatArray], wandering: Wandering) -> None:
        """Make left and right weights differ, in place, within 0..1."""
        varies = VARIES * wandering.sides
        for pair in PAIRS:
            left, right = morphs.get(pair + LEFT), morphs.get(pair + RIGHT)
            if left is None or right is None or pair == "eyeBlink":
                continue
            half = 0.5 * (self.left_more[pair] + varies)
            morphs[pair + LEFT] = np.clip(left * (1.0 + half), 0.0, 1.0)
            morphs[pair + RIGHT] = np.clip(right * (1.0 - half), 0.0, 1.0)


@lru_cache(maxsize=512)
def own_face(player_id: str, seed: int, least: float, most: float, vibrato_hz: tuple[float, float]) -> OwnFace:
    """Draw the individual traits of a player's face from the seed; left and right differ by a share between ``least``
    and ``most``.
    """
    random = generator(player_id, seed, "own face")
    side = 1.0 if random.random() < 0.5 else -1.0
    with_it = np.where(random.random(len(PAIRS)) < STRONGER_SIDE, side, -side)
    more = with_it * random.uniform(least, most, len(PAIRS))
    return OwnFace(
        left_more=dict(zip(PAIRS, more.tolist(), strict=True)),
        vibrato_hz=float(random.uniform(*vibrato_hz)),
        vibrato_rad=float(random.uniform(0.0, 2.0 * np.pi)),
        noises={
            name: Noise.of(generator(player_id, seed, "own face", name), low_hz, high_hz, 3)
            for name, (low_hz, high_hz) in _BANDS.items()
        },
    )


def face_of_player(player_id: str, seed: int, face: FaceMotion, embouchure: EmbouchureWeights) -> OwnFace:
    """Return the individual traits of a player's face, with sizes from the body's table and the kind of embouchure."""
    return own_face(player_id, seed, *face.left_right, embouchure.vibrato_hz)
