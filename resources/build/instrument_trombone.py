"""The tenor trombone with F attachment, a large bore instrument (closed length 1.15 m, bell 216 mm), and the bass
trombone (bell 241 mm) with a second rotor in line, for the left middle finger.

The two legs of the slide lie in a plane turned 30 degrees from the vertical: the mouthpiece's leg above, the
bell's below and left of it. The bell section rises from the lower leg to the player's left, so that its bow
passes over the left shoulder; the F tubing lies in its plane, the rotor on the gooseneck.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from resources.build.instrument_brass import BRASS, NICKEL, SILVER, Bell, Z, brace, contact, on_round
from resources.build.instrument_mesh import (
    Array,
    Model,
    Shape,
    bend,
    half_circle,
    joined,
    plate,
    resampled,
    solid,
    torus,
    tube,
    turned,
)

DOWN = np.array([0.5, -0.8660254, 0.0])
"""From the mouthpiece's leg of the slide to the bell's."""
LEFT = np.array([0.8660254, 0.5, 0.0])
"""Out of the plane of the slide, to the left hand's side."""
ACROSS = np.array([0.7660444, 0.6427876, 0.0])
"""From the gooseneck to the bell, in the plane of the bell section."""
OUT = np.cross(Z, ACROSS)
"""Out of the plane of the bell section, up and towards the head."""

SLIDE_WIDTH = 0.086
LOWER = SLIDE_WIDTH * DOWN
INNER_R, OUTER_R = 0.0073, 0.0081
INNER_BRACE_Z, OUTER_BRACE_Z = 0.072, 0.150
OUTER_START_Z, BOW_Z = 0.130, 0.842
STAY_R = 0.0048
GOOSENECK = LOWER + 0.030 * ACROSS
BELL = LOWER + 0.165 * ACROSS
BELL_Z = 0.335
REAR_Z = -0.180
BELL_STAY_Z = 0.0185
RECEIVER_R = 0.0108
TRIGGER_PIVOT = LOWER + 0.0190 * ACROSS + np.array([0, 0, -0.008])
TRIGGER_PAD = LOWER + 0.0420 * ACROSS + 0.014 * OUT + np.array([0, 0, -0.004])
ROTOR_Z = -0.085
SECOND_LEVER = 0.046 * DOWN + 0.0875 * Z - 0.001 * LEFT
"""The second lever's paddle, in front of the inner slide's brace; its pad faces the finger that pulls it."""
SECOND_PULL = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Layout:
    """Differences: the bell, the mouthpiece's size next to the tenor's, whether there is a second rotor."""

    bell: Bell
    mouthpiece: float = 1.0
    second: bool = False


TENOR = Layout(Bell(0.108, 0.0190, 0.70))
BASS = Layout(Bell(0.1205, 0.0190, 0.70), mouthpiece=1.06, second=True)


def build(at: Layout = TENOR) -> Model:
    """Build the model."""
    model = Model()
    model.node("slide", SLIDE_WIDTH / 2 * DOWN + OUTER_BRACE_Z * Z)
    model.node("trigger", TRIGGER_PIVOT)
    if at.second:
        model.node("second_trigger", SECOND_LEVER)
    _mouthpiece(model, at.mouthpiece)
    _inner_slide(model)
    _outer_slide(model)
    _gooseneck(model, at)
    _bell(model, at)
    _attachment(model)
    _trigger(model)
    if at.second:
        _second_rotor(model)
        _second_lever(model)
    return model


def _mouthpiece(model: Model, size: float) -> None:
    profile = [
        (0.0240, 0.0005), (0.0210, 0.0035), (0.0160, 0.0080), (0.0100, 0.0108), (0.0045, 0.0123), (0.0016, 0.0129),
        (0.0004, 0.0140), (0.0, 0.0157), (0.0005, 0.0178), (0.0020, 0.0192), (0.0042, 0.0197), (0.0075, 0.0196),
        (0.0090, 0.0186), (0.0140, 0.0178), (0.0220, 0.0158), (0.0300, 0.0120), (0.0360, 0.0088), (0.0420, 0.0073),
        (0.0500, 0.0067), (0.0640, 0.0063), (0.0640, 0.0),
    ]  # fmt: skip
    model.add(SILVER, turned((0, 0, 0), Z, [(z, size * r) for z, r in profile], sides=56, hard_deg=50))


def _inner_slide(model: Model) -> None:
    receiver = [(0.0545, 0.0083), (0.0555, 0.0090), (0.0585, 0.0090), (0.0600, 0.0084), (0.0800, 0.0084)]
    model.add(NICKEL, solid((0, 0, 0), Z, receiver))
    barrel = [
        (0.0770, 0.0092), (0.0780, 0.0098), (0.0800, 0.0094), (0.0980, 0.0094), (0.1000, 0.0099), (0.1010, 0.0094),
    ]  # fmt: skip
    for foot in (np.zeros(3), LOWER):
        model.add(NICKEL, solid(foot, Z, barrel))
        model.add(NICKEL, tube([foot + 0.098 * Z, foot + 0.79 * Z], INNER_R))
    lock = [
        (0.012, 0.0092), (0.013, 0.0098), (0.030, 0.0098), (0.0310, RECEIVER_R), (0.0430, RECEIVER_R), (0.0440, 0.0126),
        (0.0560, 0.0126), (0.0570, RECEIVER_R), (0.0780, 0.0096),
    ]  # fmt: skip
    model.add(NICKEL, solid(LOWER, Z, lock, sides=36))
    model.add(NICKEL, _stay(INNER_BRACE_Z, 0.0082, SLIDE_WIDTH - 0.0095))


def _stay(z: float, start: float, end: float) -> Shape:
    """A round slide brace between the two legs, from ``start`` to ``end`` along `DOWN`."""
    flange = [
        (start - 0.002, 0.0080), (start + 0.0012, 0.0078), (start + 0.0035, 0.0056), (start + 0.0060, STAY_R),
        (end - 0.0060, STAY_R), (end - 0.0035, 0.0056), (end - 0.0012, 0.0078), (end + 0.002, 0.0080),
    ]  # fmt: skip
    return solid(z * Z, DOWN, flange, sides=28)


def _outer_slide(model: Model) -> None:
    node = "slide"
    for foot in (np.zeros(3), LOWER):
        model.add(BRASS, tube([foot + OUTER_START_Z * Z, foot + (BOW_Z - 0.030) * Z], OUTER_R), node=node)
        collar = [(0, 0.0090), (0.001, 0.0096), (0.005, 0.0096), (0.0065, 0.0088), (0.028, 0.0088), (0.030, 0.0082)]
        model.add(NICKEL, solid(foot + (OUTER_START_Z - 0.001) * Z, Z, collar), node=node)
        sleeve = [(0, 0.0088), (0.002, 0.0092), (0.050, 0.0092), (0.052, 0.0088)]
        model.add(NICKEL, solid(foot + (BOW_Z - 0.060) * Z, Z, sleeve), node=node)
    model.add(NICKEL, _stay(OUTER_BRACE_Z, 0.0080, SLIDE_WIDTH - 0.0080), node=node)
    bow = half_circle(BOW_Z * Z, LOWER + BOW_Z * Z, Z, 32)
    model.add(BRASS, tube(joined((BOW_Z - 0.012) * Z, bow, LOWER + (BOW_Z - 0.012) * Z), 0.0086), node=node)
    end = (BOW_Z - 0.010) * Z
    model.add(NICKEL, brace(0.0080 * DOWN + end, (SLIDE_WIDTH - 0.0080) * DOWN + end, 0.0030), node=node)
    tip = SLIDE_WIDTH / 2 * DOWN + (BOW_Z + SLIDE_WIDTH / 2 + 0.0080) * Z
    bumper = [(0, 0.0048), (0.004, 0.0048), (0.0055, 0.0060), (0.009, 0.0060), (0.0105, 0.0048)]
    model.add("felt", solid(tip, Z, bumper), node=node)
    nipple = LOWER + 0.0075 * DOWN + (BOW_Z + 0.010) * Z
    model.add(BRASS, solid(nipple, DOWN, [(0, 0.0042), (0.004, 0.0042)]), node=node)
    model.add("cork", solid(nipple + 0.004 * DOWN, DOWN, [(0, 0.0036), (0.0015, 0.0036)]), node=node)
    arm = bend([nipple + 0.0060 * DOWN, nipple + 0.0064 * DOWN - 0.022 * Z, nipple + 0.0030 * DOWN - 0.052 * Z], 0.02)
    model.add(NICKEL, tube(arm, 0.0026, flat=(0.6, 1.3), side=DOWN, sides=12), node=node)


def _gooseneck(model: Model, at: Layout) -> None:
    line = bend(
        [LOWER + 0.020 * Z, LOWER - 0.004 * Z, GOOSENECK - 0.050 * Z, GOOSENECK - 0.075 * Z], [0.05, 0.05], 0.003
    )
    model.add(BRASS, tube(line, np.linspace(0.0085, 0.0088, len(line))))
    model.add(BRASS, tube([GOOSENECK - 0.095 * Z, GOOSENECK - 0.128 * Z], 0.0088))
    sleeve = [(0, 0), (0, 0.0102), (0.0015, 0.0106), (0.006, 0.0106), (0.0075, 0.0100), (0.042, 0.0100), (0.042, 0)]
    for foot, size in ((GOOSENECK, 1.0), (BELL, 1.22)):
        model.add(NICKEL, turned(foot - 0.122 * Z, -Z, [(z, r * size) for z, r in sleeve]))
    edge = BELL - float(at.bell.radius(BELL_Z - BELL_STAY_Z)) * ACROSS + BELL_STAY_Z * Z
    model.add(NICKEL, brace(LOWER + 0.0100 * ACROSS + BELL_STAY_Z * Z, edge, 0.0033))
    model.add(NICKEL, brace(GOOSENECK + 0.0100 * ACROSS - 0.132 * Z, BELL - 0.0122 * ACROSS - 0.132 * Z, 0.0033))


def _bell(model: Model, at: Layout) -> None:
    bow = half_circle(GOOSENECK + REAR_Z * Z, BELL + REAR_Z * Z, -Z, 40)
    thick = float(at.bell.radius(BELL_Z - REAR_Z))
    share = np.linspace(0, 1, len(bow) + 2)
    line = joined(GOOSENECK + (REAR_Z + 0.020) * Z, bow, BELL + (REAR_Z + 0.020) * Z)
    model.add(BRASS, tube(line, 0.0092 + share * (thick - 0.0092), sides=32))
    rear = GOOSENECK + 0.5 * (BELL - GOOSENECK) + (REAR_Z - float(np.linalg.norm(BELL - GOOSENECK)) / 2) * Z
    weight = [(0, 0.0150), (0.0015, 0.0165), (0.0095, 0.0165), (0.0110, 0.0150)]
    bar = REAR_Z + 0.006
    model.add(NICKEL, brace(GOOSENECK + 0.0090 * ACROSS + bar * Z, BELL - 0.0108 * ACROSS + bar * Z, 0.0030))
    middle = GOOSENECK + 0.5 * (BELL - GOOSENECK) + bar * Z
    model.add(NICKEL, solid(middle - 0.0055 * OUT, OUT, weight, sides=36))
    model.add(BRASS, solid(rear - 0.006 * Z, -Z, [(0, 0.006), (0.006, 0.004)]))
    straight = resampled(np.array([BELL + (REAR_Z + 0.010) * Z, BELL + 0.06 * Z]), 0.02)
    flare_z = BELL_Z - np.geomspace(0.0006, BELL_Z - 0.06, 46)[::-1]
    flare = joined(straight, BELL + flare_z[:, None] * Z)
    model.add(BRASS, tube(flare, at.bell.radius(BELL_Z - flare[:, 2]), sides=72, closed=False))

    model.add(BRASS, torus(BELL + BELL_Z * Z, Z, at.bell.rim_r - 0.0008, 0.0014, around=80, sides=12))
    inner_z = BELL_Z - np.geomspace(0.0006, 0.30, 40)
    inside = BELL + inner_z[:, None] * Z
    model.add(
        "inner_brass", tube(inside, at.bell.radius(BELL_Z - inner_z) - 0.0007, sides=72, closed=False, proxy=False)
    )


def _at(across: float, out: float, z: float) -> Array:
    """A place about the gooseneck, in the axes of the bell section."""
    return GOOSENECK + across * ACROSS + out * OUT + z * Z


def _attachment(model: Model) -> None:
    rotor = GOOSENECK + ROTOR_Z * Z
    body = [
        (-0.0190, 0.0165), (-0.0175, 0.0182), (-0.0140, 0.0182), (-0.0130, 0.0170), (0.0130, 0.0170), (0.0140, 0.0182),
        (0.0175, 0.0182), (0.0190, 0.0165), (0.0190, 0.0060), (0.0230, 0.0060), (0.0240, 0.0050),
    ]  # fmt: skip
    model.add(NICKEL, solid(rotor, OUT, body, sides=40))
    radius = 0.0085
    first = bend([_at(0.010, 0, -0.085), _at(0.030, 0, -0.085), _at(0.030, 0, -0.160)], 0.016)
    turn_1 = half_circle(_at(0.030, 0, -0.160), _at(0.054, 0, -0.160), -Z, 16)
    turn_2 = half_circle(_at(0.054, 0, -0.045), _at(0.102, 0, -0.045), Z, 20)
    turn_3 = half_circle(_at(0.102, 0, -0.162), _at(0.078, 0, -0.162), -Z, 16)
    back = bend([_at(0.078, 0, -0.085), _at(0.078, 0, -0.066), _at(0.070, -0.0205, -0.056), _at(0.030, -0.0205, -0.050),
                 _at(0.006, -0.0205, -0.056), _at(0.002, -0.0140, -0.085)], [0.012, 0.012, 0.014, 0.016])  # fmt: skip
    model.add(BRASS, tube(joined(first, turn_1, turn_2, turn_3, back), radius, sides=22))
    sleeve = [(0, 0.0094), (0.0015, 0.0098), (0.006, 0.0098), (0.0075, 0.0092), (0.050, 0.0092)]
    for across in (0.102, 0.078):
        model.add(NICKEL, solid(_at(across, 0, -0.098), -Z, sleeve))
    model.add(NICKEL, brace(_at(0.0625, 0, -0.100), _at(0.0690, 0, -0.100), 0.0028))
    model.add(NICKEL, brace(_at(0.1105, 0, -0.080), _at(0.1225, 0, -0.080), 0.0026))


def _second_rotor(model: Model) -> None:
    """The G flat rotor behind the first and its tubing, a shorter loop on the near side of the bell section."""
    rotor = GOOSENECK + (ROTOR_Z - 0.046) * Z
    body = [
        (-0.0175, 0.0150), (-0.0160, 0.0166), (-0.0125, 0.0166), (-0.0115, 0.0156), (0.0115, 0.0156), (0.0125, 0.0166),
        (0.0160, 0.0166), (0.0175, 0.0150), (0.0175, 0.0055), (0.0212, 0.0055), (0.0220, 0.0045),
    ]  # fmt: skip
    model.add(NICKEL, solid(rotor, OUT, body, sides=40))
    near, far = -0.0195, -0.0400
    out = bend(
        [_at(0, near + 0.008, -0.131), _at(0.006, far, -0.131), _at(0.020, far, -0.120), _at(0.022, far, -0.055)], 0.009
    )
    turn_1 = half_circle(_at(0.022, far, -0.050), _at(0.056, far, -0.050), Z, 20)
    turn_2 = half_circle(_at(0.056, far, -0.170), _at(0.092, far, -0.170), -Z, 20)
    turn_3 = half_circle(_at(0.092, far, -0.060), _at(0.072, far + 0.0005, -0.060), Z, 16)
    back = bend([_at(0.072, far, -0.062), _at(0.072, far, -0.128), _at(0.040, near - 0.004, -0.138),
                 _at(0.010, near + 0.004, -0.136)], [0.014, 0.014])  # fmt: skip
    model.add(BRASS, tube(joined(out, turn_1, turn_2, turn_3, back), 0.0083, sides=22))
    model.add(NICKEL, brace(_at(0.056, -0.0085, -0.100), _at(0.056, far + 0.0080, -0.100), 0.0024))


def _second_lever(model: Model) -> None:
    """A paddle for the left middle finger before the inner slide's brace, on a rod that slides beside the lower leg."""
    node = "second_trigger"
    paddle = [(-0.0034, 0.0070), (-0.0028, 0.0080), (-0.0006, 0.0080), (0.0, 0.0070)]
    model.add(NICKEL, solid(SECOND_LEVER, -SECOND_PULL, paddle, sides=32), node=node)
    corner = SECOND_LEVER - 0.0020 * Z + (SLIDE_WIDTH - 0.046 + 0.0135) * DOWN
    rod = bend([SECOND_LEVER - 0.0020 * Z, corner, corner - 0.105 * Z], 0.012)
    model.add(NICKEL, tube(rod, 0.0021, sides=14), node=node)
    for z in (0.020, 0.052):
        guide = [(0, 0.0036), (0.006, 0.0036)]
        model.add(NICKEL, solid(corner + (z - corner[2]) * Z, Z, guide, sides=16))
        model.add(NICKEL, brace(LOWER + 0.0085 * DOWN + (z + 0.003) * Z,
                                          LOWER + 0.0115 * DOWN + (z + 0.003) * Z, 0.0018))  # fmt: skip


def _trigger(model: Model) -> None:
    node = "trigger"
    pivot = TRIGGER_PIVOT
    post = [(-0.010, 0.0030), (0.010, 0.0030)]
    model.add(NICKEL, solid(pivot, OUT, post, sides=18))
    for side in (-1, 1):
        model.add(NICKEL, plate(pivot - 0.0065 * ACROSS + 0.0085 * side * OUT, (0.007, 0.0012, 0.004), ACROSS, OUT))
    barrel = [(-0.0068, 0.0042), (0.0068, 0.0042)]
    model.add(NICKEL, solid(pivot, OUT, barrel, sides=20), node=node)
    arm = bend([pivot, pivot + 0.010 * ACROSS + 0.001 * Z, TRIGGER_PAD - 0.004 * ACROSS + 0.0012 * Z], 0.012)
    model.add(NICKEL, tube(arm, 0.0028, flat=(0.85, 1.2), side=Z, sides=16), node=node)
    paddle = [(0, 0.0070), (0.0006, 0.0082), (0.0026, 0.0086), (0.0034, 0.0080)]
    model.add(NICKEL, solid(TRIGGER_PAD, Z, paddle, sides=32), node=node)
    link_end = GOOSENECK + 0.0265 * OUT + (ROTOR_Z + 0.012) * Z
    model.add(NICKEL, solid(GOOSENECK + ROTOR_Z * Z, OUT, [(0.0235, 0.0095), (0.0265, 0.0095)]))
    model.add(NICKEL, tube([pivot + 0.0085 * OUT, link_end], 0.0015, sides=12))


def contacts(at: Layout = TENOR) -> list[dict[str, object]]:
    """Return the contacts of a trained player's hands with the instrument, in the root frame."""
    bar, inner, pull = OUTER_BRACE_Z * Z, INNER_BRACE_Z * Z, Z + 0.2 * LEFT
    # Ring and little finger close around the lower leg as far as the hand's size lets them: no fixed touch.
    return [
        contact("right.thumb.pad", "slide", *on_round(bar + 0.043 * DOWN, STAY_R, -pull), "slide"),
        contact("right.index.pad", "slide", *on_round(bar + 0.034 * DOWN, STAY_R, pull), "slide"),
        contact("right.middle.pad", "slide", *on_round(bar + 0.053 * DOWN, STAY_R, pull), "slide"),
        contact("left.thumb.pad", "trigger", TRIGGER_PAD, -Z, "trigger"),
        contact("left.index.pad", "root", *on_round(0.066 * Z, 0.0084, 0.8 * LEFT - 0.6 * DOWN)),
        contact("left.middle.pad", "second_trigger", SECOND_LEVER, -SECOND_PULL, "second_trigger")
        if at.second
        else contact("left.middle.pad", "root", *on_round(inner + 0.050 * DOWN, STAY_R, Z - 0.8 * LEFT)),
    ]


INSTRUMENTS = {
    name: (partial(build, at), partial(contacts, at))
    for name, at in (("trombone_tenor_F_attachment", TENOR), ("trombone_bass_F_Gb", BASS))
}
