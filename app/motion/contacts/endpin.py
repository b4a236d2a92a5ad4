"""Instruments on an endpin: the tip stays on the floor and the instrument turns about it.

Lips and tip are two fixed points at a constant distance; the body's motion would violate this by some millimetres, so
the pin's length adapts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.carried_instrument import InstrumentTransform, attitude, held_angles
from app.rig import quaternion
from instrument_maps.hold import Carriage
from instrument_maps.model import Endpin

UPRIGHT = 0.5
"""Least cosine between an endpin and the vertical for the instrument to stand on it."""


@dataclass(frozen=True)
class EndpinStand:
    """An instrument that stands on its endpin.

    ``lips_m`` (1, 3) is the place of its mouthpiece before any motion, which determines the tip's place on the floor.
    """

    endpin: Endpin
    carriage: Carriage
    lips_m: FloatArray

    @classmethod
    def of(cls, endpin: Endpin, carriage: Carriage, usual: InstrumentTransform) -> EndpinStand | None:
        """Create the stand of an instrument from its usual placement; None if the pin does not reach the floor."""
        needed_m, down = _needed(endpin, usual.position_m, usual.rotation)
        stands = down[0] > UPRIGHT and needed_m[0] <= endpin.most_m
        return cls(endpin, carriage, usual.position_m) if stands else None

    def stood(self, carried: InstrumentTransform, motion: BodyMotion) -> InstrumentTransform:
        """Rotate the carried instrument about its mouthpiece until its pin is above the point of the floor where the
        tip stands.
        """
        # The tip follows only the angles set by the animator; melody and cues do not move the pin.
        pitch, yaw, roll = held_angles(self.carriage, replace(motion, bell_rad=np.zeros_like(motion.bell_rad)))
        still = attitude(pitch, np.asarray(yaw), roll)
        drawn_m, _ = _needed(self.endpin, self.lips_m, still)
        place_m = self.lips_m + quaternion.rotate(still, self._tip_m(drawn_m))
        requested_m = place_m - carried.position_m
        tip_m, axis = np.asarray(self.endpin.tip_m), np.asarray(self.endpin.axis)
        # Solves |tip + out * axis| = distance for the length by which the pin has to be pulled out.
        along = float(tip_m @ axis)
        out_m = np.sqrt(np.maximum((requested_m**2).sum(axis=1) - float(tip_m @ tip_m) + along**2, 0.0)) - along
        pointing_m = quaternion.rotate(carried.rotation, self._tip_m(out_m))
        swung = quaternion.between(_unit(pointing_m), _unit(requested_m))
        return InstrumentTransform(carried.position_m, quaternion.multiply(swung, carried.rotation))

    def drawn_out(self, position_m: AnyFloatArray, rotation: AnyFloatArray) -> FloatArray:
        """Return the extension (F,) of the pin, 0..1, at which its tip is on the floor or as near to it as possible.

        Parameters
        ----------
        position_m, rotation : (F, 3) and (F, 4)
            ``world_from_instrument``; the floor is at height 0.
        """
        return np.clip(_needed(self.endpin, position_m, rotation)[0] / self.endpin.most_m, 0.0, 1.0)

    def pin_m(self, carried: InstrumentTransform) -> float:
        """Return the length in metres by which the pin has to be pulled out to stand on the floor, in the first frame
        of a placement; negative: the instrument ends below the floor."""
        return float(_needed(self.endpin, carried.position_m, carried.rotation)[0][0])

    def _tip_m(self, out_m: FloatArray) -> FloatArray:
        tip_m: FloatArray = np.asarray(self.endpin.tip_m) + np.multiply.outer(out_m, np.asarray(self.endpin.axis))
        return tip_m


def _unit(vectors: FloatArray) -> FloatArray:
    result: FloatArray = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return result


def _needed(endpin: Endpin, position_m: AnyFloatArray, rotation: AnyFloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the pin length (F,) in metres needed to touch the floor, and the cosine (F,) of its angle from straight
    down.
    """
    turn = np.asarray(rotation, np.float64)
    tip_y = np.asarray(position_m, np.float64)[:, 1] + quaternion.rotate(turn, np.asarray(endpin.tip_m))[:, 1]
    down: FloatArray = -quaternion.rotate(turn, np.asarray(endpin.axis))[:, 1]
    return tip_y / np.maximum(down, UPRIGHT), down
