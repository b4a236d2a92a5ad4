"""What the notes ask for, frame by frame, and whether controls are there as far as they may not have left."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence, Set
from functools import cached_property

import msgspec
import numpy as np

from app.contacts.bounds import BoolArray, FloatArray, IntArray, in_place
from app.plan.model import FingeringEvent
from instrument_maps.model import Control


class ControlMeasure(msgspec.Struct, frozen=True):
    """Whether a control is in place at the judged frames, and stays there until it may leave.

    ``stopped_short`` and ``held_stopped_short`` are those of the judged notes, and of the frames held, at which it
    stays on the near side of a place that is out of the player's reach: neither right nor wrong, and distinguished. How
    far from there at most is ``most_short_mm``.
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
    """The notes that sound in a span, and the next one: a control may leave the last note's place for its sake."""
    later = [note for note in notes if note.end_s > first_s]
    inside = sum(note.start_s <= last_s for note in later)
    return later[: inside + 1]


class NoteFrames:
    """Some frames and the notes that sound in them.

    Parameters
    ----------
    times_s : (F,) float64
        Ascending.
    notes : sequence of FingeringEvent
        Ordered by onset; see `notes_of`.
    """

    def __init__(self, times_s: FloatArray, notes: Sequence[FingeringEvent]) -> None:
        self._times_s = times_s
        self.notes: Sequence[FingeringEvent] = notes
        self._targets: dict[str, FloatArray] = {}
        self._spans: dict[tuple[float, float], slice] = {}

    @cached_property
    def sounding(self) -> BoolArray:
        """Frames (F,) at which a note sounds."""
        return self.within([(note.start_s, note.end_s) for note in self.notes])

    def within(self, spans_s: Iterable[tuple[float, float]]) -> BoolArray:
        """Frames (F,) inside any of these spans."""
        inside = np.zeros(len(self._times_s), dtype=np.bool_)
        for start_s, end_s in spans_s:
            inside[self._span(start_s, end_s)] = True
        return inside

    def targets(self, control: Control) -> FloatArray:
        """Value of a control that each note asks for."""
        known = self._targets.get(control.name)
        if known is None:
            asked = [note.controls.get(control.name, control.rest_value) for note in self.notes]
            known = self._targets[control.name] = np.array(asked)
        return known

    def working(self, control: Control, values: FloatArray) -> tuple[BoolArray, BoolArray]:
        """Frames of a sounding note at which a control is away from rest as its note asks, and at rest as it asks."""
        pressed, released = np.zeros((2, len(self._times_s)), dtype=np.bool_)
        frames, notes = self._frames_of_notes
        targets = self.targets(control)[notes]
        there, rests = in_place(control, values[frames], targets), targets == control.rest_value
        pressed[frames[there & ~rests]] = True
        released[frames[there & rests]] = True
        return pressed, released

    @cached_property
    def _frames_of_notes(self) -> tuple[IntArray, IntArray]:
        """The frames at which each note sounds, one note after another, and which note it is: one may sound on under
        the next."""
        spans = [self._span(note.start_s, note.end_s) for note in self.notes]
        frames = [np.arange(span.start, span.stop) for span in spans]
        notes = np.repeat(np.arange(len(frames)), np.array([len(own) for own in frames], dtype=np.intp))
        return np.concatenate([np.zeros(0, dtype=np.intp), *frames]), notes

    def asked(self, requested: Sequence[bool] | BoolArray) -> BoolArray:
        """Frames of the sounding notes for which ``requested`` (N,) is true."""
        frames = np.zeros(len(self._times_s), dtype=np.bool_)
        for index in np.flatnonzero(requested).tolist():
            frames[self._belongs(index)] = True
        return frames

    def kept(self, station: int, worked: IntArray, controls: Sequence[Control]) -> BoolArray:
        """Frames of the notes that a finger works at this of its stations, until it may leave for the next note.

        Parameters
        ----------
        worked : (N,) int
            Its station in every note.
        controls : sequence of Control
            All that it works anywhere.
        """
        frames = np.zeros(len(self._times_s), dtype=np.bool_)
        targets = [(control, self.targets(control)) for control in controls]
        for index in np.flatnonzero(worked == station).tolist():
            span = self._belongs(index)
            frames[span] = True
            following = min(index + 1, len(self.notes) - 1)
            leaves_s = [
                self._leaves_s(control, values, index)
                for control, values in targets
                if values[index] != values[following]
            ]
            if leaves_s:
                frames[self._span(min(leaves_s), math.inf).start : span.stop] = False
        return frames

    def targets_at_frames(self, control: Control) -> FloatArray:
        """Value of a control (F,) that the note at each frame asks for; NaN where none sounds."""
        result = np.full(len(self._times_s), np.nan)
        for index, target in enumerate(self.targets(control).tolist()):
            result[self._belongs(index)] = target
        return result

    def measure(
        self, control: Control, values: FloatArray, fps: float, out_of_reach: Set[str | None] = frozenset()
    ) -> ControlMeasure:
        """Count the notes at whose judged frame a control is in place, and the frames at which it left too early.

        Parameters
        ----------
        control : Control
        values : (F,) float64
        fps : float
            The frames are every one of this rate.
        out_of_reach : set of str
            Ids of the notes for which a hand cannot bring what it carries to its place.
        """
        targets = self.targets(control)
        starts_s, ends_s = np.array([(note.start_s, note.end_s) for note in self.notes]).reshape(-1, 2).T
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
        for index in np.flatnonzero(long).tolist():
            span = self._span(self.notes[index].start_s, self._leaves_s(control, targets, index))
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

    def _leaves_s(self, control: Control, targets: FloatArray, index: int) -> float:
        """The earliest time at which a control may leave the place of a note: its end, or shortly before.

        Where its share of the note is not enough for the way at the speed the map gives, it may take the time it
        needs: the plan flags such notes.
        """
        note = self.notes[index]
        if index + 1 == len(targets):
            return note.end_s
        needed_s = 0.0
        if control.max_speed_m_s and control.travel_m:
            needed_s = abs(targets[index + 1] - targets[index]) * control.travel_m / control.max_speed_m_s
        next_s = self.notes[index + 1].start_s
        # A note may sound on under the next one (legato); its control belongs to it until then only.
        end_s = min(note.end_s, next_s)
        allowed_s = max(next_s - end_s, control.move_note_share * (end_s - note.start_s))
        window_s = max(needed_s, min(control.move_window_s, allowed_s))
        return min(end_s, next_s - window_s)

    def _belongs(self, index: int) -> slice:
        """The frames of a note, to the next one's onset at most."""
        note = self.notes[index]
        following_s = self.notes[index + 1].start_s if index + 1 < len(self.notes) else math.inf
        return self._span(note.start_s, min(note.end_s, following_s))

    def _span(self, start_s: float, end_s: float) -> slice:
        span = self._spans.get((start_s, end_s))
        if span is None:
            found = np.searchsorted(self._times_s, [start_s - 1e-9, end_s - 1e-9])
            span = self._spans[start_s, end_s] = slice(*found.tolist())
        return span


def _stops_short(control: Control, values: FloatArray, targets: FloatArray, unreached: BoolArray) -> BoolArray:
    """Where a control that carries a hand is out of its place on the near side, for a note that is out of reach."""
    if not control.finger.endswith(".hand"):
        return np.zeros(len(values), dtype=np.bool_)
    near: BoolArray = np.abs(values - control.rest_value) < np.abs(targets - control.rest_value)
    return near & unreached & ~in_place(control, values, targets)
