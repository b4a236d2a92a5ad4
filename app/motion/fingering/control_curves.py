"""Curves of an instrument's controls over time: valves, slides, keys, triggers and rings.

A control is in place at its note's onset. It leaves the previous place only just before the next onset; repeated notes
do not lift it; in a rest of a beat or more it returns to rest after the note. The instrument map gives the speed of
each control and the share of a note it may use.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.motion.curves.curve import Curve, minimum_jerk, moves, moves_to
from app.plan.model import FingeringEvent
from app.score.metre_map import FeltBeats, beat_ticks_at
from instrument_maps.model import Control

SLOWEST_FRAME_S = 1.0 / 24.0
"""Longest frame in seconds: notes are judged up to one frame after the onset, and no move begins earlier than that
allows.
"""
STILL_IN_PLACE_M = 0.004
"""Distance in metres within which a slide counts as in place."""
STILL_SHARE = 0.25
"""Greatest remaining share of a short, hardly visible move that counts as in place."""
STILL_PRESSED = 0.07
"""Same share for other moves."""
MOST_BACK_SHARE = 0.9
"""Greatest share of a short rest for the way back, since the way out needs time too."""
_PHASES: Final = np.linspace(0.0, 0.5, 201)
_PROGRESS: Final = minimum_jerk(_PHASES)
_PRESSED_PHASE: Final = float(np.interp(STILL_PRESSED, _PROGRESS, _PHASES))
"""Share of the time of a minimum-jerk move at which a key's motion becomes visible."""
LEAST_HELD_SHARE = 0.25
"""Share of a note, from its onset to the next one's, in which no control leaves its place."""
TAIL_SHARE = 0.65
"""Greatest share of a sounding note that a slide move may take if its own share would require too high a speed. The ear
determines pitch at the beginning of a note, and the next attack covers its end: with the first third in place (to
`STILL_IN_PLACE_M`, 0.04 semitones) a note is in tune. Longer notes lose less: see `TAIL_PEAK_M_S`.
"""
TAIL_PEAK_M_S = 2.05
"""Peak speed in m/s of a slide that takes more than its own share of a note, if the note is long enough. Measured on
six pieces, the hand's speed is 0.84 to 0.87 of it, since the instrument moves too: below 1.8 m/s.
"""
PEAK_TO_MEAN = 15.0 / 8.0
"""Peak speed of a minimum-jerk move as a multiple of its mean speed."""
RELEASE_S = 0.12
"""Seconds in which a finger returns to its place after a note."""
CARRY_BACK_S = 0.25
"""Least seconds in which a slide returns to its place; see `CARRY_BACK_SHARE`."""
CARRY_BACK_SHARE = 0.5
"""Speed of a slide's return, as a share of the speed in the instrument's map."""


def need_s(control: Control, distance: float) -> float:
    """Least time in seconds of a control's move over ``distance`` (share 0..1 of its travel); 0 if the map gives no
    speed.
    """
    if control.max_speed_m_s is None or not control.travel_m:
        return 0.0
    return abs(distance) * control.travel_m / control.max_speed_m_s


def _unhurried_s(control: Control, distances: FloatArray) -> FloatArray:
    """Times (M,) in seconds of unhurried moves over ``distances`` (M,); 0 if the map gives no unhurried speed."""
    if control.unhurried_speed_m_s is None:
        return np.zeros(len(distances))
    return np.abs(distances) * control.travel_m / control.unhurried_speed_m_s


def window_s(control: Control, distances: FloatArray, durations_s: FloatArray, gaps_s: FloatArray) -> FloatArray:
    """Time (M,) in seconds before each of M onsets at which a control may leave its previous position.

    A move that fits into its share of the note is unhurried. If the share is too short for that, a slide takes some of
    the note's tail too (`TAIL_SHARE`). If it is too short for a human speed (the plan reports such notes), the control
    starts earlier, but not before the note's first frame at 24 frames/s.

    Parameters
    ----------
    distances : (M,) float
        Distances, 0..1 of the control's travel.
    durations_s, gaps_s : (M,) float
        Sounding lengths of the previous notes, and rests between them and the onsets.
    """
    needs = np.zeros(len(distances))
    if control.max_speed_m_s is not None and control.travel_m:
        needs = np.abs(distances) * control.travel_m / control.max_speed_m_s
    seen = 1.0 - _unseen_phase(control, distances)
    usual = np.maximum(needs, _unhurried_s(control, distances) * seen)
    share = np.maximum(gaps_s, control.move_note_share * durations_s)
    unhurried = np.minimum(np.maximum(control.move_window_s, usual), share)
    tail_s = tail_of_note_s(control, distances, durations_s, gaps_s)
    unhurried = np.maximum(unhurried, tail_s)
    allowed = np.maximum(share, tail_s)
    hurried = np.minimum(needs, np.maximum(allowed, durations_s + gaps_s - SLOWEST_FRAME_S))
    return np.where(needs <= allowed, unhurried, hurried)


def tail_of_note_s(control: Control, distances: FloatArray, durations_s: FloatArray, gaps_s: FloatArray) -> FloatArray:
    """Time (M,) in seconds before each onset that a slide's move may take from the previous note in addition to the
    slide's usual share of it.

    They are 0 for controls without an unhurried speed. Parameters are those of `window_s`.
    """
    if control.kind != "slide" or control.unhurried_speed_m_s is None:
        return np.zeros(len(distances))
    calm_s = np.abs(distances) * control.travel_m * PEAK_TO_MEAN / TAIL_PEAK_M_S
    return np.minimum(calm_s * (1.0 - _unseen_phase(control, distances)), gaps_s + TAIL_SHARE * durations_s)


def _unseen_phase(control: Control, distances: FloatArray) -> FloatArray:
    """Share (M,) of the time of moves over ``distances`` (M,), from their start, in which the move is still too small
    to see.

    Finger or hand accelerate in this time, so that the motion is not jerky.
    """
    if control.kind != "slide" or not control.travel_m:
        return np.full(len(distances), _PRESSED_PHASE)
    share = STILL_IN_PLACE_M / np.maximum(np.abs(distances) * control.travel_m, STILL_IN_PLACE_M / STILL_SHARE)
    return np.interp(share, _PROGRESS, _PHASES)


def _unseen_s(control: Control, distances: FloatArray, windows_s: FloatArray) -> FloatArray:
    """Time (M,) in seconds by which a control may start moving before ``windows_s``, because the beginning of the move
    is too small to see.
    """
    phase = _unseen_phase(control, distances)
    return windows_s * phase / (1.0 - phase)


def control_curves(
    fingerings: Sequence[FingeringEvent],
    controls: Iterable[Control],
    felt_beats: FeltBeats,
    farthest: Mapping[str, float] = MappingProxyType({}),
) -> dict[str, Curve]:
    """Compute the curves 0..1 of all controls of an instrument by name; values are limited to ``farthest`` (by name).

    Fingerings are in order, each from onset to end of its note; controls they do not name are at rest.
    """
    notes = _Notes.of(fingerings, felt_beats)
    return {control.name: _curve(notes, control, farthest.get(control.name, 1.0)) for control in controls}


@dataclass(frozen=True, eq=False)
class _Notes:
    """Fingerings as arrays.

    Attributes
    ----------
    fingerings : sequence of FingeringEvent
        The fingerings in order.
    kinds : (N,) int
        Index in ``places`` for each note.
    places : list of mapping of str to float
        Distinct combinations of control values.
    start_s, end_s : (N,) float
        Start and end of each note in seconds.
    rests : (N,) bool
        True if the rest before the note is long enough for controls to return to rest.
    """

    fingerings: Sequence[FingeringEvent]
    kinds: IndexArray
    places: list[Mapping[str, float]]
    start_s: FloatArray
    end_s: FloatArray
    rests: BoolArray

    @classmethod
    def of(cls, fingerings: Sequence[FingeringEvent], felt_beats: FeltBeats) -> _Notes:
        starts = np.array([event.start_tick for event in fingerings], np.int64)
        ends = np.array([event.end_tick for event in fingerings], np.int64)
        rests = np.zeros(len(starts), dtype=np.bool_)
        rests[1:] = starts[1:] - ends[:-1] >= beat_ticks_at(felt_beats, starts[1:])
        # Notes with the same fingering object share its values; equal objects are not searched for.
        different = {id(event.controls): event.controls for event in fingerings}
        numbers = {identity: number for number, identity in enumerate(different)}
        return cls(
            fingerings,
            np.array([numbers[id(event.controls)] for event in fingerings], np.intp),
            list(different.values()),
            np.array([event.start_s for event in fingerings], np.float64),
            np.array([event.end_s for event in fingerings], np.float64),
            rests,
        )


def _curve(notes: _Notes, control: Control, farthest: float) -> Curve:
    """Return the curve of one control (key, slide, valve) over all notes; values are limited to ``farthest``."""
    if not notes.fingerings:
        return moves((), control.rest_value)
    name, rest = control.name, control.rest_value
    targets = np.minimum([place.get(name, rest) for place in notes.places], farthest)[notes.kinds]
    # Most controls do not move at most notes.
    stays = (targets[1:] == targets[:-1]) & (~notes.rests[1:] | (targets[1:] == rest))
    changes = np.flatnonzero(~stays) + 1
    through = notes.rests[changes]
    first_s, last_s, value = float(notes.start_s[0]), float(notes.end_s[-1]), float(targets[0])
    rows = [
        np.array([(first_s - _free_window_s(control, value - rest), first_s, value)]),
        _at_once(notes, control, targets, changes[~through]),
        *(
            np.array(
                _through_rest(
                    control,
                    float(notes.end_s[index - 1]),
                    float(notes.start_s[index]),
                    float(targets[index - 1]),
                    float(targets[index]),
                )
            )
            for index in changes[through].tolist()
        ),
        np.array([(last_s, last_s + release_s(control, float(targets[-1])), rest)]),
    ]
    order = np.concatenate(([0], changes[~through], np.repeat(changes[through], 2), [len(targets)]))
    table = np.concatenate(rows)[np.argsort(order, kind="stable")]
    return moves_to(table[:, 0], table[:, 1], table[:, 2], rest)


def _at_once(notes: _Notes, control: Control, targets: FloatArray, changes: IndexArray) -> FloatArray:
    """Return the moves of a control between notes without a rest, as rows (M, 3) of start and end in seconds and value;
    ``changes`` are the indices of the M notes to which it moves.
    """
    before_s, onset_s = notes.start_s[changes - 1], notes.start_s[changes]
    end_s = np.minimum(notes.end_s[changes - 1], onset_s)
    distances = targets[changes] - targets[changes - 1]
    windows_s = window_s(control, distances, end_s - before_s, onset_s - end_s)
    start_s = onset_s - windows_s - _unseen_s(control, distances, windows_s)
    # However hurried, the previous note keeps its first frame and most of its first half.
    earliest_s = before_s + np.maximum(SLOWEST_FRAME_S, LEAST_HELD_SHARE * (onset_s - before_s))
    start_s = np.minimum(np.maximum(start_s, earliest_s), onset_s - windows_s)
    if control.kind == "slide":
        glides = [notes.fingerings[index].glide_from_s for index in changes.tolist()]
        start_s = np.minimum(start_s, [np.inf if glide_s is None else glide_s for glide_s in glides])
    return np.stack((start_s, onset_s, targets[changes]), axis=1)


def _free_window_s(control: Control, distance: float) -> float:
    """Time in seconds that a move over ``distance`` takes if no note before it limits its start."""
    distances = np.array([distance])
    windows_s = window_s(control, distances, np.array([0.0]), np.array([np.inf]))
    return float(windows_s[0] + (_unseen_s(control, distances, windows_s)[0] if distance else 0.0))


def release_s(control: Control, value: float) -> float:
    """Time in seconds of an unhurried return of a control from ``value`` to its rest position."""
    distance = value - control.rest_value
    need = need_s(control, distance)
    unhurried = float(_unhurried_s(control, np.array([distance]))[0])
    return max(CARRY_BACK_S, need / CARRY_BACK_SHARE, unhurried) if need > 0.0 else RELEASE_S


def _through_rest(
    control: Control, end_s: float, onset_s: float, value: float, target: float
) -> list[tuple[float, float, float]]:
    """Moves of a control in a rest, as (start, end, value): back to its rest position after the note, and out again
    just before the next onset.

    If both moves would be hurried, a control with an unhurried speed stays out and moves directly to the next value.
    """
    rest = control.rest_value
    gap_s = onset_s - end_s
    back, out = abs(value - rest), abs(target - rest)
    back_s = release_s(control, value) if back else 0.0
    out_s = _free_window_s(control, out) if out else 0.0
    if back_s + out_s > gap_s and back and out and control.unhurried_speed_m_s is not None:
        straight_s = min(_free_window_s(control, target - value), gap_s)
        return [(end_s, onset_s - straight_s, value), (onset_s - straight_s, onset_s, target)]
    if back_s + out_s > gap_s:  # a fast beat: both moves are shortened in proportion to their distances
        back_s = max(gap_s - out_s, gap_s * back / (back + out))
        back_s = min(back_s, MOST_BACK_SHARE * gap_s) if out else gap_s
    back_end_s = min(end_s + back_s, onset_s)
    return [(end_s, back_end_s, rest), (max(onset_s - out_s, back_end_s), onset_s, target)]
