"""Whether controls are where the notes ask for them: at the frames of the notes, as far as they may not have left."""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from typing import TypeAlias

import msgspec
import numpy as np
import numpy.typing as npt

from app.export.playback import Playback
from app.performance.contacts import in_place
from app.plan.model import FingeringEvent
from app.rig import quaternion
from instrument_maps.model import Control, InstrumentMap

FloatArray: TypeAlias = npt.NDArray[np.float64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]
IntArray: TypeAlias = npt.NDArray[np.intp]


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


def control_values(instrument: InstrumentMap, held: Playback) -> dict[str, FloatArray]:
    """Value of every control (F,), from where its bone is in the file."""
    frames = held.clip.frames
    rotations, translations_m = held.rotations(0, frames), held.translations_m(0, frames)
    result = {}
    for control in instrument.controls:
        if control.motion is None:
            continue
        bone = held.bone_names.index(control.name)
        axis = np.asarray(control.motion.axis)
        if control.travel_m:
            moved_m = (translations_m[:, bone] - held.rest_m[bone]) @ axis
            result[control.name] = moved_m / control.travel_m
        else:
            angles = quaternion.twist_angle(rotations[:, bone], axis)
            result[control.name] = angles / (control.motion.angle_rad or math.nan)
    return result


class ControlJudge:
    """The notes of a file and when each is judged.

    Parameters
    ----------
    times_s : (F,) float64
    fps, first_frame_s : float
    notes : sequence of FingeringEvent
        Ordered by onset.
    out_of_reach : set of str
        Ids of the notes for which a hand cannot bring what it carries to its place.
    """

    def __init__(
        self,
        times_s: FloatArray,
        fps: float,
        first_frame_s: float,
        notes: Sequence[FingeringEvent],
        out_of_reach: Set[str | None] = frozenset(),
    ) -> None:
        self._times_s = times_s
        self._notes = notes
        starts = np.array([note.start_s for note in notes])
        self._ends = np.array([note.end_s for note in notes])
        self._frames = np.ceil((starts - first_frame_s) * fps).astype(np.int64)
        self._inside = (self._frames >= 0) & (self._frames < len(times_s))
        self._short = self._ends - starts < 2.0 / fps
        self._unreached = np.array([note.note_id in out_of_reach for note in notes], dtype=np.bool_)

    def targets(self, control: Control) -> FloatArray:
        """Value of a control that each note asks for."""
        return np.array([note.controls.get(control.name, control.rest_value) for note in self._notes])

    def working(self, control: Control, values: FloatArray) -> tuple[BoolArray, BoolArray]:
        """Frames of a sounding note at which a control is away from rest as its note asks, and at rest as it asks."""
        pressed = np.zeros(len(self._times_s), dtype=np.bool_)
        released = pressed.copy()
        for note, target in zip(self._notes, self.targets(control), strict=True):
            span = self._span(note.start_s, note.end_s)
            there = in_place(control, values[span], np.asarray(target))
            (released if target == control.rest_value else pressed)[span] |= there
        return pressed, released

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
            following = min(index + 1, len(self._notes) - 1)
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

    def measure(self, control: Control, values: FloatArray) -> ControlMeasure:
        """Count the notes at whose judged frame a control is in place, and the frames at which it left too early."""
        targets = self.targets(control)
        long, short = self._inside & ~self._short, self._inside & self._short
        right, stopped = np.zeros((2, len(targets)), dtype=np.bool_)
        at_onsets = values[self._frames[self._inside]]
        right[self._inside] = in_place(control, at_onsets, targets[self._inside])
        stopped[self._inside] = self._stops_short(
            control, at_onsets, targets[self._inside], self._unreached[self._inside]
        )
        held = wrong = held_stopped = 0
        most_short = 0.0
        for index in np.flatnonzero(long).tolist():
            span = self._span(self._notes[index].start_s, self._leaves_s(control, targets, index))
            there = in_place(control, values[span], targets[index])
            short_of = self._stops_short(control, values[span], targets[index], self._unreached[index])
            held += len(there)
            wrong += int((~there & ~short_of).sum())
            held_stopped += int(short_of.sum())
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

    def _stops_short(
        self, control: Control, values: FloatArray, targets: FloatArray, unreached: BoolArray
    ) -> BoolArray:
        """Where a control that carries a hand is out of its place on the near side, for a note that is out of reach."""
        if not control.finger.endswith(".hand"):
            return np.zeros(len(values), dtype=np.bool_)
        near: BoolArray = np.abs(values - control.rest_value) < np.abs(targets - control.rest_value)
        return near & unreached & ~in_place(control, values, targets)

    def _leaves_s(self, control: Control, targets: FloatArray, index: int) -> float:
        """The earliest time at which a control may leave the place of a note: its end, or shortly before.

        Where its share of the note is not enough for the way at the speed the map gives, it may take the time it
        needs: the plan flags such notes.
        """
        note = self._notes[index]
        if index + 1 == len(targets):
            return note.end_s
        needed_s = 0.0
        if control.max_speed_m_s and control.travel_m:
            needed_s = abs(targets[index + 1] - targets[index]) * control.travel_m / control.max_speed_m_s
        next_s = self._notes[index + 1].start_s
        # A note may sound on under the next one (legato); its control belongs to it until then only.
        end_s = min(note.end_s, next_s)
        allowed_s = max(next_s - end_s, control.move_note_share * (end_s - note.start_s))
        window_s = max(needed_s, min(control.move_window_s, allowed_s))
        return min(end_s, next_s - window_s)

    def _belongs(self, index: int) -> slice:
        """The frames of a note, to the next one's onset at most."""
        note = self._notes[index]
        following_s = self._notes[index + 1].start_s if index + 1 < len(self._notes) else math.inf
        return self._span(note.start_s, min(note.end_s, following_s))

    def _span(self, start_s: float, end_s: float) -> slice:
        return slice(*np.searchsorted(self._times_s, [start_s - 1e-9, end_s - 1e-9]))
