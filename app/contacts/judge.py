"""Finds contacts broken by a player's motion (lips, hands, single fingers, feet), with the measures of an export."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.contacts.bounds import FEET_MM, GRIP_MM, LIPS_MM, MOVED_MM, SLIDE_M, allowed_mm, bound_mm, contact_name
from app.contacts.breaks import JUDGED_PER_S, Break, runs
from app.contacts.controls import NoteFrames
from app.contacts.missed_contacts import missed_mm
from app.contacts.touches import LIPS, TouchJudge, Traces, distance_m, hand_gaps_m, world_from_nodes
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.hand_in_bell import wrist_shift
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from app.rig.grip.lips import with_lip_landmarks
from app.rig.instrument import node_transforms
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import forward
from app.rig.skinning import landmark_joints, landmark_positions


class ContactJudge:
    """Checks motion computed from one player's curves.

    Parameters
    ----------
    curves : PerformanceCurves
        Curves from which the motion was computed.
    character : Character
        The player's character.
    model : InstrumentModel
        Model of the player's instrument.
    """

    def __init__(self, curves: PerformanceCurves, character: Character, model: InstrumentModel) -> None:
        plan, instrument = curves.plan, curves.instrument_map
        self._curves, self._model = curves, model
        self._character = with_lip_landmarks(character, instrument, curves.body)
        self._missed = missed_mm(curves.player.grip)
        self._starts_s = np.array([event.start_s for event in plan.grips])
        self._until_s = np.maximum.accumulate(np.array([event.end_s for event in plan.grips]))
        self._breaths_s = [(event.start_s, event.end_s) for event in plan.breaths]
        marks = [*(contact.part for contact in instrument.contacts), *({LIPS} & character.landmarks.keys())]
        self._marks = tuple(dict.fromkeys(marks))
        self._nodes = {contact.node: model.node_names.index(contact.node) for contact in instrument.contacts}
        skeleton = character.skeleton
        self._wrists = {hand.side: skeleton.index(f"{hand.side}Hand") for hand in curves.player.grip.hands}
        self._joints = sorted({*landmark_joints(self._character, self._marks), *self._wrists.values()})

    def breaks(self, motion: Motion) -> tuple[Break, ...]:
        """Find the contacts broken in some frames, unordered. The frames to check are fixed for the whole performance,
        so results do not depend on the span.
        """
        rate = float(motion.fps)
        step = max(1, round(rate / JUDGED_PER_S))
        before = round((motion.first_frame_s - self._curves.plan.time_frame.first_frame_s) * rate)
        frames = np.arange(-before % step, motion.frames, step)
        if not len(frames):
            return ()
        times_s = motion.first_frame_s + frames / rate
        found = list(self._feet(motion, frames, times_s))
        first = int(np.searchsorted(self._until_s, times_s[0], side="right"))
        notes = self._curves.plan.grips[first : int(np.searchsorted(self._starts_s, times_s[-1], side="right")) + 1]
        sounds = NoteFrames(times_s, notes).sounding
        if sounds.any():
            found += self._playing_contacts(motion, frames[sounds], times_s[sounds], NoteFrames(times_s[sounds], notes))
        return tuple(found)

    def _feet(self, motion: Motion, frames: IndexArray, times_s: FloatArray) -> Iterator[Break]:
        place, meant = self._curves.player.place, self._curves.footings(times_s)
        ankles = {side: limb.end for side, limb in place.legs.items()}
        joints = forward(
            self._character.skeleton, motion.rotations[frames], motion.hips_m[frames], sorted(ankles.values())
        )
        for side, ankle in ankles.items():
            # The heel, since it stays where it is however far the ankle lets the toes rise.
            poses = joints.of(ankle), (meant[side].ankle_m, meant[side].foot)
            there_m, meant_m = (ankle_m + quaternion.rotate(foot, place.heels_m[side]) for ankle_m, foot in poses)
            gaps_m = distance_m(there_m, meant_m)
            yield from runs(("foot", side, ""), times_s, gaps_m, gaps_m * 1000.0 > FEET_MM)

    def _playing_contacts(
        self, motion: Motion, frames: IndexArray, times_s: FloatArray, notes: NoteFrames
    ) -> Iterator[Break]:
        instrument = self._curves.instrument_map
        joints = forward(self._character.skeleton, motion.rotations[frames], motion.hips_m[frames], self._joints)
        morphs = {name: values[frames] for name, values in motion.morphs.items()}
        marks_m = landmark_positions(self._character, self._marks, joints, morphs)
        controls = {name: values[frames].astype(np.float64) for name, values in motion.controls.items()}
        place_m = motion.instrument_position_m[frames].astype(np.float64)
        turn = motion.instrument_rotation[frames].astype(np.float64)
        nodes_m, turns = node_transforms(self._model, instrument, controls, len(frames))
        nodes = {name: (nodes_m[:, node], turns[:, node]) for name, node in self._nodes.items()}
        marks = {name: marks_m[:, index] for index, name in enumerate(self._marks)}
        traces = Traces(marks, world_from_nodes(place_m, turn, nodes))
        lips_m = traces.lips_m(instrument)
        if lips_m is not None:
            # A catch breath shortens a note: the note still sounds in the score, but the lips have left.
            off_lips = (lips_m * 1000.0 > LIPS_MM) & ~notes.within(self._breaths_s)
            yield from runs(("lips", "", ""), times_s, lips_m, off_lips)
        placed = self._curves.placed(times_s)
        stopped, stopping = instrument.stopped, self._curves.stopping.sample(times_s)
        off: dict[str, BoolArray] = {}
        for hand in self._curves.player.grip.hands:
            wrist_m = joints.of(self._wrists[hand.side])[0]
            gaps_m = hand_gaps_m(hand, wrist_m, place_m, turn, controls, placed)
            if stopped is not None and hand.side == stopped.hand and stopping.any():
                shift = wrist_shift(self._character.skeleton, stopped, stopping, InstrumentTransform(place_m, turn))
                gaps_m = distance_m(wrist_m, shift.target(*hand_targets(hand, place_m, turn, controls, placed))[0])
            bounds_mm = [bound_mm(contact) for contact in instrument.contacts if contact.part.startswith(hand.side)]
            off[hand.side] = gaps_m * 1000.0 > MOVED_MM
            broken = gaps_m * 1000.0 > min(bounds_mm, default=GRIP_MM)
            yield from runs(("hand", hand.side, ""), times_s, gaps_m, broken)
            if hand.motion is not None and hand.motion.control in self._curves.controls:
                control = hand.motion.control
                asked = {**controls, control: self._curves.controls[control].sample(times_s)}
                asked_m, _ = hand_targets(hand, place_m, turn, asked, placed)
                gaps_m = hand_gaps_m(hand, asked_m, place_m, turn, controls, placed)
                yield from runs(("short", hand.side, control), times_s, gaps_m, gaps_m > SLIDE_M)
        judge = TouchJudge(instrument, traces, controls, notes, stopping > 0.0)
        for index, contact in enumerate(instrument.contacts):
            if contact.grip == "guide":
                continue
            gaps_m = judge.gap_m(index)
            # If the whole hand is displaced, so are its fingers.
            most_mm = allowed_mm(contact_name(contact), bound_mm(contact), self._missed)
            broken = (gaps_m * 1000.0 > most_mm) & ~off[contact.part.split(".")[0]]
            if broken.any():
                broken = broken & judge.asked(index)
                yield from runs(("touch", contact.part, contact.control or ""), times_s, gaps_m, broken)
