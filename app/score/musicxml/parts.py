"""Reads the part list of a MusicXML score (names, instruments, percussion sounds) and the measures of each part."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final
from xml.etree.ElementTree import Element

from app.errors import FileError
from app.score.limits import MOST_BARS, MOST_NAME, MOST_STREAMS
from app.score.musicxml.written import Place
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

_NO_NAME = re.compile(r"(?:MusicXML Part|Part[_ ]?\d*|P\d+)", re.IGNORECASE)
"""Names that converters give to parts and instruments without a name."""
MOST_MEASURES: Final = 400_000
"""Greatest number of measures in all parts: two thousand in two hundred parts."""
_MOST_LISTED: Final = 4 * MOST_STREAMS
"""Greatest number of parts in a score, with and without notes."""
_KIT_CHANNEL = 10
_KEYS = {10: "B♭", 9: "A", 3: "E♭", 5: "F", 2: "D", 7: "G"}
"""Keys of instruments by the sounding pitch of a written C in semitones above C."""
_DEFAULT_STROKE = 38
"""Percussion sound if none is given: a snare drum."""


@dataclass(slots=True)
class PartInstrument:
    """One instrument of a MusicXML part.

    Attributes
    ----------
    sound : str
        Id in MusicXML's standard list of sounds; empty if the file gives none.
    program : int or None
        General MIDI program, from 0; None if the file gives none.
    stroke : int or None
        MIDI key of the sound in a drum kit; None if it is not part of one.
    """

    name: str = ""
    sound: str = ""
    program: int | None = None
    channel: int = 0
    stroke: int | None = None


@dataclass(slots=True)
class WrittenPart:
    """A part of a MusicXML score before it is read: its instruments and the elements of its measures.

    Attributes
    ----------
    instruments : dict of str to PartInstrument
        Instruments by id, in the order of the file.
    measures : list of (Element, Element)
        For each measure the element with its attributes, and the element with its content.
    """

    id: str
    name: str = ""
    instruments: dict[str, PartInstrument] = field(default_factory=dict)
    measures: list[tuple[Element, Element]] = field(default_factory=list)


def written_parts(root: Element, place: Place) -> list[WrittenPart]:
    """Return the parts of a score in the order of their list, followed by parts missing in it. Raises FileError if
    there are too many parts or measures.
    """
    listed = [one for parts in root.iterfind("part-list") for one in parts.iter("score-part")]
    with_measures = root.iterfind("part" if root.tag == "score-partwise" else "measure/part")
    ids = {one.get("id", "") for one in (*listed, *with_measures)}
    if len(ids) > _MOST_LISTED:
        raise FileError("musicxml.too_many_parts", file=place.file, parts=len(ids), most=MOST_STREAMS)
    found: dict[str, WrittenPart] = {}
    for one in listed:
        id = one.get("id", "")
        if id not in found:
            found[id] = _listed(one, id, place)
    count = 0
    if root.tag == "score-partwise":
        for part in root.iterfind("part"):
            own = found.setdefault(part.get("id", ""), WrittenPart(part.get("id", "")))
            own.measures += [(measure, measure) for measure in part.iterfind("measure")]
            count += len(own.measures)
            _require_few(count, place)
    else:
        for number, measure in enumerate(root.iterfind("measure")):
            for part in measure.iterfind("part"):
                own = found.setdefault(part.get("id", ""), WrittenPart(part.get("id", "")))
                # A part without content in a measure rests there.
                count += number + 1 - len(own.measures)
                _require_few(count, place)
                own.measures += [(measure, Element("part"))] * (number - len(own.measures))
                own.measures.append((measure, part))
    if any(len(part.measures) > MOST_BARS for part in found.values()):
        raise FileError("musicxml.too_many_measures", file=place.file, most=MOST_BARS)
    return list(found.values())


def _require_few(measures: int, place: Place) -> None:
    """Raise FileError if all parts together have more measures than any real score."""
    if measures > MOST_MEASURES:
        raise FileError("musicxml.too_many_measures", file=place.file, most=MOST_MEASURES)


def _listed(one: Element, id: str, place: Place) -> WrittenPart:
    name = _text(one.find("part-name-display")) or _text(one.find("part-name"))
    part = WrittenPart(id, "" if _NO_NAME.fullmatch(name) else name[:MOST_NAME])
    for written in one.iterfind("score-instrument"):
        called = _text(written.find("instrument-name"))
        part.instruments[written.get("id", "")] = PartInstrument(
            "" if _NO_NAME.fullmatch(called) else called[:MOST_NAME], _text(written.find("instrument-sound")).lower()
        )
    for midi in one.iterfind("midi-instrument"):
        own = part.instruments.setdefault(midi.get("id", ""), PartInstrument())
        own.program = _midi(midi, "midi-program", 128)
        own.channel = (_midi(midi, "midi-channel", 16) or -1) + 1
        own.stroke = _midi(midi, "midi-unpitched", 128)
    return part


def _midi(owner: Element, tag: str, most: int) -> int | None:
    """Number in a MIDI element of the file, converted to count from 0; None if it is missing or above ``most``."""
    text = (owner.findtext(tag) or "").strip()
    number = int(text) if text.isascii() and text.isdigit() and len(text) < 4 else 0
    return number - 1 if 1 <= number <= most else None


def _text(element: Element | None) -> str:
    """Return all text of an element in one line, with accidentals as signs."""
    if element is None:
        return ""
    pieces: list[str] = []
    for one in element.iter():
        said = (one.text or "").strip() if one.tag != "accidental-text" else _SIGNS.get((one.text or "").strip(), "")
        # The accidental of an instrument's key follows its letter directly.
        pieces.append(said if one.tag == "accidental-text" or not pieces or not said else f" {said}")
    return " ".join("".join(pieces).split())


_SIGNS = {"flat": "♭", "sharp": "♯"}


def stroke_of(instrument: PartInstrument | None, part_name: str) -> int:
    """MIDI key in a drum kit for unpitched percussion, by the instrument or the part's name."""
    if instrument is None:
        return vocabulary().stroke(part_name) or _DEFAULT_STROKE
    if instrument.stroke is not None:
        return instrument.stroke
    by_sound = vocabulary().stroke_by_sound(instrument.sound)
    return by_sound or vocabulary().stroke(instrument.name) or vocabulary().stroke(part_name) or _DEFAULT_STROKE


def is_kit(instrument: PartInstrument) -> bool:
    """Return whether an instrument is assigned to MIDI's percussion channel."""
    return instrument.channel == _KIT_CHANNEL


def said_instrument(part_name: str, instrument: PartInstrument, transposition: int | None) -> Instrument | None:
    """Instrument given by its id in MusicXML's list of sounds, with size and key from the part's name or else from the
    transposition. None if the id is not informative, so that name and program decide.

    Parameters
    ----------
    transposition : int or None
        Semitones by which the part sounds higher than written; None if unknown.
    """
    words = vocabulary()
    said = words.by_sound(instrument.sound)
    names = [found for text in (part_name, instrument.name) if text and (found := words.by_name(text)) is not None]
    named = next((found for found in names if not found.vague), None)
    if said is None or (said.kind == "other" and named is not None and named.kind == "wind"):
        # Many programs write a piano if the instrument is unknown.
        return None
    if named is not None and words.is_kind(named, said):
        return named
    # The whole score may be written at concert pitch; a named size already has its key.
    key = _KEYS.get((transposition or 0) % 12)
    return (words.within(f"in {key}", said) if key and said.kind == "wind" and not said.sort_of else None) or said
