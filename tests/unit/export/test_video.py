"""Films: read back by the encoder's own reader."""

from __future__ import annotations

import subprocess
from fractions import Fraction
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest

from app.errors import FileError
from app.export.video import video_into

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
    told = ffmpeg("-i", str(path)).stderr
    assert b"64x48" in told
    assert f"{float(fps):.4g} fps".encode() in told
    assert b"Audio: aac" in told
    assert b"Video: h264" in told
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


def test_an_encoder_that_refuses_is_told(tmp_path: Path) -> None:
    path = tmp_path / "missing" / "film.mp4"
    with pytest.raises(FileError) as refused:
        film(path, 2000)
    assert refused.value.message.id == "video.failed"
    assert "missing" in str(refused.value.message.arguments["file"])
