"""Framing of the 3D viewport: the initial camera of each view, and the point that it keeps in the middle."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.project.camera_bookmarks import View
from app.rig.grip.body_size import face_size
from widgets.viewport.camera import Camera, box_corners, frame, frame_around, frame_points
from widgets.viewport.cast import Stage
from widgets.viewport.finger_visibility import clearest, directions, fingers_seen
from widgets.viewport.limb_capsules import model_bounds

# Angle from the player's front towards their left and elevation of the eye, in degrees; for hands the usual ones.
_DIRECTIONS_DEG: dict[View, tuple[float, float]] = {
    "ensemble": (0.0, 9.0),
    "front": (0.0, 4.0),
    "side": (-90.0, 4.0),
    "top": (0.0, 89.9),
    "hands": (-24.0, 20.0),
    "mouth": (-58.0, 4.0),
    "feet": (-28.0, 16.0),
}
_HALF_M: dict[View, float] = {"mouth": 0.115, "feet": 0.30}
"""Least half height in metres of a close-up's picture, by view."""
_SHOE_M: Final = (-0.1, 0.2)
"""Distance in metres of a shoe's heel and tip ahead of the ankle."""
_STEPPING_ROOM_M: Final = 0.17
"""Room in metres around dancing feet to every side: a camera follows them late, and between the poses that it was
placed for they step farther.
"""
_HANDS_MARGIN = 1.25
"""Height of the picture relative to that of the hands' bones, so that hands and part of the instrument are visible."""
_FINGERS = tuple(
    f"{side}{name}"
    for side in ("left", "right")
    for name in (
        "Hand",
        "ThumbDistal",
        *(
            f"{finger}{bone}"
            for finger in ("Index", "Middle", "Ring", "Little")
            for bone in ("Proximal", "Intermediate", "Distal")
        ),
    )
)
"""Joints shown by a close-up of the hands."""
HEAD_M = 0.16
"""Distance in metres from a head's joint to its crown."""
_BUST_M = 0.3
"""Distance in metres from the centre of the head to the side of a bust's box."""
BODY_M = 0.55
"""Distance in metres from the middle that a player with an instrument takes."""
SEEN_THROUGH: Final = 0.85
"""Share of the pixels that are omitted to draw a performer in the way transparently."""
_LEAST_COMMON_FRONT: Final = 0.2
"""Length of the mean of several performers' front directions below which they have no common front."""
_OMITTED_SHARES: Final = (0.55, 0.7)
"""Shares of the way to the selected performer up to which one in the way is omitted wholly, and from which one is drawn
transparently; a body at half of the way looks twice as large."""


def view_camera(view: View, stage: Stage, rows: Sequence[int], camera: Camera, aspect: float) -> Camera:
    """Return the camera of a view.

    Parameters
    ----------
    view : View
        The view.
    stage : Stage
        Performers with their poses.
    rows : sequence of int
        Rows of the selected players, the active one first.
    camera : Camera
        Previous camera, whose angle of view is used; it is returned if there is no player to show.
    aspect : float
        Width over height.
    """
    return steady_camera(view, (stage,), rows, camera, aspect)


def steady_camera(view: View, posed: Iterable[Stage], rows: Sequence[int], camera: Camera, aspect: float) -> Camera:
    """Return the camera of a view that suits several poses: one direction with all performers visible in each pose.

    Parameters
    ----------
    posed : iterable of Stage
        The same stage, in another pose at each iteration.
    """
    clear, around, boxes = list[FloatArray](), list[FloatArray](), list[tuple[FloatArray, FloatArray]]()
    everything = list[FloatArray]()
    turn, middle, usual = 0.0, None, _DIRECTIONS_DEG[view]
    for stage in posed:
        everyone = [row for row in range(len(stage.members)) if stage.shown[row]]
        chosen = everyone if view == "ensemble" else [row for row in rows if stage.shown[row]]
        if not chosen:
            continue
        turn = 0.0 if view == "ensemble" else _turn_of_all_rad(stage, chosen)
        if view == "hands":
            clear.append(fingers_seen(stage, chosen[0], directions(usual), turn))
        middle = tracked(view, stage, chosen[0])
        if view == "ensemble":
            everything.append(corners(stage, chosen))
        elif middle is None:
            boxes.append(_bust(stage, chosen) if view == "front" else bounds(stage, chosen))
        else:
            around.append(_around(view, stage, chosen[0], middle))
    if not boxes and not around and not everything:
        return camera
    side_deg, pitch_deg = clearest(np.mean(clear, axis=0), usual) if clear else usual
    yaw = math.radians(side_deg) + turn
    camera = replace(camera, yaw_rad=math.remainder(yaw, 2.0 * math.pi), pitch_rad=math.radians(pitch_deg))
    if middle is not None:
        margin = _HANDS_MARGIN if view == "hands" else 1.0
        return frame_around(camera, middle, middle + np.concatenate(around), aspect, margin)
    if everything:
        return frame_points(camera, np.concatenate(everything), aspect)
    low = np.min([box[0] for box in boxes], axis=0)
    high = np.max([box[1] for box in boxes], axis=0)
    return frame(camera, low, high, aspect, 1.08)


def tracked(view: View, stage: Stage, row: int) -> FloatArray | None:
    """Return the point (3,) that a close-up keeps in the middle; None if the view follows nothing."""
    if not stage.shown[row]:
        return None
    if view == "hands":
        hands: FloatArray = _hands(stage, row).mean(axis=0)
        return hands
    if view == "mouth":
        held = stage.node_matrix(row)
        assets = stage.members[row].assets
        lips = held[:, :3] @ np.asarray(assets.map.mouthpiece.position_m) + held[:, 3]
        # Lips and eyes, and still the face while the instrument is lowered in a long rest.
        head = stage.joints[row, assets.character.skeleton.index("head")]
        size = face_size(assets.character)
        face: FloatArray = head[:, :3] @ (size * np.array([0.0, 0.02, 0.09])) + head[:, 3]
        near = float(np.clip(1.0 - (np.linalg.norm(lips - face) / size - 0.1) / 0.15, 0.0, 1.0))
        mouth: FloatArray = (1.0 - 0.6 * near) * face + 0.6 * near * lips
        return mouth
    if view == "feet":
        feet = np.array([stage.joint_m(row, "leftFoot"), stage.joint_m(row, "rightFoot")])
        low: FloatArray = feet.mean(axis=0) + np.array([0.0, 0.05, 0.0]) + 0.08 * front_direction(stage, row)
        return low
    return None


def needed_distance_m(view: View, stage: Stage, row: int, camera: Camera, aspect: float) -> float | None:
    """Return the distance in metres at which a camera shows all of a close-up; None if it is constant."""
    middle = tracked(view, stage, row)
    if view != "hands" or middle is None:
        return None
    return frame_around(camera, middle, middle + _around(view, stage, row, middle), aspect, _HANDS_MARGIN).distance_m


def in_the_way(view: View, stage: Stage, rows: Sequence[int], camera: Camera) -> dict[int, float]:
    """Return the performers who stand between the camera and the selected ones, if the view is about these: by row, the
    share of pixels to omit, 0 to 1. A body near the camera, which would fill the picture, is omitted wholly.
    """
    chosen = [row for row in rows if stage.shown[row]]
    others = [row for row in range(len(stage.members)) if stage.shown[row] and row not in chosen]
    if view == "ensemble" or not chosen or not others:
        return {}
    # Dancers and players who step are not at their places.
    chests = np.array([stage.joint_m(row, "hips") for row in (*chosen, *others)])
    chests[:, 1] = camera.eye_m[1]
    off = chests - camera.eye_m
    found = dict[int, float]()
    for way in off[: len(chosen)]:
        length = float(np.linalg.norm(way))
        if length < 1e-6:
            continue
        along = off[len(chosen) :] @ way / length
        aside = np.linalg.norm(off[len(chosen) :] - along[:, None] * way / length, axis=1)
        before = (along > -BODY_M) & (along < length - BODY_M) & (aside < BODY_M)
        full, half = (share * length for share in _OMITTED_SHARES)
        omitted = np.interp(along, (full, half), (1.0, SEEN_THROUGH))
        for index in np.flatnonzero(before):
            row = others[index]
            found[row] = max(found.get(row, 0.0), float(omitted[index]))
    return found


def corners(stage: Stage, rows: Sequence[int]) -> FloatArray:
    """Return the corners (8 per row, 3), in the world in metres, of a box around each of some players with instrument.

    One box around all would have corners where no one is, and leave room for them.
    """
    return np.concatenate([box_corners(*bounds(stage, [row])) for row in rows])


def bounds(stage: Stage, rows: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """Least and greatest corner (3,), in the world in metres, of a box around players with their instruments, from the
    floor up."""
    points = []
    for row in rows:
        assets = stage.members[row].assets
        points.append(stage.joints[row, 1 : len(assets.character.skeleton.names), :, 3])
        head_m = stage.joint_m(row, "head")
        points.append(head_m[None] + [0.0, (face_size(assets.character) - 1.0) * HEAD_M, 0.0])
        if assets.held is None:
            continue
        low, high = model_bounds(assets.instrument)
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        held = stage.node_matrix(row)
        points.append(corners @ held[:, :3].T + held[:, 3])
    whole = np.concatenate(points)
    flesh_m = 0.10
    low, high = whole.min(axis=0) - flesh_m, whole.max(axis=0) + np.array([flesh_m, HEAD_M, flesh_m])
    low[1] = min(float(low[1]), 0.0)
    return low, high


def _bust(stage: Stage, rows: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """Return least and greatest corner (3,) of a box around players from the hips up, or from the floor up if they
    dance; it is centred on the bodies regardless of the arms.
    """
    low, high = bounds(stage, rows)
    if any(stage.members[row].assets.held is None for row in rows):
        return low, high
    on_foot = any(stage.members[row].dances_on_foot for row in rows)
    heads_m = np.array([stage.joint_m(row, "head") for row in rows])
    hips_m = min(float(stage.joint_m(row, "hips")[1]) for row in rows)
    for axis in (0, 2):
        low[axis], high[axis] = heads_m[:, axis].min() - _BUST_M, heads_m[:, axis].max() + _BUST_M
    if not on_foot:
        low[1] = hips_m
    return low, high


def turn_rad(stage: Stage, row: int) -> float:
    """Return the direction in which a player faces, radians from +Z towards +X."""
    forward = front_direction(stage, row)
    return math.atan2(forward[0], forward[2])


def _turn_of_all_rad(stage: Stage, rows: Sequence[int]) -> float:
    """Return the mean direction in which performers face, radians from +Z towards +X; that of the first one if they
    face one another.
    """
    mean: FloatArray = np.mean([front_direction(stage, row) for row in rows], axis=0)
    if math.hypot(mean[0], mean[2]) < _LEAST_COMMON_FRONT:
        return turn_rad(stage, rows[0])
    return math.atan2(mean[0], mean[2])


def front_direction(stage: Stage, row: int) -> FloatArray:
    """Horizontal unit vector (3,) in the world to which a player faces."""
    return stage.members[row].world_from_player[:, 2]


def _hands(stage: Stage, row: int) -> FloatArray:
    names = [f"{side}{joint}" for side in ("left", "right") for joint in ("Hand", "MiddleProximal")]
    return np.array([stage.joint_m(row, name) for name in names])


def _around(view: View, stage: Stage, row: int, middle: FloatArray) -> FloatArray:
    """Return the points (N, 3) that a close-up must show, relative to its middle."""
    if view == "hands":
        return np.array([stage.joint_m(row, name) for name in _FINGERS]) - middle
    half = 0.58 * _HALF_M[view]
    if view == "mouth":
        half *= face_size(stage.members[row].assets.character)
    corners = np.array(list(product((-1.0, 1.0), repeat=3)))
    if view == "feet" and stage.members[row].dances_on_foot:
        # Steps go out of a picture of standing feet.
        joints = stage.members[row].assets.character.skeleton
        feet = stage.joints[row, [joints.index(name) for name in ("leftFoot", "rightFoot")]]
        ends = [feet[:, :, 3] + along_m * feet[:, :, 2] - middle for along_m in _SHOE_M]
        return np.concatenate([half * corners, *(end + _STEPPING_ROOM_M * corners for end in np.concatenate(ends))])
    return half * corners
