"""``suisou evaluate results``: tables and a report of the viewers' answers."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.speech import said, sentence, spoken
from app.cli.summary import columns
from app.cli.terminal import say
from app.encoding import shown

if TYPE_CHECKING:
    from app.evaluation.tables import ResultTable


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of the command that evaluates viewers' answers."""
    command.add_argument("files", type=Path, nargs="+", metavar="FILE.csv")
    command.add_argument("--key", type=Path, metavar="KEY.json")
    command.add_argument("--to", type=Path, metavar="DIR")
    command.set_defaults(run=results)


def results(arguments: argparse.Namespace) -> None:
    """Tabulate the answers, print the tables and write the report.

    Raises
    ------
    AppError
        The answers cannot be read, or the report cannot be written.
    """
    from app.evaluation.conclusions import conclude
    from app.evaluation.report import write_results
    from app.evaluation.tables import tables
    from app.evaluation.viewer_files import gather

    gathered = gather(arguments.files, arguments.key)
    found, measured = gathered.results, gathered.measures
    say(said("results.title", piece=found.piece))
    for table in tables(found, measured, spoken().language):
        say("", *table_lines(table))
    conclusions = conclude(found)
    for heading, messages in (("results.may", conclusions.may), ("results.may_not", conclusions.may_not)):
        say("", f"{said(heading)}:", *(f"- {sentence(message)}" for message in messages))
    if arguments.to is not None:
        written = write_results(found, measured, arguments.to)
        say("", f"{shown(arguments.to)}: {', '.join(path.name for path in written)}")


def table_lines(table: ResultTable) -> list[str]:
    """Return a table as lines of text, with numbers aligned right."""
    return [table.title, *columns([table.head, *table.rows], names=table.names), f"({table.note})"]
