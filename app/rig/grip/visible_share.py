"""Share of an instrument that a player's hands and head leave in sight, from the front and from both sides.

Surfaces are sampled as points, and each view keeps the nearest point in every cell of a grid, as a depth buffer does.
The instrument's own parts do not count as hiding it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from app.arrays import AnyIntArray, FloatArray, IndexArray
from app.errors import Message
from app.rig import quaternion
from app.rig.grip.carriage import carrying, joint_rotations, upright, usual_posture
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.grip_pose import GripPose, Lips, Side, hand_targets
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import ancestors, forward, rest_positions
from app.rig.skinning import patch
from instrument_maps.model import InstrumentMap
from metadata.model import Body

LEAST_IN_SIGHT = 0.5
"""Least share of an instrument's outline in sight; bundled adults leave at least 0.6 of every instrument."""
_VIEWS: Final = ((0, 1, 2, 1.0), (2, 1, 0, 1.0), (2, 1, 0, -1.0))
"""Views: axes of the picture, axis towards the viewer, and its sign (+Z ahead, +X left of the player)."""
_CELLS = 80
"""Cells of a picture along the instrument's greatest extent."""
_FINER = 0.7
"""Distance between samples of a surface relative to a cell."""
_MOST_SPLITS = 64
"""Greatest number of samples along an edge."""


class VisibleShare(NamedTuple):
    """Shares 0..1 of an instrument's outline that hands and head leave in sight: from the front, and from the better
    side.
    """

    front: float
    side: float

    @property
    def least(self) -> float:
        """The smaller of both shares."""
        return min(self)


Wrists = Mapping[Side, tuple[FloatArray, FloatArray]]
"""Position (3,) and rotation (4,) of wrists in the instrument's frame, by side."""


def hidden_message(
    character: Character, model: InstrumentModel, instrument: InstrumentMap, body: Body, grip: GripPose
) -> Message | None:
    """Return a warning about hands and head that hide most of a held instrument; None if enough of it is in sight."""
    still, turned = np.zeros((1, 3)), quaternion.IDENTITY[None]
    wrists = {}
    for hand in grip.hands:
        place_m, turn = hand_targets(hand, still, turned, {})
        wrists[hand.side] = (place_m[0], turn[0])
    fingers = dict(zip(grip.finger_joints, finger_rotations(grip, {}, 1)[0], strict=True))
    share = visible_share(character, model, instrument, body, grip.lips, wrists, fingers)
    if share.least >= LEAST_IN_SIGHT:
        return None
    shares = {"front": round(100.0 * share.front), "side": round(100.0 * share.side)}
    largest = instrument.hold.size_range[1]
    if instrument.size < largest:
        return Message("character.instrument_hidden", {**shares})
    return Message("character.instrument_too_small", {**shares, "percent": round(100.0 * largest)})


def visible_share(
    character: Character,
    model: InstrumentModel,
    instrument: InstrumentMap,
    body: Body,
    lips: Lips,
    wrists: Wrists,
    fingers: Mapping[int, FloatArray],
) -> VisibleShare:
    """Return the share of an instrument in sight while its player stands or sits still.

    Parameters
    ----------
    model : InstrumentModel
        The instrument, as large as the map.
    wrists : mapping
        Wrists in the instrument's frame, by side.
    fingers : mapping of int to (4,) float64
        Rotation of joints of fingers relative to the joint above; others are as in the T-pose.
    """
    stand = upright(character, instrument, body, lips)
    held = [
        _corners(quaternion.rotate(stand.instrument_rotation, mesh.positions_m) + stand.instrument_m, mesh.triangles)
        for mesh in model.meshes
    ]
    extents = np.ptp(np.concatenate([corners[:, 0] for corners in held]), axis=0)
    cell_m = float(extents.max()) / _CELLS
    placed = {
        side: (
            stand.instrument_m + quaternion.rotate(stand.instrument_rotation, place_m),
            quaternion.multiply(stand.instrument_rotation, turn),
        )
        for side, (place_m, turn) in wrists.items()
    }
    world = _posed(character, instrument, body, placed, fingers)
    own, others = spread(np.concatenate(held), cell_m), _covering(character, world)
    shares = [_in_sight(own, others, view, cell_m) for view in _VIEWS]
    return VisibleShare(shares[0], max(shares[1:]))


def _posed(
    character: Character, instrument: InstrumentMap, body: Body, wrists: Wrists, fingers: Mapping[int, FloatArray]
) -> FloatArray:
    """Return the transforms (1, J, 4, 4) of all joints of a player, with each arm straight behind its wrist."""
    skeleton = character.skeleton
    usual = usual_posture(instrument)
    still = forward(skeleton, joint_rotations(skeleton, carrying(body, usual, instrument.hold.carriage(usual))))
    places_m, turns, rest_m = still.positions_m[0].copy(), still.rotations[0].copy(), rest_positions(skeleton)
    for side, (wrist_m, turn) in wrists.items():
        wrist = skeleton.index(f"{side}Hand")
        for joint in ancestors(skeleton, wrist)[-3:]:
            places_m[joint], turns[joint] = wrist_m + quaternion.rotate(turn, rest_m[joint] - rest_m[wrist]), turn
        for joint in _below(character, wrist):
            above = skeleton.parents[joint]
            turns[joint] = quaternion.multiply(turns[above], fingers.get(joint, quaternion.IDENTITY))
            places_m[joint] = places_m[above] + quaternion.rotate(turns[above], skeleton.offsets_m[joint])
    world = np.tile(np.eye(4), (1, len(turns), 1, 1))
    world[0, :, :3, :3], world[0, :, :3, 3] = quaternion.to_matrix(turns), places_m
    return world


def _below(character: Character, joint: int) -> list[int]:
    """Return the joints below a joint, parents first."""
    skeleton = character.skeleton
    return [one for one in range(len(skeleton.names)) if one != joint and joint in ancestors(skeleton, one)]


def _covering(character: Character, world: FloatArray) -> FloatArray:
    """Return the corners (T, 3, 3) of the triangles of hands and head in a pose."""
    skeleton = character.skeleton
    roots = [skeleton.index(name) for name in ("leftHand", "rightHand", "head")]
    of_part = np.zeros(len(skeleton.names), dtype=bool)
    of_part[[joint for root in roots for joint in (root, *_below(character, root))]] = True
    found = [np.zeros((0, 3, 3))]
    for mesh in character.meshes:
        within = np.where(of_part[mesh.joints], mesh.weights, 0.0).sum(axis=1) > 0.5
        triangles = mesh.triangles[within[mesh.triangles].all(axis=1)]
        if len(triangles):
            used, rows = np.unique(triangles, return_inverse=True)
            placed_m = patch(character, mesh, used).deformed(world)[0]
            found.append(_corners(placed_m, rows.reshape(-1, 3)))
    return np.concatenate(found)


def _corners(places_m: FloatArray, triangles: AnyIntArray) -> FloatArray:
    return np.asarray(places_m[triangles], dtype=np.float64)


def spread(corners: FloatArray, cell_m: float) -> FloatArray:
    """Return points (P, 3) all over triangles with given corners, nearer to each other than cells."""
    # The first corner lies opposite the shortest edge: long, thin triangles need few rows.
    lengths_m = np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, 1, axis=1), axis=2)
    apex = lengths_m.argmin(axis=1)
    corners = np.take_along_axis(corners, ((apex[:, None] + np.arange(3)) % 3)[..., None], axis=1)
    splits = [_splits(lengths_m.max(axis=1) / cell_m), _splits(lengths_m.min(axis=1) / cell_m)]
    keys, groups = np.unique(np.stack(splits, axis=1), axis=0, return_inverse=True)
    points = [np.zeros((0, 3))]
    for number, (along, across) in enumerate(keys):
        if along == 1:
            points.append(corners[groups.ravel() == number].mean(axis=1))
            continue
        away, aside = np.meshgrid(np.arange(along + 1) / along, np.arange(across + 1) / across)
        shares = np.stack([1.0 - away, away * (1.0 - aside), away * aside]).reshape(3, -1).T
        points.append((shares @ corners[groups.ravel() == number]).reshape(-1, 3))
    return np.concatenate(points)


def _splits(cells: FloatArray) -> IndexArray:
    """Return numbers of parts (T,) into which edges of given lengths are split; powers of two make few groups."""
    parts = 2.0 ** np.ceil(np.log2(np.maximum(cells / _FINER, 1.0)))
    return np.minimum(parts, _MOST_SPLITS).astype(np.intp)


def _in_sight(own: FloatArray, others: FloatArray, view: tuple[int, int, int, float], cell_m: float) -> float:
    """Return the share of the cells of an instrument's outline in which no other surface is nearer to the viewer.

    ``own`` (P, 3) are points all over the instrument, ``others`` (T, 3, 3) corners of the other triangles.
    """
    across, up, ahead, sign = view
    plane = [across, up]
    low, high = own[:, plane].min(axis=0), own[:, plane].max(axis=0)
    shape = tuple(((high - low) / cell_m).astype(np.intp) + 1)
    beside = (others.min(axis=1)[:, plane] > high) | (others.max(axis=1)[:, plane] < low)
    behind = (sign * others[..., ahead]).max(axis=1) < (sign * own[:, ahead]).min()
    near = spread(others[~beside.any(axis=1) & ~behind], cell_m)

    def nearest(points: FloatArray) -> FloatArray:
        cells: IndexArray = np.floor((points[:, [across, up]] - low) / cell_m).astype(np.intp)
        inside = ((cells >= 0) & (cells < shape)).all(axis=1)
        depth = np.full(shape, -np.inf)
        np.maximum.at(depth, tuple(cells[inside].T), sign * points[inside, ahead])
        return depth

    mine = nearest(own)
    seen = np.isfinite(mine)
    return float((nearest(near) <= mine)[seen].mean())
