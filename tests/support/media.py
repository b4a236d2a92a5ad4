"""Sound and film files made by ffmpeg for tests, some of them damaged or hostile."""

from __future__ import annotations

import subprocess
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import soundfile


def ffmpeg(*arguments: str) -> None:
    subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-y", *arguments], check=True)


def clicks(path: Path, rate_hz: int, at_s: tuple[float, ...] = (1.0, 3.0), length_s: float = 4.0) -> Path:
    """Write short tones separated by silence to a WAV file."""
    sound = np.zeros(round(length_s * rate_hz))
    burst = 0.8 * np.sin(2.0 * np.pi * 1000.0 * np.arange(round(0.05 * rate_hz)) / rate_hz)
    for second in at_s:
        sound[round(second * rate_hz) :][: len(burst)] = burst
    soundfile.write(path, sound, rate_hz)
    return path


def heard_s(samples: np.ndarray, around_s: float, rate_hz: int) -> float:
    """Time in seconds at which a tone begins near a given time."""
    first = max(round((around_s - 0.3) * rate_hz), 0)
    loud = np.abs(samples[first : first + round(0.8 * rate_hz), 0].astype(np.int64)) > 8000
    return (first + int(loud.argmax())) / rate_hz


def with_gap(path: Path, gap_s: float, pictures: bool = False, length_s: float = 0.4, codec: str = "aac") -> Path:
    """Write a film with a tone and pictures whose time stamps jump in the middle."""
    later = f"PTS+gt(T\\,{length_s / 2})*{gap_s}/TB"
    inputs = ["-f", "lavfi", "-i", f"sine=440:r=48000:d={length_s}"]
    if pictures:
        inputs += ["-f", "lavfi", "-i", f"testsrc=s=64x64:r=25:d={length_s}", "-vf", f"setpts={later}"]
    ffmpeg(*inputs, "-af", f"asetpts={later}", "-fps_mode", "passthrough", "-c:a", codec, str(path))
    return path
