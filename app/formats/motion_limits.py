"""Limits of the motion in a file: few keys can stand for many frames, so frames are counted before any is made."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from app.errors import FileError

FPS: Final = (1, 1000)
"""Frame rates that motion is captured, animated or played at."""
KEPT_FPS: Final = Fraction(60)
"""Lowest frame rate that a motion is kept at, and the one of the motions that a model is learned from."""
FREE_FRAMES, FRAMES_PER_KB = 54_000, 50
"""Frames of any file, a quarter of an hour at 60 frames per second, and more for its size. A frame of a body that is
written out takes more than a hundred bytes in every format, so only what is sampled between keys meets this bound."""
FREE_TRANSFORMS, TRANSFORMS_PER_KB = 2**20, 512
"""Frames times nodes that a file may have: a free allowance, plus this many for each kilobyte of its size."""
MOST_TRANSFORMS: Final = 2**23
"""Frames times nodes of a file of any size: a quarter of an hour of 150 nodes at 60 frames per second."""


def longest_motion_s(fps: float, nodes: int, size_bytes: int) -> float:
    """Return how long a motion of a file of this size may be, sampled at a rate and kept at no less than `KEPT_FPS`."""
    most_frames = FREE_FRAMES + FRAMES_PER_KB * size_bytes // 1000
    most_transforms = min(MOST_TRANSFORMS, FREE_TRANSFORMS + TRANSFORMS_PER_KB * size_bytes // 1000)
    return min((most_frames - 1) / max(fps, float(KEPT_FPS)), (most_transforms // max(nodes, 1) - 1) / fps)


def require_frames(file: str, seconds: float, fps: float, nodes: int, size_bytes: int) -> None:
    """Refuse a motion that would have more frames than its file is good for.

    Parameters
    ----------
    seconds, fps : float
        Its duration, and the rate at which it is to be sampled.
    nodes : int
        Nodes that are sampled in each frame.
    size_bytes : int
        Of the file.

    Raises
    ------
    FileError
        ``motion.too_long``.
    """
    most_s = longest_motion_s(fps, nodes, size_bytes)
    # A comparison that a NaN fails.
    if not seconds <= most_s:
        said = {"seconds": round(float(seconds), 1), "most": round(most_s, 1)}
        raise FileError("motion.too_long", file=file, nodes=nodes, **said)


def require_rate(fps: Fraction, file: str) -> None:
    """Refuse a frame rate that no motion has. Raises FileError (``motion.rate_impossible``)."""
    slowest, fastest = FPS
    if not slowest <= fps <= fastest:
        frame_s = float(f"{float(1 / fps):.6g}")
        raise FileError("motion.rate_impossible", file=file, frame_s=frame_s, slowest=slowest, fastest=fastest)
