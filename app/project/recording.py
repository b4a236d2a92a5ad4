"""The recording that plays with a piece, and how the piece lies on it."""

from __future__ import annotations

from collections.abc import Callable

import msgspec


class BeatPin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A beat that was put by hand where it sounds; following the recording again keeps it there.

    Attributes
    ----------
    tick : int
    recording_s : float
        From the recording's first sample.
    """

    tick: int
    recording_s: float


class Doubt(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A bar that may lie elsewhere in the recording than where following put it.

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
        Absolute, as this machine knows it; a project's file keeps it relative to itself.
    offset_s : float
        Performance time (score second 0 is tick 0) at which the recording's first sample sounds.
    confidence : float or None
        0..1 of an estimated offset; None: set by hand.
    pins : tuple of BeatPin
        Ticks and seconds rise.
    doubts : tuple of Doubt
        In order and apart; what following the recording was not sure of.
    """

    path: str
    offset_s: float = 0.0
    confidence: float | None = None
    pins: tuple[BeatPin, ...] = ()
    doubts: tuple[Doubt, ...] = ()


def with_places(audio: AudioTrack, place: Callable[[int], int]) -> AudioTrack:
    """The recording of a score whose ticks have changed: pins move along; doubtful bars have to be found again."""
    pins: list[BeatPin] = []
    for pin in audio.pins:
        tick = place(pin.tick)
        if tick >= 0 and (not pins or tick > pins[-1].tick):
            pins.append(BeatPin(tick, pin.recording_s))
    if not audio.pins and not audio.doubts:
        return audio
    return msgspec.structs.replace(audio, pins=tuple(pins), doubts=())
