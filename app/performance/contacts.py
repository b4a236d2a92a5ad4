"""Where a player's made motion breaks a contact: lips, hands, single fingers and feet, judged as an export is judged.

Messages, all problems of a player's motion: ``contact.hand_off`` (side, gap_mm): "the {side} hand comes off ...";
``contact.finger_off`` (touch, control, gap_mm): "the {touch} misses {control} ..."; ``contact.grip_off`` (touch,
gap_mm): "the {touch} does not touch ..."; ``contact.stops_short`` (control, side,
gap_mm): "{control} stops {gap_mm} mm short ..."; ``contact.lips_off`` (gap_mm): "the lips are {gap_mm} mm off ...";
``contact.foot_off`` (side, gap_mm): "the {side} foot leaves its place ...".
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.errors import Message
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.plan.model import FingeringEvent, PlayerPlan, Problem
from app.rig import quaternion
from app.rig.hold import Placed, hand_targets
from app.rig.instrument import node_transforms
from app.rig.lips import meeting
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import forward
from app.rig.skinning import landmark_joints, landmark_positions
from app.rig.stations import aside_m, only_at, stations_of_notes, worked_by
from instrument_maps.model import Contact, Control

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

TOUCH_MM = 2.0
GRIP_MM = 3.0
LIPS_MM = 2.0
FEET_MM = 1.0
PRESSED = 0.9
"""A control is where it should be within a tenth of its travel ..."""
SLIDE_M = 0.005
"""... or, where it slides, within this distance."""
MOVED_MM = 1.0
"""A hand that is farther from its place takes its fingers with it: what they miss is the hand's matter."""
LIPS = "lips.contact"
JUDGED_PER_S = 15
"""So many frames of a second are looked at: no body leaves a contact and is back sooner."""
APART_S = 0.5
"""Two breaks of one contact that are nearer than this are one."""

Kind = Literal["hand", "short", "touch", "lips", "foot"]


@dataclass(frozen=True)
class Break:
    """A contact that is not kept for a while.

    Attributes
    ----------
    kind : str
    part : str
        Side of a hand or foot; part of a hand that touches; empty for the lips.
    control : str
        What the touch works or, where it stops short, the hand carries; else empty.
    start_s, end_s : float
    gap_m : float
        The farthest.
    """

    kind: Kind
    part: str
    control: str
    start_s: float
    end_s: float
    gap_m: float

    @property
    def contact(self) -> tuple[str, str, str]:
        """Which contact it is."""
        return self.kind, self.part, self.control


def bound_mm(contact: Contact) -> float:
    """How far a contact of a map may be off."""
    touches = contact.control is not None and contact.grip == "firm"
    return TOUCH_MM if touches and not contact.part.endswith(("palm", "thumb_web")) else GRIP_MM


def in_place(control: Control, values: FloatArray, targets: FloatArray) -> BoolArray:
    """Whether values of a control are near enough to their targets."""
    off = np.abs(values - targets)
    if control.kind == "slide" and control.travel_m:
        return off * control.travel_m <= SLIDE_M
    return off <= 1.0 - PRESSED + 1e-9


class ContactJudge:
    """Judges the motion that is made from one player's curves.

    Parameters
    ----------
    playing : PerformanceCurves
    character : Character
    model : InstrumentModel
    """

    def __init__(self, playing: PerformanceCurves, character: Character, model: InstrumentModel) -> None:
        plan, instrument = playing.plan, playing.instrument_map
        self._playing, self._model = playing, model
        self._character = meeting(character, instrument, playing.body)
        self._starts_s = np.array([event.start_s for event in plan.grips])
        self._ends_s = np.array([event.end_s for event in plan.grips])
        self._breaths_s = np.array([(event.start_s, event.end_s) for event in plan.breaths]).reshape(-1, 2)
        self._touched = [
            control
            for control in instrument.controls
            if any(control.name in (contact.control, *contact.together) for contact in instrument.contacts)
        ]
        self._only_at = only_at(instrument)
        marks = [*(contact.part for contact in instrument.contacts), *({LIPS} & character.landmarks.keys())]
        self._marks = tuple(dict.fromkeys(marks))
        skeleton = character.skeleton
        self._wrists = {hand.side: skeleton.index(f"{hand.side}Hand") for hand in playing.player.hold.hands}
        self._joints = sorted({*landmark_joints(self._character, self._marks), *self._wrists.values()})
        self._legs = playing.player.place.legs

    def breaks(self, motion: Motion) -> tuple[Break, ...]:
        """The contacts that some frames do not keep, in no order."""
        step = max(1, round(motion.fps / JUDGED_PER_S))
        frames = np.arange(0, motion.frames, step)
        times_s = motion.first_frame_s + frames / float(motion.fps)
        found = list(self._feet(motion, frames, times_s))
        notes = np.searchsorted(self._starts_s, times_s + 1e-9, side="right") - 1
        sounds = notes >= 0
        sounds[sounds] = times_s[sounds] < self._ends_s[notes[sounds]] - 1e-9
        if sounds.any():
            found += self._playing_contacts(motion, frames[sounds], times_s[sounds], notes[sounds])
        return tuple(found)

    def _feet(self, motion: Motion, frames: npt.NDArray[np.intp], times_s: FloatArray) -> Iterator[Break]:
        ankles = {side: limb.end for side, limb in self._legs.items()}
        joints = forward(
            self._character.skeleton, motion.rotations[frames], motion.hips_m[frames], sorted(ankles.values())
        )
        for side, ankle in ankles.items():
            gaps_m = np.linalg.norm(joints.of(ankle)[0] - self._playing.player.place.ankles_m[side], axis=1)
            yield from _runs(("foot", side, ""), times_s, gaps_m, gaps_m * 1000.0 > FEET_MM)

    def _playing_contacts(
        self, motion: Motion, frames: npt.NDArray[np.intp], times_s: FloatArray, notes: npt.NDArray[np.intp]
    ) -> Iterator[Break]:
        instrument = self._playing.instrument_map
        joints = forward(self._character.skeleton, motion.rotations[frames], motion.hips_m[frames], self._joints)
        morphs = {name: values[frames] for name, values in motion.morphs.items()}
        marks_m = landmark_positions(self._character, self._marks, joints, morphs)
        controls = {name: values[frames].astype(np.float64) for name, values in motion.controls.items()}
        place_m = motion.instrument_position_m[frames].astype(np.float64)
        turn = motion.instrument_rotation[frames].astype(np.float64)
        rim_m = place_m + quaternion.rotate(turn, np.asarray(instrument.mouthpiece.position_m))
        if LIPS in self._marks:
            gaps_m = np.linalg.norm(marks_m[:, self._marks.index(LIPS)] - rim_m, axis=1)
            off_lips = (gaps_m * 1000.0 > LIPS_MM) & ~self._breathing(times_s)
            yield from _runs(("lips", "", ""), times_s, gaps_m, off_lips)
        placed = self._playing.placed(times_s)
        # Of the notes that are looked at: a line has thousands.
        first = int(notes.min())
        played, notes = self._playing.plan.grips[first : int(notes.max()) + 1], notes - first
        working = stations_of_notes(instrument, ((event.controls, event.fingers) for event in played))
        targets = {control.name: _targets(control, played)[notes] for control in self._touched}
        places = {finger: found[notes] for finger, found in working.items()}
        off: dict[str, BoolArray] = {}
        for hand in self._playing.player.hold.hands:
            requested_m, _ = hand_targets(hand, place_m, turn, controls, placed)
            gaps_m = np.linalg.norm(joints.of(self._wrists[hand.side])[0] - requested_m, axis=1)
            bounds_mm = [bound_mm(contact) for contact in instrument.contacts if contact.part.startswith(hand.side)]
            off[hand.side] = gaps_m * 1000.0 > MOVED_MM
            yield from _runs(
                ("hand", hand.side, ""), times_s, gaps_m, gaps_m * 1000.0 > min(bounds_mm, default=GRIP_MM)
            )
            if hand.motion is not None and hand.motion.control in self._playing.controls:
                control = hand.motion.control
                asked = {**controls, control: self._playing.controls[control].sample(times_s)}
                asked_m, _ = hand_targets(hand, place_m, turn, asked, placed)
                gaps_m = np.linalg.norm(asked_m - requested_m, axis=1)
                yield from _runs(("short", hand.side, control), times_s, gaps_m, gaps_m > SLIDE_M)
        nodes_m, node_turns = node_transforms(self._model, instrument, controls, len(frames))
        for index, contact in enumerate(instrument.contacts):
            if contact.grip == "guide":
                continue
            node = self._model.node_names.index(contact.node)
            aside = aside_m(contact, instrument, controls.get(contact.control or "", np.ones(len(frames))))
            point_m = np.asarray(contact.position_m) + aside
            point_m = nodes_m[:, node] + quaternion.rotate(node_turns[:, node], point_m)
            point_m = place_m + quaternion.rotate(turn, point_m)
            gaps_m = np.linalg.norm(marks_m[:, self._marks.index(contact.part)] - point_m, axis=1)
            # Where the whole hand has moved, its fingers have with it.
            broken = (gaps_m * 1000.0 > bound_mm(contact)) & ~off[contact.part.split(".")[0]]
            if broken.any():
                broken &= self._judged(index, controls, targets, places, placed)
                yield from _runs(("touch", contact.part, contact.control or ""), times_s, gaps_m, broken)

    def _breathing(self, times_s: FloatArray) -> BoolArray:
        """A catch breath comes out of a note's tail: the note sounds on, but the lips have stopped."""
        inside = np.zeros(len(times_s), dtype=np.bool_)
        for first, last in np.searchsorted(times_s, self._breaths_s - 1e-9).tolist():
            inside[first:last] = True
        return inside

    def _judged(
        self,
        index: int,
        controls: dict[str, FloatArray],
        targets: dict[str, FloatArray],
        places: dict[str, npt.NDArray[np.intp]],
        placed: dict[str, Placed],
    ) -> BoolArray | Literal[True]:
        """Whether a contact that is not always there should be; ``targets`` of controls and ``places`` of fingers are
        those of the frame's note."""
        instrument = self._playing.instrument_map
        contact, place = instrument.contacts[index], self._only_at[index]
        if place is not None:
            requested: BoolArray = places[place[0]] == place[1]
            for name in worked_by(contact, instrument):
                requested = requested & in_place(instrument.control(name), controls[name], targets[name])
            if place[0] in placed:
                share = placed[place[0]].share
                requested = requested & ((share <= 0.0) | (share >= 1.0))
            return requested
        if contact.control is None or contact.when == "always":
            return True
        control, target = instrument.control(contact.control), targets[contact.control]
        requested = (target == control.rest_value) == (contact.when == "released")
        return requested & in_place(control, controls[contact.control], target)


def _targets(control: Control, notes: Sequence[FingeringEvent]) -> FloatArray:
    return np.array([note.controls.get(control.name, control.rest_value) for note in notes])


def _runs(
    contact: tuple[Kind, str, str], times_s: FloatArray, gaps_m: FloatArray, broken: BoolArray
) -> Iterator[Break]:
    """The spans of broken frames."""
    if not broken.any():
        return
    indices = np.flatnonzero(broken)
    apart = np.flatnonzero(np.diff(times_s[indices]) > APART_S) + 1
    for run in np.split(indices, apart):
        yield Break(*contact, float(times_s[run[0]]), float(times_s[run[-1]]), float(gaps_m[run].max()))


def contact_problems(breaks: Iterable[Break], plan: PlayerPlan) -> tuple[Problem, ...]:
    """A problem for every while that a contact is broken, in the order of time.

    A control that stops short of a note that is out of reach is a problem of that note already
    (`app.performance.reach`): it is not reported again.
    """
    problems = []
    reported = _united(
        [
            (problem.start_s - APART_S, problem.end_s + APART_S)
            for problem in plan.problems
            if problem.message.id == "contact.out_of_reach"
        ]
    )
    starts_s = np.array([event.start_s for event in plan.grips])
    for found in joined(breaks):
        if found.kind == "short" and any(
            start_s <= found.start_s and found.end_s <= end_s for start_s, end_s in reported
        ):
            continue
        note_id = None
        if found.kind != "foot":
            index = max(int(np.searchsorted(starts_s, found.start_s + 1e-9, side="right")) - 1, 0)
            note_id = plan.grips[index].note_id
        end_s = found.end_s + 1.0 / JUDGED_PER_S
        problems.append(Problem(_message(found), note_id, found.start_s, end_s))
    return tuple(sorted(problems, key=lambda problem: problem.start_s))


def _united(spans_s: list[tuple[float, float]]) -> list[tuple[float, float]]:
    result: list[tuple[float, float]] = []
    for start_s, end_s in sorted(spans_s):
        if result and start_s <= result[-1][1]:
            result[-1] = (result[-1][0], max(result[-1][1], end_s))
        else:
            result.append((start_s, end_s))
    return result


def joined(breaks: Iterable[Break]) -> list[Break]:
    """Breaks of one contact that follow one another, as one."""
    result: list[Break] = []
    for item in sorted(breaks, key=lambda item: (*item.contact, item.start_s)):
        last = result[-1] if result else None
        if last is not None and last.contact == item.contact and item.start_s - last.end_s <= APART_S:
            end_s, gap_m = max(last.end_s, item.end_s), max(last.gap_m, item.gap_m)
            result[-1] = Break(last.kind, last.part, last.control, last.start_s, end_s, gap_m)
        else:
            result.append(item)
    return result


def _message(found: Break) -> Message:
    gap_mm = round(1000.0 * found.gap_m)
    if found.kind == "hand":
        return Message("contact.hand_off", {"side": found.part, "gap_mm": gap_mm})
    if found.kind == "short":
        return Message("contact.stops_short", {"control": found.control, "side": found.part, "gap_mm": gap_mm})
    if found.kind == "lips":
        return Message("contact.lips_off", {"gap_mm": gap_mm})
    if found.kind == "foot":
        return Message("contact.foot_off", {"side": found.part, "gap_mm": gap_mm})
    if found.control:
        return Message("contact.finger_off", {"touch": found.part, "control": found.control, "gap_mm": gap_mm})
    return Message("contact.grip_off", {"touch": found.part, "gap_mm": gap_mm})
