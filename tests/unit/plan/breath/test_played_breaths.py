"""A live performance has breaths where its score has them, despite deviations of a few milliseconds."""

from __future__ import annotations

import random
from collections.abc import Iterable

import numpy as np
import pytest

from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.music.notation import notated
from app.plan.music.piece import MEZZOFORTE, line_times, marked_loudness
from app.plan.music.rests import rest_ticks
from app.plan.parameters import PlayerParameters
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480
BPM = 66.0
STEPS = (2, 1, 1, 1.5, 0.5, 1, 1, 3, 1) * 12
PITCHES = (60, 62, 64, 65, 67, 69, 67, 65, 62, 60, 59, 55, 57)


def score() -> tuple[PlainNote, ...]:
    """Two minutes without a rest."""
    onsets = np.concatenate(([0.0], np.cumsum(STEPS)))
    return line_of(
        *(
            (round(onset * Q), round(step * Q), PITCHES[index % len(PITCHES)])
            for index, (onset, step) in enumerate(zip(onsets, STEPS, strict=False))
        )
    )


def as_played(notes: Iterable[PlainNote], seed: int) -> tuple[PlainNote, ...]:
    """Line with each note up to 15 ms early or late, and released 25 ms and a part of its length before the
    next one.
    """
    chance = random.Random(seed)
    per_s = Q * BPM / 60.0
    result = []
    for note in notes:
        early = 0.025 + 0.04 * note.duration_tick / per_s
        onset = max(round(note.onset_tick + chance.uniform(-0.015, 0.015) * per_s), 0)
        result.append((onset, round(note.duration_tick - early * per_s), note.pitch))
    return line_of(*result)


def plan(
    notes: tuple[PlainNote, ...], clock: PlainClock, loudness: tuple[float, ...] = (), **parameters: float
) -> PlayerPlan:
    line = MonophonicPart("p", notes, valves(), PlayerParameters(**parameters), loudness=loudness)
    return make_plans(piece_of(clock), (line,), time_frame((line,), clock))["p"]


def breaths(plan_: PlayerPlan) -> set[str]:
    return {event.id for event in plan_.breaths if event.kind == "breath"}


STEADY = PlainClock(((0, BPM),))


@pytest.mark.parametrize("seed", range(4))
def test_a_played_line_is_breathed_as_its_score(seed: int) -> None:
    written, found = breaths(plan(score(), STEADY)), breaths(plan(as_played(score(), seed), STEADY))
    assert len(written) > 10
    assert len(written & found) >= 0.9 * len(written)


@pytest.mark.parametrize("bpm", [76.0, 88.0])
def test_a_ritardando_moves_at_most_the_breath_it_needs(bpm: float) -> None:
    notes = score()
    slower_tick = notes[-1].onset_tick - 8 * Q
    steady, slowing = PlainClock(((0, bpm),)), PlainClock(((0, bpm), (slower_tick, 0.7 * bpm)))
    before = {f"breath:{note.id}" for note in notes if note.onset_tick < slower_tick - 8 * Q}
    written, found = plan(notes, steady), plan(notes, slowing)
    assert len(breaths(written) & before - breaths(found)) <= 1
    assert not found.problems


def test_small_swells_move_no_breath() -> None:
    notes = score()
    swells = tuple(MEZZOFORTE + 0.15 * float(np.sin(index * 1.1)) for index in range(len(notes)))
    assert breaths(plan(notes, STEADY, swells)) == breaths(plan(notes, STEADY))


def test_the_mark_nearest_to_a_loudness() -> None:
    assert marked_loudness(np.array([0.0, 0.60, MEZZOFORTE, 0.68, 1.0])).tolist() == pytest.approx(
        [16 / 127, MEZZOFORTE, MEZZOFORTE, MEZZOFORTE, 126 / 127]
    )


@pytest.mark.parametrize("early_s", [0.035, 0.05])
@pytest.mark.parametrize("lung_s", [6.0, 6.5])
def test_rests_after_notes_let_go_early_serve_as_written_ones(early_s: float, lung_s: float) -> None:
    """The rest used for a breath and the air gained follow from the score."""
    lengths, sounds = (1.5, 1, 0.25, 0.75, 0.5, 1, 1, 1, 1) * 10, (1.5, 1, 0.25, 0, 0.5, 1, 1, 0.5, 1) * 10
    onsets = np.concatenate(([0.0], np.cumsum(lengths)))
    rows = [
        (round(onset * Q), round(sound * Q), 60 + index % 7)
        for index, (onset, sound) in enumerate(zip(onsets, sounds, strict=False))
        if sound
    ]
    per_s = Q * 120.0 / 60.0
    chance = random.Random(1)
    as_played_ = [
        (
            max(onset + round(chance.uniform(-0.01, 0.01) * per_s), 0),
            length - round(min(early_s, 0.3 * length / per_s) * per_s),
            pitch,
        )
        for onset, length, pitch in rows
    ]
    clock = PlainClock(((0, 120.0),))
    written, found = (breaths(plan(line_of(*notes), clock, lung_s=lung_s)) for notes in (rows, as_played_))
    assert len(written) > 5
    assert len(written & found) >= 0.8 * len(written)


@pytest.mark.parametrize("seed", range(3))
def test_rests_of_a_line_with_short_gates_are_those_of_its_score(seed: int) -> None:
    """Every note sounds for 80 to 95 % of its length and begins up to 20 ms early or late, as programs humanise."""
    chance = random.Random(seed)
    lengths = (1, 1, 0.5, 0.5, 1, 1.5, 0.5, 2, 1, 0.75, 0.25, 1) * 8
    rests = (0, 0, 0, 0.5, 0, 0.5, 0, 0, 1, 0, 0, 2) * 8
    written, as_played_, at = [], [], 1.0
    per_s = Q * 96.0 / 60.0
    for index, (length, rest) in enumerate(zip(lengths, rests, strict=True)):
        written.append((round(at * Q), round(length * Q), PITCHES[index % len(PITCHES)]))
        late = round(chance.uniform(-0.02, 0.02) * per_s)
        as_played_.append((written[-1][0] + late, round(length * chance.uniform(0.8, 0.95) * Q), written[-1][2]))
        at += length + rest
    clock = PlainClock(((0, 96.0),))
    found = []
    for rows in (written, as_played_):
        times = line_times(MonophonicPart("p", line_of(*rows), valves()), clock)
        score = notated(times, piece_of(clock))
        found.append(rest_ticks(score, piece_of(clock).beat_ticks_at(score.onset_tick))[1:].tolist())
        assert not score.slurs_next[:-1].any()
    assert found[0] == found[1]
    assert breaths(plan(line_of(*written), clock)) == breaths(plan(line_of(*as_played_), clock))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("bpm", [50.0, 72.0])
def test_long_notes_released_as_early_as_all_others_have_no_rests_after_them(seed: int, bpm: float) -> None:
    """A chorale in which a tenth to a fifth of each three-second note is audible silence, but no rest of the score."""
    chance = random.Random(seed)
    lengths, rests = (1, 1, 1, 1, 2, 1, 0.5, 0.5, 1, 3) * 6, (0, 0, 0, 0, 0, 0, 0, 0, 0, 1) * 6
    written, as_played_, at = [], [], 0.0
    for index, (length, rest) in enumerate(zip(lengths, rests, strict=True)):
        written.append((round(at * Q), round(length * Q), PITCHES[index % len(PITCHES)]))
        as_played_.append((written[-1][0], round(length * chance.uniform(0.8, 0.95) * Q), written[-1][2]))
        at += length + rest
    clock = PlainClock(((0, bpm),))
    assert breaths(plan(line_of(*written), clock)) == breaths(plan(line_of(*as_played_), clock))


def test_half_a_second_after_a_long_note_is_a_rest_in_a_played_line_too() -> None:
    """Notes of three seconds and silences of 0.55 s are on no grid."""
    notes = [(round(index * 3.55 * Q), 3 * Q, 65) for index in range(6)]
    times = line_times(MonophonicPart("p", line_of(*notes), valves()), PlainClock(((0, 60.0),)))
    score = notated(times, piece_of(PlainClock(((0, 60.0),))))
    assert (rest_ticks(score, np.full(6, Q))[1:] > 0).all()


@pytest.mark.parametrize("felt_beat", [Q // 2, Q])
@pytest.mark.parametrize("length", [Q // 8, Q, 3 * Q, 4 * Q])
def test_a_beat_of_silence_is_a_rest_however_early_the_notes_of_the_line_are_released(
    length: int, felt_beat: int
) -> None:
    """Every note ends a fifth of its step early; after the longest note this is a beat, which is ambiguous."""
    chance = random.Random(length)
    rows, rests, at = [], set(), 7
    for index, step in enumerate((2, 1, 1, 0.5, 0.5, 1, 0, 2, 1, 0, 1, 1) * 4):
        sound, silence = (round(0.8 * step * Q), round(0.2 * step * Q)) if step else (length, felt_beat)
        rows.append((at, sound, PITCHES[index % len(PITCHES)]))
        at += sound + silence + chance.choice([0, 1])
        if not step or silence >= felt_beat:
            rests.add(f"breath:1:{index + 2}")
    line = MonophonicPart("p", line_of(*rows), valves(), PlayerParameters(breath_need=0.0))
    clock = PlainClock(((0, 120.0),))
    made = make_plans(piece_of(clock, felt_ticks=felt_beat), (line,), time_frame((line,), clock))["p"]
    assert breaths(made) >= rests & {f"breath:{note.id}" for note in line.notes}
