"""Weights of skirts that lie on the thighs of who sits.

A skirt hangs from the hips, some centimetres before the legs and behind them. Turned with the thighs it would stand off
them by as much. A share of the hips' own weight lets its front down onto them, a share of the shins' lifts its back.
"""

from __future__ import annotations

import itertools

import numpy as np
from character_cloth import smoothstep
from scipy.ndimage import gaussian_filter
from wardrobe_pieces import Wearer

SEAT_RAD = np.radians(85.0)
LIES_M = 0.010
MOST = 0.45
"""Greatest transferred share of weight."""
PATCHES_M = ((0.05, 0.025), (0.12, 0.025))
"""Halves, across and along, of the patch of the body that a place of the skirt lies on; between legs a wider one."""


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


def seated_weights(wearer: Wearer, points: np.ndarray, weights: np.ndarray, columns: int) -> np.ndarray:
    """Weights (N, J) of a skirt's grid, in rows from the waist down, that also suit a seated pose."""
    fit, suit = wearer.fit, wearer.tailoring.suit
    hip = fit.positions_t[fit.index("leftUpperLeg")]
    shins = suit.weights[:, [fit.index(f"{side}LowerLeg") for side in ("left", "right")]].sum(axis=1)
    legs = (wearer.tailoring.arm < 0.3) & (shins < 0.4)
    body = _blend(wearer, suit.points[legs], suit.weights[legs])
    ahead = points[:, 2] - hip[2]
    front, back = smoothstep(ahead, 0.0, 0.06), smoothstep(-ahead, 0.0, 0.06)
    low = 1.0 - smoothstep(points[:, 1], hip[1] - 0.16, hip[1] - 0.04)
    found = weights
    for bone, sign, side in (("hips", 1.0, front), ("shin", -1.0, back)):
        placed = _blend(wearer, points, found)
        given = points if bone == "hips" else _seated(wearer, points)[1]
        wanted = np.full(len(placed), np.nan)
        for row, place in enumerate(placed):
            off = np.abs(body[:, [0, 2]] - place[[0, 2]])
            for reach in PATCHES_M:
                near = (off < reach).all(axis=1)
                if near.any():
                    wanted[row] = sign * (sign * body[near, 1]).max() + sign * LIES_M
                    break
        fall = sign * (placed[:, 1] - wanted)
        way = sign * (placed[:, 1] - given[:, 1])
        share = (np.clip(fall / np.maximum(way, 0.05), 0.0, MOST) * side * low).reshape(-1, columns)
        for above, own in itertools.pairwise(share):
            # Before the knees nothing is below: the cloth goes on as it lay.
            own[:] = np.where(np.isnan(own), np.nan_to_num(above), own)
        share = gaussian_filter(np.nan_to_num(share), (1.0, 3.0), mode=("nearest", "wrap")).reshape(-1, 1)
        gift = np.zeros_like(found)
        if bone == "hips":
            gift[:, fit.index("hips")] = 1.0
        else:
            left = smoothstep(points[:, 0], -0.09, 0.09)
            gift[:, fit.index("leftLowerLeg")], gift[:, fit.index("rightLowerLeg")] = left, 1.0 - left
        found = found * (1.0 - share) + gift * share
    return found
