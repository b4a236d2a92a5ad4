"""Places of the guides that were read one after another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

Place: TypeAlias = tuple[str, int]
"""Name of a guide, and the number of its section."""


@dataclass(frozen=True)
class Visits:
    """The places read so far, and the one that is shown; a new one takes the place of those that were gone back from.

    Attributes
    ----------
    places : tuple of Place
    at : int
        Number of the place that is shown; -1: none yet.
    """

    places: tuple[Place, ...] = ()
    at: int = -1

    @property
    def here(self) -> Place | None:
        """The place that is shown."""
        return self.places[self.at] if self.places else None

    @property
    def can_go_back(self) -> bool:
        """True if a place was read before this one."""
        return self.at > 0

    @property
    def can_go_forward(self) -> bool:
        """True if a place was gone back from."""
        return self.at < len(self.places) - 1

    def visit(self, place: Place) -> Visits:
        """Show a place; nothing changes if it is shown."""
        if place == self.here:
            return self
        places = (*self.places[: self.at + 1], place)
        return Visits(places, len(places) - 1)

    def back(self) -> Visits:
        """Show the place before, if there is one."""
        return Visits(self.places, self.at - 1) if self.can_go_back else self

    def forward(self) -> Visits:
        """Show the place after, if there is one."""
        return Visits(self.places, self.at + 1) if self.can_go_forward else self
