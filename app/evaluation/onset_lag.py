"""Lag between the arrival of valves, keys, hole covers and slides and the sound of their notes.

Thresholds are those of ITU-R BT.1359-1 (1998) for sound and vision in broadcasting: on average viewers detect sound
that is 45 ms ahead of the picture or 125 ms behind it, and accept up to 90 and 185 ms. A positive lag means that the
action is seen after its note is heard.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import msgspec
import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.contacts.bounds import PRESSED, SLIDE_M, in_place
from app.plan.model import FingeringEvent
from instrument_maps.model import Control

DETECTED_S: Final = (-0.125, 0.045)
ACCEPTED_S: Final = (-0.185, 0.090)
_AROUND_S: Final = 0.5
"""Seconds around a note's onset within which a control's arrival is assigned to that note."""
_PHRASE_S: Final = 0.15
"""Length of a rest in seconds after which a note is not judged, since fingers are in place early."""


class LagMeasure(msgspec.Struct, frozen=True):
    """Lag of visible actions behind the sound, over the notes within phrases for which a control moves.

    Attributes
    ----------
    notes : int
        Number of judged notes. The lag of a note is that of its last control.
    missed : int
        Number of those with a control that never arrives; they are outside all thresholds and have no lag.
    median_ms, latest_ms : float or None
        Median and greatest lag in milliseconds; None if nothing arrives.
    detectable, unacceptable : float or None
        Share 0..1 of the judged notes outside the thresholds of detection and acceptance; None if there are no judged
        notes.
    """

    notes: int
    missed: int
    median_ms: float | None
    latest_ms: float | None
    detectable: float | None
    unacceptable: float | None


def measure_lag(
    fingerings: Sequence[FingeringEvent],
    controls: Sequence[Control],
    values: Mapping[str, AnyFloatArray],
    times_s: FloatArray,
) -> LagMeasure:
    """Compare visible arrivals with audible onsets.

    Parameters
    ----------
    fingerings : sequence of FingeringEvent
        Fingerings of the sounding notes, by onset.
    controls : sequence of Control
        Controls of the instrument; those without ``values`` are invisible.
    values : mapping of str to (F,)
        Value of each control in each frame.
    times_s : (F,) float64
        Time of each frame in seconds.
    """
    last_s: dict[int, float] = {}
    for control in controls:
        if control.name in values:
            for note, lag_s in _lags(fingerings, control, np.asarray(values[control.name], np.float64), times_s):
                last_s[note] = max(last_s.get(note, -np.inf), lag_s)
    lags_s = np.array(list(last_s.values()))
    arrived_s = lags_s[np.isfinite(lags_s)]
    return LagMeasure(
        notes=len(lags_s),
        missed=len(lags_s) - len(arrived_s),
        median_ms=round(1000.0 * float(np.median(arrived_s)), 1) if len(arrived_s) else None,
        latest_ms=round(1000.0 * float(arrived_s.max()), 1) if len(arrived_s) else None,
        detectable=_share_outside(lags_s, DETECTED_S),
        unacceptable=_share_outside(lags_s, ACCEPTED_S),
    )


def _lags(
    fingerings: Sequence[FingeringEvent], control: Control, values: FloatArray, times_s: FloatArray
) -> Iterator[tuple[int, float]]:
    """Yield for every judged note that moves a control: the note's index, and the time in seconds from the note's onset
    to the control's arrival; infinite if it never arrives.

    Arrivals are assigned in the order of the notes, each once, so that a late trill note is not taken for the next one.
    """
    arrivals: dict[tuple[float, float], FloatArray] = {}
    before, free_s, ended_s = control.rest_value, -np.inf, -np.inf
    for index, note in enumerate(fingerings):
        target = note.controls.get(control.name, control.rest_value)
        change, after_rest_s = (before, target), note.start_s - ended_s
        # Before a rest the fingers may leave for the next note as soon as the last one ends.
        first_s = min(note.start_s, ended_s) - _AROUND_S
        vented = note.vent is not None and control.name in note.vent.controls
        before, ended_s = control.rest_value if vented else target, note.end_s
        if bool(in_place(control, np.array([change[0]]), np.array([target]))[0]):
            continue
        if note.start_s - _AROUND_S < times_s[0] or note.start_s + _AROUND_S > times_s[-1]:
            continue
        if change not in arrivals:
            arrivals[change] = _arrivals_s(control, values, *change, times_s)
        all_s = arrivals[change]
        place = int(np.searchsorted(all_s, max(free_s, first_s), side="right"))
        found = place < len(all_s) and all_s[place] <= note.start_s + _AROUND_S
        if found:
            free_s = float(all_s[place])
        if after_rest_s <= _PHRASE_S:
            yield index, free_s - note.start_s if found else np.inf


def _arrivals_s(control: Control, values: FloatArray, before: float, target: float, times_s: FloatArray) -> FloatArray:
    """Ascending times in seconds at which a control arrives at ``target``: when it has less than a tenth of its way
    from ``before`` left, or makes contact (`app.contacts.bounds.in_place`) if that is later; interpolated between
    frames.
    """
    touches = SLIDE_M / control.travel_m if control.kind == "slide" and control.travel_m else 1.0 - PRESSED
    bound = min(touches, (1.0 - PRESSED) * abs(target - before)) + 1e-9
    off = np.abs(values - target)
    after = np.flatnonzero((off[1:] <= bound) & (off[:-1] > bound)) + 1
    # Linear interpolation between the two frames.
    share = (off[after - 1] - bound) / (off[after - 1] - off[after])
    crossed: FloatArray = times_s[after - 1] + share * (times_s[after] - times_s[after - 1])
    return crossed


def _share_outside(lags_s: FloatArray, bounds_s: tuple[float, float]) -> float | None:
    if not len(lags_s):
        return None
    # A lag equal to a bound counts as inside; times of frames are rounded.
    outside = (lags_s < bounds_s[0] - 1e-9) | (lags_s > bounds_s[1] + 1e-9)
    return round(float(np.count_nonzero(outside)) / len(lags_s), 4)
