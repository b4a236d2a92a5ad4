"""Records of a map that say how the instrument is held: contacts, where hands start, solids, and how it is carried.

Frames are those of `instrument_maps.model`.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, TypeVar

from instrument_maps.map_table import Hand, MapTable, Posture, Vector

_Kind = TypeVar("_Kind")


class Contact(MapTable, frozen=True):
    """A part of a hand that touches the instrument.

    Attributes
    ----------
    part : str
        One of `PARTS`.
    node : str
        The node that is touched (`ROOT` or the node of a control): position and normal are in its frame.
    position_m, normal : vector
        A point of the surface and the unit normal that points out of it, towards the skin.
    control : str or None
        The control this touch works, if any. A finger may work several, each with a touch of its own; the first in
        the file is where it is at home. Thumb and little fingers go from one to the other.
    together : tuple of str
        Other controls that the same finger works at the same time in this place (a thumb on hole and register key).
    when : str
        ``"always"``; ``"pressed"``: only while the control is away from rest; ``"released"``: only at rest.
    grip : str
        ``"firm"``: the touch that carries or works the instrument, exact. ``"resting"``: the part lies
        against the surface where the hand allows it (judged as the hand's grip, not as a touch). ``"guide"``, never in
        a file: about here lies a part that cannot bend, and no one judges it (a mitten's finger).
    """

    part: str
    node: str
    position_m: Vector
    normal: Vector
    control: str | None = None
    together: tuple[str, ...] = ()
    when: Literal["always", "pressed", "released"] = "always"
    grip: Literal["firm", "resting", "guide"] = "firm"


class HandSeed(MapTable, frozen=True):
    """Pose from which a solver starts a hand: plausible for a medium hand, not a contact.

    ``palm_position_m`` is the middle of the palm's skin, ``palm_normal`` points out of the palm,
    ``finger_direction`` from the wrist to the knuckles; in the frame of ``node``. ``curl`` is the bend of the
    fingers without a contact: 0 straight, 1 a fist; in the order index, middle, ring, little.
    ``elbow_off_ribs_deg`` is the swing of the elbow to the outside; None as the body's posture has it.
    """

    hand: Hand
    node: str
    palm_position_m: Vector
    palm_normal: Vector
    finger_direction: Vector
    curl: tuple[float, float, float, float] = (0.35, 0.4, 0.45, 0.45)
    elbow_off_ribs_deg: float | None = None


class Capsule(MapTable, frozen=True, tag="capsule", tag_field="shape"):
    """A tube or bar: all points within ``radius_m`` of the segment ``a_m``..``b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cylinder(MapTable, frozen=True, tag="cylinder", tag_field="shape"):
    """A flat-ended round body between ``a_m`` and ``b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cone(MapTable, frozen=True, tag="cone", tag_field="shape"):
    """A flat-ended round body whose radius goes from ``radius_a_m`` to ``radius_b_m``."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_a_m: float
    radius_b_m: float


class Ring(MapTable, frozen=True, tag="ring", tag_field="shape"):
    """A torus about ``axis``: ``radius_m`` to the middle of its tube, which is ``tube_radius_m`` thick."""

    node: str
    centre_m: Vector
    axis: Vector
    radius_m: float
    tube_radius_m: float


class Box(MapTable, frozen=True, tag="box", tag_field="shape"):
    """A box with half sizes ``half_m`` along the unit vectors ``x_axis``, ``y_axis`` and their cross product."""

    node: str
    centre_m: Vector
    half_m: Vector
    x_axis: Vector
    y_axis: Vector


Proxy: TypeAlias = Capsule | Cylinder | Cone | Ring | Box
"""A closed body that stands for a part of the model when a hand is checked against it."""


class Carriage(MapTable, frozen=True):
    """Carriage of the instrument while playing, as (lowest, usual, highest) angles in degrees.

    From the horizontal, straight ahead of the player: ``pitch_down_deg`` bell below the mouthpiece,
    ``yaw_left_deg`` bell to the player's left, ``roll_left_deg`` the instrument's up leaning to the left.
    Applied in the order yaw, pitch, roll.

    How the player turns to it, in degrees: ``head_left_deg`` the head to the left of the trunk, ``head_lean_left_deg``
    its ear towards the left shoulder, ``trunk_left_deg`` the shoulders to the left of the feet.
    """

    pitch_down_deg: Vector
    yaw_left_deg: Vector
    roll_left_deg: Vector
    head_left_deg: float = 0.0
    head_lean_left_deg: float = 0.0
    trunk_left_deg: float = 0.0


class LoweredPlace(MapTable, frozen=True):
    """Place of the instrument in a long rest.

    ``offset_m`` is the mouthpiece's place relative to where it is while playing, in the player's frame
    (left, up, ahead); the angles are as in `Carriage`.
    """

    offset_m: Vector
    pitch_down_deg: float
    yaw_left_deg: float
    roll_left_deg: float


class Hold(MapTable, frozen=True):
    """Hold of the instrument by a trained player.

    ``support_hand`` bears its weight. ``standing`` and ``seated`` are for playing; the two ``lowered``
    tables are for long rests. An instrument that is only played seated has no tables for standing, and the other way
    round.

    ``free_hand``: which hand can leave the instrument while it is lowered, and comes past it to the music; None: the
    one that does not bear its weight.

    ``size_range``: a player with small hands or short arms gets it smaller, one with large hands larger, but never
    beyond these multiples of the model's size.
    """

    support_hand: Hand
    standing: Carriage | None = None
    seated: Carriage | None = None
    lowered_standing: LoweredPlace | None = None
    lowered_seated: LoweredPlace | None = None
    size_range: tuple[float, float] = (0.5, 1.25)
    free_hand: Literal["left", "right", "none"] | None = None

    @property
    def leaving_hand(self) -> Hand | None:
        """The hand that can leave the lowered instrument: what else holds it bears it meanwhile. None: neither."""
        if self.free_hand is None:
            return "left" if self.support_hand == "right" else "right"
        return None if self.free_hand == "none" else self.free_hand

    @property
    def postures(self) -> tuple[Posture, ...]:
        """In what the instrument is played, the usual one first."""
        both: tuple[tuple[Posture, Carriage | None], ...] = (("standing", self.standing), ("seated", self.seated))
        return tuple(posture for posture, carriage in both if carriage is not None)

    def possible(self, posture: Posture) -> Posture:
        """The posture itself, or the only one the instrument is played in."""
        return posture if posture in self.postures else self.postures[0]

    def carriage(self, posture: Posture) -> Carriage:
        """Return how it is carried, in the only posture it is played in where the requested one is not possible."""
        return self._either(posture, self.standing, self.seated)

    def lowered(self, posture: Posture) -> LoweredPlace:
        """Return where it is in a long rest; likewise."""
        return self._either(posture, self.lowered_standing, self.lowered_seated)

    @staticmethod
    def _either(posture: Posture, standing: _Kind | None, seated: _Kind | None) -> _Kind:
        requested, other = (seated, standing) if posture == "seated" else (standing, seated)
        found = other if requested is None else requested
        if found is None:
            raise ValueError("a map without any posture")
        return found
