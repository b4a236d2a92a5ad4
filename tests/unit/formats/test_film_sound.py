"""Sound of films: it has the film's time, and the size claimed by a file is checked before memory is allocated."""

from __future__ import annotations

import os
import resource
import signal
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.child_limits import ChildLimits
from app.errors import FileError
from app.formats.ffmpeg import refusal
from app.formats.film_sound import film_sound
from app.formats.video import video_facts
from tests.support.media import clicks, ffmpeg, heard_s, with_gap

RATE_HZ = 48000
pytestmark = pytest.mark.skipif(os.name != "posix", reason="counts what children use")


class TooMuch(Exception):
    """Raised by a check of the test."""


def at_most(seconds: float) -> Callable[[float], None]:
    def check(reached_s: float) -> None:
        if reached_s > seconds:
            raise TooMuch

    return check


@pytest.mark.parametrize("name", ["gap.mp4", "gap.mkv", "gap.mov"])
def test_a_gap_in_time_is_counted_before_it_is_filled(tmp_path: Path, name: str) -> None:
    path = with_gap(tmp_path / name, 3600.0, pictures=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with pytest.raises(TooMuch):
        film_sound(str(path), RATE_HZ, at_most(600.0))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime - before.ru_utime < 5.0
    assert video_facts(str(path)).has_sound


def test_a_short_gap_is_silence_of_its_length(tmp_path: Path) -> None:
    samples = film_sound(str(with_gap(tmp_path / "gap.m4a", 7.0)), RATE_HZ, at_most(60.0))
    loud = np.abs(samples[:, 0].astype(np.int64)) > 500
    assert len(samples) / RATE_HZ == pytest.approx(7.4, abs=0.05)
    assert loud[: RATE_HZ // 6].mean() > 0.7
    assert not loud[RATE_HZ : 7 * RATE_HZ].any()
    assert loud[-RATE_HZ // 6 : -RATE_HZ // 12].mean() > 0.7


def test_what_is_heard_twice_at_a_time_is_heard_once(tmp_path: Path) -> None:
    # A splice: according to its time stamps the second half begins half a second before the first half ends.
    plain = clicks(tmp_path / "plain.wav", RATE_HZ, (1.0, 3.0))
    ffmpeg("-i", str(plain), "-af", "asetpts=PTS-gt(T\\,2)*0.5/TB", "-c:a", "pcm_s16le", str(tmp_path / "back.mkv"))
    samples = film_sound(str(tmp_path / "back.mkv"), RATE_HZ, at_most(60.0))
    assert len(samples) / RATE_HZ == pytest.approx(3.5, abs=0.05)
    assert heard_s(samples, 1.0, RATE_HZ) == pytest.approx(1.0, abs=0.005)
    assert heard_s(samples, 2.5, RATE_HZ) == pytest.approx(2.5, abs=0.03)


@pytest.mark.parametrize("name", ["film.ts", "film.m2ts", "film.mp4"])
def test_a_transport_stream_is_refused_by_what_it_is(tmp_path: Path, name: str) -> None:
    made = tmp_path / ("a.m2ts" if name.endswith("m2ts") else "a.ts")
    options = ("-mpegts_m2ts_mode", "1") if name.endswith("m2ts") else ()
    ffmpeg("-f", "lavfi", "-i", "sine=440:d=1", "-c:a", "mp2", "-f", "mpegts", *options, str(made))
    path = made.rename(tmp_path / name)
    for read in (lambda: film_sound(str(path), RATE_HZ, at_most(60.0)), lambda: video_facts(str(path))):
        with pytest.raises(FileError, match=r"video\.transport_stream"):
            read()


def test_a_reader_that_is_ended_at_a_limit_is_worded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = clicks(tmp_path / "a.wav", RATE_HZ)
    ffmpeg("-i", str(path), str(tmp_path / "a.m4a"))
    monkeypatch.setattr("app.child_limits.LIMITS", {"ffmpeg.sound": ChildLimits(16 * 2**20)})
    with pytest.raises(FileError, match=r"video\.(too_costly|reader_ended)"):
        film_sound(str(tmp_path / "a.m4a"), RATE_HZ, at_most(60.0))


@pytest.mark.parametrize(
    ("report", "status", "id"),
    [
        (b"", -signal.SIGSEGV, "video.reader_ended"),
        (b"", -signal.SIGXCPU, "video.too_costly"),
        (b"", 0xC0000005, "video.reader_ended"),
        (b"[x @ 0x1] Error: Cannot allocate memory\nConversion failed!\n", 244, "video.too_costly"),
        (b"[x @ 0x1] moov atom not found\nError opening input file file:/a.\n", 183, "video.not_readable"),
        (b"", 1, "video.not_readable"),
    ],
)
def test_the_end_of_a_reader_is_worded(report: bytes, status: int, id: str) -> None:
    assert refusal(report, "/a", status).message.id == id
