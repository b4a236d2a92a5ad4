"""Delays between parts of a body: the hips begin, then the chest, then head and elbows."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from app.arrays import FloatArray
from metadata.model import Overlap


class Overlapped(NamedTuple):
    """Values of one motion for each part of the body, each with the part's own delay, as arrays (F,) over F frames."""

    hips: FloatArray
    chest: FloatArray
    head: FloatArray
    elbows: FloatArray

    @classmethod
    def nothing(cls, frames: int) -> Overlapped:
        """Return zero for every part of a body at rest."""
        return cls(*(np.zeros(frames) for _ in cls._fields))


class Sampled(Protocol):
    """Protocol of curves that can be sampled at times."""

    def sample(self, times_s: FloatArray) -> FloatArray: ...


class Leads(NamedTuple):
    """Seconds by which each part of the body moves before the head (0) in the same gesture, so that motions overlap."""

    hips_s: float
    chest_s: float
    head_s: float
    elbows_s: float

    @classmethod
    def of(cls, overlap: Overlap) -> Leads:
        """Compute the leads of all body parts from the delays in the body's table."""
        return cls(overlap.chest_s + overlap.head_s, overlap.head_s, 0.0, overlap.head_s - overlap.elbows_s)

    def at(self, times_s: FloatArray) -> Overlapped:
        """Shift ascending times for each part of the body by its lead, giving the times at which to sample a curve for
        the part.
        """
        return Overlapped(*(times_s + lead_s for lead_s in self))

    def sample(self, curve: Sampled, times_s: FloatArray) -> Overlapped:
        """Sample a curve at ascending times with the delay of each part of the body."""
        return Overlapped(*map(curve.sample, self.at(times_s)))

    def widened(self, spans_s: FloatArray) -> FloatArray:
        """Convert spans (K, 2) in seconds in which curves change to spans in which the body changes, by adding the
        leads of its parts.
        """
        widened: FloatArray = spans_s + np.array([-max(self), -min(self)])
        return widened
