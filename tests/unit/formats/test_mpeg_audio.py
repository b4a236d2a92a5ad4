"""MPEG audio without a header: counted frames compared with encoders' output."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.formats.mpeg_audio import mpeg_audio
from tests.support.media import clicks, ffmpeg

HEADLESS = ("-write_xing", "0")


@pytest.mark.parametrize(
    ("rate_hz", "samples"), [(48000, 1152), (44100, 1152), (32000, 1152), (22050, 576), (16000, 576)]
)
@pytest.mark.parametrize("quality", [("-b:a", "64k"), ("-q:a", "5")])
def test_frames_are_counted(tmp_path: Path, rate_hz: int, samples: int, quality: tuple[str, str]) -> None:
    source, path = clicks(tmp_path / "a.wav", rate_hz), tmp_path / "a.mp3"
    ffmpeg("-i", str(source), "-c:a", "libmp3lame", *quality, *HEADLESS, str(path))
    data = path.read_bytes()
    facts = mpeg_audio(data)
    assert facts.rate_hz == rate_hz
    assert not facts.breaks_off
    assert 4 * rate_hz < facts.samples < 4 * rate_hz + 1105 + 2 * samples
    # A tag at the end is no frame; half of the last frame is a cut.
    assert mpeg_audio(data + b"TAG" + bytes(125)) == facts
    cut = mpeg_audio(data[:-20])
    assert cut.breaks_off
    assert cut.samples == facts.samples - samples


def test_what_lies_between_frames_is_passed_over(tmp_path: Path) -> None:
    source, path = clicks(tmp_path / "a.wav", 44100), tmp_path / "a.mp3"
    ffmpeg("-i", str(source), "-c:a", "libmp3lame", "-b:a", "128k", "-id3v2_version", "0", *HEADLESS, str(path))
    data = path.read_bytes()
    whole = mpeg_audio(data)
    second = data.index(data[:2], 417 * 3)
    broken = mpeg_audio(data[:second] + b"junk \xff\xfb junk" * 50 + data[second:])
    assert abs(broken.samples - whole.samples) <= 2 * 1152


def test_a_header_is_left_to_the_decoder_and_other_files_are_none(tmp_path: Path) -> None:
    source, path = clicks(tmp_path / "a.wav", 44100), tmp_path / "a.mp3"
    ffmpeg("-i", str(source), "-c:a", "libmp3lame", str(path))
    assert mpeg_audio(path.read_bytes()) is None
    assert mpeg_audio(source.read_bytes()) is None
    assert mpeg_audio(b"\xff\xfb\x90\x00") is None
    assert mpeg_audio(b"") is None
