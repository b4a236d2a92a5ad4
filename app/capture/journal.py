"""The journal of a running recording: lines of text that are only appended, so that a crash loses only unwritten lines.

Line 1 is a JSON object, the header. The other lines have times ``<ns>`` of `time.perf_counter_ns`::

    e <ns> <hex>                      an event: the bytes of one MIDI message
    s <ns> <position in s> <pass>     position of the piece that sounded then, and number of the pass of a loop
    lost <ns>, back <ns>              the device was disconnected, and was connected again
    end <ns>                          regular end of the recording; missing after a crash

A line without a line feed was interrupted and is ignored.
"""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Sequence
from io import FileIO
from pathlib import Path
from typing import Final, TypeAlias

import msgspec

from app.errors import FileError
from app.formats.files import cannot_write, read_file
from app.formats.json_data import UNREADABLE
from app.formats.locks import lock

VERSION: Final = 1
_LENGTHS: Final = {0x8: 3, 0x9: 3, 0xA: 3, 0xB: 3, 0xC: 2, 0xD: 2, 0xE: 3}
LARGEST_NS: Final = 1 << 62
_LARGEST_S: Final = 1e7
LARGEST_LATENCY_S: Final = 10.0
MOST_BYTES: Final = 2**28
"""Largest size of a journal in bytes; an hour of playing with breath takes about 20 MB."""

Gap: TypeAlias = tuple[int, int | None]
"""Times of the device's loss and return; None if it did not return."""


class JournalHeader(msgspec.Struct, frozen=True):
    """Origin of a journal: project, player, port, controller and start.

    Attributes
    ----------
    project : str
        Path of the project file (`app.encoding.stored`), or the editor's token of a project without a file.
    player : str
        Id of the recorded player.
    port, controller : str
        Name of the device; id of the preset in ``metadata/controllers``.
    latency_s : float
        Delay from playing to the event's arrival, plus the delay from the performance's time to its sound; subtracted
        from the events' times.
    started : str
        ISO 8601 date and time.
    """

    project: str
    player: str
    port: str
    controller: str
    latency_s: float
    started: str
    version: int = VERSION


class _Version(msgspec.Struct, frozen=True):
    version: int


# Created while the import lock is held: see the end of `metadata.load`.
_HEADERS: Final = msgspec.json.Decoder(JournalHeader)
_VERSIONS: Final = msgspec.json.Decoder(_Version)


class SyncPoint(msgspec.Struct, frozen=True, gc=False):
    """Position of the piece in seconds that was heard at a moment, and the number of the pass when looping."""

    ns: int
    position_s: float
    pass_: int


class Journal(msgspec.Struct, frozen=True):
    """Contents of a journal.

    Attributes
    ----------
    times_ns : tuple of int
        Arrival time of each message by `time.perf_counter_ns`, ascending.
    messages : tuple of bytes
        Bytes of each MIDI channel message.
    gaps : tuple of (int, int or None)
        Times in nanoseconds at which the device was disconnected and reconnected (None: never).
    complete : bool
        Whether the recording was ended regularly and not interrupted.
    """

    header: JournalHeader
    times_ns: tuple[int, ...]
    messages: tuple[bytes, ...]
    syncs: tuple[SyncPoint, ...]
    gaps: tuple[Gap, ...]
    complete: bool


def is_whole(message: bytes) -> bool:
    """Return whether bytes are a whole channel message: a status byte and its number of data bytes."""
    return (
        len(message) > 1 and _LENGTHS.get(message[0] >> 4) == len(message) and message[1] < 0x80 and message[-1] < 0x80
    )


class JournalWriter:
    """Writes a journal; bytes that the system does not accept are kept for the next attempt.

    Parameters
    ----------
    path : str
        Path that must not exist; with ``resumed`` it may, and an interrupted last line is removed.

    Raises
    ------
    FileError
        The file exists, or cannot be written.
    """

    def __init__(self, path: str, header: JournalHeader, *, resumed: bool = False) -> None:
        self.path = path
        self.count = 0
        self._last_sync = (-LARGEST_NS, 0)
        mode = "r+" if resumed and os.path.exists(path) else "x+"
        try:
            self._file = FileIO(path, mode)
            # The lock shows a reader of the journal that it is still being written.
            lock(self._file)
            is_new = mode == "x+" or self._cut() == 0
        except FileExistsError as error:
            raise FileError("journal.exists", file=path) from error
        except OSError as error:
            raise cannot_write(path, error) from error
        self._pending = bytearray(msgspec.json.encode(header) + b"\n" if is_new else b"")
        self._is_synced = False

    def _cut(self) -> int:
        """Remove an interrupted last line and the end mark from the file, and return the remaining length in bytes."""
        data = self._file.read()
        lines = data[: data.rfind(b"\n") + 1].splitlines(keepends=True)
        if lines and lines[-1].startswith(b"end "):
            del lines[-1]
        for line in lines:
            if line.startswith(b"e "):
                self.count += 1
            elif line.startswith(b"s "):
                _, ns, _, pass_ = line.split()
                self._last_sync = int(ns), int(pass_)
        whole = sum(map(len, lines))
        self._file.truncate(whole)
        self._file.seek(whole)
        return whole

    def event(self, ns: int, message: bytes) -> None:
        """Append a received MIDI message with its time in nanoseconds to the journal."""
        self._is_synced = False
        self._pending += b"e %d %s\n" % (ns, message.hex().encode())
        self.count += 1

    def sync(self, ns: int, position_s: float, pass_: int) -> None:
        """Append the position of the piece (in seconds, in pass ``pass_`` of a loop) that was heard at a time in
        nanoseconds. Times are made monotonic, as readers require.
        """
        if not math.isfinite(position_s) or abs(position_s) > _LARGEST_S:
            return
        ns, pass_ = self._last_sync = max(ns, self._last_sync[0]), max(pass_, self._last_sync[1])
        self._is_synced = False
        self._pending += b"s %d %.6f %d\n" % (ns, position_s, pass_)

    def mark(self, word: str, ns: int) -> None:
        """Append a mark: the device was ``lost``, is ``back``, or the recording was ended (``end``)."""
        self._is_synced = False
        self._pending += b"%s %d\n" % (word.encode(), ns)

    def write(self) -> None:
        """Pass all buffered lines to the operating system. Raises OSError; unwritten lines stay in the buffer."""
        while self._pending:
            del self._pending[: self._file.write(self._pending)]

    def to_disk(self) -> bool:
        """Write everything to the disk itself, and return whether there was anything new. Raises OSError."""
        if self._is_synced:
            return False
        self.write()
        os.fsync(self._file.fileno())
        self._is_synced = True
        return True

    def move(self, path: str) -> None:
        """Continue the journal in another file, which must not exist: everything written so far is copied there, and
        the first file is deleted.

        Raises
        ------
        OSError
            The journal stays in the first file, and nothing is lost.
        """
        self._file.seek(0)
        written = self._file.readall()
        file = FileIO(path, "x+")
        try:
            lock(file)
            data = memoryview(written + self._pending)
            while data:
                data = data[file.write(data) :]
            os.fsync(file.fileno())
        except OSError:
            file.close()
            Path(path).unlink()
            raise
        former, self.path, self._file = (self.path, self._file), path, file
        self._pending.clear()
        self._is_synced = True
        former[1].close()
        # The old file only takes space on a full disk; if it cannot be removed, its content is a part of the new one's.
        with contextlib.suppress(OSError):
            Path(former[0]).unlink()

    def close(self) -> None:
        """Flush everything to the disk and close. The file is closed even if OSError is raised."""
        try:
            self.write()
            os.fsync(self._file.fileno())
        finally:
            self._file.close()


def read_journal(path: Path) -> Journal:
    """Read a journal, including an interrupted one.

    Raises
    ------
    FileError
        The file cannot be read, has no header, is from a newer version, or contains an invalid line.
    """
    data = read_file(path, MOST_BYTES)
    first, *lines = data.split(b"\n")
    # Text after the last line feed is incomplete (or empty).
    torn = not lines
    header = None if torn else _header(path, first)
    if header is None:
        raise FileError("journal.no_header", file=str(path))
    events: list[tuple[int, bytes]] = []
    syncs: list[SyncPoint] = []
    gaps: list[Gap] = []
    complete = False
    for number, line in enumerate(lines[:-1], 2):
        try:
            word, *values = line.decode("ascii").split(" ")
            if complete:
                raise ValueError("the take had ended before")
            if word == "e":
                events.append(_event(*values))
            elif word == "s":
                syncs.append(_sync(syncs, *values))
            elif word == "lost":
                _begin_gap(gaps, _ns(*values))
            elif word == "back":
                _end_gap(gaps, _ns(*values))
            elif word == "end":
                _ns(*values)
                complete = True
            else:
                raise ValueError(f"{word!r} is no word of a journal")
        except (ValueError, TypeError) as error:
            raise FileError("journal.line", file=str(path), line=number, detail=_detail(error)) from error
    # A device that is reopened delivers its events in another thread, so they may be out of order.
    events.sort(key=lambda event: event[0])
    return Journal(
        header=header,
        times_ns=tuple(ns for ns, _ in events),
        messages=tuple(message for _, message in events),
        syncs=tuple(syncs),
        gaps=tuple(gaps),
        complete=complete,
    )


def _header(path: Path, line: bytes) -> JournalHeader | None:
    try:
        version = _VERSIONS.decode(line).version
        if version > VERSION:
            raise FileError("journal.newer", file=str(path), version=version)
        header = _HEADERS.decode(line)
    except UNREADABLE:
        return None
    known = header.version == VERSION and abs(header.latency_s) <= LARGEST_LATENCY_S
    return header if known else None


def _ns(text: str) -> int:
    ns = int(text) if len(text) < 24 else LARGEST_NS
    if abs(ns) >= LARGEST_NS:
        raise ValueError(f"{text[:24]} is no moment")
    return ns


def _event(ns: str, message: str) -> tuple[int, bytes]:
    data = bytes.fromhex(message)
    if not is_whole(data):
        raise ValueError(f"{message[:24]!r} is no message of a MIDI channel")
    return _ns(ns), data


def _sync(before: Sequence[SyncPoint], ns: str, position: str, pass_: str) -> SyncPoint:
    position_s = float(position)
    if not math.isfinite(position_s) or abs(position_s) > _LARGEST_S:
        raise ValueError(f"{position[:24]} is no place of a piece")
    point = SyncPoint(_ns(ns), position_s, _ns(pass_))
    if before and (point.ns < before[-1].ns or point.pass_ < before[-1].pass_):
        raise ValueError("time goes back")
    return point


def _begin_gap(gaps: list[Gap], ns: int) -> None:
    # A recorder that continues the journal of another one has no record that the device was lost.
    if not gaps or gaps[-1][1] is not None:
        gaps.append((ns, None))


def _end_gap(gaps: list[Gap], ns: int) -> None:
    if not gaps or gaps[-1][1] is not None:
        raise ValueError("the device is back and was never lost")
    gaps[-1] = (gaps[-1][0], ns)


def _detail(error: Exception) -> str:
    # msgspec's message about the number of values would name our functions.
    if isinstance(error, TypeError):
        return "too few or too many values"
    return "not ASCII" if isinstance(error, UnicodeDecodeError) else str(error)
