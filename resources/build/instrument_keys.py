"""Parts that woodwinds share: tone holes, rings, padded cups, rods on posts, touch pieces, reeds; and the book of keys.

A key is reported in one line of a family's script: where its rod lies, what the finger touches, which cups hang on it.
From that follow its shapes, how far it turns, how high an open cup stands over its hole, the touch point of the
contact and the tables ``[[controls]]`` and ``[[links]]`` of the map (`Keywork`). A family's script says::

    def _clarinet() -> Keywork:
        work = Keywork()
        body = Wall((0, 0, 0.1), Z, Y, [(0, 0.015), (0.5, 0.015)])
        work.model.add("grenadilla", body.skin())
        work.hole("hole_L3", "L3", "left.ring.pad", body, along=0.12, angle_deg=0, radius=0.004)
        rod = body.rod(0.05, 0.15, angle_deg=-50)
        spatula = slab(body.point(0.14, -80, 0.008), body.normal(-80), Z, oval(0.016, 0.008))
        work.key("key_E", "LE", "left.little.pad", rod, spatula, [Cup(body, 0.30, -60, 0.007)])
        return work

    INSTRUMENTS = {"clarinet_Bb": entry(_clarinet)}

Everything is in the root frame of the model, metres. The order of the calls is the order of the contacts: what a finger
touches first is where it is at home.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from resources.build.instrument_mesh import Array, Model, Shape, solid, torus, tube, turned, unit

Pieces = list[tuple[str, Shape]]
"""Shapes with their materials."""

METAL = "silver"
ROD_R = 0.0017
ARM_R = 0.0016
CUP_THICK_M = 0.0030
"""Pad and metal of a cup together."""


@dataclass(frozen=True)
class Wall:
    """A straight piece of body; a place on it is a distance along and an angle about its axis.

    Attributes
    ----------
    start : point of the axis where the distance is 0
    axis : direction of the axis, away from the player's mouth
    front : direction of the angle 0; 90 degrees is ``front x axis`` (of a clarinet, +Z and +Y: the player's left)
    profile : (distance, outer radius) in ascending order
    """

    start: ArrayLike
    axis: ArrayLike
    front: ArrayLike
    profile: Sequence[tuple[float, float]]

    def radius(self, along: float) -> float:
        """Outer radius of the body at a place along it."""
        places, radii = zip(*self.profile, strict=True)
        return float(np.interp(along, places, radii))

    def normal(self, angle_deg: float) -> Array:
        """Out of the wall at an angle."""
        front, angle = unit(self.front), np.radians(angle_deg)
        return np.cos(angle) * front + np.sin(angle) * np.cross(front, unit(self.axis))

    def around(self, angle_deg: float) -> Array:
        """Along the wall towards growing angles."""
        return self.normal(angle_deg + 90.0)

    def point(self, along: float, angle_deg: float, height: float = 0.0) -> Array:
        """A place at a height over the wall."""
        foot = np.asarray(self.start, float) + along * unit(self.axis)
        return foot + (self.radius(along) + height) * self.normal(angle_deg)

    def place(self, point: ArrayLike) -> tuple[float, float, float]:
        """Distance along, angle in degrees and height over the wall of a point."""
        off = np.asarray(point, float) - np.asarray(self.start, float)
        along = float(off @ unit(self.axis))
        side = np.cross(unit(self.front), unit(self.axis))
        angle = float(np.degrees(np.arctan2(off @ side, off @ unit(self.front))))
        height = float(np.linalg.norm(off - along * unit(self.axis))) - self.radius(along)
        return along, angle, height

    def skin(self, sides: int = 40) -> Shape:
        """The body itself, closed at both ends."""
        return solid(self.start, self.axis, self.profile, sides=sides)

    def collar(self, along: float, length: float, thick: float = 0.0012) -> Shape:
        """A metal ring around the body: at a tenon's socket, a barrel's or bell's edge."""
        a, b = self.radius(along), self.radius(along + length)
        edge = min(0.0008, length / 4)
        profile = [(-0.0003, a * 0.9), (-0.0003, a + thick * 0.6), (edge, a + thick), (length - edge, b + thick)]
        profile += [(length + 0.0003, b + thick * 0.6), (length + 0.0003, b * 0.9)]
        start = np.asarray(self.start, float) + along * unit(self.axis)
        return turned(start, self.axis, profile, sides=40, proxy=False)

    def rod(self, start: float, end: float, angle_deg: float, height: float = 0.004) -> Rod:
        """A rod along the body, between two distances."""
        return Rod(self, self.point(start, angle_deg, height), self.point(end, angle_deg, height))

    def cross_rod(self, along: float, angle_deg: float, width: float = 0.010, height: float = 0.004) -> Rod:
        """A short rod across the body, the axle of a lever that lies along it."""
        middle, across = self.point(along, angle_deg, height), self.around(angle_deg)
        return Rod(self, middle - width / 2 * across, middle + width / 2 * across)

    def spatula(
        self,
        along: float,
        angle_deg: float,
        height: float,
        outline: Array,
        thick: float = 0.0018,
        *,
        ahead: float = 1.0,
        turn_deg: float = 0.0,
        lean_deg: float = 0.0,
        material: str = METAL,
        foot: float = -0.42,
        core: Array | None = None,
    ) -> Touch:
        """A `slab` over the body, its length along it, ``ahead`` of 1 away from the mouth.

        ``turn_deg`` swings its length towards growing angles, ``lean_deg`` leans its top that way.
        """
        turn = np.radians(turn_deg)
        lead = ahead * (np.cos(turn) * unit(self.axis) + np.sin(turn) * self.around(angle_deg))
        centre, normal = self.point(along, angle_deg, height), self.normal(angle_deg + lean_deg)
        return slab(centre, normal, lead, outline, thick, material=material, foot=foot, core=core)

    def arc(self, start: ArrayLike, end: ArrayLike, clear_m: float | None = None) -> Array:
        """A way from one point to another around the body instead of through it, nowhere lower than ``clear_m``."""
        a, b = np.array(self.place(start)), np.array(self.place(end))
        b[1] += 360.0 * round((a[1] - b[1]) / 360.0)
        run = np.hypot(b[0] - a[0], np.radians(b[1] - a[1]) * self.radius(float(a[0])))
        share = np.linspace(0, 1, max(2, int(np.ceil(run / 0.006)) + 1))
        places = a + share[:, None] * (b - a)
        if clear_m is not None:
            places[1:-1, 2] = np.maximum(places[1:-1, 2], clear_m)
        return np.array([self.point(*place) for place in places])


@dataclass(frozen=True)
class Rod:
    """The axle of a key: two ends, each in a post that stands on the wall."""

    wall: Wall
    a: Array
    b: Array
    posts: bool = True
    radius: float = ROD_R

    @property
    def axis(self) -> Array:
        """Direction of the rod."""
        return unit(self.b - self.a)

    def nearest(self, point: ArrayLike) -> Array:
        """The point of the rod that is nearest to another."""
        span = self.b - self.a
        share = np.clip((np.asarray(point) - self.a) @ span / (span @ span), 0, 1)
        return self.a + share * span

    def standing(self) -> Pieces:
        """Posts of the rod, which are motionless."""
        if not self.posts:
            return []
        return [piece for end in (self.a, self.b) for piece in post(self.wall, end)]


def bodied(shape: Shape, *proxies: dict[str, object]) -> Shape:
    """Shape with these collision bodies: every part near a hand needs one, and a model has at most 260."""
    return replace(shape, proxies=proxies)


def cylinder(a: ArrayLike, b: ArrayLike, radius: float) -> dict[str, object]:
    """The collision body of a round part."""
    return {"shape": "cylinder", "a_m": np.asarray(a, float), "b_m": np.asarray(b, float), "radius_m": radius}


def post(wall: Wall, top: ArrayLike) -> Pieces:
    """A turned post with a ball that holds the end of a rod."""
    along, angle, height = wall.place(top)
    foot, out = wall.point(along, angle, -0.0008), wall.normal(angle)
    tall = height + 0.0008
    r = 0.0021
    profile = [(0, 0.0028), (0.0012, 0.0026), (0.0020, 0.0014), (max(tall - r, 0.0022), 0.0013)]
    profile += [(tall + r * np.sin(t), r * np.cos(t)) for t in np.radians([-35, 0, 35, 65])] + [(tall + r, 0.0)]
    shape = turned(foot, out, profile, sides=8, proxy=False)
    tall_proxy = [cylinder(foot, foot + tall * out, 0.0017)] if height > 0.0055 else []
    return [(METAL, bodied(shape, *tall_proxy))]


@dataclass(frozen=True)
class Touch:
    """A touch piece: its shapes, the point and normal the finger meets, and where its arm begins."""

    pieces: Pieces
    point: Array
    normal: Array
    foot: Array
    ahead: Array

    def moved(self, along_normal_m: float) -> Touch:
        """The touch with its touch point higher or lower and unchanged shapes."""
        return replace(self, point=self.point + along_normal_m * self.normal)


def oval(length: float, width: float) -> Array:
    """Outline of a rounded plate, (ahead, across)."""
    t = np.linspace(0, 2 * np.pi, 18, endpoint=False)
    x, y = np.cos(t), np.sin(t)
    return np.column_stack([length / 2 * np.sign(x) * np.abs(x) ** 0.75, width / 2 * np.sign(y) * np.abs(y) ** 0.75])


def teardrop(length: float, wide: float, narrow: float) -> Array:
    """Outline that is wide ahead and narrow behind."""
    shape = oval(length, 2.0)
    share = shape[:, 0] / length + 0.5
    half = (narrow + (wide - narrow) * share) / 2
    return np.column_stack([shape[:, 0], shape[:, 1] * half])


def slab(
    centre: ArrayLike,
    normal: ArrayLike,
    ahead: ArrayLike,
    outline: Array,
    thick: float = 0.0018,
    *,
    material: str = METAL,
    hollow_m: float = 0.0004,
    foot: float = -0.4,
    core: Array | None = None,
) -> Touch:
    """A spatula: a plate with round edges, a little hollow on top.

    Parameters
    ----------
    centre : the middle of its top, where the finger meets it
    normal : out of it, towards the finger
    ahead : direction of the outline's first coordinate
    outline : (n, 2) around the middle: `oval`, `teardrop`
    foot : where its arm begins, as a share of its length from the middle
    core : a smaller outline that its collision body and its arm go by, where it is touched near its edge
    """
    up = unit(normal)
    lead = np.asarray(ahead, float)
    lead = unit(lead - up * (lead @ up))
    side = np.cross(up, lead)
    middle = np.asarray(centre, float)
    count = len(outline)
    rim = outline[:, :1] * lead + outline[:, 1:] * side
    out = rim / np.maximum(np.linalg.norm(rim, axis=1), 1e-9)[:, None]
    rise = hollow_m
    layers = [  # height over the middle, scale, lean of the normal from up to out
        (0.0, 0.0, 0.0), (0.0, 0.55, 0.0), (rise, 0.90, -0.05), (rise - 0.15 * thick, 0.985, 0.7),
        (rise - 0.45 * thick, 1.0, 1.0), (rise - 0.8 * thick, 0.97, 1.4), (rise - thick, 0.90, 2.0),
        (rise - thick, 0.0, 2.0),
    ]  # fmt: skip
    points, normals = [], []
    for height, scale, lean in layers:
        points.append(middle + height * up + scale * rim)
        turn = lean * np.pi / 2
        normals.append(np.cos(turn) * up + np.sin(turn) * out)
    faces: list[tuple[int, int, int]] = []
    for layer in range(len(layers) - 1):
        for k in range(count):
            a, b = layer * count + k, layer * count + (k + 1) % count
            if layer > 0:
                faces.append((a, b + count, b))
            if layer < len(layers) - 2:
                faces.append((a, a + count, b + count))
    length, width = np.ptp(outline if core is None else core, axis=0)
    box: dict[str, object] = {
        "shape": "box",
        "centre_m": middle + (rise - thick / 2) * up,
        "half_m": np.array([length * 0.47, thick / 2, width * 0.45]),
        "x_axis": lead,
        "y_axis": up,
    }
    uvs = np.tile(outline / np.ptp(outline, axis=0).max() + 0.5, (len(layers), 1))
    flat = np.vstack(normals)
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    shape = Shape(np.vstack(points), flat, uvs, np.array(faces, np.int64), (box,))
    start = middle + foot * length * lead - (thick / 2) * up
    return Touch([(material, shape)], middle, up, start, lead)


def pearl(centre: ArrayLike, normal: ArrayLike, radius: float = 0.0080, *, material: str = METAL) -> Touch:
    """A round touch piece with a mother-of-pearl inlay, a little hollow; ``centre`` is the middle of its top."""
    up, middle = unit(normal), np.asarray(centre, float)
    r = radius
    seat = [(-0.0032, 0), (-0.0032, 0.8 * r), (-0.0016, r), (0.0, r), (0.0004, 0.95 * r), (0.0003, 0.88 * r)]
    disc = [(-0.0012, 0.9 * r), (0.0002, 0.9 * r), (0.0002, 0.84 * r), (-0.0001, 0.5 * r), (-0.0002, 0.0)]
    pieces = [
        (material, bodied(turned(middle, up, seat, sides=22), cylinder(middle - 0.0032 * up, middle, r))),
        ("pearl", turned(middle, up, disc, sides=22, proxy=False)),
    ]
    return Touch(pieces, middle - 0.0002 * up, up, middle - 0.0024 * up, np.eye(3)[np.argmin(np.abs(up))])


def roller(a: ArrayLike, b: ArrayLike, radius: float = 0.0022, *, material: str = METAL) -> Pieces:
    """A roller between two little-finger keys."""
    start, end = np.asarray(a, float), np.asarray(b, float)
    length, r = float(np.linalg.norm(end - start)), radius
    profile = [(0, 0.7 * r), (0.12 * length, r), (0.88 * length, r), (length, 0.7 * r)]
    return [(material, solid(start, end - start, profile, sides=12))]


def with_pieces(touch: Touch, pieces: Pieces) -> Touch:
    """A touch piece with more on it (a roller, a second lobe)."""
    return replace(touch, pieces=[*touch.pieces, *pieces])


def with_tail(touch: Touch, rod: Rod, end: ArrayLike, normal: Array, radius: float) -> Touch:
    """A lever's other end beyond its axle, where a pin meets another key."""
    profile = [(-0.001, radius), (0.002, radius)]
    pin = solid(end, -normal, profile, sides=8, proxy=False)
    return with_pieces(touch, [("silver", arm(rod.wall, rod.nearest(touch.foot), end)), ("silver", pin)])


@dataclass(frozen=True)
class Cup:
    """A padded cup over a tone hole.

    ``radius`` is the cup's; its hole's rim is 0.75 of it. ``rim_m`` is how high the rim stands over the wall.
    ``open_hole`` leaves a hole in the middle of the cup that the finger closes (a French flute's plateau).
    """

    wall: Wall
    along: float
    angle_deg: float
    radius: float
    rim_m: float = 0.0015
    thick_m: float = CUP_THICK_M
    open_hole: float = 0.0
    rim_material: str = "grenadilla"
    material: str = METAL

    @property
    def normal(self) -> Array:
        """Out of the hole."""
        return self.wall.normal(self.angle_deg)

    @property
    def seat(self) -> Array:
        """The middle of the rim the pad closes."""
        return self.wall.point(self.along, self.angle_deg, self.rim_m)

    def chimney(self) -> Pieces:
        """The rim of its hole, for the root."""
        return chimney(
            self.wall, self.along, self.angle_deg, 0.72 * self.radius, self.rim_m, material=self.rim_material
        )

    def pieces(self, lift_m: float) -> Pieces:
        """The cup with its pad at a height over the rim."""
        base, up, r, t = self.seat + lift_m * self.normal, self.normal, self.radius, self.thick_m
        found: Pieces = [("pad", solid(base, up, [(0.0, 0.93 * r), (0.4 * t, 0.93 * r)], sides=16, proxy=False))]
        inner = self.open_hole
        top = t + (0.0004 if not inner else 0.0)
        dome = [(0.3 * t, 0.0 if not inner else 0.9 * r), (0.3 * t, 0.95 * r), (0.42 * t, r), (0.72 * t, r)]
        dome += [(0.93 * t, 0.88 * r), (t, 0.66 * r)]
        dome += [(t, inner), (0.35 * t, inner)] if inner else [(top, 0.30 * r), (top, 0.0)]
        whole = cylinder(base, base + t * up, r)
        found.append((self.material, bodied(turned(base, up, dome, sides=20), whole)))
        if inner:
            disc = [(t - 0.0004, inner + 0.0002), (t - 0.0004, 0.0)]
            found.append(("dark_plastic", turned(base, up, disc, sides=18, proxy=False)))
        return found

    def top(self, lift_m: float) -> Array:
        """Return the place at which a finger touches the cup itself, lifted by ``lift_m``."""
        high = self.thick_m if self.open_hole else self.thick_m + 0.0004
        return self.seat + (lift_m + high) * self.normal


def chimney(
    wall: Wall,
    along: float,
    angle_deg: float,
    radius: float,
    height: float,
    *,
    material: str = "grenadilla",
    lip: float = 0.0013,
    deep_m: float = 0.0008,
) -> Pieces:
    """The rim of a tone hole: a short tube out of the wall and the dark inside.

    ``deep_m`` is how far the dark floor lies under the rim; the touch point of a finger is the middle of the rim.
    """
    foot, up = wall.point(along, angle_deg, 0.0), wall.normal(angle_deg)
    r, out = radius, radius + lip
    sink = min(wall.radius(along) - 1e-4, out)
    low = -(wall.radius(along) - float(np.sqrt(wall.radius(along) ** 2 - sink**2))) - 0.0004
    outer = [(low, out + 0.0006), (height - 0.0004, out), (height, out - 0.0004), (height, r + 0.0003)]
    inner = [(height, r + 0.0003), (height - 0.0003, r), (height - deep_m, r)]
    floor = [(height - deep_m, r + 0.0002), (height - deep_m, 0.0)]
    return [
        (material, bodied(turned(foot, up, outer, sides=24), cylinder(foot + low * up, foot + height * up, out))),
        (material, turned(foot, up, inner, sides=24, proxy=False)),
        ("dark_plastic", turned(foot, up, floor, sides=20, proxy=False)),
    ]


@dataclass(frozen=True)
class RingOn:
    """A ring around a finger hole, which goes down with the finger until it is level with the hole's rim."""

    wall: Wall
    along: float
    angle_deg: float
    radius: float
    rim_m: float = 0.0022
    thick: float = 0.0010

    @property
    def normal(self) -> Array:
        """Out of the hole."""
        return self.wall.normal(self.angle_deg)

    @property
    def seat(self) -> Array:
        """Middle of the ring when it is pressed."""
        return self.wall.point(self.along, self.angle_deg, self.rim_m - self.thick * 0.6)

    def pieces(self, lift_m: float, material: str = METAL) -> Pieces:
        """The ring at a height over where it goes."""
        shape = torus(self.seat + lift_m * self.normal, self.normal, self.radius, self.thick, sides=8, around=28)
        return [(material, shape)]


def arm(wall: Wall, start: ArrayLike, end: ArrayLike, *, clear_m: float = 0.0022) -> Shape:
    """A flat arm around the body from a rod to what hangs on it."""
    line = wall.arc(start, end, clear_m)
    _, angle, _ = wall.place(line[0])
    widths = np.linspace(ARM_R * 1.1, ARM_R * 0.9, len(line))
    strap = tube(line, widths, sides=8, flat=(0.62, 1.25), side=wall.normal(angle), proxy=False)
    return bodied(strap, *tube(line, 0.85 * ARM_R, sides=3).proxies)


def turn_of(rod: Rod, point: ArrayLike, normal: ArrayLike, travel_m: float) -> tuple[Array, float]:
    """Axis and angle about a rod that carry a point ``travel_m`` against its normal."""
    speed = np.cross(rod.axis, np.asarray(point, float) - rod.a) @ unit(normal)
    if abs(speed) < 0.002:
        raise ValueError("the rod passes under the touch piece: pressing it would turn nothing")
    return (rod.axis if speed < 0 else -rod.axis), float(travel_m / abs(speed))


def sink_of(rod: Rod, axis: Array, angle_rad: float, point: ArrayLike, normal: ArrayLike) -> float:
    """Return the distance (m) that a point sinks against a normal when the key turns; negative if it rises."""
    return float(-angle_rad * np.cross(axis, np.asarray(point, float) - rod.a) @ unit(normal))


@dataclass
class Keywork:
    """The book of an instrument's keys: fills the model and keeps what its map says of them.

    Attributes
    ----------
    model : Model
        What is drawn.
    contacts, controls, links : list of tables
        What the map says, in order.
    endpin : table or None
        What the map says of the pin it stands on (`instrument_endpin`).
    hover_m : float
        How high a finger waits over what it does not play.
    metal : str
        Material of rods, arms and posts.
    """

    model: Model = field(default_factory=Model)
    contacts: list[dict[str, object]] = field(default_factory=list)
    controls: list[dict[str, object]] = field(default_factory=list)
    links: list[dict[str, object]] = field(default_factory=list)
    endpin: dict[str, object] | None = None
    hover_m: float = 0.008
    metal: str = METAL

    def add(self, pieces: Pieces, node: str = "root") -> None:
        """Put shapes into a node."""
        for material, shape in pieces:
            self.model.add(material, shape, node=node)

    def contact(
        self,
        part: str,
        point: ArrayLike,
        normal: ArrayLike,
        *,
        node: str = "root",
        control: str | None = None,
        grip: str = "firm",
        together: Sequence[str] = (),
    ) -> None:
        """A touch in the root frame."""
        row: dict[str, object] = {"part": part, "node": node, "point": np.asarray(point, float)}
        row |= {"normal": unit(normal), "control": control, "grip": grip}
        if together:
            row["together"] = list(together)
        self.contacts.append(row)

    def hole(
        self,
        name: str,
        label: str,
        part: str,
        wall: Wall,
        *,
        along: float,
        angle_deg: float,
        radius: float,
        rim_m: float = 0.0022,
        half_value: float | None = None,
        material: str = "grenadilla",
    ) -> None:
        """A hole the finger itself closes; a ring around it is a link (`linked`) of one or more holes."""
        self.add(chimney(wall, along, angle_deg, radius, rim_m, material=material))
        middle = wall.point(along, angle_deg, rim_m - 0.0004)
        self.covered(name, label, part, middle, wall.normal(angle_deg), half_value=half_value)

    def covered(
        self, name: str, label: str, part: str, point: ArrayLike, normal: ArrayLike, *, half_value: float | None = None
    ) -> None:
        """A place covered by a finger, where nothing moves."""
        self.control(name, "hole", label, part, half_value=half_value)
        self.contact(part, point, normal, control=name)

    def key(
        self,
        name: str,
        label: str,
        part: str,
        rod: Rod,
        touch: Touch,
        cups: Sequence[Cup] = (),
        *,
        travel_m: float = 0.004,
        clear_m: float = 0.0022,
        touch_arm: bool = True,
        attack_s: float | None = None,
    ) -> None:
        """A key with a touch piece; cups that it closes stand open, cups that it opens lie on their holes.

        A key of ``attack_s`` is let go so long after an attack for which it was pressed.
        """
        axis, angle = turn_of(rod, touch.point, touch.normal, travel_m)
        self.model.node(name, rod.nearest(touch.foot))
        self.add(touch.pieces, name)
        if touch_arm:
            self.add([(self.metal, arm(rod.wall, rod.nearest(touch.foot), touch.foot, clear_m=clear_m))], name)
        motion = self._moving(name, rod, axis, angle, cups, clear_m=clear_m)
        self.control(name, "key", label, part, attack_s=attack_s, node=name, motion=motion)
        self.contact(part, touch.point, touch.normal, node=name, control=name)

    def plateau(
        self,
        name: str,
        label: str,
        part: str,
        rod: Rod,
        cup: Cup,
        others: Sequence[Cup] = (),
        *,
        opening_m: float = 0.0035,
        half_value: float | None = None,
    ) -> None:
        """A key whose cup the finger itself presses: flute, saxophone, bass clarinet."""
        axis, angle = turn_of(rod, cup.seat, cup.normal, opening_m)
        self.model.node(name, rod.nearest(cup.seat))
        motion = self._moving(name, rod, axis, angle, (cup, *others))
        kind = "key" if half_value is None else "hole"
        self.control(name, kind, label, part, node=name, motion=motion, half_value=half_value)
        self.contact(part, cup.top(opening_m), cup.normal, node=name, control=name)

    def linked(
        self,
        node: str,
        controls: Sequence[str],
        rod: Rod,
        *,
        rings: Sequence[RingOn] = (),
        cups: Sequence[Cup] = (),
        drop_m: float = 0.0012,
        proxy_rod: bool = True,
    ) -> None:
        """A part other controls move: rings around holes, cups far from the finger; the first of them goes ``drop_m``.

        A negative ``drop_m`` opens a cup that lies on its hole.
        """
        lead: RingOn | Cup = (*rings, *cups)[0]
        axis, angle = turn_of(rod, lead.seat, lead.normal, abs(drop_m))
        if drop_m < 0:
            axis = -axis
        self.model.node(node, rod.nearest(lead.seat))
        motion = self._moving(node, rod, axis, angle, cups, rings, proxy_rod=proxy_rod)
        self.links.append({"node": node, "motion": motion, "controls": list(controls), "when": "any"})

    def also(
        self,
        part: str,
        control: str,
        together: Sequence[str] = (),
        *,
        point: ArrayLike | None = None,
        normal: ArrayLike | None = None,
    ) -> None:
        """Another finger, or the same one with other controls, works a control: where it was touched, or elsewhere."""
        known = next(row for row in self.contacts if row["control"] == control)
        self.contact(
            part,
            known["point"] if point is None else point,
            known["normal"] if normal is None else normal,
            node=str(known["node"]),
            control=control,
            together=together,
        )

    def _moving(
        self,
        node: str,
        rod: Rod,
        axis: Array,
        angle: float,
        cups: Sequence[Cup],
        rings: Sequence[RingOn] = (),
        *,
        clear_m: float = 0.0022,
        proxy_rod: bool = True,
    ) -> dict[str, object]:
        """The rod with its arms, cups and rings; posts and rims of the holes go to the root. Returns its motion."""
        self.add([(self.metal, tube([rod.a, rod.b], rod.radius, sides=8, proxy=proxy_rod))], node)
        self.add([(self.metal, shape) for _, shape in rod.standing()])
        for cup in cups:
            lift = max(0.0, sink_of(rod, axis, angle, cup.seat, cup.normal))
            self.add(cup.chimney())
            self.add(cup.pieces(lift), node)
            end = cup.seat + (lift + cup.thick_m * 0.8) * cup.normal
            if cup.open_hole:
                off = rod.nearest(end) - end
                end = end + 0.85 * cup.radius * unit(off - cup.normal * (off @ cup.normal))
            self.add([(self.metal, arm(rod.wall, rod.nearest(end), end, clear_m=clear_m))], node)
        for ring in rings:
            lift = max(0.0, sink_of(rod, axis, angle, ring.seat, ring.normal))
            middle = ring.seat + lift * ring.normal
            self.add(ring.pieces(lift, self.metal), node)
            near = rod.nearest(middle)
            off = near - middle
            off = unit(off - ring.normal * (off @ ring.normal))
            self.add([(self.metal, arm(rod.wall, near, middle + ring.radius * off, clear_m=0.0))], node)
        return {"axis": axis, "angle_rad": angle, "pivot_m": rod.a}

    def control(self, name: str, kind: str, label: str, part: str, **more: object) -> None:
        """Add a control of the map, worked by the finger that ``part`` belongs to. Entries of ``more`` that are None
        are left out."""
        row: dict[str, object] = {"name": name, "kind": kind, "role": "pitch", "label": label}
        row |= {"finger": ".".join(part.split(".")[:2]), "hover_m": self.hover_m, **more}
        self.controls.append({key: value for key, value in row.items() if value is not None})

    def tables(self) -> str:
        """The tables ``[[controls]]``, ``[[links]]`` and ``[endpin]`` of the map."""
        blocks = [("[[controls]]", row) for row in self.controls] + [("[[links]]", row) for row in self.links]
        blocks += [] if self.endpin is None else [("[endpin]", self.endpin)]
        return "".join(table(heading, row) for heading, row in blocks)


def entry(
    make: Callable[[], Keywork],
) -> tuple[Callable[[], Model], Callable[[], list[dict[str, object]]], Callable[[], str]]:
    """Return the entry of an instrument with keys in a family's table ``INSTRUMENTS``: functions that give its model,
    its contacts and the map's tables of its keys."""
    made = lru_cache(maxsize=1)(make)
    return lambda: made().model, lambda: made().contacts, lambda: made().tables()


def table(heading: str, row: dict[str, object]) -> str:
    """A table of a map as TOML, after an empty line."""
    return f"\n{heading}\n" + "".join(f"{key} = {toml(value)}\n" for key, value in row.items())


def toml(value: object) -> str:
    """A text, a number (to a hundredth of a millimetre), a vector or an inline table as TOML."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list | tuple | np.ndarray):
        return "[" + ", ".join(toml(inner) for inner in value) + "]"
    text = f"{float(value):.5f}".rstrip("0")
    text = text if not text.endswith(".") else f"{text}0"
    return "0.0" if text == "-0.0" else text
