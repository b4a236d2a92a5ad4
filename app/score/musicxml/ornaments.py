"""Writes out grace notes, trills, turns, mordents and tremolos as they are played, at the local tempo."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Final

from app.score.musicxml.played_chords import PlayedChord, PlayedNote
from app.score.tempo import TempoMap

_GRACE_S: Final = 0.085
"""Seconds of a grace note; several share the available time."""
_TRILL_S: Final = 0.085
"""Seconds of a trill's note: six per second are slow, fourteen the fastest that players reach."""
_SHORT_S: Final = 0.075
"""Seconds of the first notes of a mordent and a turn."""
_SHARE: Final = 0.5
"""Greatest share of the previous note that grace notes take."""
_MOST_ROWS: Final = 400
"""Greatest number of notes in an ornament."""
_UNMEASURED: Final = 3
"""Number of strokes of a tremolo on one note from which a wind player uses flutter tonguing."""


def place_graces(chords: Sequence[PlayedChord], tempo: TempoMap) -> None:
    """Place grace notes before the notes they belong to, taking their time from the preceding chord; at the beginning
    of the piece, from their own main note.
    """
    voices: dict[str, list[PlayedChord]] = {}
    for chord in chords:
        voices.setdefault(chord.chord.voice, []).append(chord)
    for own in voices.values():
        before: list[PlayedChord] = []
        for (grace, onset), group in groupby(own, key=lambda one: (one.chord.grace, one.onset)):
            members = list(group)
            if grace:
                _place_group(members, onset, before, tempo)
            else:
                before = members
        _lead_in(own)


def _ticks(seconds: float, tick: int, tempo: TempoMap) -> int:
    """Return the number of ticks of a time in seconds, at the tempo of the given tick."""
    return max(round(tempo.ticks(tempo.seconds(float(tick)) + seconds) - tick), 1)


def _place_group(graces: Sequence[PlayedChord], onset: int, before: Sequence[PlayedChord], tempo: TempoMap) -> None:
    """Place consecutive grace notes before the tick ``onset``, shortening the chords ``before`` them."""
    notes = [note for chord in before for note in chord.notes]
    start = max((note.onset for note in notes), default=-1)
    room = onset if start < 0 else int((onset - start) * _SHARE)
    each = min(_ticks(_GRACE_S, max(onset - 1, 0), tempo), room // len(graces) if room > 0 else 0)
    each = each or (1 if onset >= len(graces) else 0)
    for place, chord in enumerate(graces):
        left = len(graces) - place
        chord.onset, chord.end = max(onset - left * each, 0), max(onset - (left - 1) * each, 1)
        for note in chord.begun:
            note.onset, note.end = chord.onset, max(chord.end, chord.onset + 1)
    first = graces[0].onset
    for note in notes:
        if note.onset < first < note.end:
            note.end = first


def _lead_in(own: Sequence[PlayedChord]) -> None:
    """Place the grace notes before the very first note of a part, taking their time from that note."""
    graces = [chord for chord in own if chord.chord.grace and chord.onset == 0 and chord.end <= 1]
    main = next((chord for chord in own if not chord.chord.grace), None)
    if not graces or main is None or main.onset != 0:
        return
    each = max((main.end - main.onset) // (2 * len(graces) + 2), 1)
    for place, chord in enumerate(graces):
        chord.onset, chord.end = place * each, (place + 1) * each
        for note in chord.begun:
            note.onset, note.end = chord.onset, chord.end
    for note in main.begun:
        note.onset = len(graces) * each
        note.end = max(note.end, note.onset + 1)


def write_out(chords: Sequence[PlayedChord], tempo: TempoMap, quarter: int) -> None:
    """Write out the ornaments of all chords (trills, turns, tremolos), in place in the rows of each note."""
    pairs = list(_pairs(chords))
    for first, second in pairs:
        _alternate(first, second, quarter, tempo)
    paired = {id(note) for pair in pairs for chord in pair for note in chord.begun}
    for chord in chords:
        for note in chord.begun:
            if id(note) in paired or note.rows:
                continue
            note.rows = _rows(note, tempo, quarter) or [(note.onset, max(note.end, note.onset + 1), note.tone.pitch)]


def _rows(note: PlayedNote, tempo: TempoMap, quarter: int) -> list[tuple[int, int, int]]:
    """Write out the ornament of one note as (start, end, pitch) of each sounding note; empty if it has none."""
    kinds = note.chord.ornaments
    pitch, onset, length = note.tone.pitch, note.onset, note.end - note.onset
    if length < 2 or (not kinds and not note.chord.tremolo[1]):
        return []
    upper, lower = pitch + note.tone.upper, pitch + note.tone.lower
    strokes = note.chord.tremolo[1] if note.chord.tremolo[0] == "single" else 0
    if strokes and (strokes < _UNMEASURED or note.tone.struck):
        note.marks.append(("tremolo", str(strokes)))
        return _equal(onset, note.end, max(min(quarter, length) // 2**strokes, 1), [pitch])
    if strokes:
        note.marks += [("tremolo", str(strokes)), ("flutter_tongue", "")]
        return []
    if not kinds or note.tone.struck:
        return []
    kind = kinds[0]
    short = _ticks(_SHORT_S, onset, tempo)
    if kind == "trill":
        note.marks.append(("trill", ""))
        each = _ticks(_TRILL_S, onset, tempo)
        count = max(min(round(length / each), _MOST_ROWS), 3) // 2 * 2 + 1
        return _divided(onset, note.end, [(upper if place % 2 else pitch) for place in range(min(count, length))])
    if kind.endswith("mordent"):
        note.marks.append(("mordent", "" if kind == "mordent" else "inverted"))
        return _before_main(onset, note.end, short, [pitch, lower if kind == "mordent" else upper], pitch)
    note.marks.append(("turn", "inverted" if "inverted" in kind else ""))
    turn = [lower, pitch, upper, pitch] if "inverted" in kind else [upper, pitch, lower, pitch]
    if kind.startswith("delayed"):
        at = onset + max(length // 2, length - 4 * short)
        return [(onset, at, pitch), *_divided(at, note.end, turn)] if note.end - at >= 4 else []
    return _before_main(onset, note.end, short, turn[:3], pitch)


def _before_main(onset: int, end: int, short: int, first: Sequence[int], pitch: int) -> list[tuple[int, int, int]]:
    """Write out short notes before a main note as (start, end, pitch); each lasts ``short`` ticks, together at most
    half of the time.
    """
    each = min(short, (end - onset) // (2 * len(first)))
    if each < 1:
        return []
    at = onset + each * len(first)
    return [*_divided(onset, at, first), (at, end, pitch)]


def _divided(start: int, end: int, pitches: Sequence[int]) -> list[tuple[int, int, int]]:
    """Divide the time from ``start`` to ``end`` equally among pitches; returns start, end and pitch of each note,
    leaving out those without length."""
    count = len(pitches)
    bounds = [start + (end - start) * place // count for place in range(count + 1)]
    return [
        (one, other, min(max(pitch, 0), 127))
        for one, other, pitch in zip(bounds[:-1], bounds[1:], pitches, strict=True)
        if other > one
    ]


def _equal(start: int, end: int, each: int, pitches: Sequence[int]) -> list[tuple[int, int, int]]:
    """Fill the time from ``start`` to ``end`` with notes of about ``each`` ticks that repeat the pitches in turn;
    returns start, end and pitch of each note."""
    count = min(max(-(-(end - start) // each), 1), _MOST_ROWS, end - start)
    return _divided(start, end, [pitches[place % len(pitches)] for place in range(count)])


def _pairs(chords: Sequence[PlayedChord]) -> Iterator[tuple[PlayedChord, PlayedChord]]:
    """Yield pairs of chords between which a tremolo alternates, by their start and stop marks in one voice."""
    open_: dict[str, PlayedChord] = {}
    for chord in chords:
        kind, voice = chord.chord.tremolo[0], chord.chord.voice
        if kind == "start" and not chord.chord.grace:
            open_[voice] = chord
        elif kind == "stop":
            first = open_.pop(voice, None)
            if first is not None and first.begun and chord.begun and abs(first.end - chord.onset) <= 1:
                yield first, chord


def _alternate(first: PlayedChord, second: PlayedChord, quarter: int, tempo: TempoMap) -> None:
    """Write out a tremolo between two chords: their notes in alternation over the combined length of both."""
    onset, end = first.onset, second.end
    least = _ticks(_TRILL_S / 2, onset, tempo)
    each = max(quarter // 2 ** max(first.chord.tremolo[1], 1), least, 1)
    count = min(max((end - onset) // each // 2, 1), _MOST_ROWS) * 2
    bounds = [onset + (end - onset) * place // count for place in range(count + 1)]
    for turn, chord in enumerate((first, second)):
        for note in chord.begun:
            note.rows = [
                (bounds[place], bounds[place + 1], note.tone.pitch)
                for place in range(turn, count, 2)
                if bounds[place + 1] > bounds[place]
            ] or [(note.onset, max(note.end, note.onset + 1), note.tone.pitch)]
            note.marks.append(("tremolo", str(first.chord.tremolo[1])))
