"""Notes that cannot sound together: the highest of a chord is played, the others are reported."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.plan.music.one_note_at_a_time import one_at_a_time
from app.plan.music.piece import MonophonicPart
from app.project.model import project_from_score
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps
from tests.support.performed import player_motion

CLOCK = TempoMap(480)
MAP = bundled_maps()["trumpet_Bb"]


def line(*notes: tuple[int, int, int]) -> MonophonicPart:
    ordered = sorted(notes, key=lambda note: (note[0], note[2]))
    return MonophonicPart(
        "p",
        tuple(Note(f"1:{i + 1}", onset, length, pitch, 80) for i, (onset, length, pitch) in enumerate(ordered)),
        MAP,
    )


def test_a_melody_is_left_as_it_is() -> None:
    melody = line((0, 480, 60), (480, 480, 62))
    kept, problems = one_at_a_time(melody, CLOCK)
    assert kept is melody
    assert problems == ()


def test_the_highest_of_a_chord_is_played() -> None:
    kept, problems = one_at_a_time(line((0, 480, 60), (0, 480, 67), (0, 480, 64)), CLOCK)
    assert [note.pitch for note in kept.notes] == [67]
    assert [problem.message.id for problem in problems] == ["note.struck_together"] * 2


def test_legato_is_no_problem_and_a_longer_overlap_is() -> None:
    _, legato = one_at_a_time(line((0, 500, 60), (480, 480, 62)), CLOCK)
    _, overlap = one_at_a_time(line((0, 600, 60), (480, 480, 62)), CLOCK)
    assert legato == ()
    assert [(problem.message.id, problem.note_id) for problem in overlap] == [("note.overlaps", "1:1")]
    assert overlap[0].message.arguments["overlap_ms"] == 125


notes = st.lists(
    st.tuples(st.integers(0, 12).map(lambda n: n * 120), st.integers(1, 2000), st.integers(50, 90)), max_size=12
)


@given(notes)
@settings(max_examples=40, deadline=None)
def test_whatever_is_drawn_can_be_played(drawn: list[tuple[int, int, int]]) -> None:
    given_line = line(*drawn)
    part = Part("1.1.1", "T", 0, 0, 0, None, None, MAP.id, given_line.notes)
    project = project_from_score(Score("t", 480, CLOCK, parts=(part,)), {MAP.id: MAP})
    performance = Performance(project)
    motion = player_motion(performance, project.players[0], whole_span(performance.time_frame, Fraction(24)))
    assert np.isfinite(motion.rotations).all()
    highest = {}
    for onset, _, pitch in drawn:
        highest[onset] = max(pitch, highest.get(onset, 0))
    played = {note.id: note for note in given_line.notes}
    fingered = [played[event.note_id] for event in performance.plan(project.players[0]).fingerings]
    assert {note.onset_tick: note.pitch for note in fingered} == highest
