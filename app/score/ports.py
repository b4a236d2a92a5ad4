"""MIDI ports within one track: a format 0 file with more than sixteen channels names a port before its events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import mido

_MOST_PORTS: Final = 16
"""Greatest number of ports of one track; further names count as the first port."""


def split_by_port(messages: Sequence[Any]) -> list[Sequence[Any]]:
    """Split the messages of a track by port, if notes go to several ports; each list has its own delta times.

    Parameters
    ----------
    messages : sequence of mido messages
        Messages of the track, with delta times.

    Returns
    -------
    list of sequences of mido messages
        The first list also has all events without a channel; every other one begins with its port and has only the
        events of that port's channels.
    """
    if sum(message.type == "midi_port" for message in messages) < 2:
        return [messages]
    current: int | None = None
    sent: dict[int | None, list[tuple[int, Any]]] = {}
    with_notes: dict[int | None, None] = {}
    tick = 0
    for message in messages:
        tick += message.time
        if message.type == "midi_port":
            current = message.port
        elif not message.is_meta:
            sent.setdefault(current, []).append((tick, message))
            if message.type == "note_on" and message.velocity:
                with_notes.setdefault(current)
    several = list(with_notes)[:_MOST_PORTS]
    if len(several) < 2:
        return [messages]
    elsewhere = {id(message) for port in several[1:] for _, message in sent[port]}
    others = [[mido.MetaMessage("midi_port", port=port or 0), *_with_deltas(sent[port], tick)] for port in several[1:]]
    return [_without(messages, elsewhere, several[0]), *others]


def _without(messages: Sequence[Any], left_out: set[int], port: int | None) -> list[Any]:
    """Remove the messages with the indices ``left_out`` and all port messages; ``port``, if given, is put first."""
    rows, tick = [], 0
    for message in messages:
        tick += message.time
        if id(message) not in left_out and message.type != "midi_port":
            rows.append((tick, message))
    return [*([] if port is None else [mido.MetaMessage("midi_port", port=port)]), *_with_deltas(rows, tick)]


def _with_deltas(rows: Sequence[tuple[int, Any]], end: int) -> list[Any]:
    """Convert messages at ticks to messages with delta times, and add the end of the track."""
    found, at = [], 0
    for tick, message in rows:
        if message.type != "end_of_track":
            found.append(message.copy(time=tick - at))
            at = tick
    return [*found, mido.MetaMessage("end_of_track", time=end - at)]
