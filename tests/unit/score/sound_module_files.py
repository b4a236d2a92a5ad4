"""MIDI files for sound modules, as Japanese and other programs of the nineties and after write them, byte by byte.

Every message and every table is written here a second time, from the manuals: Roland SC-55, SC-88 and SC-88Pro (GS),
Yamaha MU80 and MU100 (XG), MMA RP-024 (General MIDI 2). The reader is not used.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from random import Random

QUARTER = 480
BAR = 4 * QUARTER

# General MIDI's winds: program, instrument in the vocabulary, lowest and highest note written here.
WINDS = {
    56: ("trumpet", 60, 77), 57: ("trombone", 45, 62), 58: ("tuba", 34, 50), 60: ("horn", 50, 67),
    65: ("alto_saxophone", 55, 74), 66: ("tenor_saxophone", 50, 69), 68: ("oboe", 62, 81), 70: ("bassoon", 40, 60),
    71: ("clarinet", 55, 80), 73: ("flute", 64, 88),
}  # fmt: skip
KITS = {
    "gm": (0,),
    "gs": (0, 8, 16, 24, 25, 26, 32, 40, 48),
    "xg": (0, 1, 8, 16, 24, 25, 32, 40, 48, 56),
    "gm2": (0, 8, 16, 24, 25, 32, 40, 48),
}
# Notes of kits with another sound number than in the standard kit of General MIDI 2: note, number.
DIFFERENT = {
    ("xg", 0): ((25, 38), (28, 38), (31, 38), (33, 35), (13, 86), (22, 34), (30, 85)),
    ("gs", 0): ((25, 38), (26, 39)),
    ("gs", 48): ((27, 42), (29, 46), (30, 51), (41, 41), (53, 43), (39, 85)),
    ("gm2", 48): ((28, 44), (45, 41), (50, 43)),
}
NAMES = ("", "", "Track 5", "MIDI 03", "トラック 4", "パート2", "----", "Ch.11")
DRUM_NAMES = ("", "", "ドラム", "Drums", "DR", "リズム", "Perc", "トラック 10")


@dataclass
class Part:
    """A melody, a drum part or effects, with notes as (tick, pitch)."""

    kind: str
    channel: int
    port: int
    setup: list[tuple[int, bytes]]
    program: int
    notes: list[tuple[int, int]]
    name: str
    heard: list[tuple[int, int]] = field(default_factory=list)
    """Hits of a drum part: (tick, sound number in General MIDI 2)."""


@dataclass
class ModuleFile:
    """A file and its content."""

    data: bytes
    melodies: list[tuple[str, list[tuple[int, int]]]]
    hits: list[tuple[int, int]]
    effects: int


def module_file(seed: int) -> ModuleFile:
    """Make one of the files, with the systems GS, XG, GM2 and General MIDI in turn."""
    random = Random(seed)
    system = ("gs", "xg", "gm2", "gm")[seed % 4]
    several_ports = system != "gm2" and random.random() < 0.25
    parts: list[Part] = []
    common: list[tuple[int, bytes, int]] = [(0, _reset(system, random), port) for port in range(1 + several_ports)]
    free = {(port, channel) for port in range(1 + several_ports) for channel in range(16) if channel != 9}
    if system == "gs" and random.random() < 0.2:
        common.append((0, _exclusive(b"\x7e\x7f\x09\x01"), 0))
        common.sort(key=lambda row: row[1][1] != 0x7E)

    def take() -> tuple[int, int]:
        chosen = random.choice(sorted(free))
        free.remove(chosen)
        return chosen

    tenth_melodic = random.random() < 0.35 and system != "gm"
    if tenth_melodic:
        parts.append(_melody(random, system, 0, 9, common))
    else:
        parts.append(_drums(random, system, 0, 9, common))
    if several_ports:
        parts.append(_drums(random, system, 1, 9, common))
    for _ in range(random.randint(1, 5)):
        parts.append(_melody(random, system, *take(), common))
    if system != "gm":
        for _ in range(random.randint(0 if not tenth_melodic else 1, 2)):
            parts.append(_drums(random, system, *take(), common))
        if random.random() < 0.5:
            parts.append(_effects(random, system, *take(), common))
        if random.random() < 0.3:
            parts += _turncoat(random, system, *take(), common)
    random.shuffle(parts)
    melodies = [(WINDS[part.program][0], part.notes) for part in parts if part.kind == "melody"]
    hits = sorted(hit for part in parts for hit in part.heard)
    effects = sum(part.kind == "effects" for part in parts)
    return ModuleFile(_file(random, parts, common, several_ports), melodies, hits, effects)


# --- what parts are made by -------------------------------------------------------------------------------------------


def _reset(system: str, random: Random) -> bytes:
    """Message that starts a system."""
    device = random.choice((0x10, 0x10, 0x10, 0x00, 0x1F, 0x7F))
    if system == "gs":
        mode = random.choice((b"\x40\x00\x7f\x00", b"\x40\x00\x7f\x00", b"\x00\x00\x7f\x01"))
        return _roland(device, mode)
    if system == "xg":
        return _exclusive(bytes([0x43, 0x10 | device & 15, 0x4C, 0, 0, 0x7E, 0]))
    return _exclusive(bytes([0x7E, 0x7F, 9, 3 if system == "gm2" else 1]))


def _roland(device: int, address_and_data: bytes) -> bytes:
    checksum = -sum(address_and_data) % 128
    return _exclusive(bytes([0x41, device, 0x42, 0x12]) + address_and_data + bytes([checksum]))


def _exclusive(message: bytes) -> bytes:
    return b"\xf0" + message + b"\xf7"


BLOCKS = (1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 10, 11, 12, 13, 14, 15)
"""Index in GS's table of blocks for each part."""


def _mode(system: str, channel: int, value: int, random: Random) -> bytes:
    if system == "gs":
        return _roland(random.choice((0x10, 0x7F)), bytes([0x40, 0x10 | BLOCKS[channel], 0x15, value]))
    return _exclusive(bytes([0x43, 0x10, 0x4C, 8, channel, 7, value]))


def _bank(channel: int, msb: int, lsb: int, program: int, at: int, random: Random) -> list[tuple[int, bytes]]:
    """Bank select and program change, some ticks apart as written by some programs."""
    apart = random.choice((0, 0, 1, 5))
    rows = [(at, bytes([0xB0 | channel, 0, msb])), (at + apart, bytes([0xB0 | channel, 32, lsb]))]
    if random.random() < 0.2:
        rows.reverse()
        rows = [(at, rows[0][1]), (at + apart, rows[1][1])]
    return [*rows, (at + 2 * apart, bytes([0xC0 | channel, program]))]


def _melody(random: Random, system: str, port: int, channel: int, common: list[tuple[int, bytes, int]]) -> Part:
    program = random.choice(sorted(WINDS))
    setup: list[tuple[int, bytes]] = []
    bank = {"gs": random.choice((0, 0, 1, 8, 16)), "xg": 0, "gm2": 121, "gm": 0}[system]
    if channel == 9 and (system == "gs" or (system == "xg" and random.random() < 0.4)):
        common.append((random.choice((0, 3)), _mode(system, channel, 0, random), port))
        bank = 0
    if system == "gm" and random.random() < 0.5:
        setup = [(0, bytes([0xC0 | channel, program]))]
    else:
        setup = _bank(channel, bank, random.choice((0, 0, 3)), program, random.choice((0, 10)), random)
    return Part("melody", channel, port, setup, program, _line(random, program), random.choice(NAMES))


def _line(random: Random, program: int, first_bar: int = 1) -> list[tuple[int, int]]:
    _, low, high = WINDS[program]
    pitch = random.randint(low, high)
    notes = []
    for beat in range(16):
        notes.append((first_bar * BAR + beat * QUARTER, pitch))
        pitch = min(max(pitch + random.choice((-4, -2, -1, 1, 2, 3, 5)), low), high)
    return notes


def _beat(
    random: Random, system: str, kit: int, first_bar: int = 1
) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """Notes of a kit, and their meaning in General MIDI 2."""
    notes, heard = [], []
    timpani = kit == 48 and system in ("gs", "gm2")
    brushes = kit == 40 and system == "gs"
    special = DIFFERENT.get((system, 48 if timpani else 0), ())
    for eighth in range(32):
        tick = first_bar * BAR + eighth * QUARTER // 2
        if special and random.random() < 0.2:
            note, number = random.choice(special)
        elif timpani:
            note = number = random.choice((35, 36, 38, 40, 54, 57, 59))
        else:
            note = number = random.choice((35, 36, 36, 38, 38, 40, 41, 42, 42, 44, 46, 49, 51, 57, 70, 75))
            if brushes and eighth % 8 == 0:
                note, number = 39, 38
        notes.append((tick, note))
        heard.append((tick, number))
    return notes, heard


def _drums(random: Random, system: str, port: int, channel: int, common: list[tuple[int, bytes, int]]) -> Part:
    kit = random.choice(KITS[system])
    setup: list[tuple[int, bytes]] = []
    at = random.choice((0, 10))
    if system == "gs":
        if channel != 9 or random.random() < 0.3:
            common.append((random.choice((0, 3)), _mode(system, channel, random.choice((1, 2)), random), port))
        setup = _bank(channel, 0, random.choice((0, 3)), kit, at, random)
    elif system == "xg":
        if random.random() < 0.3 and kit != 56:
            common.append((random.choice((0, 3)), _mode(system, channel, random.choice((1, 2, 3)), random), port))
            setup = [(at, bytes([0xC0 | channel, kit]))]
        else:
            setup = _bank(channel, 127, 0, kit, at, random)
    elif system == "gm2":
        setup = _bank(channel, 120, 0, kit, at, random)
    elif random.random() < 0.7:
        setup = _bank(channel, 0, 0, kit, at, random)
    notes, heard = _beat(random, system, kit)
    return Part("drums", channel, port, setup, kit, notes, random.choice(DRUM_NAMES), heard)


def _effects(random: Random, system: str, port: int, channel: int, common: list[tuple[int, bytes, int]]) -> Part:
    """Effects such as applause or helicopters: by a program of General MIDI, a bank or a kit."""
    way = random.choice(("program", "kit", "bank"))
    program, bank = random.randint(120, 127), {"gm2": 121}.get(system, 0)
    if way == "kit" and system == "gs":
        common.append((0, _mode(system, channel, 1, random), port))
        program = 56
    elif way == "kit":
        program, bank = {"xg": (random.choice((0, 1)), 126), "gm2": (56, 120)}[system]
    elif way == "bank" and system == "xg":
        program, bank = random.choice((0, 16, 32, 56, 64, 73)), 64
    notes = [(BAR + beat * BAR, random.randint(36, 84)) for beat in range(6)]
    return Part("effects", channel, port, _bank(channel, bank, 0, program, 0, random), program, notes, "")


def _turncoat(random: Random, system: str, port: int, channel: int, common: list[tuple[int, bytes, int]]) -> list[Part]:
    """Drums for four bars, then a melody on the same channel in one track (with equal names)."""
    drums = _drums(random, system, port, channel, common)
    program = random.choice(sorted(WINDS))
    tune = _line(random, program, first_bar=7)
    turn = 6 * BAR
    if system == "gs" or system == "xg":
        common.append((turn, _mode(system, channel, 0, random), port))
    setup = _bank(channel, 121 if system == "gm2" else 0, 0, program, turn, random)
    drums.name = "turncoat"
    return [drums, Part("melody", channel, port, setup, program, tune, "turncoat")]


# --- bytes ------------------------------------------------------------------------------------------------------------


def _number(value: int) -> bytes:
    out = [value & 127]
    while value := value >> 7:
        out.append(value & 127 | 128)
    return bytes(reversed(out))


def _track(random: Random, rows: list[tuple[int, int, bytes]], running: bool = False) -> bytes:
    """Track of (tick, order, event); some system-exclusive events are written in pieces."""
    data, at, status = bytearray(), 0, 0
    for tick, _, event in sorted(rows, key=lambda row: row[:2]):
        data += _number(tick - at)
        at = tick
        if event[0] == 0xF0:
            body, status = event[1:], 0
            cut = random.randint(1, len(body) - 1)
            if random.random() < 0.25:
                data += b"\xf0" + _number(cut) + body[:cut] + b"\0\xf7" + _number(len(body) - cut) + body[cut:]
            else:
                data += b"\xf0" + _number(len(body)) + body
        elif event[0] == 0xFF:
            data, status = data + event, 0
        elif running and event[0] == status:
            data += event[1:]
        else:
            data, status = data + event, event[0]
    data += b"\0\xff\x2f\0"
    return b"MTrk" + len(data).to_bytes(4, "big") + bytes(data)


def _meta(kind: int, data: bytes) -> bytes:
    return bytes([0xFF, kind]) + _number(len(data)) + data


def _notes(part: Part) -> list[tuple[int, int, bytes]]:
    length = QUARTER // 4 if part.kind == "drums" else QUARTER - 10
    rows = []
    for tick, pitch in part.notes:
        rows.append((tick, 5, bytes([0x90 | part.channel, pitch, 90])))
        rows.append((tick + length, 4, bytes([0x90 | part.channel, pitch, 0])))
    return rows


def _file(random: Random, parts: list[Part], common: list[tuple[int, bytes, int]], several_ports: bool) -> bytes:
    way = "format 1" if several_ports else random.choice(("format 0", "format 1", "setup track", "setup track last"))
    running, encoding = random.random() < 0.4, random.choice(("shift_jis", "utf-8"))
    conductor = [(0, 0, _meta(3, "曲".encode(encoding))), (0, 0, _meta(0x51, b"\x07\xa1\x20"))]
    exclusives = [(tick, 1, event, port) for tick, event, port in common]
    setup_rows = [(tick, 3, event) for part in parts for tick, event in part.setup]
    if way == "format 0":
        rows = conductor + [row[:3] for row in exclusives] + setup_rows
        rows += [row for part in parts for row in _notes(part)]
        return _header(0, 1) + _track(random, rows, running)
    tracks = []
    together: dict[str, list[Part]] = {}
    for part in list(parts):
        # Bass drum, snare drum and cymbals in tracks of their own, one of which sets the channel up.
        if part.kind == "drums" and part.name != "turncoat" and random.random() < 0.3:
            parts.append(replace(part, notes=part.notes[1::2], setup=[], name=random.choice(DRUM_NAMES), heard=[]))
            part.notes = part.notes[::2]
    for place, part in enumerate(parts):
        together.setdefault(part.name if part.name == "turncoat" else f"{place} {part.name}", []).append(part)
    for own in together.values():
        name = own[0].name.replace("turncoat", "")
        rows = [(0, 0, _meta(3, name.encode(encoding)))] if name else []
        if several_ports:
            rows.append((0, 0, _meta(0x21, bytes([own[0].port]))))
        rows += [row for part in own for row in _notes(part)]
        if way == "format 1":
            rows += [(tick, 3, event) for part in own for tick, event in part.setup]
        tracks.append(_track(random, rows, running))
    if way == "format 1" and several_ports:
        setups = [
            _track(random, [(0, 0, _meta(0x21, bytes([port]))), *(row[:3] for row in exclusives if row[3] == port)])
            for port in (0, 1)
        ]
    elif way == "format 1":
        conductor += [row[:3] for row in exclusives]
        setups = []
    else:
        setups = [_track(random, [row[:3] for row in exclusives] + setup_rows, running)]
    first = [_track(random, conductor)]
    tracks = [*first, *tracks, *setups] if way == "setup track last" else [*first, *setups, *tracks]
    return _header(1, len(tracks)) + b"".join(tracks)


def _header(format_: int, tracks: int) -> bytes:
    values = (6, format_, tracks, QUARTER)
    return b"MThd" + values[0].to_bytes(4, "big") + b"".join(value.to_bytes(2, "big") for value in values[1:])
