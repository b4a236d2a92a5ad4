"""Optional bones of one performer's skeleton, and attachment of the instruments."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.export.rig_options import DEFAULT_RIG, RigOptions
from app.formats.scene import NodePlace
from app.performance.cast import Performer
from app.project.casting import StagePosition
from app.rig import quaternion
from app.rig.grip.grip_pose import Side

ORIGIN: Final = NodePlace(np.zeros(3), quaternion.IDENTITY)


@dataclass(frozen=True, eq=False)
class Grip:
    """Place of an instrument in the hand that holds it.

    Attributes
    ----------
    side : str
        ``"left"`` or ``"right"``.
    position_m : (3,) float64
        Origin of the instrument in the frame of the hand joint, at rest.
    rotation : (4,) float64
        ``hand_from_instrument``.
    """

    side: Side
    position_m: FloatArray
    rotation: FloatArray


@dataclass(frozen=True, eq=False)
class Rig:
    """Optional bones of a performer's skeleton, and attachment of the instruments.

    Attributes
    ----------
    options : RigOptions
        Requested options.
    grips : tuple of Grip
        Grips of the musician's instruments, in order; empty for a dancer.
    place : NodePlace or None
        Transform of the root bone on the stage; None for the origin.
    """

    options: RigOptions = DEFAULT_RIG
    grips: tuple[Grip, ...] = ()
    place: NodePlace | None = None


def rig_of(options: RigOptions, stage: StagePosition, performers: Iterable[Performer] = ()) -> Rig:
    """Return the rig of a dancer, or of a musician with all instruments (``performers``)."""
    grips = tuple(map(_grip, performers)) if options.instrument != "free" else ()
    return Rig(options, grips, floor_place(stage) if options.root_bone == "place" else None)


def floor_place(stage: StagePosition) -> NodePlace:
    """Return the transform of a place on the stage's floor, with its rotation from +Z towards +X."""
    half = stage.turn_rad / 2.0
    return NodePlace(
        100.0 * np.array([stage.x_m, 0.0, stage.z_m]), np.array([0.0, math.sin(half), 0.0, math.cos(half)])
    )


def _grip(performer: Performer) -> Grip:
    side = performer.instrument.hold.support_hand
    hand = next(one for one in performer.grip.hands if one.side == side)
    rotation = quaternion.conjugate(hand.instrument_from_hand_rotation[0])
    return Grip(side, -quaternion.rotate(rotation, hand.instrument_from_hand_m[0]), rotation)
