"""From lines to plans: the ensemble's time frame, its leader and cues, then every player by pure functions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import msgspec

from app.errors import raise_if_stopped
from app.plan.acting import acting_of
from app.plan.additive import plan_additive
from app.plan.additive_curve import AdditiveCurve
from app.plan.bar_phase import lowest, with_felt_bars
from app.plan.breath import plan_breaths
from app.plan.breath_envelope import blown
from app.plan.conducted import looks_up
from app.plan.corrections import (
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
    correct_embouchures,
    correct_expressions,
    correct_gestures,
    orphans,
    sound_corrections,
)
from app.plan.cue import plan_cues
from app.plan.dynamics import dynamics_of
from app.plan.embouchure import plan_embouchures
from app.plan.ending import Ending, ending_of
from app.plan.entries import entries
from app.plan.expression import SMILE_ID, all_shown, neutral_face
from app.plan.fermatas import fermatas
from app.plan.fingering import plan_fingerings
from app.plan.gesture import Pulse, plan_gestures, pulse
from app.plan.glances import StagePlace, glances_of
from app.plan.line import LineTimes, MonophonicPart, Piece, Seeds, note_times, without_sound
from app.plan.memo import Memo
from app.plan.model import CONDUCTOR, CueEvent, ExpressionEvent, GestureEvent, PlayerPlan, Problem, TimeFrame
from app.plan.moments import Around, plan_moments
from app.plan.muting import plan_mutes
from app.plan.named_gestures import undisturbed, with_definitions
from app.plan.parameters import restricted
from app.plan.pose import plan_poses
from app.plan.rules import lowered_spans_s, plan_by_rules, with_ruled, without_overruled
from app.plan.stagger import Breathed, Shared, SharedLine, after_holds, breathed_of, shared_line, shared_with
from app.plan.styles import plan_styles
from app.plan.together import one_at_a_time
from app.plan.tonguing import plan_tongues
from app.plan.traces import plan_traces
from app.score.model import Note
from app.score.tempo import TempoMap
from metadata.gestures import Gesture
from metadata.library import bundled_gestures, bundled_rules
from metadata.load import load_expressions
from metadata.model import Expression
from metadata.rules import Rule

__all__ = ["EnsemblePlan", "MonophonicPart", "Piece", "make_plans", "plan_ensemble", "time_frame"]

PREROLL_BEATS = 4.0
PREROLL_LEAST_S = 2.0
COME_UP_S = 3.0
"""A new piece begins so long before the first note at least: time to be seen at rest, and to come up from it."""
MOST_PREROLL_BEATS = 32
AFTER_LAST_S = 6.0
"""Time to hold still, lower the instrument, look up and bow."""


def time_frame(
    lines: tuple[MonophonicPart, ...],
    clock: TempoMap,
    preroll_beats: float = PREROLL_BEATS,
    beat_ticks: int | None = None,
) -> TimeFrame:
    """The performance's span: a pre-roll of some beats, at least 2 s, before the first note of all lines, to
    `AFTER_LAST_S` after the last. Times before the first tick are negative. Without any note: around tick 0.

    Parameters
    ----------
    beat_ticks : int or None
        The felt beat; None is a quarter.
    """
    first = min((line.notes[0].onset_tick for line in lines if line.notes), default=0)
    last = max((note.onset_tick + note.duration_tick for line in lines for note in line.notes), default=0)
    return frame_around(first, last, clock, preroll_beats, beat_ticks)


def frame_around(
    first_tick: int,
    last_tick: int,
    clock: TempoMap,
    preroll_beats: float = PREROLL_BEATS,
    beat_ticks: int | None = None,
) -> TimeFrame:
    """The same of a piece that sounds from one tick to another."""
    preroll = preroll_beats * (beat_ticks or clock.ticks_per_quarter)
    first_s = clock.seconds(float(first_tick))
    start_s = min(clock.seconds(first_tick - preroll), first_s - PREROLL_LEAST_S)
    return TimeFrame(start_s, clock.seconds(float(last_tick)) + AFTER_LAST_S)


def usual_preroll(beat_s: float) -> float:
    """Felt beats before the first note of a new piece, by the length of a beat: a bar of four, or whole beats enough to
    come up from rest."""
    return max(PREROLL_BEATS, float(min(math.ceil(COME_UP_S / beat_s - 1e-6), MOST_PREROLL_BEATS)))


@dataclass(frozen=True, eq=False)
class EnsemblePlan:
    """The plans of an ensemble, and how they were made.

    Attributes
    ----------
    plans : dict of str to PlayerPlan
        By player id.
    shared : Memo
        Steps that concern all players.
    own : dict of str to Memo
        Steps of single players.
    """

    plans: dict[str, PlayerPlan]
    shared: Memo
    own: dict[str, Memo]


def make_plans(
    piece: Piece,
    lines: tuple[MonophonicPart, ...],
    frame: TimeFrame,
    seed: int = 0,
    expressions: Mapping[str, Expression] | None = None,
) -> dict[str, PlayerPlan]:
    """Plan every line of the ensemble, in order; see `plan_ensemble`."""
    return plan_ensemble(piece, lines, frame, seed, expressions).plans


def plan_ensemble(
    piece: Piece,
    lines: tuple[MonophonicPart, ...],
    frame: TimeFrame,
    seed: int = 0,
    expressions: Mapping[str, Expression] | None = None,
    before: EnsemblePlan | None = None,
    stop_requested: Callable[[], bool] = lambda: False,
    progress: Callable[[float], None] = lambda share: None,
    places: Mapping[str, StagePlace] | None = None,
    rules: tuple[Rule, ...] | None = None,
    gestures: Mapping[str, Gesture] | None = None,
) -> EnsemblePlan:
    """Plan every line of the ensemble, in order.

    Parameters
    ----------
    frame : TimeFrame
        From `time_frame` (or a longer one).
    seed : int
        Of the whole performance; players and score positions are added to it.
    expressions : mapping of str to Expression, optional
        What may be named; at least the bundled ones, which are the default.
    before : EnsemblePlan, optional
        Of the same ensemble before an edit: what has not changed is taken from there, to the object.
    stop_requested, progress : callable
        Asked, and called with the share that is done, between two players.
    places : mapping of str to StagePlace, optional
        Where each player stands, and under `CONDUCTOR` who gives the entries; who has no place looks at no one.
    rules : tuple of Rule, optional
        What players show and do by rules; the bundled ones by default.
    gestures : mapping of str to Gesture, optional
        What rules and the animator may name; the bundled ones by default.

    Raises
    ------
    Cancelled
        ``stop_requested`` said so.
    """
    faces = load_expressions() if expressions is None else expressions
    ruling = bundled_rules() if rules is None else rules
    named = bundled_gestures() if gestures is None else gestures
    shared = Memo(None if before is None else before.shared)
    own = {line.player_id: Memo(None if before is None else before.own.get(line.player_id)) for line in lines}
    playable: list[tuple[MonophonicPart, LineTimes, tuple[Problem, ...]]] = []
    for line in lines:
        raise_if_stopped(stop_requested)
        playable.append(_playable(line, piece.clock, tuple(faces), frame.first_frame_s, own[line.player_id]))
    lines, all_times = tuple(line for line, _, _ in playable), tuple(times for _, times, _ in playable)
    rhythms = tuple(times.rhythm for times in all_times)
    piece = shared.step("felt bars", with_felt_bars, piece, rhythms, lowest(all_times))
    musicians = tuple(line.musician or line.player_id for line in lines)
    found = shared.step("entries", entries, rhythms, piece, musicians)
    leading = tuple(_leading(line) for line in lines)
    conducted = places is not None and CONDUCTOR in places
    held = shared.step("fermatas", fermatas, rhythms, piece)
    cues, cue_ids = shared.step("cues", plan_cues, found, leading, all_times, piece, frame, conducted)
    first_s = min((float(times.onset_s[0]) for times in all_times if len(times.onset_s)), default=0.0)
    beat = shared.step("pulse", pulse, piece, frame, first_s)
    ending = shared.step("ending", ending_of, all_times, piece)
    last_s = max((float(times.played_end_s.max()) for times in all_times if len(times.onset_s)), default=0.0)
    together = [own[line.player_id].step("shared line", shared_line, times, piece) for line, times, _ in playable]
    breathed: list[Breathed] = []
    plans = {}
    for done, (line, times, problems) in enumerate(playable):
        raise_if_stopped(stop_requested)
        this = together[done]
        others = (*together[:done], *together[done + 1 :])
        memo = own[line.player_id]
        shared_breaths = memo.nested("shared", shared_with, this, others, tuple(breathed), after_holds(held, times))
        own_cues = memo.step("cues", _cues_of, cues, line.player_id)
        answered = memo.step("answered", _answered, cues, line.player_id)
        seen = memo.step("seen", _seen, line.player_id, own_cues, answered, {} if places is None else places)
        given = _Given(
            piece, line, times, frame, own_cues, cue_ids, this, shared_breaths, seed, beat, ending, problems, faces,
            answered, last_s, seen, ruling, named, alone=musicians.count(musicians[done]) == 1,
        )  # fmt: skip
        plan, breaths = memo.nested("plan", _plan_line, given)
        plans[line.player_id] = plan
        breathed.append(breaths)
        progress((done + 1) / len(playable))
    for steps in (shared, *own.values()):
        steps.close()
    return EnsemblePlan(plans, shared, own)


def _cues_of(cues: tuple[CueEvent, ...], player_id: str) -> tuple[CueEvent, ...]:
    return tuple(cue for cue in cues if cue.player_id == player_id)


def _answered(cues: tuple[CueEvent, ...], player_id: str) -> tuple[CueEvent, ...]:
    """The cues that a player comes in with."""
    return tuple(cue for cue in cues if player_id in cue.takers)


def _seen(
    player_id: str, own: tuple[CueEvent, ...], answered: tuple[CueEvent, ...], places: Mapping[str, StagePlace]
) -> dict[str, StagePlace]:
    """The places of the player, of the conductor and of those whom the player looks at."""
    others = {cue.player_id for cue in answered} | {taker for cue in own for taker in cue.takers} | {CONDUCTOR}
    return {one: place for one, place in places.items() if one == player_id or one in others}


def _playable(
    line: MonophonicPart, clock: TempoMap, faces: tuple[str, ...], at_s: float, memo: Memo
) -> tuple[MonophonicPart, LineTimes, tuple[Problem, ...]]:
    """A line as it can be played, with its times, and what to report about the rest."""
    sound, unsound = memo.step("sound", sound_corrections, line.corrections, faces, at_s)
    bare = MonophonicPart(line.player_id, line.notes, line.instrument_map, loudness=line.loudness)
    single, reported = memo.step("single", one_at_a_time, bare, clock)
    times = memo.step("times", note_times, single.notes, single.loudness, clock)
    line = memo.step("playable", _with_notes, line, single.notes, single.loudness, sound)
    return line, times, unsound + reported


def _with_notes(
    line: MonophonicPart, notes: tuple[Note, ...], loudness: tuple[float, ...], corrections: tuple[Correction, ...]
) -> MonophonicPart:
    return msgspec.structs.replace(line, notes=notes, loudness=loudness, corrections=corrections)


def _leading(line: MonophonicPart) -> MonophonicPart:
    """The line as far as cues depend on it."""
    corrections = _of(line.corrections, SetCue, RemoveEvent, SetBreath)
    parameters = restricted(line.parameters, "cues")
    return MonophonicPart(
        line.player_id, line.notes, line.instrument_map, parameters, corrections, musician=line.musician
    )


def _of(corrections: tuple[Correction, ...], *kinds: type[Correction]) -> tuple[Correction, ...]:
    """The corrections of some kinds."""
    return tuple(item for item in corrections if isinstance(item, kinds))


class _Given(NamedTuple):
    """What one player's plan is made from."""

    piece: Piece
    line: MonophonicPart
    times: LineTimes
    frame: TimeFrame
    cues: tuple[CueEvent, ...]
    cue_ids: frozenset[str]
    shared_line: SharedLine
    shared: Shared
    seed: int
    pulse: Pulse
    ending: Ending
    reported: tuple[Problem, ...]
    faces: Mapping[str, Expression]
    answered: tuple[CueEvent, ...]
    last_s: float
    seen: Mapping[str, StagePlace]
    rules: tuple[Rule, ...]
    named: Mapping[str, Gesture]
    alone: bool


def _plan_line(memo: Memo, given: _Given) -> tuple[PlayerPlan, Breathed]:
    """One player's plan, and where the player breathes."""
    piece, line, times, frame = given.piece, given.line, given.times, given.frame
    notes, instrument, parameters = line.notes, line.instrument_map, line.parameters
    corrections, clock = line.corrections, piece.clock
    varied = tuple((item.start_tick, item.end_tick, item.seed) for item in corrections if isinstance(item, Vary))
    seeds = Seeds((given.seed, parameters.seed, line.player_id), varied)
    pins = {item.note_id: item.label for item in corrections if isinstance(item, PinFingering)}
    fingerings, fingering_problems = memo.step(
        "fingerings", plan_fingerings, notes, times, instrument, pins, line.stopped
    )
    mutes = memo.step("mutes", plan_mutes, notes, line.muted, line.stopped, instrument, clock)
    steps = None if line.controller is None else line.controller.breath
    envelope = None if steps is None else memo.step("blown", blown, steps, clock)
    breaths = memo.step(
        "breaths",
        plan_breaths,
        memo.step("without sound", without_sound, notes),
        times.contour,
        piece,
        restricted(parameters, "breaths"),
        frame,
        _of(corrections, SetBreath, RemoveEvent, SetCue),
        given.shared,
        seeds,
        instrument.air,
        envelope,
    )
    events = breaths.events
    lips, by_hand = restricted(parameters, "lips"), _of(corrections, SetEmbouchure)
    made_lips = memo.step(
        "made embouchures", plan_embouchures, notes, times, instrument, lips, breaths.early_end_s, steps is not None
    )
    embouchures = memo.step("embouchures", correct_embouchures, made_lips, by_hand)
    traces = memo.step("traces", plan_traces, notes, times, clock, instrument, lips, line.controller, envelope, by_hand)
    dynamics = memo.step("dynamics", dynamics_of, times, envelope)
    usual, styled = acting_of(parameters), _of(corrections, PlayStyle)
    styles, style_problems = memo.step(
        "styles", plan_styles, styled, line.actings, usual, line.styles_known, line.name, clock
    )
    made_gestures = plan_gestures(
        notes,
        times,
        piece,
        frame,
        events,
        given.cues,
        seeds,
        given.pulse,
        dynamics,
        memo,
        usual,
        styles,
        given.alone,
        answered=given.answered,
        last_s=given.last_s,
    )
    lowered = memo.step("lowered spans", lowered_spans_s, made_gestures)
    ruled = memo.step(
        "rules",
        plan_by_rules,
        notes,
        times,
        piece,
        frame,
        instrument,
        restricted(parameters, "rules"),
        styles,
        dynamics,
        lowered,
        seeds,
        given.rules,
        given.faces,
        given.named,
        embouchures,
    )
    made_gestures = memo.step("gestures and rules", with_ruled, made_gestures, ruled.gestures)
    moved = _of(corrections, ChangeGesture, AddGesture, RemoveEvent, SetBreath, SetCue)
    corrected = memo.step("corrected gestures", correct_gestures, made_gestures, moved, clock)
    corrected = memo.step("gestures by hand", without_overruled, corrected)
    held = restricted(parameters, "poses")
    defined = memo.step("named gestures", with_definitions, corrected, given.named, instrument, held, times, lowered)
    gestures = memo.step("undisturbed", undisturbed, defined.gestures)
    looked = memo.step("looked at", _looking, gestures)
    gaze = acting_of(parameters).gaze
    up = memo.step("looks up", looks_up, line.player_id, times, piece, frame, given.last_s, given.seen, gaze, seeds)
    cued = given.cues + given.answered
    glances = memo.step("glances", glances_of, line.player_id, cued, looked, given.seen, seeds, up)
    # Who corrected the smile after the last note keeps it, whatever the ending is.
    named = any(item.event_id == SMILE_ID for item in corrections if isinstance(item, ChangeExpression | RemoveEvent))
    ending = msgspec.structs.replace(given.ending, bright=True) if named else given.ending
    at_moments = memo.step(
        "moments",
        plan_moments,
        notes,
        times,
        piece,
        frame,
        instrument,
        restricted(parameters, "rules"),
        dynamics,
        seeds,
        given.rules,
        given.faces,
        embouchures,
        Around(events, given.cues, gestures, ending, styles),
    )
    neutral = memo.step("neutral", neutral_face, clock, frame, given.faces["neutral"])
    made_expressions = memo.step("expressions", all_shown, neutral, at_moments, ruled.expressions)
    faced = _of(corrections, ChangeExpression, AddExpression, RemoveEvent, SetBreath, SetCue)
    expressions = memo.step("corrected expressions", correct_expressions, made_expressions, faced, clock)
    expressions = memo.step("expressions by hand", without_overruled, expressions)
    tongues = memo.step("tongues", plan_tongues, notes, times, instrument, fingerings, piece, seeds)
    posed = _of(corrections, PoseCorrection)
    poses, pose_problems = memo.step("poses", plan_poses, posed, instrument, restricted(parameters, "poses"), clock)
    keyed = _of(corrections, AdditiveCurve)
    additive, key_problems = memo.step(
        "additive", plan_additive, keyed, instrument, restricted(parameters, "poses"), clock
    )
    lost = memo.step(
        "lost",
        _lost,
        corrections,
        notes,
        breaths.generated_ids | given.cue_ids,
        made_gestures,
        made_expressions,
        frame.first_frame_s,
    )
    problems = (
        *(*fingering_problems, *breaths.problems, *pose_problems, *key_problems, *given.reported, *lost),
        *(*ruled.problems, *defined.problems, *style_problems),
    )
    plan = PlayerPlan(
        player_id=line.player_id,
        time_frame=frame,
        fingerings=fingerings,
        breaths=events,
        tongues=tongues,
        embouchures=embouchures,
        cues=given.cues,
        gestures=gestures,
        expressions=expressions,
        problems=tuple(sorted(problems, key=lambda problem: problem.start_s)),
        poses=poses,
        additive=additive,
        traces=traces,
        glances=glances,
        styles=styles,
        mutes=mutes,
    )
    return plan, breathed_of(given.shared_line, notes, breaths.catches, breaths.left_out, events)


def _looking(gestures: tuple[GestureEvent, ...]) -> tuple[GestureEvent, ...]:
    """The gestures that eyes depend on."""
    kinds = ("lower_instrument", "look_about", "look_up")
    return tuple(
        event
        for event in gestures
        if event.kind in kinds or (event.gesture is not None and event.gesture.gaze is not None)
    )


def _lost(
    corrections: tuple[Correction, ...],
    notes: tuple[Note, ...],
    ids: frozenset[str],
    gestures: tuple[GestureEvent, ...],
    expressions: tuple[ExpressionEvent, ...],
    at_s: float,
) -> tuple[Problem, ...]:
    """A problem for every correction of what is not there; ``ids`` are those of breaths and cues."""
    made = ids | {event.id for event in gestures} | {event.id for event in expressions}
    return orphans(corrections, frozenset(note.id for note in notes), made, at_s)
