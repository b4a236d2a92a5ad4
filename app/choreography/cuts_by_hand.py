"""Cuts of a motion set by the user: moved, added, deleted, read from a file, and checked before learning.

A *bound* is a frame at which a motion starts or ends; adjacent motions share one. Every edit gives valid cuts:
ascending, without overlap, each with its accent between its bounds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.cuts import Cut
from app.encoding import guessed
from app.errors import FileError, UsageError, shortened
from app.formats.files import read_file

Cuts = tuple[Cut, ...]

MOST_FILE_BYTES: Final = 2**20


def check_cuts(cuts: Sequence[Cut], frames: int, motion: str) -> None:
    """Raise an error if cuts are invalid for a clip with this number of frames; ``motion`` names the clip in the error.

    Raises
    ------
    UsageError
        A cut is out of order, has its accent outside, or exceeds the clip.
    """
    free = 0
    for cut in cuts:
        if not free <= cut.start < cut.accent < cut.end < frames:
            raise UsageError(
                "cuts.wrong", motion=motion, start=cut.start, accent=cut.accent, end=cut.end, frames=frames
            )
        free = cut.end


def bounds(cuts: Sequence[Cut]) -> tuple[int, ...]:
    """Frames at which any of the cuts starts or ends, ascending, each once."""
    return tuple(sorted({frame for cut in cuts for frame in (cut.start, cut.end)}))


def moved_bound(cuts: Cuts, bound: int, to: int, frames: int) -> Cuts:
    """Return the cuts with a bound moved, limited by the adjacent accents and bounds, and by the clip's number of
    frames.

    Bounds of different motions stay apart, since equal ones could not be distinguished.
    """
    accents = [cut.accent for cut in cuts]
    fixed = sorted({*accents, *bounds(cuts)} - {bound})
    least = max((frame + 1 for frame in fixed if frame < bound), default=0)
    most = min((frame - 1 for frame in fixed if frame > bound), default=frames - 1)
    place = min(max(to, least), most)
    return tuple(
        replace(cut, start=place if cut.start == bound else cut.start, end=place if cut.end == bound else cut.end)
        if bound in (cut.start, cut.end)
        else cut
        for cut in cuts
    )


def moved_accent(cuts: Cuts, accent: int, to: int) -> Cuts:
    """Return the cuts with one accent moved to the frame ``to``, limited by the start and end of its motion."""
    return tuple(
        replace(cut, accent=min(max(to, cut.start + 1), cut.end - 1)) if cut.accent == accent else cut for cut in cuts
    )


def added_bound(cuts: Cuts, frame: int, curve_rad_s2: FloatArray) -> Cuts:
    """Return the cuts with a bound added at a frame.

    Within a motion it makes two: the one with the accent keeps it, the other's accent is at its maximum. Outside it
    adds the motion between the frame and the nearest bound, or the end of the clip. Without room for an accent the cuts
    are unchanged.
    """
    for at, cut in enumerate(cuts):
        if cut.start <= frame <= cut.end:
            parts = (cut.start, frame), (frame, cut.end)
            if any(end - start < 2 for start, end in parts):
                return cuts
            halves = tuple(
                Cut(start, cut.accent if start < cut.accent < end else _accent(curve_rad_s2, start, end), end)
                for start, end in parts
            )
            return cuts[:at] + halves + cuts[at + 1 :]
    near = min(bounds(cuts), key=lambda bound: abs(bound - frame), default=len(curve_rad_s2) - 1)
    start, end = min(frame, near), max(frame, near)
    if end - start < 2 or start < 0 or end >= len(curve_rad_s2):
        return cuts
    return tuple(sorted((*cuts, Cut(start, _accent(curve_rad_s2, start, end), end))))


def removed_bound(cuts: Cuts, bound: int) -> Cuts:
    """Return the cuts with a bound deleted: the motions on both sides become one, with the accent of the longer one; at
    the end of a series its motion is deleted.
    """
    before = next((cut for cut in cuts if cut.end == bound), None)
    after = next((cut for cut in cuts if cut.start == bound), None)
    rest = [cut for cut in cuts if cut is not before and cut is not after]
    if before is not None and after is not None:
        longer = max(before, after, key=lambda cut: cut.end - cut.start)
        rest.append(Cut(before.start, longer.accent, after.end))
    return tuple(sorted(rest))


def automatic_accent(cuts: Cuts, accent: int, curve_rad_s2: FloatArray) -> Cuts:
    """Return the cuts of a clip with one accent moved to its automatic frame.

    ``accent`` is the current frame of the accent of a motion; its new frame is that of the greatest angular
    acceleration (a value for each frame of the clip) within the motion.
    """
    return tuple(
        replace(cut, accent=_accent(curve_rad_s2, cut.start, cut.end)) if cut.accent == accent else cut for cut in cuts
    )


def extrema(curve_rad_s2: FloatArray) -> tuple[IntArray, IntArray]:
    """Frames (K,) of all local minima, and of all local maxima, of a curve including its ends; of equal neighbours the
    first.
    """
    rises = np.diff(curve_rad_s2) > 0.0
    falls = np.diff(curve_rad_s2) < 0.0
    none = np.ones(1, np.bool_)
    minima = np.concatenate([none, falls]) & np.concatenate([~falls, none])
    maxima = np.concatenate([none, rises]) & np.concatenate([~rises, none])
    return np.flatnonzero(minima), np.flatnonzero(maxima)


def read_times(path: Path) -> tuple[tuple[float, ...], ...]:
    """Read the times of bounds in a text file: one per line in seconds of the motion file; an empty line is a rest.

    Returns
    -------
    tuple of tuple of float
        Groups without rests, each of at least two.

    Raises
    ------
    FileError
        The file cannot be read, a line is no time, or times do not ascend or are single.
    """
    groups: list[list[float]] = [[]]
    last, number = -math.inf, 0
    for number, line in enumerate(guessed(read_file(path, MOST_FILE_BYTES)).splitlines(), start=1):
        text = line.strip()
        if not text:
            _require_group(groups[-1], path, number - 1)
            groups.append([])
            continue
        try:
            time_s = float(text)
        except ValueError:
            time_s = math.nan
        if not math.isfinite(time_s):
            raise FileError("cuts.line", file=str(path), line=number, text=shortened(text, 40))
        if time_s <= last:
            raise FileError("cuts.order", file=str(path), line=number)
        groups[-1].append(time_s)
        last = time_s
    _require_group(groups[-1], path, number)
    return tuple(tuple(group) for group in groups if group)


def _require_group(group: Sequence[float], path: Path, line: int) -> None:
    if len(group) == 1:
        raise FileError("cuts.order", file=str(path), line=line)


def cuts_at(times_s: Sequence[Sequence[float]], fps: Fraction, curve_rad_s2: FloatArray, motion: str) -> Cuts:
    """Create cuts at given times of a clip, with accents at the greatest acceleration; each group of times is a series
    of adjacent motions.

    Raises
    ------
    UsageError
        Times are outside of the clip, or too close to have a frame between them.
    """
    cuts = []
    for group in times_s:
        for start, end in pairwise(round(time_s * fps) for time_s in group):
            accent = _accent(curve_rad_s2, start, end) if 0 <= start < end < len(curve_rad_s2) else start
            cuts.append(Cut(start, accent, end))
    check_cuts(cuts, len(curve_rad_s2), motion)
    return tuple(cuts)


def _accent(curve_rad_s2: FloatArray, start: int, end: int) -> int:
    """Frame of the maximum of the curve strictly between two frames; ``start`` if there is none between."""
    between = curve_rad_s2[start + 1 : end]
    return start + 1 + int(np.argmax(between)) if len(between) else start
