"""Contacts missed by a grip itself, in any pose."""

from __future__ import annotations

from app.contacts.bounds import contact_name
from app.errors import Message
from app.rig.grip.fitting.fit_terms import GRIP_M, INSIDE_M, TOUCH_M
from app.rig.grip.grip_pose import ContactFit, GripPose


def missed_contacts(grip: GripPose) -> tuple[ContactFit, ...]:
    """Touches that a grip misses, worst first; guides and supports are not included."""
    touches = [one for hand in grip.hands for one in hand.contacts if one.firm]
    off = [one for one in touches if one.distance_m > (GRIP_M if one.control is None else TOUCH_M)]
    return tuple(sorted(off, key=lambda one: -one.distance_m))


def missed_mm(grip: GripPose) -> dict[str, float]:
    """Distance in millimetres of missed touches and of skin inside the instrument, by name in reports."""
    found = {contact_name(one): round(1000.0 * one.distance_m, 2) for one in missed_contacts(grip)}
    deepest_m = max((hand.penetration_m for hand in grip.hands), default=0.0)
    return found | ({"penetration": round(1000.0 * deepest_m, 2)} if deepest_m > INSIDE_M else {})


def missed_message(grip: GripPose) -> Message | None:
    """Return a warning about the touches that a grip misses; None if it misses none."""
    off = missed_contacts(grip)
    if not off:
        return None
    gap_mm = round(1000.0 * off[0].distance_m, 1)
    return Message("character.touches_missed", {"count": len(off), "touch": off[0].part, "gap_mm": gap_mm})
