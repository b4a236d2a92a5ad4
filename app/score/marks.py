"""Marks that a composer wrote for a player: slurs, articulations, breaths, dynamics. One row for each kind.

A mark is anchored to notes by their ids, or to ticks of the piece. One whose notes a player does not have does nothing.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

import msgspec

Source: TypeAlias = Literal["sound", "score"]
"""Origin of a part. In a score the absence of marks means something: a note that is not slurred is tongued."""


class Marking(NamedTuple):
    """A kind of mark.

    Attributes
    ----------
    id : str
        Also in users' files.
    anchor : {"note", "notes", "place", "span"}
        One note (an ornament that was written out: its first and its last), the first and the last of several, a tick,
        or ticks from and to which it holds.
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
"""Dynamics of one note, played louder than those around it: they stand beside the one that holds."""
ACCENT_SHARES: Final[Mapping[str, float]] = {"accent": 1.2, "marcato": 1.3}
"""Velocity that a reader of notation gives to accented notes, as a multiple of the others'."""
MARK: Final = "mark"
"""Begins the ids of marks."""
MARK_KINDS: Final[Mapping[str, Marking]] = {kind.id: kind for kind in MARKINGS}
WRITABLE: Final = (
    *("slur", "non_legato", "staccato", "staccatissimo", "tenuto", "accent", "marcato"),
    *("double_tongue", "triple_tongue", "flutter_tongue", "breath", "caesura", "crescendo", "diminuendo"),
)
"""Kinds that are offered to be written by hand, beside dynamics."""
WRITABLE_DYNAMICS: Final = ("ppp", "pp", "p", "mp", "mf", "f", "ff", "fff", "sfz", "fp")
if TYPE_CHECKING:
    MarkKind: TypeAlias = str
else:
    # Readers of files refuse all others.
    MarkKind = Literal[tuple(MARK_KINDS)]


class Mark(msgspec.Struct, frozen=True, gc=False, omit_defaults=True):
    """A mark in the music.

    Attributes
    ----------
    note_id : str
        The note it stands at, or the first of several; empty for one anchored to ticks.
    last_note_id : str
        The last of several notes: of a slur, of notes tongued one by one, or of those that a trill or a tremolo was
        written out in, which has none where it is one note.
    tick, end_tick : int
        Of one anchored to ticks; the end is 0 where it stands at one place. A dynamic with an end holds up to it.
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
        """Name of the mark among the events of its player: its kind and where it stands."""
        return mark_id(self.kind, self.note_id, self.last_note_id, self.tick, self.text)


def mark_id(kind: str, note_id: str, last_note_id: str, tick: int, text: str = "") -> str:
    """Return `Mark.id` of a mark at notes (``"mark:slur:0:1-0:5"``), or else at a tick (``"mark:dynamic:@480"``, and
    ``"mark:sforzando:@480"`` beside it)."""
    if not note_id:
        if text in SFORZANDI:
            kind = "sforzando"
        return f"{MARK}:{kind}:@{tick}"
    return f"{MARK}:{kind}:{note_id}-{last_note_id}" if last_note_id else f"{MARK}:{kind}:{note_id}"


def renamed_marks(marks: Iterable[Mark], ids: Mapping[str, str]) -> tuple[Mark, ...]:
    """The marks with other ids for their notes; those of notes without a new id keep theirs."""
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
    """The marks that one of the players of a staff has.

    A slur that begins or ends at another player's note holds for what this one has of it, where that is two notes.

    Parameters
    ----------
    all_notes : mapping of note id to tick
        Onsets of the notes of the staff.
    own_notes : sequence of (tick, note id, note id)
        Onset, id in the staff and id with the player, by onset.
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
    """The marks with those anchored to ticks elsewhere."""
    return tuple(
        mark
        if mark.note_id
        else msgspec.structs.replace(
            mark, tick=max(place(mark.tick), 0), end_tick=max(place(mark.end_tick), 0) if mark.end_tick else 0
        )
        for mark in marks
    )
