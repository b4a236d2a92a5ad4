"""Tables of a map about holding the instrument: contacts, initial hand poses, solids, carriage.

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
        Part of the hand, one of `PARTS`.
    node : str
        Touched node (`ROOT` or the node of a control), in whose frame position and normal are given.
    position_m, normal : vector
        Point on the surface, and outward unit normal.
    control : str or None
        Control worked by this touch, if any. A finger may work several controls by different touches; the first in the
        file is its home. Thumb and little fingers move between them.
    together : tuple of str
        Other controls worked at the same time by the same finger in this place (a thumb on hole and register key).
    when : str
        ``"always"``; ``"pressed"``: only while the control is away from rest; ``"released"``: only at rest.
    grip : str
        ``"firm"``: an exact touch that carries or works the instrument. ``"resting"``: the part lies on the surface as
        far as the hand allows (judged like the hand's grip and not like a touch). ``"guide"``, never in a file:
        approximate place of a part that cannot bend, not judged (a mitten's finger).
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
    """Initial pose of a hand from which the solver finds the grip: plausible for a medium hand, without exact contacts.

    ``palm_position_m`` is the middle of the palm's skin, ``palm_normal`` points out of the palm, ``finger_direction``
    from the wrist to the knuckles; in the frame of ``node``. ``curl`` is the bend of fingers without contact: 0
    straight, 1 a fist; in the order index, middle, ring, little. ``elbow_off_ribs_deg`` is the outward swing of the
    elbow; None for that of the body's posture.
    """

    hand: Hand
    node: str
    palm_position_m: Vector
    palm_normal: Vector
    finger_direction: Vector
    curl: tuple[float, float, float, float] = (0.35, 0.4, 0.45, 0.45)
    elbow_off_ribs_deg: float | None = None


class Capsule(MapTable, frozen=True, tag="capsule", tag_field="shape"):
    """A solid shape in the frame of a node: all points within ``radius_m`` of the segment ``a_m``..``b_m``, for tubes
    and bars.
    """

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cylinder(MapTable, frozen=True, tag="cylinder", tag_field="shape"):
    """A solid cylinder with flat ends at the points ``a_m`` and ``b_m``, in the frame of a node."""

    node: str
    a_m: Vector
    b_m: Vector
    radius_m: float


class Cone(MapTable, frozen=True, tag="cone", tag_field="shape"):
    """A solid cone with flat ends, whose radius changes from ``radius_a_m`` to ``radius_b_m``, in the frame
    of a node.
    """

    node: str
    a_m: Vector
    b_m: Vector
    radius_a_m: float
    radius_b_m: float


class Ring(MapTable, frozen=True, tag="ring", tag_field="shape"):
    """A solid ring (torus) about ``axis``, in the frame of a node: ``radius_m`` is from the centre to the middle of its
    tube, ``tube_radius_m`` the tube's radius.
    """

    node: str
    centre_m: Vector
    axis: Vector
    radius_m: float
    tube_radius_m: float


class Box(MapTable, frozen=True, tag="box", tag_field="shape"):
    """A solid box, in the frame of a node, with half sizes ``half_m`` along the unit vectors ``x_axis``, ``y_axis`` and
    their cross product.
    """

    node: str
    centre_m: Vector
    half_m: Vector
    x_axis: Vector
    y_axis: Vector


Proxy: TypeAlias = Capsule | Cylinder | Cone | Ring | Box
"""A closed body that represents a part of the model in collision checks with a hand."""


class Carriage(MapTable, frozen=True):
    """Orientation of the instrument and of the player's body while playing; each field is (lowest, usual, highest) in
    degrees.

    From the horizontal, straight ahead of the player: ``pitch_down_deg`` bell below the mouthpiece, ``yaw_left_deg``
    bell to the player's left, ``roll_left_deg`` the instrument's up axis leaning to the left. Applied in the order yaw,
    pitch, roll.

    The player's orientation in degrees: ``head_left_deg`` head turned left relative to the trunk,
    ``head_lean_left_deg`` head tilted to the left shoulder, ``trunk_left_deg`` shoulders turned left relative to the
    feet.
    """

    pitch_down_deg: Vector
    yaw_left_deg: Vector
    roll_left_deg: Vector
    head_left_deg: float = 0.0
    head_lean_left_deg: float = 0.0
    trunk_left_deg: float = 0.0


class LoweredPlace(MapTable, frozen=True):
    """Place of the instrument while it is lowered in a long rest.

    ``offset_m`` is the mouthpiece's place relative to that during playing, in the player's frame (left, up, forward);
    the angles are as in `Carriage`.
    """

    offset_m: Vector
    pitch_down_deg: float
    yaw_left_deg: float
    roll_left_deg: float


SupportKind: TypeAlias = Literal["neck_strap", "harness", "seat_strap"]
"""Kind of support: a band around the neck; a band over both shoulders and around the ribs; a band on the seat under the
player.
"""


class Support(MapTable, frozen=True):
    """A strap or band that bears the instrument.

    ``hook_m`` is the point of the instrument where it is attached, in the root frame; ``postures`` are the postures in
    which it is used.
    """

    kind: SupportKind
    hook_m: Vector
    postures: tuple[Posture, ...] = ("standing", "seated")


class Hold(MapTable, frozen=True):
    """Posture in which a trained player holds the instrument.

    ``support_hand`` carries the weight. ``standing`` and ``seated`` are for playing; the two ``lowered`` tables are for
    long rests. An instrument that is only played seated has no tables for standing, and vice versa.

    ``free_hand``: hand that can leave the lowered instrument and reach past it to the music; None for the one that does
    not carry the weight.

    ``supports``: the straps it hangs on.

    ``size_range``: limits of the factor by which the instrument is scaled for a player with small hands or short arms,
    or with large hands.
    """

    support_hand: Hand
    standing: Carriage | None = None
    seated: Carriage | None = None
    lowered_standing: LoweredPlace | None = None
    lowered_seated: LoweredPlace | None = None
    size_range: tuple[float, float] = (0.5, 1.25)
    free_hand: Literal["left", "right", "none"] | None = None
    supports: tuple[Support, ...] = ()

    @property
    def leaving_hand(self) -> Hand | None:
        """Return the hand that can leave the lowered instrument, which the other hand or a strap still carries; None if
        neither can.
        """
        if self.free_hand is None:
            return "left" if self.support_hand == "right" else "right"
        return None if self.free_hand == "none" else self.free_hand

    @property
    def postures(self) -> tuple[Posture, ...]:
        """Return the postures in which the instrument is played, the usual one first."""
        both: tuple[tuple[Posture, Carriage | None], ...] = (("standing", self.standing), ("seated", self.seated))
        return tuple(posture for posture, carriage in both if carriage is not None)

    def possible(self, posture: Posture) -> Posture:
        """Return ``posture`` if the instrument is played in it, else the only possible one."""
        return posture if posture in self.postures else self.postures[0]

    def carriage(self, posture: Posture) -> Carriage:
        """Return the carriage for a posture; if the instrument is not played in it, for the only possible one."""
        return self._either(posture, self.standing, self.seated)

    def lowered(self, posture: Posture) -> LoweredPlace:
        """Return the place of the lowered instrument for a posture; if the instrument is not played in it, for the only
        possible one.
        """
        return self._either(posture, self.lowered_standing, self.lowered_seated)

    def worn(self, posture: Posture) -> tuple[Support, ...]:
        """Return the straps on which the instrument hangs when it is played in a posture."""
        return tuple(one for one in self.supports if posture in one.postures)

    @staticmethod
    def _either(posture: Posture, standing: _Kind | None, seated: _Kind | None) -> _Kind:
        requested, other = (seated, standing) if posture == "seated" else (standing, seated)
        found = other if requested is None else requested
        if found is None:
            raise ValueError("a map without any posture")
        return found
