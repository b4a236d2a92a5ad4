"""The sub-commands: what each is called and does. Its module is loaded when its arguments are read.

Descriptions of sub-commands and the help of their options stand in tables beside the modules (``help.toml``).
"""

from __future__ import annotations

import argparse
import gc
import tomllib
from collections.abc import Callable, Sequence
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any, Final, NoReturn

from app.encoding import shown
from app.optional_features import FEATURES, SubCommand

_OWN: Final = {
    "edit": "open the editor (also without any command)",
    "inspect": "say what a MIDI file or a score holds and what its players will do",
    "export": "write the players and their instruments as FBX, BVH, GLB or USD",
    "film": "draw the players: a film with sound, PNG frames or a contact sheet",
    "midi": "write the piece as a MIDI file",
    "align": "put the notes where a recording of the piece has them",
    "instruments": "list the instrument maps, show the fingerings of one, or check one",
    "metadata": "list styles, habits, expressions, gestures and rules; save, load and compare those of a piece",
    "characters": "list the characters, check whether a file's figure can play, add one",
    "ports": "list the MIDI devices that are there",
    "record": "record from a MIDI device into a MIDI file",
    "stream": "play a piece live to another program (VMC)",
}
"""By name: the help. The module of a name is in this folder."""


def _all_commands() -> dict[str, SubCommand]:
    found = {name: SubCommand(f"app.cli.{name}", help, after="") for name, help in _OWN.items()}
    for feature in FEATURES:
        for name, command in feature.sub_commands.items():
            names = list(found)
            names.insert(names.index(command.after) + 1, name)
            found = {each: found.get(each, command) for each in names}
    return found


_COMMANDS: Final = _all_commands()
TWO_WORDS: Final = frozenset(name for name in _COMMANDS if " " in name)
"""A piece with such a name is written "./results"."""

SHARED: Final = "shared"
DESCRIPTION: Final = "description"

Declare = Callable[[argparse.ArgumentParser], None]


class CommandParser(argparse.ArgumentParser):
    """Quotes the arguments that it refuses, names of files among them, as everything else is printed.

    Parameters
    ----------
    declare : callable, optional
        Adds arguments and description; called when they are needed first.
    options
        Of `argparse`.
    """

    def __init__(self, *, declare: Declare | None = None, **options: Any) -> None:
        super().__init__(**options)
        self._declare = declare

    def complete(self) -> None:
        """Have all arguments."""
        if self._declare is not None:
            declare, self._declare = self._declare, None
            declare(self)
            _explain(self)

    def error(self, message: str) -> NoReturn:
        super().error(shown(message))

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        self.complete()
        return super().parse_known_args(args, namespace)


@cache
def help_texts() -> dict[str, dict[str, str]]:
    """Read the tables: descriptions and texts of options by sub-command; those of several under `SHARED`."""
    folder = Path(__file__).parent
    paths = (folder / "help.toml", *sorted(folder.glob("*/help.toml")))
    return {name: texts for path in paths for name, texts in tomllib.loads(path.read_text("utf-8")).items()}


def _explain(command: argparse.ArgumentParser) -> None:
    """Give a sub-command, its options and its own sub-commands the texts that their declarations leave out."""
    texts = help_texts()[SHARED] | help_texts().get(command.prog.partition(" ")[2], {})
    command.description = command.description or texts.get(DESCRIPTION)
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for part in action.choices.values():
                _explain(part)
        elif action.help is None:
            action.help = texts.get(action.option_strings[-1] if action.option_strings else action.dest)


def add_commands(top: argparse.ArgumentParser) -> None:
    """Declare all sub-commands by name and help."""
    commands = top.add_subparsers(title="commands", dest="command", metavar="COMMAND", parser_class=CommandParser)
    for name, command in _COMMANDS.items():
        commands.add_parser(name, help=command.help, declare=partial(_add_arguments, command.module))


def _add_arguments(name: str, command: argparse.ArgumentParser) -> None:
    # All that modules make lasts: collecting garbage takes a tenth of the time that loading them takes.
    collects = gc.isenabled()
    gc.disable()
    try:
        module = import_module(name)
    finally:
        if collects:
            gc.enable()
    module.add_arguments(command)
