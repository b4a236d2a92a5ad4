"""Filter of problems: those of one kind, and of the selected players."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final, NamedTuple

from app.plan.model import Problem

_KINDS: Final = {
    "fingering": "fingering",
    "breath": "breath",
    "note": "note",
    "correction": "correction",
    "contact": "contact",
    "dance": "dance",
    "choreography": "dance",
    "project": "project",
}


class ProblemFilter(NamedTuple):
    """A choice of problems.

    Attributes
    ----------
    kind : str
        See `kind_of`; empty: every kind.
    of_selected : bool
        Whether only those of the selected players are chosen.
    """

    kind: str = ""
    of_selected: bool = False

    def takes(self, performer_id: str, problem: Problem, selected: Collection[str]) -> bool:
        """Return whether a performer's problem is chosen."""
        return self.kind in ("", kind_of(problem)) and (not self.of_selected or performer_id in selected)


def kind_of(problem: Problem) -> str:
    """The kind of a problem by what it is about, as ``fingering`` or ``breath``."""
    room = problem.message.id.partition(".")[0]
    return _KINDS.get(room, room)
