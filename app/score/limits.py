"""Size limits of a score: files beyond them are refused or cut, and edits beyond them refused.

The limits are far above any real music, and low enough that no file makes the program run for hours or out of memory.
Quantities that grow with time (bars, beats, frames) are limited by the length of the piece, all others by its notes.
"""

from __future__ import annotations

import math
from typing import Final

from app.errors import Argument
from app.score.model import Score

LAST_TICK: Final = 2**31 - 1
MOST_HOURS: Final = 12
"""Greatest duration of a piece in hours, longer than any concert."""
MOST_QUARTERS: Final = 200_000
"""Greatest length of a piece in quarters: twelve hours at 277 per minute."""
MOST_BARS: Final = 200_000
MOST_TEXT: Final = 10_000
"""Greatest number of characters of any text."""
MOST_NAME: Final = 200
"""Greatest number of characters of a name."""
MOST_STREAMS: Final = 256
"""Greatest number of parts in a file, played or not: sixteen ports of sixteen channels."""
MOST_PARTS: Final = 128
"""Greatest number of played parts: more than in any band."""
MOST_PLAYER_HOURS: Final = 256
"""Greatest total hours of all players; in a piece of more than two hours fewer may play, of twelve hours 21."""


def most_parts(hours: float) -> int:
    """Largest number of parts with players in a piece of this many hours."""
    return MOST_PARTS if hours * MOST_PARTS <= MOST_PLAYER_HOURS else max(1, int(MOST_PLAYER_HOURS / hours))


def too_long(score: Score, end_tick: int | None = None) -> dict[str, Argument] | None:
    """Return the arguments of the message about a piece that is too long, in hours or in quarters; None if it is short
    enough.

    Parameters
    ----------
    end_tick : int, optional
        End of the piece; by default the end of the last note, with or without a player.

    Returns
    -------
    dict of str to Argument, or None
        Actual length (``hours``, ``quarters``, ``bars``) and the limits (``most_hours`` ...).
    """
    end = score.sounding_end_tick if end_tick is None else end_tick
    hours = score.tempo_map.seconds(float(end)) / 3600.0
    quarters, bars = end // score.ticks_per_quarter, score.metre_map.bar_of_tick(end)
    if end <= LAST_TICK and hours <= MOST_HOURS and quarters <= MOST_QUARTERS and bars <= MOST_BARS:
        return None
    return {
        # Rounded up: 12.001 hours exceed 12.
        "hours": math.ceil(10.0 * hours - 1e-6) / 10.0,
        "quarters": quarters,
        "bars": bars,
        "most_hours": MOST_HOURS,
        "most_quarters": MOST_QUARTERS,
        "most_bars": MOST_BARS,
    }
