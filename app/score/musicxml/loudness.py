"""Loudness of a part in MusicXML: converts dynamics, hairpins and accents to velocities and to marks.

The velocities are those of MuseScore, so that a score sounds the same in both programs.
"""

from __future__ import annotations

import re
from bisect import bisect_right, insort
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

from app.score.marks import ACCENT_SHARES, Mark
from app.score.musicxml.written import Direction

_SOFT: Final = (49, 33, 16, 10, 5, 1)
_LOUD: Final = (96, 112, 126, 127)
_USUAL: Final = 80.0
USUAL_DYNAMIC: Final = "mf"
"""Dynamic of notes before any written dynamic."""
_FORTE: Final = 90.0
"""Velocity of the format's loudness 1."""
_STEP: Final = 16.0
"""Change of velocity over a hairpin that leads to no mark."""
_MOST: Final = 127.0
_FORCED: Final = 112.0
_GROWING: Final = re.compile(r"\bcresc", re.IGNORECASE)
_FADING: Final = re.compile(r"\b(?:decresc|dim(?:\.|in|$))", re.IGNORECASE)
_WORD_QUARTERS: Final = 16
"""Longest duration in quarters of a hairpin in words without an end."""
_MOST_HAIRPINS: Final = 20_000


class Loudness(NamedTuple):
    """Loudness of a part over time as velocities: linear between points, and forced values for accents at
    single ticks.
    """

    ticks: list[int]
    levels: list[float]
    after: list[float]
    forced: dict[int, float]

    def at(self, tick: int) -> float:
        """Velocity at a tick of a note without marks of its own."""
        if tick in self.forced:
            return self.forced[tick]
        place = bisect_right(self.ticks, tick) - 1
        if place < 0:
            return _USUAL
        start, level, goal = self.ticks[place], self.levels[place], self.after[place]
        if place + 1 == len(self.ticks) or level == goal:
            return level
        return level + (goal - level) * (tick - start) / (self.ticks[place + 1] - start)


def velocity_of(level: float, kinds: Iterable[str], loudness: float | None) -> int:
    """Velocity of a note at a ``level``, with marks of the given kinds; ``loudness`` (1: forte), if the file gives it
    for this note, overrides both.
    """
    if loudness is not None:
        return int(min(max(round(_FORTE * loudness), 1), _MOST))
    share = max((ACCENT_SHARES.get(kind, 1.0) for kind in kinds), default=1.0)
    return int(min(max(round(level * share), 1), _MOST))


def _level(text: str) -> float | None:
    """Velocity that a dynamic sets from its place on; None if it is only an accent."""
    if text in ("mp", "mf"):
        return 64.0 if text == "mp" else 80.0
    if text == "n":
        return 1.0
    for sign, levels in (("p", _SOFT), ("f", _LOUD)):
        if text.strip(sign) == "":
            return float(levels[min(len(text), len(levels)) - 1])
    if text == "pf":
        return float(_LOUD[0])
    # "fp", "sfp", "sffpp": the final dynamic.
    soft = len(text) - len(text.rstrip("p"))
    return float(_SOFT[min(soft, len(_SOFT)) - 1]) if soft else None


def held_dynamic(text: str) -> str:
    """Dynamic that stays in force after a dynamic mark, such as "p" after "fp"; empty if the mark is only an accent."""
    if _level(text) is None or text in ("mp", "mf", "n") or text.strip("p") == "" or text.strip("f") == "":
        return text if _level(text) is not None else ""
    return "f" if text == "pf" else text[len(text.rstrip("p")) :]


def _struck(text: str) -> float | None:
    """Velocity of the notes directly at a dynamic mark, if it differs from the one afterwards (as in "fp");
    else None.
    """
    if text in ("mp", "mf", "n") or not text.strip("p") or not text.strip("f"):
        return None
    return float(_SOFT[0]) if text == "pf" else float(_LOUD[0]) if text == "fp" else _FORCED


def hairpins(directions: Sequence[tuple[int, Direction]], quarter: int, end_tick: int) -> list[Mark]:
    """Crescendos and diminuendos of a part as marks: from hairpins, and from words, which last to the end of their
    dashes or to the next dynamic.

    Parameters
    ----------
    directions : sequence of (tick, Direction)
        Directions of the part, ordered by tick.
    """
    found: list[Mark] = []
    open_: dict[str, tuple[int, str]] = {}
    dashes: dict[str, int] = {}
    worded: list[tuple[int, str]] = []

    def close(end: int) -> None:
        for start, kind in worded:
            if end > start:
                found.append(Mark(kind, tick=start, end_tick=min(end, start + _WORD_QUARTERS * quarter, end_tick)))
        worded.clear()

    for tick, one in directions:
        if one.kind == "wedge" and one.text != "stop":
            close(tick)
            open_[one.number] = tick, one.text
        elif one.kind == "wedge":
            number = one.number if one.number in open_ else next(iter(open_), "")
            start, kind = open_.pop(number, (tick, ""))
            if tick > start:
                found.append(Mark(kind, tick=start, end_tick=tick))
        elif one.kind == "words" and (_GROWING.search(one.text) or _FADING.search(one.text)):
            close(tick)
            worded.append((tick, "crescendo" if _GROWING.search(one.text) else "diminuendo"))
        elif one.kind == "dynamic" and worded and tick > worded[0][0]:
            close(tick)
        elif one.kind == "dashes" and one.text == "start":
            dashes[one.number] = tick
        elif one.kind == "dashes" and worded and dashes.pop(one.number, -1) >= worded[0][0]:
            close(tick)
    close(end_tick)
    return sorted(dict.fromkeys(found), key=lambda mark: (mark.tick, mark.end_tick))[:_MOST_HAIRPINS]


def loudness_of(directions: Sequence[tuple[int, Direction]], spans: Sequence[Mark], quarter: int) -> Loudness:
    """Compute the loudness of a part from its directions and hairpins.

    Parameters
    ----------
    directions : sequence of (tick, Direction)
        Directions of the part, ordered by tick.
    spans : sequence of Mark
        Hairpins of the part, ordered by tick.
    """
    written = {tick for tick, one in directions if one.kind == "dynamic"}
    steps: dict[int, float] = {}
    forced: dict[int, float] = {}
    for tick, one in directions:
        if one.kind == "dynamic":
            level, struck = _level(one.text), _struck(one.text)
            if level is not None:
                steps[tick] = level
            if struck is not None:
                forced[tick] = struck
        elif one.kind == "loudness" and tick not in written:
            steps[tick] = min(max(_FORTE * one.value, 1.0), _MOST)
    at = sorted(steps)
    points: dict[int, tuple[float, float]] = {tick: (steps[tick], steps[tick]) for tick in at}
    free = 0
    for mark in spans:
        start, end = max(mark.tick, free), mark.end_tick
        if end <= start:
            continue
        place = bisect_right(at, start)
        level = _now(points, at, start)
        following = at[place] if place < len(at) else None
        sign = 1.0 if mark.kind == "crescendo" else -1.0
        goal = min(max(level + sign * _STEP, 1.0), _MOST)
        if following is not None and following <= end + quarter and (steps[following] - level) * sign > 0:
            goal, end = steps[following], min(end, following) if following > start else end
        for tick in (start, end):
            if tick not in points:
                insort(at, tick)
        points[start] = level, goal
        points.setdefault(end, (goal, goal))
        free = end
    ticks = sorted(points)
    return Loudness(ticks, [points[tick][0] for tick in ticks], [points[tick][1] for tick in ticks], forced)


def _now(points: dict[int, tuple[float, float]], at: Sequence[int], tick: int) -> float:
    """Velocity level in force at a tick, given the ``points`` with a level by tick and their sorted ticks ``at``."""
    place = bisect_right(at, tick)
    return points[at[place - 1]][0] if place else _USUAL
