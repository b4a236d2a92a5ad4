"""The list of sub-commands with their help. The module of a sub-command is loaded when its arguments are read.

Help texts are in tables beside the modules (``help.toml``), the words of argparse in ``argparse.toml``.
"""

from __future__ import annotations

import argparse
import gc
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any, Final, NoReturn, TypeAlias

from app.cli.speech import (
    LANGUAGE,
    MIDDLE_C,
    MIDDLE_C_OCTAVES,
    PITCH_CHOICES,
    PITCH_NAME_CHOICES,
    PITCH_NAMES,
    PITCHES,
    said,
    spoken,
)
from app.cli.widths import width, wrapped
from app.encoding import shown
from app.messages import LANGUAGES
from app.optional_features import FEATURES, SubCommand

_OWN: Final = (
    *("edit", "inspect", "export", "film", "midi", "align"),
    *("instruments", "metadata", "characters", "ports", "record", "stream"),
)
"""Names of sub-commands, each with a module of this folder."""


def _all_commands() -> dict[str, SubCommand]:
    found = {name: SubCommand(f"app.cli.{name}", after="") for name in _OWN}
    for feature in FEATURES:
        for name, command in feature.sub_commands.items():
            names = list(found)
            names.insert(names.index(command.after) + 1, name)
            found = {each: found.get(each, command) for each in names}
    return found


_COMMANDS: Final = _all_commands()
TWO_WORDS: Final = frozenset(name for name in _COMMANDS if " " in name)
"""Sub-commands of two words; a piece with such a name is typed as "./results"."""

SHARED: Final = "shared"
SUMMARY: Final = "summary"
"""Key of a sub-command's line in the list of all sub-commands."""
DESCRIPTION: Final = "description"

Declare = Callable[[argparse.ArgumentParser], None]
Actions: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"


class _HelpFormatter(argparse.HelpFormatter):
    """Help formatter of argparse that breaks lines by the width of characters, since Japanese ones take two columns."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return super()._split_lines(text, width) if text.isascii() else wrapped(text, width)

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.isascii():
            return super()._fill_text(text, width, indent)
        return "\n".join(f"{indent}{line}" for line in wrapped(text, width - len(indent)))

    def _format_usage(
        self,
        usage: str | None,
        actions: Iterable[argparse.Action],
        groups: Iterable[argparse._MutuallyExclusiveGroup],
        prefix: str | None,
    ) -> str:
        """Return the usage text with lines indented by the width of its first word in columns, where argparse counts
        characters.
        """
        words = argparse_words().get(_USAGE, _USAGE) if prefix is None else prefix
        place = "\1" * width(words)
        return super()._format_usage(usage, actions, groups, place).replace(place, words, 1)


class TopFormatter(_HelpFormatter):
    """Help formatter that also keeps the line breaks of the description and examples."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return "".join(indent + line for line in text.splitlines(keepends=True))


class CommandParser(argparse.ArgumentParser):
    """Parser whose errors quote refused arguments and file names safely.

    Parameters
    ----------
    declare : callable, optional
        Function that adds arguments and description when they are first needed.
    options
        Further arguments of `argparse.ArgumentParser`.
    """

    def __init__(self, *, declare: Declare | None = None, **options: Any) -> None:
        super().__init__(**{"formatter_class": _HelpFormatter, **options})
        self._declare = declare

    def complete(self) -> None:
        """Add all options and arguments of the sub-command, which are declared only when it is used."""
        if self._declare is not None:
            declare, self._declare = self._declare, None
            declare(self)
            explain(self)

    def error(self, message: str) -> NoReturn:
        super().error(shown(message))

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        self.complete()
        return super().parse_known_args(args, namespace)


_FOLDER: Final = Path(__file__).parent
_USAGE: Final = "usage: "


@cache
def help_texts() -> dict[str, dict[str, dict[str, str]]]:
    """Return the help texts by language: summary, description and options of each sub-command; options shared by
    several sub-commands are under the name `SHARED`.
    """
    paths = (_FOLDER / "help.toml", *sorted(_FOLDER.glob("*/help.toml")))
    return {name: texts for path in paths for name, texts in tomllib.loads(path.read_text("utf-8")).items()}


@cache
def _words_of(language: str) -> dict[str, str]:
    table = tomllib.loads((_FOLDER / "argparse.toml").read_text("utf-8"))
    return {words["en"]: words[language] for words in table.values()}


def argparse_words() -> dict[str, str]:
    """Return translations into the current language of the English words that argparse prints."""
    return _words_of(spoken().language)


@contextmanager
def worded_argparse() -> Iterator[None]:
    """Make argparse print its words in the current language within a block, since gettext has no Japanese for them and
    follows the system's locale.
    """
    module: Any = argparse
    words, before = argparse_words(), (module._, module.ngettext)
    module._ = lambda english: words.get(english, english)
    module.ngettext = lambda one, many, number: words.get(one if number == 1 else many, one if number == 1 else many)
    try:
        yield
    finally:
        module._, module.ngettext = before


def fill_help(action: argparse.Action, **values: object) -> None:
    """Fill placeholders ``%(name)s`` in the help text of an option."""
    vars(action).update(values)


def explain(command: argparse.ArgumentParser) -> None:
    """Set the help texts of a sub-command, its options and its own sub-commands."""
    name, language = command.prog.partition(" ")[2], spoken().language
    texts = help_texts()[SHARED] | help_texts().get(name, {})
    if DESCRIPTION in texts:
        command.description = texts[DESCRIPTION][language]
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for listed in action._choices_actions:
                listed.help = summary(f"{name} {listed.dest}")
            for part in action.choices.values():
                explain(part)
        elif action.help is None:
            key = action.option_strings[-1] if action.option_strings else action.dest
            action.help = texts[key][language] if key in texts else None


def summary(name: str) -> str:
    """Return a sub-command's line in the list of all sub-commands."""
    return help_texts()[name][SUMMARY][spoken().language]


def add_commands(top: argparse.ArgumentParser) -> None:
    """Declare all sub-commands with name and summary."""
    commands = top.add_subparsers(
        title=said("cli.commands"), dest="command", metavar="COMMAND", parser_class=CommandParser
    )
    for name, command in _COMMANDS.items():
        commands.add_parser(name, help=summary(name), declare=partial(_add_arguments, command.module))


def add_actions(command: argparse.ArgumentParser, required: bool = False) -> Actions:
    """Declare that a sub-command has sub-commands of its own, and return the object to which they are added."""
    return command.add_subparsers(title=said("cli.actions"), metavar="ACTION", required=required)


def add_language_option(command: argparse.ArgumentParser) -> None:
    """Declare the option for the language, unless the command declares one itself."""
    if LANGUAGE not in command._option_string_actions:
        command.add_argument(LANGUAGE, choices=tuple(LANGUAGES), default="")


def add_pitch_options(command: argparse.ArgumentParser, of_players: bool = True) -> None:
    """Declare the options for names of pitches; if ``of_players``, also the option for written pitches of transposing
    instruments.
    """
    command.add_argument(PITCH_NAMES, choices=PITCH_NAME_CHOICES, default=PITCH_NAME_CHOICES[0])
    command.add_argument(MIDDLE_C, choices=tuple(MIDDLE_C_OCTAVES), default="C4")
    if of_players:
        command.add_argument(PITCHES, choices=PITCH_CHOICES, default=PITCH_CHOICES[0])


def _add_arguments(name: str, command: argparse.ArgumentParser) -> None:
    # All objects that modules create stay alive: garbage collection takes a tenth of the import time.
    collects = gc.isenabled()
    gc.disable()
    try:
        module = import_module(name)
    finally:
        if collects:
            gc.enable()
    module.add_arguments(command)
    _add_language_options(command)


def _add_language_options(command: argparse.ArgumentParser) -> None:
    """Declare the option for the language of a sub-command and its own sub-commands."""
    add_language_option(command)
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for part in action.choices.values():
                _add_language_options(part)
