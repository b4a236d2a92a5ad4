"""Small MIDI files with as much work as their size allows: the worst of each known cause."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Final

END: Final = b"\0\xff\x2f\0"
FASTEST: Final = b"\0\xff\x51\x03\0\x27\x10"
"""Tempo event of 10 ms per quarter, the fastest that the reader accepts."""
MOST_DELTA: Final = 0x0FFFFFFF


def variable_length(value: int) -> bytes:
    """A delta time as a file has it."""
    encoded = [value & 0x7F]
    while value := value >> 7:
        encoded.append(value & 0x7F | 0x80)
    return bytes(reversed(encoded))


def midi(*tracks: bytes, division: int = 480, format_: int = 1) -> bytes:
    """A file with these tracks."""
    header = struct.pack(">IHHH", 6, format_, min(len(tracks), 65535), division & 0xFFFF)
    return b"MThd" + header + b"".join(b"MTrk" + struct.pack(">I", len(track)) + track for track in tracks)


def note(pitch: int = 60, ticks: int = 480, delta: int = 0, channel: int = 0) -> bytes:
    """A note-on and its note-off."""
    on = variable_length(delta) + bytes([0x90 | channel, pitch, 80])
    return on + variable_length(ticks) + bytes([0x80 | channel, pitch, 0])


def metre(numerator: int, denominator_power: int, delta: int = 0) -> bytes:
    """A time signature."""
    return variable_length(delta) + bytes([0xFF, 0x58, 4, numerator, denominator_power, 24, 8])


def _repeated(piece: bytes, size: int, before: bytes = b"", after: bytes = b"") -> bytes:
    return before + piece * max((size - len(before) - len(after) - 30) // len(piece), 1) + after


def _hours(quarters: int, division: int, *more: bytes) -> bytes:
    return midi(b"".join(more) + FASTEST + note() + note(delta=quarters * division) + END, division=division)


def _stack(size: int, pitches: int, step: int, spread: int = 1) -> bytes:
    """Note-ons one after another, none of which ends before the last has begun."""
    count = max((size - 40) // 3, 1)
    ons = b"".join(bytes([step, 36 + index * spread % pitches, 80]) for index in range(count))
    return midi(b"\0\x90\x3c\x50" + ons + b"\x60\xb0\x7b\0" + END, division=96)


def _chords(size: int, width: int) -> bytes:
    """Chords one after another, each note with its end."""
    chord = b"".join(bytes([0, 40 + 3 * index % 48, 80]) for index in range(width))
    ends = b"".join(bytes([48 if index == 0 else 0, 40 + 3 * index % 48, 0]) for index in range(width))
    return midi(_repeated(chord + ends, size, b"\0\x90\x3c\x50\x30\x3c\0") + END, division=96)


def _lines(size: int, width: int) -> bytes:
    """Notes that overlap their neighbours, so that always ``width`` sound and never begin together."""
    events = []
    for index in range(max((size - 40) // 6, 1)):
        events.append(bytes([4, 40 + 5 * index % 48, 80]))
        if index >= width:
            events.append(bytes([0, 40 + 5 * (index - width) % 48, 0]))
    return midi(b"\0\x90\x3c\x50\x30\x3c\0" + b"".join(events) + b"\x60\xb0\x7b\0" + END, division=96)


def _tracks(size: int) -> bytes:
    track = b"\0\x90\x40\x50\x60\x40\0" + END
    return midi(*[track] * max((size - 14) // (8 + len(track)), 1), division=96)


def _channels(size: int) -> bytes:
    """Sixteen parts a track, in as few bytes as may be."""
    events = b"".join(bytes([0, 0x90 | channel, 64, 80]) for channel in range(16))
    track = events + b"\x60\xff\x2f\0"
    return midi(*[track] * max((size - 14) // (8 + len(track)), 1), division=96)


def _everyone(size: int, quarter_us: int, quarters: int, *first: bytes, division: int = 96) -> bytes:
    """The greatest possible number of players, from the beginning to the end."""
    tempo = b"\0\xff\x51\x03" + quarter_us.to_bytes(3, "big")
    track = b"\0\x90\x40\x50\x60\x40\0" + note(64, 96, (quarters - 2) * division) + END
    count = max(min((size - 60) // (8 + len(track)), 128), 1)
    return midi(tempo + b"".join(first) + END, *[track] * count, division=division)


def _everyone_often(size: int) -> bytes:
    """Notes of all players at such distances that everything between them counts."""
    tempo = b"\0\xff\x51\x03" + (216_000).to_bytes(3, "big")
    count = max(size // 128 // 7, 1)
    notes = b"\0\x90\x40\x50\x30\x40\0" + b"".join(
        variable_length(199_000 * 96 // count) + b"\x40\x50\x30\x40\0" for _ in range(count - 1)
    )
    return midi(tempo + END, *[notes + END] * min(128, size // 60), division=96)


def _everyones_own(size: int) -> bytes:
    """Many players of all instruments for less than a minute: what is made for each of them costs most."""
    programs = (*range(56, 62), *range(64, 75))
    count = max(min(size // 40, 128), 1)
    rest = variable_length(96 * 95 // (notes := max(size // count // 7 - 4, 2)))
    later = (rest + b"\x40\x50\x30\x40\0") * (notes - 1)
    return midi(
        *(
            bytes([0, 0xC0, programs[index % len(programs)]]) + b"\0\x90\x40\x50\x30\x40\0" + later + END
            for index in range(count)
        ),
        division=96,
    )


COSTLY: Final[dict[str, Callable[[int], bytes]]] = {
    "hours at 10 ms a quarter": lambda size: _hours(4_300_000, 10),
    "hours of bars of 1/64": lambda size: _hours(4_300_000, 16, metre(1, 6)),
    "hours of one tick a quarter": lambda size: _hours(4_300_000, 1),
    "hours of 255/1": lambda size: _hours(4_300_000, 30, metre(255, 0)),
    "a note of hours": lambda size: midi(FASTEST + note(ticks=4_300_000 * 10) + END, division=10),
    "the end of the track in hours": lambda size: midi(
        FASTEST + note() + variable_length(MOST_DELTA) + END[1:], division=1
    ),
    "a hanging note and the end in hours": lambda size: midi(
        FASTEST + b"\0\x90\x3c\x50" + note(62) + variable_length(40_000_000) + END[1:], division=10
    ),
    "a marker in hours": lambda size: midi(
        FASTEST + note() + variable_length(MOST_DELTA) + b"\xff\x06\x01a" + END, division=1
    ),
    "a metre in hours": lambda size: midi(FASTEST + note() + metre(1, 6, MOST_DELTA) + END, division=1),
    "a tempo in hours": lambda size: midi(note() + variable_length(MOST_DELTA) + FASTEST[1:] + END, division=1),
    "a breath in hours": lambda size: midi(
        FASTEST + b"\0\xb0\x02\x40" + note() + variable_length(40_000_000) + b"\xb0\x02\x10" + END, division=10
    ),
    "a percussion note in hours": lambda size: midi(
        FASTEST + note() + END, b"\0\xff\x03\x04Drum" + note(36, delta=43_000_000, channel=9) + END, division=10
    ),
    "the first note in hours": lambda size: midi(FASTEST + note(delta=43_000_000) + END, division=10),
    "everyone for twelve hours": lambda size: _everyone(size, 1_000_000, 43_000),
    "everyone for twelve hours of 216 ms": lambda size: _everyone(size, 215_000, 199_000),
    "everyone for twelve hours of bars of 1/4": lambda size: _everyone(size, 215_000, 199_000, metre(1, 2)),
    "everyone for 200,000 quarters at 10 ms": lambda size: _everyone(size, 10_000, 199_000, metre(1, 2)),
    "everyone often for twelve hours": _everyone_often,
    "everyone on an instrument of their own for a minute": _everyones_own,
    "a rest of six seconds after every note": lambda size: midi(
        b"\0\x90\x3c\x50\x10\x3c\0" + b"\x89\x10\x3c\x50\x10\x3c\0" * min(size // 7, 7000) + END, division=96
    ),
    "notes seconds apart at 10 ms": lambda size: midi(
        _repeated(b"\x8d\x00\x3c\x50\x05\x3c\0", size, FASTEST + b"\0\x90\x3c\x50\x05\x3c\0") + END, division=2
    ),
    "ten hours of notes": lambda size: midi(
        b"".join(note(60, 5, 43_000_000 // (size // 12)) for _ in range(size // 12))
        and FASTEST + b"".join(note(60, 5, 43_000_000 // (size // 12)) for _ in range(size // 12)) + END,
        division=10,
    ),
    "lost note-offs, all pitches": lambda size: _stack(size, 84, 1, 5),
    "lost note-offs, one pitch": lambda size: _stack(size, 1, 1),
    "lost note-offs, 53 pitches at a time": lambda size: _stack(size, 53, 48, 7),
    "notes struck at once, all pitches": lambda size: _stack(size, 84, 0, 5),
    "notes struck at once, one pitch": lambda size: _stack(size, 1, 0),
    "chords of 3": lambda size: _chords(size, 3),
    "chords of 20": lambda size: _chords(size, 20),
    "chords of 48": lambda size: _chords(size, 48),
    "lines of 2": lambda size: _lines(size, 2),
    "lines of 12": lambda size: _lines(size, 12),
    "lines of 40": lambda size: _lines(size, 40),
    "tracks of one note": _tracks,
    "tracks of sixteen channels": _channels,
    "a line of short notes": lambda size: midi(
        _repeated(b"\x0c\x3c\x50\x0c\x3c\0", size, b"\0\x90\x3c\x50\x0c\x3c\0") + END, division=96
    ),
    "notes of one tick": lambda size: midi(
        _repeated(b"\0\x3c\x50\x01\x3c\0", size, b"\0\x90\x3c\x50\x01\x3c\0") + END, division=32767
    ),
    "notes of one tick at 10 ms": lambda size: midi(
        FASTEST + _repeated(b"\0\x3c\x50\x01\x3c\0", size, b"\0\x90\x3c\x50\x01\x3c\0") + END, division=1
    ),
    "metres": lambda size: midi(
        _repeated(metre(3, 2, 96) + metre(4, 2, 96), size) + END, note(ticks=96, delta=9600) + END, division=96
    ),
    "metres and bars": lambda size: midi(
        _repeated(metre(3, 2, 96) + metre(4, 2, 96), size) + note() + END, division=96
    ),
    "metres of 1/64 to the end": lambda size: midi(
        _repeated(metre(1, 6, 3) + metre(2, 6, 3), size) + note() + note(delta=500_000) + END, division=96
    ),
    "tempos": lambda size: midi(
        _repeated(b"\x10\xff\x51\x03\x07\xa1\x20\x10\xff\x51\x03\x0f\xa1\x20", size) + note() + END, division=96
    ),
    "markers": lambda size: midi(_repeated(b"\x01\xff\x06\x01a", size, note()) + note() + END, division=96),
    "markers at one place": lambda size: midi(
        b"".join(b"\0\xff\x06\x03" + f"{index % 1000:03}".encode() for index in range(size // 7)) + note() + END
    ),
    "breath": lambda size: midi(
        _repeated(b"\x01\x02\x40\x01\x02\x10", size, b"\0\xb0\x02\x40") + note() + END, division=96
    ),
    "breath under a long note": lambda size: midi(
        b"\0\x90\x3c\x50" + _repeated(b"\x08\x02\x40\x08\x02\x10", size, b"\0\xb0\x02\x40") + b"\0\x80\x3c\0" + END,
        division=96,
    ),
    "pitch bend": lambda size: midi(
        b"\0\x90\x3c\x50" + _repeated(b"\x04\x40\x20\x04\x20\x60", size, b"\0\xe0\0\x40") + b"\0\x80\x3c\0" + END,
        division=96,
    ),
    "programs": lambda size: midi(_repeated(b"\0\x12\0\x13", size, b"\0\xc0\x38") + note() + END),
    "a long name": lambda size: midi(b"\0\xff\x03" + variable_length(size) + b"a" * size + note() + END),
    "a long name of a wide script": lambda size: midi(
        b"\0\xff\x03" + variable_length(size // 3 * 3) + "楽".encode() * (size // 3) + note() + END
    ),
    "a long marker": lambda size: midi(b"\0\xff\x06" + variable_length(size) + b"a" * size + note() + END),
    "texts": lambda size: midi(_repeated(b"\0\xff\x01\x01a", size) + note() + END),
    "system exclusive": lambda size: midi(
        b"\0\xf0" + variable_length(size) + b"\x41" * (size - 1) + b"\xf7" + note() + END
    ),
    "system real time": lambda size: midi(_repeated(b"\0\xf8", size) + note() + END),
    "all notes off": lambda size: midi(_repeated(b"\0\x7b\0", size, b"\0\x90\x3c\x50\x10\xb0\x7b\0") + note() + END),
    "all pitches and all notes off": lambda size: midi(
        b"".join(bytes([0, 0x90 | channel, pitch, 80]) for channel in range(16) for pitch in range(128))[
            : size // 8 * 4
        ]
        + _repeated(b"\0\x7b\0", size // 2, b"\x10\xb0\x7b\0")
        + END
    ),
    "a header of 65535 tracks": lambda size: (
        b"MThd" + struct.pack(">IHHH", 6, 1, 65535, 96) + b"MTrk" + struct.pack(">I", 12) + note() + END
    ),
    "empty chunks": lambda size: midi(note() + END) + b"XFIH\0\0\0\0" * (size // 8),
    "empty tracks": lambda size: midi(note() + END, *[b""] * (size // 8)),
    "tracks that swallow the next": lambda size: (
        midi(note() + END) + b"".join(b"MTrk\0\x0f\xff\xff" for _ in range(size // 8))
    ),
    "patterns": lambda size: midi(*[note() + END] * (size // 20), format_=2),
}
"""Functions from a size in bytes to a file, by cause of the cost; files of fixed size ignore the size."""

_TRUMPET: Final = b"\0\xc0\x38"
_TWELVE_HOURS: Final = 12 * 2 * 3600 * 480 - 4000


def _turns(size: int) -> bytes:
    """One track that alternates between six instruments."""
    programs = (56, 57, 60, 71, 73, 68)
    turns = b"".join(bytes([0, 0xC0, program]) + note(70, 100, 20) for program in programs)
    return midi(_repeated(turns, size) + END)


STUCK: Final[dict[str, Callable[[int], bytes]]] = {
    "a note of twelve hours": lambda size: midi(_TRUMPET + note(ticks=_TWELVE_HOURS) + END),
    "four notes of twelve hours": lambda size: midi(*[_TRUMPET + note(ticks=_TWELVE_HOURS) + END] * 4),
    "a note of twelve hours and one at its end": lambda size: midi(
        _TRUMPET + note(ticks=_TWELVE_HOURS) + note() + END, _TRUMPET + note() + note(delta=_TWELVE_HOURS) + END
    ),
    "two notes twelve hours apart": lambda size: midi(_TRUMPET + note() + note(delta=_TWELVE_HOURS) + END),
    "players of two notes twelve hours apart": lambda size: midi(
        *[_TRUMPET + note() + note(delta=_TWELVE_HOURS) + END] * min(max(size // 36, 1), 128)
    ),
    "notes of twelve hours": lambda size: midi(
        _TRUMPET + b"".join(note(60, 400, _TWELVE_HOURS // (size // 10) - 400) for _ in range(size // 10)) + END
    ),
    "instruments by turns": _turns,
}
"""Functions that make files whose report costs more than reading them."""

WORST: Final = {
    "everyone often for twelve hours": 40_000,
    "lost note-offs, all pitches": 30_000,
    "lines of 40": 30_000,
    "tracks of sixteen channels": 100_000,
    "patterns": 100_000,
}
"""Sizes in bytes of files that are large in every run."""
