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
"""Range of ticks per quarter in a MIDI file (15 bits)."""
MICROSECONDS_PER_QUARTER: Final = (5_000.0, 120_000_000.0)
"""Range of tempi in microseconds per quarter, wider than a MIDI file's (24 bits) so that every tempo can be scaled."""
BPM: Final = (5.0, 1000.0)
"""Range of tempi that the user can set, in quarters per minute."""
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
"""Greatest number of characters of any text."""
MOST_ID: Final = 500
MOST_NAME: Final = of_score.MOST_NAME
"""Greatest number of characters of a name given by the user."""
MOST_PLAYERS: Final = 1000
MOST_DANCERS: Final = 200
CHOREOGRAPHY_INDEX: Final = (0, 2**31 - 1)
"""Limits of the index of a basic motion, a segment or a source of a choreography."""
MOST_TAKES: Final = 2000
MOST_TAKE_EVENTS: Final = 5_000_000
TAKE_US: Final = (-(10**13), 10**13)
"""Range of performance times in a take in microseconds: four months."""
CLEANING: Final[Mapping[str, Bounds]] = {
    "ghost_s": (0.0, 0.5),
    "ghost_loudness": (0.0, 1.0),
    "double_s": (0.0, 0.2),
    "overlap_s": (0.0, 0.2),
    "quantise": (0.0, 1.0),
    "grid_quarters": (1 / 32, 16.0),
    "align": (0.0, 1.0),
}
"""Bounds of the fields of `app.score.take.Cleaning`."""
MOST_NUMBER: Final = 1e12
"""Greatest value of numbers without a bound of their own."""
