"""A take: the unchanged input of a wind controller during a pass, and the notes played in it.

A take is never changed: it is cleaned, quantised and cut again from the same events after a change of
settings.
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
    """Controllers that send the player's breath and lips.

    Attributes
    ----------
    channel : int
        1..16; 0: any.
    """

    channel: int = 0
    breath: BreathSource = "cc2"
    bite: BiteSource = "none"


class Cleaning(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings for making notes from played events; see `app.score.clean`.

    Attributes
    ----------
    ghost_s : float
        A note shorter than this is left out where it is soft too, or lies between two notes of a legato (fingers that
        did not move at once); 0: none is.
    ghost_loudness : float
        Soft: the breath stays below this (0..1); where no breath was sent, the velocity.
    double_s : float
        A note struck again at the same pitch within this time is one note; 0: never.
    overlap_s : float
        The longest that a note may sound into the next; more is cut, so that a slur stays one.
    quantise : float
        0..1: how far onsets are drawn to the grid.
    grid_quarters : float
        The grid's step.
    align : float
        0..1: how far notes are drawn to those of the score that they are taken for; 0: they are not compared.
    """

    ghost_s: float = 0.05
    ghost_loudness: float = 0.15
    double_s: float = 0.03
    overlap_s: float = 0.02
    quantise: float = 0.0
    grid_quarters: float = 0.25
    align: float = 0.0


class Take(msgspec.Struct, frozen=True, dict=True, forbid_unknown_fields=True, rename={"mapping": "wiring"}):
    """One pass of a recording.

    Attributes
    ----------
    id : str
        ``"take:1"`` and so on; unique in the project, never used again.
    colour : str
        ``"#rrggbb"``; empty: the player's.
    device : str
        The port it came from.
    recorded : str
        When, as ISO 8601 in UTC; empty where no one knows.
    tempo_map : TempoMap
        The tempo map during the recording: the events keep their places in the music when the piece's tempo changes.
    start_us, end_us : int
        Performance time of its beginning and end, microseconds; tick 0 of ``tempo_map`` is 0, the pre-roll negative.
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
        """The number in its id."""
        return int(self.id.rpartition(":")[2])

    @cached_property
    def played(self) -> Played:
        """Notes and curves of the events; a take with another name or cleaning was played the same."""
        return _PLAYED.step(_played, self.times_us, self.messages, self.mapping, self.end_us)

    @property
    def start_tick(self) -> float:
        """Return where it begins in the music."""
        return self.tempo_map.ticks(self.start_us / 1e6)

    @property
    def end_tick(self) -> float:
        """Return where it ends in the music."""
        return self.tempo_map.ticks(self.end_us / 1e6)


@dataclass(frozen=True, eq=False)
class Controlled:
    """A controller over time: a step function; times ascend.

    Attributes
    ----------
    times_s, values : float64, shape (n,)
        Values as `app.score.model.ControllerCurve` has them.
    """

    times_s: FloatArray
    values: FloatArray

    def at(self, times_s: FloatArray) -> FloatArray:
        """The value at times; 0 before the first."""
        index = np.searchsorted(self.times_s, times_s, side="right")
        return np.concatenate(([0.0], self.values))[index]


@dataclass(frozen=True, eq=False)
class Played:
    """The notes and curves of a take, as they were played; all arrays of notes have one length, in order of onset.

    Attributes
    ----------
    onsets_s, ends_s : float64
        Performance time. A note that was held at the end ends with the take.
    pitches, velocities : int64
    curves : mapping of CurveKind to Controlled
        ``breath`` and ``bite`` by the take's mapping, the others as they came.
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
    """Decode a take; messages that say nothing of notes, breath or lips are passed over."""
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
    """Return whether a message comes on the wired channel."""
    return not mapping.channel or bool(message.channel + 1 == mapping.channel)


@lru_cache(8192)
def decoded(raw: str) -> mido.Message | None:
    """A message of a channel; None for any other, and for bytes that are none."""
    try:
        message = mido.Message.from_bytes(bytes.fromhex(raw))
    except (ValueError, IndexError, TypeError, KeyError):
        return None
    return message if hasattr(message, "channel") else None


def is_message(raw: str) -> bool:
    """Return whether this is one MIDI message in hexadecimal."""
    try:
        mido.Message.from_bytes(bytes.fromhex(raw))
    except (ValueError, IndexError, TypeError, KeyError):
        return False
    return True


def curve_values(
    message: mido.Message, mapping: ControllerMapping, ranges: BendRanges | None = None
) -> Iterator[tuple[CurveKind, float]]:
    """Return what a message says of breath, bite and bend, as values of a part's curves.

    Parameters
    ----------
    ranges : BendRanges, optional
        Of the controller's channels, which follow what the message says of them; without them the usual ones.
    """
    source, value = _source(message)
    ranges = BendRanges() if ranges is None else ranges
    if message.type == "control_change" and message.control in PARAMETERS:
        ranges.receive(message.channel, message.control, message.value)
    if source == mapping.bite:
        yield "bite", abs(value)
    if source == mapping.breath:
        yield "breath", value
    # Who bites to bend does both.
    elif source in _USUAL and (source != mapping.bite or source == "pitch_bend"):
        share = ranges.semitones(message.channel) / USUAL_SEMITONES if source == "pitch_bend" else 1.0
        yield _USUAL[source], share * value


_USUAL: Final[Mapping[str, CurveKind]] = {
    "cc7": "volume",
    "cc11": "expression",
    "channel_pressure": "aftertouch",
    "pitch_bend": "pitch_bend",
}
"""Kinds of curve that controllers carry unless a mapping says otherwise."""


def _source(message: mido.Message) -> tuple[str, float]:
    """Name a message's source, as a `BreathSource` or `BiteSource`, with its value 0..1, a bend's -1..1."""
    if message.type == "control_change":
        return f"cc{message.control}", message.value / 127.0
    if message.type == "aftertouch":
        return "channel_pressure", message.value / 127.0
    if message.type == "pitchwheel":
        return "pitch_bend", message.pitch / _BEND_RANGE
    return "", 0.0
