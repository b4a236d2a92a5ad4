"""Journals are read as written, an incomplete one loses only its last line, and a hostile one raises the program's
errors.
"""

from __future__ import annotations

import errno
from pathlib import Path

import msgspec
import pytest

from app.capture.journal import Journal, JournalHeader, JournalWriter, SyncPoint, is_whole, read_journal
from app.capture.loop_passes import Pass, passes
from app.errors import FileError
from app.formats.locks import is_locked

HEADER = JournalHeader("quartet.suisou", "player-1", "EWI-USB MIDI 1", "ewi_usb", 0.012, "2026-11-21T18:00:00+09:00")
ON, OFF, BREATH = bytes([0x90, 60, 80]), bytes([0x80, 60, 64]), bytes([0xB0, 2, 70])
S = 1_000_000_000


def written(path: Path) -> Path:
    writer = JournalWriter(str(path), HEADER)
    writer.sync(10 * S, 0.0, 0)
    writer.event(10 * S, BREATH)
    writer.event(11 * S, ON)
    writer.mark("lost", 12 * S)
    writer.mark("back", 13 * S)
    writer.event(14 * S, OFF)
    writer.sync(15 * S, 5.0, 0)
    writer.mark("end", 15 * S)
    writer.close()
    return path


def test_what_is_written_is_read(tmp_path: Path) -> None:
    journal = read_journal(written(tmp_path / "take"))
    assert journal == Journal(
        header=HEADER,
        times_ns=(10 * S, 11 * S, 14 * S),
        messages=(BREATH, ON, OFF),
        syncs=(SyncPoint(10 * S, 0.0, 0), SyncPoint(15 * S, 5.0, 0)),
        gaps=((12 * S, 13 * S),),
        complete=True,
    )


def test_a_journal_is_never_written_over(tmp_path: Path) -> None:
    path = written(tmp_path / "take")
    before = path.read_bytes()
    with pytest.raises(FileError, match=r"journal\.exists"):
        JournalWriter(str(path), HEADER)
    assert path.read_bytes() == before


def test_another_recorder_goes_on_where_one_was_torn_off(tmp_path: Path) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.event(1 * S, ON)
    writer.close()
    with path.open("ab") as stream:
        stream.write(b"e 2000000000 9")
    writer = JournalWriter(str(path), HEADER, resumed=True)
    assert writer.count == 1
    writer.mark("lost", 3 * S)
    writer.event(4 * S, OFF)
    writer.close()
    journal = read_journal(path)
    assert journal.messages == (ON, OFF)
    assert journal.gaps == ((3 * S, None),)
    assert not journal.complete


def test_a_note_that_sounds_when_the_device_goes_away_ends_there_whatever_was_released_before(tmp_path: Path) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.sync(1 * S, 0.0, 0)
    # The end of a note that began before the recording.
    for second, message in enumerate((OFF, ON), start=1):
        writer.event(second * S, message)
    writer.mark("lost", 3 * S)
    writer.close()
    (taken,) = passes(read_journal(path))
    assert taken.messages == (OFF, ON, bytes([0x80, 60, 0]))
    assert taken.times_us[-1] == 2_000_000 - round(HEADER.latency_s * 1e6)


def test_another_recorder_begins_what_the_first_did_not(tmp_path: Path) -> None:
    for name, torn in (("not there", None), ("empty", b""), ("half a header", b'{"proj')):
        path = tmp_path / name
        if torn is not None:
            path.write_bytes(torn)
        writer = JournalWriter(str(path), HEADER, resumed=True)
        writer.event(4 * S, OFF)
        writer.close()
        assert read_journal(path).messages == (OFF,)


def test_what_would_make_a_journal_unreadable_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.sync(5 * S, 1.0, 1)
    writer.sync(4 * S, 2.0, 0)
    writer.sync(6 * S, float("nan"), 1)
    writer.mark("end", 7 * S)
    writer.close()
    # The recorder was killed before it could say that it had finished.
    writer = JournalWriter(str(path), HEADER, resumed=True)
    writer.mark("lost", 8 * S)
    writer.sync(4 * S, 3.0, 0)
    writer.mark("end", 9 * S)
    writer.close()
    journal = read_journal(path)
    assert journal.syncs == (SyncPoint(5 * S, 1.0, 1), SyncPoint(5 * S, 2.0, 1), SyncPoint(5 * S, 3.0, 1))
    assert journal.complete


def test_who_finds_it_knows_whether_it_still_runs(tmp_path: Path) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.write()
    assert is_locked(path)
    assert read_journal(path).times_ns == ()
    writer.close()
    assert not is_locked(path)


def test_a_full_disk_loses_nothing_once_there_is_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.write()
    file, left = writer._file, [7]

    class Full:
        def write(self, data: bytearray) -> int:
            if left[0] == 0:
                raise OSError(errno.ENOSPC, "No space left on device")
            count = file.write(bytes(data[: left[0]]))
            left[0] = 0
            return count

    monkeypatch.setattr(writer, "_file", Full())
    writer.event(1 * S, ON)
    for _ in range(2):
        with pytest.raises(OSError, match="No space"):
            writer.write()
    monkeypatch.undo()
    writer.event(2 * S, OFF)
    writer.close()
    assert read_journal(path).messages == (ON, OFF)


@pytest.mark.parametrize("message", [ON, OFF, BREATH, b"\xc0\x05", b"\xd3\x7f", b"\xe0\x00\x40", b"\xaf\x01\x02"])
def test_whole_messages(message: bytes) -> None:
    assert is_whole(message)
    for wrong in (message[:-1], message + b"\x00", message[:-1] + b"\x80", b"\x10" + message[1:], b""):
        assert not is_whole(wrong)


@pytest.mark.parametrize("message", [b"\xf8", b"\xf0\x47\x7f\xf7", b"\xf2\x00\x00"])
def test_the_system_s_messages_are_of_no_channel(message: bytes) -> None:
    assert not is_whole(message)


@pytest.mark.parametrize(
    ("line", "detail"),
    [
        (b"e 5 90", "no message"),
        (b"e 5 f07ef7", "no message"),
        (b"e 5 9x3c50", "hexadecimal"),
        (b"e 5", "too few"),
        (b"e 5 903c50 7", "too few"),
        (b"e five 903c50", "int"),
        (b"e 99999999999999999999 903c50", "no moment"),
        (b"e " + b"9" * 5000 + b" 903c50", "no moment"),
        (b"s 5 nan 0", "no place"),
        (b"s 5 1e300 0", "no place"),
        (b"s 1 0.0 0", "goes back"),
        (b"back 5", "never lost"),
        (b"end 5\ne 6 903c50", "had ended"),
        (b"", "no word"),
        (b"\xff\xfe 5", "ASCII"),
        (b"play 5", "no word"),
    ],
)
def test_a_wrong_line_is_reported_with_its_place(tmp_path: Path, line: bytes, detail: str) -> None:
    path = tmp_path / "take"
    writer = JournalWriter(str(path), HEADER)
    writer.sync(2, 0.0, 0)
    writer.close()
    with path.open("ab") as stream:
        stream.write(line + b"\n")
    with pytest.raises(FileError, match=r"journal\.line") as caught:
        read_journal(path)
    assert caught.value.message.arguments["line"] == 3 + line.count(b"\n")
    assert caught.value.message.arguments["file"] == str(path)
    assert detail in str(caught.value.message.arguments["detail"])


@pytest.mark.parametrize(
    "data", [b"", b"\n", b"MThd\x00", b"[]\n", b"{}\n", b'{"version": "x"}\n', b"[" * 10**5 + b"\n"]
)
def test_what_is_no_journal_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "take"
    path.write_bytes(data)
    with pytest.raises(FileError, match=r"journal\.no_header"):
        read_journal(path)


def test_a_newer_journal_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "take"
    path.write_bytes(b'{"version": 2, "what": "ever"}\n')
    with pytest.raises(FileError, match=r"journal\.newer"):
        read_journal(path)
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        read_journal(tmp_path / "not there")


def of(
    *, syncs: list[tuple[float, float, int]], events_s: list[float], gaps_s: list[tuple[float, float | None]]
) -> Journal:
    return Journal(
        header=HEADER,
        times_ns=tuple(round(at * S) for at in events_s),
        messages=(ON,) * len(events_s),
        syncs=tuple(SyncPoint(round(at * S), position, number) for at, position, number in syncs),
        gaps=tuple((round(a * S), None if b is None else round(b * S)) for a, b in gaps_s),
        complete=True,
    )


def test_the_performance_s_time_is_interpolated_and_the_latency_taken_off() -> None:
    # Heard at half speed from 100 to 102 s, then as a clock goes.
    journal = of(syncs=[(100, 1.0, 0), (102, 2.0, 0)], events_s=[99.012, 100.012, 101.012, 103.012], gaps_s=[])
    assert passes(journal) == (Pass(0, (0, 1_000_000, 1_500_000, 3_000_000), (ON,) * 4),)


def test_before_the_first_moment_time_goes_back() -> None:
    journal = of(syncs=[(100, 0.0, 0)], events_s=[98.012, 100.512], gaps_s=[])
    assert passes(journal)[0].times_us == (-2_000_000, 500_000)


def test_a_loop_s_return_begins_another_pass() -> None:
    syncs = [(10, 4.0, 0), (12, 6.0, 0), (12, 4.0, 1), (14, 6.0, 1), (14, 4.0, 2)]
    journal = of(syncs=syncs, events_s=[10.512, 12.011, 12.013, 14.212], gaps_s=[(11.512, 12.512), (14.112, None)])
    off = bytes((0x80 | ON[0] & 0x0F, ON[1], 0))
    first, second, third = passes(journal)
    assert first == Pass(0, (4_500_000, 5_500_000, 5_999_000), (ON, off, ON))
    # A note held when the loop returns ends when the device is lost, in the pass heard then.
    assert second == Pass(1, (4_001_000,), (ON,))
    # Struck twice, it sounds once.
    assert third == Pass(2, (4_100_000, 4_200_000), (off, ON))


def test_what_sounded_when_the_device_went_away_ends_there_and_nothing_else() -> None:
    sent = [(10.0, "903c50"), (10.1, "923e50"), (10.2, "903c00"), (10.5, "b00240"), (14.0, "823e00"), (15.0, "903c50")]
    journal = Journal(
        header=msgspec.structs.replace(HEADER, latency_s=0.0),
        times_ns=tuple(round(at * S) for at, _ in sent),
        messages=tuple(bytes.fromhex(raw) for _, raw in sent),
        syncs=(SyncPoint(10 * S, 0.0, 0), SyncPoint(20 * S, 10.0, 0)),
        gaps=((11 * S, 13 * S), (12 * S, 13 * S), (16 * S, None)),
        complete=True,
    )
    (found,) = passes(journal)
    ends = [(at, raw.hex()) for at, raw in zip(found.times_us, found.messages, strict=True) if raw[0] >> 4 == 8]
    assert ends == [(1_000_000, "823e00"), (4_000_000, "823e00"), (6_000_000, "803c00")]
    assert len(found.messages) == len(sent) + 2


def test_a_return_that_is_not_said_to_the_moment_lies_in_the_middle() -> None:
    journal = of(syncs=[(10, 5.9, 0), (10.1, 4.0, 1)], events_s=[10.012 + 0.049, 10.012 + 0.051], gaps_s=[])
    first, second = passes(journal)
    assert first.times_us == (5_949_000,)
    assert second.times_us == (3_951_000,)


def test_without_playback_there_is_no_pass() -> None:
    assert passes(of(syncs=[], events_s=[1.0], gaps_s=[])) == ()
