"""Grip of one body on one instrument: fixed hand frames, finger poses over the controls, the lips.

A `GripPose` is fitted once per character and instrument (`app.rig.grip.fitting.fit.fit_hold`) and then only evaluated,
vectorised over frames:

1. ``Lips.contact_m`` gives where the lips are in the head's frame; with the head's transform and the requested rotation
of
   the instrument that gives ``world_from_instrument``.
2. `hand_targets` gives ``world_from_hand`` of both wrists (a hand that lies on a moving node moves with it).
3. `app.rig.ik.solve_limb` turns a shoulder and a target into rotations of upper arm, lower arm and hand;
   ``HandHold.elbow_direction`` is the comfortable pole.
4. `app.rig.grip.finger_poses.finger_rotations` gives the fingers by interpolation of tables over the values of the
controls,
   one for every place (`app.rig.grip.finger_stations`) a finger goes to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.rig import quaternion
from app.rig.quaternion import interpolated

Side = Literal["left", "right"]


@dataclass(frozen=True)
class NodeMotion:
    """Motion of a node of the instrument with one control, in the instrument's frame.

    The node's transform is a translation by ``value * travel_m`` or a rotation by ``value * angle_rad`` about the axis
    ``axis`` through ``pivot_m``; the other one is zero.
    """

    control: str
    travel_m: FloatArray
    axis: FloatArray
    angle_rad: float
    pivot_m: FloatArray


@dataclass(frozen=True)
class Chain:
    """The joints of a finger, to bring it somewhere.

    Attributes
    ----------
    offsets_m : (joints, 3) float64
        Each from the one above, the first from the wrist.
    axes : (joints, 3, 3) float64
        Flexion, sideways and twist axis of each (rows).
    dofs : (D, 2) float64
        The angles that move: joint and which of its axes.
    low, high : (D,) float64
        Their ranges, radians.
    """

    offsets_m: FloatArray
    axes: FloatArray
    dofs: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class StationTable:
    """Poses of one finger at one of its stations over the value of what it works there.

    Attributes
    ----------
    controls : tuple of str
        What moves it, all at once; empty where the finger does not move and the table has one row.
    hovers : bool
        Whether the finger waits over what it works: the first row is then as high as it ever waits.
    values : (S,) float64
        Ascending, from 0 to 1.
    rotations : (S, joints, 4) float64
        ``parent_from_joint``, xyzw, each sample in the hemisphere of the one before.
    tip_joint : int
        The joint, of the finger's, that carries what touches; -1 where it touches nothing.
    tip_m : (3,) float64
        What touches, in that joint's frame.
    away_m : (3,) float64
        By how much a finger is lifted half way between home and here, in the wrist's frame ...
    waits_m : (3,) float64
        ... and while it waits here for a hand that will give way for it.
    """

    controls: tuple[str, ...]
    hovers: bool
    values: FloatArray
    rotations: FloatArray
    tip_joint: int = -1
    tip_m: FloatArray = field(default_factory=lambda: np.zeros(3))
    away_m: FloatArray = field(default_factory=lambda: np.zeros(3))
    waits_m: FloatArray = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True)
class FingerTable:
    """Poses of a finger at all its stations.

    Attributes
    ----------
    finger : str
        E.g. ``"right.index"``.
    joints : tuple of int
        Joints of the skeleton, from the palm outwards.
    stations : tuple of StationTable
        Home first; in the order of `app.rig.grip.finger_stations.stations`.
    chain : Chain or None
        Of a hand that gives way for its fingers.
    """

    finger: str
    joints: tuple[int, ...]
    stations: tuple[StationTable, ...]
    chain: Chain | None = None


class StationBlend(NamedTuple):
    """Position of a finger between two of its stations, frame by frame.

    ``before`` and ``after`` (F,) are places in ``FingerTable.stations``, ``share`` (F,) is 0 at the first and 1 at the
    second.
    """

    before: FloatArray
    after: FloatArray
    share: FloatArray


@dataclass(frozen=True)
class ContactFit:
    """Accuracy of one contact of the map, the worst over the samples of its control.

    ``distance_m`` is from the landmark on the deformed mesh to the touch point, ``angle_rad`` between the pad's outward
    normal and the reversed normal of the surface: of a finger that hovers, when its control is fully worked;
    ``waits_m`` is how far from the touch point it waits then.
    """

    part: str
    node: str
    control: str | None
    firm: bool
    distance_m: float
    angle_rad: float
    together: tuple[str, ...] = ()
    waits_m: float = 0.0


@dataclass(frozen=True)
class WristOffset:
    """Offset of a hand that lets one finger reach one of its stations.

    Attributes
    ----------
    station : int
        Its place in ``FingerTable.stations``; that table is for the wrist that has given way.
    moved_m, turned : (3,) float64
        What is added to the wrist's place in the instrument's frame, and the rotation vector it is turned by there. The
        other fingers stay where they are (`app.rig.grip.finger_poses`).
    beside : tuple of (str, int)
        Of other fingers the stations that they must be at as well. Such a lean comes on top of those of the single
        fingers: what gives way for each of them alone need not do for both.
    """

    finger: str
    station: int
    moved_m: FloatArray
    turned: FloatArray
    beside: tuple[tuple[str, int], ...] = ()

    @property
    def places(self) -> tuple[tuple[str, int], ...]:
        """The fingers it is for, and their stations."""
        return (self.finger, self.station), *self.beside


@dataclass(frozen=True)
class HandHold:
    """Grip of one hand on the instrument.

    Attributes
    ----------
    side : str
        ``"left"`` or ``"right"``.
    node : str
        The node the hand moves with (``"root"``, or a slide's).
    motion : NodeMotion or None
        How that node moves; None where the hand rests on the root.
    instrument_from_hand_m, instrument_from_hand_rotation : (S, 3) and (S, 4) float64
        The hand joint (the wrist) in the instrument's frame, before its node moves. One row; or, for a hand that a
        control carries, one per value of ``values``: the grip turns in the fingers as the arm stretches.
    elbow_direction : (3,) float64
        Unit pole: where the elbow points off the line from shoulder to wrist, in the frame of the player (+Z ahead,
        +X left, +Y up), chosen for a straight wrist.
    penetration_m : float
        Deepest vertex of hand and fingers inside the instrument's proxy, over all samples.
    values : (S,) float64
        Values of the control in ``motion`` at which the wrist is given; ascending, from 0.
    """

    side: Side
    node: str
    motion: NodeMotion | None
    instrument_from_hand_m: FloatArray
    instrument_from_hand_rotation: FloatArray
    fingers: tuple[FingerTable, ...]
    elbow_direction: FloatArray
    contacts: tuple[ContactFit, ...]
    penetration_m: float
    values: FloatArray = field(default_factory=lambda: np.zeros(1))
    leans: tuple[WristOffset, ...] = ()


@dataclass(frozen=True)
class Lips:
    """Place of an instrument on the lips, in the frame of the head joint, linear in the morph weights.

    Attributes
    ----------
    contact_rest_m : (3,) float64
        Where the mouthpiece is while it is played.
    contact_deltas_m, carrier_deltas_m : dict of str to (3,) float64
        What each morph at weight 1 adds; morphs that do nothing here are absent. The carrier has the mouthpiece alone
        while the mouth is open for a breath: the upper lip, or the lower one under which a plate lies.
    usual_m : (3,) float64
        About where the mouthpiece is while it is played, whatever the face's weights.
    apart_m : float
        Height of what lies between the lips.
    opening_m : float
        Height of the opening that playing lips leave beside it.
    gap_rest_m : float
        From the lower lip's edge up to the upper one's in the middle of the mouth, along the mouthpiece's up axis ...
    gap_deltas_m : dict of str to float
        ... and what each morph at weight 1 adds; empty where the lips are neither held apart nor open.
    jaw : str
        The morph that opens the mouth.
    """

    contact_rest_m: FloatArray
    contact_deltas_m: Mapping[str, FloatArray]
    carrier_deltas_m: Mapping[str, FloatArray]
    usual_m: FloatArray
    apart_m: float = 0.0
    opening_m: float = 0.0
    gap_rest_m: float = 0.0
    gap_deltas_m: Mapping[str, float] = field(default_factory=dict)
    jaw: str = ""

    def contact_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return (F, 3) the mouthpiece's place in the head's frame for weight curves (F,) by morph name."""
        return _weighted(self.contact_rest_m, self.contact_deltas_m, morphs, frames)

    def carried_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return (F, 3) the place as one lip alone carries it: what the mouthpiece stays on when the mouth opens.

        Equal to `contact_m` where no morph moves the lips.
        """
        carried = _weighted(np.zeros(3), self.carrier_deltas_m, morphs, frames)
        carried += self.contact_rest_m
        return carried

    def gap_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return (F,) how far the lips are apart in the middle of the mouth; negative where they are pressed."""
        gap = np.full(frames, self.gap_rest_m)
        for name, delta in self.gap_deltas_m.items():
            if name in morphs:
                gap += delta * np.asarray(morphs[name], dtype=np.float64)
        return gap

    def jaw_for(self, gap_m: FloatArray, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return (F,) the weight of `jaw` that brings the lips this far apart, beside all the other weights."""
        others = {name: values for name, values in morphs.items() if name != self.jaw}
        needed: FloatArray = (gap_m - self.gap_m(others, frames)) / self.gap_deltas_m[self.jaw]
        return np.clip(needed, 0.0, 1.0)


@dataclass(frozen=True)
class GripPose:
    """A character's hold of an instrument; see the module."""

    character_id: str
    instrument_id: str
    hands: tuple[HandHold, ...]
    lips: Lips

    @property
    def finger_joints(self) -> tuple[int, ...]:
        """The joints `app.rig.grip.finger_poses` poses, in its order."""
        return tuple(joint for hand in self.hands for finger in hand.fingers for joint in finger.joints)


def hand_targets(
    hand: HandHold,
    world_from_instrument_m: FloatArray,
    world_from_instrument_rotation: FloatArray,
    controls: Mapping[str, AnyFloatArray],
    placed: Mapping[str, StationBlend] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Place a hand on a moving instrument.

    Parameters
    ----------
    world_from_instrument_m, world_from_instrument_rotation : (F, 3) and (F, 4) float64
    controls : dict of str to (F,)
        Values 0..1; a control that is absent is at 0.
    placed : mapping of str to StationBlend, optional
        Where the fingers are that are not at home: the hand may give way for them.

    Returns
    -------
    positions_m, rotations : (F, 3) and (F, 4) float64
        ``world_from_hand``.
    """
    places, turns = np.atleast_2d(hand.instrument_from_hand_m), np.atleast_2d(hand.instrument_from_hand_rotation)
    local, turn = places[0], turns[0]
    motion = hand.motion
    if motion is not None and motion.control in controls:
        value = np.clip(np.asarray(controls[motion.control], dtype=np.float64), 0.0, 1.0)
        if len(hand.values) > 1:
            local = quaternion.columns(*(np.interp(value, hand.values, places[:, axis]) for axis in range(3)))
            turn = interpolated(hand.values, turns[:, None], value)[:, 0]
        if motion.angle_rad:
            moved = quaternion.from_rotation_vector(np.multiply.outer(motion.axis, value * motion.angle_rad).T)
            local = motion.pivot_m + quaternion.rotate(moved, local - motion.pivot_m)
            turn = quaternion.multiply(moved, turn)
        else:
            local = local + np.multiply.outer(motion.travel_m, value).T
    given = [(offset, weight) for offset in hand.leans for weight in [given_way(offset, placed)] if weight is not None]
    if given:
        local, turn = wrist_given(hand, given)
    positions = world_from_instrument_m + quaternion.rotate(world_from_instrument_rotation, local)
    return positions, quaternion.multiply(world_from_instrument_rotation, turn)


def giving_for(finger: str) -> str:
    """Name of the `StationBlend` of the hand that gives way for a finger; without it, the hand goes with the finger."""
    return f"{finger}.hand"


def given_way(offset: WristOffset, placed: Mapping[str, StationBlend] | None) -> FloatArray | None:
    """Return how far (F,) a hand gives way, 0..1; None where it never does."""
    return _all_at(offset, placed, [giving_for(finger) for finger, _ in offset.places])


def come_to(offset: WristOffset, placed: Mapping[str, StationBlend] | None) -> FloatArray | None:
    """Return how far (F,) fingers have come to where their hand gives way for them, 0..1; None where they never do."""
    return _all_at(offset, placed, [finger for finger, _ in offset.places])


def _all_at(offset: WristOffset, placed: Mapping[str, StationBlend] | None, names: Sequence[str]) -> FloatArray | None:
    weight: FloatArray | None = None
    for (finger, station), name in zip(offset.places, names, strict=True):
        where = None if placed is None else placed.get(name, placed.get(finger))
        share = None if where is None else _share_at(where, station)
        if share is None:
            return None
        weight = share if weight is None else weight * share
    return weight


def _share_at(where: StationBlend, station: int) -> FloatArray | None:
    """Return how far (F,) a finger is at one of its stations, 0..1; None where it never is."""
    weight: FloatArray = (where.after == station) * where.share + (where.before == station) * (1.0 - where.share)
    return weight if np.any(weight) else None


def wrist_given(hand: HandHold, given: Sequence[tuple[WristOffset, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Wrist (F, 3) and (F, 4) of a hand on the root, in the instrument's frame, as far (F,) as it gives way."""
    place, turn = np.atleast_2d(hand.instrument_from_hand_m), np.atleast_2d(hand.instrument_from_hand_rotation)
    if not given:
        return place, turn
    moved = np.sum([np.multiply.outer(weight, offset.moved_m) for offset, weight in given], axis=0)
    turned = np.sum([np.multiply.outer(weight, offset.turned) for offset, weight in given], axis=0)
    return place + moved, quaternion.multiply(quaternion.from_rotation_vector(turned), turn)


def _weighted(
    rest: FloatArray, deltas: Mapping[str, FloatArray], morphs: Mapping[str, AnyFloatArray], frames: int
) -> FloatArray:
    result = quaternion.repeated(rest, frames)
    components = result.T
    for name, delta in deltas.items():
        if name in morphs:
            components += np.multiply.outer(delta, np.asarray(morphs[name], dtype=np.float64))
    return result
