"""``suisou instruments``: list the instrument maps, or check one."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.options import Commands
from app.errors import AppError
from app.messages import text

_NOTES = ("C", "C#", "D", "Eb", "E", "F", "F#", "G", "Ab", "A", "Bb", "B")


class InvalidMapError(AppError):
    """A checked map has problems; they have been printed."""


def add_command(commands: Commands) -> None:
    """Declare the sub-command."""
    command = commands.add_parser(
        "instruments",
        help="list the instrument maps, or check one",
        description="Lists the instrument maps the program knows. 'instruments check FILE' validates a map.",
    )
    command.set_defaults(run=list_maps)
    actions = command.add_subparsers(title="actions", metavar="ACTION")
    check = actions.add_parser(
        "check",
        help="validate a map: says the line of a syntax error, else the key path that is wrong",
        description="Validates an instrument map, its model included. Exit status 0: valid, 1: not.",
    )
    check.add_argument("file", type=Path, metavar="FILE", help="a .toml file")
    check.set_defaults(run=check_map)


def list_maps(arguments: argparse.Namespace) -> None:
    """Print every bundled map: id, name, concert range, number of fingerings."""
    from instrument_maps.library import all_maps

    maps = all_maps().values()
    width = max((len(instrument.id) for instrument in maps), default=0)
    names = max((len(instrument.name.en) for instrument in maps), default=0)
    for instrument in maps:
        span = f"{note_name(instrument.range.low)} - {note_name(instrument.range.high)}"
        controls = ", ".join(control.name for control in instrument.controls)
        print(f"{instrument.id:{width}}  {instrument.name.en:{names}}  {span:9}  {controls}")


def check_map(arguments: argparse.Namespace) -> None:
    """Print every problem of a map file.

    Raises
    ------
    InvalidMapError
        There are problems.
    """
    from instrument_maps.load import check_map as problems_of

    problems = problems_of(arguments.file)
    for problem in problems:
        print(text(problem))
    if problems:
        raise InvalidMapError("instruments.invalid", file=arguments.file.name, count=len(problems))
    print(f"{arguments.file.name}: valid")


def note_name(pitch: int) -> str:
    """A concert pitch in scientific notation; 60 is C4."""
    return f"{_NOTES[pitch % 12]}{pitch // 12 - 1}"
