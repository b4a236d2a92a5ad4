"""When gestures of tables may be done, and with which instruments.

Messages: ``gesture.hand_holds`` (name), ``gesture.no_water_key`` (name).
"""

from __future__ import annotations

import numpy as np

from app.errors import Message
from app.plan.line import LineTimes
from app.plan.lowered import LOWER_S, RAISE_S
from instrument_maps.model import InstrumentMap
from metadata.gestures import Gesture


def may_start(
    gesture: Gesture, start_s: float, end_s: float, times: LineTimes, lowered: tuple[tuple[float, float], ...]
) -> bool:
    """Whether a gesture may be done from one time to another."""
    if gesture.may_start == "resting":
        first = int(np.searchsorted(times.played_end_s, start_s, side="right"))
        return first == len(times.onset_s) or float(times.onset_s[first]) >= end_s
    if gesture.may_start == "lowered":
        down_s, up_s = (LOWER_S, RAISE_S) if gesture.needs_lowered else (0.0, 0.0)
        return any(first_s + down_s <= start_s and end_s <= last_s - up_s for first_s, last_s in lowered)
    return True


def comes_up(start_s: float, end_s: float, lowered: tuple[tuple[float, float], ...]) -> bool:
    """Whether the instrument that is down at one time is on its way up before another."""
    return any(first_s <= start_s < last_s < end_s + RAISE_S for first_s, last_s in lowered)


def impossible(gesture: Gesture, instrument: InstrumentMap) -> Message | None:
    """Why no hand can do it with this instrument."""
    track, water = gesture.hand, instrument.water
    if track is None:
        return None
    free = instrument.hold.leaving_hand
    if free is None or track.which not in ("free", free):
        return Message("gesture.hand_holds", {"name": gesture.name})
    if any(key.place == "key" for key in track.keys) and (water is None or water.position_m is None):
        return Message("gesture.no_water_key", {"name": gesture.name})
    return None


def belongs(gesture: Gesture, instrument: InstrumentMap) -> bool:
    """Whether rules place a gesture for who plays an instrument: it can be done, and water is let out as its map
    says."""
    if gesture.lets_out_water and (instrument.water is None or instrument.water.gesture != gesture.name):
        return False
    return impossible(gesture, instrument) is None
