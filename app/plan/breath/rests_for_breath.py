"""Chooses the rests to breathe in, by their length, the playing since the last breath, and the air used.

In a long rest a player always breathes; the shorter the rest, the longer the playing before or the less the air left
must be. `app.plan.breath.breaths_in_rests` then shapes the breath.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.errors import Argument
from app.plan.music.piece import EPSILON
from app.plan.parameters import PARAMETERS

USUAL_NEED: Final = float(PARAMETERS["breath_need"].default)
"""Value of `breath_need` for which the constants below apply; a smaller one scales them down to 0, a greater one up to
full lungs.
"""

ALWAYS_S: Final = 1.5
"""Length in seconds of rests in which players breathe with any need."""
LONG_S: Final = 0.75
"""Length in seconds of rests in which players breathe after `LONG_PLAYED_S`, and which count regardless of their length
in beats.
"""
MIDDLE_S: Final = 0.5
"""Length in seconds of rests in which players breathe after `MIDDLE_PLAYED_S`, or with `MIDDLE_SHARE` of the lungs
used.
"""
SHORT_S: Final = 0.3
"""Length in seconds of rests in which players breathe after `SHORT_PLAYED_S`, or with `SHORT_SHARES` of the lungs used.
Shorter ones allow catch breaths only.
"""
LONG_PLAYED_S: Final = 1.0
MIDDLE_PLAYED_S: Final = 2.5
MIDDLE_SHARE: Final = 0.2
SHORT_SHARES: Final = (0.4, 0.35)
SHORT_PLAYED_S: Final = (5.0, 3.5)
"""Seconds of playing before a rest of `SHORT_S`, and before one of nearly `MIDDLE_S`, from which players with large
lungs breathe by habit.
"""
LEAST_PLAYED_S: Final = 1.0
"""Least seconds of playing before a breath in a rest shorter than `ALWAYS_S`, however small the lungs are."""
SHORT_LEAST_PLAYED_S: Final = 1.5
"""Least seconds of playing since the last breath before a breath in a rest shorter than `MIDDLE_S`."""


class RestNeeds(NamedTuple):
    """Conditions for a breath in the rest before each note, each array (N,) float64.

    Attributes
    ----------
    least_s
        Seconds of playing since the last breath below which the rest is never used.
    played_s
        Seconds of playing since the last breath from which the rest is always used.
    share
        Share of the lungs used up from which the rest is used.
    """

    least_s: FloatArray
    played_s: FloatArray
    share: FloatArray


class Decided(NamedTuple):
    """Decision for each rest, with the values behind it, each array (N,).

    Attributes
    ----------
    breathed : bool
        Whether the player breathes in the rest.
    played_s : float64
        Seconds that sounded since the last breath in a rest.
    spent : float64
        Share of the lungs that is used up, 0..1.
    """

    breathed: BoolArray
    played_s: FloatArray
    spent: FloatArray


def rest_needs(rest_s: FloatArray, need: float, lung_s: float) -> RestNeeds:
    """Return the conditions for breaths in rests of some lengths.

    Parameters
    ----------
    rest_s : (N,) float64
        At the tempo of the score.
    need : float
        `app.plan.parameters.PlayerParameters.breath_need`.
    lung_s : float
        `app.plan.breath.lungs.lungful_s`.
    """

    def scaled(figure: float, most: float) -> float:
        return float(np.interp(need, [0.0, USUAL_NEED, 1.0], [0.0, figure, most]))

    kind = np.searchsorted(np.array([SHORT_S, MIDDLE_S, LONG_S, ALWAYS_S]) - EPSILON, rest_s, side="right")
    short_s = np.interp(rest_s, [SHORT_S, MIDDLE_S], [scaled(played_s, lung_s) for played_s in SHORT_PLAYED_S])
    shares = np.interp(rest_s, [SHORT_S, MIDDLE_S], [scaled(share, 1.0) for share in SHORT_SHARES])
    least, short_least = (scaled(figure, figure) for figure in (LEAST_PLAYED_S, SHORT_LEAST_PLAYED_S))
    middle = scaled(MIDDLE_SHARE, 1.0)
    # If the lungs would be empty before the rest of a catch breath, an earlier breath is better.
    empty = scaled(1.0, 1.0) if need < USUAL_NEED else np.inf
    played_s = np.array([np.inf, 0.0, scaled(MIDDLE_PLAYED_S, lung_s), scaled(LONG_PLAYED_S, lung_s), 0.0])
    is_short = kind == 1
    return RestNeeds(
        np.array([short_least, short_least, least, least, 0.0])[kind],
        np.where(is_short, short_s, played_s[kind]),
        np.where(is_short, shares, np.array([empty, 0.0, middle, middle, 0.0])[kind]),
    )


def breathed_in(used: FloatArray, played_s: FloatArray, lung_s: float, refill: FloatArray, needs: RestNeeds) -> Decided:
    """Decide for each rest in order whether the player breathes in it; each decision changes the air left for the next.

    Parameters
    ----------
    used : (N + 1,) float64
        `app.plan.breath.lungs.air_used_s`.
    played_s : (N + 1,) float64
        Seconds that sounded before each note, and in total.
    refill : (N,) float64
        Share of the lungs that a breath before each note would fill; 0 without one.
    """
    places = np.flatnonzero(refill > 0.0)
    level, before_s, air_s = (0.5 if refill[0] == 0.0 else 0.0), 0.0, 0.0
    rows = zip(*(column[places].tolist() for column in (used, played_s, refill, *needs)), strict=True)
    found: list[tuple[bool, float, float]] = []
    for taken_s, sounded_s, more, least_s, enough_s, share in rows:
        level = max(level - (taken_s - air_s) / lung_s, 0.0)
        air_s, since_s, spent = taken_s, sounded_s - before_s, 1.0 - level
        is_enough = since_s >= enough_s - EPSILON or spent >= share - EPSILON
        is_breathed = is_enough and since_s >= least_s - EPSILON
        if is_breathed:
            before_s, level = sounded_s, min(level + more, 1.0)
        found.append((is_breathed, since_s, spent))
    columns = np.zeros((3, len(refill)))
    if found:
        columns[:, places] = np.array(found, dtype=np.float64).T
    return Decided(columns[0] > 0.0, columns[1], columns[2])


def why(index: int, rest_s: FloatArray, needs: RestNeeds, decided: Decided) -> dict[str, Argument]:
    """Arguments of the message that explains why a player breathes in the rest before the note ``index``. Their item
    ``why`` is the id of the reason's text; the others are the numbers in it.
    """
    least_s, enough_s, share = (float(column[index]) for column in needs)
    since_s, spent = float(decided.played_s[index]), float(decided.spent[index])
    if rest_s[index] >= ALWAYS_S - EPSILON:
        return {"why": "breath.why_long", "always_s": ALWAYS_S}
    if max(least_s, min(enough_s, share)) <= 0.0:
        return {"why": "breath.why_every"}
    if since_s >= enough_s - EPSILON:
        return {"why": "breath.why_played", "played_s": round(since_s, 2), "enough_s": round(max(enough_s, least_s), 2)}
    return {"why": "breath.why_air", "spent": round(100.0 * spent), "share": round(100.0 * share)}
