"""Events of each pass of a loop, from a journal, in performance time."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from itertools import pairwise

import msgspec

from app.capture.journal import LARGEST_NS, Journal, SyncPoint
from app.score.sounding import SoundingNotes, note_off


class Pass(msgspec.Struct, frozen=True):
    """Events of one pass of a loop, in performance time.

    Attributes
    ----------
    times_us : tuple of int
        Microseconds, ascending or equal; negative before the first note.
    """

    number: int
    times_us: tuple[int, ...]
    messages: tuple[bytes, ...]


def passes(journal: Journal) -> tuple[Pass, ...]:
    """Return the passes of a recording in performance time with the latency subtracted; empty if nothing was played
    back. Notes that sound when the device is disconnected end there.

    Time is interpolated between moments of known position, and extrapolated outside of them. The boundary of two passes
    is the reported start of the second; if that is inexact, the middle between known moments.
    """
    by_pass: dict[int, list[SyncPoint]] = {}
    for point in journal.syncs:
        by_pass.setdefault(point.pass_, []).append(point)
    if not by_pass:
        return ()
    latency_ns = round(journal.header.latency_s * 1e9)
    returns = [(a[-1].ns + b[0].ns) // 2 for a, b in pairwise(by_pass.values())]
    edges_ns = [-LARGEST_NS, *returns, LARGEST_NS]
    times_ns, messages = _ended(journal)
    found = []
    for (number, points), (begin_ns, end_ns) in zip(by_pass.items(), pairwise(edges_ns), strict=True):
        begin = bisect_left(times_ns, begin_ns + latency_ns)
        end = bisect_left(times_ns, end_ns + latency_ns)
        found.append(
            Pass(
                number=number,
                times_us=tuple(_performance_us(times_ns[begin:end], latency_ns, points)),
                messages=tuple(messages[begin:end]),
            )
        )
    return tuple(found)


def _ended(journal: Journal) -> tuple[Sequence[int], Sequence[bytes]]:
    """Return the events with note-offs added for notes that sounded when the device was disconnected."""
    if not journal.gaps:
        return journal.times_ns, journal.messages
    events = [(ns, message) for ns, message in zip(journal.times_ns, journal.messages, strict=True)]
    lost = [(lost_ns, None) for lost_ns, _ in journal.gaps]
    found: list[tuple[int, bytes]] = []
    sounding: SoundingNotes[None] = SoundingNotes()
    for ns, message in merge(events, lost, key=lambda event: event[0]):
        if message is None:
            found += [(ns, note_off(key)) for key, _ in sounding.end_all()]
        else:
            sounding.receive(message, None)
            found.append((ns, message))
    return [ns for ns, _ in found], [message for _, message in found]


def _performance_us(times_ns: Iterable[int], latency_ns: int, points: Sequence[SyncPoint]) -> Iterator[int]:
    """Convert ascending clock times in nanoseconds to microseconds of the performance, by the known positions
    ``points`` of one pass.
    """
    index = 0
    for time_ns in times_ns:
        played_ns = time_ns - latency_ns
        while index + 2 < len(points) and points[index + 1].ns <= played_ns:
            index += 1
        near = points[index]
        position_s, speed = near.position_s, 1.0
        if index + 1 < len(points):
            after = points[index + 1]
            if played_ns >= after.ns:
                near, position_s = after, after.position_s
            elif played_ns > near.ns:
                speed = (after.position_s - near.position_s) / ((after.ns - near.ns) / 1e9)
        yield round((position_s + speed * ((played_ns - near.ns) / 1e9)) * 1e6)
