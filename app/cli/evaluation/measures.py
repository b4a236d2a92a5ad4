"""``suisou evaluate measures``: measurements of a piece that need no viewers."""

from __future__ import annotations

import argparse

from app.cli.evaluation.results import table_lines
from app.cli.options import add_file_options, open_project
from app.cli.speech import spoken
from app.cli.terminal import say


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of the command that measures variants of an evaluation."""
    add_file_options(command)
    command.set_defaults(run=measures, settings=[])


def measures(arguments: argparse.Namespace) -> None:
    """Measure a piece and print the table."""
    from app.evaluation.measures import measure
    from app.evaluation.tables import measures_table
    from app.performance.ensemble import Performance

    performance = Performance(open_project(arguments))
    say(*table_lines(measures_table([measure(performance)], spoken().language)))
