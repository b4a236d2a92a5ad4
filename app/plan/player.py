"""Steps of one player's plan: fingering, breath, face and motion, each recomputed only if its inputs change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import chain
from typing import Final

import msgspec

from app.plan.acting import acting_of
from app.plan.breath.breaths import BreathPlan, plan_breaths
from app.plan.breath.staggered_breaths import after_holds, breathed_of, compared_with_others, shared_with
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.additive_events import plan_additive
from app.plan.by_hand.corrected_events import correct_embouchures, correct_expressions, correct_gestures, orphans
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
    of_kinds,
)
from app.plan.by_hand.pose_corrections import plan_poses
from app.plan.cues.answering_nods import answering_nods
from app.plan.faces.expressions_at_moments import SMILE_ID, all_shown, neutral_face, plan_moments
from app.plan.faces.glances import StagePlace, glances_of
from app.plan.faces.looks_at_conductor import looks_up
from app.plan.fingering.fingerings import plan_fingerings
from app.plan.fingering.mutes import plan_mutes
from app.plan.gestures.feet import footwork
from app.plan.gestures.gestures import bell_heights, in_order, weight_shifts
from app.plan.gestures.idle_gestures import after_the_end, holding_at_end, in_long_rests
from app.plan.gestures.leans_and_accents import accents, leans, phrases
from app.plan.gestures.lowered_instrument import lowered_spans
from app.plan.gestures.named_gestures import with_definitions, without_idle_hands
from app.plan.gestures.sways import sways, swings_of
from app.plan.kinds import GESTURE_KINDS
from app.plan.lips.embouchure import plan_embouchures
from app.plan.lips.recorded_lips import plan_traces
from app.plan.lips.tonguing import plan_tongues
from app.plan.model import (
    CONDUCTOR,
    CueEvent,
    ExpressionEvent,
    GestureEvent,
    PlayerPlan,
    Problem,
    TimeFrame,
)
from app.plan.music.breath_controller import BreathEnvelope, blown
from app.plan.music.dynamics import dynamics_of
from app.plan.music.dynamics_within_notes import dynamics_within
from app.plan.music.ending import Ending
from app.plan.music.piece import ControllerInput, LineTimes, Piece, Seeds, without_sound
from app.plan.music.pitch_bends import written_bends
from app.plan.parameters import parameters_deciding
from app.plan.rule_conditions import facts_of
from app.plan.rules import lowered_spans_s, plan_by_rules, with_ruled, without_overruled
from app.plan.styles import plan_styles
from app.score.marks import Mark, Source
from app.score.model import Note
from app.score.tempo import TempoMap
from app.steps import StepInputs, StepTable, reading
from metadata.acting import names_in
from metadata.model import Expression


def _seeds(seed: int, own_seed: int, player_id: str, corrections: tuple[Correction, ...]) -> Seeds:
    varied = tuple((item.start_tick, item.end_tick, item.seed) for item in corrections if isinstance(item, Vary))
    return Seeds((seed, own_seed, player_id), varied)


def _pins(corrections: tuple[Correction, ...]) -> dict[str, str]:
    return {item.note_id: item.label for item in corrections if isinstance(item, PinFingering)}


def _envelope(
    controller: ControllerInput | None, clock: TempoMap, times: LineTimes, marks: tuple[Mark, ...], source: Source
) -> BreathEnvelope | None:
    """Return the recorded breath curve; without one, a curve of the written dynamics if they change within notes, else
    None."""
    if controller is not None and controller.breath is not None:
        return blown(controller.breath, clock)
    return dynamics_within(times, marks, source, clock) if marks else None


def _lip_input(
    controller: ControllerInput | None, notes: tuple[Note, ...], marks: tuple[Mark, ...], clock: TempoMap
) -> ControllerInput | None:
    """Return the controllers that move the lips; bends written in the score are used if the recording has none."""
    if controller is not None and controller.bend is not None:
        return controller
    bend = written_bends(notes, marks, clock) if marks else None
    return controller if bend is None else replace(controller or ControllerInput(), bend=bend)


def _is_recorded(controller: ControllerInput | None) -> bool:
    return controller is not None


def _from_breath(controller: ControllerInput | None) -> bool:
    return controller is not None and controller.breath is not None


def _cues_of(cue_events: tuple[CueEvent, ...], player_id: str) -> tuple[CueEvent, ...]:
    return tuple(cue for cue in cue_events if cue.player_id == player_id)


def _answered(cue_events: tuple[CueEvent, ...], player_id: str) -> tuple[CueEvent, ...]:
    """Return the cues given by others with which a player comes in."""
    return tuple(cue for cue in cue_events if player_id in cue.takers)


def _seen(
    player_id: str, cues: tuple[CueEvent, ...], answered: tuple[CueEvent, ...], stage: Mapping[str, StagePlace]
) -> dict[str, StagePlace]:
    """Return the positions on stage, by id, of the player, the conductor and all players looked at."""
    others = {cue.player_id for cue in answered} | {taker for cue in cues for taker in cue.takers} | {CONDUCTOR}
    return {one: place for one, place in stage.items() if one == player_id or one in others}


def _joined(cues: tuple[CueEvent, ...], answered: tuple[CueEvent, ...]) -> tuple[CueEvent, ...]:
    return cues + answered


def _after_the_end(
    notes: tuple[Note, ...], last_s: float, piece: Piece, frame: TimeFrame, seeds: Seeds
) -> list[GestureEvent]:
    return after_the_end(last_s, piece, frame, seeds) if notes else []


def _looking(gestures: tuple[GestureEvent, ...]) -> tuple[GestureEvent, ...]:
    """Return those gestures that move the eyes or direct the gaze."""
    return tuple(
        event
        for event in gestures
        if GESTURE_KINDS[event.kind].moves_eyes or (event.gesture is not None and event.gesture.gaze is not None)
    )


def _ending(piece_ending: Ending, corrections: tuple[Correction, ...]) -> Ending:
    """Return the piece's ending as it applies to this player; it counts as bright if the animator changed or removed
    the smile after the last note.
    """
    named = any(item.event_id == SMILE_ID for item in corrections if isinstance(item, ChangeExpression | RemoveEvent))
    return msgspec.structs.replace(piece_ending, bright=True) if named else piece_ending


def _neutral(clock: TempoMap, frame: TimeFrame, faces: Mapping[str, Expression]) -> ExpressionEvent:
    return neutral_face(clock, frame, faces["neutral"])


def _note_ids(notes: tuple[Note, ...]) -> frozenset[str]:
    return frozenset(note.id for note in notes)


def _lost(
    corrections: tuple[Correction, ...],
    note_ids: frozenset[str],
    planned_breaths: BreathPlan,
    cue_ids: frozenset[str],
    made_gestures: tuple[GestureEvent, ...],
    made_expressions: tuple[ExpressionEvent, ...],
    frame: TimeFrame,
) -> tuple[Problem, ...]:
    """Return a problem for every correction whose note or planned event does not exist any more."""
    made = planned_breaths.generated_ids | cue_ids
    made |= {event.id for event in made_gestures} | {event.id for event in made_expressions}
    return orphans(corrections, note_ids, made, frame.first_frame_s)


def _by_start(problems: tuple[tuple[Problem, ...], ...]) -> tuple[Problem, ...]:
    return tuple(sorted(chain(*problems), key=lambda problem: problem.start_s))


AMONG_OTHERS: Final = StepTable(
    cues=_cues_of,
    answered=_answered,
    places=_seen,
    after_hold=reading(after_holds, held="fermatas"),
    met=reading(compared_with_others, line="shared_line"),
    shared=reading(shared_with, line="shared_line"),
)
"""Steps of a player's plan that depend on the others' plans."""
BY_MUSIC: Final[dict[str, Callable[..., object] | StepInputs]] = {
    "sways": sways,
    "weight_shifts": reading(weight_shifts, times="rhythm"),
    "leans": reading(leans, found="phrases"),
    "accents": accents,
    "bell_heights": bell_heights,
    "lowered": reading(lowered_spans, times="rhythm", cues="all_cues"),
    "answering_nods": reading(answering_nods, times="rhythm"),
    "in_long_rests": reading(in_long_rests, times="rhythm"),
    "holding_at_end": reading(holding_at_end, times="rhythm"),
    "after_the_end": _after_the_end,
    "footwork": reading(footwork, times="rhythm", found="phrases", shifts="weight_shifts"),
}
"""Steps of `PLAYER` that make gestures (`app.plan.kinds.GESTURES`) from the music and may depend on one another."""
PLAYER: Final = StepTable(
    clock="piece.clock",
    rhythm="times.rhythm",
    contour="times.contour",
    own_seed="parameters.seed",
    seeds=_seeds,
    # Fingering
    pins=_pins,
    written_fingerings="written.fingerings",
    planned_fingerings=reading(plan_fingerings, stopped="stopped", written="written_fingerings"),
    fingerings="planned_fingerings.events",
    fingering_problems="planned_fingerings.problems",
    mutes=plan_mutes,
    # Breath and tonguing
    envelope=_envelope,
    air="instrument.air",
    breath_parameters=partial(parameters_deciding, kind="breaths"),
    breath_corrections=partial(of_kinds, kinds=(SetBreath, RemoveEvent, SetCue)),
    bare_notes=without_sound,
    planned_breaths=reading(
        plan_breaths,
        notes="bare_notes",
        times="contour",
        parameters="breath_parameters",
        corrections="breath_corrections",
        written="written",
    ),
    breaths="planned_breaths.events",
    breath_problems="planned_breaths.problems",
    early_end_s="planned_breaths.early_end_s",
    catches="planned_breaths.catches",
    left_out="planned_breaths.left_out",
    tongues=reading(plan_tongues, written="written"),
    embouchure_tension="parameters.embouchure_tension",
    embouchure_corrections=partial(of_kinds, kinds=(SetEmbouchure,)),
    from_breath=_from_breath,
    made_embouchures=plan_embouchures,
    embouchures=reading(correct_embouchures, events="made_embouchures", corrections="embouchure_corrections"),
    lip_input=_lip_input,
    recorded=_is_recorded,
    traces=reading(plan_traces, corrections="embouchure_corrections", controller="lip_input", recorded="recorded"),
    own_breathed=reading(breathed_of, line="shared_line", caught="catches", events="breaths"),
    # Expressiveness
    acting=acting_of,
    stillness="acting.stillness",
    tap="acting.tap",
    gaze="acting.gaze",
    style_regions=partial(of_kinds, kinds=(PlayStyle,)),
    planned_styles=reading(
        plan_styles, corrections="style_regions", usual="acting", known="styles_known", player="name"
    ),
    styles="planned_styles.events",
    style_problems="planned_styles.problems",
    dynamics=dynamics_of,
    # Body
    all_cues=_joined,
    swings=reading(swings_of, times="rhythm", styles="styles"),
    phrases=reading(phrases, times="rhythm"),
    **BY_MUSIC,
    gestures_by_music=reading(in_order, kinds=tuple(BY_MUSIC)),
    # Results of rules
    own_habits="parameters.habits",
    habits=reading(names_in, text="own_habits"),
    usual_style="parameters.style",
    lowered_s=reading(lowered_spans_s, gestures="gestures_by_music"),
    facts=reading(facts_of, embouchures="embouchures"),
    ruled=plan_by_rules,
    ruled_gestures="ruled.gestures",
    ruled_expressions="ruled.expressions",
    rule_problems="ruled.problems",
    # Results of the animator's corrections
    made_gestures=reading(with_ruled, made="gestures_by_music", ruled="ruled_gestures"),
    gesture_corrections=partial(of_kinds, kinds=(ChangeGesture, AddGesture, RemoveEvent, SetBreath, SetCue)),
    corrected_gestures=reading(correct_gestures, events="made_gestures", corrections="gesture_corrections"),
    allowed_gestures=reading(without_overruled, events="corrected_gestures"),
    posing=partial(parameters_deciding, kind="poses"),
    defined=reading(
        with_definitions,
        events="allowed_gestures",
        definitions="known_gestures",
        parameters="posing",
        lowered="lowered_s",
    ),
    defined_gestures="defined.gestures",
    definition_problems="defined.problems",
    gestures=reading(without_idle_hands, events="defined_gestures"),
    # Eyes and face
    looking=_looking,
    looks_up=reading(looks_up, amount="gaze"),
    glances=reading(glances_of, cues="all_cues", gestures="looking", up="looks_up"),
    ending=_ending,
    at_moments=plan_moments,
    neutral=_neutral,
    made_expressions=reading(all_shown, at_notes="ruled_expressions"),
    expression_corrections=partial(of_kinds, kinds=(ChangeExpression, AddExpression, RemoveEvent, SetBreath, SetCue)),
    corrected_expressions=reading(correct_expressions, events="made_expressions", corrections="expression_corrections"),
    expressions=reading(without_overruled, events="corrected_expressions"),
    # Poses set by hand
    pose_corrections=partial(of_kinds, kinds=(PoseCorrection,)),
    planned_poses=reading(plan_poses, corrections="pose_corrections", parameters="posing"),
    poses="planned_poses.events",
    pose_problems="planned_poses.problems",
    curve_corrections=partial(of_kinds, kinds=(AdditiveCurve,)),
    planned_additive=reading(plan_additive, corrections="curve_corrections", parameters="posing"),
    additive="planned_additive.events",
    additive_problems="planned_additive.problems",
    # Collected plan
    note_ids=_note_ids,
    lost=_lost,
    problems=reading(
        _by_start,
        problems=(
            "fingering_problems",
            "breath_problems",
            "pose_problems",
            "additive_problems",
            "reported",
            "lost",
            "rule_problems",
            "definition_problems",
            "style_problems",
        ),
    ),
    plan=reading(
        PlayerPlan,
        time_frame="frame",
        poses="poses",
        additive="additive",
        traces="traces",
        glances="glances",
        styles="styles",
        mutes="mutes",
    ),
)
"""Steps of a player's plan, from the line's fields and times, `AMONG_OTHERS`, and values shared by all players."""
