"""Elbows that go out beside a reaching shoulder, and out of the trunk's way, early and slowly.

How far they have to go is seen some frames apart, at the same frames in every span.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.arms_off_trunk import Outward, outward, slow_share
from app.motion.contacts.help_for_far_hands import Help
from app.motion.contacts.instrument_put_aside import AsidePlace
from app.motion.contacts.shares_of_help import (
    BACK_EASE_S,
    OUT_EASE_S,
    SHOULDER_EASE_S,
    SLIDE_OUT_EASE_S,
    elbows_along,
    partly_slow,
    smoothed_outward,
)
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.upper_body import UpperBody

OUT_SEEN_S = 0.10
"""Interval in seconds at which the turns of elbows away from the trunk are computed."""
SLIDE_OUT_SEEN_S = 0.05
"""Same interval in seconds for a player of a slide, whose wrist is soon at the end of its range."""
SLOWER_RAD = float(np.deg2rad(0.05))
"""Angle in radians between a slow and a quick shoulder beside which it is not asked whether the wrist lets its elbow
be slow."""


def seen_every(fps: Fraction, apart_s: float = OUT_SEEN_S) -> int:
    """Frames apart at which it is seen how far elbows have to go out."""
    return max(1, math.floor(apart_s * fps))


def with_elbows_along(
    player: StillPlayer, curves: ContactCurves, upper: UpperBody, needed: list[Help], fps: Fraction, first_frame: int
) -> BodyMotion:
    """Body motion with elbows that go outwards beside a reaching shoulder, slowly where their wrists allow it."""
    half, quickly = (math.ceil(seconds * fps) for seconds in (OUT_EASE_S, SHOULDER_EASE_S))
    slow_rad, quick_rad = elbows_along(needed, half), elbows_along(needed, quickly)
    if not any(np.any(along) for along in slow_rad.values()):
        return curves.body
    apart, frames = seen_every(fps), np.arange(len(curves))
    seen = frames[-first_frame % apart :: apart]
    differing = np.array([np.abs(slow - quick_rad[side])[seen] > SLOWER_RAD for side, slow in slow_rad.items()])
    asked = np.flatnonzero(differing.any(axis=0))
    shares = {side: np.ones(len(seen)) for side in slow_rad}
    if len(asked):
        there = seen[asked]
        quick = replace(curves, body=replace(curves.body, elbow_along_rad=quick_rad))
        there_rad = {side: slow[there] for side, slow in slow_rad.items()}
        for side, share in slow_share(player, quick[there], upper[there], there_rad).items():
            shares[side][asked] = share
    along_rad: dict[str, FloatArray] = {}
    for side, share in shares.items():
        whole = np.interp(frames, frames[seen], share)
        along_rad[side] = partly_slow(quick_rad[side], slow_rad[side], whole, quickly)
    return replace(curves.body, elbow_along_rad=along_rad)


def with_elbows_off_trunk(
    player: StillPlayer,
    curves: ContactCurves,
    upper: UpperBody,
    fps: Fraction,
    first_frame: int,
    put_aside: AsidePlace | None,
) -> BodyMotion:
    """Body motion with elbows smoothly turned out of the trunk's way. It is seen at the same frames in every span."""
    moving = {hand.side for hand in player.grip.hands if hand.motion is not None}
    apart, frames = seen_every(fps, SLIDE_OUT_SEEN_S if moving else OUT_SEEN_S), np.arange(len(curves))
    half = math.ceil(OUT_EASE_S * fps)
    seen = slice(-first_frame % apart, len(curves), apart)
    # An elbow is out up to 2 half before and after, where the greatest turn is the least of as many frames.
    within = math.ceil(4 * half / apart) + 1
    found = outward(player, curves[seen], upper[seen], put_aside, within)
    if found is None:
        return curves.body
    needed_rad, most_rad = (
        {side: np.interp(frames, frames[seen], turn) for side, turn in turns.items()}
        for turns in (found.needed_rad, found.most_rad)
    )
    tight = player.shape is not None and player.shape.tight
    back = math.ceil(BACK_EASE_S * fps) if tight else half
    swift = math.ceil(SLIDE_OUT_EASE_S * fps)
    turned_rad = smoothed_outward(Outward(needed_rad, most_rad), half, moving, swift, back)
    return replace(curves.body, elbow_out_rad=turned_rad)
