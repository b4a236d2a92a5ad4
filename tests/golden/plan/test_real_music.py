"""Plans of engraved music: fingerings are those that players use, and breaths do not interrupt notes."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache
from pathlib import Path

import msgspec
import pytest

from app.performance.ensemble import Performance
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.music.piece import line_times
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

ENSEMBLE = Path(__file__).parents[2] / "data" / "midi" / "ensemble"
QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
CATCHES = {"breath.catch", "breath.catch_dropped", "breath.catch_dropped_two"}
SHORT = CATCHES | {"breath.phrase_end"}
PICKUPS = {
    "brass_quartet_lutkin_2tpt_tbn_tuba.mid": 1.0,
    "oboe_bassoon_devienne_sonata2.mid": 0.5,
    "orch_brandenburg2_mv1_trumpet_recorder_oboe.mid": 0.5,
    "solo_flute_bach_partita_corrente.mid": 0.5,
    "solo_horn_mozart_k447_mv1.mid": 1.0,
}
"""Length in quarters of the upbeat in the scores of the files, which do not contain it."""
FILES = sorted(path.name for path in ENSEMBLE.glob("*.mid"))


@cache
def performance(name: str) -> Performance:
    maps = bundled_maps()
    score = read_midi(ENSEMBLE / name, maps=map_choices(maps.values()))
    project = replace(project_from_score(score, maps), felt_beat_quarters=1.0)
    to_the_letter = tuple(
        msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, breath_need=0.0))
        for player in project.players
    )
    return Performance(replace(project, players=to_the_letter))


def is_usual(share: float, line: MonophonicPart) -> bool:
    """Return whether at least three notes of a line are followed by a silence of this share of their step."""
    steps = [
        (after.onset_tick - before.onset_tick, before.duration_tick) for before, after in itertools.pairwise(line.notes)
    ]
    return sum(abs(1.0 - length / step - share) < 0.13 for step, length in steps if step > 0) >= 3


def played(name: str) -> list[tuple[MonophonicPart, PlayerPlan]]:
    made = performance(name)
    return [(line, made.plans[line.player_id]) for line in made.parts]


def test_the_arban_study_keeps_its_first_choices() -> None:
    ((_, plan),) = played("solo_cornet_arban_first_study10.mid")
    assert sum(event.rank == 1 for event in plan.fingerings) >= 0.95 * len(plan.fingerings)


def test_nothing_is_excused_in_the_lutkin_quartet() -> None:
    assert [plan.problems for _, plan in played("brass_quartet_lutkin_2tpt_tbn_tuba.mid")] == [()] * 4


def test_nothing_but_a_long_way_of_the_slide_is_excused_in_the_bundled_quartet() -> None:
    maps = bundled_maps()
    made = Performance(project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps))
    *others, bass = made.plans.values()
    assert [plan.problems for plan in others] == [(), (), ()]
    # C, B flat, C, D flat in eighths: T1, 1, T1, 5; without the attachment the way from 1 to 6 would be longer still.
    assert [(problem.message.id, problem.message.arguments["label"]) for problem in bass.problems] == [
        ("fingering.starts_early", "5")
    ]


@pytest.mark.parametrize("name", FILES)
def test_no_phrase_travels_further_or_faster_than_the_table(name: str) -> None:
    for line, plan in played(name):
        instrument = line.instrument_map
        times = line_times(line, performance(name).piece.clock)
        slides = [control for control in instrument.controls if control.role == "pitch" and control.kind == "slide"]
        presses = [control for control in instrument.controls if control.role == "pitch" and control.kind == "press"]
        ours = [event.controls for event in plan.fingerings]
        table = [instrument.fingerings_for(note.pitch)[0].controls for note in line.notes]
        silences = (times.onset_s[1:] - times.played_end_s[:-1]).tolist()
        cuts = [0, *(index + 1 for index, silence in enumerate(silences) if silence >= 0.25), len(line.notes)]
        for start, end in itertools.pairwise(cuts):
            sums = []
            for controls in (ours, table):
                metres, moves, fastest = 0.0, 0, 0.0
                for a, b, index in zip(controls[start:end], controls[start + 1 : end], range(start, end), strict=False):
                    for control in slides:
                        way = abs(b.get(control.name, 0.0) - a.get(control.name, 0.0)) * (control.motion.travel_m or 0)
                        free_s = times.onset_s[index + 1] - times.onset_s[index] - 0.5 * times.duration_s[index]
                        metres, fastest = metres + way, max(fastest, way / free_s)
                    moves += sum(a.get(control.name, 0.0) != b.get(control.name, 0.0) for control in presses)
                sums.append((metres, moves, fastest))
            for here, there in zip(*sums, strict=True):
                assert here <= there + 1e-6


@pytest.mark.parametrize("name", FILES)
def test_repeated_notes_keep_their_fingering_unless_there_is_time_for_another(name: str) -> None:
    for line, plan in played(name):
        times = line_times(line, performance(name).piece.clock)
        silence_s = times.onset_s[1:] - times.played_end_s[:-1]
        again = (times.pitch[1:] == times.pitch[:-1]) & (silence_s < 0.25)
        step_s = times.onset_s[1:] - times.onset_s[:-1]
        for at in again.nonzero()[0]:
            before, after = plan.fingerings[at], plan.fingerings[at + 1]
            assert before.label == after.label or (step_s[at] > 0.35 and 1 in {before.rank, after.rank}), before


@pytest.mark.parametrize("name", FILES)
def test_every_rest_serves_by_the_thesis_and_no_breath_cuts_a_note(name: str) -> None:
    quarter = performance(name).project.score.ticks_per_quarter
    for line, plan in played(name):
        breaths = {event.id: event for event in plan.breaths}
        for before, note in itertools.pairwise(line.notes):
            rest = (note.onset_tick - before.onset_tick - before.duration_tick) / quarter
            breath = breaths.get(f"breath:{note.id}")
            if rest < 0.5 or (rest < 1.0 and (breath is None or breath.reason.id in SHORT)):
                # Detached notes have no rests between them.
                step = (note.onset_tick - before.onset_tick) / quarter
                assert rest < 0.5 or is_usual(rest / step, line)
                assert breath is None or breath.reason.id in SHORT
                continue
            assert breath.end_tick == note.onset_tick
            assert breath.start_tick == note.onset_tick - round(quarter * min(rest, 1.0))
            preparation = breaths.get(f"preparation:{note.id}")
            assert (preparation is not None) == (rest >= 2.0)
            if preparation is not None:
                assert (preparation.start_tick, preparation.end_tick) == (
                    note.onset_tick - 2 * quarter,
                    note.onset_tick - quarter,
                )


@pytest.mark.parametrize("name", FILES)
def test_a_catch_breath_is_taken_where_more_air_is_needed_than_there_is(name: str) -> None:
    for _, plan in played(name):
        for event in plan.breaths:
            if event.reason.id in CATCHES:
                assert event.reason.arguments["air_s"] > event.reason.arguments["lung_s"], event.reason


@pytest.mark.parametrize("name", FILES)
def test_no_breath_stands_before_a_downbeat_in_running_notes(name: str) -> None:
    """Nor between the upbeat after a rest and the beat that it leads to."""
    made = performance(name)
    quarter = made.project.score.ticks_per_quarter
    metres = made.project.score.metres
    for line, plan in played(name):
        number = {note.id: index for index, note in enumerate(line.notes)}
        steps = [after.onset_tick - before.onset_tick for before, after in itertools.pairwise(line.notes)]
        served = {number[event.id.split(":", 1)[1]] for event in plan.breaths if event.kind == "breath"}
        for index in sorted(served & set(range(2, len(line.notes) - 1))):
            metre = max(metres, key=lambda metre, at=line.notes[index].onset_tick: (metre.tick <= at, metre.tick))
            since = line.notes[index].onset_tick - metre.tick - round(PICKUPS.get(name, 0.0) * quarter)
            runs = steps[index - 1] <= 0.75 * quarter and steps[index - 2] == steps[index - 1] == steps[index]
            rests = line.notes[index - 1].duration_tick < 0.5 * steps[index - 1]
            if since % (4 * quarter * metre.numerator // metre.denominator) == 0:
                assert rests or not runs, line.notes[index]
                assert rests or not (index - 1 in served and steps[index - 1] <= 0.75 * quarter), line.notes[index]
