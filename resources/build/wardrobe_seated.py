"""Weights of skirts that lie on the thighs of who sits.

A skirt hangs from the hips, some centimetres before the legs and behind them. Turned with the thighs it would stand off
them by as much. A share of the hips' own weight lets its front down onto them, one of the shins' lets its hem down onto
the knees and lifts its back. Between the legs cloth spans from thigh to thigh.
"""

from __future__ import annotations

import itertools

import numpy as np
from character_cloth import smoothstep
from scipy.ndimage import gaussian_filter
from scipy.spatial import ConvexHull
from wardrobe_pieces import Wearer

SEAT_RAD = np.radians(85.0)
LIES_M = 0.010
LEAST_M, MOST = 0.02, 0.45
"""Least height by which the transfer of weight moves cloth, and greatest transferred share."""
SLICE_M, ASIDE_M = 0.02, 0.025
"""Half of the slice of the body that a place of the skirt lies on, and distance beyond its sides within which cloth
still lies on it."""
KNEE_CAP_M = 0.03
"""Distance behind the foremost point of seated knees of the height at which cloth hangs before them."""
KNEE_M = (0.02, 0.10)
"""Heights above the knees up to which the shins let the front down, and from which the hips do."""


def _seated(wearer: Wearer, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (N, 3) in a seated pose of points that move with the thighs, and with the shins."""
    fit = wearer.fit
    hip, knee = (fit.positions_t[fit.index(f"left{part}Leg")] for part in ("Upper", "Lower"))
    cosine, sine = np.cos(SEAT_RAD), np.sin(SEAT_RAD)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])
    about = np.array([0.0, hip[1], hip[2]])
    thigh = (points - about) @ turn.T + about
    below = np.array([0.0, knee[1], knee[2]])
    return thigh, points + ((below - about) @ turn.T + about - below)


def _blend(wearer: Wearer, points: np.ndarray, weights: np.ndarray) -> np.ndarray:
    thigh, shin = _seated(wearer, points)
    shares = [
        weights[:, [wearer.fit.index(f"{side}{part}Leg") for side in ("left", "right")]].sum(axis=1)[:, None]
        for part in ("Upper", "Lower")
    ]
    return points + shares[0] * (thigh - points) + shares[1] * (shin - points)


def _spanned(body: np.ndarray, places: np.ndarray, sign: float) -> np.ndarray:
    """Heights (N,) of a cloth spanned over the tops (`sign` 1) or undersides (-1) of both legs at places (N, 3), before
    the knees those of the knees; NaN where there is no body."""
    found, foremost = np.full(len(places), np.nan), body[:, 2].max() - KNEE_CAP_M
    for row, place in enumerate(np.minimum(places, [np.inf, np.inf, foremost])):
        near = body[np.abs(body[:, 2] - place[2]) < SLICE_M]
        if len(near) < 3 or not near[:, 0].min() - ASIDE_M < place[0] < near[:, 0].max() + ASIDE_M:
            continue
        wide = np.concatenate([near[:, :2] + [aside, 0.0] for aside in (-ASIDE_M, ASIDE_M)])
        corners = wide[ConvexHull(wide).vertices]
        corners = np.concatenate([corners, corners[:1]])
        heights = [
            one[1] + (other[1] - one[1]) * (place[0] - one[0]) / (other[0] - one[0])
            for one, other in itertools.pairwise(corners)
            if min(one[0], other[0]) <= place[0] <= max(one[0], other[0]) and one[0] != other[0]
        ]
        found[row] = sign * max(sign * height for height in heights)
    return found


def _of_four(wearer: Wearer, weights: np.ndarray) -> np.ndarray:
    """Weights (N, J) of both legs with no row that has hips and shins, so that none of the four of the legs is lost."""
    parts = {part: [wearer.fit.index(f"{side}{part}Leg") for side in ("left", "right")] for part in ("Upper", "Lower")}
    hips, found = wearer.fit.index("hips"), weights.copy()
    shins = weights[:, parts["Lower"]].sum(axis=1)
    both = np.minimum(weights[:, hips], shins)
    share = weights[:, parts["Lower"]] / np.maximum(shins, 1e-9)[:, None]
    found[:, hips] -= both
    found[:, parts["Lower"]] -= both[:, None] * share
    found[:, parts["Upper"]] += 2.0 * both[:, None] * share
    return found


def seated_weights(
    wearer: Wearer, points: np.ndarray, weights: np.ndarray, columns: int, left: np.ndarray
) -> np.ndarray:
    """Weights (N, J) of a skirt's grid, in rows from the waist down, that also suit a seated pose; `left` (N,) is the
    left leg's share."""
    fit, suit = wearer.fit, wearer.tailoring.suit
    hip, knee = (fit.positions_t[fit.index(f"left{part}Leg")] for part in ("Upper", "Lower"))
    thighs, shins = (
        suit.weights[:, [fit.index(f"{side}{part}Leg") for side in ("left", "right")]].sum(axis=1)
        for part in ("Upper", "Lower")
    )
    legs, seat = thighs + shins > 0.5, (wearer.tailoring.arm < 0.3) & (shins < 0.4)
    body = _blend(wearer, suit.points, suit.weights)
    ahead = points[:, 2] - hip[2]
    front, back = smoothstep(ahead, 0.0, 0.06), smoothstep(-ahead, 0.0, 0.06)
    low = 1.0 - smoothstep(points[:, 1], hip[1] - 0.16, hip[1] - 0.04)
    high = smoothstep(points[:, 1], knee[1] + KNEE_M[0], knee[1] + KNEE_M[1])
    found = weights
    ways = (("hips", 1.0, front, high), ("shin", 1.0, front, 1.0 - high), ("shin", -1.0, back, np.ones_like(high)))
    for bone, sign, side, there in ways:
        placed = _blend(wearer, points, found)
        given = points if bone == "hips" else _seated(wearer, points)[1]
        wanted = _spanned(body[legs if sign > 0.0 else seat], placed, sign) + sign * LIES_M
        fall = sign * (placed[:, 1] - wanted)
        way = sign * (placed[:, 1] - given[:, 1])
        share = (np.clip(fall / np.maximum(way, 0.05), 0.0, MOST) * (way > LEAST_M) * side * low).reshape(-1, columns)
        for above, own in itertools.pairwise(share):
            # Before the knees nothing is below: the cloth goes on as it lay.
            own[:] = np.where(np.isnan(own), np.nan_to_num(above), own)
        share = gaussian_filter(np.nan_to_num(share), (1.0, 3.0), mode=("nearest", "wrap")).reshape(-1, 1)
        share *= there[:, None]
        gift = np.zeros_like(found)
        if bone == "hips":
            gift[:, fit.index("hips")] = 1.0
        else:
            gift[:, fit.index("leftLowerLeg")], gift[:, fit.index("rightLowerLeg")] = left, 1.0 - left
        found = found * (1.0 - share) + gift * share
    return _of_four(wearer, found)
