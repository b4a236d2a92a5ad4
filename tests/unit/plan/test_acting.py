"""A player's amounts from style, habits, variation and the section's intensity."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from msgspec.structs import replace

from app.plan.acting import MOST, Acting, acting_of, with_style
from app.plan.parameters import PARAMETERS, PlayerParameters
from metadata.acting import AMOUNTS, Factors, Habit, Style
from metadata.library import metadata_library
from metadata.tables import Title

STYLES, HABITS = metadata_library().styles.items, metadata_library().habits.items
EXACT = {"plain": Style("plain", Title("Plain"), factors=Factors(sway=0.5, face_intensity=2.0), variation=0.0)}
SWAYS = {"swayer": Habit("swayer", Title("Swayer"), Factors(sway=3.0))}


def test_usual_parameters_are_the_usual_acting() -> None:
    assert acting_of(PlayerParameters()) == Acting()


def test_every_amount_reaches_its_layer() -> None:
    for name in AMOUNTS:
        changed = acting_of(replace(PlayerParameters(), **{name: 0.5}))
        differing = [field for field in Acting.__struct_fields__ if getattr(changed, field) != getattr(Acting(), field)]
        assert len(differing) == 1, name
        assert getattr(changed, differing[0]) == pytest.approx(0.5 * getattr(Acting(), differing[0]))


def test_no_one_is_still_more_than_always() -> None:
    assert acting_of(PlayerParameters(stillness=40.0)).stillness == 1.0


def test_style_habits_parameter_and_section_multiply() -> None:
    said = PlayerParameters(style="plain", habits="swayer", sway=0.8)
    shown = with_style(said, "a", 0.5, EXACT, SWAYS)
    assert shown.sway == pytest.approx(0.8 * 0.5 * 3.0 * 0.5)
    assert shown.face_intensity == pytest.approx(2.0 * 0.5)
    assert shown.stillness == 1.0, "less acting is not less stillness"
    assert shown.amplitude == said.amplitude
    nothing = acting_of(with_style(said, "a", 0.0, EXACT, SWAYS))
    assert [name for name in Acting.__struct_fields__ if getattr(nothing, name) > 0.0] == ["stillness", "blink"]


def test_a_layer_that_is_off_is_not_shown() -> None:
    said = PlayerParameters(layers_off="gaze,stillness", habits="swayer")
    shown, without = (with_style(one, "a", 1.0, EXACT, SWAYS) for one in (said, replace(said, layers_off="")))
    assert shown == replace(without, layers_off="gaze,stillness", gaze=0.0, stillness=0.0)


def test_layers_are_named_as_there_are() -> None:
    off = PARAMETERS["layers_off"]
    assert off.read("sway, gaze") == "gaze,sway"
    assert off.read("none") == ""
    assert off.possible.startswith("none, sway, weight_shift")
    assert not off.allows("gaze,walk")
    with pytest.raises(ValueError, match="walk"):
        off.read("walk")


def test_what_is_not_there_changes_nothing() -> None:
    said = PlayerParameters(style="gone", habits="gone", sway=0.7)
    assert with_style(said, "a", 1.0, EXACT, SWAYS) == said


def test_an_amount_is_bounded() -> None:
    said = PlayerParameters(style="plain", habits="swayer", sway=2.0, face_intensity=2.0)
    shown = with_style(said, "a", 2.0, EXACT, SWAYS)
    assert (shown.sway, shown.face_intensity) == (MOST, MOST)


def test_a_section_varies_within_its_bounds_and_has_no_clones() -> None:
    players = [f"player:{number}" for number in range(12)]
    shown = [with_style(PlayerParameters(seed=3), id, 1.0, STYLES, HABITS) for id in players]
    table = np.array([[getattr(one, name) for name in AMOUNTS] for one in shown])
    assert table.min() >= 0.8
    assert table.max() <= 1.2
    assert table.std(axis=0).min() > 0.05, "each amount differs from player to player"
    for one, other in itertools.combinations(table, 2):
        assert np.abs(one - other).max() > 0.1
    assert shown[0] == with_style(PlayerParameters(seed=3), players[0], 1.0, STYLES, HABITS)
    assert shown[0] != with_style(PlayerParameters(seed=4), players[0], 1.0, STYLES, HABITS)


def test_styles_differ_from_each_other_as_their_names_say() -> None:
    shown = {name: acting_of(with_style(PlayerParameters(style=name), "a", 1.0, STYLES, HABITS)) for name in STYLES}
    assert shown["reserved"].phrase < shown["section_player"].phrase < shown["soloist"].phrase
    assert shown["reserved"].stillness > shown["section_player"].stillness > shown["jazz"].stillness
    assert shown["jazz"].tap > 1.5 * shown["section_player"].tap
    assert shown["marching_band"].tap == 0.0
    assert shown["marching_band"].sway < 0.4
