"""The B flat trumpet: a medium-large bore instrument with the usual layout.

Sizes are those of common instruments (bore 11.7 mm, bell 123 mm, valves 27.5 mm apart, stroke 16.5 mm); from
the player's side the leadpipe passes right of the valves and the bell left of them, the tuning slide lies in
front on the leadpipe's side, the first slide points back to the player, the second to the right, the third
forward on the left.
"""

from __future__ import annotations

import numpy as np

from resources.build.instrument_mesh import (
    Array,
    Model,
    Shape,
    bend,
    half_circle,
    joined,
    plate,
    resampled,
    torus,
    tube,
    turned,
)

X, Y, Z = np.eye(3)
VALVE_X = 0.018
VALVE_Z = (0.205, 0.2325, 0.260)
CASING_R = 0.0098
BUTTON_TOP_Y = 0.0680
STROKE_M = 0.0165
FIRST_TRAVEL_M = 0.020
THIRD_TRAVEL_M = 0.035
BELL_X = 0.0375
BELL_Z = 0.520
BELL_R = 0.0615
TAIL_Y = -0.078
FIRST_Y = (-0.036, -0.060)
THIRD_Y = (-0.052, -0.076)
SADDLE = np.array([VALVE_X + 0.004, FIRST_Y[0] + 0.0062 + 0.0093, 0.1755])
SADDLE_R, SADDLE_THICK = 0.0108, 0.0015
RING = np.array([VALVE_X + 0.004, THIRD_Y[0] + 0.0062 + 0.0128, 0.3035])
RING_R, RING_THICK = 0.0120, 0.0017
HOOK = np.array([0.0, 0.0165, 0.2850])
HOOK_R = 0.0105
SLIDE_X = VALVE_X + 0.004


def build() -> Model:
    """Build the model."""
    model = Model()
    for index, z in enumerate(VALVE_Z, start=1):
        model.node(f"valve_{index}", (VALVE_X, BUTTON_TOP_Y, z))
    model.node("first_slide", SADDLE)
    model.node("third_slide", RING)
    _mouthpiece(model)
    _leadpipe_and_tuning_slide(model)
    _valves(model)
    _bell(model)
    _first_slide(model)
    _second_slide(model)
    _third_slide(model)
    _hook(model)
    return model


def _mouthpiece(model: Model) -> None:
    profile = [
        (0.0150, 0.0005), (0.0130, 0.0020), (0.0105, 0.0050), (0.0070, 0.0072), (0.0030, 0.0081), (0.0012, 0.0084),
        (0.0003, 0.0092), (0.0, 0.0105), (0.0004, 0.0120), (0.0016, 0.0131), (0.0034, 0.0135), (0.0070, 0.0135),
        (0.0090, 0.0131), (0.0100, 0.0124), (0.0150, 0.0121), (0.0200, 0.0112), (0.0250, 0.0094), (0.0290, 0.0074),
        (0.0330, 0.0062), (0.0390, 0.0055), (0.0450, 0.0053), (0.0560, 0.0054), (0.0720, 0.0050), (0.0720, 0.0),
    ]  # fmt: skip
    model.add("silver", turned((0, 0, 0), Z, profile, sides=48, hard_deg=50))


def _leadpipe_and_tuning_slide(model: Model) -> None:
    receiver = [
        (0, 0), (0, 0.0074), (0.0012, 0.0079), (0.0030, 0.0079), (0.0040, 0.0074), (0.022, 0.0072), (0.030, 0.0070),
        (0.0312, 0.0066), (0.0312, 0.0)
    ]  # fmt: skip
    model.add("nickel_silver", turned((0, 0, 0.0640), Z, receiver))
    model.add("lacquered_brass", tube([(0, 0, 0.095), (0, 0, 0.306)], [0.0060, 0.0063]))
    low = TAIL_Y + 0.022
    model.add("nickel_silver", turned((0, 0, 0.296), Z, [(0, 0), (0, 0.0070), (0.022, 0.0070), (0.022, 0.0)]))
    model.add("nickel_silver", tube([(0, 0, 0.305), (0, 0, 0.352)], 0.0062))
    model.add("nickel_silver", tube([(0, low, 0.312), (0, low, 0.352)], 0.0062))
    bow = half_circle((0, 0, 0.386), (0, low, 0.386), Z, 28)
    model.add("lacquered_brass", tube(joined((0, 0, 0.342), bow, (0, low, 0.342)), 0.0068))
    for y in (0.0, low):
        ferrule = [(0, 0), (0, 0.0076), (0.0015, 0.0080), (0.0045, 0.0080), (0.006, 0.0076), (0.006, 0.0)]
        model.add("nickel_silver", turned((0, y, 0.3395), Z, ferrule))
    into_valve = bend(
        [(0, low, 0.318), (0, low, 0.288), (0.0085, low, 0.2715), (VALVE_X, low, VALVE_Z[2])], [0.02, 0.02]
    )
    model.add("lacquered_brass", tube(into_valve, 0.0066))
    model.add("nickel_silver", turned((0, low, 0.302), Z, [(0, 0), (0, 0.0073), (0.016, 0.0073), (0.016, 0.0)]))
    model.add("lacquered_brass", _brace((0, -0.0060, 0.363), (0, low + 0.0060, 0.363)))
    _water_key(model, "root", np.array([0, low - 0.0066, 0.381]), back=-Z)


def _brace(start: tuple[float, float, float], end: tuple[float, float, float], thick: float = 0.0022) -> Shape:
    """A turned stay between two tubes, with a flange at either end and a bead in the middle."""
    a, b = np.array(start), np.array(end)
    length = float(np.linalg.norm(b - a))
    t, m = thick, length / 2
    profile = [
        (-0.001, 0), (-0.001, 2.3 * t), (0.0012, 2.2 * t), (0.0022, 1.15 * t), (0.0035, t), (m - 2 * t, t),
        (m - t, 1.5 * t), (m, 1.7 * t), (m + t, 1.5 * t), (m + 2 * t, t), (length - 0.0035, t),
        (length - 0.0022, 1.15 * t), (length - 0.0012, 2.2 * t), (length + 0.001, 2.3 * t), (length + 0.001, 0),
    ]  # fmt: skip
    return turned(a, b - a, profile, sides=18)


def _water_key(model: Model, node: str, place: Array, back: Array) -> None:
    """Nipple, lever and thumb plate under a bow."""
    down = -Y
    model.add(
        "lacquered_brass",
        turned(place - 0.001 * down, down, [(0, 0), (0, 0.0035), (0.004, 0.0035), (0.004, 0)]),
        node=node,
    )
    model.add(
        "cork", turned(place + 0.003 * down, down, [(0, 0), (0, 0.0030), (0.0014, 0.0030), (0.0014, 0)]), node=node
    )
    arm = bend(
        [place + 0.0048 * down, place + 0.0052 * down + 0.014 * back, place + 0.0022 * down + 0.032 * back], 0.012
    )
    model.add("nickel_silver", tube(arm, 0.0022, flat=(0.6, 1.2), side=Y, sides=12), node=node)
    model.add(
        "nickel_silver",
        tube(
            [place + 0.003 * down + 0.013 * back - 0.0042 * X, place + 0.003 * down + 0.013 * back + 0.0042 * X],
            0.0017,
            sides=12,
        ),
        node=node,
    )


def _valves(model: Model) -> None:
    for index, z in enumerate(VALVE_Z, start=1):
        foot = np.array([VALVE_X, 0, z])
        casing = [
            (-0.0885, 0), (-0.0885, CASING_R), (-0.030, CASING_R), (-0.0295, 0.0101), (-0.0265, 0.0101),
            (-0.026, CASING_R), (0.0285, CASING_R), (0.0285, 0),
        ]  # fmt: skip
        model.add("nickel_silver" if index else "", turned(foot, Y, casing, sides=40))
        top = [
            (0.0265, 0), (0.0265, 0.0106), (0.0275, 0.0112), (0.0325, 0.0112), (0.0335, 0.0106), (0.0355, 0.0090),
            (0.0375, 0.0060), (0.0380, 0.0050), (0.0380, 0),
        ]  # fmt: skip
        model.add("silver", turned(foot, Y, top, sides=40))
        bottom = [
            (-0.1010, 0), (-0.1010, 0.0028), (-0.0995, 0.0036), (-0.0985, 0.0036), (-0.0975, 0.0085),
            (-0.0960, 0.0106), (-0.0885, 0.0112), (-0.0870, 0.0112), (-0.0860, 0.0106), (-0.0860, 0),
        ]  # fmt: skip
        model.add("silver", turned(foot, Y, bottom, sides=40))
        model.add("felt", turned(foot, Y, [(0.0378, 0), (0.0378, 0.0062), (0.0404, 0.0062), (0.0404, 0)]))
        node = f"valve_{index}"
        model.add(
            "silver", turned(foot, Y, [(0.020, 0), (0.020, 0.0026), (0.0615, 0.0026), (0.0615, 0)], sides=18), node=node
        )
        model.add(
            "nickel_silver", turned(foot, Y, [(-0.065, 0), (-0.065, 0.0084), (0.020, 0.0084), (0.020, 0)]), node=node
        )
        button = [
            (0.0590, 0), (0.0590, 0.0034), (0.0600, 0.0050), (0.0612, 0.0078), (0.0622, 0.0085), (0.0664, 0.0085),
            (0.0674, 0.0080), (0.0678, 0.0074), (0.0676, 0.0070), (0.0676, 0),
        ]  # fmt: skip
        model.add("silver", turned(foot, Y, button, sides=36), node=node)
        pearl = [
            (0.0670, 0),
            (0.0670, 0.0071),
            (0.0677, 0.0071),
            (0.0679, 0.0066),
            (BUTTON_TOP_Y, 0.0050),
            (BUTTON_TOP_Y, 0),
        ]
        model.add("pearl", turned(foot, Y, pearl, sides=36), node=node)
    for low, high, y in ((0, 1, -0.045), (1, 2, -0.040), (0, 1, -0.066), (1, 2, -0.064)):
        knuckle = [(VALVE_X, y, VALVE_Z[low]), (VALVE_X, y, VALVE_Z[high])]
        model.add("lacquered_brass", tube(knuckle, 0.0062))
    for z in (VALVE_Z[0], VALVE_Z[2]):
        model.add("lacquered_brass", turned((0.003, 0, z), X, [(0, 0), (0, 0.004), (0.009, 0.004), (0.009, 0)]))


def bell_radius(distance: Array) -> Array:
    """Outer radius of the bell at a distance from its rim: a Bessel horn."""
    return BELL_R * (0.0148 / (0.0148 + distance)) ** 0.65


def _bell(model: Model) -> None:
    mid = (TAIL_Y) / 2
    tail = bend(
        [(VALVE_X, TAIL_Y, VALVE_Z[0]), (0.023, TAIL_Y, 0.192), (BELL_X, TAIL_Y, 0.158), (BELL_X, TAIL_Y, 0.131)], 0.03
    )
    bow = half_circle((BELL_X, TAIL_Y, 0.130), (BELL_X, 0, 0.130), -Z, 32)
    line = joined(tail, bow)
    share = np.linspace(0, 1, len(line))
    radius = 0.0064 + share * (float(bell_radius(np.array(BELL_Z - 0.131))) - 0.0064)
    stem = resampled(np.array([(BELL_X, 0, 0.132), (BELL_X, 0, 0.30)]), 0.02)
    flare_z = BELL_Z - np.geomspace(0.0005, BELL_Z - 0.30, 44)[::-1]
    stem = joined(line, stem, np.column_stack([np.full_like(flare_z, BELL_X), np.zeros_like(flare_z), flare_z]))
    radii = np.r_[radius, bell_radius(BELL_Z - stem[len(line) :, 2])]
    model.add("lacquered_brass", tube(stem, radii, sides=56, closed=False))
    model.add("lacquered_brass", torus((BELL_X, 0, BELL_Z), Z, BELL_R - 0.0006, 0.0011, around=64, sides=12))
    inner_z = BELL_Z - np.geomspace(0.0005, 0.22, 36)
    inside = np.column_stack([np.full_like(inner_z, BELL_X), np.zeros_like(inner_z), inner_z])
    model.add("inner_brass", tube(inside, bell_radius(BELL_Z - inner_z) - 0.0006, sides=56, closed=False, proxy=False))
    for z in (0.163, 0.330):
        edge = BELL_X - float(bell_radius(np.array(BELL_Z - z)))
        model.add("lacquered_brass", _brace((0.0060, 0, z), (edge, 0, z)))
    model.add("lacquered_brass", _brace((BELL_X, mid * 2 + 0.0066, 0.140), (BELL_X, -0.0073, 0.140), 0.0018))


def _first_slide(model: Model) -> None:
    x = SLIDE_X
    for y in FIRST_Y:
        model.add("nickel_silver", tube([(x, y, 0.156), (x, y, 0.199)], 0.0055))
        model.add("nickel_silver", turned((x, y, 0.1905), Z, [(0, 0), (0, 0.0066), (0.012, 0.0066), (0.012, 0)]))
    bow = half_circle((x, FIRST_Y[0], 0.1520), (x, FIRST_Y[1], 0.1520), -Z)
    model.add(
        "lacquered_brass",
        tube(joined((x, FIRST_Y[0], 0.1890), bow, (x, FIRST_Y[1], 0.1890)), 0.0062),
        node="first_slide",
    )
    angles = np.radians(np.linspace(168, 372, 26))
    cradle = SADDLE + SADDLE_R * np.column_stack([np.zeros_like(angles), np.sin(angles), np.cos(angles)])
    model.add(
        "nickel_silver", tube(cradle, SADDLE_THICK, flat=(1.0, 3.2), side=Y, sides=16, proxy=False), node="first_slide"
    )
    _strap_proxies(model, "first_slide", cradle, SADDLE_THICK, 3.2 * SADDLE_THICK)


def _strap_proxies(model: Model, node: str, line: Array, half_thick: float, half_wide: float) -> None:
    """Boxes that stand for a strap which lies across the instrument (wide along X)."""
    from dataclasses import replace

    part = model.parts[-1]
    boxes: list[dict[str, object]] = []
    for a, b in zip(line[:-1:2], line[2::2], strict=False):
        along = (b - a) / np.linalg.norm(b - a)
        half = np.array([half_wide, np.linalg.norm(b - a) / 2, half_thick])
        boxes.append({"shape": "box", "centre_m": (a + b) / 2, "half_m": half, "x_axis": X, "y_axis": along})
    model.parts[-1] = replace(part, shape=replace(part.shape, proxies=tuple(boxes)))


def _second_slide(model: Model) -> None:
    z = VALVE_Z[1]
    ahead = np.array([-0.985, -0.10, 0.14]) / np.linalg.norm([-0.985, -0.10, 0.14])
    upper, lower = np.array([VALVE_X, -0.038, z]), np.array([VALVE_X, -0.060, z])
    for start in (upper, lower):
        model.add("nickel_silver", tube([start + 0.006 * ahead, start + 0.030 * ahead], 0.0056))
        model.add(
            "nickel_silver", turned(start + 0.007 * ahead, ahead, [(0, 0), (0, 0.0066), (0.011, 0.0066), (0.011, 0)])
        )
    bow = half_circle(upper + 0.034 * ahead, lower + 0.034 * ahead, ahead)
    model.add("lacquered_brass", tube(joined(upper + 0.020 * ahead, bow, lower + 0.020 * ahead), 0.0062))
    knob = (upper + lower) / 2 + (0.034 + 0.011 + 0.0058) * ahead
    model.add(
        "nickel_silver",
        turned(
            knob,
            ahead,
            [(0, 0), (0, 0.0022), (0.004, 0.0018), (0.0055, 0.0042), (0.008, 0.0044), (0.009, 0.0030), (0.009, 0)],
        ),
    )


def _third_slide(model: Model) -> None:
    x = SLIDE_X
    for y in THIRD_Y:
        model.add("nickel_silver", tube([(x, y, 0.266), (x, y, 0.352)], 0.0055))
        model.add("nickel_silver", turned((x, y, 0.267), Z, [(0, 0), (0, 0.0066), (0.026, 0.0066), (0.026, 0)]))
    bow = half_circle((x, THIRD_Y[0], 0.3700), (x, THIRD_Y[1], 0.3700), Z)
    model.add(
        "lacquered_brass",
        tube(joined((x, THIRD_Y[0], 0.2945), bow, (x, THIRD_Y[1], 0.2945)), 0.0062),
        node="third_slide",
    )
    model.add("nickel_silver", torus(RING, X, RING_R, RING_THICK), node="third_slide")
    model.add(
        "nickel_silver", plate((x, THIRD_Y[0] + 0.0062, RING[2]), (0.0025, 0.0012, 0.006), X, Y), node="third_slide"
    )
    model.add(
        "lacquered_brass",
        _brace((x, THIRD_Y[0] - 0.006, 0.355), (x, THIRD_Y[1] + 0.006, 0.355), 0.0018),
        node="third_slide",
    )
    _water_key(model, "third_slide", np.array([x, THIRD_Y[1] - 0.0060, 0.366]), back=-Z)


def _hook(model: Model) -> None:
    angles = np.radians(np.linspace(-100, 135, 30))
    strap = HOOK + HOOK_R * np.column_stack([np.zeros_like(angles), np.sin(angles), np.cos(angles)])
    model.add("lacquered_brass", tube(strap, 0.0011, flat=(1.0, 3.2), side=Y, sides=16, proxy=False))
    _strap_proxies(model, "root", strap, 0.0011, 3.2 * 0.0011)
    model.add("lacquered_brass", plate((0, 0.0062, HOOK[2]), (0.0036, 0.0010, 0.009), X, Y))


def _on(centre: Array, radius: float, normal: Array) -> tuple[Array, Array]:
    direction = normal / np.linalg.norm(normal)
    return centre + radius * direction, direction


def contacts() -> list[dict[str, object]]:
    """Where a trained player's hands touch it, in the root frame."""
    found: list[dict[str, object]] = []

    def touch(part: str, node: str, place: tuple[Array, Array], control: str | None = None, grip: str = "firm") -> None:
        found.append(
            {"part": part, "node": node, "point": place[0], "normal": place[1], "control": control, "grip": grip}
        )

    for finger, index in (("index", 1), ("middle", 2), ("ring", 3)):
        top = np.array([VALVE_X, BUTTON_TOP_Y, VALVE_Z[index - 1]])
        touch(f"right.{finger}.pad", f"valve_{index}", (top, Y), f"valve_{index}")
    # Under the leadpipe, between the first two valves: it opposes the fingers.
    touch("right.thumb.pad", "root", _on(np.array([0, 0, 0.2188]), 0.0062, np.array([-0.7, -0.714, 0])))
    # The hook is open towards the player: the little finger lies in it and presses down.
    inside = np.array([0, 0.985, -0.174])
    inside /= np.linalg.norm(inside)
    touch("right.little.pad", "root", (HOOK - (HOOK_R - 0.0011) * inside, inside))
    touch(
        "left.index.pad", "root", _on(np.array([VALVE_X, -0.0185, VALVE_Z[2]]), CASING_R, np.array([-0.42, 0, 0.907]))
    )
    touch(
        "left.middle.pad", "root", _on(np.array([VALVE_X, -0.0355, VALVE_Z[2]]), CASING_R, np.array([-0.42, 0, 0.907]))
    )
    within = np.array([0, 0.65, 0.76])
    within /= np.linalg.norm(within)
    touch("left.ring.pad", "third_slide", (RING - (RING_R - RING_THICK) * within, within), "third_slide")
    ahead = np.array([0, 0.6, -0.8])
    touch("left.thumb.pad", "first_slide", (SADDLE - (SADDLE_R - SADDLE_THICK) * ahead, ahead), "first_slide")
    return found


INSTRUMENTS = {"trumpet_Bb": (build, contacts)}
