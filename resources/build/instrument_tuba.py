"""Euphonium, baritone, tubas: upright instruments held before the body.

Sizes are those of common instruments. Euphonium: height 680 mm, bell 300 mm, valves 34 mm apart with a way of 18 mm,
the fourth at the side for the left hand. Baritone: bell 240 mm, a narrower bore. Tubas: B flat height 920 mm, bell
430 mm; valves 32 mm apart with a way of 17 mm, the fourth of a row nearer to the player for the little finger; E flat
860 mm, bell 410 mm, three valves 35 mm apart with a way of 18 mm and the fourth at the side.

Instruments with valves on top carry their bell on the player's right: the row of valves goes to the right, off the
player, and the fingers of the right hand lie on it from behind. An instrument is drawn in a frame with the axes "from
the outer branch to the bell", "up along the bell" and "to the front"; the outer branch is at 0, before the breastbone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from resources.build.instrument_brass import (
    BRASS,
    NICKEL,
    Bell,
    Frame,
    Piston,
    Z,
    arc,
    bell,
    branch,
    contact,
    ferrule,
    loop,
    mouthpiece,
    on_round,
    receiver,
    stay,
    tapered,
)
from resources.build.instrument_mesh import Model, bend, joined, torus, tube, unit


@dataclass(frozen=True)
class Layout:
    """Places of the parts of one instrument, metres.

    Attributes
    ----------
    middle : where the outer branch stands, from the lips in the player's frame, at their height
    ahead_deg : how far ahead of the player's right the bell is
    lean_deg : how far the bell leans away from the branch
    bottom, rim : lowest point and bell's rim along the bell's axis
    width : from the outer branch to the bell's axis
    branch_r : radius of the outer branch at its lower end
    first_valve, apart, row : the first valve along the width, distance of the valves, their number
    button : height of the fingers' buttons
    fourth_back : how much nearer to the player the fourth valve of a row is, for the little finger
    thumb : the thumb's ring above the valves' level, and to the front
    side_valve : place of the fourth valve of a compensating instrument, its button's height second
    side_grip : where on its casing the left middle finger and the thumb lie, above the knuckles' level
    """

    middle: tuple[float, float, float]
    ahead_deg: float
    lean_deg: float
    bottom: float
    rim: float
    width: float
    branch_r: float
    bell: Bell
    first_valve: float
    apart: float
    row: int
    button: float
    piston: Piston
    rim_r: float
    outer_r: float
    shank: float
    top_bow: float
    bore: float = 0.0090
    rings: int = 30
    fourth_back: float = 0.0
    thumb: tuple[float, float] = (0.004, -0.016)
    side_valve: tuple[float, float, float] | None = None
    side_grip: tuple[float, float] = (-0.012, 0.0)
    left_grip: tuple[float, float] = (-0.30, 60.0)

    def frame(self) -> Frame:
        """Axes to the bell, up, to the front."""
        ahead, lean = np.radians(self.ahead_deg), np.radians(self.lean_deg)
        level = np.array([-np.cos(ahead), 0.0, np.sin(ahead)])
        up = np.array([0.0, 1.0, 0.0])
        front = np.array([np.sin(ahead), 0.0, np.cos(ahead)])
        axes = np.array([np.cos(lean) * level - np.sin(lean) * up, np.cos(lean) * up + np.sin(lean) * level, front])
        return Frame(np.array(self.middle), axes)

    def valve(self, k: int, v: float) -> tuple[float, float, float]:
        """A place on the axis of a valve of the row."""
        return (self.first_valve + k * self.apart, v, -self.fourth_back if k == 3 else 0.0)

    @property
    def inner_branch(self) -> tuple[float, float, float]:
        """Return the place of the branch in front of the valves (along the width, to the front) and the radius of its
        top bend, m."""
        return (2.4 * self.branch_r + 0.012, self.branch_r + self.piston.casing_r + 0.014, 0.62 * self.branch_r)

    @property
    def valves(self) -> list[float]:
        return [self.first_valve + k * self.apart for k in range(self.row)]

    @property
    def foot(self) -> float:
        """Height a valve's places are counted from."""
        return self.button - self.piston.button


EUPHONIUM = Layout(
    middle=(0.030, 0.0, 0.085), ahead_deg=40.0, lean_deg=11.0, bottom=-0.475, rim=0.205, width=0.235, branch_r=0.031,
    bell=Bell(0.150, 0.050, 0.68), first_valve=0.064, apart=0.034, row=3, button=-0.110, piston=Piston(), rim_r=0.0145,
    outer_r=0.0190, shank=0.060, top_bow=-0.085, side_valve=(-0.064, -0.225, 0.030),
)  # fmt: skip
BARITONE = replace(
    EUPHONIUM, bell=Bell(0.120, 0.040, 0.66), branch_r=0.024, bottom=-0.455, rim=0.195, width=0.205, side_valve=None,
    rim_r=0.0140, outer_r=0.0185, bore=0.0080,
)  # fmt: skip
TUBA_BB = Layout(
    middle=(0.085, 0.0, 0.125), ahead_deg=28.0, lean_deg=6.0, bottom=-0.565, rim=0.360, width=0.330, branch_r=0.054,
    bell=Bell(0.2150, 0.092, 0.62), first_valve=0.104, apart=0.032, row=4, button=-0.130,
    piston=Piston(casing_r=0.0135, bottom=-0.130, button_r=0.0115, button=0.082), rim_r=0.0180, outer_r=0.0225,
    shank=0.062, top_bow=0.020, bore=0.0105, fourth_back=0.027, thumb=(0.004, -0.018),
)  # fmt: skip

TUBA_EB = replace(
    TUBA_BB, middle=(0.080, 0.0, 0.120), bottom=-0.558, rim=0.305, width=0.315, branch_r=0.050,
    bell=Bell(0.2050, 0.086, 0.62), row=3, apart=0.035, side_valve=(-0.090, -0.228, 0.026), side_grip=(0.005, 0.010),
    top_bow=-0.020,
)  # fmt: skip


def build(at: Layout) -> Model:
    """Build the model."""
    model, f = Model(), at.frame()
    blown(model, at)
    row(model, at, f)
    airway(model, at, f)
    slides(model, at, f)
    if at.side_valve:
        _side_valve(model, at, f)
    thumb_ring(model, at, f)
    return model


def blown(model: Model, at: Layout) -> None:
    """Mouthpiece and receiver."""
    mouthpiece(model, at.rim_r, at.outer_r, at.shank + 0.012, 0.030, 0.0066)
    receiver(model, (0, 0, at.shank), Z, 0.0088, 0.032)


def row(model: Model, at: Layout, f: Frame) -> None:
    """The pistons side by side."""
    for k in range(at.row):
        node = f"valve_{k + 1}"
        model.node(node, f.at(at.valve(k, at.button)))
        at.piston.build(model, node, f.at(at.valve(k, at.foot)), f.way(0, 1, 0))


def airway(model: Model, at: Layout, f: Frame) -> None:
    """Leadpipe, the branches and bows after the valves, the bell."""
    level, front, first, last = at.foot - 0.045, at.piston.casing_r, at.valves[0], at.valves[-1]
    over = f.at((first - 0.004, at.foot + 0.030, 0.075 + front))
    lead = bend(
        [
            (0, 0, at.shank + 0.010),
            (0, 0, max(0.15, over[2] - 0.030)),
            over,
            f.at((first - 0.004, level, 0.060 + front)),
            f.at((first, level, front - 0.004)),
        ],
        [0.050, 0.050, 0.035],
    )
    model.add(BRASS, tube(lead, tapered(lead, [(0, 0.0070), (1, at.bore + 0.0005)]), sides=20))
    half = at.width / 2
    floor = at.bottom + half + at.branch_r
    bow = arc(f, (half, floor, 0.0), half, -90, 90, step_m=0.012)
    across = 2.4 * at.branch_r + 0.012
    rise = f.at((0.0, at.top_bow - 0.46 * across - 0.015, 0.0))
    outer = joined(rise[None], bow)
    out = f.way(0, 1, 0)
    bell(model, at.bell, f.at((at.width, at.rim, 0.0)), out, outer, 0.62 * at.branch_r, rings=at.rings)
    # the branch before it: over the top, down in front of the valves, round at the floor, up to the last valve
    deep = at.branch_r + front + 0.014
    low = floor - 0.25 * half
    turn = min(0.034, 0.48 * (last - across))
    line = bend(
        [
            f.at((last, at.foot - 0.075, front - 0.004)),
            f.at((last, at.foot - 0.075, deep)),
            f.at((last, low, deep)),
            f.at((across, low, deep)),
            f.at((across, at.top_bow, deep)),
            f.at((0.0, at.top_bow, 0.0)),
            rise,
        ],
        [0.024, turn, turn, 0.5 * across, 0.46 * across],
        step_m=0.008,
    )
    knots = [(0, at.bore + 0.0005), (0.25, at.bore + 0.0015), (1, 0.62 * at.branch_r)]
    branch(model, line, tapered(line, knots), sides=24)
    ferrule(model, rise, out, 0.62 * at.branch_r, 0.030)
    for share in (0.30, 0.75):
        v = floor + share * (at.top_bow - floor)
        end = first - front if share > 0.5 else at.width - float(at.bell.radius(at.rim - v))
        model.add(BRASS, stay(f.at((at.branch_r * 0.75, v, 0.0)), f.at((end, v, 0.0)), 0.0034))
    v = at.foot - 0.015
    far = float(at.bell.radius(at.rim - v))
    model.add(BRASS, stay(f.at((last + front - 0.001, v, 0.0)), f.at((at.width - far + 0.001, v, 0.0)), 0.0034))
    nearest = lead[np.argmax(lead[:, 2] > over[2] - 0.02)]
    along = f.place(nearest)
    away = f.at((at.width, along[1], 0.0)) - nearest
    far = float(at.bell.radius(at.rim - along[1]))
    model.add(
        BRASS, stay(nearest + 0.007 * unit(away), f.at((at.width, along[1], 0.0)) - (far - 0.001) * unit(away), 0.0030)
    )


def slides(model: Model, at: Layout, f: Frame) -> None:
    """Knuckles between the valves and their slides."""
    r, down = at.bore, f.way(0, -1, 0)
    front = at.piston.casing_r
    for low, high in zip(at.valves, at.valves[1:], strict=False):
        for v in (at.foot - 0.030, at.foot - 0.085):
            model.add(BRASS, tube([f.at((low, v, 0)), f.at((high, v, 0))], r))
    for k, u in enumerate(at.valves[:4]):
        gap = 1.25 * r
        level = at.foot - (0.060, 0.050, 0.068, 0.062)[k]
        length = (0.11, 0.050, 0.15, 0.17)[k] * at.apart / 0.034
        back = -front - 1.1 * r
        start, end = f.at((u - gap, level, back)), f.at((u + gap, level, back))
        for place, side in ((start, -gap), (end, gap)):
            model.add(BRASS, tube([f.at((u + 0.6 * side, level, 0.0)), place + 0.1 * r * f.way(0, 0, -1)], r, sides=16))
        if k == 1:
            loop(model, start, end, unit(-0.9 * f.way(0, 0, 1) + 0.44 * down), 0.036, r, drawn=0.4)
        else:
            loop(model, start, end, down, length, r, tolerance_m=0.0012)


def _side_valve(model: Model, at: Layout, f: Frame) -> None:
    """The fourth valve, for the left hand, with its tubing to the branch."""
    u, top, w = at.side_valve
    foot, up = f.at((u, top - at.piston.button, w)), f.way(0, 1, 0)
    model.node("valve_4", f.at(at.side_valve))
    at.piston.build(model, "valve_4", foot, up)
    r = at.bore
    v = top - at.piston.button - 0.060
    link = bend(
        [
            f.at((u, v, w)),
            f.at((u, v, w + 0.045)),
            f.at((0.030, v - 0.030, w + 0.045)),
            f.at((at.valves[0], v - 0.030, 0.030)),
        ],
        [0.020, 0.020],
    )
    model.add(BRASS, tube(link, r, sides=16))
    loop(
        model,
        f.at((u, v - 0.022, w + at.piston.casing_r)),
        f.at((u + 0.026, v - 0.022, w + at.piston.casing_r)),
        f.way(0, -1, 0),
        0.085,
        r,
    )
    model.add(
        BRASS, stay(f.at((u + at.piston.casing_r, v + 0.010, w)), f.at((-0.6 * at.branch_r, v + 0.010, 0.0)), 0.0034)
    )


def _ring_place(at: Layout) -> tuple[float, float, float]:
    return (at.first_valve - at.piston.casing_r - 0.0125, at.foot + at.thumb[0], at.thumb[1])


RING_R, RING_THICK = 0.0135, 0.0017


def thumb_ring(model: Model, at: Layout, f: Frame) -> None:
    place = f.at(_ring_place(at))
    model.add(NICKEL, torus(place, f.way(0.25, 0.15, 1), RING_R, RING_THICK, around=32, sides=12))
    edge = place + RING_R * f.way(1, 0, -0.25)
    model.add(
        NICKEL,
        tube(
            [edge, f.at((at.first_valve - 0.5 * at.piston.casing_r, at.foot + at.thumb[0], -0.4 * at.piston.casing_r))],
            0.0022,
            sides=12,
        ),
    )


def row_contacts(at: Layout, f: Frame) -> list[dict[str, object]]:
    """Return the contacts of the right hand: the fingers on the row of valves, the thumb in its ring."""
    up, inward = f.way(0, 1, 0), unit(f.way(-1, 0, 0.25))
    found = [
        contact(f"right.{finger}.pad", f"valve_{k + 1}", f.at(at.valve(k, at.button)), up, f"valve_{k + 1}")
        for k, finger in enumerate(("index", "middle", "ring", "little")[: at.row])
    ]
    edge = f.at(_ring_place(at)) - (RING_R - RING_THICK) * inward
    return [*found, contact("right.thumb.pad", "root", edge, inward)]


def contacts(at: Layout) -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    f = at.frame()
    row = row_contacts(at, f)
    if at.side_valve:
        u, top, w = at.side_valve
        foot, radius = top - at.piston.button, at.piston.casing_r
        middle, thumb = (f.at((u, foot + v, w)) for v in at.side_grip)
        return [
            *row,
            contact("left.index.pad", "valve_4", f.at(at.side_valve), f.way(0, 1, 0), "valve_4"),
            contact("left.middle.pad", "root", *on_round(middle, radius, f.way(0.6, 0, 0.8))),
            contact("left.thumb.pad", "root", *on_round(thumb, radius, f.way(-0.55, 0, -0.84)), grip="resting"),
        ]
    v, degrees = at.left_grip
    radius = _branch_radius(at, v)
    around = np.radians(min(degrees + np.degrees(0.085 / radius), 165.0))
    way = f.way(-np.cos(around), 0, np.sin(around))
    return [*row, contact("left.middle.pad", "root", *on_round(f.at((0.0, v, 0.0)), radius, way))]


def _branch_radius(at: Layout, v: float) -> float:
    """Radius of the outer branch at a height: of the cone between the rings of its skin."""
    f = at.frame()
    floor = at.bottom + at.width / 2 + at.branch_r
    skin = next(part.shape for part in build(at).parts if part.material == BRASS and len(part.shape.points) > 2500)
    places = (skin.points - f.origin) @ f.axes.T
    rings = places[(places[:, 1] > floor - 0.001) & (np.abs(places[:, 0]) < 0.5 * at.width)]
    order = np.argsort(rings[:, 1])
    return float(np.interp(v, rings[order, 1], np.hypot(rings[order, 0], rings[order, 2])))


LAYOUTS = {
    "euphonium_Bb_bassclef": EUPHONIUM,
    "euphonium_baritone_Bb_treble": EUPHONIUM,
    "baritone_Bb": BARITONE,
    "tuba_BBb": TUBA_BB,
    "tuba_Eb": TUBA_EB,
}
INSTRUMENTS = {name: (partial(build, at), partial(contacts, at)) for name, at in LAYOUTS.items()}
