"""Places along an instrument that short arms reach with hands whose fingers do not bend.

Such a hand works no keys and may lie anywhere on the tube. Where its arm is too short for the usual place, it slides
along the instrument towards the mouthpiece, since a hand in the air beside the instrument would be farther from the
truth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.rig import quaternion
from app.rig.grip.body_size import HAND_M, arm_m, hand_size
from app.rig.grip.carriage import Upright, upright
from app.rig.grip.fitting.fitted_instrument import bends, palm_middle_m
from app.rig.grip.grip_pose import GripPose, HandHold
from app.rig.model import Character, InstrumentModel
from instrument_maps.model import FINGERS, InstrumentMap
from metadata.model import Body

STEP_M = 0.01
"""Distance in metres between places tried along the instrument."""
OFF_M = 0.015
"""Distance in metres by which a palm may be farther from the instrument than at its usual place without a loss."""
APART_SHARE = 0.5
"""Least distance of both hands along the instrument, as a share of a hand's length, unless they are usually nearer."""
LEAST_M = 0.005
"""Least shift in metres that is reported."""


def within_reach(
    character: Character, model: InstrumentModel, instrument: InstrumentMap, body: Body, grip: GripPose
) -> GripPose:
    """Return a grip with every hand without bending fingers slid along the instrument as far as its arm requires.

    Other hands, and those on a slide, are unchanged.

    Parameters
    ----------
    model : InstrumentModel
        The instrument, as large as the map.
    """
    if not any(_is_whole(character, hand) for hand in grip.hands):
        return grip
    stand = upright(character, instrument, body, grip.lips)
    surface_m = np.concatenate([np.asarray(mesh.positions_m, np.float64) for mesh in model.meshes])
    centred = surface_m - surface_m.mean(axis=0)
    tube = _Tube(surface_m, np.asarray(instrument.mouthpiece.position_m), np.linalg.eigh(centred.T @ centred)[1][:, -1])
    length_m = APART_SHARE * HAND_M[1] * hand_size(character.skeleton)
    reaches = [_Reach(character, hand, stand, tube) for hand in grip.hands]
    order = sorted(range(len(reaches)), key=lambda number: -reaches[number].along_m)
    # The farther hand moves the nearer one along, so that they do not lie in each other.
    needed_m = dict[int, float]()
    for place, number in enumerate(order):
        one, after = reaches[number], order[place - 1] if place else None
        least_m = 0.0
        if after is not None and reaches[after].forwards == one.forwards:
            least_m = needed_m[after] - max(reaches[after].along_m - one.along_m - length_m, 0.0)
        needed_m[number] = one.slid_m(max(least_m, 0.0), max(one.along_m - length_m, 0.0))
    shifts = dict[int, float]()
    for place, number in reversed(list(enumerate(order))):
        one, before = reaches[number], order[place + 1] if place + 1 < len(order) else None
        most_m = needed_m[number]
        if before is not None and reaches[before].forwards == one.forwards:
            between_m = one.along_m - reaches[before].along_m
            most_m = min(most_m, max(between_m - min(between_m, length_m), 0.0) + shifts[before])
        shifts[number] = one.slid_m(0.0, most_m) if most_m < needed_m[number] else most_m
    hands = tuple(
        hand if shifts[number] == 0.0 else reaches[number].slid(shifts[number])
        for number, hand in enumerate(grip.hands)
    )
    moved: dict[str, float] = {
        hand.side: shifts[number] for number, hand in enumerate(grip.hands) if shifts[number] > 0.0
    }
    return replace(grip, hands=hands, slid_m=moved)


def slid_message(slid_m: Mapping[str, float]) -> Message | None:
    """Return a note about hands that lie nearer to the mouthpiece than usual; None if none does."""
    far = {side: off_m for side, off_m in slid_m.items() if off_m >= LEAST_M}
    if not far:
        return None
    most_m = max(far.values())
    return Message("character.hands_slid", {"count": len(far), "most_mm": round(1000.0 * most_m)})


@dataclass(frozen=True, eq=False)
class _Tube:
    """Vertices (V, 3) of an instrument, the position (3,) of its mouthpiece, and the direction (3,) of its greatest
    extent, in its frame.
    """

    surface_m: FloatArray
    rim_m: FloatArray
    axis: FloatArray


@dataclass(frozen=True, eq=False)
class _Reach:
    """A hand on an instrument and the arm that has to reach it."""

    character: Character
    hand: HandHold
    stand: Upright
    tube: _Tube

    @property
    def wrist_m(self) -> FloatArray:
        """Position (3,) of the wrist in the instrument's frame."""
        place_m: FloatArray = np.atleast_2d(self.hand.instrument_from_hand_m)[0]
        return place_m

    @property
    def forwards(self) -> bool:
        """True if the hand lies in the direction of the tube's axis from the mouthpiece."""
        return float((self.wrist_m - self.tube.rim_m) @ self.tube.axis) >= 0.0

    @property
    def along_m(self) -> float:
        """Distance of the wrist from the mouthpiece along the tube."""
        return abs(float((self.wrist_m - self.tube.rim_m) @ self.tube.axis))

    @property
    def way(self) -> FloatArray:
        """Direction (3,) towards the mouthpiece."""
        return -self.tube.axis if self.forwards else self.tube.axis

    def slid(self, shift_m: float) -> HandHold:
        """Return the hand, slid by a distance."""
        return replace(self.hand, instrument_from_hand_m=self.hand.instrument_from_hand_m + shift_m * self.way)

    def slid_m(self, least_m: float, most_m: float) -> float:
        """Return the least distance from ``least_m`` to ``most_m`` by which the hand slides until its arm reaches it;
        that with the smallest gap if it reaches none. 0 for a hand that stays in place.
        """
        if most_m <= 0.0 or not _is_whole(self.character, self.hand):
            return 0.0
        skeleton, side = self.character.skeleton, self.hand.side
        shoulder_m = quaternion.rotate(
            quaternion.conjugate(self.stand.instrument_rotation),
            self.stand.joints_m[skeleton.index(f"{side}UpperArm")] - self.stand.instrument_m,
        )
        shifts_m = np.append(np.arange(0.0, most_m, STEP_M), most_m)
        wrists_m = self.wrist_m + np.multiply.outer(shifts_m, self.way)
        turn = np.atleast_2d(self.hand.instrument_from_hand_rotation)[0]
        palms_m = wrists_m + quaternion.rotate(turn, palm_middle_m(self.character, side))
        off_m = np.array([np.linalg.norm(self.tube.surface_m - place_m, axis=1).min() for place_m in palms_m])
        short_m = np.maximum(np.linalg.norm(wrists_m - shoulder_m, axis=1) - arm_m(skeleton, side), 0.0)
        # A palm farther from the tube is as wrong as one that lacks that distance to it.
        wrong_m = short_m + np.maximum(off_m - off_m[0] - OFF_M, 0.0)
        tried = np.flatnonzero(shifts_m >= min(least_m, most_m) - 1e-9)
        return float(shifts_m[tried[int(wrong_m[tried].round(4).argmin())]])


def _is_whole(character: Character, hand: HandHold) -> bool:
    """Return whether no finger of a hand bends and the hand is on no slide."""
    return hand.motion is None and not any(bends(character, hand.side, finger) for finger in FINGERS)
