"""Definitions shared by the fit of a grip and its measurement: progress, required landmarks, and a hand with its wrist
solved.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.errors import UsageError
from app.rig.model import Character, InstrumentModel
from instrument_maps.model import Control, InstrumentMap

TOUCH_M, GRIP_M, INSIDE_M = 0.002, 0.003, 0.003
"""Tolerances in metres of a good grip: contacts that work controls, contacts that carry the instrument, skin inside the
instrument.
"""

FIT_VERSION = 15
"""Version in the digest of stored grips (`app.rig.grip.fitting.grip_files`); increase it if fits change."""
PLACES_VERSION = 3
"""Second version in that digest; increase it if only the stations of fingers change."""


def no_progress(share: float) -> None:
    """Ignore the share of the work that is done, for callers without a progress bar."""


def require_landmarks(character: Character, instrument_map: InstrumentMap) -> None:
    """Raise UsageError if a body lacks a landmark that the instrument touches."""
    needed = {contact.part for contact in instrument_map.contacts}
    needed |= {f"{seed.hand}.{place}" for seed in instrument_map.hands for place in ("palm", "hand")}
    missing = sorted(needed - set(character.landmarks))
    if missing:
        raise UsageError("character.landmarks_missing", id=character.id, missing=", ".join(missing))


@dataclass(frozen=True, eq=False)
class GripScene:
    """A hand whose wrist is solved: its position and basis in the instrument's frame for S values of the control that
    moves the hand (one if none does).
    """

    model: InstrumentModel
    instrument_map: InstrumentMap
    carrier: Control | None
    position_m: FloatArray
    basis: FloatArray

    def placed(self, points: FloatArray) -> FloatArray:
        """Convert points (..., S, V, 3) from the wrist's frame to the instrument's, each sample with its own wrist."""
        return points @ self.basis.transpose(0, 2, 1) + self.position_m[:, None]

    def turned(self, vectors: FloatArray) -> FloatArray:
        """Convert directions (N, ..., 3) from the wrist's frame to the instrument's."""
        return vectors @ self.basis.transpose(0, 2, 1)

    def only(self, which: IndexArray) -> GripScene:
        """Return the scene reduced to the samples with the given indices."""
        return replace(self, position_m=self.position_m[which], basis=self.basis[which])

    def over(self, values: FloatArray) -> GripScene:
        """Return the scene with one wrist for each of ``values`` of a finger's controls; a wrist that no control moves
        is repeated.
        """
        return self if len(self.position_m) == len(values) else self.only(np.zeros(len(values), dtype=np.intp))
