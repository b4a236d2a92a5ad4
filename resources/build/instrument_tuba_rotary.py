"""Tubas in F and C with rotary valves: levers in front, the bell on the player's left.

Sizes are those of common instruments: F height 900 mm, bell 380 mm; C height 930 mm, bell 420 mm; four rotors 46 mm
apart, levers 21 mm apart with a way of 9 mm; a fifth rotor in the leadpipe, two whole tones long, for the right thumb.
The outer branch stands on the player's right; the right hand comes round it to the levers, the left arm goes round the
bell. The frame is that of `instrument_tuba`, mirrored.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from resources.build.instrument_brass import BRASS, NICKEL, Bell, Frame, contact, loop, paddle, rotor, stay
from resources.build.instrument_mesh import Model, bend, solid, tube
from resources.build.instrument_tuba import TUBA_BB, Layout, airway, blown

LEVER_APART, LEVER_WAY = 0.021, 0.009
PAD_U, PIVOT_U = 0.050, 0.100
FIRST_PAD_V, PAD_W, PIVOT_W = -0.175, 0.150, 0.140
ROTOR_APART, ROTOR_R = 0.046, 0.020
THUMB, THUMB_PIVOT_V, THUMB_PIVOT_W = (-0.018, -0.150, 0.118), -0.112, 0.110
"""Middle of the thumb's plate, and the height and depth of the axle above it."""
FIFTH = (0.183, -0.143, 0.046)
"""Place where the fifth rotor begins, along its axis to the front."""
FIFTH_LONG = 0.056


@dataclass(frozen=True)
class Rotary(Layout):
    """A layout with its bell on the player's left."""

    def frame(self) -> Frame:
        right = super().frame()
        return Frame(right.origin, right.axes * np.array([-1.0, 1.0, 1.0]))


TUBA_F = Rotary(
    **{
        **vars(TUBA_BB),
        "middle": (-0.075, 0.0, 0.120),
        "bottom": -0.560,
        "rim": 0.330,
        "width": 0.315,
        "branch_r": 0.048,
        "bell": Bell(0.190, 0.085, 0.62),
        "first_valve": 0.185,
        "row": 1,
        "rings": 46,
        "fourth_back": 0.0,
        "button": -0.060,
        "left_grip": (-0.270, -10.0),
    }
)
TUBA_C = replace(
    TUBA_F, middle=(-0.080, 0.0, 0.125), bottom=-0.565, rim=0.365, width=0.328, branch_r=0.053,
    bell=Bell(0.210, 0.092, 0.62),
)  # fmt: skip


def _rotor_v(at: Rotary, k: int) -> float:
    return at.foot - 0.045 - ROTOR_APART * k


def _pad(k: int) -> tuple[float, float, float]:
    return (PAD_U, FIRST_PAD_V - LEVER_APART * k, PAD_W)


def build(at: Rotary) -> Model:
    """Build the model."""
    model, f = Model(), at.frame()
    for k in range(4):
        model.node(f"valve_{k + 1}", f.at((PIVOT_U, _pad(k)[1], PIVOT_W)))
        model.node(f"rotor_{k + 1}", f.at((at.first_valve, _rotor_v(at, k), 0.034)))
    model.node("valve_5", f.at((THUMB[0], THUMB_PIVOT_V, THUMB_PIVOT_W)))
    model.node("rotor_5", f.at((FIFTH[0], FIFTH[1], FIFTH[2] + FIFTH_LONG)))
    blown(model, at)
    airway(model, at, f)
    for k in range(4):
        _valve(model, at, f, k)
        _lever(model, at, f, k)
    _fifth(model, at, f)
    _axle(model, at, f)
    _band(model, at, f)
    return model


def _band(model: Model, at: Rotary, f: Frame) -> None:
    """Round the bell, below the left hand."""
    top = at.left_grip[0] - 0.026
    low = top - 0.014
    upper, lower = (float(at.bell.radius(at.rim - v)) + 0.0010 for v in (top, low))
    profile = [(0, lower), (0.007, (upper + lower) / 2), (top - low, upper)]
    model.add(NICKEL, solid(f.at((at.width, low, 0.0)), f.way(0, 1, 0), profile, sides=48, proxy=False))


def _valve(model: Model, at: Rotary, f: Frame, k: int) -> None:
    u, v, r = at.first_valve, _rotor_v(at, k), at.bore
    rotor(model, f"rotor_{k + 1}", f.at((u, v, -0.026)), f.way(0, 0, 1), f.way(-0.8, -0.6, 0), ROTOR_R, 0.060)
    length = (0.085, 0.040, 0.105, 0.120)[k]
    side = 1.0 if k % 2 else -1.0
    reach = min(length, 0.075) if side > 0 else length
    start = f.at((u + side * 0.8 * ROTOR_R, v + 1.2 * r, -0.004))
    end = f.at((u + side * 0.8 * ROTOR_R, v - 1.2 * r, -0.004))
    loop(model, start, end, f.way(side, 0, -0.25), reach, r)
    if k:
        above = f.at((u, v + ROTOR_APART - 0.8 * ROTOR_R, 0.004))
        model.add(BRASS, tube([above, f.at((u, v + 0.8 * ROTOR_R, 0.004))], r, sides=16))


def _lever(model: Model, at: Rotary, f: Frame, k: int) -> None:
    node, (u, v, w) = f"valve_{k + 1}", _pad(k)
    paddle(model, node, f.at((u, v, w)), f.way(0, 0, 1), f.way(1, 0, 0), (0.0088, 0.0130))
    arm = bend(
        [f.at((u + 0.006, v, w - 0.0028)), f.at((PIVOT_U - 0.018, v, w - 0.006)), f.at((PIVOT_U + 0.016, v, PIVOT_W))],
        0.03,
    )
    model.add(NICKEL, tube(arm, 0.0024, sides=12), node=node)
    hub = [(0, 0.0046), (0.016, 0.0046)]
    model.add(NICKEL, solid(f.at((PIVOT_U, v - 0.008, PIVOT_W)), f.way(0, 1, 0), hub, sides=18), node=node)
    goal = f.at((at.first_valve - 0.014, _rotor_v(at, k) - 0.012, 0.042))
    model.add(NICKEL, tube([f.at((PIVOT_U + 0.016, v, PIVOT_W)), goal], 0.0013, sides=8), node=node)


def _fifth(model: Model, at: Rotary, f: Frame) -> None:
    """The rotor in the leadpipe with its slide, and the thumb's lever before the outer branch."""
    u, v, w = FIFTH
    rotor(model, "rotor_5", f.at(FIFTH), f.way(0, 0, 1), f.way(-0.6, 0.8, 0), ROTOR_R, FIFTH_LONG)
    legs = [f.at((u + 0.014 + side, v + 0.012, w + 0.016)) for side in (0.0, 2.4 * at.bore)]
    loop(model, legs[0], legs[1], f.way(0.06, 1, 0), 0.095, at.bore)
    top = f.at((THUMB[0], THUMB_PIVOT_V, THUMB_PIVOT_W))
    front, across = f.way(0, 0, 1), f.way(1, 0, 0)
    paddle(model, "valve_5", f.at(THUMB), front, f.way(0, 1, 0), (0.0100, 0.0130))
    under = THUMB[2] - 0.0028
    arm = [f.at((THUMB[0], THUMB[1] + 0.006, under)), f.at((THUMB[0], THUMB_PIVOT_V - 0.010, under - 0.002)), top]
    model.add(NICKEL, tube(bend(arm, 0.010), 0.0024, sides=12), node="valve_5")
    hub = [(0, 0.0046), (0.016, 0.0046)]
    model.add(NICKEL, solid(top - 0.008 * across, across, hub, sides=18), node="valve_5")
    goal = f.at((u - 0.010, v + 0.014, w + FIFTH_LONG + 0.006))
    start = top + 0.008 * f.way(0, 1, 0)
    model.add(NICKEL, tube([top, start], 0.0018, sides=10), node="valve_5")
    model.add(NICKEL, tube([start, goal], 0.0013, sides=8), node="valve_5")
    axle = [top - 0.013 * across, top + 0.013 * across]
    model.add(NICKEL, tube(axle, 0.0022, sides=12))
    for side, end in zip((-1, 1), axle, strict=True):
        foot = f.at((0.4 * side * at.branch_r, THUMB_PIVOT_V, 0.52 * at.branch_r))
        model.add(BRASS, stay(end, foot, 0.0026))


def _axle(model: Model, at: Rotary, f: Frame) -> None:
    top, low = FIRST_PAD_V + 0.016, FIRST_PAD_V - 3 * LEVER_APART - 0.016
    model.add(NICKEL, tube([f.at((PIVOT_U, top, PIVOT_W)), f.at((PIVOT_U, low, PIVOT_W))], 0.0022, sides=12))
    branch_u, branch_w, branch_r = at.inner_branch
    for v in (top - 0.002, low + 0.002):
        foot = f.at((branch_u - 0.3 * branch_r, v, branch_w + 0.9 * branch_r))
        model.add(BRASS, stay(f.at((PIVOT_U, v, PIVOT_W)), foot, 0.0026))


def contacts(at: Rotary) -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    f = at.frame()
    front = f.way(0, 0, 1)
    v, degrees = at.left_grip
    radius = float(at.bell.radius(at.rim - v))
    turn = np.radians(degrees) + 0.085 / radius
    way = f.way(np.cos(turn), 0, np.sin(turn))
    return [
        *(
            contact(f"right.{finger}.pad", f"valve_{k + 1}", f.at(_pad(k)), front, f"valve_{k + 1}")
            for k, finger in enumerate(("index", "middle", "ring", "little"))
        ),
        contact("right.thumb.pad", "valve_5", f.at(THUMB), front, "valve_5"),
        contact("left.middle.pad", "root", f.at((at.width, v, 0.0)) + radius * way, way),
    ]


INSTRUMENTS = {
    name: (partial(build, at), partial(contacts, at)) for name, at in (("tuba_F", TUBA_F), ("tuba_CC", TUBA_C))
}
