"""Tempo and metres stated in a MIDI file, with assumptions where it states none."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final, NamedTuple

import msgspec

from app.errors import Message
from app.score.channel_sound import DRUM_CHANNEL
from app.score.chunks import Container
from app.score.metre_guess import Line, guessed_metres
from app.score.metre_map import Metre
from app.score.tempo import TempoChange, TempoMap
from app.score.tracks import LEAST_TEMPO, TrackEvents

_SMPTE_RATES = {24: Fraction(24), 25: Fraction(25), 29: Fraction(30000, 1001), 30: Fraction(30)}
_LARGEST_DENOMINATOR = 64
UNSTATED: Final = (Metre(0, 4, 4),)
"""Metre of a file without a time signature, according to the standard."""


class Assumed(msgspec.Struct, frozen=True):
    """Metres and pickup to use for a file without time signatures, taken from an earlier version of the file."""

    metres: tuple[Metre, ...]
    pickup_ticks: int
    ticks_per_quarter: int

    def in_ticks_of(self, ticks_per_quarter: int) -> tuple[tuple[Metre, ...], int]:
        """Return the metres and the length of the pickup, converted to a file's ticks."""
        scale = Fraction(ticks_per_quarter, self.ticks_per_quarter)
        metres = {round(metre.tick * scale): metre for metre in self.metres}
        placed = tuple(msgspec.structs.replace(metre, tick=tick) for tick, metre in sorted(metres.items()))
        return placed, round(self.pickup_ticks * scale)


class StatedTiming(NamedTuple):
    """Tempo and metres of a file, with messages about what was left out or assumed."""

    tempo_map: TempoMap
    metres: tuple[Metre, ...]
    pickup_ticks: int
    warnings: tuple[Message, ...]


def timing_of_file(container: Container, tracks: Sequence[TrackEvents], assumed: Assumed | None) -> StatedTiming:
    """Return tempo and metres of a file; ``assumed`` metres are used if the file is timed in quarters but has no time
    signature.
    """
    tempo_map, warnings = _tempo(container, tracks)
    if container.division <= 0 or any(events.metres for events in tracks):
        metres, pickup_ticks, impossible = _stated_metres(tracks, tempo_map.ticks_per_quarter)
        return StatedTiming(tempo_map, metres, pickup_ticks, (*warnings, *impossible))
    metres, pickup_ticks = _assumed_metres(tracks, tempo_map.ticks_per_quarter, assumed)
    if metres != UNSTATED:
        last = metres[-1]
        warnings.append(Message("midi.metre_assumed", {"numerator": last.numerator, "denominator": last.denominator}))
    return StatedTiming(tempo_map, metres, pickup_ticks, tuple(warnings))


def ticks_per_quarter_of(container: Container) -> int:
    """Return the ticks per quarter of a file; one timed in SMPTE frames gets substitute quarters."""
    if container.division > 0:
        return container.division
    return TempoMap.of_smpte(_ticks_per_second(container.division)).ticks_per_quarter


def _tempo(container: Container, tracks: Sequence[TrackEvents]) -> tuple[TempoMap, list[Message]]:
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
    """Frames per second as encoded in the file; 29 means 29.97."""
    return 256 - (division >> 8 & 0xFF)


def _ticks_per_second(division: int) -> float:
    """Ticks per second of a file timed in SMPTE frames."""
    rate = _smpte_rate(division)
    return float(_SMPTE_RATES.get(rate, Fraction(rate)) * max(division & 0xFF, 1))


def _stated_metres(
    tracks: Sequence[TrackEvents], ticks_per_quarter: int
) -> tuple[tuple[Metre, ...], int, list[Message]]:
    """Return the metres and the pickup length that a file states, with messages about what was left out.

    A metre repeated at a bar line is dropped; one repeated within a bar begins a new bar.
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
    """Return metres and pickup length in ticks for a MIDI file that states no metre: the assumed ones, or a guess from
    its notes."""
    if assumed is not None:
        return assumed.in_ticks_of(ticks_per_quarter)
    melodic = (notes for events in tracks for channel, notes in events.channels.items() if channel != DRUM_CHANNEL)
    lines = [Line(notes.onset_ticks, notes.end_ticks, notes.pitches) for notes in melodic]
    return guessed_metres(lines, ticks_per_quarter) or (UNSTATED, 0)
