"""Damaged, absurd and foreign files through ``suisou inspect``: it ends with status 0 or 1 and a reason in one line."""

from __future__ import annotations

import json
import random
import struct
import subprocess
import sys
from pathlib import Path

import pytest

from app.cli import main

ROOT = Path(__file__).parents[2]
MIDI = ROOT / "tests" / "data" / "midi"
FILES = sorted(path for path in MIDI.glob("*/*.mid") if 0 < path.stat().st_size < 20_000)
END = b"\0\xff\x2f\0"


def variable_length(value: int) -> bytes:
    encoded = [value & 0x7F]
    while value := value >> 7:
        encoded.append(value & 0x7F | 0x80)
    return bytes(reversed(encoded))


def note(pitch: int, duration: int = 480, wait: int = 0) -> bytes:
    return variable_length(wait) + bytes([0x90, pitch, 80]) + variable_length(duration) + bytes([0x80, pitch, 0])


def midi(*tracks: bytes, format_: int = 1, division: int = 480, count: int | None = None) -> bytes:
    header = struct.pack(">IHHH", 6, format_, len(tracks) if count is None else count, division & 0xFFFF)
    return b"MThd" + header + b"".join(b"MTrk" + struct.pack(">I", len(track)) + track for track in tracks)


ONE = note(60) + END

# Name of each input, its bytes, and the times of its notes.
READABLE = {
    "a track without its end": (midi(note(60)), [0.0]),
    "a gap of a million ticks": (midi(note(60, 480, 0) + note(62, 480, 1_000_000 - 480) + END), [0.0, 1041.6666667]),
    "a tempo of 0": (midi(b"\0\xff\x51\x03\0\0\0" + note(60) + note(62) + END), [0.0, 0.5]),
    "a tempo of one microsecond": (midi(b"\0\xff\x51\x03\0\0\x01" + note(60) + note(62) + END), [0.0, 0.5]),
    "the slowest tempo": (midi(b"\0\xff\x51\x03\xff\xff\xff" + note(60) + note(62) + END), [0.0, 16.777215]),
    "a tempo of two bytes": (midi(b"\0\xff\x51\x02\0\x01" + note(60) + note(62) + END), [0.0, 0.5]),
    "a metre of 0/4": (midi(b"\0\xff\x58\x04\0\x02\x18\x08" + ONE), [0.0]),
    "a metre of 255/huge": (midi(b"\0\xff\x58\x04\xff\xff\x18\x08" + ONE), [0.0]),
    "one tick per quarter": (midi(note(60, 4) + note(62, 4) + END, division=1), [0.0, 2.0]),
    "SMPTE 25 frames of 40": (midi(note(60, 1000) + note(62, 9) + END, division=(256 - 25) << 8 | 40), [0.0, 1.0]),
    "SMPTE 30 frames of 80": (midi(note(60, 2400) + note(62, 9) + END, division=(256 - 30) << 8 | 80), [0.0, 1.0]),
    "SMPTE 29.97 frames of 80": (midi(note(60, 2400) + note(62, 9) + END, division=(256 - 29) << 8 | 80), [0.0, 1.001]),
    "SMPTE 24 frames of 4": (midi(note(60, 96) + note(62, 9) + END, division=(256 - 24) << 8 | 4), [0.0, 1.0]),
    "format 2": (midi(note(60) + END, note(62) + END, format_=2), [0.0, 0.5]),
    "format 3": (midi(ONE, format_=3), [0.0]),
    "format 0 with two tracks": (midi(note(60) + END, note(62) + END, format_=0), [0.0, 0.0]),
    "more tracks promised": (midi(ONE, count=9), [0.0]),
    "fewer tracks promised": (midi(ONE, ONE, count=1), [0.0, 0.0]),
    "no end of a note": (midi(b"\0\x90\x3c\x50\x83\x60\xff\x2f\0"), [0.0]),
    "running status": (midi(b"\0\x90\x3c\x50\x83\x60\x3c\0\0\x3e\x50\x60\x3e\0" + END), [0.0, 0.5]),
    "system messages between": (midi(b"\0\xf8\0\xfe\0\xf4" + ONE), [0.0]),
    "a RIFF wrapper": (b"RIFF\x40\0\0\0RMIDdata\x30\0\0\0" + midi(ONE), [0.0]),
    "a foreign header of 128 bytes": (b"\0" * 128 + midi(ONE), [0.0]),
    "rubbish after the end": (midi(ONE) + b"rubbish" * 9, [0.0]),
    "a key of ten sharps": (midi(b"\0\xff\x59\x02\x0a\x07" + ONE), [0.0]),
    "a name with line breaks": (midi(b"\0\xff\x03\x09Flute\n1\r{" + ONE), [0.0]),
    "an empty track": (midi(b""), []),
    "500 notes that never end": (midi(b"\0\x90\x3c\x50" * 500 + END), [0.0]),
}
UNREADABLE = {
    "nothing": (b"", "empty"),
    "half a header": (b"MThd\0\0\0\x06\0\x01", "byte 10"),
    "a text": (b"Dear sir or madam", "byte 0"),
    "a division of 0": (midi(ONE, division=0), "byte 12"),
    "no tracks": (midi(), "byte 14"),
    "another archive": (b"PK\x03\x04" + bytes(100), "damaged compressed file"),
    "77 hours": (midi(note(60) + note(62, 480, 0x0FFFFFFF) + END), "hours"),
}


@pytest.mark.parametrize("what", READABLE)
def test_what_others_open_opens(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data, onsets_s = READABLE[what]
    path = tmp_path / "file.mid"
    path.write_bytes(data)
    assert main(["inspect", str(path), "--json", "--fps", "24"]) == 0
    found = json.loads(capsys.readouterr().out)
    reported = sorted(note_["onset_s"] for player in found["players"] for note_ in player["notes"])
    assert reported == pytest.approx(onsets_s)
    assert main(["inspect", str(path), "--no-contacts"]) == 0


@pytest.mark.parametrize("what", UNREADABLE)
def test_what_cannot_be_read_says_why(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data, because = UNREADABLE[what]
    path = tmp_path / "file.mid"
    path.write_bytes(data)
    assert main(["inspect", str(path), "--json"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert str(path) in err
    assert because in err


def test_folders_and_missing_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (tmp_path, tmp_path / "missing.mid", tmp_path / "no" / "such" / "folder.mid"):
        assert main(["inspect", str(path)]) == 1
        err = capsys.readouterr().err
        assert str(path) in err
        assert err.count("\n") == 1


def damaged(data: bytes, chance: random.Random) -> bytes:
    """A file with some bytes changed, put in, left out or cut off."""
    changed = bytearray(data)
    how = chance.choice(["flip", "flip", "cut", "insert", "delete"])
    for _ in range(chance.choice([1, 1, 3, 20])):
        at = chance.randrange(len(changed))
        if how == "flip":
            changed[at] = chance.randrange(256)
        elif how == "insert":
            changed.insert(at, chance.randrange(256))
        elif how == "delete" and len(changed) > 1:
            del changed[at]
    return bytes(changed[: chance.randrange(len(changed))]) if how == "cut" else bytes(changed)


@pytest.mark.parametrize("seed", range(60))
def test_damage_never_escapes(seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    chance = random.Random(seed)
    path = tmp_path / "damaged.mid"
    path.write_bytes(damaged(chance.choice(FILES).read_bytes(), chance))
    # Making all motion takes longest; what it is made from is the same.
    status = main(["inspect", str(path), *(["--no-contacts"] if seed % 4 else ["--fps", "24"])])
    out, err = capsys.readouterr()
    assert status in (0, 1)
    if status:
        assert out == ""
        assert str(path) in err
        assert err.count("\n") == 1


def test_a_process_ends_the_same_way(tmp_path: Path) -> None:
    path = tmp_path / "damaged.mid"
    path.write_bytes(damaged(FILES[0].read_bytes(), random.Random(1))[:40])
    for arguments, status in (([str(path)], (0, 1)), ([str(tmp_path)], (1,)), ([], (2,))):
        done = subprocess.run(
            [sys.executable, "-m", "app", "inspect", *arguments], cwd=ROOT, capture_output=True, check=False
        )
        assert done.returncode in status
        assert b"Traceback" not in done.stderr
