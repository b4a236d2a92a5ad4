"""Written marks of a part, by note: slurs, breath marks, articulations, tonguing, fingerings, dynamics."""

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
"""Marks of articulation, the strongest last."""


class WrittenFingerings(NamedTuple):
    """The fingerings written in a score, one entry per note; empty text: none."""

    label: tuple[str, ...] = ()
    by_hand: tuple[bool, ...] = ()
    """True for each note whose fingering the user set."""
    glides: tuple[bool, ...] = ()
    """True for each note with a glissando to the next one."""


NO_FINGERINGS: Final = WrittenFingerings()


@dataclass(frozen=True, eq=False)
class WrittenMarks:
    """Marks by note, arrays (N,).

    Attributes
    ----------
    source : {"sound", "score"}
        In a score, absence of a mark means that there is none; for a sound it means unknown.
    slurred : bool
        Whether the next note is slurred to it.
    tongued : bool
        Whether the next note is tongued in any case: where a slur begins or ends, or each note is tongued.
    joined : bool
        Whether one slur is over it and the next note, divided or not.
    divided : bool
        Whether it is tongued softly under a slur (portato).
    glides : bool
        Whether a glissando leads to the next note, which follows without a rest.
    breath : bool
        Whether a breath mark or caesura follows it.
    breath_by_hand, stroke_by_hand, fingering_by_hand : bool
        Whether the breath mark, the articulation or tonguing, and the fingering were written by hand.
    stroke : str
        Its mark of `OF_STROKE`; empty: none.
    tonguing : str
        ``"double_tongue"``, ``"triple_tongue"`` or ``"flutter_tongue"``; empty: none.
    fingering : str
        Fingering or slide position as written; empty: none.
    level : float64
        Loudness 0..1 by dynamics and hairpins; NaN where none is in force.
    swell : float64
        Rows of `DYNAMICS` by which a hairpin changes the heard loudness; 0 where a level exists.
    struck : bool
        Whether its dynamic is for this note only, as in a sforzando.
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
        """Mask (N,) of notes after which the next note is tongued, because of its own mark or because a slur ends."""
        marked = np.fromiter(map(bool, self.stroke), bool, len(self.stroke))
        return np.append(marked[1:], False)[: len(marked)] | self.tongued

    @cached_property
    def fingerings(self) -> WrittenFingerings:
        """The fingerings in the form used by the fingering plan."""
        return WrittenFingerings(self.fingering, tuple(self.fingering_by_hand.tolist()), tuple(self.glides.tolist()))

    @property
    def is_score(self) -> bool:
        """True if the marks are those of a score, so that a missing mark means that there is none."""
        return self.source == "score"

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing inputs of cached steps."""
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
    """Return the marks of a part by note; marks of missing notes have no effect.

    Parameters
    ----------
    corrections : tuple of Correcting
        Corrections of the part; marks set by them count as written by hand.
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
                # The neighbouring notes of an ornament have marks of their own.
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
    """Masks (N,) of notes slurred to the next, and of notes under a slur that their strokes separate from the note
    before.
    """
    count = len(stroke)
    under = joined | np.concatenate(([False], joined[:-1]))[:count]
    divided = under & np.fromiter((mark in DIVIDING for mark in stroke), bool, count)
    return joined & ~np.append(divided[1:], False)[:count], divided


def unwritten(count: int) -> WrittenMarks:
    """Return the data of ``count`` notes without any marks, as for a part read from sound."""
    none = np.zeros(count, dtype=bool)
    names = ("",) * count
    level, swell = np.full(count, np.nan), np.zeros(count)
    flags = (none,) * 9
    return WrittenMarks("sound", *flags, names, names, names, level, swell, none)
