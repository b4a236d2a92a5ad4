"""Small and fast model of a character's hand: wrist frame, fifteen finger joints, and part of the skin.

Everything is computed in the wrist's frame for a batch of finger poses, so that a solver can try all perturbations in
one call.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import AnyIntArray, FloatArray, IndexArray
from app.identity_cache import IdentityCache
from app.rig import quaternion
from app.rig.grip.grip_pose import Side
from app.rig.model import Character
from app.rig.skeleton import ancestors, rest_positions
from app.rig.skinning import mesh_named, patch
from metadata.model import Body
from metadata.skeleton_profile import SkeletonProfile

FINGERS = ("thumb", "index", "middle", "ring", "little")
_CELL_M = 0.006
"""Size in metres of the cells to which skin is thinned, one vertex each; bundled bodies are hardly thinned, a scanned
one is.
"""
_BALLS = 3
"""Balls per bone of a finger."""
_PALM_STATIONS = (0.05, 0.25, 0.45, 0.65, 0.85)
"""Balls between the wrist and each knuckle."""
_FOREARM_M = (0.05, 0.1, 0.15, 0.2)
"""Balls in the forearm, behind the wrist."""
_SLEEVE_M, _PALM_M = 0.006, 0.014
_FOREARM_TAPER = 0.05
_FINGER_FLESH, _PALM_FLESH = 0.65, 0.85
"""Shares of a ball's radius that must stay outside the instrument: touching is measured on the skin, balls exclude thin
bars.
"""


@dataclass(frozen=True, eq=False)
class HandModel:
    """A hand in its wrist's frame, with 16 joints, by which grips are solved.

    Attributes
    ----------
    side : str
        ``left`` or ``right``.
    joints : tuple of int
        In the character's skeleton: the wrist, then thumb to little finger, three joints each (16).
    offsets_m : (16, 3) float64
        Position of each joint in its parent's frame; zero for the wrist.
    axes : (16, 3, 3) float64
        Flexion, sideways and twist axis of each joint (rows).
    limits : (16, 3, 2) float64
        Range of flexion, sideways and twist, radians.
    joint_from_mesh : (17, 3, 4) float64
        Inverse bind matrices; the last is that of the forearm, straight behind the wrist.
    forearm_m : (3,) float64
        The elbow in the wrist's frame at rest.
    landmarks : dict of str to (17, 4) float64
        Weighted homogeneous point per joint (see `LandmarkSet`).
    landmark_normals : dict of str to (17, 3) float64
        Weighted outward normal per joint of each landmark.
    skin_points : (17, 4, V) float64
        Some of the skin's vertices, as weighted points like the landmarks.
    all_points : (17, 4, W) float64
        All vertices of the hand's skin, likewise.
    balls : (B, 4) float64
        Balls that fill fingers and palm: centre in the frame of the joint that moves it, radius.
    ball_joints : (B,) int
        Joint 0..15 that moves each ball.
    ball_finger : (B,) int
        Finger 0..4, -1 for the palm.
    forearm_balls : (C, 2) float64
        Balls of the forearm: distance from the wrist, radius.
    ball_pairs : (N, 2) int
        Pairs of balls of different fingers that must not overlap.
    ball_gaps_m : (N,) float64
        Least distance required between the centres of a pair.
    """

    side: Side
    joints: tuple[int, ...]
    offsets_m: FloatArray
    axes: FloatArray
    limits: FloatArray
    joint_from_mesh: FloatArray
    forearm_m: FloatArray
    landmarks: dict[str, FloatArray]
    landmark_normals: dict[str, FloatArray]
    skin_points: FloatArray
    all_points: FloatArray
    balls: FloatArray
    ball_joints: IndexArray
    ball_finger: IndexArray
    forearm_balls: FloatArray
    ball_pairs: IndexArray
    ball_gaps_m: FloatArray


def joint_rotations(hand: HandModel, angles: FloatArray) -> FloatArray:
    """Return the rotations (B, 16, 4) of 16 joints in B poses for angles (B, 16, 3) of flexion, sideways and twist:
    swing after twist."""
    swing = angles[..., 0, None] * hand.axes[:, 0] + angles[..., 1, None] * hand.axes[:, 1]
    return quaternion.multiply(
        quaternion.from_rotation_vector(swing), quaternion.from_axis_angle(hand.axes[:, 2], angles[..., 2])
    )


def wrist_from_joint(hand: HandModel, rotations: FloatArray) -> FloatArray:
    """Return the transforms (B, 17, 3, 4) of the joints and the forearm in the wrist's frame in B poses; the wrist
    itself is the identity."""
    turn = quaternion.to_matrix(rotations)
    result = np.zeros((len(rotations), 17, 3, 4))
    result[:, 0, :, :3] = result[:, 16, :, :3] = np.eye(3)
    result[:, 16, :, 3] = hand.forearm_m
    for first in range(1, 16, 3):
        result[:, first, :, :3] = turn[:, first]
        result[:, first, :, 3] = hand.offsets_m[first]
        for joint in (first + 1, first + 2):
            above = result[:, joint - 1]
            result[:, joint, :, :3] = above[..., :3] @ turn[:, joint]
            result[:, joint, :, 3] = above[..., :3] @ hand.offsets_m[joint] + above[..., 3]
    return result


def wrist_from_mesh(hand: HandModel, transforms: FloatArray) -> FloatArray:
    """Return the skinning matrices (B, 17, 3, 4) for transforms of `wrist_from_joint`."""
    result: FloatArray = transforms[..., :3] @ hand.joint_from_mesh
    result[..., 3] += transforms[..., 3]
    return result


def skinned(matrices: FloatArray, points: FloatArray) -> FloatArray:
    """Return the points (B, V, 3) of V vertices in B poses of the hand, from homogeneous points weighted by frame (17,
    4, V)."""
    count = points.shape[2]
    flat = matrices.transpose(0, 2, 1, 3).reshape(len(matrices) * 3, 17 * 4) @ points.reshape(17 * 4, count)
    return flat.reshape(len(matrices), 3, count).transpose(0, 2, 1)


def turned(matrices: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the unit normals (B, L, 3) of L vertices in B poses of the hand, from normals weighted by frame (17, 3,
    L)."""
    count = normals.shape[2]
    flat = matrices[..., :3].transpose(0, 2, 1, 3).reshape(len(matrices) * 3, 17 * 3) @ normals.reshape(17 * 3, count)
    result = flat.reshape(len(matrices), 3, count).transpose(0, 2, 1)
    unit: FloatArray = result / np.sqrt(np.einsum("blc,blc->bl", result, result))[..., None]
    return unit


def rest_landmark(hand: HandModel, name: str) -> FloatArray:
    """Return the position (3,) of a landmark in the wrist's frame with the fingers at rest."""
    still = wrist_from_joint(hand, np.tile(quaternion.IDENTITY, (1, 16, 1)))
    place: FloatArray = skinned(wrist_from_mesh(hand, still), hand.landmarks[name][:, :, None])[0, 0]
    return place


def flesh_radius(hand: HandModel) -> FloatArray:
    """Return the radii in metres (balls,) of the balls that must stay outside the instrument; those of the forearm come
    last.
    """
    firm = np.where(hand.ball_finger >= 0, _FINGER_FLESH, _PALM_FLESH) * hand.balls[:, 3]
    return np.concatenate([firm, _PALM_FLESH * hand.forearm_balls[:, 1]])


def ball_centres(hand: HandModel, transforms: FloatArray) -> FloatArray:
    """Return the centres (B, balls, 3) of the hand's balls in B poses in the wrist's frame."""
    carrier = transforms[:, hand.ball_joints]
    result: FloatArray = np.einsum("bkij,kj->bki", carrier[..., :3], hand.balls[:, :3]) + carrier[..., 3]
    return result


_SIDES: dict[Side, Side] = {"left": "left", "right": "right"}
"""Each side as one object, by which results are kept."""
_MODELS: IdentityCache[HandModel] = IdentityCache(48)


def hand_model(character: Character, side: Side, body: Body, profile: SkeletonProfile) -> HandModel:
    """Return the model of a character's hand, cached.

    Parameters
    ----------
    side : str
        ``left`` or ``right``.
    body : Body
        Limits of the joints.
    profile : SkeletonProfile
        Axes of the joints.
    """
    return _MODELS.step(_made, character, _SIDES[side], body, profile)


def _made(character: Character, side: Side, body: Body, profile: SkeletonProfile) -> HandModel:
    skeleton = character.skeleton
    names = [f"{side}Hand", *(name for finger in FINGERS for name in profile.fingers[side][finger].joints)]  # type: ignore[index]
    joints = tuple(skeleton.index(name) for name in names)
    elbow = skeleton.index(f"{side}LowerArm")
    rest = rest_positions(skeleton)
    offsets = np.zeros((16, 3))
    axes, limits = np.zeros((16, 3, 3)), np.zeros((16, 3, 2))
    for place, name in enumerate(names):
        above = joints[0] if place % 3 == 1 else joints[place - 1]
        if place:
            offsets[place] = rest[joints[place]] - rest[above]
        kind = profile.joint_axes(name)
        axes[place] = [kind.flexion, kind.sideways, kind.twist]
        bound = body.limits[profile.joint(name).kind]
        limits[place] = np.radians([bound.flexion_deg, bound.sideways_deg, bound.twist_deg])
    bind = character.joint_from_mesh[[*joints, elbow], :3, :]
    table = _carrier_table(character, joints, elbow)
    marks = {
        name: mark for name, mark in character.landmarks.items() if name.startswith(f"{side}.") and ".foot." not in name
    }
    landmarks, normals = {}, {}
    for name, mark in marks.items():
        points, directions = _moments(character, mark.mesh, mark.vertices, table)
        landmarks[name] = points.mean(axis=2)
        normals[name] = directions.mean(axis=2)
    whole = marks[f"{side}.hand"]
    points, _ = _moments(character, whole.mesh, whole.vertices, table)
    none = np.zeros(0, dtype=np.intp)
    draft = HandModel(
        side=side,
        joints=joints,
        offsets_m=offsets,
        axes=axes,
        limits=limits,
        joint_from_mesh=bind,
        forearm_m=rest[elbow] - rest[joints[0]],
        landmarks=landmarks,
        landmark_normals=normals,
        skin_points=points,
        all_points=points,
        balls=np.zeros((0, 4)),
        ball_joints=none,
        ball_finger=none,
        forearm_balls=np.zeros((0, 2)),
        ball_pairs=np.zeros((0, 2), dtype=np.intp),
        ball_gaps_m=np.zeros(0),
    )
    return _with_skin(draft)


def _carrier_table(character: Character, joints: Sequence[int], elbow: int) -> IndexArray:
    """Return for each joint of the skeleton (J,) the index (0..16) of the hand model's frame that moves it: that of the
    nearest ancestor in the hand, else the forearm's (16).
    """
    place = {joint: index for index, joint in enumerate(joints)}
    table = np.full(len(character.skeleton.names), 16, dtype=np.intp)
    for joint in range(len(table)):
        for above in reversed(ancestors(character.skeleton, joint)):
            if above in place or above == elbow:
                table[joint] = place.get(above, 16)
                break
    return table


def _moments(
    character: Character, mesh_name: str, vertices: AnyIntArray, table: IndexArray
) -> tuple[FloatArray, FloatArray]:
    """Return homogeneous points (17, 4, V) and normals (17, 3, V) of V vertices, weighted by the hand's 17 frames."""
    part = patch(character, mesh_named(character, mesh_name), vertices)
    weights = np.zeros((17, len(vertices)))
    np.add.at(weights, table[part.joints], part.weights.T)
    points = np.concatenate([part.positions_m.T, np.ones((1, len(vertices)))])
    return weights[:, None] * points, weights[:, None] * part.normals.T


def _with_skin(hand: HandModel) -> HandModel:
    """Return the hand model with a reduced set of skin vertices, and with balls that fill the hand."""
    rest = wrist_from_joint(hand, np.tile(quaternion.IDENTITY, (1, 16, 1)))
    skin = skinned(wrist_from_mesh(hand, rest), hand.all_points)[0]
    weights = hand.all_points[:, 3]
    cells = np.floor(skin / _CELL_M).astype(np.int64)
    _, chosen = np.unique(cells, axis=0, return_index=True)
    chosen = np.sort(chosen)
    owner = np.argmax(weights, axis=0)
    found = [*_finger_balls(hand, rest, skin, owner, weights), *_palm_balls(hand, skin, owner)]
    carriers = np.array([joint for joint, _ in found], dtype=np.intp)
    ball = np.array([ball for _, ball in found], dtype=np.float64).reshape(-1, 4)
    finger = np.where(carriers > 0, (carriers - 1) // 3, -1)
    first, second = np.triu_indices(len(ball), 1)
    apart = (finger[first] != finger[second]) & (carriers[first] > 1) & (carriers[second] > 1)
    pairs = np.stack([first[apart], second[apart]], axis=1)
    centres = rest[0, carriers, :, 3] + ball[:, :3]
    gaps = ball[pairs[:, 0], 3] + ball[pairs[:, 1], 3] - 0.001
    at_rest = np.linalg.norm(centres[pairs[:, 0]] - centres[pairs[:, 1]], axis=1)
    palm = [radius for joint, (_, _, _, radius) in found if joint == 0]
    wrist_m = (float(np.median(palm)) if palm else _PALM_M) + _SLEEVE_M
    forearm = [[behind, wrist_m + _FOREARM_TAPER * behind] for behind in _FOREARM_M]
    return replace(
        hand,
        skin_points=np.ascontiguousarray(hand.all_points[:, :, chosen]),
        balls=ball,
        ball_joints=carriers,
        ball_finger=finger,
        forearm_balls=np.array(forearm),
        ball_pairs=pairs,
        ball_gaps_m=np.minimum(gaps, at_rest),
    )


def _finger_balls(
    hand: HandModel, rest: FloatArray, skin: FloatArray, owner: IndexArray, weights: FloatArray
) -> list[tuple[int, list[float]]]:
    """Return balls that stand for the flesh of fingers and thumb along their bones, as (joint, [x, y, z, radius])."""
    found = []
    for joint in range(1, 16):
        own = skin[(owner == joint) & (weights[joint] > 0.6)] - rest[0, joint, :, 3]
        if len(own) < 4:
            continue
        axis = hand.axes[joint, 2] * np.sign(hand.axes[joint, 2] @ own.mean(axis=0))
        tip = joint % 3 == 0
        length = np.max(own @ axis) if tip else float(np.linalg.norm(hand.offsets_m[joint + 1]))
        along = own @ axis
        for station in (np.arange(_BALLS) + 0.5) / _BALLS:
            ring = own[np.abs(along - station * length) < length / 4]
            if len(ring) < 4:
                continue
            middle = (ring.min(axis=0) + ring.max(axis=0)) / 2
            middle += axis * (station * length - middle @ axis)
            off = ring - middle
            off -= np.outer(off @ axis, axis)
            found.append((joint, [*middle, float(np.median(np.linalg.norm(off, axis=1)))]))
    return found


def _palm_balls(hand: HandModel, skin: FloatArray, owner: IndexArray) -> list[tuple[int, list[float]]]:
    """Return balls that stand for the flesh of the palm from the wrist to each knuckle, half as thick as the palm
    there, as (frame, [x, y, z, radius]).
    """
    found = []
    flesh = skin[(owner == 0) | (owner == 16) | (owner == 1) | ((owner - 1) % 3 == 0)]
    for knuckle in (4, 7, 10, 13):
        for station in _PALM_STATIONS:
            at = hand.offsets_m[knuckle] * station
            # At rest the palm faces down, so its thickness is measured along Y.
            column = flesh[np.hypot(flesh[:, 0] - at[0], flesh[:, 2] - at[2]) < 0.008]
            if len(column) >= 2 and np.ptp(column[:, 1]) > 0.01:
                low, high = column[:, 1].min(), column[:, 1].max()
                found.append((0, [at[0], (low + high) / 2, at[2], (high - low) / 2]))
    return found
