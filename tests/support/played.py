"""Convert an engraved MIDI file to one as if played into a sequencer, by rules and random numbers.

Every note begins up to 20 ms early or late; in some half bars the notes are slurred, each lasting 5 to 60 ms into the
next; velocities follow a phrase arch; controllers 1, 2 and 11 move around mezzoforte; the tempo bends by 8 % and slows
down at the end; some long notes have a grace note; key switches far below the range stand before phrases.
"""

from __future__ import annotations

import bisect
import io
import math
import random
from pathlib import Path
from typing import Final, NamedTuple

import mido
import numpy as np

from app.score.contents import PieceContents
from app.score.read import read_contents
from app.score.tempo import TempoChange, TempoMap

PERCUSSION: Final = 9
_CONTROL_EVERY_S: Final = 0.2


class Manner(NamedTuple):
    """Playing habits of a synthetic player.

    Attributes
    ----------
    slurred : float
        0..1 of the half bars in which notes overlap. As players slur: not into the next half bar, and not from a note
        into a shorter one.
    overlap_s : tuple of float
        How long, at least and at most.
    graced : float
        0..1 of the long notes that have a grace note.
    """

    slurred: float = 0.5
    overlap_s: tuple[float, float] = (0.005, 0.060)
    early_or_late_s: float = 0.020
    graced: float = 0.02
    key_switches: bool = True
    controllers: tuple[int, ...] = (1, 2, 11)
    rubato: float = 0.08
    arched: float | None = 40.0
    """Difference of velocity between the softest and the loudest note of a phrase of six seconds; None to keep the
    file's velocities.
    """


class _Sounding(NamedTuple):
    begin_s: float
    end_s: float
    pitch: int
    velocity: int


def played(path: Path, seed: int = 0, manner: Manner | None = None) -> bytes:
    """Return the bytes of a played version of a file with the same tracks, names, programs and metres."""
    manner = manner or Manner()
    by_chance = random.Random(f"{seed}:{path.stem}")
    contents = read_contents(path)
    # Fine, and the same player's chances fall at the same places: `app.plan.music.piece.Seeds` counts ticks and tracks.
    scale = math.ceil(192 / contents.tempo_map.ticks_per_quarter)
    file = mido.MidiFile(type=1, ticks_per_beat=scale * contents.tempo_map.ticks_per_quarter)
    end_tick = max(max(stream.end_ticks) for stream in contents.channels)
    events: list[tuple[int, mido.MetaMessage]] = [
        (
            round(metre.tick * scale),
            mido.MetaMessage("time_signature", numerator=metre.numerator, denominator=metre.denominator),
        )
        for metre in contents.metres
    ]
    tempi = _bent(contents.tempo_map, end_tick, manner.rubato)
    events += [(round(tick * scale), mido.MetaMessage("set_tempo", tempo=tempo)) for tick, tempo in tempi]
    bent = TempoMap.of_changes(contents.tempo_map.ticks_per_quarter, [TempoChange(*tempo) for tempo in tempi])
    for index in range(contents.channels[-1].track + 1):
        streams = [stream for stream in contents.channels if stream.track == index]
        track = mido.MidiTrack()
        file.tracks.append(track)
        rows: list[tuple[int, int, mido.Message | mido.MetaMessage]] = []
        if index == 0:
            rows += [(tick, 0, message) for tick, message in events]
        for stream in streams:
            if stream is streams[0]:
                rows.append((0, 0, mido.MetaMessage("track_name", name=stream.name)))
                rows.append((0, 0, mido.MetaMessage("instrument_name", name=stream.instrument_name)))
            if stream.program is not None:
                rows.append((0, 1, mido.Message("program_change", channel=stream.channel, program=stream.program)))
            notes = [
                _Sounding(bent.seconds(float(on)), bent.seconds(float(off)), pitch, velocity)
                for on, off, pitch, velocity in zip(
                    stream.onset_ticks, stream.end_ticks, stream.pitches, stream.velocities, strict=True
                )
            ]
            half_bars = _half_bars(sorted(stream.onset_ticks), contents)
            if stream.channel != PERCUSSION:
                notes = _performed(notes, half_bars, manner, by_chance)
                rows += _controllers(notes, stream.channel, manner, bent, scale)
            for note in notes:
                on, off = (max(round(float(bent.ticks(at_s)) * scale), 0) for at_s in (note.begin_s, note.end_s))
                rows.append((on, 3, _message("note_on", stream.channel, note)))
                rows.append((max(off, on + 1), 2, _message("note_off", stream.channel, note)))
        _write(track, rows)
    stored = io.BytesIO()
    file.save(file=stored)
    return stored.getvalue()


def _half_bars(onset_ticks: list[int], contents: PieceContents) -> list[int]:
    """Return the start of the half bar that each onset is in, ticks; in a bar of an odd number of beats one beat is
    left over."""
    starts = [metre.tick for metre in contents.metres]
    result = []
    for tick in onset_ticks:
        metre = contents.metres[max(bisect.bisect_right(starts, tick) - 1, 0)]
        beat = contents.tempo_map.ticks_per_quarter * 4 // metre.denominator
        beats = 3 if metre.numerator % 3 == 0 and metre.numerator > 3 else 2
        bar, within = divmod(tick - metre.tick, metre.numerator * beat)
        result.append(metre.tick + bar * metre.numerator * beat + within // (beats * beat) * beats * beat)
    return result


def _performed(
    notes: list[_Sounding], half_bars: list[int], manner: Manner, by_chance: random.Random
) -> list[_Sounding]:
    """Notes of a track with played onsets, ends and velocities, including grace notes and key switches.

    Parameters
    ----------
    half_bars : list of int
        The half bar of each note, in the order of time.
    """
    notes = sorted(notes)
    following = {
        round(note.begin_s, 4): (half_bar, note.end_s - note.begin_s)
        for note, half_bar in zip(notes, half_bars, strict=True)
    }
    slurred = {half_bar for half_bar in sorted(set(half_bars)) if by_chance.random() < manner.slurred}
    shifts = [by_chance.uniform(-1.0, 1.0) * manner.early_or_late_s for _ in notes]
    lowest = min(note.pitch for note in notes)
    result: list[_Sounding] = []
    last_end_s = -10.0
    for note, half_bar, shift_s in zip(notes, half_bars, shifts, strict=True):
        begin_s, end_s = max(note.begin_s + shift_s, 0.0), note.end_s
        length_s = end_s - note.begin_s
        next_half_bar, next_length_s = following.get(round(note.end_s, 4), (None, 0.0))
        if half_bar in slurred and half_bar == next_half_bar and length_s < next_length_s + 0.01:
            end_s += manner.early_or_late_s + by_chance.uniform(*manner.overlap_s)
        else:
            end_s -= min(0.025 + 0.04 * length_s, 0.3 * length_s)
        arch = math.sin(math.pi * (note.begin_s % 6.0) / 6.0)
        level = note.velocity if manner.arched is None else 75 + manner.arched * (arch - 0.5)
        velocity = min(max(round(level + by_chance.gauss(0.0, 5.0)), 1), 127)
        if length_s > 0.4 and by_chance.random() < manner.graced and begin_s > 0.2:
            grace_s = begin_s - by_chance.uniform(0.06, 0.09)
            if result:
                result[-1] = result[-1]._replace(end_s=min(result[-1].end_s, grace_s + 0.01))
            result.append(_Sounding(grace_s, begin_s + 0.01, note.pitch + by_chance.choice((1, 2)), velocity))
        if manner.key_switches and begin_s - last_end_s > 0.3 and begin_s > 0.15:
            switch = max(min(24, (lowest - 18) // 12 * 12), 0) + by_chance.choice((0, 1, 2, 4))
            result.append(_Sounding(begin_s - 0.1, begin_s - 0.04, switch, 100))
        result.append(_Sounding(begin_s, end_s, note.pitch, velocity))
        last_end_s = max(last_end_s, note.end_s)
    return _one_key_each(sorted(result))


def _one_key_each(notes: list[_Sounding]) -> list[_Sounding]:
    """End each note before the same key is struck again, except for two players in unison on one key."""
    following: dict[int, float] = {}
    result = []
    for note in reversed(notes):
        again_s = following.get(note.pitch, math.inf)
        end_s = note.end_s if again_s - note.begin_s < 0.045 else min(note.end_s, again_s - 0.005)
        following[note.pitch] = note.begin_s
        result.append(note._replace(end_s=max(end_s, note.begin_s + 0.01)))
    return result[::-1]


def _controllers(
    notes: list[_Sounding], channel: int, manner: Manner, bent: TempoMap, scale: float
) -> list[tuple[int, int, mido.Message]]:
    rows = []
    times_s = np.arange(0.0, max(note.end_s for note in notes), _CONTROL_EVERY_S)
    ticks = np.rint(bent.ticks(times_s) * scale).astype(int).tolist()
    for number in manner.controllers:
        levels = 80 + 40 * (np.sin(np.pi * (times_s % 6.0) / 6.0) - 2 / np.pi) + 5 * np.sin(times_s * number)
        for tick, level in zip(ticks, np.rint(levels).astype(int).tolist(), strict=True):
            rows.append((tick, 1, mido.Message("control_change", channel=channel, control=number, value=level)))
    return rows


def _bent(tempo_map: TempoMap, end_tick: int, rubato: float) -> list[tuple[int, int]]:
    """Vary the tempi slightly every two quarters, and slow down in the last eight quarters."""
    quarter = tempo_map.ticks_per_quarter
    ticks = sorted({change.tick for change in tempo_map.changes} | set(range(0, end_tick, 2 * quarter)))
    tempi, place = [], 0
    for tick in ticks:
        while place + 1 < len(tempo_map.changes) and tempo_map.changes[place + 1].tick <= tick:
            place += 1
        plain = tempo_map.changes[place].microseconds_per_quarter
        bend = 1.0 + rubato * math.sin(tick / (7.0 * quarter))
        slowing = 1.0 + 0.4 * max(1.0 - (end_tick - tick) / (8.0 * quarter), 0.0)
        tempi.append((tick, round(plain * bend * slowing)))
    return tempi


def _message(kind: str, channel: int, note: _Sounding) -> mido.Message:
    velocity = note.velocity if kind == "note_on" else 0
    return mido.Message(kind, channel=channel, note=note.pitch, velocity=velocity)


def _write(track: mido.MidiTrack, rows: list[tuple[int, int, mido.Message | mido.MetaMessage]]) -> None:
    before = 0
    for tick, _, message in sorted(rows, key=lambda row: row[:2]):
        track.append(message.copy(time=tick - before))
        before = tick
