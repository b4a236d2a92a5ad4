"""Assigns the voices of a shared staff to players: each voice with its own notes is one player's, stems up first.

A passage in which the other voices have neither notes nor visible rests is played by everyone; it gets no assignment.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from typing import Final

from app.score.musicxml.played_chords import Desk, PlayedChord

_MOST_VOICES: Final = 8
"""Greatest number of voices of a measure that are played by separate players."""


def seat(measure: Sequence[PlayedChord]) -> None:
    """Set for each chord of a measure the players who play it (its desk), from the voices of the staff."""
    lines: dict[tuple[str, str], list[PlayedChord]] = {}
    for one in measure:
        if one.chord.tones or not one.chord.hidden:
            lines.setdefault((one.chord.staff, one.chord.voice), []).append(one)
    if not 2 <= len(lines) <= _MOST_VOICES:
        return
    rows = sorted(lines.items(), key=lambda row: (row[0][0], _goes_down(row[1]), len(row[0][1]), row[0][1]))
    spans = [sorted((one.onset, max(one.end, one.onset + 1)) for one in line) for _, line in rows]
    widths = [max(len(one.chord.tones) for one in line) or 1 for _, line in rows]
    first = 1
    for place, (_, line) in enumerate(rows):
        others = [own for other, own in enumerate(spans) if other != place]
        for one in line:
            if any(_sounds(own, one.onset, max(one.end, one.onset + 1)) for own in others):
                one.desk = Desk(first, sum(widths))
        first += widths[place]


def _goes_down(line: Sequence[PlayedChord]) -> bool:
    """Return whether the stems of a voice point down."""
    stems = [one.chord.stem for one in line]
    return stems.count("down") > stems.count("up")


def _sounds(spans: Sequence[tuple[int, int]], start: int, end: int) -> bool:
    """Return whether any of the ordered spans of a voice overlaps the span from ``start`` to ``end`` ticks."""
    before = bisect_left(spans, (end, 0)) - 1
    return before >= 0 and spans[before][1] > start
