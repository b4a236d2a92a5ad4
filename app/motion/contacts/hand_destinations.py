"""Destinations of hands that leave the lowered instrument (music stand, water key), and the motion to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.hand_in_bell import STOPPING, wrist_shift
from app.motion.contacts.hands_away import Away
from app.motion.contacts.help_for_far_hands import clavicle_of
from app.motion.contacts.trunk_and_legs import SIDES, Side, Trunk
from app.motion.gestures.hand_gestures import PLACES, SHAPES
from app.rig import quaternion
from app.rig.grip.empty_hand_shapes import shaped, tip_m
from app.rig.ik import arm
from app.rig.model import Skeleton
from instrument_maps.wind import Stopped, Water

USUAL_ARM_M: Final = 0.5
"""Length in metres of upper and lower arm of an adult, by which destinations are scaled."""
PAGE_M: Final = np.array([0.0, -0.02, 0.54])
"""Centre of the music relative to the point between the shoulders, in metres, where the eyes read
(`app.motion.faces.gaze`).
"""
ELBOW_M: Final = np.array([0.01, -0.22, 0.07])
"""Approximate position of the elbow of an arm that reaches forward, relative to its shoulder in metres: outwards, up,
forward.
"""
PAGE_PALM: Final = np.array([-0.6, -0.75, 0.25])
"""Direction of the palm that turns a page: outwards, up, forward."""
ELBOW_LOW: Final = np.array([0.5, -1.0, -0.25])
"""Direction of the elbow in which it hangs low: outwards, up, forward."""
KEY_ELBOW: Final = 0.4
"""Share of `ELBOW_LOW` in the elbow's direction for a hand at the water key."""


def hands_off_instrument(
    skeleton: Skeleton,
    base: Trunk,
    hands: Mapping[str, FloatArray],
    carried: InstrumentTransform,
    water: Water | None,
    stopped: Stopped | None,
) -> Away | None:
    """Return the placement of hands that leave the instrument; None if none does.

    Parameters
    ----------
    base : Trunk
        Trunk before any motion, one frame.
    carried : InstrumentTransform
        Placement of the instrument.
    hands : mapping of str to array
        Values from `app.motion.gestures.hand_gestures.limited_hand_gestures`, and the closure of the bell by a hand
        (`STOPPING`).
    water, stopped : Water, Stopped or None
        Place of the water key, and hand position that closes the bell, if the instrument has them.
    """
    found = Away({}, {}, {})
    if stopped is not None and STOPPING in hands:
        found.shifts[stopped.hand] = wrist_shift(skeleton, stopped, hands[STOPPING], carried)
    for side in SIDES:
        if f"{side}.m" not in hands:
            continue
        scale = arm(skeleton, side).length_m / USUAL_ARM_M
        found.offsets_m[side] = scale * hands[f"{side}.m"]
        found.places[side] = []
        low = np.zeros(len(carried.position_m))
        for place in PLACES:
            share = hands.get(f"{side}.{place}")
            if share is None or (place == "key" and (water is None or water.position_m is None)):
                continue
            if place == "page":
                wrist = _at_page(skeleton, side, base, scale, found.offsets_m[side])
                low = low + share
            else:
                assert water is not None
                wrist = _at_key(skeleton, side, base, scale, carried, water)
                low = low + KEY_ELBOW * share
            found.places[side].append((share, *wrist))
        found.elbows[side] = (np.minimum(low, 1.0), _sided(ELBOW_LOW, side))
    return found if found.offsets_m or found.shifts else None


def page_m(skeleton: Skeleton, base: Trunk) -> FloatArray:
    """Centre (3,) of the sheet music in the player's frame, metres."""
    shoulders_m = np.mean([_shoulder_m(skeleton, side, base) for side in SIDES], axis=0)
    middle_m: FloatArray = shoulders_m + arm(skeleton, "left").length_m / USUAL_ARM_M * PAGE_M
    return middle_m


def with_shapes(
    skeleton: Skeleton, hands: Mapping[str, FloatArray], joints: list[int], rotations: FloatArray
) -> FloatArray:
    """Set the finger rotations (F, joints, 4) of hands that have left the instrument to their shapes (open, pinch,
    point); other fingers are unchanged.
    """
    for side in SIDES:
        there = {shape: hands[f"{side}.{shape}"] for shape in SHAPES if f"{side}.{shape}" in hands}
        if not there:
            continue
        # Blended one after another, each by its share of the sum so far.
        mixed = np.maximum(1.0 - np.sum(list(there.values()), axis=0), 0.0)
        for shape, share in there.items():
            mixed = mixed + share
            part = share / np.maximum(mixed, 1e-9)
            for joint, turned in shaped(skeleton, side, shape).items():
                if joint in joints:
                    number = joints.index(joint)
                    both = quaternion.slerp(rotations[:, number], np.broadcast_to(turned, (len(share), 4)), part)
                    rotations[:, number] = np.where(part[:, None] > 0.0, both, rotations[:, number])
    return rotations


def _at_page(
    skeleton: Skeleton, side: Side, base: Trunk, scale: float, offset_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    middle_m = page_m(skeleton, base)
    elbow_m = _shoulder_m(skeleton, side, base) + scale * _sided(ELBOW_M, side)
    turned = _hand(side, middle_m + offset_m - elbow_m, np.broadcast_to(_sided(PAGE_PALM, side), offset_m.shape))
    return middle_m - quaternion.rotate(turned, tip_m(skeleton, side, "pinch")), turned


def _at_key(
    skeleton: Skeleton, side: Side, base: Trunk, scale: float, carried: InstrumentTransform, water: Water
) -> tuple[FloatArray, FloatArray]:
    key_m = carried.position_m + quaternion.rotate(carried.rotation, np.asarray(water.position_m))
    out = quaternion.rotate(carried.rotation, np.asarray(water.normal))
    elbow_m = _shoulder_m(skeleton, side, base) + scale * _sided(ELBOW_M, side)
    along = key_m - elbow_m
    along = along - quaternion.dot(along, out)[:, None] * out
    turned = _hand(side, along, -out)
    return key_m - quaternion.rotate(turned, tip_m(skeleton, side, "point")), turned


def _hand(side: Side, fingers: FloatArray, palm: FloatArray) -> FloatArray:
    """Rotation (F, 4) of a hand whose fingers point along ``fingers`` (F, 3), with the palm facing ``palm`` as nearly
    as possible.
    """
    fingers = fingers / np.linalg.norm(fingers, axis=1, keepdims=True)
    palm = palm - quaternion.dot(palm, fingers)[:, None] * fingers
    palm = palm / np.linalg.norm(palm, axis=1, keepdims=True)
    return quaternion.from_frames(fingers if side == "left" else -fingers, -palm)


def _sided(vector: FloatArray, side: Side) -> FloatArray:
    outwards: FloatArray = vector * np.array([1.0 if side == "left" else -1.0, 1.0, 1.0])
    return outwards


def _shoulder_m(skeleton: Skeleton, side: Side, base: Trunk) -> FloatArray:
    joint, reaches_m = clavicle_of(skeleton, side)
    place_m: FloatArray = (base.chest_m + quaternion.rotate(base.chest, skeleton.offsets_m[joint] + reaches_m))[0]
    return place_m
