"""Valves, slides, keys, triggers and rings as curves of time.

A control is in place at the onset of its note. It leaves its last place only just before the next onset; repeated
notes do not lift it; in a rest of a beat or more it returns to rest once its note has ended. How quickly each control
moves, and in how much of a note, the instrument map says.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from app.arrays import BoolArray
from app.motion.curves.curve import Curve, minimum_jerk, moves
from app.plan.model import FingeringEvent
from app.score.metre_map import FeltBeats, beat_ticks_at
from instrument_maps.model import Control

SLOWEST_FRAME_S = 1.0 / 24.0
"""A note is judged up to one frame after its onset; no move, however hurried, begins before that."""
STILL_IN_PLACE_M = 0.004
"""A slide this near its place is in its place."""
STILL_SHARE = 0.25
"""Largest such share of a way so short that it is hardly seen at all ..."""
STILL_PRESSED = 0.07
"""... and the share of other ways."""
MOST_BACK_SHARE = 0.9
"""Largest share of a short rest that goes to the way back, however short the way out."""
_PHASES = np.linspace(0.0, 0.5, 201)
LEAST_HELD_SHARE = 0.3
RELEASE_S = 0.12
"""A finger's way back to rest after a note, unhurried."""
CARRY_BACK_S = 0.25
"""A slide's way back to rest, unhurried, takes at least this long ..."""
CARRY_BACK_SHARE = 0.5
"""... and goes at this share of the speed the map gives."""


def need_s(control: Control, distance: float) -> float:
    """Least time of a move over ``distance`` (0..1 of the travel); 0 where the map gives no speed."""
    if control.max_speed_m_s is None or not control.travel_m:
        return 0.0
    return abs(distance) * control.travel_m / control.max_speed_m_s


def window_s(control: Control, distance: float, duration_s: float, gap_s: float) -> float:
    """Return how long before an onset a control may leave its place.

    Where the share of the note is too short for a human speed (the plan flags such notes) the control starts
    earlier, but leaves the note its first frame at 24 frames/s.

    Parameters
    ----------
    distance : float
        How far it goes, 0..1 of its travel.
    duration_s, gap_s : float
        Sounding length of the note before, and the rest between that note and the onset.
    """
    need = need_s(control, distance)
    allowed = max(gap_s, control.move_note_share * duration_s)
    if need <= allowed:
        return min(max(control.move_window_s, need), allowed)
    return min(need, max(allowed, duration_s + gap_s - SLOWEST_FRAME_S))


def unseen_s(control: Control, distance: float, window: float) -> float:
    """Return how much earlier than its window a control may begin to move, because when the window opens it is still in
    place.

    What looks like standing still is where finger or hand gathers speed, so that it need not jerk.
    """
    share = STILL_PRESSED
    if control.kind == "slide" and control.travel_m:
        share = min(STILL_IN_PLACE_M / (abs(distance) * control.travel_m), STILL_SHARE)
    phase = _phase(share)
    return window * phase / (1.0 - phase)


@lru_cache(maxsize=4096)
@lru_cache(maxsize=4096)
def _phase(share: float) -> float:
    """Time, as a share of a minimum-jerk move, at which it has come so far."""
    return float(np.interp(share, minimum_jerk(_PHASES), _PHASES))


def control_curves(
    fingerings: Sequence[FingeringEvent],
    controls: Iterable[Control],
    felt_beats: FeltBeats,
    farthest: Mapping[str, float] = MappingProxyType({}),
) -> dict[str, Curve]:
    """Curves 0..1 of all controls of an instrument, by name; some go no farther than ``farthest`` (values by name).

    Fingerings are in order, each from its note's onset to its end; a control they do not name is at rest.
    """
    starts = np.array([event.start_tick for event in fingerings], np.int64)
    ends = np.array([event.end_tick for event in fingerings], np.int64)
    rests = np.zeros(len(starts), dtype=np.bool_)
    rests[1:] = starts[1:] - ends[:-1] >= beat_ticks_at(felt_beats, starts[1:])
    return {control.name: _curve(fingerings, control, rests, farthest.get(control.name, 1.0)) for control in controls}


def _curve(fingerings: Sequence[FingeringEvent], control: Control, rests: BoolArray, farthest: float) -> Curve:
    """One control's; ``rests`` (N,) says which notes a rest precedes that brings controls back to rest."""
    if not fingerings:
        return moves((), control.rest_value)
    name, rest = control.name, control.rest_value
    targets = np.minimum([event.controls.get(name, rest) for event in fingerings], farthest)
    # Nothing happens where a control stays where it is: most keys do, in most notes.
    stays = (targets[1:] == targets[:-1]) & (~rests[1:] | (targets[1:] == rest))
    first = fingerings[0]
    value = float(targets[0])
    segments = [(first.start_s - _free_window_s(control, value - rest), first.start_s, value)]
    for index in (np.flatnonzero(~stays) + 1).tolist():
        last, event = fingerings[index - 1], fingerings[index]
        value, target = float(targets[index - 1]), float(targets[index])
        if rests[index]:
            segments += _through_rest(control, last.end_s, event.start_s, value, target)
        else:
            end_s = min(last.end_s, event.start_s)
            window = window_s(control, target - value, end_s - last.start_s, event.start_s - end_s)
            start_s = event.start_s - window - unseen_s(control, target - value, window)
            # However hurried, the note before has its first frame, and most of its first half.
            earliest_s = last.start_s + max(SLOWEST_FRAME_S, LEAST_HELD_SHARE * (event.start_s - last.start_s))
            start_s = min(max(start_s, earliest_s), event.start_s - window)
            if control.kind == "slide" and event.glide_from_s is not None:
                start_s = min(start_s, event.glide_from_s)
            segments.append((start_s, event.start_s, target))
    last_s = fingerings[-1].end_s
    segments.append((last_s, last_s + release_s(control, float(targets[-1])), rest))
    return moves(segments, rest)


def _free_window_s(control: Control, distance: float) -> float:
    window = max(control.move_window_s, need_s(control, distance))
    return window + unseen_s(control, distance, window) if distance else window


def release_s(control: Control, value: float) -> float:
    """Unhurried time of the way back to rest."""
    need = need_s(control, value - control.rest_value)
    return max(CARRY_BACK_S, need / CARRY_BACK_SHARE) if need > 0.0 else RELEASE_S


def _through_rest(
    control: Control, end_s: float, onset_s: float, value: float, target: float
) -> list[tuple[float, float, float]]:
    """Back to rest once the note has ended, and out again just before the next onset."""
    rest = control.rest_value
    gap_s = onset_s - end_s
    back, out = abs(value - rest), abs(target - rest)
    back_s = release_s(control, value) if back else 0.0
    out_s = _free_window_s(control, out) if out else 0.0
    if back_s + out_s > gap_s:  # a fast beat: hurry both ways, each by its share of the distance
        back_s = max(gap_s - out_s, gap_s * back / (back + out))
        back_s = min(back_s, MOST_BACK_SHARE * gap_s) if out else gap_s
    back_end_s = min(end_s + back_s, onset_s)
    return [(end_s, back_end_s, rest), (max(onset_s - out_s, back_end_s), onset_s, target)]
