"""Converts an animator's additive curves to seconds and checks them against the limits of a body."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

import numpy as np

from app.errors import Argument, Message
from app.plan.by_hand.additive_curve import BODY_CHANNELS, CHANNELS, FACE, AdditiveCurve, CurveKey
from app.plan.by_hand.bezier import looked_at_s, rows, sampled_rows
from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.pose_corrections import GENTLE_RAD_S2, LEAST_FADE_S, MINIMUM_JERK_PEAK, pose_limits
from app.plan.events_by_hand import AdditiveEvent, CurveSegment, PoseTarget
from app.plan.model import Planned, Problem
from app.plan.parameters import PlayerParameters
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

Limits = tuple[float, float]

_HELD: Final[tuple[tuple[PoseTarget, tuple[str, ...]], ...]] = (
    ("bell", ("up", "left", "roll")),
    ("head", ("up", "left", "roll")),
    ("torso", ("up", "left", "roll")),
    ("left_elbow", ("up",)),
    ("right_elbow", ("up",)),
)
POSED: Final[dict[str, tuple[PoseTarget, str]]] = {
    f"{target}.{angle}": (target, f"{angle}_deg") for target, angles in _HELD for angle in angles
}
"""Channels that a pose correction can hold too, with its target and angle."""

HIPS_M: Final[dict[str, Limits]] = {
    "hips.left": (-0.09, 0.09),
    "hips.ahead": (-0.06, 0.06),
    "hips.up": (-0.1, 0.015),
}
"""Limits in metres of the hips' displacement with the feet in place; upwards only the amount by which the knees are
bent.
"""
PELVIS_DEG: Final[dict[str, Limits]] = {"hips.tilt": (-6.0, 8.0), "hips.roll": (-6.0, 6.0)}
"""Limits in degrees of the pelvis's forward tilt and left lean, also on a seat; the trunk follows."""
SHOULDERS_DEG: Final = (-5.0, 12.0)
KNEES_DEG: Final = (-6.0, 45.0)
"""Limits in degrees of an additional bend of hardly bent knees."""
EYES_DEG: Final[dict[str, Limits]] = {"eyes.up": (-30.0, 25.0), "eyes.left": (-35.0, 35.0)}

GENTLE_M_S2: Final = 8.0
"""Greatest acceleration in m/s2 with which the hips' displacement begins and ends."""
FASTEST: Final[dict[str, float]] = {"deg": math.degrees(150.0), "m": 30.0}
"""Peak accelerations above which a curve is reported, per s2: those of a fast head (`metadata`, ``head``) and of
jumping hips.
"""
STEP_S: Final = 1.0 / 60.0
"""Step in seconds for measuring accelerations: one frame."""
MOST_LOOKS: Final = 240
"""Greatest number of frames examined between two keys: four seconds, or as many points over a longer time."""
LEAST_MORPH_S: Final = 0.08
REPORTED: Final[dict[str, float]] = {"deg": 1.0, "m": 0.005, "weight": 0.02}
"""Excess over the body's limits above which a value is reported, by unit."""


def plan_additive(
    corrections: tuple[Correction, ...], instrument: InstrumentMap, parameters: PlayerParameters, clock: TempoMap
) -> Planned[AdditiveEvent]:
    """Convert the enabled additive curves among the corrections to events, ordered by start, with a problem for each
    curve that a body cannot follow.
    """
    events: list[AdditiveEvent] = []
    problems: list[Problem] = []
    body = load_body()
    for item in corrections:
        if not isinstance(item, AdditiveCurve) or not item.enabled or item.weight == 0.0:
            continue
        low, high = channel_limits(item.channel, instrument, parameters, body)
        shape = segments(item, clock)
        if not shape:
            continue
        start_s, end_s = shape[0].start_s, shape[-1].end_s
        if low == high:
            problems.append(Problem(Message("additive.not_here", {"moved": item.channel}), None, start_s, end_s))
            continue
        problems += _reported(item, shape, (low, high))
        events.append(
            AdditiveEvent(
                id=f"additive:{item.name}",
                channel=item.channel,
                start_tick=item.start_tick,
                end_tick=item.end_tick,
                start_s=start_s,
                end_s=end_s,
                segments=shape,
                low=low,
                high=high,
            )
        )
    return Planned(tuple(sorted(events, key=lambda event: (event.start_s, event.id))), tuple(problems))


def channel_limits(channel: str, instrument: InstrumentMap, parameters: PlayerParameters, body: Body) -> Limits:
    """Lowest and highest value of an animation channel, in its unit; both 0 if it cannot move in the player's
    posture."""
    if channel in POSED:
        target, angle = POSED[channel]
        return pose_limits(target, instrument, parameters, body)[angle]
    if channel.startswith(FACE):
        return -1.0, 1.0
    if channel in EYES_DEG:
        return EYES_DEG[channel]
    if channel == "shoulders.up":
        return SHOULDERS_DEG
    if instrument.endpin is not None:
        # Nothing moves over an instrument that stands on its pin.
        return 0.0, 0.0
    if channel in PELVIS_DEG:
        return PELVIS_DEG[channel]
    posture = instrument.hold.possible(parameters.posture)
    if body.postures[posture].seat_height_shank > 0.0:
        return 0.0, 0.0
    return HIPS_M.get(channel, KNEES_DEG)


def least_s(channel: str, change: float) -> float:
    """The least time in seconds in which a body can change a channel by this amount, in the channel's unit."""
    unit = CHANNELS[channel].unit
    if unit == "weight":
        return LEAST_MORPH_S
    peak = math.radians(abs(change)) / GENTLE_RAD_S2 if unit == "deg" else abs(change) / GENTLE_M_S2
    return max(LEAST_FADE_S, math.sqrt(MINIMUM_JERK_PEAK * peak))


def segments(curve: AdditiveCurve, clock: TempoMap) -> tuple[CurveSegment, ...]:
    """Convert a curve to segments in seconds, multiplied by its weight, without gaps from the start of fading in to the
    end of fading out.
    """
    keys, weight = curve.keys, curve.weight
    times_s = [clock.seconds(float(key.tick)) for key in keys]
    slopes = automatic_slopes(times_s, [key.value for key in keys])
    result: list[CurveSegment] = []
    first, last = weight * keys[0].value, weight * keys[-1].value
    blend_in_s = times_s[0] - clock.seconds(float(keys[0].tick - curve.blend_in_ticks))
    blend_in_s = max(blend_in_s, least_s(curve.channel, first))
    result.append(_eased(times_s[0] - blend_in_s, times_s[0], 0.0, first))
    for number, (key, following) in enumerate(pairwise(keys)):
        start_s, end_s = times_s[number], times_s[number + 1]
        before, after = weight * key.value, weight * following.value
        if key.interpolation == "constant":
            step_s = max(end_s - least_s(curve.channel, after - before), start_s)
            if step_s > start_s:
                result.append(_eased(start_s, step_s, before, before))
            result.append(_eased(step_s, end_s, before, after))
            continue
        third_s = (end_s - start_s) / 3.0
        if key.interpolation == "linear":
            third = (after - before) / 3.0
            leave, arrive = (third_s, third), (-third_s, -third)
        else:
            leave = handle(key, clock, third_s, slopes[number], leaves=True)
            arrive = handle(following, clock, third_s, slopes[number + 1], leaves=False)
            leave, arrive = ((seconds, weight * value) for seconds, value in (leave, arrive))
        leave, arrive = _within(leave, end_s - start_s), _within(arrive, end_s - start_s)
        result.append(
            CurveSegment(
                start_s, end_s, before, after,
                start_s + leave[0], before + leave[1], end_s + arrive[0], after + arrive[1], eased=False,
            )
        )  # fmt: skip
    blend_out_s = clock.seconds(float(keys[-1].tick + curve.blend_out_ticks)) - times_s[-1]
    blend_out_s = max(blend_out_s, least_s(curve.channel, last))
    result.append(_eased(times_s[-1], times_s[-1] + blend_out_s, last, 0.0))
    return tuple(result)


def automatic_slopes(times_s: list[float], values: list[float]) -> list[float]:
    """Slopes at keys, per second, without overshoot: 0 at the ends and at turning points, else the harmonic mean of
    both sides (Fritsch and Butland 1984).
    """
    slopes = [0.0] * len(values)
    for at in range(1, len(values) - 1):
        before_s, after_s = times_s[at] - times_s[at - 1], times_s[at + 1] - times_s[at]
        before = (values[at] - values[at - 1]) / before_s
        after = (values[at + 1] - values[at]) / after_s
        if before * after > 0.0:
            one, other = 2.0 * after_s + before_s, after_s + 2.0 * before_s
            slopes[at] = (one + other) / (one / before + other / after)
    return slopes


def handle(key: CurveKey, clock: TempoMap, third_s: float, slope: float, *, leaves: bool) -> tuple[float, float]:
    """Return a key's handle relative to the key: seconds (negative before it) and value.

    Parameters
    ----------
    third_s, slope : float
        A third of the way to the neighbour, and the slope of an automatic handle.
    """
    sign = 1 if leaves else -1
    given = key.leave if leaves else key.arrive
    if given is None:
        return sign * third_s, sign * third_s * slope
    return clock.seconds(float(key.tick + sign * given.ticks)) - clock.seconds(float(key.tick)), given.value


def _within(handle_: tuple[float, float], length_s: float) -> tuple[float, float]:
    """Shorten a curve's handle (seconds, value) to the distance between two keys at equal slope, so that no time has
    two values."""
    seconds, value = handle_
    share = min(1.0, length_s / abs(seconds)) if seconds else 1.0
    return share * seconds, share * value


def _eased(start_s: float, end_s: float, before: float, after: float) -> CurveSegment:
    return CurveSegment(start_s, end_s, before, after, start_s, before, end_s, after, eased=True)


def _reported(item: AdditiveCurve, shape: tuple[CurveSegment, ...], limits: Limits) -> list[Problem]:
    unit, found = CHANNELS[item.channel].unit, []
    start_s, end_s = shape[0].start_s, shape[-1].end_s
    table = rows(shape)
    times_s = looked_at_s(table, STEP_S, MOST_LOOKS)
    values = sampled_rows(table, times_s)
    low, high = limits
    furthest = float(values[np.abs(values).argmax()])
    held = min(max(furthest, low), high)
    if unit != "weight" and abs(furthest - held) > REPORTED[unit]:
        shown = 100.0 if unit == "m" else 1.0
        arguments: dict[str, Argument] = {
            "moved": item.channel,
            "asked": round(shown * furthest, 1),
            "most": round(shown * held, 1),
            "unit": "°" if unit == "deg" else " cm",
        }
        beyond_s = times_s[(values < low) | (values > high)]
        span_s = float(beyond_s[0]), min(float(beyond_s[-1]) + STEP_S, end_s)
        found.append(Problem(Message("additive.beyond_reach", arguments), None, *span_s))
    if item.channel in BODY_CHANNELS and not item.channel.startswith("eyes."):
        before, after = (sampled_rows(table, times_s + sign * STEP_S) for sign in (-1, 1))
        peak = float(np.abs(before - 2.0 * values + after).max()) / STEP_S**2
        if peak > FASTEST[unit]:
            found.append(Problem(Message("additive.too_fast", {"moved": item.channel}), None, start_s, end_s))
    return found
