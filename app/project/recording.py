"""The recording that plays with a piece, and its alignment."""

from __future__ import annotations

from collections.abc import Callable

import msgspec


class BeatPin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A beat placed by hand at its time in the recording, which following the recording again does not move.

    Attributes
    ----------
    tick : int
        Tick of the beat.
    recording_s : float
        Time from the recording's first sample.
    """

    tick: int
    recording_s: float


class Doubt(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A bar whose time in the recording is uncertain after following.

    Attributes
    ----------
    start_tick, end_tick : int
        The bar; the end is excluded.
    confidence : float
        0..1; 0 if the recording lacks the bar.
    """

    start_tick: int
    end_tick: int
    confidence: float


class AudioTrack(msgspec.Struct, frozen=True):
    """The recording that plays with the piece.

    Attributes
    ----------
    path : str
        Absolute path; project files store it relative to themselves.
    offset_s : float
        Performance time of the recording's first sample; score second 0 is tick 0.
    confidence : float or None
        Confidence 0..1 of an estimated offset; None if set by hand.
    pins : tuple of BeatPin
        Pinned beats, ascending in ticks and seconds.
    doubts : tuple of Doubt
        Uncertain bars, in order without overlap.
    """

    path: str
    offset_s: float = 0.0
    confidence: float | None = None
    pins: tuple[BeatPin, ...] = ()
    doubts: tuple[Doubt, ...] = ()


def with_places(audio: AudioTrack, place: Callable[[int], int]) -> AudioTrack:
    """Return the recording after a change of ticks: pins move with the music; uncertain bars are dropped."""
    pins: list[BeatPin] = []
    for pin in audio.pins:
        tick = place(pin.tick)
        if tick >= 0 and (not pins or tick > pins[-1].tick):
            pins.append(BeatPin(tick, pin.recording_s))
    if not audio.pins and not audio.doubts:
        return audio
    return msgspec.structs.replace(audio, pins=tuple(pins), doubts=())
