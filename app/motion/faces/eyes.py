"""Directs both eyes at a target, and converts directions to weights of ARKit's eyeLook shapes.

A target is a point in the player's space, so that eyes stay on it while the head moves and converge on near targets. A
shape at full weight turns an eye by `SHAPES_RAD`; in between, vertices move linearly, and weights are chosen so that
the centre of the iris is exactly in the line of sight.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, Literal, TypeAlias, get_args

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.motion.curves.soft_bounds import softly_capped
from app.rig import quaternion
from app.rig.model import Skeleton

EyeSide: TypeAlias = Literal["left", "right"]
EYE_SIDES: Final[tuple[EyeSide, ...]] = get_args(EyeSide)

SHAPES_RAD: Final[Mapping[str, float]] = {name: math.radians(deg) for name, deg in
                                          {"In": 40.0, "Out": 40.0, "Up": 30.0, "Down": 35.0}.items()}  # fmt: skip
"""Rotation of an eye in radians by a shape at weight 1; ARKit does not define it."""
ASIDE_RAD, UP_RAD, DOWN_RAD = 0.6, 0.47, 0.56
"""Greatest rotation of the eyes in the head in radians: sideways, up, down."""
_EASE_RAD: Final = 0.05
NEAREST_M: Final = 0.2
"""Least distance in metres at which the eyes converge."""
USUAL_EYE_M: Final = np.array([0.03, 0.035, 0.076])
"""Position of a left eye relative to the joint of an adult's head in metres, for skeletons without eyes."""


def shape_name(side: EyeSide, way: str) -> str:
    """Return ARKit's name of the morph that turns an eye ``In``, ``Out``, ``Up`` or ``Down`` (``way``)."""
    return f"eyeLook{way}{side.capitalize()}"


EYE_SHAPES: Final = tuple(shape_name(side, way) for side in EYE_SIDES for way in SHAPES_RAD)


def eye_joint(side: EyeSide) -> str:
    """Name of the joint of an eye."""
    return f"{side}Eye"


def eyes_from_head_m(skeleton: Skeleton) -> dict[EyeSide, FloatArray]:
    """Positions (3,) of the eyes in the head's frame; average ones if the skeleton has no eyes."""
    mirrored = np.array([-1.0, 1.0, 1.0])
    found: dict[EyeSide, FloatArray] = {"left": USUAL_EYE_M, "right": USUAL_EYE_M * mirrored}
    if all(eye_joint(side) in skeleton.names for side in EYE_SIDES):
        found = {side: np.asarray(skeleton.offsets_m[skeleton.index(eye_joint(side))]) for side in EYE_SIDES}
    return found


def directions_to(
    target_m: FloatArray, head: FloatArray, head_m: FloatArray, eyes_m: Mapping[EyeSide, FloatArray]
) -> dict[EyeSide, FloatArray]:
    """Unit line of sight (F, 3) of each eye in the head's frame, limited to the eyes' range.

    Parameters
    ----------
    target_m, head_m : (F, 3) float64
        Positions of the target and of the head, in the same space.
    head : (F, 4) float64
        Rotation of the head in that space.
    eyes_m : mapping of str to (3,) float64
        Eye positions, from `eyes_from_head_m`.
    """
    middle_m = 0.5 * (eyes_m["left"] + eyes_m["right"])
    way = quaternion.rotate(quaternion.conjugate(head), target_m - head_m) - middle_m
    away_m = np.maximum(np.linalg.norm(way, axis=-1), NEAREST_M)
    yaw = np.arctan2(way[..., 0], way[..., 2])
    up = np.arctan2(way[..., 1], np.hypot(way[..., 0], way[..., 2]))
    yaw = _within(yaw, ASIDE_RAD, ASIDE_RAD)
    up = _within(up, UP_RAD, DOWN_RAD)
    seen_m = away_m[..., None] * _direction(yaw, up) + middle_m
    return {side: _unit(seen_m - eye_m) for side, eye_m in eyes_m.items()}


def point(yaw_rad: FloatArray, down_rad: FloatArray, away_m: FloatArray) -> FloatArray:
    """Point (F, 3) in metres at a distance ``away_m`` in a direction given by angles; left and down are positive."""
    return away_m[..., None] * _direction(yaw_rad, -down_rad)


def eye_turn(sight: FloatArray) -> FloatArray:
    """Rotation (F, 4) of an eye from straight ahead to the directions ``sight`` (F, 3), without roll
    (Listing's law).
    """
    across = np.hypot(sight[..., 0], sight[..., 1])
    angle = np.arctan2(across, sight[..., 2])
    scale = np.where(across > 1e-12, angle / np.maximum(across, 1e-12), 1.0)
    return quaternion.from_rotation_vector(
        np.stack([-sight[..., 1] * scale, sight[..., 0] * scale, np.zeros_like(across)], axis=-1)
    )


def weights_for(side: EyeSide, sight: FloatArray) -> dict[str, FloatArray]:
    """Weights (F,) 0..1 of the four eyeLook morphs of an eye that make the centre of its iris point in the directions
    ``sight`` (F, 3).
    """
    ahead = np.maximum(sight[..., 2], 1e-6)
    left, up = sight[..., 0] / ahead, sight[..., 1] / ahead
    outwards = left if side == "left" else -left
    asked = {"In": -outwards, "Out": outwards, "Up": up, "Down": -up}
    # A shape moves the iris sideways by the sine of its angle and back by one minus the cosine.
    back = 1.0 + sum(np.maximum(asked[way], 0.0) * math.tan(0.5 * angle) for way, angle in SHAPES_RAD.items())
    return {
        shape_name(side, way): np.clip(np.maximum(asked[way], 0.0) / (back * math.sin(angle)), 0.0, 1.0)
        for way, angle in SHAPES_RAD.items()
    }


def sight_by(side: EyeSide, weights: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
    """Unit direction (F, 3) in which the centre of an iris points with the given weights of eyeLook morphs; missing
    weights are 0.
    """
    place = np.tile([0.0, 0.0, 1.0], (frames, 1))
    for way in SHAPES_RAD:
        weight = weights.get(shape_name(side, way))
        if weight is not None:
            place += np.asarray(weight, np.float64)[:, None] * (_turned_ahead(side, way) - [0.0, 0.0, 1.0])
    return _unit(place)


def shape_turn(side: EyeSide, way: str) -> FloatArray:
    """Rotation (4,) of an eye by an eyeLook morph at weight 1."""
    turn: FloatArray = eye_turn(_turned_ahead(side, way)[None])[0]
    return turn


def _turned_ahead(side: EyeSide, way: str) -> FloatArray:
    angle = SHAPES_RAD[way]
    aside = math.sin(angle) * (1.0 if (way == "Out") == (side == "left") else -1.0)
    if way in ("In", "Out"):
        return np.array([aside, 0.0, math.cos(angle)])
    return np.array([0.0, math.sin(angle) if way == "Up" else -math.sin(angle), math.cos(angle)])


def _within(angle: FloatArray, most: float, most_other: float) -> FloatArray:
    capped = softly_capped(np.maximum(angle, 0.0), most, _EASE_RAD)
    other = softly_capped(np.maximum(-angle, 0.0), most_other, _EASE_RAD)
    result: FloatArray = np.where(angle >= 0.0, capped, -other)
    return result


def _direction(yaw: FloatArray, up: FloatArray) -> FloatArray:
    level = np.cos(up)
    return np.stack([level * np.sin(yaw), np.sin(up), level * np.cos(yaw)], axis=-1)


def _unit(vectors: FloatArray) -> FloatArray:
    result: FloatArray = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return result
