"""Where a player's hands should touch the instrument, where they do, and how far apart that is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.rig.skinning import landmark_set
from instrument_maps.model import ROOT, Contact, InstrumentMap
from widgets.viewport.cast import Stage

Floats = npt.NDArray[np.float64]

AWAY_FROM_REST = 0.5
"""A control farther from its rest than this is pressed."""


@dataclass(frozen=True, eq=False)
class Touch:
    """One contact of the map in the present pose.

    Attributes
    ----------
    part : str
        Landmark of the hand.
    wanted_m, found_m : (3,) float64
        The place on the instrument and the middle of the landmark's skin, in the world.
    firm : bool
        Whether it carries or works the instrument.
    """

    part: str
    wanted_m: Floats
    found_m: Floats
    firm: bool

    @property
    def distance_mm(self) -> float:
        """How far the skin is from its place."""
        return 1000.0 * float(np.linalg.norm(self.wanted_m - self.found_m))


def touches(stage: Stage, row: int) -> tuple[Touch, ...]:
    """The contacts of a player that hold in the present pose."""
    kit, pose = stage.members[row].kit, stage.poses[row]
    if pose is None:
        return ()
    holding = [
        contact
        for contact in kit.map.contacts
        if contact.part in kit.character.landmarks and _holds(contact, kit.map, pose.controls)
    ]
    if not holding:
        return ()
    marks = landmark_set(kit.character, tuple(contact.part for contact in holding))
    bones = stage.bones[row, marks.joints].astype(np.float64)
    found = np.tensordot(bones, marks.points, axes=([0, 2], [0, 1])).T
    result = []
    for contact, place in zip(holding, found, strict=True):
        node = kit.instrument.node_names.index(contact.node)
        rest = np.asarray(contact.position_m) + (0.0 if contact.node == ROOT else kit.instrument.node_positions_m[node])
        matrix = stage.node_matrix(row, node)
        wanted = matrix[:, :3] @ rest + matrix[:, 3]
        result.append(Touch(contact.part, wanted, place, contact.grip == "firm"))
    return tuple(result)


def _holds(contact: Contact, instrument: InstrumentMap, controls: Mapping[str, float]) -> bool:
    if contact.when == "always" or contact.control is None:
        return True
    control = instrument.control(contact.control)
    pressed = abs(controls.get(control.name, control.rest_value) - control.rest_value) > AWAY_FROM_REST
    return pressed == (contact.when == "pressed")
