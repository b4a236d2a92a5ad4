"""``suisou metadata``: lists styles, habits, expressions, gestures and rules; saves, loads and compares those of a
piece.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.speech import said, sentence, spoken
from app.cli.summary import columns, heads
from app.cli.terminal import say, warn
from app.encoding import shown
from app.errors import AppError, Message, UsageError
from app.messages import WORDINGS
from app.messages.wordings import wording

if TYPE_CHECKING:
    from metadata.rules import Rule


class InvalidMetadataError(AppError):
    """A checked table has problems; they have been printed."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou metadata``."""
    command.add_argument("piece", type=Path, nargs="?", metavar="PIECE")
    what = command.add_mutually_exclusive_group()
    what.add_argument("--check", type=Path, metavar="FILE")
    what.add_argument("--save", type=Path, metavar="FILE")
    what.add_argument("--load", type=Path, metavar="FILE")
    what.add_argument("--diff", type=Path, metavar="FILE")
    command.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Run the requested action.

    Raises
    ------
    UsageError
        The action needs a piece and none was given.
    """
    asked = arguments.save or arguments.load or arguments.diff
    if asked and arguments.piece is None:
        raise UsageError("metadata.no_piece")
    if arguments.piece is not None and not asked:
        raise UsageError("metadata.nothing_asked")
    if arguments.check:
        check(arguments.check)
    elif arguments.save:
        save(arguments.piece, arguments.save)
    elif arguments.load:
        load(arguments.piece, arguments.load)
    elif arguments.diff:
        diff(arguments.piece, arguments.diff)
    else:
        list_all()


def list_all() -> None:
    """Print every table of metadata (name, title, whether it is the user's own), then the folders and their faulty
    files.
    """
    from app.formats.user_folder import Shelf
    from metadata.library import FOLDERS, metadata_library

    library = metadata_library()
    strange = {name: _unknown_names(library.rules.items[name].rules) for name in library.rules.files}
    name_of = spoken().name
    rows = [heads("metadata.heads")]
    shelves: tuple[Shelf[Any], ...] = library
    for folder, shelf in zip(FOLDERS, shelves, strict=True):
        for name, item in sorted(shelf.items.items()):
            title = getattr(item, "title", None)
            plain = _described(folder.name, item.description, name) if title is None else name_of(item.description)
            described = plain if title is None else f"{name_of(title)}: {plain}"
            rows.append((folder.name, f"{name}{'*' if name in shelf.files else ''}", described))
    say(*columns(rows, of_numbers=False), "", said("cli.own_folders"))
    for shelf in shelves:
        say(f"  {shown(shelf.folder)}")
        for problems in shelf.problems.values():
            say(*(f"    {sentence(problem)}" for problem in problems))
        if shelf is library.rules:
            for name, unknown in strange.items():
                say(*(f"    rules/{shown(name)}.toml: {sentence(message)}" for message in unknown))


def _described(folder: str, description: str, name: str) -> str:
    """Return the description of a table, in the user's language if the table is bundled."""
    id = f"metadata.described_{folder}_{name}"
    return said(id) if id in WORDINGS and wording(id, "en") == description else description


def check(file: Path) -> None:
    """Validate a table as the kind that its folder's name indicates.

    Raises
    ------
    UsageError
        The folder's name is not that of a kind.
    AppError
        The table is invalid, or a rule refers to an unknown name.
    """
    from metadata.library import READERS
    from metadata.rules import RuleSet

    folder = file.absolute().parent.name
    if folder not in READERS:
        raise UsageError("metadata.no_kind", folder=folder, known=", ".join(READERS))
    found = READERS[folder](file)
    unknown = _unknown_names(found.rules) if isinstance(found, RuleSet) else []
    if unknown:
        raise InvalidMetadataError(unknown[0].id, **unknown[0].arguments)
    say(said("cli.valid", file=file.name))


def _unknown_names(rules: Iterable[Rule]) -> list[Message]:
    """Return messages about expressions, gestures, styles and habits that rules name but that do not exist, so that
    such a rule has no effect.
    """
    from app.plan.rule_conditions import unknown_in
    from metadata.library import metadata_library

    library, found = metadata_library(), list[Message]()
    for rule in rules:
        unknown = unknown_in(rule, library.expressions_by_name, library.gestures.items)
        found += [] if unknown is None else [unknown]
        for kind, names, known in (
            ("style", (*rule.when.styles, *rule.when.not_styles), library.styles.items),
            ("habit", rule.when.habits, library.habits.items),
        ):
            where = {"rule": rule.name, "known": ", ".join(sorted(known))}
            found += [Message(f"rule.unknown_{kind}", {**where, "name": name}) for name in names if name not in known]
    return found


def save(piece: Path, file: Path) -> None:
    """Write the metadata of the piece in a project file to ``file``: acting, corrections and the like without the
    notes."""
    from app.project.piece_metadata import metadata_of, save_metadata
    from app.project.storage import load

    save_metadata(metadata_of(load(piece)), file)
    say(said("cli.written", file=str(file)))


def load(piece: Path, file: Path) -> None:
    """Apply the metadata in ``file`` to the piece in a project file, and save the project."""
    from app.project.piece_metadata import load_metadata, with_metadata
    from app.project.storage import load as opened
    from app.project.storage import save as written

    project, problems = with_metadata(opened(piece), load_metadata(file))
    for problem in problems:
        warn(sentence(problem))
    written(project, piece)
    say(said("cli.written", file=str(piece)))


def diff(piece: Path, file: Path) -> None:
    """Print the differences between the metadata of the piece in a project file and that in ``file``.

    Raises
    ------
    InvalidMetadataError
        If there are differences.
    """
    from app.project.piece_metadata import differences, load_metadata, metadata_of
    from app.project.storage import load

    found = differences(metadata_of(load(piece)), load_metadata(file))
    for place, one, other in found:
        say(f"{place}: {one or '-'} -> {other or '-'}")
    if found:
        raise InvalidMetadataError("metadata.differ", piece=piece.name, file=file.name, count=len(found))
    say(said("metadata.no_difference", piece=piece.name, file=file.name))
