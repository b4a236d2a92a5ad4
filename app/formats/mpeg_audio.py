"""Length and codec delay of MPEG audio files (MP1, MP2, MP3) without a header, found by counting frames.

A header is a first frame without sound, written by the encoders of Xing, LAME and Fraunhofer: it contains the number of
frames and usually the samples to remove at the start.

Sources: ISO/IEC 11172-3, 2.4.1.3 and 2.4.2.3, and 13818-3 for the lower rates; the header of Xing and LAME as described
at gabriel.mp3-tech.org/mp3infotag.html.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from mmap import mmap
from typing import Final

from app.formats.media_kind import tag_bytes

_RATES_HZ: Final = (44100, 48000, 32000)
_KBITS: Final = {
    (1, 1): (32, 64, 96, 128, 160, 192, 224, 256, 288, 320, 352, 384, 416, 448),
    (1, 2): (32, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 384),
    (1, 3): (32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320),
    (2, 1): (32, 48, 56, 64, 80, 96, 112, 128, 144, 160, 176, 192, 224, 256),
    (2, 2): (8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160),
    (2, 3): (8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160),
}
"""Bit rates in kbit/s by version (1, or 2 and 2.5) and layer, from index 1."""
_CONTENTS: Final = (b"Xing", b"Info", b"VBRI")
"""Marks of headers with the number of frames."""
_LAYER_III_SAMPLES: Final = 1105
"""Delay of encoder and decoder in samples: LAME's 576 and 529. Encoders like the standard's example have 528 instead of
576, Fraunhofer's about 50 samples more: a difference of at most 1.2 ms.
"""
_OTHER_SAMPLES: Final = 481
"""Delay in samples of the filter banks of encoder and decoder in layers I and II."""
_RESYNC: Final = 1 << 16
"""Greatest number of unrelated bytes between two frames."""


@dataclass(frozen=True)
class MpegAudio:
    """Facts read from the frames of a file.

    Attributes
    ----------
    rate_hz : int
        Samples per second.
    samples : int
        Samples per channel in all complete frames.
    breaks_off : bool
        Whether the last frame is incomplete.
    delay_samples : int
        Delay of the sound by encoder and decoder. With a header, decoders remove it.
    """

    rate_hz: int
    samples: int
    breaks_off: bool
    delay_samples: int


@dataclass(frozen=True)
class _Frame:
    key: int
    """Version, layer and rate, which are equal in all frames of a file."""
    layer: int
    rate_hz: int
    length: int
    samples: int


def mpeg_audio(data: bytes | mmap) -> MpegAudio | None:
    """Count the frames of a file without a header; None if it has one, or no consecutive frames."""
    found = _frames(data)
    at, first = next(found, (0, None))
    if first is None or at != tag_bytes(data[:10]) or _frame(data, at + first.length) is None:
        return None
    if any(name in data[at : at + first.length] for name in _CONTENTS):
        return None
    samples, breaks_off = first.samples, False
    for at, frame in found:
        breaks_off = at + frame.length > len(data)
        samples += 0 if breaks_off else frame.samples
    delay = _LAYER_III_SAMPLES if first.layer == 3 else _OTHER_SAMPLES
    return MpegAudio(first.rate_hz, samples, breaks_off, delay)


def _frames(data: bytes | mmap) -> Iterator[tuple[int, _Frame]]:
    at, key = tag_bytes(data[:10]), None
    while at + 4 <= len(data):
        frame = _frame(data, at)
        if frame is not None and key in (None, frame.key):
            key = frame.key
            yield at, frame
            at += frame.length
            continue
        found = _resumed(data, at, key)
        if found is None:
            return
        at = found


def _resumed(data: bytes | mmap, at: int, key: int | None) -> int | None:
    """Return the next offset after ``at`` at which two consecutive frames are found, of the kind ``key`` if given; None
    if there are none nearby.
    """
    end = min(at + _RESYNC, len(data) - 4)
    at = data.find(b"\xff", at + 1, end)
    while at >= 0:
        frame = _frame(data, at)
        if frame is not None and key in (None, frame.key):
            following = _frame(data, at + frame.length)
            if following is not None and following.key == frame.key:
                return at
        at = data.find(b"\xff", at + 1, end)
    return None


def _frame(data: bytes | mmap, at: int) -> _Frame | None:
    """Parse the frame header at an offset; None if there is none."""
    head = data[at : at + 4]
    if len(head) < 4 or head[0] != 0xFF or head[1] & 0xE0 != 0xE0:
        return None
    version, layer = head[1] >> 3 & 3, 4 - (head[1] >> 1 & 3)
    kbits, rate = head[2] >> 4, head[2] >> 2 & 3
    if version == 1 or layer == 4 or kbits in (0, 15) or rate == 3:
        return None
    rate_hz = _RATES_HZ[rate] >> {3: 0, 2: 1, 0: 2}[version]
    bits_per_s = 1000 * _KBITS[1 if version == 3 else 2, layer][kbits - 1]
    padding = head[2] >> 1 & 1
    samples = 384 if layer == 1 else 1152 if layer == 2 or version == 3 else 576
    slots = (12 if layer == 1 else samples // 8) * bits_per_s // rate_hz + padding
    length = 4 * slots if layer == 1 else slots
    return _Frame(version << 4 | layer << 2 | rate, layer, rate_hz, length, samples)
