"""Written dynamics and hairpins: the dynamic in force at a tick, and the loudness of notes that begin there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.music.velocity_ladders import DYNAMICS, LEVELS
from app.score.marks import SFORZANDI, Mark, Source

ROW_OF_DYNAMIC: Final[dict[str, float]] = {
    **{name: float(row) for row, (name, _) in enumerate(DYNAMICS)},
    "n": 0.0, "pppp": 0.0, "ppppp": 0.0, "pppppp": 0.0, "ffff": 7.0, "fffff": 7.0, "ffffff": 7.0
}  # fmt: skip
"""Row in `DYNAMICS` of each mark that holds until the next one."""
FORTE_THEN: Final = {"fp": "p", "sfp": "p", "ffp": "p", "mfp": "p", "sfzp": "p", "sfpp": "pp", "pf": "f"}
"""Marks that apply to one note, with the dynamic that follows."""
DYNAMIC_TEXTS: Final = (*ROW_OF_DYNAMIC, *FORTE_THEN, *sorted(SFORZANDI))
"""Marks with a known meaning."""
FORTE: Final = ROW_OF_DYNAMIC["f"]
LOUDER_ROWS: Final = 1.5
"""Rows of `DYNAMICS` by which a sforzando is louder than the current dynamic."""
NEXT_MARK_QUARTERS: Final = 1.0
"""Quarters after a hairpin within which a dynamic is the hairpin's goal."""
HAIRPIN_ROWS: Final = 1.0
"""Rows by which a hairpin without a goal changes the dynamic."""
MOST: Final = float(len(LEVELS) - 1)
"""Row of the loudest dynamic."""


class WrittenDynamics(NamedTuple):
    """Dynamics by tick, as rows of `DYNAMICS`.

    Attributes
    ----------
    ticks, rows : (K,) float64
        Dynamic in force, linear between these ticks.
    spans : tuple of (tick, end tick, row)
        Dynamics for a passage only.
    swells : tuple of (tick, end tick, rows)
        Hairpins without a written dynamic, relative to the loudness heard, with the change in rows at their end.
    struck : tuple of int
        Ticks of sforzandi.
    """

    ticks: FloatArray
    rows: FloatArray
    spans: tuple[tuple[int, int, float], ...]
    swells: tuple[tuple[int, int, float], ...]
    struck: tuple[int, ...]

    def rows_at(self, ticks: FloatArray) -> FloatArray:
        """Written dynamic in force at given ticks as a row of `DYNAMICS`, fractional within a hairpin; NaN where there
        is none."""
        found = np.full(len(ticks), np.nan)
        if len(self.ticks):
            known = ticks >= self.ticks[0]
            found[known] = np.interp(ticks[known], self.ticks, self.rows)
        for start, end, row in self.spans:
            found[(ticks >= start) & (ticks < end)] = row
        return found

    def swell_at(self, ticks: FloatArray) -> FloatArray:
        """Change of loudness by hairpins at given ticks, in rows of `DYNAMICS` relative to the loudness heard."""
        found = np.zeros(len(ticks))
        for start, end, rows in self.swells:
            within = (ticks >= start) & (ticks < end)
            found[within] = rows * (ticks[within] - start) / (end - start)
        return found


NONE_WRITTEN: Final = WrittenDynamics(np.empty(0), np.empty(0), (), (), ())


def written_dynamics(marks: Iterable[Mark], source: Source, quarter: int) -> WrittenDynamics:
    """Collect the dynamics and hairpins among the marks of a part."""
    of_dynamics = [mark for mark in marks if mark.kind in ("dynamic", "crescendo", "diminuendo")]
    if not of_dynamics:
        return NONE_WRITTEN
    holding = {mark.tick: row for mark in of_dynamics if not mark.end_tick and (row := holding_row(mark)) is not None}
    hairpins = [mark for mark in of_dynamics if mark.kind != "dynamic" and mark.end_tick > mark.tick]
    swells = []
    if source == "sound":
        # Before the first dynamic, hairpins change the played dynamic.
        first = min(holding, default=None)
        heard = [mark for mark in hairpins if first is None or mark.tick < first]
        hairpins = [mark for mark in hairpins if mark not in heard]
        swells = [
            (mark.tick, mark.end_tick, HAIRPIN_ROWS if mark.kind == "crescendo" else -HAIRPIN_ROWS) for mark in heard
        ]
    ticks, rows = _knots(holding, hairpins, quarter)
    spans = [
        (mark.tick, mark.end_tick, row)
        for mark in of_dynamics
        if mark.kind == "dynamic" and mark.end_tick and (row := holding_row(mark)) is not None
    ]
    struck = [mark.tick for mark in of_dynamics if mark.kind == "dynamic" and _is_of_one_note(mark.text)]
    found = np.array(ticks, np.float64), np.array(rows, np.float64)
    return WrittenDynamics(*found, tuple(spans), tuple(swells), tuple(struck))


def note_dynamics(onsets: IntArray, written: WrittenDynamics, quarter: int) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return for each note at its onset the loudness (N,) 0..1 (NaN without a dynamic in force), the change (N,) by
    hairpins in rows of `DYNAMICS`, and a mask (N,) of the notes whose dynamic applies to them alone.
    """
    at = onsets.astype(np.float64)
    rows = written.rows_at(at)
    struck = np.zeros(len(onsets), dtype=bool)
    for index in struck_notes(onsets, written, quarter):
        around = 0.0 if np.isnan(rows[index]) else rows[index]
        rows[index] = min(max(FORTE, around + LOUDER_ROWS), MOST)
        struck[index] = True
    return loudness_of_rows(rows), written.swell_at(at), struck


def loudness_of_rows(rows: FloatArray) -> FloatArray:
    """Loudness (N,), 0..1, of dynamics given as rows of `DYNAMICS`, such as 0 for the softest."""
    return np.asarray(np.interp(rows, np.arange(len(LEVELS)), LEVELS))


def rows_of_loudness(loudness: FloatArray) -> FloatArray:
    """Convert loudness (N,) 0..1 to rows of `DYNAMICS`, fractional between two dynamics."""
    return np.asarray(np.interp(loudness, LEVELS, np.arange(len(LEVELS), dtype=np.float64)))


def struck_notes(onsets: IntArray, written: WrittenDynamics, quarter: int) -> list[int]:
    """Indices of the notes with a sforzando: for each sforzando the first note within a quarter after it."""
    found = []
    for tick in written.struck:
        index = int(np.searchsorted(onsets, tick))
        if index < len(onsets) and onsets[index] < tick + quarter:
            found.append(index)
    return found


def _is_of_one_note(text: str) -> bool:
    """Return whether a dynamic text begins with an accent that applies to one note only, such as "sfz"."""
    return text in SFORZANDI or (text in FORTE_THEN and text != "pf")


def holding_row(mark: Mark) -> float | None:
    """Row in `DYNAMICS` of the dynamic that stays in force after a mark; None if it changes nothing."""
    return ROW_OF_DYNAMIC.get(FORTE_THEN.get(mark.text, mark.text)) if mark.kind == "dynamic" else None


def _knots(holding: dict[int, float], hairpins: Sequence[Mark], quarter: int) -> tuple[list[int], list[float]]:
    """Knots of the dynamic in force as ticks and rows, linear in between: dynamics are steps, hairpins ramps."""
    ticks: list[int] = []
    rows: list[float] = []

    def go(tick: int, row: float) -> None:
        """Add a knot; if there already is one at the same tick, that one is moved just before it."""
        if ticks and tick <= ticks[-1]:
            rows[-1] = row
            return
        ticks.append(tick)
        rows.append(row)

    marked = sorted(holding)
    starts = sorted({*marked, *(mark.tick for mark in hairpins)})
    pins = {mark.tick: mark for mark in hairpins}
    reached = -1
    for tick in starts:
        if tick < reached and tick not in holding:
            # Only one hairpin applies at a time.
            continue
        known = holding.get(tick)
        row = known if known is not None else (rows[-1] if rows else None)
        if row is None:
            if tick not in pins:
                continue
            row = ROW_OF_DYNAMIC["mf"]
        if rows and tick - 1 > ticks[-1] and row != rows[-1]:
            go(tick - 1, rows[-1])
        go(tick, row)
        pin = pins.get(tick)
        if pin is None or pin.end_tick <= tick:
            continue
        up = 1.0 if pin.kind == "crescendo" else -1.0
        aim = next((mark for mark in marked if tick < mark <= pin.end_tick + NEXT_MARK_QUARTERS * quarter), None)
        reached = pin.end_tick if aim is None else min(pin.end_tick, aim)
        goal = None if aim is None else holding[aim]
        if goal is None or (goal - row) * up <= 0.0:
            goal = min(max(row + up * HAIRPIN_ROWS, 0.0), float(len(LEVELS) - 1))
        # The value just before the next dynamic begins.
        go(reached - (reached in holding and holding[reached] != goal), goal)
    return ticks, rows
