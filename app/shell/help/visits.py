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
    at : int
        Index of the section on display; -1 if there is none.
    """

    places: tuple[Place, ...] = ()
    at: int = -1

    @property
    def here(self) -> Place | None:
        """The guide's section that is displayed; None before the first one."""
        return self.places[self.at] if self.places else None

    @property
    def can_go_back(self) -> bool:
        """True if there is an earlier section."""
        return self.at > 0

    @property
    def can_go_forward(self) -> bool:
        """True if there is a later section."""
        return self.at < len(self.places) - 1

    def visit(self, place: Place) -> Visits:
        """Return the history after visiting a section; unchanged if it is on display."""
        if place == self.here:
            return self
        places = (*self.places[: self.at + 1], place)
        return Visits(places, len(places) - 1)

    def back(self) -> Visits:
        """Return the history at the previous section, if there is one."""
        return Visits(self.places, self.at - 1) if self.can_go_back else self

    def forward(self) -> Visits:
        """Return the history at the next section, if there is one."""
        return Visits(self.places, self.at + 1) if self.can_go_forward else self
