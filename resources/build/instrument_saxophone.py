"""The saxophones: the alto, the tenor and the baritone with larger tubes, the straight soprano.

Sizes are those of common instruments. Alto: neck 190 mm along its curve, body 455 mm from the receiver to the bow,
25 mm thick at its top and 53 at its end, bow 98 mm from axis to axis, bell rim 121 mm wide and 215 mm below the
receiver. Tenor: body 590 mm, 29 to 63 mm thick, bell 153 mm, a neck that rises before it falls to the mouth.
Baritone to low A: body 800 mm, 38 to 84 mm thick (slimmer under the hands than a real cone: a small hand must reach
around it), a loop above the body, bell 180 mm. Soprano: 675 mm with the mouthpiece, 14 to 43 mm thick, bell 91 mm. The
pearls are 31 to 38 mm apart on all: hands do not grow with the tube; the cups lie where the tone holes are, on rods as
long as they need to be.

The model's frame: +Z along the mouthpiece, away from the player. The body hangs from the neck's end, a little to the
player's right and back to the body (`Shape`); its Wall's front looks ahead, +90 degrees is the player's left. Distances
``along`` are counted from the receiver, where the neck goes in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from resources.build.instrument_keys import (
    Cup,
    Keywork,
    Rod,
    Touch,
    Wall,
    bodied,
    cylinder,
    entry,
    oval,
    pearl,
    roller,
    with_pieces,
)
from resources.build.instrument_mesh import (
    Array,
    Shape,
    bend,
    half_circle,
    joined,
    lengths,
    solid,
    torus,
    tube,
    turned,
    unit,
)
from resources.build.instrument_reeds import SingleReed, thumb_rest

X, Y, Z = np.eye(3)
BRASS = "gold_lacquer"
THIN_M = 0.0018
POST_M = 0.0017
FINGER_M = 0.020
"""Distance in metres between the body's wall and the centre of a finger around it."""

ALTO_REED = SingleReed(
    tip_m=0.013, length=0.086, radius=0.0137, end_radius=0.0128, beak_length=0.036, tip_width=0.0150, table=0.0090,
    bite=0.0086, reed_length=0.0700, reed_width=0.0150, reed_thick=0.0031, ligature=(0.038, 0.062), metal=BRASS,
)  # fmt: skip
TENOR_REED = SingleReed(
    tip_m=0.014, length=0.093, radius=0.0152, end_radius=0.0140, beak_length=0.038, tip_width=0.0162, table=0.0100,
    bite=0.0092, reed_length=0.0780, reed_width=0.0162, reed_thick=0.0033, ligature=(0.041, 0.066), metal=BRASS,
)  # fmt: skip
BARITONE_REED = SingleReed(
    tip_m=0.015, length=0.104, radius=0.0166, end_radius=0.0152, beak_length=0.042, tip_width=0.0178, table=0.0110,
    bite=0.0100, reed_length=0.0860, reed_width=0.0178, reed_thick=0.0035, ligature=(0.045, 0.072), metal=BRASS,
)  # fmt: skip
SOPRANO_REED = SingleReed(
    tip_m=0.011, length=0.068, radius=0.0122, end_radius=0.0108, beak_length=0.031, tip_width=0.0125, table=0.0080,
    bite=0.0076, reed_length=0.0600, reed_width=0.0125, reed_thick=0.0029, ligature=(0.033, 0.054), metal=BRASS,
)  # fmt: skip

HOLES = {  # along of the alto's holes, radius of their cups
    "hfs": (0.022, 0.0070), "pf": (0.040, 0.0072), "se": (0.058, 0.0074), "peb": (0.074, 0.0076), "pd": (0.100, 0.0080),
    "c": (0.128, 0.0078), "1L": (0.150, 0.0085), "bbb": (0.169, 0.0075), "sc": (0.118, 0.0080), "sbb": (0.143, 0.0082),
    "2L": (0.187, 0.0092), "3L": (0.221, 0.0115), "gs": (0.2485, 0.0106), "f_sharp": (0.276, 0.0125),
    "afs": (0.298, 0.0078), "1R": (0.308, 0.0136), "2R": (0.345, 0.0146), "3R": (0.386, 0.0156), "leb": (0.428, 0.0150),
}  # fmt: skip


@dataclass(frozen=True)
class Layout:
    """Differences of the saxophones, metres.

    Attributes
    ----------
    reed : the mouthpiece
    neck : (ahead, above the mouthpiece's axis) of the neck's corners, the last where it goes into the body
    bends : radii at the corners
    neck_radius : of the neck's ends
    right_deg, back_deg : how the body leans from straight down
    body : (along, radius)
    holes, holes_from : how much farther apart holes are than the alto's, and where its body's top would be
    cups : how much larger cups are
    left, right : along of the first finger's pearl
    pitch : distance of the pearls, left hand first to second, second to third, right hand
    bow_m : from the body's axis to the bell's
    bell_length, bell_throat, bell_rim : from the bow to the rim, radii; ``bell_sides`` around it
    bell_deg, bell_lean : the bell lies so far to the left of ahead, seen from the body, and leans away from it
    bell_cups : along the bell of the cups of B and B flat, and radius
    hook_deg : from the pearls of the right hand around to the thumb's hook; ``hook_reach`` is its length,
        ``hook_at`` how far after the first pearl it lies
    thumb_deg : from the front around to the left thumb's rest, on the alto
    palm : of the palm keys of D, E flat and F, after the left hand's first pearl
    cluster : the left little finger's keys lie so much farther down than the alto's; their height
    fork : the cup of the fork F sharp lies so much higher than the hole, above the hand
    side : of B flat, C and E at the side, after the right hand's first pearl; so many degrees beside the pearls and
        so high over the body (``side_deg``, ``side_heights``), their cups and rods so much farther around
        (``side_cups_deg``, ``side_axles_deg``); ``side_place`` of the index finger works them
    front : of the front F, before the left hand's first pearl
    high_f_sharp : of the high F sharp, after the right hand's third pearl
    little : of the right little finger's E flat: after the third pearl, degrees beside it, height
    far : thin parts farther than this from every touch have no collision bodies, nor tone holes' rims lower than
        ``flat``, nor posts lower than ``low_posts``; nodes in ``whole`` keep all;
        ``steps`` between the places that bodies of neck, bow and octave lever are taken from
    """

    reed: SingleReed = ALTO_REED
    neck: Sequence[tuple[float, float]] = ((0.184, 0.004), (0.196, -0.084))
    bends: Sequence[float] = (0.066,)
    neck_radius: tuple[float, float] = (0.0080, 0.0123)
    right_deg: float = 14.0
    back_deg: float = 7.0
    body: Sequence[tuple[float, float]] = ((0.0, 0.0128), (0.455, 0.0262))
    holes: float = 1.0
    holes_from: float = 0.0
    cups: float = 1.0
    left: float = 0.150
    right: float = 0.312
    pitch: tuple[float, float, float] = (0.037, 0.034, 0.033)
    bow_m: float = 0.100
    bell_length: float = 0.228
    bell_throat: float = 0.0330
    bell_rim: float = 0.0605
    bell_sides: int = 40
    bell_deg: float = 22.0
    bell_lean: float = 0.10
    bell_cups: tuple[tuple[float, float], tuple[float, float]] = ((0.050, 0.0205), (0.110, 0.0215))
    low_a: bool = False
    left_deg: float = -4.0
    left_share: float = 1.0
    right_stack_deg: float = -4.0
    right_pearl_deg: float = -30.0
    hook_deg: float = 158.0
    side: tuple[float, float, float] = (0.0182, 0.0118, 0.0058)
    little: tuple[float, float, float] = (0.0148, -16.0, 0.0150)
    hook_reach: float = 0.022
    thumb_deg: float = 167.0
    palm: tuple[float, float, float] = (0.0125, 0.0060, -0.0005)
    cluster: tuple[float, float] = (0.0, 0.0160)
    fork: float = 0.0
    rod: float = 0.0075
    low_posts: float = 0.0
    whole: tuple[str, ...] = ()
    side_cups_deg: float = 0.0
    side_axles_deg: float = 0.0
    side_deg: tuple[float, float, float] = (-45.0, -48.0, -51.0)
    side_heights: tuple[float, float, float] = (0.0265, 0.0255, 0.0240)
    hook_at: float = 0.012
    side_place: str = "pad_proximal"
    front: float = 0.0119
    high_f_sharp: float = -0.0030
    far: float = 0.0601
    flat: float = 0.0062
    steps: tuple[int, int, int] = (5, 3, 6)


def coarse(line: Array, radii: Array, sides: int, step: int) -> Shape:
    """A bent tube with few collision bodies, from every so many points of its line."""
    kept = np.unique([*range(0, len(line), step), len(line) - 1])
    return bodied(tube(line, radii, sides=sides, proxy=False), *tube(line[kept], radii[kept], sides=3).proxies)


class Saxophone:
    """A saxophone under work."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.work = Keywork(metal=BRASS, hover_m=0.008)
        self.down, self.front = self.directions()
        self.neck_points = self.neck_corners()
        self.body = Wall(self.neck_points[-1], self.down, self.front, layout.body)
        self.end = layout.body[-1][0]
        self.left_share, self.right_share = layout.left_share, self.share(layout.right, ALTO.right)

    def directions(self) -> tuple[Array, Array]:
        """Return the direction of the body, from the neck down, and the direction of its front."""
        right, back = np.radians([self.layout.right_deg, self.layout.back_deg])
        down = unit((-np.sin(right), -np.cos(right) * np.cos(back), -np.cos(right) * np.sin(back)))
        return down, unit(Z - down * (Z @ down))

    def neck_corners(self) -> list[Array]:
        """Corners of the neck after the mouthpiece; the last is the body's upper end."""
        *inner, (_, last) = self.layout.neck
        points = [np.array([0.0, self.layout.reed.axis_y + above, ahead]) for ahead, above in inner]
        return [*points, points[-1] + (inner[-1][1] - last) * self.down]

    # Places

    def share(self, along: float, of_alto: float) -> float:
        """Return the angle that a hand reaches around this body, as a share of the angle around the alto's."""
        alto = float(np.interp(of_alto, *np.transpose(ALTO.body)))
        return (alto + FINGER_M) / (self.body.radius(along) + FINGER_M)

    def hole(self, name: str) -> float:
        return self.layout.holes_from + HOLES[name][0] * self.layout.holes

    def cup(self, name: str, angle: float) -> Cup:
        return Cup(
            self.body, self.hole(name), angle, HOLES[name][1] * self.layout.cups, rim_m=0.0030, thick_m=0.0038,
            rim_material=BRASS, material=BRASS,
        )  # fmt: skip

    def rod(self, start: float, end: float, angle: float, height: float = 0.0, wall: Wall | None = None) -> Rod:
        """A rod along the body (or the bell) on plain posts: there are some sixty of them."""
        wall, height = wall or self.body, height or self.layout.rod
        found = replace(wall.rod(min(start, end), max(start, end), angle, height), posts=False)
        for top in (found.a, found.b):
            out = unit(top - wall.point(wall.place(top)[0], angle, -wall.radius(wall.place(top)[0])))
            profile = [(-height - 0.0008, 0.0016), (-0.0014, 0.0013), (0.0, 0.0023), (0.0020, 0.0)]
            shape = turned(top, out, profile, sides=6, proxy=False, hard_deg=80.0)
            low = height < self.layout.low_posts
            bodies = [] if low else [cylinder(top - height * out, top + 0.0018 * out, POST_M)]
            self.work.model.add(BRASS, bodied(shape, *bodies))
        return found

    def plate(self, along: float, angle: float, height: float, length: float, width: float) -> Touch:
        """A touch plate over the body, ``length`` along it."""
        return self.body.spatula(along, angle, height, oval(length, width), 0.0020, material=BRASS, foot=0.0)

    # Parts

    def make(self) -> Keywork:
        """The whole instrument."""
        self.tubes()
        self.left_stack()
        self.left_thumb()
        self.palm_keys()
        self.left_cluster()
        self.right_stack()
        self.side_keys()
        self.right_little()
        self.low_cups()
        self.fittings()
        self.without_thin()
        return self.work

    def without_thin(self) -> None:
        """Posts and rims under rods and cups, and arms far from every finger, need no collision bodies of their own."""
        places = np.array([row["point"] for row in self.work.contacts])
        self.without(lambda body, node: self.is_thin(body, node, places))

    def without(self, needless: Callable[[dict[str, object], str], bool]) -> None:
        """Drop the collision bodies that a function, asked in their order for a body and its node, calls needless."""
        parts = self.work.model.parts
        for index, part in enumerate(parts):
            kept = [body for body in part.shape.proxies if not needless(body, part.node)]
            parts[index] = replace(part, shape=bodied(part.shape, *kept))

    def is_thin(self, body: dict[str, object], node: str, places: Array) -> bool:
        """Return whether a collision body is a post's, an arm's or a tone hole's rim that no hand comes near."""
        if body["shape"] not in ("cylinder", "capsule"):
            return False
        ends = np.array([body["a_m"], body["b_m"]])
        if node in self.layout.whole:
            return False
        flat = node == "root" and np.linalg.norm(ends[1] - ends[0]) < self.layout.flat
        if np.asarray(body["radius_m"]) > THIN_M and not flat:
            return False
        steps = ends[0] + np.linspace(0, 1, 9)[:, None] * (ends[1] - ends[0])
        far = np.linalg.norm(steps[:, None] - places[None], axis=2).min() > self.layout.far
        return bool(far)

    def tubes(self) -> None:
        """Mouthpiece, neck, body, bow and bell."""
        work, layout, body = self.work, self.layout, self.body
        line = self.neck_line(self.mouthpiece(layout.neck_radius[0], 0.016))
        run = lengths(line) / lengths(line)[-1]
        thin, wide = layout.neck_radius
        self.neck = line
        work.model.add(BRASS, coarse(line, thin + (wide - thin) * run, 20, layout.steps[0]))
        collar = [(0, 0.8 * thin), (0, 1.12 * thin + 0.0004), (0.004, 1.12 * thin + 0.0004), (0.004, 0.8 * thin)]
        work.model.add(BRASS, turned(line[3], line[4] - line[3], collar, sides=24, proxy=False))
        place, top = self.socket
        receiver = [(-0.016, 0), (-0.016, wide), (-0.014, wide + 0.0016), (-0.003, wide + 0.0016)]
        receiver += [(-0.003, wide + 0.0026), (0.016, top + 0.0022), (0.016, top + 0.0004)]
        work.model.add(BRASS, turned(place, self.down, receiver, sides=28))
        screw = place + 0.006 * self.down + (top + 0.001) * body.normal(150.0)
        work.model.add(BRASS, tube([screw, screw + 0.014 * body.normal(150.0)], 0.0016, sides=8, proxy=False))
        knob = screw + 0.014 * body.normal(150.0)
        work.model.add(BRASS, solid(knob, body.normal(150.0), [(0, 0.0042), (0.004, 0.0042)],
                                     sides=12, proxy=False))  # fmt: skip
        work.model.add(BRASS, body.skin(28))
        self.bow_and_bell()

    def mouthpiece(self, radius: float, cork_m: float) -> Array:
        """Mouthpiece and cork on a tube so thick; where the mouthpiece ends.

        The beak gets a body before the lips, which its box leaves out.
        """
        reed, parts = self.layout.reed, self.work.model.parts
        self.work.add(reed.pieces())
        low, high = 0.008, reed.beak_length - reed.tip_m
        axis = reed.axis_y * Y
        cone = {"shape": "cone", "a_m": axis + low * Z, "b_m": axis + high * Z, "radius_a_m": 0.8 * reed.radius,
                "radius_b_m": reed.radius}  # fmt: skip
        index = next(index for index, part in enumerate(parts) if part.shape.proxies)
        part = parts[index]
        parts[index] = replace(part, shape=bodied(part.shape, *part.shape.proxies, cone))
        start = np.array([0.0, reed.axis_y, reed.end_z])
        cork = [(0, radius + 0.0012), (cork_m, radius + 0.0012)]
        self.work.model.add("cork", solid(start - 0.001 * Z, Z, cork, sides=24, proxy=False))
        return start

    def neck_line(self, start: Array) -> Array:
        """The centre line from the mouthpiece into the socket."""
        corners = [start + 0.010 * Z, *self.neck_points[:-1], self.socket[0] + 0.004 * self.down]
        straight = start + np.linspace(0.0, 0.010, 5)[:, None] * Z
        return joined(straight, bend(corners, list(self.layout.bends), 0.006))

    @property
    def socket(self) -> tuple[Array, float]:
        """Return the place at which the neck is put in, and the tube's radius there (m)."""
        return np.asarray(self.body.start), self.body.radius(0.0)

    def bow_and_bell(self) -> None:
        """The bow under the body and the bell before it."""
        work, layout, body = self.work, self.layout, self.body
        ahead = body.normal(layout.bell_deg)
        end = np.asarray(body.start) + self.end * self.down
        r = body.radius(self.end)
        bow = half_circle(end, end + layout.bow_m * ahead, self.down, 14)
        share = np.linspace(0, 1, len(bow))
        work.model.add(BRASS, coarse(bow, r + 0.0004 + (layout.bell_throat - r) * share, 30, layout.steps[1]))
        up = unit(-self.down + layout.bell_lean * ahead)
        self.bell = Wall(bow[-1], up, unit(ahead - up * (ahead @ up)), self.bell_profile())
        for place, low, wide in ((end, -0.009, r), (bow[-1], -0.006, layout.bell_throat)):
            ring = [(low, wide - 0.002), (low, wide + 0.0013), (low + 0.001, wide + 0.0019)]
            ring += [(low + 0.013, wide + 0.0019), (low + 0.014, wide + 0.0013), (low + 0.014, wide - 0.002)]
            axis = self.down if place is end else up
            work.model.add(BRASS, turned(place, axis, ring, sides=36, proxy=False))
        self.add_bell(bow[-1], up)

    def bell_profile(self) -> list[tuple[float, float]]:
        layout = self.layout
        share = np.linspace(0, 1, 22)
        flare = 0.27 * share + 0.18 * share**3 + 0.55 * share**9
        radii = layout.bell_throat + (layout.bell_rim - layout.bell_throat) * flare
        return [(float(a * layout.bell_length), float(b)) for a, b in zip(share, radii, strict=True)]

    def add_bell(self, start: Array, up: Array) -> None:
        """The bell's skin, its rolled rim and the dark of its throat."""
        profile = self.bell_profile()
        length, rim = profile[-1]
        work, layout = self.work, self.layout
        work.model.add(BRASS, turned(start, up, [(0.0, 0.0), *profile], sides=layout.bell_sides))
        inside = [(along, radius - 0.0008) for along, radius in [*profile[:8:-1], *profile[8:0:-4]]] + [(0.0, 0.0)]
        work.model.add(BRASS, turned(start, up, inside, sides=30, proxy=False))
        work.model.add("inner_brass", turned(start, up, [(0.10 * length, profile[2][1] - 0.0012), (0.10 * length, 0.0)],
                                             sides=32, proxy=False))  # fmt: skip
        work.model.add(BRASS, torus(start + (length + 0.0004) * up, up, rim, 0.0017, sides=6, around=40))

    def left_stack(self) -> None:
        """Pearls of the left hand with the cups under them, bis and front F."""
        work, layout, angle = self.work, self.layout, self.layout.left_deg
        first, second, _ = layout.pitch
        places = {"1L": layout.left, "2L": layout.left + first, "3L": layout.left + first + second}
        axle = angle - 58.0
        for name, finger in (("1L", "index"), ("2L", "middle"), ("3L", "ring")):
            self.stack_key(f"key_{name}", name, f"left.{finger}.pad", places[name], angle, self.cup(name, angle), axle)
        work.linked("pad_C", ("key_1L", "key_2L"), self.rod(self.hole("c") - 0.010, self.hole("c") + 0.011, axle),
                    cups=[self.cup("c", angle)], drop_m=0.0045)  # fmt: skip
        self.bis(places["1L"], places["2L"], angle, axle)
        self.front_f(places["1L"], angle)

    def stack_key(
        self, name: str, label: str, part: str, along: float, angle: float, cup: Cup, axle: float,
        travel: float = 0.0048,
    ) -> None:  # fmt: skip
        """A stack key: a pearl for the finger, on an arm of the rod that also carries the cup."""
        near = abs(along - cup.along) < 0.004 and abs(angle - cup.angle_deg) < 2.0
        height = cup.rim_m + travel + cup.thick_m + 0.0034
        touch = pearl(self.body.point(along, angle, height), self.body.normal(angle), 0.0078, material=BRASS)
        rod = self.rod(min(along, cup.along) - 0.013, max(along, cup.along) + 0.013, axle)
        self.work.key(name, label, part, rod, touch, [cup], travel_m=travel, touch_arm=not near)

    def bis(self, first: float, second: float, angle: float, axle: float) -> None:
        """The small pearl between the first and the second finger; the first rolls onto it."""
        work = self.work
        along = first + 0.0162
        height = 0.0030 + 0.0048 + 0.0038 + 0.0018
        touch = pearl(self.body.point(along, angle + 2.0, height), self.body.normal(angle), 0.0048, material=BRASS)
        rod = self.rod(along - 0.004, along + 0.009, axle - 9.0, 0.0090)
        work.key("key_bis", "bbb", "left.index.pad", rod, touch, travel_m=0.0045)
        hole = self.hole("bbb")
        work.linked("pad_bis", ("key_bis", "key_2L", "key_1R"), self.rod(hole - 0.007, hole + 0.008, angle + 52.0),
                    cups=[self.cup("bbb", angle + 6.0)], drop_m=0.0042)  # fmt: skip
        both = self.body.point(first + 0.0060, angle, self._pearl_height)
        work.also("left.index.pad", "key_1L", ("key_bis",), point=both, normal=self.body.normal(angle))

    @property
    def _pearl_height(self) -> float:
        """Return the height above the body at which a finger touches a pearl of the left hand, m."""
        return 0.0030 + 0.0048 + 0.0038 + 0.0034 - 0.0002

    def front_f(self, first: float, angle: float) -> None:
        """The small key above the first finger."""
        work = self.work
        along = first - self.layout.front
        touch = self.plate(along, angle + 8.0, 0.0166, 0.0074, 0.0120)
        work.key("key_front_F", "ff", "left.index.pad", self.rod(along - 0.006, along + 0.006, angle + 40.0, 0.0090),
                 touch, travel_m=0.0040)  # fmt: skip

    def left_thumb(self) -> None:
        """The thumb's rest, the octave key above it, of the baritone the key of low A below."""
        work, body, layout = self.work, self.body, self.layout
        along, angle = layout.left + 0.008, layout.left_deg + layout.thumb_deg * self.left_share
        out = body.normal(angle)
        rest = [(-0.002, 0.0076), (0.0040, 0.0076), (0.0055, 0.0068), (0.0060, 0.0046)]
        button = solid(body.point(along, angle), out, rest, sides=24)
        work.model.add("dark_plastic", button)
        work.contact("left.thumb.pad", body.point(along, angle, 0.0060), out)
        touch = self.plate(along - 0.0104, angle - 11.0, 0.0075, 0.0075, 0.0150)
        rod = self.body.cross_rod(along - 0.042, angle - 11.0, 0.012, 0.0060)
        work.key("key_octave", "oct", "left.thumb.pad", rod, touch, travel_m=0.0040)
        self.neck_octave()
        if layout.low_a:
            low = self.plate(along + 0.0200, angle, 0.0075, 0.0130, 0.0140)
            work.key("key_low_A", "la", "left.thumb.pad", body.cross_rod(along + 0.042, angle, 0.012, 0.0060), low,
                     travel_m=0.0040)  # fmt: skip

    def neck_octave(self) -> None:
        """The pip on the neck and the lever that lies on it, a ring around the receiver at its end."""
        work, line = self.work, self.neck
        run = lengths(line)
        radius = self.layout.neck_radius[0] + (self.layout.neck_radius[1] - self.layout.neck_radius[0]) * run / run[-1]
        first, last = int(np.searchsorted(run, 0.30 * run[-1])), int(np.searchsorted(run, 0.93 * run[-1]))
        steps = np.gradient(line, axis=0)
        out = np.array([unit(np.cross(unit(step), X)) for step in steps])
        place, normal = line[first], out[first]
        pip = [(0, 0.0036), (radius[first] + 0.0030, 0.0030), (radius[first] + 0.0032, 0)]
        work.model.add(BRASS, turned(place, normal, pip, sides=12, proxy=False))
        wall = Wall(line[first], unit(line[last] - line[first]), normal, [(0.0, radius[first]), (1.0, radius[first])])
        middle = int(np.searchsorted(run, 0.62 * run[-1]))
        saddle = line[middle] + (radius[middle] + 0.0040) * out[middle]
        side = 0.006 * X
        rod = Rod(wall, saddle - side, saddle + side, posts=False)
        lever = line[first : last + 1] + (radius[first : last + 1] + 0.0050)[:, None] * out[first : last + 1]
        node = "octave_neck"
        work.model.node(node, saddle)
        strap = tube(lever, 0.0021, sides=8, flat=(0.7, 1.5), side=out[first], proxy=False)
        body = list(tube(lever[:: self.layout.steps[2]], 0.0021, sides=3).proxies)
        pad = [(-0.0018, 0.0046), (0.0012, 0.0046), (0.0022, 0.0030)]
        ring_radius = radius[last] + 0.0060
        ring = torus(line[last], unit(steps[last]), ring_radius, 0.0015, sides=6, around=28)
        work.add([
            (BRASS, bodied(strap, *body)),
            (BRASS, solid(place + (radius[first] + 0.0050) * normal, normal, pad, sides=16, proxy=False)),
            (BRASS, ring),
            (BRASS, tube([rod.a, rod.b], 0.0019, sides=8, proxy=False)),
        ], node)  # fmt: skip
        foot = line[middle] + 0.9 * radius[middle] * out[middle]
        for end in (rod.a, rod.b):
            work.model.add(BRASS, tube([foot + (end - saddle), end], 0.0018, sides=8, proxy=False))
        motion = {"axis": X, "angle_rad": 0.055, "pivot_m": saddle}
        work.links.append({"node": node, "motion": motion, "controls": ["key_octave"], "when": "any"})

    def palm_keys(self) -> None:
        """The keys of D, E flat and F, which the root of the left index works, and combinations of them."""
        work, layout = self.work, self.layout
        first = layout.left
        part = "left.index.pad_proximal"
        angle = layout.left_deg + 72.0 * self.left_share
        length = min(0.0060, round(layout.palm[1] - layout.palm[2] - 0.0004, 4))
        for name, label, along, axle, cup_angle in (
            ("key_palm_D", "pd", first + layout.palm[0], 86.0, 112.0),
            ("key_palm_E_flat", "peb", first + layout.palm[1], 92.0, 118.0),
            ("key_palm_F", "pf", first + layout.palm[2], 98.0, 124.0),
        ):
            touch = self.plate(along, angle, 0.0240, length, 0.0140)
            rod = self.rod(along + 0.004, self.hole(label) - 0.008, axle, 0.0095)
            work.key(name, label, part, rod, touch, [self.cup(label, cup_angle)], travel_m=0.0030, clear_m=0.004)
        work.also(part, "key_palm_E_flat", ("key_palm_D",))
        work.also(part, "key_palm_F", ("key_palm_D", "key_palm_E_flat"))

    def left_cluster(self) -> None:
        """The table of the left little finger: G sharp, C sharp, B and B flat."""
        work, layout = self.work, self.layout
        third = layout.left + layout.pitch[0] + layout.pitch[1]
        part = "left.little.pad"
        for name, label, along, angle, length, width, axle, end in (
            ("key_G_sharp", "gs", 0.0105, 54.0, 0.0085, 0.0220, 88.0, 0.0),
            ("key_C_sharp", "cs", 0.0182, 47.0, 0.0080, 0.0105, 90.0, 1.0),
            ("key_B", "lb", 0.0182, 62.0, 0.0080, 0.0105, 98.0, 1.0),
            ("key_B_flat", "lbb", 0.0242, 54.0, 0.0072, 0.0220, 106.0, 1.0),
        ):
            place = third + along + layout.cluster[0]
            turned_deg = layout.left_deg + angle * self.left_share
            touch = self.plate(place, turned_deg, layout.cluster[1], length, width)
            stop = place + 0.010 if not end else self.end - 0.012 * (1 + (axle - 90) / 8)
            work.key(name, label, part, self.rod(place - 0.006, stop, axle), touch, travel_m=0.0045)
        gs = self.cup("gs", layout.left_deg + 2.0)
        work.linked("pad_G_sharp", ("key_G_sharp",), self.rod(gs.along - 0.012, gs.along + 0.012, 52.0, 0.0062),
                    cups=[gs], drop_m=-0.0045)  # fmt: skip

    def right_stack(self) -> None:
        """Pearls of the right hand beside their cups, F sharp and its fork."""
        work, layout, body = self.work, self.layout, self.body
        angle, pearls = layout.right_stack_deg, layout.right_pearl_deg
        names = ("key_1R", "key_2R", "key_3R")
        f_sharp = self.cup("f_sharp", angle)
        for number, (label, finger) in enumerate((("1R", "index"), ("2R", "middle"), ("3R", "ring"))):
            along = layout.right + number * layout.pitch[2]
            self.stack_key(f"key_{label}", label, f"right.{finger}.pad", along, pearls, self.cup(label, angle),
                           angle + 52.0, 0.0055)  # fmt: skip
        work.linked("pad_F_sharp", names, self.rod(f_sharp.along - 0.014, f_sharp.along + 0.014, angle + 52.0),
                    cups=[f_sharp], drop_m=0.0048)  # fmt: skip
        last = layout.right + 2 * layout.pitch[2]
        touch = self.plate(last - 0.0160, pearls - 15.0 * self.right_share, 0.0140, 0.0110, 0.0070)
        fork = self.cup("afs", pearls - 62.0)
        fork = replace(fork, along=fork.along - layout.fork)
        rod = self.rod(last - 0.010, fork.along - 0.008, pearls - 42.0, layout.rod + 0.0005)
        work.key("key_fork_F_sharp", "afs", "right.ring.pad", rod, touch, [fork], travel_m=0.0040)
        touch = self.plate(last + layout.high_f_sharp, pearls - 29.0 * self.right_share, 0.0160, 0.0130, 0.0075)
        high = self.cup("hfs", -112.0)
        rod = self.rod(last + 0.004, high.along - 0.008, pearls - 56.0, 0.0125)
        work.key("key_high_F_sharp", "hfs", "right.ring.pad", rod, touch, [high], travel_m=0.0040)
        hook_at = layout.right + layout.hook_at
        hook = thumb_rest(
            body, hook_at, pearls + 360.0 - layout.hook_deg, reach=layout.hook_reach, width=0.017, metal=BRASS
        )
        work.add(hook.pieces)
        work.contact("right.thumb.side", hook.point, hook.normal)

    def side_keys(self) -> None:
        """The keys at the right side: high E, C and B flat."""
        work, layout = self.work, self.layout
        pearls = layout.right_pearl_deg
        for name, label, along, angle, axle, cup_angle, height in (
            ("key_side_B_flat", "sbb", layout.side[0], layout.side_deg[0], -90.0, -114.0, layout.side_heights[0]),
            ("key_side_C", "sc", layout.side[1], layout.side_deg[1], -96.0, -120.0, layout.side_heights[1]),
            ("key_side_E", "se", layout.side[2], layout.side_deg[2], -103.0, -127.0, layout.side_heights[2]),
        ):
            place = layout.right + along
            length = min(0.0056, round(layout.side[1] - layout.side[2] - 0.0004, 4))
            touch = self.plate(place, pearls + angle * self.right_share, height, length, 0.0115)
            cup = self.cup(label, cup_angle - layout.side_cups_deg)
            rod = self.rod(place + 0.004, cup.along - 0.009, axle - layout.side_axles_deg, 0.0085)
            work.key(name, label, f"right.index.{layout.side_place}", rod, touch, [cup], travel_m=0.0035)

    def right_little(self) -> None:
        """E flat and C of the right little finger, with rollers between."""
        work, layout, body = self.work, self.layout, self.body
        pearls = layout.right_pearl_deg
        last = layout.right + 2 * layout.pitch[2]
        eb = self.cup("leb", pearls - 62.0)
        at, aside, height = layout.little
        above, below = last + at, last + at + 0.0095
        angle = pearls + aside * self.right_share
        bar = [
            roller(*(body.point(last + at, angle + end, height - 0.0010) for end in (-11.0, 11.0)), 0.0020,
                   material=BRASS)
            for at in (at + 0.0037, at + 0.0057)
        ]  # fmt: skip
        touch = with_pieces(self.plate(above, angle, height, 0.0075, 0.0190), bar[0])
        rod = self.rod(above - 0.007, eb.along + 0.012, pearls - 38.0, 0.0085)
        work.key("key_E_flat", "leb", "right.little.pad", rod, touch, [eb], travel_m=0.0045)
        touch = with_pieces(self.plate(below, angle, height, 0.0080, 0.0190), bar[1])
        rod = self.rod(below - 0.004, self.end + 0.013, pearls - 62.0, 0.0085)
        work.key("key_C", "lc", "right.little.pad", rod, touch, travel_m=0.0045)

    def low_cups(self) -> None:
        """C and C sharp on the bow, B and B flat on the bell, with their guards."""
        work, layout, body = self.work, self.layout, self.body
        ahead = body.normal(layout.bell_deg)
        right = unit(np.cross(ahead, -self.down))
        end = np.asarray(body.start) + self.end * self.down
        low = end + layout.bow_m / 2 * (ahead + self.down)
        r = (body.radius(self.end) + layout.bell_throat) / 2
        bow = Wall(low - 0.05 * ahead, ahead, right, [(0.0, r), (0.1, r)])
        scale = layout.cups
        c = replace(self.cup("leb", 0.0), wall=bow, along=0.050, radius=0.0180 * scale, angle_deg=12.0)
        rod = self.rod(0.024, 0.076, 62.0, 0.0085, bow)
        work.linked("pad_low_C", ("key_C",), rod, cups=[c], drop_m=0.0060)
        sharp = replace(c, along=0.052, radius=0.0160 * scale, angle_deg=186.0)
        work.linked(
            "pad_C_sharp", ("key_C_sharp",), self.rod(0.028, 0.074, 240.0, 0.0085, bow), cups=[sharp], drop_m=-0.0055
        )
        self.guard(c)
        self.guard(sharp)
        (b, b_radius), (b_flat, b_flat_radius) = layout.bell_cups
        low_a = [("pad_low_A", ("key_low_A",), 2 * b_flat - b, b_flat_radius * 1.04, 0.03)] if layout.low_a else []
        for node, controls, along, radius, half in (
            ("pad_B", ("key_B", "key_B_flat"), b, b_radius, b_radius),
            ("pad_B_flat", ("key_B_flat",), b_flat, b_flat_radius, b_flat_radius),
            *low_a,
        ):
            cup = replace(c, wall=self.bell, along=along, radius=radius, angle_deg=100.0, rim_m=0.0045)
            rod = self.rod(along - half, along + half, 168.0, 0.0085, self.bell)
            work.linked(node, controls, rod, cups=[cup], drop_m=0.0065)
            self.guard(cup)

    def guard(self, cup: Cup) -> None:
        """The wire guard over a low cup, on three feet, with its felt bumper."""
        up = cup.normal
        across = unit(cup.wall.axis)
        over = np.cross(up, across)
        top = cup.seat + (0.0062 + cup.thick_m + 0.0028) * up
        reach = 1.06 * cup.radius + 0.0015
        wires = []
        self.work.model.add(BRASS, torus(top, up, reach, 0.0013, sides=5, around=20))
        for turn in (0.5, 0.5 + 2.094, 0.5 + 4.189):
            place = top + reach * (np.cos(turn) * across + np.sin(turn) * over)
            along, angle, _ = cup.wall.place(place)
            foot = cup.wall.point(along, angle, -0.001)
            knee = foot + 0.75 * (top - cup.seat + cup.rim_m * up)
            wires.append(np.array([foot, 0.5 * (foot + knee) + 0.002 * unit(place - top), place]))
        feet = [bodied(tube(wire, 0.0013, sides=5, proxy=False), *tube(wire[::2], 0.0013).proxies) for wire in wires]
        self.work.model.add(BRASS, *feet)
        cross = np.array([top - reach * over, top, top + reach * over])
        self.work.model.add(BRASS, tube(cross, 0.0015, sides=6))
        self.work.model.add("felt", solid(top, -up, [(0.0, 0.0045), (0.0024, 0.0045)], sides=12))

    def fittings(self) -> None:
        """The ring of the strap and the brace to the bell."""
        work, layout, body = self.work, self.layout, self.body
        self.strap_ring()
        height = self.end - (0.80 if layout.bell_length < 0.3 else 0.70) * layout.bell_length
        start = body.point(height, layout.bell_deg)
        offset = float((start - np.asarray(self.bell.start)) @ unit(self.bell.axis))
        stop = self.bell.point(offset, 180.0)
        work.model.add(BRASS, tube([start, stop], 0.0030, sides=10))
        middle = (start + stop) / 2
        brace = torus(middle, body.around(layout.bell_deg), 0.011, 0.0022, sides=8, around=28)
        work.model.add(BRASS, brace)

    def strap_ring(self) -> None:
        """The ring on the back that a strap hooks into."""
        work, layout, body = self.work, self.layout, self.body
        along = 0.60 * (layout.left + layout.right)
        plate = body.point(along, 180.0, 0.0006)
        out = body.normal(180.0)
        wide = min(0.008, 0.45 * body.radius(along))  # flat on a slim body's round
        disc = [(-0.001, wide), (0.0008, wide - 0.001)]
        work.model.add(BRASS, solid(plate, out, disc, sides=16, proxy=False))
        work.model.add(BRASS, torus(plate + 0.0085 * out, body.around(180.0), 0.0075, 0.0016, sides=8, around=24))


class Baritone(Saxophone):
    """Builds the baritone: the tube goes down from the neck, up again and over into the body (the loop)."""

    BACK, LEFT = 0.074, 0.058
    """The tube that comes from the neck lies behind the body, the one that goes up again to the left of both."""
    FALL, RISE = 0.150, 0.160

    def neck_corners(self) -> list[Array]:
        """The neck's corner, then the receiver of the neck, behind the body's upper end."""
        layout = self.layout
        corner = np.array([0.0, layout.reed.axis_y + layout.neck[0][1], layout.neck[0][0]])
        receiver = corner + (layout.neck[0][1] - layout.neck[1][1]) * self.down
        self.receiver = receiver
        return [corner, receiver + self.BACK * self.front + 0.020 * self.down]

    @property
    def socket(self) -> tuple[Array, float]:
        """Return the place at which the neck is put in, and the radius of the tube that takes it (m)."""
        return self.receiver, self.layout.neck_radius[1] + 0.0010

    def tubes(self) -> None:
        """Tubes of the others, with the loop between neck and body."""
        super().tubes()
        down, top = self.down, np.asarray(self.body.start)
        left = self.body.normal(90.0)
        side = top - 0.5 * self.BACK * self.front + self.LEFT * left
        low = self.receiver + self.FALL * down
        rising = side + (low - side) @ down * down
        under = half_circle(low, rising, down, 10)
        over = half_circle(side - 0.004 * down, top - 0.004 * down, -down, 10)
        line = joined(self.receiver, under, over, top + 0.004 * down)
        run = lengths(line) / lengths(line)[-1]
        r0, r1 = self.socket[1], self.body.radius(0.0)
        radii = r0 + (r1 - r0) * run
        self.work.model.add(BRASS, coarse(line, radii, 18, 2))
        for place, way in ((low, down), (rising, down), (side, -down), (top, -down)):
            r = float(radii[np.linalg.norm(line - place, axis=1).argmin()]) + 0.0008
            ring = [(-0.012, r - 0.004), (-0.012, r), (0.002, r + 0.0004), (0.002, r - 0.004)]
            self.work.model.add(BRASS, turned(place, way, ring, sides=24, proxy=False))


class Soprano(Saxophone):
    """Builds the straight soprano: neck, body and bell in one line with the mouthpiece."""

    def directions(self) -> tuple[Array, Array]:
        """Along the mouthpiece; the pearls on top."""
        return Z, Y

    def neck_corners(self) -> list[Array]:
        """The upper end, in the mouthpiece."""
        reed = self.layout.reed
        return [np.array([0.0, reed.axis_y, reed.end_z + 0.008])]

    def tubes(self) -> None:
        """Mouthpiece, cork, the straight body and its bell."""
        work, body = self.work, self.body
        self.mouthpiece(body.radius(0.0), 0.014)
        work.model.add(BRASS, body.skin(28))
        for along in (0.040, 0.046, self.end - 0.006):
            work.model.add(BRASS, body.collar(along, 0.005))
        up = self.down
        self.bell = Wall(
            body.point(self.end, 0.0) - body.radius(self.end) * self.front, up, self.front, self.bell_profile()
        )
        self.add_bell(np.asarray(self.bell.start), up)

    def neck_octave(self) -> None:
        """The octave key's cup on the upper end."""
        cup = Cup(self.body, 0.026, 0.0, 0.0050, rim_m=0.0028, thick_m=0.0030, rim_material=BRASS, material=BRASS)
        rod = self.body.cross_rod(0.062, 0.0, 0.010, 0.0060)
        self.work.linked("octave_neck", ("key_octave",), rod, cups=[cup], drop_m=-0.0022)

    def low_cups(self) -> None:
        """C, C sharp, B and B flat on the body's lower end, with their guards."""
        work = self.work
        for node, control, along, angle, radius, axle, drop in (
            ("pad_low_C", ("key_C",), 0.443, -40.0, 0.0145, -92.0, 0.0045),
            ("pad_C_sharp", ("key_C_sharp",), 0.447, 62.0, 0.0125, 112.0, -0.0042),
            ("pad_B", ("key_B", "key_B_flat"), 0.484, 52.0, 0.0155, 104.0, 0.0048),
            ("pad_B_flat", ("key_B_flat",), 0.514, 24.0, 0.0160, 76.0, 0.0048),
        ):
            cup = Cup(self.body, along, angle, radius, rim_m=0.0034, thick_m=0.0038, rim_material=BRASS, material=BRASS)
            work.linked(node, control, self.rod(along - radius, along + radius, axle), cups=[cup], drop_m=drop)
            self.guard(cup)

    def fittings(self) -> None:
        """The ring of a strap."""
        self.strap_ring()

    def without_thin(self) -> None:
        """Nor do posts that stand beside another in the little room, and the rim that hardly stands out of its bell."""
        super().without_thin()
        posts: list[Array] = []

        def needless(body: dict[str, object], node: str) -> bool:
            if body["shape"] == "cylinder" and node == "root" and body["radius_m"] == POST_M:
                middle = np.mean([body["a_m"], body["b_m"]], axis=0)
                if any(np.linalg.norm(post - middle) < POST_M for post in posts):
                    return True
                posts.append(middle)
            return body["shape"] == "ring" and body["radius_m"] == self.layout.bell_rim

        self.without(needless)


ALTO = Layout()
TENOR = Layout(
    reed=TENOR_REED, neck=((0.150, 0.010), (0.262, 0.050), (0.270, -0.062)), bends=(0.090, 0.052),
    neck_radius=(0.0092, 0.0142), right_deg=15.0, back_deg=7.0, body=((0.0, 0.0148), (0.590, 0.0315)),
    holes=1.30, cups=1.20, left=0.198, right=0.392, hook_deg=138.0, right_stack_deg=6.0, side=(0.0195, 0.0142,
    0.0089), far=0.066, steps=(4, 2, 3), pitch=(0.038, 0.036, 0.033), bow_m=0.122, bell_length=0.312,
    bell_throat=0.0395, bell_rim=0.0765, bell_sides=56, bell_cups=((0.062, 0.0245), (0.132, 0.0255)),
)  # fmt: skip
BARITONE = Layout(
    reed=BARITONE_REED, neck=((0.205, 0.004), (0.215, -0.090)), bends=(0.070,), neck_radius=(0.0100, 0.0155),
    right_deg=15.0, back_deg=7.0, body=((0.0, 0.0190), (0.580, 0.0270), (0.800, 0.0420)), holes=1.76, cups=1.30,
    left=0.245, right=0.445, left_share=0.90, hook_deg=137.0, thumb_deg=170.0, cluster=(-0.0012, 0.0148), fork=0.085,
    palm=(0.0128, 0.0070, 0.0014), right_stack_deg=12.0, side=(0.0195, 0.0142, 0.0089),
    pitch=(0.037, 0.035, 0.033), bow_m=0.166, bell_length=0.500, bell_throat=0.0540, bell_rim=0.0900, bell_sides=40,
    bell_cups=((0.085, 0.0300), (0.185, 0.0310)), low_a=True, bell_lean=0.045, steps=(6, 2, 6),
    hook_reach=0.0223, rod=0.0064, low_posts=0.0080, whole=("pad_C_sharp", "pad_B", "pad_B_flat", "pad_low_A"),
)  # fmt: skip

SOPRANO = Layout(
    reed=SOPRANO_REED, body=((0.0, 0.0068), (0.040, 0.0080), (0.545, 0.0212)), holes=0.667, holes_from=0.118, cups=0.80,
    left=0.212, right=0.336, pitch=(0.033, 0.031, 0.031), bell_length=0.052, bell_throat=0.0216, bell_rim=0.0455,
    left_share=1.145, little=(0.0130, -22.5, 0.0162), hook_reach=0.0320, hook_at=0.0075,
    side=(0.0182, 0.0128, 0.0071), side_deg=(-20.0, -20.0, -20.0), side_heights=(0.0240, 0.0240, 0.0250),
    side_place="pad_middle", front=0.0105, side_cups_deg=48.0,
    side_axles_deg=28.0, low_posts=0.0070,
)  # fmt: skip

INSTRUMENTS = {
    "sax_alto_Eb": entry(lambda: Saxophone(ALTO).make()),
    "sax_soprano_Bb": entry(lambda: Soprano(SOPRANO).make()),
    "sax_tenor_Bb": entry(lambda: Saxophone(TENOR).make()),
    "sax_baritone_Eb": entry(lambda: Baritone(BARITONE).make()),
}
