"""Slow curves of a face from the notes of a plan: exertion, and the direction of the music.

Computed in integers on an absolute time grid, so that distant notes have no influence, not even in the last bit. Slow
quantities (direction of melody, phrase, remaining air, tired lips) follow the generated plan: lips set by hand only
change the momentary load.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from app.arrays import BoolArray, FloatArray, IntArray
from app.motion.curves.spline import Spline
from app.plan.breath.lungs import air_rate, lungful_s
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters
from instrument_maps.wind import Air
from metadata.face_model import FaceMotion

Whole: TypeAlias = npt.NDArray[np.int32]
"""Fixed-point numbers, with `ONE` for 1: a product of two has 24 bits; wider ones take twice as long."""

STEP_S: Final = 0.05
BITS: Final = 12
ONE: Final = 1 << BITS
"""The number 1 in fixed point."""
WORKING_S: Final = 0.10
"""Seconds before and after a moment whose notes determine the effort shown in the face."""
CONTOUR_S, AROUND_S = 0.25, 1.6
"""Seconds around a moment over which notes are averaged, and the longer time with whose mean that average is
compared.
"""
CONTOUR: Final = 3.0
"""Factor of that difference: a third of the range of tension or loudness is a full rise."""
LIGHT: Final = 0.35
"""Load 0..1 that can be sustained without tiring."""
PHRASE_REST_S: Final = 0.6
"""Length in seconds of a rest that ends a phrase; a breath ends it too."""
PEAK: Final = 0.62
"""Position of a phrase's greatest tension, as a share of the phrase."""
WHOLE_PHRASE_S: Final = 4.0
"""Length in seconds of a phrase with the full tension; shorter ones have proportionally less."""
TIRES_S: Final = 16.0
"""Time in seconds over which load is averaged for the fatigue of the lips."""
TIRED_FROM, TIRED_AT = 0.25, 0.65
"""Mean loads at which fatigue begins and is complete."""
TIRED_STEPS: Final = 32
AFTER_S: Final = 8.0
"""Seconds after the last note within which the face relaxes."""


class Exertion(NamedTuple):
    """Exertion that shows in the face, sampled at F times: each field (F,) is 0..1, but ``contour`` (direction of the
    melody) and ``swell`` are -1..1. `FaceMotion` defines their effect.
    """

    working: FloatArray
    strain: FloatArray
    contour: FloatArray
    swell: FloatArray
    emptying: FloatArray
    phrase: FloatArray
    tired: FloatArray


@dataclass(frozen=True)
class Lungs:
    """Air of a player: seconds that a full breath lasts at mezzoforte, and how the use of air changes with loudness."""

    full_s: float
    air: Air | None = None

    @classmethod
    def of(cls, parameters: PlayerParameters, air: Air | None) -> Lungs:
        """Return the lungs of a player whose instrument uses air as ``air`` describes."""
        return cls(lungful_s(parameters, air), air)


def exertion_of(plan: PlayerPlan, face: FaceMotion, lungs: Lungs) -> Spline:
    """Compute the `Exertion` curves of a whole plan."""
    frame = plan.time_frame
    first = int(np.floor(frame.first_frame_s / STEP_S)) - 1
    count = int(np.ceil((frame.end_s + AFTER_S) / STEP_S)) - first
    at_s = (first + np.arange(count, dtype=np.float64)) * STEP_S
    if not plan.embouchures:
        return Spline(first, STEP_S, np.zeros((len(Exertion._fields), 1), np.int16), float(ONE))
    starts_s = np.array([event.start_s for event in plan.embouchures])
    ends_s = np.minimum(np.array([event.end_s for event in plan.embouchures]), np.append(starts_s[1:], np.inf))
    note = np.searchsorted(starts_s, at_s, side="right") - 1
    sounds = (note >= 0) & (at_s < ends_s[note])
    tension, air, effort = _asked(plan, at_s, note, sounds, as_planned=False)
    load = music = _load(face, tension, air, effort, sounds)
    if any(event.planned is not None for event in plan.embouchures):
        tension, air, effort = _asked(plan, at_s, note, sounds, as_planned=True)
        music = _load(face, tension, air, effort, sounds)
    playing = sounds.astype(np.int32)
    arch = _arch(plan, starts_s, ends_s, at_s)
    rows = (
        _mean(load, WORKING_S, WORKING_S),
        _strain(load, face.rise_s, face.decay_s),
        _apart(_whole(tension), playing),
        _apart(_whole(air), playing),
        _emptying(plan, lungs, air * sounds, sounds, at_s),
        _mean(_whole(arch) * _mean(music, 0.8, 0.8) // (ONE // 2), 0.2, 0.2),
        _tired(music),
    )
    low = np.array([[-ONE if name in ("contour", "swell") else 0] for name in Exertion._fields])
    return Spline(first, STEP_S, np.clip(np.stack(rows), low, ONE).astype(np.int16), float(ONE))


def _load(face: FaceMotion, tension: FloatArray, air: FloatArray, effort: FloatArray, sounds: BoolArray) -> Whole:
    """Combine tension, air and effort (N,) on the time grid to the load of the notes, 0..1; 0 where nothing sounds."""
    share = face.load
    cost = share.tension * tension + share.air * air + share.effort * effort - share.easy
    return _whole(np.clip(np.where(sounds, cost, 0.0), 0.0, 1.0))


def _asked(
    plan: PlayerPlan, at_s: FloatArray, note: IntArray, sounds: BoolArray, *, as_planned: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lip tension, air and effort on the time grid, each 0 in silences: recorded values where there are any, else those
    of the notes.

    ``as_planned`` excludes values set by hand.
    """
    events, traces = plan.embouchures, plan.traces
    rows = [
        (event.tension, event.effort, event.air) if event.planned is None or not as_planned else event.planned
        for event in events
    ]
    found = [np.where(sounds, column[note], 0.0) for column in np.array(rows).T[[0, 2, 1]]]
    if traces is not None:
        place = np.rint((at_s - traces.start_s) / traces.step_s).astype(np.int64)
        for number, values in enumerate((traces.tension, traces.air, traces.effort)):
            if values is not None:
                found[number] = np.where(sounds, values[np.clip(place, 0, len(values) - 1)], 0.0)
    return found[0], found[1], found[2]


def _whole(values: FloatArray) -> Whole:
    return np.rint(values * ONE).astype(np.int32)


def _sum(values: Whole, before_s: float, after_s: float) -> Whole:
    """Sum values over a window from ``before_s`` before to ``after_s`` after each, by cumulative sums; integer
    wrap-around cancels out.
    """
    before, after = (max(round(width_s / STEP_S), 0) for width_s in (before_s, after_s))
    total = np.zeros(before + 1 + len(values) + after, np.int32)
    upto = total[before + 1 : before + 1 + len(values)]
    np.cumsum(values, dtype=np.int32, out=upto)
    total[before + 1 + len(values) :] = upto[-1]
    sums: Whole = total[before + after + 1 :] - total[: len(values)]
    return sums


def _mean(values: Whole, before_s: float, after_s: float) -> Whole:
    """Average values over a window from ``before_s`` before to ``after_s`` after each, twice, for a smooth fall-off."""
    for _ in range(2):
        values = _sum(values, before_s, after_s) // (round(before_s / STEP_S) + round(after_s / STEP_S) + 1)
    return values


def _apart(values: Whole, playing: Whole) -> Whole:
    """Excess of each value over the average of the surrounding notes; 0 in rests."""
    sounds = np.flatnonzero(playing)
    here, around = (
        _sum(values, width_s, width_s)[sounds] // _sum(playing, width_s, width_s)[sounds]
        for width_s in (CONTOUR_S, AROUND_S)
    )
    apart = np.zeros(len(values), np.int32)
    apart[sounds] = np.clip(round(CONTOUR) * (here - around), -ONE, ONE)
    return _mean(apart, CONTOUR_S, CONTOUR_S)


def _strain(load: Whole, rise_s: float, decay_s: float) -> Whole:
    """Strain of the face, which grows within ``rise_s`` under a heavy load and decays within ``decay_s`` after it."""
    heavy = np.maximum(load - round(LIGHT * ONE), 0)
    grown = _mean(heavy, rise_s / 2.0, 0.0) * ONE // round((1.0 - LIGHT) * ONE)
    steps = round(decay_s / STEP_S)
    strain, passed = grown.copy(), np.empty_like(grown)
    for step in range(1, steps):
        left = np.int32(round(ONE * (1.0 - step / steps) ** 2))
        np.multiply(grown[:-step], left, out=passed[step:])
        np.right_shift(passed[step:], BITS, out=passed[step:])
        np.maximum(strain[step:], passed[step:], out=strain[step:])
    return _mean(strain, 0.1, 0.1)


def _emptying(plan: PlayerPlan, lungs: Lungs, loudness: FloatArray, sounds: BoolArray, at_s: FloatArray) -> Whole:
    """Return the share of the last breath's air that is used up."""
    rate = _whole(np.where(sounds, air_rate(loudness, lungs.air), 0.0))
    used = np.cumsum(rate, dtype=np.int64)
    breaths = [event for event in plan.breaths if event.draws_air]
    if not breaths:
        return np.zeros(len(at_s), np.int32)
    ends_s = np.maximum.accumulate(np.array([event.end_s for event in breaths]))
    filled = np.searchsorted(ends_s, at_s, side="right") - 1
    begins = np.searchsorted(at_s, ends_s, side="left")
    before = np.append(used[np.minimum(begins, len(at_s) - 1)], 0)[filled]
    depths = np.append(np.array([max(event.depth, 0.3) for event in breaths]), 1.0)[filled]
    spent = np.where(filled >= 0, used - before, 0) * STEP_S / (depths * lungs.full_s)
    # The first half of the exertion hardly shows.
    left = _whole(np.square(np.clip(spent / ONE, 0.0, 1.0)))
    return _mean(np.where(_sum(sounds.astype(np.int32), 0.5, 0.0) > 0, left, np.int32(0)), 0.15, 0.15)


def _arch(plan: PlayerPlan, starts_s: FloatArray, ends_s: FloatArray, at_s: FloatArray) -> FloatArray:
    """Return the position (N,) in the arch of the phrase at each time: 0 at its ends, 1 at its peak. ``starts_s`` and
    ``ends_s`` are those of the notes."""
    breaths_s = np.array([event.end_s for event in plan.breaths if event.draws_air])
    rested = np.append(True, starts_s[1:] - ends_s[:-1] >= PHRASE_REST_S)
    rested[np.minimum(np.searchsorted(starts_s, breaths_s - 1e-6), len(starts_s) - 1)] = True
    begins = np.flatnonzero(rested)
    from_s, to_s = starts_s[begins], ends_s[np.append(begins[1:], len(starts_s)) - 1]
    phrase = np.maximum(np.searchsorted(from_s, at_s, side="right") - 1, 0)
    length_s = np.maximum(to_s - from_s, STEP_S)
    share = np.clip((at_s - from_s[phrase]) / length_s[phrase], 0.0, 1.0)
    rise = np.where(share < PEAK, share / PEAK, (1.0 - share) / (1.0 - PEAK))
    arch: FloatArray = rise * rise * (3.0 - 2.0 * rise) * np.minimum(length_s[phrase] / WHOLE_PHRASE_S, 1.0)
    return arch


def _tired(load: Whole) -> Whole:
    """Tiredness of the lips after a long time without rest; in steps, so that single notes rarely change it."""
    mean = _sum(load, TIRES_S, 0.0) // round(TIRES_S / STEP_S)
    more = (mean - round(TIRED_FROM * ONE)) * ONE // round((TIRED_AT - TIRED_FROM) * ONE)
    step = ONE // TIRED_STEPS
    return np.clip(more // step * step, 0, ONE)
