"""History of the guide sections that were read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

Place: TypeAlias = tuple[str, int]
"""Name of a guide, and the index of its section."""


@dataclass(frozen=True)
class Visits:
    """The history of visited sections and the position in it; a new visit discards the sections after the position.

    Attributes
    ----------
    places : tuple of Place
        Sections in the order of the visits.
    at : int
        Index in ``places`` of the section on display; -1 if there is none.
    """

    places: tuple[Place, ...] = ()
    at: int = -1

    @property
    def here(self) -> Place | None:
        """The guide's section that is displayed; None before the first one."""
        return self.places[self.at] if self.places else None

    @property
    def can_go_back(self) -> bool:
        """Return whether an earlier section is in the history."""
        return self.at > 0

    @property
    def can_go_forward(self) -> bool:
        """Return whether a later section is in the history."""
        return self.at < len(self.places) - 1

    def visit(self, place: Place) -> Visits:
        """Return the history after visiting a section; unchanged if it is on display."""
        if place == self.here:
            return self
        places = (*self.places[: self.at + 1], place)
        return Visits(places, len(places) - 1)

    def back(self) -> Visits:
        """Return the history moved to the previous section; unchanged at the first one."""
        return Visits(self.places, self.at - 1) if self.can_go_back else self

    def forward(self) -> Visits:
        """Return the history moved to the next section; unchanged at the last one."""
        return Visits(self.places, self.at + 1) if self.can_go_forward else self
