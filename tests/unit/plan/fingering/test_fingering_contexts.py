"""Short phrases, trills and tremolos compared with fingerings that teachers accept
(``tests/data/fingerings/contexts.csv``).
"""

from __future__ import annotations

import csv

import numpy as np
import pytest

from app.plan.fingering.trills_and_runs import attacked_notes, chromatic_notes, glissando_steps, trill_steps
from app.plan.generate import MonophonicPart
from app.plan.music.piece import LineTimes, line_times
from instrument_maps.load import bundled_maps
from tests.support.fingering_contexts import SOURCES, contexts, right_of
from tests.support.plan import PlainClock, line_of

LEAST_SHARE = 0.95


def test_every_context_has_a_source_and_about_half_are_held_out() -> None:
    with SOURCES.open(encoding="utf-8", newline="") as stream:
        assert {row["source"] for row in csv.DictReader(stream)} == {one.source for one in contexts()}
    assert len(contexts()) >= 400
    assert len({(one.map, one.name) for one in contexts()}) == len(contexts())
    assert 0.4 < sum(one.held_out for one in contexts()) / len(contexts()) < 0.6


def test_nearly_all_tuned_contexts_are_fingered_as_a_teacher_accepts() -> None:
    counts = right_of(one for one in contexts() if not one.held_out)
    right, total = (sum(column) for column in zip(*counts.values(), strict=True))
    assert right / total >= LEAST_SHARE, counts


def line(pitches: list[int], step_tick: int, sounds: float = 1.0) -> LineTimes:
    notes = line_of(*((at * step_tick, round(sounds * step_tick), pitch) for at, pitch in enumerate(pitches)))
    return line_times(MonophonicPart("p", notes, bundled_maps()["flute"]), PlainClock())


@pytest.mark.parametrize(
    ("pitches", "step_tick", "found"),
    [
        ([72, 74] * 3, 100, True),
        ([72, 74] * 3, 240, False),
        ([72, 76] * 3, 60, True),
        ([72, 76] * 3, 100, False),
        ([72, 86] * 3, 60, False),
        ([72, 74, 76, 77, 79, 81], 60, False),
    ],
)
def test_trills_and_tremolos_alternate_quickly(pitches: list[int], step_tick: int, found: bool) -> None:
    assert trill_steps(line(pitches, step_tick)).tolist() == [found] * 5


def test_a_glissando_is_slurred_and_goes_one_way() -> None:
    run = [72, 73, 74, 75]
    assert glissando_steps(line(run, 60)).all()
    assert not glissando_steps(line(run, 60, sounds=0.7)).any()
    assert not glissando_steps(line(run, 240)).any()
    assert not glissando_steps(line([72, 73, 74, 73], 60)).any()


def test_a_chromatic_note_has_semitones_on_both_sides_one_of_them_below() -> None:
    assert chromatic_notes(line([65, 66, 67, 69], 120)).tolist() == [False, True, False, False]
    assert chromatic_notes(line([66, 67, 66, 64], 120)).tolist() == [False, True, False, False]
    assert not chromatic_notes(line([65, 66, 67], 480)).any()


def test_an_attack_is_tongued_or_slurred_up_over_a_break() -> None:
    pitches = [53, 57, 59, 57]
    register = np.array([0, 1, 1, 1])
    still = np.zeros(3, dtype=bool)
    assert attacked_notes(line(pitches, 240, sounds=1.02), register, still).tolist() == [True, True, False, False]
    # If all notes touch and none is slurred, the file is a rendered score in which slurs are unknown.
    assert attacked_notes(line(pitches, 240), register, still).all()
    assert attacked_notes(line(pitches, 240, sounds=0.5), register, still).all()
