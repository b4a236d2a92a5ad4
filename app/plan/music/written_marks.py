"""Written marks of a line by note: slurs, breath marks, articulations, tonguing, fingerings, dynamics."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.plan.music.velocity_ladders import DYNAMICS, LEVELS
from app.score.marks import Mark, Source
from app.score.model import Note

ROW_OF_DYNAMIC: Final[dict[str, float]] = {
    **{name: float(row) for row, (name, _) in enumerate(DYNAMICS)},
    "n": 0.0, "pppp": 0.0, "ppppp": 0.0, "pppppp": 0.0, "ffff": 7.0, "fffff": 7.0, "ffffff": 7.0
}  # fmt: skip
"""Row in `DYNAMICS` of each mark that holds until the next one."""
FORTE_THEN: Final = {"fp": "p", "sfp": "p", "ffp": "p", "mfp": "p", "sfzp": "p", "sfpp": "pp", "pf": "f"}
"""Marks of which the first part is one note's, with the dynamic that holds after it."""
SFORZANDI: Final = frozenset({"sf", "sfz", "sffz", "fz", "rf", "rfz", "sfzz"})
"""Marks of one note, played louder than those around it."""
DYNAMIC_TEXTS: Final = (*ROW_OF_DYNAMIC, *FORTE_THEN, *sorted(SFORZANDI))
"""Marks that have a meaning."""
FORTE: Final = ROW_OF_DYNAMIC["f"]
LOUDER_ROWS: Final = 1.5
"""Rows of `DYNAMICS` by which a sforzando is louder than the dynamic in force."""
NEXT_MARK_QUARTERS: Final = 1.0
"""A dynamic that comes so soon after a hairpin is where the hairpin leads."""
HAIRPIN_ROWS: Final = 1.0
"""Rows by which a hairpin without a goal changes the dynamic."""
DIVIDING: Final = frozenset({"staccato", "staccatissimo", "tenuto", "marcato"})
"""Marks that divide a slur: its notes are tongued softly."""
OF_STROKE: Final = ("staccatissimo", "staccato", "tenuto", "accent", "marcato")
"""Marks that say how a note is struck, the strongest last."""


@dataclass(frozen=True, eq=False)
class WrittenMarks:
    """Marks by note, arrays (N,).

    Attributes
    ----------
    source : {"sound", "score"}
        Of a score a note without marks has none; of a sound they are unknown.
    slurred : bool
        Whether the next note is slurred to it.
    tongued : bool
        Whether the next note is tongued whatever the sound says: where a slur ends, or each note is tongued.
    joined : bool
        Whether one slur is over it and the next note, divided or not.
    divided : bool
        Whether it is tongued softly under a slur (portato).
    breath : bool
        Whether a breath mark or a caesura follows it.
    stroke : str
        The mark of `OF_STROKE` that it has; empty: none.
    tonguing : str
        ``"double_tongue"``, ``"triple_tongue"`` or ``"flutter_tongue"``; empty: none.
    fingering : str
        The fingering or slide position, as it is written; empty: none.
    level : float64
        Loudness 0..1 by dynamics and hairpins; NaN where none is in force.
    swell : float64
        Rows of `DYNAMICS` by which a hairpin changes what the sound says; 0 where there is a level.
    struck : bool
        Whether its dynamic is its own only, as of a sforzando.
    """

    source: Source
    slurred: BoolArray
    tongued: BoolArray
    joined: BoolArray
    divided: BoolArray
    breath: BoolArray
    stroke: tuple[str, ...]
    tonguing: tuple[str, ...]
    fingering: tuple[str, ...]
    level: FloatArray
    swell: FloatArray
    struck: BoolArray

    @property
    def tongued_next(self) -> BoolArray:
        """True if the next note has a mark that says that it is tongued, or follows a slur's end."""
        marked = np.fromiter(map(bool, self.stroke), bool, len(self.stroke))
        return np.append(marked[1:], False)[: len(marked)] | self.tongued

    @property
    def is_score(self) -> bool:
        """True if the absence of marks says something."""
        return self.source == "score"

    def __eq__(self, other: object) -> bool:
        """Return whether they are the same to the last bit, as inputs of steps are compared."""
        if not isinstance(other, WrittenMarks):
            return NotImplemented
        pairs = ((getattr(self, field.name), getattr(other, field.name)) for field in fields(self))
        return all(
            np.array_equal(mine, others, equal_nan=mine.dtype.kind == "f")
            if isinstance(mine, np.ndarray)
            else mine == others
            for mine, others in pairs
        )

    __hash__ = None  # type: ignore[assignment]


def written_marks(
    notes: tuple[Note, ...], marks: tuple[Mark, ...], source: Source, ticks_per_quarter: int
) -> WrittenMarks:
    """Return the marks of a line by note; those of notes that it does not have do nothing."""
    count = len(notes)
    if not marks and source == "sound":
        return unwritten(count)
    place = {note.id: index for index, note in enumerate(notes)}
    slurred, apart, ends, breath = (np.zeros(count, dtype=bool) for _ in range(4))
    stroke, tonguing, fingering = [""] * count, [""] * count, [""] * count
    for mark in marks:
        first = place.get(mark.note_id)
        if first is None:
            continue
        last = place.get(mark.last_note_id, first)
        if mark.kind == "slur":
            slurred[first:last] = True
            ends[last] = True
        elif mark.kind == "non_legato":
            apart[first:last] = True
        elif mark.kind in ("breath", "caesura"):
            breath[last] = True
        elif mark.kind in OF_STROKE:
            stroke[first] = max(stroke[first] or mark.kind, mark.kind, key=OF_STROKE.index)
        elif mark.kind.endswith("_tongue"):
            tonguing[first : last + 1] = [mark.kind] * (last + 1 - first)
        elif mark.kind in ("fingering", "position"):
            for index in range(first, last + 1):
                # Of an ornament the neighbours have their own.
                if notes[index].pitch == notes[first].pitch:
                    fingering[index] = mark.text
    slurred &= ~apart
    tongued = apart | (ends & ~slurred)
    under = slurred | np.insert(slurred[:-1], 0, False)[:count]
    dividing = np.fromiter((mark in DIVIDING for mark in stroke), bool, count)
    divided = under & dividing
    # The stroke of the next note divides them.
    joined = slurred
    slurred = joined & ~np.append(divided[1:], False)[:count]
    level, swell, struck = _levels(notes, marks, source, ticks_per_quarter)
    by_note = tuple(stroke), tuple(tonguing), tuple(fingering), level, swell, struck
    return WrittenMarks(source, slurred, tongued, joined, divided, breath, *by_note)


def unwritten(count: int) -> WrittenMarks:
    """Return the marks of so many notes without any, read from sound."""
    none = np.zeros(count, dtype=bool)
    names = ("",) * count
    level, swell = np.full(count, np.nan), np.zeros(count)
    return WrittenMarks("sound", none, none, none, none, none, names, names, names, level, swell, none)


def _levels(
    notes: Sequence[Note], marks: Iterable[Mark], source: Source, quarter: int
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Loudness of each note by dynamics and hairpins, by how much hairpins change what the sound says, and whether the
    loudness is the note's own."""
    onsets = np.fromiter((note.onset_tick for note in notes), np.int64, len(notes))
    level, swell = np.full(len(onsets), np.nan), np.zeros(len(onsets))
    struck = np.zeros(len(onsets), dtype=bool)
    of_dynamics = [mark for mark in marks if mark.kind in ("dynamic", "crescendo", "diminuendo")]
    if not of_dynamics or not len(onsets):
        return level, swell, struck
    spans = [mark for mark in of_dynamics if mark.kind == "dynamic" and mark.end_tick]
    holding = {mark.tick: row for mark in of_dynamics if not mark.end_tick and (row := _holding_row(mark)) is not None}
    hairpins = [mark for mark in of_dynamics if mark.kind != "dynamic"]
    if source == "sound":
        # Before the first dynamic they change what is heard.
        first = min(holding, default=None)
        heard = [mark for mark in hairpins if first is None or mark.tick < first]
        hairpins = [mark for mark in hairpins if mark not in heard]
        for mark in heard:
            within = (onsets >= mark.tick) & (onsets < mark.end_tick)
            way = (onsets[within] - mark.tick) / (mark.end_tick - mark.tick) if within.any() else 0.0
            swell[within] = (HAIRPIN_ROWS if mark.kind == "crescendo" else -HAIRPIN_ROWS) * way
    ticks, rows = _knots(holding, hairpins, quarter)
    if ticks:
        known = onsets >= ticks[0]
        level[known] = np.interp(onsets[known], ticks, rows)
    for mark in spans:
        if (row := _holding_row(mark)) is not None:
            level[(onsets >= mark.tick) & (onsets < mark.end_tick)] = row
    for mark in of_dynamics:
        own = FORTE if mark.text in FORTE_THEN and mark.text != "pf" else None
        if mark.kind != "dynamic" or (own is None and mark.text not in SFORZANDI):
            continue
        at = int(np.searchsorted(onsets, mark.tick))
        if at == len(onsets) or onsets[at] >= mark.tick + quarter:
            continue
        around = level[at]
        level[at] = max(own if own is not None else FORTE, 0.0 if np.isnan(around) else around + LOUDER_ROWS)
        level[at] = min(level[at], float(len(LEVELS) - 1))
        struck[at] = True
    return np.interp(level, np.arange(len(LEVELS)), LEVELS), swell, struck


def _holding_row(mark: Mark) -> float | None:
    """Row in `DYNAMICS` of what a dynamic mark leaves in force; None: it says nothing about that."""
    return ROW_OF_DYNAMIC.get(FORTE_THEN.get(mark.text, mark.text)) if mark.kind == "dynamic" else None


def _knots(holding: dict[int, float], hairpins: Sequence[Mark], quarter: int) -> tuple[list[int], list[float]]:
    """Ticks and rows of the dynamic in force, linear between them: dynamics are steps, hairpins ways."""
    ticks: list[int] = []
    rows: list[float] = []

    def go(tick: int, row: float) -> None:
        """Add a knot; of two at one tick the earlier lies just before it."""
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
            # One hairpin at a time.
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
        # Where another dynamic begins, it has come as far just before.
        go(reached - (reached in holding and holding[reached] != goal), goal)
    return ticks, rows
