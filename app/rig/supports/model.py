"""Straps and chairs as values: meshes on bones of their own, and what each of these bones follows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from app.arrays import FloatArray
from app.rig.mesh import Mesh

BoneRole: TypeAlias = Literal["still", "joint", "top", "middle", "end", "cord"]
"""A bone keeps its place, follows a joint, or is one of a strap: at the body, in the middle and at the end of a leg, or
the cord between its legs and the instrument."""


@dataclass(frozen=True, eq=False)
class SupportBone:
    """A bone of straps and chair; unturned in the pose they were made in.

    Attributes
    ----------
    place_m : (3,) float64
        In that pose.
    joint : int
        Of the character, of role ``joint``.
    strap, leg : int
        Of the strap's own bones: which strap, and which of its legs.
    """

    name: str
    role: BoneRole
    place_m: FloatArray
    joint: int = -1
    strap: int = -1
    leg: int = -1


@dataclass(frozen=True, eq=False)
class StrapLeg:
    """The free part of a band, from where it leaves the body to where the legs meet.

    Attributes
    ----------
    joints : (K,) int and (K,) float64
        Joints that carry its upper end, and their shares; none: it is tied to the seat.
    top_m : (3,) float64
        Its upper end in the pose the strap was made in.
    out : (3,) float64
        The way that it bows, in that pose: away from the body.
    low_bow_m : float
        How far the control point in its middle goes out where the instrument is lowered, so that it lies on the body.
    """

    joints: tuple[int, ...]
    shares: tuple[float, ...]
    top_m: FloatArray
    out: FloatArray
    low_bow_m: float = 0.0


@dataclass(frozen=True, eq=False)
class Hook:
    """A place of one of the musician's instruments where a strap is hooked in.

    Attributes
    ----------
    instrument : int
        Which of the musician's instruments.
    at_m : (3,) float64
        In the instrument's frame.
    """

    instrument: int
    at_m: FloatArray


@dataclass(frozen=True, eq=False)
class Strap:
    """A strap: legs that meet, and a cord from there to the hook.

    Attributes
    ----------
    kind : str
        `instrument_maps.hold.SupportKind`.
    hooks : tuple of Hook
        Of the instruments that are played with it; it hangs on the nearest.
    cord_m : float
        Length of the cord; 0: the leg itself ends at the hook.
    root_m, meet_m, hook_m : (3,) float64
        What it hangs from, where the legs meet, and its lower end, in the pose it was made in.
    turning : int
        The joint that turns it; -1: it is tied to the seat.
    low_m : (3,) float64
        Its lower end with the instrument lowered, as the body is in that pose.
    hanging_m : (3,) float64
        Its lower end where it is not hooked in, in that pose.
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
    """Straps and chair of a musician, in the pose they were made in, in the player's frame.

    Attributes
    ----------
    kinds : tuple of str
        What there is: kinds of straps, and ``chair``.
    meshes : tuple of Mesh
        One of each kind; `Mesh.joints` are numbers of bones.
    bones : tuple of SupportBone
    straps : tuple of Strap
    joints : (J, 3, 4) float64
        ``world_from_joint`` of all joints in that pose.
    """

    kinds: tuple[str, ...]
    meshes: tuple[Mesh, ...]
    bones: tuple[SupportBone, ...]
    straps: tuple[Strap, ...]
    joints: FloatArray
