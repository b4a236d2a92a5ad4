"""The recording that plays with a piece, and its alignment."""

from __future__ import annotations

from collections.abc import Callable

import msgspec


class BeatPin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A beat placed by hand at its time in the recording; following the recording again keeps it.

    Attributes
    ----------
    tick : int
    recording_s : float
        From the recording's first sample.
    """

    tick: int
    recording_s: float


class Doubt(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A bar whose place in the recording is uncertain after following.

    Attributes
    ----------
    start_tick, end_tick : int
        Half-open.
    confidence : float
        0..1; 0: the recording does not have the bar.
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
        Confidence 0..1 of an estimated offset; None: set by hand.
    pins : tuple of BeatPin
        Ticks and seconds rise.
    doubts : tuple of Doubt
        Uncertain bars, in order without overlap.
    """

    path: str
    offset_s: float = 0.0
    confidence: float | None = None
    pins: tuple[BeatPin, ...] = ()
    doubts: tuple[Doubt, ...] = ()


def with_places(audio: AudioTrack, place: Callable[[int], int]) -> AudioTrack:
    """The recording after a change of ticks: pins move along; uncertain bars are dropped."""
    pins: list[BeatPin] = []
    for pin in audio.pins:
        tick = place(pin.tick)
        if tick >= 0 and (not pins or tick > pins[-1].tick):
            pins.append(BeatPin(tick, pin.recording_s))
    if not audio.pins and not audio.doubts:
        return audio
    return msgspec.structs.replace(audio, pins=tuple(pins), doubts=())
