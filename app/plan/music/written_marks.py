"""Written marks of a line by note: slurs, breath marks, articulations, tonguing, fingerings, dynamics."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.plan.by_hand.correction import Correcting
from app.plan.by_hand.mark_corrections import SetMark
from app.plan.music.written_dynamics import note_dynamics, written_dynamics
from app.score.marks import MARK_KINDS, Mark, Source
from app.score.model import Note

DIVIDING: Final = frozenset({"staccato", "staccatissimo", "tenuto", "marcato"})
"""Marks that divide a slur: its notes are tongued softly."""
OF_STROKE: Final = ("staccatissimo", "staccato", "tenuto", "accent", "marcato")
"""Marks that say how a note is struck, the strongest last."""


class WrittenFingerings(NamedTuple):
    """Fingerings in a score, each field by note; empty: none."""

    label: tuple[str, ...] = ()
    by_hand: tuple[bool, ...] = ()
    """True where a hand wrote it."""
    glides: tuple[bool, ...] = ()
    """True where a glissando leads to the next note."""


NO_FINGERINGS: Final = WrittenFingerings()


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
        Whether the next note is tongued whatever the sound says: where a slur begins or ends, or each is tongued.
    joined : bool
        Whether one slur is over it and the next note, divided or not.
    divided : bool
        Whether it is tongued softly under a slur (portato).
    glides : bool
        Whether a glissando leads to the next note, which follows without a rest.
    breath : bool
        Whether a breath mark or a caesura follows it.
    breath_by_hand, stroke_by_hand, fingering_by_hand : bool
        Whether the breath mark, the mark of the stroke or the tonguing, and the fingering was written by hand.
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
    glides: BoolArray
    breath: BoolArray
    breath_by_hand: BoolArray
    stroke_by_hand: BoolArray
    fingering_by_hand: BoolArray
    stroke: tuple[str, ...]
    tonguing: tuple[str, ...]
    fingering: tuple[str, ...]
    level: FloatArray
    swell: FloatArray
    struck: BoolArray

    @cached_property
    def tongued_next(self) -> BoolArray:
        """True if the next note has a mark that says that it is tongued, or follows a slur's end."""
        marked = np.fromiter(map(bool, self.stroke), bool, len(self.stroke))
        return np.append(marked[1:], False)[: len(marked)] | self.tongued

    @cached_property
    def fingerings(self) -> WrittenFingerings:
        """The fingerings, as the plan of fingerings reads them."""
        return WrittenFingerings(self.fingering, tuple(self.fingering_by_hand.tolist()), tuple(self.glides.tolist()))

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
    notes: tuple[Note, ...],
    marks: tuple[Mark, ...],
    source: Source,
    ticks_per_quarter: int,
    corrections: tuple[Correcting, ...] = (),
) -> WrittenMarks:
    """Return the marks of a line by note; those of notes that it does not have do nothing.

    Parameters
    ----------
    corrections : tuple of Correcting
        Of the line: they say which of the marks were written by hand.
    """
    count = len(notes)
    if not marks and source == "sound":
        return unwritten(count)
    place = {note.id: index for index, note in enumerate(notes)}
    by_hand = {item.mark for item in corrections if isinstance(item, SetMark)}
    slurred, apart, ends, glides, breath = (np.zeros(count, dtype=bool) for _ in range(5))
    breath_by_hand, stroke_by_hand, fingering_by_hand = (np.zeros(count, dtype=bool) for _ in range(3))
    stroke, tonguing, fingering = [""] * count, [""] * count, [""] * count
    for mark in marks:
        first = place.get(mark.note_id)
        if first is None or (MARK_KINDS[mark.kind].anchor == "notes" and mark.last_note_id not in place):
            continue
        last = place.get(mark.last_note_id, first)
        if mark.kind == "slur":
            slurred[first:last] = True
            ends[max(first - 1, 0) : first] = True
            ends[last] = True
        elif mark.kind == "non_legato":
            apart[first:last] = True
        elif mark.kind == "glissando" and last + 1 < count:
            glides[last] = notes[last].onset_tick + notes[last].duration_tick >= notes[last + 1].onset_tick
        elif mark.kind in ("breath", "caesura"):
            breath[last] = True
            breath_by_hand[last] = mark in by_hand
        elif mark.kind in OF_STROKE:
            stroke[first] = max(stroke[first] or mark.kind, mark.kind, key=OF_STROKE.index)
            stroke_by_hand[first] |= mark in by_hand
        elif mark.kind.endswith("_tongue"):
            tonguing[first : last + 1] = [mark.kind] * (last + 1 - first)
            stroke_by_hand[first : last + 1] |= mark in by_hand
        elif mark.kind in ("fingering", "position"):
            for index in range(first, last + 1):
                # Of an ornament the neighbours have their own.
                if notes[index].pitch == notes[first].pitch:
                    fingering[index] = mark.text
                    fingering_by_hand[index] = mark in by_hand
    joined = (slurred | glides) & ~apart
    tongued = apart | (ends & ~joined)
    slurred, divided = _divided(joined, stroke)
    onsets = np.fromiter((note.onset_tick for note in notes), np.int64, count)
    level, swell, struck = note_dynamics(onsets, written_dynamics(marks, source, ticks_per_quarter), ticks_per_quarter)
    flags = slurred, tongued, joined, divided, glides, breath, breath_by_hand, stroke_by_hand, fingering_by_hand
    by_note = tuple(stroke), tuple(tonguing), tuple(fingering), level, swell, struck
    return WrittenMarks(source, *flags, *by_note)


def _divided(joined: BoolArray, stroke: list[str]) -> tuple[BoolArray, BoolArray]:
    """Return which notes are slurred to the next, and which a stroke under a slur divides from the note before."""
    count = len(stroke)
    under = joined | np.concatenate(([False], joined[:-1]))[:count]
    divided = under & np.fromiter((mark in DIVIDING for mark in stroke), bool, count)
    return joined & ~np.append(divided[1:], False)[:count], divided


def unwritten(count: int) -> WrittenMarks:
    """Marks of a number of notes without any, as read from sound."""
    none = np.zeros(count, dtype=bool)
    names = ("",) * count
    level, swell = np.full(count, np.nan), np.zeros(count)
    flags = (none,) * 9
    return WrittenMarks("sound", *flags, names, names, names, level, swell, none)
