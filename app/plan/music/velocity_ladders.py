"""Tables of the velocities with which notation programs write dynamics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray

DYNAMICS: Final = (
    ("ppp", 16), ("pp", 33), ("p", 49), ("mp", 64), ("mf", 80), ("f", 96), ("ff", 112), ("fff", 126)
)  # fmt: skip
"""Dynamic marks with their velocities, as in MuseScore."""
COMMON: Final = ("pp", "p", "mp", "mf", "f", "ff")
"""Marks that occur in most music."""
MARKS: Final = {mark: index for index, (mark, _) in enumerate(DYNAMICS)}
MF: Final = MARKS["mf"]
MEZZOFORTE: Final = 0.63
"""Loudness 0..1 of mezzoforte: MIDI velocity 80 of 127."""
LEVELS: Final[FloatArray] = np.array([MEZZOFORTE if mark == "mf" else at / 127.0 for mark, at in DYNAMICS])
"""Loudness (8,) of each mark, softest first."""
DEFAULTS: Final = frozenset({64, 80, 90, 96, 100, 127})
"""Velocities that programs write for music without dynamics."""


@dataclass(frozen=True)
class Ladder:
    """The velocities with which one program writes dynamics.

    Attributes
    ----------
    steps : tuple of (mark, velocity)
        A mark may occur several times (``"sf"``: a stress after which the level returns; empty: no mark).
    default : int or None
        Velocity without any dynamic; None: one of `DEFAULTS`.
    added : tuple of int
        Velocities that articulations add.
    accent_share : float
        Factor of an accent; 1: no effect.
    usual : float
        How common files of this program are: logarithm of their share of all files.
    passed : tuple of int
        Velocities at the end of hairpins without a target.
    """

    name: str
    steps: tuple[tuple[str, int], ...]
    default: int | None = None
    added: tuple[int, ...] = ()
    accent_share: float = 1.0
    usual: float = 0.0
    passed: tuple[int, ...] = ()


LILYPOND: Final = "LilyPond"
UNMARKED_STEP: Final = ""
"""Step of notes without a mark, for which the previous mark applies."""
_LILYPOND_VOLUMES: Final = (
    ("ppp", 0.25), ("ppp", 0.34), ("ppp", 0.42), ("pp", 0.49), ("p", 0.55), ("mp", 0.61), ("mf", 0.68),
    (UNMARKED_STEP, 90 / 127), ("f", 0.75), ("ff", 0.80), ("fff", 0.85), ("fff", 0.92), ("sf", 1.0),
)  # fmt: skip
"""LilyPond's ``scm/midi.scm``: ppppp to ffff and sf; 90 of 127 is its volume without a mark."""
LILYPOND_RANGES: Final = {
    73: (0.0, 0.7), 68: (0.0, 0.7), 71: (0.0, 0.7), 70: (0.0, 0.6), 60: (0.1, 0.7), 56: (0.1, 0.8),
}  # fmt: skip
"""LilyPond's ``instrument-equalizer-alist`` by General MIDI program (from 0): flute, oboe, clarinet, bassoon, French
horn and trumpet; all others have the whole range."""
SET_RANGES: Final = {
    128 + index: (low / 10, high / 10)
    for index, (low, high) in enumerate((low, high) for low in range(8) for high in range(low + 5, 11))
    if (low / 10, high / 10) not in {(0.0, 1.0), *LILYPOND_RANGES.values()}
}
"""Ranges that a score sets itself in LilyPond (``midiMinimumVolume``), as programs from 128."""
_DEFAULT_VOLUME: Final = 90
"""Velocity of a LilyPond voice without instrument and mark."""
_UNTIL: Final = 0.225
"""Change over a hairpin without a mark: 0.25 of the range from its tenth (``lily/dynamic-performer.cc``)."""
_LILYPOND_ADDED: Final = (4, 6, 20, 24, 26, 40)
"""``ly/script-init.ly``: staccato, staccatissimo, accent, accent with either, marcato."""


def _lilypond(program: int | None) -> Ladder:
    low, high = {**LILYPOND_RANGES, **SET_RANGES}.get(-1 if program is None else program, (0.0, 1.0))
    # Rounded down as in LilyPond, including rounding errors: a flute without a mark gets 62.
    steps = [(mark, int(127 * (low + (high - low) * volume))) for mark, volume in _LILYPOND_VOLUMES]
    default = dict(steps)[UNMARKED_STEP]
    if default != _DEFAULT_VOLUME:
        steps.append((UNMARKED_STEP, _DEFAULT_VOLUME))
    passed = {
        int(127 * (low + (high - low) * (volume + off)))
        for mark, volume in _LILYPOND_VOLUMES
        for off in (-_UNTIL, _UNTIL)
        if mark in COMMON and volume + off <= 1.0
    }
    return Ladder(LILYPOND, tuple(steps), default, _LILYPOND_ADDED, passed=tuple(sorted(passed)))


def _ladder(name: str, velocities: str, **more: object) -> Ladder:
    """Create a ladder from eight velocities for *ppp* to *fff*, given as text."""
    values = [int(value) for value in velocities.split()]
    marks = [mark for mark, _ in DYNAMICS]
    return Ladder(name, tuple(zip(marks, values, strict=True)), **more)  # type: ignore[arg-type]


_FIXED: Final = (
    _ladder("MuseScore", "16 33 49 64 80 96 112 126", accent_share=1.2),
    _ladder("Finale", "23 36 49 62 75 88 101 114", default=64, usual=-0.5),
    _ladder("Sibelius", "20 39 61 71 84 98 113 127", usual=-0.5),
    _ladder("NoteWorthy", "10 30 45 60 75 92 108 127", usual=-1.5),
    # Strong, weaker and weak beats: the additions are negative.
    _ladder("abc2midi", "30 45 60 75 90 105 120 127", default=105, added=(-10, -25), usual=-1.5),
    _ladder("music21", "19 32 44 57 70 89 108 114", usual=-1.5),
)
LADDERS: Final = (LILYPOND, *(ladder.name for ladder in _FIXED))
_BY_NAME: Final = {ladder.name: ladder for ladder in _FIXED}
SHARES: Final = {
    "ppp": 0.01, "pp": 0.07, "p": 0.22, "mp": 0.13, "mf": 0.2, "f": 0.22, "ff": 0.11, "fff": 0.02, "sf": 0.02, "": 0.2
}  # fmt: skip
"""Approximate frequencies of the marks."""


def ladder_of(name: str, program: int | None) -> Ladder:
    """Return the ladder of the notation program ``name`` for an instrument, given as General MIDI program (from 0) or
    one of `SET_RANGES`.
    """
    return _lilypond(program) if name == LILYPOND else _BY_NAME[name]


def articulated(ladder: Ladder, velocity: int) -> list[tuple[int, float]]:
    """Return the differences in velocity that articulations make to a note of this ladder at ``velocity``, 0 for none
    included, each with its frequency.
    """
    more = [*ladder.added]
    if ladder.accent_share != 1.0:
        # MuseScore rounds the product down, not the addition.
        more.append(int(velocity * ladder.accent_share) - velocity)
    return [(0, 0.85), *((one, 0.15 / len(more)) for one in more)]
