"""Sousaphone in BB flat: worn round the body, on the left shoulder, its bell ahead over the player's head.

Sizes are those of common instruments: bell 660 mm, bore 18.5 mm, three pistons 32 mm apart with a way of 17 mm; the
winding is 690 by 490 mm from middle to middle of the tube, as the bundled bodies with their right arms need it. The
tube goes from the valves as a helix twice round the player: under the right arm, up the back, over the left shoulder
and down the front, round the right hip and up the back again, to the bell's collar behind the left shoulder. Its turns
are counted in degrees from the shoulder: 90 is before the breast, 180 at the right hip, 270 at the back; what comes
before the shoulder is negative.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from resources.build.instrument_brass import BRASS, NICKEL, Bell, Frame, Z, bell, contact, ferrule, inside_out, stay
from resources.build.instrument_mesh import Array, Model, bend, joined, lengths, solid, tube, unit
from resources.build.instrument_tuba import TUBA_BB, blown, row, row_contacts, slides, thumb_ring

ROW = replace(
    TUBA_BB, middle=(-0.042, 0.0, 0.202), ahead_deg=28.0, first_valve=0.026, row=3, fourth_back=0.0, button=-0.168,
    bore=0.00925,
)  # fmt: skip
"""The valves stand as those of the tuba do, where the right hand finds them."""
SHOULDER, HIP = np.array([0.162, -0.006]), np.array([-0.284, -0.525])
"""Middle of the tube on the left shoulder and at the right hip, from the lips to the left and up."""
BACK, FRONT = -0.405, 0.088
"""... and behind the player and in front, from the lips ahead."""
PITCH = 0.088
"""Distance in metres between adjacent turns."""
FIRST_DEG, COLLAR_DEG = -240.0, 290.0
RADII = ((-240, 0.0135), (-180, 0.020), (-90, 0.028), (0, 0.0345), (60, 0.0375), (180, 0.0445), (290, 0.0520))
BELL = Bell(0.330, 0.0836, 0.90)
RIM = np.array([0.085, 0.545, 0.080])
STEM = np.array([0.205, 0.0, -0.340])
"""Place where the bell's stem stands behind the left shoulder."""
ELBOW_R = 0.125
NECK = 0.070
"""Measure of how far left of the first valve the tube from the mouthpiece comes down."""
GRIP_DEG, ROUND_DEG = 66.0, 35.0
"""Place of the left hand, and how far round the tube its palm is from the left to the front: from the left alone a
thick wrist would be in the breast.
"""


def winding(degrees: Array) -> Array:
    """Middle of the tube at places of the helix (n, 3)."""
    middle = np.r_[(SHOULDER + HIP) / 2, (FRONT + BACK) / 2]
    along = np.r_[unit(SHOULDER - HIP), 0.0]
    beside = np.array([-along[1], along[0], 0.0])
    turn = np.radians(np.atleast_1d(degrees))
    half = np.linalg.norm(SHOULDER - HIP) / 2, (FRONT - BACK) / 2
    round_ = half[0] * np.cos(turn)[:, None] * along + half[1] * np.sin(turn)[:, None] * Z
    return np.asarray(middle + round_ - PITCH * turn[:, None] / (2 * np.pi) * beside)


def radius(degrees: float) -> float:
    """Radius of the tube there."""
    return float(np.interp(degrees, [place for place, _ in RADII], [r for _, r in RADII]))


def build() -> Model:
    """Build the model."""
    model, f = Model(), ROW.frame()
    blown(model, ROW)
    row(model, ROW, f)
    slides(model, ROW, f)
    thumb_ring(model, ROW, f)
    _gooseneck(model, f)
    _body(model, f)
    _bell(model)
    _stays(model, f)
    return model


def _gooseneck(model: Model, f: Frame) -> None:
    """From the mouthpiece ahead, to the left and down into the first valve."""
    level, first = ROW.foot - 0.045, ROW.valves[0]
    line = bend(
        [
            (0, 0, ROW.shank + 0.010),
            (0, 0, 0.150),
            f.at((first - NECK, ROW.foot + 0.130, 0.045)),
            f.at((first - NECK, level, 0.045)),
            f.at((first, level, ROW.piston.casing_r - 0.004)),
        ],
        [0.045, 0.050, 0.030],
    )
    share = lengths(line) / lengths(line)[-1]
    model.add(BRASS, tube(line, np.interp(share, [0, 1], [0.0070, ROW.bore]), sides=20))
    for part in (0.10, 0.30):
        k = int(np.argmin(np.abs(share - part)))
        ferrule(model, line[k], line[k + 1] - line[k - 1], 0.0078, 0.012)


def _body(model: Model, f: Frame) -> None:
    """From the last valve twice round the player."""
    last = ROW.valves[-1]
    degrees = np.linspace(FIRST_DEG, COLLAR_DEG, 150)
    helix = winding(degrees)
    way = unit(helix[1] - helix[0])
    level = ROW.foot - 0.075
    side = ROW.piston.casing_r - 0.004
    link = bend(
        [f.at((last + side, level, 0.0)), f.at((last + 0.060, level, 0.0)), helix[0] - 0.080 * way, helix[0]],
        [0.030, 0.045],
    )
    line = joined(link, helix)
    grown = np.r_[np.linspace(ROW.bore, RADII[0][1], len(line) - len(helix)), [radius(d) for d in degrees]]
    model.add(BRASS, tube(line, grown, sides=32))
    for place in (-120.0, 8.0, 140.0, 250.0):
        a, b = winding(np.array([place - 0.5, place + 0.5]))
        ferrule(model, (a + b) / 2, b - a, radius(place) + 0.0008, 0.030)


def _bell(model: Model) -> None:
    """The stem behind the shoulder, the collar and the bell over the head."""
    start = winding(np.array([COLLAR_DEG - 3.0, COLLAR_DEG]))
    way = unit(start[1] - start[0])
    turn = np.array([STEM[0], RIM[1], STEM[2]])
    across = STEM[0] - start[1][0]
    corner = start[1] + across / way[0] * way
    corner[2] = STEM[2]
    ahead = unit(RIM - turn)
    before = bend([start[1], corner, turn, turn + 0.14 * ahead], [0.19, ELBOW_R], step_m=0.010)
    narrow, wide = radius(COLLAR_DEG), float(BELL.radius(np.linalg.norm(RIM - before[-1])))
    grown = narrow + (lengths(before) / lengths(before)[-1]) ** 1.6 * (wide - narrow)
    first = int(np.argmax(before[:, 1] > turn[1] - ELBOW_R))
    deep = 0.75 * np.linalg.norm(RIM - before[-1])
    line = joined(before[first:], RIM - deep * ahead)
    inner = np.r_[grown[first:], BELL.radius(deep)] - 0.0012
    model.add("inner_brass", inside_out(tube(line, inner, sides=40, closed=False)))
    bell(model, BELL, RIM, ahead, before, radius(COLLAR_DEG), rings=34, sides=64)
    collar = int(np.argmin(np.abs(before[:, 1] - (turn[1] - ELBOW_R - 0.06)) + (before[:, 2] > STEM[2] + 0.01)))
    thick = float(grown[collar])
    profile = [(-0.022, thick + 0.004), (-0.016, thick + 0.006), (0.016, thick + 0.006), (0.022, thick + 0.004)]
    model.add(NICKEL, solid(before[collar], (0, 1, 0), profile, sides=40))


def _stays(model: Model, f: Frame) -> None:
    """Between the turns, and from the winding to the valves."""
    for low, high in ((-190.0, 170.0), (-100.0, 260.0), (-75.0, 283.0)):
        a, b = winding(np.array([low, high]))
        across = unit(b - a)
        start, end = a + 0.6 * radius(low) * across, b - 0.6 * radius(high) * across
        model.add(BRASS, tube([start, end], 0.009, sides=16))
    for k, degrees in ((0, 108.0), (2, 122.0)):
        place = f.at((ROW.valves[k], ROW.foot - 0.100, -ROW.piston.casing_r + 0.001))
        goal = winding(np.array([degrees]))[0]
        away = unit(goal - place)
        model.add(BRASS, stay(place, goal - (radius(degrees) - 0.002) * away, 0.0034))


def grip() -> tuple[Array, Array, Array, Array]:
    """The tube where the left hand holds it: its middle, its way to the shoulder, to the left hand's palm, ahead."""
    a, b = winding(np.array([GRIP_DEG + 0.5, GRIP_DEG - 0.5]))
    way = unit(b - a)
    outer = np.array([unit(SHOULDER - HIP)[1], -unit(SHOULDER - HIP)[0], 0.0])
    left = unit(outer - way * (outer @ way))
    front = np.cross(left, way)
    front = front if front[2] > 0 else -front
    cosine, sine = np.cos(np.radians(ROUND_DEG)), np.sin(np.radians(ROUND_DEG))
    return (a + b) / 2, way, cosine * left + sine * front, cosine * front - sine * left


def contacts() -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    middle, _, palm, ahead = grip()
    r = radius(GRIP_DEG)
    around = 0.085 / r
    way = np.cos(around) * palm + np.sin(around) * ahead
    return [*row_contacts(ROW, ROW.frame()), contact("left.middle.pad", "root", middle + r * way, way)]


INSTRUMENTS = {"sousaphone_BBb": (build, contacts)}
