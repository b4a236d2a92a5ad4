"""The built-in synthesiser, which renders a player's part phrase by phrase.

A part is cut into phrases of some bars that are rendered independently, so that a piece is audible as soon as its first
phrases are ready, and after an edit only the changed phrases are rendered again. A phrase is identified by the bytes of
its MIDI file. midirenderer stops at the last event, so silence for the tail follows.

Parts are rendered independently of other players; loudness and pan are applied by the mixer.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from app.arrays import IntArray
from app.audio.rendering import rendered, soundfont
from app.audio.track import RATE_HZ, AudioSegment, Samples
from app.performance.loudness import sounding_curve
from app.score.bend_range import USUAL_SEMITONES, range_controls, range_for, wheel
from app.score.channel_sound import DRUM_CHANNEL
from app.score.model import SAME_SOUND, CurveKind, Note, Part, PercussionHit
from app.score.tempo import TempoMap
from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import InstrumentMap

TICKS_PER_QUARTER: Final = 24000
"""Ticks per quarter of phrases: at MIDI's default of 120 quarters per minute, a tick is a sample at 48 kHz."""
_WINDOW_QUARTERS: Final = 8
"""Length in quarters of the fixed windows in which a phrase's notes begin, so that an edit does not move the bounds of
other phrases.
"""
_TAIL_S: Final = 1.5
"""Length in seconds of the longest release with reverberation."""
_BLOCK: Final = 64
"""Number of samples between times at which the synthesiser processes events."""
_STROKE: Final = 480
"""Number of samples between a drum's note-on and note-off."""
_VOLUME, _EXPRESSION = 7, 11
_MOST_CACHED_BYTES: Final = 256 * 1024 * 1024


@dataclass(frozen=True)
class RenderedPhrase:
    """Consecutive notes of a part that are rendered together.

    Attributes
    ----------
    start, end : int
        Performance time in samples; the end includes the decay of the last notes.
    midi : bytes
        MIDI file that begins at the start; equal bytes give equal sound.
    """

    start: int
    end: int
    midi: bytes


class Synthesiser:
    """Renders phrases and caches their sound.

    Parameters
    ----------
    render : callable
        Function that renders a MIDI file, in this or another process.
    """

    def __init__(self, render: Callable[[bytes], Samples] = rendered) -> None:
        self._render = render
        self._sounds: dict[bytes, Samples] = {}
        self._bytes = 0

    def ready(self, phrase: RenderedPhrase) -> AudioSegment | None:
        """Return the sound of a phrase that has been rendered; None otherwise."""
        samples = self._sounds.get(phrase.midi)
        return None if samples is None else AudioSegment(phrase.start, samples)

    def render(self, phrase: RenderedPhrase) -> AudioSegment:
        """Render a phrase as sound: int16, mono. Any thread may call this."""
        piece = self.ready(phrase)
        if piece is None:
            samples = self._render(phrase.midi)
            self._sounds[phrase.midi] = samples
            self._bytes += samples.nbytes
            piece = AudioSegment(phrase.start, samples)
        return piece

    def forget(self, used: Iterable[RenderedPhrase]) -> frozenset[bytes]:
        """Drop the oldest unused sounds until there is room for new ones.

        Returns
        -------
        frozenset of bytes
            `RenderedPhrase.midi` of the dropped sounds.
        """
        lengths = {phrase.midi: phrase.end - phrase.start for phrase in used}
        # Samples have two bytes.
        coming = sum(2 * length for midi, length in lengths.items() if midi not in self._sounds)
        # Iterate over a copy: another worker that is being stopped may still add a sound.
        gone = set()
        for midi in [midi for midi in list(self._sounds) if midi not in lengths]:
            if self._bytes + coming <= _MOST_CACHED_BYTES:
                break
            self._bytes -= self._sounds.pop(midi).nbytes
            gone.add(midi)
        return frozenset(gone)


def phrases(part: Part, tempo_map: TempoMap, program: int) -> tuple[RenderedPhrase, ...]:
    """Cut a part into phrases.

    Parameters
    ----------
    program : int
        General MIDI program, 0..127.
    """
    if not part.notes:
        return ()
    onset_ticks = np.array([note.onset_tick for note in part.notes], np.int64)
    onsets = _samples(tempo_map, onset_ticks)
    ends = _samples(tempo_map, np.array([note.end_tick for note in part.notes], np.int64))
    bent = range_for([value for curve in part.curves if curve.kind == "pitch_bend" for value in curve.values])
    controls = _controls(part, tempo_map, bent)
    opening = _opening(program, bent)
    windows = onset_ticks // (_WINDOW_QUARTERS * tempo_map.ticks_per_quarter)
    # Notes are sorted by onset, so those of a window are consecutive.
    firsts = np.flatnonzero(np.diff(windows, prepend=windows[0] - 1))
    return tuple(
        _phrase(part.notes[first:last], onsets[first:last], ends[first:last], controls, opening)
        for first, last in zip(firsts.tolist(), [*firsts[1:].tolist(), len(part.notes)], strict=True)
    )


def drum_phrases(hits: Sequence[PercussionHit], tempo_map: TempoMap) -> tuple[RenderedPhrase, ...]:
    """Cut the percussion of a piece into phrases, for the drum kit.

    Parameters
    ----------
    hits : sequence of PercussionHit
        Strokes in the order of their ticks.
    """
    if not hits:
        return ()
    ticks = np.array([hit.tick for hit in hits], np.int64)
    at = _samples(tempo_map, ticks)
    # The length of a drum's sound is fixed: a note-off is needed only before the next stroke.
    notes = [Note("", hit.tick, 1, SAME_SOUND.get(hit.pitch, hit.pitch), hit.velocity) for hit in hits]
    windows = ticks // (_WINDOW_QUARTERS * tempo_map.ticks_per_quarter)
    firsts = np.flatnonzero(np.diff(windows, prepend=windows[0] - 1))
    opening = bytes((0xC0 | DRUM_CHANNEL, 0))
    return tuple(
        _phrase(notes[first:last], at[first:last], at[first:last] + _STROKE, (), opening, DRUM_CHANNEL)
        for first, last in zip(firsts.tolist(), [*firsts[1:].tolist(), len(notes)], strict=True)
    )


def program_of(part: Part, instrument: InstrumentMap | None) -> int:
    """Return the General MIDI program for a player's part.

    It is the file's program if that suits the instrument; else the program that the vocabulary gives for the instrument
    or its substitute; else the file's program if that is a wind instrument.
    """
    names = [] if instrument is None else [*instrument.plays, *instrument.substitutes_for]
    table = vocabulary().instruments
    own = [program for name in names if name in table for program in table[name].programs]
    available = programs()
    if part.program in own and part.program in available:
        return part.program
    for program in [*own, part.program]:
        if program in available:
            return int(program)
    return min(available)


@cache
def programs() -> frozenset[int]:
    """Return the programs in the bundled soundfont."""
    data = soundfont()
    at = data.index(b"phdr")
    size = struct.unpack_from("<I", data, at + 4)[0]
    rows = struct.iter_unpack("<20sHHHIII", data[at + 8 : at + 8 + size])
    return frozenset([row[1] for row in rows][:-1])


def _opening(program: int, bent: int) -> bytes:
    """Return the first messages of a phrase: its program, and the range of pitch bends in semitones."""
    messages = [bytes((0xC0, program))]
    if bent != USUAL_SEMITONES:
        messages += [bytes((0xB0, *control)) for control in range_controls(bent)]
    return b"\0".join(messages)


def _controls(part: Part, tempo_map: TempoMap, bent: int) -> tuple[tuple[IntArray, tuple[bytes, ...]], ...]:
    """Convert a part's audible controllers (loudness as expression, volume, pitch bend) to sample positions and MIDI
    messages.

    ``bent`` is the range of the bends in semitones.
    """
    loudness = sounding_curve(part)
    audible = [curve for curve in part.curves if curve.kind in ("volume", "pitch_bend")]
    if loudness is not None and loudness.kind != "volume":
        audible.append(loudness)
    return tuple(
        (
            _samples(tempo_map, np.array(curve.ticks, np.int64)),
            tuple(_control(curve.kind, value, bent) for value in curve.values),
        )
        for curve in audible
    )


def _control(kind: CurveKind, value: float, bent: int) -> bytes:
    if kind == "pitch_bend":
        bend = 8192 + wheel(value, bent)
        return bytes((0xE0, bend & 127, bend >> 7))
    level = min(max(round(127 * value), 0), 127)
    return bytes((0xB0, _VOLUME if kind == "volume" else _EXPRESSION, level))


def _phrase(
    notes: Sequence[Note],
    onsets: IntArray,
    ends: IntArray,
    controls: Sequence[tuple[IntArray, tuple[bytes, ...]]],
    opening: bytes,
    channel: int = 0,
) -> RenderedPhrase:
    """Create a phrase of notes that sound from ``onsets`` to ``ends`` (in samples), as a MIDI file that begins with the
    messages ``opening`` at the first onset.
    """
    start = int(onsets.min()) // _BLOCK * _BLOCK
    last = int(ends.max())
    # (sample, order, message): at one sample controllers come first, then note-offs, then note-ons.
    events = [(0, 0, opening)]
    for samples, messages in controls:
        first = max(int(np.searchsorted(samples, onsets.min(), side="right")) - 1, 0)
        for step in range(first, max(int(np.searchsorted(samples, last)), first + 1)):
            events.append((max(int(samples[step]) - start, 0), 1, messages[step]))
    for note, onset, end in zip(notes, onsets.tolist(), ends.tolist(), strict=True):
        events.append((onset - start, 3, bytes((0x90 | channel, note.pitch, note.velocity))))
        events.append((max(end, onset + 1) - start, 2, bytes((0x80 | channel, note.pitch, 0))))
    events.sort(key=_in_order)
    tail = round(_TAIL_S * RATE_HZ)
    return RenderedPhrase(start, max(last, start) + tail, _midi_file(events, tail))


def _in_order(event: tuple[int, int, bytes]) -> tuple[int, int]:
    return event[:2]


def _midi_file(events: Iterable[tuple[int, int, bytes]], tail: int) -> bytes:
    """Format events as a MIDI file of one track whose ticks are samples. Own code, since a library takes ten times as
    long and large scores have hundreds of thousands of messages.
    """
    track = bytearray()
    before = 0
    for at, _, message in events:
        track += _variable_length(at - before) + message
        before = at
    track += _variable_length(tail) + b"\xff\x2f\x00"
    return struct.pack(">4sIHHH4sI", b"MThd", 6, 0, 1, TICKS_PER_QUARTER, b"MTrk", len(track)) + bytes(track)


def _variable_length(number: int) -> bytes:
    """Return a MIDI variable-length quantity: seven bits per byte, highest first, with a mark on all but the last."""
    if number < 128:
        return bytes((number,))
    out = [number & 127]
    while number := number >> 7:
        out.append(number & 127 | 128)
    return bytes(reversed(out))


def _samples(tempo_map: TempoMap, ticks: IntArray) -> IntArray:
    return np.round(tempo_map.seconds(ticks) * RATE_HZ).astype(np.int64)
