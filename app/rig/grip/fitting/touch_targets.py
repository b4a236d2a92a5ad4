"""Points that fingers touch, and the nodes of the instrument, in the instrument's frame for values of the controls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.rig import quaternion
from app.rig.grip.finger_stations import MOST_HOVER_M, aside_m, height_share
from app.rig.instrument import node_transforms, part_transform, part_values
from app.rig.model import InstrumentModel
from instrument_maps.hold import Contact
from instrument_maps.model import ROOT, Control, InstrumentMap

# Deviations that give a residual of one.
FIRM_M, RESTING_M = 0.0003, 0.0012
FIRM_NORMAL, RESTING_NORMAL = 0.35, 0.6
GUIDE_M, GUIDE_NORMAL = 0.006, 1.5
SPREADS = {"firm": (FIRM_M, FIRM_NORMAL), "resting": (RESTING_M, RESTING_NORMAL), "guide": (GUIDE_M, GUIDE_NORMAL)}
HOVER_MORE = 1.3
"""Factor of the map's height at which fingers wait in the fastest passages."""
HOVER_SPREAD = 0.5
"""Standard deviation of a waiting finger's height relative to it, as the hand may require."""
HOVER_TURNS = 2.0
"""Factor by which the pad's orientation is less exact at a waiting height than at the touch."""


@dataclass(frozen=True, eq=False)
class TouchTarget:
    """Point on the instrument that a finger must touch, at S values of the controls that it works.

    ``positions`` and ``normals`` are (S, 3). Arrays (S,): ``active`` is True if the contact is required there,
    ``spread_m`` and ``spread_normal`` are the tolerances of position and normal.
    """

    contact: Contact
    positions: FloatArray
    normals: FloatArray
    active: BoolArray
    spread_m: FloatArray
    spread_normal: FloatArray


def touch_at(
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    contact: Contact,
    worked: frozenset[str],
    carrier: Control | None,
    values: FloatArray,
) -> TouchTarget:
    """Return the target of a contact while all ``worked`` controls are at ``values`` (S,), raised for a finger that
    waits above its control.
    """
    position, normal = contact_at(model, instrument_map, contact, worked, carrier, values)
    exact_m, exact_normal = SPREADS[contact.grip]
    spread_m, spread_normal = np.full(len(values), exact_m), np.full(len(values), exact_normal)
    if contact.control in worked:
        control = instrument_map.control(contact.control or "")
        share = height_share(control, values)
        height_m = min(HOVER_MORE * control.hover_m, MOST_HOVER_M) * share
        position = position + height_m[:, None] * normal + aside_m(contact, instrument_map, values)
        spread_m = np.hypot(spread_m, HOVER_SPREAD * height_m)
        if control.hover_m:
            spread_normal = spread_normal * (1.0 + HOVER_TURNS * share)
    return TouchTarget(contact, position, normal, counts(contact, values), spread_m, spread_normal)


def counts(contact: Contact, values: FloatArray) -> BoolArray:
    """Return a mask (S,) of the control values at which a contact is required."""
    if contact.when == "pressed":
        return values > 0.0
    return values == 0.0 if contact.when == "released" else values >= 0.0


def contact_at(
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    contact: Contact,
    worked: frozenset[str],
    carrier: Control | None,
    values: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return position (S, 3) and normal (S, 3) of a contact in the instrument's frame while the ``worked`` controls
    take S values; a hand moved by ``carrier`` stays with its own node.
    """
    place = model.node_positions_m[model.node_names.index(contact.node)] + contact.position_m
    normal = np.asarray(contact.normal, dtype=np.float64)
    part = next((part for part in instrument_map.moving_parts if part.node == contact.node), None)
    if part is None or (carrier is not None and carrier.name in part.controls):
        return np.tile(place, (len(values), 1)), np.tile(normal, (len(values), 1))
    moved, turn = part_transform(part.motion, part_values(part, _at(worked, values), len(values)))
    return quaternion.rotate(turn, place) + moved, quaternion.rotate(turn, normal)


def _at(worked: frozenset[str], values: FloatArray) -> Mapping[str, FloatArray]:
    return dict.fromkeys(sorted(worked), values)


def nodes_at(
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    worked: frozenset[str],
    carrier: Control | None,
    values: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return positions (S, N, 3) and bases (S, N, 3, 3) of the instrument's N nodes while the ``worked`` controls take
    S values.

    For a hand moved by the control ``carrier``, its own node is fixed and all others move the opposite way.
    """
    place, turn = node_transforms(model, instrument_map, _at(worked, values), len(values))
    if carrier is not None:
        others = np.arange(len(model.node_names)) != model.node_names.index(carrier.node or ROOT)
        place[:, others] -= np.multiply.outer(values, travel(carrier))[:, None]
    return place, quaternion.to_matrix(turn)


def travel(control: Control) -> FloatArray:
    """Return the travel (3,) of a sliding control; zero for a rotating one."""
    axis = (0.0, 0.0, 0.0) if control.motion is None else control.motion.axis
    return np.asarray(axis, dtype=np.float64) * control.travel_m
