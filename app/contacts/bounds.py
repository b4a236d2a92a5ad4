"""Bounds of contact errors, for all checks and reports."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray
from app.rig.grip.finger_stations import MOST_HOVER_M
from app.rig.grip.fitting.fit_terms import GRIP_M, INSIDE_M, TOUCH_M
from app.rig.grip.grip_pose import ContactFit
from instrument_maps.hold import Contact
from instrument_maps.model import Control

TOUCH_MM, GRIP_MM, PENETRATION_MM = 1000.0 * TOUCH_M, 1000.0 * GRIP_M, 1000.0 * INSIDE_M
LIPS_MM = 2.0
FEET_MM = 1.0
HOVER_MM = 1000.0 * MOST_HOVER_M
CLEAR_MM = 3.0
"""Distance in millimetres of a finger from a hole above which the hole sounds open, unless the instrument is smaller
and has a smaller limit.
"""
PRESSED = 0.9
"""Share of its travel from which a pressed control counts as in place; a released one counts up to a tenth."""
SLIDE_M = 0.005
"""Distance in metres within which a slide counts as in place."""
MOVED_MM = 1.0
"""Distance in millimetres of a hand from its place above which its fingers' gaps are reported as a problem of
the hand.
"""
UNREACHED_M = 0.005
"""Largest distance in metres of a hand from its grip that is not reported to the user."""

NEARLY_ALL = 99
"""Percentile of the distances that reports list in addition to the maximum."""


def reported_least_m(distances_m: FloatArray) -> float:
    """Lower bound in metres for the percentile that `Spread.of` reports, from lower bounds of the distances (F,)."""
    rank = (len(distances_m) - 1) * NEARLY_ALL // 100
    return float(np.partition(distances_m, rank)[rank])


class Spread(msgspec.Struct, frozen=True):
    """Distribution of a contact's error over ``frames`` frames, in millimetres: maximum, 99th percentile, and the bound
    for the percentile. Without frames there is no value and no violation.
    """

    max_mm: float
    p99_mm: float
    bound_mm: float
    frames: int

    @classmethod
    def of(cls, distances_m: FloatArray, bound_mm: float) -> Spread:
        """Measure the distribution of distances (F,) in metres over F frames, and compare it with a bound."""
        if not len(distances_m):
            return cls(0.0, 0.0, bound_mm, 0)
        distances_mm = distances_m * 1000.0
        most, nearly = float(distances_mm.max()), float(np.percentile(distances_mm, NEARLY_ALL))
        return cls(round(most, 5), round(nearly, 5), bound_mm, len(distances_mm))

    @property
    def kept(self) -> bool:
        """True if the distance is within the bound at every frame."""
        return self.max_mm <= self.bound_mm


def bound_mm(contact: Contact) -> float:
    """Return the allowed error of a contact in millimetres."""
    touches = contact.control is not None and contact.grip == "firm"
    return TOUCH_MM if touches and not contact.part.endswith(("palm", "thumb_web")) else GRIP_MM


def allowed_mm(name: str, bound_mm: float, missed: Mapping[str, float]) -> float:
    """Allowed error of a contact in millimetres: its bound plus the error of the grip itself (``missed``), which is
    reported separately (`app.contacts.missed_contacts`).
    """
    return bound_mm + missed.get(name, 0.0)


def contact_name(contact: Contact | ContactFit) -> str:
    """Return the name of a contact in reports, such as ``"left.index.pad on valve_1"``."""
    return f"{contact.part} on {'+'.join((contact.control or contact.node, *contact.together))}"


def in_place(control: Control, values: FloatArray, targets: FloatArray) -> BoolArray:
    """Mask (F,) of the frames in which a control's value (F,) is close enough to its target (F,)."""
    off = np.abs(values - targets)
    if control.kind == "slide" and control.travel_m:
        return off * control.travel_m <= SLIDE_M
    return off <= 1.0 - PRESSED + 1e-9
