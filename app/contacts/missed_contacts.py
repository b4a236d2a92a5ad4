"""Contacts that a grip itself misses, however its player moves."""

from __future__ import annotations

from app.contacts.bounds import contact_name
from app.errors import Message
from app.rig.grip.fitting.fit_terms import GRIP_M, INSIDE_M, TOUCH_M
from app.rig.grip.grip_pose import ContactFit, GripPose


def missed_contacts(grip: GripPose) -> tuple[ContactFit, ...]:
    """The touches that a hold does not meet, the worst first. Those that only guide or rest are not among them."""
    touches = [one for hand in grip.hands for one in hand.contacts if one.firm]
    off = [one for one in touches if one.distance_m > (GRIP_M if one.control is None else TOUCH_M)]
    return tuple(sorted(off, key=lambda one: -one.distance_m))


def missed_mm(grip: GripPose) -> dict[str, float]:
    """By how much, by the names of the measures: touches, and skin inside the instrument."""
    found = {contact_name(one): round(1000.0 * one.distance_m, 2) for one in missed_contacts(grip)}
    deepest_m = max((hand.penetration_m for hand in grip.hands), default=0.0)
    return found | ({"penetration": round(1000.0 * deepest_m, 2)} if deepest_m > INSIDE_M else {})


def missed_message(grip: GripPose) -> Message | None:
    """Warning about the touches that are not met; None if all are."""
    off = missed_contacts(grip)
    if not off:
        return None
    gap_mm = round(1000.0 * off[0].distance_m, 1)
    return Message("character.touches_missed", {"count": len(off), "touch": off[0].part, "gap_mm": gap_mm})
