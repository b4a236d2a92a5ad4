"""Reading films: the picture displayed at each time, in films whose pictures contain their index."""

from __future__ import annotations

import os
import subprocess
from fractions import Fraction
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest

from app.child_limits import ChildLimits
from app.errors import Cancelled, FileError
from app.formats.film_sound import film_sound
from app.formats.video import VideoFacts, VideoPictures, video_facts, video_pictures
from tests.support.films import SIZE, number_of, written

PICTURES = 200
PLACES = (0, 1, 2, 47, 99, 100, 198, 199)


def converted(source: Path, to: Path, *options: str) -> Path:
    subprocess.run(
        [imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-i", str(source), *options, str(to)], check=True
    )
    return to


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> Path:
    sound = np.zeros((PICTURES * 2000, 2), np.float32)
    sound[96_000:][:480] = 0.8
    return written(tmp_path_factory.mktemp("film") / "演奏 %d 'x'.mp4", Fraction(24), PICTURES, sound)


def numbers_from(path: Path, first: int, count: int = 3) -> list[int]:
    facts = video_facts(str(path))
    with video_pictures(str(path), facts.rate, SIZE, first) as pictures:
        read = [picture for _ in range(count) if (picture := pictures.read()) is not None]
    return [number_of(picture) for picture in read]


@pytest.mark.parametrize("rate", [Fraction(24), Fraction(30000, 1001), Fraction(60)])
def test_any_picture_is_found_and_what_follows_it(tmp_path: Path, rate: Fraction) -> None:
    path = written(tmp_path / "film.mp4", rate, PICTURES)
    assert video_facts(str(path)).rate == rate
    for place in PLACES:
        assert numbers_from(path, place) == list(range(place, min(place + 3, PICTURES)))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("film.mkv", ("-c:v", "libx264", "-bf", "3", "-g", "60")),
        ("film.webm", ("-c:v", "libvpx", "-crf", "8", "-b:v", "2M")),
        ("film.avi", ("-c:v", "mpeg4")),
        ("film.mov", ("-c:v", "mjpeg")),
    ],
)
def test_cameras_and_browsers_write_other_files(
    film: Path, tmp_path: Path, name: str, options: tuple[str, ...]
) -> None:
    path = converted(film, tmp_path / name, "-an", *options)
    assert not video_facts(str(path)).has_sound
    for place in PLACES:
        assert numbers_from(path, place) == list(range(place, min(place + 3, PICTURES)))


def test_pictures_can_be_sampled_at_another_rate(film: Path) -> None:
    with video_pictures(str(film), Fraction(12), SIZE, 5) as pictures:
        assert [number_of(picture) for _ in range(4) if (picture := pictures.read()) is not None] == [10, 12, 14, 16]


def any_length(seconds: float) -> None:
    """No check."""


def test_facts_of_a_film(film: Path) -> None:
    facts = video_facts(str(film))
    assert facts.duration_s == pytest.approx(PICTURES / 24, abs=0.05)
    assert facts == VideoFacts(*SIZE, Fraction(24), facts.duration_s, True)
    assert facts.fitted(32, 32) == (32, 24)
    assert facts.fitted(1000, 1000) == SIZE


def test_a_phone_held_upright(film: Path, tmp_path: Path) -> None:
    turned = converted(film, tmp_path / "turned.mp4", "-c", "copy")
    upright = tmp_path / "upright.mp4"
    subprocess.run(
        [
            *(imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-display_rotation", "90"),
            *("-i", str(turned), "-c", "copy", str(upright)),
        ],
        check=True,
    )
    facts = video_facts(str(upright))
    assert (facts.width, facts.height) == (SIZE[1], SIZE[0])


def test_sound_keeps_the_time_of_the_pictures(film: Path, tmp_path: Path) -> None:
    # The sound begins a second after the pictures.
    later = tmp_path / "later.mkv"
    command = ["-i", str(film), "-itsoffset", "1.0", "-i", str(film), "-map", "0:v", "-map", "1:a", "-c", "copy"]
    subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", *command, str(later)], check=True)
    for path, click_s in ((film, 2.0), (later, 3.0)):
        samples = film_sound(str(path), 48000, any_length)
        assert samples.shape[1] == 2
        assert np.argmax(np.abs(samples[:, 0].astype(np.int64)) > 10_000) / 48000 == pytest.approx(click_s, abs=0.005)


def test_reading_can_be_stopped(film: Path) -> None:
    with pytest.raises(Cancelled):
        film_sound(str(film), 48000, any_length, lambda: True)


def test_a_playlist_opens_no_other_file(film: Path, tmp_path: Path) -> None:
    for name, text in (
        ("list.m3u8", f"#EXTM3U\n#EXTINF:1,\n{film}\n"),
        ("list.mp4", f"ffconcat version 1.0\nfile '{film}'\n"),
        ("list.mkv", "http://127.0.0.1:9/film.mp4\n"),
    ):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        with pytest.raises(FileError, match=r"video\.not_readable"):
            video_facts(str(path))


@pytest.mark.parametrize("content", [b"", b"RIFF", b"\0" * 4096, bytes(range(256)) * 64])
def test_what_is_no_film_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "film.mp4"
    path.write_bytes(content)
    with pytest.raises(FileError, match=r"video\.not_readable") as refused:
        video_facts(str(path))
    assert str(path) in str(refused.value)


def test_sound_or_pictures_can_be_absent(film: Path, tmp_path: Path) -> None:
    # A title that looks like a report of ffmpeg changes nothing.
    title = "title=a\n  Stream #0:5: Video: h264\n  Duration: 09:00:00.00"
    heard = converted(film, tmp_path / "heard.m4a", "-vn", "-metadata", title)
    with pytest.raises(FileError, match=r"video\.no_pictures"):
        video_facts(str(heard))
    silent = converted(film, tmp_path / "silent.mp4", "-an", "-c:v", "copy", "-metadata", title)
    assert video_facts(str(silent)).duration_s < 10.0
    with pytest.raises(FileError, match=r"video\.no_sound"):
        film_sound(str(silent), 48000, any_length)


def test_half_a_file_gives_the_pictures_it_has(film: Path, tmp_path: Path) -> None:
    whole = converted(film, tmp_path / "whole.mkv", "-c:v", "mjpeg", "-an")
    half = tmp_path / "half.mkv"
    half.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    assert numbers_from(half, 0) == [0, 1, 2]
    assert numbers_from(half, 190) == []


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        video_facts(str(tmp_path / "gone.mp4"))
    with pytest.raises(FileError, match=r"file\.not_regular"):
        video_facts(str(tmp_path))


@pytest.mark.skipif(os.name != "posix", reason="Windows has jobs")
def read_to_end(pictures: VideoPictures) -> None:
    while pictures.read() is not None:
        pass


def test_pictures_whose_reader_is_ended_are_worded_and_those_that_are_stopped_are_not(
    film: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with video_pictures(str(film), Fraction(24), SIZE) as pictures:
        assert pictures.read() is not None
        pictures.stop()
        read_to_end(pictures)
    monkeypatch.setattr("app.child_limits.LIMITS", {"ffmpeg.pictures": ChildLimits(2**30, cpu_s=1.0)})
    with (
        video_pictures(str(film), Fraction(48000), (1920, 1080)) as pictures,
        pytest.raises(FileError, match=r"video\.too_costly"),
    ):
        read_to_end(pictures)
