"""Control values required by the notes at each frame, and checks that controls reach and hold them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence, Set
from functools import cached_property

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.contacts.bounds import in_place
from app.motion.fingering.control_curves import tail_of_note_s
from app.plan.model import FingeringEvent
from instrument_maps.model import Control


class ControlMeasure(msgspec.Struct, frozen=True):
    """Accuracy of a control's motion: number of notes at whose onset it is in place, and number of frames in which it
    left its place too early.

    ``stopped_short`` and ``held_stopped_short`` count the notes and frames in which the control stops before a position
    that the hand cannot reach; these count neither as right nor as wrong. ``most_short_mm`` is the largest missing
    distance.
    """

    judged: int
    right: int
    short_notes: int
    short_right: int
    held_frames: int
    held_wrong: int
    stopped_short: int = 0
    held_stopped_short: int = 0
    most_short_mm: float = 0.0


def notes_of(notes: Sequence[FingeringEvent], first_s: float, last_s: float) -> list[FingeringEvent]:
    """Notes that sound in a span of seconds, and the next one, for which a control may already leave its position."""
    later = [note for note in notes if note.end_s > first_s]
    inside = sum(note.start_s <= last_s for note in later)
    return later[: inside + 1]


class NoteFrames:
    """Assigns the frames of a motion to the notes that sound in them.

    Parameters
    ----------
    times_s : (F,) float64
        Ascending times.
    notes : sequence of FingeringEvent
        Notes ordered by onset; see `notes_of`.
    """

    def __init__(self, times_s: FloatArray, notes: Sequence[FingeringEvent]) -> None:
        self._times_s = times_s
        self.notes: Sequence[FingeringEvent] = notes
        self._targets: dict[str, FloatArray] = {}
        bounds_s = [(note.start_s, note.end_s) for note in notes]
        self._starts_s, self._ends_s = np.array(bounds_s, dtype=np.float64).reshape(-1, 2).T

    @cached_property
    def sounding(self) -> BoolArray:
        """Mask (F,) of the frames at which a note sounds."""
        return self._inside(*self._bounds(self._starts_s, self._ends_s))

    def within(self, spans_s: Iterable[tuple[float, float]]) -> BoolArray:
        """Mask (F,) of the frames inside any of the spans (start, end) in seconds."""
        starts_s, ends_s = np.array(list(spans_s), dtype=np.float64).reshape(-1, 2).T
        return self._inside(*self._bounds(starts_s, ends_s))

    def targets(self, control: Control) -> FloatArray:
        """Value (N,) of a control that each of N notes requires; its rest value for notes that do not use it."""
        known = self._targets.get(control.name)
        if known is None:
            asked = [note.controls.get(control.name, control.rest_value) for note in self.notes]
            known = self._targets[control.name] = np.array(asked)
        return known

    def working(self, control: Control, values: FloatArray) -> tuple[BoolArray, BoolArray]:
        """Masks (F,) of the frames of sounding notes in which a control is where the note requires it: away from its
        rest position, and at its rest position.
        """
        pressed, released = np.zeros((2, len(self._times_s)), dtype=np.bool_)
        frames, notes = self._frames_of_notes
        targets = self.targets(control)[notes]
        there, rests = in_place(control, values[frames], targets), targets == control.rest_value
        pressed[frames[there & ~rests]] = True
        released[frames[there & rests]] = True
        return pressed, released

    @cached_property
    def _frames_of_notes(self) -> tuple[IndexArray, IndexArray]:
        """Indices of the frames of all notes, joined (K,), and for each the index of its note (K,); notes
        may overlap.
        """
        starts, stops = self._bounds(self._starts_s, self._ends_s)
        return _indices(starts, stops), np.repeat(np.arange(len(starts)), np.maximum(stops - starts, 0))

    def asked(self, requested: Sequence[bool] | BoolArray) -> BoolArray:
        """Mask (F,) of the frames of those notes for which ``requested`` (N,) is true."""
        starts, stops = self._own
        chosen = np.asarray(requested, dtype=np.bool_)
        return self._inside(starts[chosen], stops[chosen])

    def kept(self, station: int, worked: IndexArray, controls: Sequence[Control]) -> BoolArray:
        """Mask (F,) of the frames in which a finger must stay at one of its stations (positions at keys): those of
        notes played there, until the finger may leave for the next note.

        Parameters
        ----------
        worked : (N,) int
            Station of the finger for every note.
        controls : sequence of Control
            All controls of the finger.
        """
        starts, stops = self._own
        here = np.flatnonzero(worked == station)
        following = np.minimum(here + 1, len(self.notes) - 1)
        leaves_s = np.full(len(here), math.inf)
        for control in controls:
            targets = self.targets(control)
            goes = targets[here] != targets[following]
            leaves_s[goes] = np.minimum(leaves_s[goes], self._leaves_s(control, targets)[here[goes]])
        # A control that must leave before its note begins limits all earlier notes of it as well.
        until = np.minimum.accumulate(np.searchsorted(self._times_s, leaves_s - 1e-9)[::-1])[::-1]
        return self._inside(starts[here], np.minimum(stops[here], until))

    def targets_at_frames(self, control: Control) -> FloatArray:
        """Value (F,) of a control that the sounding note requires at each frame; NaN where no note sounds."""
        result = np.full(len(self._times_s), np.nan)
        starts, stops = self._own
        result[_indices(starts, stops)] = np.repeat(self.targets(control), np.maximum(stops - starts, 0))
        return result

    def measure(
        self, control: Control, values: FloatArray, fps: float, out_of_reach: Set[str | None] = frozenset()
    ) -> ControlMeasure:
        """Count the notes with a control in place at the checked frame, and the frames at which it left too early.

        Parameters
        ----------
        control : Control
            The control to check.
        values : (F,) float64
            Value of the control at each frame.
        fps : float
            Frame rate; frames are consecutive.
        out_of_reach : set of str
            Ids of notes for which a hand cannot move the control all the way.
        """
        targets = self.targets(control)
        starts_s, ends_s = self._starts_s, self._ends_s
        unreached = np.array([note.note_id in out_of_reach for note in self.notes], dtype=np.bool_)
        frames = np.ceil((starts_s - self._times_s[0]) * fps).astype(np.int64)
        inside = (frames >= 0) & (frames < len(self._times_s))
        is_short = ends_s - starts_s < 2.0 / fps
        long, short = inside & ~is_short, inside & is_short
        right, stopped = np.zeros((2, len(targets)), dtype=np.bool_)
        at_onsets = values[frames[inside]]
        right[inside] = in_place(control, at_onsets, targets[inside])
        stopped[inside] = _stops_short(control, at_onsets, targets[inside], unreached[inside])
        held = wrong = held_stopped = 0
        most_short = 0.0
        firsts, stops = self._bounds(starts_s, self._leaves_s(control, targets))
        for index in np.flatnonzero(long).tolist():
            span = slice(firsts[index], stops[index])
            there = in_place(control, values[span], targets[index])
            held += len(there)
            wrong += len(there) - int(np.count_nonzero(there))
            if unreached[index]:
                short_of = _stops_short(control, values[span], targets[index], unreached[index])
                wrong -= int(np.count_nonzero(short_of))
                held_stopped += int(np.count_nonzero(short_of))
                most_short = max(most_short, float(np.abs(values[span] - targets[index])[short_of].max(initial=0.0)))
        return ControlMeasure(
            judged=int(long.sum()),
            right=int(right[long].sum()),
            short_notes=int(short.sum()),
            short_right=int(right[short].sum()),
            held_frames=held,
            held_wrong=wrong,
            stopped_short=int(stopped[long].sum()),
            held_stopped_short=held_stopped,
            most_short_mm=round(1000.0 * most_short * (control.travel_m or 0.0), 2),
        )

    def _leaves_s(self, control: Control, targets: FloatArray) -> FloatArray:
        """Earliest time (N,) in seconds at which a control may leave its position for each note: at the note's end, or
        shortly before.

        If its share of the note is too short for the map's speed, it may take the time it needs (the plan reports such
        notes); if the share allows an unhurried move, that may be used, and of a hurried slide a note's tail too.
        """
        starts_s, next_s = self._starts_s[:-1], self._starts_s[1:]
        needed_s, unhurried_s = np.zeros((2, len(next_s)))
        distances = targets[1:] - targets[:-1]
        distances_m = np.abs(distances) * control.travel_m
        if control.max_speed_m_s:
            needed_s = distances_m / control.max_speed_m_s
        if control.unhurried_speed_m_s:
            unhurried_s = distances_m / control.unhurried_speed_m_s
        # In legato a note may continue under the next one; its control is needed only until the next begins.
        ends_s = np.minimum(self._ends_s[:-1], next_s)
        allowed_s = np.maximum(next_s - ends_s, control.move_note_share * (ends_s - starts_s))
        window_s = np.maximum(needed_s, np.minimum(np.maximum(control.move_window_s, unhurried_s), allowed_s))
        tail_s = tail_of_note_s(control, distances, ends_s - starts_s, next_s - ends_s)
        window_s = np.maximum(window_s, tail_s)
        if control.kind == "slide":
            glides_s = np.array([note.glide_from_s or math.inf for note in self.notes[1:]])
            window_s = np.maximum(window_s, next_s - glides_s)
        return np.concatenate([np.minimum(ends_s, next_s - window_s), self._ends_s[-1:]])

    @cached_property
    def _own(self) -> tuple[IndexArray, IndexArray]:
        """First frame (N,) of each note, and the frame after its last one (N,), which is not later than the
        next onset.
        """
        following_s = np.append(self._starts_s[1:], math.inf)
        return self._bounds(self._starts_s, np.minimum(self._ends_s, following_s[: len(self.notes)]))

    def _bounds(self, starts_s: FloatArray, ends_s: FloatArray) -> tuple[IndexArray, IndexArray]:
        """For each of K spans of seconds the index of its first frame (K,), and of the frame after its last (K,)."""
        return np.searchsorted(self._times_s, starts_s - 1e-9), np.searchsorted(self._times_s, ends_s - 1e-9)

    def _inside(self, starts: IndexArray, stops: IndexArray) -> BoolArray:
        """Mask (F,) of the frames in any of the spans [start, stop) of frame indices."""
        count = len(self._times_s) + 1
        some = stops > starts
        changes = np.bincount(starts[some], minlength=count) - np.bincount(stops[some], minlength=count)
        inside: BoolArray = np.cumsum(changes[:-1]) > 0
        return inside


def _indices(starts: IndexArray, stops: IndexArray) -> IndexArray:
    """Concatenate the indices of spans: all i with ``starts[k] <= i < stops[k]``, shape (K,)."""
    lengths = np.maximum(stops - starts, 0)
    before = np.cumsum(lengths) - lengths
    indices: IndexArray = np.arange(lengths.sum()) + np.repeat(starts - before, lengths)
    return indices


def _stops_short(control: Control, values: FloatArray, targets: FloatArray, unreached: BoolArray) -> BoolArray:
    """Mask (F,) of the frames in which a control moved by a whole hand stops before its target, in frames of notes out
    of the arm's reach (``unreached``).
    """
    if not control.finger.endswith(".hand"):
        return np.zeros(len(values), dtype=np.bool_)
    near: BoolArray = np.abs(values - control.rest_value) < np.abs(targets - control.rest_value)
    return near & unreached & ~in_place(control, values, targets)
