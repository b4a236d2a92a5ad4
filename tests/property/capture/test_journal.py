"""Properties of journals: wherever one is torn off only its last line is lost; whatever is in one, our errors tell."""

from __future__ import annotations

import contextlib
import tempfile
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.capture.journal import Journal, JournalHeader, JournalWriter, SyncPoint, read_journal
from app.capture.loop_passes import passes
from app.errors import FileError

HEADER = JournalHeader("ピアノ.suisou", "p", "EWI", "generic", 0.0, "")
DATA = st.integers(0, 127)
MESSAGES = st.one_of(
    st.builds(lambda status, a, b: bytes([status, a, b]), st.integers(0x80, 0xBF), DATA, DATA),
    st.builds(lambda status, a: bytes([status, a]), st.integers(0xC0, 0xDF), DATA),
)
EVENTS = st.lists(st.tuples(st.integers(-(1 << 61), 1 << 61), MESSAGES), max_size=20)


def write(path: Path, events: list[tuple[int, bytes]]) -> bytes:
    writer = JournalWriter(str(path), HEADER)
    for ns, message in events:
        writer.event(ns, message)
    writer.mark("end", 0)
    writer.close()
    return path.read_bytes()


@given(EVENTS, st.data())
def test_torn_off_anywhere_only_the_last_line_is_lost(events: list[tuple[int, bytes]], data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "take"
        whole = write(path, events)
        cut = data.draw(st.integers(0, len(whole)))
        path.write_bytes(whole[:cut])
        kept = whole[:cut].count(b"\n")
        if kept == 0:
            with pytest.raises(FileError, match=r"journal\.no_header"):
                read_journal(path)
            return
        journal = read_journal(path)
        expected = sorted(events[: kept - 1], key=lambda event: event[0])
        assert list(zip(journal.times_ns, journal.messages, strict=True)) == expected
        assert journal.complete == (kept == len(events) + 2)
        JournalWriter(str(path), HEADER, resumed=True).close()
        assert read_journal(path) == msgspec.structs.replace(journal, complete=False)


@given(
    st.lists(
        st.one_of(
            st.binary(max_size=40), st.from_regex(rb"(e|s|lost|back|end)( [0-9a-f.+-]{1,25}){0,3}", fullmatch=True)
        )
    )
)
def test_whatever_is_in_it_our_errors_tell(lines: list[bytes]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "take"
        header = write(path, []).splitlines()[0]
        path.write_bytes(b"\n".join([header, *lines, b""]))
        with contextlib.suppress(FileError):
            for one in passes(read_journal(path)):
                assert len(one.times_us) == len(one.messages)


SYNCS = st.lists(st.tuples(st.integers(0, 10**12), st.floats(-10, 3600), st.integers(0, 3)), min_size=1, max_size=12)


@given(SYNCS, st.lists(st.integers(-(10**11), 10**12), max_size=30))
def test_every_event_is_in_one_pass_at_the_time_that_a_slow_reckoning_finds(
    syncs: list[tuple[int, float, int]], times: list[int]
) -> None:
    numbers = sorted(number for _, _, number in syncs)
    points = [
        SyncPoint(ns, position, number)
        for (ns, position, _), number in zip(sorted(syncs, key=lambda row: row[0]), numbers, strict=True)
    ]
    times.sort()
    journal = Journal(HEADER, tuple(times), (b"\x90\x3c\x40",) * len(times), tuple(points), (), True)
    found = passes(journal)
    assert sum(len(one.times_us) for one in found) == len(times)
    assert [one.number for one in found] == sorted(set(numbers))
    place = 0
    for one in found:
        own = [point for point in points if point.pass_ == one.number]
        if len({point.ns for point in own}) < len(own):
            place += len(one.times_us)
            continue
        ns, position = np.array([point.ns for point in own]) / 1e9, [point.position_s for point in own]
        for time_us in one.times_us:
            at = times[place] / 1e9
            expected = float(np.interp(at, ns, position)) + min(at - ns[0], 0.0) + max(at - ns[-1], 0.0)
            assert abs(time_us / 1e6 - expected) < 1e-5
            place += 1
