"""Limits on the length of motion in a file; checked before sampling, since few keys can span many frames."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from app.errors import FileError

FPS: Final = (1, 1000)
"""Least and greatest frame rate of motion in frames per second."""
KEPT_FPS: Final = Fraction(60)
"""Lowest frame rate at which motion is stored, and the rate of the motion from which models are learned."""
FREE_FRAMES, FRAMES_PER_KB = 54_000, 50
"""Limit of the number of frames: a fixed amount, a quarter of an hour at 60 frames per second, plus this many per
kilobyte of the file. Explicit frames need more than a hundred bytes in every format, so only motion sampled between
keys reaches this bound.
"""
FREE_TRANSFORMS, TRANSFORMS_PER_KB = 2**20, 512
"""Limit of frames times nodes: a fixed amount, plus this many per kilobyte of the file."""
MOST_TRANSFORMS: Final = 2**23
"""Greatest product of frames and nodes for a file of any size: a quarter of an hour of 150 nodes at 60 frames per
second.
"""


def longest_motion_s(fps: float, nodes: int, size_bytes: int) -> float:
    """Return the greatest allowed duration of a motion, in seconds, for a file of a size with a number of nodes.

    It is sampled at ``fps`` and stored at `KEPT_FPS` or more.
    """
    most_frames = FREE_FRAMES + FRAMES_PER_KB * size_bytes // 1000
    most_transforms = min(MOST_TRANSFORMS, FREE_TRANSFORMS + TRANSFORMS_PER_KB * size_bytes // 1000)
    return min((most_frames - 1) / max(fps, float(KEPT_FPS)), (most_transforms // max(nodes, 1) - 1) / fps)


def require_frames(file: str, seconds: float, fps: float, nodes: int, size_bytes: int) -> None:
    """Raise FileError for a motion with too many frames for the size of its file.

    Parameters
    ----------
    seconds, fps : float
        Duration, and sampling rate.
    nodes : int
        Number of nodes sampled in each frame.
    size_bytes : int
        Size of the file.

    Raises
    ------
    FileError
        The motion is too long.
    """
    most_s = longest_motion_s(fps, nodes, size_bytes)
    # Written so that NaN fails the comparison.
    if not seconds <= most_s:
        said = {"seconds": round(float(seconds), 1), "most": round(most_s, 1)}
        raise FileError("motion.too_long", file=file, nodes=nodes, **said)


def require_rate(fps: Fraction, file: str) -> None:
    """Raise FileError for a frame rate outside `FPS`."""
    slowest, fastest = FPS
    if not slowest <= fps <= fastest:
        frame_s = float(f"{float(1 / fps):.6g}")
        raise FileError("motion.rate_impossible", file=file, frame_s=frame_s, slowest=slowest, fastest=fastest)
