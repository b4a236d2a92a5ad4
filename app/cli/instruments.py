"""``suisou instruments``: list the instrument maps, show the fingerings of one, or check one."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.summary import columns
from app.cli.terminal import say
from app.encoding import shown
from app.errors import AppError
from app.messages import text
from app.messages.pitches import pitch_name


class InvalidMapError(AppError):
    """A checked map has problems; they have been printed."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the sub-command."""
    command.set_defaults(run=list_maps)
    actions = command.add_subparsers(title="actions", metavar="ACTION")
    scale = actions.add_parser("scale", help="print the fingerings of an instrument in a chromatic scale of its range")
    scale.add_argument("id", metavar="ID")
    scale.add_argument("--first", action="store_true")
    scale.set_defaults(run=print_scale)
    check = actions.add_parser(
        "check", help="validate a map: says the line of a syntax error, else the key path that is wrong"
    )
    check.add_argument("file", type=Path, metavar="FILE")
    check.set_defaults(run=check_map)


def list_maps(arguments: argparse.Namespace) -> None:
    """Print every map: id, name, concert range, transposition, what the player moves; then the user's own folder and
    what is wrong in it."""
    from instrument_maps.library import library

    known = library()
    rows = [
        (
            f"{instrument.id}{'*' if instrument.id in known.own else ''}",
            instrument.name.en,
            f"{pitch_name(instrument.range.low)} - {pitch_name(instrument.range.high)}",
            transposition(instrument.transposition_semitones),
            ", ".join(control.label or control.name for control in instrument.controls),
        )
        for instrument in known.in_score_order
    ]
    say(*columns([("id", "name", "sounds", "written", "controls"), *rows], of_numbers=False))
    say("", f"your own (*): {shown(known.folder)}")
    for problems in known.problems.values():
        for problem in problems:
            say(f"  {text(problem)}")


def print_scale(arguments: argparse.Namespace) -> None:
    """Print the fingerings of a chromatic scale. Raises MapError where there is no such instrument."""
    from instrument_maps.fingering_label import says_words
    from instrument_maps.fingering_words import fingering_words
    from instrument_maps.library import find_map

    instrument = find_map(arguments.id)
    words = says_words(instrument.controls)
    rows = []
    for pitch in range(instrument.range.low, instrument.range.high + 1):
        for fingering in instrument.fingerings_for(pitch)[: 1 if arguments.first else None]:
            first = fingering.rank == 1
            rows.append(
                (
                    pitch_name(pitch) if first else "",
                    pitch_name(fingering.written_pitch) if first else "",
                    str(fingering.rank),
                    fingering.label,
                    f"{fingering.cents:+.0f}" if round(fingering.cents) else "",
                    ", ".join(fingering.tags),
                    *([fingering_words(instrument, fingering.label, "en")] if words else []),
                )
            )
    head = ("sounds", "written", "rank", "fingering", "cents", "for", *(["keys"] if words else []))
    say(*columns([head, *rows], of_numbers=False))


def transposition(semitones: int) -> str:
    """Interval between written and sounding pitch: ``"+2"``, ``"as it sounds"``."""
    return f"{semitones:+d}" if semitones else "as it sounds"


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
        say(text(problem))
    if problems:
        raise InvalidMapError("instruments.invalid", file=arguments.file.name, count=len(problems))
    say(f"{shown(arguments.file.name)}: valid")
