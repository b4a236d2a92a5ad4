"""The part of a dance that a wind player can perform while playing: hips, trunk and head around the player's place.

A dancer walks and turns around; a player stands with a mouthpiece at the lips. So the motion is taken relative to the
dancer's facing, spins are limited, and motion slower than a phrase (path, facing, posture) is removed. The rest is
scaled down to `MOST` phrase by phrase, so that a large motion does not reduce distant ones, and rare extremes are
limited softly.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.motion.by_hand.pose_corrections import within
from app.motion.gestures.dance_layer import CHANNELS, BodyLayer
from app.motion.gestures.danced_feet import DancedFeet
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.model import Character
from app.rig.skeleton import forward
from app.rig.sole import SIDES

FPS: Final = Fraction(30)
"""Sampling rate of a layer in frames per second; its motion is below 4 Hz."""
MOST: Final = {
    "side_m": 0.11,
    "ahead_m": 0.045,
    "up_m": 0.015,
    "hips_forward_rad": float(np.deg2rad(7.0)),
    "hips_turn_rad": float(np.deg2rad(16.0)),
    "hips_left_rad": float(np.deg2rad(9.0)),
    "trunk_forward_rad": float(np.deg2rad(6.0)),
    "trunk_turn_rad": float(np.deg2rad(12.5)),
    "trunk_left_rad": float(np.deg2rad(8.0)),
    "head_forward_rad": float(np.deg2rad(8.0)),
    "head_turn_rad": float(np.deg2rad(16.0)),
    "head_left_rad": float(np.deg2rad(8.0)),
}
"""Greatest motion of a player at full amount to either side, for feet that stay in place and a bell that moves no more
than by nodding.
"""
FASTEST_M_S: Final = 0.8
FASTEST_TURN_RAD_S: Final = 2.5
FASTEST_LEAN_RAD_S: Final = 1.3
"""Greatest considered speeds of the dancer; faster motion such as a spin counts as this fast."""
SLOW_S: Final = 1.5
"""Standard deviation in seconds of the window whose mean is removed as place, facing and posture."""
SMOOTH_S: Final = 0.04
"""Length in seconds of the window that removes the tremor of a capture, which a bell half a metre from the lips would
magnify.
"""
USUAL: Final = 0.95
"""Share of the motion that is within `USUAL_SHARE`."""
USUAL_SHARE: Final = 0.85
"""Share of `MOST` within which the usual motion is."""
PHRASE_S: Final = 2.0
"""Standard deviation in seconds of the window over which motion is scaled equally."""


def body_layer(motion: Motion, character: Character, feet: DancedFeet | None = None) -> BodyLayer:
    """Derive from a dance the layer of body motion that a player performs while playing.

    Parameters
    ----------
    motion : Motion
        Motion of a dancer with the same body (`app.choreography.retarget`).
    feet : DancedFeet, optional
        Feet of the player, which influence the layer.
    """
    fps, skeleton = float(motion.fps), character.skeleton
    chest = skeleton.parents[skeleton.index("leftShoulder")]
    hips, head = skeleton.index("hips"), skeleton.index("head")
    posed = forward(
        skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64), (hips, chest, head)
    )
    turned = {name: posed.of(joint)[1] for name, joint in (("hips", hips), ("trunk", chest), ("head", head))}
    facing = _facing_rad(turned["hips"])
    raw = _path(_middle_m(motion, character), facing)
    home = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), -facing)
    for name, rotations in turned.items():
        vector = quaternion.to_rotation_vector(quaternion.multiply(home, rotations))
        turn = facing if name == "hips" else facing + vector[:, 1]
        for angle, values in (("forward", vector[:, 0]), ("turn", turn), ("left", -vector[:, 2])):
            raw[f"{name}_{angle}_rad"] = np.unwrap(values)
    columns = {}
    for name in CHANNELS:
        columns[name] = _held(_about_its_mean(raw[name], fps, _fastest(name)), MOST[name], fps)
    values = np.stack([columns[name] for name in CHANNELS], axis=1)
    if len(values) == 1:
        values = np.repeat(values, 2, axis=0)
    return BodyLayer(motion.first_frame_s, 1.0 / fps, values, DancedFeet.none() if feet is None else feet)


def _middle_m(motion: Motion, character: Character) -> FloatArray:
    """Midpoint (F, 3) between both hip joints in every frame, in metres."""
    skeleton = character.skeleton
    offset = np.mean([skeleton.offsets_m[skeleton.index(f"{side}UpperLeg")] for side in SIDES], axis=0)
    turned = motion.rotations[:, skeleton.index("hips")].astype(np.float64)
    middle: FloatArray = motion.hips_m + quaternion.rotate(turned, offset)
    return middle


def _facing_rad(hips: FloatArray) -> FloatArray:
    """Return the facing (F,) of the hips in radians, continuous through turns."""
    _, twist = quaternion.swing_twist(hips, np.array([0.0, 1.0, 0.0]))
    return np.unwrap(2.0 * np.arctan2(twist[:, 1], twist[:, 3]))


def _path(hips_m: FloatArray, facing: FloatArray) -> dict[str, FloatArray]:
    """Path of the hips by channel, with every step taken relative to the dancer's facing at that time."""
    steps = np.diff(hips_m, axis=0)
    middle = 0.5 * (facing[1:] + facing[:-1])
    side = np.cos(middle) * steps[:, 0] - np.sin(middle) * steps[:, 2]
    ahead = np.sin(middle) * steps[:, 0] + np.cos(middle) * steps[:, 2]
    along = {"side_m": side, "ahead_m": ahead, "up_m": steps[:, 1]}
    return {name: np.concatenate(([0.0], np.cumsum(values))) for name, values in along.items()}


def _fastest(channel: str) -> float:
    if channel.endswith("_m"):
        return FASTEST_M_S
    return FASTEST_TURN_RAD_S if "turn" in channel else FASTEST_LEAN_RAD_S


def _about_its_mean(values: FloatArray, fps: float, fastest: float) -> FloatArray:
    """Band-pass filter values (F,): removes slow motion, and motion too fast for a player (``fastest`` per second)."""
    speeds = np.diff(values) * fps
    kept = np.concatenate(([0.0], np.cumsum(within(speeds, fastest, fastest)))) / fps
    smooth = gaussian_filter1d(kept, SMOOTH_S * fps, mode="nearest")
    result: FloatArray = smooth - gaussian_filter1d(kept, SLOW_S * fps, mode="nearest")
    return result


def _held(values: FloatArray, most: float, fps: float) -> FloatArray:
    """Scale values (F,) down phrase by phrase, never up, until they are usually within ``most``; extremes are limited
    softly.
    """
    sizes = np.sqrt(gaussian_filter1d(np.square(values), PHRASE_S * fps, mode="nearest"))
    if not sizes.all():
        return values
    usual = sizes * np.quantile(np.abs(values) / sizes, USUAL)
    return within(np.minimum(1.0, USUAL_SHARE * most / usual) * values, most, most)
