"""The part of a dance that a wind player can do while playing: hips, trunk and head, around the player's place.

A dancer walks, turns round and looks everywhere; a player stands and has a mouthpiece at the lips. So the motion is
taken relative to itself: speeds are seen from where the dancer faces, those of spins are cut, and what is slower than
a phrase (the way over the stage, the facing, the usual bearing) is left out. What remains is made smaller until it is
within `MOST`, phrase by phrase, so that a large motion does not make those long before and after it small, and the rare
extremes end softly.
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
"""Sampling rate of a layer: its motion is below 4 Hz."""
MOST: Final = {
    "side_m": 0.11,
    "ahead_m": 0.045,
    "up_m": 0.012,
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
"""Most that a player at full amount moves to either side: on feet that stay, and with a bell that rises and sinks by no
more than the trunk nods."""
FASTEST_M_S: Final = 0.8
FASTEST_TURN_RAD_S: Final = 2.5
FASTEST_LEAN_RAD_S: Final = 1.3
"""Limits of the dancer's speed: faster motion, such as a spin, counts as this fast."""
SLOW_S: Final = 1.5
"""Width (the standard deviation) of the window whose mean is taken for the place, the facing and the bearing."""
SMOOTH_S: Final = 0.04
"""Length of the window that removes the tremor of a capture, in seconds: a bell half a metre from the lips would
show it."""
USUAL: Final = 0.95
"""Share of the motion that is within ..."""
USUAL_SHARE: Final = 0.85
"""... this share of `MOST`."""
PHRASE_S: Final = 2.0
"""Standard deviation of the window whose motion is made smaller alike."""


def body_layer(motion: Motion, character: Character, feet: DancedFeet | None = None) -> BodyLayer:
    """The layer of a dance.

    Parameters
    ----------
    motion : Motion
        Of a dancer of the same body (`app.choreography.retarget`).
    feet : DancedFeet, optional
        What the player's feet do to it.
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
    """(F, 3) the middle of the hip joints."""
    skeleton = character.skeleton
    offset = np.mean([skeleton.offsets_m[skeleton.index(f"{side}UpperLeg")] for side in SIDES], axis=0)
    turned = motion.rotations[:, skeleton.index("hips")].astype(np.float64)
    middle: FloatArray = motion.hips_m + quaternion.rotate(turned, offset)
    return middle


def _facing_rad(hips: FloatArray) -> FloatArray:
    """(F,) which way the hips face, counted on through turns."""
    _, twist = quaternion.swing_twist(hips, np.array([0.0, 1.0, 0.0]))
    return np.unwrap(2.0 * np.arctan2(twist[:, 1], twist[:, 3]))


def _path(hips_m: FloatArray, facing: FloatArray) -> dict[str, FloatArray]:
    """Return where the hips go, by channel: every step as it is seen from where the dancer faces then."""
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
    """Band-pass filter: removes what is faster than a player moves, and what is slow."""
    speeds = np.diff(values) * fps
    kept = np.concatenate(([0.0], np.cumsum(within(speeds, fastest, fastest)))) / fps
    smooth = gaussian_filter1d(kept, SMOOTH_S * fps, mode="nearest")
    result: FloatArray = smooth - gaussian_filter1d(kept, SLOW_S * fps, mode="nearest")
    return result


def _held(values: FloatArray, most: float, fps: float) -> FloatArray:
    """Made smaller phrase by phrase until it is usually well within its bound, which the rest keeps softly; never
    larger."""
    sizes = np.sqrt(gaussian_filter1d(np.square(values), PHRASE_S * fps, mode="nearest"))
    if not sizes.all():
        return values
    usual = sizes * np.quantile(np.abs(values) / sizes, USUAL)
    return within(np.minimum(1.0, USUAL_SHARE * most / usual) * values, most, most)
