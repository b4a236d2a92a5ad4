"""Grip of one body on one instrument: fixed hand frames, finger poses over the controls, lips.

A `GripPose` is fitted once per character and instrument (`app.rig.grip.fitting.fit.fit_hold`) and then evaluated for
all frames at once:

1. ``Lips.contact_m`` gives the lips in the head's frame; with the head's transform and the requested rotation of the
   instrument this gives ``world_from_instrument``.
2. `hand_targets` gives ``world_from_hand`` of both wrists (a hand on a moving node moves with it).
3. `app.rig.ik.solve_limb` converts a shoulder and a target to rotations of upper arm, lower arm and hand;
   ``HandHold.elbow_direction`` is the comfortable pole.
4. `app.rig.grip.finger_poses.finger_rotations` interpolates the fingers in tables over the values of the controls, one
   for every station (`app.rig.grip.finger_stations`) of a finger.
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
    ``axis`` through ``pivot_m``; the value that does not apply is zero.
    """

    control: str
    travel_m: FloatArray
    axis: FloatArray
    angle_rad: float
    pivot_m: FloatArray


@dataclass(frozen=True)
class Chain:
    """The joints of a finger for inverse kinematics.

    Attributes
    ----------
    offsets_m : (joints, 3) float64
        Offset of each joint from the one above, the first from the wrist.
    axes : (joints, 3, 3) float64
        Flexion, sideways and twist axis of each joint (rows).
    dofs : (D, 2) float64
        Movable angles: index of the joint, and index of the axis.
    low, high : (D,) float64
        Least and greatest value of each movable angle, radians.
    """

    offsets_m: FloatArray
    axes: FloatArray
    dofs: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class StationTable:
    """Poses of one finger at one station over the value of its controls there.

    Attributes
    ----------
    controls : tuple of str
        Controls that move the finger simultaneously; empty if the finger does not move and the table has one row.
    hovers : bool
        Whether the finger waits above its controls: the first row is then at the greatest height.
    values : (S,) float64
        Values of the controls, ascending from 0 to 1.
    rotations : (S, joints, 4) float64
        ``parent_from_joint``, xyzw, each sample in the hemisphere of the previous one.
    tip_joint : int
        Joint within the finger that carries the touching point; -1 if there is none.
    tip_m : (3,) float64
        Touching point in that joint's frame.
    away_m : (3,) float64
        Lift of the finger halfway between home and this station, in the wrist's frame.
    waits_m : (3,) float64
        Lift of the finger while it waits for an offset of its hand.
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
        Side and finger, such as ``"right.index"``.
    joints : tuple of int
        Joints of the skeleton, from the palm outwards.
    stations : tuple of StationTable
        Home first; in the order of `app.rig.grip.finger_stations.stations`.
    chain : Chain or None
        Joints for inverse kinematics; only for a hand with wrist offsets.
    """

    finger: str
    joints: tuple[int, ...]
    stations: tuple[StationTable, ...]
    chain: Chain | None = None


class StationBlend(NamedTuple):
    """Position of a finger between two of its stations, frame by frame.

    ``before`` and ``after`` (F,) are indices in ``FingerTable.stations``; ``share`` (F,) is 0 at the first and 1 at the
    second.
    """

    before: FloatArray
    after: FloatArray
    share: FloatArray


@dataclass(frozen=True)
class ContactFit:
    """Accuracy of one contact of the map: the worst over the samples of its control.

    ``distance_m`` is from the landmark on the deformed mesh to the touch point, ``angle_rad`` between the pad's outward
    normal and the reversed normal of the surface; for a hovering finger, when its control is fully worked. ``waits_m``
    is its distance from the touch point while waiting.
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
    """Offset of a wrist by which a finger can reach one of its stations.

    Attributes
    ----------
    station : int
        Index in ``FingerTable.stations``; the poses there are for the offset wrist.
    moved_m, turned : (3,) float64
        Translation of the wrist in the instrument's frame, and rotation vector about it. The other fingers stay in
        place (`app.rig.grip.finger_poses`).
    beside : tuple of (str, int)
        Further (finger, station) for an offset that applies only when both fingers are there; it is added to their
        single offsets.
    """

    finger: str
    station: int
    moved_m: FloatArray
    turned: FloatArray
    beside: tuple[tuple[str, int], ...] = ()

    @property
    def places(self) -> tuple[tuple[str, int], ...]:
        """Pairs of finger and station that need this offset of the wrist."""
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
        Motion of that node; None if the hand is on the root.
    instrument_from_hand_m, instrument_from_hand_rotation : (S, 3) and (S, 4) float64
        Hand joint (wrist) in the instrument's frame before its node moves: one row, or one per value in ``values`` for
        a hand moved by a control, since the grip rotates in the fingers as the arm stretches.
    elbow_direction : (3,) float64
        Unit direction of the elbow from the line of shoulder and wrist, in the player's frame (+Z ahead, +X left, +Y
        up), chosen for a straight wrist.
    penetration_m : float
        Deepest vertex of hand and fingers inside the instrument's proxy, over all samples.
    values : (S,) float64
        Values of the control in ``motion`` for which the wrist is given; ascending from 0.
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
    """Position of an instrument at the lips in the frame of the head joint, linear in the morph weights.

    Attributes
    ----------
    contact_rest_m : (3,) float64
        Position of the mouthpiece during playing.
    contact_deltas_m, carrier_deltas_m : dict of str to (3,) float64
        Displacement by each morph at weight 1; morphs without influence are omitted. The carrier supports the
        mouthpiece while the mouth is open for a breath: the upper lip, or the lower lip under which a lip plate lies.
    usual_m : (3,) float64
        Approximate position of the mouthpiece during playing, independent of the morph weights.
    apart_m : float
        Height in metres of the part of the mouthpiece that is between the lips.
    opening_m : float
        Height in metres of the opening between the lips next to the mouthpiece during playing.
    gap_rest_m : float
        Distance from the edge of the lower lip to that of the upper lip in the middle of the mouth, along the
        mouthpiece's up axis.
    gap_deltas_m : dict of str to float
        Change of that distance by each morph at weight 1; empty if the lips are neither held apart nor open.
    jaw : str
        Morph that opens the mouth.
    vowels : tuple of str
        Other morphs that open it on a face without a shape that closes the lips, such as one with mouth shapes by
        vowel.
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
    vowels: tuple[str, ...] = ()

    def contact_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return the mouthpiece's position (F, 3) in the head's frame for morph weights (F,) by name."""
        return _weighted(self.contact_rest_m, self.contact_deltas_m, morphs, frames)

    def carried_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return the mouthpiece's position (F, 3) in the head's frame if only one lip carries it, used while the mouth
        opens.

        Equal to `contact_m` if no morph moves the lips.
        """
        carried = _weighted(np.zeros(3), self.carrier_deltas_m, morphs, frames)
        carried += self.contact_rest_m
        return carried

    def gap_m(self, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return the distance (F,) in metres between the lips in the middle of the mouth; negative if they press
        together.
        """
        gap = np.full(frames, self.gap_rest_m)
        for name, delta in self.gap_deltas_m.items():
            if name in morphs:
                gap += delta * np.asarray(morphs[name], dtype=np.float64)
        return gap

    def jaw_for(self, gap_m: FloatArray, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return the weight (F,) of the morph `jaw` at which the lips are ``gap_m`` apart, with all other weights
        given.
        """
        others = {name: values for name, values in morphs.items() if name != self.jaw}
        needed: FloatArray = (gap_m - self.gap_m(others, frames)) / self.gap_deltas_m[self.jaw]
        return np.clip(needed, 0.0, 1.0)

    def share_of_vowels(self, gap_m: FloatArray, morphs: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
        """Return the share (F,) 0..1 of the weights of `vowels` at which the lips are not more than ``gap_m`` apart
        while the jaw is closed, with all other weights given.
        """
        opened = np.zeros(frames)
        for name in self.vowels:
            if name in morphs:
                opened += self.gap_deltas_m[name] * np.asarray(morphs[name], dtype=np.float64)
        others = {name: values for name, values in morphs.items() if name != self.jaw and name not in self.vowels}
        left_m = np.maximum(gap_m - self.gap_m(others, frames), 0.0)
        share: FloatArray = np.divide(left_m, opened, out=np.ones(frames), where=opened > left_m)
        return share


@dataclass(frozen=True)
class GripPose:
    """A character's grip on an instrument: both hands, the lips, and the accuracy of the contacts.

    ``slid_m`` has the distances in metres by which hands lie nearer to the mouthpiece than usual, by side
    (`app.rig.grip.whole_hands`).
    """

    character_id: str
    instrument_id: str
    hands: tuple[HandHold, ...]
    lips: Lips
    slid_m: Mapping[str, float] = field(default_factory=dict)

    @property
    def finger_joints(self) -> tuple[int, ...]:
        """Return the joints posed by `app.rig.grip.finger_poses` in its order."""
        return tuple(joint for hand in self.hands for finger in hand.fingers for joint in finger.joints)


def hand_targets(
    hand: HandHold,
    world_from_instrument_m: FloatArray,
    world_from_instrument_rotation: FloatArray,
    controls: Mapping[str, AnyFloatArray],
    placed: Mapping[str, StationBlend] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Return the place of a hand on a moving instrument.

    Parameters
    ----------
    world_from_instrument_m, world_from_instrument_rotation : (F, 3) and (F, 4) float64
        Position and rotation of the instrument in the world.
    controls : dict of str to (F,)
        Values 0..1 by control; missing controls are at 0.
    placed : mapping of str to StationBlend, optional
        Positions of fingers that are not at home; the hand may be offset for them.

    Returns
    -------
    positions_m, rotations : (F, 3) and (F, 4) float64
        Position and rotation of the wrist in the world.
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
    """Return the key under which the mapping ``placed`` of `hand_targets` has the motion of a wrist offset made for a
    finger.

    Without such an entry, the wrist moves together with the finger.
    """
    return f"{finger}.hand"


def given_way(offset: WristOffset, placed: Mapping[str, StationBlend] | None) -> FloatArray | None:
    """Return the applied share (F,), 0..1, of a wrist offset; None if it is never applied.

    ``placed`` has the position between stations by finger, and that of the hand by the names of `giving_for`.
    """
    return _all_at(offset, placed, [giving_for(finger) for finger, _ in offset.places])


def come_to(offset: WristOffset, placed: Mapping[str, StationBlend] | None) -> FloatArray | None:
    """Return the share (F,), 0..1, by which all fingers of a wrist offset have reached its stations; None if they never
    do.

    ``placed`` is the position between stations by finger.
    """
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
    """Return the share (F,) by which a finger is at one of its stations, 0..1; None if never."""
    weight: FloatArray = (where.after == station) * where.share + (where.before == station) * (1.0 - where.share)
    return weight if np.any(weight) else None


def wrist_given(hand: HandHold, given: Sequence[tuple[WristOffset, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Return position (F, 3) and rotation (F, 4) of a wrist in the instrument's frame, with offsets applied by their
    shares (F,).
    """
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
