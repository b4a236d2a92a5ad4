"""Parts that large brass instruments share: mouthpiece, swept branches, bell, piston and rotary valves, stays.

A `Frame` is a plane an instrument is drawn in; what is built from it is in the root frame.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from resources.build.instrument_mesh import (
    Array,
    Model,
    Shape,
    half_circle,
    joined,
    lengths,
    plate,
    solid,
    square_to,
    tube,
    turned,
    unit,
)

X, Y, Z = np.eye(3)
BRASS, NICKEL, SILVER = "lacquered_brass", "nickel_silver", "silver"


def contact(
    part: str, node: str, point: Array, normal: Array, control: str | None = None, grip: str = "firm"
) -> dict[str, object]:
    """A touch of a hand, in the root frame."""
    return {"part": part, "node": node, "point": point, "normal": normal, "control": control, "grip": grip}


def on_round(centre: Array, radius: float, normal: Array) -> tuple[Array, Array]:
    """The point of a round part that faces along a normal, and the normal with length 1."""
    way = unit(normal)
    return centre + radius * way, way


def direction(pitch_down_deg: float, yaw_left_deg: float) -> Array:
    """Return the unit vector, in the player's frame, of a direction given by pitch (down) and yaw (to the left)."""
    pitch, yaw = np.radians(pitch_down_deg), np.radians(yaw_left_deg)
    return np.array([np.sin(yaw) * np.cos(pitch), -np.sin(pitch), np.cos(yaw) * np.cos(pitch)])


def root_from_player(pitch_down_deg: float, yaw_left_deg: float) -> Array:
    """Matrix that turns directions of the player's frame into the model's, for its usual carriage without roll."""
    pitch, yaw = np.radians(pitch_down_deg), np.radians(yaw_left_deg)
    about_y = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
    return (about_y @ about_x).T


@dataclass(frozen=True)
class Frame:
    """Three orthogonal axes (rows) and where they meet."""

    origin: Array
    axes: Array

    def at(self, *places: Sequence[float]) -> Array:
        """Points given by their places along the axes: one (3,) for one place, else (n, 3)."""
        points: Array = self.origin + np.array(places, float) @ self.axes
        return points[0] if len(places) == 1 else points

    def way(self, p: float, q: float, r: float) -> Array:
        """A direction."""
        return unit(np.array([p, q, r]) @ self.axes)

    def place(self, point: ArrayLike) -> Array:
        """Places along the axes of a point of the root frame."""
        return np.asarray((np.asarray(point) - self.origin) @ self.axes.T)


def arc(
    frame: Frame, centre: Sequence[float], radius: float, start_deg: float, end_deg: float, step_m: float = 0.010
) -> Array:
    """Part of a circle about the third axis: 0 degrees lies against the second axis, 90 along the first."""
    count = max(4, int(np.ceil(abs(np.radians(end_deg - start_deg)) * radius / step_m)))
    share = np.linspace(0, 1, count + 1)
    angle = np.radians(start_deg + share * (end_deg - start_deg))
    p, q, r = centre
    places = np.column_stack([p + radius * np.sin(angle), q - radius * np.cos(angle), np.full_like(angle, r)])
    return np.asarray(frame.origin + places @ frame.axes)


def tapered(line: Array, knots: Sequence[tuple[float, float]]) -> Array:
    """Radii along a line from (share of its length, radius)."""
    along = lengths(line)
    return np.interp(along / along[-1], [share for share, _ in knots], [radius for _, radius in knots])


def inside_out(shape: Shape) -> Shape:
    """A tube's surface seen from within, without collision bodies."""
    return Shape(shape.points, -shape.normals, shape.uvs, shape.faces[:, ::-1], ())


def mouthpiece(model: Model, rim_r: float, outer_r: float, length: float, cup: float, shank_r: float) -> None:
    """A cup (``cup``: its depth) or a funnel on the air axis, its rim in the plane of the root's origin."""
    throat = 0.30 * rim_r
    land = outer_r - rim_r
    profile = [
        (0.90 * cup, throat), (0.62 * cup, 0.62 * rim_r), (0.30 * cup, 0.80 * rim_r), (0.10 * cup, 0.88 * rim_r),
        (0.0012, 0.93 * rim_r), (0.0003, 0.965 * rim_r), (0.0, rim_r), (0.0004, rim_r + 0.45 * land),
        (0.0015, rim_r + 0.86 * land), (0.0034, outer_r), (0.0085, outer_r), (0.0105, 0.965 * outer_r),
        (0.014, 0.90 * outer_r), (0.40 * cup + 0.010, 0.86 * outer_r), (0.75 * cup + 0.010, 0.68 * outer_r),
        (cup + 0.012, 0.45 * outer_r), (cup + 0.020, 1.05 * shank_r), (length, shank_r), (length, 0.0),
    ]  # fmt: skip
    model.add(SILVER, turned((0, 0, 0), Z, profile, sides=48, hard_deg=50))


def receiver(model: Model, start: ArrayLike, axis: ArrayLike, radius: float, length: float) -> None:
    """The socket a mouthpiece sits in."""
    r = radius
    model.add(
        NICKEL,
        solid(
            start, axis, [(0, 1.12 * r), (0.002, 1.2 * r), (0.005, 1.2 * r), (0.006, 1.06 * r), (length, r)], sides=24
        ),
    )


def ferrule(model: Model, centre: ArrayLike, axis: ArrayLike, radius: float, length: float) -> None:
    """A beaded sleeve over a joint of tubes; ``radius`` is theirs, and their bodies stand for it."""
    half, r, bead = length / 2, radius + 0.0009, min(0.002, length / 5)
    profile = [
        (-half, r + 0.0006), (bead - half, r + 0.0006), (bead - half, r), (half - bead, r), (half - bead, r + 0.0006),
        (half, r + 0.0006),
    ]  # fmt: skip
    model.add(NICKEL, solid(centre, axis, profile, sides=20, proxy=False))


def branch(model: Model, line: Array, radii: ArrayLike, sides: int = 16) -> None:
    """A tube that no hand comes near: a few capsules stand for it."""
    model.add(BRASS, tube(line, radii, sides=sides, tolerance_m=COARSE_M))


COARSE_M = 0.0030


def stay(start: ArrayLike, end: ArrayLike, thick: float = 0.0028) -> Shape:
    """A turned stay between two tubes, with a flange at either end."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    t = thick
    profile = [
        (-0.002, 1.65 * t), (0.0015, 1.6 * t), (0.0030, t), (length - 0.0030, t), (length - 0.0015, 1.6 * t),
        (length + 0.002, 1.65 * t),
    ]  # fmt: skip
    reach = 0.0015 * (b - a) / length
    body = {"shape": "cylinder", "a_m": a - reach, "b_m": b + reach, "radius_m": 1.25 * t}
    return replace(solid(a, b - a, profile, sides=14, proxy=False), proxies=(body,))


def brace(start: ArrayLike, end: ArrayLike, thick: float = 0.0022) -> Shape:
    """A turned stay between two tubes, with a flange at either end and a bead in the middle."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    t, m = thick, length / 2
    profile = [
        (-0.001, 2.3 * t), (0.0012, 2.2 * t), (0.0022, 1.15 * t), (0.0035, t), (m - 2 * t, t), (m - t, 1.5 * t),
        (m, 1.7 * t), (m + t, 1.5 * t), (m + 2 * t, t), (length - 0.0035, t), (length - 0.0022, 1.15 * t),
        (length - 0.0012, 2.2 * t), (length + 0.001, 2.3 * t),
    ]  # fmt: skip
    return solid(a, b - a, profile, sides=18)


def loop(
    model: Model,
    start: ArrayLike,
    end: ArrayLike,
    out: ArrayLike,
    length: float,
    radius: float,
    drawn: float = 0.45,
    tolerance_m: float = 0.0022,
) -> None:
    """A valve slide: two legs side by side, their sleeves, and the bow that is drawn."""
    a, b, way = np.asarray(start, float), np.asarray(end, float), unit(out)
    foot = length - float(np.linalg.norm(b - a)) / 2
    line = joined(a, half_circle(a + foot * way, b + foot * way, way, 10), b)
    model.add(BRASS, tube(line, radius + 0.0003, sides=16, tolerance_m=tolerance_m))
    for foot in (a, b):
        sleeve = [(0, radius + 0.0009), (drawn * length, radius + 0.0009)]
        model.add(NICKEL, solid(foot, way, sleeve, sides=16, proxy=False))
        ferrule(model, foot + drawn * length * way, way, radius, 0.006)


@dataclass(frozen=True)
class Bell:
    """A Bessel horn: outer radius ``rim_r (s / (s + x))**flare`` at the distance x from its rim."""

    rim_r: float
    scale_m: float
    flare: float

    def radius(self, distance: ArrayLike) -> Array:
        return np.asarray(self.rim_r * (self.scale_m / (self.scale_m + np.asarray(distance, float))) ** self.flare)


def bell(
    model: Model,
    shape: Bell,
    centre: ArrayLike,
    out: ArrayLike,
    before: Array,
    start_r: float,
    *,
    open_m: float = 0.0,
    rings: int = 26,
    sides: int = 56,
) -> None:
    """The last branch of an instrument and its bell.

    Parameters
    ----------
    centre, out : the middle of its rim and the way it opens
    before : the bent part of the branch, up to where the straight bell begins; ``start_r`` is its first radius
    open_m : a hand may reach so far into it: that part is walls, not a solid body
    """
    middle, way = np.asarray(centre, float), unit(out)
    straight = float(np.linalg.norm(middle - before[-1])) - 0.004
    distance = np.geomspace(0.0006, straight, rings)[::-1]
    stem = middle - distance[:, None] * way
    line = joined(before, stem)
    tail = len(line) - len(stem)
    along = lengths(line)
    radii = shape.radius(distance)
    share = (along[:tail] / along[tail]) ** 1.6
    radii = np.r_[start_r + share * (radii[0] - start_r), radii]
    solid = tail + int(np.searchsorted(-distance, -open_m)) if open_m else len(line) - 1
    outside = radii + np.r_[np.zeros(tail), WALL_M * _share_within(distance, open_m)] if open_m else radii
    model.add(BRASS, tube(line, outside, sides=sides, closed=False, proxy=not open_m))
    rim_bead = 0.0016
    angles = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    across, over = square_to(way)
    if open_m:
        bodies = tube(line[: solid + 1], radii[: solid + 1], sides=6, closed=False, tolerance_m=0.0017).proxies
        walls = _walls(shape, middle, way, across, over, float(distance[solid - tail]))
        model.add(BRASS, replace(_empty(), proxies=(*bodies, *walls)))
    ring = middle + (shape.rim_r - 0.0008) * (np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * over)
    model.add(BRASS, tube(np.vstack([ring, ring[:1]]), rim_bead, sides=8, closed=False, side=way, proxy=False))
    deep = np.geomspace(0.0006, max(0.8 * straight, open_m + 0.03), rings)[::-1]
    inner = tube(middle - deep[:, None] * way, shape.radius(deep) - 0.0007, sides=sides, closed=False, proxy=False)
    model.add("inner_brass", inside_out(inner))


WALLS, WALL_SAG_M, RIM_M = 19, 0.0010, 0.02
WALL_M = 0.00235
"""Greatest thickness of the metal around a hand: a little more than skin yields there, so that none shows outside."""


def _share_within(distance: Array, open_m: float) -> Array:
    """Return how much thicker the wall of an open bell is at distances from its rim, 0 to 1: 0 at the rim and where the
    hand ends, 1 in the middle.
    """
    share = np.clip(np.minimum(distance / 0.06, (open_m + 0.02 - distance) / 0.05), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _empty() -> Shape:
    return Shape(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 2)), np.zeros((0, 3), np.int64))


def _walls(shape: Bell, middle: Array, way: Array, across: Array, over: Array, deep: float) -> list[dict[str, object]]:
    """Flat pieces that stand for the skin of an open bell: a little thicker than it, to the outside."""
    edges = [0.0]
    while edges[-1] < deep - 1e-6:
        edges.append(min(_next_edge(shape, edges[-1]), deep))
    found: list[dict[str, object]] = []
    for near, far in itertools.pairwise(edges):
        a, b = np.array([near, shape.radius(near)]), np.array([far, shape.radius(far)])
        slope = (b - a) / np.linalg.norm(b - a)
        centre = (a + b) / 2
        for k in range(WALLS):
            angle = 2 * np.pi * (k + 0.5) / WALLS
            radial = np.cos(angle) * across + np.sin(angle) * over
            sideways = -np.sin(angle) * across + np.cos(angle) * over
            along = -slope[0] * way + slope[1] * radial
            outward = slope[0] * radial + slope[1] * way
            thick = 0.0008
            place = middle - centre[0] * way + centre[1] * radial + (thick - 0.0014) * outward
            half = np.array([max(a[1], b[1]) * np.tan(np.pi / WALLS), np.linalg.norm(b - a) / 2, thick])
            found.append({"shape": "box", "centre_m": place, "half_m": half, "x_axis": sideways, "y_axis": along})
    return found


def _next_edge(shape: Bell, start: float) -> float:
    """Return the place along the bell (m) up to which one straight piece is close enough to the profile."""
    end = start
    while end < start + 0.12:
        end += 0.001
        along = np.linspace(start, end, 12)
        profile = np.column_stack([along, shape.radius(along)])
        chord = unit(profile[-1] - profile[0])
        off = (profile - profile[0]) @ np.array([-chord[1], chord[0]])
        if np.abs(off).max() > (WALL_SAG_M if start > RIM_M else 2.2 * WALL_SAG_M):
            break
    return end


@dataclass(frozen=True)
class Piston:
    """Sizes of a piston valve: metres along its axis from the level of the upper knuckles."""

    casing_r: float = 0.0125
    top: float = 0.030
    bottom: float = -0.105
    button: float = 0.078
    button_r: float = 0.0100

    def build(self, model: Model, node: str, foot: Array, up: Array) -> None:
        """The casing in the root, piston, stem and finger button in ``node``."""
        r, top, low, high = self.casing_r, self.top, self.bottom, self.button
        casing = [(low, r), (top - 0.004, r)]
        model.add(NICKEL, solid(foot, up, casing, sides=32))
        cap = [(top - 0.010, 1.09 * r), (top - 0.001, 1.13 * r), (top, 1.06 * r), (top + 0.005, 0.5 * r)]
        model.add(SILVER, solid(foot, up, cap, sides=32))
        under = [(low - 0.010, 0.4 * r), (low - 0.006, 1.02 * r), (low - 0.003, 1.12 * r), (low + 0.008, 1.12 * r)]
        model.add(SILVER, solid(foot, up, under, sides=32))
        felt = [(top + 0.004, 0.62 * r), (top + 0.0075, 0.62 * r)]
        model.add("felt", solid(foot, up, felt, sides=24))
        model.add(SILVER, solid(foot, up, [(top - 0.01, 0.0034), (high - 0.004, 0.0034)], sides=16), node=node)
        b = self.button_r
        button = [
            (high - 0.0088, 0.0042), (high - 0.0070, 0.85 * b), (high - 0.0058, b), (high - 0.0016, b),
            (high - 0.0004, 0.93 * b),
        ]  # fmt: skip
        model.add(SILVER, solid(foot, up, button, sides=32), node=node)
        pearl = [(high - 0.001, 0.88 * b), (high - 0.0002, 0.84 * b), (high, 0.6 * b)]
        model.add("pearl", solid(foot, up, pearl, sides=32), node=node)


def rotor(model: Model, node: str, foot: Array, axis: Array, arm: Array, radius: float, length: float) -> None:
    """A rotary valve: its casing in the root; the stop arm on top, which turns with the rotor, in ``node``."""
    r = radius
    casing = [
        (0, 0), (0, r), (0.003, 1.08 * r), (0.006, 1.08 * r), (0.007, r), (length - 0.007, r),
        (length - 0.006, 1.08 * r), (length - 0.002, 1.08 * r), (length, 0.9 * r), (length + 0.001, 0),
    ]  # fmt: skip
    body = {"shape": "cylinder", "a_m": foot, "b_m": foot + (length + 0.001) * axis, "radius_m": 1.06 * r}
    model.add(NICKEL, replace(turned(foot, axis, casing, sides=32, proxy=False), proxies=(body,)))
    top = foot + (length + 0.001) * axis
    model.add(
        SILVER,
        solid(top - 0.002 * axis, axis, [(0, 0.0036), (0.008, 0.0036), (0.009, 0.0025)], sides=18, proxy=False),
        node=node,
    )
    bar = tube(
        [top + 0.003 * axis - 0.3 * r * arm, top + 0.003 * axis + 0.95 * r * arm],
        0.0022,
        sides=12,
        flat=(1.0, 1.5),
        side=axis,
    )
    model.add(SILVER, bar, node=node)
    model.add(
        SILVER,
        solid(top + 0.001 * axis + 0.85 * r * arm, axis, [(0, 0.003), (0.008, 0.003)], sides=14, proxy=False),
        node=node,
    )


def paddle(model: Model, node: str, pad: Array, up: Array, along: Array, half: tuple[float, float]) -> None:
    """A finger plate whose upper side lies in ``pad``: a slab with rounded ends along ``along``."""
    width, length = half
    thick = 0.0016
    model.add(SILVER, plate(pad - thick * up, (length, thick, width), along, up), node=node)
    side = np.cross(along, up)
    for end in (-1, 1):
        edge = pad - thick * up + end * length * along
        model.add(SILVER, tube([edge - width * side, edge + width * side], thick, sides=10, proxy=False), node=node)


def strap(line: Array, half_width: float, across: Array) -> Shape:
    """A bent band, thin along its bend, with a flat body for each piece."""
    thick = 0.0011
    skin = tube(
        line,
        thick,
        flat=(1.0, half_width / thick),
        side=np.cross(unit(line[1] - line[0]), across),
        sides=16,
        proxy=False,
    )
    bodies = []
    for a, b in zip(line[:-1:2], line[2::2], strict=False):
        along = unit(b - a)
        bodies.append(
            {
                "shape": "box",
                "centre_m": (a + b) / 2,
                "x_axis": along,
                "y_axis": across,
                "half_m": np.array([np.linalg.norm(b - a) / 2, half_width, thick]),
            }
        )
    return replace(skin, proxies=tuple(bodies))
