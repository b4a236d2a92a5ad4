"""Weights by which skirts, and coats below their waist, lie on the thighs of a seated player.

Such a cloth hangs from the hips, some centimetres before the legs and behind them. Turned with the thighs it would
stand off them by as much. Of all mixtures of hips, thighs and shins each place gets the one that puts it onto the
thighs, or below them, in a seated pose. Between the legs cloth spans from thigh to thigh.
"""

from __future__ import annotations

import itertools

import numpy as np
from character_cloth import Cloth, smoothstep
from scipy.ndimage import gaussian_filter
from scipy.spatial import ConvexHull
from wardrobe_pieces import Wearer

SEAT_RAD = np.radians(86.0)
LIES_M = 0.010
OVER_LAP_M = 0.023
"""Distance of the front of coats and shirts from a lap: thighs of short players rise towards the knees."""
SLICE_M, ASIDE_M = 0.02, 0.025
"""Half of the slice of the body that a place of the skirt lies on, and distance beyond its sides within which cloth
still lies on it."""
KNEE_CAP_M = 0.03
"""Distance behind the foremost point of seated knees of the height at which cloth hangs before them."""
STEP = 0.02
"""Difference between neighbouring mixtures that are tried."""
ALONG, KEPT_M = 0.3, 0.01
"""Error along the thighs as a share of one across them, and the error that a wholly different mixture outweighs."""
ROUNDS = 3
BELOW_M = 0.08
"""Depth under the knees down to which cloth is laid."""
SAG_M = 0.035
"""Depth in the middle to which a short skirt sags between the legs."""
OVER_KNEES_M = 0.09
"""Length of a short skirt that hangs before the knees."""
CALF_M = 0.11
"""Distance behind the knees at which the back of a long skirt falls from the seat."""
RAISED_M = 0.02
"""Height by which sitting down raises the hem of a long skirt in front."""
BEFORE, BEHIND = 0.16, 0.20
"""Slopes by which a long skirt comes away from the knees before the shins, and behind the calves."""
DRESS_ASIDE_M = 0.004
"""`ASIDE_M` of a long dress, which goes over the thighs' sides in a curve."""
FALLS = 0.2
"""Slope of a long skirt's front beside the thighs."""
HOLLOW_M = 0.09
"""Depth of a long skirt's hollow between the shins."""
DROP = 0.06
"""Share of the hips in the hem of a short skirt, by which it hangs down at the sides."""
SHORTER = 0.78
"""Length of a short skirt under the thighs as a share of its length over them."""
BETWEEN_M = 0.09
"""Distance off the middle beyond which a coat goes with one leg alone."""

OTHER_LEG, OUTER_M = 0.2, (0.14, 0.20)
"""Share of the other leg in the sides of a coat, and distances off the middle between which it gets it."""


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


def _of_legs(wearer: Wearer, weights: np.ndarray) -> np.ndarray:
    """Weights (N, 2) of thighs, and of shins with their feet."""
    parts = (("UpperLeg",), ("LowerLeg", "Foot", "Toes"))
    rows = [[wearer.fit.index(f"{side}{bone}") for side in ("left", "right") for bone in own] for own in parts]
    return np.stack([weights[:, own].sum(axis=1) for own in rows], axis=1)


def _blend(wearer: Wearer, points: np.ndarray, legs: np.ndarray) -> np.ndarray:
    thigh, shin = _seated(wearer, points)
    return points + legs[:, :1] * (thigh - points) + legs[:, 1:] * (shin - points)


def _spanned(
    body: np.ndarray, places: np.ndarray, sign: float, falls: float | None = None, aside_m: float = ASIDE_M
) -> np.ndarray:
    """Heights (N,) of a cloth spanned over the tops (`sign` 1) or undersides (-1) of both legs at places (N, 3), before
    the knees those of the knees; NaN where there is no body, or at its sides those of cloth that `falls` with this
    slope."""
    found, foremost = np.full(len(places), np.nan), body[:, 2].max() - KNEE_CAP_M
    for row, place in enumerate(np.minimum(places, [np.inf, np.inf, foremost])):
        near = body[np.abs(body[:, 2] - place[2]) < SLICE_M]
        if len(near) < 3:
            continue
        least, most = near[:, 0].min() - aside_m, near[:, 0].max() + aside_m
        beside = max(least - place[0], place[0] - most)
        if beside >= 0.0:
            if falls is not None:
                found[row] = (near[:, 1].min() + near[:, 1].max()) / 2.0 - sign * falls * beside
            continue
        wide = np.concatenate([near[:, :2] + [aside, 0.0] for aside in (-aside_m, aside_m)])
        corners = wide[ConvexHull(wide).vertices]
        corners = np.concatenate([corners, corners[:1]])
        heights = [
            one[1] + (other[1] - one[1]) * (place[0] - one[0]) / (other[0] - one[0])
            for one, other in itertools.pairwise(corners)
            if min(one[0], other[0]) <= place[0] <= max(one[0], other[0]) and one[0] != other[0]
        ]
        found[row] = sign * max(sign * height for height in heights)
    return found


def _over_knees(wearer: Wearer, body: np.ndarray, points: np.ndarray, hem_m: float | None) -> np.ndarray:
    """Places (N, 2) in height and along the thighs at which the front of a skirt lies on the thighs, spans the gap
    between them and falls before the knees, down to a height `hem_m` if it is a long one."""
    hip = wearer.fit.positions_t[wearer.fit.index("leftUpperLeg")]
    down = np.maximum(hip[1] - points[:, 1], 0.0)
    edge = body[:, 2].max() + LIES_M
    knees_m = float(body[body[:, 2] > edge - 2.0 * KNEE_CAP_M, 1].max())
    fall = OVER_KNEES_M if hem_m is None else knees_m - hem_m
    length = down * (edge - hip[2] + fall) / down.max()
    along = np.minimum(hip[2] + length, edge)
    places = np.column_stack([points[:, :2], along])
    close = (None, ASIDE_M) if hem_m is None else (FALLS, DRESS_ASIDE_M)
    height = _spanned(body, places, 1.0, *close) + LIES_M
    knee = np.abs(wearer.fit.positions_t[wearer.fit.index("leftLowerLeg")][0])
    between = np.maximum(1.0 - (points[:, 0] / knee) ** 2, 0.0)
    height -= (SAG_M if hem_m is None else HOLLOW_M) * between * smoothstep(down, 0.15, 0.35)
    below = np.maximum(hip[2] + length - edge, 0.0)
    if hem_m is None:
        return np.column_stack([height - below, along])
    hangs = BEFORE * below - HOLLOW_M * between * smoothstep(below, 0.0, 0.5 * fall)
    return np.column_stack([height + (hem_m - height) * below / fall, along + hangs])


def _behind_knees(wearer: Wearer, body: np.ndarray, points: np.ndarray, hem_m: float) -> np.ndarray:
    """Places (N, 2) in height and along the thighs at which the back of a long skirt lies under the thighs and falls
    behind the calves to a height `hem_m`."""
    hip, knee = (wearer.fit.positions_t[wearer.fit.index(f"left{part}Leg")] for part in ("Upper", "Lower"))
    down = np.maximum(hip[1] - points[:, 1], 0.0)
    edge = hip[2] + hip[1] - knee[1] - CALF_M
    at_edge = np.abs(body[:, 2] - edge) < SLICE_M
    fall = body[at_edge, 1].min() - LIES_M - hem_m
    length = down * (edge - hip[2] + fall) / down.max()
    along = np.minimum(hip[2] + length, edge)
    height = _spanned(body, np.column_stack([points[:, :2], along]), -1.0) - LIES_M
    below = np.maximum(hip[2] + length - edge, 0.0)
    return np.column_stack([height + (hem_m - height) * below / fall, along - BEHIND * below])


def _mixtures() -> np.ndarray:
    """Shares (K, 2) of thighs and shins that are tried."""
    steps = np.arange(0.0, 1.0 + STEP / 2, STEP)
    pairs = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    return pairs[pairs.sum(axis=1) <= 1.0 + 1e-9]


def _laid(wearer: Wearer, points: np.ndarray, legs: np.ndarray, wanted: np.ndarray, along: float = ALONG) -> np.ndarray:
    """Mixtures (N, 2) whose places in a seated pose are nearest to the wanted ones (N, 2) in height and
    along the thighs."""
    thigh, shin = _seated(wearer, points)
    tried, found = _mixtures(), legs.copy()
    for row in np.flatnonzero(~np.isnan(wanted).any(axis=1)):
        place = points[row] + tried @ np.stack([thigh[row] - points[row], shin[row] - points[row]])
        off = (place[:, 1:] - wanted[row]) * [1.0, along]
        change = KEPT_M * (tried - legs[row])
        found[row] = tried[np.argmin((off**2).sum(axis=1) + (change**2).sum(axis=1))]
    return found


def _smoothed(shares: np.ndarray, columns: int) -> np.ndarray:
    """Shares (N, 2) of a grid whose last column lies on the first one, smoothed across pleats."""
    grid = shares.reshape(-1, columns, shares.shape[1])[:, :-1]
    soft = gaussian_filter(grid, (1.0, 3.0, 0.0), mode=("nearest", "wrap", "nearest"))
    return np.concatenate([soft, soft[:, :1]], axis=1).reshape(shares.shape)


def seated_weights(
    wearer: Wearer, points: np.ndarray, weights: np.ndarray, columns: int, left: np.ndarray
) -> np.ndarray:
    """Weights (N, J) of a cloth's grid about both legs, in rows from the waist down, that also suit a seated pose;
    `left` (N,) is the left leg's share."""
    fit, suit = wearer.fit, wearer.tailoring.suit
    hip, knee = (fit.positions_t[fit.index(f"left{part}Leg")] for part in ("Upper", "Lower"))
    own = _of_legs(wearer, suit.weights)
    body = _blend(wearer, suit.points, own)
    high = suit.points[:, 1] > knee[1] - BELOW_M
    legs, seat = high & (own.sum(axis=1) > 0.5), high & (wearer.tailoring.arm < 0.3) & (own[:, 1] < 0.4)
    ahead = points[:, 2] - hip[2]
    low = 1.0 - smoothstep(points[:, 1], hip[1] - 0.12, hip[1] - 0.02)
    before = _of_legs(wearer, weights)
    along = _blend(wearer, points, before)[:, 2]
    short = points[:, 1].min() > knee[1] - BELOW_M
    hem_m = None if short else float(_seated(wearer, points)[1][:, 1].min())
    front_m = None if hem_m is None else hem_m + RAISED_M
    if short:
        before = before * (1.0 - DROP * smoothstep(hip[1] - points[:, 1], 0.08, 0.35))[:, None]
        along = hip[2] + SHORTER * (along - hip[2])
    # Towards the sides cloth goes from above the thighs to below them.
    share = (low * smoothstep(np.abs(ahead), 0.0, 0.06))[:, None]
    found, behind = before, ahead < 0.0
    for _ in range(ROUNDS):
        wanted = _over_knees(wearer, body[legs], points, front_m)
        if hem_m is None:
            height = _spanned(body[seat], _blend(wearer, points[behind], found[behind]), -1.0) - LIES_M
            wanted[behind] = np.stack([height, along[behind]], axis=1)
        else:
            wanted[behind] = _behind_knees(wearer, body[seat], points[behind], hem_m)
        laid = _laid(wearer, points, before, wanted, ALONG if short else 1.0)
        found = before + share * (_smoothed(laid, columns) - before)
    return _with_legs(wearer, weights, found, left)


def on_lap(
    wearer: Wearer, below: Cloth, points: np.ndarray, weights: np.ndarray, columns: int, lies_m: float = OVER_LAP_M
) -> np.ndarray:
    """Weights (N, J) of the grid of a coat below its waist, the front of which lies `lies_m` over the lap of a seated
    player in the trousers or skirt `below` it: it bends forwards where it meets them."""
    fit = wearer.fit
    before, own = _of_legs(wearer, weights), _of_legs(wearer, below.weights)
    body = _blend(wearer, below.points, own)[own.sum(axis=1) > 0.5]
    ahead = points[:, 2] - fit.positions_t[fit.index("leftUpperLeg")][2]
    lap = _spanned(body, points, 1.0) + lies_m
    under = np.nan_to_num(np.maximum(lap - points[:, 1], 0.0))
    lies = points + under[:, None] * [0.0, 0.0, 1.0]
    wanted = np.stack([_spanned(body, lies, 1.0) + lies_m, lies[:, 2]], axis=1)
    wanted[(under == 0.0) | (ahead < 0.0)] = np.nan
    share = smoothstep(ahead, 0.0, 0.06)[:, None]
    found = before + share * (_smoothed(_laid(wearer, points, before, wanted), columns) - before)
    left = smoothstep(points[:, 0], -BETWEEN_M, BETWEEN_M)
    # Knees that are turned outwards would take the sides of the coat off the thighs.
    other = OTHER_LEG * smoothstep(np.abs(points[:, 0]), *OUTER_M)
    return _with_legs(wearer, weights, found, left + (1.0 - 2.0 * left) * other)


def _with_legs(wearer: Wearer, weights: np.ndarray, legs: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Weights (N, J) with other shares (N, 2) of thighs and shins, `left` (N,) of them the left leg's; all others have
    the rest in the proportions that they had."""
    fit, moved, others = wearer.fit, weights.copy(), np.ones(weights.shape[1], dtype=bool)
    for column, part in enumerate(("Upper", "Lower")):
        for side, share in (("left", left), ("right", 1.0 - left)):
            moved[:, fit.index(f"{side}{part}Leg")] = share * legs[:, column]
            others[fit.index(f"{side}{part}Leg")] = False
    rest = moved[:, others].sum(axis=1)
    moved[:, fit.index("hips")] += rest < 1e-6
    moved[:, others] *= ((1.0 - legs.sum(axis=1)) / np.where(rest < 1e-6, 1.0, rest))[:, None]
    return moved
