"""Filter of problems by kind and by selected players."""

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
    """Criteria for showing problems.

    Attributes
    ----------
    kind : str
        Kind of problem as in `kind_of`; empty for all kinds.
    of_selected : bool
        Whether to show only those of selected players.
    """

    kind: str = ""
    of_selected: bool = False

    def takes(self, performer_id: str, problem: Problem, selected: Collection[str]) -> bool:
        """Return whether a performer's problem passes the filter."""
        return self.kind in ("", kind_of(problem)) and (not self.of_selected or performer_id in selected)


def kind_of(problem: Problem) -> str:
    """Return the kind of a problem by its subject, such as ``fingering`` or ``breath``."""
    room = problem.message.id.partition(".")[0]
    return _KINDS.get(room, room)
