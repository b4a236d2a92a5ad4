"""A take: unchanged input of a wind controller during one recording pass, and the notes played in it.

A take is never modified; after a change of settings it is cleaned, quantised and cut again from the same events.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Final

import mido
import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.identity_cache import IdentityCache
from app.score.bend_range import PARAMETERS, USUAL_SEMITONES, BendRanges
from app.score.model import CurveKind
from app.score.sounding import SoundingNotes
from app.score.tempo import TempoMap
from metadata.model import BiteSource, BreathSource

_BEND_RANGE = 8192


class ControllerMapping(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """MIDI controllers that carry the player's breath and bite.

    Attributes
    ----------
    channel : int
        MIDI channel 1..16 of the controllers; 0: any channel.
    """

    channel: int = 0
    breath: BreathSource = "cc2"
    bite: BiteSource = "none"


class Cleaning(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings for making notes from played events; see `app.score.clean`.

    Attributes
    ----------
    ghost_s : float
        A note shorter than this is removed if it is also soft or lies between two legato notes (fingers that did not
        move together); 0: never.
    ghost_loudness : float
        A note is soft if its breath (or, without breath data, its velocity) stays below this, 0..1.
    double_s : float
        Two notes of one pitch within this time are joined into one; 0: never.
    overlap_s : float
        Longest overlap of a note with the next; more is cut, leaving a slur.
    quantise : float
        Strength of quantising onsets to the grid, 0..1.
    grid_quarters : float
        Step of the grid in quarters.
    align : float
        Strength of moving notes to the matched notes of the score, 0..1; 0: no comparison.
    """

    ghost_s: float = 0.05
    ghost_loudness: float = 0.15
    double_s: float = 0.03
    overlap_s: float = 0.02
    quantise: float = 0.0
    grid_quarters: float = 0.25
    align: float = 0.0


class Take(msgspec.Struct, frozen=True, dict=True, forbid_unknown_fields=True, rename={"mapping": "wiring"}):
    """One recorded pass of a player's part, with the settings by which its notes are cleaned.

    Attributes
    ----------
    id : str
        ``"take:1"`` and so on; unique in the project, never reused.
    colour : str
        ``"#rrggbb"``; empty: the player's.
    device : str
        Name of the MIDI input port.
    recorded : str
        Time of the recording, ISO 8601 in UTC; empty if unknown.
    tempo_map : TempoMap
        The tempo map during the recording: the events keep their places in the music when the piece's tempo changes.
    start_us, end_us : int
        Begin and end in performance time, microseconds; time 0 is tick 0 of ``tempo_map``, and the pre-roll is
        negative.
    times_us : tuple of int
        Performance time of every event, ascending.
    messages : tuple of str
        The events as hexadecimal bytes of MIDI.
    """

    id: str
    name: str
    colour: str
    device: str
    recorded: str
    mapping: ControllerMapping
    cleaning: Cleaning
    tempo_map: TempoMap
    start_us: int
    end_us: int
    times_us: tuple[int, ...]
    messages: tuple[str, ...]

    @property
    def number(self) -> int:
        """Number of the take, from its id."""
        return int(self.id.rpartition(":")[2])

    @cached_property
    def played(self) -> Played:
        """Notes and curves of the events; cached independently of the take's name and cleaning settings."""
        return _PLAYED.step(_played, self.times_us, self.messages, self.mapping, self.end_us)

    @property
    def start_tick(self) -> float:
        """Return the start of the take in ticks."""
        return self.tempo_map.ticks(self.start_us / 1e6)

    @property
    def end_tick(self) -> float:
        """Return the end of the take in ticks."""
        return self.tempo_map.ticks(self.end_us / 1e6)


@dataclass(frozen=True, eq=False)
class Controlled:
    """A MIDI controller over time: a step function; times ascend.

    Attributes
    ----------
    times_s, values : float64, shape (n,)
        Times, and values in the units of `app.score.model.ControllerCurve`.
    """

    times_s: FloatArray
    values: FloatArray

    def at(self, times_s: FloatArray) -> FloatArray:
        """Value (N,) of the controller at given times; 0 before its first message."""
        index = np.searchsorted(self.times_s, times_s, side="right")
        return np.concatenate(([0.0], self.values))[index]


@dataclass(frozen=True, eq=False)
class Played:
    """Notes and curves of a take as played; note arrays have equal length and are ordered by onset.

    Attributes
    ----------
    onsets_s, ends_s : float64
        Start and end of each note in performance time; a note still held at the end of the take ends there.
    pitches, velocities : int64
        Pitch and velocity of each note.
    curves : mapping of CurveKind to Controlled
        ``breath`` and ``bite`` by the take's mapping, the others as received.
    """

    onsets_s: FloatArray
    ends_s: FloatArray
    pitches: IntArray
    velocities: IntArray
    curves: Mapping[CurveKind, Controlled]

    def __len__(self) -> int:
        return len(self.onsets_s)


_PLAYED: Final[IdentityCache[Played]] = IdentityCache(64)


def _played(times_us: tuple[int, ...], messages: tuple[str, ...], mapping: ControllerMapping, end_us: int) -> Played:
    """Decode the events of a take; messages without effect on notes, breath or lips are skipped."""
    notes: list[tuple[float, float, int, int]] = []
    sounding: SoundingNotes[tuple[float, int]] = SoundingNotes()
    sent: dict[CurveKind, tuple[list[float], list[float]]] = {}
    ranges = BendRanges()
    for time_us, raw in zip(times_us, messages, strict=True):
        message = decoded(raw)
        if message is None or not is_wired(message, mapping):
            continue
        time_s = time_us / 1e6
        data = bytes.fromhex(raw)
        ended = sounding.receive(data, (time_s, data[-1]))
        notes += [(onset_s, time_s, pitch, velocity) for (_, pitch), (onset_s, velocity) in ended]
        for curve, value in curve_values(message, mapping, ranges):
            times, values = sent.setdefault(curve, ([], []))
            if times and times[-1] == time_s:
                values[-1] = value
            else:
                times.append(time_s)
                values.append(value)
    end_s = end_us / 1e6
    held = sounding.end_all()
    notes += [(onset_s, max(end_s, onset_s), pitch, velocity) for (_, pitch), (onset_s, velocity) in held]
    notes.sort()
    columns = np.array(notes, np.float64).reshape(-1, 4)
    return Played(
        columns[:, 0],
        columns[:, 1],
        columns[:, 2].astype(np.int64),
        columns[:, 3].astype(np.int64),
        {kind: Controlled(np.array(times), np.array(values)) for kind, (times, values) in sent.items()},
    )


def is_wired(message: mido.Message, mapping: ControllerMapping) -> bool:
    """Return whether a message comes on the MIDI channel that the mapping selects."""
    return not mapping.channel or bool(message.channel + 1 == mapping.channel)


@lru_cache(8192)
def decoded(raw: str) -> mido.Message | None:
    """Parse a MIDI channel message from hexadecimal text; None for other messages and invalid bytes."""
    try:
        message = mido.Message.from_bytes(bytes.fromhex(raw))
    except (ValueError, IndexError, TypeError, KeyError):
        return None
    return message if hasattr(message, "channel") else None


def is_message(raw: str) -> bool:
    """Return whether the text is one MIDI message in hexadecimal."""
    try:
        mido.Message.from_bytes(bytes.fromhex(raw))
    except (ValueError, IndexError, TypeError, KeyError):
        return False
    return True


def curve_values(
    message: mido.Message, mapping: ControllerMapping, ranges: BendRanges | None = None
) -> Iterator[tuple[CurveKind, float]]:
    """Yield the breath, bite and bend values that a message sets, in the units of a part's curves.

    Parameters
    ----------
    ranges : BendRanges, optional
        Bend ranges of the controller's channels, updated by the message; the usual ones if None.
    """
    source, value = _source(message)
    ranges = BendRanges() if ranges is None else ranges
    if message.type == "control_change" and message.control in PARAMETERS:
        ranges.receive(message.channel, message.control, message.value)
    if source == mapping.bite:
        yield "bite", abs(value)
    if source == mapping.breath:
        yield "breath", value
    # A player who bends by biting uses one control for both.
    elif source in _USUAL and (source != mapping.bite or source == "pitch_bend"):
        share = ranges.semitones(message.channel) / USUAL_SEMITONES if source == "pitch_bend" else 1.0
        yield _USUAL[source], share * value


_USUAL: Final[Mapping[str, CurveKind]] = {
    "cc7": "volume",
    "cc11": "expression",
    "channel_pressure": "aftertouch",
    "pitch_bend": "pitch_bend",
}
"""Kinds of curves of controllers without a mapping."""


def _source(message: mido.Message) -> tuple[str, float]:
    """Return the controller that a message sets, named as in `BreathSource` or `BiteSource`, and its value 0..1 (pitch
    bend -1..1).
    """
    if message.type == "control_change":
        return f"cc{message.control}", message.value / 127.0
    if message.type == "aftertouch":
        return "channel_pressure", message.value / 127.0
    if message.type == "pitchwheel":
        return "pitch_bend", message.pitch / _BEND_RANGE
    return "", 0.0
