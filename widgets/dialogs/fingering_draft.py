"""A fingering table while it is edited."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.errors import AppError
from instrument_maps import fingering_table as edit
from instrument_maps.library import library
from instrument_maps.model import InstrumentMap


@dataclass
class FingeringDraft:
    """A fingering table while it is edited, with its undo history.

    Attributes
    ----------
    instrument : InstrumentMap
        Instrument in its saved state.
    base : tuple of Fingering
        Fingerings of the map that it extends.
    states : list of tuple of Fingering
        All states of the table since it was opened.
    at : int
        Index of the displayed state.
    """

    instrument: InstrumentMap
    base: edit.Table
    states: list[edit.Table] = field(default_factory=list)
    at: int = 0
    _judged: tuple[edit.Table, tuple[tuple[str, str], ...]] | None = None

    @property
    def table(self) -> edit.Table:
        """The table of fingerings after the last change or undo."""
        return self.states[self.at]

    @property
    def is_saved(self) -> bool:
        """True if the table equals that in the library."""
        return self.table == self.instrument.fingerings

    @property
    def problems(self) -> tuple[tuple[str, str], ...]:
        """Reasons why the instrument's map would be refused with the edited table."""
        if self._judged is None or self._judged[0] is not self.table:
            self._judged = (self.table, edit.problems_of(self.instrument, self.table))
        return self._judged[1]


def base_of(instrument: InstrumentMap) -> edit.Table:
    """Return the fingerings of the map that an instrument extends; for a bundled one its own."""
    try:
        return edit.base_table(instrument, library().own.get(instrument.id))
    except AppError:
        # The user's file is invalid and an earlier version in use, so the table cannot be reset.
        return instrument.fingerings
