"""The recorders of the baroque (English) fingering: soprano in C and alto in F, of plastic as in schools.

Sizes are those of common instruments: 324 mm (soprano) and 472 mm (alto) long, 23 and 27 mm thick in the middle, the
holes of the right hand 22 and 27 mm apart; the two lowest holes are double. In three joints: head with beak and window,
body, foot.

The model's frame: the origin in the middle of the beak where the lips close around it, +Z along the bore away from the
player, +Y the front with the finger holes. Distances ``along`` are counted from there; the tip lies at ``-TIP_M``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from resources.build.instrument_keys import Keywork, Wall, bodied, chimney, cylinder, entry
from resources.build.instrument_mesh import Array, Shape, plate, turned
from resources.build.instrument_reeds import creased, loft

X, Y, Z = np.eye(3)
TIP_M = 0.010
"""Distance in metres of the beak's tip from the lips, inside the mouth."""


@dataclass(frozen=True)
class Sizes:
    """Differences of the recorders; distances from the tip, in metres."""

    length: float
    head: float
    """Distance at which the head joint ends."""
    foot: float
    """Distance at which the foot joint begins."""
    window: float
    holes: tuple[float, ...]
    """Holes of the seven fingers."""
    thumb: float
    thick: float
    """Radius of the body."""
    beak: float
    """Distance to which the beak's slope extends."""
    rest: float
    """Distance at which the right thumb holds the instrument."""
    hole: float
    tip: tuple[float, float] = (0.0098, 0.0046)
    """Half the beak's width at the tip, and its height there."""
    body: str = "pearwood"
    trim: str = "ivory_plastic"


SOPRANO = Sizes(
    length=0.324, head=0.108, foot=0.268, window=0.052, beak=0.046, thick=0.0115, hole=0.0029,
    thumb=0.1330, rest=0.2050,
    holes=(0.1400, 0.1625, 0.1850, 0.2100, 0.2310, 0.2520, 0.2800), body="ivory_plastic", trim="maple",
)  # fmt: skip
ALTO = Sizes(
    length=0.472, head=0.148, foot=0.388, window=0.064, beak=0.054, thick=0.0138, hole=0.0035,
    thumb=0.1830, rest=0.3010,
    holes=(0.1940, 0.2250, 0.2560, 0.3020, 0.3320, 0.3620, 0.4010), tip=(0.0110, 0.0054),
)  # fmt: skip

FINGERS = {
    "l1": "left.index", "l2": "left.middle", "l3": "left.ring", "r1": "right.index", "r2": "right.middle",
    "r3": "right.ring", "r4": "right.little",
}  # fmt: skip
"""By hole, from the top."""


class Recorder:
    """Builds one recorder."""

    def __init__(self, sizes: Sizes) -> None:
        self.sizes = sizes
        self.work = Keywork(hover_m=0.008)
        r, s = sizes.thick, sizes
        # The bore's axis lies under the middle of the beak, which is the origin.
        self.drop = 0.0
        self.drop = -0.5 * sum(self._beak(TIP_M)[1:])
        start = np.array([0.0, self.drop, -TIP_M])
        body = [
            (s.head - 0.004, 1.06 * r), (s.head + 0.018, 1.00 * r), (s.foot - 0.030, 0.90 * r),
            (s.foot - 0.001, 0.88 * r),
        ]  # fmt: skip
        self.body = Wall(start, Z, Y, body)
        foot = [
            (s.foot, 1.05 * r), (s.foot + 0.004, 1.14 * r), (s.foot + 0.009, 1.14 * r), (s.foot + 0.013, 1.02 * r),
            (s.foot + 0.60 * (s.length - s.foot), 0.98 * r), (s.length - 0.010, 1.06 * r), (s.length - 0.006, 1.20 * r),
            (s.length - 0.001, 1.20 * r),
        ]  # fmt: skip
        self.foot = Wall(start, Z, Y, foot)
        head = [
            (s.window + 0.006, 1.14 * r), (s.window + 0.022, 1.14 * r), (s.head - 0.028, 1.06 * r),
            (s.head - 0.020, 1.08 * r),
            (s.head - 0.018, 1.26 * r), (s.head - 0.012, 1.30 * r), (s.head - 0.002, 1.30 * r), (s.head, 1.24 * r),
        ]  # fmt: skip
        self.head = Wall(start, Z, Y, head)

    @property
    def lips_apart_m(self) -> float:
        """Height of the beak where the lips close."""
        return self._beak(TIP_M)[1] - self._beak(TIP_M)[2]

    def make(self) -> Keywork:
        """The whole instrument."""
        work, s = self.work, self.sizes
        work.model.add(s.body, self.body.skin(), self.head.skin(), self.foot.skin())
        work.model.add(s.trim, self.head.collar(s.head - 0.014, 0.0135, 0.0007))
        work.model.add(s.trim, self.foot.collar(s.foot + 0.0035, 0.0060, 0.0007))
        work.model.add(s.trim, self.foot.collar(s.length - 0.0066, 0.0062, 0.0006))
        end = np.asarray(self.foot.start) + s.length * Z
        work.model.add(
            "dark_plastic", turned(end - 0.001 * Z, Z, [(0.0012, 0.62 * s.thick), (0.0012, 0.0)], proxy=False)
        )
        self.mouth()
        self.holes()
        return work

    # -- head

    def _beak(self, place: float) -> tuple[float, float, float]:
        """Half width, top and bottom of the beak's section at a distance from the tip, over the origin's height."""
        s = self.sizes
        share = float(np.clip(place / s.beak, 0, 1))
        r = 1.14 * s.thick
        half = s.tip[0] + (r - s.tip[0]) * share**0.8
        top = self.drop + r
        slope = share**1.15
        bottom_tip, bottom = top - s.tip[1] - 0.0016, self.drop - r
        fall = 0.0016 * (1 - share) ** 2
        return half, top - fall, bottom_tip + (bottom - bottom_tip) * slope

    def mouth(self) -> None:
        """The head from its beak to the window, with windway and labium."""
        work, s = self.work, self.sizes
        t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        rings: list[Array] = []
        r = 1.14 * s.thick
        for place in (0.0, 0.0012, *np.linspace(0.004, s.beak, 12), s.beak + 0.004, s.window + 0.0065):
            half, top, bottom = self._beak(place)
            if place == 0.0:
                half, top, bottom = half - 0.0010, top - 0.0008, bottom + 0.0008
            x, y = np.cos(t), np.sin(t)
            around = self.drop + r * y
            section = around if place > s.beak else np.clip(around, bottom, top)
            flat = np.clip(1 - place / s.beak, 0, 1) ** 0.5
            oval = bottom + (top - bottom) * (0.5 + 0.5 * np.sign(y) * np.abs(y) ** 0.8)
            section = flat * oval + (1 - flat) * section
            wide = np.sign(x) * np.abs(x) ** (1 - 0.35 * flat)
            rings.append(np.column_stack([half * wide, section, np.full_like(t, place - TIP_M)]))
        bodies: list[dict[str, object]] = []
        for start, end in ((0.0, 0.25), (0.25, 0.5), (0.5, 0.75)):
            half, top, bottom = self._beak((start + 0.6 * (end - start)) * s.beak)
            bodies.append({
                "shape": "box", "centre_m": np.array([0, (top + bottom) / 2, (start + end) / 2 * s.beak - TIP_M]),
                "half_m": np.array([0.92 * half, (top - bottom) / 2, (end - start) / 2 * s.beak]),
                "x_axis": X, "y_axis": Y,
            })  # fmt: skip
        axis = np.array([0.0, self.drop, -TIP_M])
        bodies.append(cylinder(axis + 0.75 * s.beak * Z, axis + (s.window + 0.0065) * Z, r))
        work.model.add(s.body, loft(rings, hard_deg=40.0, proxies=bodies))
        half, top, bottom = self._beak(0.0)
        slit = plate((0, top - 0.0024, -TIP_M - 0.0001), (0.55 * half, 0.0006, 0.0003), X, Y)
        work.model.add("leather", bodied(slit))
        # Window and labium: a dark opening cut square and a ramp that rises from its edge.
        w, at = 0.46 * s.thick, s.window - TIP_M
        high = self.drop + r
        dark = plate((0, high - 0.0004, at), (w, 0.0009, 0.0021), X, Y)
        work.model.add("leather", bodied(dark))
        ramp = wedge(w, high, at + 0.0022, 0.017 if s.length > 0.4 else 0.013, r - 0.0003, self.drop)
        work.model.add(s.trim, ramp)

    def holes(self) -> None:
        """Finger holes, the thumb's hole, and where the right thumb holds."""
        s, wall = self.sizes, self.body
        self.work.contact("right.thumb.pad", wall.point(s.rest, 184.0), wall.normal(184.0))
        self.one("lt", "left.thumb", s.thumb, 180.0, 1.05)
        for (label, finger), along in zip(FINGERS.items(), s.holes, strict=True):
            angle = {"l3": 4.0, "r3": 4.0, "r4": -14.0}.get(label, 0.0)
            double = label in ("r3", "r4")
            self.one(label, finger, along, angle, 0.72 if double else 1.0, double)

    def one(self, label: str, finger: str, along: float, angle: float, share: float, double: bool = False) -> None:
        """A hole flush with the wall; a double one has a small hole beside the first."""
        work, s = self.work, self.sizes
        wall, radius = self.foot if along > s.foot else self.body, s.hole * share
        holes = [(angle, radius)]
        if double:
            holes.append((angle - np.degrees(2.5 * radius / wall.radius(along)), 0.75 * radius))
        for at, size in holes:
            work.add(chimney(wall, along, at, size, 0.0002, material=s.body, lip=0.0006, deep_m=0.0007))
        half_value = 0.5 if double or label == "lt" else None
        point, normal = wall.point(along, angle, 0.0), wall.normal(angle)
        work.covered(f"hole_{label}", label, f"{finger}.pad", point, normal, half_value=half_value)


def wedge(half: float, high: float, start: float, length: float, radius: float, drop: float) -> Shape:
    """The labium: a ramp let into the round head, lowest at its edge."""
    rings = []
    for share in np.linspace(0, 1, 6):
        x = half * (1 + 0.25 * share) * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
        over = drop + np.sqrt(radius**2 - x**2) + 0.0010
        y = over - (1 - share) * 0.0005
        rings.append(np.column_stack([x, y, np.full(5, start + share * length)]))
    points = np.vstack(rings)
    faces = []
    for layer in range(5):
        for k in range(4):
            a, b = layer * 5 + k, layer * 5 + k + 1
            faces += [(a, a + 5, b + 5), (a, b + 5, b)]
    return creased(points, np.array(faces), 60.0)


INSTRUMENTS = {
    "recorder_soprano_C": entry(lambda: Recorder(SOPRANO).make()),
    "recorder_alto_F": entry(lambda: Recorder(ALTO).make()),
}
