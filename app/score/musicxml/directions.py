"""Directions over the staves, sounds without a note, and barlines: tempo, dynamics, words, mutes, repeats and jumps."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import Final
from xml.etree.ElementTree import Element

from app.score.limits import MOST_NAME
from app.score.musicxml.tempos import FASTEST, SLOWEST
from app.score.musicxml.written import Bar, Direction, Place, Time

_UNITS: Final = {
    "long": Fraction(16),
    "breve": Fraction(8),
    "whole": Fraction(4),
    "half": Fraction(2),
    "quarter": Fraction(1),
    "eighth": Fraction(1, 2),
    "16th": Fraction(1, 4),
    "32nd": Fraction(1, 8),
    "64th": Fraction(1, 16),
}
_MOST_TIMES: Final = 64
"""Greatest number of repetitions of one section."""
_MUTES: Final = {"off": "open", "stop-hand": "hand"}
_JUMPS: Final = (
    # "Tacet on D.S." describes the repetition and is not a jump.
    ("da_capo", re.compile(r"(?<!\bon )(?:\bd\.?\s*c\b|\bda\s+capo\b)", re.IGNORECASE)),
    ("dal_segno", re.compile(r"(?<!\bon )(?:\bd\.?\s*s\b|\bdal\s+segno\b)", re.IGNORECASE)),
    ("to_coda", re.compile(r"^\W*to\s+coda\b", re.IGNORECASE)),
    ("fine", re.compile(r"^\W*fine\W*$", re.IGNORECASE)),
    ("trio", re.compile(r"^\W*(?:trio|alternativo)\b", re.IGNORECASE)),
)
_MOST_NUMBERS: Final = 64
_DYNAMIC: Final = re.compile(r"(?:p{1,6}|f{1,6}|m[pf]|s?f{1,2}p{0,2}|s?f{1,3}z{1,2}p?|r(?:f|fz)|pf|fp{1,2}|n)")


def read_direction(one: Element, cursor: Time, division: Time, bar: Bar, place: Place) -> Iterator[Direction]:
    """Yield the directions of a MusicXML ``<direction>`` element, such as dynamics and tempo, and of its ``<sound>``,
    at their positions."""
    sound = one.find("sound")
    offset = one.find("offset")
    moved: Time = cursor
    if offset is not None:
        exact = cursor + place.number_of(offset.text or "", "offset") * division
        moved = exact if exact > 0 else 0
    at = moved if offset is not None and offset.get("sound") == "yes" else cursor
    for kind in one.iterfind("direction-type"):
        for item in kind:
            # The end of a hairpin may be moved between notes; everything else applies at its note.
            yield from _typed(item, moved if item.tag == "wedge" else at, bar, place)
    if sound is not None:
        yield from read_sound(sound, at, bar, place)


def read_dynamics(item: Element, at: Time) -> Iterator[Direction]:
    """Yield the dynamics (such as "mf") in a MusicXML ``<dynamics>`` element."""
    for mark in item:
        text = mark.tag if mark.tag != "other-dynamics" else "".join((mark.text or "").split())
        if _DYNAMIC.fullmatch(text):
            yield Direction(at, "dynamic", text)


def _typed(item: Element, at: Time, bar: Bar, place: Place) -> Iterator[Direction]:
    """Yield the directions of one child of MusicXML's ``<direction-type>``, such as dynamics, a wedge or words."""
    tag = item.tag
    number = item.get("number", "1")
    if tag == "dynamics":
        yield from read_dynamics(item, at)
    elif tag == "wedge":
        if item.get("type") in ("crescendo", "diminuendo", "stop"):
            yield Direction(at, "wedge", item.get("type", ""), number)
    elif tag == "words":
        text = " ".join((item.text or "").split())[:MOST_NAME]
        if text:
            yield Direction(at, "words", text)
            bar.said.update(kind for kind, words in _JUMPS if words.search(text))
    elif tag == "rehearsal":
        text = " ".join((item.text or "").split())[:MOST_NAME]
        if text:
            yield Direction(at, "rehearsal", text)
    elif tag == "metronome":
        tempo = _metronome(item, place)
        if tempo is not None:
            yield Direction(at, "metronome", value=tempo)
    elif tag == "dashes":
        if item.get("type") in ("start", "stop"):
            yield Direction(at, "dashes", item.get("type", ""), number)
    elif tag == "string-mute":
        yield Direction(at, "mute", "open" if item.get("type") == "off" else "mute")
    elif tag in ("segno", "coda"):
        bar.said.add(tag)


def _metronome(item: Element, place: Place) -> float | None:
    """Tempo of a metronome mark in quarters per minute; None if the mark equates two note lengths or has words instead
    of a number.
    """
    unit = _UNITS.get((item.findtext("beat-unit") or "").strip())
    said = re.search(r"\d+(?:[.,]\d+)?", item.findtext("per-minute") or "")
    if unit is None or said is None or len(item.findall("beat-unit")) > 1:
        return None
    dots = min(sum(1 for _ in item.iterfind("beat-unit-dot")), 4)
    tempo = float(place.number_of(said[0].replace(",", "."), "per-minute") * unit * (2 - Fraction(1, 2**dots)))
    return tempo if SLOWEST <= tempo <= FASTEST else None


def read_sound(sound: Element, at: Time, bar: Bar, place: Place) -> Iterator[Direction]:
    """Yield the directions for playback that a MusicXML ``<sound>`` element contains: tempo, loudness, mutes and
    instrument changes. Its repeats and jumps are stored in ``bar``.
    """
    tempo, loudness = sound.get("tempo"), sound.get("dynamics")
    if tempo is not None:
        value = float(place.number_of(tempo, "tempo"))
        if SLOWEST <= value <= FASTEST:
            yield Direction(at, "tempo", value=value)
    if loudness is not None:
        yield Direction(at, "loudness", value=float(place.number_of(loudness, "dynamics")) / 100.0)
    for child in sound:
        if child.tag == "play" and (mute := (child.findtext("mute") or "").strip()):
            yield Direction(at, "mute", _MUTES.get(mute, mute[:MOST_NAME]))
        elif child.tag == "instrument-change":
            sounding = (child.findtext("instrument-sound") or "").strip().lower()
            yield Direction(at, "instrument", sounding, child.get("id", ""))
    if sound.get("dacapo") == "yes":
        bar.da_capo = True
    if sound.get("fine") is not None and sound.get("fine") != "no":
        bar.fine = True
    bar.segno = sound.get("segno") or bar.segno
    bar.coda = sound.get("coda") or bar.coda
    bar.to_coda = sound.get("tocoda") or bar.to_coda
    bar.dal_segno = sound.get("dalsegno") or bar.dal_segno
    if sound.get("forward-repeat") == "yes":
        bar.forward = True


def read_barline(one: Element, bar: Bar, place: Place) -> None:
    """Store the repeats, endings, segno and coda of a MusicXML barline in ``bar``."""
    repeat, ending = one.find("repeat"), one.find("ending")
    if repeat is not None:
        if repeat.get("direction") == "forward":
            bar.forward = True
        elif repeat.get("direction") == "backward":
            times = int(place.number_of(repeat.get("times", "2"), "times"))
            if times > _MOST_TIMES:
                raise place.bad("times", repeat.get("times"))
            bar.backward = max(bar.backward, times, 2)
            bar.after_jump = bar.after_jump or repeat.get("after-jump") == "yes"
    if ending is not None:
        if ending.get("type") == "start":
            bar.ending_start = frozenset(_numbers(ending.get("number", "") or ending.text or ""))
        elif ending.get("type") in ("stop", "discontinue"):
            bar.ending_stop = True
    for tag in ("segno", "coda"):
        if one.find(tag) is not None:
            bar.said.add(tag)
    bar.segno = one.get("segno") or bar.segno
    bar.coda = one.get("coda") or bar.coda


def _numbers(text: str) -> Iterator[int]:
    """Yield the numbers in the text of an ending, such as 1, 2, 3 for "1-3"."""
    for first, last in re.findall(r"(\d{1,3})(?:\s*-\s*(\d{1,3}))?", text)[:_MOST_NUMBERS]:
        yield from range(int(first), min(int(last or first), int(first) + _MOST_NUMBERS) + 1)
