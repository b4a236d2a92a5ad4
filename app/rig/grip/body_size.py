"""Size of a body relative to an adult's, and scaling of bodies, models and grips as a whole.

Sizes between those of the two bundled adults count as 1, since instruments are built for them.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from functools import lru_cache
from typing import Any, TypeVar

import msgspec
import numpy as np

from app.rig.characters.landmarks import eye_distance
from app.rig.grip.grip_pose import Side
from app.rig.mesh import scaled_mesh
from app.rig.model import Character, InstrumentModel, Skeleton
from app.rig.skeleton import rest_positions
from metadata.model import Body

Range = tuple[float, float]

# Ranges of adults in metres: from the wrist to the last joint of the middle finger, across the knuckles, upper and
# lower arm, height of the hips, distance of the eyes. They include both bundled adults, for arms, legs and faces with a
# small margin.
HAND_M, KNUCKLES_M, ARM_M, LEGS_M, EYES_M = (0.155, 0.173), (0.058, 0.070), (0.45, 0.57), (0.86, 1.06), (0.057, 0.064)

_Value = TypeVar("_Value")


def ratio_to_grown_up(length_m: float, grown_up_m: Range) -> float:
    """Return a length relative to the nearest of an adult's range; 1 within the range."""
    return length_m / min(max(length_m, grown_up_m[0]), grown_up_m[1])


@lru_cache(maxsize=64)
def hand_size(skeleton: Skeleton) -> float:
    """Return the size of the hands relative to an adult's."""
    rest = rest_positions(skeleton)

    def apart_m(first: str, second: str) -> float:
        return float(np.linalg.norm(rest[skeleton.index(first)] - rest[skeleton.index(second)]))

    sizes = [
        float(
            np.sqrt(
                ratio_to_grown_up(apart_m(f"{side}Hand", f"{side}MiddleDistal"), HAND_M)
                * ratio_to_grown_up(apart_m(f"{side}IndexProximal", f"{side}LittleProximal"), KNUCKLES_M)
            )
        )
        for side in ("left", "right")
    ]
    return min(sizes)


def arm_m(skeleton: Skeleton, side: Side) -> float:
    """Return the length in metres of upper and lower arm together."""
    below = (skeleton.index(f"{side}{part}") for part in ("LowerArm", "Hand"))
    return sum(float(np.linalg.norm(skeleton.offsets_m[joint])) for joint in below)


def arm_size(skeleton: Skeleton, side: Side) -> float:
    """Return the length of an arm relative to an adult's."""
    return ratio_to_grown_up(arm_m(skeleton, side), ARM_M)


@lru_cache(maxsize=64)
def leg_size(skeleton: Skeleton) -> float:
    """Return the length of the legs relative to an adult's, which scales the body's sway."""
    rest = rest_positions(skeleton)
    return ratio_to_grown_up(float(rest[skeleton.index("hips")][1] - min(0.0, float(rest[:, 1].min()))), LEGS_M)


@lru_cache(maxsize=64)
def face_size(character: Character) -> float:
    """Return the size of the face relative to an adult's."""
    return ratio_to_grown_up(eye_distance(character), EYES_M)


def sized_body(body: Body, size: float) -> Body:
    """Return the body's limits with the lengths of swaying, stepping and bobbing multiplied by ``size``."""
    return body if size == 1.0 else _sized(body, size)


def _sized(table: Any, size: float) -> Any:
    changed: dict[str, Any] = {}
    for name in table.__struct_fields__:
        value = getattr(table, name)
        if name.endswith("_m") and name != "opening_m":
            changed[name] = type(value)(size * part for part in value) if isinstance(value, tuple) else size * value
        elif isinstance(value, msgspec.Struct):
            changed[name] = _sized(value, size)
        elif isinstance(value, dict) and any(isinstance(item, msgspec.Struct) for item in value.values()):
            changed[name] = {key: _sized(item, size) for key, item in value.items()}
    return msgspec.structs.replace(table, **changed)


def sized_character(character: Character, size: float) -> Character:
    """Return a character scaled as a whole."""
    joint_from_mesh = character.joint_from_mesh.copy()
    joint_from_mesh[:, :3, 3] *= size
    skeleton = character.skeleton
    return replace(
        character,
        skeleton=Skeleton(skeleton.names, skeleton.parents, size * skeleton.offsets_m),
        joint_from_mesh=joint_from_mesh,
        meshes=tuple(scaled_mesh(mesh, size) for mesh in character.meshes),
    )


def sized_model(model: InstrumentModel, size: float) -> InstrumentModel:
    """Return a model scaled as a whole."""
    if size == 1.0:
        return model
    meshes = tuple(scaled_mesh(mesh, size) for mesh in model.meshes)
    return replace(model, node_positions_m=size * model.node_positions_m, meshes=meshes)


def sized(value: _Value, size: float) -> _Value:
    """Return a part of a grip scaled with body and instrument: every field named as a length is multiplied."""
    return value if size == 1.0 else _times(value, size, "")


def _times(value: Any, size: float, name: str) -> Any:
    if name.endswith("_m"):
        return value * size
    if isinstance(value, tuple):
        return tuple(_times(item, size, "") for item in value)
    if is_dataclass(value) and not isinstance(value, type):
        return replace(
            value, **{item.name: _times(getattr(value, item.name), size, item.name) for item in fields(value)}
        )
    return value
