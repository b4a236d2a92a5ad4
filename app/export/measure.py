"""Measurement of exported files after reading them back: contacts, controls, joints, feet and breaths.

The generated motion is not used, only the files, the plan (intended events) and the instrument map (positions).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray
from app.contacts.bounds import (
    FEET_MM,
    HOVER_MM,
    LIPS_MM,
    PENETRATION_MM,
    Spread,
    bound_mm,
    contact_name,
    reported_least_m,
)
from app.contacts.controls import ControlMeasure, NoteFrames, notes_of
from app.contacts.touches import TouchJudge, Traces, distance_m, hole_values
from app.errors import Progress
from app.export.arm_depths import ArmDepth, arm_depth
from app.export.face_curves import DEFAULT_FACE, FaceOptions
from app.export.frame_blocks import SOLES, Walk, bone_deviation_m
from app.export.joint_measures import JointMeasure, measure_joints
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback
from app.export.target import TargetSkeleton, normalised_target
from app.export.threads import in_threads
from app.formats.scene import Scene
from app.motion.contacts.hand_in_bell import bell_closing
from app.motion.gestures.danced_feet import DancedFeet
from app.performance.cast import Performer
from app.plan.gestures.feet import Foot, foot_of, lifted_s
from app.plan.model import BreathEvent, PlayerPlan
from app.rig import quaternion
from app.rig.grip.fitting.fitted_instrument import mouth_opens
from app.rig.grip.lips import with_lip_landmarks
from instrument_maps.model import InstrumentMap
from metadata.load import load_skeleton
from metadata.model import Body

BONES_MM = 0.01
JAW_OPENS = 0.05
TORSO_BACK_RAD = math.radians(0.3)
"""Backward lean in radians of the torso that counts, with the opening of the jaw, as a visible breath."""

NOT_DANCED = DancedFeet.none()
_CHUNK = 4096
"""Number of frames read and judged at a time."""


class BreathMeasure(msgspec.Struct, frozen=True):
    """Numbers of planned breaths, and of those visible in an exported file: by the jaw that opens, by the trunk that
    leans back, and by both as required. ``jaw_open`` is None for a file without curves of the mouth, in which the trunk
    alone shows a breath.
    """

    planned: int
    jaw_open: int | None
    torso_back: int
    shown: int


class PlayerMeasures(msgspec.Struct, frozen=True):
    """Measures of one player's exported files, by subject.

    ``hovering`` is the distance of unused fingers from their nearest keys and holes. ``guides`` is the distance of
    stiff fingers from their intended contact, reported without a bound. ``arms`` is the depth of a forearm in trunk and
    clothes. ``lips_guessed`` is True for a face without a mouth that opens: `lips` is then the distance from the place
    guessed for it.
    """

    sounding_frames: int
    contacts: dict[str, Spread]
    lips: Spread
    upper_lip_in_breaths: Spread
    feet: dict[str, Spread]
    bones: Spread
    penetration: Spread
    controls: dict[str, ControlMeasure]
    limits: JointMeasure
    acceleration: JointMeasure
    breaths: BreathMeasure
    hovering: dict[str, Spread] = {}
    guides: dict[str, Spread] = {}
    arms: ArmDepth = ArmDepth()
    lips_guessed: bool = False


@dataclass(frozen=True, eq=False)
class PlayerMeasurement:
    """Measures of one player, with the torso's angles (F, 2) in radians (sideways, forward) for comparison with other
    players.
    """

    measures: PlayerMeasures
    torso_rad: FloatArray


@dataclass(frozen=True, eq=False)
class PlayerJudge:
    """Measurement of a player's files against the plan and human limits.

    Attributes
    ----------
    performer : Performer
        Player with instrument and character; the character's landmarks refer to vertices of the file's meshes.
    plan : PlayerPlan
        Plan of the whole piece; events outside the file's frames are ignored.
    target : TargetSkeleton or None
        Skeleton of the player's file; by default the normalised one.
    changing : sequence of (float, float)
        Spans in seconds of instrument changes, in which breaths may be taken without an instrument at the lips.
    out_of_reach : set of str
        Ids of the notes that cannot be reached (`app.contacts.reach`).
    danced : DancedFeet
        Foot movements of a dance while playing.
    face : FaceOptions
        Names and parts of the curves in the player's file; without the mouth's, lips are not judged.
    """

    performer: Performer
    plan: PlayerPlan
    target: TargetSkeleton | None = None
    changing: Sequence[tuple[float, float]] = ()
    out_of_reach: Set[str | None] = frozenset()
    danced: DancedFeet = field(default_factory=DancedFeet.none)
    face: FaceOptions = DEFAULT_FACE

    def measure(
        self,
        player_scene: Scene,
        instrument_scene: Scene,
        first_frame_s: float,
        progress: Progress = lambda share: None,
    ) -> PlayerMeasurement:
        """Measure a player's two files, given as the scenes that were read back.

        Parameters
        ----------
        player_scene, instrument_scene : Scene
            Scenes with a clip.
        first_frame_s : float
            Time of the files' first frame.
        progress : callable
            Called with the share done, 0..1; its exceptions stop the work.
        """
        if player_scene.clip is None or instrument_scene.clip is None:
            raise ValueError("a file without a clip cannot be measured")
        instrument, body = self.performer.instrument, self.performer.body
        character = with_lip_landmarks(self.performer.dressed, instrument, body)
        player = ScenePlayback(player_scene, player_scene.clip)
        held = ScenePlayback(instrument_scene, instrument_scene.clip)
        times_s = first_frame_s + np.arange(player.clip.frames) / float(player.clip.fps)
        notes = NoteFrames(times_s, notes_of(self.plan.grips, float(times_s[0]), float(times_s[-1])))
        joints = JointPlayback(player, self.target or normalised_target(character.skeleton), character)
        walk = Walk(joints, held, character, instrument)
        of_joints: list[tuple[JointMeasure, JointMeasure]] = []

        arms: list[ArmDepth] = []

        def judge_joints() -> None:
            arms.append(arm_depth(joints))
            of_joints.append(measure_joints(joints, body, load_skeleton(body.skeleton), float(player.clip.fps)))

        depth_m = _depths_m(walk, notes.sounding, judge_joints, progress)
        traces, opens = walk.traces, mouth_opens(character)
        jaw = joints.curve("jawOpen", self.face.names) if self._mouth else None
        ((limits, acceleration),) = of_joints
        return PlayerMeasurement(
            PlayerMeasures(
                sounding_frames=int(notes.sounding.sum()),
                bones=Spread.of(bone_deviation_m(joints), BONES_MM),
                penetration=Spread.of(depth_m, PENETRATION_MM),
                feet={
                    name: Spread.of(slid_m(sole_m, times_s, self.plan, name, body, self.danced), FEET_MM)
                    for name in SOLES
                    if (sole_m := traces.marks_m.get(name)) is not None
                },
                limits=limits,
                acceleration=acceleration,
                arms=arms[0],
                lips_guessed="lips.contact" in character.landmarks and not opens,
                breaths=_breaths(self.plan.breaths, times_s, jaw, walk.torso_rad, opens),
                **self._lips(traces, notes),
                **self._touches(traces, notes, held),
            ),
            walk.torso_rad,
        )

    @property
    def _mouth(self) -> bool:
        """True if the player's file has curves of the mouth."""
        return "mouth" in self.face.parts

    def _lips(self, traces: Traces, notes: NoteFrames) -> dict[str, Any]:
        """Measure the distances of the lips from the mouthpiece during notes, and of the upper lip during breaths;
        return fields of `PlayerMeasures` by name. Lips that the file does not move are not measured.
        """
        instrument, breaths = self.performer.instrument, self.plan.breaths
        # A catch breath shortens a note: the note still sounds in the score, but the lips have left.
        blowing = notes.sounding & ~notes.within((event.start_s, event.end_s) for event in breaths)
        inhaling = notes.within((event.start_s, event.end_s) for event in breaths if event.draws_air)
        inhaling &= ~notes.within(self.changing)
        lips_m = traces.lips_m(instrument) if self._mouth else None
        upper_lip_m = traces.upper_lip_m(instrument, blowing) if self._mouth else None
        return {
            "lips": Spread.of(np.zeros(0) if lips_m is None else lips_m[blowing], LIPS_MM),
            "upper_lip_in_breaths": Spread.of(np.zeros(0) if upper_lip_m is None else upper_lip_m[inhaling], LIPS_MM),
        }

    def _touches(self, traces: Traces, notes: NoteFrames, held: ScenePlayback) -> dict[str, Any]:
        """Measure the distances of fingers from their keys, also of fingers that hover, and the errors of keys and
        slides; return fields of `PlayerMeasures` by name.
        """
        instrument = self.performer.instrument
        values = _control_values(instrument, held) | hole_values(instrument, traces)
        closing = notes.within(map(tuple, bell_closing(self.plan.mutes, instrument.stopped).spans_s.tolist()))
        judge = TouchJudge(instrument, traces, values, notes, closing)
        touches = [
            (contact, Spread.of(judge.gap_m(index)[judge.asked(index)], bound_mm(contact)))
            for index, contact in enumerate(instrument.contacts)
        ]
        return {
            "contacts": {contact_name(contact): spread for contact, spread in touches if contact.grip != "guide"},
            "guides": {contact_name(contact): spread for contact, spread in touches if contact.grip == "guide"},
            "controls": {
                control.name: notes.measure(control, values[control.name], float(held.clip.fps), self.out_of_reach)
                for control in instrument.controls
                if control.name in values
            },
            "hovering": {finger: Spread.of(gaps_m, HOVER_MM) for finger, gaps_m in judge.hovering_m().items()},
        }


def greatest_correlations(players: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return the largest correlation of each player's curve (F,) with that of another player; 0 for a player without
    motion.
    """
    greatest = dict.fromkeys(players, -1.0)
    for (name, curve), (other, others) in itertools.combinations(players.items(), 2):
        moves = np.ptp(curve) > 0.0 and np.ptp(others) > 0.0
        correlation = float(np.corrcoef(curve, others)[0, 1]) if moves else 0.0
        greatest[name] = max(greatest[name], correlation)
        greatest[other] = max(greatest[other], correlation)
    return greatest


def _depths_m(walk: Walk, sounding: BoolArray, beside: Callable[[], None], progress: Progress) -> FloatArray:
    """Return the depth (K,) in metres of the skin in the instrument, for the K frames in which notes sound.

    Except for the deepest frames, values are lower bounds. ``beside`` is called after each chunk of frames.
    """
    frames = len(sounding)
    played = np.flatnonzero(sounding)
    depth_m = np.zeros(len(played))

    def judge(first: int) -> None:
        last = min(first + _CHUNK, frames)
        read_back = walk.read(first, last, sounding)
        own = slice(*np.searchsorted(played, [first, last]).tolist())
        at = played[own]
        if not len(at):
            return
        morphs, nodes = walk.morphs(at), walk.nodes(at)

        def least_of(found_m: FloatArray) -> float:
            np.maximum(depth_m[own], found_m, out=depth_m[own])
            return reported_least_m(depth_m)

        for hand, carriers in zip(walk.hands, read_back, strict=True):
            least_m = np.maximum(depth_m[own], reported_least_m(depth_m))
            depth_m[own] = hand.depths_m(carriers, morphs, nodes, least_m, least_of)

    tasks: list[Callable[[], None]] = [beside, *(partial(judge, first) for first in range(0, frames, _CHUNK))]
    done = itertools.count(1)
    in_threads(tasks, lambda index: progress(next(done) / len(tasks)))
    return depth_m


def slid_m(
    sole_m: FloatArray, times_s: FloatArray, plan: PlayerPlan, name: str, body: Body, danced: DancedFeet = NOT_DANCED
) -> FloatArray:
    """Return the distance in metres (K,) of a sole from the place where it was last put down, for the K frames in which
    it stands.
    """
    foot: Foot = "left" if name.startswith("left") else "right"
    steps = [event for event in plan.gestures if event.kind == "step" and foot_of(event) == foot]
    put = np.zeros(len(times_s), np.int64)
    for number, event in enumerate(steps, 1):
        put[(times_s >= event.start_s) & (times_s < event.end_s)] = number
    lifted = np.zeros(len(times_s), np.bool_)
    put += (len(steps) + 1) * danced.steps_before(foot, times_s)
    for start_s, end_s in (*lifted_s(plan.gestures, foot, body.footwork.step_s), *danced.lifted_s(foot)):
        lifted |= (times_s >= start_s) & (times_s <= end_s)
    standing_m, places = sole_m[~lifted], put[~lifted]
    _, firsts, which = np.unique(places, return_index=True, return_inverse=True)
    return distance_m(standing_m, standing_m[firsts[which]]) if len(standing_m) else np.zeros(0)


def _control_values(instrument: InstrumentMap, held: ScenePlayback) -> dict[str, FloatArray]:
    """Return the value (F,) of every moving control, from the position of its bone in the file."""
    result = {}
    for control in instrument.controls:
        if control.motion is None:
            continue
        bone = held.bone_names.index(control.name)
        axis = np.asarray(control.motion.axis)
        if control.travel_m:
            moved_m = (held.bone_translations_m(bone) - held.rest_m[bone]) @ axis
            result[control.name] = moved_m / control.travel_m
        else:
            angles = quaternion.twist_angle(held.bone_rotations(bone), axis)
            result[control.name] = angles / (control.motion.angle_rad or math.nan)
    return result


def _breaths(
    events: Sequence[BreathEvent], times_s: FloatArray, jaw: FloatArray | None, torso_rad: FloatArray, mouth: bool
) -> BreathMeasure:
    """Count the planned breaths during which the jaw opens and the torso leans back compared with just before; for a
    character without a ``mouth`` that opens, or a file without its curves (``jaw`` is None), the torso alone counts.
    """
    planned = opened = back = shown = 0
    for event in events:
        first, last = np.searchsorted(times_s, [event.start_s - 1e-9, event.end_s + 1e-9])
        if not event.draws_air or first == 0 or last >= len(times_s) or last - first < 1:
            continue
        planned += 1
        opens = jaw is not None and bool(jaw[first:last].max() - jaw[first - 1] >= JAW_OPENS)
        leans = bool(torso_rad[first - 1, 1] - torso_rad[first : last + 1, 1].min() >= TORSO_BACK_RAD)
        opened += opens
        back += leans
        shown += leans and (opens or not mouth or jaw is None)
    return BreathMeasure(planned, None if jaw is None else opened, back, shown)
