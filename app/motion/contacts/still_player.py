"""Inputs of the contact solvers: a player without motion, and curves sampled at some frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.arrays import FloatArray, IndexArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.endpin import EndpinStand
from app.motion.contacts.hand_destinations import hands_off_instrument
from app.motion.contacts.hands_away import Away
from app.motion.contacts.instrument_put_aside import Aside
from app.motion.contacts.trunk_and_legs import Side, Stance, Trunk
from app.motion.contacts.wrists import ANYWHERE, BellRoom, Wrist
from app.rig.grip.grip_pose import GripPose, StationBlend
from app.rig.model import Skeleton
from app.rig.trunk_shape import TrunkShape
from instrument_maps.hold import Carriage, LoweredPlace
from instrument_maps.wind import Stopped, Water


@dataclass(frozen=True)
class StillPlayer:
    """All data of a player that do not change over time, from which contacts are solved.

    ``still`` is the posture and ``base`` its trunk, one frame; ``grip_of_lips_m`` (3,) is the displacement of the
    mouthpiece between one lip and both playing lips, in the head's frame. ``stand`` is set for an instrument on the
    floor, ``aside`` if the musician has several. ``water`` is the place of the water key, ``stopped`` the hand position
    that closes the bell. ``most_amplitude`` is the amplitude up to which the arms have room.
    """

    skeleton: Skeleton
    grip: GripPose
    place: Stance
    carriage: Carriage
    lowered: LoweredPlace
    still: BodyMotion
    base: Trunk
    grip_of_lips_m: FloatArray
    wrists: Mapping[Side, Wrist]
    stand: EndpinStand | None = None
    aside: Aside | None = None
    bell_room: BellRoom = ANYWHERE
    water: Water | None = None
    stopped: Stopped | None = None
    shape: TrunkShape | None = None
    most_amplitude: float = 1.0

    @property
    def steps(self) -> bool:
        """Return whether the player may take steps; False with an instrument that stands on its endpin."""
        return self.stand is None

    @property
    def stands_free(self) -> bool:
        """Return whether the hips may move away from their position; False on a seat, and with an instrument that
        stands on its endpin.
        """
        return not self.place.seated and self.stand is None

    def away(self, motion: BodyMotion, carried: InstrumentTransform) -> Away | None:
        """Return the placement of hands that leave the instrument; None if none does."""
        if not motion.hands:
            return None
        return hands_off_instrument(self.skeleton, self.base, motion.hands, carried, self.water, self.stopped)


@dataclass(frozen=True)
class ContactCurves:
    """Inputs of the contact solvers, sampled at equal frames.

    Attributes
    ----------
    controls, morphs : dict of str to (F,) float64
        Values 0..1 of the instrument's controls, and weights of the face's morphs, by name.
    mouth_open : (F,) float64
        Opening of the mouth for a breath.
    placed : dict of str to StationBlend
        Positions of fingers away from their home keys.
    raised : (F,) float64 or float
        Height of waiting fingers above their keys, 0..1.
    stowed : (F,) float64 or None
        Share of the motion of putting the instrument aside, 0..1; None: never.
    """

    body: BodyMotion
    controls: dict[str, FloatArray]
    morphs: dict[str, FloatArray]
    mouth_open: FloatArray
    placed: dict[str, StationBlend] = field(default_factory=dict)
    raised: FloatArray | float = 0.0
    stowed: FloatArray | None = None

    def __len__(self) -> int:
        return len(self.mouth_open)

    def __getitem__(self, frames: slice | IndexArray) -> ContactCurves:
        return ContactCurves(
            self.body[frames],
            {name: values[frames] for name, values in self.controls.items()},
            {name: values[frames] for name, values in self.morphs.items()},
            self.mouth_open[frames],
            {finger: StationBlend(*(values[frames] for values in where)) for finger, where in self.placed.items()},
            self.raised if isinstance(self.raised, float) else self.raised[frames],
            None if self.stowed is None else self.stowed[frames],
        )
