"""Layers of body motion: sway, lean, accents, weight, knees, breath, cue, bell, gaze, feet, and the residue of a body
asked to keep still.

Hips, chest, head and elbows have the same layers one after another (`app.motion.gestures.body_lag`). Every layer is a
function of time in anatomical angles. Layers are added, so each can be left out and none knows the others; contacts are
solved afterwards and are never broken by them. Sizes come from `metadata` at the player's amplitude.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import partial
from itertools import zip_longest
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.breath.air_in_trunk import air
from app.motion.breath.resting_breath import quiet_breaths
from app.motion.by_hand.pose_corrections import Offset, Poses, hold_body
from app.motion.curves.curve import Curve, Envelopes, moves
from app.motion.curves.following_gestures import follow, path
from app.motion.curves.path import Path
from app.motion.faces.gaze import Look, with_instrument
from app.motion.gestures.accents import Accents
from app.motion.gestures.beside_playing import Concert, ConcertSamples, beside_playing
from app.motion.gestures.body_lag import Leads, Overlapped
from app.motion.gestures.feet import Feet, feet_moved
from app.motion.gestures.hand_gestures import Reaches, Reaching, reached
from app.motion.gestures.held_still import held_still, holds_of
from app.motion.gestures.lowered_instrument import lowering
from app.motion.gestures.named_gestures import Gestured, Sums, with_gestures
from app.motion.gestures.nods import Nods
from app.motion.gestures.summed_angles import Angles, Part, Sizes, Sum
from app.plan.acting import Acting
from app.plan.by_hand.pose_corrections import BELL_LEFT, BELL_UP, NECK_SHARES, TRUNK_SHARES
from app.plan.kinds import Part as BodyPart
from app.plan.kinds import answered_by
from app.plan.model import BreathEvent, GestureEvent, PoseTarget
from app.plan.parameters import PlayerParameters
from app.steps import StepTable, reading
from metadata.model import Body, Posture, at_amplitude

EYES_BACK = 0.6
"""Share of the head's turn to the instrument that the eyes turn back, to the music and to the others."""
EXHALE_S = 3.0
FULLEST = 1.4
BELL_S: Final = 0.5
"""The bell goes to another height within this time."""
QUIET, QUIET_AIR = 0.45, 0.3
"""How full a quiet breath makes the lungs look, and how much air it is, beside a full one."""
LEAST_DRAWN = 0.4
"""However soon breaths follow each other, each has this much room: no breath goes unseen, also where a bell sinks."""
BREATH_LEAD_S = 0.03
"""The inhalation is complete this long before the breath's end."""
LIFT_SHARE = 0.7
FREE_AMPLITUDE = 0.5
"""Who moves as much as this lets the head go along with a trunk that turns for a far hand."""
STEP_IN_HIPS = 0.3
"""Hips go along with a foot that is put ahead."""


class LungCurves(NamedTuple):
    """How full the lungs look, and how far a preparation leans, 0..1."""

    full: Curve
    leaning: Curve


def lungs(breaths: Sequence[BreathEvent]) -> LungCurves:
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
    return LungCurves(moves(full), moves(lean))


@dataclass(frozen=True)
class LayerSamples:
    """The layers at some frames, before the player's sizes: members as of `Layers`, each (F,) float64.

    ``dip`` and ``lift`` are of the nods, ``giving`` is 1 half way between two places of the weight, ``held`` what the
    animator holds differently, ``gestured`` the keyed gestures, ``feet`` as of `Feet.sample`, ``concert`` what is done
    beside playing (None: nothing), ``reached`` the hands that leave the instrument, ``further`` how much fuller the
    lungs look to the trunk where a breath would not show (`app.motion.breath.breaths_that_show`), ``push`` how hard the
    breath pushes an attack (`app.motion.faces.tongue_strokes`).
    """

    full: FloatArray
    leaning: FloatArray
    air: FloatArray
    dip: FloatArray
    lift: FloatArray
    sway: Overlapped
    lean: Overlapped
    accent: Overlapped
    weight: Overlapped
    giving: FloatArray
    height: FloatArray
    lowered: FloatArray
    feet: dict[str, FloatArray]
    held: dict[PoseTarget, Offset]
    gestured: Sums | None = None
    concert: ConcertSamples | None = None
    reached: Reaches | None = None
    quiet: FloatArray | float = 0.0
    further: FloatArray | float = 0.0
    push: FloatArray | float = 0.0


@dataclass(frozen=True)
class Layers:
    """What one player's plan asks of the body, as curves of time; each is sampled with the sizes of the player.

    Attributes
    ----------
    full, leaning : Curve
        How full the lungs look, and the lean that prepares a breath.
    air : Curve
        How much air is in them.
    sway, lean : Path
        Where the trunk goes aside and forward, -1..1.
    weight, height : Curve
        Where weight and bell go, -1..1.
    leads : Leads
        How the parts of the body follow one another.
    """

    full: Curve
    leaning: Curve
    air: Curve
    nods: Nods
    sway: Path
    lean: Path
    accents: Accents
    weight: Curve
    height: Curve
    lowered: Curve
    quiet: Curve
    feet: Feet
    poses: Poses
    gestured: Gestured
    reaching: Reaching
    concert: Concert
    still: Envelopes
    leads: Leads

    def sample(self, times_s: FloatArray) -> LayerSamples:
        """The layers at ascending times."""
        return held_still(self._moving(times_s), self.still, times_s, self._moving)

    def _moving(self, times_s: FloatArray) -> LayerSamples:
        """The layers of a body that holds still nowhere."""
        dip, lift = self.nods.sample(times_s)
        before, after, share = self.weight.between(self.leads.at(times_s).hips)
        return LayerSamples(
            full=self.full.sample(times_s),
            leaning=self.leaning.sample(times_s),
            air=self.air.sample(times_s),
            dip=dip,
            lift=lift,
            sway=self.leads.sample(self.sway, times_s),
            lean=self.leads.sample(self.lean, times_s),
            accent=self.leads.sample(self.accents, times_s),
            weight=self.leads.sample(self.weight, times_s),
            giving=2.0 * share * (1.0 - share) * np.abs(after - before),
            height=self.height.sample(times_s),
            lowered=self.lowered.sample(times_s),
            quiet=self.quiet.sample(times_s),
            feet=self.feet.sample(times_s),
            held=self.poses.sample(times_s),
            gestured=self.gestured.sample(times_s),
            reached=self.reaching.sample(times_s),
            concert=self.concert.sample(times_s),
        )

    def changed_s(self, other: Layers) -> list[FloatArray]:
        """Spans (K, 2) outside of which both have the very same values."""
        names = [member.name for member in fields(self) if member.name != "leads"]
        return [self.leads.widened(getattr(self, name).changed_s(getattr(other, name))) for name in names]


def _of_part(gestures: tuple[GestureEvent, ...], part: BodyPart) -> tuple[GestureEvent, ...]:
    """Return the gestures that a part of the body's motion answers."""
    kinds = answered_by(part)
    return tuple(event for event in gestures if event.kind in kinds)


LAYERS: Final = StepTable(
    breaths="plan.breaths",
    gestures="plan.gestures",
    lung_curves=lungs,
    full="lung_curves.full",
    leaning="lung_curves.leaning",
    air=air,
    cues="plan.cues",
    nodding=partial(_of_part, part="nod"),
    nods=reading(Nods.of, answers="nodding"),
    swaying=partial(_of_part, part="sway"),
    sway=reading(path, events="swaying"),
    leant=partial(_of_part, part="lean"),
    lean=reading(path, events="leant"),
    accented=partial(_of_part, part="accent"),
    accents=reading(Accents.of, events="accented"),
    shifting=partial(_of_part, part="weight"),
    shift_s="body.weight_shift.transition_s",
    weight=reading(follow, events="shifting", transition_s="shift_s"),
    carrying=partial(_of_part, part="bell"),
    height=reading(partial(follow, transition_s=BELL_S), events="carrying"),
    putting_down=partial(_of_part, part="lowering"),
    lower_s="body.bell.lower_s",
    raise_s="body.bell.raise_s",
    lowered=reading(lowering, gestures="putting_down"),
    quiet=reading(quiet_breaths, gestures="putting_down"),
    stepping=partial(_of_part, part="feet"),
    step_s="body.footwork.step_s",
    feet=reading(Feet.of, events="stepping"),
    posed="plan.poses",
    poses=reading(Poses.of, events="posed"),
    gestured=reading(Gestured.of, events="gestures"),
    reaching=reading(Reaching.of, events="gestures"),
    beside=partial(_of_part, part="beside"),
    concert=reading(Concert.of, gestures="beside"),
    still=reading(holds_of, gestures="beside"),
    overlap="body.overlap",
    leads=reading(Leads.of, overlap="overlap"),
    layers=Layers,
)
"""The steps of a body's layers; given are the plan, the body and the felt beats."""


def body_motion(
    levels: LayerSamples,
    player_id: str,
    parameters: PlayerParameters,
    acting: Acting,
    body: Body,
    posture: Posture,
    look: Look,
    times_s: FloatArray,
    *,
    steps: bool = True,
    beside: FloatArray | float = 1.0,
    swaying: FloatArray | float = 1.0,
    shifting: FloatArray | float = 1.0,
) -> BodyMotion:
    """Sum of all layers at ascending ``times_s`` (F,), on top of the posture's own angles; without ``steps`` feet only
    tap.

    ``beside`` is the share that is shown of keyed gestures and of what is done beside playing, ``swaying`` and
    ``shifting`` of what wanders by itself with the sway and with the weight.
    """
    sizes, sway, deg = Sizes(body, parameters, player_id), body.sway, np.deg2rad
    inhaled, lean, shown = levels.full + QUIET * levels.quiet, levels.leaning, acting.gestures * beside
    dip, lift = acting.cue * levels.dip, acting.cue * levels.lift
    frames, lowered, seated = len(times_s), levels.lowered, posture.seat_height_shank > 0.0
    hands, raised = reached(levels.reached or {}, parameters.amplitude, acting.gestures)
    if raised is not None:
        lowered = lowered * (1.0 - raised)
    look, total = with_instrument(look, lowered), Sum(frames)
    aside_rad = _held(total, posture, lowered)
    wandering, uneasy = swaying * acting.sway, shifting * acting.weight_shift
    angles = Angles.of(
        Part(levels.sway, acting.sway), Part(levels.lean, acting.phrase), Part(levels.accent, acting.phrase),
        Part(levels.weight, acting.weight_shift), sizes, seated, Leads.of(body.overlap), times_s, wandering,
    )  # fmt: skip
    angles.add_to(total)
    total.left(NECK_SHARES, deg(sizes.wander("head_side", sway.head_deg, times_s, wandering)))
    total.turn(NECK_SHARES, deg(sizes.wander("head_turn", sway.head_deg, times_s, wandering)))

    breath_size = acting.breath * at_amplitude(body.breath.shown, parameters.amplitude)
    inhaled = breath_size * inhaled
    with_trunk, with_shoulders = sizes.breathing
    trunk_back = deg(with_trunk * body.breath.torso_back_deg) * (inhaled + breath_size * levels.further)
    pushed = deg(body.breath.push_forward_deg) * breath_size * levels.push
    breathing = trunk_back - deg(body.breath.preparation_forward_deg) * lean - pushed
    total.forward(TRUNK_SHARES, -breathing)
    total.forward(NECK_SHARES, -deg(body.breath.head_back_deg) * inhaled + 0.4 * breathing)

    total.forward(TRUNK_SHARES, sizes.rad(body.cue.trunk_deg) * (dip - LIFT_SHARE * lift))
    total.forward(NECK_SHARES, sizes.rad(body.cue.head_deg) * (dip - LIFT_SHARE * lift))
    bell_cue = LIFT_SHARE * sizes.rad(body.cue.bell_lift_deg) * lift - sizes.rad(body.cue.bell_dip_deg) * dip
    # The head follows a rising or sinking bell a little, the trunk less.
    height = acting.bell_height * levels.height
    bell_up = np.maximum(height, 0.0) * sizes.rad(body.bell.up_deg) + np.minimum(height, 0.0) * sizes.rad(
        body.bell.down_deg
    )
    total.forward(NECK_SHARES, -0.35 * bell_up)
    total.forward(TRUNK_SHARES, -0.15 * bell_up)

    total.turn(NECK_SHARES, 0.5 * look.head_yaw_rad)
    total.forward(NECK_SHARES, 0.5 * look.head_pitch_rad)
    total.forward(TRUNK_SHARES, deg(body.bell.lowered_trunk_deg) * lowered)

    feet = feet_moved(levels.feet, body, parameters.amplitude, acting.footwork, steps=steps)
    hips_forward_rad, hips_ahead_m = angles.pelvis, _ahead_m(levels, sizes, acting, feet, times_s, uneasy)
    shoulders, elbows = (
        deg(with_shoulders * body.breath.shoulder_lift_deg) * inhaled,
        deg(body.breath.elbow_out_deg) * inhaled,
    )
    if levels.concert is not None:
        done = beside_playing(levels.concert, body.concert, parameters.amplitude, shown, seated or not steps)
        total.forward(TRUNK_SHARES, done.trunk_rad)
        total.forward(NECK_SHARES, done.neck_rad)
        total.turn(TRUNK_SHARES, body.concert.look_trunk_share * lowered * 0.5 * look.head_yaw_rad)
        lowered = lowered * (1.0 - done.up_share)
        hips_forward_rad, hips_ahead_m = hips_forward_rad + done.hips_rad, hips_ahead_m - done.back_m
        shoulders, elbows = shoulders + done.shoulders_rad, elbows + done.elbows_rad
    forward_rad, left_rad, turn_rad = total.all()
    held = with_gestures(levels.held, levels.gestured, parameters.amplitude, shown)
    hold_body(held, body, forward_rad, left_rad, turn_rad)
    bell_held, elbows_held = {}, {}
    if "bell" in held:
        bell = held["bell"]
        bell_held = {"pitch": BELL_UP["bell"] * bell.up, "yaw": BELL_LEFT["bell"] * bell.left, "roll": bell.roll}
    if "left_elbow" in held:
        elbows_held["left"] = held["left_elbow"].up
    if "right_elbow" in held:
        elbows_held["right"] = held["right_elbow"].up
    down = acting.phrase * levels.accent.hips
    giving = acting.weight_shift * levels.giving * sizes.rad(body.weight_shift.knee_deg)
    return BodyMotion(
        forward_rad=forward_rad,
        left_rad=left_rad,
        turn_rad=turn_rad,
        hips_side_m=_aside_m(levels, sizes, acting, steps, times_s, uneasy),
        hips_ahead_m=hips_ahead_m,
        hips_bob_m=np.maximum(down, 0.0) * sizes.of(sway.bob_m),
        hips_roll_rad=angles.hips_roll_rad,
        hips_turn_rad=angles.hips_turn_rad,
        hips_forward_rad=hips_forward_rad,
        # Knees give way on an accent, in a nod, and as they take the weight.
        knee_rad=np.maximum(down, -0.3) * sizes.rad(sway.knee_deg) + dip * sizes.rad(body.cue.knee_deg) + giving,
        bell_rad=0.5 * bell_up,
        bell_cue_rad=bell_cue,
        bell_down_rad=np.zeros(frames),
        bell_right_rad=np.zeros(frames),
        bell_held_rad=bell_held,
        shoulders_rad=shoulders,
        elbows_rad=elbows,
        eyes_yaw_rad=look.yaw_rad - 0.5 * look.head_yaw_rad - EYES_BACK * aside_rad,
        eyes_pitch_rad=look.pitch_rad - 0.5 * look.head_pitch_rad,
        lowered=lowered,
        steadied=np.full(frames, max(0.0, 1.0 - parameters.amplitude / FREE_AMPLITUDE)),
        protraction_rad={},
        elbow_held_rad=elbows_held,
        hips_danced={},
        elbows_late_rad=angles.elbows_late(),
        feet=feet,
        hands=hands,
    )


def _held(total: Sum, posture: Posture, lowered: FloatArray) -> FloatArray:
    """Add a posture, and return how far the head is turned to the instrument."""
    still = np.ones(len(lowered))
    for joint, angle_deg in posture.spine_deg.items():
        total.forward({joint: 1.0}, np.deg2rad(angle_deg) * still)
    for add, angles in ((total.left, posture.spine_left_deg), (total.turn, posture.spine_turn_deg)):
        for joint, angle_deg in angles.items():
            # A player turned to the instrument looks straight ahead when it is lowered; the trunk stays with the hands.
            there = 1.0 - lowered if joint in NECK_SHARES else still
            add({joint: np.deg2rad(angle_deg)}, there)
    aside: FloatArray = sum(np.deg2rad(angle_deg) for angle_deg in posture.spine_turn_deg.values()) * (1.0 - lowered)
    return aside


def _aside_m(
    levels: LayerSamples, sizes: Sizes, acting: Acting, steps: bool, times_s: FloatArray, uneasy: FloatArray | float
) -> FloatArray:
    """Hips to the left: with the weight, and over the foot that stands during a step."""
    side_m = sizes.body.weight_shift.side_m
    aside_m: FloatArray = acting.weight_shift * levels.weight.hips * sizes.of(side_m)
    aside_m = aside_m + sizes.wander("weight", side_m, times_s, uneasy)
    if steps:
        over_m = acting.footwork * sizes.of(sizes.body.footwork.unload_m)
        for side, sign in (("left", -1.0), ("right", 1.0)):
            if f"{side}_unloaded" in levels.feet:
                aside_m = aside_m + sign * over_m * levels.feet[f"{side}_unloaded"]
    return aside_m


def _ahead_m(
    levels: LayerSamples,
    sizes: Sizes,
    acting: Acting,
    feet: dict[str, FloatArray],
    times_s: FloatArray,
    uneasy: FloatArray | float,
) -> FloatArray:
    """Hips ahead: back as the trunk leans forward, aslant with the weight, half as far as a foot that is put ahead."""
    phrase, shift = sizes.body.phrase, sizes.body.weight_shift
    back = acting.phrase * (levels.lean.hips + 0.5 * levels.accent.hips) * sizes.of(phrase.ahead_m)
    aslant = sizes.aslant * acting.weight_shift * levels.weight.hips * sizes.of(shift.ahead_m)
    ahead_m: FloatArray = aslant - back + sizes.wander("ahead", shift.ahead_m, times_s, uneasy)
    for side in ("left", "right"):
        if f"{side}_ahead" in feet:
            ahead_m = ahead_m + STEP_IN_HIPS * feet[f"{side}_ahead"]
    return ahead_m
