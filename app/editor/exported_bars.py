"""The bars that the last export wrote and the lead-in before them, as the export dialog offers them again."""

from __future__ import annotations

from typing import Final, NamedTuple


class ExportedBars(NamedTuple):
    """Bars written by an export, and their lead-in.

    Attributes
    ----------
    bars : (int, int) or None
        First and last bar; None for the whole piece.
    lead_in_beats : float
        Number of felt beats before the first bar.
    """

    bars: tuple[int, int] | None = None
    lead_in_beats: float = 0.0


WHOLE_PIECE: Final = ExportedBars()
