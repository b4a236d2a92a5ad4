"""Terms of fitting a grip (`app.rig.grip.fitting.fit`), for what starts one or uses its results."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.errors import UsageError
from app.rig.model import Character, InstrumentModel
from instrument_maps.model import Control, InstrumentMap

TOUCH_M, GRIP_M, INSIDE_M = 0.002, 0.003, 0.003
"""A hold ends well where what works a control is off by no more than this, what carries the instrument by no more than
this, and no skin is deeper inside it than this."""

FIT_VERSION = 15
"""Part of the digest of stored holds (`app.rig.grip.fitting.grip_files`): raise it when a fit comes out differently."""
PLACES_VERSION = 3
"""Part of that digest too: raise it when only the places change at which fingers wait over what they work, or work
it at several places."""


def no_progress(share: float) -> None:
    """Ignores the progress."""


def require_landmarks(character: Character, instrument_map: InstrumentMap) -> None:
    """Raise UsageError ``character.landmarks_missing`` where a body lacks a place the instrument touches."""
    needed = {contact.part for contact in instrument_map.contacts}
    needed |= {f"{seed.hand}.{place}" for seed in instrument_map.hands for place in ("palm", "hand")}
    missing = sorted(needed - set(character.landmarks))
    if missing:
        raise UsageError("character.landmarks_missing", id=character.id, missing=", ".join(missing))


@dataclass(frozen=True, eq=False)
class GripScene:
    """A solved wrist on its instrument."""

    model: InstrumentModel
    instrument_map: InstrumentMap
    carrier: Control | None
    position_m: FloatArray
    basis: FloatArray

    def placed(self, points: FloatArray) -> FloatArray:
        """Take points (..., S, V, 3) of the wrist's frame to the instrument's, sample by sample."""
        return points @ self.basis.transpose(0, 2, 1) + self.position_m[:, None]

    def turned(self, vectors: FloatArray) -> FloatArray:
        """Likewise for directions."""
        return vectors @ self.basis.transpose(0, 2, 1)

    def only(self, which: IndexArray) -> GripScene:
        """The scene at some of its samples."""
        return replace(self, position_m=self.position_m[which], basis=self.basis[which])

    def over(self, values: FloatArray) -> GripScene:
        """The scene at some values of what a finger works: a wrist that nothing carries is the same at all of them."""
        return self if len(self.position_m) == len(values) else self.only(np.zeros(len(values), dtype=np.intp))
