"""Casts of new pieces: build for large instruments, variety side by side, and nothing by the alphabet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from app.project.band_in_title import ANY_AGE, Years, years_in_title
from app.project.casting import SPACING_M, StagePosition, stage_arc, stage_seats
from app.project.character_choice import (
    Candidate,
    Seat,
    build_of,
    characters_for,
    choose_characters,
    newcomers_character,
)
from app.project.footprint import footprint, solid_m3
from app.rig.people.body_shapes import Phenotype, age_of
from app.rig.people.bundled_people import bundled_people, bundled_person, not_cast_for, our_years
from app.rig.people.person import originals
from instrument_maps.load import bundled_maps

MAPS = bundled_maps()
BAND = (
    *("flute", "flute", "oboe", "bassoon", *("clarinet_Bb",) * 5, "sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb"),
    *(*("trumpet_Bb",) * 6, *("horn_double_F_Bb",) * 4, *("trombone_tenor_F_attachment",) * 4, "tuba_BBb"),
)
WOMAN = Candidate("woman", 1.60, 25.0, 1.0, 0.3, -4.0, -1.0, "bob", 0.50)


def seats(count: int, asks: Mapping[int, float] | None = None) -> list[Seat]:
    stages = [StagePosition(number * SPACING_M, 0.0, 0.0) for number in range(count)]
    return [Seat(("flute",), (asks or {}).get(place, 0.0), 0.0, stage) for place, stage in enumerate(stages)]


def varied(**changes: Sequence[object]) -> list[Candidate]:
    """Candidates who differ by some fields only; ids count from a."""
    rows = zip(*changes.values(), strict=True)
    return [
        msgspec.structs.replace(WOMAN, id="abcdefgh"[number], **dict(zip(changes, row, strict=True)))
        for number, row in enumerate(rows)
    ]


def test_the_largest_instrument_goes_to_the_build_for_it() -> None:
    candidates = varied(build=[0.2, 0.8, 0.5, 0.2])
    assert choose_characters(seats(4, {2: 1.0, 3: 0.5}), candidates)[2:] == ("b", "c")


def test_neighbours_are_unlike_whatever_they_are_called() -> None:
    heights_m = [1.55, 1.56, 1.57, 1.75, 1.76, 1.77]
    tall = {"abcdef"[number]: height_m for number, height_m in enumerate(heights_m)}
    chosen = choose_characters(seats(6), varied(height_m=heights_m))
    assert sorted(chosen) == list("abcdef")
    assert all(abs(tall[one] - tall[other]) > 0.1 for one, other in pairwise(chosen))
    backwards = choose_characters(seats(6), varied(height_m=heights_m[::-1]))
    tall = {"abcdef"[number]: height_m for number, height_m in enumerate(heights_m[::-1])}
    assert all(abs(tall[one] - tall[other]) > 0.1 for one, other in pairwise(backwards))


def test_the_longest_arms_take_the_far_reach() -> None:
    slides = [msgspec.structs.replace(seat, travel_m=0.62) for seat in seats(2)]
    candidates = varied(arm_m=[0.5, 0.6])
    assert choose_characters([*seats(2), *slides], candidates)[2:] == ("b", "b")
    assert sorted(choose_characters(seats(3), candidates)) in (["a", "a", "b"], ["a", "b", "b"])
    assert choose_characters([], candidates) == ()


def test_the_small_are_not_cast_and_later_ages_come_last() -> None:
    candidates = varied(too_small_for=[frozenset({"flute"}), frozenset(), frozenset()], later=[0, 1, 0])
    assert choose_characters(seats(1), candidates) == ("c",)
    assert sorted(choose_characters(seats(2), candidates)) == ["b", "c"]
    assert "a" not in choose_characters(seats(5), candidates)
    everyone = varied(too_small_for=[frozenset({"flute"})])
    assert choose_characters(seats(2), everyone) == ("a", "a")


def test_those_cast_already_stay_and_are_not_chosen_again() -> None:
    chosen = choose_characters(seats(3), varied(height_m=[1.5, 1.6, 1.7]), {0: "b", 1: "one of the user's own"})
    assert chosen[:2] == ("b", "one of the user's own")
    assert chosen[2] in {"a", "c"}


def test_height_muscles_and_weight_make_a_build_and_old_age_takes_of_it() -> None:
    middling = Phenotype(1.7, age=age_of(30.0))
    more = [msgspec.structs.replace(middling, **{name: value}) for name, value in (("height_m", 1.8), ("muscle", 0.7))]
    assert all(build_of(one) > build_of(middling) for one in more)
    assert build_of(msgspec.structs.replace(middling, age=age_of(80.0))) < 0.8 * build_of(middling)


def test_volumes_are_in_the_order_of_weights() -> None:
    order = ["piccolo", "oboe", "trumpet_Bb", "sax_alto_Eb", "euphonium_Bb_bassclef", "tuba_BBb", "sousaphone_BBb"]
    volumes_m3 = [solid_m3(MAPS[name]) for name in order]
    assert volumes_m3 == sorted(volumes_m3)
    # The slide's two tubes and the bell of a trombone, filled, hold between one litre and five.
    assert 0.001 < solid_m3(MAPS["trombone_tenor_F_attachment"]) < 0.005


@pytest.mark.parametrize("years", [ANY_AGE, years_in_title("Lincoln High School Band")], ids=["anyone", "pupils"])
def test_a_band_is_varied_side_by_side(years: Years) -> None:
    stages = stage_seats([footprint(MAPS[name]) for name in BAND])
    chosen = characters_for([[MAPS[name]] for name in BAND], stages, years)
    assert chosen == characters_for([[MAPS[name]] for name in BAND], stages, years)
    assert len({*chosen}) == len(BAND)
    assert not any(name in not_cast_for(id) for name, id in zip(BAND, chosen, strict=True))
    assert all(our_years(id) >= 14.0 for id in chosen)
    bodies = [bundled_person(id).phenotype if id in bundled_people() else originals()[id] for id in chosen]
    assert bodies[-1].height_m > 1.75
    assert our_years(chosen[-1]) < 60.0
    beside = [
        (one, other)
        for one in range(len(BAND))
        for other in range(one)
        if np.hypot(stages[one].x_m - stages[other].x_m, stages[one].z_m - stages[other].z_m) < 1.9
        and BAND[one] == BAND[other]
    ]
    assert len(beside) > 10
    apart_m = [abs(bodies[one].height_m - bodies[other].height_m) for one, other in beside]
    assert np.mean(apart_m) > 0.08
    assert np.mean([bodies[one].sex != bodies[other].sex for one, other in beside]) > 0.4


def test_a_newcomer_is_someone_else() -> None:
    stages = stage_arc(5)
    there = list(zip(characters_for([[MAPS["flute"]]] * 5, stages), stages, strict=True))
    assert newcomers_character(MAPS["flute"], there) not in {id for id, _ in there}
    assert newcomers_character(MAPS["flute"], [])
    for title, youngest, oldest in (("Northside Middle School Band", 14.0, 17.0), ("シニア楽団", 60.0, 90.0)):
        assert youngest <= our_years(newcomers_character(MAPS["tuba_BBb"], there, years_in_title(title))) <= oldest


def test_more_players_than_people_are_shared_out() -> None:
    counts = Counter(characters_for([[MAPS["trumpet_Bb"]]] * 60, stage_arc(60)))
    assert max(counts.values()) == 2


def cast_in(title: str, names: Sequence[str] = BAND) -> list[float]:
    """Ages in years of a band that a title names, by seat."""
    stages = stage_seats([footprint(MAPS[name]) for name in names])
    chosen = characters_for([[MAPS[name]] for name in names], stages, years_in_title(title))
    assert chosen == characters_for([[MAPS[name]] for name in names], stages, years_in_title(title))
    assert not any(name in not_cast_for(id) for name, id in zip(names, chosen, strict=True))
    return [our_years(id) for id in chosen]


@pytest.mark.parametrize(
    "title",
    [
        *("Maple Elementary School Winter Songs", "Primary School Band", "Elementary Band Warm-Ups", "Kids Band"),
        *("Children's Concert Band", "Children’s Orchestra", "みなみ小学校 音楽会", "子どもバンド", "キッズブラス"),
    ],
)
def test_children_play_in_their_own_bands(title: str) -> None:
    children = sum(our_years(id) < 14.0 for id in bundled_people())
    ages = cast_in(title)
    assert sum(age < 14.0 for age in ages) == children
    assert max(ages) < 21.0
    assert max(cast_in(title, ("bassoon", "clarinet_Bb", "trumpet_Bb"))) < 14.0
    assert 14.0 <= cast_in(title, ("flute",))[0] < 16.0, "children are too small for it"


@pytest.mark.parametrize(
    ("title", "youngest", "oldest"),
    [
        ("Oakfield Middle School", 14.0, 17.0),
        ("Junior High School Band", 14.0, 17.0),
        ("第三中学校 校歌", 14.0, 17.0),
        ("Lincoln High School Senior Band", 14.0, 21.0),
        ("Valley Youth Orchestra", 14.0, 21.0),
        ("県立西高等学校吹奏楽部", 14.0, 21.0),
        ("Senior Citizens Band", 60.0, 91.0),
        ("The Seniors' Wind Band", 60.0, 91.0),
        ("シニア吹奏楽団", 60.0, 91.0),
    ],
)
def test_a_duo_has_the_ages_of_the_band_in_its_title(title: str, youngest: float, oldest: float) -> None:
    assert {youngest <= age < oldest for age in cast_in(title, ("flute", "clarinet_Bb"))} == {True}


def test_pupils_do_not_play_among_elders() -> None:
    ages = sorted(cast_in("Senior Citizens Band"))
    assert ages[0] > 21.0
    assert ages.count(ages[-1]) > 1, "someone plays twice rather than a pupil"
    assert min(cast_in("敬老の日コンサート", ("flute",) * 5)) > 45.0


@pytest.mark.parametrize(
    "title",
    [
        *("", "Children's March", "Children's Corner", "Senior Recital", "High School Musical", "Old-school funk"),
        *("Elementary, my dear Watson", "Middle of the Night", "こどもの日", "小さな世界"),
    ],
)
def test_a_title_that_names_no_band_leaves_ages_open(title: str) -> None:
    assert years_in_title(title) == ANY_AGE
