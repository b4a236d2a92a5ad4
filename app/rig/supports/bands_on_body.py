"""Legs of a strap, that is, its bands: each lies on the body as far as it touches, then goes straight to where the legs
meet.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.rig.supports.band import Shares, SurfaceStrip, band
from app.rig.supports.model import StrapLeg
from app.rig.supports.taut_string import PosedTrunk, TautString, taut_string

OVER_M = 0.0045
"""Height in metres of a band over clothes, which yield a little more than the band when the trunk bends."""
_ON_BODY, _FREE = 30, 9
"""Number of rings of a band on the body, and beyond it."""
_AROUND_M = 0.008
"""Additional height in metres of a band around the ribs where it leaves the body, in front of a belly that moves."""
_SMOOTHED = 3
_EVEN = 7
"""Number of rings over which a band is smoothed; odd."""
_MOST_JOINTS = 4
_GIVES_WAY = 1.35
"""Factor for moving a band outwards, since it lies beside the string for which the distance was found."""
_CLEAR_M = 0.007
"""Distance in metres between the body and a band that leads to a lowered instrument."""
_LEAST_DROP = 0.9
"""Least downward distance of a band on a body, relative to the forward distance."""
_MOST_ON_BODY = 0.52
"""Greatest share of a strap's leg that moves with the clothes; the rest slides over the chest."""


@dataclass(frozen=True, eq=False)
class BandRoute:
    """Course of one leg (band) of a strap over a body, in the player's frame.

    Attributes
    ----------
    start_m, via_m : (3,) float64
        Beginning and side of the course, as in `taut_string`.
    inner_start, inner_via : (3,) float64
        Directions from these two points to the edge of the band that is nearer to the head.
    half_m : callable
        Half the width at shares of the course: 0..1 on the body, 1..2 on the free part.
    thick_m : float
        Thickness.
    material : int
        Index of the material.
    around : bool
        Whether the band goes around the ribs, not over a shoulder.
    """

    start_m: FloatArray
    via_m: FloatArray
    inner_start: FloatArray
    inner_via: FloatArray
    half_m: Callable[[FloatArray], FloatArray]
    thick_m: float = 0.0028
    material: int = 0
    around: bool = False


@dataclass(frozen=True, eq=False)
class LegShape:
    """One leg (band) of a strap with the R cross-sections of its band.

    Attributes
    ----------
    leg : StrapLeg
        Its free part.
    centre_m, outwards : (R, 3) float64
        Middle of each cross-section, and unit vector away from the body.
    edges_m : (2, R, 3) float64
        Inner and outer edge of each cross-section.
    on_body : int
        Number of cross-sections that lie on the body; the others are free.
    weights : (on_body, J) float64
        Weights of the character's J joints at the cross-sections on the body.
    """

    route: BandRoute
    leg: StrapLeg
    centre_m: FloatArray
    outwards: FloatArray
    edges_m: FloatArray
    on_body: int
    weights: FloatArray

    def strips(self, bones: Mapping[int, int], top: int) -> list[SurfaceStrip]:
        """Return the surface of the band.

        Parameters
        ----------
        bones : mapping of int to int
            Bone that follows each joint of the character.
        top : int
            Index of the first of the leg's three bones.
        """
        shares: list[Shares] = [
            [(bones[int(joint)], float(row[joint])) for joint in np.flatnonzero(row)] for row in self.weights
        ]
        for t in np.linspace(0.0, 1.0, _FREE + 1)[1:]:
            shares.append([(top, (1 - t) ** 2), (top + 1, 2 * t * (1 - t)), (top + 2, t**2)])
        tangents = np.gradient(self.centre_m, axis=0)
        tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-9)
        across = np.cross(tangents, self.outwards)
        at = np.concatenate([np.linspace(0.0, 1.0, self.on_body), np.linspace(1.0, 2.0, _FREE + 1)[1:]])
        inner, outer = self.edges_m
        if ((inner - outer) * across).sum() < 0.0:
            inner, outer = outer, inner
        half = self.route.half_m(at)
        thick = np.full(len(at), self.route.thick_m)
        over = np.full(len(at), OVER_M)
        if self.route.around:
            over += _AROUND_M * np.sin(0.5 * np.pi * at)
        return band(
            self.centre_m, across, self.outwards, half, thick, shares, over, self.route.material, (inner, outer)
        )


def leg_of(trunk: PosedTrunk, route: BandRoute, meet_m: FloatArray, low_m: FloatArray) -> LegShape | None:
    """Lay a leg of a strap over a body; None if the body does not lie in its plane.

    Parameters
    ----------
    meet_m, low_m : (3,) float64
        Point where the legs meet, with the instrument played and with it lowered.
    """
    widest = float(route.half_m(np.linspace(0.0, 1.0, 9)).max())
    aim_m = _aim(route, meet_m)
    if route.around:
        # Below, a coat's hem on a lap stands off from the body.
        trunk = trunk.above(min(float(route.via_m[1]), float(meet_m[1])) - 2.0 * widest)
    strings = list[TautString]()
    for side in (0.0, 1.0, -1.0):
        aside = side * widest
        found = taut_string(
            trunk, route.start_m + aside * route.inner_start, route.via_m + aside * route.inner_via, aim_m
        )
        if found is None:
            return None
        strings.append(found)
    share = min(_leaving(strings[0], meet_m), _MOST_ON_BODY)
    parts = [_resampled(string, 0.0, share, _ON_BODY) for string in strings]
    on_body, outwards = parts[0]
    half = route.half_m(np.linspace(0.0, 1.0, _ON_BODY))[:, None] / widest
    edges = np.array([on_body + half * evened(line - on_body, _EVEN, 1) for line, _ in parts[1:]])
    weights = _smoothed(trunk.weights_at(on_body))
    joints = np.argsort(-weights[-1])[:_MOST_JOINTS]
    shares = weights[-1][joints] / weights[-1][joints].sum()
    weights[-1] = 0.0
    weights[-1][joints] = shares
    free, free_edges, free_outwards = _free_part(
        strings, share, edges[:, -1], route, None if aim_m is meet_m else meet_m
    )
    out = _unit(np.concatenate([outwards[-1:], free_outwards]).mean(axis=0))
    low_bow_m = _low_bow(trunk, route, on_body[-1], out, free, low_m)
    return LegShape(
        route,
        StrapLeg(tuple(joints.tolist()), tuple(shares.tolist()), on_body[-1], out, low_bow_m),
        np.concatenate([on_body, free]),
        np.concatenate([outwards, free_outwards]),
        np.concatenate([edges, free_edges], axis=1),
        _ON_BODY,
        weights,
    )


def _low_bow(
    trunk: PosedTrunk, route: BandRoute, top_m: FloatArray, out: FloatArray, free: FloatArray, low_m: FloatArray
) -> float:
    """Return the distance in metres by which the control point of a leg's free part moves outwards so that it lies on
    the body when the instrument is lowered.
    """
    string = taut_string(trunk, route.start_m, route.via_m, low_m)
    if string is None:
        return 0.0
    t = np.linspace(0.0, 1.0, _FREE + 1)[1:-1]
    chord = low_m - top_m
    long = float(chord @ chord)
    along = (string.points_m - top_m) @ chord / long
    over = ((string.points_m - top_m) - along[:, None] * chord) @ out
    beyond = np.argsort(along)
    needed = np.interp(t, along[beyond], over[beyond])
    usual = free[-1] - top_m
    there = (free[:-1] - top_m - t[:, None] * usual) @ out
    return max(_GIVES_WAY * float(((needed - there + _CLEAR_M) / (2.0 * t * (1.0 - t))).max()), 0.0)


def _aim(route: BandRoute, meet_m: FloatArray) -> FloatArray:
    """Return the point (3,) towards which a band is laid over the body: ``meet_m``, or below it if it lies far ahead,
    so that a band over a shoulder crosses the collar bone instead of going around the shoulders.
    """
    ahead = float(np.linalg.norm((meet_m - route.via_m)[[0, 2]]))
    least = _LEAST_DROP * ahead
    if route.around or route.via_m[1] - meet_m[1] >= least:
        return meet_m
    return np.array([meet_m[0], route.via_m[1] - least, meet_m[2]])


def _leaving(string: TautString, meet_m: FloatArray) -> float:
    """Return the share of a string's length from which it can go straight to ``meet_m`` without passing through the
    body.
    """
    at = _lengths(string.points_m)
    out = ((meet_m - string.points_m) * string.outwards).sum(axis=1)
    beyond = np.flatnonzero((out >= -1e-4) & (at > 0.2))
    return float(min(at[string.leaves], at[beyond[0]] if len(beyond) else 1.0))


def _free_part(
    strings: Sequence[TautString], share: float, edges_m: FloatArray, route: BandRoute, meet_m: FloatArray | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return middle (F, 3), edges (2, F, 3) and outward directions (F, 3) of the free part of a band, beyond ``share``
    of its strings: along these, or straight to ``meet_m`` if given.
    """
    t = np.linspace(0.0, 1.0, _FREE + 1)[1:, None]
    beyond = [_resampled(string, share, 1.0, _FREE + 1) for string in strings]
    first, outwards = beyond[0][0][0], beyond[0][1][1:]
    across = _unit(edges_m - first)
    if meet_m is not None:
        middle = first + t * (meet_m - first)
        outwards = np.repeat(beyond[0][1][:1], _FREE, axis=0)
        ways = [np.repeat(way[None], _FREE, axis=0) for way in across]
    else:
        middle = beyond[0][0][1:]
        # Where the strings meet, the direction between them is undefined: the band keeps the previous one.
        ways = [
            _unit((1.0 - t) * _unit(line[1:] - middle) + t * way)
            for (line, _), way in zip(beyond[1:], across, strict=True)
        ]
    half = route.half_m(1.0 + t[:, 0])[:, None]
    return middle, np.array([middle + half * way for way in ways]), outwards


def joined_behind(one: LegShape, other: LegShape) -> list[LegShape]:
    """Return two legs whose bands begin next to each other, joined by a common first cross-section in the middle."""
    centre = 0.5 * (one.centre_m[0] + other.centre_m[0])
    outwards = _unit(one.outwards[0] + other.outwards[0])
    edges = 0.5 * (one.edges_m[:, 0] + other.edges_m[:, 0])
    weights = 0.5 * (one.weights[0] + other.weights[0])
    return [
        replace(
            leg,
            centre_m=np.concatenate([centre[None], leg.centre_m]),
            outwards=np.concatenate([outwards[None], leg.outwards]),
            edges_m=np.concatenate([edges[:, None], leg.edges_m], axis=1),
            on_body=leg.on_body + 1,
            weights=np.concatenate([weights[None], leg.weights]),
        )
        for leg in (one, other)
    ]


def _unit(ways: FloatArray) -> FloatArray:
    found: FloatArray = ways / np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-9)
    return found


def _lengths(points: FloatArray) -> FloatArray:
    """Return at each point of a line (N, 3) the share (N,), 0..1, of the length up to it."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    found: FloatArray = way / max(float(way[-1]), 1e-9)
    return found


def evened(points: FloatArray, window: int, degree: int) -> FloatArray:
    """Smooth the points (R, 3) of a line along it by polynomials of a degree over windows of points (Savitzky-Golay).

    Equals ``scipy.signal.savgol_filter``, whose import takes longer than making all straps of a band.
    """
    powers = np.vander(np.arange(window) - window // 2, degree + 1).astype(np.float64)
    fit = powers @ np.linalg.pinv(powers)
    rows = np.arange(len(points))
    first = np.clip(rows - window // 2, 0, len(points) - window)
    windows = np.lib.stride_tricks.sliding_window_view(points, window, axis=0)[first]
    found: FloatArray = np.einsum("rw,rkw->rk", fit[rows - first], windows)
    return found


def _resampled(string: TautString, first: float, last: float, count: int) -> tuple[FloatArray, FloatArray]:
    """Return ``count`` points at even distances on a part (shares ``first`` to ``last``) of a string, and the
    directions outwards there, both (R, 3)."""
    at, asked = _lengths(string.points_m), np.linspace(first, last, count)
    points = np.stack([np.interp(asked, at, string.points_m[:, axis]) for axis in range(3)], axis=1)
    # Corners of the hull come from single triangles and are smoothed; even curves do not change.
    points[1:-1] = evened(points, _EVEN, 2)[1:-1]
    ways = _smoothed(np.stack([np.interp(asked, at, string.outwards[:, axis]) for axis in range(3)], axis=1))
    return points, _unit(ways)


def _smoothed(rows: FloatArray) -> FloatArray:
    """Return a line (N, 3) smoothed by a moving average; both ends stay."""
    padded = np.concatenate([np.repeat(rows[:1], _SMOOTHED, 0), rows, np.repeat(rows[-1:], _SMOOTHED, 0)])
    found: FloatArray = np.mean([padded[k : k + len(rows)] for k in range(2 * _SMOOTHED + 1)], axis=0)
    return found


def tapering(widths_m: Sequence[tuple[float, float]]) -> Callable[[FloatArray], FloatArray]:
    """Return a function of the share of a band's length that gives half its width in metres, going smoothly through
    pairs of (share, half width).
    """
    at, half = np.array(widths_m).T

    def half_m(shares: FloatArray) -> FloatArray:
        number = np.clip(np.searchsorted(at, shares, side="right") - 1, 0, len(at) - 2)
        t = np.clip((shares - at[number]) / (at[number + 1] - at[number]), 0.0, 1.0)
        found: FloatArray = half[number] + (half[number + 1] - half[number]) * t * t * (3.0 - 2.0 * t)
        return found

    return half_m
