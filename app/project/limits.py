"""Limits of a project's numbers, for edits and files.

The length of a piece is limited in `app.score.limits`. The limits are far above any real music, and low enough that no
hostile file makes the program run for hours or out of memory.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Final

from app.plan import parameters as of_players
from app.plan.parameters import Bounds
from app.score import limits as of_score

LAST_TICK: Final = of_score.LAST_TICK
TICKS_PER_QUARTER: Final = (1, 32767)
"""The 15 bits of a MIDI file's division."""
MICROSECONDS_PER_QUARTER: Final = (5_000.0, 120_000_000.0)
"""Wider than what a MIDI file can say (24 bits) and its reader accepts, so that a tempo can still be scaled."""
BPM: Final = (5.0, 1000.0)
"""Quarters per minute that the user may set."""
TEMPO_RATIO: Final = (0.25, 4.0)
METRE_NUMERATOR: Final = (1, 255)
METRE_DENOMINATORS: Final = (1, 2, 4, 8, 16, 32, 64)
PREROLL_BEATS: Final = (0.0, 64.0)
SECTION_INTENSITY: Final = (0.0, 2.0)
FELT_BEAT_QUARTERS: Final = (1 / 16, 16.0)
FPS: Final = (Fraction(1), Fraction(240))
SEED: Final = of_players.SEED
OFFSET_S: Final = (-86_400.0, 86_400.0)
STAGE_M: Final = (-1000.0, 1000.0)
TURN_RAD: Final = (-1000.0, 1000.0)
MOST_TEXT: Final = of_score.MOST_TEXT
"""Characters of any one text."""
MOST_ID: Final = 500
MOST_NAME: Final = of_score.MOST_NAME
"""Characters of a name that the user gives."""
MOST_PLAYERS: Final = 1000
MOST_DANCERS: Final = 200
CHOREOGRAPHY_INDEX: Final = (0, 2**31 - 1)
"""Limits of the index of a basic motion, a segment or a source of a choreography."""
MOST_TAKES: Final = 2000
MOST_TAKE_EVENTS: Final = 5_000_000
TAKE_US: Final = (-(10**13), 10**13)
"""Performance times of a take, microseconds: four months."""
CLEANING: Final[Mapping[str, Bounds]] = {
    "ghost_s": (0.0, 0.5),
    "ghost_loudness": (0.0, 1.0),
    "double_s": (0.0, 0.2),
    "overlap_s": (0.0, 0.2),
    "quantise": (0.0, 1.0),
    "grid_quarters": (1 / 32, 16.0),
    "align": (0.0, 1.0),
}
"""Bounds of `app.score.take.Cleaning`, by field."""
MOST_NUMBER: Final = 1e12
"""Largest number that has no bound of its own."""
