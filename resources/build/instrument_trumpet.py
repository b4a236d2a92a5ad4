"""The B flat trumpet and its near relations: trumpet in C, cornet, flugelhorn.

Sizes are those of common instruments. Trumpet: bore 11.7 mm, bell 123 mm, valves 27.5 mm apart, stroke 16.5 mm; from
the player's side the leadpipe passes right of the valves and the bell left of them, the tuning slide lies in
front on the leadpipe's side, the first slide points back to the player, the second to the right, the third
forward on the left. The trumpet in C has the same valves on a tube shorter by an eighth (bell 5 cm nearer). The cornet
(bell 119 mm) winds its conical tube once more, so that its valves are 5 cm nearer, and its bell's tail is a shepherd's
crook. The flugelhorn (bell 152 mm) leads its straight mouthpipe into the first valve; its wide tube leaves the third.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from resources.build.instrument_brass import BRASS, NICKEL, SILVER, Bell, X, Y, Z, brace, contact, on_round
from resources.build.instrument_mesh import (
    Array,
    Model,
    bend,
    half_circle,
    joined,
    plate,
    resampled,
    solid,
    torus,
    tube,
    turned,
    unit,
)

VALVE_X = 0.018
VALVE_APART = 0.0275
CASING_R = 0.0098
BUTTON_TOP_Y = 0.0680
TAIL_Y = -0.078
FIRST_Y = (-0.036, -0.060)
THIRD_Y = (-0.052, -0.076)
SADDLE_R, SADDLE_THICK = 0.0108, 0.0015
RING_R, RING_THICK = 0.0120, 0.0017
HOOK_R = 0.0105
SLIDE_X = VALVE_X + 0.004


@dataclass(frozen=True)
class Layout:
    """Places of the parts of one instrument, metres along its length from the rim of the mouthpiece.

    ``shank`` is the visible length of the mouthpiece, ``first_valve`` the axis of the first valve, ``front`` the bow in
    front of the leadpipe, ``rim`` the bell's rim, ``back`` the centre of its tail's bow.
    """

    shank: float
    first_valve: float
    front: float
    rim: float
    bell: Bell
    back: float
    bell_x: float = 0.0375
    saddle_ahead: float = 0.0
    middle_y: float = -0.0355
    third_bow: float = 0.0
    airway: str = "trumpet"

    @property
    def valves(self) -> tuple[float, float, float]:
        return (self.first_valve, self.first_valve + VALVE_APART, self.first_valve + 2 * VALVE_APART)

    @property
    def shift(self) -> float:
        """Return the distance by which the valves, and the parts around them, lie further ahead than a trumpet's, m."""
        return self.first_valve - TRUMPET_FIRST_VALVE

    @property
    def saddle(self) -> Array:
        return np.array([SLIDE_X, FIRST_Y[0] + 0.0062 + 0.0093, 0.1755 + self.shift + self.saddle_ahead])

    @property
    def ring(self) -> Array:
        return np.array([SLIDE_X, THIRD_Y[0] + 0.0062 + 0.0128, 0.3035 + self.shift])

    @property
    def hook(self) -> Array:
        return np.array([0.0, 0.0165, 0.2850 + self.shift])


TRUMPET_FIRST_VALVE = 0.205
TRUMPET = Layout(
    shank=0.072, first_valve=TRUMPET_FIRST_VALVE, front=0.386, rim=0.520, bell=Bell(0.0615, 0.0148, 0.65), back=0.130
)
TRUMPET_C = replace(TRUMPET, front=0.378, rim=0.472, back=0.140, third_bow=-0.008)
CORNET = Layout(
    shank=0.050, first_valve=0.152, front=0.322, rim=0.395, bell=Bell(0.0595, 0.0175, 0.70), back=0.048,
    bell_x=0.053, saddle_ahead=0.013, middle_y=-0.0380, airway="cornet",
)  # fmt: skip
FLUGELHORN = Layout(
    shank=0.052, first_valve=0.163, front=0.330, rim=0.460, bell=Bell(0.0760, 0.031, 0.86), back=0.080,
    bell_x=0.054, saddle_ahead=0.011, middle_y=-0.0380, airway="flugelhorn",
)  # fmt: skip


def build(at: Layout = TRUMPET) -> Model:
    """Build the model."""
    model = Model()
    for index, z in enumerate(at.valves, start=1):
        model.node(f"valve_{index}", (VALVE_X, BUTTON_TOP_Y, z))
    model.node("first_slide", at.saddle)
    model.node("third_slide", at.ring)
    _mouthpiece(model, at)
    AIRWAYS[at.airway](model, at)
    _valves(model, at)
    _bell(model, at)
    _first_slide(model, at)
    _second_slide(model, at)
    _third_slide(model, at)
    _hook(model, at)
    return model


def _mouthpiece(model: Model, at: Layout) -> None:
    profile = [
        (0.0150, 0.0005), (0.0130, 0.0020), (0.0105, 0.0050), (0.0070, 0.0072), (0.0030, 0.0081), (0.0012, 0.0084),
        (0.0003, 0.0092), (0.0, 0.0105), (0.0004, 0.0120), (0.0016, 0.0131), (0.0034, 0.0135), (0.0070, 0.0135),
        (0.0090, 0.0131), (0.0100, 0.0124), (0.0150, 0.0121), (0.0200, 0.0112), (0.0250, 0.0094), (0.0290, 0.0074),
        (0.0330, 0.0062), (0.0390, 0.0055), (0.0450, 0.0053), (at.shank, 0.0050), (at.shank, 0.0),
    ]  # fmt: skip
    model.add(SILVER, turned((0, 0, 0), Z, profile, sides=48, hard_deg=50))


def _receiver(model: Model, at: Layout) -> None:
    receiver = [
        (0, 0.0074), (0.0012, 0.0079), (0.0030, 0.0079), (0.0040, 0.0074), (0.022, 0.0072), (0.030, 0.0070),
        (0.0312, 0.0066),
    ]  # fmt: skip
    model.add(NICKEL, solid((0, 0, at.shank - 0.008), Z, receiver))


def _ferrule(model: Model, place: tuple[float, float, float], radius: float, length: float) -> None:
    model.add(NICKEL, solid(place, Z, [(0, radius), (length, radius)]))


def _tuning_slide(model: Model, at: Layout, low: float) -> None:
    """The leadpipe beside the valves and the bow in front of it, back to where the lower leg ends."""
    model.add(BRASS, tube([(0, 0, at.shank + 0.023), (0, 0, at.front - 0.080)], [0.0060, 0.0063]))
    _ferrule(model, (0, 0, at.front - 0.090), 0.0070, 0.022)
    model.add(NICKEL, tube([(0, 0, at.front - 0.081), (0, 0, at.front - 0.034)], 0.0062))
    model.add(NICKEL, tube([(0, low, at.front - 0.074), (0, low, at.front - 0.034)], 0.0062))
    bow = half_circle((0, 0, at.front), (0, low, at.front), Z, 28)
    model.add(BRASS, tube(joined((0, 0, at.front - 0.044), bow, (0, low, at.front - 0.044)), 0.0068))
    for y in (0.0, low):
        ferrule = [(0, 0.0076), (0.0015, 0.0080), (0.0045, 0.0080), (0.006, 0.0076)]
        model.add(NICKEL, solid((0, y, at.front - 0.0465), Z, ferrule))
    model.add(BRASS, brace((0, -0.0060, at.front - 0.023), (0, low + 0.0060, at.front - 0.023)))
    _water_key(model, "root", np.array([0, low - 0.0066, at.front - 0.005]), back=-Z)


def _through_third_valve(model: Model, at: Layout) -> None:
    """Trumpet: leadpipe, tuning slide, third valve."""
    _receiver(model, at)
    low, last = TAIL_Y + 0.022, at.valves[2]
    _tuning_slide(model, at, low)
    into_valve = bend(
        [(0, low, at.front - 0.068), (0, low, last + 0.028), (0.0085, low, last + 0.0115), (VALVE_X, low, last)],
        [0.02, 0.02],
    )
    # Its first stretch runs along Z but for the last bit, which differs from processor to processor.
    model.add(BRASS, tube(into_valve, 0.0066, side=Y))
    _ferrule(model, (0, low, at.front - 0.084), 0.0073, 0.016)


def _wound_once_more(model: Model, at: Layout) -> None:
    """Cornet: the tuning slide's lower leg goes back beneath the hand and round once more to the third valve."""
    _receiver(model, at)
    low, lower = TAIL_Y + 0.022, TAIL_Y - 0.012
    x, back, last = -0.006, at.first_valve - 0.052, at.valves[2]
    _tuning_slide(model, at, low)
    leg = bend([(0, low, at.front - 0.068), (0, low, last + 0.040), (x, low, last + 0.010), (x, low, back)], 0.03)
    bow = half_circle((x, low, back), (x, lower, back), -Z, 20)
    on = bend([(x, lower, back), (x, lower, last - 0.014), (VALVE_X, lower + 0.016, last)], 0.014)
    model.add(BRASS, tube(joined(leg, bow, on), 0.0066))
    _ferrule(model, (0, low, at.front - 0.084), 0.0073, 0.016)
    for y in (low, lower):
        _ferrule(model, (x, y, back + 0.006), 0.0074, 0.012)


def _through_first_valve(model: Model, at: Layout) -> None:
    """Flugelhorn: a straight mouthpipe that is drawn to tune, into the first valve; a stay along the valves carries the
    thumb and the hook."""
    _receiver(model, at)
    first, last = at.valves[0], at.valves[2]
    model.add(NICKEL, tube([(0, 0, at.shank + 0.020), (0, 0, first - 0.050)], 0.0056))
    model.add(BRASS, tube([(0, 0, first - 0.070), (0, 0, first - 0.020)], 0.0068))
    into_valve = bend([(0, 0, first - 0.030), (0, 0, first - 0.012), (VALVE_X, -0.012, first)], 0.010)
    model.add(BRASS, tube(into_valve, 0.0064))
    screw = [(0, 0), (0, 0.0022), (0.008, 0.0022), (0.009, 0.0055), (0.011, 0.0055), (0.012, 0.0)]
    model.add(NICKEL, turned((0, 0.005, first - 0.064), Y, screw, sides=18))
    model.add(BRASS, tube([(0, 0, first - 0.012), (0, 0, last + 0.036)], 0.0062))
    model.add(BRASS, brace((0.0040, 0, last), (VALVE_X - CASING_R + 0.001, 0, last), 0.0024))


def _water_key(model: Model, node: str, place: Array, back: Array) -> None:
    """Nipple, lever and thumb plate under a bow."""
    down = -Y
    model.add(BRASS, solid(place - 0.001 * down, down, [(0, 0.0035), (0.004, 0.0035)]), node=node)
    model.add("cork", solid(place + 0.003 * down, down, [(0, 0.0030), (0.0014, 0.0030)]), node=node)
    arm = bend(
        [place + 0.0048 * down, place + 0.0052 * down + 0.014 * back, place + 0.0022 * down + 0.032 * back], 0.012
    )
    model.add(NICKEL, tube(arm, 0.0022, flat=(0.6, 1.2), side=Y, sides=12), node=node)
    model.add(
        NICKEL,
        tube(
            [place + 0.003 * down + 0.013 * back - 0.0042 * X, place + 0.003 * down + 0.013 * back + 0.0042 * X],
            0.0017,
            sides=12,
        ),
        node=node,
    )


def _valves(model: Model, at: Layout) -> None:
    for index, z in enumerate(at.valves, start=1):
        foot = np.array([VALVE_X, 0, z])
        casing = [
            (-0.0885, CASING_R), (-0.030, CASING_R), (-0.0295, 0.0101), (-0.0265, 0.0101), (-0.026, CASING_R),
            (0.0285, CASING_R),
        ]  # fmt: skip
        model.add(NICKEL, solid(foot, Y, casing, sides=40))
        top = [
            (0.0265, 0.0106), (0.0275, 0.0112), (0.0325, 0.0112), (0.0335, 0.0106), (0.0355, 0.0090), (0.0375, 0.0060),
            (0.0380, 0.0050),
        ]  # fmt: skip
        model.add(SILVER, solid(foot, Y, top, sides=40))
        bottom = [
            (-0.1010, 0.0028), (-0.0995, 0.0036), (-0.0985, 0.0036), (-0.0975, 0.0085), (-0.0960, 0.0106),
            (-0.0885, 0.0112), (-0.0870, 0.0112), (-0.0860, 0.0106),
        ]  # fmt: skip
        model.add(SILVER, solid(foot, Y, bottom, sides=40))
        model.add("felt", solid(foot, Y, [(0.0378, 0.0062), (0.0404, 0.0062)]))
        node = f"valve_{index}"
        model.add(SILVER, solid(foot, Y, [(0.020, 0.0026), (0.0615, 0.0026)], sides=18), node=node)
        model.add(NICKEL, solid(foot, Y, [(-0.065, 0.0084), (0.020, 0.0084)]), node=node)
        button = [
            (0.0590, 0.0034), (0.0600, 0.0050), (0.0612, 0.0078), (0.0622, 0.0085), (0.0664, 0.0085), (0.0674, 0.0080),
            (0.0678, 0.0074), (0.0676, 0.0070),
        ]  # fmt: skip
        model.add(SILVER, solid(foot, Y, button, sides=36), node=node)
        pearl = [(0.0670, 0.0071), (0.0677, 0.0071), (0.0679, 0.0066), (BUTTON_TOP_Y, 0.0050)]
        model.add("pearl", solid(foot, Y, pearl, sides=36), node=node)
    for low, high, y in ((0, 1, -0.045), (1, 2, -0.040), (0, 1, -0.066), (1, 2, -0.064)):
        knuckle = [(VALVE_X, y, at.valves[low]), (VALVE_X, y, at.valves[high])]
        model.add(BRASS, tube(knuckle, 0.0062))
    for z in (at.valves[0], at.valves[2]):
        model.add(BRASS, solid((0.003, 0, z), X, [(0, 0.004), (0.009, 0.004)]))


def _bell(model: Model, at: Layout) -> None:
    line, start = TAILS[at.airway](at)
    first_r = 0.0064
    begin = float(line[-1, 2]) + 0.002
    stem = resampled(np.array([(at.bell_x, 0, begin), (at.bell_x, 0, at.rim - 0.22)]), 0.02)
    flare_z = at.rim - np.geomspace(0.0005, 0.22, 44)[::-1]
    stem = joined(line, stem, np.column_stack([np.full_like(flare_z, at.bell_x), np.zeros_like(flare_z), flare_z]))
    share = np.linspace(0, 1, len(line))
    radius = first_r + share * (float(at.bell.radius(at.rim - begin)) - first_r)
    radii = np.r_[radius, at.bell.radius(at.rim - stem[len(line) :, 2])]
    model.add(BRASS, tube(stem, radii, sides=56, closed=False))
    around = torus((at.bell_x, 0, at.rim), Z, at.bell.rim_r - 0.0006, 0.0011, around=64, sides=12)
    model.add(BRASS, around)
    inner_z = at.rim - np.geomspace(0.0005, 0.22, 36)
    inside = np.column_stack([np.full_like(inner_z, at.bell_x), np.zeros_like(inner_z), inner_z])
    model.add(
        "inner_brass", tube(inside, at.bell.radius(at.rim - inner_z) - 0.0006, sides=56, closed=False, proxy=False)
    )
    for z in (at.first_valve - 0.042, at.front - 0.056):
        edge = at.bell_x - float(at.bell.radius(at.rim - z))
        model.add(BRASS, brace((0.0060, 0, z), (edge, 0, z)))
    low = start - float(np.interp(0.5, share, radius)) + 0.0066
    model.add(BRASS, brace((at.bell_x, low, at.back + 0.010), (at.bell_x, -0.0073, at.back + 0.010), 0.0018))


def _plain_tail(at: Layout) -> tuple[Array, float]:
    """From the first valve back and round to the bell's stem; and how high its lower leg lies."""
    first = at.first_valve
    tail = bend(
        [(VALVE_X, TAIL_Y, first), (0.023, TAIL_Y, first - 0.013), (at.bell_x, TAIL_Y, at.back + 0.028),
         (at.bell_x, TAIL_Y, at.back + 0.001)],
        0.03,
    )  # fmt: skip
    return joined(tail, half_circle((at.bell_x, TAIL_Y, at.back), (at.bell_x, 0, at.back), -Z, 32)), TAIL_Y


def _crook(at: Layout) -> tuple[Array, float]:
    """The cornet's tail: a bow wider than the tubes it joins, like a shepherd's crook."""
    x, first, high, bow_r = at.bell_x, at.first_valve, 0.010, 0.044
    tail = bend(
        [(VALVE_X, TAIL_Y, first), (0.024, TAIL_Y, first - 0.012), (x, TAIL_Y, first - 0.046),
         (x, TAIL_Y, at.back + bow_r)],
        [0.02, 0.03],
    )  # fmt: skip
    bow = half_circle((x, TAIL_Y, at.back + bow_r - 0.012), (x, high, at.back + bow_r - 0.012), -Z, 32)
    share = np.linspace(0, 1, 16)[1:, None]
    down = np.array([x, high, at.back + bow_r - 0.012]) + share * [0, 0, 0.06]
    down[:, 1:2] = high * (1 - share * share * (3 - 2 * share))
    return joined(tail, bow, down), TAIL_Y


def _wide_tail(at: Layout) -> tuple[Array, float]:
    """The flugelhorn's: from the third valve ahead, round, back beneath the hands and round to the bell's stem."""
    x, last, low = at.bell_x, at.valves[2], -0.142
    ahead = bend([(VALVE_X, TAIL_Y, last), (0.026, TAIL_Y, last + 0.02), (x, TAIL_Y, at.front)], 0.03)
    bow = half_circle((x, TAIL_Y, at.front), (x, low, at.front), Z, 24)
    return joined(ahead, bow, half_circle((x, low, at.back), (x, 0, at.back), -Z, 32)), low


def _first_slide(model: Model, at: Layout) -> None:
    x, ahead = SLIDE_X, at.shift
    for y in FIRST_Y:
        model.add(NICKEL, tube([(x, y, 0.156 + ahead), (x, y, 0.199 + ahead)], 0.0055))
        model.add(NICKEL, solid((x, y, 0.1905 + ahead), Z, [(0, 0.0066), (0.012, 0.0066)]))
    bow = half_circle((x, FIRST_Y[0], 0.1520 + ahead), (x, FIRST_Y[1], 0.1520 + ahead), -Z)
    model.add(
        BRASS,
        tube(joined((x, FIRST_Y[0], 0.1890 + ahead), bow, (x, FIRST_Y[1], 0.1890 + ahead)), 0.0062),
        node="first_slide",
    )
    angles = np.radians(np.linspace(168, 372, 26))
    cradle = at.saddle + SADDLE_R * np.column_stack([np.zeros_like(angles), np.sin(angles), np.cos(angles)])
    model.add(NICKEL, tube(cradle, SADDLE_THICK, flat=(1.0, 3.2), side=Y, sides=16, proxy=False), node="first_slide")
    _strap_proxies(model, "first_slide", cradle, SADDLE_THICK, 3.2 * SADDLE_THICK)


def _strap_proxies(model: Model, node: str, line: Array, half_thick: float, half_wide: float) -> None:
    """Boxes that stand for a strap which lies across the instrument (wide along X)."""
    part = model.parts[-1]
    boxes: list[dict[str, object]] = []
    for a, b in zip(line[:-1:2], line[2::2], strict=False):
        along = (b - a) / np.linalg.norm(b - a)
        half = np.array([half_wide, np.linalg.norm(b - a) / 2, half_thick])
        boxes.append({"shape": "box", "centre_m": (a + b) / 2, "half_m": half, "x_axis": X, "y_axis": along})
    model.parts[-1] = replace(part, shape=replace(part.shape, proxies=tuple(boxes)))


def _second_slide(model: Model, at: Layout) -> None:
    z = at.valves[1]
    ahead = np.array([-0.985, -0.10, 0.14]) / np.linalg.norm([-0.985, -0.10, 0.14])
    upper, lower = np.array([VALVE_X, -0.038, z]), np.array([VALVE_X, -0.060, z])
    for start in (upper, lower):
        model.add(NICKEL, tube([start + 0.006 * ahead, start + 0.030 * ahead], 0.0056))
        model.add(NICKEL, solid(start + 0.007 * ahead, ahead, [(0, 0.0066), (0.011, 0.0066)]))
    bow = half_circle(upper + 0.034 * ahead, lower + 0.034 * ahead, ahead)
    model.add(BRASS, tube(joined(upper + 0.020 * ahead, bow, lower + 0.020 * ahead), 0.0062))
    knob = (upper + lower) / 2 + (0.034 + 0.011 + 0.0058) * ahead
    model.add(
        NICKEL, solid(knob, ahead, [(0, 0.0022), (0.004, 0.0018), (0.0055, 0.0042), (0.008, 0.0044), (0.009, 0.0030)])
    )


def _third_slide(model: Model, at: Layout) -> None:
    x, ahead = SLIDE_X, at.shift
    end = ahead + at.third_bow
    for y in THIRD_Y:
        model.add(NICKEL, tube([(x, y, 0.266 + ahead), (x, y, 0.352 + end)], 0.0055))
        model.add(NICKEL, solid((x, y, 0.267 + ahead), Z, [(0, 0.0066), (0.026, 0.0066)]))
    bow = half_circle((x, THIRD_Y[0], 0.3700 + end), (x, THIRD_Y[1], 0.3700 + end), Z)
    model.add(
        BRASS,
        tube(joined((x, THIRD_Y[0], 0.2945 + ahead), bow, (x, THIRD_Y[1], 0.2945 + ahead)), 0.0062),
        node="third_slide",
    )
    model.add(NICKEL, torus(at.ring, X, RING_R, RING_THICK), node="third_slide")
    model.add(NICKEL, plate((x, THIRD_Y[0] + 0.0062, at.ring[2]), (0.0025, 0.0012, 0.006), X, Y), node="third_slide")
    model.add(
        BRASS,
        brace((x, THIRD_Y[0] - 0.006, 0.355 + end), (x, THIRD_Y[1] + 0.006, 0.355 + end), 0.0018),
        node="third_slide",
    )
    _water_key(model, "third_slide", np.array([x, THIRD_Y[1] - 0.0060, 0.366 + end]), back=-Z)


def _hook(model: Model, at: Layout) -> None:
    angles = np.radians(np.linspace(-100, 135, 30))
    strap = at.hook + HOOK_R * np.column_stack([np.zeros_like(angles), np.sin(angles), np.cos(angles)])
    model.add(BRASS, tube(strap, 0.0011, flat=(1.0, 3.2), side=Y, sides=16, proxy=False))
    _strap_proxies(model, "root", strap, 0.0011, 3.2 * 0.0011)
    model.add(BRASS, plate((0, 0.0062, at.hook[2]), (0.0036, 0.0010, 0.009), X, Y))


def contacts(at: Layout = TRUMPET) -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    first, _, last = at.valves
    inside, within, ahead = unit([0, 0.985, -0.174]), unit([0, 0.65, 0.76]), np.array([0, 0.6, -0.8])
    casing = np.array([-0.42, 0, 0.907])
    return [
        *(
            contact(f"right.{finger}.pad", f"valve_{k}", np.array([VALVE_X, BUTTON_TOP_Y, z]), Y, f"valve_{k}")
            for k, (finger, z) in enumerate(zip(("index", "middle", "ring"), at.valves, strict=True), start=1)
        ),
        # Under the leadpipe, between the first two valves: it opposes the fingers.
        contact("right.thumb.pad", "root", *on_round(Z * (first + 0.0138), 0.0062, np.array([-0.7, -0.714, 0]))),
        # The hook is open towards the player: the little finger lies in it and presses down.
        contact("right.little.pad", "root", at.hook - (HOOK_R - 0.0011) * inside, inside),
        contact("left.index.pad", "root", *on_round(np.array([VALVE_X, -0.0185, last]), CASING_R, casing)),
        contact("left.middle.pad", "root", *on_round(np.array([VALVE_X, at.middle_y, last]), CASING_R, casing)),
        contact("left.ring.pad", "third_slide", at.ring - (RING_R - RING_THICK) * within, within, "third_slide"),
        contact("left.thumb.pad", "first_slide", at.saddle - (SADDLE_R - SADDLE_THICK) * ahead, ahead, "first_slide"),
    ]


AIRWAYS = {"trumpet": _through_third_valve, "cornet": _wound_once_more, "flugelhorn": _through_first_valve}
TAILS = {"trumpet": _plain_tail, "cornet": _crook, "flugelhorn": _wide_tail}
INSTRUMENTS = {
    name: (partial(build, at), partial(contacts, at))
    for name, at in (
        ("trumpet_Bb", TRUMPET),
        ("trumpet_C", TRUMPET_C),
        ("cornet_Bb", CORNET),
        ("flugelhorn_Bb", FLUGELHORN),
    )
}
