"""Mutators of bytes and of structured formats: their results are valid enough to be read further."""

from __future__ import annotations

import json
import random
import re
import struct
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from app.errors import AppError
from app.formats.fbx.decode import read_elements
from app.formats.fbx.encode import Element, Property
from tests.fuzz.harness.values import FLOATS, INTEGERS, NUMBER_TEXTS, TEXTS
from tests.support.encoded import encode_elements

MOST_BYTES: Final = 100_000
"""Greatest size in bytes of mutants of small seeds; the cost of larger files is tested separately."""

Mutator = Callable[[bytes, random.Random], bytes]

_NUMBER = re.compile(rb"[-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?")
_QUOTED = re.compile(rb"\"(?:[^\"\\\n]|\\.)*\"|'[^'\n]*'")


def mutated(seeds: Sequence[bytes], chance: random.Random, structured: Sequence[Mutator]) -> bytes:
    """A mutant of some seeds: one to a few mutations, half of them by the structure of the format."""
    data = chance.choice(seeds)
    for _ in range(chance.choice((1, 1, 1, 1, 2, 4))):
        if structured and chance.random() < 0.5:
            data = chance.choice(structured)(data, chance)
        elif chance.random() < 0.15:
            data = spliced(data, chance.choice(seeds), chance)
        else:
            data = chance.choice(BYTES)(data, chance)
    return data[: max(MOST_BYTES, max(map(len, seeds)))]


# Bytes


def flip(data: bytes, chance: random.Random) -> bytes:
    """Invert some bits."""
    if not data:
        return b"\0"
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 8, 40))):
        changed[_place(data, chance)] ^= 1 << chance.randrange(8)
    return bytes(changed)


def overwrite(data: bytes, chance: random.Random) -> bytes:
    """Overwrite a place by a number of one to eight bytes in either byte order."""
    width, order = chance.choice((1, 2, 3, 4, 8)), chance.choice(("little", "big"))
    number = chance.choice(INTEGERS) % (1 << 8 * width)
    place = _place(data, chance)
    return data[:place] + number.to_bytes(width, "little" if order == "little" else "big") + data[place + width :]


def overwrite_float(data: bytes, chance: random.Random) -> bytes:
    """A float32 or float64, finite or not."""
    value = chance.choice((*FLOATS, float("nan"), float("inf"), float("-inf")))
    try:
        packed = struct.pack(chance.choice(("<f", "<d", ">f", ">d")), value)
    except OverflowError:
        packed = struct.pack("<f", float("inf"))
    place = _place(data, chance) & ~3
    return data[:place] + packed + data[place + len(packed) :]


def cut(data: bytes, chance: random.Random) -> bytes:
    """Keep only the beginning."""
    return data[: _place(data, chance)]


def delete(data: bytes, chance: random.Random) -> bytes:
    """Remove a piece."""
    start, stop = _span(data, chance)
    return data[:start] + data[stop:]


def repeat(data: bytes, chance: random.Random) -> bytes:
    """Repeat a piece several times."""
    start, stop = _span(data, chance)
    times = chance.choice((2, 2, 3, 20, 500))
    return data[:stop] + data[start:stop] * min(times, MOST_BYTES // max(stop - start, 1)) + data[stop:]


def move(data: bytes, chance: random.Random) -> bytes:
    """Move a piece to another place."""
    start, stop = _span(data, chance)
    rest = data[:start] + data[stop:]
    place = _place(rest, chance)
    return rest[:place] + data[start:stop] + rest[place:]


def insert(data: bytes, chance: random.Random) -> bytes:
    """Insert some bytes."""
    place = _place(data, chance)
    more = chance.choice((bytes(chance.randrange(1, 40)), b"\xff" * chance.randrange(1, 9), chance.randbytes(8)))
    return data[:place] + more + data[place:]


def spliced(data: bytes, other: bytes, chance: random.Random) -> bytes:
    """Join the beginning of one file and the end of another."""
    return data[: _place(data, chance)] + other[_place(other, chance) :]


def _place(data: bytes, chance: random.Random) -> int:
    """Choose a place, half of the time in the head of the file, which has the greatest effect."""
    most = len(data) if chance.random() < 0.5 else min(len(data), 600)
    return chance.randrange(most) if most else 0


def _span(data: bytes, chance: random.Random) -> tuple[int, int]:
    start = _place(data, chance)
    return start, start + min(chance.choice((1, 4, 16, 100, 2000)), len(data) - start)


BYTES: Final[Sequence[Mutator]] = (flip, flip, overwrite, overwrite, overwrite_float, cut, delete, repeat, move, insert)


# Texts: TOML, INI, BVH, journals


def number_in_text(data: bytes, chance: random.Random) -> bytes:
    """Replace a number in a text."""
    return _replaced(_NUMBER, data, chance.choice(NUMBER_TEXTS).encode(), chance)


def text_in_text(data: bytes, chance: random.Random) -> bytes:
    """Replace a quoted string in a text."""
    return _replaced(_QUOTED, data, json.dumps(chance.choice(TEXTS), ensure_ascii=False).encode(), chance)


def kind_in_text(data: bytes, chance: random.Random) -> bytes:
    """Replace a value by one of another type: a list, a table, a Boolean, a date, deep nesting."""
    value = chance.choice(
        (b"[]", b"{}", b"true", b'""', b"1979-05-27T07:32:00Z", b"07:32:00", b"[[]]", b"0", b"[" * 3000 + b"]" * 3000)
    )
    return _replaced(chance.choice((_NUMBER, _QUOTED)), data, value, chance)


def lines(data: bytes, chance: random.Random) -> bytes:
    """Remove, duplicate, move or multiply a line."""
    rows = data.splitlines(keepends=True)
    if not rows:
        return data
    row = rows.pop(chance.randrange(len(rows)))
    for _ in range(chance.choice((0, 1, 2, 1000 if len(row) < 80 else 2))):
        rows.insert(chance.randint(0, len(rows)), row)
    return b"".join(rows)


def _replaced(pattern: re.Pattern[bytes], data: bytes, value: bytes, chance: random.Random) -> bytes:
    found = list(pattern.finditer(data[:MOST_BYTES]))
    if not found:
        return data
    match = chance.choice(found)
    return data[: match.start()] + value + data[match.end() :]


TEXT: Final[Sequence[Mutator]] = (number_in_text, number_in_text, text_in_text, kind_in_text, lines)


# JSON


def json_value(data: bytes, chance: random.Random) -> bytes:
    """Change, remove, rename, repeat or nest a member of a JSON document."""
    try:
        document = changed_value(json.loads(data), chance)
        return json.dumps(document, ensure_ascii=chance.random() < 0.5).encode("utf-8", "surrogatepass")
    except (ValueError, RecursionError):
        return data


def changed_value(document: Any, chance: random.Random) -> Any:
    """Change one to three places of the document in place and return it."""
    box = [document]
    for _ in range(chance.choice((1, 1, 1, 2))):
        # Every place is as likely as any other, so most are deep in the lists.
        if chance.random() < 0.5:
            owner, key = _walk(box, chance)
        else:
            owner, key = chance.choice(list(_places(box)))
        _change(owner, key, chance, box)
    return box[0]


def _walk(document: Any, chance: random.Random) -> tuple[Any, Any]:
    """A place that is found by going down at random: the top of a document is reached as often as its depths."""
    owner, key = document, 0
    while isinstance(owner[key], dict | list) and owner[key] and chance.random() < 0.85:
        owner = owner[key]
        key = chance.choice(list(owner)) if isinstance(owner, dict) else chance.randrange(len(owner))
    return owner, key


def _places(document: Any) -> list[tuple[Any, Any]]:
    found, ahead = [], [document]
    while ahead and len(found) < 20_000:
        owner = ahead.pop()
        for key in owner if isinstance(owner, dict) else range(len(owner)):
            found.append((owner, key))
            if isinstance(owner[key], dict | list):
                ahead.append(owner[key])
    return found


def _change(owner: Any, key: Any, chance: random.Random, box: list[Any]) -> None:
    value = owner[key]
    how = chance.random()
    if how < 0.45 and isinstance(value, int | float) and not isinstance(value, bool):
        near = (value + 1, value - 1, -value, value * 2, value * 1000)
        owner[key] = chance.choice((*INTEGERS, *FLOATS, *near, float("nan"), float("inf")))
    elif how < 0.45 and isinstance(value, str):
        owner[key] = chance.choice((*TEXTS, value + chance.choice(TEXTS), "\ud800"))
    elif how < 0.6:
        other, place = chance.choice(_places(box))
        owner[key] = json.loads(json.dumps(other[place])) if other is not box else value
    elif how < 0.75 and owner is not box:
        del owner[key]
    elif how < 0.85 and isinstance(value, list) and value:
        owner[key] = value * chance.choice((2, 3, 50))
    elif how < 0.9 and isinstance(owner, dict):
        owner[chance.choice(TEXTS) if chance.random() < 0.5 else f"{key}x"] = owner.pop(key)
    elif how < 0.92:
        nested: Any = value
        for _ in range(chance.choice((2, 50, 600))):
            nested = [nested]
        owner[key] = nested
    else:
        owner[key] = chance.choice((None, True, False, [], {}, 0, "", -1, 10**25, [[]], {"a": 1}))


JSON: Final[Sequence[Mutator]] = (json_value, json_value, json_value, number_in_text)


# MIDI


def midi_events(data: bytes, chance: random.Random) -> bytes:
    """Tracks taken apart into events; some are changed, repeated, moved, or hostile ones put between."""
    chunks = _midi_chunks(data)
    if not chunks:
        return data
    header, tracks = chunks
    how = chance.random()
    if how < 0.12:
        header = struct.pack(
            ">HHH", chance.choice((0, 1, 2, 3)), chance.choice((0, 1, len(tracks), 65535)), chance.choice(_DIVISIONS)
        )
    elif how < 0.2 and len(tracks) < 300:
        tracks = tracks * chance.choice((2, 3, 16))
    elif tracks:
        place = chance.randrange(len(tracks))
        tracks[place] = _changed_events(tracks[place], chance)
    chunk_list = [b"MThd" + struct.pack(">I", len(header)) + header]
    for track in tracks:
        body = b"".join(_length(delta) + event for delta, event in track)
        chunk_list.append(b"MTrk" + struct.pack(">I", len(body)) + body)
    return b"".join(chunk_list)


_DIVISIONS = (0, 1, 2, 24, 96, 480, 32767, 0x8001, 0xE728, 0xE250, 0xE800, 0xFFFF)
_TEMPI = (0, 1, 9, 100, 1000, 9_999, 10_000, 500_000, 2**24 - 1)
_DELTAS = (0, 1, 2, 100, 480, 10_000, 10**6, 2**21, 2**28 - 1)


def _hostile_event(chance: random.Random) -> bytes:
    channel, pitch = chance.choice((0, 1, 9, 15)), chance.choice((0, 1, 36, 60, 61, 72, 126, 127))
    text = chance.choice(TEXTS)[:2000].encode("utf-8", "surrogatepass")
    return chance.choice(
        (
            bytes((0x90 | channel, pitch, chance.choice((0, 1, 64, 127)))),
            bytes((0x80 | channel, pitch, 0)),
            bytes((0xC0 | channel, chance.choice((0, 56, 57, 60, 73, 127)))),
            bytes(
                (0xB0 | channel, chance.choice((0, 1, 2, 7, 11, 64, 120, 121, 123, 127)), chance.choice((0, 64, 127)))
            ),
            bytes((0xE0 | channel, chance.choice((0, 127)), chance.choice((0, 64, 127)))),
            b"\xff\x51\x03" + chance.choice(_TEMPI).to_bytes(3, "big"),
            b"\xff\x58\x04"
            + bytes((chance.choice((0, 1, 3, 4, 127, 255)), chance.choice((0, 2, 6, 7, 31, 255)), 24, 8)),
            b"\xff\x59\x02" + bytes((chance.choice((0, 7, 249, 128)), chance.choice((0, 1, 9)))),
            b"\xff" + bytes((chance.choice((1, 3, 4, 6, 7, 0x20, 0x21, 0x54, 0x7F)),)) + _length(len(text)) + text,
            b"\xff\x2f\x00",
            b"\xf0" + _length(4) + b"abc\xf7",
        )
    )


def _changed_events(events: list[tuple[int, bytes]], chance: random.Random) -> list[tuple[int, bytes]]:
    events = list(events)
    how = chance.choice(("insert", "insert", "delta", "delete", "repeat", "stack", "offs", "move"))
    at = chance.randrange(len(events) + 1)
    if how == "insert":
        for _ in range(chance.choice((1, 1, 5, 60))):
            events.insert(at, (chance.choice((0, 0, 1, 10, 480)), _hostile_event(chance)))
    elif how == "delta" and events:
        at = min(at, len(events) - 1)
        events[at] = chance.choice(_DELTAS), events[at][1]
    elif how == "delete" and events:
        del events[at : at + chance.choice((1, 2, 10))]
    elif how == "repeat" and events:
        piece = events[at : at + chance.choice((1, 4, 50))]
        events[at:at] = piece * min(chance.choice((2, 10, 400)), 8000 // max(len(piece), 1))
    elif how == "stack":
        # Many notes at once, or never ended.
        pitch, spread = chance.randrange(128), chance.choice((0, 1, 1, 7))
        events[at:at] = [
            (chance.choice((0, 0, 1)), bytes((0x90, (pitch + spread * number) % 128, 80)))
            for number in range(chance.choice((5, 60, 1500)))
        ]
    elif how == "offs":
        offs = [place for place, (_, event) in enumerate(events) if event[0] >> 4 == 8]
        lost = set(chance.sample(offs, min(len(offs), chance.choice((1, 10, 53)))))
        events = [event for place, event in enumerate(events) if place not in lost]
    elif how == "move" and events:
        events.insert(chance.randrange(len(events)), events.pop(min(at, len(events) - 1)))
    return events


def _midi_chunks(data: bytes) -> tuple[bytes, list[list[tuple[int, bytes]]]] | None:
    if data[:4] != b"MThd" or len(data) < 14:
        return None
    at = 8 + int.from_bytes(data[4:8], "big")
    tracks = []
    while data[at : at + 4] == b"MTrk":
        size = int.from_bytes(data[at + 4 : at + 8], "big")
        tracks.append(_midi_events(data[at + 8 : at + 8 + size]))
        at += 8 + size
    return (data[8:14], tracks) if tracks else None


def _midi_events(data: bytes) -> list[tuple[int, bytes]]:
    """Return the events of a track that mutations can move or remove, with their delta times; running status is written
    out."""
    events: list[tuple[int, bytes]] = []
    at, status = 0, 0
    while at < len(data):
        delta, at = _number(data, at)
        if at >= len(data):
            break
        if data[at] == 0xFF or data[at] in (0xF0, 0xF7):
            start = at
            size, body = _number(data, at + (2 if data[at] == 0xFF else 1))
            at = body + size
            events.append((delta, data[start:at]))
            continue
        if data[at] & 0x80:
            status, at = data[at], at + 1
        if status < 0x80 or status >= 0xF0:
            break
        size = 1 if status >> 4 in (0xC, 0xD) else 2
        events.append((delta, bytes((status,)) + data[at : at + size]))
        at += size
    return events


def _number(data: bytes, at: int) -> tuple[int, int]:
    value = 0
    while at < len(data):
        value, at = value << 7 | data[at] & 0x7F, at + 1
        if not data[at - 1] & 0x80:
            break
    return value, at


def _length(value: int) -> bytes:
    value = min(value, 2**28 - 1)
    found = [value & 0x7F]
    while value := value >> 7:
        found.append(value & 0x7F | 0x80)
    return bytes(reversed(found))


MIDI: Final[Sequence[Mutator]] = (midi_events,)


# glTF binaries


def glb_document(data: bytes, chance: random.Random) -> bytes:
    """The JSON chunk with a member changed, its lengths right."""
    if data[:4] != b"glTF" or len(data) < 20:
        return json_value(data, chance)
    size = int.from_bytes(data[12:16], "little")
    document = json_value(data[20 : 20 + size], chance)
    document += b" " * (-len(document) % 4)
    rest = data[20 + size :]
    total = 20 + len(document) + len(rest)
    return b"glTF" + struct.pack("<II", 2, total) + struct.pack("<II", len(document), 0x4E4F534A) + document + rest


GLB: Final[Sequence[Mutator]] = (glb_document,)


# FBX binaries


def fbx_elements(data: bytes, chance: random.Random) -> bytes:
    """An element of the tree missing, twice, renamed, or with another value, its offsets right."""
    try:
        root = read_elements(data, "mutant")
        return encode_elements(_changed_element(root, chance).children or ())
    except (AppError, ValueError, TypeError, OverflowError, struct.error):
        return data


def _changed_element(element: Element, chance: random.Random) -> Element:
    children = list(element.children or ())
    if children and (not element.properties or chance.random() < 0.8):
        at, how = chance.randrange(len(children)), chance.random()
        if how < 0.08:
            del children[at]
        elif how < 0.14:
            children.insert(at, children[at])
        else:
            children[at] = _changed_element(children[at], chance)
        return Element(element.name, element.properties, tuple(children))
    properties = list(element.properties)
    if not properties:
        properties.append(chance.choice((np.int32(0), np.int64(1), "x", 1.0, np.zeros(3))))
    else:
        at = chance.randrange(len(properties))
        properties[at] = _changed_property(properties[at], chance)
    return Element(element.name, tuple(properties), element.children)


def _changed_property(value: Property, chance: random.Random) -> Property:
    if isinstance(value, np.ndarray) and len(value) and chance.random() < 0.7:
        array = value.copy()
        array[chance.randrange(len(array))] = _of_type(array.dtype, chance)
        return array
    if isinstance(value, np.ndarray):
        return value[: chance.randrange(len(value) + 1)] if chance.random() < 0.5 else np.concatenate([value, value])
    if isinstance(value, np.integer):
        return _of_type(value.dtype, chance)
    if isinstance(value, bool):
        return not value
    if isinstance(value, float | np.floating):
        return chance.choice((*FLOATS, float("nan"), float("inf")))
    return chance.choice(TEXTS)


def _of_type(dtype: np.dtype[Any], chance: random.Random) -> Any:
    """An extreme number that an array of this type can hold."""
    if dtype.kind == "f":
        return dtype.type(chance.choice((*FLOATS[:7], float("nan"), float("inf"))))
    if dtype.kind == "b":
        return np.True_
    info = np.iinfo(dtype)
    return dtype.type(min(max(chance.choice(INTEGERS), int(info.min)), int(info.max)))


FBX: Final[Sequence[Mutator]] = (fbx_elements,)
