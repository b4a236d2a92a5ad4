"""``suisou midi``: writes the piece as a MIDI file."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.options import add_file_options, add_title_option, open_project
from app.cli.speech import said, sentence
from app.cli.terminal import say, warn
from app.errors import FileError


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou midi``."""
    add_file_options(command)
    add_title_option(command)
    command.add_argument("--to", type=Path, required=True, metavar="FILE")
    command.set_defaults(run=write, settings=[])


def write(arguments: argparse.Namespace) -> None:
    """Write the project's score as a MIDI file and print its contents."""
    from app.project.midi_out import export_midi
    from instrument_maps.library import library

    project = open_project(arguments)
    if _same(arguments.to, arguments.file):
        raise FileError("midi.onto_itself", file=str(arguments.to))
    for warning in export_midi(project, arguments.to, library().maps):
        warn(sentence(warning))
    notes = sum(len(part.notes) for part in project.score.parts)
    hits = len(project.score.percussion)
    counts = {"tracks": len(project.score.parts) + (hits > 0), "notes": notes, "hits": hits}
    say(said("midi.file_written_with_hits" if hits else "midi.file_written", file=str(arguments.to), **counts))


def _same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:
        return False  # the output file does not exist yet
