"""Grips of a character with the same hands as another one: wrists and fingers are taken over, lips and elbows are its
own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.formats.toml import read_toml, shaped
from app.rig import quaternion
from app.rig.grip.carriage import Upright, upright
from app.rig.grip.fitting.arm_problem import ArmProblem, arm_problem, arm_residuals
from app.rig.grip.grip_pose import GripPose, HandHold
from app.rig.grip.lips import fit_lips
from app.rig.model import Character
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.model import Body

CHECKED_NAME: Final = "arms_checked.toml"
"""File of `checked_costs`, written by ``resources.build.check_cast --write``."""
SWIVELS: Final = 36
"""Number of tried positions of the elbow."""
STRAINED: Final = (1.5, 7.0)
"""Factor and difference of the cost of two characters' arms beyond which wrists are expected to leave the human ranges
in motion, for instruments that no bundled person was checked with."""
MORE_THAN_CHECKED: Final = 1.15
"""Factor of the greatest cost among the bundled people who were checked in motion beyond which a body is strained: a
man of 1.86 m and 88 years stays within the bounds of contacts at 1.12.
"""


def with_own_arms(grip: GripPose, character: Character, instrument: InstrumentMap, body: Body) -> GripPose:
    """Return the grip of a character from that of another one with the same hands (`Character.hands_of`).

    Each elbow is placed for the straightest wrist between shoulder and instrument, as in a new fit.
    """
    lips = fit_lips(character, instrument, body)
    own = replace(grip, character_id=character.id, lips=lips)
    if instrument.size != 1.0:
        # The hands were fitted at their usual size; the elbow then hangs like that of the other character.
        return own
    stand = upright(character, instrument, body, lips)
    hands = zip(grip.hands, instrument.hands, strict=True)
    return replace(
        own,
        hands=tuple(_elbow(hand, arm_problem(character, instrument, body, seed, stand), stand) for hand, seed in hands),
    )


def arms_cost(grip: GripPose, character: Character, instrument: InstrumentMap, body: Body) -> float:
    """Return the strain of both arms if a character uses the grip of another one with the same hands: the sum of
    squares of the fit's residuals for elbows and wrists.
    """
    stand = upright(character, instrument, body, fit_lips(character, instrument, body))
    hands = zip(grip.hands, instrument.hands, strict=True)
    return sum(
        float(_costs(hand, arm_problem(character, instrument, body, seed, stand))[1].min()) for hand, seed in hands
    )


def are_strained(
    grip: GripPose,
    character: Character,
    other: Character,
    carried: tuple[InstrumentMap, InstrumentMap],
    body: Body,
) -> bool:
    """Return whether a character bends its wrists further than everyone with the same hands whose motion was checked
    (`checked_costs`); for an instrument of the user, whether much further than the other one with the same grip.

    Parameters
    ----------
    grip : GripPose
        Grip of the other character.
    carried : (InstrumentMap, InstrumentMap)
        The instrument as carried by the character, and as carried by the other one.
    """
    own = arms_cost(grip, character, carried[0], body)
    if bundled_maps().get(carried[1].id) is carried[1] and other.id in checked_costs():
        return own > MORE_THAN_CHECKED * checked_costs()[other.id].get(carried[1].id, 0.0)
    times, more = STRAINED
    usual = arms_cost(grip, other, carried[1], body)
    return own > max(times * usual, usual + more)


@cache
def checked_costs() -> Mapping[str, Mapping[str, float]]:
    """Return the greatest `arms_cost` among the bundled people who play within the bounds, by the body that their hands
    are from and by instrument; an instrument that none of them plays is absent.
    """
    path = Path(str(files("resources"))) / "characters" / CHECKED_NAME
    return MappingProxyType(shaped(read_toml(path), dict[str, dict[str, float]], str(path)))


def _elbow(hand: HandHold, problem: ArmProblem, stand: Upright) -> HandHold:
    swivels, cost = _costs(hand, problem)
    swivel = swivels[np.argmin(cost)]
    down, out = problem.swivel_frame
    pole = quaternion.rotate(stand.instrument_rotation, np.cos(swivel) * down + np.sin(swivel) * out)
    return replace(hand, elbow_direction=pole)


def _costs(hand: HandHold, problem: ArmProblem) -> tuple[FloatArray, FloatArray]:
    """Return the tried swivels of the elbow (`SWIVELS`,) in radians, and the cost of each."""
    swivels = np.linspace(*problem.swivel_range, SWIVELS)
    cost = np.zeros(SWIVELS)
    places, turns = np.atleast_2d(hand.instrument_from_hand_m), np.atleast_2d(hand.instrument_from_hand_rotation)
    for place, turn in zip(places, turns, strict=True):
        parts = arm_residuals(problem, swivels, np.tile(place, (SWIVELS, 1)), np.tile(turn, (SWIVELS, 1)))
        cost += np.square(parts).sum(axis=1)
    return swivels, cost
