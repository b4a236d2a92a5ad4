"""Straps and chairs as values: meshes with bones of their own, and the joint, strap or seat that each bone follows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from app.arrays import FloatArray
from app.rig.mesh import Mesh
from instrument_maps.hold import SupportKind

BoneRole: TypeAlias = Literal["still", "joint", "top", "middle", "end", "cord"]
"""Behaviour of a bone: fixed; following a joint; or part of a strap (at the body, in the middle or at the end of a leg,
or the cord between the legs and the instrument).
"""
GROWN_UP_M = 0.172
"""Half the distance in metres between the shoulder joints of adults, for whom sizes of straps apply."""
FROM_NECK_M: Final[dict[SupportKind, tuple[float, float, float]]] = {
    "neck_strap": (0.0, -0.06, 0.07),
    "harness": (0.0, -0.21, 0.06),
}
"""About the middle of the places at which a strap's bands leave an adult's body, from the base of the neck (left, up,
forward) in metres; none for straps that do not lie on the body.
"""


@dataclass(frozen=True, eq=False)
class SupportBone:
    """A bone of straps and chair; its rotation is the identity in the pose in which they were made.

    Attributes
    ----------
    name : str
        Name in exported files.
    role : str
        Thing that it follows: a joint, nothing, or a part of a strap.
    place_m : (3,) float64
        Position in that pose.
    joint : int
        Joint of the character, for the role ``joint``.
    strap, leg : int
        For a strap's own bones: index of the strap, and of its leg.
    """

    name: str
    role: BoneRole
    place_m: FloatArray
    joint: int = -1
    strap: int = -1
    leg: int = -1


@dataclass(frozen=True, eq=False)
class StrapLeg:
    """The free part of one leg (band) of a strap, from where it leaves the body to where the legs meet.

    Attributes
    ----------
    joints, shares : (K,) int and (K,) float64
        Joints that carry its upper end, and their weights; empty if it is tied to the seat.
    top_m : (3,) float64
        Its upper end in the pose in which the strap was made.
    out : (3,) float64
        Direction in which it bows in that pose: away from the body.
    low_bow_m : float
        Distance by which the control point in its middle moves out when the instrument is lowered, so that the band
        lies on the body.
    """

    joints: tuple[int, ...]
    shares: tuple[float, ...]
    top_m: FloatArray
    out: FloatArray
    low_bow_m: float = 0.0


@dataclass(frozen=True, eq=False)
class Hook:
    """A place on one of the musician's instruments to which a strap is hooked.

    Attributes
    ----------
    instrument : int
        Index among the musician's instruments.
    at_m : (3,) float64
        Position in the instrument's frame.
    """

    instrument: int
    at_m: FloatArray


@dataclass(frozen=True, eq=False)
class Strap:
    """A strap: legs (bands) that meet, and a cord from there to the hook.

    Attributes
    ----------
    kind : str
        Kind, as in `instrument_maps.hold.SupportKind`.
    hooks : tuple of Hook
        Hooks of the instruments that are played with it; it hangs on the nearest.
    cord_m : float
        Length of the cord; 0 if a leg itself ends at the hook.
    root_m, meet_m, hook_m : (3,) float64
        Point from which it hangs, point where the legs meet, and its lower end, in the pose in which it was made.
    turning : int
        Joint with which it rotates; -1 if it is tied to the seat.
    low_m : (3,) float64
        Its lower end with the instrument lowered and the body in that pose.
    hanging_m : (3,) float64
        Its lower end when it is not hooked in, in that pose.
    """

    kind: str
    legs: tuple[StrapLeg, ...]
    hooks: tuple[Hook, ...]
    cord_m: float
    root_m: FloatArray
    meet_m: FloatArray
    hook_m: FloatArray
    turning: int
    low_m: FloatArray
    hanging_m: FloatArray


@dataclass(frozen=True, eq=False)
class Supports:
    """Straps and chair of a musician, in the pose in which they were made, in the player's frame.

    Attributes
    ----------
    kinds : tuple of str
        Kinds of straps, and ``chair`` if there is one.
    meshes : tuple of Mesh
        One mesh for each kind; `Mesh.joints` are indices of ``bones``.
    bones : tuple of SupportBone
        All bones.
    straps : tuple of Strap
        All straps.
    joints : (J, 3, 4) float64
        ``world_from_joint`` of all joints in that pose.
    """

    kinds: tuple[str, ...]
    meshes: tuple[Mesh, ...]
    bones: tuple[SupportBone, ...]
    straps: tuple[Strap, ...]
    joints: FloatArray
