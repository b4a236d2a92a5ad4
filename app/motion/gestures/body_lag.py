"""Parts of a body that follow one another: the hips begin, the chest comes after them, then head and elbows."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from app.arrays import FloatArray
from metadata.model import Overlap


class Overlapped(NamedTuple):
    """A value as each part of the body has it, delayed, at some frames; (F,) float64 each."""

    hips: FloatArray
    chest: FloatArray
    head: FloatArray
    elbows: FloatArray

    @classmethod
    def nothing(cls, frames: int) -> Overlapped:
        """The value of a body at rest."""
        return cls(*(np.zeros(frames) for _ in cls._fields))


class Sampled(Protocol):
    """Protocol of values that can be sampled at times."""

    def sample(self, times_s: FloatArray) -> FloatArray: ...


class Leads(NamedTuple):
    """Lead of each part over the head, seconds. The head is in time: what is before it prepares."""

    hips_s: float
    chest_s: float
    head_s: float
    elbows_s: float

    @classmethod
    def of(cls, overlap: Overlap) -> Leads:
        """Leads of the parts of a body over the part that comes last."""
        return cls(overlap.chest_s + overlap.head_s, overlap.head_s, 0.0, overlap.head_s - overlap.elbows_s)

    def at(self, times_s: FloatArray) -> Overlapped:
        """The time of a curve at which each part is, by ascending times."""
        return Overlapped(*(times_s + lead_s for lead_s in self))

    def sample(self, curve: Sampled, times_s: FloatArray) -> Overlapped:
        """A curve as each part has it."""
        return Overlapped(*map(curve.sample, self.at(times_s)))

    def widened(self, spans_s: FloatArray) -> FloatArray:
        """Spans (K, 2) in which something changes, by those in which the curves do."""
        widened: FloatArray = spans_s + np.array([-max(self), -min(self)])
        return widened
