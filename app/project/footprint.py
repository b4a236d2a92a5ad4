"""Space that an instrument needs on the stage, place of its section, and volume, from its map and the vocabulary."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from app.arrays import FloatArray
from app.identity_cache import IdentityCache
from app.project.casting import Footprint
from app.rig import quaternion
from instrument_maps.hold import Box, Carriage, Cone, Proxy, Ring
from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import ROOT, InstrumentMap

LIPS_AHEAD_M = 0.12
"""Distance in metres of the lips in front of the body's centre."""

_FOOTPRINTS: IdentityCache[Footprint] = IdentityCache(128)


def footprint(instrument: InstrumentMap | None) -> Footprint:
    """Return the space that a player of an instrument needs; without a map, that of a body."""
    if instrument is None:
        return Footprint(row=len(vocabulary().seating))
    return _FOOTPRINTS.step(_footprint, instrument)


def together(footprints: Iterable[Footprint]) -> Footprint:
    """Return the space of a musician who plays several instruments in turn, at the place of the first one's section."""
    first, *others = footprints
    if not others:
        return first
    return Footprint(
        first.row,
        first.place,
        max(first.left_m, *(one.left_m for one in others)),
        max(first.right_m, *(one.right_m for one in others)),
        max(first.ahead_m, *(one.ahead_m for one in others)),
    )


def solid_m3(instrument: InstrumentMap) -> float:
    """Return the volume in cubic metres of an instrument's collision bodies, a measure of how much is carried."""
    return math.fsum(_volume_m3(body) for body in instrument.proxy)


def _volume_m3(body: Proxy) -> float:
    if isinstance(body, Box):
        return 8.0 * math.prod(body.half_m)
    if isinstance(body, Ring):
        return 2.0 * math.pi**2 * body.radius_m * body.tube_radius_m**2
    first_m, last_m = (body.radius_a_m, body.radius_b_m) if isinstance(body, Cone) else (body.radius_m, body.radius_m)
    return math.pi * math.dist(body.a_m, body.b_m) * (first_m**2 + first_m * last_m + last_m**2) / 3.0


def _footprint(instrument: InstrumentMap) -> Footprint:
    family = vocabulary().family(instrument.plays)
    seats = [
        (row, place)
        for row, names in enumerate(vocabulary().seating)
        for place, name in enumerate(names)
        if name == family
    ]
    row, place = seats[0] if seats else (len(vocabulary().seating), 0)
    ends = _ends(instrument)
    if not len(ends):
        return Footprint(row, place)
    left, right, ahead = 0.0, 0.0, 0.0
    for posture in instrument.hold.postures:
        carried = quaternion.rotate(_turn(instrument.hold.carriage(posture)), ends)
        left, right = max(left, float(carried[:, 0].max())), max(right, float(-carried[:, 0].min()))
        ahead = max(ahead, float(carried[:, 2].max()) + LIPS_AHEAD_M)
    return Footprint(row, place, left, right, ahead)


def _turn(carriage: Carriage) -> FloatArray:
    """Return the rotation (4,) of an instrument in its usual carriage: yaw, then pitch, then roll."""
    yaw, pitch, roll = (
        np.radians(angles[1]) for angles in (carriage.yaw_left_deg, carriage.pitch_down_deg, carriage.roll_left_deg)
    )
    about_y = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), yaw)
    about_x = quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), pitch)
    about_z = quaternion.from_axis_angle(np.array([0.0, 0.0, 1.0]), -roll)
    return quaternion.multiply(about_y, quaternion.multiply(about_x, about_z))


def _ends(instrument: InstrumentMap) -> FloatArray:
    """Return the corners (N, 3) of boxes around an instrument's collision bodies in its frame, metres; for parts that a
    hand moves, at both ends of their travel.
    """
    travels = {
        control.node: np.array(control.motion.axis) * control.travel_m
        for control in instrument.controls
        if control.motion is not None and control.travel_m
    }
    found = []
    for points, node in _bodies(instrument):
        if node == ROOT:
            found.append(points)
        elif node in travels:
            found += [points, points + travels[node]]
    return np.concatenate(found) if found else np.zeros((0, 3))


def _bodies(instrument: InstrumentMap) -> Iterator[tuple[FloatArray, str]]:
    """Yield the eight corners (8, 3) of a box around every collision body of an instrument, in metres, and the name of
    its node.
    """
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    for body in instrument.proxy:
        if isinstance(body, Box):
            third = np.cross(body.x_axis, body.y_axis)
            axes = np.array([body.x_axis, body.y_axis, third]) * np.array(body.half_m)[:, None]
            yield np.array(body.centre_m) + corners @ axes, body.node
        elif isinstance(body, Ring):
            yield np.array(body.centre_m) + corners * (body.radius_m + body.tube_radius_m), body.node
        else:
            radii_m = (body.radius_a_m, body.radius_b_m) if isinstance(body, Cone) else (body.radius_m, body.radius_m)
            ends_m = zip((body.a_m, body.b_m), radii_m, strict=True)
            yield np.concatenate([np.array(end_m) + corners * radius_m for end_m, radius_m in ends_m]), body.node
