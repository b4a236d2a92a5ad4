"""Marks written for a player: slurs, articulations, breaths, dynamics. One table row for each kind.

A mark is anchored to notes by their ids or to ticks of the piece. It has no effect if the player lacks its notes.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

import msgspec

Source: TypeAlias = Literal["sound", "score"]
"""Origin of a part: a performance or a score. In a score the absence of marks has a meaning: a note without slur is
tongued.
"""


class Marking(NamedTuple):
    """A kind of mark.

    Attributes
    ----------
    id : str
        Name of the kind; also stored in project files.
    anchor : {"note", "notes", "place", "span"}
        Anchor: one note (or first and last of a written-out ornament), first and last of several notes, a tick, or a
        span of ticks.
    """

    id: str
    anchor: Literal["note", "notes", "place", "span"] = "note"


MARKINGS: Final = (
    Marking("slur", "notes"),
    Marking("non_legato", "notes"),
    Marking("staccato"),
    Marking("staccatissimo"),
    Marking("tenuto"),
    Marking("accent"),
    Marking("marcato"),
    Marking("breath"),
    Marking("caesura"),
    Marking("fermata"),
    Marking("dynamic", "place"),
    Marking("crescendo", "span"),
    Marking("diminuendo", "span"),
    Marking("double_tongue"),
    Marking("triple_tongue"),
    Marking("flutter_tongue"),
    Marking("grace"),
    Marking("trill"),
    Marking("mordent"),
    Marking("turn"),
    Marking("tremolo"),
    Marking("scoop"),
    Marking("plop"),
    Marking("doit"),
    Marking("fall"),
    Marking("glissando"),
    Marking("stopped"),
    Marking("open"),
    Marking("fingering"),
    Marking("position"),
)
SFORZANDI: Final = frozenset({"sf", "sfz", "sffz", "fz", "rf", "rfz", "sfzz"})
"""Dynamics of a single note, played louder than those around it, in addition to the dynamic in force."""
ACCENT_SHARES: Final[Mapping[str, float]] = {"accent": 1.2, "marcato": 1.3}
"""Velocity of accented notes in notation programs, relative to the others'."""
MARK: Final = "mark"
"""Prefix of the ids of marks."""
MARK_KINDS: Final[Mapping[str, Marking]] = {kind.id: kind for kind in MARKINGS}
WRITABLE: Final = (
    *("slur", "non_legato", "staccato", "staccatissimo", "tenuto", "accent", "marcato"),
    *("double_tongue", "triple_tongue", "flutter_tongue", "breath", "caesura", "crescendo", "diminuendo"),
)
"""Kinds of marks that the user can add, besides dynamics."""
WRITABLE_DYNAMICS: Final = ("ppp", "pp", "p", "mp", "mf", "f", "ff", "fff", "sfz", "fp")
if TYPE_CHECKING:
    MarkKind: TypeAlias = str
else:
    # Readers of files refuse all other kinds.
    MarkKind = Literal[tuple(MARK_KINDS)]


class Mark(msgspec.Struct, frozen=True, gc=False, omit_defaults=True):
    """A mark in the music.

    Attributes
    ----------
    note_id : str
        The note it belongs to, or the first of several; empty if anchored to ticks.
    last_note_id : str
        Last note of a slur, of notes tongued one by one, or of a written-out trill or tremolo; empty for a single note.
    tick, end_tick : int
        Anchor in ticks; the end is 0 for a single place. A dynamic with an end is in force until then.
    text : str
        ``"mf"``, ``"sfz"`` of a dynamic; ``"1-2"``, ``"0"`` of a fingering; ``"4"`` of a position.
    """

    kind: MarkKind
    note_id: str = ""
    last_note_id: str = ""
    tick: int = 0
    end_tick: int = 0
    text: str = ""

    @property
    def id(self) -> str:
        """Id of the mark, made of its kind and anchor; unique among the events of its player."""
        return mark_id(self.kind, self.note_id, self.last_note_id, self.tick, self.text)


def mark_id(kind: str, note_id: str, last_note_id: str, tick: int, text: str = "") -> str:
    """Return `Mark.id` of a mark at notes (``"mark:slur:0:1-0:5"``) or at a tick (``"mark:dynamic:@480"``; a sforzando
    there has ``"mark:sforzando:@480"``).
    """
    if not note_id:
        if text in SFORZANDI:
            kind = "sforzando"
        return f"{MARK}:{kind}:@{tick}"
    return f"{MARK}:{kind}:{note_id}-{last_note_id}" if last_note_id else f"{MARK}:{kind}:{note_id}"


def renamed_marks(marks: Iterable[Mark], ids: Mapping[str, str]) -> tuple[Mark, ...]:
    """Return the marks with note ids replaced by ``ids``; ids that are not in it stay."""
    return tuple(
        msgspec.structs.replace(
            mark,
            note_id=ids.get(mark.note_id, mark.note_id),
            last_note_id=ids.get(mark.last_note_id, mark.last_note_id),
        )
        if mark.note_id
        else mark
        for mark in marks
    )


def marks_of_player(
    marks: Sequence[Mark], all_notes: Mapping[str, int], own_notes: Sequence[tuple[int, str, str]]
) -> tuple[Mark, ...]:
    """Select the marks of one player from those of a staff that several players share.

    A slur that begins or ends at another player's note is shortened to this player's notes; it is dropped if fewer than
    two remain.

    Parameters
    ----------
    all_notes : mapping of note id to tick
        Onsets of the notes of the staff.
    own_notes : sequence of (tick, note id, note id)
        Onset, id in the staff and id for the player of each note, by onset.
    """
    ids = {id: own for _, id, own in own_notes}
    onsets = [onset for onset, _, _ in own_notes]
    found = []
    for mark in marks:
        if not mark.note_id:
            found.append(mark)
            continue
        first, last = ids.get(mark.note_id), ids.get(mark.last_note_id)
        if mark.last_note_id and (first is None) != (last is None):
            start, end = all_notes.get(mark.note_id), all_notes.get(mark.last_note_id)
            if start is not None and first is None and (place := bisect_left(onsets, start)) < len(onsets):
                first = own_notes[place][2]
            if end is not None and last is None and (place := bisect_right(onsets, end)):
                last = own_notes[place - 1][2]
        if first is None or (mark.last_note_id and (last is None or last == first)):
            continue
        found.append(msgspec.structs.replace(mark, note_id=first, last_note_id=last or ""))
    return tuple(dict.fromkeys(found))


def moved_marks(marks: Iterable[Mark], place: Callable[[int], int]) -> tuple[Mark, ...]:
    """Move the marks that are anchored to ticks; ``place`` maps old ticks to new ones."""
    return tuple(
        mark
        if mark.note_id
        else msgspec.structs.replace(
            mark, tick=max(place(mark.tick), 0), end_tick=max(place(mark.end_tick), 0) if mark.end_tick else 0
        )
        for mark in marks
    )
