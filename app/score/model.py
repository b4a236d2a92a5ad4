"""Score and its parts, in ticks."""

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
"""Players who share a track."""

MOST_BEND: Final = 63.5
"""Whole tones: 127 semitones, the widest whole range that MIDI can set."""

CurveKind: TypeAlias = Literal["breath", "volume", "expression", "aftertouch", "pitch_bend", "bite"]


class Note(msgspec.Struct, frozen=True, gc=False):
    """A note as it sounds.

    Attributes
    ----------
    id : str
        ``"track:number"``, both counted from 1: the track in the file, the note in the order of the track's note-ons.
        Unique in the score; splitting a track into voices does not change it.
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
    """A controller over time: a step function, each value holds until the next tick.

    Attributes
    ----------
    kind : {"breath", "volume", "expression", "aftertouch", "pitch_bend", "bite"}
        MIDI controllers 2, 7 and 11; channel and key pressure; pitch bend; how hard the teeth press, controller 16 (see
        `app.score.write`).
    ticks : tuple of int
        Strictly ascending.
    values : tuple of float
        0..1; pitch bend in whole tones, which are the range that MIDI gives an instrument, -`MOST_BEND`..`MOST_BEND`.
    """

    kind: CurveKind
    ticks: tuple[int, ...]
    values: tuple[float, ...]

    @property
    def shown_range(self) -> tuple[float, float]:
        """Range of values in which the curve is drawn and edited: for a bend the usual range, or a larger one if the
        curve exceeds it."""
        widest = max(1.0, *map(abs, self.values)) if self.kind == "pitch_bend" else 1.0
        return (-widest if self.kind == "pitch_bend" else 0.0), widest


def value_range(kind: CurveKind) -> tuple[float, float]:
    """The lowest and highest value of a controller."""
    return (-MOST_BEND, MOST_BEND) if kind == "pitch_bend" else (0.0, 1.0)


class Marker(msgspec.Struct, frozen=True):
    """Name of a place of the piece: a rehearsal letter, a section, a cue. Its text is one line, not empty."""

    tick: int
    text: str


SAME_SOUND: Final = {22: 42, 26: 46}
"""Sounds for notes outside the 47 sounds of a General MIDI drum kit that are an edge of one of them."""


class PercussionHit(msgspec.Struct, frozen=True, gc=False):
    """A note of a percussion track: no player plays it, but dancers move to it.

    Attributes
    ----------
    pitch : int
        MIDI note 0..127: the sound of a drum kit that is struck, as General MIDI numbers it.
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
        What the file calls it, else its instrument; several parts may share a name.
    track : int
        The track in the file, counted from 0.
    voice : int
        Counted from 0, the highest; 0 in a track with one voice. What its player has on a second instrument is counted
        from `MOST_VOICES`, on a third from twice as many.
    channel : int
        0..15.
    program : int or None
        General MIDI program 0..127; None if the file does not say.
    instrument : str or None
        Id in the vocabulary of instruments; None if neither name nor program says.
    map_id : str
        The instrument map that plays it.
    notes : tuple of Note
        By onset, then pitch.
    curves : tuple of ControllerCurve
        Of the whole track; voices of one track share them.
    transposed_semitones : int
        How much higher it was read than the file has it, which had written pitches (lower: negative).
    muted : tuple of (start, end)
        Spans of ticks, by start, in which it is played with a mute.
    stopped : tuple of (start, end)
        Those of them in which the hand stops the bell; no older file has any.
    mute_kinds : tuple of (tick, kind)
        Which mute is in the bell from there on, where it is named; no older file has any.
    marks : tuple of Mark
        What is written over its notes; no older file has any, nor has what was read from MIDI.
    source : {"sound", "score"}
        What it was read from: of a score, what has no mark has none; of a MIDI file, it is not known.
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
        """Track, channel, and which of its player's instruments: that of the stream it was read from."""
        return self.track, self.channel, self.voice // MOST_VOICES

    @cached_property
    def note_ids(self) -> frozenset[str]:
        """Ids of its notes."""
        return frozenset(note.id for note in self.notes)

    @cached_property
    def end_tick(self) -> int:
        """Return where its last note ends; 0 without notes."""
        return max((note.end_tick for note in self.notes), default=0)


_LEFT_OUT_OF_PARTS: Final = frozenset({"score.stray_notes", "score.key_switches"})
"""Reasons for leaving out some notes of a part that is played."""


class UnplayedPart(msgspec.Struct, frozen=True):
    """A part that no one plays, and why. Its last note ends at ``end_tick``.

    ``sounding`` are the spans of ticks, in order, in which it sounds; pauses shorter than a quarter are not counted
    apart. Empty where nothing accompanies (key switches, stray notes), or where an old project did not keep it.
    """

    name: str
    reason: Message
    note_count: int
    end_tick: int = 0
    sounding: tuple[tuple[int, int], ...] = ()

    @property
    def is_of_played_part(self) -> bool:
        """True if only these notes of the part are left out, and the others have a player."""
        return self.reason.id in _LEFT_OUT_OF_PARTS


def sounding_spans(spans: Iterable[tuple[int, int]], quarter_ticks: int) -> tuple[tuple[int, int], ...]:
    """Spans (start, end) of ticks in order, joined where less than a quarter lies between them."""
    joined: list[tuple[int, int]] = []
    for start, end in sorted(spans):
        if joined and start - joined[-1][1] < quarter_ticks:
            joined[-1] = (joined[-1][0], max(joined[-1][1], end))
        else:
            joined.append((start, end))
    return tuple(joined)


class Score(msgspec.Struct, frozen=True, dict=True):
    """A piece: everything that its players and its listeners share.

    Attributes
    ----------
    metres : tuple of Metre
        By tick, at least one, the first at tick 0.
    pickup_ticks : int
        Length of an incomplete first bar, 0 if there is none. A MIDI file has no mark for it; it is known where the
        file gives the first bar a metre of its own, or restates the metre before a bar is over.
    markers : tuple of Marker
        By tick; at one tick in the order of the file. Some may lie behind the last note.
    percussion : tuple of PercussionHit
        By tick, then pitch: every note of the percussion tracks.
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
        """Return where the last note of the parts ends; 0 without notes."""
        return max((part.end_tick for part in self.parts), default=0)

    @cached_property
    def accompaniment(self) -> tuple[tuple[int, int], ...]:
        """Spans of ticks, in order, in which something sounds that no one plays."""
        return sounding_spans((span for part in self.unplayed for span in part.sounding), self.ticks_per_quarter)

    @cached_property
    def sounding_end_tick(self) -> int:
        """Return where the last note of the piece ends, whether it has a player or not; 0 without notes. Of percussion
        hits alone it is known where they begin."""
        last_hit_end = self.percussion[-1].tick + 1 if self.percussion else 0
        return max((self.end_tick, last_hit_end, *(part.end_tick for part in self.unplayed)))

    @cached_property
    def metre_map(self) -> MetreMap:
        """Return where its bars and beats are; what beat is felt the project says
        (`app.project.model.Project.metre_map`)."""
        return MetreMap(self.ticks_per_quarter, self.metres, self.pickup_ticks > 0)

    @cached_property
    def felt_metre_map(self) -> MetreMap:
        """The metre map with the beat that is felt at the tempo of each bar."""
        felt = felt_beats(self.tempo_map, self.metre_map, self.bar_starts)
        return msgspec.structs.replace(self.metre_map, felt=felt)

    @property
    def last_bar(self) -> int:
        """The number of the bar in which the last note ends, whether it has a player or not."""
        return self.metre_map.bar_of_tick(max(self.sounding_end_tick - 1, 0))

    @property
    def bar_starts(self) -> IntArray:
        """Ticks at which the bars begin, to the bar in which the last note ends, whether it has a player or not.

        The first is the pickup (bar 0) if there is one, else bar 1.
        """
        return self.metre_map.bars(0, max(self.sounding_end_tick, 1))


def transposed(notes: tuple[Note, ...], semitones: int) -> tuple[Note, ...]:
    """The notes, transposed by semitones; those beyond MIDI's range as far as it goes."""
    if not semitones:
        return notes
    return tuple(msgspec.structs.replace(note, pitch=min(max(note.pitch + semitones, 0), 127)) for note in notes)
