"""Recording from MIDI devices: ports, the recorder, journals of takes."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "capture.no_library": (
        "MIDI devices cannot be reached: {detail}; they need Python 3.11 or 3.12 and, on Linux, the package libasound2"
    ),
    "capture.no_system": (
        "no MIDI system answers; on Linux, load the kernel's sequencer (sudo modprobe snd-seq) or start JACK"
    ),
    "capture.api_unknown": "there is no MIDI system {name!r} here; possible: {possible}",
    "capture.no_ports": "no MIDI device is connected; plug one in and switch it on",
    "capture.port_unknown": "no MIDI device is called {port!r}; there are: {possible}",
    "capture.port_not_here": "{port} is not connected; it is used as soon as it is",
    "capture.port_refused": (
        "{port} cannot be opened ({detail}): another program may be using it; close it there, and it is opened here"
    ),
    "capture.not_written": (
        "{file} cannot be written: {reason}; recording goes on and is written as soon as there is room"
    ),
    "capture.cut_short": "{file} cannot be written: {reason}; the end of the recording is missing in it",
    "capture.recorder_ended": "the recorder ended unexpectedly and was started again; what it had heard is kept",
    "capture.recorder_fails": "the recorder cannot be started ({detail})",
    "record.no_port": "say with --port which device to record from; 'suisou ports' lists them",
    "record.exists": "{file} is there already; choose another name, or delete it",
    "record.running": "another recording into {file} is running; choose another name",
    "record.journal_left": (
        "{journal} is there already: a recording was not finished; write it with 'suisou record --rescue --to {file}'"
    ),
    "record.not_written": (
        "{file} cannot be written: {reason}; the recording is kept in {journal}: make room, then write it with "
        "'suisou record --rescue --to {file}'"
    ),
    "record.nothing_heard": "nothing was heard from {port}: no file was written",
    "journal.exists": "{file} is there already: another recording is running, or one was not finished",
    "journal.no_header": "{file} is no journal of a take: its first line does not say what it is",
    "journal.newer": "{file} was written by a newer version of the program (journal {version}); use that one",
    "journal.line": "{file}, line {line}: {detail}",
}
