"""Weights of the face's morphs (ARKit's 52) from embouchure, breath, tongue, effort, expression and lids.

Every morph is a sum of curves with weights from `metadata`, clipped to 0..1. Finally the jaw is opened so that the lips
close around the mouthpiece, or leave an opening to blow through; this is solved from the effect of the character's own
morphs on its lips.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.motion.faces.face_curves import Drivers
from app.motion.faces.gaze import GazeFrames
from app.motion.faces.individual_face import OwnFace, Wandering, face_of_player
from app.motion.faces.upper_face import Driver, upper_face
from app.plan.acting import Acting
from app.plan.parameters import PlayerParameters
from app.rig.grip.grip_pose import Lips
from metadata.face_model import EmbouchureKind, EmbouchureWeights, FaceMotion
from metadata.model import Body, Expression, at_amplitude

AROUND_FROM, AROUND_BY = 0.32, 0.06
"""Lowering (0..1) of the instrument below which the lips begin to part for it, and below which they have parted."""
EASES: float = 0.5
"""Share by which the tension decreases between notes."""
RECORDED_LIPS: float = 0.08
"""Share of the generated motion of the lips that remains where their motion was recorded."""
TIRED_WANDERS: float = 0.8
"""Additional random motion of tired lips."""


@dataclass(frozen=True)
class FaceSizes:
    """Sizes of one player's facial motion.

    Attributes
    ----------
    embouchure : EmbouchureWeights
        Weights of the instrument's kind of embouchure.
    upper, lips, vibrato : float or (F,) float64
        Size of motion above the mouth, of lip motion within notes, and of a full vibrato.
    """

    own: OwnFace
    motion: FaceMotion
    embouchure: EmbouchureWeights
    upper: FloatArray | float
    lips: FloatArray | float
    vibrato: FloatArray | float

    def shared(self, upper: FloatArray | float, lips: FloatArray | float) -> FaceSizes:
        """Return the sizes scaled by shares 0..1 of the upper face and of the lips, which may vary by frame (F,)."""
        if isinstance(upper, float) and isinstance(lips, float):
            return self
        return replace(self, upper=upper * self.upper, lips=lips * self.lips, vibrato=lips * self.vibrato)


def face_sizes(
    player_id: str,
    parameters: PlayerParameters,
    acting: Acting,
    body: Body,
    kind: EmbouchureKind,
    vibrato: float,
    recorded: bool,
) -> FaceSizes:
    """Compute the sizes of a player's facial motion.

    Parameters
    ----------
    kind, vibrato : str, float
        Kind of embouchure, and usual amount of vibrato on held notes.
    recorded : bool
        Whether a controller recorded the lips.
    """
    motion, embouchure, amplitude = body.face, body.embouchure[kind], parameters.amplitude
    lips = acting.lips * at_amplitude(motion.lips_size, amplitude)
    return FaceSizes(
        own=face_of_player(player_id, parameters.seed, motion, embouchure),
        motion=motion,
        embouchure=embouchure,
        upper=acting.face * at_amplitude(motion.size, amplitude),
        lips=RECORDED_LIPS * lips if recorded else lips,
        vibrato=acting.lips * vibrato,
    )


def face_morphs(
    face: Drivers,
    lips: Lips,
    expressions: Mapping[str, Expression],
    look: GazeFrames,
    lowered: FloatArray,
    sizes: FaceSizes,
    times_s: FloatArray,
) -> dict[str, FloatArray]:
    """Compute the weights (F,) 0..1 of all morphs of a face that move.

    Parameters
    ----------
    lips : Lips
        Lips of the character with the instrument.
    expressions : mapping of str to Expression
        Definitions of the expressions in ``face``.
    look : GazeFrames
        Lids and downward gaze.
    lowered : (F,) float64
        0 with the instrument at the lips, 1 with it lowered.
    """
    inhaling, at_lips, embouchure = face.mouth_open, face.at_lips, sizes.embouchure
    formed = at_lips * (1.0 - 0.9 * inhaling)
    around = formed
    if lips.apart_m > 0.0:
        # A reed or mouthpiece between the lips stays there in a rest unless the instrument is lowered.
        share = np.clip((AROUND_FROM - lowered) / (AROUND_FROM - AROUND_BY), 0.0, 1.0)
        around = share * share * (3.0 - 2.0 * share)
    resting = np.maximum(around - at_lips, 0.0) * (1.0 - 0.9 * inhaling)
    wandering = sizes.own.wandering(times_s)
    drivers = _lips(face, formed, resting, sizes, wandering, times_s)
    drivers += [(face.tongue, embouchure.tongue_stroke), (face.tongue_back, embouchure.tongue_back)]
    drivers.append((inhaling, embouchure.inhale))
    down_rad = look.pitch_rad
    drivers += upper_face(face.exertion, inhaling, wandering, down_rad, sizes.motion, sizes.upper)
    for name, shown in face.expressions.items():
        expression = expressions[name]
        drivers.append((shown if expression.while_playing else shown * (1.0 - at_lips), expression.weights))
    drivers += [(look.left_lid, {"eyeBlinkLeft": 1.0}), (look.right_lid, {"eyeBlinkRight": 1.0})]
    morphs = _mixed(drivers)
    sizes.own.lopsided(morphs, wandering)
    if lips.jaw:
        _part_lips(morphs, lips, around, formed)
    return morphs


def _lips(
    face: Drivers,
    formed: FloatArray,
    resting: FloatArray,
    sizes: FaceSizes,
    wandering: Wandering,
    times_s: FloatArray,
) -> list[Driver]:
    """Return the contributions of the embouchure and of lip motion within notes to the face's morphs, as pairs of a
    curve and morph weights.
    """
    embouchure = sizes.embouchure
    # During a breath the upper lip stays on the mouthpiece.
    alive = sizes.lips * formed * np.square(1.0 - face.mouth_open)
    wanders = 1.0 + TIRED_WANDERS * face.exertion.tired
    given = sizes.lips * embouchure.give * wandering.lips * wanders
    tension = np.clip(face.tension * (1.0 - EASES * face.eased) + given, 0.0, 1.0)
    drivers: list[Driver] = [
        (formed * (1.0 - tension) + resting, embouchure.relaxed),
        (formed * tension, embouchure.tight),
        (formed * face.air, embouchure.air),
        (formed * face.push, embouchure.push),
        (formed * (1.0 - face.air), embouchure.soft),
        (formed * face.effort, embouchure.effort),
        (alive * face.firm, embouchure.onset),
        (alive * wandering.corners * wanders, embouchure.corners),
        (alive * wandering.chin * wanders, embouchure.chin),
        (alive * face.exertion.tired, embouchure.tired),
    ]
    if np.any(sizes.vibrato) and embouchure.vibrato and np.any(face.vibrato):
        swing = sizes.own.vibrato(times_s, wandering)
        drivers.append((sizes.vibrato * formed * face.vibrato * swing, embouchure.vibrato))
    return drivers


def usual_morphs(embouchure: EmbouchureWeights, lips: Lips) -> dict[str, float]:
    """Return the morph weights of a face that plays at medium tension, with the jaw closing the lips around the
    mouthpiece."""
    morphs = {name: np.array([weight]) for name, weight in embouchure.usual.items()}
    one = np.ones(1)
    if lips.jaw:
        _part_lips(morphs, lips, one, one)
    return {name: float(values[0]) for name, values in morphs.items()}


def _part_lips(morphs: dict[str, FloatArray], lips: Lips, around: FloatArray, formed: FloatArray) -> None:
    """Set the weight of the jaw in ``morphs`` so that the lips have the required distance, plus the opening for a
    breath; reduce vowels that alone would part them further. ``around`` and ``formed`` (F,) are the degrees, 0..1, to
    which the lips enclose the mouthpiece and form an opening.
    """
    apart_m = lips.apart_m + lips.opening_m * formed
    shown = [name for name in lips.vowels if name in morphs]
    if shown:
        share = 1.0 - around * (1.0 - lips.share_of_vowels(apart_m, morphs, len(around)))
        morphs.update({name: share * morphs[name] for name in shown})
    needed = lips.jaw_for(apart_m, morphs, len(around))
    beyond = morphs.get(lips.jaw, np.zeros(len(around)))
    morphs[lips.jaw] = np.clip(around * needed + beyond, 0.0, 1.0)


def _mixed(drivers: Sequence[Driver]) -> dict[str, FloatArray]:
    morphs: dict[str, FloatArray] = {}
    for driver, weights in drivers:
        made: dict[float, FloatArray] = {}
        for name, weight in weights.items():
            if weight == 0.0:
                continue
            if weight not in made:
                made[weight] = weight * driver
            if name in morphs:
                morphs[name] += made[weight]
            else:
                morphs[name] = made[weight].copy()
    for values in morphs.values():
        np.clip(values, 0.0, 1.0, out=values)
    return morphs
