"""Turns a player's plan into motion: curves of controls, face and body, then contacts, vectorised over frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.breath.air_in_trunk import widened
from app.motion.breath.breaths_that_show import leaning_further
from app.motion.by_hand.additive_curves import NOTHING, Additive, with_added, with_added_morphs, with_held
from app.motion.contacts.arms_room import limited_to_arms
from app.motion.contacts.carried_instrument import limited_to_carriage, shown_by
from app.motion.contacts.hand_in_bell import STOPPING, bell_closing
from app.motion.contacts.ready_player import player_body
from app.motion.contacts.solve import PlayerBody, padding_frames, solve
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import SIDES, Footing, Side, footing, hips_path, torso_forward
from app.motion.curves.curve import EVERYWHERE, Curve, Envelopes, frame_times
from app.motion.faces.exertion import Lungs
from app.motion.faces.face_curves import FACE, FaceCurves
from app.motion.faces.gaze import GAZE, Gaze, GazeFrames, Watching, plan_gaze
from app.motion.faces.morph_weights import FaceSizes, face_morphs, face_sizes
from app.motion.fingering.finger_curves import sampled
from app.motion.fingering.fingers import FINGERS, fingers_of
from app.motion.gestures.body_layers import QUIET_AIR, StyleShares, body_motion
from app.motion.gestures.dance_layer import BodyLayer, breath_envelopes, giving_way, leaning_less, with_dance
from app.motion.gestures.danced_feet import DancedFeet, with_danced, with_danced_feet
from app.motion.gestures.feet import feet_moved
from app.motion.gestures.held_still import with_holds
from app.motion.gestures.layers import LAYERS, Layers, LayerSamples
from app.motion.gestures.summed_angles import Sizes
from app.motion.model import Motion
from app.motion.played_frames import PlayedFrames
from app.plan.acting import Acting, acting_of
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters, deciding_values
from app.plan.styles import differing_s, most_shown, share_at
from app.rig.grip.carriage import carrying
from app.rig.grip.grip_pose import GripPose, StationBlend, giving_for
from app.rig.model import Character
from app.score.metre_map import FeltBeats
from app.steps import StepRuns
from instrument_maps.model import InstrumentMap
from metadata.load import load_expressions
from metadata.model import Body, Expression, Posture

FEET_LEFT: Final = 0.1
"""Amount of a dance above which its feet replace all generated steps, taps and heel lifts."""
NOT_SHOWN = Envelopes.of(())
OWN: Final = ("raised", "inhaling", "stopping", "_further", "additive", "danced_feet")
"""Curves of `PerformanceCurves` that are computed separately from the layers."""


@dataclass(frozen=True, eq=False)
class PerformanceCurves:
    """One player's plan as curves over the whole performance, from which all frames are computed.

    Attributes
    ----------
    felt_beats : tuple of (tick, ticks)
        Felt beat from each tick on.
    parameters : PlayerParameters
        Parameters as set, with less sway for an instrument that rests on the body or the floor.
    acting : Acting
        Acting by these parameters, reduced for an instrument that rests on the body or the floor, and by a dance.
    posture : Posture
        Posture with head and trunk turned to the instrument.
    expressions : dict of str to Expression
        Expressions used in the plan.
    player : PlayerBody
        Time-independent data of the player.
    controls : dict of str to Curve
        Curve of each control of the instrument.
    stations : dict of str to Curve
        Station of each finger (`app.motion.fingering.finger_curves`).
    raised : Curve
        Height of waiting fingers above their keys.
    dance : BodyLayer or None
        Dance of hips, trunk and head, scaled by the parameters.
    danced_feet : DancedFeet
        Dance of the feet, where not corrected by the animator.
    inhaling : Envelopes
        Spans in which the dance gives way to breaths.
    stowed : Curve or None
        Share by which the instrument is put aside (`app.motion.doubling`).
    additive : Additive
        The animator's additive curves.
    stopping : Envelopes
        Closure of the bell by a hand.
    runs : StepRuns
        Cache of the steps that made the curves, for reuse after edits.
    """

    plan: PlayerPlan
    instrument_map: InstrumentMap
    felt_beats: FeltBeats
    parameters: PlayerParameters
    acting: Acting
    posture: Posture
    body: Body
    expressions: dict[str, Expression]
    player: PlayerBody
    layers: Layers
    face: FaceCurves
    gaze: Gaze
    controls: dict[str, Curve]
    stations: dict[str, Curve]
    raised: Curve
    runs: StepRuns
    dance: BodyLayer | None = None
    danced_feet: DancedFeet = field(default_factory=DancedFeet.none)
    inhaling: Envelopes = NOT_SHOWN
    stowed: Curve | None = None
    additive: Additive = NOTHING
    stopping: Envelopes = NOT_SHOWN

    @property
    def player_id(self) -> str:
        """Id of the player whose motion the curves describe."""
        return self.plan.player_id

    @property
    def start_s(self) -> float:
        """Performance time of frame 0 in seconds."""
        return self.plan.time_frame.first_frame_s

    def motion(self, fps: Fraction, first_frame: int, frames: int, every: int = 1) -> Motion:
        """Compute some frames of the motion, or every n-th of them at the correspondingly lower rate. A frame is the
        same whatever span is requested.
        """
        pad = padding_frames(fps)
        times_s = frame_times(self.start_s, fps, first_frame - pad, frames + 2 * pad)
        curves = self.curves(self.frames(times_s))
        return solve(
            self.player, curves, fps, float(frame_times(self.start_s, fps, first_frame, 1)[0]), every, first_frame
        )

    def frames(self, times_s: FloatArray) -> PlayedFrames:
        """Sample everything that moves the player at ascending times, before contacts are solved."""
        levels = replace(self.layers.sample(times_s), further=self._further.sample(times_s))
        return PlayedFrames(
            times_s=times_s,
            levels=levels,
            look=self.gaze.sample(times_s),
            face=self.face.sample(times_s),
            controls={name: curve.sample(times_s) for name, curve in self.controls.items()},
            placed=self.placed(times_s),
            raised=self.raised.sample(times_s),
            danced=self._danced(times_s),
            stepped=self._stepped(times_s),
            stowed=None if self.stowed is None else self.stowed.sample(times_s),
            added=self.additive.sample(times_s),
            stopping=self.stopping.sample(times_s) if len(self.stopping.height) else None,
        )

    def _danced(self, times_s: FloatArray) -> FloatArray | None:
        if self.dance is None:
            return None
        return giving_way(self.dance.sample(times_s), self.inhaling.sample(times_s))

    def _stepped(self, times_s: FloatArray) -> dict[str, FloatArray]:
        stepped = self.danced_feet.sample(times_s, steps=self.player.stands_free)
        return leaning_less(stepped, self.inhaling.sample(times_s)) if stepped else stepped

    def curves(self, frames: PlayedFrames) -> ContactCurves:
        """Convert sampled or live frames to the inputs of the contact solvers."""
        levels = self._breathing(replace(frames.levels, push=frames.face.push), frames.times_s)
        added = frames.added
        if added:
            levels = replace(levels, held=with_held(levels.held, added))
        moved = self._moved(levels, frames.look, frames.times_s)
        if frames.danced is not None:
            amount, free = self.parameters.dance_amount, self.player.stands_free
            moved = with_dance(moved, frames.danced, amount, self.body, legs=free)
            moved = with_danced_feet(moved, frames.stepped, amount, self.body, steps=free)
        if added:
            moved = with_added(moved, added, self.body, self.player.place.knee_rad)
        if frames.stopping is not None:
            moved = replace(moved, hands=moved.hands | {STOPPING: frames.stopping})
        if frames.stowed is not None and self.player.put_aside is not None:
            moved = self.player.put_aside.watched(moved, frames.stowed)
            # A hand that put its instrument aside has already left it.
            there = 1.0 - frames.stowed
            moved = replace(moved, hands={name: (there * values.T).T for name, values in moved.hands.items()})
        styles = self.plan.styles
        morphs = face_morphs(
            frames.face,
            self.player.grip.lips,
            self.expressions,
            frames.look,
            moved.lowered,
            self._face_sizes.shared(share_at(styles, "face", frames.times_s), share_at(styles, "lips", frames.times_s)),
            frames.times_s,
        )
        air = levels.air + QUIET_AIR * levels.quiet
        morphs |= widened(air, levels.push, self.body.breath, self.acting.breath)
        if added:
            morphs = with_added_morphs(morphs, added, frames.face.at_lips)
        return ContactCurves(
            moved, frames.controls, morphs, frames.face.mouth_open, frames.placed, frames.raised, frames.stowed
        )

    def _moved(self, levels: LayerSamples, look: GazeFrames, times_s: FloatArray) -> BodyMotion:
        """Compute the body motion of the layers, without dance and additive curves, as if the instrument were never put
        aside.
        """
        return body_motion(
            levels,
            Sizes(self.body, self.parameters, self.player_id, self.acting, self.posture),
            look,
            times_s,
            StyleShares(*(share_at(self.plan.styles, layer, times_s) for layer in StyleShares._fields)),
            self.player.steps,
        )

    @cached_property
    def _further(self) -> Envelopes:
        return leaning_further(self.plan.breaths, self.layers.full, self._torso_rad)

    def _torso_rad(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forward lean (F,) of the trunk in radians at ascending times, without and with breathing; without dance,
        which gives way to breaths, and without poses by hand."""
        levels = self._breathing(replace(self.layers.sample(times_s), held={}), times_s)
        look, skeleton, place = self.gaze.sample(times_s), self.player.skeleton, self.player.place

        def lean_rad(levels: LayerSamples) -> FloatArray:
            moved = self._moved(levels, look, times_s)
            return torso_forward(skeleton, *hips_path(place, skeleton, moved), moved)

        return lean_rad(replace(levels, full=np.zeros(len(times_s)))), lean_rad(levels)

    def _breathing(self, levels: LayerSamples, times_s: FloatArray) -> LayerSamples:
        """Scale the breathing in the layers of motion by the styles in force at each time."""
        share = share_at(self.plan.styles, "breath", times_s)
        if isinstance(share, float):
            return levels
        shown = {name: share * getattr(levels, name) for name in ("full", "air", "further", "push")}
        return replace(levels, **shown)

    def placed(self, times_s: FloatArray) -> dict[str, StationBlend]:
        """Sample the stations of fingers, and of hands that shift to help a finger, at ascending times."""
        hands = self.player.grip.hands
        asked = {table.finger for hand in hands for table in hand.fingers}
        asked |= {giving_for(finger) for hand in hands for lean in hand.leans for finger, _ in lean.places}
        return {name: sampled(curve, times_s) for name, curve in self.stations.items() if name in asked}

    def footings(self, times_s: FloatArray) -> dict[Side, Footing]:
        """Intended poses of the feet, by side, at ascending times (F,); toes rise only as far as the ankles allow."""
        levels, amplitude = self.layers.feet.sample(times_s), self.parameters.amplitude
        moved = feet_moved(levels, self.body, amplitude, self.acting.footwork, steps=self.player.steps)
        danced = self.danced_feet.sample(times_s, steps=self.player.stands_free)
        moved = with_danced(moved, danced, self.parameters.dance_amount)
        return {side: footing(self.player.place, side, moved, len(times_s)) for side in SIDES}

    def changed_s(self, other: PerformanceCurves) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which, and of `padding_frames` around them, both motions have
        equal frames."""
        mine, others = self._settings, other._settings
        if mine[0] != others[0] or any(a is not b for a, b in zip(mine[1:], others[1:], strict=True)):
            return EVERYWHERE
        if self.controls.keys() != other.controls.keys() or self.stations.keys() != other.stations.keys():
            return EVERYWHERE
        alone, others_alone = ({name: getattr(one, name) for name in OWN} for one in (self, other))
        pairs: list[tuple[Mapping[str, Any], Mapping[str, Any]]] = [
            (self.controls, other.controls),
            (self.stations, other.stations),
            (alone, others_alone),
        ]
        pairs += [(vars(mine), vars(theirs)) for mine, theirs in ((self.face, other.face), (self.gaze, other.gaze))]
        spans = [
            curve.changed_s(others[name])
            for own, others in pairs
            for name, curve in own.items()
            if not isinstance(curve, dict)
        ]
        spans.append(differing_s(self.plan.styles, other.plan.styles))
        if self.stowed is not None and other.stowed is not None:
            spans.append(self.stowed.changed_s(other.stowed))
        spans += self.layers.changed_s(other.layers)
        for name in self.face.expressions.keys() | other.face.expressions.keys():
            shown = self.face.expressions.get(name, NOT_SHOWN)
            others_shown = other.face.expressions.get(name, NOT_SHOWN)
            if self.expressions.get(name) == other.expressions.get(name):
                spans.append(shown.changed_s(others_shown))
            else:
                spans += [shown.spans_s, others_shown.spans_s]
        return with_holds(np.concatenate(spans), self.layers.still, other.layers.still)

    @property
    def _face_sizes(self) -> FaceSizes:
        mouth, recorded = self.instrument_map.embouchure, self.plan.has_recorded_lips
        return face_sizes(self.player_id, self.parameters, self.acting, self.body, mouth.kind, mouth.vibrato, recorded)

    @property
    def _settings(self) -> tuple[object, ...]:
        """Settings that affect every frame: plain values first, then objects compared by identity."""
        still = self.player
        endpin = None if still.stand is None else still.stand.endpin
        shown, put = deciding_values(self.parameters, "motion"), (still.aside, self.stowed is None)
        values = (
            self.player_id,
            self.start_s,
            shown,
            self.acting,
            self.posture,
            still.carriage,
            still.lowered,
            endpin,
            put,
            self.plan.has_recorded_lips,
        )
        return (values, still.skeleton, still.grip, still.shape, self.body, self.dance)


def prepare(
    runs: StepRuns,
    plan: PlayerPlan,
    parameters: PlayerParameters,
    instrument_map: InstrumentMap,
    character: Character,
    grip: GripPose,
    body: Body,
    *,
    felt_beats: FeltBeats,
    expressions: Mapping[str, Expression] | None = None,
    dance: BodyLayer | None = None,
) -> PerformanceCurves:
    """Convert a player's plan to curves.

    ``parameters`` set amplitude, posture, seed and sizes of layers; ``grip`` must be fitted for this character and
    instrument; a rest of a felt beat brings controls back to rest; bundled expressions are the default. Unchanged
    curves are reused from ``runs`` (`PerformanceCurves.runs` before an edit). ``dance`` is added by the parameters'
    amount and replaces as much of the generated sway and weight shift.
    """
    known = load_expressions() if expressions is None else expressions
    carriage = instrument_map.hold.carriage(parameters.posture)
    dance = None if parameters.dance_amount == 0.0 else dance
    shown = most_shown(plan.styles, acting_of(parameters))
    acting = shown_by(parameters, carriage, shown, dancing=dance is not None)
    parameters = limited_to_carriage(parameters, carriage)
    player = player_body(parameters, instrument_map, character, grip, body)
    parameters = limited_to_arms(parameters, player)
    feet = DancedFeet.none() if dance is None else dance.feet.giving_way(plan.gestures)
    given = _given(
        plan, parameters, acting, player, instrument_map, body, felt_beats=felt_beats, dances=dance is not None
    )
    face, layers = runs.begin(FACE, **given).of(FaceCurves), runs.begin(LAYERS, **given).of(Layers)
    gaze, hands = runs.begin(GAZE, **given).of(plan_gaze), runs.begin(FINGERS, **given)
    fingers = hands.of(fingers_of)
    made = PerformanceCurves(
        plan=plan,
        instrument_map=instrument_map,
        felt_beats=felt_beats,
        parameters=parameters,
        acting=acting,
        posture=carrying(body, instrument_map.hold.possible(parameters.posture), carriage),
        body=body,
        expressions={name: known[name] for name in face.expressions},
        player=player,
        layers=layers,
        face=face,
        gaze=gaze,
        controls=fingers.controls,
        stations=fingers.stations,
        raised=fingers.raised,
        dance=dance,
        danced_feet=feet,
        inhaling=NOT_SHOWN if dance is None else breath_envelopes(plan.breaths),
        stopping=bell_closing(plan.mutes, instrument_map.stopped),
        additive=hands.of(Additive.of),
        runs=runs,
    )
    runs.close()
    return made


def _given(
    plan: PlayerPlan,
    parameters: PlayerParameters,
    acting: Acting,
    player: PlayerBody,
    instrument_map: InstrumentMap,
    body: Body,
    *,
    felt_beats: FeltBeats,
    dances: bool,
) -> dict[str, object]:
    """Collect all inputs of the steps that make a player's motion, by name."""
    return {
        "plan": plan,
        "embouchure_tension": parameters.embouchure_tension,
        "face_motion": body.face,
        "lungs": Lungs.of(parameters, instrument_map.air),
        "body": body,
        "felt_beats": felt_beats,
        "watching": Watching(parameters.seed, acting.gaze, acting.blink),
        "instrument": instrument_map,
        "farthest": player.farthest,
        "generated_feet": max(0.0, 1.0 - parameters.dance_amount / FEET_LEFT) if dances else 1.0,
    }
