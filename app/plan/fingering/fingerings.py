"""Chooses the fingering of every note by a search over the whole part.

The search (Viterbi over the ranked fingerings of every note) keeps the first choice unless speed or a trill justifies
an alternate in spite of its intonation. Afterwards every run of alternates and every phrase is compared with the first
choices, which are used if the run travels further or needs a faster motion.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import msgspec
import numpy as np

from app.arrays import IntArray
from app.errors import Argument, Message
from app.plan.fingering.costs import TOLERANCE, FingeringProblem, fingering_problem
from app.plan.fingering.mutes import stopped_notes
from app.plan.fingering.search import best_path, even_trills, never_worse
from app.plan.model import FingeringEvent, Planned, Problem, Vent
from app.plan.music.piece import LineTimes
from app.plan.music.written_marks import NO_FINGERINGS, WrittenFingerings
from app.score.model import Note
from instrument_maps.model import Fingering, InstrumentMap

GLIDE_AFTER = 0.4
"""Share of a note after which a glissando begins to glide."""
LEAST_HELD_S = 0.1
"""Least seconds of a note with closed vents; a note that would end sooner after its vents are released keeps them
pressed.
"""


def plan_fingerings(
    notes: tuple[Note, ...],
    times: LineTimes,
    instrument: InstrumentMap,
    pins: dict[str, str],
    stopped: tuple[tuple[int, int], ...] = (),
    written: WrittenFingerings = NO_FINGERINGS,
) -> Planned[FingeringEvent]:
    """Choose a fingering for every note.

    Parameters
    ----------
    pins : dict of str to str
        Labels required by corrections, by note id.
    stopped : tuple of (start tick, end tick), optional
        Spans in which the hand stops the bell: notes are fingered as the map defines for stopped notes.
    written : WrittenFingerings, optional
        Fingerings in the score. A correction overrides them, and they override the search.
    """
    if not notes:
        return Planned((), ())
    by_hand = stopped_notes(notes, stopped, instrument)
    problem = fingering_problem(notes, times, instrument, pins, by_hand, written)
    path = never_worse(problem, even_trills(problem, best_path(problem)))
    events = []
    shortest_s, in_trill = _shortest_steps(problem)
    onset_tick, end_tick = times.onset_tick.tolist(), times.played_end_tick.tolist()
    onset_s, end_s = times.onset_s.tolist(), times.played_end_s.tolist()
    chosen = list(zip(problem.pitch_index.tolist(), path.tolist(), strict=True))
    controls = _controls(problem, chosen, instrument)
    glides_s = _glides_s(written.glides if problem.has_slide else (), onset_s)
    for index, (note, (row, column)) in enumerate(zip(notes, chosen, strict=True)):
        ranked = problem.table.choices[row]
        fingering = ranked[column]
        pinned = pins.get(note.id) == fingering.label
        if pinned or problem.in_score.get(index) == column:
            is_own = pinned or any(written.by_hand[index : index + 1])
            reason = _reason("fingering.by_hand" if is_own else "fingering.written", fingering.label)
        elif by_hand[index]:
            reason = _reason("fingering.stopped", fingering.label)
        else:
            reason = _searched(fingering, ranked[0], in_trill[index], shortest_s[index])
        event = FingeringEvent(
            id=f"fingering:{note.id}",
            note_id=note.id,
            start_tick=onset_tick[index],
            end_tick=end_tick[index],
            start_s=onset_s[index],
            end_s=end_s[index],
            label=fingering.label,
            rank=fingering.rank,
            controls=controls[index],
            cents=fingering.cents,
            reason=reason,
            corrected=pinned,
            fingers=fingering.fingers,
            glide_from_s=glides_s.get(index),
        )
        events.append(_vented(event, ranked, instrument) if "attack" in fingering.tags and not pinned else event)
    of_notes = *_out_of_range(notes, times, instrument), *_early_starts(notes, problem, path)
    return Planned(tuple(events), (*_unplayed(notes, events, pins, written, problem), *of_notes))


def _unplayed(
    notes: Sequence[Note],
    events: Sequence[FingeringEvent],
    pins: Mapping[str, str],
    written: WrittenFingerings,
    problem: FingeringProblem,
) -> list[Problem]:
    """Return a problem for every fingering in a correction or in the score that the map lacks."""
    wrong = [
        ("correction.no_such_fingering", index, pins[note.id])
        for index, note in enumerate(notes if pins else ())
        if pins.get(note.id, events[index].label) != events[index].label
    ]
    wrong += [
        ("fingering.not_in_map", index, label)
        for index, label in enumerate(written.label)
        if label and index not in problem.in_score
    ]
    return [
        Problem(Message(id, {"note": notes[index].id, "label": label}), notes[index].id, event.start_s, event.end_s)
        for id, index, label in wrong
        for event in (events[index],)
    ]


def _searched(fingering: Fingering, first_choice: Fingering, in_trill: bool, step_s: float) -> Message:
    """Return the message that explains a fingering chosen by the search; ``step_s`` is the time to the nearer
    neighbouring note in seconds.
    """
    if fingering.rank <= 1:
        return _reason("fingering.first_choice", fingering.label)
    rule = "fingering.trill" if in_trill else "fingering.speed"
    return _reason(rule, fingering.label, (first_choice.label, round(step_s * 1000.0)))


def _glides_s(glides: tuple[bool, ...], onset_s: Sequence[float]) -> dict[int, float]:
    """Time in seconds at which each slide glide starts, by the index of the note it leads to."""
    return {
        index: onset_s[index - 1] + GLIDE_AFTER * (onset_s[index] - onset_s[index - 1])
        for index in range(1, len(onset_s))
        if glides and glides[index - 1]
    }


def _controls(
    problem: FingeringProblem, chosen: Sequence[tuple[int, int]], instrument: InstrumentMap
) -> list[dict[str, float]]:
    """Control values 0..1 of every note, from the fingering chosen for it (pitch row and rank), with tuning corrections
    on long notes.
    """
    held = [
        (control.name, control.held_min_s or 0.0) for control in instrument.controls if control.role == "intonation"
    ]
    lengths_s = (problem.times.played_end_s - problem.times.onset_s).tolist()
    corrected: dict[tuple[int, int, tuple[str, ...]], dict[str, float]] = {}
    result = []
    for (row, column), length_s in zip(chosen, lengths_s, strict=True):
        fingering = problem.table.choices[row][column]
        controls = fingering.controls
        if fingering.correction:
            extra = tuple([name for name, minimum in held if length_s >= minimum and name in fingering.correction])
            if (row, column, extra) not in corrected:
                corrected[row, column, extra] = {**controls, **{name: fingering.correction[name] for name in extra}}
            controls = corrected[row, column, extra]
        result.append(controls)
    return result


@lru_cache(maxsize=1024)
def _reason(rule: str, label: str, instead: tuple[str, int] | None = None) -> Message:
    """Message with the reason of a fingering, cached so that equal reasons share one object. ``instead`` has the label
    of the first choice that was not used, and the available time in milliseconds.
    """
    more: dict[str, Argument] = {} if instead is None else {"first": instead[0], "time_ms": instead[1]}
    return Message(rule, {"label": label, **more})


def _vented(event: FingeringEvent, ranked: Sequence[Fingering], instrument: InstrumentMap) -> FingeringEvent:
    """Return the event with the controls that only help the attack released once the note speaks, if the note is long
    enough; else unchanged.

    Parameters
    ----------
    ranked : sequence of Fingering
        All fingerings of the note.
    instrument : InstrumentMap
        Its controls say for how long they are held at an attack.
    """
    attacks = {control.name: control.attack_s for control in instrument.controls if control.attack_s is not None}
    vents = tuple(name for name in event.controls if name in attacks)
    length_s, open_s = event.end_s - event.start_s, max((attacks[name] for name in vents), default=0.0)
    if not vents or length_s < open_s + LEAST_HELD_S:
        return event
    held = event.controls.keys() - set(vents)
    label = next((fingering.label for fingering in ranked if fingering.controls.keys() == held), event.label)
    end_tick = event.start_tick + round((event.end_tick - event.start_tick) * open_s / length_s)
    return msgspec.structs.replace(event, vent=Vent(vents, end_tick, event.start_s + open_s, label))


def _shortest_steps(problem: FingeringProblem) -> tuple[list[float], list[bool]]:
    """Return for every note the shorter of the times to the notes before and after it, in seconds, and whether it is
    part of a trill."""
    steps = np.diff(problem.times.onset_s)
    if not len(steps):
        return [0.0], [False]
    shortest = np.minimum(np.append(steps, np.inf), np.concatenate(([np.inf], steps)))
    in_trill = np.append(problem.in_trill, False) | np.concatenate(([False], problem.in_trill))
    return shortest.tolist(), in_trill.tolist()


def _out_of_range(notes: tuple[Note, ...], times: LineTimes, instrument: InstrumentMap) -> list[Problem]:
    low, high = instrument.range.low, instrument.range.high
    return [
        Problem(
            Message(
                "fingering.out_of_range",
                {
                    "note": notes[index].id,
                    "low": low,
                    "high": high,
                    "played_pitch": instrument.nearest_playable(int(times.pitch[index])),
                },
            ),
            notes[index].id,
            float(times.onset_s[index]),
            float(times.played_end_s[index]),
        )
        for index in np.flatnonzero((times.pitch < low) | (times.pitch > high)).tolist()
    ]


def _early_starts(notes: tuple[Note, ...], problem: FingeringProblem, path: IntArray) -> list[Problem]:
    if not problem.has_slide:
        return []
    steps = np.arange(len(path) - 1)
    motions, times = problem.motions, problem.times
    share = motions.share[steps, path[:-1], path[1:]]
    result = []
    for step in np.flatnonzero(share > 1.0 + TOLERANCE).tolist():
        needed_s = float(motions.needed_s[step, path[step], path[step + 1]])
        chosen = problem.table.choices[problem.pitch_index[step + 1]][path[step + 1]]
        arguments = {
            "note": notes[step + 1].id,
            "label": chosen.label,
            "needed_ms": round(needed_s * 1000.0),
            "available_ms": round(needed_s / float(share[step]) * 1000.0),
        }
        onset_s = float(times.onset_s[step + 1])
        result.append(
            Problem(Message("fingering.starts_early", arguments), notes[step + 1].id, onset_s - needed_s, onset_s)
        )
    return result
