"""The built-in synthesiser: a player's part as sound, phrase by phrase.

A part is cut into phrases of some bars' length that sound independently of one another, so that a piece is heard as
soon as its first phrases are made, and only the phrases that an edit touched are made again: what a phrase is made from
(its MIDI bytes) is its identity. A phrase takes some 25 ms, during which midirenderer 0.1.3 lets no other Python run;
whole parts would stop the window. It also stops at the last event, so silence follows that lets the tail sound.

Parts are rendered without regard to who else plays; loudness and place are the mixer's.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import midirenderer
import mido
import numpy as np
import soundfile

from app.audio.track import RATE_HZ, Piece, Samples
from app.performance.loudness import speaking_curve
from app.score.model import ControllerCurve, Note, Part
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap
from instrument_maps.vocabulary import vocabulary

SOUNDFONT: Final = Path(__file__).parents[2] / "resources" / "soundfont" / "winds.sf2"

TICKS_PER_QUARTER: Final = 24000
"""At MIDI's own 120 quarters per minute a tick is a sample at 48 kHz."""
_WINDOW_QUARTERS: Final = 8
"""A phrase's notes begin in one of these windows; fixed, so that an edit moves no other phrase's bounds."""
_TAIL_S: Final = 1.5
"""The longest release and the reverberation."""
_BLOCK: Final = 64
"""The synthesiser heeds events once in so many samples."""
_BEND_SEMITONES: Final = 2
_VOLUME, _EXPRESSION = 7, 11
_MOST_CACHED_BYTES: Final = 256 * 1024 * 1024


@dataclass(frozen=True)
class Phrase:
    """Some notes of a part, to be rendered.

    Attributes
    ----------
    start, end : int
        Performance time in samples; the end is where the last tail has died away.
    midi : bytes
        A MIDI file that begins there; equal bytes sound equal.
    """

    start: int
    end: int
    midi: bytes


class Synthesiser:
    """Renders phrases and remembers them."""

    def __init__(self) -> None:
        self._sounds: dict[bytes, Samples] = {}
        self._bytes = 0

    def ready(self, phrase: Phrase) -> Piece | None:
        """A phrase that has been rendered; None if it has not."""
        samples = self._sounds.get(phrase.midi)
        return None if samples is None else Piece(phrase.start, samples)

    def render(self, phrase: Phrase) -> Piece:
        """A phrase as sound: int16, mono. May be called from a worker."""
        piece = self.ready(phrase)
        if piece is None:
            samples = _render(phrase.midi)
            self._sounds[phrase.midi] = samples
            self._bytes += samples.nbytes
            piece = Piece(phrase.start, samples)
        return piece

    def forget(self, used: Iterable[Phrase]) -> None:
        """Let go of the oldest sounds that nobody uses, where they take more than their room."""
        if self._bytes <= _MOST_CACHED_BYTES:
            return
        kept = {phrase.midi for phrase in used}
        for midi in [midi for midi in self._sounds if midi not in kept]:
            if self._bytes <= _MOST_CACHED_BYTES:
                break
            self._bytes -= self._sounds.pop(midi).nbytes


def phrases(part: Part, tempo_map: TempoMap, program: int) -> tuple[Phrase, ...]:
    """Cut a part into phrases.

    Parameters
    ----------
    part : Part
    tempo_map : TempoMap
    program : int
        General MIDI program, 0..127.
    """
    window = _WINDOW_QUARTERS * tempo_map.ticks_per_quarter
    groups: dict[int, list[Note]] = {}
    for note in part.notes:
        groups.setdefault(note.onset_tick // window, []).append(note)
    curves = _heard_curves(part)
    return tuple(_phrase(notes, curves, tempo_map, program) for _, notes in sorted(groups.items()))


def program_of(part: Part, instrument: InstrumentMap) -> int:
    """The General MIDI program that sounds like what a player plays.

    The file's own program where it is one of the instrument's; else what the vocabulary gives the instrument, then what
    it may stand in for; else the file's, if it is a wind.
    """
    names = [*instrument.plays, *instrument.substitutes_for]
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
    """The programs that the bundled soundfont has."""
    data = _soundfont()
    at = data.index(b"phdr")
    size = struct.unpack_from("<I", data, at + 4)[0]
    rows = struct.iter_unpack("<20sHHHIII", data[at + 8 : at + 8 + size])
    return frozenset([row[1] for row in rows][:-1])


@cache
def _soundfont() -> bytes:
    return SOUNDFONT.read_bytes()


def _heard_curves(part: Part) -> tuple[tuple[int, ControllerCurve], ...]:
    """The curves that are heard, with the controller that carries each: the player's loudness as expression."""
    loudness = speaking_curve(part)
    heard: list[tuple[int, ControllerCurve]] = []
    if loudness is not None and loudness.kind != "volume":
        heard.append((_EXPRESSION, loudness))
    for curve in part.curves:
        if curve.kind == "volume":
            heard.append((_VOLUME, curve))
        elif curve.kind == "pitch_bend":
            heard.append((-1, curve))
    return tuple(heard)


def _phrase(
    notes: Sequence[Note], curves: Sequence[tuple[int, ControllerCurve]], tempo_map: TempoMap, program: int
) -> Phrase:
    onsets = np.array([note.onset_tick for note in notes], np.int64)
    ends = np.array([note.end_tick for note in notes], np.int64)
    first_tick, last_tick = int(onsets.min()), int(ends.max())
    start = _samples(tempo_map, first_tick) // _BLOCK * _BLOCK

    def at(tick: int) -> int:
        return _samples(tempo_map, tick) - start

    # (sample, order, message): what ends a note comes before what begins the next, controllers before both.
    events: list[tuple[int, int, mido.Message]] = [
        (0, 0, mido.Message("program_change", program=program)),
    ]
    for controller, curve in curves:
        index = max(int(np.searchsorted(curve.ticks, first_tick, side="right")) - 1, 0)
        stop = int(np.searchsorted(curve.ticks, last_tick))
        for step in range(index, max(stop, index + 1)):
            events.append((max(at(curve.ticks[step]), 0), 1, _control(controller, curve.values[step])))
    for note, onset, end in zip(notes, onsets.tolist(), ends.tolist(), strict=True):
        begin = at(onset)
        events.append((begin, 3, mido.Message("note_on", note=note.pitch, velocity=note.velocity)))
        events.append((max(at(end), begin + 1), 2, mido.Message("note_off", note=note.pitch)))
    events.sort(key=lambda event: event[:2])
    track = mido.MidiTrack()
    before = 0
    for sample, _, message in events:
        track.append(message.copy(time=sample - before))
        before = sample
    track.append(mido.MetaMessage("end_of_track", time=round(_TAIL_S * RATE_HZ)))
    file = mido.MidiFile(type=0, ticks_per_beat=TICKS_PER_QUARTER)
    file.tracks.append(track)
    out = io.BytesIO()
    file.save(file=out)
    return Phrase(start, start + before + round(_TAIL_S * RATE_HZ), out.getvalue())


def _control(controller: int, value: float) -> mido.Message:
    if controller < 0:
        return mido.Message("pitchwheel", pitch=min(max(round(value * 8192), -8192), 8191))
    return mido.Message("control_change", control=controller, value=min(max(round(value * 127), 0), 127))


def _samples(tempo_map: TempoMap, tick: int) -> int:
    return round(tempo_map.seconds(float(tick)) * RATE_HZ)


def _render(midi: bytes) -> Samples:
    wave = midirenderer.render_wave_from(_soundfont(), midi)
    stereo, rate_hz = soundfile.read(io.BytesIO(wave), dtype="int16", always_2d=True)
    if rate_hz != RATE_HZ:
        raise RuntimeError(f"the synthesiser renders at {rate_hz} Hz")
    mono = (stereo.astype(np.int32).sum(axis=1) // 2).astype(np.int16)
    heard = np.flatnonzero(np.abs(mono) > 1)
    sound: Samples = mono[: int(heard[-1]) + 1 if len(heard) else 0].copy()
    return sound
