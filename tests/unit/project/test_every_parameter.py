"""Code that handles parameters handles every declared one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import FileError, UsageError
from app.plan.parameters import PARAMETERS, Parameter, PlayerParameters
from app.project import presets
from app.project.edit import dancers, players
from app.project.migrations import CURRENT, MIGRATIONS
from app.project.model import DANCER_PARAMETERS, Project
from app.project.parameters import parse_settings, with_settings
from app.project.performers import Dancer
from app.project.storage import decode, encode
from tests.support.parameters import others
from tests.unit.project.pieces import full_project, small_project

FILE = Path("/music/piece.suisou")
EVERY = pytest.mark.parametrize("parameter", PARAMETERS.values(), ids=PARAMETERS)
OF_DANCERS = pytest.mark.parametrize("parameter", DANCER_PARAMETERS.values(), ids=DANCER_PARAMETERS)


def other(parameter: Parameter) -> object:
    return others(parameter, parameter.default)[-1]


def outside(parameter: Parameter) -> list[object]:
    low, high = parameter.bounds or (0, 0)
    return [parameter.kind(low - 1), parameter.kind(high * 1.5)] if parameter.bounds else [7]


def is_players(parameter: Parameter) -> bool:
    return PARAMETERS.get(parameter.name) is parameter


def with_value(project: Project, parameter: Parameter, value: object) -> Project:
    """Project whose first player or dancer has a value, valid or not."""
    if is_players(parameter):
        first, *rest = project.players
        changed = msgspec.structs.replace(first.parameters, **{parameter.name: value})
        return replace(project, players=(msgspec.structs.replace(first, parameters=changed), *rest))
    front, *behind = project.dancers
    return replace(project, dancers=(msgspec.structs.replace(front, **{parameter.name: value}), *behind))


def test_every_field_of_a_player_and_every_number_of_a_dancer_is_declared() -> None:
    assert tuple(PARAMETERS) == PlayerParameters.__struct_fields__
    numbers = [field.name for field in msgspec.structs.fields(Dancer) if isinstance(field.default, int | float)]
    assert list(DANCER_PARAMETERS) == [name for name in numbers if name != "mirrored"]


@pytest.mark.parametrize("parameter", [*PARAMETERS.values(), *DANCER_PARAMETERS.values()], ids=lambda one: one.name)
def test_a_declaration_says_all_that_is_needed(parameter: Parameter) -> None:
    assert parameter.label
    assert parameter.decides
    assert (parameter.bounds is not None) == (parameter.kind in (int, float))
    assert parameter.allows(parameter.default)
    assert parameter.allows(parameter.in_older_files)
    assert 1 <= parameter.since <= CURRENT
    assert not parameter.spread or parameter.kind is float


@EVERY
def test_it_is_set_by_its_name(parameter: Parameter) -> None:
    for value in others(parameter, parameter.default):
        said = "auto" if value is None else str(value)
        settings = parse_settings([f"*.{parameter.name}={said}"], ["a"], [], [])
        assert getattr(with_settings(PlayerParameters(), settings), parameter.name) == value
    for value in outside(parameter):
        with pytest.raises(UsageError) as raised:
            parse_settings([f"*.{parameter.name}={value}"], ["a"], [], [])
        assert raised.value.message.id == "set.value_invalid"
        assert str((parameter.bounds or ("",))[-1]) in str(raised.value.message.arguments["possible"])


@pytest.mark.parametrize("parameter", [*PARAMETERS.values(), *DANCER_PARAMETERS.values()], ids=lambda one: one.name)
def test_it_is_saved_and_checked_and_older_files_mean_what_they_meant(parameter: Parameter) -> None:
    project = with_value(full_project("/music"), parameter, other(parameter))
    content = encode(project, FILE)
    assert decode(content, FILE) == project
    for value in outside(parameter):
        with pytest.raises(FileError, match=parameter.name):
            encode(with_value(project, parameter, value), FILE)
    if parameter.since > 1:
        raw = {"players": [{"parameters": {}}], "dancers": [{}], "score": {"unplayed": []}, "corrections": {}}
        new = MIGRATIONS[parameter.since](raw)
        holder = new["players"][0]["parameters"] if is_players(parameter) else new["dancers"][0]
        assert holder[parameter.name] == parameter.in_older_files


@EVERY
def test_a_preset_has_what_is_for_many(parameter: Parameter, tmp_path: Path) -> None:
    value = other(parameter)
    presets.save_preset(tmp_path, presets.preset_of(PlayerParameters(**{parameter.name: value}), "mine"))
    kept = presets.presets(tmp_path).items["mine"].parameters
    assert kept.get(parameter.name) == (None if parameter.is_own else value)
    project = small_project()
    changed = players.set_parameters(project, [project.players[0].id], **kept)
    had = getattr(project.players[0].parameters, parameter.name)
    assert getattr(changed.players[0].parameters, parameter.name) == (had if parameter.is_own else value)


@EVERY
def test_the_dice_vary_it_about_the_middle_or_leave_it(parameter: Parameter) -> None:
    project = small_project()
    everyone = [player.id for player in project.players]
    same = players.set_parameters(project, everyone, **{parameter.name: getattr(PlayerParameters(), parameter.name)})
    wide = players.randomise(same, everyone, 1.0)
    values = [getattr(player.parameters, parameter.name) for player in wide.players]
    assert all(parameter.allows(value) for value in values)
    if parameter.spread:
        assert len(set(values)) == len(values)
        assert all(abs(value - parameter.default) <= 2 * parameter.spread for value in values)
    else:
        assert set(values) == {parameter.default} or parameter.name in ("seed", "habits")


@EVERY
def test_it_goes_back_to_what_the_player_was_cast_with(parameter: Parameter) -> None:
    project = small_project()
    first = project.players[0]
    now = getattr(first.parameters, parameter.name)
    changed = players.set_parameters(project, [first.id], **{parameter.name: others(parameter, now)[0]})
    assert changed != project
    back = players.reset_parameters(changed, [first.id], [parameter.name]).players[0].parameters
    cast = players.cast_parameters(project, first.id, players.instrument_of(first))
    assert back == msgspec.structs.replace(first.parameters, **{parameter.name: getattr(cast, parameter.name)})


@OF_DANCERS
def test_a_dancers_number_is_held_within_its_bounds(parameter: Parameter) -> None:
    project = full_project("/music")
    for bound, value in zip(parameter.bounds or (), outside(parameter), strict=True):
        changed = dancers.change_dancers(project, [project.dancers[0].id], **{parameter.name: value})
        held = getattr(changed.dancers[0], parameter.name)
        assert held == bound
        assert type(held) is parameter.kind
