"""Slurs, articulations, breath marks and dynamics of a score, by note."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.plan.music.piece import note_times
from app.plan.music.velocity_ladders import DYNAMICS, LEVELS
from app.plan.music.written_marks import WrittenMarks, written_marks
from app.score.marks import Mark
from app.score.model import Note
from app.score.tempo import TempoMap

QUARTER = 480
LEVEL = {name: float(level) for (name, _), level in zip(DYNAMICS, LEVELS, strict=True)}


def quarters(count: int) -> tuple[Note, ...]:
    return tuple(Note(f"1:{at + 1}", at * QUARTER, QUARTER, 60 + at % 5, 80) for at in range(count))


def read(count: int, *marks: Mark) -> WrittenMarks:
    return written_marks(quarters(count), marks, "score", QUARTER)


def dynamic(text: str, quarter: float) -> Mark:
    return Mark("dynamic", tick=round(quarter * QUARTER), text=text)


def hairpin(kind: str, start: float, end: float) -> Mark:
    return Mark(kind, tick=round(start * QUARTER), end_tick=round(end * QUARTER))


def levels(count: int, *marks: Mark) -> Sequence[float]:
    found: Sequence[float] = read(count, *marks).level.tolist()
    return found


def test_a_slur_joins_each_note_to_the_next_but_the_last() -> None:
    written = read(6, Mark("slur", "1:2", "1:4"), Mark("slur", "1:5", "1:6"))
    assert written.slurred.tolist() == [False, True, True, False, True, False]


def test_dots_divide_a_slur() -> None:
    written = read(4, Mark("slur", "1:1", "1:4"), Mark("staccato", "1:3"))
    assert written.slurred.tolist() == [True, False, True, False]
    assert written.divided.tolist() == [False, False, True, False]
    assert written.stroke == ("", "", "staccato", "")


def test_an_accent_under_a_slur_does_not_divide_it() -> None:
    assert read(3, Mark("slur", "1:1", "1:3"), Mark("accent", "1:2")).slurred.tolist() == [True, True, False]


def test_of_two_marks_the_stronger_says_how_a_note_is_struck() -> None:
    assert read(1, Mark("accent", "1:1"), Mark("staccato", "1:1")).stroke == ("accent",)


def test_the_fingering_of_an_ornament_is_that_of_its_main_notes() -> None:
    # Written out in six notes; the neighbour is another pitch.
    notes = tuple(Note(f"1:{at + 1}", at * 60, 60, 60 + at % 2, 80) for at in range(6))
    marks = (Mark("trill", "1:1", "1:5"), Mark("fingering", "1:1", "1:5", text="1-3"))
    assert written_marks(notes, marks, "score", QUARTER).fingering == ("1-3", "", "1-3", "", "1-3", "")


def test_breath_marks_stand_after_their_notes() -> None:
    written = read(4, Mark("breath", "1:2"), Mark("caesura", "1:4"))
    assert written.breath.tolist() == [False, True, False, True]


def test_marks_of_other_notes_do_nothing() -> None:
    assert read(2, Mark("breath", "9:9"), Mark("slur", "9:8", "9:9")) == read(2)


def test_a_dynamic_holds_until_the_next() -> None:
    assert levels(4, dynamic("p", 1), dynamic("f", 3)) == pytest.approx(
        [np.nan, LEVEL["p"], LEVEL["p"], LEVEL["f"]], nan_ok=True
    )


def test_a_hairpin_leads_to_the_next_dynamic() -> None:
    found = levels(6, dynamic("p", 0), hairpin("crescendo", 1, 4), dynamic("f", 4))
    assert found[:2] == pytest.approx([LEVEL["p"]] * 2)
    assert LEVEL["p"] < found[2] < found[3] < LEVEL["f"]
    assert found[4:] == pytest.approx([LEVEL["f"]] * 2)


def test_a_hairpin_without_a_goal_changes_one_step() -> None:
    found = levels(6, dynamic("f", 0), hairpin("diminuendo", 1, 3))
    assert found == pytest.approx([LEVEL["f"], LEVEL["f"], (LEVEL["f"] + LEVEL["mf"]) / 2.0, *[LEVEL["mf"]] * 3])


def test_a_hairpin_against_the_next_dynamic_goes_its_own_way_first() -> None:
    found = levels(6, dynamic("mf", 0), hairpin("crescendo", 1, 4), dynamic("p", 4))
    assert found[3] > LEVEL["mf"]
    assert found[4] == pytest.approx(LEVEL["p"])


@pytest.mark.parametrize("mark", ["sf", "sfz", "fz", "rfz"])
def test_a_sforzando_is_one_note_s(mark: str) -> None:
    written = read(3, dynamic("p", 0), dynamic(mark, 1))
    assert written.level.tolist() == pytest.approx([LEVEL["p"], LEVEL["f"], LEVEL["p"]])
    assert written.struck.tolist() == [False, True, False]


def test_forte_piano_is_loud_for_one_note() -> None:
    assert levels(3, dynamic("mf", 0), dynamic("fp", 1)) == pytest.approx([LEVEL["mf"], LEVEL["f"], LEVEL["p"]])


PLACES = st.integers(0, 12)
MARKS = st.lists(
    st.one_of(
        st.builds(dynamic, st.sampled_from([*LEVEL, "sfz", "fp", "sfp", "n", "ffff", "loud"]), PLACES),
        st.builds(
            lambda kind, at, long: hairpin(kind, at, at + long),
            st.sampled_from(["crescendo", "diminuendo"]), PLACES, st.integers(0, 5),
        ),
        st.builds(lambda first, long: Mark("slur", f"1:{first}", f"1:{first + long}"), PLACES, st.integers(0, 4)),
        st.builds(lambda kind, at: Mark(kind, f"1:{at}"), st.sampled_from(["staccato", "tenuto", "breath"]), PLACES),
    ),
    max_size=8,
)  # fmt: skip


@given(MARKS, st.integers(0, 10))
def test_levels_are_known_from_the_first_dynamic_on_and_lie_between_the_softest_and_the_loudest(
    marks: list[Mark], count: int
) -> None:
    written = read(count, *marks)
    known = ~np.isnan(written.level)
    assert (np.diff(known.astype(int)) >= 0).all() or written.struck.any()
    assert ((written.level[known] >= LEVELS[0]) & (written.level[known] <= LEVELS[-1])).all()
    assert not (written.slurred & np.append(written.divided[1:], False)[:count]).any()


def test_times_of_a_score_have_its_slurs_and_dynamics_only() -> None:
    overlapping = tuple(Note(note.id, note.onset_tick, QUARTER + 60, note.pitch, 80) for note in quarters(4))
    marks = (Mark("slur", "1:1", "1:2"), dynamic("f", 2))
    times = note_times(overlapping, (), TempoMap(QUARTER), written_marks(overlapping, marks, "score", QUARTER))
    assert times.slurs_next.tolist() == [True, False, False, False]
    assert times.loudness[2:] == pytest.approx([LEVEL["f"]] * 2)
    heard = note_times(overlapping, (), TempoMap(QUARTER), written_marks(overlapping, marks, "sound", QUARTER))
    # The note after the end of a slur is tongued, even if the notes overlap.
    assert heard.slurs_next.tolist() == [True, False, True, False]
