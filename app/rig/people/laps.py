"""Coats that lie on the lap of a seated player: on every build at the same small distance from trousers or skirt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.rig import quaternion
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import forward

LIES_M, LOOSE_M = 0.005, 0.012
"""Distances of a coat from what it lies on: from trousers, and from a skirt, which would go through it where the legs
are not quite as in the pose in which it is laid.
"""
_SPANS: Final = 0.05
"""Share of the vertices of a skirt that both legs move by `_BY_EACH` at least; of trousers, hardly any are."""
_BY_EACH: Final = 0.1
ROUNDS: Final = 2
"""Number of times that a coat is laid: turned less, cloth also lies farther back."""
_RAISED_RAD, _ASIDE_RAD = np.deg2rad(86.0), np.deg2rad(13.0)
"""Angles of a seated player's thighs: from vertical, and outwards."""
_CELL_M: Final = 0.01
_HALF_M: Final = 0.40
"""Half of the width, and length before the hip joints, of the map of the lap."""
_CELLS: Final = round(2 * _HALF_M / _CELL_M)
_FALLS: Final = 0.8
"""Slope of cloth beside the thighs."""
_DEEPEST_M: Final = 0.06
_NEAR_M: Final = (-0.01, 0.10)
"""Heights over the lap of what lies on it."""
_BEFORE_M: Final = 0.05
"""Length before the hip joints from which cloth is laid wholly."""
_FADES_M: Final = 0.012
"""Difference of heights from those of what is laid to those of what stays."""
_MOST_M: Final = 0.05
"""Greatest change of height."""
_LEAST_RISE_M: Final = 0.05
"""Height by which raised thighs lift a place at least, if it is laid."""
_GOES_WITH_LEGS: Final = (0.12, 0.4)
"""Shares of the legs in the weights, from those of cloth that stays to those of cloth that is laid."""
_SAG: Final = 0.07
"""Depth to which cloth sags between the thighs as a share of their distance."""
_SOFT_CELLS: Final = 1.0
_CROSS: Final = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.bool_)
"""A cell and its neighbours."""


def laid_on_lap(coat: Mesh, below: Sequence[Mesh], character: Character) -> Mesh:
    """Return a coat whose part before the hips lies on the lap of a seated player. Standing, it is unchanged.

    Parameters
    ----------
    coat : Mesh
        Garment over those ``below``, such as a jacket.
    below : sequence of Mesh
        Trousers or skirt.
    character : Character
        Person whose skeleton moves them.

    Returns
    -------
    Mesh
        The coat with other shares of thighs and hips in the weights of its lower front.
    """
    if not below:
        return coat
    seated = _seated(character)
    ahead_m = float(_joints_m(character, seated)[character.skeleton.index("leftUpperLeg"), 2])
    lap = _lap([_deformed(mesh, None, seated, None, 0)[mesh.triangles] for mesh in below], ahead_m)
    lies_m = LOOSE_M if any(_spans_legs(mesh, character.skeleton.names) for mesh in below) else LIES_M
    for _ in range(ROUNDS):
        coat = _nearer(coat, lap, lies_m, seated, ahead_m, character)
    return coat


def _spans_legs(mesh: Mesh, names: Sequence[str]) -> bool:
    """Return whether a garment hangs around both legs together."""
    left, right = (
        np.where(np.array([f"{side}UpperLeg" == name for name in names])[mesh.joints], mesh.weights, 0.0).sum(axis=1)
        for side in ("left", "right")
    )
    return bool(np.mean(np.minimum(left, right) > _BY_EACH) > _SPANS)


def _nearer(
    coat: Mesh, lap: FloatArray, lies_m: float, seated: FloatArray, ahead_m: float, character: Character
) -> Mesh:
    """Return a coat that lies closer to a map of the lap, as `_lap`, in front of a depth ``ahead_m``: at a height of
    ``lies_m`` over it.
    """
    names, pelvis = character.skeleton.names, character.skeleton.index("hips")
    leg = np.array([any(part in name for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")) for name in names])
    shares = np.where(leg[coat.joints], coat.weights, 0.0).sum(axis=1, dtype=np.float64)
    rows = np.flatnonzero(shares > _GOES_WITH_LEGS[0])
    share = shares[rows]
    hips, legs = (_deformed(coat, rows, seated, joints, pelvis) for joints in (~leg, leg))
    places = share[:, None] * legs + (1.0 - share[:, None]) * hips
    over_m = places[:, 1] - _at(lap, places, ahead_m)
    lies = (over_m > _NEAR_M[0]) & (over_m < _NEAR_M[1]) & (places[:, 2] > ahead_m)
    if not lies.any():
        return coat
    moved = np.clip(lies_m - _at(_lowest(places[lies], over_m[lies], ahead_m), places, ahead_m), -_MOST_M, _MOST_M)
    laid = np.clip((share - _GOES_WITH_LEGS[0]) / (_GOES_WITH_LEGS[1] - _GOES_WITH_LEGS[0]), 0.0, 1.0)
    laid *= np.clip((places[:, 2] - ahead_m) / _BEFORE_M, 0.0, 1.0) * _near(over_m)
    rise = legs[:, 1] - hips[:, 1]
    change = laid * np.where(rise > _LEAST_RISE_M, moved / np.maximum(rise, _LEAST_RISE_M), 0.0)
    return _with_shares(coat, rows, share, np.clip(share + change, 0.0, 1.0), leg, pelvis)


def _near(over_m: FloatArray) -> FloatArray:
    """Return the shares (N,) by which places at heights over the lap are laid."""
    return np.asarray(
        np.clip((over_m - _NEAR_M[0]) / _FADES_M + 1.0, 0.0, 1.0)
        * np.clip((_NEAR_M[1] - over_m) / _FADES_M + 1.0, 0.0, 1.0)
    )


def _seated(character: Character) -> FloatArray:
    """Return the transforms (J, 4, 4) by which joints move meshes in a seated pose."""
    skeleton = character.skeleton
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (1, len(skeleton.names), 1))
    across, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    for side, sign in (("left", 1.0), ("right", -1.0)):
        aside = quaternion.from_axis_angle(up, sign * _ASIDE_RAD)
        raised = quaternion.from_axis_angle(across, -_RAISED_RAD)
        rotations[0, skeleton.index(f"{side}UpperLeg")] = quaternion.multiply(aside, raised)
        rotations[0, skeleton.index(f"{side}LowerLeg")] = quaternion.from_axis_angle(across, _RAISED_RAD)
    found: FloatArray = forward(skeleton, rotations).matrices()[0] @ character.joint_from_mesh
    return found


def _joints_m(character: Character, seated: FloatArray) -> FloatArray:
    return np.asarray((seated @ np.linalg.inv(character.joint_from_mesh))[:, :3, 3])


def _deformed(
    mesh: Mesh, rows: IntArray | None, seated: FloatArray, joints: BoolArray | None, otherwise: int
) -> FloatArray:
    """Return vertices (K, 3) of a mesh as moved by some of its joints alone; those without any of them, by the joint
    ``otherwise``.
    """
    own = slice(None) if rows is None else rows
    points = mesh.positions_m[own].astype(np.float64)
    weights = mesh.weights[own].astype(np.float64)
    if joints is not None:
        weights = np.where(joints[mesh.joints[own]], weights, 0.0)
    total = weights.sum(axis=1, keepdims=True)
    blended = np.einsum("nk,nkij->nij", weights / np.where(total > 1e-6, total, 1.0), seated[mesh.joints[own]])
    blended[total[:, 0] <= 1e-6] = seated[otherwise]
    return np.asarray(np.einsum("nij,nj->ni", blended[:, :3, :3], points) + blended[:, :3, 3])


def _cells(places: FloatArray, ahead_m: float) -> tuple[IntArray, IntArray]:
    x = np.floor((places[..., 0] + _HALF_M) / _CELL_M).astype(np.intp)
    z = np.floor((places[..., 2] - ahead_m) / _CELL_M).astype(np.intp)
    return x, z


def _lap(parts: Sequence[FloatArray], ahead_m: float) -> FloatArray:
    """Return heights (`_CELLS`, `_CELLS` / 2) over x and z of the lap made by triangles (T, 3, 3): it sags from thigh
    to thigh and falls at their sides.
    """
    from scipy.ndimage import gaussian_filter, maximum_filter  # slow to import; needed for few outfits

    inside = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1]], np.float64)
    inside /= inside.sum(axis=1, keepdims=True)
    points = np.concatenate([np.einsum("ka,tad->tkd", inside, corners).reshape(-1, 3) for corners in parts])
    x, z = _cells(points, ahead_m)
    good = (x >= 0) & (x < _CELLS) & (z >= 0) & (z < _CELLS // 2)
    lap = np.full((_CELLS, _CELLS // 2), -np.inf)
    np.maximum.at(lap, (x[good], z[good]), points[good, 1])
    middle, across = _CELLS // 2, np.arange(_CELLS)
    for heights in lap.T:
        found = np.flatnonzero(np.isfinite(heights))
        if not len(found) or found[0] >= middle or found[-1] < middle:
            heights[:] = np.nan
            continue
        heights[:] = np.interp(across, found, heights[found])
        right, left = int(heights[:middle].argmax()), middle + int(heights[middle:].argmax())
        between = np.linspace(0.0, 1.0, left - right + 1)
        sag_m = _SAG * _CELL_M * (left - right) * np.sin(np.pi * between)
        span = heights[right] + (heights[left] - heights[right]) * between - sag_m
        heights[right : left + 1] = np.maximum(heights[right : left + 1], span)
        beside = np.maximum(np.maximum(found[0] - across, across - found[-1]), 0) * _CELL_M
        heights -= np.minimum(_FALLS * beside, _DEEPEST_M)
    return np.asarray(gaussian_filter(maximum_filter(_filled(lap), footprint=_CROSS), _SOFT_CELLS))


def _filled(values: FloatArray) -> FloatArray:
    """Return a map in which cells without a finite value have the nearest one."""
    from scipy.ndimage import distance_transform_edt  # slow to import; needed for few outfits

    nearest = distance_transform_edt(~np.isfinite(values), return_distances=False, return_indices=True)
    return np.asarray(values[tuple(nearest)])


def _lowest(places: FloatArray, over_m: FloatArray, ahead_m: float) -> FloatArray:
    """Return a map, as `_lap`, of the least heights over the lap of the layers of a coat, smooth across cells."""
    from scipy.ndimage import gaussian_filter, minimum_filter  # slow to import; needed for few outfits

    least = np.full((_CELLS, _CELLS // 2), np.inf)
    x, z = (np.clip(cells, 0, top - 1) for cells, top in zip(_cells(places, ahead_m), least.shape, strict=True))
    np.minimum.at(least, (x, z), over_m)
    return np.asarray(gaussian_filter(minimum_filter(_filled(least), 3), _SOFT_CELLS))


def _at(values: FloatArray, places: FloatArray, ahead_m: float) -> FloatArray:
    """Return values (N,) of a map between its cells."""
    from scipy.ndimage import map_coordinates  # slow to import; needed for few outfits

    x = (places[:, 0] + _HALF_M) / _CELL_M - 0.5
    z = (places[:, 2] - ahead_m) / _CELL_M - 0.5
    return np.asarray(map_coordinates(values, [x, z], order=1, mode="nearest"))


def _with_shares(coat: Mesh, rows: IntArray, before: FloatArray, after: FloatArray, leg: BoolArray, hips: int) -> Mesh:
    """Return a coat in whose vertices ``rows`` legs have the shares ``after`` instead of ``before``."""
    joints, weights = coat.joints.copy(), coat.weights.astype(np.float64)
    own, moved = joints[rows], weights[rows]
    of_legs = leg[own]
    rest = np.where(of_legs, 0.0, moved).sum(axis=1)
    lone = rest <= 1e-6
    # Where legs alone moved it, the hips take the place of the weakest joint.
    weakest = moved.argmin(axis=1)[lone]
    places = np.flatnonzero(lone)
    own[places, weakest], moved[places, weakest], of_legs[places, weakest] = hips, 0.0, False
    legs = np.where(of_legs, moved, 0.0)
    others = np.where(of_legs, 0.0, moved)
    others[places, weakest] = 1.0
    legs *= (after / np.maximum(legs.sum(axis=1), 1e-9))[:, None]
    others *= ((1.0 - after) / others.sum(axis=1))[:, None]
    joints[rows], weights[rows] = own, legs + others
    return replace(coat, joints=joints, weights=weights.astype(coat.weights.dtype))
