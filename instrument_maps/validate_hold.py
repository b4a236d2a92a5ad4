"""Checks of the places where hands and bodies touch the instrument: contacts, hands, solids, carriage."""

from __future__ import annotations

import math
from collections.abc import Iterator

from instrument_maps.hold import Box, Capsule, Carriage, Cone, Contact, Cylinder, Proxy, Ring
from instrument_maps.model import MOVERS, PARTS, ROOT, Control, InstrumentMap
from instrument_maps.value_checks import REACH_M, UNIT_TOLERANCE, Problem, dot, near_point, unit_vector, within

_SMALLEST, _LARGEST = 0.2, 4.0


def contacts_problems(instrument: InstrumentMap) -> Iterator[Problem]:
    nodes = {ROOT, *instrument.nodes}
    controls = {control.name: control for control in instrument.controls}
    seen: set[tuple[str, str, frozenset[str]]] = set()
    for index, contact in enumerate(instrument.contacts):
        path = f"contacts[{index}]"
        if contact.part not in PARTS:
            yield f"{path}.part", f"'{contact.part}' is not a part of a hand"
        if contact.node not in nodes:
            yield f"{path}.node", f"'{contact.node}' is neither '{ROOT}' nor the node of a control"
        yield from near_point(f"{path}.position_m", contact.position_m)
        yield from unit_vector(f"{path}.normal", contact.normal)
        if contact.grip == "guide":
            yield f"{path}.grip", "'guide' is for fingers that a character lacks; a file says 'firm' or 'resting'"
        if contact.control is not None and contact.control not in controls:
            yield f"{path}.control", f"there is no control named '{contact.control}'"
        elif contact.control is None and contact.when != "always":
            yield f"{path}.when", f"'{contact.when}' needs a control"
        for place, name in enumerate(contact.together):
            if name not in controls or name == contact.control or contact.control is None:
                yield f"{path}.together[{place}]", f"'{name}' is no other control beside '{contact.control}'"
        station = frozenset((*([contact.control] if contact.control else []), *contact.together))
        if (contact.part, contact.when, station) in seen:
            yield f"{path}.part", f"'{contact.part}' touches twice"
        seen.add((contact.part, contact.when, station))
    for index, control in enumerate(instrument.controls):
        if control.finger in MOVERS and not any(_works(contact, control) for contact in instrument.contacts):
            yield f"controls[{index}].finger", f"no contact says where '{control.finger}' touches '{control.name}'"
    yield from _hands(instrument, nodes)


def _works(contact: Contact, control: Control) -> bool:
    """Return whether a contact works a control; for a whole hand, by any of its parts."""
    hand, _, mover = control.finger.partition(".")
    of_mover = contact.part.startswith(f"{hand}." if mover == "hand" else f"{hand}.{mover}.")
    return contact.control == control.name and of_mover


def _hands(instrument: InstrumentMap, nodes: set[str]) -> Iterator[Problem]:
    hands = [seed.hand for seed in instrument.hands]
    for index, seed in enumerate(instrument.hands):
        path = f"hands[{index}]"
        if seed.hand in hands[:index]:
            yield f"{path}.hand", f"the {seed.hand} hand starts twice"
        if seed.node not in nodes:
            yield f"{path}.node", f"'{seed.node}' is neither '{ROOT}' nor the node of a control"
        yield from near_point(f"{path}.palm_position_m", seed.palm_position_m)
        yield from unit_vector(f"{path}.palm_normal", seed.palm_normal)
        yield from unit_vector(f"{path}.finger_direction", seed.finger_direction)
        if seed.elbow_off_ribs_deg is not None:
            yield from within(f"{path}.elbow_off_ribs_deg", seed.elbow_off_ribs_deg, 0, 120)
        for finger, curl in enumerate(seed.curl):
            yield from within(f"{path}.curl[{finger}]", curl, 0, 1)
    for index, contact in enumerate(instrument.contacts):
        hand = contact.part.partition(".")[0]
        if contact.part in PARTS and hand not in hands:
            yield f"contacts[{index}].part", f"'hands' does not say where the {hand} hand starts"


def proxies_problems(instrument: InstrumentMap) -> Iterator[Problem]:
    nodes = {ROOT, *instrument.nodes}
    for index, proxy in enumerate(instrument.proxy):
        path = f"proxy[{index}]"
        if proxy.node not in nodes:
            yield f"{path}.node", f"'{proxy.node}' is neither '{ROOT}' nor the node of a control"
        for key, detail in _proxy(proxy):
            yield f"{path}.{key}", detail


def _proxy(proxy: Proxy) -> Iterator[Problem]:
    if isinstance(proxy, Capsule | Cylinder | Cone):
        yield from near_point("a_m", proxy.a_m)
        yield from near_point("b_m", proxy.b_m)
        if not isinstance(proxy, Capsule) and math.dist(proxy.a_m, proxy.b_m) < 1e-6:
            yield "b_m", "is the same point as a_m"
        radii = (
            {"radius_a_m": proxy.radius_a_m, "radius_b_m": proxy.radius_b_m}
            if isinstance(proxy, Cone)
            else {"radius_m": proxy.radius_m}
        )
        for key, radius in radii.items():
            yield from within(key, radius, 1e-5, REACH_M)
    elif isinstance(proxy, Ring):
        yield from near_point("centre_m", proxy.centre_m)
        yield from unit_vector("axis", proxy.axis)
        yield from within("radius_m", proxy.radius_m, 1e-4, REACH_M)
        yield from within("tube_radius_m", proxy.tube_radius_m, 1e-5, proxy.radius_m)
    elif isinstance(proxy, Box):
        yield from near_point("centre_m", proxy.centre_m)
        yield from unit_vector("x_axis", proxy.x_axis)
        yield from unit_vector("y_axis", proxy.y_axis)
        if abs(dot(proxy.x_axis, proxy.y_axis)) > UNIT_TOLERANCE:
            yield "y_axis", "is not at a right angle to x_axis"
        for axis, half in enumerate(proxy.half_m):
            yield from within(f"half_m[{axis}]", half, 1e-5, REACH_M)


def hold_problems(instrument: InstrumentMap) -> Iterator[Problem]:
    hold = instrument.hold
    if not hold.postures:
        yield "hold", "says neither how it is played standing nor how seated"
    smallest, largest = hold.size_range
    if not _SMALLEST <= smallest <= 1.0 <= largest <= _LARGEST:
        yield (
            "hold.size_range",
            f"must be [smallest, largest] with {_SMALLEST} <= smallest <= 1 <= largest <= {_LARGEST}",
        )
    for index, support in enumerate(hold.supports):
        yield from near_point(f"hold.supports[{index}].hook_m", support.hook_m)
        if not support.postures:
            yield f"hold.supports[{index}].postures", "says no posture"
    for name in ("standing", "seated"):
        carriage, lowered = getattr(hold, name), getattr(hold, f"lowered_{name}")
        if (carriage is None) != (lowered is None):
            yield f"hold.lowered_{name}", f"must be there exactly where hold.{name} is"
        if carriage is not None:
            yield from _carriage(f"hold.{name}", carriage)
        if lowered is not None:
            yield from near_point(f"hold.lowered_{name}.offset_m", lowered.offset_m)
            for key in ("pitch_down_deg", "yaw_left_deg", "roll_left_deg"):
                yield from within(f"hold.lowered_{name}.{key}", getattr(lowered, key), -180, 180)


def _carriage(path: str, carriage: Carriage) -> Iterator[Problem]:
    for key in ("pitch_down_deg", "yaw_left_deg", "roll_left_deg"):
        low, usual, high = getattr(carriage, key)
        if not -180 <= low <= usual <= high <= 180:
            yield f"{path}.{key}", "must be [lowest, usual, highest] in degrees"
    for key, most in (("head_left_deg", 60), ("head_lean_left_deg", 25), ("trunk_left_deg", 45)):
        yield from within(f"{path}.{key}", getattr(carriage, key), -most, most)
