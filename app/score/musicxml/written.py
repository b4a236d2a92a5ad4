"""Data classes for the contents of a MusicXML score as written: chords, directions and bars, measure by measure."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias
from xml.etree.ElementTree import Element

from app.errors import FileError, shortened

Time: TypeAlias = int | Fraction
"""Time in ticks; a fraction if the file's divisions have no common multiple that a score may have."""


@dataclass(slots=True)
class Place:
    """Place in a MusicXML file (part and measure) that is named in messages about errors."""

    file: str
    part: str = ""
    measure: str = ""

    def bad(self, element: str, value: str | None) -> FileError:
        """Create the error about an invalid value of an element at this place."""
        said = shortened((value or "").strip(), 40)
        return FileError(
            "musicxml.bad_value", file=self.file, part=self.part, measure=self.measure, element=element, value=said
        )

    def number(self, owner: Element, tag: str) -> Time | None:
        """Return the number in a child of an element; None if there is no such child. Raises FileError for an invalid
        number.
        """
        text = owner.findtext(tag)
        return None if text is None else self.number_of(text, tag)

    def number_of(self, text: str, tag: str) -> Time:
        """Parse the number in the text of an element ``tag``. Raises FileError as `number` does."""
        plain = text.strip()
        try:
            if plain.isascii() and plain.isdigit() and len(plain) < _MOST_DIGITS:
                return int(plain)
            value = float(plain)
            if not math.isfinite(value) or abs(value) > _MOST_NUMBER:
                raise ValueError
        except ValueError:
            raise self.bad(tag, text) from None
        exact = Fraction(value).limit_denominator(_MOST_PARTS)
        return exact.numerator if exact.denominator == 1 else exact


_MOST_DIGITS, _MOST_NUMBER, _MOST_PARTS = 10, 1e9, 1_000_000


@dataclass(slots=True)
class Tone:
    """One note of a chord in MusicXML.

    Attributes
    ----------
    pitch : int
        Sounding pitch as MIDI number; for percussion, the key of a drum kit.
    instrument : str
        Id of the instrument in the part; empty: the part's first one.
    upper, lower : int
        Semitones to the next scale steps above and below, for ornaments.
    loudness : float or None
        Loudness that the file gives for playback; 1 is forte.
    marks : list of (kind, text)
        Marks of this note alone, such as its fingering.
    """

    pitch: int
    instrument: str = ""
    struck: bool = False
    tie_start: bool = False
    tie_stop: bool = False
    upper: int = 2
    lower: int = -2
    loudness: float | None = None
    marks: list[tuple[str, str]] = field(default_factory=list)


@dataclass(slots=True)
class Chord:
    """Notes struck together in one voice, or a rest.

    Attributes
    ----------
    start, length : Time
        Start relative to the measure, and length, in ticks.
    tones : list of Tone
        Notes of the chord; empty for a rest.
    marks : list of (kind, text)
        Marks of the whole chord, with the kinds of `app.score.marks`.
    slurs : list of (type, number)
        Slurs that start or stop here, by MusicXML's slur number.
    fermata : float
        Factor by which a fermata lengthens it; 1: no fermata.
    tremolo : (type, strokes)
        Type ``single``, ``start`` or ``stop``, and number of strokes; 0: no tremolo.
    stem : str
        Direction of the stem, ``up`` or ``down``.
    hidden : bool
        Whether the chord or rest is not printed.
    """

    start: Time
    length: Time
    voice: str
    staff: str
    grace: bool = False
    tones: list[Tone] = field(default_factory=list)
    marks: list[tuple[str, str]] = field(default_factory=list)
    slurs: list[tuple[str, str]] = field(default_factory=list)
    ornaments: list[str] = field(default_factory=list)
    fermata: float = 1.0
    tremolo: tuple[str, int] = ("", 0)
    mute: str = ""
    stem: str = ""
    hidden: bool = False


@dataclass(slots=True)
class Direction:
    """Sign or words over or under a staff.

    Attributes
    ----------
    kind : str
        ``dynamic``, ``wedge``, ``words``, ``tempo``, ``metronome``, ``rehearsal``, ``mute``, ``dashes``, ``loudness``,
        ``instrument``, ``own_instrument`` (back to the part's own).
    """

    start: Time
    kind: str
    text: str = ""
    number: str = "1"
    value: float = 0.0


@dataclass(slots=True)
class Measure:
    """One measure of one part of a MusicXML score.

    Attributes
    ----------
    length : Time
        Time at which its last content ends, in ticks.
    """

    chords: list[Chord] = field(default_factory=list)
    directions: list[Direction] = field(default_factory=list)
    length: Time = 0


@dataclass(slots=True)
class Bar:
    """Contents of a measure that all parts share.

    Attributes
    ----------
    metre : (numerator, denominator) or None
        Time signature, if it changes here; denominator 0: unmetred.
    length : Time
        Length in ticks.
    numbers : set of int
        Numbers of the ending that begins here or continues.
    to_coda, coda, segno, dal_segno : str
        Names of the coda and segno signs in this measure; empty if there are none.
    """

    number: str = ""
    implicit: bool = False
    metre: tuple[int, int] | None = None
    length: Time = 0
    forward: bool = False
    backward: int = 0
    after_jump: bool = False
    ending_start: frozenset[int] = frozenset()
    ending_stop: bool = False
    segno: str = ""
    coda: str = ""
    to_coda: str = ""
    dal_segno: str = ""
    da_capo: bool = False
    fine: bool = False
    said: set[str] = field(default_factory=set)
    """Words and signs of jumps without a sound element."""
