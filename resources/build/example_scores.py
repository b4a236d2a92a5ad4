"""Writes the bundled examples in MusicXML: the notes of their MIDI files, with the marks that MIDI cannot say.

Onsets and lengths are in quarters from the beginning of the piece, pitches sound.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, NamedTuple
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

DIVISIONS: Final = 4
"""Divisions per quarter."""
_VALUES: Final = {
    6.0: ("whole", 1),
    4.0: ("whole", 0),
    3.0: ("half", 1),
    2.0: ("half", 0),
    1.5: ("quarter", 1),
    1.0: ("quarter", 0),
    0.5: ("eighth", 0),
    0.25: ("16th", 0),
}
_FIFTHS: Final = "FCGDAEB"
_LADDER: Final = ((16, "ppp"), (33, "pp"), (49, "p"), (64, "mp"), (80, "mf"), (96, "f"), (112, "ff"))
"""Velocities with the dynamics that the program recognises in them."""


class Note(NamedTuple):
    """A note as it is written.

    Attributes
    ----------
    velocity : int
        What the MIDI file says; dynamics come from it.
    marks : tuple of str
        Elements of ``articulations``.
    """

    onset: float
    length: float
    pitch: int
    velocity: int
    marks: tuple[str, ...] = ()

    @property
    def end(self) -> float:
        """Quarters to the end."""
        return self.onset + self.length


@dataclass(frozen=True)
class Line:
    """The part of one player.

    Attributes
    ----------
    sound : str
        Id in the standard list of sounds.
    program : int
        General MIDI, from 0.
    shift : int
        Semitones by which it sounds higher than it is written.
    slurs : tuple of (first, last)
        Places of notes.
    levels : tuple of (onset, velocity)
        Where a dynamic begins, and which.
    drums : mapping of int to str
        Names of what is struck, by key of the drum kit; empty: a part with pitches.
    """

    name: str
    sound: str
    program: int
    notes: tuple[Note, ...]
    shift: int = 0
    clef: str = "G2"
    slurs: tuple[tuple[int, int], ...] = ()
    levels: tuple[tuple[float, int], ...] = ()
    drums: Mapping[int, str] = field(default_factory=dict)


class Heading(NamedTuple):
    """Heading of the score: metre in quarters to the bar, key in fifths, tempi as (onset, quarters per minute)."""

    title: str
    composer: str
    rights: str
    metre: tuple[int, int]
    fifths: int
    tempi: tuple[tuple[float, float], ...]
    bars: int


def stepwise(
    notes: Sequence[Note], first: float = 0.0, last: float = float("inf"), longest: int = 4
) -> tuple[tuple[int, int], ...]:
    """Slurs over notes that follow one another at once by steps, from one onset to another.

    Parameters
    ----------
    longest : int
        Notes in one slur.
    """
    found: list[tuple[int, int]] = []
    start = 0
    for place, (one, following) in enumerate(pairwise(notes)):
        joined = (
            first <= one.onset < last
            and one.end == following.onset
            and 1 <= abs(following.pitch - one.pitch) <= 2
            and not {"staccato", "breath-mark"} & {*one.marks, *following.marks[:1]}
            and place + 1 - start < longest
        )
        if joined:
            continue
        if place > start:
            found.append((start, place))
        start = place + 1
    return (*found, (start, len(notes) - 1)) if len(notes) - 1 > start else tuple(found)


def dynamic(velocity: int) -> str:
    """The dynamic that is nearest to a velocity."""
    return min(_LADDER, key=lambda row: abs(row[0] - velocity))[1]


def score(heading: Heading, lines: Sequence[Line]) -> bytes:
    """Write a score."""
    root = Element("score-partwise", version="4.0")
    SubElement(SubElement(root, "work"), "work-title").text = heading.title
    about = SubElement(root, "identification")
    _text(about, "creator", heading.composer, type="composer")
    _text(about, "rights", heading.rights)
    listed = SubElement(root, "part-list")
    for number, line in enumerate(lines, 1):
        _listed(SubElement(listed, "score-part", id=f"P{number}"), line, number)
    for number, line in enumerate(lines, 1):
        _part(SubElement(root, "part", id=f"P{number}"), line, heading, is_first=number == 1, id=f"P{number}")
    ElementTree.indent(root, "")
    head = b'<?xml version="1.0" encoding="UTF-8"?>\n'
    return head + ElementTree.tostring(root, encoding="utf-8", short_empty_elements=True) + b"\n"


def _text(owner: Element, tag: str, text: str | float, **attributes: str) -> None:
    SubElement(owner, tag, attributes).text = f"{text:g}" if isinstance(text, float) else str(text)


def _listed(one: Element, line: Line, number: int) -> None:
    id = one.get("id", "")
    _text(one, "part-name", line.name)
    instruments = [(f"{id}-I{key}", name) for key, name in line.drums.items()] or [(f"{id}-I1", line.name)]
    for own, name in instruments:
        instrument = SubElement(one, "score-instrument", id=own)
        _text(instrument, "instrument-name", name)
        if line.sound:
            _text(instrument, "instrument-sound", line.sound)
    for (own, _), key in zip(instruments, [*line.drums] or [None], strict=True):
        midi = SubElement(one, "midi-instrument", id=own)
        _text(midi, "midi-channel", 10 if line.drums else number)
        _text(midi, "midi-program", line.program + 1)
        if key is not None:
            _text(midi, "midi-unpitched", key + 1)


class _Piece(NamedTuple):
    """The part of a note, or of a rest, that one sign stands for."""

    onset: float
    length: float
    notes: tuple[int, ...]
    is_first: bool
    is_last: bool


def _pieces(line: Line, bar: float, bars: int) -> list[_Piece]:
    """Notes and rests in signs that bars and values allow."""
    found: list[_Piece] = []
    now = 0.0

    def spell(start: float, end: float, notes: tuple[int, ...]) -> None:
        at = start
        while at < end:
            room = min(end, (at // bar + 1) * bar) - at
            length = next(value for value in _VALUES if value <= room)
            found.append(_Piece(at, length, notes, at == start, at + length == end))
            at += length

    groups: dict[float, list[int]] = {}
    for place, note in enumerate(line.notes):
        groups.setdefault(note.onset, []).append(place)
    for onset, following in zip(groups, [*list(groups)[1:], bars * bar], strict=True):
        spell(now, onset, ())
        now = min(max(line.notes[place].end for place in groups[onset]), following)
        spell(onset, now, tuple(groups[onset]))
    spell(now, bars * bar, ())
    return found


def _part(part: Element, line: Line, heading: Heading, *, is_first: bool, id: str) -> None:
    bar = 4.0 * heading.metre[0] / heading.metre[1]
    pieces = _pieces(line, bar, heading.bars)
    numbers: dict[int, list[str]] = {}
    for first, last in line.slurs:
        numbers.setdefault(first, []).append("start")
        numbers.setdefault(last, []).insert(0, "stop")
    levels = dict(line.levels)
    for number in range(heading.bars):
        measure = SubElement(part, "measure", number=str(number + 1))
        if not number:
            _attributes(measure, line, heading)
        own = [piece for piece in pieces if piece.onset // bar == number]
        if not any(piece.notes for piece in own):
            own = [_Piece(number * bar, bar, (), True, True)]
        for piece in own:
            if is_first:
                _tempi(measure, piece, heading)
            if piece.is_first and piece.notes and piece.onset in levels:
                direction = SubElement(measure, "direction", placement="below")
                SubElement(
                    SubElement(SubElement(direction, "direction-type"), "dynamics"), dynamic(levels[piece.onset])
                )
            for place in piece.notes or (None,):
                _sign(measure, line, heading, piece, place, numbers, id)
    SubElement(SubElement(measure, "barline", location="right"), "bar-style").text = "light-heavy"


def _tempi(measure: Element, piece: _Piece, heading: Heading) -> None:
    """Tempi at a sign or, where none begins there, behind it."""
    for onset, tempo in heading.tempi:
        if not piece.onset <= onset < piece.onset + piece.length:
            continue
        direction = SubElement(measure, "direction", placement="above")
        kind = SubElement(direction, "direction-type")
        metronome = SubElement(kind, "metronome")
        _text(metronome, "beat-unit", "half")
        _text(metronome, "per-minute", tempo / 2)
        if onset > piece.onset:
            _text(direction, "offset", round((onset - piece.onset) * DIVISIONS), sound="yes")
        SubElement(direction, "sound", tempo=f"{tempo:g}")


def _attributes(measure: Element, line: Line, heading: Heading) -> None:
    attributes = SubElement(measure, "attributes")
    _text(attributes, "divisions", DIVISIONS)
    _text(SubElement(attributes, "key"), "fifths", _fifths(line, heading))
    time = SubElement(attributes, "time")
    _text(time, "beats", heading.metre[0])
    _text(time, "beat-type", heading.metre[1])
    clef = SubElement(attributes, "clef")
    _text(clef, "sign", "percussion" if line.drums else line.clef[0])
    if not line.drums:
        _text(clef, "line", line.clef[1])
    if line.shift:
        transpose = SubElement(attributes, "transpose")
        _text(transpose, "diatonic", -1 if line.shift == -2 else 0)
        _text(transpose, "chromatic", line.shift)


def _fifths(line: Line, heading: Heading) -> int:
    return 0 if line.drums else heading.fifths - 7 * line.shift % 12 + (12 if 7 * line.shift % 12 > 6 else 0)


def _sign(
    measure: Element,
    line: Line,
    heading: Heading,
    piece: _Piece,
    place: int | None,
    slurs: Mapping[int, Sequence[str]],
    id: str,
) -> None:
    """Write one sign of a note, or of a rest."""
    one = SubElement(measure, "note")
    value, dots = _VALUES[piece.length]
    if place is None:
        whole = piece.length == 4.0 * heading.metre[0] / heading.metre[1]
        SubElement(one, "rest", {"measure": "yes"} if whole else {})
        _text(one, "duration", round(piece.length * DIVISIONS))
    else:
        note = line.notes[place]
        if place != piece.notes[0]:
            SubElement(one, "chord")
        _pitch(one, note.pitch, line, _fifths(line, heading))
        _text(one, "duration", round(piece.length * DIVISIONS))
        tied = [kind for kind, held in (("stop", not piece.is_first), ("start", not piece.is_last)) if held]
        for kind in tied:
            SubElement(one, "tie", type=kind)
        if line.drums:
            SubElement(one, "instrument", id=f"{id}-I{note.pitch}")
    _text(one, "voice", 1)
    _text(one, "type", value)
    for _ in range(dots):
        SubElement(one, "dot")
    if place is not None:
        _notations(one, line.notes[place], piece, tied, slurs.get(place, ()))


def _notations(one: Element, note: Note, piece: _Piece, tied: Iterable[str], slurs: Sequence[str]) -> None:
    notations = Element("notations")
    for kind in tied:
        SubElement(notations, "tied", type=kind)
    for kind in slurs:
        if piece.is_first if kind == "start" else piece.is_last:
            SubElement(notations, "slur", type=kind, number="1")
    marks = [mark for mark in note.marks if (piece.is_last if mark == "breath-mark" else piece.is_first)]
    if marks:
        articulations = SubElement(notations, "articulations")
        for mark in marks:
            SubElement(articulations, mark)
    if len(notations):
        one.append(notations)


def _pitch(one: Element, pitch: int, line: Line, fifths: int) -> None:
    if line.drums:
        unpitched = SubElement(one, "unpitched")
        _text(unpitched, "display-step", "CEG"[pitch % 3])
        _text(unpitched, "display-octave", 5)
        return
    written = pitch - line.shift
    # The name in the key, or the nearest to it on the circle of fifths.
    place = next(place for place in range(fifths - 2, fifths + 10) if (7 * place - written) % 12 == 0)
    alter = (place + 1) // 7
    own = SubElement(one, "pitch")
    _text(own, "step", _FIFTHS[(place + 1) % 7])
    if alter:
        _text(own, "alter", alter)
    _text(own, "octave", (written - alter) // 12 - 1)
