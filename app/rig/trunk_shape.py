"""Shape of a body's trunk and thighs in its clothes, as signed distances near each joint, and of its forearms."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Final

import numpy as np

from app.arrays import AnyIntArray, BoolArray, FloatArray, IndexArray, SingleArray
from app.identity_cache import IdentityCache
from app.rig.ik import Side
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from metadata.load import load_skeleton

TRUNK: Final = ("hips", "spine", "chest", "upperChest", "leftUpperLeg", "rightUpperLeg")
ALONG: Final = np.array([0.1, 0.325, 0.55, 0.775, 1.0])
"""Positions between elbow (0) and wrist (1) at which the distance from the trunk is measured."""
CELL_M: Final = 0.025
BEYOND_M: Final = 0.10
"""Greatest distance in metres outside the skin that the grids contain."""
_DEEPEST_M: Final = 0.15
_ASIDE_M: Final = 0.02
"""Sideways distance in metres from the nearest vertex beyond which a point, such as one under a hem, counts less and
less as inside."""
_SHINS: Final = ("leftLowerLeg", "rightLowerLeg")
_HELD: Final = 0.9
"""Least weight of the trunk, or of the forearm, on a vertex that counts as its own."""
_MOSTLY: Final = 0.7
"""Least weight of the trunk where shins have the rest, as on the lap in a long skirt."""
_OWN: Final = 0.3
"""Least weight of a single joint on a vertex that counts as its own."""
_OUTWARDS: Final = 0.3
"""Cosine between normal and direction from the joint's middle line below which a vertex belongs to a hem or lining."""
_FEWEST: Final = 40
"""Number of vertices below which a mesh, such as a button, is ignored."""
_THICK_PERCENT, _THICK_SPAN = 85.0, 0.15
_OUTFIT_M, _WORN_M = 0.012, 0.006
"""Room in metres that arms leave: before a body's own clothes, over which an outfit's jacket may be so much thicker,
and before the clothes that are worn."""
_USUAL_RADII_M: Final = (0.045, 0.045, 0.04, 0.035, 0.03)


@dataclass(frozen=True, eq=False)
class TrunkShape:
    """Trunk and forearms of a body.

    Attributes
    ----------
    joints : tuple of int
        Joints of trunk and thighs that hold skin or clothes.
    corners_m : tuple of (3,) float64
        By joint: lowest corner of its grid in the joint's frame.
    grids_m : tuple of (X, Y, Z) float32
        By joint: depth inside the surface, `CELL_M` apart; negative outside.
    radii_m : dict of side to (P,) float64
        Thickness of a forearm in its sleeve at `ALONG`.
    room_m : float
        Room that arms leave before the surface.
    """

    joints: tuple[int, ...]
    corners_m: tuple[FloatArray, ...]
    grids_m: tuple[SingleArray, ...]
    radii_m: dict[Side, FloatArray]
    room_m: float

    @property
    def tight(self) -> bool:
        """True if arms leave little room, as before an outfit, so that it matters where they are in nods and sways."""
        return self.room_m < _OUTFIT_M

    @cached_property
    def bounds_m(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest corner (J, 1, 3) of each joint's grid in the joint's frame."""
        low_m = np.stack(self.corners_m)
        high_m = low_m + [(np.array(grid.shape) - 1) * CELL_M for grid in self.grids_m]
        return low_m[:, None], high_m[:, None]

    def depths_m(self, number: int, points_m: FloatArray) -> FloatArray:
        """Return the depth (N,) inside the surface of points (N, 3) in the frame of ``joints[number]``.

        It is negative outside, where `BEYOND_M` and more are not distinguished.
        """
        from scipy.ndimage import map_coordinates  # heavy: a window is up before any body is

        places = (points_m - self.corners_m[number]).T / CELL_M
        found: FloatArray = map_coordinates(
            self.grids_m[number], places, np.float64, order=1, mode="constant", cval=-BEYOND_M
        )
        return found


_SHAPES: IdentityCache[TrunkShape | None] = IdentityCache(128)


def trunk_shape(character: Character) -> TrunkShape | None:
    """Return the shape of a character in its own clothes, cached; None for one without a trunk of skin or clothes."""
    return _SHAPES.step(_in_own_clothes, character.undressed or character)


def dressed_shape(character: Character) -> TrunkShape | None:
    """Return the shape of a character in the clothes that it wears, cached, or None as in `trunk_shape`.

    It is nowhere thinner than in its own clothes with the room before these.
    """
    return trunk_shape(character) if character.undressed is None else _SHAPES.step(_as_worn, character)


def _in_own_clothes(character: Character) -> TrunkShape | None:
    surfaces = [
        surface
        for mesh in character.meshes
        for surface in _surfaces(character, mesh, [_USED.step(_used, mesh.triangles)])
    ]
    radii_m: dict[Side, FloatArray] = {side: _radii_m(character, side) for side in ("left", "right")}
    return _made(character, surfaces, radii_m, _OUTFIT_M)


def _as_worn(character: Character) -> TrunkShape | None:
    own, more_m = character.undressed, _OUTFIT_M - _WORN_M
    assert own is not None
    surfaces = [
        replace(surface, more_m=more_m)
        for mesh in own.meshes
        for surface in _surfaces(own, mesh, [_USED.step(_used, mesh.triangles)])
    ]
    for mesh in character.meshes:
        if not any(mesh is other for other in own.meshes):
            # Garments lie over each other: each material is a surface of its own.
            numbers = np.unique(mesh.triangle_materials)
            parts = [_used(mesh.triangles[mesh.triangle_materials == number]) for number in numbers]
            surfaces += _surfaces(character, mesh, parts)
    radii_m: dict[Side, FloatArray] = {
        side: np.maximum(_radii_m(own, side) + more_m, _radii_m(character, side)) for side in ("left", "right")
    }
    return _made(character, surfaces, radii_m, _WORN_M)


def _made(
    character: Character, surfaces: Sequence[_Surface], radii_m: dict[Side, FloatArray], room_m: float
) -> TrunkShape | None:
    if not surfaces:
        return None
    names = _names(character)
    places_m = np.concatenate([one.places_m for one in surfaces])
    corner_m = places_m.min(axis=0) - BEYOND_M
    count = np.ceil((places_m.max(axis=0) + BEYOND_M - corner_m) / CELL_M).astype(int) + 1
    depths_m, rest_m = _depths_m(surfaces, corner_m, count), rest_positions(character.skeleton)
    joints, corners_m, grids_m = [], [], []
    for number, name in enumerate(names):
        own_m = np.concatenate([one.places_m[one.shares[:, number] >= _OWN] for one in surfaces])
        if len(own_m) < _FEWEST:
            continue
        first = np.floor((own_m.min(axis=0) - BEYOND_M - corner_m) / CELL_M).astype(int).clip(0)
        last = np.ceil((own_m.max(axis=0) + BEYOND_M - corner_m) / CELL_M).astype(int) + 1
        joint = character.skeleton.index(name)
        joints.append(joint)
        corners_m.append(corner_m + first * CELL_M - rest_m[joint])
        grids_m.append(_ending(depths_m[tuple(map(slice, first, last))]))
    return TrunkShape(tuple(joints), tuple(corners_m), tuple(grids_m), radii_m, room_m)


def _names(character: Character) -> list[str]:
    return [name for name in TRUNK if name in character.skeleton.names]


@dataclass(frozen=True, eq=False)
class _Surface:
    """Vertices of a mesh on the trunk in the T-pose: positions (V, 3) and normals (V, 3) in world space, the weights
    (V, T) of T joints, and the room ``more_m`` in metres that is kept before them."""

    places_m: FloatArray
    normals: FloatArray
    shares: FloatArray
    more_m: float = 0.0


def _surfaces(character: Character, mesh: Mesh, parts: Sequence[IndexArray]) -> list[_Surface]:
    """Return the surfaces on the trunk of parts of a mesh, each given by its vertices."""
    names = _names(character)
    shares = np.stack([_share(mesh, _holders(character, (name,), TRUNK)) for name in names], axis=1)
    trunks, shins = shares.sum(axis=1), _share(mesh, _holders(character, _SHINS))
    held = (trunks >= _MOSTLY) & (trunks + shins >= _HELD)
    found = []
    for rows in parts:
        surface = _surface(character, names, mesh, shares, rows[held[rows]])
        if len(surface.places_m) >= _FEWEST:
            found.append(surface)
    return found


def _surface(character: Character, names: Sequence[str], mesh: Mesh, shares: FloatArray, held: IndexArray) -> _Surface:
    """Return the outward-facing surface of a mesh in the T-pose; hems and linings, which face the body, are left out.

    Each vertex is posed rigidly with the joint of ``names`` that has the greatest weight on it.

    Parameters
    ----------
    shares : (V, T) float64
        Weights of the mesh's V vertices for the T joints of ``names``.
    held : (H,) int
        Indices of the vertices to use.
    """
    rest_m, most = rest_positions(character.skeleton), np.argmax(shares[held], axis=1)
    places_m, normals = np.zeros((len(held), 3)), np.zeros((len(held), 3))
    outwards = np.zeros(len(held), np.bool_)
    for number, name in enumerate(names):
        rows, joint = np.flatnonzero(most == number), character.skeleton.index(name)
        if not len(rows):
            continue
        to_joint = character.joint_from_mesh[joint]
        places_m[rows] = mesh.positions_m[held[rows]] @ to_joint[:3, :3].T + to_joint[:3, 3] + rest_m[joint]
        normals[rows] = mesh.normals[held[rows]] @ to_joint[:3, :3].T
        middle_m = 0.5 * (places_m[rows].min(axis=0) + places_m[rows].max(axis=0))
        out_m = (places_m[rows] - middle_m)[:, [0, 2]]
        outwards[rows] = (normals[rows][:, [0, 2]] * out_m).sum(axis=1) > _OUTWARDS * np.linalg.norm(out_m, axis=1)
    return _Surface(places_m[outwards], normals[outwards], shares[held][outwards])


def _holders(character: Character, names: Collection[str], others: Collection[str] = ()) -> BoolArray:
    """Mask (J,) of the joints that are named, or are descendants of one without being joints of the human skeleton."""
    return _holders_in(character.skeleton.names, character.skeleton.parents, tuple(names), tuple(others))


@lru_cache(maxsize=64)
def _holders_in(
    all_names: tuple[str, ...], parents: tuple[int, ...], names: tuple[str, ...], others: tuple[str, ...]
) -> BoolArray:
    human = {joint.name for joint in load_skeleton().joints} | set(others)
    found: list[bool] = []
    for name, parent in zip(all_names, parents, strict=True):
        found.append(name in names or (name not in human and parent >= 0 and found[parent]))
    return np.array(found)


def _share(mesh: Mesh, holders: BoolArray) -> FloatArray:
    """Sum (V,) of the weights of each vertex for the joints in a mask (J,)."""
    return _SHARES.step(_summed, mesh.joints, mesh.weights, holders)


def _summed(joints: AnyIntArray, weights: SingleArray, holders: BoolArray) -> FloatArray:
    return np.asarray(np.where(holders[joints], weights, 0.0).sum(axis=1), np.float64)


# People made from one body share joints, weights and triangles.
_SHARES: IdentityCache[FloatArray] = IdentityCache(512)
_USED: IdentityCache[IndexArray] = IdentityCache(64)


def _used(triangles: AnyIntArray) -> IndexArray:
    """Return the vertices of some triangles, each once."""
    return np.unique(triangles).astype(np.intp)


def _depths_m(surfaces: Sequence[_Surface], corner_m: FloatArray, count: IndexArray) -> FloatArray:
    """Return the depth (X, Y, Z) inside the outermost of some surfaces at the points of a grid."""
    from scipy.spatial import cKDTree  # heavy: a window is up before any body is

    indices = np.stack(np.meshgrid(*map(np.arange, count), indexing="ij"), axis=-1)
    deepest_m = np.full(indices.shape[:3], -BEYOND_M)
    for one in surfaces:
        first = np.floor((one.places_m.min(axis=0) - BEYOND_M - corner_m) / CELL_M).astype(int).clip(0)
        last = np.ceil((one.places_m.max(axis=0) + BEYOND_M - corner_m) / CELL_M).astype(int) + 1
        part = tuple(map(slice, first, last))
        points_m = corner_m + indices[part].reshape(-1, 3) * CELL_M
        found = cKDTree(one.places_m).query(points_m, distance_upper_bound=_DEEPEST_M)
        away_m, nearest = np.asarray(found[0]), np.asarray(found[1])
        near = np.flatnonzero(np.isfinite(away_m))
        to_m, away_m = points_m[near] - one.places_m[nearest[near]], away_m[near]
        inside_m = -np.einsum("pi,pi->p", to_m, one.normals[nearest[near]])
        aside_m = np.sqrt(np.maximum(away_m**2 - inside_m**2, 0.0))
        # Beyond an edge, as under a hem, a point is less and less inside.
        inside_m = np.where(inside_m > 0.0, inside_m - 2.0 * np.maximum(aside_m - _ASIDE_M, 0.0), -away_m)
        found_m = np.full(len(points_m), -BEYOND_M)
        found_m[near] = inside_m + one.more_m
        deepest_m[part] = np.maximum(deepest_m[part], found_m.reshape(deepest_m[part].shape))
    clipped_m: FloatArray = np.clip(deepest_m, -BEYOND_M, _DEEPEST_M)
    return clipped_m


def _ending(depths_m: FloatArray) -> SingleArray:
    """Return a grid (X, Y, Z) whose depths end smoothly at its sides."""
    for axis, count in enumerate(depths_m.shape):
        to_side = np.minimum(np.arange(count), np.arange(count)[::-1]) * CELL_M - BEYOND_M / 2.0
        depths_m = np.minimum(depths_m, np.expand_dims(to_side, [other for other in range(3) if other != axis]))
    ending_m: SingleArray = np.maximum(depths_m, -BEYOND_M).astype(np.float32)
    return ending_m


def _radii_m(character: Character, side: Side) -> FloatArray:
    """Return the thickness (P,) of a forearm in its sleeve at `ALONG`."""
    holders = _holders(character, (f"{side}LowerArm",))
    joint, wrist = (character.skeleton.index(f"{side}{part}") for part in ("LowerArm", "Hand"))
    to_joint, bone_m = character.joint_from_mesh[joint], character.skeleton.offsets_m[wrist]
    places_m = np.concatenate(
        [np.zeros((0, 3))] + [mesh.positions_m[_share(mesh, holders) >= _HELD] for mesh in character.meshes]
    )
    places_m = places_m @ to_joint[:3, :3].T + to_joint[:3, 3]
    along = places_m @ bone_m / float(bone_m @ bone_m)
    out_m = np.linalg.norm(places_m - along[:, None] * bone_m, axis=1)
    radii_m = []
    for at, usual_m in zip(ALONG, _USUAL_RADII_M, strict=True):
        near = np.abs(along - at) < _THICK_SPAN
        radii_m.append(float(np.percentile(out_m[near], _THICK_PERCENT)) if near.sum() > 4 else usual_m)
    return np.array(radii_m)
