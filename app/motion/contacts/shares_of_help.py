"""Distributes the help for a far hand over trunk, shoulders, head and instrument, smoothed over time."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.arms_off_trunk import Outward
from app.motion.contacts.help_for_far_hands import Help
from app.motion.curves.soft_bounds import softly_capped
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES

HELP_EASE_S = 0.10
"""Seconds before a hand moves far out at which trunk and shoulders begin to help, and after its return at which they
end.
"""
SHOULDER_EASE_S = 0.08
"""Same time in seconds for the shoulder, which is lighter; in less it would turn the arm faster than people do."""
OUT_EASE_S = 0.28
"""Seconds before an elbow has to be clear of the trunk, or out beside a shoulder that reaches forward, at which it
begins to move, and after at which it is back: its way is long, and in less time it would be flung."""
BACK_EASE_S = 0.14
"""Same time in seconds in which an elbow that is out of thick clothes keeps to what its wrist allows."""
SLIDE_OUT_EASE_S = 0.12
"""Same time in seconds for the elbow of a hand that moves a slide: it moves with the hand anyway."""
ROOM_EASE_S = 0.06
"""Seconds in which the help recedes for a hand that comes near."""
HELP_EASE_RAD = 0.06
"""Range in radians over which help is limited that would push a shoulder into a near hand."""
HIPS_TURN = 0.16
TRUNK_TURNS = {"spine": 0.18, "chest": 0.34, "upperChest": 0.32}
"""Shares of the trunk's joints in the rotation towards a far hand."""
NECK_TURNS_BACK = {"neck": 0.5, "head": 0.5}
DRAWS_RAD = {"neck": float(np.deg2rad(-8.0)), "head": float(np.deg2rad(14.0))}
"""Angles in radians by which the neck draws back and the head bows for the farthest places; leaning the trunk would
bring shoulder and lips no nearer to each other.
"""
DRAW_DOWN_RAD, DRAW_RIGHT_RAD = float(np.deg2rad(6.0)), float(np.deg2rad(8.0))
"""Angles in radians by which the bell sinks and turns towards the far hand's shoulder."""


def smoothed_help(parts: list[Help], half: int) -> Help:
    """Join the needed help of consecutive stretches of frames (``parts``), smoothed so that it begins early and changes
    slowly: over ``half`` frames before and after, less for shoulders.
    """
    quick = max(1, round(ROOM_EASE_S / HELP_EASE_S * half))
    swift = max(1, round(SHOULDER_EASE_S / HELP_EASE_S * half))
    sides = parts[0].protraction_rad.keys()
    return Help(
        turn_rad=_eased(np.concatenate([part.turn_rad for part in parts]), half),
        short_m=_eased(np.concatenate([part.short_m for part in parts]), half),
        protraction_rad={
            side: _eased(np.concatenate([part.protraction_rad[side] for part in parts]), swift) for side in sides
        },
        most_turn_rad={side: _held_back([part.most_turn_rad[side] for part in parts], quick) for side in sides},
        most_protraction_rad={
            side: _held_back([part.most_protraction_rad[side] for part in parts], quick) for side in sides
        },
    )


def smoothed_outward(
    outward: Outward, half: int, moving: Collection[str] = (), swift: int = 0, back: int | None = None
) -> dict[str, FloatArray]:
    """Return the turn (F,) of each elbow out of the trunk's way, by side, in radians: early, slow, and no farther than
    its wrist allows.

    Parameters
    ----------
    half : int
        Number of frames before and after over which the turn begins and ends.
    moving : collection of str
        Sides of hands that move along something, whose elbows go along ``swift`` frames before and after instead.
    back : int, optional
        Number of frames before and after over which other elbows keep to what their wrists allow; as many as ``half``
        by default.
    """
    turns_rad: dict[str, FloatArray] = {}
    for side, needed_rad in outward.needed_rad.items():
        over, kept = (swift, swift) if side in moving else (half, half if back is None else back)
        turns_rad[side] = with_room(_eased(needed_rad, over), _held_back([outward.most_rad[side]], kept))
    return turns_rad


def partly_slow(quick_rad: FloatArray, slow_rad: FloatArray, share: FloatArray, half: int) -> FloatArray:
    """Return an elbow's motion (F,) between a quick and a slow one: the least ``share`` (F,) of the slow one within
    ``half`` frames, smoothly."""
    return quick_rad + np.clip(_held_back([share], half), 0.0, 1.0) * (slow_rad - quick_rad)


def elbows_along(parts: list[Help], half: int) -> dict[str, FloatArray]:
    """Return the forward motion (F,) of each shoulder that its elbow goes along with, by side, in radians: as much as
    the shoulder needs by then, early and slowly over ``half`` frames before and after.
    """
    along_rad: dict[str, FloatArray] = {}
    for side in parts[0].protraction_rad:
        along_rad[side] = _eased(np.concatenate([part.protraction_rad[side] for part in parts]), half)
    return along_rad


def turned_to_far_hand(motion: BodyMotion, turn: FloatArray, aside_per_turn: float) -> BodyMotion:
    """Turn hips and trunk to the left by ``turn`` (F,) and neck and head back. Where the head is kept in place, the
    trunk also leans to the other side by ``aside_per_turn``, with the head upright.
    """
    turns, leans = dict(motion.turn_rad), dict(motion.left_rad)
    for shares, sign in ((TRUNK_TURNS, 1.0), (NECK_TURNS_BACK, -1.0)):
        for joint, share in shares.items():
            turns[joint] = turns[joint] + sign * share * turn
    lean = -aside_per_turn * motion.steadied * np.sin(turn)
    for shares, sign in ((TRUNK_SHARES, 1.0), (NECK_SHARES, -1.0)):
        for joint, share in shares.items():
            leans[joint] = leans[joint] + sign * share * lean
    return replace(motion, hips_turn_rad=motion.hips_turn_rad + HIPS_TURN * turn, turn_rad=turns, left_rad=leans)


def leaned_to_far_hand(motion: BodyMotion, draw: FloatArray, right: FloatArray) -> BodyMotion:
    """Move head and instrument towards a far hand: by the share ``draw`` (F,) 0..1, to the side ``right`` (F,), 1 for
    the right hand and -1 for the left.
    """
    forward = dict(motion.forward_rad)
    for joint, angle_rad in DRAWS_RAD.items():
        forward[joint] = forward[joint] + angle_rad * draw
    return replace(
        motion,
        forward_rad=forward,
        bell_down_rad=motion.bell_down_rad + DRAW_DOWN_RAD * draw,
        bell_right_rad=motion.bell_right_rad + DRAW_RIGHT_RAD * right * draw,
    )


def with_room(help_rad: FloatArray, most_rad: FloatArray) -> FloatArray:
    """Limit the help (F,) that other joints give an arm, in radians, softly to the available room ``most_rad``. Zero
    help stays zero, so results do not depend on the span of frames.
    """
    given = softly_capped(help_rad, most_rad, np.clip(most_rad, 1e-9, HELP_EASE_RAD))
    return np.where(help_rad == 0.0, 0.0, given)


def _held_back(parts: list[FloatArray], half: int) -> FloatArray:
    """Smooth lower envelope (F,) of the joined ``parts``: the minimum within ``half`` frames, then a
    smoothing as wide.
    """
    return np.pi - _eased(np.pi - np.concatenate(parts), half)


def _eased(needed: FloatArray, half: int) -> FloatArray:
    """Smooth upper envelope (F,) of ``needed`` (F,): the maximum within ``half`` frames, then a smoothing as wide.

    The outer ``2 * half`` frames are not valid.
    """
    if not np.any(needed):
        return needed
    held = greatest_within(np.maximum(needed, 0.0), half)
    if needed.min() < 0.0:
        held = held + least_within(np.minimum(needed, 0.0), half)
    weights = np.hanning(2 * half + 3)
    eased: FloatArray = np.convolve(held, weights / weights.sum(), mode="same")
    return eased


def greatest_within(values: FloatArray, half: int) -> FloatArray:
    """Maximum (F,) within ``half`` frames of each value, mirrored at the ends; equals `scipy.ndimage` without importing
    it.
    """
    found, window, width = _symmetric(values, half), 2 * half + 1, 1
    while width < window:
        # Windows double in width, and the last one covers the remainder.
        step = min(width, window - width)
        found = np.maximum(found[:-step], found[step:])
        width += step
    return found


def _symmetric(values: FloatArray, half: int) -> FloatArray:
    """Extend values (F,) at each end by ``half`` mirrored ones, to (F + 2 half,)."""
    if half > len(values):
        return np.pad(values, half, mode="symmetric")
    return np.concatenate((values[:half][::-1], values, values[len(values) - half :][::-1]))


def least_within(values: FloatArray, half: int) -> FloatArray:
    """Minimum (F,) within ``half`` frames of each value, mirrored at the ends."""
    return -greatest_within(-values, half)
