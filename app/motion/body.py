"""Layers of body motion: sway, weight, knees, breath, cue, bell, gaze and the residue of a body asked to keep still.

Every layer is a function of time in anatomical angles. Layers are added, so each can be left out and none knows the
others; contacts are solved afterwards and are never broken by them. Sizes come from `metadata` at the player's
amplitude.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from itertools import zip_longest
from typing import Any, Literal

import numpy as np

from app.motion.curve import Curve, FloatArray, Noise, bump, moves, rows_changed_s, through
from app.motion.gaze import Look
from app.motion.gestured import Gestured, Sums, with_gestures
from app.motion.pose import Offset, Poses, hold_body
from app.motion.seed import generator
from app.plan.model import BreathEvent, CueEvent, GestureEvent, PlayerPlan, PoseTarget, same_events
from app.plan.parameters import PlayerParameters
from app.plan.pose import BELL_LEFT, BELL_UP, NECK_SHARES, TRUNK_SHARES
from app.score.metre_map import FeltBeats, beat_ticks_at
from metadata.model import AmplitudeScale, Body, Posture, at_amplitude

TRUNK = (*TRUNK_SHARES, *NECK_SHARES)
EYES_LEVEL = 0.6
"""Share of the trunk's sideways lean that neck and head take back, so that the eyes stay level."""
EYES_BACK = 0.6
"""Share of the head's turn to the instrument that the eyes turn back, to the music and to the others."""
QUICK_S = 0.6
"""Gestures shorter than this are smaller in proportion: no one leans as far in half the time."""
UPRIGHT_S = 1.0
"""A body that bobs no more comes up within this time, and goes down again in as much before it does."""
EXHALE_S = 3.0
FULLEST = 1.4
LEAST_DRAWN = 0.4
"""However soon breaths follow each other, each has this much room: no breath goes unseen, also where a bell sinks."""
BREATH_LEAD_S = 0.03
"""The inhalation is complete this long before the breath's end."""
RESIDUE_SHARE = 0.6
"""RMS of the wandering that is always there, as a share of the sizes at amplitude 0."""
NOISE_SHARE = 0.30
"""Wandering beside the planned gestures, as a share of their size."""
LIFT_LAG = 0.6547
"""Where the side lobe of a bump's acceleration peaks, in half widths: a lift placed there adds to the nod's peak
without moving it."""
LIFT_SHARE = 0.6
_NONE_AT_REST = ("protraction_rad", "elbow_held_rad", "bell_held_rad", "hips_danced")


@dataclass(frozen=True)
class BodyMotion:
    """What the layers sum to; every array is (F,) float64.

    Attributes
    ----------
    forward_rad, left_rad, turn_rad : dict of str to array
        Flexion, sideways lean and twist of each joint of trunk and neck.
    hips_side_m, hips_bob_m : array
        Of the hips, to the left and down.
    hips_roll_rad, hips_turn_rad : array
        Left and left.
    knee_rad : array
        Bend added to both knees.
    bell_rad, bell_cue_rad : array
        Bell up, beside what the head does: with the melody, and to give a cue.
    bell_down_rad, bell_right_rad : array
        Bell towards a far hand; what the contacts ask for.
    bell_held_rad : dict of str to array
        What the animator adds to the instrument's ``pitch`` (bell up), ``yaw`` and ``roll`` (left); empty: nothing.
    shoulders_rad : array
        Both shoulders up.
    elbows_rad : array
        Both elbows out.
    eyes_yaw_rad, eyes_pitch_rad : array
        Of the eyes in the head: left, down.
    lowered : array
        0 with the instrument at the lips, 1 with it lowered.
    protraction_rad : dict of str to array
        Each shoulder forwards, by side; what the contacts ask for.
    elbow_held_rad : dict of str to array
        How far the animator turns each elbow out, by side; empty: not at all.
    hips_danced : dict of str to array
        What a dance adds to the hips (`app.motion.danced`): ``ahead_m``, ``forward_rad`` and ``ease_m``, by how much
        more the hand-over from leg to leg is rounded; empty: no one dances.
    """

    forward_rad: dict[str, FloatArray]
    left_rad: dict[str, FloatArray]
    turn_rad: dict[str, FloatArray]
    hips_side_m: FloatArray
    hips_bob_m: FloatArray
    hips_roll_rad: FloatArray
    hips_turn_rad: FloatArray
    knee_rad: FloatArray
    bell_rad: FloatArray
    bell_cue_rad: FloatArray
    bell_down_rad: FloatArray
    bell_right_rad: FloatArray
    bell_held_rad: dict[str, FloatArray]
    shoulders_rad: FloatArray
    elbows_rad: FloatArray
    eyes_yaw_rad: FloatArray
    eyes_pitch_rad: FloatArray
    lowered: FloatArray
    protraction_rad: dict[str, FloatArray]
    elbow_held_rad: dict[str, FloatArray]
    hips_danced: dict[str, FloatArray]

    def __getitem__(self, frames: slice) -> BodyMotion:
        """The same motion in some of its frames."""
        cut: dict[str, Any] = {}
        for member in fields(self):
            value = getattr(self, member.name)
            if isinstance(value, dict):
                cut[member.name] = {joint: angles[frames] for joint, angles in value.items()}
            else:
                cut[member.name] = value[frames]
        return BodyMotion(**cut)

    @classmethod
    def still(cls, posture: Posture) -> BodyMotion:
        """One frame of the posture before any motion."""
        zero = np.zeros(1)
        held, left, turned = (
            {joint: np.array([np.deg2rad(angles.get(joint, 0.0))]) for joint in TRUNK}
            for angles in (posture.spine_deg, posture.spine_left_deg, posture.spine_turn_deg)
        )
        rest: dict[str, Any] = {member.name: zero for member in fields(cls)}
        empty: dict[str, Any] = {name: {} for name in _NONE_AT_REST}
        return cls(**(rest | {"forward_rad": held, "left_rad": left, "turn_rad": turned} | empty))


@dataclass(frozen=True)
class _Sizes:
    """The body's sizes at one player's amplitude, and the noise of that player."""

    body: Body
    parameters: PlayerParameters
    player_id: str

    def of(self, scale: AmplitudeScale) -> float:
        return at_amplitude(scale, self.parameters.amplitude)

    def rad(self, scale: AmplitudeScale) -> float:
        return float(np.deg2rad(self.of(scale)))

    def wander(self, layer: str, scale: AmplitudeScale, times_s: FloatArray) -> FloatArray:
        """Noise of this player's layer: the residue, and a share of the planned motion's size."""
        noise = _noise(self.player_id, self.parameters.seed, layer, self.body.sway.residual_hz)
        return noise.sample(times_s) * (RESIDUE_SHARE * scale[0] + NOISE_SHARE * (self.of(scale) - scale[0]))


@lru_cache(maxsize=4096)
def _noise(player_id: str, seed: int, layer: str, low_hz: float) -> Noise:
    return Noise.of(generator(player_id, seed, layer), 0.4 * low_hz, 2.5 * low_hz)


def follow(
    events: Sequence[GestureEvent],
    kind: Literal["sway", "weight_shift", "bell_height"],
    transition_s: float | None = None,
) -> Curve:
    """A value that goes to each gesture's amount: over the whole gesture, or within ``transition_s`` of its start.

    It goes back to 0 where the next gesture is more than its own length (at least a second) away.
    """
    chosen = [event for event in events if event.kind == kind]
    segments: list[tuple[float, float, float]] = []
    for event, following in zip_longest(chosen, chosen[1:]):
        end_s = event.end_s if following is None else min(event.end_s, following.start_s)
        length_s = end_s - event.start_s
        if length_s <= 0.0:
            continue
        move_s = length_s if transition_s is None else min(transition_s, length_s)
        size = min(1.0, move_s / QUICK_S)
        amount = min(max(event.amount * size, -1.0), 1.0)
        segments.append((event.start_s, event.start_s + move_s, amount))
        pause_s = np.inf if following is None else following.start_s - end_s
        if pause_s > max(1.0, length_s):
            segments.append((end_s, end_s + min(max(length_s, 1.0), 2.0, pause_s), 0.0))
    return moves(segments)


@dataclass(frozen=True)
class Bobbing:
    """Down-ness 0..1 of a body that bobs with the sway's beats: lowest on each beat, where its acceleration peaks.

    Attributes
    ----------
    start_s, length_s, beats : (N,) float64
        Swings in order, and how many beats each lasts.
    level : Curve
        How far down the body goes.
    """

    start_s: FloatArray
    length_s: FloatArray
    beats: FloatArray
    level: Curve

    @classmethod
    def of(cls, events: Sequence[GestureEvent], felt_beats: FeltBeats) -> Bobbing:
        """From the sways among a player's gestures."""
        found = [event for event in events if event.kind == "sway" and event.end_s > event.start_s]
        # Of those that begin together the last one counts, as in `follow`.
        swings = [one for one, after in zip_longest(found, found[1:]) if after is None or after.start_s > one.start_s]
        if not swings:
            nothing = np.zeros(0)
            return cls(nothing, nothing, nothing, moves(()))
        start_s = np.array([event.start_s for event in swings])
        length_s = np.array([event.end_s for event in swings]) - start_s
        start_tick = np.array([event.start_tick for event in swings])
        lasts_tick = np.array([event.end_tick for event in swings]) - start_tick
        beats = np.maximum(1.0, np.round(lasts_tick / beat_ticks_at(felt_beats, start_tick)))
        size = np.square(np.minimum(1.0, length_s / beats / QUICK_S))
        # Who hardly sways hardly bobs: a body that is still is still.
        size *= np.sqrt(np.abs([event.amount for event in swings]))
        end_s = start_s + length_s
        # Between swings far apart the body stands upright.
        far = np.flatnonzero(start_s[1:] - end_s[:-1] > 2.0 * UPRIGHT_S)
        knots_s = np.concatenate(
            (start_s, end_s[-1:], end_s[far], end_s[far] + UPRIGHT_S, start_s[far + 1] - UPRIGHT_S)
        )
        sizes = np.concatenate((size, [0.0], size[far], np.zeros(2 * len(far))))
        order = np.argsort(knots_s, kind="stable")
        return cls(start_s, length_s, beats, through(knots_s[order], sizes[order]))

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Values at ascending times, (F,) float64."""
        if len(self.start_s) == 0:
            return np.zeros(len(times_s))
        inner = np.clip(np.searchsorted(self.start_s, times_s, side="right") - 1, 0, len(self.start_s) - 1)
        phase = (times_s - self.start_s[inner]) / self.length_s[inner]
        level = self.level.sample(times_s)
        within = (phase >= 0.0) & (phase <= 1.0)
        waving = level * (0.5 + 0.5 * np.cos(2.0 * np.pi * self.beats[inner] * phase))
        down: FloatArray = np.where(within, waving, level)
        return down

    def changed_s(self, other: Bobbing) -> FloatArray:
        """Spans (K, 2) outside of which both have the very same values."""
        swings = rows_changed_s(self._rows, other._rows, self._spans_s, other._spans_s)
        return np.concatenate((swings, self.level.changed_s(other.level)))

    @property
    def _rows(self) -> FloatArray:
        return np.stack((self.start_s, self.length_s, self.beats), axis=1)

    @property
    def _spans_s(self) -> FloatArray:
        """A swing holds to its end, or to the next one."""
        end_s = self.start_s + self.length_s
        return np.stack((self.start_s, np.maximum(end_s, np.append(self.start_s[1:], -np.inf)[: len(end_s)])), axis=1)


def lungs(breaths: Sequence[BreathEvent]) -> tuple[Curve, Curve]:
    """How full the lungs are (up over each breath, down over the phrase), and the preparation's lean 0..1."""
    full: list[tuple[float, float, float]] = []
    lean: list[tuple[float, float, float]] = []
    level = 0.0
    drawn = sorted((breath for breath in breaths if breath.kind == "breath"), key=lambda breath: breath.start_s)
    for breath, following in zip_longest(drawn, drawn[1:]):
        # Breaths that were moved onto each other by hand: the later one goes on from where the one before is full.
        start_s = max(breath.start_s, full[-1][1]) if full else breath.start_s
        if breath.end_s <= start_s:
            continue
        top_s = max(breath.end_s - BREATH_LEAD_S, 0.5 * (start_s + breath.end_s))
        rise = 0.5 + 0.5 * breath.depth
        level = min(FULLEST, level + rise)
        full.append((start_s, top_s, level))
        until_s = breath.end_s + EXHALE_S if following is None else min(breath.end_s + EXHALE_S, following.start_s)
        if until_s > breath.end_s:
            level = min(level * (1.0 - min(1.0, (until_s - breath.end_s) / 1.5)), FULLEST - LEAST_DRAWN)
            full.append((breath.end_s, until_s, level))
    free_s = -np.inf
    for breath in breaths:
        if breath.kind == "preparation" and breath.end_s > max(breath.start_s, free_s):
            start_s = max(breath.start_s, free_s)
            free_s = breath.end_s + 0.6 * (breath.end_s - start_s)
            lean += [(start_s, breath.end_s, 1.0), (breath.end_s, free_s, 0.0)]
    return moves(full), moves(lean)


def lowering(gestures: Sequence[GestureEvent], lower_s: float, raise_s: float) -> Curve:
    """0 with the instrument at the lips, 1 with it lowered; it is up again when the gesture ends.

    Gestures that overlap are one: the instrument stays down from the first to the last, as low as the lowest of them.
    """
    spans: list[tuple[float, float, float]] = []
    lowerings = (event for event in gestures if event.kind == "lower_instrument" and event.end_s > event.start_s)
    for event in sorted(lowerings, key=lambda event: event.start_s):
        if spans and event.start_s < spans[-1][1]:
            start_s, end_s, amount = spans[-1]
            spans[-1] = (start_s, max(end_s, event.end_s), max(amount, event.amount))
        else:
            spans.append((event.start_s, event.end_s, event.amount))
    segments: list[tuple[float, float, float]] = []
    for start_s, end_s, amount in spans:
        share = min(1.0, (end_s - start_s) / (lower_s + raise_s))
        segments.append((start_s, start_s + share * lower_s, amount))
        segments.append((end_s - share * raise_s, end_s, 0.0))
    return moves(segments)


@dataclass(frozen=True)
class Nods:
    """Dips and lifts of all cues: the dip's acceleration peaks on the preparatory beat, its width is the beat.

    Attributes
    ----------
    peak_s, half_s, amount : (N,) float64
    """

    peak_s: FloatArray
    half_s: FloatArray
    amount: FloatArray

    @classmethod
    def of(cls, cues: Sequence[CueEvent]) -> Nods:
        """From a player's cues."""
        rows = [(cue.peak_s, min(0.6 * cue.beat_s, cue.peak_s - cue.start_s), cue.amount) for cue in cues]
        table = np.array([row for row in rows if row[1] > 0.0], dtype=np.float64).reshape(-1, 3)
        return cls(table[:, 0], table[:, 1], table[:, 2])

    def sample(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Dip and lift, 1 as usual, at ascending times, each (F,) float64."""
        dip, lift = np.zeros(len(times_s)), np.zeros(len(times_s))
        first = np.searchsorted(times_s, self.peak_s - self.half_s)
        last = np.searchsorted(times_s, self.peak_s + 2.0 * self.half_s)
        for index in np.flatnonzero(last > first):
            here = slice(first[index], last[index])
            peak_s, half_s = float(self.peak_s[index]), float(self.half_s[index])
            amount = float(self.amount[index])
            np.maximum(dip[here], amount * bump(times_s[here], peak_s, half_s), out=dip[here])
            np.maximum(lift[here], amount * bump(times_s[here], peak_s + LIFT_LAG * half_s, half_s), out=lift[here])
        return dip, lift

    def changed_s(self, other: Nods) -> FloatArray:
        """Spans (K, 2) outside of which both have the very same values."""
        mine, others = (np.stack((nods.peak_s, nods.half_s, nods.amount), axis=1) for nods in (self, other))
        spans = [np.stack((row[:, 0] - row[:, 1], row[:, 0] + 2.0 * row[:, 1]), axis=1) for row in (mine, others)]
        return rows_changed_s(mine, others, *spans)


@dataclass
class _Sum:
    """Angles of trunk and neck while the layers are added."""

    frames: int
    angles: dict[str, FloatArray] = field(default_factory=dict)

    def add(self, shares: dict[str, float], values: FloatArray) -> None:
        for joint, share in shares.items():
            self.angles[joint] = self.angles.get(joint, 0.0) + share * values

    def all(self) -> dict[str, FloatArray]:
        return {joint: self.angles.get(joint, np.zeros(self.frames)) for joint in TRUNK}


_KINDS = ("sway", "weight_shift", "bell_height", "lower_instrument")
"""Gestures that layers are made of."""


@dataclass(frozen=True)
class LayerSamples:
    """The layers at some frames, before the player's sizes: members as of `Layers`, each (F,) float64.

    ``dip`` and ``lift`` are of the nods, ``held`` what the animator holds differently, ``gestured``
    the keyed gestures.
    """

    full: FloatArray
    leaning: FloatArray
    dip: FloatArray
    lift: FloatArray
    sway: FloatArray
    weight: FloatArray
    height: FloatArray
    bobbing: FloatArray
    lowered: FloatArray
    held: dict[PoseTarget, Offset]
    gestured: Sums = field(default_factory=dict)


@dataclass(frozen=True)
class Layers:
    """What one player's plan asks of the body, as curves of time; each is sampled with the sizes of the player.

    Attributes
    ----------
    full, leaning : Curve
        How full the lungs are, and the lean that prepares a breath.
    sway, weight, height : Curve
        Where sway, weight and bell go, -1..1.
    """

    full: Curve
    leaning: Curve
    nods: Nods
    sway: Curve
    weight: Curve
    height: Curve
    bobbing: Bobbing
    lowered: Curve
    poses: Poses
    gestured: Gestured

    @classmethod
    def of(
        cls, plan: PlayerPlan, body: Body, felt_beats: FeltBeats, before: tuple[Layers, PlayerPlan] | None = None
    ) -> Layers:
        """From a whole plan, or from what is the same as in the plan ``before``."""
        if before is not None:
            layers, other = before
            if same_events(plan, other, "gestures"):
                if not same_events(plan, other, "breaths"):
                    full, leaning = lungs(plan.breaths)
                    layers = replace(layers, full=full, leaning=leaning)
                if not same_events(plan, other, "cues"):
                    layers = replace(layers, nods=Nods.of(plan.cues))
                return layers if same_events(plan, other, "poses") else replace(layers, poses=Poses.of(plan.poses))
        full, leaning = lungs(plan.breaths)
        gestures = {kind: [event for event in plan.gestures if event.kind == kind] for kind in _KINDS}
        same: dict[str, Layers | None] = dict.fromkeys(_KINDS)
        if before is not None:
            # Other heights of the bell, and the same swings: most gestures outlive an edit.
            layers, other = before
            for kind in _KINDS:
                if gestures[kind] == [event for event in other.gestures if event.kind == kind]:
                    same[kind] = layers
        swing, shift, bell, low = (same[kind] for kind in _KINDS)
        return cls(
            full=full,
            leaning=leaning,
            nods=Nods.of(plan.cues),
            sway=swing.sway if swing else follow(gestures["sway"], "sway"),
            weight=shift.weight
            if shift
            else follow(gestures["weight_shift"], "weight_shift", body.weight_shift.transition_s),
            height=bell.height if bell else follow(gestures["bell_height"], "bell_height", 0.5),
            bobbing=swing.bobbing if swing else Bobbing.of(gestures["sway"], felt_beats),
            lowered=low.lowered
            if low
            else lowering(gestures["lower_instrument"], body.bell.lower_s, body.bell.raise_s),
            poses=Poses.of(plan.poses),
            gestured=Gestured.of(plan.gestures),
        )

    def sample(self, times_s: FloatArray) -> LayerSamples:
        """The layers at ascending times."""
        sampled: dict[str, Any] = {layer.name: getattr(self, layer.name).sample(times_s) for layer in fields(self)}
        dip, lift = sampled.pop("nods")
        return LayerSamples(dip=dip, lift=lift, held=sampled.pop("poses"), **sampled)


def body_motion(
    levels: LayerSamples,
    player_id: str,
    parameters: PlayerParameters,
    body: Body,
    posture: Posture,
    look: Look,
    times_s: FloatArray,
) -> BodyMotion:
    """Sum of all layers at ascending ``times_s`` (F,), on top of the posture's own angles."""
    sizes = _Sizes(body, parameters, player_id)
    sway, frames = body.sway, len(times_s)
    inhaled, lean, dip, lift = levels.full, levels.leaning, levels.dip, levels.lift

    aside = parameters.sway * levels.sway
    down = parameters.sway * levels.bobbing * (1.0 - np.clip(inhaled, 0.0, 1.0))
    weight = parameters.weight_shift * levels.weight
    height = parameters.bell_height * levels.height
    bell_up = np.maximum(height, 0.0) * sizes.rad(body.bell.up_deg) + np.minimum(height, 0.0) * sizes.rad(
        body.bell.down_deg
    )

    forward, left, turn = _Sum(frames), _Sum(frames), _Sum(frames)
    lowered = levels.lowered
    for joint, angle_deg in posture.spine_deg.items():
        forward.add({joint: 1.0}, np.full(frames, np.deg2rad(angle_deg)))
    for summed, angles in ((left, posture.spine_left_deg), (turn, posture.spine_turn_deg)):
        for joint, angle_deg in angles.items():
            # A player turned to the instrument looks straight ahead when it is lowered; the trunk stays with the hands.
            there = 1.0 - lowered if joint in NECK_SHARES else np.ones(frames)
            summed.add({joint: np.deg2rad(angle_deg)}, there)
    aside_rad = sum(np.deg2rad(angle_deg) for angle_deg in posture.spine_turn_deg.values()) * (1.0 - lowered)

    deg = np.deg2rad
    side = aside * sizes.rad(sway.side_deg) + deg(sizes.wander("side", sway.side_deg, times_s))
    left.add(TRUNK_SHARES, side)
    left.add(NECK_SHARES, -EYES_LEVEL * side)
    twist = -aside * sizes.rad(sway.turn_deg) + deg(sizes.wander("turn", sway.turn_deg, times_s))
    turn.add(TRUNK_SHARES, 0.7 * twist)
    nod_forward = down * sizes.rad(sway.forward_deg) + deg(sizes.wander("forward", sway.forward_deg, times_s))
    forward.add(TRUNK_SHARES, nod_forward)
    forward.add(NECK_SHARES, down * sizes.rad(sway.head_deg) - 0.4 * nod_forward)
    left.add(NECK_SHARES, deg(sizes.wander("head_side", sway.head_deg, times_s)))
    turn.add(NECK_SHARES, deg(sizes.wander("head_turn", sway.head_deg, times_s)))

    breathing = deg(body.breath.torso_back_deg) * inhaled - deg(body.breath.preparation_forward_deg) * lean
    forward.add(TRUNK_SHARES, -breathing)
    forward.add(NECK_SHARES, -deg(body.breath.head_back_deg) * inhaled + 0.4 * breathing)

    forward.add(TRUNK_SHARES, sizes.rad(body.cue.trunk_deg) * (dip - LIFT_SHARE * lift))
    forward.add(NECK_SHARES, sizes.rad(body.cue.head_deg) * (dip - LIFT_SHARE * lift))
    bell_cue = LIFT_SHARE * sizes.rad(body.cue.bell_lift_deg) * lift - sizes.rad(body.cue.bell_dip_deg) * dip
    # The head follows a rising or sinking bell a little, the trunk less.
    forward.add(NECK_SHARES, -0.35 * bell_up)
    forward.add(TRUNK_SHARES, -0.15 * bell_up)

    turn.add(NECK_SHARES, 0.5 * look.head_yaw_rad)
    forward.add(NECK_SHARES, 0.5 * look.head_pitch_rad)

    forward.add(TRUNK_SHARES, deg(body.bell.lowered_trunk_deg) * lowered)

    roll = weight * sizes.rad(body.weight_shift.roll_deg)
    left.add(TRUNK_SHARES, -0.8 * roll)
    forward_rad, left_rad, turn_rad = forward.all(), left.all(), turn.all()
    held = with_gestures(levels.held, levels.gestured, parameters.amplitude, parameters.gestures)
    hold_body(held, body, forward_rad, left_rad, turn_rad)
    bell_held, elbows_held = {}, {}
    if "bell" in held:
        bell = held["bell"]
        bell_held = {"pitch": BELL_UP["bell"] * bell.up, "yaw": BELL_LEFT["bell"] * bell.left, "roll": bell.roll}
    if "left_elbow" in held:
        elbows_held["left"] = held["left_elbow"].up
    if "right_elbow" in held:
        elbows_held["right"] = held["right_elbow"].up
    return BodyMotion(
        forward_rad=forward_rad,
        left_rad=left_rad,
        turn_rad=turn_rad,
        hips_side_m=weight * sizes.of(body.weight_shift.side_m)
        + sizes.wander("weight", body.weight_shift.side_m, times_s),
        hips_bob_m=down * sizes.of(sway.bob_m),
        hips_roll_rad=roll,
        hips_turn_rad=0.3 * twist,
        knee_rad=down * sizes.rad(sway.knee_deg) + dip * sizes.rad(body.cue.knee_deg),
        bell_rad=0.5 * bell_up,
        bell_cue_rad=bell_cue,
        bell_down_rad=np.zeros(frames),
        bell_right_rad=np.zeros(frames),
        bell_held_rad=bell_held,
        shoulders_rad=deg(body.breath.shoulder_lift_deg) * inhaled,
        elbows_rad=deg(body.breath.elbow_out_deg) * inhaled,
        eyes_yaw_rad=look.yaw_rad - 0.5 * look.head_yaw_rad - EYES_BACK * aside_rad,
        eyes_pitch_rad=look.pitch_rad - 0.5 * look.head_pitch_rad,
        lowered=lowered,
        protraction_rad={},
        elbow_held_rad=elbows_held,
        hips_danced={},
    )
