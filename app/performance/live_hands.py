"""Fingers and slide of a live player: fingering of each note as it begins, and the motion to it.

Notes are not known in advance: a control starts at the onset and arrives as fast as a hand can move. A finger moves to
its key with it, and stays until needed elsewhere, or goes home after a while (`app.motion.fingering.finger_curves`
describes the case of known notes).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.live_values import Journey, Reach
from app.motion.fingering.control_curves import RELEASE_S, need_s, release_s
from app.motion.fingering.finger_curves import FAST_NOTE_S, HOME_S, LEAST_TRAVEL_S, NEIGHBOURS, SLOW_NOTE_S, TRAVEL_S
from app.motion.perform import PerformanceCurves
from app.plan.fingering.live_fingering import REMEMBERED, Fingered, NextFingering
from app.rig.grip.finger_stations import fingers_at_work, station_for, stations
from app.rig.grip.grip_pose import StationBlend, giving_for
from instrument_maps.model import Control, Fingering

LET_GO_S = 0.5
"""Seconds of silence for which controls stay in place, as in a rest of less than a beat."""
RAISES_S = 0.4
"""Least seconds in which the height of waiting fingers changes."""


FRAMES = 8
"""Number of computed frames for a moment: the moment itself, and others evenly spaced up to the hands' arrival."""
_ON_WAY = np.linspace(0.0, 1.0, FRAMES)


@dataclass(frozen=True)
class Hands:
    """Hands and fingers of a live player at a moment (first frame) and on the way to their goals (other frames); fields
    as in `app.motion.played_frames.PlayedFrames`."""

    controls: dict[str, FloatArray]
    placed: dict[str, StationBlend]
    raised: FloatArray
    arrived_s: float
    """Time of arrival in seconds."""


@dataclass(frozen=True)
class _Grip:
    """A fingering as control values, with other values for a held note where they differ, and the station (position at
    its key) of each working finger.
    """

    fingering: Fingering
    values: dict[str, float]
    held: dict[str, float]
    at_work: dict[str, int]


def _due_s(control: Control) -> float:
    """Seconds after an onset at which a control is corrected for a held note, or released if it only helps
    the attack.
    """
    return control.held_min_s or control.attack_s or 0.0


class LiveHands:
    """The hands and fingers of one player who plays live.

    Parameters
    ----------
    playing : PerformanceCurves
        Curves of the player, for instrument and grip; its notes are not used.
    """

    def __init__(self, curves: PerformanceCurves) -> None:
        instrument = self._instrument = curves.instrument_map
        self._choice = NextFingering(instrument)
        self._before: deque[Fingered] = deque(maxlen=REMEMBERED)
        self._grips: dict[tuple[int, int], _Grip] = {}
        self._reaches = {control.name: Reach.at_rest(control.rest_value) for control in instrument.controls}
        self._controls = {control.name: control for control in instrument.controls}
        hands = curves.player.grip.hands
        self._farthest = curves.player.farthest
        self._carrying = [hand.motion.control for hand in hands if hand.motion is not None]
        leaning = {finger for hand in hands for lean in hand.leans for finger, _ in lean.places}
        posed = {table.finger for hand in hands for table in hand.fingers}
        places = stations(instrument)
        self._places = {name: own for name, own in places.items() if len(own) > 1 and name in posed | leaning}
        self._fingers = {name: Journey() for name in self._places}
        self._givings = {name: Journey() for name in self._places if name in leaning}
        self._free_s: dict[str, float] = {}
        """Since when fingers that are away from home work nothing."""
        self._grip: _Grip | None = None
        self._onset_s = self._silent_s = math.inf
        self._corrected = False
        hovers = any(control.hover_m for control in instrument.controls)
        self._raised = Reach.at_rest(0.0) if hovers else None

    @property
    def fingering(self) -> Fingering | None:
        """Fingering used last; None before any note, and after it was released."""
        return None if self._grip is None else self._grip.fingering

    @property
    def carries(self) -> bool:
        """True if the instrument has a control that moves a hand along, such as a slide."""
        return bool(self._carrying)

    def play(self, now_s: float, pitch: int, loudness: float) -> None:
        """Begin a note; the fingers do not move for a note outside the instrument's range."""
        self.advance(now_s)
        self._silent_s = math.inf
        if not self._instrument.in_range(pitch):
            return
        column = self._choice.column(tuple(self._before), pitch, now_s, loudness)
        if self._before:
            self._end_last(now_s)
        self._before.append(Fingered(pitch, now_s, math.inf, loudness, column))
        self._raise(now_s)
        self._onset_s, self._corrected = now_s, False
        self._take(now_s, self._grip_of(pitch, column))

    def rest(self, now_s: float) -> None:
        """End the current note; the hands return to rest if no other follows soon."""
        self.advance(now_s)
        if self._before:
            self._end_last(now_s)
        self._silent_s = min(self._silent_s, now_s)

    def advance(self, now_s: float) -> None:
        """Perform all actions whose time has come: correct the tuning of a held note, release the fingering in a
        silence, return the hands to rest.
        """
        grip = self._grip
        if grip is not None and now_s >= self._silent_s + LET_GO_S:
            self._let_go(self._silent_s + LET_GO_S)
        elif grip is not None and not self._corrected and math.isinf(self._silent_s):
            held_s = now_s - self._onset_s
            due = {name: value for name, value in grip.held.items() if held_s >= _due_s(self._controls[name])}
            for name, value in due.items():
                self._move(now_s, self._controls[name], value)
            self._corrected = len(due) == len(grip.held)
        for name, free_s in list(self._free_s.items()):
            giving = self._givings.get(name)
            if giving is not None and giving.goal and now_s >= free_s + TRAVEL_S:
                giving.go(free_s + TRAVEL_S, 0, RELEASE_S)
            if now_s >= free_s + HOME_S:
                self._fingers[name].go(free_s + HOME_S, 0, TRAVEL_S)
                del self._free_s[name]

    def at(self, now_s: float) -> Hands:
        """Sample the hands at a time (first frame) and on the way to their goals (further frames)."""
        self.advance(now_s)
        controls = {}
        for name, reach in self._reaches.items():
            value = min(max(reach.at(now_s), 0.0), 1.0)
            controls[name] = value + (reach.target - value) * _ON_WAY
        placed = {name: _placed(journey, now_s) for name, journey in self._fingers.items()}
        placed |= {giving_for(name): _placed(journey, now_s) for name, journey in self._givings.items()}
        raised = 0.0 if self._raised is None else min(max(self._raised.at(now_s), 0.0), 1.0)
        arrived_s = max((reach.end_s for reach in self._reaches.values()), default=now_s)
        return Hands(controls, placed, np.full(FRAMES, raised), arrived_s)

    def carry(self, now_s: float, length_s: float) -> None:
        """Slow down the controls that move a hand along (such as a slide), so that they arrive ``length_s`` from now at
        the earliest.
        """
        for name in self._carrying if length_s > 0.0 else ():
            reach = self._reaches[name]
            if not reach.ended(now_s) and reach.end_s < now_s + length_s:
                self._reaches[name] = reach.toward(now_s, reach.target, length_s)

    def _end_last(self, now_s: float) -> None:
        last = self._before[-1]
        if math.isinf(last.end_s):
            self._before[-1] = Fingered(last.pitch, last.onset_s, now_s, last.loudness, last.column)

    def _grip_of(self, pitch: int, column: int) -> _Grip:
        grip = self._grips.get((pitch, column))
        if grip is None:
            fingering = self._choice.fingering(pitch, column)
            working = fingers_at_work(self._instrument, fingering.controls, fingering.fingers)
            grip = self._grips[pitch, column] = _Grip(
                fingering,
                self._within_reach(self._instrument.values(fingering)),
                self._within_reach(fingering.correction) | self._vents(fingering),
                {name: station_for(own, working[name]) for name, own in self._places.items() if name in working},
            )
        return grip

    def _vents(self, fingering: Fingering) -> dict[str, float]:
        """Return the controls that a fingering uses only for the attack, each with its value at rest."""
        if "attack" not in fingering.tags:
            return {}
        controls = (self._controls[name] for name in fingering.controls)
        return {control.name: control.rest_value for control in controls if control.attack_s is not None}

    def _within_reach(self, values: Mapping[str, float]) -> dict[str, float]:
        return {name: min(value, self._farthest.get(name, 1.0)) for name, value in values.items()}

    def _take(self, now_s: float, grip: _Grip) -> None:
        """Change to another fingering: start the moves of its controls, and of the fingers with their keys."""
        self._grip = grip
        goes = [name for name, station in grip.at_work.items() if self._fingers[name].goal != station]
        least_s = LEAST_TRAVEL_S if goes else 0.0
        longest_s = least_s
        for name, value in grip.values.items():
            longest_s = max(longest_s, self._move(now_s, self._controls[name], value, least_s))
        for name in self._places:
            station = grip.at_work.get(name)
            if station is None:
                if self._fingers[name].goal or (name in self._givings and self._givings[name].goal):
                    self._free_s.setdefault(name, now_s)
                continue
            self._free_s.pop(name, None)
            self._fingers[name].go(now_s, station, longest_s)
            if name in self._givings:
                self._givings[name].go(now_s, station, longest_s)

    def _move(self, now_s: float, control: Control, value: float, least_s: float = 0.0) -> float:
        """Move a control to a value; returns the seconds it takes, 0 if it is there or already moving there."""
        reach = self._reaches[control.name]
        if reach.target == value:
            return 0.0
        length_s = max(control.move_window_s, need_s(control, value - reach.at(now_s)), least_s)
        self._reaches[control.name] = reach.toward(now_s, value, length_s)
        return length_s

    def _let_go(self, now_s: float) -> None:
        """Return the controls (keys, slide) to rest at an unhurried pace, since no note is played any more."""
        self._grip = None
        for name, reach in self._reaches.items():
            control = self._controls[name]
            if reach.target != control.rest_value:
                length_s = release_s(control, reach.at(now_s))
                self._reaches[name] = reach.toward(now_s, control.rest_value, length_s)
        for name, finger in self._fingers.items():
            if finger.goal or (name in self._givings and self._givings[name].goal):
                self._free_s.setdefault(name, now_s)

    def _raise(self, now_s: float) -> None:
        """Update the height of waiting fingers: higher after faster notes."""
        if self._raised is None or len(self._before) < 2:
            return
        onsets_s = np.array([note.onset_s for note in self._before])
        steps_s = np.clip(np.diff(onsets_s)[-NEIGHBOURS:], FAST_NOTE_S, SLOW_NOTE_S)
        pace = np.log(SLOW_NOTE_S / steps_s) / np.log(SLOW_NOTE_S / FAST_NOTE_S)
        self._raised = self._raised.toward(now_s, float(np.mean(pace)), RAISES_S)


def _placed(journey: Journey, now_s: float) -> StationBlend:
    before, after, share = journey.at(now_s)
    places = np.full((3, FRAMES), float(journey.goal))
    places[2] = 1.0
    places[:, 0] = before, after, share
    return StationBlend(*places)
