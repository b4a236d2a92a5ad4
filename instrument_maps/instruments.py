"""The instruments known by name, and their relations, such as sort and family."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple, TypeVar

import msgspec

from app.errors import MapError
from instrument_maps.model import InstrumentName
from instrument_maps.name_words import is_wide, words_of

T = TypeVar("T")


class Instrument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An instrument of the table: its ids, names and section.

    Attributes
    ----------
    kind : {"wind", "percussion", "other"}
        Kind of the instrument; only winds have players.
    names : tuple of str
        Names; the first is the English name for users, the first in kana or kanji the Japanese one. Comparison ignores
        case, diacritics, width and punctuation.
    programs : tuple of int
        General MIDI programs, 0..127.
    family : str
        Section of a wind instrument, one of those in the table's ``seating``.
    sort_of : str
        Id of the more general instrument of which this is a size or key: a clarinet in A is a sort of clarinet. A part
        for one may be played by the other if nothing fits better.
    by_name_only : bool
        Whether the instrument is never chosen by the range of notes alone.
    key_by_part : bool
        Whether players choose its key by the part, as tuba players do: a sort of it that reaches all notes precedes a
        map of its own that does not.
    any_pitch : bool
        Whether it is a wind section without a range ("brass"): the range of its notes determines the instrument, among
        ``families`` if given.
    various : bool
        Whether it represents several instruments, distinguished by the part's own name.
    vague : bool
        Whether its names may mean a part of any instrument ("Voice 1"), so that a program other than 0 is more
        informative.
    vague_names : tuple of str
        Names that mean a part of this instrument only in some ensembles ("Tenor 1"); an instrument found by one of them
        is vague.
    keyed_names : tuple of str
        Names that mean a part of this instrument only beside a key, its own or one of its forms ("Bass in C").
    key : str
        Key of the instrument, one of the table.
    form_of : tuple of str
        Ids of the instruments whose names, beside one of the ``marks``, name this one ("Clarinet" and "bass").
    marks : tuple of str
        Sizes, keys or clefs of the table; of two joined by a plus ("contrabass+E♭") both are required.
    """

    id: str
    kind: Literal["wind", "percussion", "other"]
    names: tuple[str, ...]
    programs: tuple[int, ...] = ()
    family: str = ""
    sort_of: str = ""
    by_name_only: bool = False
    families: tuple[str, ...] = ()
    key_by_part: bool = False
    any_pitch: bool = False
    various: bool = False
    vague: bool = False
    vague_names: tuple[str, ...] = ()
    keyed_names: tuple[str, ...] = ()
    key: str = ""
    form_of: tuple[str, ...] = ()
    marks: tuple[str, ...] = ()

    @property
    def japanese(self) -> str:
        """Japanese name of the instrument, as shown to people."""
        return next((name for name in self.names if any(map(is_wide, name))), self.names[0])


class Ensemble(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Instruments that play together.

    Attributes
    ----------
    parts : tuple of str
        Ids of instruments in the order of the staves.
    pitches : tuple of int
        The usual median of each part's notes at concert pitch, MIDI numbers.
    names : tuple of str
        Names in titles.
    unusual : float
        Semitones by which each part must fit better than in a usual ensemble.
    """

    parts: tuple[str, ...]
    pitches: tuple[int, ...]
    names: tuple[str, ...] = ()
    unusual: float = 0.0


class Compass(NamedTuple):
    """Range of concert pitches as MIDI numbers, both ends included: of all notes that occur in parts, and of most
    parts.
    """

    low: int
    easy_low: int
    easy_high: int
    high: int


class VocabularyTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Contents of the file `instrument_names.toml`.

    Attributes
    ----------
    instruments : tuple of Instrument
        Instruments; names and programs belong to one instrument each.
    seating : tuple of tuple of str
        Families of winds by row from the audience's side, each row from the audience's left.
    sizes, keys, clefs : dict of str to tuple of str
        Marks that distinguish the forms of an instrument, and the words for each.
    score_order : tuple of str
        Families from the top of a score to its bottom.
    family_names : dict of str to InstrumentName
        Name of each family by its id.
    ensembles : tuple of Ensemble
        Ensembles that are recognised by their parts.
    ranges : mapping of str to Compass
        Concert pitches of the parts of ensembles, by instrument.
    prefixes : tuple of str
        Words that may be joined to a name without changing its meaning ("Soloflöte", "ソロホルン").
    sounds : mapping of str to str
        Instrument by its id in MusicXML's standard list of sounds.
    strokes : mapping of str to int
        Drum kit key (MIDI number) by such a sound, or by the id of a percussion instrument.
    """

    instruments: tuple[Instrument, ...]
    ranges: dict[str, Compass] = {}
    ensembles: tuple[Ensemble, ...] = ()
    seating: tuple[tuple[str, ...], ...] = ()
    score_order: tuple[str, ...] = ()
    family_names: dict[str, InstrumentName] = {}
    sizes: dict[str, tuple[str, ...]] = {}
    keys: dict[str, tuple[str, ...]] = {}
    clefs: dict[str, tuple[str, ...]] = {}
    prefixes: tuple[str, ...] = ()
    sounds: dict[str, str] = {}
    strokes: dict[str, int] = {}


class InstrumentRelations:
    """Relations between the instruments of a vocabulary: more general instruments, forms and families; immutable.

    Parameters
    ----------
    table : VocabularyTable
        The instruments.
    file : str
        The table's name for messages.

    Raises
    ------
    MapError
        A program belongs to two instruments, or a family, form or mark is not in the table.
    """

    def __init__(self, table: VocabularyTable, file: str) -> None:
        self.seating, self.score_order = table.seating, table.score_order
        self.family_names = table.family_names
        self.ensembles, self.ranges = table.ensembles, table.ranges
        self.instruments = {instrument.id: instrument for instrument in table.instruments}
        self._sounds, self._strokes = table.sounds, table.strokes
        self._by_program: dict[int, Instrument] = {}
        self._forms: dict[str, list[Instrument]] = {}
        for instrument in table.instruments:
            for program in instrument.programs:
                if self._by_program.setdefault(program, instrument) is not instrument:
                    raise invalid(file, f"program {program} belongs to two instruments")
        for problem in (*self._of_forms(table), *self._of_ensembles(), *self._of_families(), *self._of_sorts()):
            raise invalid(file, problem)
        for instrument in table.instruments:
            for general in instrument.form_of:
                self._forms.setdefault(general, []).append(instrument)

    def _of_forms(self, table: VocabularyTable) -> Iterator[str]:
        """Yield descriptions of faults in the table's forms and sounds."""
        marks = {*table.sizes, *table.keys, *table.clefs}
        for instrument in self.instruments.values():
            own = {part for mark in instrument.marks for part in mark.split("+")}
            if not self.instruments.keys() >= {*instrument.form_of} or not marks >= own:
                yield f"'{instrument.id}' is a form that the table does not have"
        for id in self._sounds.values():
            if id not in self.instruments:
                yield f"'{id}' is a form that the table does not have"

    def _of_ensembles(self) -> Iterator[str]:
        known = self.instruments.keys() & self.ranges.keys()
        for one in self.ensembles:
            if not {*one.parts} <= known or len(one.parts) != len(one.pitches):
                yield f"an ensemble of {', '.join(one.parts)} has a part without instrument, range or pitch"

    def _of_families(self) -> Iterator[str]:
        families = {"", *(family for row in self.seating for family in row)}
        if families != {"", *self.score_order}:
            yield "the seating and the score order have different families"
        named = (family for one in self.instruments.values() for family in (one.family, *one.families))
        for family in (*self.family_names, *named):
            if family not in families:
                yield f"'{family}' has no place in the seating"

    def _of_sorts(self) -> Iterator[str]:
        for instrument in self.instruments.values():
            above = [instrument.id]
            while (more := self.instruments.get(above[-1])) is not None and more.sort_of:
                if more.sort_of in above or more.sort_of not in self.instruments:
                    yield f"'{instrument.id}' is a sort of '{more.sort_of}', which is no other instrument"
                    break
                above.append(more.sort_of)

    def by_program(self, program: int) -> Instrument | None:
        """Return the instrument with a General MIDI program, 0..127; None if there is none."""
        return self._by_program.get(program)

    def by_sound(self, sound: str) -> Instrument | None:
        """Return the instrument with an id in MusicXML's standard list of sounds, or with the longest matching
        beginning of the id; None if there is none.
        """
        id = _nearest(self._sounds, sound)
        return None if id is None else self.instruments[id]

    def stroke_by_sound(self, sound: str) -> int | None:
        """Return the drum kit key (MIDI number) for a percussion sound in MusicXML's standard list; None if it is
        unknown.
        """
        return _nearest(self._strokes, sound)

    def is_sort(self, id: str, general: str) -> bool:
        """Return whether ``general`` is a more general instrument for ``id``, directly or over several steps."""
        known = self.instruments.get(id)
        return (
            known is not None
            and bool(known.sort_of)
            and (known.sort_of == general or self.is_sort(known.sort_of, general))
        )

    def is_kind(self, named: Instrument, general: Instrument) -> bool:
        """Return whether ``named`` is a form or a variety of ``general``."""
        return general.id in named.form_of or self.is_sort(named.id, general.id)

    def relatives(self, instrument: Instrument) -> list[tuple[Instrument, ...]]:
        """Return groups of other winds that a part named for an instrument may mean, the likeliest first: its sizes and
        keys; those chosen by range whose English names end in the same word; its section; any.
        """
        general = instrument
        while general.sort_of:
            general = self.instruments[general.sort_of]
        winds = [one for one in self.instruments.values() if one.kind == "wind" and not one.any_pitch]
        usual = [one for one in winds if not one.by_name_only]
        last = words_of(instrument.names[0])[-1]
        sections = [one.families for one in self.instruments.values() if instrument.family in one.families]
        return [
            tuple(one for one in winds if self.is_kind(one, general) or one == general),
            tuple(one for one in usual if words_of(one.names[0])[-1] == last),
            tuple(one for one in usual if any(one.family in families for families in sections)),
            tuple(usual),
        ]

    def family(self, ids: tuple[str, ...]) -> str:
        """Return the family of the first of the instruments that has one; empty if none has."""
        families = (self.instruments[id].family for id in ids if id in self.instruments)
        return next((family for family in families if family), "")


def invalid(file: str, detail: str) -> MapError:
    """Return the error for an invalid table of instruments; ``detail`` says what is wrong."""
    return MapError("vocabulary.invalid", file=file, detail=detail)


def _nearest(table: Mapping[str, T], sound: str) -> T | None:
    """Look up a dotted id in a table, or the longest beginning of it that the table contains; None if there is none."""
    while sound and sound not in table:
        sound = sound.rpartition(".")[0]
    return table.get(sound)
