"""The table of what can be left out of the program: a row for each, which names the modules that bring it.

Without its row, and without the folders that are called like it (in `app`, `widgets`, `resources` and `tests`), the
rest of the program is whole. Nothing else names those modules: whoever can be extended asks the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from types import ModuleType
from typing import Final


@dataclass(frozen=True)
class SubCommand:
    """A sub-command of the command line.

    Attributes
    ----------
    module : str
        Declares its arguments; loaded when they are read.
    after : str
        The command behind which the help lists it.
    """

    module: str
    help: str
    after: str


@dataclass(frozen=True)
class Feature:
    """One row.

    Attributes
    ----------
    messages, texts : str
        The modules of its ``WORDINGS`` and of its dialogs' ``TEXTS``.
    actions, actions_after : str
        The module of its ``ACTIONS``, and the action behind which they stand.
    sub_commands : mapping
        By name.
    """

    id: str
    messages: str
    texts: str
    actions: str
    actions_after: str
    sub_commands: Mapping[str, SubCommand] = field(default_factory=dict)


FEATURES: Final[tuple[Feature, ...]] = (
    Feature(
        id="evaluation",
        messages="app.evaluation.messages",
        texts="widgets.dialogs.evaluation.texts",
        actions="app.shell.evaluation.actions",
        actions_after="file.export_midi",
        sub_commands={
            "evaluate": SubCommand(
                "app.cli.evaluation.make",
                "make a questionnaire in which viewers judge the performance against real players",
                after="film",
            ),
            "evaluate results": SubCommand("app.cli.evaluation.results", "what viewers answered", after="evaluate"),
            "evaluate measures": SubCommand(
                "app.cli.evaluation.measures",
                "what can be measured of a piece without viewers",
                after="evaluate results",
            ),
        },
    ),
)


def modules(column: str) -> Iterator[tuple[Feature, ModuleType]]:
    """The modules that a column of the table names, loaded, with their rows."""
    for feature in FEATURES:
        yield feature, import_module(getattr(feature, column))
