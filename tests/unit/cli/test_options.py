"""Options and their values as users type them."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from app.cli import parser
from app.cli.commands import DESCRIPTION, SHARED, SUMMARY, CommandParser, help_texts
from app.cli.options import AUTOMATIC, beats, felt_beat, frame_rate, whole_number
from app.errors import UsageError
from app.project.parameters import parameter_names, parse_settings


@pytest.mark.parametrize("typed", ["0", "-30", "1000", "fast", "30/", "1e-999999999"])
def test_what_is_no_frame_rate(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        frame_rate(typed)


@pytest.mark.parametrize("typed", ["-1", "1.5", "x", "", "1e3", "9" * 30])
def test_what_is_no_whole_number(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        whole_number(typed)


@pytest.mark.parametrize("typed", ["-1", "nan", "inf", "x", "65"])
def test_what_are_no_beats(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        beats(typed)


def test_numbers() -> None:
    assert whole_number("0") == 0
    assert whole_number(str(2**63 - 1)) == 2**63 - 1
    assert whole_number("12") == 12
    assert beats("2.5") == 2.5
    assert frame_rate("29.97") == Fraction(30000, 1001)
    assert felt_beat("3/2") == 1.5
    assert felt_beat("Auto") == AUTOMATIC


def options(command: CommandParser, name: str = "") -> Iterator[tuple[str, argparse.Action]]:
    """Every option of every command, by command and name."""
    command.complete()
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for sub_name, sub in action.choices.items():
                yield from options(sub, f"{name} {sub_name}")
        else:
            yield f"{name} {'/'.join(action.option_strings) or action.dest}", action


NUMBERS = {
    name: action.type
    for name, action in options(parser())
    if action.type not in (None, Path) and name != " stream --host"
}
"""Functions that parse the texts of options that are neither texts nor paths."""


@pytest.mark.parametrize(
    "typed", ["nan", "inf", "-inf", "1e400", "1e999999999", "-1e30", "9" * 30, "9" * 5000, "1/0", ""]
)
def test_no_option_takes_what_is_no_number_of_its_range(typed: str) -> None:
    assert len(NUMBERS) >= 15
    for name, read in NUMBERS.items():
        assert callable(read)
        assert read not in (int, float), f"{name}: argparse would not say what is possible"
        with pytest.raises(argparse.ArgumentTypeError):
            read(typed)


@pytest.mark.parametrize("typed", ["nan", "inf", "-inf", "1e400", "9" * 5000])
def test_no_parameter_takes_what_is_no_number(typed: str) -> None:
    for name in parameter_names():
        with pytest.raises(UsageError) as refused:
            parse_settings([f"*.{name}={typed}"], ["Trumpet"], ["trumpet_Bb"], ["character_a"])
        assert refused.value.message.id == "set.value_invalid"
        assert refused.value.message.arguments["possible"]


def test_the_error_names_the_option_and_what_is_possible(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["stream", "x.mid", "--from", "nan"])
    assert "argument --from: 'nan' is not a number of seconds from -86400 to 86400" in capsys.readouterr().err


def test_everything_is_explained_and_every_explanation_read() -> None:
    unread = {(name, option) for name, texts in help_texts().items() for option in texts}
    pending: list[argparse.ArgumentParser] = [parser()]
    while pending:
        command = pending.pop()
        if isinstance(command, CommandParser):
            command.complete()
        name = command.prog.partition(" ")[2]
        assert command.description, command.prog
        for action in command._actions:
            if isinstance(action, argparse._SubParsersAction):
                pending += action.choices.values()
                continue
            assert action.help, (command.prog, action.dest)
            option = action.option_strings[-1] if action.option_strings else action.dest
            unread -= {(name, option), (SHARED, option)}
        unread -= {(name, DESCRIPTION), (name, SUMMARY)}
    assert unread == set()
