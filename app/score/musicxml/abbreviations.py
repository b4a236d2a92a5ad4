"""Abbreviations in MusicXML: measures that repeat earlier ones (measure-repeat signs), and slashes for improvised
music.

A file should contain the notes that a repeat sign stands for, but some programs leave them out. Slash notes stand for
improvisation: their pitches have no meaning, and they are not played.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Final
from xml.etree.ElementTree import Element

from app.score.musicxml.parts import WrittenPart
from app.score.musicxml.written import Measure

_MOST_BACK: Final = 8
"""Greatest number of measures that one sign repeats."""
_STYLES: Final = "attributes/measure-style/"


def expand_repeats(part: WrittenPart, measures: Sequence[Measure]) -> None:
    """Fill measures that have a measure-repeat sign but no notes with the chords of the repeated measures."""
    back = 0
    for index, (_, content) in enumerate(part.measures):
        for sign in content.iterfind(f"{_STYLES}measure-repeat"):
            text = (sign.text or "").strip()
            back = min(int(text), _MOST_BACK) if text.isascii() and text.isdigit() and len(text) < 3 else 1
            back = max(back, 1) if sign.get("type") == "start" else 0
        own = measures[index]
        if back and index >= back and not any(chord.tones for chord in own.chords):
            own.chords = measures[index - back].chords
            own.length = max(own.length, measures[index - back].length)


def is_slash(notehead: Element | None) -> bool:
    """Return whether a notehead is a slash, so that its pitch has no meaning."""
    return notehead is not None and (notehead.text or "").strip() == "slash"


def slashed(part: WrittenPart) -> str:
    """Numbers of the measures with slash notes, in ranges such as "3, 5-8"; empty if there are none."""
    within = False
    found = []
    for index, (head, content) in enumerate(part.measures):
        for sign in (*content.iterfind(f"{_STYLES}slash"), *content.iterfind(f"{_STYLES}beat-repeat")):
            within = sign.get("type") == "start"
        heads = (one for note in content.iterfind("note") for one in note.iterfind("notehead"))
        if within or any(map(is_slash, heads)):
            found.append((index, head.get("number", str(index + 1))))
    ranges = []
    for _, run in groupby(enumerate(found), key=lambda row: row[1][0] - row[0]):
        numbers = [number for _, (_, number) in run]
        ranges.append(numbers[0] if len(numbers) == 1 else f"{numbers[0]}-{numbers[-1]}")
    return ", ".join(ranges)
