"""Kinds of files by content, regardless of name."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.formats.media_kind import MediaKind, kind_of, media_kind, tag_bytes
from tests.support.media import clicks, ffmpeg

KINDS = {
    "a.wav": MediaKind.SOUND,
    "a.flac": MediaKind.SOUND,
    "a.ogg": MediaKind.SOUND,
    "a.opus": MediaKind.SOUND,
    "a.mp3": MediaKind.SOUND,
    "a.aiff": MediaKind.SOUND,
    "a.m4a": MediaKind.FILM,
    "a.mov": MediaKind.FILM,
    "a.mkv": MediaKind.FILM,
    "a.avi": MediaKind.FILM,
    "a.wma": MediaKind.FILM,
    "a.mpg": MediaKind.FILM,
    "a.aac": MediaKind.ADTS,
    "a.ts": MediaKind.TRANSPORT,
}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("media")
    wave = clicks(folder / "source.wav", 44100, (0.5,), 1.5)
    outputs = [part for name in KINDS for part in ("-map", "0:a", str(folder / name))]
    ffmpeg("-i", str(wave), *outputs)
    return folder


@pytest.mark.parametrize(("name", "kind"), KINDS.items())
def test_the_content_decides(files: Path, tmp_path: Path, name: str, kind: MediaKind) -> None:
    content = (files / name).read_bytes()
    path = tmp_path / "named.xyz"
    path.write_bytes(content)
    assert media_kind(str(path)) is kind


def test_a_tag_is_passed_over(files: Path, tmp_path: Path) -> None:
    tag = b"ID3\x04\0\0" + bytes((0, 8, 0, 0)) + bytes(8 << 14)
    assert tag_bytes(tag) == len(tag)
    path = tmp_path / "tagged.mp3"
    path.write_bytes(tag + (files / "a.aac").read_bytes())
    assert media_kind(str(path)) is MediaKind.ADTS


@pytest.mark.parametrize("content", [b"", b"ID3", b"G", b"\xff", b"RIFF", bytes(1000)])
def test_what_no_one_knows_is_left_to_the_reader_of_sound(content: bytes) -> None:
    assert kind_of(content) is MediaKind.SOUND
