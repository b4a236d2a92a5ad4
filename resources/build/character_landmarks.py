"""Named places on a character's surface: finger pads, lips for mouthpieces, soles."""

from __future__ import annotations

import numpy as np
from character_skeleton import FINGERS, SkeletonFit, phalanges
from character_surface import Surface

FINGER_MATERIAL, NAIL_MATERIAL, LIP_MATERIAL = "skin", "nails", "lips"
PAD_VERTICES = 6
BARE_MIDDLE = (0.62, 0.5, 0.55)
"""Centres of the visible parts of the phalanges as shares of their lengths; the web covers half of the first."""


def _entry(surface: Surface, vertices: np.ndarray) -> dict[str, object]:
    return {"mesh": surface.name, "vertices": [int(vertex) for vertex in np.sort(vertices)]}


def _nearest(points: np.ndarray, target: np.ndarray, candidates: np.ndarray, count: int) -> np.ndarray:
    distances = np.linalg.norm(points[candidates] - target, axis=1)
    return candidates[np.argsort(distances, kind="stable")[:count]]


def _patch(body: Surface, candidates: np.ndarray, origin: np.ndarray, direction: np.ndarray, count: int) -> np.ndarray:
    """The `count` candidates nearest to the point at which a ray from inside a limb leaves the skin."""
    offsets = body.positions[candidates] - origin
    along = offsets @ direction
    across = np.linalg.norm(offsets - along[:, None] * direction, axis=1)
    facing = (body.normals[candidates] @ direction > 0.5) & (along > 0)
    if not facing.any():
        raise ValueError("no skin faces this way")
    front = candidates[facing]
    surface_point = origin + direction * along[facing][np.argmin(across[facing])]
    return _nearest(body.positions, surface_point, front, count)


def _phalanx_length_m(
    fit: SkeletonFit, tips: dict[str, np.ndarray], joint: str, following: str | None, finger: str
) -> float:
    start = fit.world_from_joint_rest[fit.index(joint), :3, 3]
    end = tips[finger] if following is None else fit.world_from_joint_rest[fit.index(following), :3, 3]
    return float(np.linalg.norm(end - start))


def _finger(
    body: Surface, fit: SkeletonFit, tips: dict[str, np.ndarray], side: str, finger: str
) -> dict[str, np.ndarray]:
    """Pads of all phalanges and their thumb's side."""
    sign = 1.0 if side == "left" else -1.0
    joints = [side + finger + phalanx for phalanx in phalanges(finger)]
    nails = np.unique(body.triangles[NAIL_MATERIAL])
    distal_weight = body.weights[:, fit.index(joints[2])]
    nail = nails[distal_weight[nails] > 0.5]
    nail_direction = body.normals[nail].mean(axis=0)
    places = {}
    names = {0: "_proximal", 1: "_middle", 2: ""}
    for order, joint in enumerate(joints):
        if finger == "Thumb" and order == 0:
            continue
        frame = fit.world_from_joint_rest[fit.index(joint)]
        following = joints[order + 1] if order < 2 else None
        length = _phalanx_length_m(fit, tips, joint, following, side + finger)
        axis = frame[:3, :3] @ (_thumb_axis(sign) if finger == "Thumb" else np.array([sign, 0.0, 0.0]))
        dorsal = nail_direction - axis * (nail_direction @ axis)
        dorsal /= np.linalg.norm(dorsal)
        thumb_side = np.cross(dorsal, axis) * -sign
        middle = frame[:3, 3] + axis * length * BARE_MIDDLE[order]
        own = np.flatnonzero(body.weights[:, fit.index(joint)] > (0.9 if order == 2 else 0.6))
        places["pad" + names[order]] = _patch(body, own, middle, -dorsal, PAD_VERTICES)
        places["side" + names[order]] = _patch(body, own, middle, thumb_side, 4)
    return places


def _thumb_axis(sign: float) -> np.ndarray:
    return np.array([sign, 0.0, 1.0]) / np.sqrt(2.0)


def _hand(body: Surface, fit: SkeletonFit, side: str) -> dict[str, np.ndarray]:
    sign = 1.0 if side == "left" else -1.0
    joints = [fit.index(side + "Hand")]
    joints += [fit.index(side + finger + phalanx) for finger in FINGERS for phalanx in phalanges(finger)]
    hand = np.flatnonzero(body.weights[:, joints].sum(axis=1) > 0.5)
    frame = fit.world_from_joint_rest[joints[0]]
    knuckle = fit.world_from_joint_rest[fit.index(side + "MiddleProximal"), :3, 3]
    length = float(np.linalg.norm(knuckle - frame[:3, 3]))
    palm = frame[:3, 3] + frame[:3, :3] @ np.array([sign * 0.6 * length, 0.0, 0.0])
    index = fit.world_from_joint_rest[fit.index(side + "IndexProximal"), :3, 3]
    thumb = fit.world_from_joint_rest[fit.index(side + "ThumbProximal"), :3, 3]
    return {
        "hand": hand,
        "palm": _patch(body, hand, palm, -frame[:3, 1], 8),
        "thumb_web": _nearest(body.positions, (index + thumb) / 2, hand, 5),
    }


def _lips(body: Surface) -> dict[str, np.ndarray]:
    """Front of the upper and of the lower vermilion, and the vertices about the middle of the closed lips' front."""
    lips = np.unique(body.triangles[LIP_MATERIAL])
    drop = body.morphs["jawOpen"][lips, 1]
    upper, lower = lips[drop > drop.min() * 0.3], lips[drop < drop.min() * 0.7]
    centre_upper = upper[np.abs(body.positions[upper, 0]) < 0.006]
    centre_lower = lower[np.abs(body.positions[lower, 0]) < 0.006]

    def front(side: np.ndarray) -> np.ndarray:
        facing = side[body.normals[side, 2] > 0.4]
        middle = body.positions[facing].mean(axis=0) * np.array([0.0, 1.0, 1.0])
        return _nearest(body.positions, middle, facing, PAD_VERTICES)

    gaps = np.linalg.norm(body.positions[centre_upper][:, None] - body.positions[centre_lower][None], axis=2)
    # The foremost place where the lips all but touch.
    score = gaps - 0.5 * (body.positions[centre_upper, 2][:, None] + body.positions[centre_lower, 2][None])
    pairs = np.argsort(score, axis=None, kind="stable")[:6]
    first, second = np.unravel_index(pairs, gaps.shape)
    return {
        "upper": front(centre_upper),
        "lower": front(centre_lower),
        "contact": np.unique(np.concatenate([centre_upper[first], centre_lower[second]])),
    }


def landmarks(
    body: Surface, fit: SkeletonFit, tips: dict[str, np.ndarray], soles: dict[str, dict[str, object]]
) -> dict[str, object]:
    """All landmarks by name; `tips` are the finger tips in the rest pose by "leftIndex" and the like."""
    found: dict[str, object] = {f"lips.{name}": _entry(body, vertices) for name, vertices in _lips(body).items()}
    for side in ("left", "right"):
        for name, vertices in _hand(body, fit, side).items():
            found[f"{side}.{name}"] = _entry(body, vertices)
        for finger in FINGERS:
            for name, vertices in _finger(body, fit, tips, side, finger).items():
                found[f"{side}.{finger.lower()}.{name}"] = _entry(body, vertices)
        found[f"{side}.foot.sole"] = soles[side]
    return found
