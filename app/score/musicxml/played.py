"""Notes of a part in the order they are played: repeats unrolled, ties joined, slurs matched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Final

from app.score.musicxml.in_force import restored
from app.score.musicxml.played_chords import PlayedChord, PlayedNote
from app.score.musicxml.players_by_voice import seat
from app.score.musicxml.written import Chord, Direction, Measure, Time

_MOST_OPEN: Final = 32
"""Greatest number of slurs with one number, and of ties of one pitch, that are open simultaneously."""
_NONE: Final = Measure()
"""Replacement for a measure that is missing in a part."""


@dataclass(slots=True)
class PlayedPart:
    """A part in the order it is played.

    Attributes
    ----------
    slurs : list of (first, last)
        First and last chord of each slur.
    directions : list of (tick, Direction)
        Directions with the tick at which they take effect, ordered by tick.
    held : list of (onset, end, stretch)
        Start and end tick of notes and rests with fermatas, and the factor by which they are lengthened.
    """

    chords: list[PlayedChord]
    slurs: list[tuple[PlayedChord, PlayedChord]]
    directions: list[tuple[int, Direction]]
    held: list[tuple[int, int, float]]

    @property
    def notes(self) -> list[PlayedNote]:
        """All notes that begin in the part, in order of their onsets."""
        return [note for chord in self.chords for note in chord.begun]


def played_part(measures: Sequence[Measure], visits: Sequence[Sequence[Time]]) -> PlayedPart:
    """Build a part in the order it is played, with repeats written out.

    Parameters
    ----------
    visits : sequence of sequence of Time
        For each measure the start times of all its passes.
    """
    chords: list[PlayedChord] = []
    document: list[list[PlayedChord]] = []
    held: list[tuple[int, int, float]] = []
    last: dict[str, PlayedChord] = {}
    order = sorted((start, place) for place, times in enumerate(visits) for start in times)
    directions = restored(measures, order)
    for start, place in order:
        measure = measures[place] if place < len(measures) else _NONE
        if not (measure.chords or measure.directions):
            continue
        directions += [(round(start + one.start), one) for one in measure.directions]
        own = [
            PlayedChord(round(start + chord.start), round(start + chord.start + chord.length), chord)
            for chord in measure.chords
        ]
        seat(own)
        document.append(own)
        for one in sorted(own, key=attrgetter("onset")):
            chord = one.chord
            if chord.fermata != 1.0 and one.end > one.onset:
                held.append((one.onset, one.end, chord.fermata))
            if chord.tones:
                last[chord.voice] = one
                chords.append(one)
            elif any(kind in ("breath", "caesura") for kind, _ in chord.marks) and chord.voice in last:
                # Some programs write a breath after a rest; it belongs to the note before.
                before = last[chord.voice]
                before.chord = _breathing(before.chord, chord)
    # A stable sort keeps grace notes before the note they lead to.
    chords.sort(key=attrgetter("onset"))
    directions.sort(key=lambda row: row[0])
    _join_ties(chords)
    return PlayedPart(chords, _slurs(document), directions, held)


def _breathing(before: Chord, rest: Chord) -> Chord:
    """Copy a chord and add to it the breath marks that are written at the rest after it; a copy, since the chord may be
    repeated without them.
    """
    more = [mark for mark in rest.marks if mark[0] in ("breath", "caesura") and mark not in before.marks]
    return replace(before, marks=[*before.marks, *more])


def _join_ties(chords: Sequence[PlayedChord]) -> None:
    """Create the notes of the chords in place; tied tones become one note."""
    open_: dict[tuple[int, bool], list[PlayedNote]] = {}
    for chord in chords:
        for tone in chord.chord.tones:
            waiting = open_.get((tone.pitch, tone.struck), [])
            note = _tied(waiting, chord) if tone.tie_stop else None
            if note is None:
                note = PlayedNote(chord.onset, chord.end, tone, chord.chord, tone)
                chord.begun.append(note)
            else:
                waiting.remove(note)
                note.end, note.last = max(note.end, chord.end), tone
            chord.notes.append(note)
            if tone.tie_start:
                open_.setdefault((tone.pitch, tone.struck), []).append(note)


def _tied(waiting: list[PlayedNote], chord: PlayedChord) -> PlayedNote | None:
    """Find the waiting note that a tie connects to a chord: it must end where the chord begins; of several, one of the
    same voice.
    """
    # Later chords begin no earlier, so notes that have ended cannot be tied any more.
    waiting[:] = [note for note in waiting if note.end >= chord.onset - 1][-_MOST_OPEN:]
    near = [note for note in waiting if note.end <= chord.onset + 1]
    return max(near, key=lambda note: note.chord.voice == chord.chord.voice, default=None)


def _slurs(measures: Sequence[Sequence[PlayedChord]]) -> list[tuple[PlayedChord, PlayedChord]]:
    """Match the starts and stops of slurs, and return the first and last chord of each.

    A slur number identifies one slur at a time, in the order of the file. The file lists each measure voice by voice,
    so a slur's stop may come before its start. A slur that starts with the number of one still open is nested in it.
    """
    found: list[tuple[PlayedChord, PlayedChord]] = []
    open_: dict[str, list[PlayedChord]] = {}
    for measure in measures:
        early: dict[str, list[PlayedChord]] = {}
        for chord in measure:
            written = chord.chord.slurs[:_MOST_OPEN]
            numbers = {kind: [number for one, number in written if one == kind] for kind in ("start", "stop")}
            for number in numbers["stop"]:
                first = _nearest(open_.get(number, ()), chord, after=False)
                if first is not None:
                    open_[number].remove(first)
                    found.append((first, chord))
                elif number in numbers["start"]:
                    # A slur from a note to itself has no end.
                    numbers["start"].remove(number)
                else:
                    early.setdefault(number, []).append(chord)
                    del early[number][:-_MOST_OPEN]
            for number in numbers["start"]:
                last = _nearest(early.get(number, ()), chord, after=True)
                if last is not None:
                    early[number].remove(last)
                    found.append((chord, last))
                    continue
                waiting = open_.setdefault(number, [])
                waiting.append(chord)
                del waiting[:-_MOST_OPEN]
    return sorted(found, key=lambda row: (row[0].onset, row[1].onset))


def _nearest(others: Sequence[PlayedChord], chord: PlayedChord, *, after: bool) -> PlayedChord | None:
    """Find the last of ``others`` that a slur can connect with a chord, before it or (``after``) after it; preferably
    of the same voice.
    """
    fitting = [
        one for one in others if one is not chord and (one.onset > chord.onset if after else one.onset <= chord.onset)
    ]
    same = [one for one in fitting if one.chord.voice == chord.chord.voice]
    return next(reversed(same or fitting), None)
