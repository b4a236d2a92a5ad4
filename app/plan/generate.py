"""From lines to plans: the ensemble's time frame, its leader and cues, then every player by pure functions."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from app.plan.breath import BreathPlan, plan_breaths
from app.plan.corrections import (
    Correction,
    PinFingering,
    correct_embouchures,
    correct_expressions,
    correct_gestures,
    orphans,
    sound_corrections,
)
from app.plan.cue import plan_cues
from app.plan.embouchure import plan_embouchures, plan_tongues
from app.plan.expression import plan_expressions
from app.plan.fingering import plan_fingerings
from app.plan.gesture import plan_gestures
from app.plan.line import Line, LineTimes, Piece, line_times
from app.plan.model import Clock, CueEvent, PlayerPlan, Problem, TimeFrame
from app.plan.together import one_at_a_time
from metadata.load import load_expressions
from metadata.model import Expression

__all__ = ["Line", "Piece", "make_plans", "time_frame"]

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
    preroll = preroll_beats * (beat_ticks or clock.ticks_per_quarter)
    first_s = clock.seconds(float(first))
    start_s = min(clock.seconds(first - preroll), first_s - PREROLL_LEAST_S)
    return TimeFrame(start_s, clock.seconds(float(last)) + AFTER_LAST_S)


def make_plans(
    piece: Piece,
    lines: tuple[Line, ...],
    frame: TimeFrame,
    seed: int = 0,
    expressions: Mapping[str, Expression] | None = None,
) -> dict[str, PlayerPlan]:
    """Plan every line of the ensemble, in order.

    Parameters
    ----------
    frame : TimeFrame
        From `time_frame` (or a longer one).
    seed : int
        Of the whole performance; players and score positions are added to it.
    expressions : mapping of str to Expression, optional
        What may be named; at least the bundled ones, which are the default.

    Returns
    -------
    dict of str to PlayerPlan
        By player id.
    """
    faces = load_expressions() if expressions is None else expressions
    checked = [sound_corrections(line.corrections, tuple(faces), frame.first_frame_s) for line in lines]
    singles = [
        one_at_a_time(msgspec.structs.replace(line, corrections=sound), piece.clock)
        for line, (sound, _) in zip(lines, checked, strict=True)
    ]
    lines = tuple(line for line, _ in singles)
    all_times = tuple(line_times(line, piece.clock) for line in lines)
    cues, cue_ids = plan_cues(lines, all_times, piece, frame)
    first_s = min((float(times.onset_s[0]) for times in all_times if len(times.onset_s)), default=0.0)
    taken: dict[tuple[tuple[int, int, int], ...], frozenset[tuple[int, int]]] = {}
    plans = {}
    told = [unsound + unplayable for (_, unsound), (_, unplayable) in zip(checked, singles, strict=True)]
    for line, times, problems in zip(lines, all_times, told, strict=True):
        # Players of one part stagger their catch breaths; the key is what they play.
        part = tuple(zip(times.onset_tick.tolist(), times.played_end_tick.tolist(), times.pitch.tolist(), strict=True))
        places = taken.get(part, frozenset())
        ids = frozenset(note.id for note in line.notes if (note.onset_tick, note.pitch) in places)
        own_cues = tuple(cue for cue in cues if cue.player_id == line.player_id)
        plan, breaths = _plan_line(piece, line, times, frame, own_cues, cue_ids, ids, seed, first_s, problems, faces)
        plans[line.player_id] = plan
        caught = {(note.onset_tick, note.pitch) for note in line.notes if note.id in breaths.catch_notes}
        taken[part] = places | caught
    return plans


def _plan_line(
    piece: Piece,
    line: Line,
    times: LineTimes,
    frame: TimeFrame,
    cues: tuple[CueEvent, ...],
    cue_ids: frozenset[str],
    taken: frozenset[str],
    seed: int,
    swing_at_s: float,
    unsound: tuple[Problem, ...],
    faces: Mapping[str, Expression],
) -> tuple[PlayerPlan, BreathPlan]:
    notes, instrument, parameters = line.notes, line.instrument_map, line.parameters
    corrections: tuple[Correction, ...] = line.corrections
    seeds = (seed, parameters.seed, line.player_id)
    pins = {item.note_id: item.label for item in corrections if isinstance(item, PinFingering)}
    fingerings, fingering_problems = plan_fingerings(notes, times, instrument, pins)
    breaths = plan_breaths(notes, times, piece, parameters, frame, corrections, taken, seeds)
    embouchures = correct_embouchures(
        plan_embouchures(notes, times, instrument, parameters, breaths.early_end_s), corrections
    )
    made_gestures = plan_gestures(notes, times, piece, frame, breaths.events, cues, seeds, swing_at_s)
    gestures = correct_gestures(made_gestures, corrections, piece.clock)
    made_expressions = plan_expressions(
        notes, times, piece.clock, instrument, frame, embouchures, breaths.events, cues, gestures, faces
    )
    generated = (
        breaths.generated_ids
        | cue_ids
        | {event.id for event in made_gestures}
        | {event.id for event in made_expressions}
    )
    note_ids = frozenset(note.id for note in notes)
    problems = (
        *fingering_problems,
        *breaths.problems,
        *unsound,
        *orphans(corrections, note_ids, generated, frame.first_frame_s),
    )
    plan = PlayerPlan(
        player_id=line.player_id,
        time_frame=frame,
        fingerings=fingerings,
        breaths=breaths.events,
        tongues=plan_tongues(notes, times, instrument, fingerings),
        embouchures=embouchures,
        cues=cues,
        gestures=gestures,
        expressions=correct_expressions(made_expressions, corrections, piece.clock),
        problems=tuple(sorted(problems, key=lambda problem: problem.start_s)),
    )
    return plan, breaths
