"""Casting: characters, places on the stage and amplitudes of players, the same in every run."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

import msgspec

from app.chance import chance, seed_of
from instrument_maps.map_table import Posture

SPACING_M = 1.3
"""Between neighbours: room for a long instrument's bell and an elbow."""
ARC_RAD = math.radians(150.0)
"""Largest part of a circle the players stand on; the open side is the audience's."""
LEAST_RADIUS_M = 1.1
MOST_IN_ARC = 12
"""More sit in rows, as a band does."""
CONDUCTOR_AWAY_M, CONDUCTOR_STEP_M = 1.9, 0.05
"""From the nearest player."""
FRONT_RADIUS_M, ROW_DEPTH_M = 2.6, 1.5
"""Radius of the first of several rows, and room behind it for a slide and a stand."""
ELBOW_M = 0.36
"""From a player's middle to an elbow: no one needs less room to a side."""
BACK_M = 0.35
"""From a player's middle to the back of a chair."""
CLEAR_M = 0.12
"""Between what neighbours hold."""

DANCER_ROOM_M = 2.4
"""Between a dancer's place and any other performer: steps to a side, and an arm."""

NATURAL_AMPLITUDE = 0.5
AMPLITUDE_SPREAD = 0.12
"""Players move by as much more or less than a natural amount (T7: random values so that they differ)."""


FAR_REACH_M = 0.4
"""A hand that travels this far works at the end of an arm."""
LONG_ARMS = 0.9
"""Arms are long from this share of the longest on."""


class StagePosition(msgspec.Struct, frozen=True):
    """Place of a player: metres from the middle of the stage, the audience towards +Z, and the turn from +Z towards +X
    in radians."""

    x_m: float
    z_m: float
    turn_rad: float


class ConductorPlace(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A place before the players for a conductor, who faces them: as `StagePosition`.

    Attributes
    ----------
    on_stage : bool
        Whether a conductor stands there, who gives the entries. An empty place conducts no one; so do those of older
        projects, in which no one said that there is a conductor.
    """

    x_m: float
    z_m: float
    on_stage: bool = False


class Footprint(msgspec.Struct, frozen=True):
    """The room a player takes, and where the usual seating has them.

    Attributes
    ----------
    row, place : int
        Of the instrument's section in the seating of a band: rows from the audience, places from its left.
    left_m, right_m, ahead_m : float
        How far the instrument goes to the player's left, right and ahead, as it is usually carried.
    """

    row: int = 0
    place: int = 0
    left_m: float = 0.0
    right_m: float = 0.0
    ahead_m: float = 0.0


def stage_seats(footprints: Sequence[Footprint]) -> tuple[StagePosition, ...]:
    """Places for an ensemble, in its order: an arc for a few, the rows of a band for many.

    Neighbours stand as far apart as what they hold asks for. In rows players sit with their section, the sections
    in the usual order; one that has too many for a row goes on in another behind it.
    """
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
    """Return where a conductor would stand before players: in their middle, as far from the nearest as that one needs,
    and on the audience's side of them."""
    if not stages:
        return ConductorPlace(0.0, CONDUCTOR_AWAY_M)
    x_m = math.fsum(stage.x_m for stage in stages) / len(stages)
    z_m = math.fsum(stage.z_m for stage in stages) / len(stages)
    while min(math.hypot(stage.x_m - x_m, stage.z_m - z_m) for stage in stages) < CONDUCTOR_AWAY_M:
        z_m += CONDUCTOR_STEP_M
    return ConductorPlace(round(x_m, 2), round(z_m, 2))


def usual_posture(count: int) -> Posture:
    """Usual posture of an ensemble of this size: a few stand, a band sits."""
    return "standing" if count <= MOST_IN_ARC else "seated"


def _spacing(row: Sequence[Footprint]) -> float:
    """Distances between neighbours, from the audience's left: each has the next at the left hand."""
    needed = [max(one.left_m, ELBOW_M) + max(other.right_m, ELBOW_M) + CLEAR_M for one, other in pairwise(row)]
    return max([SPACING_M, *needed])


def stage_arc(count: int, spacing_m: float = SPACING_M) -> tuple[StagePosition, ...]:
    """Places of a few players on an arc open to the audience, in the order of the score from the audience's left (-X).

    Everyone stands ``spacing_m`` from the next and faces the middle of the arc's opening, half way between a
    colleague across and the audience.
    """
    if count < 2:
        return (StagePosition(0.0, 0.0, 0.0),) * count
    # The arc grows with its players: first in angle at the least radius, then in radius.
    step = min(ARC_RAD / (count - 1), 2.0 * math.asin(min(1.0, spacing_m / 2.0 / LEAST_RADIUS_M)))
    return _row(count, step, max(LEAST_RADIUS_M, spacing_m / (2.0 * math.sin(step / 2.0))))


def _row(count: int, step: float, radius: float) -> tuple[StagePosition, ...]:
    """Players on one arc, ``step`` radians apart."""
    angles = [(index - (count - 1) / 2.0) * step for index in range(count)]
    return tuple(StagePosition(radius * math.sin(angle), -radius * math.cos(angle), -angle / 2.0) for angle in angles)


def amplitude(seed: int, player_id: str) -> float:
    """A player's own amount of motion, around the natural one."""
    return round(NATURAL_AMPLITUDE + AMPLITUDE_SPREAD * (2.0 * chance("amplitude", seed, player_id) - 1.0), 3)


def player_seed(seed: int, player_id: str) -> int:
    """A player's own seed."""
    return seed_of("player", seed, player_id)


def choose_characters(
    travels_m: Sequence[float], arms_m: Mapping[str, float], left_out: Sequence[Collection[str]] = ()
) -> tuple[str, ...]:
    """A character for every player: a far reach gets one of the long arms, and everyone the least used character.

    Parameters
    ----------
    travels_m : sequence of float
        How far each player's instrument asks a hand to travel.
    arms_m : mapping of str to float
        Length of arm of every character to choose from; at least one.
    left_out : sequence of collection of str, optional
        By player: characters who are too small for the instrument.

    Returns
    -------
    tuple of str
        Ids, in the order of the players.
    """
    longest_m = max(arms_m.values())
    long = [character for character, arm_m in arms_m.items() if arm_m >= LONG_ARMS * longest_m]
    counts: Counter[str] = Counter()
    result = dict.fromkeys(range(len(travels_m)), "")
    # Those who ask for long arms choose first, so that the others are who is left.
    for place in sorted(result, key=lambda place: travels_m[place] <= FAR_REACH_M):
        possible = long if travels_m[place] > FAR_REACH_M else list(arms_m)
        small = left_out[place] if left_out else ()
        suited = [character for character in possible if character not in small] or possible
        result[place] = min(suited, key=lambda candidate: counts[candidate])
        counts[result[place]] += 1
    return tuple(result.values())
