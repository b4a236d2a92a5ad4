"""Tempo of a score as it is played: marks, words, gradual changes and fermatas."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Sequence
from itertools import islice
from typing import Final, NamedTuple

from app.score.limits import MOST_NAME
from app.score.tempo import TempoChange, TempoMap

USUAL: Final = 120.0
"""Default tempo in quarters per minute."""
SLOWEST, FASTEST = 5.0, 1000.0
"""Possible range of tempi in quarters per minute."""
_WORDS: Final = (
    (re.compile(r"prestissimo", re.I), 192.0),
    (re.compile(r"\bpresto|presto\b", re.I), 172.0),
    (re.compile(r"\bvivace|\bvivo\b|lebhaft", re.I), 152.0),
    (re.compile(r"\ballegretto", re.I), 112.0),
    (re.compile(r"\ballegro|schnell", re.I), 132.0),
    (re.compile(r"\bmoderato|mäßig|mässig", re.I), 104.0),
    (re.compile(r"\bandantino", re.I), 84.0),
    (re.compile(r"\bandante|gehend", re.I), 76.0),
    (re.compile(r"\badagietto", re.I), 72.0),
    (re.compile(r"\badagio|langsam", re.I), 66.0),
    (re.compile(r"\blarghetto", re.I), 62.0),
    (re.compile(r"\blento\b", re.I), 54.0),
    (re.compile(r"\blargo\b|\bbreit\b", re.I), 48.0),
    (re.compile(r"\bgrave\b", re.I), 42.0),
    (re.compile(r"tempo di marcia|\bmarch\b|alla marcia", re.I), 112.0),
    (re.compile(r"tempo di valse|\bwaltz\b", re.I), 160.0),
)
"""Tempi of words without a number, in quarters per minute: the middle of the range printed on metronomes."""
_SLOWER: Final = re.compile(
    r"\b(?:rit(?:\.|ard|en|$)|rall(?:\.|ent|$)|allarg|calando|morendo|smorz|perdendosi|slentando)", re.I
)
_FASTER: Final = re.compile(r"\b(?:accel|string(?:\.|endo|$)|affrett|incalz)", re.I)
_BACK: Final = re.compile(r"\ba\s+tempo\b|\btempo\s*giusto\b|\bin\s+tempo\b", re.I)
_FIRST: Final = re.compile(r"\btempo\s*(?:primo|1\s?[°oº.]?|I\b\.?)|\bcome\s+prima\b", re.I)
_MORE: Final = re.compile(r"\b(?:molto|assai|sempre più)\b", re.I)
_LESS: Final = re.compile(r"\b(?:poco|un po)\b", re.I)
_SHARES: Final = {-1: (0.85, 0.72, 0.6), 1: (1.12, 1.28, 1.45)}
"""Factors for the tempo at the end of a gradual change: slight, usual, strong."""
_RAMP_QUARTERS: Final = 8
"""Longest duration in quarters of a gradual change without an end."""
_FAR_QUARTERS: Final = 16
"""Quarters after the beginning of a gradual change beyond which a new tempo does not end it."""
_STEPS: Final = 2
"""Number of steps per quarter of a gradual change."""


class TempoEvent(NamedTuple):
    """A mark that affects the tempo.

    Attributes
    ----------
    kind : {"set", "word", "slower", "faster", "back", "first"}
        A tempo in numbers or words; a gradual change; a return to the previous or to the first tempo.
    value : float
        Tempo in quarters per minute; for a gradual change, the share of the tempo reached at its end.
    """

    tick: int
    kind: str
    value: float = 0.0


class Held(NamedTuple):
    """A span of ticks that a fermata lengthens by a factor."""

    tick: int
    end_tick: int
    stretch: float


def said_of_tempo(tick: int, words: str) -> TempoEvent | None:
    """Interpret words over a staff as a tempo mark; None if they are about something else."""
    text = words[:MOST_NAME].strip().strip("()")
    if _FIRST.search(text):
        return TempoEvent(tick, "first")
    if _BACK.search(text):
        return TempoEvent(tick, "back")
    for sign, pattern in ((-1, _SLOWER), (1, _FASTER)):
        if pattern.search(text):
            amount = 2 if _MORE.search(text) else 0 if _LESS.search(text) else 1
            return TempoEvent(tick, "slower" if sign < 0 else "faster", _SHARES[sign][amount])
    found = next((tempo for pattern, tempo in _WORDS if pattern.search(text)), None)
    return None if found is None else TempoEvent(tick, "word", found)


def tempo_map(events: Sequence[TempoEvent], held: Sequence[Held], end_tick: int, ticks_per_quarter: int) -> TempoMap:
    """Build the tempo map of a score from its tempo marks and fermatas.

    Parameters
    ----------
    events : sequence of TempoEvent
        Tempo marks ordered by tick; at one tick a number has priority over words.
    end_tick : int
        Last tick of the piece.
    """
    changes = _changes(events, end_tick, ticks_per_quarter)
    spans = _joined(held)
    at, starts = [tick for tick, _ in changes], [span.tick for span in spans]
    rows = []
    for tick in sorted({*at, *starts, *(span.end_tick for span in spans)}):
        tempo = changes[bisect_right(at, tick) - 1][1]
        place = bisect_right(starts, tick) - 1
        if place >= 0 and tick < spans[place].end_tick:
            tempo /= spans[place].stretch
        rows.append(TempoChange(tick, 60e6 / min(max(tempo, SLOWEST), FASTEST)))
    return TempoMap.of_changes(ticks_per_quarter, rows)


def _changes(events: Sequence[TempoEvent], end_tick: int, quarter: int) -> list[tuple[int, float]]:
    """Ticks and tempo (quarters per minute) of all tempo changes, with gradual ones in steps; fermatas are left out."""
    numbers = {event.tick for event in events if event.kind == "set"}
    said = [event for event in dict.fromkeys(events) if event.kind != "word" or event.tick not in numbers]
    changes = [(0, USUAL)]
    first = steady = 0.0
    for place, event in enumerate(said):
        tempo = changes[-1][1]
        if event.kind in ("set", "word"):
            steady = event.value
            first = first or steady
            changes.append((event.tick, steady))
        elif event.kind in ("back", "first"):
            steady = (first if event.kind == "first" else steady) or USUAL
            if event.tick not in numbers:
                changes.append((event.tick, steady))
        else:
            later = next((one for one in islice(said, place + 1, None) if one.tick > event.tick), None)
            steady = steady or tempo
            near = later is not None and later.tick - event.tick <= _FAR_QUARTERS * quarter
            end = later.tick if near and later is not None else min(event.tick + _RAMP_QUARTERS * quarter, end_tick)
            goal = tempo * event.value
            if near and later is not None and later.kind in ("set", "word") and (later.value < tempo) == (goal < tempo):
                goal = max(goal, later.value) if goal < tempo else min(goal, later.value)
            steps = max((end - event.tick) * _STEPS // quarter, 1)
            for step in range(steps):
                at = event.tick + (end - event.tick) * step // steps
                changes.append((at, tempo + (goal - tempo) * (step + 1) / steps))
            if not near and end < end_tick:
                # Without a further indication the former tempo returns.
                changes.append((end, steady))
    return list({tick: (tick, tempo) for tick, tempo in sorted(changes, key=lambda row: row[0])}.values())


def _joined(held: Sequence[Held]) -> list[Held]:
    """Order fermata spans and remove overlaps: of two that begin together the longer counts, and one that begins within
    another is dropped.
    """
    found: list[Held] = []
    for one in sorted(held):
        if found and one.tick < found[-1].end_tick:
            last = found[-1]
            if one.tick == last.tick:
                found[-1] = Held(last.tick, max(last.end_tick, one.end_tick), max(last.stretch, one.stretch))
            continue
        found.append(one)
    return found
