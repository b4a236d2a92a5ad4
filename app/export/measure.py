"""What the written files hold: contacts, controls, joints, feet and breaths, measured on what our reader reads back.

Nothing here looks at the motion the files were made from; only the plan (what should happen) and the map (where things
are) are known beside the files.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from app.export.control_judge import (
    BoolArray,
    ControlJudge,
    ControlMeasure,
    FloatArray,
    IntArray,
    control_values,
    notes_of,
)
from app.export.joint_playback import JointPlayback
from app.export.joints import anatomical_angles, angular_accelerations
from app.export.penetration import Hands
from app.export.playback import Playback, Surface
from app.export.target import TargetSkeleton, normalised_target
from app.formats.scene import Scene
from app.performance.contacts import FEET_MM, LIPS_MM, TOUCH_MM, bound_mm
from app.plan.model import BreathEvent, PlayerPlan
from app.rig.fitted_instrument import mouth_opens
from app.rig.hold import ContactFit
from app.rig.lips import meeting
from app.rig.model import Character
from app.rig.stations import MOST_HOVER_M, aside_m, only_at, stations, stations_of_notes, worked_by
from instrument_maps.model import ROOT, Contact, InstrumentMap
from metadata.model import Body, SkeletonProfile

BONES_MM = 0.01
PENETRATION_MM = 3.0
HOVER_MM = 1000.0 * MOST_HOVER_M
CLEAR_MM = 3.0
"""A finger farther than this from a hole lets it sound open; of a smaller instrument, from its smaller one."""
JAW_OPENS = 0.05
TORSO_BACK_RAD = math.radians(0.3)
"""A breath shows where the jaw opens by this weight and the torso leans back by this angle."""

_CHUNK = 256
_TORSO = ("hips", "neck")
_SOLES = ("left.foot.sole", "right.foot.sole")
_HANDS = ("left.hand", "right.hand")
_LIPS = "lips.contact"
_UPPER_LIP = "lips.upper"


class Spread(msgspec.Struct, frozen=True):
    """A distance over frames, against its bound. With no frame there is nothing to measure and nothing is wrong."""

    max_mm: float
    p99_mm: float
    bound_mm: float
    frames: int

    @property
    def kept(self) -> bool:
        """Whether the bound is kept at every frame."""
        return self.max_mm <= self.bound_mm


class JointMeasure(msgspec.Struct, frozen=True):
    """The joint that comes nearest to its bound, or goes beyond it."""

    joint: str
    value: float
    bound: float
    beyond: int
    """Frames (of any joint) beyond the bound."""


class BreathMeasure(msgspec.Struct, frozen=True):
    """Planned breaths and how many of them show."""

    planned: int
    jaw_open: int
    torso_back: int
    shown: int


class PlayerMeasures(msgspec.Struct, frozen=True):
    """Section by section what one player's files hold.

    ``hovering`` is how far fingers that work nothing are from the nearest of their keys and holes; ``guides`` how far
    parts that cannot bend are from where they would touch: reported, not judged.
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


@dataclass(frozen=True, eq=False)
class Measured:
    """Measures of one player, and the angles of its torso (F, 2), radians (sideways, forward), to compare players."""

    measures: PlayerMeasures
    torso_rad: FloatArray


@dataclass(frozen=True, eq=False)
class _Traces:
    """What the frames are asked for, over the whole file."""

    landmarks: dict[str, FloatArray]
    nodes: dict[str, FloatArray]
    torso: FloatArray
    bone_deviation_m: FloatArray
    depth_m: FloatArray


def measure_player(
    player_scene: Scene,
    instrument_scene: Scene,
    character: Character,
    instrument: InstrumentMap,
    plan: PlayerPlan,
    body: Body,
    profile: SkeletonProfile,
    first_frame_s: float,
    progress: Callable[[float], None] = lambda share: None,
    target: TargetSkeleton | None = None,
    changing: Sequence[tuple[float, float]] = (),
) -> Measured:
    """Measure what was read back of one player's two files.

    Parameters
    ----------
    player_scene, instrument_scene : Scene
        Both with a clip.
    character : Character
        For its landmarks: vertex numbers of the meshes in the file.
    instrument : InstrumentMap
    plan : PlayerPlan
        Of the whole piece; what lies outside the file's frames is not judged.
    body, profile : Body and SkeletonProfile
        Human ranges, and the axes they are about.
    first_frame_s : float
        Time of the file's first frame.
    progress : callable
        Called with the share 0..1 that is done; what it raises stops the work.
    target : TargetSkeleton, optional
        The skeleton the player's file is on; ours if absent.
    changing : sequence of (float, float)
        When the player changes instruments: a breath may be drawn then, with nothing at the lips.
    """
    if player_scene.clip is None or instrument_scene.clip is None:
        raise ValueError("a file without a clip cannot be measured")
    character = meeting(character, instrument, body)
    player = Playback(player_scene, player_scene.clip)
    held = Playback(instrument_scene, instrument_scene.clip)
    fps = player.clip.fps
    times_s = first_frame_s + np.arange(player.clip.frames) / float(fps)
    notes = notes_of(plan.grips, float(times_s[0]), float(times_s[-1]))
    sounding = _within(times_s, [(note.start_s, note.end_s) for note in notes])
    # A catch breath comes out of a note's tail: the note sounds on, but the lips have stopped.
    blowing = sounding & ~_within(times_s, [(event.start_s, event.end_s) for event in plan.breaths])
    inhaling = [(event.start_s, event.end_s) for event in plan.breaths if event.kind == "breath"]
    joints = JointPlayback(player, target or normalised_target(character.skeleton), character)
    traces = _trace(joints, held, character, instrument, sounding, progress)
    unreached = {problem.note_id for problem in plan.problems if problem.message.id == "contact.out_of_reach"}
    judge = ControlJudge(times_s, float(fps), first_frame_s, notes, unreached)
    values = control_values(instrument, held) | _hole_values(instrument, traces)
    working = stations_of_notes(instrument, ((note.controls, note.fingers) for note in notes))
    measures = PlayerMeasures(
        sounding_frames=int(sounding.sum()),
        contacts={
            contact_name(contact): _contact(index, instrument, traces, judge, values, sounding, working)
            for index, contact in enumerate(instrument.contacts)
            if contact.grip != "guide"
        },
        guides={
            contact_name(contact): _contact(index, instrument, traces, judge, values, sounding, working)
            for index, contact in enumerate(instrument.contacts)
            if contact.grip == "guide"
        },
        lips=_lips(instrument, traces, blowing),
        upper_lip_in_breaths=_lip_gap(
            instrument, traces, blowing, _within(times_s, inhaling) & ~_within(times_s, changing)
        ),
        feet={name: _drift(traces.landmarks[name]) for name in _SOLES if name in traces.landmarks},
        bones=_spread(traces.bone_deviation_m, BONES_MM),
        penetration=_spread(traces.depth_m[sounding], PENETRATION_MM),
        controls={
            control.name: judge.measure(control, values[control.name])
            for control in instrument.controls
            if control.name in values
        },
        limits=_limits(joints.rotations, joints.names, body, profile),
        acceleration=_acceleration(joints.rotations, joints.names, body, profile, float(fps)),
        breaths=_breaths(plan.breaths, times_s, joints.curve("jawOpen"), traces.torso, mouth_opens(character)),
        hovering=_hovering(instrument, traces, judge, working),
    )
    return Measured(measures, traces.torso)


def greatest_correlations(players: Mapping[str, FloatArray]) -> dict[str, float]:
    """Largest correlation of each player's curve (F,) with any other player's; 0 for a player who does not move."""
    greatest = dict.fromkeys(players, -1.0)
    for (name, curve), (other, others) in itertools.combinations(players.items(), 2):
        moves = np.ptp(curve) > 0.0 and np.ptp(others) > 0.0
        correlation = float(np.corrcoef(curve, others)[0, 1]) if moves else 0.0
        greatest[name] = max(greatest[name], correlation)
        greatest[other] = max(greatest[other], correlation)
    return greatest


def _trace(
    joints: JointPlayback,
    held: Playback,
    character: Character,
    instrument: InstrumentMap,
    sounding: BoolArray,
    progress: Callable[[float], None],
) -> _Traces:
    """One walk over all frames, a chunk at a time."""
    player = joints.playback
    frames = player.clip.frames
    requested = {contact.part for contact in instrument.contacts} | {*_SOLES, _LIPS, _UPPER_LIP}
    requested &= character.landmarks.keys()
    surfaces = {name: Surface(player, *joints.surface(character.landmarks[name])) for name in sorted(requested)}
    there = [name for name in _HANDS if name in character.landmarks]
    hands = [Hands(player, *joints.surface(character.landmarks[name]), instrument.proxy) for name in there]
    bone_of_node = {part.node: part.name for part in instrument.moving_parts} | {ROOT: held.bone_names[0]}
    node_bones = {node: held.bone_names.index(bone) for node, bone in bone_of_node.items()}
    landmarks = {name: np.empty((frames, 3)) for name in surfaces}
    nodes = {node: np.empty((frames, 4, 4)) for node in node_bones}
    torso, depth_m, deviation_m = np.empty((frames, 2)), np.zeros(frames), np.empty(frames)
    low = joints.bone(_TORSO[0])
    high = joints.bone(_TORSO[1], "head")  # VRM leaves the neck optional; the head is next above it.
    lengths_m = np.linalg.norm(player.rest_m, axis=1)
    parents = np.array(player.parents)
    for first in range(0, frames, _CHUNK):
        last = min(first + _CHUNK, frames)
        span = slice(first, last)
        world = player.world(first, last)
        for name, surface in surfaces.items():
            landmarks[name][span] = surface.positions_m(world, first, last).mean(axis=1)
        held_world = held.world(first, last)
        for node, bone in node_bones.items():
            nodes[node][span] = held_world[:, bone]
        bones_m = world[..., :3, 3]
        upright = bones_m[:, high] - bones_m[:, low]
        torso[span] = np.arctan2(upright[:, [0, 2]], upright[:, 1:2])
        found_m = np.linalg.norm(bones_m - bones_m[:, parents], axis=-1)
        deviation_m[span] = np.abs(found_m - lengths_m)[:, joints.rigid].max(axis=1)
        if sounding[span].any():
            for part in hands:
                depth_m[span] = np.maximum(
                    depth_m[span], part.depths_m(world, {name: nodes[name][span] for name in nodes}, first, last)
                )
        progress(last / frames)
    return _Traces(landmarks, nodes, torso, deviation_m, depth_m)


def _within(times_s: FloatArray, spans: Sequence[tuple[float, float]]) -> BoolArray:
    inside = np.zeros(len(times_s), dtype=np.bool_)
    for start_s, end_s in spans:
        inside[slice(*np.searchsorted(times_s, [start_s - 1e-9, end_s - 1e-9]))] = True
    return inside


def _spread(distances_m: FloatArray, bound_mm: float) -> Spread:
    if not len(distances_m):
        return Spread(0.0, 0.0, bound_mm, 0)
    distances_mm = distances_m * 1000.0
    return Spread(
        round(float(distances_mm.max()), 5),
        round(float(np.percentile(distances_mm, 99)), 5),
        bound_mm,
        len(distances_mm),
    )


def contact_name(contact: Contact | ContactFit) -> str:
    """What a measure of a contact is called."""
    return f"{contact.part} on {'+'.join((contact.control or contact.node, *contact.together))}"


def _contact(
    index: int,
    instrument: InstrumentMap,
    traces: _Traces,
    judge: ControlJudge,
    values: Mapping[str, FloatArray],
    sounding: BoolArray,
    working: Mapping[str, IntArray],
) -> Spread:
    contact = instrument.contacts[index]
    frames = sounding
    place = only_at(instrument)[index]
    if contact.control is not None:
        pressed, released = judge.working(instrument.control(contact.control), values[contact.control])
        frames = {"always": sounding, "pressed": pressed, "released": released}[contact.when]
    if place is not None:
        finger, station = place
        names = sorted({name for found in stations(instrument)[finger] for name in found.controls})
        frames = frames & judge.kept(station, working[finger], [instrument.control(name) for name in names])
        for control in map(instrument.control, worked_by(contact, instrument)):
            # Of a hole without a moving part the finger itself is the measure: it closes it where it should or fails.
            if control.motion is not None:
                frames = frames & judge.working(control, values[control.name])[0]
    gap_m = _gap_m(contact, instrument, traces, None if contact.control is None else judge)[frames]
    return _spread(gap_m, bound_mm(contact))


def _gap_m(contact: Contact, instrument: InstrumentMap, traces: _Traces, judge: ControlJudge | None) -> FloatArray:
    """How far (F,) a part of a hand is from its touch point; aside on a hole that its note half closes."""
    node = traces.nodes[contact.node]
    point_m = node[:, :3, :3] @ np.asarray(contact.position_m) + node[:, :3, 3]
    if judge is not None and contact.control is not None:
        targets = np.nan_to_num(judge.targets_at_frames(instrument.control(contact.control)), nan=1.0)
        point_m = point_m + np.einsum("fij,fj->fi", node[:, :3, :3], aside_m(contact, instrument, targets))
    gap_m: FloatArray = np.linalg.norm(traces.landmarks[contact.part] - point_m, axis=1)
    return gap_m


def _hole_values(instrument: InstrumentMap, traces: _Traces) -> dict[str, FloatArray]:
    """Value of every hole without a moving part (F,), from the fingers that may close it.

    1 or its half where a finger lies there, 0 where none is near, NaN where one is too near to let it sound open.
    """
    result = {}
    for control in instrument.controls:
        if control.motion is not None:
            continue
        touches = [contact for contact in instrument.contacts if control.name in worked_by(contact, instrument)]
        if not touches:
            # No one's finger is there: fingers that do not bend (`app.rig.fitted_instrument`).
            continue
        whole_m = np.min([_gap_m(contact, instrument, traces, None) for contact in touches], axis=0)
        values = np.where(whole_m > instrument.size * CLEAR_MM / 1000.0, 0.0, np.nan)
        if control.half_value is not None:
            half_m = np.min([_half_gap_m(contact, instrument, traces) for contact in touches], axis=0)
            values = np.where(half_m <= TOUCH_MM / 1000.0, control.half_value, values)
            whole_m = np.where(half_m < whole_m, np.inf, whole_m)
        result[control.name] = np.where(whole_m <= TOUCH_MM / 1000.0, 1.0, values)
    return result


def _half_gap_m(contact: Contact, instrument: InstrumentMap, traces: _Traces) -> FloatArray:
    node = traces.nodes[contact.node]
    half = None if contact.control is None else instrument.control(contact.control).half_value
    aside = aside_m(contact, instrument, np.full(1, half or 0.0))[0]
    point_m = node[:, :3, :3] @ (np.asarray(contact.position_m) + aside) + node[:, :3, 3]
    gap_m: FloatArray = np.linalg.norm(traces.landmarks[contact.part] - point_m, axis=1)
    return gap_m


def _hovering(
    instrument: InstrumentMap, traces: _Traces, judge: ControlJudge, working: Mapping[str, IntArray]
) -> dict[str, Spread]:
    """How far fingers that work nothing are from the nearest of the places where they do, or from the way between two
    of them."""
    found = {}
    for finger, places in stations(instrument).items():
        touches = sorted({index for place in places if place.controls for index in place.contacts})
        touches = [index for index in touches if only_at(instrument)[index] is not None]
        if not touches:
            continue
        frames = judge.asked(working[finger] < 0)
        parts = {instrument.contacts[index].part for index in touches}
        points = [_point_m(instrument.contacts[index], traces)[frames] for index in touches]
        gaps_m = [
            _to_way_m(traces.landmarks[part][frames], points[a], points[b])
            for part in sorted(parts)
            for a in range(len(points))
            for b in range(a, len(points))
        ]
        found[finger] = _spread(np.min(gaps_m, axis=0), HOVER_MM)
    return found


def _point_m(contact: Contact, traces: _Traces) -> FloatArray:
    node = traces.nodes[contact.node]
    point_m: FloatArray = node[:, :3, :3] @ np.asarray(contact.position_m) + node[:, :3, 3]
    return point_m


def _to_way_m(place_m: FloatArray, a_m: FloatArray, b_m: FloatArray) -> FloatArray:
    """Distance (F,) of a place (F, 3) from the line between two others."""
    way, off = b_m - a_m, place_m - a_m
    length2 = np.maximum(np.einsum("fi,fi->f", way, way), 1e-12)
    share = np.clip(np.einsum("fi,fi->f", off, way) / length2, 0.0, 1.0)
    gap_m: FloatArray = np.linalg.norm(off - way * share[:, None], axis=1)
    return gap_m


def _rim_to(instrument: InstrumentMap, traces: _Traces, landmark: str) -> FloatArray:
    """From the middle of the rim to a place on the lips, in the instrument's frame (F, 3)."""
    root = traces.nodes[ROOT]
    rim_m = root[:, :3, :3] @ np.asarray(instrument.mouthpiece.position_m) + root[:, :3, 3]
    offset_m: FloatArray = np.einsum("fji,fj->fi", root[:, :3, :3], traces.landmarks[landmark] - rim_m)
    return offset_m


def _lips(instrument: InstrumentMap, traces: _Traces, blowing: BoolArray) -> Spread:
    """How far the lips are from the rim; a head without a mouth has none to judge."""
    if _LIPS not in traces.landmarks:
        return _spread(np.zeros(0), LIPS_MM)
    return _spread(np.linalg.norm(_rim_to(instrument, traces, _LIPS)[blowing], axis=1), LIPS_MM)


def _lip_gap(instrument: InstrumentMap, traces: _Traces, playing: BoolArray, breathing: BoolArray) -> Spread:
    """How far the rim leaves its place on the upper lip while the mouth breathes; its place is where it lies while
    notes sound."""
    if not playing.any() or _UPPER_LIP not in traces.landmarks:
        return _spread(np.zeros(0), LIPS_MM)
    offset_m = _rim_to(instrument, traces, _UPPER_LIP)
    place_m = np.median(offset_m[playing], axis=0)
    return _spread(np.linalg.norm(offset_m[breathing] - place_m, axis=1), LIPS_MM)


def _drift(landmark_m: FloatArray) -> Spread:
    return _spread(np.linalg.norm(landmark_m - landmark_m[0], axis=1), FEET_MM)


def _limits(rotations: FloatArray, bones: Sequence[str], body: Body, profile: SkeletonProfile) -> JointMeasure:
    """The joint angle that goes furthest beyond its range, degrees (negative: inside all ranges by that much)."""
    known = {joint.name: joint.kind for joint in profile.joints}
    worst, beyond = ("", -math.inf), 0
    for index, bone in enumerate(bones):
        limits = body.limits.get(known.get(bone, ""))
        if limits is None:
            continue
        axes = profile.joint_axes(bone)
        angles = np.degrees(
            anatomical_angles(
                rotations[:, index], np.asarray(axes.flexion), np.asarray(axes.sideways), np.asarray(axes.twist)
            )
        )
        for name, angle, (low, high) in zip(
            ("flexion", "sideways", "twist"),
            angles.T,
            (limits.flexion_deg, limits.sideways_deg, limits.twist_deg),
            strict=True,
        ):
            excess = np.maximum(low - angle, angle - high)
            beyond += int((excess > 0.01).sum())
            worst = max(worst, (f"{bone} {name}", round(float(excess.max()), 4)), key=lambda item: item[1])
    return JointMeasure(worst[0], worst[1], 0.0, beyond)


def _acceleration(
    rotations: FloatArray, bones: Sequence[str], body: Body, profile: SkeletonProfile, fps: float
) -> JointMeasure:
    """The angular acceleration that comes nearest to its human bound."""
    known = {joint.name: joint.kind for joint in profile.joints}
    indices = [index for index, bone in enumerate(bones) if known.get(bone, "") in body.limits]
    bounds = np.array([body.limits[known[bones[index]]].acceleration_rad_s2 for index in indices])
    accelerations = angular_accelerations(rotations[:, indices], fps)
    if not accelerations.size:
        return JointMeasure("", 0.0, 0.0, 0)
    ratios = accelerations / bounds
    worst = int(np.argmax(ratios.max(axis=0)))
    return JointMeasure(
        bones[indices[worst]],
        round(float(accelerations[:, worst].max()), 3),
        float(bounds[worst]),
        int((ratios > 1.0).sum()),
    )


def _breaths(
    events: Sequence[BreathEvent], times_s: FloatArray, jaw: FloatArray, torso_rad: FloatArray, mouth: bool
) -> BreathMeasure:
    """Whether during each breath the jaw opens and the torso leans back against what was just before; without a
    ``mouth`` that opens, the torso alone shows it."""
    planned = opened = back = shown = 0
    for event in events:
        first, last = np.searchsorted(times_s, [event.start_s - 1e-9, event.end_s + 1e-9])
        if event.kind != "breath" or first == 0 or last >= len(times_s) or last - first < 1:
            continue
        planned += 1
        opens = bool(jaw[first:last].max() - jaw[first - 1] >= JAW_OPENS)
        leans = bool(torso_rad[first - 1, 1] - torso_rad[first : last + 1, 1].min() >= TORSO_BACK_RAD)
        opened += opens
        back += leans
        shown += leans and (opens or not mouth)
    return BreathMeasure(planned, opened, back, shown)
