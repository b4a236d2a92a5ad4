"""Sound of every channel on a sound module: melody, rhythm part or sound effect, and its programs.

General MIDI has its drum kit on channel 10. Systems that extend it allow rhythm parts on any channel and melodies on
channel 10. The relevant messages are collected from all tracks in order of ticks; at one tick resets come first (the
track of settings need not be the first of the file), then part modes, then banks and programs.

GM (General MIDI System Level 1, MMA 1991)
    "GM System On" (universal 09 01). Channel 10 alone has percussion; banks mean nothing.
GS (Roland SC-55 and SC-88 owner's manuals, MIDI implementation)
    "GS Reset" (data set to 40 00 7F) and the mode set of the SC-88 (00 00 7F). "Use for rhythm part" (40 1x 15) makes
    a part a rhythm part (1, 2: a drum map) or a melody (0), block 0 being part 10, 1 to 9 parts 1 to 9, A to F parts 11
    to 16; 50 1x is the other port's. "Receive channel" (40 1x 02) moves a part to another channel. "Bend pitch control"
    (40 2x 10, 40 to 58) is the range of its bends, 0 to 24 semitones. The bank select has variations, with MT-32 and
    CM-64 sounds in 126 and 127: no drums. Programs 56 and 57 of a rhythm part are effects.
XG (Yamaha MU80 and MU100 data lists)
    "XG System On" (00 00 7E), "all parameter reset" (00 00 7F). Bank MSB 127 has drum kits, 126 kits of effects, 64
    effects, anything less melodies, on every channel; "part mode" (08 pp 07) is 0 for a melody, else a drum part, and
    "receive channel" is 08 pp 04, "bend pitch control" 08 pp 23 (28 to 58: -24 to 24 semitones). Parts from 16 on are
    the second port's.
GM2 (General MIDI 2, MMA RP-024)
    "GM2 System On" (universal 09 03). Bank MSB 120 is percussion, 121 a melody; program 56 of percussion is effects.

A bank takes effect at the next program change. If none follows before the first note, it takes effect at that note: the
two were written in the wrong order. Roland checksums are ignored, as in other programs, and broadcast messages are
accepted.

Without a reset, or with resets of both GS and XG, banks 120, 126 and 127 are read as in XG and GM2, like FluidSynth's
"xg" bank selection, but the name of a wind instrument has priority (`ChannelSound.certain`). On channel 10 a bank below
120 makes a melody in XG only; many files have bank 0 everywhere and mean drums. A channel with such a bank stays
percussion if its program is a kit number.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from heapq import merge
from typing import Final, Literal, NamedTuple, TypeAlias, TypeVar

from app.score.bend_range import USUAL_SEMITONES, ModuleRange
from app.score.channel_sound import (
    DRUM_CHANNEL,
    ChannelSound,
    SoundChange,
    System,
    timeline,
)

Port: TypeAlias = tuple[int, bytes]
"""Number of a port (meta event 33) and name of a device (meta event 9)."""

FIRST_PORT: Final[Port] = (0, b"")
LATE_QUARTERS: Final = 4
"""Greatest number of quarters after a channel's first note for its first description, since programs write descriptions
some ticks apart in the first bar.
"""
_MOST_CHANGES: Final = 256
"""Greatest number of examined changes of a channel by other tracks, of each kind; a piece has a few."""


class Setup(NamedTuple):
    """A message that changes a channel's sound.

    Attributes
    ----------
    number : int
        Index among the messages of its track.
    channel : int
        -1: a system exclusive message.
    value : int or bytes
        A program, a bank MSB, or a system exclusive message without F0 and F7.
    port : Port or None
        The port selected in the track at this point; None if there was none.
    """

    tick: int
    number: int
    channel: int
    kind: Literal["program", "bank", "exclusive"]
    value: int | bytes
    port: Port | None


class Setups(NamedTuple):
    """Messages of one track that change sounds.

    Attributes
    ----------
    first_onsets : mapping of int to int
        First onset of each channel with notes.
    port : Port or None
        Port of the track's notes.
    """

    setups: Sequence[Setup]
    first_onsets: Mapping[int, int]
    port: Port | None


def channel_sounds(tracks: Sequence[Setups], quarter: int) -> list[dict[int, list[tuple[int, ChannelSound]]]]:
    """Return the sounds over time of each channel with notes, for each track.

    A track's own banks and programs precede those of other tracks, since large scores share channels. Settings in a
    track without notes on the channel apply to all tracks with notes; settings in other tracks with notes apply only to
    a track that has none.

    Parameters
    ----------
    quarter : int
        Ticks per quarter.

    Returns
    -------
    list of dict of int to list of (tick, ChannelSound)
        For each track, by channel; ticks ascend, and the first entry applies from the beginning.
    """
    modes = _modes(tracks, {track.port or FIRST_PORT for track in tracks if track.first_onsets})
    given = _given(tracks)
    nothing = _Given([], [])
    found = []
    for place, track in enumerate(tracks):
        port = track.port or FIRST_PORT
        mine: dict[int, list[SoundChange]] = {}
        for setup in track.setups:
            if setup.channel in track.first_onsets:
                mine.setdefault(setup.channel, []).append(_step(place, setup))
        timelines = {}
        for channel, onset in track.first_onsets.items():
            own = mine.get(channel, [])
            said = given.get((port, channel), nothing)
            settings = [given.get((one, channel), nothing).settings for one in _listening(port)]
            steps = merge(modes[port][channel], *settings, own if own else said.others)
            timelines[channel] = timeline(steps, channel, onset, LATE_QUARTERS * quarter)
        found.append(timelines)
    return found


def _step(track: int, setup: Setup) -> SoundChange:
    assert setup.kind != "exclusive"
    assert isinstance(setup.value, int)
    return SoundChange(setup.tick, 2, track, setup.number, setup.kind, setup.value)


class _Given(NamedTuple):
    """Banks and programs of a channel that also apply to other tracks: those set in tracks without notes on the
    channel, and those set in tracks with notes.
    """

    settings: list[SoundChange]
    others: list[SoundChange]


def _given(tracks: Sequence[Setups]) -> dict[tuple[Port | None, int], _Given]:
    """Collect the banks and programs that also apply to other tracks, by port and channel."""
    given: dict[tuple[Port | None, int], _Given] = {}
    for place, track in enumerate(tracks):
        for setup in track.setups:
            if setup.kind != "exclusive":
                key = _addressed(setup.port, track), setup.channel
                settings, others = given.setdefault(key, _Given([], []))
                (others if setup.channel in track.first_onsets else settings).append(_step(place, setup))
    return {
        key: _Given(sorted(settings)[:_MOST_CHANGES], sorted(others)[:_MOST_CHANGES])
        for key, (settings, others) in given.items()
    }


def _listening(port: Port) -> tuple[Port | None, ...]:
    """Return the addresses whose settings a port receives: itself, its number without device name, and all ports."""
    return tuple(dict.fromkeys((port, (port[0], b""), None)))


def _addressed(port: Port | None, track: Setups) -> Port | None:
    """Port to which the messages of a track are addressed; None means all ports, if a track without notes names no
    port.
    """
    if port is not None or not track.first_onsets:
        return port
    return track.port or FIRST_PORT


class _Reset(NamedTuple):
    system: System


_Parameter: TypeAlias = Literal["mode", "receive", "bend"]


class _PartValue(NamedTuple):
    """Value that a message sets for a parameter of one part (0..15) of a sound module."""

    other_port: bool
    part: int
    parameter: _Parameter
    value: int


def _meaning(message: bytes) -> list[_Reset | _PartValue]:
    """Return the resets and part parameters in a system exclusive message; empty for other messages."""
    if message[:1] == b"\x7e" and len(message) >= 4 and message[2] == 9:
        systems: dict[int, System] = {1: "gm", 2: "", 3: "gm2"}
        return [_Reset(systems[message[3]])] if message[3] in systems else []
    if message[:1] == b"\x41" and message[2:4] == b"\x42\x12" and len(message) >= 8:
        return _roland(message[4], message[5], message[6], message[7 : max(len(message) - 1, 8)])
    if message[:1] == b"\x43" and len(message) >= 7 and message[1] >> 4 == 1 and message[2] == 0x4C:
        return _yamaha(message[3], message[4], message[5], message[6:])
    return []


def _roland(high: int, middle: int, low: int, data: bytes) -> list[_Reset | _PartValue]:
    """Return the settings that a Roland GS message (an address of three bytes and data) makes for parts of the sound
    module."""
    if (high, middle, low) == (0x40, 0, 0x7F):
        return [_Reset("" if data[0] == 0x7F else "gs")]
    if (high, middle, low) == (0, 0, 0x7F):
        return [_Reset("gs")]
    if high not in (0x40, 0x50) or middle >> 4 not in (1, 2):
        return []
    block = middle & 15
    part = DRUM_CHANNEL if block == 0 else block - 1 if block <= DRUM_CHANNEL else block
    places: dict[_Parameter, int] = {"receive": 0x02, "mode": 0x15} if middle >> 4 == 1 else {"bend": 0x10}
    return _part_values(high == 0x50, part, low, data, places)


def _yamaha(high: int, middle: int, low: int, data: bytes) -> list[_Reset | _PartValue]:
    """Return the resets and part parameters that a Yamaha XG message (an address of three bytes and data) contains."""
    if (high, middle) == (0, 0) and low in (0x7E, 0x7F):
        return [_Reset("xg")]
    if high != 8 or middle >= 32:
        return []
    return _part_values(middle >= 16, middle % 16, low, data, {"receive": 0x04, "mode": 0x07, "bend": 0x23})


def _part_values(
    other_port: bool, part: int, low: int, data: bytes, places: Mapping[_Parameter, int]
) -> list[_Reset | _PartValue]:
    """Convert data bytes that begin at the address ``low`` of a part to the parameters they set; ``places`` has the
    address of each parameter.
    """
    return [
        _PartValue(other_port, part, parameter, data[place - low])
        for parameter, place in places.items()
        if low <= place < low + len(data)
    ]


_Made = TypeVar("_Made")
_CENTRE, _MOST_BENT = 0x40, 24
"""Value for a bend of no semitones, and greatest bend in semitones."""


class _Row(NamedTuple):
    """Effects of one system exclusive message; rows are sorted into the order in which messages apply."""

    tick: int
    rank: int
    track: int
    number: int
    meaning: _Reset | _PartValue


def _modes(tracks: Sequence[Setups], ports: Iterable[Port]) -> dict[Port, list[list[SoundChange]]]:
    """Collect the resets and part modes that messages set, by port and channel."""
    return _by_port(tracks, ports, ("receive", "mode"), _port_modes)


def module_ranges(tracks: Sequence[Setups], ports: Iterable[Port]) -> dict[Port, list[ModuleRange]]:
    """Return the pitch bend ranges that messages to sound modules set, by port, in the order of time."""
    return _by_port(tracks, ports, ("receive", "bend"), _port_ranges)


def _by_port(
    tracks: Sequence[Setups],
    ports: Iterable[Port],
    parameters: Collection[_Parameter],
    made_of: Callable[[Sequence[_Row]], list[_Made]],
) -> dict[Port, list[_Made]]:
    """Collect resets and the given part parameters by port, each list converted by ``made_of``. A port without a reset
    of its own takes the resets of other ports, since they belong to the same module.
    """
    rows: dict[Port | None, list[_Row]] = {}
    for place, track in enumerate(tracks):
        for setup in track.setups:
            if not isinstance(setup.value, bytes):
                continue
            for meaning in _meaning(setup.value):
                if isinstance(meaning, _PartValue) and meaning.parameter not in parameters:
                    continue
                port = _addressed(setup.port, track)
                if isinstance(meaning, _PartValue) and meaning.other_port:
                    number, device = port or FIRST_PORT
                    port = number ^ 1, device
                rank = 1 if isinstance(meaning, _PartValue) else 0
                rows.setdefault(port, []).append(_Row(setup.tick, rank, place, setup.number, meaning))
    first = {key: sorted(found, key=_order)[:_MOST_CHANGES] for key, found in rows.items()}
    resets = [row for found in first.values() for row in found if isinstance(row.meaning, _Reset)][:_MOST_CHANGES]
    made: dict[tuple[Port | None, ...], list[_Made]] = {}
    found = {}
    for port in ports:
        heard = tuple(one for one in _listening(port) if one in first)
        if heard not in made:
            own = [row for one in heard for row in first[one]]
            if not any(isinstance(row.meaning, _Reset) for row in own):
                own += resets
            made[heard] = made_of(sorted(own, key=_order)[:_MOST_CHANGES])
        found[port] = made[heard]
    return found


def _port_ranges(rows: Sequence[_Row]) -> list[ModuleRange]:
    """Bend ranges for the channels of one port: a reset applies to all channels, a range to the channel on which its
    part receives.
    """
    receive = list(range(16))
    found = []
    for row in rows:
        meaning = row.meaning
        if isinstance(meaning, _Reset):
            receive = list(range(16))
            found.append(ModuleRange(row.tick, None, USUAL_SEMITONES))
        elif meaning.parameter == "receive":
            if meaning.value < 32:
                receive[meaning.part] = meaning.value if meaning.value < 16 else -1
        elif receive[meaning.part] >= 0 and abs(meaning.value - _CENTRE) <= _MOST_BENT:
            found.append(ModuleRange(row.tick, receive[meaning.part], meaning.value - _CENTRE))
    return found


def _order(row: _Row) -> tuple[int, int, int, int]:
    return row[:4]


def _port_modes(rows: Sequence[_Row]) -> list[list[SoundChange]]:
    """Mode changes for the channels of one port: a reset applies to all channels, a mode to the channel on which its
    part receives.
    """
    steps: list[list[SoundChange]] = [[] for _ in range(16)]
    modes: dict[int, bool] = {}
    receive = list(range(16))
    both = {"gs", "xg"} <= {row.meaning.system for row in rows if isinstance(row.meaning, _Reset)}
    for tick, rank, track, number, meaning in rows:
        if isinstance(meaning, _Reset):
            modes, receive = {}, list(range(16))
            system = "" if both and meaning.system in ("gs", "xg") else meaning.system
            for own in steps:
                own.append(SoundChange(tick, rank, track, number, "reset", system))
            continue
        before = receive[meaning.part]
        if meaning.parameter == "mode":
            modes[meaning.part] = meaning.value > 0
        elif meaning.value < 32:
            receive[meaning.part] = meaning.value if meaning.value < 16 else -1
        for channel in {before, receive[meaning.part]} - {-1}:
            steps[channel].append(
                SoundChange(tick, rank, track, number, "mode", _channel_mode(channel, modes, receive))
            )
    return steps


def _channel_mode(channel: int, modes: Mapping[int, bool], receive: Sequence[int]) -> bool | None:
    """Return whether the parts that receive on a channel are rhythm parts; None if no message says. Parts moved to the
    channel count before its own part; one melodic part makes it melodic.
    """
    moved = [part for part, own in enumerate(receive) if own == channel != part]
    if moved:
        return all(modes.get(part, part == DRUM_CHANNEL) for part in moved)
    return modes.get(channel) if receive[channel] == channel else None
