"""The table of optional features, each with the modules that implement it.

Without its row and the folders of its name (in `app`, `widgets`, `resources` and `tests`), the rest of the program
works. No other code refers to these modules: extensible code reads the table.
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
        Module that declares the arguments, loaded when they are read. A table in its folder contains the help.
    after : str
        Command after which it is listed in the help.
    """

    module: str
    after: str


@dataclass(frozen=True)
class Feature:
    """An optional feature: the modules of its actions, lanes, sections and commands.

    Attributes
    ----------
    actions, actions_after : str
        Module with ``ACTIONS`` (empty if there is none, as for all fields), and id of the action after which they are
        inserted.
    lanes, lanes_after : str
        Module with ``LANES``, and id of the lane below which they are inserted.
    players_section : str
        Module with ``SECTION``, a widget for the panel of players with a signal ``sought``.
    dances : str
        Package that generates dances for `app.performance.dances`; empty if there is none.
    sub_commands : mapping
        Sub-commands by name.
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
    """Yield each feature that has a module in a column of the table, with the module."""
    for feature in FEATURES:
        name: str = getattr(feature, column)
        if name:
            yield feature, import_module(name)


def extended(own: Iterable[T], column: str, id_of: Callable[[T], str]) -> list[T]:
    """Insert the rows that optional features add to a table, each after the row it names.

    Parameters
    ----------
    own : iterable
        The table without features.
    column : str
        ``"actions"`` or ``"lanes"``; the modules contain the rows under this name in capitals.
    id_of : callable
        The id of a row.
    """
    found = list(own)
    for feature, module in modules(column):
        behind: str = getattr(feature, f"{column}_after")
        at = next(number for number, row in enumerate(found, 1) if id_of(row) == behind)
        found[at:at] = getattr(module, column.upper())
    return found
