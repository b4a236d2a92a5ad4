"""From lines to plans: the ensemble's time frame, its leader and cues, then every player by pure functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import msgspec

from app.errors import Cancelled
from app.plan.bar_phase import with_felt_bars
from app.plan.breath import breath_inputs, plan_breaths
from app.plan.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
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
from app.plan.cue import cue_inputs, entries, plan_cues
from app.plan.dynamics import dynamics_of
from app.plan.embouchure import plan_embouchures, plan_tongues
from app.plan.ending import Ending, ending_of
from app.plan.expression import SMILE_ID, plan_expressions
from app.plan.fingering import plan_fingerings
from app.plan.gesture import Pulse, plan_gestures, pulse
from app.plan.heard import blown
from app.plan.line import Line, LineTimes, Piece, Seeds, line_times
from app.plan.memo import Memo
from app.plan.model import Clock, CueEvent, PlayerPlan, Problem, TimeFrame
from app.plan.pose import plan_poses
from app.plan.stagger import Breathed, Shared, SharedLine, breathed_of, shared_line, shared_with
from app.plan.together import one_at_a_time
from app.plan.traces import plan_traces
from metadata.load import load_expressions
from metadata.model import Expression

__all__ = ["EnsemblePlan", "Line", "Piece", "make_plans", "plan_ensemble", "time_frame"]

BREATH_PARAMETERS = (
    "breath_min_beats",
    "breath_last_beat_beats",
    "breath_prepare_beats",
    "breath_need",
    "lung_s",
    "circular_breathing",
)
"""Parameters that the breaths look at."""

PREROLL_BEATS = 4.0
PREROLL_LEAST_S = 2.0
AFTER_LAST_S = 2.0


def time_frame(
    lines: tuple[Line, ...], clock: Clock, preroll_beats: float = PREROLL_BEATS, beat_ticks: int | None = None
) -> TimeFrame:
    """The performance's span: a pre-roll of some beats, at least 2 s, before the first note of all lines, to 2 s
    after the last. Times before the first tick are negative. Without any note: around tick 0.

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
    clock: Clock,
    preroll_beats: float = PREROLL_BEATS,
    beat_ticks: int | None = None,
) -> TimeFrame:
    """The same of a piece that sounds from one tick to another."""
    preroll = preroll_beats * (beat_ticks or clock.ticks_per_quarter)
    first_s = clock.seconds(float(first_tick))
    start_s = min(clock.seconds(first_tick - preroll), first_s - PREROLL_LEAST_S)
    return TimeFrame(start_s, clock.seconds(float(last_tick)) + AFTER_LAST_S)


@dataclass(frozen=True, eq=False)
class EnsemblePlan:
    """The plans of an ensemble, and how they were made.

    Attributes
    ----------
    plans : dict of str to PlayerPlan
        By player id.
    shared : Memo
        Steps that concern everybody.
    own : dict of str to Memo
        Steps of single players.
    """

    plans: dict[str, PlayerPlan]
    shared: Memo
    own: dict[str, Memo]


def make_plans(
    piece: Piece,
    lines: tuple[Line, ...],
    frame: TimeFrame,
    seed: int = 0,
    expressions: Mapping[str, Expression] | None = None,
) -> dict[str, PlayerPlan]:
    """Plan every line of the ensemble, in order; see `plan_ensemble`."""
    return plan_ensemble(piece, lines, frame, seed, expressions).plans


def plan_ensemble(
    piece: Piece,
    lines: tuple[Line, ...],
    frame: TimeFrame,
    seed: int = 0,
    expressions: Mapping[str, Expression] | None = None,
    before: EnsemblePlan | None = None,
    stop_wanted: Callable[[], bool] = lambda: False,
    progress: Callable[[float], None] = lambda share: None,
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
    stop_wanted, progress : callable
        Asked, and told the share that is done, between two players.

    Raises
    ------
    Cancelled
        ``stop_wanted`` said so.
    """
    faces = load_expressions() if expressions is None else expressions
    shared = Memo(None if before is None else before.shared)
    own = {line.player_id: Memo(None if before is None else before.own.get(line.player_id)) for line in lines}
    playable: list[tuple[Line, LineTimes, tuple[Problem, ...]]] = []
    for line in lines:
        _go_on(stop_wanted)
        playable.append(_playable(line, piece.clock, tuple(faces), frame.first_frame_s, own[line.player_id]))
    lines, all_times = tuple(line for line, _, _ in playable), tuple(times for _, times, _ in playable)
    piece = shared.step("felt bars", lambda: with_felt_bars(piece, all_times), piece, all_times)
    rhythms = tuple(times.rhythm for times in all_times)
    persons = tuple(line.person or line.player_id for line in lines)
    found = shared.step("entries", lambda: entries(all_times, piece, persons), rhythms, piece, persons)
    cues, cue_ids = shared.step(
        "cues",
        lambda: plan_cues(found, lines, all_times, piece, frame),
        found,
        cue_inputs(lines),
        all_times,
        piece,
        frame,
    )
    first_s = min((float(times.onset_s[0]) for times in all_times if len(times.onset_s)), default=0.0)
    beat = shared.step("pulse", lambda: pulse(piece, frame, first_s), piece, frame, first_s)
    ending = shared.step("ending", lambda: ending_of(all_times, piece), all_times, piece)
    together = [
        own[line.player_id].step("shared line", lambda times=times: shared_line(times, piece), times, piece)  # type: ignore[misc]
        for line, times, _ in playable
    ]
    breathed: list[Breathed] = []
    plans = {}
    for done, (line, times, problems) in enumerate(playable):
        _go_on(stop_wanted)
        this = together[done]
        others = [*together[:done], *together[done + 1 :]]
        shared_breaths = shared_with(this, others, breathed)
        memo = own[line.player_id]
        own_cues = memo.step("cues", lambda line=line: _cues_of(cues, line.player_id), cues)  # type: ignore[misc]
        given = _Given(
            piece, line, times, frame, own_cues, cue_ids, this, shared_breaths, seed, beat, ending, problems, faces
        )
        plan, breaths = memo.step("plan", lambda given=given, memo=memo: _plan_line(given, memo), *given)  # type: ignore[misc]
        plans[line.player_id] = plan
        breathed.append(breaths)
        progress((done + 1) / len(playable))
    for steps in (shared, *own.values()):
        steps.close()
    return EnsemblePlan(plans, shared, own)


def _cues_of(cues: tuple[CueEvent, ...], player_id: str) -> tuple[CueEvent, ...]:
    return tuple(cue for cue in cues if cue.player_id == player_id)


def _go_on(stop_wanted: Callable[[], bool]) -> None:
    if stop_wanted():
        raise Cancelled("work.stopped")


def _playable(
    line: Line, clock: Clock, faces: tuple[str, ...], at_s: float, memo: Memo
) -> tuple[Line, LineTimes, tuple[Problem, ...]]:
    """A line as it can be played, with its times, and what to tell of the rest."""
    sound, unsound = memo.step(
        "sound", lambda: sound_corrections(line.corrections, faces, at_s), line.corrections, faces, at_s
    )
    bare = Line(line.player_id, line.notes, line.instrument_map, loudness=line.loudness)
    single, told = memo.step("single", lambda: one_at_a_time(bare, clock), line.notes, line.loudness, clock)
    notes, loudness = single.notes, single.loudness
    times = memo.step("times", lambda: line_times(single, clock), notes, loudness, clock)
    line = memo.step(
        "playable",
        lambda: msgspec.structs.replace(line, notes=notes, loudness=loudness, corrections=sound),
        line,
        notes,
        loudness,
        sound,
    )
    return line, times, unsound + told


class _Given(NamedTuple):
    """What one player's plan is made from."""

    piece: Piece
    line: Line
    times: LineTimes
    frame: TimeFrame
    cues: tuple[CueEvent, ...]
    cue_ids: frozenset[str]
    shared_line: SharedLine
    shared: Shared
    seed: int
    pulse: Pulse
    ending: Ending
    told: tuple[Problem, ...]
    faces: Mapping[str, Expression]


def _plan_line(given: _Given, memo: Memo) -> tuple[PlayerPlan, Breathed]:
    """One player's plan, and where the player breathes."""
    piece, line, times, frame = given.piece, given.line, given.times, given.frame
    notes, instrument, parameters = line.notes, line.instrument_map, line.parameters
    corrections, clock = line.corrections, piece.clock
    varied = tuple((item.start_tick, item.end_tick, item.seed) for item in corrections if isinstance(item, Vary))
    seeds = Seeds((given.seed, parameters.seed, line.player_id), varied)
    sound = (notes, times)

    def of(*kinds: type[Correction]) -> tuple[Correction, ...]:
        return tuple(item for item in corrections if isinstance(item, kinds))

    pins = {item.note_id: item.label for item in corrections if isinstance(item, PinFingering)}
    fingerings, fingering_problems = memo.step(
        "fingerings", lambda: plan_fingerings(notes, times, instrument, pins), *sound, instrument, pins
    )
    steps = None if line.heard is None else line.heard.breath
    heard = None if steps is None else memo.step("blown", lambda: blown(steps, clock), steps, clock)
    shared = given.shared
    breaths = memo.step(
        "breaths",
        lambda: plan_breaths(notes, times, piece, parameters, frame, corrections, shared, seeds, instrument.air, heard),
        *breath_inputs(notes, times),
        piece,
        instrument.air,
        tuple(getattr(parameters, name) for name in BREATH_PARAMETERS),
        frame,
        of(SetBreath, RemoveEvent, SetCue),
        shared,
        seeds,
        heard,
    )
    events, early_end_s = breaths.events, breaths.early_end_s
    embouchures = memo.step(
        "embouchures",
        lambda: correct_embouchures(
            plan_embouchures(notes, times, instrument, parameters, early_end_s, steps is not None), corrections
        ),
        *sound,
        instrument,
        parameters.embouchure_tension,
        early_end_s,
        of(SetEmbouchure),
        steps is not None,
    )
    traces = memo.step(
        "traces",
        lambda: plan_traces(notes, times, clock, instrument, parameters, line.heard, heard, corrections),
        *sound,
        clock,
        instrument,
        parameters.embouchure_tension,
        line.heard,
        heard,
        of(SetEmbouchure),
    )
    dynamics = memo.step("dynamics", lambda: dynamics_of(times, heard), times, heard)
    made_gestures = plan_gestures(notes, times, piece, frame, events, given.cues, seeds, given.pulse, dynamics, memo)
    moved = of(ChangeGesture, AddGesture, RemoveEvent, SetBreath, SetCue)
    gestures = memo.step(
        "corrected gestures",
        lambda: correct_gestures(made_gestures, corrections, clock),
        made_gestures,
        moved,
        clock,
    )
    # Who corrected the smile after the last note keeps it, whatever the ending is.
    named = any(item.event_id == SMILE_ID for item in corrections if isinstance(item, ChangeExpression | RemoveEvent))
    ending = msgspec.structs.replace(given.ending, bright=True) if named else given.ending
    made_expressions = memo.step(
        "expressions",
        lambda: plan_expressions(
            notes, times, clock, instrument, frame, embouchures, events, given.cues, gestures, ending, given.faces
        ),
        *sound,
        clock,
        instrument,
        frame,
        embouchures,
        events,
        given.cues,
        gestures,
        ending,
        given.faces,
    )
    faced = of(ChangeExpression, AddExpression, RemoveEvent, SetBreath, SetCue)
    expressions = memo.step(
        "corrected expressions",
        lambda: correct_expressions(made_expressions, corrections, clock),
        made_expressions,
        faced,
        clock,
    )
    tongues = memo.step(
        "tongues", lambda: plan_tongues(notes, times, instrument, fingerings), *sound, instrument, fingerings
    )
    poses, pose_problems = memo.step(
        "poses",
        lambda: plan_poses(corrections, instrument, parameters, clock),
        of(PoseCorrection),
        instrument,
        parameters.posture,
        clock,
    )
    lost = memo.step(
        "lost",
        lambda: orphans(
            corrections,
            frozenset(note.id for note in notes),
            breaths.generated_ids
            | given.cue_ids
            | {event.id for event in made_gestures}
            | {event.id for event in made_expressions},
            frame.first_frame_s,
        ),
        corrections,
        notes,
        breaths.generated_ids,
        given.cue_ids,
        made_gestures,
        made_expressions,
        frame.first_frame_s,
    )
    problems = (*fingering_problems, *breaths.problems, *pose_problems, *given.told, *lost)
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
        traces=traces,
    )
    return plan, breathed_of(given.shared_line, notes, breaths.catch_notes, events)
