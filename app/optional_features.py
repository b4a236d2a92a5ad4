"""The table of what can be left out of the program: a row for each, which names the modules that bring it.

Without its row, and without the folders that are called like it (in `app`, `widgets`, `resources` and `tests`), the
rest of the program is whole. Nothing else names those modules: whoever can be extended asks the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from types import ModuleType
from typing import Final, TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class SubCommand:
    """A sub-command of the command line.

    Attributes
    ----------
    module : str
        Declares its arguments; loaded when they are read. Their help stands in a table in its folder.
    after : str
        The command behind which the help lists it.
    """

    module: str
    after: str


@dataclass(frozen=True)
class Feature:
    """A feature that can be left out of the program: the modules of its actions, lanes, sections and commands.

    Attributes
    ----------
    actions, actions_after : str
        The module of its ``ACTIONS`` (empty, as all others: it has none), and the id of the action behind which they
        stand.
    lanes, lanes_after : str
        The module of its ``LANES``, and the id of the lane below which they stand.
    players_section : str
        The module of its ``SECTION`` in the panel of players: a widget with a signal ``sought``.
    dances : str
        The package that makes dances, as `app.performance.dances` asks for them; empty: it makes none.
    sub_commands : mapping
        By name.
    """

    id: str
    actions: str = ""
    actions_after: str = ""
    lanes: str = ""
    lanes_after: str = ""
    players_section: str = ""
    dances: str = ""
    sub_commands: Mapping[str, SubCommand] = field(default_factory=dict)


FEATURES: Final[tuple[Feature, ...]] = (
    Feature(
        id="evaluation",
        actions="app.shell.evaluation.actions",
        actions_after="file.export_midi",
        sub_commands={
            "evaluate": SubCommand("app.cli.evaluation.make", after="film"),
            "evaluate results": SubCommand("app.cli.evaluation.results", after="evaluate"),
            "evaluate measures": SubCommand("app.cli.evaluation.measures", after="evaluate results"),
        },
    ),
    Feature(
        id="choreography",
        actions="app.shell.choreography.actions",
        actions_after="players.reset",
        lanes="widgets.timeline.lanes.choreography.dance_lane",
        lanes_after="curves",
        players_section="widgets.players.choreography.dancers",
        sub_commands={
            "choreography": SubCommand("app.cli.choreography.command", after="characters"),
        },
        dances="app.choreography.performed",
    ),
)


def modules(column: str) -> Iterator[tuple[Feature, ModuleType]]:
    """The modules that a column of the table names, loaded, with their rows."""
    for feature in FEATURES:
        name: str = getattr(feature, column)
        if name:
            yield feature, import_module(name)


def extended(own: Iterable[T], column: str, id_of: Callable[[T], str]) -> list[T]:
    """A table with what features add to it: behind the row that each names.

    Parameters
    ----------
    own : iterable
        The table without features.
    column : str
        ``"actions"`` or ``"lanes"``; the modules have the rows under this name in capitals.
    id_of : callable
        The id of a row.
    """
    found = list(own)
    for feature, module in modules(column):
        behind: str = getattr(feature, f"{column}_after")
        at = next(number for number, row in enumerate(found, 1) if id_of(row) == behind)
        found[at:at] = getattr(module, column.upper())
    return found
