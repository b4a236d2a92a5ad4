"""The horn in F: the double horn in F and B flat and the single horn.

Sizes are those of common instruments: bell 310 mm, the coil 290 mm across, mouthpiece rim 17.5 mm inside and 25 mm
outside, levers 20.5 mm apart with a way of 9 mm, rotors 38 mm apart. The player sees the coil obliquely from above: its
plane goes from the lips forward to the left and down to the bell at the right thigh. Seen from the front the levers lie
on the near side of it, at the upper left edge; the thumb's lever lies behind.

The coil is drawn in a frame with the axes "along the leadpipe", "down to the bell", "to the front".
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from resources.build.instrument_brass import (
    BRASS,
    NICKEL,
    Bell,
    Frame,
    Z,
    arc,
    bell,
    branch,
    contact,
    direction,
    ferrule,
    loop,
    mouthpiece,
    paddle,
    receiver,
    root_from_player,
    rotor,
    stay,
    strap,
    tapered,
)
from resources.build.instrument_mesh import Array, Model, bend, joined, solid, tube, unit

PITCH_DOWN_DEG, YAW_LEFT_DEG = 22.0, 8.0
"""The usual carriage: the mouthpiece points a little down and to the left."""
BELL_PLACE = np.array([-0.285, -0.402, 0.050])
"""The middle of the bell's rim in the player's frame, from the lips: at the right thigh of who sits."""
LEADPIPE = direction(30.0, 28.0)
"""Place where the coil's upper edge goes, in the player's frame."""
BELL = Bell(rim_r=0.155, scale_m=0.022, flare=0.62)
OPEN_M = 0.175
COIL, COIL_R = (0.330, 0.185), 0.145
LEVER_APART, LEVER_WAY = 0.0205, 0.009
FIRST_LEVER, PAD_B, PAD_N = 0.256, 0.040, 0.080
PIVOT_B, PIVOT_N = 0.093, 0.066
THUMB = (0.264, 0.058, 0.026)
HOOK_R = 0.0105
ROTORS = (0.262, 0.300, 0.338)
ROTOR_B = 0.135


def frame() -> Frame:
    """The coil's axes in the root frame: along, down to the bell, to the front."""
    down = unit(BELL_PLACE - (BELL_PLACE @ LEADPIPE) * LEADPIPE)
    axes = np.array([LEADPIPE, down, np.cross(down, LEADPIPE)])
    return Frame(np.zeros(3), axes @ root_from_player(PITCH_DOWN_DEG, YAW_LEFT_DEG).T)


@dataclass(frozen=True)
class Hand:
    """The bell as the right hand finds it: its middle, the way out, up, and away from the player."""

    centre: Array
    out: Array
    up: Array
    off: Array

    def wall(self, depth: float, angle_deg: float) -> tuple[Array, Array]:
        """A point of the inner wall and the normal that points off it; 0 degrees away from the player, 90 up."""
        angle = np.radians(angle_deg)
        radial = np.cos(angle) * self.off + np.sin(angle) * self.up
        step = 1e-4
        radius = float(BELL.radius(depth)) - 0.0007
        slope = (float(BELL.radius(depth - step)) - float(BELL.radius(depth + step))) / (2 * step)
        return self.centre - depth * self.out + radius * radial, unit(slope * self.out - radial)


def hand() -> Hand:
    """Return the place and directions of the right hand in the bell."""
    f = frame()
    centre, out = _bell_axis(f)
    up = root_from_player(PITCH_DOWN_DEG, YAW_LEFT_DEG) @ np.array([0.0, 1.0, 0.0])
    up = unit(up - (up @ out) * out)
    return Hand(centre, out, up, np.cross(up, out))


def _bell_axis(f: Frame) -> tuple[Array, Array]:
    centre = root_from_player(PITCH_DOWN_DEG, YAW_LEFT_DEG) @ BELL_PLACE
    return centre, f.way(np.cos(_leaves()), np.sin(_leaves()), 0.0)


def _leaves() -> float:
    """The angle of the coil at which the bell's axis leaves it, radians."""
    f = frame()
    goal = f.place(root_from_player(PITCH_DOWN_DEG, YAW_LEFT_DEG) @ BELL_PLACE)[:2]
    angles = np.radians(np.linspace(110, 170, 6001))
    away = goal - (np.array(COIL) + COIL_R * np.column_stack([np.sin(angles), -np.cos(angles)]))
    tangent = np.column_stack([np.cos(angles), np.sin(angles)])
    off = away[:, 0] * tangent[:, 1] - away[:, 1] * tangent[:, 0]
    return float(angles[np.argmin(np.abs(off))])


def lever_pad(k: int) -> tuple[float, float, float]:
    return (FIRST_LEVER + LEVER_APART * k, PAD_B, PAD_N)


def build(double: bool = True) -> Model:
    """Build the model."""
    model, f = Model(), frame()
    for k in range(3):
        model.node(f"valve_{k + 1}", f.at((FIRST_LEVER + LEVER_APART * k, PIVOT_B, PIVOT_N)))
        model.node(f"rotor_{k + 1}", f.at((ROTORS[k], ROTOR_B, 0.064)))
    if double:
        model.node("thumb_valve", f.at((THUMB[0], PIVOT_B, THUMB[2])))
        model.node("thumb_rotor", f.at((0.390, 0.165, 0.064)))
    mouthpiece(model, 0.0092, 0.0126, 0.062, 0.018, 0.0046)
    receiver(model, (0, 0, 0.054), Z, 0.0066, 0.034)
    _leadpipe(model, f)
    _bell(model, f)
    _coils(model, f, double)
    for k in range(3):
        _lever(model, f, k)
        rotor(
            model,
            f"rotor_{k + 1}",
            f.at((ROTORS[k], ROTOR_B, 0.006)),
            f.way(0, 0, 1),
            f.way(0.5, -0.87, 0),
            0.0165,
            0.057,
        )
    if double:
        _thumb_lever(model, f)
        rotor(model, "thumb_rotor", f.at((0.390, 0.165, 0.006)), f.way(0, 0, 1), f.way(-0.7, -0.7, 0), 0.0175, 0.057)
    _hook(model, f)
    return model


def _leadpipe(model: Model, f: Frame) -> None:
    """From the receiver over the coil's upper edge and once round, into the first valve."""
    straight = 0.150 * Z
    top = f.at((COIL[0] - 0.01, COIL[1] - COIL_R, 0.052))
    lead = bend([0.060 * Z, straight, f.at((0.215, COIL[1] - COIL_R, 0.052)), top], [0.10, 0.16])
    around = arc(f, (*COIL, 0.052), COIL_R, 0, 232, step_m=0.008)
    inward = bend(
        [
            around[-1],
            f.at((0.186, 0.222, 0.048)),
            f.at((0.205, 0.150, 0.036)),
            f.at((ROTORS[0] - 0.012, ROTOR_B, 0.036)),
        ],
        [0.03, 0.03],
    )
    near = joined(lead, around[:14])
    model.add(BRASS, tube(near, tapered(near, [(0, 0.0052), (1, 0.0066)]), sides=20))
    branch(model, joined(around[13:], inward), 0.0066, sides=18)
    for degrees in (24.0, 205.0):
        place = arc(f, (*COIL, 0.052), COIL_R, degrees, degrees + 2)
        ferrule(model, place[0], place[-1] - place[0], 0.0066, 0.018)


def _bell(model: Model, f: Frame) -> None:
    centre, out = _bell_axis(f)
    leave = np.degrees(_leaves())
    before = arc(f, (*COIL, 0.0), COIL_R, -62.0, leave, step_m=0.010)
    bell(model, BELL, centre, out, before, 0.0085, open_m=OPEN_M)
    back = unit(before[0] - before[1])
    tail = bend(
        [
            f.at((ROTORS[0], ROTOR_B + 0.012, 0.014)),
            f.at((ROTORS[0], 0.206, 0.006)),
            f.at((0.166, 0.206, 0.0)),
            before[0] + 0.040 * back,
            before[0],
        ],
        0.02,
    )
    model.add(BRASS, tube(tail, 0.0080, sides=16))
    ferrule(model, before[0], before[1] - before[0], 0.0078, 0.020)
    garland = [(0, float(BELL.radius(0.215)) + 0.0010), (0.012, float(BELL.radius(0.203)) + 0.0016)]
    model.add(NICKEL, solid(centre - 0.215 * out, out, garland, sides=40, proxy=False))


def _coils(model: Model, f: Frame, double: bool) -> None:
    """Windings inside the coil, and the slides of the valves."""

    def through(
        radius: float,
        level: float,
        start: float,
        end: float,
        first: tuple[float, ...],
        last: tuple[float, ...],
        size: float,
    ) -> None:
        around = arc(f, (*COIL, level), radius, start, end, step_m=0.010)
        into = bend([f.at(first), around[0] - 0.030 * unit(around[1] - around[0]), around[0]], 0.012)
        back = bend([around[-1], around[-1] + 0.030 * unit(around[-1] - around[-2]), f.at(last)], 0.012)
        branch(model, joined(into, around, back), size, sides=14)
        ferrule(model, around[0], around[1] - around[0], size, 0.016)

    through(0.124, 0.036, 62.0, 318.0, (0.378, 0.140, 0.036), (0.300, 0.118, 0.036), 0.0066)
    if double:
        through(0.108, 0.018, 75.0, 262.0, (0.392, 0.150, 0.018), (0.250, 0.140, 0.020), 0.0066)
        loop(model, f.at((0.378, 0.180, 0.054)), f.at((0.405, 0.180, 0.054)), f.way(-0.12, 1, 0), 0.074, 0.0066)
    else:
        loop(model, f.at((0.380, 0.150, 0.054)), f.at((0.406, 0.150, 0.054)), f.way(-0.12, 1, 0), 0.100, 0.0066)
    layers = ((0.048, (0.086, 0.042, 0.112)), (0.022, (0.058, 0.030, 0.078)))
    for level, sizes in layers if double else layers[:1]:
        for k, size in enumerate(sizes):
            a = ROTORS[k]
            loop(
                model,
                f.at((a - 0.0105, ROTOR_B + 0.010, level)),
                f.at((a + 0.0105, ROTOR_B + 0.010, level)),
                f.way(0, 1, 0),
                size,
                0.0062,
            )
    for degrees in (100.0, 175.0, 262.0):
        outer = arc(f, (*COIL, 0.052), COIL_R, degrees, degrees + 1)[0]
        lower = arc(f, (*COIL, 0.0), COIL_R, degrees, degrees + 1)[0]
        if degrees < 200:
            model.add(BRASS, stay(outer + 0.0066 * f.way(0, 0, -1), lower + 0.016 * f.way(0, 0, 1), 0.0020))
        inner = arc(f, (*COIL, 0.036), 0.124, degrees, degrees + 1)[0]
        model.add(BRASS, stay(inner + 0.006 * unit(lower - inner), lower + 0.014 * unit(inner - lower), 0.0018))
    cross = (f.at((ROTORS[0], ROTOR_B - 0.016, 0.036)), f.at((ROTORS[0], COIL[1] - COIL_R + 0.022, 0.050)))
    model.add(BRASS, stay(cross[0], cross[1], 0.0024))


def _lever(model: Model, f: Frame, k: int) -> None:
    """Paddle, arm and axle of a lever, and the rod from it to its rotor's arm."""
    node, (a, b, n) = f"valve_{k + 1}", lever_pad(k)
    paddle(model, node, f.at((a, b, n)), f.way(0, 0, 1), f.way(0, 1, 0), (0.0085, 0.0115))
    arm = bend(
        [
            f.at((a, b + 0.006, n - 0.0028)),
            f.at((a, 0.070, n - 0.006)),
            f.at((a, PIVOT_B, PIVOT_N)),
            f.at((a, PIVOT_B + 0.016, PIVOT_N + 0.004)),
        ],
        [0.03, 0.03],
    )
    model.add(NICKEL, tube(arm, 0.0022, sides=12, flat=(1.0, 1.5), side=f.way(0, 0, 1)), node=node)
    hub = f.at((a - 0.008, PIVOT_B, PIVOT_N))
    model.add(NICKEL, solid(hub, f.way(1, 0, 0), [(0, 0.0042), (0.016, 0.0042)], sides=18), node=node)
    end = f.at((a, PIVOT_B + 0.016, PIVOT_N + 0.004))
    goal = f.at((ROTORS[k] + 0.006, ROTOR_B - 0.012, 0.070))
    model.add("felt", tube([end, goal], 0.0008, sides=8), node=node)
    if k == 0:
        start = f.at((FIRST_LEVER - 0.016, PIVOT_B, PIVOT_N))
        model.add(
            NICKEL, tube([start, f.at((FIRST_LEVER + 2 * LEVER_APART + 0.016, PIVOT_B, PIVOT_N))], 0.0020, sides=12)
        )
        for along in (FIRST_LEVER - 0.014, FIRST_LEVER + 2 * LEVER_APART + 0.014):
            model.add(NICKEL, stay(f.at((along, PIVOT_B, PIVOT_N)), f.at((along, PIVOT_B + 0.004, 0.040)), 0.0022))
            model.add(BRASS, stay(f.at((along, PIVOT_B + 0.004, 0.040)), f.at((along, ROTOR_B - 0.012, 0.036)), 0.0020))


def _thumb_lever(model: Model, f: Frame) -> None:
    """Behind the levers, for the thumb: it turns the change valve."""
    a, b, n = THUMB
    paddle(model, "thumb_valve", f.at(THUMB), f.way(0, 0, -1), f.way(0, 1, 0), (0.0085, 0.0125))
    arm = bend(
        [f.at((a, b + 0.006, n + 0.0028)), f.at((a, PIVOT_B, n)), f.at((a + 0.05, PIVOT_B + 0.016, n + 0.002))], 0.006
    )
    model.add(NICKEL, tube(arm, 0.0022, sides=12), node="thumb_valve")
    hub = f.at((a - 0.008, PIVOT_B, n))
    model.add(NICKEL, solid(hub, f.way(1, 0, 0), [(0, 0.0042), (0.016, 0.0042)], sides=18), node="thumb_valve")
    model.add(
        "felt",
        tube([f.at((a + 0.05, PIVOT_B + 0.016, n + 0.002)), f.at((0.380, 0.152, 0.040))], 0.0008, sides=8),
        node="thumb_valve",
    )
    model.add(NICKEL, stay(f.at((a - 0.010, PIVOT_B, n)), f.at((a - 0.010, ROTOR_B - 0.014, n + 0.004)), 0.0020))


def _hook_centre() -> tuple[float, float, float]:
    return (FIRST_LEVER + 3 * LEVER_APART + 0.001, PAD_B + 0.002, PAD_N - 0.004 + HOOK_R)


def _hook(model: Model, f: Frame) -> None:
    """For the little finger, on the leadpipe; it is open towards the levers."""
    centre = _hook_centre()
    angles = np.radians(np.linspace(-120, 110, 29))
    line = np.array([f.at((centre[0] + HOOK_R * np.cos(t), centre[1], centre[2] + HOOK_R * np.sin(t))) for t in angles])
    model.add(BRASS, strap(line, 0.0036, f.way(0, 1, 0)))
    foot = f.at((centre[0], centre[1], centre[2] - HOOK_R))
    model.add(BRASS, stay(foot - 0.001 * f.way(0, 0, 1), f.at((centre[0], COIL[1] - COIL_R + 0.001, 0.057)), 0.0022))


def contacts(double: bool = True) -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    f = frame()
    front, inside, off = f.way(0, 0, 1), f.way(-0.17, 0, 0.985), f.way(0, 0.35, -0.94)
    pipe = f.at((FIRST_LEVER + 0.010, COIL[1] - COIL_R, 0.052))
    right = hand()
    return [
        *(
            contact(f"left.{finger}.pad", f"valve_{k + 1}", f.at(lever_pad(k)), front, f"valve_{k + 1}")
            for k, finger in enumerate(("index", "middle", "ring"))
        ),
        contact("left.thumb.pad", "thumb_valve", f.at(THUMB), -front, "thumb_valve")
        if double
        else contact("left.thumb.pad", "root", pipe + 0.0062 * off, off),
        contact("left.little.pad", "root", f.at(_hook_centre()) - (HOOK_R - 0.0011) * inside, inside),
        contact("right.index.side_middle", "root", *right.wall(0.085, 66.0)),
        contact("right.thumb.side", "root", *right.wall(0.072, 100.0), grip="resting"),
    ]


INSTRUMENTS = {
    "horn_double_F_Bb": (partial(build, True), partial(contacts, True)),
    "horn_F_single": (partial(build, False), partial(contacts, False)),
}
