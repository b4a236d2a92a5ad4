"""``suisou record``: records from a MIDI device into a MIDI file."""

from __future__ import annotations

import argparse
import contextlib
import os
import time
from datetime import datetime
from itertools import count as count_from
from pathlib import Path
from typing import Final

import platformdirs

from app.capture.journal import JournalHeader, read_journal
from app.capture.loop_passes import passes
from app.capture.port_names import matching
from app.capture.protocol import (
    Back,
    EventsSaved,
    Lost,
    Moved,
    NotStarted,
    Opened,
    RecordingFinished,
    RequestRefused,
    Restarted,
)
from app.cli.commands import fill_help
from app.cli.options import LONGEST_S, bounded_number
from app.cli.ports import NoDevice, PortMonitor
from app.cli.speech import error_sentence, said, sentence
from app.cli.status import DONE, PARTIAL
from app.cli.terminal import count, say, warn
from app.errors import AppError, FileError, UsageError
from app.formats.locks import is_locked
from app.project.journals import second_folder
from app.score.write_take import write_take
from metadata.load import recognised_controller

_WITHIN_S: Final = 15.0
_LEAD_S: Final = 0.2
_BEATS_IN_BAR: Final = 4
_USUAL_TEMPO: Final = 120.0

_seconds = bounded_number(0.1, LONGEST_S, "quantity.seconds", float)
_tempo = bounded_number(20.0, 400.0, "quantity.tempo", float)
_bars = bounded_number(0, 16, "quantity.bars", int)


class RecordError(AppError):
    """Error: a recording from a MIDI device could not be made."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou record``."""
    command.add_argument("--port", metavar="NAME")
    command.add_argument("--to", type=Path, required=True, metavar="TAKE.mid")
    command.add_argument("--seconds", type=_seconds, metavar="S")
    command.add_argument("--count-in", type=_bars, default=0, metavar="BARS")
    tempo = command.add_argument("--tempo", type=_tempo, default=_USUAL_TEMPO, metavar="BPM")
    fill_help(tempo, usual=f"{_USUAL_TEMPO:g}")
    command.add_argument("--rescue", action="store_true")
    command.set_defaults(run=record)


def record(arguments: argparse.Namespace) -> int:
    """Record, write the file, and return the exit status.

    Raises
    ------
    AppError
        There is no device, nothing was received, or no file can be written.
    """
    target: Path = arguments.to
    journal = target.with_name(f"{target.name}.take-journal")
    if arguments.port is None and not arguments.rescue:
        raise UsageError("record.no_port")
    if os.path.exists(target):
        raise FileError("record.exists", file=str(target))
    if is_locked(journal):
        raise FileError("record.running", file=str(target))
    if not arguments.rescue:
        if os.path.exists(journal):
            raise FileError("record.journal_left", file=str(target), journal=journal.name)
        journal = _listen(arguments, journal)
    return _write(target, journal, arguments.tempo)


def second_place(target: Path) -> Path:
    """Return a path in another folder for a recording whose own folder is full or not writable."""
    return second_folder(target.parent, platformdirs.user_state_path("suisou", appauthor=False) / "recordings")


def _beside_none(folder: Path, name: str) -> Path:
    """Return a path in a folder that does not exist yet; a number is added to the name if necessary."""
    stem, _, suffix = name.partition(".")
    names = (name if number == 1 else f"{stem} ({number}).{suffix}" for number in count_from(1))
    return next(folder / one for one in names if not os.path.lexists(folder / one))


def _listen(arguments: argparse.Namespace, journal: Path) -> Path:
    """Record into a journal file until the time is over or Ctrl+C is pressed, and return the path of the journal.

    The path differs from ``journal`` if the recorder had to change to another folder.
    """
    with PortMonitor() as listening:
        port = _open(listening, arguments.port)
        count_in_s = arguments.count_in * _BEATS_IN_BAR * 60.0 / arguments.tempo
        begin_ns = time.perf_counter_ns() + round((_LEAD_S * bool(arguments.count_in) + count_in_s) * 1e9)
        header = JournalHeader(
            project="",
            player="",
            port=port,
            controller=recognised_controller(port).name,
            latency_s=0.0,
            started=datetime.now().astimezone().isoformat(timespec="seconds"),
        )
        elsewhere = _beside_none(second_place(journal), journal.name)
        moved = _Moves(journal)
        listening.link.start(journal, header, elsewhere)
        listening.link.sync(begin_ns, 0.0)
        try:
            _begun(listening, moved)
            with contextlib.suppress(KeyboardInterrupt):
                _count_in(listening, arguments.count_in, arguments.tempo, begin_ns, moved)
                length_s = LONGEST_S if arguments.seconds is None else arguments.seconds
                warn(said("record.begun" if arguments.seconds else "record.begun_until_stopped"))
                _report_until(listening, _monotonic_s(begin_ns) + length_s, moved)
        finally:
            now_ns = time.perf_counter_ns()
            listening.link.sync(max(now_ns, begin_ns), max(now_ns - begin_ns, 0) / 1e9)
            listening.link.stop()
        _finished(listening, moved)
        return moved.journal


class _Moves:
    """Keeps the path of the journal file of a recording, and reports it when the recorder changes to another folder."""

    def __init__(self, journal: Path) -> None:
        self.journal = journal

    def follow(self, reported: Moved) -> None:
        """Note the new path of the journal, and print it with the reason."""
        former, self.journal = self.journal, Path(os.fsdecode(reported.path))
        files = {"file": str(former), "journal": str(self.journal)}
        warn(said("record.goes_on_elsewhere", reason=reported.reason, **files))


def _open(listening: PortMonitor, requested: str) -> str:
    """Open the MIDI device named ``requested``, or the only device whose name contains it, and return its name."""
    inputs = listening.ports().inputs
    if not inputs:
        raise NoDevice("capture.no_ports")
    found = matching(requested, inputs, partly=True)
    if len(found) != 1:
        raise NoDevice("capture.port_unknown", port=requested, possible=", ".join(found or inputs))
    listening.link.open(found[0])
    for reported in listening.until(time.monotonic() + _WITHIN_S):
        if isinstance(reported, Opened):
            return reported.port
        if isinstance(reported, RequestRefused):
            raise NoDevice(reported.reason.id, **reported.reason.arguments)
    raise NoDevice("capture.port_not_here", port=found[0])


def _begun(listening: PortMonitor, moves: _Moves) -> None:
    for reported in listening.until(time.monotonic() + _WITHIN_S):
        if isinstance(reported, Moved):
            moves.follow(reported)
            return
        if isinstance(reported, EventsSaved):
            return
        if isinstance(reported, NotStarted | RequestRefused):
            raise RecordError(reported.reason.id, **reported.reason.arguments)


def _count_in(listening: PortMonitor, bars: int, tempo: float, begin_ns: int, moves: _Moves) -> None:
    beats = bars * _BEATS_IN_BAR
    for beat in range(beats):
        _report_until(listening, _monotonic_s(begin_ns) - (beats - beat) * 60.0 / tempo, moves)
        number = beat % _BEATS_IN_BAR + 1
        count(number, is_last=number == _BEATS_IN_BAR)
    _report_until(listening, _monotonic_s(begin_ns), moves)


def _report_until(listening: PortMonitor, end_s: float, moves: _Moves) -> None:
    """Print when the MIDI device is disconnected or connected again, until a moment of `time.monotonic`."""
    for reported in listening.until(end_s):
        match reported:
            case Moved():
                moves.follow(reported)
            case Lost(port=port):
                warn(said("record.port_gone", port=port))
            case Back(port=port):
                warn(said("record.port_back", port=port))
            case RequestRefused(reason=reason) | Restarted(reason=reason):
                warn(sentence(reason))


def _finished(listening: PortMonitor, moves: _Moves) -> None:
    for reported in listening.until(time.monotonic() + _WITHIN_S):
        if isinstance(reported, Moved):
            moves.follow(reported)
        if isinstance(reported, RequestRefused):
            warn(sentence(reported.reason))
        if isinstance(reported, RecordingFinished):
            return


def _write(target: Path, path: Path, tempo: float) -> int:
    """Write a MIDI file from the journal file of a recording, delete the journal, and return the exit status.

    If ``target`` cannot be written, another folder is used. ``tempo`` is in beats per minute.
    """
    journal = read_journal(path)
    taken = passes(journal)
    if not taken or not journal.messages:
        if journal.complete:
            path.unlink()
        raise RecordError("record.nothing_received", port=journal.header.port)
    take = taken[0]
    end_us = round(journal.syncs[-1].position_s * 1e6)

    def written(file: Path) -> None:
        notes = write_take(
            file, take.times_us, take.messages, name=journal.header.port, beats_per_minute=tempo, end_us=end_us
        )
        path.unlink()
        length_s = max(end_us, take.times_us[-1], 0) / 1e6
        say(said("record.written", file=str(file), notes=notes, seconds=length_s))

    try:
        written(target)
    except FileError as error:
        reason = error.message.arguments.get("reason", error_sentence(error))
        elsewhere = _beside_none(second_place(target), target.name)
        try:
            written(elsewhere)
        except FileError:
            kept = path.name if path.parent == target.parent else str(path)
            raise RecordError("record.not_written", file=str(target), reason=reason, journal=kept) from error
        warn(said("record.written_elsewhere", file=str(target), reason=reason, elsewhere=str(elsewhere)))
        return PARTIAL
    return DONE


def _monotonic_s(ns: int) -> float:
    """Convert a moment of `time.perf_counter_ns` in nanoseconds to one of `time.monotonic` in seconds."""
    return time.monotonic() + (ns - time.perf_counter_ns()) / 1e9
