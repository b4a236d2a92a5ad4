"""``suisou instruments``: lists the instrument maps, prints the fingerings of one, or checks a map file."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.commands import add_actions, add_pitch_options
from app.cli.speech import said, sentence, spoken
from app.cli.summary import columns, heads
from app.cli.terminal import say
from app.errors import AppError
from app.messages import WORDINGS


class InvalidMapError(AppError):
    """A checked map has problems; they have been printed."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou instruments``."""
    command.set_defaults(run=list_maps)
    add_pitch_options(command, of_players=False)
    actions = add_actions(command)
    scale = actions.add_parser("scale", help="")
    scale.add_argument("id", metavar="ID")
    scale.add_argument("--first", action="store_true")
    add_pitch_options(scale, of_players=False)
    scale.set_defaults(run=print_scale)
    check = actions.add_parser("check", help="")
    check.add_argument("file", type=Path, metavar="FILE")
    check.set_defaults(run=check_map)


def list_maps(arguments: argparse.Namespace) -> None:
    """Print every map (id, name, concert range, transposition, moving parts), then the user's own folder and the faults
    in it.
    """
    from instrument_maps.library import library

    known, speech = library(), spoken()
    rows = [
        (
            f"{instrument.id}{'*' if instrument.id in known.own else ''}",
            speech.name(instrument.name),
            f"{speech.pitch(instrument.range.low)} - {speech.pitch(instrument.range.high)}",
            transposition(instrument.transposition_semitones),
            ", ".join(control.label or control.name for control in instrument.controls),
        )
        for instrument in known.in_score_order
    ]
    say(*columns([heads("instruments.heads"), *rows], of_numbers=False))
    say("", said("cli.own_folder", folder=str(known.folder)))
    for problems in known.problems.values():
        for problem in problems:
            say(f"  {sentence(problem)}")


def print_scale(arguments: argparse.Namespace) -> None:
    """Print the fingerings of a chromatic scale. Raises MapError for an unknown instrument."""
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
                    spoken().pitch(pitch) if first else "",
                    spoken().pitch(fingering.written_pitch) if first else "",
                    str(fingering.rank),
                    fingering.label,
                    f"{fingering.cents:+.0f}" if round(fingering.cents) else "",
                    ", ".join(map(word_of_tag, fingering.tags)),
                    *([fingering_words(instrument, fingering.label, spoken().language)] if words else []),
                )
            )
    titles = heads("instruments.scale_heads")
    say(*columns([titles if words else titles[:-1], *rows], of_numbers=False))


def word_of_tag(tag: str) -> str:
    """Return the reason for an alternate fingering in the user's language; a tag from the user's own map is returned
    unchanged.
    """
    id = f"fingering_tag.{tag}"
    return said(id) if id in WORDINGS else tag


def transposition(semitones: int) -> str:
    """Return the interval from sounding to written pitch as text: ``"+2"``, or "as it sounds" for none."""
    return f"{semitones:+d}" if semitones else said("instruments.as_it_sounds")


def check_map(arguments: argparse.Namespace) -> None:
    """Print every problem of a map file.

    Raises
    ------
    InvalidMapError
        The map has problems.
    """
    from instrument_maps.load import check_map as problems_of

    problems = problems_of(arguments.file)
    for problem in problems:
        say(sentence(problem))
    if problems:
        raise InvalidMapError("instruments.invalid", file=arguments.file.name, count=len(problems))
    say(said("cli.valid", file=arguments.file.name))
