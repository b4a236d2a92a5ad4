"""Contacts of a player's hands with the instrument: required place, actual place, and distance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.rig.grip.finger_stations import aside_m, only_at, worked_by
from app.rig.skinning import landmark_set
from instrument_maps.model import ROOT, InstrumentMap
from widgets.viewport.cast import Stage

AWAY_FROM_REST = 0.5
"""Share of its least use beyond which a control counts as pressed."""


@dataclass(frozen=True, eq=False)
class ContactReading:
    """A contact of the map in the present pose.

    Attributes
    ----------
    part : str
        Landmark of the hand that touches.
    requested_m, found_m : (3,) float64
        The point to touch on the instrument, and the middle of the landmark's skin, both in the world.
    firm : bool
        Whether it supports or works the instrument.
    """

    part: str
    requested_m: FloatArray
    found_m: FloatArray
    firm: bool

    @property
    def finger(self) -> str:
        """Hand and finger of the touching part: ``"left.index"`` for ``"left.index.pad"``."""
        return self.part.rpartition(".")[0]

    @property
    def distance_mm(self) -> float:
        """Return the distance in millimetres of the skin from the point to touch."""
        return 1000.0 * float(np.linalg.norm(self.requested_m - self.found_m))


def touches(stage: Stage, row: int) -> tuple[ContactReading, ...]:
    """Return the contacts of a player that apply in the present pose."""
    kit, pose = stage.members[row].assets, stage.poses[row]
    if pose is None:
        return ()
    holding = [
        contact
        for index, contact in enumerate(kit.map.contacts)
        if contact.part in kit.character.landmarks and _holds(index, kit.map, pose.controls)
    ]
    if not holding:
        return ()
    marks = landmark_set(kit.character, tuple(contact.part for contact in holding))
    bones = stage.bones[row, marks.joints].astype(np.float64)
    found = np.tensordot(bones, marks.points, axes=([0, 2], [0, 1])).T
    result: list[ContactReading] = []
    workers: dict[tuple[str, ...], list[ContactReading]] = {}
    for contact, place in zip(holding, found, strict=True):
        node = kit.instrument.node_names.index(contact.node)
        origin = 0.0 if contact.node == ROOT else kit.instrument.node_positions_m[node]
        value = float(pose.controls.get(contact.control or "", 1.0))
        rest = origin + np.asarray(contact.position_m) + aside_m(contact, kit.map, np.full(1, value))[0]
        matrix = stage.node_matrix(row, node)
        requested = matrix[:, :3] @ rest + matrix[:, 3]
        result.append(ContactReading(contact.part, requested, place, contact.grip == "firm"))
        if works := worked_by(contact, kit.map):
            workers.setdefault(works, []).append(result[-1])
    # If several fingers may work it, the nearest one does.
    idle = {id(touch) for touches in workers.values() for touch in touches if touch.finger != _nearest(touches).finger}
    return tuple(touch for touch in result if id(touch) not in idle)


def _nearest(touches: list[ContactReading]) -> ContactReading:
    return min(touches, key=lambda touch: touch.distance_mm)


def _holds(index: int, instrument: InstrumentMap, controls: Mapping[str, float]) -> bool:
    """Return whether a contact with an index is required in the present pose; of a finger with several stations, only
    those of the station at which it works most of the pressed controls.
    """
    contact = instrument.contacts[index]
    place = only_at(instrument)[index]
    if place is not None:
        works = worked_by(contact, instrument)
        more = [
            other
            for other in (worked_by(one, instrument) for one in instrument.contacts)
            if set(other) > set(works) and all(_pressed(name, instrument, controls) for name in other)
        ]
        return bool(works) and not more and all(_pressed(name, instrument, controls) for name in works)
    if contact.when == "always" or contact.control is None:
        return True
    return _pressed(contact.control, instrument, controls) == (contact.when == "pressed")


def _pressed(name: str, instrument: InstrumentMap, controls: Mapping[str, float]) -> bool:
    control = instrument.control(name)
    least = control.half_value or 1.0
    return abs(controls.get(name, control.rest_value) - control.rest_value) > AWAY_FROM_REST * least
