"""Reads a MIDI file into a score.

Formats: a track of format 0, and any track with several channels, is split by channel; tracks of format 1 sound
together; patterns of format 2 follow one another in file order, each starting at the end of the previous one with its
last tempo.

A channel belongs to a port (meta events 33 and 9): tracks of other ports do not affect it. `app.score.sound_module`
decides between melodic channels, rhythm parts and sound effects.

Note-offs: a note-on with velocity 0 is a note-off. A note-off ends the *oldest* sounding note of its pitch and channel
(first in, first out). If a pitch is struck again and the first note's end comes late, the first note ends at the new
onset, as in takes (`app.score.sounding`): applied if the channel becomes monophonic by it, or if the pitch would sound
three times at once. Two players on one channel may hold one pitch together, and an overlap of less than a quarter of a
note is legato; such notes stay. A note-off and a note-on at one tick separate two notes. A note without length lasts
one tick.

A note without a note-off lasts until the next onset on its channel, at most four quarters: a lost note-off must not add
a second player or a drone of hours, and the end of the track may be far away. "All notes off" and "all sound off" end
it earlier. Once a pitch has lost a note-off, the first note-off after each of its notes ends that note unless the pitch
is struck again before; first in, first out would shift every end by one note. Two such notes at one tick become one.

Markers and cue points of any track become markers of the piece; repetitions in several tracks are merged, and empty
texts dropped.
"""

from __future__ import annotations

import codecs
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Final

from app.encoding import shown
from app.errors import FileError, Message
from app.score.channels import settle_bends
from app.score.chunks import Container, read_container
from app.score.contents import PieceContents, score_of
from app.score.ensembles import named_by_ensemble
from app.score.instrument_choice import MapChoice
from app.score.limits import MOST_NAME, MOST_STREAMS, too_long
from app.score.model import Marker, Score
from app.score.musicxml.container import is_musicxml
from app.score.musicxml.read import read_musicxml
from app.score.parts import parts_of
from app.score.ports import split_by_port
from app.score.repair import track_messages
from app.score.sound_module import channel_sounds
from app.score.stated_timing import Assumed, ticks_per_quarter_of, timing_of_file
from app.score.streams import streams_of
from app.score.stuck_notes import cut_stuck_notes
from app.score.texts import TextDecoder
from app.score.track_instrument import named_by_title
from app.score.tracks import TrackEvents, gather, no_notes

UNENDED_QUARTERS: Final = 4
"""Length in quarters of a note without an end."""
_LONGEST_MARKER = 1000
"""Greatest number of characters of a marker; longer ones are no names of places and are cut."""


def read_midi(path: Path, *, encoding: str | None = None, maps: Sequence[MapChoice]) -> Score:
    """Read a MIDI file or a MusicXML score; players are assigned by names, programs and ranges.

    Parameters
    ----------
    encoding : str, optional
        Encoding of the file's texts; otherwise guessed (`app.score.texts`).
    maps : sequence of MapChoice
        The available instruments.

    Raises
    ------
    FileError
        The file cannot be read. A file that is readable in part opens, with warnings about the missing content.
    """
    contents = read_contents(path, encoding=encoding)
    parts, unplayed, warnings = parts_of(contents.channels, maps, score_of(contents))
    return score_of(contents, parts, unplayed, (*contents.warnings, *warnings))


def read_contents(
    path: Path,
    *,
    encoding: str | None = None,
    apart: Collection[tuple[int, int]] = (),
    assumed: Assumed | None = None,
) -> PieceContents:
    """Read the notes, tempo, metres and markers of a MIDI file or of a MusicXML score.

    Parameters
    ----------
    encoding, apart, assumed
        For MIDI files only, as in `_midi_contents`.

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
        Metres for a file without time signatures; by default guessed from its notes.
    apart : collection of (int, int)
        Track and channel of those that stay separate players even if the channels of their track belong together: the
        ones of the project that was made from the file.
    """
    container = read_container(path)
    quarter = ticks_per_quarter_of(container)
    unended = UNENDED_QUARTERS * quarter
    tracks, counts, warnings = _tracks(container, unended, str(path))
    _require_few(sum(bool(events.channels) for events in tracks), str(path))
    sounds = channel_sounds([one.said_of_sounds for one in tracks], quarter)
    for events, own in zip(tracks, sounds, strict=True):
        events.sounds = own
    alone = len(container.tracks) == 1
    if container.format == 2 and not alone:
        warnings.append(Message("midi.patterns", {"patterns": len(container.tracks)}))
    timing = timing_of_file(container, tracks, assumed)
    empty = Score("", quarter, *timing[:3])
    stuck = cut_stuck_notes(tracks, timing.tempo_map, empty.metre_map, unended)
    _require_length(empty, tracks, str(path))
    texts = _texts(tracks, encoding)
    channels = streams_of(tracks, settle_bends(tracks), texts, alone, frozenset(apart))
    _require_few(len(channels), str(path))
    title = _title(tracks[0], texts, alone)
    return PieceContents(
        title=title or shown(path.stem),
        tempo_map=timing.tempo_map,
        metres=timing.metres,
        pickup_ticks=timing.pickup_ticks,
        channels=tuple(named_by_ensemble(named_by_title(channels, title), title)),
        warnings=(*no_notes(tracks, counts, texts), *warnings, *timing.warnings, *stuck),
        markers=_markers(tracks, texts),
        encoding=texts.encoding,
    )


def _tracks(container: Container, unended: int, file: str) -> tuple[list[TrackEvents], list[int], list[Message]]:
    """Parse the tracks of a file. Returns the tracks (those with several ports split, with the additional ports last),
    the number of events of each track without notes, and messages about repairs.
    """
    warnings = list(container.warnings)
    tracks: list[TrackEvents] = []
    more: list[TrackEvents] = []
    counts = []
    begin = 0
    for index, track in enumerate(container.tracks):
        messages, problems = track_messages(track, index, file)
        events, *others = [gather(part, begin, unended) for part in split_by_port(messages)]
        for other in others:
            other.name, other.instrument_name = events.name, events.instrument_name
        begin = events.end_tick if container.format == 2 else 0
        warnings += [*problems, *(warning for one in (events, *others) for warning in _track_warnings(one, index))]
        tracks.append(events)
        more += others
        counts.append(sum(not message.is_meta for message in messages) if not events.channels else 0)
    tracks += more
    return tracks, counts, warnings


def _track_warnings(events: TrackEvents, index: int) -> list[Message]:
    counts = (
        ("midi.early_end", events.after_end),
        ("midi.hanging_notes", events.hanging),
        ("midi.zero_length_notes", events.zero_length),
        ("midi.beyond_all_music", events.beyond),
    )
    return [Message(id_, {"track": index + 1, "count": count}) for id_, count in counts if count]


def _require_few(parts: int, file: str) -> None:
    """Raise FileError if there are more parts than `MOST_STREAMS`."""
    if parts > MOST_STREAMS:
        raise FileError("midi.too_many_parts", file=file, parts=parts, most=MOST_STREAMS)


def _require_length(empty: Score, tracks: Sequence[TrackEvents], file: str) -> None:
    """Raise FileError if the piece is longer than any real music; silence after the last note does not count."""
    last = max(range(len(tracks)), key=lambda index: tracks[index].last_tick)
    long = too_long(empty, tracks[last].last_tick)
    if long is not None:
        raise FileError("midi.too_long", file=file, track=last + 1, **long)


def _texts(tracks: Sequence[TrackEvents], encoding: str | None) -> TextDecoder:
    """Return a decoder for the texts of a file, for the given encoding or a guess from all of its texts."""
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
    """Title of the piece: the first track's name, if that track has no notes or is the only one."""
    if first.channels and not alone:
        return ""
    return texts.read(first.name)[:MOST_NAME]
