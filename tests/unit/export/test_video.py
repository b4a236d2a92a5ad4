"""Films, read back by the encoder's own reader."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest

from app.errors import FileError
from app.export import video
from app.export.tree import clean_up
from app.export.video import video_into
from app.formats.cache import CACHE_VARIABLE
from app.formats.temporary_folders import scratch_places

SIZE = (64, 48)


def ffmpeg(*arguments: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), *arguments], capture_output=True, check=False)


def film(path: Path, pictures: int, stop: bool = False) -> None:
    with video_into(path, SIZE, Fraction(24)) as writer:
        for _ in range(pictures):
            writer.write(picture(1))
        if stop:
            raise KeyboardInterrupt


def picture(index: int) -> np.ndarray:
    image = np.zeros((SIZE[1], SIZE[0], 4), np.uint8)
    image[..., 0] = 10 * index
    image[: SIZE[1] // 2, :, 1] = 200
    image[..., 3] = 255
    return image


@pytest.mark.parametrize("fps", [Fraction(24), Fraction(30000, 1001)])
def test_a_film_has_its_pictures_rate_and_sound(tmp_path: Path, fps: Fraction) -> None:
    path = tmp_path / "演奏 'x'.mp4"
    sound = (0.3 * np.sin(np.arange(48_000) / 20.0)).astype(np.float32)
    with video_into(path, SIZE, fps, np.stack([sound, sound], axis=1)) as writer:
        for index in range(20):
            writer.write(picture(index))
    reported = ffmpeg("-i", str(path)).stderr
    assert b"64x48" in reported
    assert f"{float(fps):.4g} fps".encode() in reported
    assert b"Audio: aac" in reported
    assert b"Video: h264" in reported
    raw = ffmpeg("-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-").stdout
    images = np.frombuffer(raw, np.uint8).reshape(-1, SIZE[1], SIZE[0], 3)
    assert len(images) == 20
    # The upper half is green, so the first row is on top.
    assert images[10][5, 5, 1] > 150 > images[10][-5, 5, 1]
    assert abs(int(images[15][-5, 5, 0]) - 150) < 20


def test_a_film_that_was_stopped_is_not_there_and_the_old_one_stays(tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    path.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt):
        film(path, 1, stop=True)
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["film.mp4"]


def test_an_encoder_that_refuses_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(video, "_command", lambda *given: [sys.executable, "-c", "import sys; sys.exit('no room')"])
    with pytest.raises(FileError) as refused:
        film(tmp_path / "film.mp4", 2000)
    assert refused.value.message.id == "video.failed"
    assert refused.value.message.arguments == {"file": str(tmp_path / "film.mp4"), "detail": "no room"}
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_reported_without_the_encoders_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reason = os.strerror(errno.ENOSPC)
    says = f"import sys; sys.exit('[out#0/mp4 @ 0x3be] Error writing trailer: {reason}')"
    monkeypatch.setattr(video, "_command", lambda *given: [sys.executable, "-c", says])
    with pytest.raises(FileError) as refused:
        film(tmp_path / "film.mp4", 2000)
    assert refused.value.message.id == "file.cannot_write"
    assert refused.value.message.arguments == {"file": str(tmp_path / "film.mp4"), "reason": reason}


def test_a_folder_that_is_missing_is_reported_and_not_made(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"file\.cannot_write.*missing"):
        film(tmp_path / "missing" / "film.mp4", 1)
    assert list(tmp_path.iterdir()) == []


KILLED = """
import sys
from fractions import Fraction
from pathlib import Path
import numpy as np
from app.export.video import video_into
with video_into(Path(sys.argv[1]), (64, 48), Fraction(24), np.zeros((48_000, 2), np.float32)) as film:
    for _ in range(12):
        film.write(np.zeros((48, 64, 3), np.uint8))
    print("making", flush=True)
    input()
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
def test_what_is_left_of_a_film_whose_maker_was_killed_goes_with_the_next_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    folder = tmp_path / "films"
    folder.mkdir()
    (folder / "film.mp4").write_bytes(b"old")
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(folder / "film.mp4")],
        cwd=Path(__file__).parents[3],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    with process.stdin, process.stdout as stdout:
        assert stdout.readline() == b"making\n"
        clean_up()
        assert len(list(folder.iterdir())) == 2, "one that is being made stays"
        process.kill()
        process.wait()
    clean_up()
    assert [path.name for path in folder.iterdir()] == ["film.mp4"]
    assert (folder / "film.mp4").read_bytes() == b"old"
    assert not [path for place in scratch_places() if place.is_relative_to(tmp_path) for path in place.iterdir()]
