"""Converts the measures of a MusicXML part to chords at exact times, with all marks written at the notes."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final
from xml.etree.ElementTree import Element

from app.score.limits import MOST_NAME, MOST_QUARTERS
from app.score.musicxml.abbreviations import expand_repeats, is_slash
from app.score.musicxml.directions import read_barline, read_direction, read_dynamics, read_sound
from app.score.musicxml.flutter import is_flutter
from app.score.musicxml.parts import WrittenPart, is_kit, stroke_of
from app.score.musicxml.written import Bar, Chord, Measure, Place, Time, Tone

_STEPS: Final = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}
_ORDER: Final = "CDEFGAB"
_SHARPS: Final = "FCGDAEB"
_TYPES: Final = {
    "maxima": Fraction(32),
    "long": Fraction(16),
    "breve": Fraction(8),
    "whole": Fraction(4),
    "half": Fraction(2),
    "quarter": Fraction(1),
    "eighth": Fraction(1, 2),
    **{name: Fraction(4, int(name[:-2])) for name in ("16th", "64th", "128th", "256th", "512th", "1024th")},
    "32nd": Fraction(1, 8),
}
_ARTICULATIONS: Final[dict[str, tuple[str, ...]]] = {
    "accent": ("accent",),
    "soft-accent": ("accent",),
    "stress": ("accent",),
    "strong-accent": ("marcato",),
    "staccato": ("staccato",),
    "tenuto": ("tenuto",),
    "detached-legato": ("tenuto", "staccato"),
    "staccatissimo": ("staccatissimo",),
    "spiccato": ("staccatissimo",),
    "scoop": ("scoop",),
    "plop": ("plop",),
    "doit": ("doit",),
    "falloff": ("fall",),
    "breath-mark": ("breath",),
    "caesura": ("caesura",),
}
_TECHNIQUES: Final = {
    "double-tongue": "double_tongue",
    "triple-tongue": "triple_tongue",
    "stopped": "stopped",
    "half-muted": "stopped",
    "open": "open",
}
_POSITION: Final = re.compile(
    r"(?:pos(?:ition|\.)?\s*([1-7])|([1-7])(?:st|nd|rd|th|\.)?\s*pos(?:ition|\.)?)", re.IGNORECASE
)
_ORNAMENTS: Final = {
    "trill-mark": "trill",
    "shake": "trill",
    "turn": "turn",
    "vertical-turn": "turn",
    "inverted-turn": "inverted_turn",
    "delayed-turn": "delayed_turn",
    "delayed-inverted-turn": "delayed_inverted_turn",
    "mordent": "mordent",
    "inverted-mordent": "inverted_mordent",
}
_SIGNS: Final = {"flat": -1, "natural": 0, "sharp": 1, "double-sharp": 2, "sharp-sharp": 2, "flat-flat": -2}
_FERMATAS: Final = {"angled": 1.5, "double-angled": 1.25, "square": 3.0, "double-square": 4.0, "half-curve": 1.5}
"""Factor for the length of a note with a fermata, by its shape, as in MuseScore."""
_FERMATA: Final = 2.0
_MUTES: Final = {"off": "open", "stop-hand": "hand"}
_MOST_STROKES: Final = 8
_MOST_DIVISIONS: Final = 32767
"""Greatest ticks per quarter in a score."""
_ROUGH_TICKS: Final = 10_080
_PARTS_OF_TICK: Final = 720_720
"""Resolution per tick to which times between ticks are rounded; sums of arbitrary fractions would become ever
slower.
"""
_MOST_DIGITS: Final = 10
_LEAST_TICKS: Final = 480


def ticks_per_quarter(root: Element) -> int:
    """Return the smallest number of ticks per quarter for which all times of a score are whole, up to a limit."""
    common = 1
    for text in {(one.text or "").strip() for one in root.iter("divisions")}:
        # Others are refused or completed by the caller.
        if text.isascii() and text.isdigit() and len(text) < _MOST_DIGITS:
            common = math.lcm(common, int(text) or 1)
        if common > _MOST_DIVISIONS:
            return _ROUGH_TICKS
    fine = math.lcm(common, _LEAST_TICKS)
    return fine if fine <= _MOST_DIVISIONS else common * -(-_LEAST_TICKS // common)


@dataclass(slots=True)
class _State:
    """Values in force while a MusicXML part is read: ticks per unit, division, key signature and so on."""

    ticks: int
    division: Time
    fifths: int = 0
    shift: dict[str, int] = field(default_factory=dict)
    chord: Chord | None = None
    cursor: Time = 0


def read_measures(part: WrittenPart, bars: list[Bar], ticks: int, place: Place) -> tuple[list[Measure], int | None]:
    """Read the measures of a part.

    Parameters
    ----------
    bars : list of Bar
        Bars shared by all parts; information from this part is added in place.
    ticks : int
        Ticks per quarter.

    Returns
    -------
    measures : list of Measure
        Contents of each measure of the part.
    transposition : int or None
        Semitones by which the part initially sounds higher than written; None if the file gives none.
    """
    state = _State(ticks, ticks)
    # Some programs write the divisions of the first measure after its notes.
    heads = (one for _, content in part.measures[:1] for one in content.iterfind("attributes"))
    first = next((one for one in heads if one.find("divisions") is not None), None)
    if first is not None:
        place.part, place.measure = part.name or part.id, part.measures[0][0].get("number", "1")
        _divisions(first, state, place)
    measures = []
    for index, (head, content) in enumerate(part.measures):
        if index == len(bars):
            bars.append(Bar(head.get("number", str(index + 1)), head.get("implicit") == "yes"))
        place.part, place.measure = part.name or part.id, head.get("number", str(index + 1))
        measures.append(_measure(part, content, bars[index], state, place))
    expand_repeats(part, measures)
    return measures, next(iter(state.shift.values()), None)


def _measure(part: WrittenPart, content: Element, bar: Bar, state: _State, place: Place) -> Measure:
    measure = Measure()
    state.cursor = 0
    state.chord = None
    for one in content:
        tag = one.tag
        if tag == "note":
            _note(part, one, measure, state, place)
        elif tag == "backup":
            state.cursor = max(state.cursor - _duration(one, state, place), 0)
        elif tag == "forward":
            state.cursor += _duration(one, state, place)
        elif tag == "attributes":
            _attributes(one, bar, state, place)
        elif tag == "direction":
            measure.directions += read_direction(one, state.cursor, state.division, bar, place)
        elif tag == "sound":
            measure.directions += read_sound(one, state.cursor, bar, place)
        elif tag == "barline":
            read_barline(one, bar, place)
            _fermata_at_end(one, measure)
        if state.cursor > measure.length:
            measure.length = state.cursor
            if measure.length > MOST_QUARTERS * state.ticks:
                raise place.bad("duration", one.findtext("duration"))
    return measure


def _divisions(one: Element, state: _State, place: Place) -> None:
    divisions = place.number(one, "divisions")
    if divisions is not None:
        if divisions <= 0:
            raise place.bad("divisions", one.findtext("divisions"))
        exact = Fraction(state.ticks) / divisions
        state.division = exact.numerator if exact.denominator == 1 else exact


def _attributes(one: Element, bar: Bar, state: _State, place: Place) -> None:
    _divisions(one, state, place)
    fifths = place.number(one, "key/fifths")
    if fifths is not None:
        state.fifths = max(-7, min(7, int(fifths)))
    time = one.find("time")
    if time is not None and bar.metre is None:
        bar.metre = _metre(time, place)
    for shift in one.iterfind("transpose"):
        chromatic = place.number(shift, "chromatic") or 0
        octaves = place.number(shift, "octave-change") or 0
        state.shift[shift.get("number", "")] = int(chromatic) + 12 * int(octaves)


def _metre(time: Element, place: Place) -> tuple[int, int] | None:
    """Parse a time signature as (numerator, denominator): (0, 0) if it is unmetred, None if no single fraction
    expresses it.
    """
    if time.find("senza-misura") is not None:
        return 0, 0
    whole, finest = Fraction(0), 1
    for beats, kind in zip(time.iterfind("beats"), time.iterfind("beat-type"), strict=False):
        denominator = int(place.number_of(kind.text or "", "beat-type"))
        numerators = [Fraction(place.number_of(term, "beats")) for term in (beats.text or "").split("+")]
        if not 1 <= denominator <= 64 or denominator & (denominator - 1) or min(numerators) < 0:
            raise place.bad("beat-type", f"{beats.text}/{kind.text}")
        whole += sum(numerators, Fraction(0)) / denominator
        finest = max(finest, denominator)
    numerator = whole * finest
    if numerator.denominator != 1 or not 1 <= numerator <= 255:
        return None
    return int(numerator), finest


def _duration(one: Element, state: _State, place: Place) -> Time:
    """Duration of an element in ticks; if it states none, that of its note type."""
    text = one.findtext("duration")
    if text is not None:
        length = place.number_of(text, "duration")
        if length < 0:
            raise place.bad("duration", text)
        return _ticks(length * state.division)
    quarters = _TYPES.get((one.findtext("type") or "").strip(), Fraction(0))
    dots = sum(1 for _ in one.iterfind("dot"))
    quarters *= 2 - Fraction(1, 2 ** min(dots, 8))
    actual = place.number(one, "time-modification/actual-notes")
    normal = place.number(one, "time-modification/normal-notes")
    if actual and normal:
        quarters *= Fraction(normal) / actual
    return _ticks(quarters * state.ticks)


def _ticks(exact: Time) -> Time:
    """Convert an exact time to whole ticks if it is whole, else keep it as a fraction of ticks."""
    if _PARTS_OF_TICK % exact.denominator:
        exact = Fraction(round(exact * _PARTS_OF_TICK), _PARTS_OF_TICK)
    return exact.numerator if exact.denominator == 1 else exact


def _note(part: WrittenPart, one: Element, measure: Measure, state: _State, place: Place) -> None:
    """Read a MusicXML note element into a new chord of the measure, or into the previous chord if it
    belongs to that.
    """
    found: dict[str, Element] = {}
    ties, notations = set(), []
    for child in one:
        if child.tag == "tie":
            ties.add(child.get("type"))
        elif child.tag == "notations":
            notations.append(child)
        else:
            found.setdefault(child.tag, child)
    grace = "grace" in found
    if "chord" in found and state.chord is not None:
        chord = state.chord
    else:
        length = 0 if grace else _duration(one, state, place)
        chord = Chord(state.cursor, length, _said(found.get("voice"), "1"), _said(found.get("staff"), "1"), grace)
        chord.stem, chord.hidden = _said(found.get("stem"), ""), one.get("print-object") == "no"
        state.cursor += length
        if "cue" in found:
            state.chord = chord
            return
        measure.chords.append(chord)
        state.chord = chord
    if "cue" in found:
        return
    tone = None if is_slash(found.get("notehead")) else _tone(part, found, chord, state, place)
    if tone is not None:
        tone.tie_start, tone.tie_stop = "start" in ties, "stop" in ties
        loudness = one.get("dynamics")
        if loudness is not None:
            tone.loudness = min(max(float(place.number_of(loudness, "dynamics")) / 100.0, 0.0), 2.0)
        chord.tones.append(tone)
    play = found.get("play")
    if play is not None and (mute := (play.findtext("mute") or "").strip()):
        chord.mute = _MUTES.get(mute, mute[:MOST_NAME])
    if tone is not None and "pitch" in found and any(written.find("ornaments") is not None for written in notations):
        _with_neighbours(tone, found["pitch"], state.fifths, place)
    for written in notations:
        _notations(written, chord, tone, measure)


def _said(element: Element | None, usual: str) -> str:
    return usual if element is None else (element.text or usual).strip()


def _tone(part: WrittenPart, found: dict[str, Element], chord: Chord, state: _State, place: Place) -> Tone | None:
    """Return the tone of a MusicXML note with its pitch; None for a rest."""
    named = found.get("instrument")
    id = "" if named is None else named.get("id", "")
    instrument = part.instruments.get(id) or next(iter(part.instruments.values()), None)
    pitch = found.get("pitch")
    if pitch is None:
        if "unpitched" not in found:
            return None
        return Tone(stroke_of(instrument, part.name), id, struck=True)
    step = (pitch.findtext("step") or "").strip()
    octave = place.number(pitch, "octave")
    if step not in _STEPS or octave is None:
        raise place.bad("pitch", step)
    alter = place.number(pitch, "alter")
    if alter is None:
        # A note entered by hand may have only the sign.
        alter = _SIGNS.get(_said(found.get("accidental"), ""), 0)
    shift = state.shift.get(chord.staff, state.shift.get("", 0))
    natural = 12 * (int(octave) + 1) + _STEPS[step]
    written = math.floor(natural + alter + Fraction(1, 2))
    sounding = min(max(written + shift, 0), 127)
    if instrument is not None and is_kit(instrument):
        return Tone(sounding if instrument.stroke is None else instrument.stroke, id, struck=True)
    return Tone(sounding, id)


def _with_neighbours(tone: Tone, pitch: Element, fifths: int, place: Place) -> None:
    """Set the distance in semitones from an ornamented note to its upper and lower scale neighbour, by the key
    signature (``fifths``).
    """
    step, octave = (pitch.findtext("step") or "").strip(), int(place.number(pitch, "octave") or 0)
    written = 12 * (octave + 1) + _STEPS[step] + int(place.number(pitch, "alter") or 0)
    tone.upper, tone.lower = (_neighbour(step, octave, by, fifths) - written for by in (1, -1))


def _neighbour(step: str, octave: int, by: int, fifths: int) -> int:
    """Written pitch of the scale step above or below (``by``) a note in the key with ``fifths`` sharps (negative:
    flats).
    """
    place = _ORDER.index(step) + by
    name = _ORDER[place % 7]
    altered = _SHARPS.index(name)
    alter = 1 if altered < fifths else -1 if 6 - altered < -fifths else 0
    return 12 * (octave + place // 7 + 1) + _STEPS[name] + alter


def _notations(written: Element, chord: Chord, tone: Tone | None, measure: Measure) -> None:
    for one in written:
        tag = one.tag
        if tag == "slur":
            if one.get("type") in ("start", "stop"):
                chord.slurs.append((one.get("type", ""), one.get("number", "1")))
        elif tag == "tied" and tone is not None:
            # A drawn tie sounds, even without a tie element.
            tone.tie_start = tone.tie_start or one.get("type") in ("start", "continue")
            tone.tie_stop = tone.tie_stop or one.get("type") in ("stop", "continue")
        elif tag == "articulations":
            chord.marks += [(kind, "") for mark in one for kind in _ARTICULATIONS.get(mark.tag, ())]
        elif tag == "technical":
            _technical(one, chord, tone)
        elif tag == "ornaments":
            _ornaments(one, chord, tone)
        elif tag == "fermata":
            chord.fermata = _FERMATAS.get((one.text or "").strip(), _FERMATA)
            chord.marks.append(("fermata", ""))
        elif tag in ("glissando", "slide") and one.get("type") == "start":
            chord.marks.append(("glissando", ""))
        elif tag == "dynamics":
            measure.directions += read_dynamics(one, chord.start)


def _technical(written: Element, chord: Chord, tone: Tone | None) -> None:
    own = chord.marks if tone is None else tone.marks
    fingering = []
    for one in written:
        text = " ".join((one.text or "").split())[:MOST_NAME]
        if one.tag in _TECHNIQUES:
            chord.marks.append((_TECHNIQUES[one.tag], ""))
        elif one.tag == "fingering" and text and "yes" not in (one.get("alternate"), one.get("substitution")):
            fingering.append(text)
        elif one.tag == "harmon-mute":
            chord.mute = "mute"
        elif one.tag == "other-technical":
            if is_flutter(text) or is_flutter(one.get("smufl", "")):
                chord.marks.append(("flutter_tongue", ""))
            elif (found := _POSITION.fullmatch(text)) is not None:
                own.append(("position", found[1] or found[2]))
    if fingering:
        own.append(("fingering", "-".join(fingering)[:MOST_NAME]))


def _ornaments(written: Element, chord: Chord, tone: Tone | None) -> None:
    for one in written:
        tag = one.tag
        if tag in _ORNAMENTS:
            chord.ornaments.append(_ORNAMENTS[tag])
        elif tag == "tremolo":
            text = (one.text or "").strip()
            strokes = int(text) if text.isascii() and text.isdigit() and len(text) < 3 else 3
            chord.tremolo = one.get("type", "single"), min(strokes, _MOST_STROKES)
        elif tag == "wavy-line":
            if one.get("type") == "start" and "trill" not in chord.ornaments:
                chord.ornaments.append("trill")
        elif tag == "accidental-mark" and tone is not None:
            alter = _SIGNS.get((one.text or "").strip())
            if alter is not None and one.get("placement") != "below":
                # The neighbour note outside the key.
                natural = tone.upper if tone.upper in (1, 2) else 2
                tone.upper = max(1, min(3, natural + alter - (natural == 2 and alter > 0)))


def _fermata_at_end(one: Element, measure: Measure) -> None:
    """Apply a fermata over a barline to the last note of the measure."""
    fermata = one.find("fermata")
    last = next((chord for chord in reversed(measure.chords) if chord.tones and not chord.grace), None)
    if fermata is not None and last is not None and one.get("location", "right") == "right" and last.fermata == 1.0:
        last.fermata = _FERMATAS.get((fermata.text or "").strip(), _FERMATA)
        last.marks.append(("fermata", ""))
