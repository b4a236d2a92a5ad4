"""Reads a MIDI file into a score.

How the three formats are taken: format 0 is split by channel, and so is any track that uses several channels; the
tracks of format 1 sound together; the patterns of format 2 follow one another in the order of the file, each beginning
where the one before ends, with the tempo it left.

A channel is one of its port (meta events 33 and 9): tracks of other ports do not set it up. Which channels have
melodies, rhythm parts and sound effects `app.score.sound_module` knows.

What a note is: a note-on with velocity 0 is a note-off. A note-off ends the *oldest* note of its pitch and channel
that still sounds (first in, first out). A pitch that is struck again ends there and begins again, as in takes
(`app.score.sounding`), where its own end comes late: where the channel is one melody then, or where the pitch would
sound three times at once. Two players on one channel may have one pitch together, and what lasts into the next note by
less than a quarter of its length is legato; such notes overlap. A note-off and a note-on at one tick are two notes in a
row. A note of no length lasts one tick.

A note that no note-off ends lasts until the next note of its channel begins, and four quarters at most: a lost note-off
must neither make a second player of a line nor a drone of hours, and the end of the track, where a synthesiser would
stop, may be far away. "All notes off" and "all sound off" end it before that. Where a pitch has lost a note-off, the
first one after a note ends it unless the pitch is struck again before; first in, first out would give every note the
end of the one after it. Two notes of such a pitch at one tick are one.

Markers and cue points are markers of the piece, whichever track holds them; one that several tracks repeat is one, and
one without a text is none.

The errors are those of `app.score.chunks`, and:

midi.unknown_encoding : file, encoding
    "{file}: there is no text encoding '{encoding}'"
midi.track_unreadable : file, track, byte, detail
    "{file}: track {track}, which begins at byte {byte}, cannot be read: {detail}"
midi.too_many_parts : file, parts, most
    "{file}: {parts} parts (channels of tracks) have notes; at most {most} can be taken in"
midi.too_long : file, track, and as `app.score.limits.too_long` says it
    "{file}: the last note of track {track} ends after {hours} hours, {quarters} quarter notes and {bars} bars ..."

The warnings are those of `app.score.chunks`, `app.score.repair`, `app.score.stuck_notes` and `app.score.parts`, and:

midi.smpte_rate : rate
    "The file counts time in frames of 1/{rate} s, which is no SMPTE rate; it was taken literally"
midi.patterns : patterns
    "The file has {patterns} independent patterns (format 2); they follow one another"
midi.early_end : track, count
    "Track {track} says that it ends before its last {count} notes, which were read all the same"
midi.hanging_notes : track, count
    "{count} notes of track {track} never end; they end where the next note of the channel begins, and after four
    quarters at the latest"
midi.beyond_all_music : track, count
    "{count} events of track {track} lie beyond the last possible tick and were left out"
midi.zero_length_notes : track, count
    "{count} notes of track {track} have no length; they last one tick"
midi.impossible_metre : track, tick, count
    "Track {track} has {count} impossible time signatures, the first at tick {tick}; they were left out"
midi.metre_assumed : numerator, denominator
    "No time signature in the file: {numerator}/{denominator} assumed from the notes" (`app.score.metre_guess`)
midi.impossible_tempo : track, tick, count
    "Track {track} has {count} impossible tempos, the first at tick {tick}; they were left out"
midi.no_notes : tracks
    "The file has no notes in its {tracks} tracks"
midi.track_without_notes : track, name, count, and midi.unnamed_track_without_notes : track, count
    "Track {track} ({name}) has no notes and {count} other events", of each of the first tracks of such a file
"""

from __future__ import annotations

import codecs
import io
import re
from collections.abc import Collection, Mapping, Sequence, Set
from fractions import Fraction
from pathlib import Path
from typing import Final

import mido
import msgspec

from app.encoding import shown
from app.errors import FileError, Message
from app.score.channels import curves_of, leading_channel, players_channels, settle_bends, sounding_channels
from app.score.choose import MapChoice, TrackChannel, is_no_name, named_by_title
from app.score.chunks import Container, TrackChunk, read_container
from app.score.contents import PieceContents, score_of
from app.score.doublings import doubled_instruments
from app.score.ensembles import named_by_ensemble
from app.score.limits import MOST_NAME, MOST_STREAMS, too_long
from app.score.metre_guess import Line, guessed_metres
from app.score.metre_map import Metre
from app.score.model import Marker, Score
from app.score.musicxml.container import is_musicxml
from app.score.musicxml.read import read_musicxml
from app.score.mutes import mutes_of
from app.score.parts import parts_of
from app.score.ports import split_by_port
from app.score.repair import Repaired, last_suspicious, repaired
from app.score.solos import words_of_players
from app.score.sound_module import FIRST_PORT, Port, Use, channel_sounds
from app.score.spread import spread_lines
from app.score.stuck_notes import cut_stuck_notes
from app.score.take_tracks import RECORDED
from app.score.tempo import TempoChange, TempoMap
from app.score.texts import TextDecoder
from app.score.tracks import LEAST_TEMPO, TrackEvents, gather, no_notes
from instrument_maps.vocabulary import vocabulary

# What mido raises on bytes it does not understand, found by reading it and by fuzzing.
_MIDO_ERRORS = (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, mido.KeySignatureError)

# LilyPond names a track "staff:voice"; "\\new" is a staff without a name.
_LILYPOND_NAME = re.compile(r"^([^:]*):([^:]*)$")

_SMPTE_RATES = {24: Fraction(24), 25: Fraction(25), 29: Fraction(30000, 1001), 30: Fraction(30)}
_LARGEST_DENOMINATOR = 64
_PERCUSSION_CHANNEL = 9
UNSTATED: Final = (Metre(0, 4, 4),)
"""The metre of a file without a time signature, as the standard has it."""
UNENDED_QUARTERS: Final = 4
"""The longest a note lasts that nothing ends."""
_LONGEST_MARKER = 1000
"""Characters; whatever is longer is no name of a place, and is cut."""


class Assumed(msgspec.Struct, frozen=True):
    """Metres for a file that states none: those that a project has from an earlier version of it."""

    metres: tuple[Metre, ...]
    pickup_ticks: int
    ticks_per_quarter: int

    def in_ticks_of(self, ticks_per_quarter: int) -> tuple[tuple[Metre, ...], int]:
        """The metres, and the length of the pickup, in a file's own ticks."""
        scale = Fraction(ticks_per_quarter, self.ticks_per_quarter)
        metres = {round(metre.tick * scale): metre for metre in self.metres}
        placed = tuple(msgspec.structs.replace(metre, tick=tick) for tick, metre in sorted(metres.items()))
        return placed, round(self.pickup_ticks * scale)


def read_midi(path: Path, *, encoding: str | None = None, maps: Sequence[MapChoice]) -> Score:
    """Read a MIDI file or a score in MusicXML; names, programs and ranges decide who plays what.

    Parameters
    ----------
    encoding : str, optional
        Of the file's texts; otherwise guessed text by text (`app.score.texts`).
    maps : sequence of MapChoice
        The instruments that can be played.

    Raises
    ------
    FileError
        If it cannot be read; what can be read in part opens, and the score's warnings say what was left out.
    """
    contents = read_contents(path, encoding=encoding)
    parts, unplayed, warnings = parts_of(contents.streams, maps, score_of(contents))
    return score_of(contents, parts, unplayed, (*contents.warnings, *warnings))


def read_contents(
    path: Path,
    *,
    encoding: str | None = None,
    apart: Collection[tuple[int, int]] = (),
    assumed: Assumed | None = None,
) -> PieceContents:
    """Read the notes, tempo, metres and markers of a MIDI file, or of a score in MusicXML, which says all else itself.

    Parameters
    ----------
    encoding, apart, assumed
        Of a MIDI file, as `_midi_contents` has them.

    Raises
    ------
    FileError
        As `read_midi` and `app.score.musicxml.read.read_musicxml` raise it.
    """
    if encoding is not None:
        try:
            codecs.lookup(encoding)
        except LookupError as error:
            raise FileError("midi.unknown_encoding", file=str(path), encoding=encoding) from error
    if is_musicxml(path):
        return read_musicxml(path)
    return _midi_contents(path, encoding, apart, assumed)


def _midi_contents(
    path: Path, encoding: str | None, apart: Collection[tuple[int, int]], assumed: Assumed | None
) -> PieceContents:
    """Read a MIDI file.

    Parameters
    ----------
    assumed : Assumed, optional
        The metres of a file without time signatures; by default what its notes say.
    apart : collection of (int, int)
        Track and channel of those that are players of their own, whatever the channels of a track have in common: those
        of a project that was made from the file.
    """
    container = read_container(path)
    ticks_per_quarter = container.division
    if ticks_per_quarter <= 0:
        ticks_per_quarter = TempoMap.of_smpte(_ticks_per_second(ticks_per_quarter)).ticks_per_quarter
    warnings = list(container.warnings)
    tracks: list[TrackEvents] = []
    more: list[TrackEvents] = []
    counts: list[int] = []
    begin, unended = 0, UNENDED_QUARTERS * ticks_per_quarter
    for index, track in enumerate(container.tracks):
        messages, problems = _messages(track, index, str(path))
        warnings += problems
        begin = begin if container.format == 2 else 0
        events, *others = [gather(part, begin, unended) for part in split_by_port(messages)]
        for other in others:
            other.name, other.instrument_name = events.name, events.instrument_name
        begin = events.end_tick
        warnings += [warning for one in (events, *others) for warning in _track_warnings(one, index)]
        tracks.append(events)
        more += others
        counts.append(sum(not message.is_meta for message in messages) if not events.channels else 0)
    # The tracks of the file keep their numbers.
    tracks += more
    _require_few(sum(bool(events.channels) for events in tracks), str(path))
    for events, sounds in zip(
        tracks, channel_sounds([one.said_of_sounds for one in tracks], ticks_per_quarter), strict=True
    ):
        events.sounds = sounds
    alone = len(container.tracks) == 1
    if container.format == 2 and not alone:
        warnings.append(Message("midi.patterns", {"patterns": len(container.tracks)}))
    tempo_map, tempo_warnings = _tempo_map(container, tracks)
    if container.division > 0 and not any(events.metres for events in tracks):
        metres, pickup_ticks = _assumed_metres(tracks, ticks_per_quarter, assumed)
        metre_warnings = _assumed_warnings(metres)
    else:
        metres, pickup_ticks, metre_warnings = _metres(tracks, ticks_per_quarter)
    empty = Score("", ticks_per_quarter, tempo_map, metres, pickup_ticks)
    stuck = cut_stuck_notes(tracks, tempo_map, empty.metre_map, unended)
    _require_length(empty, tracks, str(path))
    texts = _texts(tracks, encoding)
    streams = _streams(tracks, settle_bends(tracks), texts, alone, frozenset(apart))
    _require_few(len(streams), str(path))
    title = _title(tracks[0], texts, alone)
    return PieceContents(
        title=title or shown(path.stem),
        tempo_map=tempo_map,
        metres=metres,
        pickup_ticks=pickup_ticks,
        streams=tuple(named_by_ensemble(named_by_title(streams, title), title)),
        warnings=(*no_notes(tracks, counts, texts), *warnings, *tempo_warnings, *metre_warnings, *stuck),
        markers=_markers(tracks, texts),
        encoding=texts.encoding,
    )


def _messages(track: TrackChunk, index: int, file: str) -> tuple[mido.MidiTrack, list[Message]]:
    """The messages of one track, repaired as far as needed."""
    until = last_suspicious(track.data)
    repair = repaired(track.data, until) if until else None
    try:
        messages = _parsed(repair.data if repair else track.data)
    except _MIDO_ERRORS:
        repair = repaired(track.data)
        try:
            messages = _parsed(repair.data)
        except _MIDO_ERRORS as error:
            raise FileError(
                "midi.track_unreadable",
                file=file,
                track=index + 1,
                byte=track.first_byte,
                detail=str(error) or type(error).__name__,
            ) from error
    return messages, _repair_warnings(repair, track, index) if repair else []


def _parsed(data: bytes) -> mido.MidiTrack:
    header = b"MThd" + bytes([0, 0, 0, 6, 0, 0, 0, 1, 1, 0xE0]) + b"MTrk" + len(data).to_bytes(4, "big")
    return mido.MidiFile(file=io.BytesIO(header + data), clip=True, charset="latin-1").tracks[0]


def _repair_warnings(repair: Repaired, track: TrackChunk, index: int) -> list[Message]:
    warnings = []
    if repair.skipped:
        byte = track.first_byte + repair.first_skipped
        warnings.append(
            Message("midi.bytes_not_understood", {"track": index + 1, "byte": byte, "count": repair.skipped})
        )
    if repair.truncated_at is not None:
        byte = track.first_byte + repair.truncated_at
        warnings.append(Message("midi.track_truncated", {"track": index + 1, "byte": byte}))
    return warnings


def _track_warnings(events: TrackEvents, index: int) -> list[Message]:
    counts = (
        ("midi.early_end", events.after_end),
        ("midi.hanging_notes", events.hanging),
        ("midi.zero_length_notes", events.zero_length),
        ("midi.beyond_all_music", events.beyond),
    )
    return [Message(id_, {"track": index + 1, "count": count}) for id_, count in counts if count]


def _require_few(parts: int, file: str) -> None:
    """Refuse more parts than any piece has; every track with notes has one at least."""
    if parts > MOST_STREAMS:
        raise FileError("midi.too_many_parts", file=file, parts=parts, most=MOST_STREAMS)


def _require_length(empty: Score, tracks: Sequence[TrackEvents], file: str) -> None:
    """Refuse a piece that is longer than any music; silence behind the last note is none of it."""
    last = max(range(len(tracks)), key=lambda index: tracks[index].last_tick)
    long = too_long(empty, tracks[last].last_tick)
    if long is not None:
        raise FileError("midi.too_long", file=file, track=last + 1, **long)


def _tempo_map(container: Container, tracks: Sequence[TrackEvents]) -> tuple[TempoMap, list[Message]]:
    division = container.division
    if division < 0:
        rate = _smpte_rate(division)
        warnings = [] if rate in _SMPTE_RATES else [Message("midi.smpte_rate", {"rate": rate})]
        return TempoMap.of_smpte(_ticks_per_second(division)), warnings
    changes: list[TempoChange] = []
    warnings = []
    for index, events in enumerate(tracks):
        possible = [TempoChange(tick, float(tempo)) for tick, tempo in events.tempos if tempo >= LEAST_TEMPO]
        impossible = [tick for tick, tempo in events.tempos if tempo < LEAST_TEMPO]
        changes += possible
        warnings += _left_out("midi.impossible_tempo", index, impossible)
    return TempoMap.of_changes(division, changes), warnings


def _left_out(id_: str, index: int, ticks: Sequence[int]) -> list[Message]:
    return [Message(id_, {"track": index + 1, "tick": ticks[0], "count": len(ticks)})] if ticks else []


def _smpte_rate(division: int) -> int:
    """Frames per second as the file says it, 29 for 29.97."""
    return 256 - (division >> 8 & 0xFF)


def _ticks_per_second(division: int) -> float:
    """Of a file that counts in SMPTE frames."""
    rate = _smpte_rate(division)
    return float(_SMPTE_RATES.get(rate, Fraction(rate)) * max(division & 0xFF, 1))


def _metres(tracks: Sequence[TrackEvents], ticks_per_quarter: int) -> tuple[tuple[Metre, ...], int, list[Message]]:
    """The metres, the length of the pickup and what had to be left out.

    A metre restated at a bar line says nothing and falls away; restated within a bar it begins a new one.
    """
    latest = {0: Metre(0, 4, 4)}
    warnings: list[Message] = []
    for index, events in enumerate(tracks):
        impossible = []
        for tick, numerator, denominator in events.metres:
            if numerator > 0 and 0 < denominator <= _LARGEST_DENOMINATOR:
                latest[tick] = Metre(tick, numerator, denominator)
            else:
                impossible.append(tick)
        warnings += _left_out("midi.impossible_metre", index, impossible)
    kept: list[Metre] = []
    for tick in sorted(latest):
        metre = latest[tick]
        if kept:
            last = kept[-1]
            same = (last.numerator, last.denominator) == (metre.numerator, metre.denominator)
            bars = Fraction((tick - last.tick) * last.denominator, 4 * ticks_per_quarter * last.numerator)
            if same and bars.denominator == 1:
                continue
        kept.append(metre)
    pickup_ticks = 0
    if len(kept) > 1:
        first_length = kept[1].tick
        full = Fraction(4 * ticks_per_quarter * kept[1].numerator, kept[1].denominator)
        one_bar = Fraction(4 * ticks_per_quarter * kept[0].numerator, kept[0].denominator)
        if first_length < full and first_length <= one_bar:
            pickup_ticks = first_length
    return tuple(kept), pickup_ticks, warnings


def _assumed_metres(
    tracks: Sequence[TrackEvents], ticks_per_quarter: int, assumed: Assumed | None
) -> tuple[tuple[Metre, ...], int]:
    """The metres of a file that states none, and the length of the pickup."""
    if assumed is not None:
        return assumed.in_ticks_of(ticks_per_quarter)
    melodic = (
        notes for events in tracks for channel, notes in events.channels.items() if channel != _PERCUSSION_CHANNEL
    )
    lines = [Line(notes.onset_ticks, notes.end_ticks, notes.pitches) for notes in melodic]
    return guessed_metres(lines, ticks_per_quarter) or (UNSTATED, 0)


def _assumed_warnings(metres: Sequence[Metre]) -> list[Message]:
    if metres == UNSTATED:
        return []
    return [Message("midi.metre_assumed", {"numerator": metres[-1].numerator, "denominator": metres[-1].denominator})]


def _texts(tracks: Sequence[TrackEvents], encoding: str | None) -> TextDecoder:
    """The reader of the texts of a file."""
    names = (name for events in tracks for name in (events.name, events.instrument_name))
    others = (text for events in tracks for _, text in (*events.markers, *events.texts))
    return TextDecoder(names, others, encoding)


def _markers(tracks: Sequence[TrackEvents], texts: TextDecoder) -> tuple[Marker, ...]:
    found = (
        Marker(tick, " ".join(texts.read(text).split())[:_LONGEST_MARKER].rstrip())
        for events in tracks
        for tick, text in events.markers
    )
    named = dict.fromkeys(marker for marker in found if marker.text)
    return tuple(sorted(named, key=lambda marker: marker.tick))


def _title(first: TrackEvents, texts: TextDecoder, alone: bool) -> str:
    """The name of the first track, if it is the piece's and not a player's."""
    if first.channels and not alone:
        return ""
    return texts.read(first.name)[:MOST_NAME]


def _streams(
    tracks: Sequence[TrackEvents],
    zones: Sequence[Mapping[int, frozenset[int]]],
    texts: TextDecoder,
    alone: bool,
    apart: Set[tuple[int, int]],
) -> list[TrackChannel]:
    """The notes of every track by channel, or by what belongs together; ``alone``: of a file with one track."""
    lilypond = any(b"LilyPond" in text for _, text in tracks[0].texts)
    given: dict[tuple[Port, int], set[int]] = {}
    for events in tracks:
        for channel in events.channels.keys() & events.programs.keys():
            key = (events.port or FIRST_PORT, channel)
            given.setdefault(key, set()).update(program for _, program in events.programs[channel])
    streams = []
    lines = spread_lines(tracks, zones, [texts.read(events.name) for events in tracks])
    for index, events in enumerate(tracks):
        name = texts.read(events.name)[:MOST_NAME]
        if lilypond and (match := _LILYPOND_NAME.match(name)):
            name = _lilypond_name(match[1].strip(), match[2].strip())
        spread = lines.get(index)
        groups = players_channels(events, "" if alone else name, zones[index], staff=not alone)
        if any(sum((index, channel) in apart for channel in own) > 1 for own in groups):
            groups = [(channel,) for own in groups for channel in own]
        if alone:
            name = name if len(groups) == 1 and len(tracks) == 1 else ""
        said = [(tick, texts.read(text)) for tick, text in (*events.texts, *events.markers)]
        recorded = any(text == RECORDED.encode() for _, text in events.texts)
        for channels in groups:
            notes = events.notes(channels)
            first = leading_channel(events, channels)
            heard, among = (events, channels) if spread is None else (spread.events, spread.channels)
            sounding = sounding_channels(first, among, zones[index])
            curves = curves_of(heard, among, zones[index])
            played_on = doubled_instruments(events, channels, name, said if len(groups) == 1 else (), notes.onset_ticks)
            muted, stopped = mutes_of(events, channels, name, said if len(groups) == 1 else ())
            solos = words_of_players(said) if len(groups) == 1 else ()
            lead = leading_channel(heard, among)
            sounds = [heard.sound_at(lead, tick) for tick in notes.onset_ticks]
            kinds = [(sound.use, instrument) for sound, instrument in zip(sounds, played_on, strict=True)]
            for change, kind in enumerate(sorted(dict.fromkeys(kinds), key=_kind_order)):
                use, instrument = kind
                own = notes.where([one == kind for one in kinds])
                mine = [sound for sound, one in zip(sounds, kinds, strict=True) if one == kind]
                struck = [sound.struck(pitch) for sound, pitch in zip(mine, own.pitches, strict=True)]
                streams.append(
                    TrackChannel(
                        track=index,
                        channel=first,
                        name=_doubled_name(name, instrument)[:MOST_NAME] if change and instrument else name,
                        instrument_name=texts.read(events.instrument_name)[:MOST_NAME],
                        program=_program(heard, sounding, own.onset_ticks[0], given),
                        use=use,
                        certain=mine[0].certain,
                        struck=struck if use == "rhythm" and struck != own.pitches else [],
                        onset_ticks=own.onset_ticks,
                        end_ticks=own.end_ticks,
                        pitches=own.pitches,
                        velocities=own.velocities,
                        numbers=own.numbers,
                        curves=curves,
                        played_on=instrument,
                        change=change,
                        solos=solos,
                        recorded=recorded,
                        muted=muted,
                        stopped=stopped,
                        line=-1 if spread is None else spread.first,
                    )
                )
    return streams


def _lilypond_name(staff: str, voice: str) -> str:
    """The name of a track that is called after a staff and a voice: the staff's, but the voice's where that alone tells
    an instrument, or anything at all."""
    staff, voice = ("" if name.startswith("\\") else name for name in (staff, voice))
    found = map(vocabulary().by_name, (staff, voice))
    tells = [one is not None and not (one.vague or one.any_pitch) for one in found]
    return voice if tells == [False, True] or (not staff and not is_no_name(voice)) else staff


def _kind_order(kind: tuple[Use, str]) -> tuple[int, bool]:
    """Melodies first, so that what a player has keeps its place; of these what the track is for."""
    use, instrument = kind
    return ("melodic", "rhythm", "effect").index(use), bool(instrument)


def _doubled_name(name: str, instrument: str) -> str:
    """The name of what a track's player plays on another instrument, which comes first and so is what it is read as."""
    spoken = vocabulary().instruments[instrument].names[0]
    return f"{spoken} ({name})" if name else spoken


def _program(
    events: TrackEvents, channels: Sequence[int], first_onset: int, given: Mapping[tuple[Port, int], Set[int]]
) -> int | None:
    """The program with which the first note of some channels sounds, the likeliest channel first.

    It is the track's own if it gives any, for the channels of large scores are shared by tracks. Else it is
    what the other tracks of its port give the channel, if those with notes there agree; ``given`` has what they give.
    """
    for channel in channels:
        own = events.programs.get(channel)
        if own:
            before = [program for tick, program in own if tick <= first_onset]
            return before[-1] if before else own[0][1]
    others = given.get((events.port or FIRST_PORT, channels[0]), frozenset[int]())
    if len(others) > 1:
        return None
    heard = events.sound_at(channels[0], first_onset).program
    return next(iter(others), None) if heard is None else heard
