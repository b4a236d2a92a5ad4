"""Reads a MusicXML score into the same form as a MIDI file: notes as they are played, tempo, metres and markers.

Each part becomes a track, with one channel for each of its instruments. Pitches sound as the part's transposition says.
Repeats, endings and jumps are unrolled (`repeats_and_jumps`); grace notes, trills, turns, mordents and tremolos are
written out (`ornaments`); tempo marks, rit., accel. and fermatas form the tempo map (`tempos`); dynamics and accents
determine velocities (`loudness`). Marks at the notes are kept (`app.score.marks`). Lyrics, chord names, figured bass,
layout and cue notes are ignored.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element

from app.encoding import shown
from app.errors import FileError, Message
from app.score.contents import PieceContents
from app.score.ensembles import named_by_ensemble
from app.score.limits import MOST_NAME, MOST_STREAMS, too_long
from app.score.model import Marker, Score
from app.score.musicxml.abbreviations import slashed
from app.score.musicxml.bars import measure_lengths, metres_of
from app.score.musicxml.container import read_document
from app.score.musicxml.notes import read_measures, ticks_per_quarter
from app.score.musicxml.ornaments import place_graces, write_out
from app.score.musicxml.parts import written_parts
from app.score.musicxml.played import PlayedPart, played_part
from app.score.musicxml.repeats_and_jumps import playing_order
from app.score.musicxml.streams import part_streams
from app.score.musicxml.tempos import Held, TempoEvent, said_of_tempo, tempo_map
from app.score.musicxml.written import Bar, Measure, Place, Time
from app.score.track_instrument import named_by_title

MOST_ITEMS: Final = 1_000_000
"""Greatest number of notes, rests and directions in a score, counted as often as they are played."""
LEAST_ITEMS: Final = 20_000
MOST_ITEMS_PER_BYTE: Final = 2
"""Greatest number of played notes, rests and directions per byte of a small file: compressed music has half a note per
byte and few repeats.
"""
MOST_TIMES: Final = 16
"""Greatest mean number of times that written notes may be played."""


def read_musicxml(path: Path) -> PieceContents:
    """Read a MusicXML score.

    Raises
    ------
    FileError
        The file cannot be read, or is larger than any real score.
    """
    file = str(path)
    root, size = read_document(path)
    place = Place(file)
    parts = written_parts(root, place)
    quarter = ticks_per_quarter(root)
    bars: list[Bar] = []
    read = [read_measures(part, bars, quarter, place) for part in parts]
    measures = [own for own, _ in read]
    written = measure_lengths(bars, measures, quarter)
    order = playing_order(bars, file)
    starts = list(accumulate((bars[one].length for one in order.measures), initial=0))
    end = starts.pop()
    visits: list[list[Time]] = [[] for _ in bars]
    for one, start in zip(order.measures, starts, strict=True):
        visits[one].append(start)
    _require_few(measures, visits, size, file)
    _require_length(Score("", quarter, tempo_map((), (), 0, quarter)), round(end), file)
    played = [played_part(own, visits) for own in measures]
    metred = metres_of(order.measures, starts, bars, written, quarter)
    tempo = tempo_map(*_tempo(played), round(end), quarter)
    _require_length(Score("", quarter, tempo, metred.metres, metred.pickup_ticks), round(end), file)
    for own in played:
        place_graces(own.chords, tempo)
        write_out(own.chords, tempo, quarter)
    streams = [
        stream
        for number, (part, own, (_, shift)) in enumerate(zip(parts, played, read, strict=True))
        for stream in part_streams(part, own, number, shift, quarter, round(end))
    ]
    if len(streams) > MOST_STREAMS:
        raise FileError("musicxml.too_many_parts", file=file, parts=len(streams), most=MOST_STREAMS)
    title = _title(root)
    warnings = [Message("musicxml.lost_jump", {"measure": measure}) for measure in order.lost[:_MOST_LOST]]
    warnings += [
        Message("musicxml.slashes", {"part": shown(part.name or part.id), "measures": numbers[:_MOST_TEXT]})
        for part in parts
        if (numbers := slashed(part))
    ][:_MOST_LOST]
    if not streams:
        warnings.append(Message("musicxml.no_notes", {"parts": len(parts)}))
    return PieceContents(
        title=title or shown(path.stem),
        tempo_map=tempo,
        metres=metred.metres,
        pickup_ticks=metred.pickup_ticks,
        channels=tuple(named_by_ensemble(named_by_title(streams, title), title)),
        warnings=tuple(warnings),
        markers=_markers(played),
    )


_MOST_LOST: Final = 20
_MOST_TEXT: Final = 200
"""Greatest number of characters in a list of measures."""


def _require_few(measures: Sequence[Sequence[Measure]], visits: Sequence[Sequence[Time]], size: int, file: str) -> None:
    """Raise FileError if a score, with its repeats unrolled, has more items than any real piece."""
    written = played = 0
    for part in measures:
        for measure, times in zip(part, visits, strict=False):
            items = len(measure.directions) + sum(max(len(chord.tones), 1) for chord in measure.chords)
            written += items
            played += items * len(times)
    most = min(MOST_ITEMS, LEAST_ITEMS + min(MOST_ITEMS_PER_BYTE * size, MOST_TIMES * written))
    if played > most:
        raise FileError("musicxml.too_many_notes", file=file, most=most)


def _require_length(empty: Score, end: int, file: str) -> None:
    long = too_long(empty, end)
    if long is not None:
        raise FileError("musicxml.too_long", file=file, **long)


def _tempo(played: Sequence[PlayedPart]) -> tuple[list[TempoEvent], list[Held]]:
    """Return the tempo marks of all parts, and the fermatas."""
    events: list[TempoEvent] = []
    marks: list[TempoEvent] = []
    for part in played:
        for tick, one in part.directions:
            if one.kind == "tempo":
                events.append(TempoEvent(tick, "set", one.value))
            elif one.kind == "metronome":
                marks.append(TempoEvent(tick, "set", one.value))
            elif one.kind == "words" and (said := said_of_tempo(tick, one.text)) is not None:
                events.append(said)
    numbered = {event.tick for event in events if event.kind == "set"}
    events += (mark for mark in marks if mark.tick not in numbered)
    held = [Held(*row) for row in dict.fromkeys(row for part in played for row in part.held)]
    return sorted(dict.fromkeys(events), key=lambda event: (event.tick, event.kind != "set")), held


def _markers(played: Sequence[PlayedPart]) -> tuple[Marker, ...]:
    """Rehearsal marks of all parts in order of time; equal ones at one place become one."""
    found: Iterable[Marker] = (
        Marker(tick, one.text) for part in played for tick, one in part.directions if one.kind == "rehearsal"
    )
    return tuple(sorted(dict.fromkeys(found), key=lambda marker: marker.tick))


def _title(root: Element) -> str:
    """The title of a score; empty where it has none."""
    texts: list[str] = [
        *(root.findtext("work/work-title") or "", root.findtext("movement-title") or ""),
        *(
            credit.findtext("credit-words") or ""
            for credit in root.iterfind("credit")
            if (credit.findtext("credit-type") or "").strip() == "title"
        ),
    ]
    return next((said[:MOST_NAME] for text in texts if (said := " ".join(text.split()))), "")
