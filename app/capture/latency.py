"""Measurement of a device's latency while the user blows on every click."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, Literal, TypeAlias

import msgspec
import numpy as np

from app.capture.controller_recognition import breath_value
from metadata.model import BreathSource

EARLIEST_S: Final = -0.2
"""Notes that precede a click by more than this number of seconds belong to another click."""
LATEST_S: Final = 0.35
LEAST_HITS: Final = 7
MOST_SPREAD_S: Final = 0.035
"""Greatest standard deviation in seconds of a valid measurement."""
_ONE_HIT_S: Final = 0.15
"""Two onsets closer than this number of seconds count as one."""
_BREATH_RESTS, _BREATH_BEGINS = 4, 12
_OUTLIER: Final = 3.0
_LEAST_OUTLIER_S: Final = 0.025
_MAD_TO_DEVIATION: Final = 1.4826

Fault: TypeAlias = Literal["", "too_few", "too_uneven"]


class LatencyMeasurement(msgspec.Struct, frozen=True):
    """Measured latency of a device, with its spread.

    Attributes
    ----------
    offsets_s : tuple of float or None
        Delay of the note assigned to each click in seconds; None if there was none.
    used : tuple of bool
        Whether each note was used; outliers are not.
    latency_s : float
        Median delay of the used notes in seconds.
    spread_s : float
        Standard deviation in seconds of the used delays, estimated from the median deviation.
    fault : Fault
        Reason why the measurement is invalid; empty if it is valid.
    """

    offsets_s: tuple[float | None, ...]
    used: tuple[bool, ...]
    latency_s: float
    spread_s: float
    fault: Fault


def measured_latency(clicks_s: Sequence[float], hits_s: Sequence[float]) -> LatencyMeasurement:
    """Compute the latency from the times of clicks and of the notes played to them, both ascending on the same clock.

    Each click is assigned the note with the most typical delay; missing and double notes do no harm.
    """
    near = [[hit - click for hit in hits_s if EARLIEST_S <= hit - click <= LATEST_S] for click in clicks_s]
    every = [offset for offsets in near for offset in offsets]
    if not every:
        return LatencyMeasurement((None,) * len(near), (False,) * len(near), 0.0, 0.0, "too_few")
    middle_s = _densest(every)
    offsets = tuple(min(own, key=lambda offset: abs(offset - middle_s), default=None) for own in near)
    found = np.array([offset for offset in offsets if offset is not None])
    median_s = float(np.median(found))
    deviation_s = _MAD_TO_DEVIATION * float(np.median(np.abs(found - median_s)))
    most_s = max(_OUTLIER * deviation_s, _LEAST_OUTLIER_S)
    used = tuple(offset is not None and abs(offset - median_s) <= most_s for offset in offsets)
    kept = np.array([offset for offset, counts in zip(offsets, used, strict=True) if counts and offset is not None])
    latency_s = float(np.median(kept))
    spread_s = _MAD_TO_DEVIATION * float(np.median(np.abs(kept - latency_s)))
    fault: Fault = ""
    if len(kept) < LEAST_HITS:
        fault = "too_few"
    elif spread_s > MOST_SPREAD_S:
        fault = "too_uneven"
    return LatencyMeasurement(offsets, used, latency_s, spread_s, fault)


def _densest(offsets: Sequence[float]) -> float:
    """Return the delay with the most similar other delays, so that notes played between the clicks have no
    influence.
    """
    values = np.sort(np.array(offsets))
    around = np.searchsorted(values, values + 0.05) - np.searchsorted(values, values - 0.05)
    return float(np.median(values[around == around.max()]))


def hits(events: Iterable[tuple[float, bytes]], breath: BreathSource) -> tuple[float, ...]:
    """Times in seconds at which the user began to blow: by notes, or by breath if the device sends no notes; double
    onsets are excluded.

    Parameters
    ----------
    events : iterable of (float, bytes)
        Ascending times in seconds, and messages of one channel.
    """
    notes: list[float] = []
    breaths: list[float] = []
    rests = True
    for time_s, message in events:
        value = breath_value(message, breath)
        if message[0] >> 4 == 0x9 and message[2]:
            notes.append(time_s)
        elif value is not None and rests and value >= _BREATH_BEGINS:
            breaths.append(time_s)
            rests = False
        elif value is not None and value <= _BREATH_RESTS:
            rests = True
    found: list[float] = []
    for time_s in notes or breaths:
        if not found or time_s - found[-1] > _ONE_HIT_S:
            found.append(time_s)
    return tuple(found)


def events_on_time_line(
    events: Iterable[tuple[int, bytes]], positions: Sequence[tuple[int, float]]
) -> list[tuple[float, bytes]]:
    """Convert the times of events to the time line of playback.

    Parameters
    ----------
    events : iterable of (int, bytes)
        Times of a clock in nanoseconds, and messages.
    positions : sequence of (int, float)
        Playback position in seconds at moments of that clock, ascending; extrapolated outside of them.
    """
    if not positions:
        return []
    moments = np.array([moment for moment, _ in positions], np.float64)
    seconds = np.array([second for _, second in positions], np.float64)
    result = []
    for moment, message in events:
        at_s = float(np.interp(moment, moments, seconds))
        beyond_ns = min(moment - positions[0][0], 0) + max(moment - positions[-1][0], 0)
        result.append((at_s + beyond_ns / 1e9, message))
    return result
