"""Mouthpieces of woodwinds and their carriers: beak, reeds, ligature, thumb rest.

Everything is in the frame of the mouthpiece: the origin in the middle of what is between the lips where they close
around it, +Z the air, -Y the side of the (single) reed, +X the player's left; metres. The tip lies at negative Z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from resources.build.instrument_keys import METAL, Pieces, Touch, Wall
from resources.build.instrument_mesh import Array, Shape, plate, solid, tube, turned, unit

X, Y, Z = np.eye(3)


def creased(
    points: ArrayLike, faces: ArrayLike, hard_deg: float = 32.0, proxies: Sequence[dict[str, object]] = ()
) -> Shape:
    """A shape of a bare mesh: smooth normals, but edges sharper than ``hard_deg`` stay edges."""
    places, corners = np.asarray(points, float), np.asarray(faces, np.int64)
    sides = np.cross(places[corners[:, 1]] - places[corners[:, 0]], places[corners[:, 2]] - places[corners[:, 0]])
    area = np.linalg.norm(sides, axis=1)
    corners, sides, area = corners[area > 1e-13], sides[area > 1e-13], area[area > 1e-13]
    flat = sides / area[:, None]
    _, same = np.unique(np.round(places, 7), axis=0, return_inverse=True)
    meeting: dict[int, list[int]] = {}
    for face, row in enumerate(same.reshape(-1)[corners]):
        for corner in row:
            meeting.setdefault(int(corner), []).append(face)
    hard = np.cos(np.radians(hard_deg))
    found: dict[tuple[int, tuple[float, ...]], int] = {}
    out_points, out_normals, out_faces = [], [], []
    for face, row in enumerate(corners):
        indices = []
        for corner in row:
            around = meeting[int(same.reshape(-1)[corner])]
            near = [other for other in around if flat[other] @ flat[face] > hard]
            normal = unit(sides[near].sum(axis=0))
            key = (int(same.reshape(-1)[corner]), tuple(np.round(normal, 3)))
            if key not in found:
                found[key] = len(out_points)
                out_points.append(places[corner])
                out_normals.append(normal)
            indices.append(found[key])
        out_faces.append(indices)
    vertices = np.array(out_points)
    span = np.maximum(np.ptp(vertices, axis=0), 1e-9)
    uvs = ((vertices - vertices.min(axis=0)) / span)[:, [0, 2]]
    return Shape(vertices, np.array(out_normals), uvs, np.array(out_faces, np.int64), tuple(proxies))


def loft(
    rings: Sequence[Array], *, hard_deg: float = 32.0, proxies: Sequence[dict[str, object]] = (), caps: bool = True
) -> Shape:
    """A skin over closed outlines of the same number of points, one after the other; ends closed by fans.

    Seen against the direction they follow one another, the points of a ring run counterclockwise.
    """
    count = len(rings[0])
    points = list(np.vstack(rings))
    faces = []
    for layer in range(len(rings) - 1):
        for k in range(count):
            a, b = layer * count + k, layer * count + (k + 1) % count
            faces += [(a, b, b + count), (a, b + count, a + count)]
    for ring, turn in ((0, -1), (len(rings) - 1, 1)) if caps else ():
        middle = len(points)
        points.append(rings[ring].mean(axis=0))
        for k in range(count):
            edge = (ring * count + k, ring * count + (k + 1) % count)
            faces.append((middle, *edge[::turn]))
    return creased(np.array(points), np.array(faces), hard_deg, proxies)


@dataclass(frozen=True)
class SingleReed:
    """Sizes of a mouthpiece with a beak, in metres; those of a B flat clarinet.

    Attributes
    ----------
    tip_m : how far the tip is in the mouth
    length : from the tip to the end
    radius : of the body under the ligature
    end_radius : of the body at its end, before the barrel
    beak_length : how far from the tip the beak's slope reaches
    tip_width : of the tip
    table : how far the reed's table lies from the bore's axis
    tip_thick : of the beak at the tip
    bite : height of the beak over the table 12 mm from the tip
    reed_length, reed_width, reed_thick : of the reed, the thickness at its butt
    ligature : where the ligature begins and ends, from the tip
    """

    tip_m: float = 0.012
    length: float = 0.074
    radius: float = 0.0136
    end_radius: float = 0.0128
    beak_length: float = 0.033
    tip_width: float = 0.0130
    table: float = 0.0088
    tip_thick: float = 0.0012
    bite: float = 0.0078
    reed_length: float = 0.0675
    reed_width: float = 0.0130
    reed_thick: float = 0.0030
    ligature: tuple[float, float] = (0.037, 0.060)
    body: str = "ebonite"
    metal: str = METAL

    @property
    def reed_bite(self) -> float:
        """Thickness of the reed between the lips."""
        return float(self._reed_at(self.tip_m))

    @property
    def lips_apart_m(self) -> float:
        """Height of beak and reed where the lips close."""
        return self.bite + self.reed_bite

    @property
    def axis_y(self) -> float:
        """Height of the bore's axis over the origin."""
        return self.table - self.bite + self.lips_apart_m / 2

    @property
    def end_z(self) -> float:
        """Return the z at which the mouthpiece ends and the barrel or neck begins, m."""
        return self.length - self.tip_m

    def _reed_at(self, from_tip: ArrayLike) -> Array:
        vamp = 0.52 * self.reed_length
        share = np.clip(np.asarray(from_tip, float) / vamp, 0, 1)
        return np.asarray(0.00012 + (self.reed_thick - 0.00012) * share**1.25)

    def _half_width(self, from_tip: float) -> float:
        share = float(np.clip(from_tip / self.beak_length, 0, 1))
        return self.tip_width / 2 + (self.radius - self.tip_width / 2) * share**1.25

    def pieces(self) -> Pieces:
        """Beak, reed and ligature."""
        reed = self._reed()
        proxies = self._proxies()
        beak = self._beak(proxies)
        return [(self.body, beak), ("cane", reed), *self._ligature()]

    def _outline(self, from_tip: float, radius: float, half: float, low: float, high: float) -> Array:
        """A round section cut off by the table below and the beak's slope above; ``half`` wide where it is widest."""
        widest = np.clip(0.0, low, high) / radius
        half = half / float(np.sqrt(1 - widest**2))
        t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        x, y = half * np.cos(t), np.clip(radius * np.sin(t), low, high)
        z = np.full_like(x, from_tip - self.tip_m)
        return np.column_stack([x, y + self.axis_y, z])

    def _beak(self, proxies: list[dict[str, object]]) -> Shape:
        rings = []
        slope = (self.bite - self.tip_thick) / self.tip_m
        top_from = np.linspace(0, self.beak_length, 12)
        window = self.ligature[1] + 0.004
        for place in [*top_from, self.beak_length + 0.004, self.ligature[0], window, window + 0.0005, self.length]:
            share = np.clip((place - self.beak_length) / (self.length - self.beak_length), 0, 1)
            radius = self.radius + share * (self.end_radius - self.radius)
            half = self._half_width(place) if place <= self.beak_length else radius
            high = -self.table + self.tip_thick + slope * place + 0.12 * slope * max(0.0, place - self.tip_m)
            if place > self.beak_length:
                high = radius
            low = -self.table if place <= window else -radius
            rings.append(self._outline(place, radius, half, low, min(high, radius)))
        return loft(rings, proxies=proxies)

    def _proxies(self) -> list[dict[str, object]]:
        start, end = self.beak_length - self.tip_m, self.length - self.tip_m
        axis = np.array([0, self.axis_y, 0])
        body = {"shape": "cylinder", "a_m": axis + start * Z, "b_m": axis + end * Z, "radius_m": self.radius}
        tilt = unit((0, (self.bite - self.tip_thick) / self.tip_m / 2, 1))
        up = np.cross(tilt, X)
        half = np.array([self.tip_width / 2, self.lips_apart_m * 0.42, (start + self.tip_m) / 2])
        centre = np.array([0, self.lips_apart_m * 0.12, (start - self.tip_m) / 2])
        beak = {"shape": "box", "centre_m": centre, "half_m": half, "x_axis": X, "y_axis": up}
        return [body, beak]

    def _reed(self) -> Shape:
        rings = []
        low = self.axis_y - self.table
        for place in [0, *np.linspace(0.002, 0.52 * self.reed_length, 10), 0.54 * self.reed_length, self.reed_length]:
            thick = float(self._reed_at(place))
            half = self.reed_width / 2 * (1 - 0.10 * place / self.reed_length)
            bark = thick - 0.0009 * np.clip(thick / self.reed_thick, 0, 1)
            x = np.array([-1, -0.6, 0.6, 1, 1, 0.8, 0.45, 0, -0.45, -0.8, -1]) * half
            belly = 1 - (x / half) ** 2
            y = np.where(np.arange(11) < 4, 0.0, -(bark + (thick - bark) * belly))
            z = np.full(11, place - self.tip_m + 0.0004)
            rings.append(np.column_stack([x, y + low, z])[::-1])
        return loft(rings)

    def _ligature(self) -> Pieces:
        start, end = (place - self.tip_m for place in self.ligature)
        t = np.linspace(0, 2 * np.pi, 44, endpoint=False)
        r = self.radius + 0.0002
        half, belly = self.reed_width / 2 * 0.95, self.table + self.reed_thick
        rings = []
        for z, wide in ((start, 0.0), (start, 0.0007), (end, 0.0007), (end, 0.0)):
            x, y = (r + wide) * np.cos(t), (r + wide) * np.sin(t)
            over = np.abs(x) < half + 0.001
            bump = belly + wide - 0.0006 * (x / half) ** 2
            y = np.where((y < 0) & over, np.minimum(y, -bump), y)
            rings.append(np.column_stack([x, y + self.axis_y, np.full_like(x, z)]))
        found: Pieces = [(self.metal, loft(rings, caps=False))]
        lugs_y = self.axis_y - belly - 0.0022
        for z in (start + 0.2 * (end - start), end - 0.2 * (end - start)):
            for x in (-0.0038, 0.0024):
                found.append((self.metal, tube([(x, lugs_y, z - 0.0022), (x, lugs_y, z + 0.0022)], 0.0024, sides=10,
                                               proxy=False)))  # fmt: skip
            screw = [(0, 0.0012), (0.014, 0.0012), (0.014, 0.0034), (0.020, 0.0032)]
            found.append((self.metal, solid((0.0060, lugs_y, z), -X, screw, sides=12, proxy=False)))
        return found


@dataclass(frozen=True)
class DoubleReed:
    """Sizes of a double reed, in metres; those of an oboe.

    ``tip_m`` is how far the tip is in the mouth, ``blade`` the length of the cane, ``width`` of the tip, ``gap`` of
    the tip's opening, ``throat`` the radius where the thread begins, ``thread`` its length, ``staple`` the length of
    the tube below and ``staple_radius`` (with its cork) its radius.
    """

    tip_m: float = 0.006
    blade: float = 0.024
    width: float = 0.0072
    gap: float = 0.0016
    throat: float = 0.0031
    thread: float = 0.013
    staple: float = 0.027
    staple_radius: float = 0.0036
    thread_material: str = "leather"
    staple_material: str = "cork"

    def _half(self, from_tip: float) -> tuple[float, float]:
        share = float(np.clip(from_tip / self.blade, 0, 1))
        wide = self.width / 2 + (self.throat - self.width / 2) * share**1.1
        tall = self.gap / 2 + (self.throat - self.gap / 2) * np.sin(share * np.pi / 2)
        return wide, float(tall)

    @property
    def lips_apart_m(self) -> float:
        """Height of the reed where the lips close."""
        return 2 * self._half(self.tip_m)[1]

    @property
    def end_z(self) -> float:
        """Return the z at which the reed's staple goes into the instrument or onto the bocal, m."""
        return self.blade + self.thread + self.staple - self.tip_m

    def pieces(self) -> Pieces:
        """Cane, thread and staple."""
        t = np.linspace(0, 2 * np.pi, 28, endpoint=False)
        rings = []
        for place in np.linspace(0, self.blade, 9):
            wide, tall = self._half(float(place))
            z = np.full_like(t, place - self.tip_m)
            rings.append(np.column_stack([wide * np.cos(t), tall * np.sin(t), z]))
        start, thread = self.blade - self.tip_m, self.thread
        wide = self.throat + 0.0005
        reed = {"shape": "cylinder", "a_m": -self.tip_m * Z, "b_m": start * Z, "radius_m": self.throat}
        wound = [(0, 0), (0, self.throat), (0.0006, wide)]
        for turn in np.arange(0.0010, thread - 0.0008, 0.0008):
            wound += [(float(turn), wide - 0.0001), (float(turn) + 0.0004, wide)]
        wound += [(thread, self.throat), (thread, 0)]
        r = self.staple_radius
        below = [(0, r * 0.8), (0.002, r * 0.85), (0.003, r), (self.staple, r)]
        return [
            ("cane", loft(rings, proxies=[reed])),
            (self.thread_material, turned(start * Z, Z, wound, sides=20)),
            (self.staple_material, solid((start + thread) * Z, Z, below, sides=20)),
        ]


def thumb_rest(
    wall: Wall, along: float, angle_deg: float, *, reach: float = 0.017, width: float = 0.016, metal: str = METAL
) -> Touch:
    """The hook on the back under which the right thumb carries a straight instrument.

    Its touch point lies under the hook, where the side of the thumb's nail bears; the normal points along the body,
    away from the mouth.
    """
    out, across, down = wall.normal(angle_deg), wall.around(angle_deg), unit(wall.axis)
    base = wall.point(along, angle_deg, 0.0006)
    pieces: Pieces = [(metal, plate(base + 0.010 * down, (width * 0.42, 0.0007, 0.013), across, out))]
    for place in (0.004, 0.018):
        foot = wall.point(along + place, angle_deg, 0.0010)
        pieces.append((metal, turned(foot, out, [(0, 0.0022), (0.0006, 0.0020), (0.0009, 0.0)], sides=10, proxy=False)))
    t = np.linspace(0, 1, 8)
    line = wall.point(along, angle_deg, 0.0004) + np.outer(t * reach, out) + np.outer(0.0030 * t**2, down)
    rings = []
    for place, share in zip(line, t, strict=True):
        half, thick = width / 2 * (1 - 0.25 * share**3), 0.0013 - 0.0004 * share
        u = np.linspace(0, 2 * np.pi, 14, endpoint=False)
        bow = 0.0016 * np.cos(u)[:, None] ** 2 * down
        rings.append(place + half * np.cos(u)[:, None] * across + thick * np.sin(u)[:, None] * down + bow)
    slope = unit(line[-1] - line[0])
    under = np.cross(across, slope) if np.cross(across, slope) @ down > 0 else np.cross(slope, across)
    half = np.array([width / 2 * 0.9, 0.0013, np.linalg.norm(line[-1] - line[0]) / 2])
    box = {"shape": "box", "centre_m": (line[0] + line[-1]) / 2, "half_m": half, "x_axis": across, "y_axis": under}
    hook = loft([ring[::-1] for ring in rings], proxies=[box])
    pieces.append((metal, hook))
    share = 0.50
    point = wall.point(along, angle_deg, 0.0004 + share * reach) + (0.0030 * share**2 + 0.0012) * down
    return Touch(pieces, point, down, base, down)
