"""Recurring bars, and dances that repeat the motion danced to them before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.accent_grid import grid_of
from app.choreography.dance import Manner
from app.choreography.generate import Choreographer
from app.choreography.phrases import likeness_of_bars, returning_places, returns_of_bars, varied
from app.choreography.rhythm import Rhythm, felt_at, own_beat_s, pace_of
from app.choreography.sequence import Weights
from tests.support.dances import model

BEAT_S = 0.55


def played(form: str, beat_s: float = BEAT_S, beats: int = 4) -> Rhythm:
    """Sections of four bars; each letter has strokes of its own."""
    hits = []
    for section, letter in enumerate(form):
        random = np.random.default_rng(ord(letter))
        for bar in range(4):
            for place in np.flatnonzero(random.uniform(size=4 * beats) < 0.5):
                at = (4 * section + bar) * beats + place / 4.0
                hits.append((beat_s * at, int(random.integers(47)), float(random.uniform(0.4, 1.0))))
    hits.sort()
    times, symbols, strengths = (np.array(column) for column in zip(*hits, strict=True))
    count = 4 * beats * len(form) + 1
    return Rhythm(beat_s * np.arange(count), np.arange(count) % beats, times, symbols.astype(int), strengths, False)


def test_sections_return_and_new_ones_do_not() -> None:
    worths = returns_of_bars(played("ABAC"))
    assert (worths[[8, 9, 10, 11], [0, 1, 2, 3]] > 0.5).all()
    assert (worths[12:].max(axis=1) < 0.5).all()
    assert (worths[np.triu_indices(16, -3)] == 0.0).all()


def test_where_all_bars_are_alike_none_returns() -> None:
    rhythm = played("AAAA")
    same = replace(rhythm, hits_s=rhythm.beats_s, symbols=np.ones(len(rhythm.beats_s), int), strengths=np.ones(65))
    assert np.abs(returns_of_bars(same)).max() < 1e-6


def test_likeness_does_not_depend_on_the_tempo_and_knows_each_bar_itself() -> None:
    one, other = likeness_of_bars(played("ABA")), likeness_of_bars(played("ABA", 0.8))
    assert np.allclose(one, other, atol=1e-6)
    assert np.allclose(np.diag(one), 1.0)


def test_the_more_a_melody_weighs_the_more_bars_differ_by_it() -> None:
    # By the drums the third section is the first one, by the melody it is another.
    drums, tune = played("ABA"), played("ABC")
    rhythm = replace(drums, melody=tune)
    alike = [likeness_of_bars(rhythm, weight)[9, 1] for weight in (0.0, 0.25, 0.5, 1.0)]
    assert alike == sorted(alike, reverse=True)
    assert alike[0] > alike[-1] + 0.2
    assert np.array_equal(likeness_of_bars(rhythm, 0.0), likeness_of_bars(drums))
    assert np.allclose(likeness_of_bars(rhythm), 0.5 * (likeness_of_bars(drums) + likeness_of_bars(tune)))


def test_sections_return_by_their_melody_too() -> None:
    beaten = replace(played("AAAA"), symbols=np.zeros(0, int), hits_s=np.zeros(0), strengths=np.zeros(0))
    worths = returns_of_bars(replace(beaten, melody=played("ABAC")))
    assert worths[9, 1] > 0.5 > worths[13, 1]


def test_sections_return_by_their_melody_the_more_the_more_it_weighs() -> None:
    """Over even drums every amount from 0.25 on was the same, since recurrences are relative to their own spread."""
    beats = played("AAAA").beats_s
    even = replace(played("AAAA"), hits_s=beats, symbols=np.zeros(len(beats), int), strengths=np.ones(len(beats)))
    rhythm = replace(even, melody=played("ABAC"))
    amounts = np.array([0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0])
    worths = np.array([returns_of_bars(rhythm, amount)[9, 1] for amount in amounts])
    assert worths == pytest.approx(2.0 * amounts, abs=1e-6)
    assert np.array_equal(returns_of_bars(rhythm, 0.0), returns_of_bars(even))


def test_a_melody_alone_decides_at_the_amount_1() -> None:
    rhythm = replace(played("ABBA"), melody=played("ABAC"))
    by_drums, by_both, by_melody = (returns_of_bars(rhythm, amount) for amount in (0.0, 0.5, 1.0))
    assert by_drums[13, 1] > 0.5 > by_melody[13, 1]
    assert by_melody[9, 1] > 1.5 > by_drums[9, 1]
    # The usual amount, which dances have unless the user changes it, is the mean of both as it always was.
    alike = likeness_of_bars(rhythm)
    assert np.array_equal(by_both, returns_of_bars(rhythm))
    assert np.allclose(alike, 0.5 * (likeness_of_bars(rhythm, 0.0) + likeness_of_bars(rhythm, 1.0)))


def test_places_return_to_the_same_place_of_the_bar() -> None:
    rhythm = played("ABA")
    times = grid_of(rhythm).times_s
    found = returning_places(rhythm, times)
    assert found is not None
    place, bar = np.nonzero(found.worths)
    assert len(place) >= 250
    earlier = found.earlier[place, bar]
    assert np.allclose(times[place] - times[earlier], 4 * BEAT_S * (place // 8 - bar))


def test_without_bars_nothing_returns() -> None:
    empty = Rhythm(np.zeros(0), np.zeros(0, int), np.zeros(0), np.zeros(0, int), np.zeros(0), False)
    assert returns_of_bars(empty).size == 0
    assert returning_places(empty, np.zeros(0)) is None


def test_what_returns_is_danced_again_with_variation() -> None:
    # In a small stock few segments fit the beats well, so they are repeated anyway.
    rhythm, choreographer = played("ABA"), Choreographer(model(beats=48))

    def again(weights: Weights) -> float:
        same = []
        for seed in range(4):
            steps = {
                step.place: step.segment for step in choreographer.steps(rhythm, Manner(seed=seed), weights=weights)
            }
            pairs = [(steps.get(place - 64), steps[place]) for place in steps if 64 <= place < 96]
            same.append(np.mean([one == other for one, other in pairs]))
        return float(np.mean(same))

    assert again(Weights(returns=0.0)) < 0.3
    assert 0.5 < again(Weights()) < 1.0


def test_a_section_that_would_be_copied_is_varied_in_each_four_bars() -> None:
    # So much weight makes copies of whole sections.
    rhythm, choreographer = played("ABA"), Choreographer(model(beats=48))
    for seed in range(3):
        steps = choreographer.steps(rhythm, Manner(seed=seed), weights=Weights(returns=200.0, chance=0.0))
        danced = {step.place: step.segment for step in steps}
        again = {place: danced.get(place - 64) == danced[place] for place in danced if 64 <= place < 96}
        assert sum(again.values()) > 0.5 * len(again)
        assert not all(again[place] for place in again if place < 64 + 32)


def test_varied_places_get_other_segments_of_the_same_motions() -> None:
    again = np.array([[0.8, 0.0, 0.0, -0.4]])
    found = varied(again, np.array([1, 1, 0, 0]))
    assert found[0, 0] < 0.0 < found[0, 1]
    assert found[0, 2:].tolist() == [0.0, -0.4]


@pytest.mark.parametrize(("beat_s", "pace"), [(0.7, 1.4), (0.9, 1.5), (0.5, 1.0), (0.4, 1.0)])
def test_dancers_move_faster_to_beats_faster_than_their_own(beat_s: float, pace: float) -> None:
    assert pace_of(played("A", 0.5), beat_s, 1.5) == pytest.approx(pace)


def test_far_tempi_are_felt_at_half_or_double_time() -> None:
    slow, fast = felt_at(played("A", 2.0), 0.5), felt_at(played("A", 0.2), 0.5)
    assert np.allclose(np.diff(slow.beats_s), 0.5)
    assert slow.bar_beats[:17].tolist() == [*range(16), 0]
    assert np.allclose(np.diff(fast.beats_s), 0.4)
    assert fast.bar_beats[:5].tolist() == [0, 1, 0, 1, 0]
    for near in (played("A", 0.3), played("A", 0.9)):
        assert felt_at(near, 0.5) is near
    for rhythm in (slow, fast):
        assert felt_at(rhythm, 0.5) is rhythm


@pytest.mark.parametrize("gaps", [(15, 16), (14, 15, 16), (15, 15)])
def test_a_footfall_found_a_frame_later_changes_no_felt_tempo(gaps: tuple[int, ...]) -> None:
    frames = np.cumsum([0, *gaps * (48 // len(gaps))])
    for rhythm in (played("A", 1.0), played("A", 0.25)):
        felt = set()
        for fall in range(len(frames)):
            for later in (-1, 0, 1):
                falls_s = (frames + later * (np.arange(len(frames)) == fall)) / 30.0
                felt.add(len(felt_at(rhythm, own_beat_s(np.diff(falls_s))).beats_s))
        assert len(felt) == 1


def test_a_dancer_who_hardly_steps_dances_to_usual_beats() -> None:
    for gaps_s in ([], [8.5]):
        assert own_beat_s(np.array(gaps_s)) == 0.5


def test_between_the_beats_of_a_slow_piece_feet_come_down_but_bodies_do_not_arrive() -> None:
    rhythm = played("A", 2.0)
    grid = grid_of(felt_at(rhythm, 0.5))
    strong = grid.times_s[grid.strengths == 1.0]
    assert np.allclose(strong, rhythm.beats_s)
    assert grid.on_beat.sum() == 4 * len(rhythm.beats_s) - 3
    near = grid_of(felt_at(played("A"), 0.5))
    assert np.array_equal(near.strengths == 1.0, near.on_beat)


def test_beats_are_divided_and_joined_as_the_metre_does() -> None:
    rhythm = played("A", 1.5, beats=2)
    compound = replace(rhythm, divisions=np.full(len(rhythm.beats_s), 3))
    felt = felt_at(compound, 0.5)
    assert np.allclose(np.diff(felt.beats_s), 0.5)
    assert felt.bar_beats[:7].tolist() == [0, 1, 2, 3, 4, 5, 0]
    waltz = felt_at(played("A", 0.2, beats=3), 0.5)
    assert np.allclose(np.diff(waltz.beats_s), 0.6)
    assert (waltz.divisions == 3).all()
    five = played("A", 0.2, beats=5)
    assert felt_at(five, 0.5) is five
