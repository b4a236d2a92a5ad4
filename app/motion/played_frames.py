"""Frames of a player, sampled from curves or played live, from which poses are solved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.arrays import FloatArray
from app.motion.by_hand.additive_curves import Added
from app.motion.faces.face_curves import Drivers
from app.motion.faces.gaze import GazeFrames
from app.motion.gestures.layers import LayerSamples
from app.rig.grip.grip_pose import StationBlend


@dataclass(frozen=True)
class PlayedFrames:
    """Frames of a player before any contact is solved.

    Attributes
    ----------
    times_s : (F,) float64
        Ascending times in seconds.
    levels, look, face
        Samples of body, eyes and face.
    controls : dict of str to (F,) float64
        Values of the instrument's controls.
    raised : (F,) float64
        Height of waiting fingers above their keys, 0..1.
    danced : (F, 12) float64 or None
        Values of the dance layer; None: no dance.
    stepped : dict of str to (F,) float64
        Motion of dancing feet (`app.motion.gestures.danced_feet`).
    stowed : (F,) float64 or None
        Share by which the instrument is put aside.
    added : dict of str to Added
        Additive curves by channel.
    stopping : (F,) float64 or None
        Closure of the bell by a hand; None: never.
    """

    times_s: FloatArray
    levels: LayerSamples
    look: GazeFrames
    face: Drivers
    controls: dict[str, FloatArray]
    placed: dict[str, StationBlend]
    raised: FloatArray
    danced: FloatArray | None = None
    stepped: Mapping[str, FloatArray] = field(default_factory=dict)
    stowed: FloatArray | None = None
    added: Mapping[str, Added] = field(default_factory=dict)
    stopping: FloatArray | None = None
