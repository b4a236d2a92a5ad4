"""Small sound files that stand for far more samples than they have bytes, written byte by byte."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Final

_LARGEST_BLOCK: Final = 65_535
_OPUS_HZ: Final = 48_000
_OPUS_PACKET_S: Final = 0.12
_MOST_IN_PAGE: Final = 255
_NOTHING: Final = b"\x1b\x02"
"""A packet of Opus with two silent frames of 60 ms (RFC 6716, section 3)."""


# FLAC. Source: RFC 9639, sections 8.2 and 9.


def flac(size: int, rate_hz: int = 48_000, channels: int = 1, block: int = _LARGEST_BLOCK, loud: bool = False) -> bytes:
    """Blocks of one value each: silence, or steps from each to the next.

    Parameters
    ----------
    size : int
        Bytes, about.
    block : int
        Samples of a block.
    """
    frames, length, count = [], 42, 0
    while length < size:
        head = (
            b"\xff\xf8\x70" + bytes([(channels - 1) << 4 | 0x08]) + chr(count).encode() + struct.pack(">H", block - 1)
        )
        head += bytes([_crc(head, 8, 0x07)])
        value = count * 7919 % 60_000 - 30_000 if loud else 0
        head += (b"\0" + struct.pack(">h", value)) * channels
        frames.append(head + struct.pack(">H", _crc(head, 16, 0x8005)))
        length += len(frames[-1])
        count += 1
    said = struct.pack(">Q", rate_hz << 44 | (channels - 1) << 41 | 15 << 36 | count * block)
    return b"fLaC\x80\0\0\x22" + struct.pack(">HH", block, block) + bytes(6) + said + bytes(16) + b"".join(frames)


def flac_silence(size: int) -> bytes:
    """Silence, 15 bytes for 65,535 samples."""
    return flac(size)


def flac_slow_silence(size: int) -> bytes:
    """Silence at 8 kHz, six times as long."""
    return flac(size, 8_000)


def flac_fast_silence(size: int) -> bytes:
    """Silence of many samples in each second."""
    return flac(size, 655_350)


def flac_wide_silence(size: int) -> bytes:
    """Silence of eight channels."""
    return flac(size, 192_000, 8)


def flac_steps(size: int) -> bytes:
    """The greatest number of steps for these bytes and this duration."""
    seconds = 550.0 + size / 600
    return flac(size, block=min(int(seconds * 48_000 / (size / 15)), _LARGEST_BLOCK), loud=True)


def _crc(data: bytes, bits: int, polynomial: int) -> int:
    value, top = 0, 1 << (bits - 1)
    for byte in data:
        value ^= byte << (bits - 8)
        for _ in range(8):
            value = ((value << 1) ^ (polynomial if value & top else 0)) & (2 * top - 1)
    return value


# Ogg Opus. Sources: RFC 3533, section 6; RFC 7845, sections 3 and 5.


def _page(serial: int, number: int, position: int, flags: int, packets: Sequence[bytes]) -> bytes:
    lacing = b"".join(bytes([255] * (len(packet) // 255) + [len(packet) % 255]) for packet in packets)
    head = struct.pack("<4sBBQIII", b"OggS", 0, flags, position, serial, number, 0)
    page = head + bytes([len(lacing)]) + lacing + b"".join(packets)
    return page[:22] + struct.pack("<I", _crc(page, 32, 0x04C11DB7)) + page[26:]


def opus_silence(seconds: float, serial: int = 1) -> bytes:
    """Silence of which nothing is sent: 25 bytes for a second."""
    packets = [_NOTHING] * max(round(seconds / _OPUS_PACKET_S), 1)
    head = b"OpusHead" + struct.pack("<BBHIhB", 1, 1, 0, _OPUS_HZ, 0, 0)
    pages = [_page(serial, 0, 0, 2, [head]), _page(serial, 1, 0, 0, [b"OpusTags" + bytes(8)])]
    done = 0
    while done < len(packets):
        some = packets[done : done + _MOST_IN_PAGE]
        done += len(some)
        position = round(done * _OPUS_PACKET_S * _OPUS_HZ)
        pages.append(_page(serial, len(pages), position, 4 if done == len(packets) else 0, some))
    return b"".join(pages)


def opus_hours(size: int) -> bytes:
    """Silence of which nothing is sent."""
    return opus_silence(size / 26)


def opus_chain(size: int) -> bytes:
    """One stream after another of a packet each."""
    one = len(opus_silence(0.1))
    return b"".join(opus_silence(0.1, serial) for serial in range(max(size // one, 1)))


# WAV


def wav_hours(size: int) -> bytes:
    """A file that says it is hours long, and ends."""
    head = b"WAVEfmt " + struct.pack("<IHHIIHH", 16, 1, 1, 1000, 1000, 1, 8)
    return b"RIFF" + struct.pack("<I", 2**32 - 1) + head + b"data" + struct.pack("<I", 2**32 - 16) + b"\x80" * size


COSTLY_SOUND: Final[tuple[Callable[[int], bytes], ...]] = (
    *(flac_silence, flac_slow_silence, flac_fast_silence, flac_wide_silence, flac_steps),
    *(opus_hours, opus_chain, wav_hours),
)
"""Costly files of the kind "audio"."""
