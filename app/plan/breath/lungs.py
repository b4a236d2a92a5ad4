"""Air supply: air used by notes and gained by breaths."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.music.breath_controller import STOPS_AT, BreathEnvelope, step_means
from app.plan.music.dynamics import mean_around
from app.plan.music.piece import EPSILON, MEZZOFORTE, LineTimes, marked_loudness
from app.plan.parameters import PlayerParameters
from instrument_maps.wind import Air

FULL_BREATH_S = 0.5
"""Seconds that a trained player needs to fill the lungs."""
LOUDNESS_RANGE = (0.6, 1.6)
"""Use of air by the softest and the loudest note relative to mezzoforte, unless the instrument's map defines it."""
USUAL_LUNG_S = 9.0
"""Default of `PlayerParameters.lung_s`, to which the `Air` values of maps refer."""
PIANO, FORTE = 0.39, 0.77
"""Loudness of the two dynamics in a map's `Air`: velocities 49 and 98 of 127."""

PHRASE_S = 8.0
"""Seconds before and after a note over which loudness is averaged; its air follows the dynamic mark nearest to the
mean."""
STALE_S = 12.0
"""Seconds after which lungs of default size need fresh air even on an instrument that uses little (an oboist exhales
first).
"""

CIRCULAR_SHARE = 0.4
"""Share of the air that remains in the lungs of a player who inhales through the nose."""

HASTY_SHARE = 0.4
"""Least used share of the lungs before the next breath, where possible."""


def air_used_s(times: LineTimes, air: Air | None = None, envelope: BreathEnvelope | None = None) -> FloatArray:
    """Cumulative use of air (N + 1,) by N notes: before each note, and in total, in seconds of playing at mezzoforte.

    Parameters
    ----------
    envelope : BreathEnvelope or None
        Recorded breath; if it shows when air is blown, all of it counts, also between notes.
    """
    lasts_s = times.duration_s
    # Air is used by the dynamic of the phrase, regardless of variations of single notes.
    loudness = marked_loudness(
        mean_around(times.onset_s, lasts_s, times.loudness, times.onset_s + lasts_s / 2.0, PHRASE_S)
    )
    noted_s = lasts_s * air_rate(loudness, air)
    if envelope is None:
        return np.concatenate(([0.0], np.cumsum(noted_s)))
    rate = np.where(envelope.values > STOPS_AT, air_rate(envelope.values, air), 0.0)
    ends_s = np.append(times.onset_s[1:], times.played_end_s[-1])
    blown_s = np.maximum(ends_s - times.onset_s, EPSILON)
    taken = step_means(envelope.at_s, rate, times.onset_s, times.onset_s + blown_s) * blown_s
    # Air for notes that were not blown is computed from their loudness.
    taken = np.where(envelope.plays(times), taken, noted_s)
    return np.concatenate(([0.0], np.cumsum(taken)))


def air_rate(loudness: FloatArray, air: Air | None = None) -> FloatArray:
    """Return the rate (N,) at which air is used at a loudness 0..1, relative to mezzoforte."""
    if air is None:
        low, high = LOUDNESS_RANGE
        return np.interp(loudness, [0.0, MEZZOFORTE, 1.0], [low, 1.0, high])
    lasting_s = [min(lasts_s, STALE_S) for lasts_s in (air.piano_s, air.mezzoforte_s, air.forte_s)]
    return np.interp(loudness, [PIANO, MEZZOFORTE, FORTE], [lasting_s[1] / one_s for one_s in lasting_s])


def lungful_s(parameters: PlayerParameters, air: Air | None = None) -> float:
    """Seconds that a full breath of the player lasts at mezzoforte: the value of the instrument map (``air``), scaled
    to the player's lungs.
    """
    return parameters.lung_s * (1.0 if air is None else min(air.mezzoforte_s, STALE_S) / USUAL_LUNG_S)


def levels(used: FloatArray, lung_s: float, refill: FloatArray) -> FloatArray:
    """Fill level (N,) of the lungs, 0..1, at each note's onset, after the breath before it."""
    # No player begins with empty lungs: if no breath precedes the first note (removed by hand), a normal one is
    # assumed.
    here, before = (0.5 if refill[0] == 0.0 else 0.0), 0
    breaths = np.flatnonzero(refill > 0.0)
    full = [here]
    for index, air, more in zip(breaths.tolist(), used[breaths].tolist(), refill[breaths].tolist(), strict=True):
        spent = (air - float(used[before])) / lung_s
        here, before = min(max(here - spent, 0.0) + more, 1.0), index
        full.append(here)
    # The content of the lungs decreases until the next breath as air is used.
    last = np.searchsorted(breaths, np.arange(len(refill)), side="right")
    since = used[np.concatenate(([0], breaths))[last]]
    return np.asarray(np.maximum(np.array(full)[last] - (used[: len(refill)] - since) / lung_s, 0.0))


def short_catches(used: FloatArray, lung_s: float, refill: FloatArray, filled: FloatArray) -> IntArray:
    """Indices (K,) of notes before which catch breaths do not provide enough air.

    Covers the notes from the catch breath before the first stretch that is short of air to the next breath in a rest.

    Parameters
    ----------
    refill, filled : (N,) float
        Share of the lungs filled by breaths in rests, and by all breaths.
    """
    starts = np.unique(np.concatenate(([0], np.flatnonzero(filled > 0.0))))
    ends = np.append(starts[1:], len(filled))
    short = np.flatnonzero(used[ends] - used[starts] > levels(used, lung_s, filled)[starts] * lung_s + EPSILON)
    rests = np.append(np.flatnonzero(refill > 0.0), len(filled))
    result = np.zeros(len(filled), dtype=bool)
    for first, start in zip(starts[np.maximum(short - 1, 0)].tolist(), starts[short].tolist(), strict=True):
        place = int(np.searchsorted(rests, start, side="right"))
        result[max(first, int(rests[place - 1]) if place else 0) : rests[place]] = True
    return np.flatnonzero(result & (filled > 0.0) & (refill == 0.0))


def with_circular_breathing(used: FloatArray, lung_s: float, refill: FloatArray) -> FloatArray:
    """Cumulative use of air (N + 1,) as from `air_used_s`, minus the air inhaled through the nose during circular
    breathing.

    After each breath in ``refill`` (`levels`) the lungs empty to the share `CIRCULAR_SHARE` and stay at it.
    """
    result = used.copy()
    level = 0.5 if refill[0] == 0.0 else 0.0
    starts = np.unique(np.concatenate(([0], np.flatnonzero(refill > 0.0))))
    for start, end in zip(starts.tolist(), [*starts[1:].tolist(), len(refill)], strict=True):
        level = min(level + float(refill[start]), 1.0)
        most_s = (1.0 - CIRCULAR_SHARE) * level * lung_s
        result[start + 1 : end + 1] = result[start] + np.minimum(used[start + 1 : end + 1] - used[start], most_s)
        level -= float(result[end] - result[start]) / lung_s
    return result


def drawn_share(length_s: float) -> float:
    """Share of the lungs filled by a breath of this length."""
    return min(length_s / FULL_BREATH_S, 1.0)
