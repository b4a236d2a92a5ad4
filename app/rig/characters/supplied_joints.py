"""The T-pose of a figure's joints, with missing ends of chains added and the soles on the floor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.rig import quaternion
from app.rig.mesh import Mesh

SIDES: Final = ("left", "right")
OFF_CENTRE: Final = 0.1
"""Distance of the feet from the origin, relative to the height, below which a figure counts as standing there."""
OWN_VERTEX: Final = 0.5
"""Share of a vertex's weight above which it belongs to a joint."""
HAND_M: Final = (
    {
        "ThumbMetacarpal": (0.028, -0.002, 0.018),
        "ThumbProximal": (0.060, -0.002, 0.050),
        "ThumbDistal": (0.086, -0.002, 0.075),
    },
    {
        "IndexProximal": (0.093, -0.005, 0.026),
        "IndexIntermediate": (0.138, -0.005, 0.026),
        "IndexDistal": (0.163, -0.005, 0.026),
    },
    {"MiddleProximal": (0.093, 0.0, 0.0), "MiddleIntermediate": (0.142, 0.0, 0.0), "MiddleDistal": (0.172, 0.0, 0.0)},
    {
        "RingProximal": (0.085, 0.0, -0.020),
        "RingIntermediate": (0.131, 0.0, -0.020),
        "RingDistal": (0.160, 0.0, -0.020),
    },
    {
        "LittleProximal": (0.069, -0.005, -0.033),
        "LittleIntermediate": (0.106, -0.005, -0.033),
        "LittleDistal": (0.127, -0.005, -0.033),
    },
)
"""Positions of a bundled adult's left fingers in the T-pose from the wrist, in metres."""
HAND_REACH_M: Final = 0.195
"""Distance from that adult's wrist to the tip of the middle finger, in metres."""
EYE_M: Final = np.array([0.031, 0.042, 0.091])
HEAD_TOP_M: Final = 0.13
"""Positions of that adult's left eye and crown from the head's joint, in metres."""
TOES_M: Final = np.array([0.0, -0.048, 0.153])
ANKLE_M: Final = 0.1
"""Positions of that adult's toes from the ankle, and the ankle's height, in metres."""
HEAD_HEIGHT_M: Final = 1.671
"""Height of that adult's head joint in metres."""
UP: Final = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Fit:
    """The J joints of the character, with the bones that they correspond to.

    Attributes
    ----------
    bones : list of int
        Bone of each joint; -1 for an added joint.
    turns : (J, 4) float64
        World rotation from the rest pose to the T-pose.
    rest_m, places_m : (J, 3) float64
        World positions in the rest pose and in the T-pose.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    bones: list[int]
    turns: FloatArray
    rest_m: FloatArray
    places_m: FloatArray


def supplied_ends(fit: Fit, meshes: Sequence[Mesh]) -> Fit:
    """Return the fit with positions for the missing joints at the ends of chains."""
    rest_m, places = fit.rest_m.copy(), fit.places_m.copy()
    index = {name: joint for joint, name in enumerate(fit.names)}
    for joint, name in enumerate(fit.names):
        if not np.isnan(places[joint, 0]):
            continue
        parent = fit.parents[joint]
        side = "left" if name.startswith("left") else "right"
        mirror = np.array([1.0 if side == "left" else -1.0, 1.0, 1.0])
        part = name.removeprefix(side)
        if part == "Eye":
            offset = EYE_M * _extent(fit, meshes, [index["head"]], UP) / HEAD_TOP_M
        elif part == "Toes":
            offset = TOES_M * max(float(places[parent, 1] - _floor(fit, meshes)), 0.01) / ANKLE_M
        else:
            offset = _finger_offset(fit.names, places, index, side, part, meshes, fit)
        places[joint] = places[parent] + offset * mirror
        back = quaternion.conjugate(fit.turns[joint])
        rest_m[joint] = rest_m[parent] + quaternion.rotate(back, places[joint] - places[parent])
    return replace(fit, rest_m=rest_m, places_m=places)


def _finger_offset(
    names: Sequence[str],
    places: FloatArray,
    index: Mapping[str, int],
    side: str,
    part: str,
    meshes: Sequence[Mesh],
    fit: Fit,
) -> FloatArray:
    """Return the offset (3,) of a left finger joint from its parent in metres, for figures without finger bones, by the
    length of the preceding bone or of the hand."""
    chain = next(chain for chain in HAND_M if part in chain)
    order = list(chain).index(part)
    ways = np.diff(np.vstack([np.zeros(3), *chain.values()]), axis=0)
    if order >= 2:
        before, own = (index[side + list(chain)[order - back]] for back in (1, 2))
        length = float(np.linalg.norm(places[before] - places[own]))
        if length > 1e-4:
            scale = length / float(np.linalg.norm(ways[order - 1]))
            return np.asarray(ways[order] * scale)
    hand = index[side + "Hand"]
    carried = [joint for joint, name in enumerate(names) if name.startswith(side) and joint >= hand and _of_hand(name)]
    along = np.array([1.0 if side == "left" else -1.0, 0.0, 0.0])
    scale = _extent(fit, meshes, [hand, *carried], along) / HAND_REACH_M
    result: FloatArray = ways[order] * scale
    return result


def _of_hand(name: str) -> bool:
    return any(finger in name for finger in ("Thumb", "Index", "Middle", "Ring", "Little"))


def _extent(fit: Fit, meshes: Sequence[Mesh], joints: Sequence[int], direction: FloatArray) -> float:
    """Return the extent in metres of the skin of some joints in a direction from the first of them, in the T-pose; the
    value of bundled bodies, scaled to the figure, if there is no skin.
    """
    joint_from_mesh = inverse_binds(fit)
    found = 0.0
    for mesh in meshes:
        own = _held(mesh, joints)
        if own.any():
            away = (_t_posed(fit, joint_from_mesh, mesh)[own] - fit.places_m[joints[0]]) @ direction
            found = max(found, float(np.percentile(away, 98.0)))
    if found > 0.0:
        return found
    height = float(fit.places_m[fit.names.index("head"), 1] - _floor(fit, meshes))
    return (HAND_REACH_M if direction[0] else HEAD_TOP_M) * height / HEAD_HEIGHT_M


def _floor(fit: Fit, meshes: Sequence[Mesh]) -> float:
    """Return the height of the soles in the T-pose in metres."""
    feet = [joint for joint, name in enumerate(fit.names) if name.endswith(("Foot", "Toes"))]
    joint_from_mesh = inverse_binds(fit)
    lowest = [
        float(_t_posed(fit, joint_from_mesh, mesh)[own, 1].min()) for mesh in meshes if (own := _held(mesh, feet)).any()
    ]
    if lowest:
        return min(lowest)
    ankles = [fit.places_m[joint, 1] for joint in feet if not np.isnan(fit.places_m[joint, 1])]
    head = float(fit.places_m[fit.names.index("head"), 1])
    low = float(min(ankles))
    return low - ANKLE_M * (head - low) / (HEAD_HEIGHT_M - ANKLE_M)


def on_the_floor(fit: Fit, meshes: Sequence[Mesh]) -> Fit:
    """Return the T-pose with the soles on the floor at the origin; unchanged if they nearly are."""
    floor = _floor(fit, meshes)
    feet = [fit.names.index(side + "Foot") for side in SIDES]
    middle = fit.places_m[feet].mean(axis=0)
    height = float(fit.places_m[fit.names.index("head"), 1]) - floor
    shift = np.array([-middle[0], -floor, -middle[2]])
    if float(np.hypot(middle[0], middle[2])) < OFF_CENTRE * height:
        shift[[0, 2]] = 0.0
    places = fit.places_m + shift
    places[0] = 0.0
    return replace(fit, places_m=places)


def inverse_binds(fit: Fit) -> FloatArray:
    """Return the inverse bind matrices (J, 4, 4), from the mesh in its rest pose to the frame of each joint."""
    result = np.tile(np.eye(4), (len(fit.names), 1, 1))
    result[:, :3, :3] = quaternion.to_matrix(fit.turns)
    result[:, :3, 3] = -np.einsum("jab,jb->ja", result[:, :3, :3], fit.rest_m)
    return result


def _t_posed(fit: Fit, joint_from_mesh: FloatArray, mesh: Mesh) -> FloatArray:
    """Return the vertices (V, 3) of a mesh moved to the T-pose, in metres."""
    matrices = joint_from_mesh[:, :3, :].copy()
    matrices[:, :, 3] += fit.places_m
    result = np.zeros((len(mesh.positions_m), 3))
    for column in range(mesh.joints.shape[1]):
        own = matrices[mesh.joints[:, column]]
        moved = np.einsum("vij,vj->vi", own[:, :, :3], mesh.positions_m) + own[:, :, 3]
        result += mesh.weights[:, column, None] * moved
    return result


def _held(mesh: Mesh, joints: Sequence[int]) -> BoolArray:
    """Return for each vertex (V,) whether it is mainly moved by the given joints."""
    held: BoolArray = np.where(np.isin(mesh.joints, joints), mesh.weights, 0.0).sum(axis=1) > OWN_VERTEX
    return held
