"""Places on the stage and amplitudes of players, reproducibly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import msgspec

from app.chance import chance, seed_of
from instrument_maps.map_table import Posture

SPACING_M = 1.3
"""Distance in metres between neighbours, with space for a long instrument's bell and an elbow."""
ARC_RAD = math.radians(150.0)
"""Largest angle in radians of the arc on which players stand; the open side faces the audience."""
LEAST_RADIUS_M = 1.1
MOST_IN_ARC = 12
"""Greatest number of players in an arc; more sit in rows like a band."""
CONDUCTOR_AWAY_M, CONDUCTOR_STEP_M = 1.9, 0.05
"""Distance in metres of the conductor from the nearest player, and step by which it is increased."""
FRONT_RADIUS_M, ROW_DEPTH_M = 2.6, 1.5
"""Radius of the first of several rows, and distance between rows for a slide and a stand, in metres."""
ELBOW_M = 0.36
"""Distance in metres from a player's middle to an elbow, the least space needed at a side."""
BACK_M = 0.35
"""Distance in metres from a player's centre to the back of the chair."""
CLEAR_M = 0.12
"""Distance in metres between the instruments of neighbours."""

DANCER_ROOM_M = 2.4
"""Distance in metres between a dancer's place and any other performer, for side steps and an arm."""

NATURAL_AMPLITUDE = 0.5
AMPLITUDE_SPREAD = 0.12
"""Greatest random difference of a player's amplitude from the natural one (T7: random values so that players
differ).
"""


class StagePosition(msgspec.Struct, frozen=True):
    """Place of a player: x and z in metres from the middle of the stage, with the audience towards +Z, and the rotation
    from +Z towards +X in radians.
    """

    x_m: float
    z_m: float
    turn_rad: float


class ConductorPlace(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Place in front of the players for a conductor, who faces them; fields as in `StagePosition`.

    Attributes
    ----------
    on_stage : bool
        Whether a conductor stands there and gives the entries. An empty place has no effect; older projects always have
        an empty place.
    """

    x_m: float
    z_m: float
    on_stage: bool = False


class Footprint(msgspec.Struct, frozen=True):
    """Space that a player needs, and the section's place in the usual seating.

    Attributes
    ----------
    row, place : int
        Row (from the audience) and place (from its left) of the instrument's section in a band's seating.
    left_m, right_m, ahead_m : float
        Extent of the instrument to the player's left, right and front in the usual playing position.
    """

    row: int = 0
    place: int = 0
    left_m: float = 0.0
    right_m: float = 0.0
    ahead_m: float = 0.0


def stage_seats(footprints: Sequence[Footprint]) -> tuple[StagePosition, ...]:
    """Return the places for an ensemble in the given order: an arc for a few players, rows as in a band for many."""
    if len(footprints) <= MOST_IN_ARC:
        return stage_arc(len(footprints), _spacing(footprints))
    order = sorted(range(len(footprints)), key=lambda index: (footprints[index].row, footprints[index].place))
    rows: list[list[int]] = []
    for index in order:
        if not rows or footprints[rows[-1][0]].row != footprints[index].row or len(rows[-1]) >= MOST_IN_ARC:
            rows.append([])
        rows[-1].append(index)
    places: dict[int, StagePosition] = {}
    radius = FRONT_RADIUS_M
    for row in rows:
        own = [footprints[index] for index in row]
        if places:
            radius += max(ROW_DEPTH_M, BACK_M + CLEAR_M + max(one.ahead_m for one in own))
        spacing = _spacing(own)
        radius = max(radius, spacing / (2.0 * math.sin(ARC_RAD / max(len(row) - 1, 1) / 2.0)))
        step = 2.0 * math.asin(min(1.0, spacing / 2.0 / radius))
        places.update(zip(row, _row(len(row), step, radius), strict=True))
    return tuple(places[index] for index in range(len(footprints)))


def conductor_place(stages: Sequence[StagePosition]) -> ConductorPlace:
    """Return the usual place of a conductor: centred in front of the players, at the distance that the nearest one
    needs.
    """
    if not stages:
        return ConductorPlace(0.0, CONDUCTOR_AWAY_M)
    x_m = math.fsum(stage.x_m for stage in stages) / len(stages)
    z_m = math.fsum(stage.z_m for stage in stages) / len(stages)
    while min(math.hypot(stage.x_m - x_m, stage.z_m - z_m) for stage in stages) < CONDUCTOR_AWAY_M:
        z_m += CONDUCTOR_STEP_M
    return ConductorPlace(round(x_m, 2), round(z_m, 2))


def usual_posture(count: int) -> Posture:
    """Return the usual posture for a number of players: standing in an arc, or seated in rows."""
    return "standing" if count <= MOST_IN_ARC else "seated"


def _spacing(row: Sequence[Footprint]) -> float:
    """Return the distances in metres between neighbours in a row from the audience's left; each player's neighbour is
    at the left hand.
    """
    needed = [max(one.left_m, ELBOW_M) + max(other.right_m, ELBOW_M) + CLEAR_M for one, other in pairwise(row)]
    return max([SPACING_M, *needed])


def stage_arc(count: int, spacing_m: float = SPACING_M) -> tuple[StagePosition, ...]:
    """Return the places of a few players on an arc open to the audience, in score order from the audience's left (-X).

    Neighbours are ``spacing_m`` apart. Each faces the middle of the opening, half way between the colleague opposite
    and the audience.
    """
    if count < 2:
        return (StagePosition(0.0, 0.0, 0.0),) * count
    # The arc grows with the number of players: first in angle at the least radius, then in radius.
    step = min(ARC_RAD / (count - 1), 2.0 * math.asin(min(1.0, spacing_m / 2.0 / LEAST_RADIUS_M)))
    return _row(count, step, max(LEAST_RADIUS_M, spacing_m / (2.0 * math.sin(step / 2.0))))


def _row(count: int, step: float, radius: float) -> tuple[StagePosition, ...]:
    """Return the places of ``count`` players on an arc around the conductor, ``step`` radians apart, at ``radius``
    metres.
    """
    angles = [(index - (count - 1) / 2.0) * step for index in range(count)]
    return tuple(StagePosition(radius * math.sin(angle), -radius * math.cos(angle), -angle / 2.0) for angle in angles)


def amplitude(seed: int, player_id: str) -> float:
    """Return the amplitude of a player's motion, a random value near the usual one."""
    return round(NATURAL_AMPLITUDE + AMPLITUDE_SPREAD * (2.0 * chance("amplitude", seed, player_id) - 1.0), 3)


def player_seed(seed: int, player_id: str) -> int:
    """Return the random seed of one player, derived from the piece's seed and the player's id."""
    return seed_of("player", seed, player_id)
