"""Chooses the places of catch breaths: where the air would run out before the next rest, and at clear phrase ends."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.breath.catch_breath_lengths import MOST_DROPPED, Room
from app.plan.breath.lungs import FULL_BREATH_S, HASTY_SHARE, levels
from app.plan.breath.phrase_ends import ComparedLine, place_costs, slur_costs
from app.plan.breath.rests_for_breath import LEAST_PLAYED_S
from app.plan.music.piece import EPSILON

LEAST_COST = 0.2
"""Least cost of a breath before the air is used up, so that breaths stay at the ends of phrases."""
ONE_MORE = 1.5
"""Least need of air of a stretch, in lungfuls, from which a breath at a phrase's end within it counts as needed."""
EARLY_COST = 0.25
"""Cost of breathing with full lungs; with half-full lungs a quarter of it."""
HASTY_COST = 10.0
"""Cost of breathing before `HASTY_SHARE` of the lungs is used."""
GASP_COST = 100.0
"""Cost of breathing after less than `LEAST_PLAYED_S` of playing, acceptable only without any air left."""
TOO_LONG_COST = 1000.0
BREAKING_COST = 150.0
"""Cost from which a place conflicts with the score's marks, so that other ways of breathing before it are compared."""
AIR_STEPS = 32
"""Number of distinguished amounts of air in that comparison."""
DROPPED_COST = 30.0
"""Cost of omitting a note if none is long enough for a catch breath."""
MISSING_COST = 10.0
"""Additional cost for each other player of the same rhythm who omits a note nearby, which would leave a gap."""
NEAR = MOST_DROPPED
"""Number of notes within which two places are near each other."""


class AirSupply(NamedTuple):
    """Air supply of a part.

    Attributes
    ----------
    used : (N + 1,) float64
        `air_used_s`.
    lung_s : float
        `lungful_s`.
    refill : (N,) float64
        Share of the lungs filled by the breath before each note; 0 without a breath.
    free_s : float
        Seconds of air that must be used before a breath is taken for a phrase end alone.
    """

    used: FloatArray
    lung_s: float
    refill: FloatArray
    free_s: float


def catch_places(line: ComparedLine, lungs: AirSupply, may: BoolArray, missing: IntArray, room: Room) -> list[int]:
    """Indices of the notes with a catch breath before them.

    Between two given breaths, finds the cheapest chain of places such that no stretch needs more air than there is (a
    shortest path; a place costs less the better a phrase end it is, and below 0 at a clear one). If no chain suffices,
    the stretch stays short of air.

    Parameters
    ----------
    may : (N,) bool
        Mask of notes before which the rules may place a breath.
    missing : (N,) int64
        Number of other players of the same rhythm that leave out each note.
    room : Room
        Available time before each note; notes are left out only if nothing else gives enough air.
    """
    used, lung_s, refill, free_s = lungs
    level = levels(used, lung_s, refill)
    may = may & (refill == 0.0)
    open_ = may & (room.length_s > 0.0)
    open_[0] = False
    stretches = _stretches(lungs, level)
    if not stretches:
        return []
    # Notes may be dropped for a breath only if no breath in a rest lies between them.
    breathed = np.concatenate(([0], np.cumsum(refill > 0.0)))
    places = np.arange(len(refill))
    dropping = may & ~open_ & (room.drop_s > 0.0) & (breathed[places] == breathed[places - room.dropped])
    cost = np.full(len(refill), np.inf)
    at = np.concatenate([start + 1 + np.flatnonzero(open_[start + 1 : end]) for start, end, _ in stretches])
    cost[at] = place_costs(line, at)
    air_s = np.minimum(room.lasts_s / FULL_BREATH_S, 1.0) * lung_s
    played_s = np.concatenate(([0.0], np.cumsum(line.times.duration_s)))

    def chain(start: int, end: int, allowed: BoolArray) -> tuple[list[int], bool]:
        places = start + 1 + np.flatnonzero(allowed[start + 1 : end])
        nodes = np.concatenate(([start], places, [end]))
        numbers = used[nodes].tobytes(), played_s[nodes].tobytes(), cost[places].tobytes(), air_s[places].tobytes()
        found, is_enough = cheapest_chain(*numbers, float(level[start]), lung_s, free_s)
        if (cost[places[list(found)]] >= BREAKING_COST).any():
            found, is_enough = cheapest_chain(*numbers, float(level[start]), lung_s, free_s, steps=AIR_STEPS)
        return places[list(found)].tolist(), is_enough

    # While the air lasts, a breath is worthwhile only at the end of a phrase and outside rests: `rests_for_breath`
    # decides about those.
    ends_phrase = open_ & (cost < 0.0) & (line.rests == 0)
    result: list[int] = []
    for start, end, is_short in stretches:
        if not is_short:
            if ends_phrase[start + 1 : end].any():
                result += chain(start, end, ends_phrase)[0]
            continue
        found, is_enough = chain(start, end, open_)
        also = start + 1 + np.flatnonzero(dropping[start + 1 : end])
        if len(also) and not (is_enough and (cost[found] < DROPPED_COST).all()):
            cost[also] = _dropping_costs(line, also, room.dropped[also], missing)
            found, _ = chain(start, end, open_ | dropping)
        result += found
    return result


def _stretches(lungs: AirSupply, level: FloatArray) -> list[tuple[int, int, bool]]:
    """Return the stretches of notes between given breaths in which a catch breath is possible: first note, index after
    the last note, and True if the air does not suffice."""
    used, lung_s, refill, free_s = lungs
    starts = np.unique(np.concatenate(([0], np.flatnonzero(refill > 0.0))))
    ends = np.append(starts[1:], len(refill))
    taken_s = used[ends] - used[starts]
    short = taken_s > level[starts] * lung_s + EPSILON
    some = short | (taken_s >= ONE_MORE * free_s)
    return list(zip(starts[some].tolist(), ends[some].tolist(), short[some].tolist(), strict=True))


def _dropping_costs(line: ComparedLine, at: IntArray, dropped: IntArray, missing: IntArray) -> FloatArray:
    """Return the cost (K,) of K breaths that replace notes: that of a breath before the replaced notes plus that of
    leaving them out."""
    cost = place_costs(line, at - dropped, dropped)
    cost += DROPPED_COST * dropped + slur_costs(line, at)
    before = np.concatenate(([0], np.cumsum(missing)))
    others = before[np.minimum(at + NEAR, len(missing))] - before[np.maximum(at - dropped - NEAR, 0)]
    return np.asarray(cost + MISSING_COST * others, dtype=np.float64)


@lru_cache(maxsize=4096)
def cheapest_chain(
    used: bytes, played: bytes, cost: bytes, drawn: bytes, level: float, lung_s: float, free_s: float, *, steps: int = 1
) -> tuple[tuple[int, ...], bool]:
    """Return the cheapest places of catch breaths in one stretch, and whether the air lasts with them.

    Label-setting search: the air at a place is what the best path so far left plus what the catch breath adds. With
    several ``steps`` the best path is kept for each amount of air, since the cheapest one may leave too little.

    Cached by its arguments, since an edit leaves most stretches unchanged.

    Parameters
    ----------
    used, played : bytes of (K + 2,) float64
        Air used and seconds played up to the start of the stretch, up to each place, and up to its end.
    cost, drawn : bytes of (K,) float64
        Cost of each place, and the air that a catch breath adds there.
    free_s : float
        Air used below which no place costs less than `LEAST_COST`.
    steps : int
        Number of amounts of air in the lungs that are kept apart.
    """
    used_s, played_s = np.frombuffer(used), np.frombuffer(played)
    costs, drawn_s = np.frombuffer(cost).tolist(), np.frombuffer(drawn).tolist()
    last = len(used_s) - 1
    air_s = np.full((last + 1, steps), level * lung_s)
    total = np.full((last + 1, steps), np.inf)
    total[0, 0] = 0.0
    origin = np.zeros((last + 1, steps), dtype=np.int64)
    # One lungful reaches no further back than this; if it does not reach the previous place, that place is used anyway.
    reach = np.minimum(np.searchsorted(used_s, used_s - lung_s - EPSILON), np.arange(last + 1) - 1)
    # From here on so little air has been used that a breath would be premature.
    hasty_s = HASTY_SHARE * lung_s
    hasty = np.searchsorted(used_s, used_s - hasty_s, side="right").tolist()
    gasps = np.searchsorted(played_s, played_s - LEAST_PLAYED_S + EPSILON, side="right").tolist()
    for node, back in enumerate(reach.tolist()[1:], 1):
        needed = used_s[node] - used_s[back:node]
        left_s = air_s[back:node] - needed[:, None]
        ways = total[back:node].copy()
        late = max(hasty[node] - back, 0)
        if late < len(ways):
            ways[late:] += HASTY_COST * np.maximum(1.0 - needed[late:, None] / hasty_s, 0.0)
        if gasps[node] < node:
            ways[max(gasps[node] - back, 0) :] += GASP_COST
        if left_s.min() < 0.0:
            ways += np.where(left_s < -EPSILON, TOO_LONG_COST * (1.0 - left_s), 0.0)
            np.maximum(left_s, 0.0, out=left_s)
        if node < last:
            here = costs[node - 1]
            ways += here if here >= LEAST_COST else np.where(needed[:, None] < free_s, LEAST_COST, here)
            ways += (EARLY_COST / lung_s**2) * left_s * left_s
            left_s = np.minimum(left_s + drawn_s[node - 1], lung_s)
        ways, left_s = ways.ravel(), left_s.ravel()
        if steps == 1 or node == last:
            best = np.array([ways.argmin()])
        else:
            order = ways.argsort(kind="stable")
            best = order[np.unique((left_s[order] * (steps - 1) / lung_s).astype(np.int64), return_index=True)[1]]
        kept = slice(len(best))
        origin[node, kept], total[node, kept], air_s[node, kept] = back * steps + best, ways[best], left_s[best]
    chain = []
    label = int(origin[-1, 0])
    while label >= steps:
        chain.append(label // steps - 1)
        label = int(origin.flat[label])
    return tuple(chain[::-1]), bool(total[-1, 0] < TOO_LONG_COST)
