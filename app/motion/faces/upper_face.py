"""Motion of brows, lids, cheeks and nostrils."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.arrays import FloatArray
from app.motion.faces.exertion import Exertion
from app.motion.faces.individual_face import Wandering
from metadata.face_model import FaceMotion

Driver = tuple[FloatArray, Mapping[str, float]]


def upper_face(
    exertion: Exertion,
    inhaling: FloatArray,
    wandering: Wandering,
    looking_down_rad: FloatArray,
    face: FaceMotion,
    size: FloatArray | float,
) -> list[Driver]:
    """Return the motion of brows, lids, cheeks and nostrils as pairs of a curve and the morph weights it drives, scaled
    by the player's ``size``.
    """
    up, down = np.maximum(exertion.contour, 0.0), np.maximum(-exertion.contour, 0.0)
    louder, softer = np.maximum(exertion.swell, 0.0), np.maximum(-exertion.swell, 0.0)
    followed = (
        (exertion.working, face.working),
        (exertion.strain, face.strain),
        (up, face.rising),
        (down, face.falling),
        (louder, face.louder),
        (softer, face.softer),
        (exertion.emptying, face.emptying),
        (exertion.phrase, face.phrase),
        (inhaling, face.inhale),
        (wandering.brows, face.brows),
        (wandering.lids, face.lids),
        (wandering.nose, face.nose),
    )
    drivers: list[Driver] = [(size * driver, weights) for driver, weights in followed if weights]
    if face.lid_per_rad:
        down_rad = np.maximum(looking_down_rad, 0.0)
        drivers.append((face.lid_per_rad * down_rad, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}))
    return drivers
