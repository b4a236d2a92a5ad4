"""Names of face shapes for the receiver of a stream: ARKit's names in two spellings, or the presets of VRM 0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from app.arrays import FloatArray

FaceNames = Literal["arkit", "arkit_capital", "vrm"]
"""Names of face shapes: ``jawOpen``; ``JawOpen``, common for "perfect sync" clips; ``A``, ``Blink_L`` and so on (VRM
0).
"""
FACE_NAMES: Final[tuple[FaceNames, ...]] = ("arkit", "arkit_capital", "vrm")

VRM_PRESETS: Final[Mapping[str, Mapping[str, float]]] = {
    "A": {"jawOpen": 1.0},
    "I": {"mouthStretchLeft": 0.5, "mouthStretchRight": 0.5},
    "U": {"mouthPucker": 1.0},
    "O": {"mouthFunnel": 1.0},
    "Blink_L": {"eyeBlinkLeft": 1.0},
    "Blink_R": {"eyeBlinkRight": 1.0},
    "Joy": {"mouthSmileLeft": 0.5, "mouthSmileRight": 0.5},
    # Weights of half: the whole face changes, so less suffices than for the brows alone.
    "Angry": {"browDownLeft": 0.25, "browDownRight": 0.25},
}
"""Weights of ARKit's shapes in each preset of VRM 0; sums are limited to 1."""


@dataclass(frozen=True, eq=False)
class FaceLayout:
    """The N face shapes that a receiver expects by name, and the calculation of their values from morph weights.

    Attributes
    ----------
    shares : (len(names), len(morphs)) float64 or None
        Weight of each morph in each value; None if each name is that of one morph.
    """

    names: tuple[str, ...]
    morphs: tuple[str, ...]
    shares: FloatArray | None = None

    def values(self, weights: Mapping[str, float]) -> FloatArray:
        """Return the values (N,), 0..1, of the N names that a receiver expects, from weights of ARKit shapes by
        name."""
        own = np.array([weights.get(morph, 0.0) for morph in self.morphs])
        values: FloatArray = np.clip(own if self.shares is None else self.shares @ own, 0.0, 1.0)
        return values


def face_layout(naming: FaceNames, morphs: Sequence[str]) -> FaceLayout:
    """Create the layout that converts a face's morphs, named as in ARKit, to the shapes of a naming."""
    if naming == "arkit":
        return FaceLayout(tuple(morphs), tuple(morphs))
    if naming == "arkit_capital":
        return FaceLayout(tuple(morph[:1].upper() + morph[1:] for morph in morphs), tuple(morphs))
    made = {name: parts for name, parts in VRM_PRESETS.items() if parts.keys() & set(morphs)}
    shares = np.array([[parts.get(morph, 0.0) for morph in morphs] for parts in made.values()])
    return FaceLayout(tuple(made), tuple(morphs), shares.reshape(len(made), len(morphs)))
