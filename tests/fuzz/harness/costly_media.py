"""Small sound and film files made by ffmpeg that require far more memory or time than their size suggests."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Final

from tests.support.media import ffmpeg

_BYTES_PER_S: Final = 2000
"""Approximate rate of sound and pictures in bytes per second."""


def _made(name: str, *arguments: str) -> bytes:
    with tempfile.TemporaryDirectory(prefix="suisou-fuzz-") as folder:
        path = Path(folder) / name
        ffmpeg(*arguments, str(path))
        return path.read_bytes()


def _tone(size: int) -> tuple[str, ...]:
    return "-f", "lavfi", "-i", f"sine=440:r=8000:d={max(size / _BYTES_PER_S, 0.3):.2f}"


def _pictures(size: int, side: int = 64) -> tuple[str, ...]:
    return "-f", "lavfi", "-i", f"color=red:s={side}x{side}:r=25:d={max(size / _BYTES_PER_S, 0.3):.2f}"


def m4a_gap(size: int) -> bytes:
    """A day that passes after the first blocks of sound."""
    return _made("a.m4a", *_tone(size), "-af", "asetpts=PTS+gt(N\\,3)*86400/TB", "-c:a", "aac")


def m4a_gaps(size: int) -> bytes:
    """A minute that passes after every block of sound."""
    return _made("a.m4a", *_tone(size), "-af", "asetpts=PTS+N*60/TB", "-c:a", "aac")


def m4a_minutes(size: int) -> bytes:
    """A gap as long as it may be."""
    return _made("a.m4a", *_tone(size), "-af", "asetpts=PTS+gt(N\\,3)*550/TB", "-c:a", "aac")


def mkv_days(size: int) -> bytes:
    """Two weeks that pass after the first blocks of sound."""
    return _made("a.mkv", *_tone(size), "-af", "asetpts=PTS+gt(N\\,3)*1200000/TB", "-c:a", "aac")


def mkv_gap(size: int) -> bytes:
    """Hours that pass in sound and pictures."""
    later = ("-vf", "setpts=PTS+gt(N\\,3)*36000/TB", "-af", "asetpts=PTS+gt(N\\,3)*36000/TB")
    coded = ("-fps_mode", "passthrough", "-c:v", "libx264", "-c:a", "aac")
    return _made("a.mkv", *_pictures(size // 2), *_tone(size // 2), *later, *coded)


def mp4_late_sound(size: int) -> bytes:
    """Sound that begins hours after the pictures."""
    late = ("-map", "0:v", "-map", "1:a", "-c:v", "libx264", "-c:a", "aac", "-af", "asetpts=PTS+20000/TB")
    return _made("a.mp4", *_pictures(size // 2), *_tone(size // 2), *late)


def mkv_large_pictures(size: int) -> bytes:
    """Pictures of 64 million pixels, all alike."""
    coded = ("-frames:v", str(max(size // 10_000, 1)), "-c:v", "png", "-pred", "none", "-pix_fmt", "monob")
    return _made("a.mkv", *_pictures(size, 8192), *coded)


def transport(size: int) -> bytes:
    """A transport stream, at which the ffmpeg 7.0.2 of Linux crashes."""
    return _made("a.ts", *_tone(size), "-c:a", "mp2")


def mp3_slow(size: int) -> bytes:
    """Silence at 8 kbit/s without a header."""
    silence = ("-f", "lavfi", "-i", f"anullsrc=r=8000:cl=mono:d={size / 1000:.2f}")
    return _made("a.mp3", *silence, "-c:a", "libmp3lame", "-b:a", "8k", "-write_xing", "0", "-id3v2_version", "0")


COSTLY_MEDIA: Final[dict[str, tuple[Callable[[int], bytes], ...]]] = {
    "film": (mkv_gap, mp4_late_sound, mkv_large_pictures, transport),
}
"""The same as `tests.fuzz.harness.costly_files.COSTLY_FILES`."""
COSTLY_RECORDINGS: Final = (m4a_gap, m4a_gaps, m4a_minutes, mkv_days, mkv_gap, mp4_late_sound, transport, mp3_slow)
"""Costly files of the kind "audio"."""
