"""The score and its parts; all times in ticks."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Final, Literal, TypeAlias

import msgspec

from app.arrays import IntArray
from app.errors import Message
from app.score.felt_beat import felt_beats
from app.score.marks import Mark, Source
from app.score.metre_map import Metre, MetreMap
from app.score.tempo import TempoMap

MOST_VOICES: Final = 16
"""Greatest number of players who share a track."""

MOST_BEND: Final = 63.5
"""Greatest bend in whole tones: 127 semitones, the widest integer range in MIDI."""

CurveKind: TypeAlias = Literal["breath", "volume", "expression", "aftertouch", "pitch_bend", "bite"]


class Note(msgspec.Struct, frozen=True, gc=False):
    """A note as it sounds.

    Attributes
    ----------
    id : str
        ``"track:number"``, both from 1: track in the file, and note in the order of the track's note-ons. Unique in the
        score; unchanged when a track is split into voices.
    onset_tick, duration_tick : int
        The duration is at least 1.
    pitch : int
        Concert pitch, MIDI number.
    velocity : int
        1..127.
    """

    id: str
    onset_tick: int
    duration_tick: int
    pitch: int
    velocity: int

    @property
    def end_tick(self) -> int:
        """The first tick at which the note no longer sounds."""
        return self.onset_tick + self.duration_tick


class ControllerCurve(msgspec.Struct, frozen=True):
    """A MIDI controller over time: a step function, each value holds until the next tick.

    Attributes
    ----------
    kind : {"breath", "volume", "expression", "aftertouch", "pitch_bend", "bite"}
        MIDI controllers 2, 7 and 11; channel or key pressure; pitch bend; bite force, controller 16 (see
        `app.score.write`).
    ticks : tuple of int
        Strictly ascending.
    values : tuple of float
        0..1; pitch bend in whole tones (MIDI's default range), -`MOST_BEND`..`MOST_BEND`.
    """

    kind: CurveKind
    ticks: tuple[int, ...]
    values: tuple[float, ...]

    @property
    def shown_range(self) -> tuple[float, float]:
        """Range of values in which the curve is drawn and edited; for pitch bend the usual range, or more if the curve
        exceeds it.
        """
        widest = max(1.0, *map(abs, self.values)) if self.kind == "pitch_bend" else 1.0
        return (-widest if self.kind == "pitch_bend" else 0.0), widest


def value_range(kind: CurveKind) -> tuple[float, float]:
    """Lowest and highest value of a kind of controller: pitch bend in whole tones, -63.5..63.5, others 0..1."""
    return (-MOST_BEND, MOST_BEND) if kind == "pitch_bend" else (0.0, 1.0)


class Marker(msgspec.Struct, frozen=True):
    """A named place of the piece: a rehearsal letter, a section, a cue. The text is one line and not empty."""

    tick: int
    text: str


SAME_SOUND: Final = {22: 42, 26: 46}
"""Replacement for sounds of a drum kit outside the 47 of General MIDI that are similar to one of them."""


class PercussionHit(msgspec.Struct, frozen=True, gc=False):
    """A note of a percussion track: it has no player, but dancers move to it.

    Attributes
    ----------
    pitch : int
        MIDI note 0..127: the drum kit sound by its General MIDI number.
    velocity : int
        1..127.
    """

    tick: int
    pitch: int
    velocity: int


class Part(msgspec.Struct, frozen=True, dict=True):
    """Part of one player: one voice of one track.

    Attributes
    ----------
    id : str
        ``"track.channel.voice"``, each counted from 1; unique in the score.
    name : str
        Name in the file, else the instrument's; several parts may have the same.
    track : int
        The track in the file, counted from 0.
    voice : int
        Index of the voice from 0, the highest; 0 in a track with one voice. Parts on the player's second instrument
        count from `MOST_VOICES`, on a third from twice as much.
    channel : int
        0..15.
    program : int or None
        General MIDI program 0..127; None if the file has none.
    instrument : str or None
        Id in the vocabulary of instruments; None if neither name nor program is known.
    map_id : str
        Id of the instrument map.
    notes : tuple of Note
        The notes by onset, then pitch.
    curves : tuple of ControllerCurve
        Controller curves of the whole track, shared by its voices.
    transposed_semitones : int
        Semitones by which notes were raised on reading, since the file had written pitches; negative if lowered.
    muted : tuple of (start, end)
        Spans of ticks, by start, that are played with a mute.
    stopped : tuple of (start, end)
        Those of the muted spans in which the hand stops the bell; empty in older files.
    mute_kinds : tuple of (tick, kind)
        Kind of mute from each tick on, where it is named; empty in older files.
    marks : tuple of Mark
        Marks written over the notes; empty in older files and for MIDI.
    source : {"sound", "score"}
        Origin: in a score an absent mark means that there is none; in a MIDI file it means that nothing is known.
    """

    id: str
    name: str
    track: int
    voice: int
    channel: int
    program: int | None
    instrument: str | None
    map_id: str
    notes: tuple[Note, ...]
    curves: tuple[ControllerCurve, ...] = ()
    transposed_semitones: int = 0
    muted: tuple[tuple[int, int], ...] = ()
    stopped: tuple[tuple[int, int], ...] = ()
    marks: tuple[Mark, ...] = ()
    source: Source = "sound"
    mute_kinds: tuple[tuple[int, str], ...] = ()

    @property
    def place(self) -> tuple[int, int, int]:
        """Track, channel and instrument index of the player: identifies the channel the part was read from."""
        return self.track, self.channel, self.voice // MOST_VOICES

    @cached_property
    def note_ids(self) -> frozenset[str]:
        """Ids of the part's notes."""
        return frozenset(note.id for note in self.notes)

    @cached_property
    def end_tick(self) -> int:
        """Return the tick at which the last note ends; 0 without notes."""
        return max((note.end_tick for note in self.notes), default=0)


_LEFT_OUT_OF_PARTS: Final = frozenset({"score.stray_notes", "score.key_switches"})
"""Reasons for omitting single notes of a played part."""


class UnplayedPart(msgspec.Struct, frozen=True):
    """A part without a player, with the reason (such as percussion), and the tick at which its last note ends.

    ``sounding`` are the spans of ticks, in order, in which it sounds; pauses shorter than a quarter are bridged. Empty
    for notes that are no accompaniment (key switches, stray notes), and in old projects.
    """

    name: str
    reason: Message
    note_count: int
    end_tick: int = 0
    sounding: tuple[tuple[int, int], ...] = ()

    @property
    def is_of_played_part(self) -> bool:
        """True if this stands for left-out notes of a part whose other notes have a player."""
        return self.reason.id in _LEFT_OUT_OF_PARTS


def sounding_spans(spans: Iterable[tuple[int, int]], quarter_ticks: int) -> tuple[tuple[int, int], ...]:
    """Merge spans (start, end) of ticks where less than a quarter lies between them; ordered."""
    joined: list[tuple[int, int]] = []
    for start, end in sorted(spans):
        if joined and start - joined[-1][1] < quarter_ticks:
            joined[-1] = (joined[-1][0], max(joined[-1][1], end))
        else:
            joined.append((start, end))
    return tuple(joined)


class Score(msgspec.Struct, frozen=True, dict=True):
    """A piece: everything that its players and the audio share.

    Attributes
    ----------
    metres : tuple of Metre
        The metres by tick, at least one, the first at tick 0.
    pickup_ticks : int
        Length of an incomplete first bar, 0 if there is none. MIDI has no mark for it; it is detected if the first bar
        has its own metre, or the metre is repeated before a bar is complete.
    markers : tuple of Marker
        Markers by tick, at one tick in the order of the file. Some may be after the last note.
    percussion : tuple of PercussionHit
        All notes of percussion tracks, by tick, then pitch.
    """

    title: str
    ticks_per_quarter: int
    tempo_map: TempoMap
    metres: tuple[Metre, ...] = (Metre(0, 4, 4),)
    pickup_ticks: int = 0
    parts: tuple[Part, ...] = ()
    unplayed: tuple[UnplayedPart, ...] = ()
    warnings: tuple[Message, ...] = ()
    markers: tuple[Marker, ...] = ()
    percussion: tuple[PercussionHit, ...] = ()

    @cached_property
    def end_tick(self) -> int:
        """Return the tick at which the last note of the parts ends; 0 without notes."""
        return max((part.end_tick for part in self.parts), default=0)

    @cached_property
    def accompaniment(self) -> tuple[tuple[int, int], ...]:
        """Spans of ticks, in order, in which parts without a player sound."""
        return sounding_spans((span for part in self.unplayed for span in part.sounding), self.ticks_per_quarter)

    @cached_property
    def sounding_end_tick(self) -> int:
        """Return the tick at which the last note of the piece ends, with or without a player; 0 without notes.
        Percussion hits count one tick, since their length is unknown.
        """
        last_hit_end = self.percussion[-1].tick + 1 if self.percussion else 0
        return max((self.end_tick, last_hit_end, *(part.end_tick for part in self.unplayed)))

    @cached_property
    def metre_map(self) -> MetreMap:
        """The metre map without felt beats, which the project adds (`app.project.model.Project.metre_map`)."""
        return MetreMap(self.ticks_per_quarter, self.metres, self.pickup_ticks > 0)

    @cached_property
    def felt_metre_map(self) -> MetreMap:
        """The metre map with felt beats computed from the tempo of each bar."""
        felt = felt_beats(self.tempo_map, self.metre_map, self.bar_starts)
        return msgspec.structs.replace(self.metre_map, felt=felt)

    @property
    def last_bar(self) -> int:
        """Number of the bar in which the last note ends, with or without a player."""
        return self.metre_map.bar_of_tick(max(self.sounding_end_tick - 1, 0))

    @property
    def bar_starts(self) -> IntArray:
        """Ticks at which the bars begin, up to the bar in which the last note ends, with or without a player.

        The first is the pickup (bar 0) if there is one, else bar 1.
        """
        return self.metre_map.bars(0, max(self.sounding_end_tick, 1))


def transposed(notes: tuple[Note, ...], semitones: int) -> tuple[Note, ...]:
    """Transpose notes by semitones; pitches are clipped to 0..127."""
    if not semitones:
        return notes
    return tuple(msgspec.structs.replace(note, pitch=min(max(note.pitch + semitones, 0), 127)) for note in notes)
