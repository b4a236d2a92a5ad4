"""Cuts set by the user remain a valid segmentation after any edits, and are learned unchanged."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.choreography.cuts import Cut, segment
from app.choreography.cuts_by_hand import (
    Cuts,
    added_bound,
    automatic_accent,
    bounds,
    check_cuts,
    cuts_at,
    extrema,
    moved_accent,
    moved_bound,
    read_times,
    removed_bound,
)
from app.choreography.learn import learn
from app.choreography.model_file import decode_model, encode_model, read_model
from app.errors import FileError, UsageError
from app.project.choreography_files import choreography_path
from tests.unit.choreography.test_learn import SWINGS

FRAMES = 60
CURVE = np.abs(np.sin(np.arange(FRAMES) / 4.0)) + 0.01 * np.arange(FRAMES)
CUTS = (Cut(5, 10, 15), Cut(15, 20, 25), Cut(40, 45, 50))


def test_a_bound_moves_for_both_motions_and_no_further_than_the_accents() -> None:
    assert moved_bound(CUTS, 15, 17, FRAMES) == (Cut(5, 10, 17), Cut(17, 20, 25), CUTS[2])
    assert moved_bound(CUTS, 15, 2, FRAMES)[0].end == 11
    assert moved_bound(CUTS, 15, 99, FRAMES)[1].start == 19
    # At the ends of the clip, and beside a rest.
    assert moved_bound(CUTS, 5, -3, FRAMES)[0].start == 0
    assert moved_bound(CUTS, 50, 99, FRAMES)[2].end == FRAMES - 1
    assert moved_bound(CUTS, 25, 45, FRAMES)[1].end == 39


def test_an_accent_stays_in_its_motion() -> None:
    assert moved_accent(CUTS, 20, 17)[1] == Cut(15, 17, 25)
    assert moved_accent(CUTS, 20, 0)[1] == Cut(15, 16, 25)
    assert moved_accent(CUTS, 20, 99)[1] == Cut(15, 24, 25)
    top = 16 + int(np.argmax(CURVE[16:25]))
    assert automatic_accent(moved_accent(CUTS, 20, 17), 17, CURVE)[1].accent == top


def test_a_cut_makes_two_motions_and_its_deletion_one() -> None:
    made = added_bound(CUTS, 18, CURVE)
    assert bounds(made) == (5, 15, 18, 25, 40, 50)
    assert made[2] == Cut(18, 20, 25)
    assert made[1].accent == 16 + int(np.argmax(CURVE[16:18]))
    assert removed_bound(made, 18) == CUTS
    # In a rest and outside: the motion up to the nearest cut.
    assert added_bound(CUTS, 30, CURVE)[2].start == 25
    assert added_bound(CUTS, 58, CURVE)[3].start == 50
    assert added_bound((), 10, CURVE)[0].end == FRAMES - 1
    # No room for an accent.
    assert added_bound(CUTS, 16, CURVE) == CUTS
    assert removed_bound(CUTS, 50) == CUTS[:2]
    assert removed_bound(CUTS, 15) == (Cut(5, 10, 25), CUTS[2])


edits = st.tuples(
    st.sampled_from(["bound", "accent", "add", "remove", "automatic"]), st.integers(0, 99), st.integers(-9, 70)
)


@given(st.lists(edits, max_size=12))
def test_whatever_is_edited_can_be_learned_from(steps: list[tuple[str, int, int]]) -> None:
    cuts: Cuts = CUTS
    for kind, which, to in steps:
        ends = bounds(cuts)
        if kind == "add":
            cuts = added_bound(cuts, min(max(to, 0), FRAMES - 1), CURVE)
        elif kind == "bound" and ends:
            cuts = moved_bound(cuts, ends[which % len(ends)], to, FRAMES)
        elif kind == "accent" and cuts:
            cuts = moved_accent(cuts, cuts[which % len(cuts)].accent, to)
        elif kind == "automatic" and cuts:
            cuts = automatic_accent(cuts, cuts[which % len(cuts)].accent, CURVE)
        elif kind == "remove" and ends:
            cuts = removed_bound(cuts, ends[which % len(ends)])
        check_cuts(cuts, FRAMES, "x")


@given(st.lists(st.integers(0, 3), min_size=1, max_size=20))
def test_extrema_are_those_that_a_slow_search_finds(values: list[int]) -> None:
    curve = np.array(values, np.float64)

    def found(sign: int) -> list[int]:
        result = []
        for at, value in enumerate(values):
            before = sign * values[at - 1] if at else None
            after = sign * values[at + 1] if at + 1 < len(values) else None
            lower = sign * value
            if (before is None or lower < before) and (after is None or lower <= after):
                result.append(at)
        return result

    minima, maxima = extrema(curve)
    assert minima.tolist() == found(1)
    assert maxima.tolist() == found(-1)


def test_given_cuts_are_in_the_model_exactly() -> None:
    found = segment(SWINGS.motion).cuts
    given_cuts = (Cut(3, 30, 50), replace(found[1], start=60), *found[4:6], Cut(400, 401, 510))
    model = learn([replace(SWINGS, cuts=given_cuts)], states=3, seed=0, name="x")
    assert tuple(Cut(one.start, one.accent, one.end) for one in model.segments) == given_cuts
    assert model.sources[0].cuts_given
    assert not learn([SWINGS], states=3, seed=0, name="x").sources[0].cuts_given
    again = decode_model(encode_model(model), "x")
    assert again.sources == model.sources
    assert again.segments == model.segments


def test_found_cuts_that_are_given_are_the_same_choreography() -> None:
    found = learn([SWINGS], states=4, seed=1, name="x")
    given_too = learn([replace(SWINGS, cuts=segment(SWINGS.motion).cuts)], states=4, seed=1, name="x")
    assert given_too.segments == found.segments
    assert given_too.emission.tolist() == found.emission.tolist()


@pytest.mark.parametrize(
    "cuts",
    [
        (Cut(-1, 5, 9),),
        (Cut(5, 5, 9),),
        (Cut(5, 9, 9),),
        (Cut(5, 7, 9), Cut(8, 12, 20)),
        (Cut(20, 30, 40), Cut(5, 7, 9)),
        (Cut(500, 505, 511),),
    ],
)
def test_cuts_that_are_none_are_refused(cuts: Cuts) -> None:
    with pytest.raises(UsageError) as caught:
        learn([replace(SWINGS, cuts=cuts)], states=1, seed=0, name="x")
    assert caught.value.message.id == "cuts.wrong"
    assert caught.value.message.arguments["motion"] == "swings.bvh"
    assert caught.value.message.arguments["frames"] == 511


def test_without_given_cuts_there_is_nothing_to_learn() -> None:
    with pytest.raises(UsageError) as caught:
        learn([replace(SWINGS, cuts=())], states=None, seed=0, name="x")
    assert caught.value.message.id == "learn.no_motion"


def test_times_are_read_in_groups(tmp_path: Path) -> None:
    path = tmp_path / "cuts.txt"
    path.write_text("0.5\n 1.0 \r\n1.5\n\n\n2\n3e0\n\n", encoding="utf-8")
    groups = read_times(path)
    assert groups == ((0.5, 1.0, 1.5), (2.0, 3.0))
    curve = np.zeros(200)
    curve[[40, 70, 150]] = 1.0
    assert cuts_at(groups, Fraction(60), curve, "x") == (Cut(30, 40, 60), Cut(60, 70, 90), Cut(120, 150, 180))
    with pytest.raises(UsageError):
        cuts_at(groups, Fraction(60), curve[:150], "x")
    with pytest.raises(UsageError):
        cuts_at(((1.0, 1.01),), Fraction(60), curve, "x")


@pytest.mark.parametrize(
    ("text", "id", "line"),
    [
        ("1.0\nx\n", "cuts.line", 2),
        ("1.0\nnan\n", "cuts.line", 2),
        ("1.0\n1.0\n", "cuts.order", 2),
        ("1.0\n2.0\n\n3.0\n", "cuts.order", 4),
        ("1.0\n\n3.0\n", "cuts.order", 1),
    ],
)
def test_a_wrong_line_is_named(tmp_path: Path, text: str, id: str, line: int) -> None:
    path = tmp_path / "cuts.txt"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError) as caught:
        read_times(path)
    assert (caught.value.message.id, caught.value.message.arguments["line"]) == (id, line)


def test_the_bundled_choreography_has_found_cuts() -> None:
    assert [source.cuts_given for source in read_model(choreography_path("salsa")).sources] == [False] * 5
