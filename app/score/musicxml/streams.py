"""Groups the notes of a part by instrument, numbered in playing order, with velocities and marks."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from app.score.channel_sound import DRUM_CHANNEL
from app.score.doublings import requested_instrument
from app.score.limits import MOST_NAME
from app.score.marks import Mark
from app.score.musicxml.flutter import fluttered
from app.score.musicxml.loudness import hairpins, loudness_of, velocity_of
from app.score.musicxml.parts import PartInstrument, WrittenPart, said_instrument
from app.score.musicxml.played import PlayedPart
from app.score.musicxml.played_chords import Desk, PlayedChord, PlayedNote
from app.score.mutes import OPEN_SIGN, STOPPED_SIGN, How, mutes_in, named_mute, said_of_mute, takes_mutes
from app.score.solos import words_of_players
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary

_STRUCK: Final = "*"
"""Kind of notes without a pitch."""
_SHORT: Final = {"staccatissimo": 0.34, "staccato": 0.5, "marcato": 0.75}
"""Share of their length that notes with these marks sound."""


@dataclass(slots=True)
class _Row:
    """One sounding note of a part: start and end tick, pitch, velocity, instrument (``kind``), the written note and its
    player.
    """

    onset: int
    end: int
    pitch: int
    velocity: int
    kind: str
    note: PlayedNote
    desk: Desk
    number: int = 0


def part_streams(
    part: WrittenPart, played: PlayedPart, track: int, transposition: int | None, quarter: int, end_tick: int
) -> list[TrackChannel]:
    """Return the notes of a part as one `TrackChannel` per instrument; empty if the part has no notes.

    Parameters
    ----------
    track : int
        Index of the part, from 0.
    transposition : int or None
        Semitones by which the part sounds higher than written; None if unknown.
    quarter, end_tick : int
        Ticks per quarter, and end tick of the piece.
    """
    spans = hairpins(played.directions, quarter, end_tick)
    rows = _rows(played, loudness_of(played.directions, spans, quarter).at, _kinds(part, played, transposition))
    if not rows:
        return []
    first = next(iter(part.instruments.values()), PartInstrument())
    words = [(tick, one.text) for tick, one in played.directions if one.kind == "words"]
    _mark_flutters(played, words)
    marks = _marks(played, f"{track + 1}:", spans)
    base = _base(part, first, transposition)
    order = sorted(dict.fromkeys(row.kind for row in rows), key=lambda kind: (kind == _STRUCK, kind != base))
    streams = []
    for change, kind in enumerate(order):
        own = [row for row in rows if row.kind == kind]
        struck = kind == _STRUCK
        ids = {f"{track + 1}:{row.number}" for row in own}
        mutes = mutes_in(_mutes(own, played, words, brass=_is_brass(kind, part.name)))
        streams.append(
            TrackChannel(
                track=track,
                channel=DRUM_CHANNEL if struck else _channel(track),
                name=part.name if not change or struck else _doubled(part.name, kind),
                instrument_name=first.name,
                program=None if struck else first.program,
                onset_ticks=[row.onset for row in own],
                end_ticks=[row.end for row in own],
                pitches=[row.pitch for row in own],
                velocities=[row.velocity for row in own],
                numbers=[row.number for row in own],
                curves=(),
                played_on="" if struck else kind,
                change=change,
                muted=() if struck else mutes.muted,
                stopped=() if struck else mutes.stopped,
                mute_kinds=() if struck else mutes.mute_kinds,
                desks=() if struck else tuple((row.number, *row.desk) for row in own if row.desk.first),
                solos=() if struck else words_of_players(words),
                use="rhythm" if struck else "melodic",
                certain=struck,
                marks=() if struck else tuple(mark for mark in marks if not mark.note_id or mark.note_id in ids),
                source="score",
            )
        )
    return streams


def _mark_flutters(played: PlayedPart, words: list[tuple[int, str]]) -> None:
    """Mark the notes for which words over the staff request flutter tonguing."""
    by_onset = sorted(played.notes, key=lambda note: note.onset)
    for note, flutters in zip(by_onset, fluttered(words, [note.onset for note in by_onset]), strict=True):
        if flutters:
            note.marks.append(("flutter_tongue", ""))


def _channel(track: int) -> int:
    """Choose a MIDI channel for a part by its index, never the percussion channel."""
    channel = track % 15
    return channel + (channel >= DRUM_CHANNEL)


def _doubled(name: str, instrument: str) -> str:
    """Name for the notes that a part's player plays on a second instrument."""
    spoken = vocabulary().instruments[instrument].names[0] if instrument else ""
    return (f"{spoken} ({name})" if name and spoken else spoken or name)[:MOST_NAME]


def _base(part: WrittenPart, first: PartInstrument, transposition: int | None) -> str:
    """Main instrument of a part as an id in the vocabulary; empty if name and program must decide."""
    said = said_instrument(part.name, first, transposition)
    return "" if said is None else said.id


def _kinds(part: WrittenPart, played: PlayedPart, transposition: int | None) -> dict[int, str]:
    """Find the instrument of each note, by `id_of` the note: as given at the note, or by the last words before it."""
    instruments = part.instruments
    first = next(iter(instruments), "")
    base = _base(part, instruments.get(first, PartInstrument()), transposition)
    named = vocabulary().by_name(part.name)
    mine = {base, "" if named is None else named.id}
    ids = {first: base, "": base}
    for id, other in list(instruments.items())[1:]:
        found = vocabulary().by_sound(other.sound) or vocabulary().by_name(other.name)
        wind = found is not None and found.kind == "wind" and not (found.vague or found.any_pitch)
        ids[id] = base if found is None or not wind or found.id in mine else found.id
    changes: list[tuple[int, str]] = []
    for tick, one in played.directions:
        asked = None
        if one.kind == "own_instrument":
            changes.append((tick, base))
        elif one.kind == "words":
            asked = requested_instrument(one.text)
        elif one.kind == "instrument":
            asked = vocabulary().by_sound(one.text or instruments.get(one.number, PartInstrument()).sound)
        if asked is not None and asked.kind == "wind":
            changes.append((tick, base if asked.id in mine else asked.id))
    kinds: dict[int, str] = {}
    place, current = 0, base
    for note in sorted(played.notes, key=lambda note: note.onset):
        while place < len(changes) and changes[place][0] <= note.onset:
            current = changes[place][1]
            place += 1
        # If notes name their instruments, words are ignored.
        said = len(instruments) > 1 and note.tone.instrument in instruments
        kinds[id_of(note)] = _STRUCK if note.tone.struck else ids[note.tone.instrument] if said else current
    return kinds


def id_of(note: PlayedNote) -> int:
    """Return a number that identifies a note while its part is read."""
    return id(note)


def _rows(played: PlayedPart, level: Callable[[int], float], kinds: dict[int, str]) -> list[_Row]:
    """Return all sounding notes of a part, with ornaments written out and numbers assigned."""
    rows: list[_Row] = []
    seated = ((note, chord.desk_of(note)) for chord in played.chords for note in chord.begun)
    for note, desk in seated:
        said = {kind for kind, _ in note.chord.marks}
        velocity = velocity_of(level(note.onset), said, note.tone.loudness)
        share = min((_SHORT[kind] for kind in said if kind in _SHORT), default=1.0)
        for onset, end, pitch in note.rows:
            sounding = end if len(note.rows) > 1 or "tenuto" in said else onset + max(round((end - onset) * share), 1)
            rows.append(_Row(onset, sounding, pitch, velocity, kinds[id_of(note)], note, desk))
    rows.sort(key=lambda row: (row.onset, row.pitch))
    for number, row in enumerate(rows, 1):
        row.number = number
        row.note.numbers.append(number)
    return rows


def _is_brass(kind: str, name: str) -> bool:
    """Return whether an instrument, given by id (``kind``) or else by name, is a brass instrument."""
    return takes_mutes(
        vocabulary().instruments[kind] if kind in vocabulary().instruments else vocabulary().by_name(name)
    )


def _mutes(
    rows: Sequence[_Row], played: PlayedPart, words: Sequence[tuple[int, str]], *, brass: bool
) -> list[tuple[int, int, How]]:
    """Return for each note its start tick, end tick and way of playing (such as muted or hand-stopped): by its own
    sign, else by the last words before it.
    """
    said: list[tuple[int, How]] = [(tick, how) for tick, text in words if (how := said_of_mute(text)) is not None]
    for tick, one in played.directions:
        if one.kind == "mute":
            said.append((tick, _how(one.text)))
    said += _signed(rows, words, [tick for tick, _ in said]) if brass else []
    said.sort(key=lambda row: row[0])
    found: list[tuple[int, int, How]] = []
    place, current = 0, _how("open")
    for row in rows:
        while place < len(said) and said[place][0] <= row.onset:
            current = said[place][1]
            place += 1
        chord = row.note.chord
        signs = {kind for kind, _ in chord.marks}
        own = "hand" if "stopped" in signs else "open" if "open" in signs else chord.mute
        if own == "open" and current == "hand":
            current = _how(own)
        found.append((row.onset, row.end, _how(own) if own else current))
    return found


def _signed(rows: Sequence[_Row], words: Sequence[tuple[int, str]], others: Sequence[int]) -> Iterator[tuple[int, How]]:
    """Yield the ticks at which the written signs "+" and "o" close and open the bell by hand. A "+" applies until an
    "o" or other words about mutes; if no "o" follows, only to the notes that begin with it.
    """
    signs = [(tick, text.strip()) for tick, text in words if text.strip() in (STOPPED_SIGN, OPEN_SIGN)]
    ends = sorted({tick for tick, _ in signs} | set(others))
    onsets = sorted({row.onset for row in rows})
    for place, (tick, sign) in enumerate(signs):
        yield tick, "hand" if sign == STOPPED_SIGN else "open"
        if sign == STOPPED_SIGN and OPEN_SIGN not in (text for _, text in signs[place + 1 : place + 2]):
            after = bisect_left(onsets, tick) + 1
            end = bisect_left(ends, tick + 1)
            if after < len(onsets) and not (end < len(ends) and ends[end] <= onsets[after]):
                yield onsets[after], "open"


def _how(text: str) -> How:
    return "hand" if text == "hand" else "open" if text == "open" else named_mute(text)


def _marks(played: PlayedPart, prefix: str, spans: Sequence[Mark]) -> list[Mark]:
    """Collect the marks of a part: those at its notes, for each player of a chord, and those over its staff."""
    found: list[Mark] = []

    def first(note: PlayedNote) -> str:
        return f"{prefix}{note.numbers[0]}"

    def last(note: PlayedNote) -> str:
        return f"{prefix}{note.numbers[-1]}"

    for chord in played.chords:
        for note in chord.notes:
            if chord.chord.grace and note in chord.begun:
                found.append(Mark("grace", first(note)))
            for kind, text in chord.chord.marks:
                at_end = kind in ("breath", "caesura", "fermata", "fall", "doit", "glissando")
                found.append(Mark(kind, last(note) if at_end else first(note), text=text))
    for note in played.notes:
        for kind, text in [*note.marks, *note.tone.marks]:
            end = last(note) if len(note.numbers) > 1 else ""
            found.append(Mark(kind, first(note), end, text=text))
    for begin, stop in played.slurs:
        for one, other in _paired(begin, stop):
            if one is not other:
                found.append(Mark("slur", first(one), last(other)))
    dynamics = [Mark("dynamic", tick=tick, text=one.text) for tick, one in played.directions if one.kind == "dynamic"]
    # The last of several marks in one place applies.
    return list({mark.id: mark for mark in (*found, *dynamics, *spans)}.values())


def _paired(start: PlayedChord, end: PlayedChord) -> list[tuple[PlayedNote, PlayedNote]]:
    """Pair the notes of two chords connected by a slur from the highest down; surplus notes of one chord are paired
    with the lowest of the other.
    """
    upper, lower = (sorted(one.notes, key=lambda note: -note.tone.pitch) for one in (start, end))
    if not upper or not lower:
        return []
    count = max(len(upper), len(lower))
    return [(upper[min(one, len(upper) - 1)], lower[min(one, len(lower) - 1)]) for one in range(count)]
