"""Valid values of parameters, and messages about invalid ones."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from app.errors import UsageError
from app.plan.parameters import PlayerParameters
from app.project.parameters import (
    matching_players,
    parameter_names,
    parse_settings,
    select_players,
    with_settings,
)

NAMES = ["trumpet 1", "trumpet 2", "1. Pos.x=y [alt]"]
INSTRUMENTS = ["horn_F", "trumpet_Bb"]
CHARACTERS = ["adult_woman", "adult_man"]


def set_all(*texts: str) -> dict[tuple[int, str], object]:
    settings = parse_settings(texts, NAMES, INSTRUMENTS, CHARACTERS)
    return {(setting.player, setting.parameter): setting.value for setting in settings}


def test_every_field_can_be_set() -> None:
    fields = {field.name for field in msgspec.structs.fields(PlayerParameters)}
    assert set(parameter_names()) == fields | {"instrument", "character"}


def test_values_get_their_types() -> None:
    assert set_all("trumpet 1.amplitude=0.25", "TRUMPET 2.seed=7", "trumpet 2.cue_leader=true") == {
        (0, "amplitude"): 0.25,
        (1, "seed"): 7,
        (1, "cue_leader"): True,
    }


def test_a_pattern_means_all_and_the_last_one_wins() -> None:
    assert set_all("*.posture=seated", "trumpet 2.posture=standing") == {
        (0, "posture"): "seated",
        (1, "posture"): "standing",
        (2, "posture"): "seated",
    }


def test_a_name_may_hold_the_seam_and_pattern_signs() -> None:
    assert set_all("1. Pos.x=y [alt].amplitude=1") == {(2, "amplitude"): 1.0}
    assert matching_players("1. pos.x=y [ALT]", NAMES) == (2,)


def test_automatic_values() -> None:
    assert set_all("trumpet 1.cue_leader=auto", "trumpet 1.character=auto") == {
        (0, "cue_leader"): None,
        (0, "character"): None,
    }


def test_a_choreography_is_bundled_or_a_file_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert set_all(
        "trumpet 1.choreography=salsa", "trumpet 2.choreography=dances/Tango.choreography", "1*.choreography=none"
    ) == {
        (0, "choreography"): "salsa",
        (1, "choreography"): str(tmp_path / "dances" / "Tango.choreography"),
        (2, "choreography"): "",
    }


@pytest.mark.parametrize(
    ("text", "id", "mentions"),
    [
        ("trumpet 1", "set.syntax", "trumpet 1"),
        (".amplitude=1", "set.syntax", ".amplitude=1"),
        ("tuba.amplitude=1", "set.player_unknown", "trumpet 2"),
        ("trumpet 1.volume=1", "set.parameter_unknown", "breath_min_beats"),
        ("trumpet 1.amplitude=2", "set.value_invalid", "1.0"),
        ("trumpet 1.amplitude=nan", "set.value_invalid", "1.0"),
        ("trumpet 1.amplitude=inf", "set.value_invalid", "1.0"),
        ("trumpet 1.amplitude=", "set.value_invalid", "1.0"),
        ("trumpet 1.amplitude=auto", "set.value_invalid", "1.0"),
        ("trumpet 1.posture=lying", "set.value_invalid", "seated"),
        ("trumpet 1.cue_leader=perhaps", "set.value_invalid", "false"),
        ("trumpet 1.seed=0.5", "set.value_invalid", "0 ..."),
        ("trumpet 1.instrument=kazoo", "set.value_invalid", "horn_F"),
        ("trumpet 1.character=../x", "set.value_invalid", "adult_man"),
        ("trumpet 1.choreography=tango", "set.value_invalid", "salsa"),
        ("trumpet 1.choreography=tango.bvh", "set.value_invalid", "*.choreography"),
        ("trumpet 1.dance_amount=1.5", "set.value_invalid", "1.0"),
    ],
)
def test_errors_name_what_is_possible(text: str, id: str, mentions: str) -> None:
    with pytest.raises(UsageError) as error:
        set_all(text)
    assert error.value.message.id == id
    assert mentions in " ".join(str(value) for value in error.value.message.arguments.values())


def test_settings_change_only_what_they_name() -> None:
    settings = parse_settings(["*.amplitude=1", "*.instrument=horn_F"], ["a"], INSTRUMENTS, CHARACTERS)
    assert with_settings(PlayerParameters(), settings) == PlayerParameters(amplitude=1.0)


def test_players_are_chosen_by_name_in_score_order() -> None:
    assert select_players([], NAMES) == (0, 1, 2)
    assert select_players(["1. Pos.x=y [alt]", "Trumpet 1"], NAMES) == (0, 2)
    with pytest.raises(UsageError) as error:
        select_players(["oboe"], NAMES)
    assert error.value.message.id == "player.unknown"
